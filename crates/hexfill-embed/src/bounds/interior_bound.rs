//! Upper bounds inside a mesh: what the number of corners round an interior vertex or edge allows.
//!
//! In a valid mesh of a surface that does not cross itself the corners at an interior vertex tile the full solid angle, and those
//! round an interior edge the full turn. The largest determinant of three unit vectors that span a solid angle is
//! [`equilateral`], a concave function of the angle, and a determinant is at most the sine of its dihedral angle, which is concave
//! too: so with n corners the worst is at most the value at the n-th part (Jensen). Four hexes at a vertex allow
//! 4 / sqrt(27) = 0.7698, three round an edge sqrt(3) / 2.
//!
//! The first is met at the inner corners of a pillow under a cubed sphere, and there only in the limit of a vanishing star:
//! who does not know this bound shrinks edges without end.
//!
//! Source: ours; that concave functions make equal shares best is Jensen's inequality.

use super::angle_bound::equilateral;
use crate::problem::{FIXED, Problem};
use hexfill_mesh::cube::EDGES;
use std::f64::consts::PI;

/// No embedding has a larger worst scaled Jacobian, whatever its boundary, as long as that does not cross itself. Positive
/// for every proper mesh.
pub(crate) fn interior_bound(problem: &Problem) -> f64 {
    let at_vertices = (0..problem.free.len()).map(|s| equilateral(4.0 * PI / problem.places(s).len() as f64));
    let is_free = |v: u32| problem.slot[v as usize] != FIXED;
    let mut edges: Vec<[u32; 2]> = problem
        .hexes
        .iter()
        .flat_map(|h| EDGES.map(|[i, j]| [h[i].min(h[j]), h[i].max(h[j])]))
        .filter(|&[a, b]| is_free(a) || is_free(b))
        .collect();
    edges.sort_unstable();
    let at_edges = edges.chunk_by(|a, b| a == b).map(|round| (2.0 * PI / round.len() as f64).sin());
    at_vertices.chain(at_edges).fold(1.0, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::samples::grid;
    use hexfill_geometry::{Vector, cross, dot, unit};
    use hexfill_mesh::Random;

    #[test]
    fn no_triangle_beats_the_equilateral_one_and_it_is_concave() {
        let mut random = Random::of_task(23, 0);
        let (mut largest, mut nearest) = (0.0f64, 0.0f64);
        for _ in 0..400_000 {
            let mut direction = || unit(std::array::from_fn(|_| random.signed())).unwrap_or([1.0, 0.0, 0.0]);
            let (a, b, c): (Vector, Vector, Vector) = (direction(), direction(), direction());
            let d = dot(a, cross(b, c));
            if d > 1e-6 {
                let solid = 2.0 * d.atan2(1.0 + dot(a, b) + dot(b, c) + dot(c, a));
                assert!(d <= equilateral(solid) + 1e-12, "{d} {solid}");
                largest = largest.max(solid);
                nearest = nearest.max(d / equilateral(solid));
            }
        }
        assert!(largest > 1.9 * PI && nearest > 0.999, "{largest} {nearest}");
        let step = 1e-3;
        let at = |i: usize| equilateral(step * i as f64);
        for i in 1..(2.0 * PI / step) as usize {
            assert!(at(i - 1) + at(i + 1) <= 2.0 * at(i) + 1e-12, "{i}");
        }
    }

    #[test]
    fn a_grid_allows_everything_and_four_hexes_at_a_vertex_do_not() {
        let mesh = grid(3);
        let problem = Problem::new(64, mesh.hexes_raw(), &mesh.boundary_vertices());
        assert!((interior_bound(&problem) - 1.0).abs() < 1e-12);
        // A cube behind a pillow: its corners have three hexes of the pillow and itself.
        let inner = [0, 1, 2, 3, 4, 5, 6, 7];
        let behind = hexfill_mesh::cube::FACETS.map(|f| {
            let [a, b, c, d] = f.map(|i| i as u32);
            [a, b, c, d, a + 8, b + 8, c + 8, d + 8]
        });
        let mut hexes = vec![inner];
        hexes.extend(behind);
        let fixed: Vec<bool> = (0..16).map(|v| v >= 8).collect();
        let bound = interior_bound(&Problem::new(16, hexes, &fixed));
        assert!((bound - 4.0 / 27f64.sqrt()).abs() < 1e-12, "{bound}");
    }
}
