//! Linear programs in patches round the worst cells, for meshes too large for one program.
//!
//! Source: ours, with the programs of Madsen 1975.

use super::each_patch::improve_each;
use super::goal::Goal;
use super::sequential_programs::{ProgramLimits, climb};
use crate::problem::{Incidence, Patch, Problem, patches};
use crate::quality::{Cells, judge_near_worst, worst_value};
use hexfill_geometry::Vector;
use hexfill_mesh::{Context, StopReason};

/// Cells in a patch at most when it is to climb, unless it is round a single cell: the programs of larger ones are slow and bring no more.
const CLIMB_CELLS: usize = 200;

/// Cells in a patch round a single cell at most.
const LONE_CELLS: usize = 1200;

/// Variables of all patches of more than [`CLIMB_CELLS`] cells together: enough for a dozen of them. A boundary that holds a cell near
/// its worst value whatever lies round it takes more for each hundredth of it (900 quads at random take 5,600).
const LARGE_VARIABLES: usize = 6000;

/// Whether the worst cells are few: then patches round them are quicker than barriers over the whole mesh.
pub(crate) fn is_worst_isolated(problem: &Problem, points: &[Vector]) -> bool {
    let cells = judge_near_worst(problem, points, 0.0, SEED_BAND);
    let limit = seed_limit(cells.worst);
    50 * cells.each.iter().filter(|c| c.value <= limit).count() <= problem.hexes.len()
}

/// Cells up to this value are taken together with the worst.
fn seed_limit(worst: f64) -> f64 {
    worst + (0.5 * worst).clamp(0.02, SEED_BAND)
}

/// How far above the worst such cells lie at most.
const SEED_BAND: f64 = 0.1;

/// Patches of some rings round the worst cells, with the number of these: those below twice the worst, or the worst few, while the patches stay
/// small. `None` if even the patch round a single cell is large.
fn patches_round_worst(
    problem: &Problem,
    incidence: &Incidence,
    cells: &Cells,
    target: f64,
    rings: usize,
) -> Option<(usize, Vec<Patch>)> {
    let mut order: Vec<usize> = (0..problem.hexes.len()).collect();
    order.sort_by(|&a, &b| cells.each[a].value.total_cmp(&cells.each[b].value).then(a.cmp(&b)));
    let limit = seed_limit(cells.worst).min(target);
    let mut seeds = order.iter().take_while(|&&h| cells.each[h].value <= limit).count().max(1);
    loop {
        let parts = patches(problem, incidence, &order[..seeds], rings);
        let largest = parts.iter().map(|p| p.problem.hexes.len()).max().unwrap_or(0);
        if seeds == 1 && largest > LONE_CELLS {
            return None;
        }
        // The work of a program grows faster than its cells: the worst first, and as many of them as leave patches
        // small.
        if seeds == 1 || largest <= CLIMB_CELLS {
            return Some((seeds, parts));
        }
        seeds = seeds.div_ceil(2);
    }
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
    let (mut stale, mut large_variables) = (0, 0);
    for round in 0..rounds {
        if let Some(reason) = context.stop() {
            return Some(reason);
        }
        let cells = judge_near_worst(problem, points, 0.0, SEED_BAND);
        if cells.worst >= target {
            return None;
        }
        // Where a round gains nothing the next has larger patches: what held the worst cells may lie a ring further
        // out.
        let (seeds, parts) = patches_round_worst(problem, incidence, &cells, target, 1 + stale)?;
        let large = parts.iter().filter(|p| p.problem.hexes.len() > CLIMB_CELLS);
        let wanted = large.map(|p| p.problem.n_variables()).sum::<usize>();
        let is_spent = wanted > 0 && large_variables > LARGE_VARIABLES;
        context.report("optimise patches", round as u64, Some(rounds as u64), || {
            let spent = if is_spent { ", what large patches may cost is spent" } else { "" };
            format!("worst scaled Jacobian {:.6}, {seeds} hexes to be raised{spent}", cells.worst)
        });
        if is_spent {
            return None;
        }
        large_variables += wanted;
        // A patch sees everything its vertices can spoil, so what is better in it is not worse outside.
        improve_each(&parts, points, context, |part, points, context| {
            let limits = ProgramLimits { iterations: 25, band: 0.2, tolerance: 1e-6 };
            climb(&part.problem, points, Goal::ScaledJacobian { target }, limits, context);
        });
        let after = worst_value(problem, points);
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
