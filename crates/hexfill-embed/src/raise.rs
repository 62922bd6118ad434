//! Raises the worst scaled Jacobian of meshes of any size by smooth barriers.
//!
//! Linear programs ([`crate::maxmin`]) find the last digits on small meshes but cost much from some hundred hexes on. Here
//! `sum psi((s - t) / w)` over the corners (and the inner points of cells where the worst was seen) is minimised by L-BFGS, with
//! `psi(z) = z - 1 - ln z` below 1 and 0 above: a barrier that keeps every value above t and acts on those below t + w only, so
//! good cells stay where they are. Edges that have become short have a barrier of their own ([`crate::lengths`]). Then t follows
//! the worst value upwards; the distance to it and the width shrink when nothing is gained. A step counts only if the worst
//! value over whole cells rises, as judged by bisection, so validity is never traded for corners.

use crate::jacobian::{Frame, add_by_corner, columns, scaled_with_gradient, weights_at};
use crate::lbfgs::{self, minimise};
use crate::lengths::Floors;
use crate::maxmin::{Cells, judge_near_worst};
use crate::problem::Problem;
use crate::vector::{Vector, sub};
use hexfill_mesh::cube::CORNER_NEIGHBOURS;
use hexfill_mesh::{Context, StopReason};

/// How long to try.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// Barriers minimised, at most.
    pub(crate) rounds: usize,
    /// L-BFGS iterations for each.
    pub(crate) iterations: usize,
}

/// Cells so far above the worst are not cut into boxes.
const SEEN: f64 = 0.02;

/// Widths of the barrier, one after the other.
const WIDTHS: [f64; 5] = [0.5, 0.25, 0.12, 0.06, 0.03];

/// Raises the worst scaled Jacobian of `points`, all of whose cells must be valid, until it reaches `target` or the limits.
pub(crate) fn raise(
    problem: &Problem,
    points: &mut Vec<Vector>,
    target: f64,
    limits: Limits,
    context: &Context<'_>,
) -> Option<StopReason> {
    if problem.n_variables() == 0 {
        return None;
    }
    let mut cells = judge_near_worst(problem, points, 0.0, SEEN);
    let floors = Floors::new(problem, points);
    let mut inner: Vec<Vec<Vector>> = vec![Vec::new(); problem.hexes.len()];
    let mut level = 0;
    let mut gap = 0.5;
    for round in 0..limits.rounds {
        if let Some(reason) = context.stop() {
            return Some(reason);
        }
        let worst = cells.worst;
        if worst <= 0.0 || worst >= target {
            return None;
        }
        context.report("optimise", round as u64, Some(limits.rounds as u64), || {
            format!("worst scaled Jacobian {worst:.6}, width {}, gap {gap:.3}", WIDTHS[level])
        });
        let width = WIDTHS[level];
        // t stays below the worst by a share of the width, or of the worst itself.
        let barrier = Barrier {
            problem,
            inner: &inner,
            floors: &floors,
            t: worst - gap * width.min(2.0 * worst.max(0.01)),
            width,
        };
        let mut trial = points.clone();
        let stopped = barrier.descend(&mut trial, limits.iterations, context);
        let trial_cells = judge_near_worst(problem, &trial, worst, SEEN);
        let gain = trial_cells.worst - worst;
        if gain > 0.0 {
            *points = trial;
            cells = trial_cells;
        } else if note_inner(&trial_cells, worst, &mut inner) {
            // A cell went bad where no row watched: watch, and try again.
            continue;
        }
        if stopped.is_some() {
            return stopped;
        }
        if gain < 0.02 * cells.worst.abs().max(1e-3) {
            if level + 1 < WIDTHS.len() {
                level += 1;
            } else if gap > 0.05 {
                gap *= 0.4;
            } else {
                return None;
            }
        }
    }
    None
}

/// Adds the inner points where cells are worst and below `limit`. Returns whether any is new.
fn note_inner(cells: &Cells, limit: f64, inner: &mut [Vec<Vector>]) -> bool {
    const MOST: usize = 16;
    let mut new = false;
    for ((worst, seen), list) in cells.each.iter().zip(inner) {
        if *worst > limit {
            continue;
        }
        for &at in seen {
            if list.len() < MOST && !list.contains(&at) {
                list.push(at);
                new = true;
            }
        }
    }
    new
}

