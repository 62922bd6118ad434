//! Meshes too large for the ways of small ones: barriers on patches do nearly all, and programs in small patches loosen what holds them back.
//!
//! Source: ours; measured in `record/embed-2026-11-21.md`.

use super::edge_floors::EdgeFloors;
use super::patch_barriers::{lift_poor_cells, visits};
use super::patch_programs::climb_worst;
use crate::problem::{Incidence, Problem};
use crate::quality::worst_value;
use hexfill_geometry::Vector;
use hexfill_mesh::{Context, StopReason};

/// Turns of barriers and programs in [`raise_large`], and most rounds of programs in each.
const TURNS: usize = 3;
const ROUNDS: usize = 4;

/// Raises the worst cells to `target`, as far as that goes, by at most so many `rounds` of programs in each turn. All cells must be valid. Says why it was told to stop.
pub(crate) fn raise_large(
    problem: &Problem,
    points: &mut [Vector],
    target: f64,
    rounds: usize,
    context: &Context<'_>,
) -> Option<StopReason> {
    let incidence = Incidence::new(problem);
    let floors = EdgeFloors::new(problem, points);
    let mut left = visits(problem.hexes.len());
    for _ in 0..TURNS {
        let stopped = lift_poor_cells(problem, &incidence, points, &floors, target, &mut left, context);
        let lifted = worst_value(problem, points);
        let stopped = stopped.or_else(|| climb_worst(problem, &incidence, points, target, rounds.min(ROUNDS), context));
        let climbed = worst_value(problem, points);
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
    let floors = EdgeFloors::new(problem, points);
    let mut visits = problem.hexes.len();
    lift_poor_cells(problem, &Incidence::new(problem), points, &floors, target, &mut visits, context)
}
