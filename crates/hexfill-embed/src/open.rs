//! Untangling a mesh that is not closed yet: hexes and the void they leave, held open by pyramids.
//!
//! Over each quad of the front stands a pyramid with one apex inside the void, and the four corners at its base take part in the energy. So the front
//! stays star-shaped seen from the apex: a pillow by scaling towards it is valid, and whatever is laid next finds room. The apex is held.
//!
//! Source: ours, with the energy of Garanzha et al. 2021.

use crate::cell::bisection::Sign;
use crate::cell::frame::{BOTTOM_CORNERS, Frame, MIXED};
use crate::improvement::{UntangleLimits, untangle};
use crate::problem::Problem;
use crate::quality::WORKING_BOXES;
use crate::starts::{Weights, place_at_means};
use hexfill_geometry::{Vector, det};
use hexfill_mesh::Context;

/// Hexes laid, the front of the void they leave (quads counter-clockwise seen from outside of the void), and a point inside it.
#[derive(Clone, Copy, Debug)]
pub struct Open<'a> {
    /// The hexes.
    pub hexes: &'a [[u32; 8]],
    /// The front.
    pub front: &'a [[u32; 4]],
    /// The point inside the void.
    pub apex: Vector,
}

/// How long to try.
#[derive(Clone, Copy, Debug)]
pub struct OpenEffort {
    /// Rounds of the untangler.
    pub rounds: usize,
    /// Iterations in each.
    pub iterations: usize,
    /// Rounds to go on once all is positive.
    pub extra: usize,
}

/// Positions to begin with: the surface's as given, all other vertices and the apex at the means of their neighbours along edges, pyramids included
/// (graph Laplacian). Cells may well be inverted. Returns all points, those of the surface first, and the apex.
pub fn open_start(
    hexes: &[[u32; 8]],
    front: &[[u32; 4]],
    n_vertices: usize,
    surface: &[Vector],
) -> (Vec<Vector>, Vector) {
    let apex = n_vertices as u32;
    let cells = hexes.iter().copied().chain(front.iter().map(|q| pyramid(q, apex))).collect();
    let fixed: Vec<bool> = (0..=n_vertices).map(|v| v < surface.len()).collect();
    let problem = Problem::new(n_vertices + 1, cells, &fixed);
    let mut points = surface.to_vec();
    points.resize(n_vertices + 1, [0.0; 3]);
    place_at_means(&problem, &mut points, Weights::Unit, false, &Context::default());
    let apex = points.pop().unwrap_or_default();
    (points, apex)
}

/// A pyramid over a quad of the front, as a hex whose top is one point.
fn pyramid(&[a, b, c, d]: &[u32; 4], apex: u32) -> [u32; 8] {
    [a, d, c, b, apex, apex, apex, apex]
}

impl Open<'_> {
    /// Moves the vertices marked in `free` (one flag a point). Returns how many of the hexes and of the pyramids at free vertices are not valid.
    pub fn untangle(
        &self,
        free: &[bool],
        points: &mut Vec<Vector>,
        effort: OpenEffort,
        context: &Context<'_>,
    ) -> [usize; 2] {
        let is_near = |cell: &[u32; 8]| cell.iter().any(|&v| free.get(v as usize) == Some(&true));
        let mut cells: Vec<[u32; 8]> = self.hexes.iter().copied().filter(is_near).collect();
        let n = cells.len();
        let a = points.len() as u32;
        cells.extend(self.front.iter().map(|q| pyramid(q, a)).filter(is_near));
        let fixed: Vec<bool> = free.iter().map(|f| !f).chain([true]).collect();
        points.push(self.apex);
        let mut problem = Problem::new(points.len(), cells, &fixed);
        problem.first_pyramid = n;
        let OpenEffort { rounds, iterations, extra } = effort;
        let limits = UntangleLimits { rounds, iterations, extra_rounds: extra, ..UntangleLimits::new() };
        untangle(&problem, points, limits, context);
        let frame = |h: usize| Frame::new(&problem.corners_of(h, points));
        let bad_hexes = (0..n).filter(|&h| frame(h).sign(WORKING_BOXES) != Sign::Positive).count();
        let bad_pyramids = (n..problem.hexes.len()).filter(|&h| is_flat(&frame(h))).count();
        points.pop();
        [bad_hexes, bad_pyramids]
    }
}