struct Barrier<'a> {
    problem: &'a Problem,
    inner: &'a [Vec<Vector>],
    floors: &'a Floors,
    t: f64,
    width: f64,
}

impl Barrier<'_> {
    fn descend(&self, points: &mut [Vector], iterations: usize, context: &Context<'_>) -> Option<StopReason> {
        let problem = self.problem;
        let mut x = problem.gather(points);
        let mut rows = vec![(0.0, [[0.0; 3]; 8]); problem.hexes.len()];
        let diagonal = self.inverse_diagonal(points);
        let work = lbfgs::Limits { iterations, relative_decrease: 1e-3, memory: 12 };
        let mut stopped = None;
        minimise(
            &mut x,
            &diagonal,
            work,
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
        stopped
    }

    /// The barrier of one hex and its gradient by corner; infinite outside the domain.
    fn hex(&self, hex: usize, points: &[Vector]) -> (f64, [Vector; 8]) {
        let p = self.problem.corners_of(hex, points);
        let mut value = 0.0;
        let mut gradient = [[0.0; 3]; 8];
        self.floors.add(&self.problem.hexes[hex], &Frame::new(&p), &mut value, &mut gradient);
        let mut psi = |s: f64| {
            let z = (s - self.t) / self.width;
            if z >= 1.0 {
                return 0.0;
            }
            value += if z > 0.0 { z - 1.0 - z.ln() } else { f64::INFINITY };
            (1.0 - 1.0 / z) / self.width
        };
        for (corner, ends) in CORNER_NEIGHBOURS.iter().enumerate() {
            let c = ends.map(|n| sub(p[n], p[corner]));
            let Some((s, g)) = scaled_with_gradient(&c) else { return (f64::INFINITY, gradient) };
            let slope = psi(s);
            if slope != 0.0 {
                for (g, &end) in g.iter().zip(ends) {
                    for k in 0..3 {
                        gradient[end][k] += slope * g[k];
                        gradient[corner][k] -= slope * g[k];
                    }
                }
            }
        }
        for &at in &self.inner[hex] {
            let weights = weights_at(at);
            let Some((s, g)) = scaled_with_gradient(&columns(&p, &weights)) else { return (f64::INFINITY, gradient) };
            let slope = psi(s);
            if slope != 0.0 {
                add_by_corner(&mut gradient, &weights, slope, &g);
            }
        }
        (value, gradient)
    }

    /// A scaled Jacobian changes by about one over a move of one edge.
    fn inverse_diagonal(&self, points: &[Vector]) -> Vec<f64> {
        let problem = self.problem;
        problem.by_variable(|s| {
            let shortest = problem.shortest_edge_at(s, points);
            0.01 * self.width * shortest * shortest
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maxmin::judge;
    use crate::samples::{check_barrier, grid, grid_points};
    use hexfill_mesh::Random;

    #[test]
    fn gradient_matches_differences_and_the_barrier_is_closed() {
        check_barrier(|problem, inner, h, points| {
            let floors = Floors::new(problem, &grid_points(2));
            Barrier { problem, inner, floors: &floors, t: 0.1, width: 0.9 }.hex(h, points)
        });
    }

    #[test]
    fn a_skew_grid_is_raised_to_nearly_perfect() {
        let n = 4usize;
        let mesh = grid(n);
        let fixed = mesh.boundary_vertices();
        let problem = Problem::new(fixed.len(), mesh.hexes_raw(), &fixed);
        let mut random = Random::of_task(52, 0);
        let mut points = grid_points(n);
        for (p, _) in points.iter_mut().zip(&fixed).filter(|(_, is_fixed)| !**is_fixed) {
            *p = p.map(|x| x + 0.3 * random.signed());
        }
        let before = judge(&problem, &points, 1.0).worst;
        assert!(before > 0.0 && before < 0.6, "{before}");
        raise(&problem, &mut points, 0.99, Limits { rounds: 60, iterations: 40 }, &Context::default());
        assert!(judge(&problem, &points, 1.0).worst > 0.95);
    }
}
