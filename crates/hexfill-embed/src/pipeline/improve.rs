//! Which way the worst scaled Jacobian is raised, by the size of the mesh.
//!
//! Source: ours; the sizes at which ways change were measured (`record/embed-2026-11-21.md`).

use crate::improvement::{
    BarrierLimits, Goal, ProgramLimits, UntangleLimits, climb, climb_worst, follow_worst, is_worst_isolated,
    raise_large, untangle,
};
use crate::options::Options;
use crate::problem::{Incidence, Problem};
use crate::quality::{bad_cells, worst_value};
use hexfill_geometry::Vector;
use hexfill_mesh::{Context, StopReason};

/// Meshes of so many hexes are left to the linear programs.
pub(crate) const SMALL: usize = 100;

/// Meshes of more hexes are raised where they are poor only, however poor that is.
pub(super) const LARGE: usize = 2000;

/// Raises the worst scaled Jacobian of valid cells. Small meshes go by linear programs alone, which follow thin
/// ridges best; larger ones by barriers first, as a program's cost grows faster than the mesh. Says why it was told to stop.
pub(super) fn improve(
    problem: &Problem,
    points: &mut Vec<Vector>,
    target: f64,
    options: &Options,
    context: &Context<'_>,
) -> Option<StopReason> {
    let n_hexes = problem.hexes.len();
    if n_hexes <= SMALL {
        return climb_whole(problem, points, target, options.programs, context);
    }
    // A round judges every cell.
    let rounds = options.programs / 5;
    let by_patches =
        |points: &mut Vec<Vector>| climb_worst(problem, &Incidence::new(problem), points, target, rounds, context);
    let patchy = n_hexes > options.whole_limit && problem.symmetry.is_none();
    if patchy && n_hexes > LARGE {
        return raise_large(problem, points, target, rounds, context);
    }
    if patchy && is_worst_isolated(problem, points) {
        return by_patches(points);
    }
    let stopped = follow_from_two(problem, points, target, options.programs, context);
    if stopped.is_some() {
        return stopped;
    }
    if patchy {
        return by_patches(points);
    }
    climb_whole(problem, points, target, options.programs * SMALL / n_hexes / 2, context)
}

/// Barriers over the whole mesh, from the points as they are and from smoothed ones; the better result is kept.
fn follow_from_two(
    problem: &Problem,
    points: &mut Vec<Vector>,
    target: f64,
    rounds: usize,
    context: &Context<'_>,
) -> Option<StopReason> {
    let limits = BarrierLimits { rounds, iterations: 80 };
    let mut smooth = points.clone();
    let shapes = UntangleLimits { extra_rounds: 4, ..UntangleLimits::new() };
    let stopped = untangle(problem, &mut smooth, shapes, context);
    let stopped = stopped.or_else(|| follow_worst(problem, points, target, limits, context));
    if stopped.is_some() || !bad_cells(problem, &smooth).is_empty() {
        return stopped;
    }
    let stopped = follow_worst(problem, &mut smooth, target, limits, context);
    if worst_value(problem, &smooth) > worst_value(problem, points) {
        *points = smooth;
    }
    stopped
}

/// Linear programs over the whole mesh.
fn climb_whole(
    problem: &Problem,
    points: &mut Vec<Vector>,
    target: f64,
    programs: usize,
    context: &Context<'_>,
) -> Option<StopReason> {
    let limits = ProgramLimits { iterations: programs, band: 0.3, tolerance: 1e-9 };
    climb(problem, points, Goal::ScaledJacobian { target }, limits, context).stopped
}
