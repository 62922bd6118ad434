//! Vertex-star upper bounds: what no placement of the interior vertices can beat.
//!
//! Keep a boundary vertex and the directions of its fixed edges, and let every other edge at it point anywhere. The best
//! possible worst corner there bounds the scaled Jacobian of the whole mesh. A corner with no free edge is a number;
//! corners with exactly one free edge u are linear in it, `u . n` with n the cross product of the two fixed unit edges, and
//! the maximum over unit u of the minimum over the corners round u is found in closed form: at the optimum one,
//! two or three corners are equal and their normals span u, so finitely many candidates suffice. Corners with two or three
//! free edges are left out, which can only raise the bound: it stays an upper bound.

use crate::problem::{FIXED, Problem};
use crate::vector::{Vector, cross, dot, scale, sub, unit};
use hexfill_mesh::VertexId;
use hexfill_mesh::cube::CORNER_NEIGHBOURS;
use serde::Serialize;
use std::collections::BTreeMap;

/// An upper bound on the scaled Jacobian at one boundary vertex.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct StarBound {
    /// The vertex.
    #[serde(serialize_with = "serialize_vertex")]
    pub vertex: VertexId,
    /// No embedding with this boundary has a larger worst corner here (computed in floating point).
    pub bound: f64,
    /// Whether the bound is the true optimum of the star: no corner at the vertex has two free edges.
    pub tight: bool,
}

pub(crate) fn serialize_vertex<S: serde::Serializer>(v: &VertexId, s: S) -> Result<S::Ok, S::Error> {
    s.serialize_u32(v.0)
}

/// The bounds of all fixed vertices with a corner that has at most one free edge, ascending by vertex.
pub(crate) fn bounds(problem: &Problem, points: &[Vector]) -> Vec<StarBound> {
    // Per fixed vertex: fixed corner values, and per free neighbour the normals of its corners.
    struct Star {
        fixed: f64,
        free: BTreeMap<u32, Vec<Vector>>,
        tight: bool,
    }
    let is_fixed = |v: u32| problem.slot[v as usize] == FIXED;
    let mut stars: BTreeMap<u32, Star> = BTreeMap::new();
    for hex in &problem.hexes {
        for (corner, neighbours) in CORNER_NEIGHBOURS.iter().enumerate() {
            let v = hex[corner];
            if !is_fixed(v) {
                continue;
            }
            let star = stars.entry(v).or_insert(Star { fixed: f64::INFINITY, free: BTreeMap::new(), tight: true });
            let ends = neighbours.map(|n| hex[n]);
            let n_free = ends.iter().filter(|&&w| !is_fixed(w)).count();
            if n_free > 1 {
                star.tight = false;
                continue;
            }
            // Rotate so that the free edge (or any) comes first: the frame stays right-handed.
            let first = ends.iter().position(|&w| !is_fixed(w)).unwrap_or(0);
            let direction = |k: usize| {
                let w = ends[(first + k) % 3];
                // A fixed edge of length zero makes every corner on it worthless.
                unit(sub(points[w as usize], points[v as usize])).unwrap_or([0.0; 3])
            };
            let normal = cross(direction(1), direction(2));
            if n_free == 1 {
                star.free.entry(ends[first]).or_default().push(normal);
            } else {
                star.fixed = star.fixed.min(dot(direction(0), normal));
            }
        }
    }
    stars
        .into_iter()
        .filter(|(_, star)| star.fixed.is_finite() || !star.free.is_empty())
        .map(|(v, star)| {
            let free = star.free.values().map(|normals| best_direction(normals));
            StarBound { vertex: VertexId(v), bound: free.fold(star.fixed, f64::min), tight: star.tight }
        })
        .collect()
}

/// The maximum over unit vectors u of the minimum of `u . n` over the normals.
fn best_direction(normals: &[Vector]) -> f64 {
    let value = |u: Vector| normals.iter().map(|&n| dot(u, n)).fold(f64::INFINITY, f64::min);
    let mut best = -1.0f64;
    let mut consider = |candidate: Vector| {
        if let Some(u) = unit(candidate) {
            best = best.max(value(u)).max(value(scale(-1.0, u)));
        }
    };
    for (i, &a) in normals.iter().enumerate() {
        consider(a);
        for (j, &b) in normals.iter().enumerate().take(i) {
            let along = sub(b, a);
            // The point of the line a b nearest to the origin: equal products with a and b, within their plane.
            let square = dot(along, along);
            if square > 0.0 {
                consider(crate::vector::add_scaled(a, -dot(a, along) / square, along));
            }
            for &c in &normals[..j] {
                consider(cross(along, sub(c, a)));
            }
        }
    }
    // All normals zero: every direction gives 0.
    if normals.iter().all(|n| dot(*n, *n) == 0.0) { 0.0 } else { best }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn closed_form_beats_and_meets_a_dense_sampling() {
        let mut random = Random::new(21, 0);
        for case in 0..30 {
            let normals: Vec<Vector> =
                (0..1 + case % 6).map(|_| [random.signed(), random.signed(), 0.3 + random.unit()]).collect();
            let exact = best_direction(&normals);
            let mut sampled = -1.0f64;
            for _ in 0..20000 {
                if let Some(u) = unit([random.signed(), random.signed(), random.signed()]) {
                    sampled = sampled.max(normals.iter().map(|&n| dot(u, n)).fold(f64::INFINITY, f64::min));
                }
            }
            assert!(sampled <= exact + 1e-12 && exact < sampled + 0.05, "{exact} {sampled}");
        }
    }

    #[test]
    fn the_corner_of_a_cube_is_bounded_by_its_own_angle() {
        let mut points: Vec<Vector> = hexfill_mesh::cube::POSITIONS.map(|p| p.map(f64::from)).to_vec();
        points[6] = [0.5, 0.5, 1.0];
        let mut fixed = vec![true; 8];
        fixed[6] = false;
        let problem = Problem::new(8, vec![[0, 1, 2, 3, 4, 5, 6, 7]], &fixed);
        let all = bounds(&problem, &points);
        assert_eq!(all.len(), 7);
        assert!(all.iter().all(|b| (b.bound - 1.0).abs() < 1e-12 && b.tight));
        points[1] = [1.0, 1.0, 0.0];
        let at_0 = bounds(&problem, &points)[0];
        assert!((at_0.bound - 0.5f64.sqrt()).abs() < 1e-12);
    }
}
