//! The whole mesh at once: a barrier whose level follows the worst scaled Jacobian upwards.
//!
//! Linear programs ([`super::sequential_programs`]) find the last digits on small meshes but cost much from some hundred hexes on. Here
//! the logarithmic [`Barrier`] is minimised, then its level follows the worst value; the distance to it and the width shrink when nothing is
//! gained (a logarithmic barrier method with a moving constraint: Fiacco and McCormick 1968).
//! Invariant: a step counts only if the worst value over whole cells rises, as judged by bisection, so validity is never traded for corners.
//!
//! Source: Fiacco, McCormick 1968.

use super::barrier::{Barrier, Descent, Penalty};
use super::edge_floors::EdgeFloors;
use crate::problem::Problem;
use crate::quality::{Cells, judge_near_worst};
use hexfill_geometry::Vector;
use hexfill_mesh::{Context, StopReason};

/// How long to try.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BarrierLimits {
    /// Barriers minimised, at most.
    pub(crate) rounds: usize,
    /// L-BFGS iterations for each.
    pub(crate) iterations: usize,
}

/// Cells so far above the worst are not cut into boxes.
const SEEN: f64 = 0.02;

/// Pairs L-BFGS remembers.
const MEMORY: usize = 12;

/// Widths of the barrier, one after the other.
const WIDTHS: [f64; 5] = [0.5, 0.25, 0.12, 0.06, 0.03];

/// Raises the worst scaled Jacobian of `points`, all of whose cells must be valid, until it reaches `target` or the limits.
pub(crate) fn follow_worst(
    problem: &Problem,
    points: &mut Vec<Vector>,
    target: f64,
    limits: BarrierLimits,
    context: &Context<'_>,
) -> Option<StopReason> {
    if problem.n_variables() == 0 {
        return None;
    }
    let mut cells = judge_near_worst(problem, points, 0.0, SEEN);
    let floors = EdgeFloors::new(problem, points);
    let mut inner: Vec<Vec<Vector>> = vec![Vec::new(); problem.hexes.len()];
    let mut level = 0;
    let mut gap = 0.5;
    for round in 0..limits.rounds {
        if let Some(reason) = context.stop() {
            return Some(reason);
        }
        let worst = cells.worst;
        // An invalid cell is outside every barrier: nothing to climb from.
        if worst <= 0.0 || worst >= target {
            return None;
        }
        context.report("optimise", round as u64, Some(limits.rounds as u64), || {
            format!("worst scaled Jacobian {worst:.6}, at best {target:.6}")
        });
        let width = WIDTHS[level];
        // The level stays below the worst by a share of the width, or of the worst itself.
        let barrier = Barrier {
            problem,
            inner: &inner,
            floors: &floors,
            penalty: Penalty::Logarithmic,
            level: worst - gap * width.min(2.0 * worst.max(0.01)),
            width,
        };
        let mut trial = points.clone();
        let descent = Descent { iterations: limits.iterations, memory: MEMORY, restarts: 1 };
        let stopped = barrier.descend(&mut trial, descent, context);
        // The barrier watches corners and a few inner points; only bisection sees the cells whole.
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
    for (cell, list) in cells.each.iter().zip(inner) {
        if cell.value > limit {
            continue;
        }
        for &at in &cell.inner {
            if list.len() < MOST && !list.contains(&at) {
                list.push(at);
                new = true;
            }
        }
    }
    new
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::samples::{grid, grid_points};
    use crate::quality::judge;
    use hexfill_mesh::Random;

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
        follow_worst(&problem, &mut points, 0.99, BarrierLimits { rounds: 60, iterations: 40 }, &Context::default());
        assert!(judge(&problem, &points, 1.0).worst > 0.95);
    }
}
