//! Lifts all poor cells of a mesh of any size at once, and touches nothing else.
//!
//! A level tau is set a little above the worst scaled Jacobian. Cells below it are seeds of patches ([`crate::patch`]), and in each
//! patch `sum phi(s - t)` over the corners (and the inner points of cells where the worst was seen) is minimised by L-BFGS, where
//! `phi(z) = (h - z)^2 / (h z)` below `h = tau - t` and 0 above, and t is a share of the patch's worst value: a barrier at t that
//! pulls at every cell below tau, the worst most, and is 0 elsewhere, so a patch ends where its cells are good and the
//! patches are independent. A scaled Jacobian does not know lengths, and may have its optimum in the limit of a vanishing
//! star only: so edges that have become short have a barrier of their own ([`crate::lengths`]). A patch is written back only if its worst value over
//! whole cells rose, as judged by bisection. Then tau is raised, as long as the worst value follows. All bounds are counts, so
//! the result does not depend on the machine or the threads; the work is about linear in the number of poor cells.

use crate::jacobian::{
    CORNER_MIXED, FRAME_EDGES, Frame, MIXED, add_by_corner, columns, scaled, scaled_with_gradient, weights_at,
};
use crate::lbfgs::{self, minimise};
use crate::lengths::Floors;
use crate::maxmin::{judge, judge_near_worst};
use crate::patch::{Incidence, Patch, patches};
use crate::problem::Problem;
use crate::vector::{Vector, add, det, dot, norm, sub};
use hexfill_mesh::cube::CORNER_NEIGHBOURS;
use hexfill_mesh::{Context, StopReason};
use rayon::prelude::*;

/// Passes at most.
const PASSES: usize = 60;

/// Cells that may be worked on in all, and each cell of the mesh once on top of it.
const VISITS: usize = 250_000;

/// The reach of a level is in units of the worst value, but of this where that is less.
const LEAST_REACH: f64 = 0.02;

/// The reach ends here.
const NARROWEST: f64 = 0.06;

/// L-BFGS iterations between two preconditioners, and how many of these a patch gets.
const ITERATIONS: usize = 30;
const RESTARTS: usize = 3;

/// A level ends so far beyond the target, in units of it: what is aimed at is reached in the limit only.
const BEYOND: f64 = 5e-4;

/// Inner points watched in a cell at most.
const WATCHED: usize = 16;

/// How many cells may be worked on, over all passes.
pub(crate) fn visits(n_hexes: usize) -> usize {
    VISITS + n_hexes
}

/// Raises the poor cells of `points`, all of which must be valid, until the worst reaches `target` or stays behind.
pub(crate) fn lift(
    problem: &Problem,
    incidence: &Incidence,
    points: &mut [Vector],
    floors: &Floors,
    target: f64,
    visits: &mut usize,
    context: &Context<'_>,
) -> Option<StopReason> {
    let n_hexes = problem.hexes.len();
    let floors = floors.lowered(problem, points);
    // In units of the worst value.
    let mut reach = 1.0;
    let mut rings = 1;
    let mut worst = judge_near_worst(problem, points, 0.0, 0.0).worst;
    for pass in 0..PASSES {
        if let Some(reason) = context.stop() {
            return Some(reason);
        }
        if worst <= 0.0 || worst >= target {
            return None;
        }
        let tau = (worst + reach * worst.max(LEAST_REACH)).min(target + BEYOND * target.abs());
        let cells = judge(problem, points, tau);
        let seeds: Vec<usize> = (0..n_hexes).filter(|&h| cells.each[h].0 < tau).collect();
        let parts = patches(problem, incidence, &seeds, rings);
        let size: usize = parts.iter().map(|part| part.problem.hexes.len()).sum();
        context.report("lift", pass as u64, None, || {
            format!("worst {worst:.6}, {} cells below {tau:.4}, {} patches of {size} cells", seeds.len(), parts.len())
        });
        if size > *visits {
            if reach <= NARROWEST {
                return None;
            }
            reach *= 0.5;
            continue;
        }
        *visits -= size;
        let quiet = Context { progress: None, ..*context };
        let before = &*points;
        let better: Vec<Option<Vec<Vector>>> = parts
            .par_iter()
            .map(|part| lift_patch(part, part.points(before), &floors.of_part(part), tau, &quiet))
            .collect();
        for (part, better) in parts.iter().zip(better) {
            if let Some(better) = better {
                part.write_back(&better, points);
            }
        }
        let after = judge_near_worst(problem, points, 0.0, 0.0).worst;
        let (gain, asked) = (after - worst, tau - worst);
        worst = after;
        if gain < 0.2 * asked {
            if rings < 2 && 3 * size < n_hexes {
                rings += 1;
                continue;
            }
            if reach <= NARROWEST {
                return None;
            }
            rings = 1;
            reach *= 0.5;
        } else if gain > 0.8 * asked {
            reach = (1.5 * reach).min(1.0);
        }
    }
    None
}

