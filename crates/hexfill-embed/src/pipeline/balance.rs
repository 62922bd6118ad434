//! The balanced objective: a good worst condition number at nearly the best worst scaled Jacobian.
//!
//! Source: ours; the condition number is that of Knupp et al. 2006, chapter 7, section Maximum Aspect Frobenius.

use super::one_start::Candidate;
use crate::improvement::{Goal, ProgramLimits, climb};
use crate::options::Options;
use crate::problem::Problem;
use crate::quality::{bad_cells, worst_log_condition};
use hexfill_mesh::{Context, StopReason};
use rayon::prelude::*;

/// A balanced result keeps this share of the optimum.
const BALANCED_SHARE: f64 = 0.95;

/// Candidates balanced at most.
const MOST_BALANCED: usize = 4;

/// Lowers the condition numbers of the good candidates and puts the best first. The first must be valid, and the best so far.
pub(super) fn balance(
    problem: &Problem,
    found: &mut Vec<Candidate>,
    options: &Options,
    context: &Context<'_>,
) -> StopReason {
    let floor = BALANCED_SHARE * found[0].verdict.worst;
    found.retain(|c| c.verdict.is_valid() && c.verdict.worst > floor);
    found.truncate(MOST_BALANCED);
    let quiet = Context { progress: None, ..*context };
    let limits = ProgramLimits { iterations: options.programs, band: 0.1, tolerance: 1e-4 };
    let stops: Vec<Option<StopReason>> =
        found.par_iter_mut().map(|c| balance_one(problem, c, floor, limits, &quiet)).collect();
    found.sort_by(|a, b| {
        let conditions = (worst_log_condition(problem, &a.points), worst_log_condition(problem, &b.points));
        conditions.0.total_cmp(&conditions.1).then(a.number.cmp(&b.number))
    });
    stops.into_iter().flatten().next().unwrap_or(StopReason::Finished)
}

/// Lowers the condition number of a candidate. The optimum is often thin; the way up passes the floor in better shape. Tries both, keeps the better.
fn balance_one(
    problem: &Problem,
    candidate: &mut Candidate,
    floor: f64,
    limits: ProgramLimits,
    context: &Context<'_>,
) -> Option<StopReason> {
    let mut early = candidate.untangled.clone();
    let rise = ProgramLimits { tolerance: 1e-6, ..limits };
    let target = Goal::ScaledJacobian { target: floor + 1e-3 * floor.abs() };
    let up = climb(problem, &mut early, target, rise, context);
    let goal = Goal::Condition { floor };
    let late = climb(problem, &mut candidate.points, goal, limits, context);
    let mut stopped = up.stopped.or(late.stopped);
    if up.scaled_jacobian >= floor && bad_cells(problem, &early).is_empty() {
        stopped = stopped.or(climb(problem, &mut early, goal, limits, context).stopped);
        if worst_log_condition(problem, &early) < worst_log_condition(problem, &candidate.points) {
            std::mem::swap(&mut candidate.points, &mut early);
        }
    }
    stopped
}
