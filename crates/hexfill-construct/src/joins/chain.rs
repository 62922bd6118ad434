//! A chain of hexes between two cubes, and the boundary of the ball that all together are.
//!
//! Source: Erickson 2014 (odd components are paired); the chain of hexes is ours.

use super::no_chain::NoChain;
use crate::core::complex::sorted;
use crate::ids::PointId;
use hexfill_mesh::cube::FACETS;
use hexfill_mesh::{QuadSurface, improper_pairs};
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};

/// A short chain of hexes from `first` to `last`, one quad after another, that keeps away from the vertices `near` between its ends.
pub(super) fn chain(
    first: usize,
    last: usize,
    hexes: &[[PointId; 8]],
    hexes_at: &BTreeMap<[PointId; 4], Vec<usize>>,
    near: &BTreeSet<PointId>,
) -> Option<Vec<usize>> {
    // A hex in the middle that touches the cubes would make the ball touch itself; that is made dear rather than
    // forbidden, since close components leave no way without.
    let cost = |h: usize| {
        if h == first || h == last { 1 } else { 1 + 4 * hexes[h].iter().filter(|v| near.contains(v)).count() }
    };
    // Dijkstra with ties by number of the hex, so that of equal chains always the same one is taken.
    let mut best: BTreeMap<usize, (usize, usize)> = BTreeMap::from([(first, (0, first))]);
    let mut heap = BinaryHeap::from([(std::cmp::Reverse(0), first)]);
    while let Some((std::cmp::Reverse(length), h)) = heap.pop() {
        if h == last {
            break;
        }
        if best.get(&h).is_some_and(|b| b.0 < length) {
            continue;
        }
        for f in FACETS {
            for &o in hexes_at.get(&sorted(f.map(|k| hexes[h][k]))).into_iter().flatten().filter(|&&o| o != h) {
                let through = length + cost(o);
                if best.get(&o).is_none_or(|b| through < b.0) {
                    best.insert(o, (through, h));
                    heap.push((std::cmp::Reverse(through), o));
                }
            }
        }
    }
    let mut chain = vec![last];
    while let Some(&h) = chain.last() {
        let before = best.get(&h)?.1;
        if before == h {
            break;
        }
        chain.push(before);
    }
    chain.reverse();
    Some(chain)
}

/// The boundary of two cubes and a chain as a surface of its own, with the vertex of the mesh for each of its vertices.
///
/// # Errors
/// What it is instead of a proper sphere.
pub(super) fn ball(
    cubes: &[Vec<[PointId; 4]>; 2],
    chain: &[usize],
    hexes: &[[PointId; 8]],
) -> Result<(QuadSurface, Vec<PointId>), NoChain> {
    let mut open: BTreeMap<[PointId; 4], [PointId; 4]> = BTreeMap::new();
    let chained = chain.iter().flat_map(|&h| FACETS.map(|f| f.map(|k| hexes[h][k])));
    for quad in cubes.iter().flatten().copied().chain(chained) {
        // A quad that comes twice lies between two members of the chain: the boundary is what came an odd number of
        // times.
        if open.remove(&sorted(quad)).is_none() {
            open.insert(sorted(quad), quad);
        }
    }
    let mut ids: Vec<PointId> = open.values().flatten().copied().collect();
    ids.sort_unstable();
    ids.dedup();
    let local: Vec<[u32; 4]> = open.values().map(|q| q.map(|v| ids.partition_point(|&x| x < v) as u32)).collect();
    let surface = QuadSurface::try_new(ids.len(), &local)?;
    // Nothing above made sure of this: it decides whether the chain may be replaced.
    if !surface.is_sphere() || !surface.n_quads().is_multiple_of(2) || !surface.reversed().is_empty() {
        return Err(NoChain::TouchesItself);
    }
    if !improper_pairs(&surface).is_empty() {
        return Err(NoChain::Improper);
    }
    Ok((surface, ids))
}