/// Lifts one patch; `None` if its worst cell did not get better.
fn lift_patch(
    part: &Patch,
    points: Vec<Vector>,
    floors: &Floors,
    tau: f64,
    context: &Context<'_>,
) -> Option<Vec<Vector>> {
    let problem = &part.problem;
    let before = judge(problem, &points, tau);
    if before.worst <= 0.0 || problem.n_variables() == 0 {
        return None;
    }
    let mut inner: Vec<Vec<Vector>> = before.each.iter().map(|c| watched(c, tau)).collect();
    for share in [0.5, 0.8, 0.95] {
        if context.stop().is_some() {
            break;
        }
        let mut trial = points.clone();
        let t = share * before.worst;
        Barrier { problem, inner: &inner, floors, t, height: tau - t }.descend(&mut trial, context);
        let after = judge(problem, &trial, tau);
        if after.worst > before.worst {
            return Some(trial);
        }
        for (list, cell) in inner.iter_mut().zip(&after.each) {
            for at in watched(cell, tau) {
                if list.len() < WATCHED && !list.contains(&at) {
                    list.push(at);
                }
            }
        }
    }
    None
}

/// The inner points of a poor cell.
fn watched((worst, seen): &(f64, Vec<Vector>), tau: f64) -> Vec<Vector> {
    if *worst < tau { seen.clone() } else { Vec::new() }
}

struct Barrier<'a> {
    problem: &'a Problem,
    inner: &'a [Vec<Vector>],
    floors: &'a Floors,
    /// Where the barrier is infinite.
    t: f64,
    /// How far above t it ends.
    height: f64,
}

