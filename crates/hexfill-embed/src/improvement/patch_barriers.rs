//! All poor cells of a mesh of any size at once, and nothing else: barriers on patches, the level lifted.
//!
//! A level tau is set a little above the worst scaled Jacobian. Cells below it are seeds of patches ([`patches`]), and in each
//! patch the rational [`Barrier`] is minimised, infinite at a share of the patch's worst value and 0 from tau on: so a patch ends where its
//! cells are good, and the patches are independent. A patch is written back only if its worst value over
//! whole cells rose, as judged by bisection. Then tau is raised, as long as the worst value follows. All bounds are counts, so
//! the result does not depend on the machine or the threads; the work is about linear in the number of poor cells.
//!
//! Source: ours, with the barriers of Fiacco, McCormick 1968.

use super::barrier::{Barrier, Descent, Penalty};
use super::edge_floors::EdgeFloors;
use crate::problem::{Incidence, Patch, Problem, patches};
use crate::quality::{WorstOfCell, judge, worst_value};
use hexfill_geometry::Vector;
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

/// The work on a patch at one level.
const DESCENT: Descent = Descent { iterations: 30, memory: 10, restarts: 3 };

/// A level ends so far beyond the target, in units of it: what is aimed at is reached in the limit only.
const BEYOND: f64 = 5e-4;

/// Inner points watched in a cell at most.
const WATCHED: usize = 16;

/// How many cells may be worked on, over all passes.
pub(crate) fn visits(n_hexes: usize) -> usize {
    VISITS + n_hexes
}

/// How far a level is above the worst value, and how far patches grow round the cells below it.
struct Pace {
    /// In units of the worst value.
    reach: f64,
    rings: usize,
}

impl Pace {
    /// The level above `worst`, not far beyond `target`.
    fn level(&self, worst: f64, target: f64) -> f64 {
        (worst + self.reach * worst.max(LEAST_REACH)).min(target + BEYOND * target.abs())
    }

    /// Halves the reach; false if it is narrow enough.
    fn narrow(&mut self) -> bool {
        let wide = self.reach > NARROWEST;
        self.reach *= 0.5;
        wide
    }

    /// What to do after the worst value rose by `gain` when `asked` was aimed at; patches may grow if `may_grow`. False if nothing is left to try.
    fn learn(&mut self, gain: f64, asked: f64, may_grow: bool) -> bool {
        if gain < 0.2 * asked {
            if self.rings < 2 && may_grow {
                self.rings += 1;
                return true;
            }
            self.rings = 1;
            return self.narrow();
        }
        if gain > 0.8 * asked {
            self.reach = (1.5 * self.reach).min(1.0);
        }
        true
    }
}

/// Raises the poor cells of `points`, all of which must be valid, until the worst reaches `target` or stays behind. At most `visits` cells are
/// worked on, which is lowered by what was.
pub(crate) fn lift_poor_cells(
    problem: &Problem,
    incidence: &Incidence,
    points: &mut [Vector],
    floors: &EdgeFloors,
    target: f64,
    visits: &mut usize,
    context: &Context<'_>,
) -> Option<StopReason> {
    let n_hexes = problem.hexes.len();
    let floors = floors.lowered(problem, points);
    let mut pace = Pace { reach: 1.0, rings: 1 };
    let mut worst = worst_value(problem, points);
    for pass in 0..PASSES {
        if let Some(reason) = context.stop() {
            return Some(reason);
        }
        if worst <= 0.0 || worst >= target {
            return None;
        }
        let tau = pace.level(worst, target);
        let cells = judge(problem, points, tau);
        // Patches are disjoint and their outer cells good, where the barrier is flat: so they can be worked on at
        // once and put together.
        let seeds: Vec<usize> = (0..n_hexes).filter(|&h| cells.each[h].value < tau).collect();
        let parts = patches(problem, incidence, &seeds, pace.rings);
        let size: usize = parts.iter().map(|part| part.problem.hexes.len()).sum();
        context.report("lift", pass as u64, None, || {
            format!("worst scaled Jacobian {worst:.6}, {} hexes to be lifted above {tau:.4}", seeds.len())
        });
        // A bound on work and not on time, or the result would depend on the machine.
        if size > *visits {
            if !pace.narrow() {
                return None;
            }
            continue;
        }
        *visits -= size;
        lift_patches(&parts, points, &floors, tau, context);
        let after = worst_value(problem, points);
        let (gain, asked) = (after - worst, tau - worst);
        worst = after;
        if !pace.learn(gain, asked, 3 * size < n_hexes) {
            return None;
        }
    }
    None
}

/// Lifts every patch from the same points; the results are written back in the order of the patches, whatever the threads did.
fn lift_patches(parts: &[Patch], points: &mut [Vector], floors: &EdgeFloors, tau: f64, context: &Context<'_>) {
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
}

/// Lifts one patch; `None` if its worst cell did not get better.
fn lift_patch(
    part: &Patch,
    points: Vec<Vector>,
    floors: &EdgeFloors,
    tau: f64,
    context: &Context<'_>,
) -> Option<Vec<Vector>> {
    let problem = &part.problem;
    let before = judge(problem, &points, tau);
    if before.worst <= 0.0 || problem.n_variables() == 0 {
        return None;
    }
    let mut inner: Vec<Vec<Vector>> = before.each.iter().map(|c| watched(c, tau)).collect();
    // First with room below the worst, for large moves; a level close to it pulls at the worst cell alone.
    for share in [0.5, 0.8, 0.95] {
        if context.stop().is_some() {
            break;
        }
        let mut trial = points.clone();
        let (level, penalty) = (share * before.worst, Penalty::Rational);
        Barrier { problem, inner: &inner, floors, penalty, level, width: tau - level }
            .descend(&mut trial, DESCENT, context);
        let after = judge(problem, &trial, tau);
        // Better than before in whole cells is all that counts; the first share that gives it ends the work on this
        // patch.
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
fn watched(cell: &WorstOfCell, tau: f64) -> Vec<Vector> {
    if cell.value < tau { cell.inner.clone() } else { Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::samples::{grid, grid_points};

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
        let lengths = EdgeFloors::new(&problem, &points);
        lift_poor_cells(&problem, &incidence, &mut points, &lengths, 0.9, &mut left, &Context::default());
        let after = judge(&problem, &points, 1.0).worst;
        assert!(after > 0.7, "{before} {after}");
        assert!(left > visits(problem.hexes.len()) / 2);
        let far = |p: &Vector| p.iter().any(|&x| x > 9.0);
        assert!(exact.iter().zip(&points).all(|(a, b)| !far(a) || a == b));
    }
}
