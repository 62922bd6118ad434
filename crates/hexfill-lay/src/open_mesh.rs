//! [`OpenMesh`]: the surface with the hexes that a sweep could glue, all at valid positions, and the void they leave.
//!
//! Source: ours.

use crate::step::Step;
use hexfill_embed::{Open, OpenEffort, open_start, tutte_start, untangle_near};
use hexfill_geometry::Vector;
use hexfill_mesh::{Context, HexMesh, QuadSurface};
use hexfill_shell::{SweepOptions, Swept, sweep};
use rayon::prelude::*;
use rustc_hash::FxHashSet;
use std::borrow::Cow;

/// Sweeps that differ by how ties are broken; the best of them are gone on from. As many as these quads allow, within limits.
const QUADS_SWEPT: usize = 10_000;
const SWEEPS: [usize; 2] = [8, 32];
/// Voids of more quads are not tried.
const MOST_OPEN: usize = 300;
/// One hex of the pillow in so many may be forgiven.
const FEW: usize = 8;
/// A quad of the void may take so many hexes in the end.
const HEXES_A_QUAD: usize = 5;
/// How long the untangler tries.
const EFFORT: OpenEffort = OpenEffort { rounds: 100, iterations: 200, extra: 2 };

/// Hexes round a void, their positions, and what is open.
#[derive(Clone, Debug)]
pub(crate) struct OpenMesh {
    pub(crate) hexes: Vec<[u32; 8]>,
    /// What made each of them.
    pub(crate) steps: Vec<Step>,
    /// Those that stay come first: the surface's, and in a patch those of hexes outside.
    pub(crate) points: Vec<Vector>,
    pub(crate) n_fixed: usize,
    /// Quads counter-clockwise seen from outside of the void.
    pub(crate) front: Vec<[u32; 4]>,
    /// Inside the void, which it sees all of.
    pub(crate) apex: Vector,
    /// Hexes, ascending, for which the surface leaves no room: they wait for a second edge at its vertices, and nothing looks at them.
    pub(crate) forgiven: Vec<u32>,
}

/// What is laid.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Part {
    /// A surface. A sweep that closes is a mesh already, which others place; the pillow under the surface may go in the end.
    Whole,
    /// A piece of one. Sweeps that close count, too; the pillow stays, as the pieces must fit together and there is no other mesh to choose.
    Piece,
}

/// The best that sweeps with other ties leave, fewest forgiven hexes first, then fewest hexes as far as one can tell; none if no void can be held open.
pub(crate) fn swept(surface: &QuadSurface, points: &[Vector], part: Part, ctx: &Context<'_>) -> Vec<OpenMesh> {
    let quiet = Context { progress: None, ..*ctx };
    let sweeps = (QUADS_SWEPT / surface.n_quads().max(1)).clamp(SWEEPS[0], SWEEPS[1]) as u64;
    let mut left: Vec<Swept> =
        (0..sweeps).into_par_iter().filter_map(|i| left_open(surface, points, part, ctx.seed + i, &quiet)).collect();
    // Many sweeps end alike.
    let mut seen = FxHashSet::default();
    left.retain(|swept| seen.insert(swept.hexes.clone()));
    let mut open: Vec<OpenMesh> =
        left.into_par_iter().filter_map(|swept| OpenMesh::placed(swept, surface.n_quads(), points, &quiet)).collect();
    // Stable: among equals the first.
    open.sort_by_key(|open| (open.forgiven.len(), open.hexes.len() + HEXES_A_QUAD * open.front.len()));
    open
}

/// What a sweep behind a pillow leaves, if that is one void of not too many quads.
fn left_open(surface: &QuadSurface, points: &[Vector], part: Part, seed: u64, ctx: &Context<'_>) -> Option<Swept> {
    let options = SweepOptions::default().with_pillows(1).with_seed(seed);
    let swept = sweep(surface, Some(points), &options, ctx);
    if swept.front.is_empty() && part == Part::Piece && ctx.stop().is_none() {
        return Some(swept);
    }
    let is_small = (1..=MOST_OPEN).contains(&swept.front.len()) && ctx.stop().is_none();
    let (void, _) = QuadSurface::on_own_vertices(swept.front.clone()).ok().filter(|_| is_small)?;
    void.is_sphere().then_some(swept)
}

impl OpenMesh {
    /// Positions for what a sweep made; `None` if not all of it is valid but for a few hexes at the surface.
    fn placed(swept: Swept, n_quads: usize, surface: &[Vector], ctx: &Context<'_>) -> Option<Self> {
        let Swept { hexes, front, n_vertices, plugs, .. } = swept;
        let steps = Step::of_sweep(n_quads, plugs, hexes.len());
        let (points, apex) = if front.is_empty() {
            let mesh = HexMesh::try_new(n_vertices as usize, &hexes).ok()?;
            (tutte_start(&mesh, surface).ok()?, [0.0; 3])
        } else {
            open_start(&hexes, &front, n_vertices as usize, surface)
        };
        let mut open = Self { hexes, steps, points, n_fixed: surface.len(), front, apex, forgiven: Vec::new() };
        let [bad, pyramids] = open.untangle(&open.inner(), EFFORT, ctx);
        // A pyramid that is not valid means that the apex does not see all of the void: no pillow could be put in
        // later, and laying could not go on.
        if pyramids > 0 || bad * FEW > surface.len() {
            return None;
        }
        if bad > 0 {
            open.forgive();
            if open.untangle(&open.inner(), EFFORT, ctx) != [0, 0] {
                return None;
            }
        }
        Some(open)
    }

    /// Forgives the hexes that are not valid and that no small change makes valid.
    fn forgive(&mut self) {
        let Ok(mesh) = HexMesh::try_new(self.points.len(), &self.hexes) else { return };
        if let Ok((points, bad)) = untangle_near(&mesh, &self.points, 0, 0, &Context::default()) {
            self.points = points;
            self.forgiven = bad.iter().map(|h| h.0).collect();
        }
    }

    /// Per vertex whether it may move.
    pub(crate) fn inner(&self) -> Vec<bool> {
        (0..self.points.len()).map(|v| v >= self.n_fixed).collect()
    }

    /// Moves the free vertices. Returns the hexes and the pyramids at them that are not valid.
    pub(crate) fn untangle(&mut self, free: &[bool], effort: OpenEffort, ctx: &Context<'_>) -> [usize; 2] {
        let looked_at = without(&self.hexes, &self.forgiven);
        Open { hexes: &looked_at, front: &self.front, apex: self.apex }.untangle(free, &mut self.points, effort, ctx)
    }
}

/// Hexes but for those with some numbers, which ascend.
fn without<'a>(hexes: &'a [[u32; 8]], numbers: &[u32]) -> Cow<'a, [[u32; 8]]> {
    if numbers.is_empty() {
        return Cow::Borrowed(hexes);
    }
    (0..).zip(hexes).filter(|(h, _)| numbers.binary_search(h).is_err()).map(|(_, hex)| *hex).collect()
}
