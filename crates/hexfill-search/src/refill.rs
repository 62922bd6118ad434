//! Smaller fillings by refilling: a ball of hexes is taken out of a filling, and its hole filled by a way back to a known state.
//!
//! [`simplify`](crate::simplify()) looks up what is on record for the hole, so it finds nothing where every filling on record joins pairs that hexes outside
//! join, too. A [search backward](crate::backward) starts with these pairs blocked. It takes a thousand times as long, so few balls are
//! tried, large ones.
//!
//! Source: Verhetsel et al. 2018 (groups of hexes get new interiors with fewer); that the interior is searched and not looked up is ours.

use crate::backward::{Breadth, shorter_way};
use crate::known::Known;
use crate::simplify::{LiveMesh, Region, sequence};
use hexfill_mesh::{Context, HexMesh, Random};

/// Most quads of a ball that is taken out, and on the way to it.
const BALL_QUADS: usize = 24;
const GROW_QUADS: usize = 30;
/// Fewest hexes of a ball: of smaller ones everything is on record.
const FEWEST: usize = 12;
/// How widely each hole is searched.
const BREADTH: Breadth = Breadth { depth: 10, beam: 500, first: false };

/// The mesh with fewer hexes, if one of so many balls of it has a filling with fewer.
pub(crate) fn refilled(mesh: &HexMesh, balls: usize, known: &Known, ctx: &Context<'_>) -> Option<HexMesh> {
    let live = LiveMesh::new(mesh);
    let mut region = Region::new();
    (0..balls as u64).take_while(|_| ctx.stop().is_none()).find_map(|ball| {
        let mut random = sequence(ctx.seed, ball);
        if !grow(&mut region, &live, &mut random) {
            return None;
        }
        let (mut hole, ids) = region.cavity(&live)?;
        region.block_outside(&live, &mut hole, &ids);
        let filling = shorter_way(&hole, region.hexes().len() as u32, known, &BREADTH, ctx)?.filling(known)?;
        // What is inside the hole follows the vertices of its boundary.
        let (n, fresh) = (ids.len() as u32, live.n_vertex_slots() as u32);
        let id = |v: u32| ids.get(v as usize).copied().unwrap_or(fresh + v - n);
        let outside = live.alive().filter(|&h| !region.contains(h)).map(|h| *live.hex(h));
        let hexes: Vec<[u32; 8]> = outside.chain(filling.hexes_raw().into_iter().map(|hex| hex.map(id))).collect();
        HexMesh::try_new(fresh as usize + filling.n_vertices() - n as usize, &hexes).ok()
    })
}

/// Grows a ball of a random number of hexes from a random one, mostly by the hex that shares most quads with it; whether its boundary is small enough.
fn grow(region: &mut Region, live: &LiveMesh, random: &mut Random) -> bool {
    let n = live.n_hexes();
    let size = FEWEST + random.below(n.saturating_sub(FEWEST).max(1));
    let wild = random.below(4);
    region.start(live, random.below(n) as u32);
    while region.hexes().len() < size || region.n_quads() > BALL_QUADS {
        let any = random.below(16) < wild;
        let candidates = region.candidates(live, GROW_QUADS);
        let most = candidates.iter().map(|c| c.shared).max().unwrap_or(0);
        let fit: Vec<u32> = candidates.iter().filter(|c| any || c.shared == most).map(|c| c.hex).collect();
        if fit.is_empty() {
            return false;
        }
        let hex = fit[random.below(fit.len())];
        region.join(live, hex);
    }
    region.hexes().len() < n
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Atlas, FillOptions, fill_from_atlas};
    use hexfill_check::{Judged, Level, Options, judge};
    use hexfill_mesh::generate::random_sphere;

    #[test]
    fn what_is_refilled_is_proper_and_smaller() {
        let atlas = Atlas::fewest().pruned(1, |quads, hexes| quads <= 16 && hexes < 45);
        let known = Known::from_atlas(&atlas).unwrap();
        let mut smaller = 0;
        for seed in 0..4 {
            let sphere = random_sphere(14, seed).unwrap();
            let quads: Vec<[u32; 4]> = sphere.quads_raw();
            let made = fill_from_atlas(&sphere, Atlas::embedded(), &FillOptions::default(), &Context::default());
            // Behind a pillow: as many hexes too many as there are quads.
            let filling = made.unwrap().fillings.remove(0).mesh;
            let copy = |v: u32| v + sphere.n_vertices() as u32;
            let mut hexes: Vec<[u32; 8]> = filling.hexes_raw().into_iter().map(|hex| hex.map(copy)).collect();
            hexes.extend(quads.iter().map(|q| std::array::from_fn(|i| if i < 4 { copy(q[i]) } else { q[i - 4] })));
            let mut mesh = HexMesh::try_new(sphere.n_vertices() + filling.n_vertices(), &hexes).unwrap();
            while let Some(made) = refilled(&mesh, 10, &known, &Context { seed, ..Context::default() }) {
                assert!(made.n_hexes() < mesh.n_hexes());
                mesh = made;
                smaller += 1;
                let hexes = mesh.hexes_raw();
                let judged = Judged::connectivity(mesh.n_vertices(), &hexes).with_surface(&quads);
                let report = judge(&judged, &Options::default().with_up_to(Level::L3), &Context::default());
                assert!(report.passed(Level::L3), "{report}");
            }
        }
        assert!(smaller > 3, "{smaller}");
    }
}
