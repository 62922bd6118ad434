//! What a stopped fill still owes: a mesh. Where none was found in time the surface is constructed, which takes next to no time unless it is
//! large.
//!
//! Source: ours.

use crate::fill::attempt::Attempt;
use crate::fill::construct::construct;
use crate::fill::error::FillError;
use crate::fill::filled::FillResult;
use crate::fill::options::{FillOptions, Strategy};
use crate::problem::Problem;
use hexfill_construct::CellChoice;
use hexfill_mesh::Context;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How long after the stop constructions may take, those of all components together.
pub(crate) const GRACE: Duration = Duration::from_secs(1);

/// Constructions of surfaces with more quads may take longer. With a deadline, engines that may find nothing leave some time to them.
const LARGE: usize = 2000;

/// This share of the time that is left.
const LEFT_TO_OTHERS: f64 = 0.25;

/// The context of engines that may find nothing.
pub(crate) fn leaving_time<'a>(problem: &Problem, options: &FillOptions, ctx: &Context<'a>) -> Context<'a> {
    let may_construct = options.strategy == Strategy::Auto && !options.improve;
    match ctx.deadline {
        Some(end) if may_construct && problem.surface.n_quads() > LARGE => {
            let left = end.saturating_duration_since(Instant::now());
            ctx.with_time_limit(left.mul_f64(1.0 - LEFT_TO_OTHERS))
        }
        _ => *ctx,
    }
}

/// Constructions after a stop, which share the time they have.
#[derive(Default)]
pub(crate) struct LastResort {
    end: Option<Instant>,
}

impl LastResort {
    /// Constructs a surface whose filling was stopped before there was a mesh. With the cells that were asked for if that takes at most
    /// half of the time; those with the fewest hexes are several times faster. Without a mesh at last the stop is a clean one.
    ///
    /// # Errors
    /// [`FillError::Refused`].
    pub(crate) fn fill(
        &mut self,
        problem: &Problem,
        options: &FillOptions,
        ctx: &Context<'_>,
        result: &mut FillResult,
    ) -> Result<(), FillError> {
        let may_construct = matches!(options.strategy, Strategy::Auto | Strategy::Construct);
        let Some(stop) = ctx.stop().filter(|_| may_construct && result.meshes.is_empty()) else { return Ok(()) };
        let now = Instant::now();
        let end = *self.end.get_or_insert(now + GRACE);
        let half = now + end.saturating_duration_since(now) / 2;
        for (cells, deadline) in [(options.cells, half), (CellChoice::Fewest, end)] {
            let quick = FillOptions { cells, count: 1, simplify: None, ..options.clone() };
            let still = Context { cancel: None, deadline: Some(deadline), ..*ctx };
            match construct(problem, &quick, &still, result) {
                // Another engine might have filled what cannot be constructed.
                Err(FillError::Construct(why)) => {
                    result.tried.push(Attempt::NoConstruction(Arc::new(why)));
                    break;
                }
                made => made?,
            }
            if !result.meshes.is_empty() {
                break;
            }
        }
        result.stop = stop;
        Ok(())
    }
}
