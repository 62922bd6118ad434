//! [`EdgeFloors`]: what keeps edges from vanishing while scaled Jacobians are raised.
//!
//! A scaled Jacobian does not know lengths, and the best of a star is sometimes reached in the limit of a vanishing one only (four
//! hexes at a vertex behind a pillow, see [`crate::bounds`]), so whoever raises nothing else shrinks edges without end. Here an edge resists once it is
//! shorter than half of the shortest that its vertices had: a barrier, 0 from there on and infinite at a quarter.
//!
//! Source: ours.

use crate::cell::frame::{FRAME_EDGES, Frame};
use crate::problem::{Patch, Problem};
use hexfill_geometry::{Vector, add, norm, scale, sub};

/// Edges resist when they are shorter than this share of the shortest at their vertex was; they never come to half of that.
const RESISTS: f64 = 0.5;

/// Per vertex: the length under which its edges resist; infinite for vertices that do not move.
#[derive(Clone, Debug)]
pub(crate) struct EdgeFloors(Vec<f64>);

impl EdgeFloors {
    /// From the edges as they are.
    pub(crate) fn new(problem: &Problem, points: &[Vector]) -> Self {
        let mut floors = vec![f64::INFINITY; problem.n_vertices];
        for (s, &v) in problem.free.iter().enumerate() {
            floors[v as usize] = RESISTS * problem.shortest_edge_at(s, points);
        }
        Self(floors)
    }

    /// The same, lowered where edges have become short meanwhile, so that none is behind its barrier.
    pub(crate) fn lowered(&self, problem: &Problem, points: &[Vector]) -> Self {
        let now = Self::new(problem, points).0;
        Self(self.0.iter().zip(now).map(|(&floor, now)| floor.min(now / RESISTS)).collect())
    }

    /// Those of the vertices of a part.
    pub(crate) fn of_part(&self, part: &Patch) -> Self {
        Self(part.of_vertices(&self.0))
    }

    /// Adds the barrier of the edges of a hex, and its gradient by corner.
    #[inline]
    pub(crate) fn add(&self, hex: &[u32; 8], frame: &Frame, value: &mut f64, gradient: &mut [Vector; 8]) {
        let floors = hex.map(|v| self.0[v as usize]);
        for (n, [from, to]) in FRAME_EDGES.into_iter().enumerate() {
            let edge = frame.0[n / 4][n % 4];
            let (length, floor) = (norm(edge), floors[from].min(floors[to]));
            if length >= floor || floor == f64::INFINITY {
                continue;
            }
            // (1/2 - z)^2 / (z / 2)
            let z = length / floor - 0.5;
            *value += if z > 0.0 { 0.5 / z - 2.0 + 2.0 * z } else { f64::INFINITY };
            let along = scale((2.0 - 0.5 / (z * z)) / (floor * length), edge);
            gradient[to] = add(gradient[to], along);
            gradient[from] = sub(gradient[from], along);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::Random;
    use hexfill_mesh::cube::POSITIONS;

    #[test]
    fn gradient_matches_differences_and_the_barrier_is_closed() {
        let mut random = Random::of_task(61, 0);
        let hex = std::array::from_fn(|i| i as u32);
        let floors =
            EdgeFloors((0..8).map(|v| if v < 2 { f64::INFINITY } else { 0.9 + 0.5 * random.unit() }).collect());
        let at = |p: &[Vector; 8]| {
            let (mut value, mut gradient) = (0.0, [[0.0; 3]; 8]);
            floors.add(&hex, &Frame::new(p), &mut value, &mut gradient);
            (value, gradient)
        };
        let p = POSITIONS.map(|p| p.map(|x| f64::from(x) + 0.1 * random.signed()));
        let (value, gradient) = at(&p);
        assert!(value > 0.0);
        for corner in 0..8 {
            for k in 0..3 {
                let (mut high, mut low) = (p, p);
                high[corner][k] += 1e-6;
                low[corner][k] -= 1e-6;
                let slope = (at(&high).0 - at(&low).0) / 2e-6;
                let given = gradient[corner][k];
                assert!((slope - given).abs() < 1e-5 * (1.0 + slope.abs()), "{corner} {k} {slope} {given}");
            }
        }
        assert_eq!(at(&POSITIONS.map(|p| p.map(|x| 0.4 * f64::from(x)))).0, f64::INFINITY);
        assert_eq!(at(&POSITIONS.map(|p| p.map(|x| 1.5 * f64::from(x)))).0, 0.0);
    }
}
