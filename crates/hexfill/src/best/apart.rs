//! Solids that lie apart: the best mesh of each, side by side.
//!
//! Source: ours.

use crate::best::choice::Choice;
use crate::best::{PlaceOptions, PlacedFill, fill_placed};
use crate::fill::apart::{SideBySide, of_component, problem_of};
use crate::fill::error::FillError;
use crate::fill::judged::verify;
use crate::fill::last_resort::GRACE;
use crate::fill::options::FillOptions;
use crate::place::placed::Placed;
use crate::problem::Problem;
use hexfill_mesh::{Context, StopReason};
use std::time::Instant;

/// Fills each solid as if it were the only one. All or nothing: a solid left empty is no mesh of the surface.
pub(super) fn fill_best_apart(
    problem: &Problem,
    solids: &[Vec<usize>],
    options: &FillOptions,
    how: &PlaceOptions,
    boundary: &[[f64; 3]],
    ctx: &Context<'_>,
) -> Result<PlacedFill, FillError> {
    let one = FillOptions { growth_log: None, ..options.clone() };
    let mut whole = SideBySide::new(problem);
    let mut all = PlacedFill { meshes: Vec::new(), stop: StopReason::Finished, tried: Vec::new(), choice: None };
    let mut said = Choice::default();
    let mut quads_left = problem.surface.n_quads();
    let mut overtime = None;
    for (c, solid) in solids.iter().enumerate() {
        // After a stop each solid left is constructed, as long as all of them together take a moment.
        if let Some(stop) = ctx.stop()
            && Instant::now() > *overtime.get_or_insert_with(|| Instant::now() + GRACE)
        {
            all.stop = stop;
            return Ok(all);
        }
        let (part, vertices) = problem_of(problem, c, solid)?;
        // Of the time that is left each has its share, or the first would take it all.
        let n_quads = part.surface.n_quads();
        let share = n_quads as f64 / quads_left as f64;
        let left = ctx.deadline.map(|end| end.saturating_duration_since(Instant::now()));
        let ctx = left.map_or(*ctx, |left| ctx.with_time_limit(left.mul_f64(share)));
        quads_left -= n_quads;
        let made = fill_placed(&part, &one, how, &ctx)?;
        all.tried.extend(of_component(c, made.tried));
        if all.stop == StopReason::Finished {
            all.stop = made.stop;
        }
        let Some((filled, placed)) = made.meshes.into_iter().next() else { return Ok(all) };
        whole.add(&filled, &vertices, placed.as_ref().map(Placed::points));
        if let Some(choice) = made.choice {
            said.components.push((c, choice));
        }
    }
    let mut filled = whole.into_filled();
    if filled.mesh.n_hexes() as u64 > u64::from(options.max_hexes) {
        return Ok(all);
    }
    verify(&problem.surface, &filled.mesh, filled.route)?;
    let points = filled.start.take().unwrap_or_default();
    let placed = Placed::judged(&filled.mesh, boundary, points, None, None);
    all.meshes.push((filled, Some(placed)));
    all.choice = (!said.is_empty()).then_some(said);
    Ok(all)
}
