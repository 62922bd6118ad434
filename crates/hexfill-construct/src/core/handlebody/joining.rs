//! Components of one solid are joined by prisms: their connected sum.
//!
//! Source: ours; connected sums are textbook knowledge.

use super::cutting::Cutting;
use super::prism::{Prism, SIDES};
use crate::surface::polygons::{DartId, GonId};

/// Joins two components by a prism between the triangles `a` and `c`.
pub(super) fn join(cutting: &mut Cutting, a: GonId, c: GonId) {
    let s = &cutting.s;
    let ([a0, a1, a2], [c0, c1, c2]) = ([0, 1, 2].map(|k| s.side(a, k)), [0, 1, 2].map(|k| s.side(c, k)));
    // The triangles face each other: the order of the second one is turned round.
    let vertices = [a0, a1, a2, c0, c2, c1].map(|d| s.origin[d]);
    let ends = [(0, 1), (1, 2), (2, 0), (3, 5), (5, 4), (4, 3)];
    let beyond = [a0, a1, a2, c0, c1, c2].map(|d| s.twin[d]);
    // Potentials of the corners, so that the sides are closed; nothing forces the sum along the prism.
    let potential: Vec<[i64; 6]> = (0..cutting.inside.width)
        .map(|k| {
            let value = |d: DartId| cutting.inside.of(d)[k];
            [0, value(a0), value(a0) + value(a1), 0, -value(c2), value(c0)]
        })
        .collect();
    let n = cutting.add_triangles(4).0;
    let s = &mut cutting.s;
    let sides = [a, c, GonId(n), GonId(n + 1), GonId(n + 2), GonId(n + 3)];
    let dart_of = |from: usize, to: usize| {
        SIDES.iter().zip(sides).find_map(|(corners, side)| {
            let i = (0..3).find(|&i| corners[i] == from && corners[(i + 1) % 3] == to)?;
            Some(DartId(3 * side.0 + i as u32))
        })
    };
    for (corners, side) in SIDES.iter().zip(sides) {
        for i in 0..3 {
            let (from, to) = (corners[i], corners[(i + 1) % 3]);
            let d = s.side(side, i);
            s.origin[d] = vertices[from];
            let outside = ends.iter().position(|&e| e == (from, to)).map(|k| beyond[k]);
            if let Some(twin) = outside.or_else(|| dart_of(to, from)) {
                s.join(d, twin);
            }
            for (k, p) in potential.iter().enumerate() {
                cutting.inside.of_mut(d)[k] = p[to] - p[from];
            }
        }
    }
    cutting.prisms.push(Prism { sides, vertices });
}
