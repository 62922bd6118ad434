//! One start, worked out: placed, untangled, improved.
//!
//! Source: ours.

use super::improve::{LARGE, improve};
use super::normal::Normal;
use crate::improvement::{lift_barely_valid, round_shapes, untangle_all, untangle_bad};
use crate::options::{Objective, Options};
use crate::quality::{Verdict, bad_cells};
use crate::starts::{Weights, place_at_means};
use hexfill_geometry::Vector;
use hexfill_mesh::{Context, Random, StopReason};

/// Where only valid cells are asked for, large meshes are raised to this share of their upper bound, which takes few cells.
const BARELY: f64 = 0.05;

/// What is worked on.
#[derive(Clone, Copy)]
pub(super) struct Work<'a> {
    pub(super) normal: &'a Normal,
    /// The start given, in normal coordinates.
    pub(super) start: Option<&'a [Vector]>,
    pub(super) options: &'a Options,
}

/// One start, worked out.
pub(super) struct Candidate {
    pub(super) number: u32,
    pub(super) points: Vec<Vector>,
    /// The points before quality was raised.
    pub(super) untangled: Vec<Vector>,
    pub(super) verdict: Verdict,
    pub(super) stopped: Option<StopReason>,
}

impl Work<'_> {
    /// Works out one start; `target` is the worst scaled Jacobian that is strived for.
    pub(super) fn one(&self, number: u32, target: f64, context: &Context<'_>) -> Candidate {
        let problem = &self.normal.problem;
        let mut points = self.place(number, context);
        let (mut bad, mut stopped) = self.untangle(number, &mut points, context);
        if let Some(given) = self.start.filter(|_| self.is_as_given(number) && problem.symmetry.is_none())
            && !bad.is_empty()
        {
            // A start that could not be untangled comes back no worse than it was.
            let before = bad_cells(problem, given);
            let with = |points: &[Vector], bad: &[usize]| Verdict::with_bad(problem, points, bad.len());
            if with(given, &before) >= with(&points, &bad) {
                points.copy_from_slice(given);
                bad = before;
            }
        }
        let climbs = self.options.objective != Objective::UntangleOnly && bad.is_empty();
        let untangled = points.clone();
        if climbs && stopped.is_none() {
            stopped = improve(problem, &mut points, target, self.options, context);
            bad = bad_cells(problem, &points);
        }
        let is_large = problem.hexes.len() > LARGE;
        if bad.is_empty() && stopped.is_none() && !climbs && is_large && problem.symmetry.is_none() {
            stopped = lift_barely_valid(problem, &mut points, BARELY * target, context);
        }
        let verdict = Verdict::with_bad(problem, &points, bad.len());
        Candidate { number, points, untangled, verdict, stopped }
    }

    /// Whether this start is the given one, and not a guess to be smoothed.
    fn is_as_given(&self, number: u32) -> bool {
        number == 0 && self.start.is_some() && !self.options.smooth_start
    }

    /// The positions a start begins with.
    fn place(&self, number: u32, context: &Context<'_>) -> Vec<Vector> {
        let problem = &self.normal.problem;
        let mut points = self.normal.points.clone();
        match self.start {
            Some(start) if number == 0 => {
                points.copy_from_slice(start);
                if self.options.smooth_start {
                    place_at_means(problem, &mut points, Weights::Unit, true, context);
                }
            }
            given => {
                let plain = number == u32::from(given.is_some());
                let mut random = Random::of_task(context.seed, u64::from(number));
                let weights = if plain { Weights::Unit } else { Weights::Random(&mut random) };
                place_at_means(problem, &mut points, weights, false, context);
            }
        }
        if problem.symmetry.is_some() {
            // The nearest symmetric positions.
            let x = problem.gather(&points);
            problem.scatter(&x, &mut points);
        }
        points
    }

    /// Untangles: large meshes and what was given by patches, else all at once. Returns the cells still bad, and why it was told to stop.
    fn untangle(&self, number: u32, points: &mut [Vector], context: &Context<'_>) -> (Vec<usize>, Option<StopReason>) {
        let problem = &self.normal.problem;
        let as_given = self.is_as_given(number);
        let is_large = problem.hexes.len() > self.options.local_limit;
        if problem.symmetry.is_some() || !(is_large || as_given) {
            return untangle_all(problem, points, context);
        }
        let (bad, stopped) = untangle_bad(problem, points, context);
        if bad.is_empty() && !as_given {
            round_shapes(problem, points, context);
        }
        (bad, stopped)
    }
}
