//! How far a mesh is from the hexes its edges want: the number that ranks meshes before anything is embedded.
//!
//! Source: ours.

use crate::compress::Coarse;
use crate::lift::segments;
use hexfill_mesh::cube::EDGES;
use rustc_hash::FxHashMap;

/// Hexes round an interior edge that bends nothing.
const REGULAR: f32 = 4.0;

/// What is known of a coarse mesh before it is lifted.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Deviation {
    /// Sum over all edges of (hexes round it - hexes wanted)^2, each counted once for every fine edge on it. 0 is perfect.
    pub cost: f32,
    /// Hexes after lifting.
    pub fine_hexes: u64,
}

/// Measures a coarse mesh; `None` if one of its sheets ends in chords of different multiplicities.
pub(crate) fn deviation(coarse: &Coarse, hexes: &[[u32; 8]]) -> Option<Deviation> {
    let segments = segments(coarse, hexes).ok()?;
    let mut round: FxHashMap<[u32; 2], u32> = FxHashMap::default();
    let mut fine_hexes = 0;
    for hex in hexes {
        for [i, j] in EDGES {
            *round.entry([hex[i].min(hex[j]), hex[i].max(hex[j])]).or_insert(0) += 1;
        }
        fine_hexes += [[0, 1], [0, 3], [0, 4]]
            .iter()
            .map(|&[i, j]: &[usize; 2]| u64::from(segments[&[hex[i].min(hex[j]), hex[i].max(hex[j])]]))
            .product::<u64>();
    }
    let surface = &coarse.surface;
    let mut wanted: FxHashMap<[u32; 2], f32> = FxHashMap::default();
    for d in surface.darts() {
        let (a, b) = (surface.origin(d).0, surface.target(d).0);
        wanted.insert([a.min(b), a.max(b)], coarse.wanted[d.index()]);
    }
    // In the order of the edges: a sum of floats depends on its order.
    let mut edges: Vec<([u32; 2], u32)> = round.into_iter().collect();
    edges.sort_unstable();
    let cost = edges.iter().map(|(e, n)| {
        let off = *n as f32 - wanted.get(e).copied().unwrap_or(REGULAR);
        segments[e] as f32 * off * off
    });
    Some(Deviation { cost: cost.sum(), fine_hexes })
}
