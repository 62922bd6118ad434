//! Large meshes: move only what is bad, patch by patch, many patches at a time.
//!
//! Cells that fail are seeds of patches ([`crate::patch`]); each patch is untangled alone with its surroundings held.
//! Patches grow from round to round until nothing fails, and the whole mesh is the last patch. Quality is then raised the
//! same way: the worst cells are seeds, and each patch climbs with its own linear programs.
//! Results of a round are written back in the order of the patches, whatever the threads did.

use crate::lengths::Floors;
use crate::lift;
use crate::maxmin::{self, Goal};
use crate::patch::{Incidence, Patch, patches};
use crate::problem::Problem;
use crate::untangle::{UntangleLimits, bad_cells, untangle};
use crate::vector::Vector;
use hexfill_mesh::{Context, StopReason};
use rayon::prelude::*;

/// Cells in a patch at most when it is to climb: the linear programs of larger ones are slow.
const CLIMB_CELLS: usize = 600;

/// Hexes times iterations that untangling all at once may take, for each energy.
const WHOLE_WORK: usize = 50_000_000;

/// Meshes with more hexes than this get the first energy only.
const ONE_ENERGY: usize = 5000;

/// Untangles where needed. Returns the cells still bad, ascending, and why it stopped.
pub(crate) fn untangle_bad(
    problem: &Problem,
    points: &mut [Vector],
    context: &Context<'_>,
) -> (Vec<usize>, Option<StopReason>) {
    let incidence = Incidence::new(problem);
    let mut bad = bad_cells(problem, points);
    for rings in [0usize, 1, 2, 3, 4, 6, 8, 12] {
        if bad.is_empty() || context.stop().is_some() {
            return (bad, context.stop());
        }
        // What has grown to more than half of the mesh waits for the whole.
        let mut parts = patches(problem, &incidence, &bad, rings);
        parts.retain(|p| 2 * p.problem.hexes.len() <= problem.hexes.len());
        if parts.is_empty() {
            break;
        }
        context.report("untangle patches", rings as u64, None, || {
            format!("{} bad cells, {} patches of {rings} rings", bad.len(), parts.len())
        });
        each(&parts, points, context, |part, points, context| {
            let limits = UntangleLimits { rounds: 60, iterations: 100, extra_rounds: 1, ..UntangleLimits::new() };
            untangle(&part.problem, points, limits, context);
        });
        bad = bad_cells(problem, points);
    }
    match context.stop() {
        None if !bad.is_empty() => untangle_whole(problem, points, context),
        stop => (bad, stop),
    }
}

/// Untangles all at once: shapes only, and if that fails with the volume term, from the same points. Keeps what has
/// fewer bad cells. Returns the cells still bad, ascending, and why it stopped.
pub(crate) fn untangle_whole(
    problem: &Problem,
    points: &mut [Vector],
    context: &Context<'_>,
) -> (Vec<usize>, Option<StopReason>) {
    let start = points.to_vec();
    let mut best: Option<(Vec<usize>, Vec<Vector>)> = None;
    let mut stopped = None;
    // A bound on the work that does not look at the clock: some minutes on the largest meshes.
    let total = (WHOLE_WORK / problem.hexes.len()).max(1000);
    for volume_weight in [0.0, 1.0] {
        let mut trial = start.clone();
        let limits = UntangleLimits { volume_weight, total, ..UntangleLimits::new() };
        let done = untangle(problem, &mut trial, limits, context);
        let bad = bad_cells(problem, &trial);
        stopped = done.stopped;
        if best.as_ref().is_none_or(|(least, _)| bad.len() < least.len()) {
            best = Some((bad, trial));
        }
        let done = best.as_ref().is_some_and(|(bad, _)| bad.is_empty());
        if stopped.is_some() || done || problem.hexes.len() > ONE_ENERGY {
            break;
        }
    }
    let (bad, trial) = best.expect("the loop ran");
    points.copy_from_slice(&trial);
    (bad, stopped)
}

/// Lets the cells of a valid mesh become round, all at once, by one minimisation of the energy of shapes: means of neighbours squeeze
/// what lies along the surface. Nothing changes if that leaves a cell that is not valid.
pub(crate) fn round_shapes(problem: &Problem, points: &mut [Vector], context: &Context<'_>) {
    let mut trial = points.to_vec();
    untangle(problem, &mut trial, UntangleLimits { rounds: 1, ..UntangleLimits::new() }, context);
    if bad_cells(problem, &trial).is_empty() {
        points.copy_from_slice(&trial);
    }
}

