//! A barrier that raises scaled Jacobians: 0 on good cells, infinite at a level.
//!
//! `sum penalty(s - t)` over the corners of all cells, and over the inner points of cells where the worst was seen, keeps every value
//! s above the level t and pulls at those below t + w only, the worst most; so good cells stay where they are. A scaled Jacobian does not know
//! lengths, so short edges have a barrier of their own ([`EdgeFloors`]). L-BFGS minimises (interior-point methods solve max-min problems
//! in this way, the level following the worst value: Fiacco and McCormick 1968).
//!
//! Source: Fiacco, McCormick 1968.

use super::edge_floors::EdgeFloors;
use crate::cell::frame::{CORNER_MIXED, FRAME_EDGES, Frame, MIXED};
use crate::cell::scaled_jacobian::{add_by_corner, columns, scaled, scaled_with_gradient, weights_at};
use crate::problem::Problem;
use crate::solvers::lbfgs::{self, minimise};
use hexfill_geometry::{Vector, add, det, dot, norm, sub};
use hexfill_mesh::cube::CORNER_NEIGHBOURS;
use hexfill_mesh::{Context, StopReason};

/// How a scaled Jacobian pays for being less than a width w above the level, at z = s - t.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Penalty {
    /// `z/w - 1 - ln(z/w)`, with a diagonal that knows lengths of edges only: soft, for whole meshes.
    Logarithmic,
    /// `(w - z)^2 / (w z)`, with the curvature of the corners as the diagonal: steeper, for patches round poor cells.
    Rational,
}

impl Penalty {
    /// Value, slope and curvature at z; all 0 from z = w on, infinite at 0.
    #[inline]
    fn at(self, z: f64, w: f64) -> (f64, f64, f64) {
        if z >= w {
            return (0.0, 0.0, 0.0);
        }
        if z.is_nan() || z <= 0.0 {
            return (f64::INFINITY, 0.0, 0.0);
        }
        match self {
            Self::Logarithmic => {
                let y = z / w;
                (y - 1.0 - y.ln(), (1.0 - 1.0 / y) / w, 1.0 / (z * z))
            }
            Self::Rational => (w / z - 2.0 + z / w, 1.0 / w - w / (z * z), 2.0 * w / (z * z * z)),
        }
    }

    /// The corners of a hex in the order in which their terms are added up, which the last bits of sums depend on.
    fn corners(self) -> &'static [Corner; 8] {
        match self {
            Self::Logarithmic => &OUTWARD,
            Self::Rational => &ALONG_AXES,
        }
    }
}

/// The three edges at a corner, right-handed, as (from, to) and as numbers in [`FRAME_EDGES`].
#[derive(Clone, Copy)]
struct Corner {
    ends: [[usize; 2]; 3],
    edges: [usize; 3],
}

/// The edges of each corner, from it.
const OUTWARD: [Corner; 8] = {
    let mut table = [Corner { ends: [[0; 2]; 3], edges: [0; 3] }; 8];
    let mut c = 0;
    while c < 8 {
        let mut k = 0;
        while k < 3 {
            let (end, mut e) = (CORNER_NEIGHBOURS[c][k], 0);
            while !(FRAME_EDGES[e][0] == c && FRAME_EDGES[e][1] == end
                || FRAME_EDGES[e][0] == end && FRAME_EDGES[e][1] == c)
            {
                e += 1;
            }
            table[c].ends[k] = [c, end];
            table[c].edges[k] = e;
            k += 1;
        }
        c += 1;
    }
    table
};

/// The edges of each corner along the axes.
const ALONG_AXES: [Corner; 8] = {
    let mut table = [Corner { ends: [[0; 2]; 3], edges: [0; 3] }; 8];
    let mut c = 0;
    while c < 8 {
        let mut d = 0;
        while d < 3 {
            let e = 4 * d + MIXED[CORNER_MIXED[c]].edges[d];
            table[c].ends[d] = FRAME_EDGES[e];
            table[c].edges[d] = e;
            d += 1;
        }
        c += 1;
    }
    table
};

/// See the module page.
pub(crate) struct Barrier<'a> {
    pub(crate) problem: &'a Problem,
    /// Per hex: the inner points watched, in the unit cube.
    pub(crate) inner: &'a [Vec<Vector>],
    pub(crate) floors: &'a EdgeFloors,
    pub(crate) penalty: Penalty,
    /// Where the barrier is infinite.
    pub(crate) level: f64,
    /// How far above the level it ends.
    pub(crate) width: f64,
}

/// How far to descend.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Descent {
    /// L-BFGS iterations between two diagonals.
    pub(crate) iterations: usize,
    /// Pairs L-BFGS remembers.
    pub(crate) memory: usize,
    /// Diagonals taken.
    pub(crate) restarts: usize,
}

/// The barrier of a hex, and its gradient by corner.
type Term = (f64, [Vector; 8]);

