//! One solid: the engines in their order.
//!
//! Source: ours.

use crate::fill::construct::construct;
use crate::fill::error::FillError;
use crate::fill::filled::FillResult;
use crate::fill::judged::accept;
use crate::fill::last_resort::leaving_time;
use crate::fill::options::{FillOptions, Strategy};
use crate::fill::search::search;
use crate::fill::shelled::shelled;
use crate::problem::Problem;
use hexfill_mesh::{Context, StopReason};
use hexfill_search::MAX_QUADS;

/// Fills one component, or several at once where one lies in another. The caller has checked that it is fillable, and turns to the
/// [`LastResort`](crate::fill::last_resort::LastResort) if the work was stopped before there was a mesh.
pub(crate) fn fill_component(
    problem: &Problem,
    options: &FillOptions,
    ctx: &Context<'_>,
) -> Result<FillResult, FillError> {
    let surface = &problem.surface;
    let small = surface.is_sphere() && surface.n_quads() <= MAX_QUADS;
    if options.strategy == Strategy::Atlas && !small {
        return Err(FillError::NotForStrategy {
            what: format!(
                "the atlas fills one sphere of at most {MAX_QUADS} quads; this surface has {} components, genus {}, {} quads",
                surface.n_components(),
                surface.genus(),
                surface.n_quads()
            ),
            remedy: "use --strategy auto or construct",
        });
    }
    let mut result = FillResult::new();
    // Engines before the last one stop a little early: a construction that is stopped is no mesh at all.
    let early = leaving_time(problem, options, ctx);
    let by_atlas = matches!(options.strategy, Strategy::Auto | Strategy::Atlas);
    let by_shelling = matches!(options.strategy, Strategy::Auto | Strategy::Shell);
    if small && by_atlas {
        // What the atlas does not hold is shelled before inward flips have their turn.
        let cavities = if options.strategy == Strategy::Auto && options.count == 1 && !options.improve {
            1
        } else {
            options.inward_cavities
        };
        search(surface, &FillOptions { inward_cavities: cavities, ..options.clone() }, &early, &mut result)?;
    }
    if result.meshes.len() < options.count && by_shelling && early.stop().is_none() {
        for filled in shelled(problem, options, &early, &mut result)? {
            accept(surface, filled, options, &mut result)?;
        }
    }
    if small && result.meshes.is_empty() && options.strategy == Strategy::Auto && early.stop().is_none() {
        search(surface, options, &early, &mut result)?;
    }
    let may_construct = matches!(options.strategy, Strategy::Auto | Strategy::Construct);
    if result.meshes.is_empty() && may_construct && ctx.stop().is_none() {
        construct(problem, options, ctx, &mut result)?;
    }
    if result.stop == StopReason::Finished {
        result.stop = ctx.stop().unwrap_or(StopReason::Finished);
    }
    result.meshes.sort_by_key(|m| m.mesh.n_hexes());
    Ok(result)
}
