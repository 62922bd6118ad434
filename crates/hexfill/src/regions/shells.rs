//! Faces with their two sides, and the shells that sides make round regions.
//!
//! Source: ours.

use crate::regions::error::RegionsError;
use hexfill_geometry::{Vector, cone, cross, direction, dot, midpoint, sub};
use hexfill_io::MeshData;
use hexfill_mesh::{Edge, Forest, HexId, Offenders, VertexId, cube, id_type};
use std::collections::BTreeMap;

id_type!(
    /// A side of a face: twice its number in front of it (where its normal points), one more behind it.
    Side,
    "s"
);

impl Side {
    fn of(quad: u32, behind: bool) -> Self {
        Self(2 * quad + u32::from(behind))
    }
}

/// The quads of a file, then the boundary quads of its hexes that are none of them; and per side (twice the quad: before it; one more: behind it) whether
/// a hex lies there.
pub(super) fn walls(data: &MeshData) -> (Vec<[u32; 4]>, Vec<bool>) {
    let sorted = |quad: [u32; 4]| {
        let mut quad = quad;
        quad.sort_unstable();
        quad
    };
    let mut walls = data.quads.clone();
    let mut index: BTreeMap<[u32; 4], usize> = walls.iter().enumerate().map(|(q, quad)| (sorted(*quad), q)).collect();
    let mut facets: BTreeMap<[u32; 4], ([u32; 4], usize)> = BTreeMap::new();
    for hex in &data.hexes {
        for facet in cube::FACETS {
            let quad = facet.map(|k| hex[k]);
            facets.entry(sorted(quad)).or_insert((quad, 0)).1 += 1;
        }
    }
    let mut occupied = vec![false; 2 * walls.len()];
    for (key, (quad, times)) in facets {
        let q = match index.get(&key) {
            Some(&q) => q,
            None if times == 1 => {
                walls.push(quad);
                occupied.extend([false, false]);
                index.insert(key, walls.len() - 1);
                walls.len() - 1
            }
            // Between two hexes of the file, and no face of it: nothing to see there.
            None => continue,
        };
        // Facets face out of their hex, which lies behind them.
        let same = (0..4).any(|k| (0..4).all(|i| walls[q][(i + k) % 4] == quad[i]));
        if times == 1 {
            occupied[2 * q + usize::from(same)] = true;
        } else {
            occupied[2 * q] = true;
            occupied[2 * q + 1] = true;
        }
    }
    (walls, occupied)
}

/// Hexes of negative volume.
pub(super) fn inside_out(hexes: &[[u32; 8]], points: &[Vector]) -> Offenders<HexId> {
    let volume = |hex: &[u32; 8]| {
        // From a corner of its own, as far from the origin the sign would be rounding.
        let at = |k: usize| sub(points[hex[k] as usize], points[hex[0] as usize]);
        cube::FACETS.iter().map(|facet| cone(facet.map(at))).sum::<f64>()
    };
    (0..hexes.len()).filter(|&h| volume(&hexes[h]) < 0.0).map(HexId::new).collect()
}

/// The quad of a side, facing out of the region on that side.
pub(super) fn outward(walls: &[[u32; 4]], side: u32) -> [u32; 4] {
    let [a, b, c, d] = walls[side as usize / 2];
    if side.is_multiple_of(2) { [a, d, c, b] } else { [a, b, c, d] }
}

/// The sides that belong together, each shell ascending.
pub(super) fn shells(name: &str, walls: &[[u32; 4]], points: &[Vector]) -> Result<Vec<Vec<u32>>, RegionsError> {
    // Per edge: the quads there, whether each runs along it from the smaller end.
    let mut edges: BTreeMap<[u32; 2], Vec<(u32, bool)>> = BTreeMap::new();
    for (q, quad) in (0..).zip(walls) {
        for k in 0..4 {
            let (a, b) = (quad[k], quad[(k + 1) % 4]);
            edges.entry([a.min(b), a.max(b)]).or_default().push((q, a < b));
        }
    }
    let with = |is_one: fn(usize) -> bool| -> Offenders<Edge> {
        let of = edges.iter().filter(|(_, quads)| is_one(quads.len()));
        of.map(|(&[a, b], _)| Edge(VertexId(a), VertexId(b))).collect()
    };
    // A wall that ends in space bounds nothing: the two sides of it are one, and so would be the regions.
    let open = with(|n| n < 2);
    if !open.is_empty() {
        return Err(RegionsError::Open { name: name.to_owned(), edges: open, shared: with(|n| n > 2) });
    }
    let mut forest: Forest<Side> = Forest::new(2 * walls.len());
    for (&[a, b], quads) in &edges {
        let mut round: Vec<(f64, u32, bool)> =
            quads.iter().map(|&(q, along)| (angle(walls[q as usize], [a, b], points), q, along)).collect();
        round.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        // Between two neighbours in the order of their angles there is nothing: the sides that face each other there
        // belong to one region.
        for (i, &(_, p, along)) in round.iter().enumerate() {
            let (_, q, next_along) = round[(i + 1) % round.len()];
            // A quad along the edge has growing angles before it.
            forest.union(Side::of(p, !along), Side::of(q, next_along));
        }
    }
    let mut shells: BTreeMap<Side, Vec<u32>> = BTreeMap::new();
    for side in 0..2 * walls.len() as u32 {
        shells.entry(forest.find(Side(side))).or_default().push(side);
    }
    let mut shells: Vec<Vec<u32>> = shells.into_values().collect();
    shells.sort();
    Ok(shells)
}

/// The angle of a quad round one of its edges, in a frame that depends on the edge alone.
fn angle(quad: [u32; 4], [a, b]: [u32; 2], points: &[Vector]) -> f64 {
    let at = |v: u32| points[v as usize];
    let others: Vec<Vector> = quad.into_iter().filter(|&v| v != a && v != b).map(at).collect();
    let along = direction(at(a), at(b)).unwrap_or([0.0, 0.0, 1.0]);
    // Towards the far side's middle: of a bent quad both far corners count.
    let away = sub(others.get(1).map_or(others[0], |&other| midpoint(others[0], other)), midpoint(at(a), at(b)));
    // The axis least along the edge gives the frame.
    let k = (0..3).min_by(|&i, &j| along[i].abs().total_cmp(&along[j].abs())).unwrap_or(0);
    let mut axis = [0.0; 3];
    axis[k] = 1.0;
    let second = cross(along, axis);
    let first = cross(second, along);
    dot(away, second).atan2(dot(away, first))
}