impl Barrier<'_> {
    /// Moves `points`, which must lie inside the barrier, down it: until it is 0 or hardly falls, or the work is spent. Says why it was told to stop.
    pub(crate) fn descend(&self, points: &mut [Vector], descent: Descent, context: &Context<'_>) -> Option<StopReason> {
        let problem = self.problem;
        let mut x = problem.gather(points);
        let mut rows: Vec<Term> = vec![(0.0, [[0.0; 3]; 8]); problem.hexes.len()];
        let Descent { iterations, memory, restarts } = descent;
        let limits = lbfgs::Limits { iterations, relative_decrease: 1e-3, memory };
        let mut stopped = None;
        for _ in 0..restarts {
            // Anew after every restart: near the barrier curvatures change by orders of magnitude on the way down,
            // and pairs remembered from before mislead.
            let diagonal = self.inverse_diagonal(points);
            let before = rows.iter().map(|row| row.0).sum::<f64>();
            // Each hex writes its own row and each variable sums its rows in a fixed order, so that threads do not
            // change a bit of the gradient.
            let found = minimise(
                &mut x,
                &diagonal,
                limits,
                |x, gradient| {
                    problem.scatter(x, points);
                    let at = &*points;
                    problem.map_hexes(&mut rows, |h| self.hex(h, at));
                    problem.sum_at_variables(&rows, gradient);
                    rows.iter().map(|row| row.0).sum()
                },
                |_, value| {
                    stopped = context.stop();
                    stopped.is_some() || value <= 0.0
                },
            );
            problem.scatter(&x, points);
            let little = before > 0.0 && found.value > 0.98 * before;
            if found.value <= 0.0 || little || stopped.is_some() {
                break;
            }
        }
        stopped
    }

    /// The barrier of one hex and its gradient by corner; infinite outside the domain.
    fn hex(&self, hex: usize, points: &[Vector]) -> Term {
        let p = self.problem.corners_of(hex, points);
        let mut value = 0.0;
        let mut gradient = [[0.0; 3]; 8];
        let frame = Frame::new(&p);
        self.floors.add(&self.problem.hexes[hex], &frame, &mut value, &mut gradient);
        // Twelve edges serve eight corners: each length is taken once.
        let inverse_length = frame.0.map(|d| d.map(|e| 1.0 / norm(e)));
        let end = self.level + self.width;
        for Corner { ends, edges } in self.penalty.corners() {
            let c = ends.map(|[from, to]| sub(p[to], p[from]));
            let [i, j, k] = edges.map(|e| inverse_length[e / 4][e % 4]);
            // Most corners are good and end here, without roots; the margin is for rounding.
            if det(c[0], c[1], c[2]) * (i * j * k) >= end + 1e-12 {
                continue;
            }
            // An edge of no length has no direction: outside the domain, and the line search comes back from there.
            let Some((s, g)) = scaled_with_gradient(&c) else { return (f64::INFINITY, gradient) };
            let (v, slope, _) = self.penalty.at(s - self.level, self.width);
            value += v;
            if slope != 0.0 {
                for (g, &[from, to]) in g.iter().zip(ends) {
                    for x in 0..3 {
                        gradient[to][x] += slope * g[x];
                        gradient[from][x] -= slope * g[x];
                    }
                }
            }
        }
        // Inside a cell a value may be below those at all corners; points where that was seen are kept above the
        // level as well.
        for &at in &self.inner[hex] {
            let weights = weights_at(at);
            let Some((s, g)) = scaled_with_gradient(&columns(&p, &weights)) else { return (f64::INFINITY, gradient) };
            let (v, slope, _) = self.penalty.at(s - self.level, self.width);
            value += v;
            if slope != 0.0 {
                add_by_corner(&mut gradient, &weights, slope, &g);
            }
        }
        (value, gradient)
    }

    /// The first inverse Hessian of L-BFGS, by variable.
    fn inverse_diagonal(&self, points: &[Vector]) -> Vec<f64> {
        let problem = self.problem;
        if self.penalty == Penalty::Logarithmic {
            // A scaled Jacobian changes by about one over a move of one edge.
            return problem.by_variable(|s| {
                let shortest = problem.shortest_edge_at(s, points);
                0.01 * self.width * shortest * shortest
            });
        }
        let mut at_corners = vec![[0.0; 8]; problem.hexes.len()];
        problem.map_hexes(&mut at_corners, |h| self.curvature(&problem.corners_of(h, points)));
        problem.by_variable(|s| {
            let sum =
                problem.places(s).iter().map(|&place| at_corners[place as usize / 8][place as usize % 8]).sum::<f64>();
            // Where nothing pulls: a corner that moves by about one over an edge.
            let shortest = problem.shortest_edge_at(s, points);
            1.0 / (sum + 1.0 / (self.width * shortest * shortest).max(1e-300))
        })
    }

    /// The Gauss-Newton curvature of the corners of a hex by corner, a mean over directions. It spans many orders of magnitude.
    fn curvature(&self, p: &[Vector; 8]) -> [f64; 8] {
        let mut sum = [0.0; 8];
        for (corner, ends) in CORNER_NEIGHBOURS.iter().enumerate() {
            let c = ends.map(|n| sub(p[n], p[corner]));
            if scaled(&c) >= self.level + self.width {
                continue;
            }
            let Some((s, g)) = scaled_with_gradient(&c) else { continue };
            let (_, _, curvature) = self.penalty.at(s - self.level, self.width);
            if curvature > 0.0 {
                for (g, &end) in g.iter().zip(ends) {
                    sum[end] += curvature * dot(*g, *g) / 3.0;
                }
                // The corner itself moves all three edges at once, against the directions of their ends.
                let own = g.iter().fold([0.0; 3], |s, &g| add(s, g));
                sum[corner] += curvature * dot(own, own) / 3.0;
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::samples::{grid, grid_points};
    use hexfill_mesh::Random;

    const BOTH: [Penalty; 2] = [Penalty::Logarithmic, Penalty::Rational];

    #[test]
    fn gradient_matches_differences_and_the_barrier_is_closed() {
        let mesh = grid(2);
        let problem = Problem::new(27, mesh.hexes_raw(), &mesh.boundary_vertices());
        let inner = vec![vec![[0.5, 0.25, 0.5]]; 8];
        let floors = EdgeFloors::new(&problem, &grid_points(2));
        for penalty in BOTH {
            let barrier =
                Barrier { problem: &problem, inner: &inner, floors: &floors, penalty, level: 0.1, width: 0.9 };
            let mut random = Random::of_task(51, 0);
            let mut points = grid_points(2);
            points[13] = std::array::from_fn(|k| points[13][k] + 0.4 * random.signed());
            let total = |points: &[Vector]| (0..8).map(|h| barrier.hex(h, points).0).sum::<f64>();
            let mut gradient = vec![0.0; 3];
            let rows: Vec<_> = (0..8).map(|h| barrier.hex(h, &points)).collect();
            problem.sum_at_variables(&rows, &mut gradient);
            for k in 0..3 {
                let (mut high, mut low) = (points.clone(), points.clone());
                high[13][k] += 1e-6;
                low[13][k] -= 1e-6;
                let slope = (total(&high) - total(&low)) / 2e-6;
                assert!((slope - gradient[k]).abs() < 1e-5 * (1.0 + slope.abs()), "{slope} {}", gradient[k]);
            }
            // The middle vertex far outside.
            points[13] = [5.0, 0.0, 0.0];
            assert_eq!(total(&points), f64::INFINITY);
        }
    }

    #[test]
    fn penalties_end_smoothly_and_know_their_curvature() {
        for penalty in BOTH {
            assert_eq!(penalty.at(0.3, 0.3), (0.0, 0.0, 0.0));
            assert_eq!(penalty.at(-0.1, 0.3).0, f64::INFINITY);
            let (value, slope, _) = penalty.at(0.3 - 1e-9, 0.3);
            assert!(value < 1e-14 && slope.abs() < 1e-6);
            for z in [0.01, 0.1, 0.25] {
                let (high, low) = (penalty.at(z + 1e-7, 0.3), penalty.at(z - 1e-7, 0.3));
                let (_, slope, curvature) = penalty.at(z, 0.3);
                assert!(((high.0 - low.0) / 2e-7 - slope).abs() < 1e-4 * (1.0 + slope.abs()));
                assert!(((high.1 - low.1) / 2e-7 - curvature).abs() < 1e-4 * (1.0 + curvature.abs()));
            }
        }
    }

    #[test]
    fn both_tables_of_corners_are_right_handed() {
        let p = hexfill_mesh::cube::POSITIONS.map(|p| p.map(f64::from));
        for corner in OUTWARD.iter().chain(&ALONG_AXES) {
            let [a, b, c] = corner.ends.map(|[from, to]| sub(p[to], p[from]));
            assert_eq!(det(a, b, c), 1.0);
            for (ends, e) in corner.ends.iter().zip(corner.edges) {
                assert!(FRAME_EDGES[e] == *ends || FRAME_EDGES[e] == [ends[1], ends[0]]);
            }
        }
    }

    #[test]
    fn edges_that_are_too_short_resist() {
        let mesh = grid(2);
        let problem = Problem::new(27, mesh.hexes_raw(), &mesh.boundary_vertices());
        let mut points = grid_points(2);
        let floors = EdgeFloors::new(&problem, &points.iter().map(|p| p.map(|x| 2.5 * x)).collect::<Vec<_>>());
        let inner = vec![Vec::new(); 8];
        let barrier = Barrier {
            problem: &problem,
            inner: &inner,
            floors: &floors,
            penalty: Penalty::Rational,
            level: 0.1,
            width: 0.9,
        };
        let mut closed = |p: Vector| {
            points[13] = p;
            (0..8).map(|h| barrier.hex(h, &points).0).sum::<f64>() == f64::INFINITY
        };
        // Valid, but with an edge too short.
        assert!(closed([1.0, 1.0, 0.3]) && !closed([1.0, 1.0, 0.8]));
    }
}
