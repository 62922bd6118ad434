//! What a sweep leaves where chords cross themselves: small fronts go to the atlas and to inward flips.
//!
//! The pairs that the hexes outside join are blocked, so that the whole is proper. Where that finds nothing, a pillow round
//! the residual frees it of its surroundings, and what is inside it is filled without blocked pairs.

use crate::front::Front;
use hexfill_mesh::cube::{BODY_DIAGONALS, EDGES, FACETS};
use hexfill_mesh::{Context, QuadSurface};
use hexfill_search::{Atlas, FillOptions, MAX_QUADS, fill_avoiding};

/// Cavities that inward flips may look at, for a residual with its blocked pairs and for one in a pillow.
const CAVITIES: u64 = 10_000;
/// Cavities kept on each level.
const BEAM: usize = 200;

/// All hexes of a front whose residual could be filled; `None` if it is too large, no sphere, or nothing was found.
pub(crate) fn fill_residual(front: &Front, ctx: &Context<'_>) -> Option<Vec<[u32; 8]>> {
    if front.n_quads() == 0 {
        return Some(front.hexes().to_vec());
    }
    if front.n_quads() > MAX_QUADS {
        return None;
    }
    // Blocked pairs cost hexes, too: the smaller of the two ways is kept.
    let plain = fill_front(front, ctx);
    if plain.as_ref().is_some_and(|hexes| hexes.len() <= front.hexes().len() + front.n_quads()) {
        return plain;
    }
    let pillowed = fill_front(&front.pillowed().0, ctx);
    [plain, pillowed].into_iter().flatten().min_by_key(Vec::len)
}

fn fill_front(front: &Front, ctx: &Context<'_>) -> Option<Vec<[u32; 8]>> {
    let surface = QuadSurface::try_new(front.n_vertices() as usize, &front.quads()).ok()?;
    let mut on_front = vec![false; front.n_vertices() as usize];
    surface.quads().iter().flatten().for_each(|v| on_front[v.index()] = true);
    let mut joined: Vec<[u32; 2]> = Vec::new();
    let mut join = |a: u32, b: u32| {
        if on_front[a as usize] && on_front[b as usize] {
            joined.push([a, b]);
        }
    };
    for hex in front.hexes() {
        EDGES.iter().chain(&BODY_DIAGONALS).for_each(|&[i, j]| join(hex[i], hex[j]));
        FACETS.iter().for_each(|&[i, j, k, l]| {
            join(hex[i], hex[k]);
            join(hex[j], hex[l]);
        });
    }
    for &[a, b, c, d] in front.surface() {
        [[a, b], [b, c], [c, d], [d, a], [a, c], [b, d]].iter().for_each(|&[x, y]| join(x, y));
    }
    let options = FillOptions { max_cavities: CAVITIES, beam: BEAM, ..FillOptions::default() };
    let quiet = Context { progress: None, ..*ctx };
    let outcome = fill_avoiding(&surface, &joined, Atlas::embedded(), &options, &quiet)?;
    let filling = outcome.fillings.first()?;
    let mut hexes = front.hexes().to_vec();
    hexes.extend(filling.mesh.hexes_raw());
    Some(hexes)
}
