//! `fill`: from a problem to verified meshes. Picks the strategy, and lets nothing out that the judge refused.
//!
//! `options -> component (search, shelled, construct) -> judged -> filled`; solids that lie apart take that way each (`apart`), and what was
//! stopped before there was a mesh is constructed (`last_resort`).
//!
//! Source: ours.

pub(crate) mod apart;
pub(crate) mod attempt;
mod component;
pub(crate) mod construct;
pub(crate) mod error;
pub(crate) mod filled;
pub(crate) mod judged;
pub(crate) mod last_resort;
pub(crate) mod maker;
pub(crate) mod options;
pub(crate) mod scaled;
pub(crate) mod search;
pub(crate) mod shelled;
pub(crate) mod stored;

use crate::problem::Problem;
use crate::problem::solids::solids;
use apart::{fill_apart, lie_apart};
use component::fill_component;
use error::{FillError, check_fillable};
use filled::FillResult;
use hexfill_mesh::Context;
use judged::verify;
use last_resort::LastResort;
use options::FillOptions;
use scaled::Scaled;

/// Fills the surface of a problem. Every mesh returned has passed levels 1 to 3 of the judge, its boundary being the
/// surface. An empty list means: none found within the bounds, which proves nothing.
///
/// Told to stop by the context, it returns the best so far. If there is none, the surface is constructed if the strategy allows it and
/// that takes no more than a second; else the list is empty.
///
/// # Errors
/// [`FillError::NoMesh`] with the theorem and its certificate; [`FillError::NotForStrategy`], [`FillError::Atlas`] and [`FillError::Construct`] if what was asked
/// for cannot be done; [`FillError::Refused`] for a defect of this program. Not to find a mesh, or to be stopped, is no error.
pub fn fill(problem: &Problem, options: &FillOptions, ctx: &Context<'_>) -> Result<FillResult, FillError> {
    check_fillable(&problem.surface)?;
    if let Some(scaled) = Scaled::of(problem, options) {
        let mut result = fill(&scaled.problem, &scaled.options, ctx)?;
        result.meshes.iter_mut().for_each(|filled| scaled.restore(filled));
        return Ok(result);
    }
    let solids = solids(&problem.surface, problem.points.as_deref());
    if lie_apart(&solids, options) {
        let result = fill_apart(problem, &solids, options, ctx)?;
        result.meshes.iter().try_for_each(|m| verify(&problem.surface, &m.mesh, m.route))?;
        return Ok(result);
    }
    let mut result = fill_component(problem, options, ctx)?;
    LastResort::default().fill(problem, options, ctx, &mut result)?;
    Ok(result)
}
