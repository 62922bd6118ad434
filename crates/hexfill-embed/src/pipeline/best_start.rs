//! Several starts, and the best of them with its report.
//!
//! Starts run in batches whose sizes do not depend on the threads, and the best start is chosen by its [`Verdict`] and
//! then by number, so the result does not depend on them either.
//!
//! Source: ours.
//!
//! [`Verdict`]: crate::quality::Verdict

use super::assess::assess;
use super::balance::balance;
use super::improve::LARGE;
use super::normal::Normal;
use super::one_start::{Candidate, Work};
use crate::bounds::{Star, StarBound, interior_bound, least_bound, refine_stars, star_bounds_of};
use crate::options::{Objective, Options};
use crate::report::{EmbedReport, Embedding, is_impossible};
use hexfill_geometry::Vector;
use hexfill_mesh::{Context, StopReason};
use rayon::prelude::*;

/// Starts tried at once after the first.
const BATCH: u32 = 4;

/// Large meshes are raised to this share of their upper bound: the last digits of a bound take most of the time.
const ENOUGH: f64 = 0.995;

/// Nothing is gained so near the upper bound.
pub(crate) const NEAR_OPTIMUM: f64 = 1e-8;

/// Looks for positions from all starts and reports on the best.
pub(crate) fn run(normal: &Normal, start: Option<&[Vector]>, options: &Options, context: &Context<'_>) -> Embedding {
    let start = start.map(|s| normal.with_start(s));
    let work = Work { normal, start: start.as_deref(), options };
    let mut bounds = Bounds::new(normal);
    let outcome = best(&work, &mut bounds, context);
    if outcome.valid_starts == 0 || options.objective != Objective::UntangleOnly {
        bounds.refine(&outcome.candidate.points, context);
    }
    report(&work, bounds, outcome)
}

/// The upper bounds of a mesh.
struct Bounds {
    stars: Vec<Star>,
    /// The bound by interior vertices and edges.
    inside: f64,
    /// Whether the stars count corners with several free edges.
    refined: bool,
    /// The least of them all.
    least: f64,
    n_hexes: usize,
}

impl Bounds {
    fn new(normal: &Normal) -> Self {
        let stars = star_bounds_of(&normal.problem, &normal.points);
        let inside = interior_bound(&normal.problem);
        let least = least_bound(&stars).min(inside);
        Self { stars, inside, refined: false, least, n_hexes: normal.problem.hexes.len() }
    }

    /// Sharpens the star bounds, once.
    fn refine(&mut self, hint: &[Vector], context: &Context<'_>) {
        if !std::mem::replace(&mut self.refined, true) {
            refine_stars(&mut self.stars, hint, context);
            self.least = least_bound(&self.stars).min(self.inside);
        }
    }

    /// The worst scaled Jacobian that is strived for.
    fn target(&self) -> f64 {
        if self.n_hexes > LARGE { ENOUGH * self.least } else { self.least - 1e-9 }
    }

    fn is_met_by(&self, value: f64) -> bool {
        value >= self.least - NEAR_OPTIMUM
    }
}

/// What the starts came to.
struct Outcome {
    /// The best.
    candidate: Candidate,
    starts: u32,
    valid_starts: u32,
    stop: StopReason,
}

/// How many starts there may be; see [`Options::starts`].
fn most_starts(work: &Work<'_>) -> u32 {
    match (work.options.starts, work.normal.problem.hexes.len()) {
        // Nothing can move.
        _ if work.normal.problem.free.is_empty() => 1,
        (0, 0..=100) => 8,
        (0, 101..=5000) => 4,
        // What a given start does not lead to is out of reach of means of neighbours.
        (0, _) if work.start.is_some() => 1,
        (0, _) => 2,
        (n, _) => n,
    }
}

/// Works out starts, a batch at a time, until one is good enough or none is left.
fn best(work: &Work<'_>, bounds: &mut Bounds, context: &Context<'_>) -> Outcome {
    let options = work.options;
    let first_valid_is_enough =
        options.objective == Objective::UntangleOnly || options.starts == 0 && bounds.n_hexes > 400;
    let starts = most_starts(work);
    let mut found: Vec<Candidate> = Vec::new();
    let mut stop = StopReason::Finished;
    while (found.len() as u32) < starts {
        let from = found.len() as u32;
        let batch = if from == 0 { 1 } else { BATCH.min(starts - from) };
        // Progress comes from the driving thread: only a lone start reports in detail.
        let inner = if batch == 1 { *context } else { Context { progress: None, ..*context } };
        // Taken before the batch and not changed by it: what a start does must not depend on which others are done.
        let target = bounds.target();
        let new: Vec<Candidate> =
            (from..from + batch).into_par_iter().map(|number| work.one(number, target, &inner)).collect();
        // In the order of their numbers, whatever the threads did.
        found.extend(new);
        let best = found.iter().map(|c| c.verdict.worst).fold(f64::NEG_INFINITY, f64::max);
        context.report("starts", found.len() as u64, Some(u64::from(starts)), || format!("best {best:.6}"));
        if let Some(reason) = found.iter().find_map(|c| c.stopped) {
            stop = reason;
            break;
        }
        let valid = found.iter().any(|c| c.verdict.is_valid());
        if valid && (first_valid_is_enough || bounds.is_met_by(best)) {
            break;
        }
        if !valid {
            // Where no placement is valid, one start is as good as many.
            bounds.refine(&found[0].points, context);
            if is_impossible(bounds.least) {
                break;
            }
        }
    }
    let starts = found.len() as u32;
    let valid_starts = found.iter().filter(|c| c.verdict.is_valid()).count() as u32;
    found.sort_by(|a, b| b.verdict.cmp(&a.verdict).then(a.number.cmp(&b.number)));
    if options.objective == Objective::Balanced && found[0].verdict.is_valid() && stop == StopReason::Finished {
        stop = balance(&work.normal.problem, &mut found, options, context);
    }
    Outcome { candidate: found.swap_remove(0), starts, valid_starts, stop }
}

/// The best positions in the coordinates of the caller, with what is known of them.
fn report(work: &Work<'_>, mut bounds: Bounds, outcome: Outcome) -> Embedding {
    let normal = work.normal;
    let (mut upper_bound, target) = (bounds.least, bounds.target());
    if outcome.candidate.verdict.worst > upper_bound + 1e-9 {
        // Only a surface that crosses itself can beat its angles.
        bounds.stars.iter_mut().for_each(|s| s.bound.bound = s.by_direction);
        upper_bound = least_bound(&bounds.stars);
    }
    let mut stars: Vec<StarBound> = bounds.stars.iter().map(|s| s.bound).collect();
    stars.sort_by(|a, b| a.bound.total_cmp(&b.bound).then(a.vertex.cmp(&b.vertex)));
    stars.truncate(10);
    let points = normal.restore(&outcome.candidate.points);
    let seen = assess(normal, &points);
    let report = EmbedReport {
        objective: work.options.objective,
        valid_in_floating_point: seen.n_invalid == 0,
        n_invalid: seen.n_invalid,
        symmetries: normal.problem.symmetry.as_ref().map_or(1, |s| s.order),
        starts: outcome.starts,
        valid_starts: outcome.valid_starts,
        best_start: outcome.candidate.number,
        scaled_jacobian: seen.worst_cells[0].scaled_jacobian,
        scaled_jacobian_bound: seen.bound,
        condition: seen.condition,
        shortest_edge: seen.shortest_edge,
        worst_cells: seen.worst_cells,
        upper_bound,
        target,
        star_bounds: stars,
        stop: outcome.stop,
    };
    Embedding { points, report }
}
