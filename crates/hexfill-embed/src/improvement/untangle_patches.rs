//! Untangling of meshes of any size: patch by patch where bad cells are few, else all at once.
//!
//! Cells that fail are seeds of patches; each patch is untangled alone with its surroundings held.
//! Patches grow from round to round until nothing fails, and the whole mesh is the last patch.
//!
//! Source: ours, with the energy of Garanzha et al. 2021.

use super::each_patch::improve_each;
use super::smoothing::smooth;
use super::untangle::{UntangleLimits, is_hopeless, untangle};
use crate::problem::{Incidence, Problem, patches};
use crate::quality::bad_cells;
use hexfill_geometry::Vector;
use hexfill_mesh::{Context, StopReason};

/// Hexes times iterations that untangling all at once may take, for each energy.
const WHOLE_WORK: usize = 50_000_000;

/// Meshes with more hexes than this get the first energy only.
const ONE_ENERGY: usize = 5000;

/// On meshes of more hexes than this neither energy goes on where it is hopeless: some seconds each, in vain.
const COSTLY: usize = 800;
/// Rounds after which that shows.
const LATE: usize = 20;

/// In meshes with more hexes than this noise is smoothed away before anything is untangled,
const SMOOTHED: usize = 20_000;
/// if more than one cell of so many is bad,
const NOISY: usize = 20;
/// by so many sweeps, if they leave one bad cell of so many.
const SWEEPS: usize = 10;
const LEFT: usize = 4;

/// Smooths `points` if that leaves few of the bad cells. Returns the cells bad now, ascending. Where bad cells are everywhere, patches round them are the
/// whole mesh, and untangling that is slow; noise in a good mesh is gone after some sweeps, and patches do the rest.
fn smooth_away(problem: &Problem, points: &mut [Vector], bad: Vec<usize>) -> Vec<usize> {
    let mut trial = points.to_vec();
    smooth(problem, &mut trial, SWEEPS);
    let left = bad_cells(problem, &trial);
    if LEFT * left.len() > bad.len() {
        return bad;
    }
    points.copy_from_slice(&trial);
    left
}

/// Untangles where needed. Returns the cells still bad, ascending, and why it stopped.
pub(crate) fn untangle_bad(
    problem: &Problem,
    points: &mut [Vector],
    context: &Context<'_>,
) -> (Vec<usize>, Option<StopReason>) {
    let mut bad = bad_cells(problem, points);
    if problem.hexes.len() > SMOOTHED && NOISY * bad.len() > problem.hexes.len() {
        bad = smooth_away(problem, points, bad);
    }
    bad = untangle_rings(problem, points, bad, &[0, 1, 2, 3, 4, 6, 8, 12], context);
    match context.stop() {
        None if !bad.is_empty() => untangle_all(problem, points, context),
        stop => (bad, stop),
    }
}

/// Untangles patches of so many rings round the cells that are bad, one number of rings after the other. Returns the cells still bad, ascending.
pub(crate) fn untangle_rings(
    problem: &Problem,
    points: &mut [Vector],
    mut bad: Vec<usize>,
    rings: &[usize],
    context: &Context<'_>,
) -> Vec<usize> {
    let incidence = Incidence::new(problem);
    for &rings in rings {
        if bad.is_empty() || context.stop().is_some() {
            break;
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
        improve_each(&parts, points, context, |part, points, context| {
            let limits = UntangleLimits { rounds: 60, iterations: 100, extra_rounds: 1, ..UntangleLimits::new() };
            untangle(&part.problem, points, limits, context);
        });
        bad = bad_cells(problem, points);
    }
    bad
}

/// Untangles all at once, with a bound on the work that does not look at the clock: some minutes on the largest meshes.
pub(crate) fn untangle_all(
    problem: &Problem,
    points: &mut [Vector],
    context: &Context<'_>,
) -> (Vec<usize>, Option<StopReason>) {
    untangle_whole(problem, points, (WHOLE_WORK / problem.hexes.len()).max(1000), context)
}

/// Untangles all at once by at most so many iterations for each energy: shapes only, and if that fails with the volume term, from the same points.
/// Keeps what has fewer bad cells. Returns the cells still bad, ascending, and why it stopped.
pub(crate) fn untangle_whole(
    problem: &Problem,
    points: &mut [Vector],
    total: usize,
    context: &Context<'_>,
) -> (Vec<usize>, Option<StopReason>) {
    let start = points.to_vec();
    let is_costly = problem.hexes.len() > COSTLY;
    let late = if is_costly { LATE } else { usize::MAX };
    let mut best: Option<(Vec<usize>, Vec<Vector>)> = None;
    let mut stopped = None;
    for volume_weight in [0.0, 1.0] {
        let mut trial = start.clone();
        let limits = UntangleLimits { volume_weight, total, late, ..UntangleLimits::new() };
        stopped = untangle(problem, &mut trial, limits, context);
        let bad = bad_cells(problem, &trial);
        if best.as_ref().is_none_or(|(least, _)| bad.len() < least.len()) {
            best = Some((bad, trial));
        }
        let is_done = |bad: &[usize]| bad.is_empty() || is_costly && is_hopeless(bad.len(), problem);
        if stopped.is_some() || best.as_ref().is_some_and(|(bad, _)| is_done(bad)) || problem.hexes.len() > ONE_ENERGY {
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
