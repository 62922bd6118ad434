//! [`Plan`]: hexes that fill a void, by topology alone.
//!
//! Source: ours.

use hexfill_mesh::{Context, QuadSurface};
use hexfill_search::{Atlas, FillOptions, fill_avoiding};
use hexfill_shell::{Front, SweepOptions, stir_front, sweep_front};

/// Voids of at most so many quads are filled from the atlas or by inward flips, if that works; larger ones are swept and stirred.
const SMALL: usize = 20;
/// Times a residual is stirred, each time by so many rounds, until it is small.
const STIRRINGS: u64 = 8;
const ROUNDS: u32 = 2;
/// Cavities that inward flips may look at, and how many they keep.
const CAVITIES: u64 = 20_000;
const BEAM: usize = 200;

/// Hexes for a void, in an order in which they can be glued to its front; they may leave a smaller void.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    /// Vertices below the number of those of the front are those of the front.
    pub(crate) hexes: Vec<[u32; 8]>,
    pub(crate) n_vertices: usize,
}

impl Plan {
    /// For a void whose front is `surface`, where nothing outside blocks anything (it is behind a pillow). Other numbers give other plans. `None` if no hex was found.
    pub(crate) fn new(surface: &QuadSurface, number: u64, ctx: &Context<'_>) -> Option<Self> {
        // Every other plan for a small void comes from a sweep: fillings of one void differ little.
        let direct = surface.n_quads() <= SMALL && number.is_multiple_of(2);
        let filling = direct.then(|| filling(surface, number as usize / 2, ctx)).flatten();
        filling.or_else(|| swept(surface, number, ctx))
    }
}

/// A complete filling, the one of that number among the best.
fn filling(surface: &QuadSurface, number: usize, ctx: &Context<'_>) -> Option<Plan> {
    let options = FillOptions::default().with_count(number + 1).with_max_cavities(CAVITIES).with_beam(BEAM);
    let found = fill_avoiding(surface, &[], Atlas::fewest(), &options, ctx)?.fillings;
    let mesh = &found.get(number % found.len().max(1))?.mesh;
    Some(Plan { hexes: mesh.hexes_raw(), n_vertices: mesh.n_vertices() })
}

/// The hexes of a sweep and of stirring.
fn swept(surface: &QuadSurface, number: u64, ctx: &Context<'_>) -> Option<Plan> {
    let mut front = Front::new(surface).ok()?;
    let options = |seed| SweepOptions::default().with_seed(seed);
    sweep_front(&mut front, &options(number), ctx);
    for stirring in 1..=STIRRINGS {
        if front.n_quads() <= SMALL || ctx.stop().is_some() {
            break;
        }
        stir_front(&mut front, ROUNDS, &options(number + 1000 * stirring), ctx);
    }
    let swept = front.finish(None);
    (!swept.hexes.is_empty()).then_some(Plan { n_vertices: swept.n_vertices as usize, hexes: swept.hexes })
}