/// Solves every patch from the same `points` and writes a result back if it has fewer bad cells, or as many and a
/// better worst cell.
fn each(
    parts: &[Patch],
    points: &mut [Vector],
    context: &Context<'_>,
    work: impl Fn(&Patch, &mut Vec<Vector>, &Context<'_>) + Sync,
) {
    // Progress is reported by the thread that drives the work only.
    let (quiet, before) = (Context { progress: None, ..*context }, &*points);
    let results: Vec<Option<Vec<Vector>>> = parts
        .par_iter()
        .map(|part| {
            let old = part.points(before);
            let mut new = old.clone();
            work(part, &mut new, &quiet);
            let rank = |p: &[Vector]| {
                let bad = bad_cells(&part.problem, p).len();
                (bad, -maxmin::judge_near_worst(&part.problem, p, 0.0, 0.0).worst)
            };
            let (a, b) = (rank(&new), rank(&old));
            (a.0 < b.0 || a.0 == b.0 && a.1 < b.1).then_some(new)
        })
        .collect();
    for (part, result) in parts.iter().zip(results) {
        if let Some(result) = result {
            part.write_back(&result, points);
        }
    }
}

/// Whether the worst cells are few: then patches round them are quicker than barriers over the whole mesh.
pub(crate) fn is_worst_isolated(problem: &Problem, points: &[Vector]) -> bool {
    let cells = maxmin::judge_near_worst(problem, points, 0.0, SEED_BAND);
    let limit = seed_limit(cells.worst);
    50 * cells.each.iter().filter(|c| c.0 <= limit).count() <= problem.hexes.len()
}

/// Cells up to this value are taken together with the worst.
fn seed_limit(worst: f64) -> f64 {
    worst + (0.5 * worst).clamp(0.02, SEED_BAND)
}

/// How far above the worst such cells lie at most.
const SEED_BAND: f64 = 0.1;

/// Turns of barriers and programs in [`raise_large`], and rounds of programs in each.
const TURNS: usize = 3;
const ROUNDS: usize = 4;

/// Raises the worst cells of meshes too large for the ways of small ones. All cells must be valid. The barriers of
/// [`crate::lift`] do nearly all of it; where a few cells hold the rest back, programs in small patches loosen them.
pub(crate) fn raise_large(
    problem: &Problem,
    points: &mut [Vector],
    target: f64,
    context: &Context<'_>,
) -> Option<StopReason> {
    let incidence = Incidence::new(problem);
    let floors = Floors::new(problem, points);
    let mut visits = lift::visits(problem.hexes.len());
    for _ in 0..TURNS {
        let stopped = lift::lift(problem, &incidence, points, &floors, target, &mut visits, context);
        let lifted = maxmin::judge_near_worst(problem, points, 0.0, 0.0).worst;
        let stopped = stopped.or_else(|| climb_worst(problem, &incidence, points, target, ROUNDS, context));
        let climbed = maxmin::judge_near_worst(problem, points, 0.0, 0.0).worst;
        if stopped.is_some() || climbed >= target || climbed < 1.05 * lifted {
            return stopped;
        }
    }
    None
}

/// Raises the cells below a low target only: those that untangling left barely valid.
pub(crate) fn lift_barely_valid(
    problem: &Problem,
    points: &mut [Vector],
    target: f64,
    context: &Context<'_>,
) -> Option<StopReason> {
    let floors = Floors::new(problem, points);
    let mut visits = problem.hexes.len();
    lift::lift(problem, &Incidence::new(problem), points, &floors, target, &mut visits, context)
}

/// Raises the worst cells patch by patch, for meshes too large for one program. All cells must be valid.
pub(crate) fn climb_worst(
    problem: &Problem,
    incidence: &Incidence,
    points: &mut [Vector],
    target: f64,
    rounds: usize,
    context: &Context<'_>,
) -> Option<StopReason> {
    let mut stale = 0;
    for round in 0..rounds {
        if let Some(reason) = context.stop() {
            return Some(reason);
        }
        let cells = maxmin::judge_near_worst(problem, points, 0.0, SEED_BAND);
        if cells.worst >= target {
            return None;
        }
        // The worst cells: those below twice the worst, or the worst few, while the patches stay small.
        let mut order: Vec<usize> = (0..problem.hexes.len()).collect();
        order.sort_by(|&a, &b| cells.each[a].0.total_cmp(&cells.each[b].0).then(a.cmp(&b)));
        let limit = seed_limit(cells.worst).min(target);
        let mut seeds = order.iter().take_while(|&&h| cells.each[h].0 <= limit).count().max(1);
        let rings = 1 + stale;
        let parts = loop {
            let parts = patches(problem, incidence, &order[..seeds], rings);
            if seeds == 1 && parts.iter().any(|p| p.problem.hexes.len() > 2 * CLIMB_CELLS) {
                return None;
            }
            if seeds == 1 || parts.iter().all(|p| p.problem.hexes.len() <= CLIMB_CELLS) {
                break parts;
            }
            seeds = seeds.div_ceil(2);
        };
        context.report("optimise patches", round as u64, Some(rounds as u64), || {
            format!("worst {:.6}, {seeds} cells in {} patches", cells.worst, parts.len())
        });
        each(&parts, points, context, |part, points, context| {
            let limits = maxmin::Limits { iterations: 25, band: 0.2, tolerance: 1e-6 };
            maxmin::climb(&part.problem, points, Goal::ScaledJacobian { target }, limits, context);
        });
        let after = maxmin::judge_near_worst(problem, points, 0.0, 0.0).worst;
        if after < cells.worst + 1e-3 * cells.worst.abs() {
            stale += 1;
            if stale > 2 {
                return None;
            }
        } else {
            stale = 0;
        }
    }
    None
}