impl Barrier<'_> {
    fn descend(&self, points: &mut [Vector], context: &Context<'_>) {
        let problem = self.problem;
        let mut x = problem.gather(points);
        let mut rows = vec![(0.0, [[0.0; 3]; 8]); problem.hexes.len()];
        let limits = lbfgs::Limits { iterations: ITERATIONS, relative_decrease: 1e-3, memory: 10 };
        for _ in 0..RESTARTS {
            let diagonal = self.inverse_diagonal(points);
            let before = rows.iter().map(|row| row.0).sum::<f64>();
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
                |_, value| value <= 0.0 || context.stop().is_some(),
            );
            problem.scatter(&x, points);
            let little = before > 0.0 && found.value > 0.98 * before;
            if found.value <= 0.0 || little || context.stop().is_some() {
                break;
            }
        }
    }

    /// Value, slope and curvature at a scaled Jacobian.
    #[inline]
    fn phi(&self, s: f64) -> (f64, f64, f64) {
        let (z, h) = (s - self.t, self.height);
        if z >= h {
            (0.0, 0.0, 0.0)
        } else if z > 0.0 {
            (h / z - 2.0 + z / h, 1.0 / h - h / (z * z), 2.0 * h / (z * z * z))
        } else {
            (f64::INFINITY, 0.0, 0.0)
        }
    }

    /// The barrier of one hex and its gradient by corner; infinite outside the domain.
    fn hex(&self, hex: usize, points: &[Vector]) -> (f64, [Vector; 8]) {
        let p = self.problem.corners_of(hex, points);
        let mut value = 0.0;
        let mut gradient = [[0.0; 3]; 8];
        let frame = Frame::new(&p);
        self.floors.add(&self.problem.hexes[hex], &frame, &mut value, &mut gradient);
        let frame = frame.0;
        let inverse = frame.map(|d| d.map(|e| 1.0 / norm(e)));
        for n in CORNER_MIXED {
            let [i, j, k] = MIXED[n].edges;
            let c = [frame[0][i], frame[1][j], frame[2][k]];
            let s = det(c[0], c[1], c[2]) * (inverse[0][i] * inverse[1][j] * inverse[2][k]);
            if s >= self.t + self.height {
                continue;
            }
            let Some((s, g)) = scaled_with_gradient(&c) else { return (f64::INFINITY, gradient) };
            let (v, slope, _) = self.phi(s);
            value += v;
            for (d, edge) in [i, j, k].into_iter().enumerate() {
                let [from, to] = FRAME_EDGES[4 * d + edge];
                for x in 0..3 {
                    gradient[to][x] += slope * g[d][x];
                    gradient[from][x] -= slope * g[d][x];
                }
            }
        }
        for &at in &self.inner[hex] {
            let weights = weights_at(at);
            let Some((s, g)) = scaled_with_gradient(&columns(&p, &weights)) else { return (f64::INFINITY, gradient) };
            let (v, slope, _) = self.phi(s);
            value += v;
            if slope != 0.0 {
                add_by_corner(&mut gradient, &weights, slope, &g);
            }
        }
        (value, gradient)
    }

    /// The Gauss-Newton curvature of the corners at each vertex, which spans many orders of magnitude; where nothing pulls, that of
    /// a corner that moves by about one over an edge.
    fn inverse_diagonal(&self, points: &[Vector]) -> Vec<f64> {
        let problem = self.problem;
        let mut at_corners = vec![[0.0; 8]; problem.hexes.len()];
        problem.map_hexes(&mut at_corners, |h| {
            let p = problem.corners_of(h, points);
            let mut sum = [0.0; 8];
            for (corner, ends) in CORNER_NEIGHBOURS.iter().enumerate() {
                let c = ends.map(|n| sub(p[n], p[corner]));
                if scaled(&c) >= self.t + self.height {
                    continue;
                }
                let Some((s, g)) = scaled_with_gradient(&c) else { continue };
                let (_, _, curvature) = self.phi(s);
                if curvature > 0.0 {
                    for (g, &end) in g.iter().zip(ends) {
                        sum[end] += curvature * dot(*g, *g) / 3.0;
                    }
                    let own = g.iter().fold([0.0; 3], |s, &g| add(s, g));
                    sum[corner] += curvature * dot(own, own) / 3.0;
                }
            }
            sum
        });
        problem.by_variable(|s| {
            let sum =
                problem.places(s).iter().map(|&place| at_corners[place as usize / 8][place as usize % 8]).sum::<f64>();
            let shortest = problem.shortest_edge_at(s, points);
            1.0 / (sum + 1.0 / (self.height * shortest * shortest).max(1e-300))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{check_barrier, grid, grid_points};

    #[test]
    fn gradient_matches_differences_and_the_barrier_is_closed() {
        check_barrier(|problem, inner, h, points| {
            let floors = Floors::new(problem, &grid_points(2));
            Barrier { problem, inner, floors: &floors, t: 0.1, height: 0.9 }.hex(h, points)
        });
    }

    #[test]
    fn edges_that_are_too_short_resist() {
        let mesh = grid(2);
        let problem = Problem::new(27, mesh.hexes_raw(), &mesh.boundary_vertices());
        let mut points = grid_points(2);
        let floors = Floors::new(&problem, &points.iter().map(|p| p.map(|x| 2.5 * x)).collect::<Vec<_>>());
        let inner = vec![Vec::new(); 8];
        let barrier = Barrier { problem: &problem, inner: &inner, floors: &floors, t: 0.1, height: 0.9 };
        let mut closed = |p: Vector| {
            points[13] = p;
            (0..8).map(|h| barrier.hex(h, &points).0).sum::<f64>() == f64::INFINITY
        };
        // Valid, but with an edge too short.
        assert!(closed([1.0, 1.0, 0.3]) && !closed([1.0, 1.0, 0.8]));
    }

    #[test]
    fn poor_cells_are_lifted_and_the_rest_stays_where_it_is() {
        let n = 12usize;
        let mesh = grid(n);
        let fixed = mesh.boundary_vertices();
        let problem = Problem::new(fixed.len(), mesh.hexes_raw(), &fixed);
        let side = n + 1;
        let exact = grid_points(n);
        let mut points = exact.clone();
        let moved = 3 + side * (3 + side * 3);
        points[moved] = [3.35, 3.3, 2.75];
        let before = judge(&problem, &points, 1.0).worst;
        assert!(before > 0.0 && before < 0.4, "{before}");
        let incidence = Incidence::new(&problem);
        let mut left = visits(problem.hexes.len());
        let lengths = Floors::new(&problem, &points);
        lift(&problem, &incidence, &mut points, &lengths, 0.9, &mut left, &Context::default());
        let after = judge(&problem, &points, 1.0).worst;
        assert!(after > 0.7, "{before} {after}");
        assert!(left > visits(problem.hexes.len()) / 2);
        let far = |p: &Vector| p.iter().any(|&x| x > 9.0);
        assert!(exact.iter().zip(&points).all(|(a, b)| !far(a) || a == b));
    }
}
