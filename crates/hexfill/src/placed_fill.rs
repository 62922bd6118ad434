//! Filling and placing in one: what a user wants is a mesh with valid coordinates.
//!
//! The smallest filling of a small surface often has none. Then more fillings are looked for, and at last the surface is
//! constructed, whose cells were chosen for their coordinates. Nothing is lost: where nothing is certified, the smallest
//! filling stays.

use crate::choose::fill_best;
use crate::components::solids;
use crate::fill::{FillError, FillOptions, FillResult, Filled, Strategy, check_fillable, fill};
use crate::geometry::{Placed, boundary_points, place, place_best, start_positions};
use crate::problem::Problem;
use crate::scale::Scaled;
use hexfill_construct::CellChoice;
use hexfill_mesh::{Context, StopReason};
use std::time::Duration;

/// How to place fillings. By default each is embedded, in bounded work.
#[derive(Clone, Copy, Debug)]
pub struct PlaceOptions {
    /// How to embed; `None`: start positions only, judged only if the cells of the construction are embeddable ones.
    pub embed: Option<hexfill_embed::Options>,
    /// Keep the best of all fillings that were found, not each of them.
    pub best: bool,
    /// How long one embedding may take; with [`best`](Self::best) all of them together.
    pub limit: Option<Duration>,
}

impl Default for PlaceOptions {
    fn default() -> Self {
        Self { embed: Some(hexfill_embed::Options::default()), best: false, limit: None }
    }
}

/// Fillings with their coordinates.
#[derive(Clone, Debug)]
pub struct PlacedFill {
    /// The meshes, fewest hexes first, with positions if the surface has any.
    pub meshes: Vec<(Filled, Option<Placed>)>,
    /// Why the work ended.
    pub stop: StopReason,
    /// What was tried, in words.
    pub tried: Vec<String>,
    /// Why this mesh and no other, if there was a choice.
    pub choice: Option<String>,
}

/// [`fill`], then [`place`]. Where a single mesh is asked for, by any strategy ([`Strategy::Auto`]), and the first does not embed, others are
/// tried.
///
/// # Errors
/// As [`fill`].
pub fn fill_placed(
    problem: &Problem,
    options: &FillOptions,
    how: &PlaceOptions,
    ctx: &Context<'_>,
) -> Result<PlacedFill, FillError> {
    if let Some(scaled) = Scaled::of(problem, options) {
        let mut made = fill_placed(&scaled.problem, &scaled.options, how, ctx)?;
        for (filled, placed) in &mut made.meshes {
            match placed {
                Some(placed) => scaled.restore_placed(filled, placed),
                None => scaled.restore(filled),
            }
        }
        return Ok(made);
    }
    if let (Some(embed), Some(boundary)) = (&how.embed, boundary_points(problem))
        && matches!(options.strategy, Strategy::Auto | Strategy::Shell)
        && options.count == 1
        && !options.improve
        && !how.best
        && solids(&problem.surface, Some(&boundary)).len() == 1
    {
        check_fillable(&problem.surface)?;
        return fill_best(problem, options, how, embed, &boundary, ctx);
    }
    let FillResult { meshes, stop, tried } = fill(problem, options, ctx)?;
    let Some(boundary) = boundary_points(problem).filter(|_| !meshes.is_empty()) else {
        return Ok(PlacedFill { meshes: meshes.into_iter().map(|m| (m, None)).collect(), stop, tried, choice: None });
    };
    let limited = || how.limit.map_or(*ctx, |limit| ctx.with_time_limit(limit));
    let mut choice = None;
    let placed: Vec<(Filled, Placed)> = match &how.embed {
        Some(embed) if how.best => {
            choice = Some(format!("the best of {} meshes", meshes.len()));
            place_best(&meshes, problem, &boundary, embed, &limited()).into_iter().collect()
        }
        embed => meshes
            .into_iter()
            .map(|mut filled| {
                let placed = match embed {
                    None if options.cells == CellChoice::Fewest => start_positions(&filled, &boundary, ctx),
                    embed => place(&mut filled, problem, &boundary, embed.as_ref(), &limited()),
                };
                (filled, placed)
            })
            .collect(),
    };
    let meshes = placed.into_iter().map(|(filled, placed)| (filled, Some(placed))).collect();
    let stop = if stop == StopReason::Finished { ctx.stop().unwrap_or(stop) } else { stop };
    Ok(PlacedFill { meshes, stop, tried, choice })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fill::Route;

    #[test]
    fn a_smallest_filling_without_coordinates_is_left_for_one_with() {
        let problem = Problem::load(":buffer-cube-20", None).unwrap();
        let ctx = Context::default();
        let smallest = fill(&problem, &FillOptions::default(), &ctx).unwrap();
        let made = fill_placed(&problem, &FillOptions::default(), &PlaceOptions::default(), &ctx).unwrap();
        let (filled, placed) = &made.meshes[0];
        assert!(placed.as_ref().unwrap().is_certified(), "{:?}", made.tried);
        assert!(filled.mesh.n_hexes() > smallest.meshes[0].mesh.n_hexes());
        assert!(filled.route != Route::Construction);
    }

    #[test]
    fn a_straight_corner_rules_out_every_mesh() {
        let mut problem = Problem::load(":cube", None).unwrap();
        let points = problem.points.as_mut().unwrap();
        // One corner of the cube onto the line between two of its neighbours.
        let quad = problem.surface.quads()[0];
        let [a, b, c] = [0, 1, 2].map(|k: usize| quad[k].index());
        points[b] = [0, 1, 2].map(|k: usize| 0.5 * (points[a][k] + points[c][k]));
        let made =
            fill_placed(&problem, &FillOptions::default(), &PlaceOptions::default(), &Context::default()).unwrap();
        assert_eq!(made.meshes[0].0.mesh.n_hexes(), 1);
        assert!(!made.meshes[0].1.as_ref().unwrap().is_certified());
        assert!(made.choice.as_ref().is_some_and(|c| c.contains("straight or not convex")), "{:?}", made.choice);
    }
}