/// Whether a pyramid has a corner at its base that is not positive.
fn is_flat(frame: &Frame) -> bool {
    (0..64).filter(|n| BOTTOM_CORNERS >> n & 1 == 1).any(|n| {
        let [a, b, c] = MIXED[n].edges;
        det(frame.0[0][a], frame.0[1][b], frame.0[2][c]) <= 0.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::cube::FACETS;
    use hexfill_mesh::cube::POSITIONS;

    const EFFORT: OpenEffort = OpenEffort { rounds: 50, iterations: 100, extra: 0 };

    /// A cube with a pillow under its facets: hexes, the inner front, positions with the inner cube shrunk to `size` and turned inside out if negative.
    fn pillowed(size: f64) -> (Vec<[u32; 8]>, Vec<[u32; 4]>, Vec<Vector>) {
        let outer: Vec<Vector> = POSITIONS.iter().map(|p| p.map(|x| 2.0 * f64::from(x) - 1.0)).collect();
        let points = outer.iter().copied().chain(outer.iter().map(|p| p.map(|x| size * x))).collect();
        let facets = FACETS.map(|f| f.map(|i| i as u32));
        let hexes = facets.map(|[a, b, c, d]| [a + 8, b + 8, c + 8, d + 8, a, b, c, d]).to_vec();
        (hexes, facets.map(|f| f.map(|v| v + 8)).to_vec(), points)
    }

    fn free() -> Vec<bool> {
        (0..16).map(|v| v >= 8).collect()
    }

    #[test]
    fn a_front_inside_out_is_put_right_and_the_rest_stays() {
        for size in [-0.4, -0.01, 1.5] {
            let (hexes, front, mut points) = pillowed(size);
            let before = points.clone();
            let open = Open { hexes: &hexes, front: &front, apex: [0.1, 0.0, -0.1] };
            let judge = OpenEffort { rounds: 0, iterations: 0, extra: 0 };
            assert_ne!(open.untangle(&free(), &mut points, judge, &Context::default()), [0, 0]);
            assert_eq!(points, before, "no rounds, no change");
            assert_eq!(open.untangle(&free(), &mut points, EFFORT, &Context::default()), [0, 0], "{size}");
            assert_eq!((&points[..8], points.len()), (&before[..8], 16));
        }
    }

    #[test]
    fn a_start_keeps_the_surface_and_has_the_rest_at_means() {
        let (hexes, front, given) = pillowed(0.5);
        let (points, apex) = open_start(&hexes, &front, 16, &given[..8]);
        assert_eq!(points[..8], given[..8]);
        // A vertex of the inner cube has one neighbour outside, three inside, and the apex: by symmetry x = (1 + x) / 5.
        for (p, q) in points[8..].iter().zip(&given[..8]) {
            assert!((0..3).all(|k| (p[k] - q[k] / 4.0).abs() < 1e-9), "{p:?}");
        }
        assert!(apex.iter().all(|x| x.abs() < 1e-9));
    }

    #[test]
    fn a_front_that_turns_its_back_to_the_apex_is_seen() {
        let (hexes, front, mut points) = pillowed(0.5);
        // The apex outside of the void: some pyramids are inside out, while all hexes are right.
        let open = Open { hexes: &hexes, front: &front, apex: [0.9, 0.0, 0.0] };
        let judge = OpenEffort { rounds: 0, iterations: 0, extra: 0 };
        assert_eq!(open.untangle(&free(), &mut points, judge, &Context::default()), [0, 1]);
        // Moved there, it is inside.
        assert_eq!(open.untangle(&free(), &mut points, EFFORT, &Context::default()), [0, 0]);
    }
}
