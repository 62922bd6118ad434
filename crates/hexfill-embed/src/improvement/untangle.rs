//! Untangling: from any start to coordinates with det J > 0 in every cell, if the energy finds them.
//!
//! Minimise the foldover-free [`Energy`] for a falling sequence of eps. The schedule is that of Garanzha et al. 2021 (arXiv 2102.03069), who show
//! that it reaches a valid mesh in finitely many rounds if each minimisation does its share:
//! with F before and F' after a minimisation, `sigma = max(1 - F'/F, 1/10)`, `mu = (1 - sigma) chi(eps, Dmin)`, and the
//! next eps is `2 sqrt(mu (mu - Dmin))` while `Dmin < mu`, else tiny. When all terms are positive the cells are put
//! to the Bernstein test, and the mixed determinants of the cells that fail it join the energy.
//!
//! Source: Garanzha et al. 2021; the Bernstein test at the end is ours, after Johnen, Weill, Remacle 2017.

use super::foldover_free_energy::{Energy, chi};
use crate::cell::bisection::Sign;
use crate::cell::frame::{Frame, MIXED};
use crate::problem::Problem;
use crate::quality::WORKING_BOXES;
use crate::solvers::lbfgs::{Limits, minimise};
use hexfill_geometry::{Vector, det};
use hexfill_mesh::{Context, StopReason};

/// One bad cell in so many is too many to hope for the rest.
const HOPELESS: usize = 20;

/// Whether too many cells are bad.
pub(crate) fn is_hopeless(n_bad: usize, problem: &Problem) -> bool {
    HOPELESS * n_bad > problem.hexes.len()
}

/// How long to try.
#[derive(Clone, Copy, Debug)]
pub(crate) struct UntangleLimits {
    /// Values of eps at most.
    pub(crate) rounds: usize,
    /// L-BFGS iterations per value of eps.
    pub(crate) iterations: usize,
    /// L-BFGS iterations in all.
    pub(crate) total: usize,
    /// Rounds to go on once everything is positive: further shape improvement.
    pub(crate) extra_rounds: usize,
    /// Give up after so many rounds if more than one cell in [`HOPELESS`] still has a corner that is not positive.
    pub(crate) late: usize,
    /// Give up after so many rounds with neither fewer bad cells nor a better smallest determinant.
    pub(crate) patience: usize,
    /// Weight of the volume term of the energy.
    pub(crate) volume_weight: f64,
}

impl UntangleLimits {
    /// The usual limits, shapes only.
    pub(crate) const fn new() -> Self {
        Self {
            rounds: 100,
            iterations: 200,
            total: usize::MAX,
            extra_rounds: 0,
            late: usize::MAX,
            patience: 15,
            volume_weight: 0.0,
        }
    }
}

/// Moves the free vertices of `points` until every cell is positive or the limits are reached. Says why it was told to stop.
pub(crate) fn untangle(
    problem: &Problem,
    points: &mut [Vector],
    limits: UntangleLimits,
    context: &Context<'_>,
) -> Option<StopReason> {
    let mut energy = Energy::new(problem, points, limits.volume_weight);
    let mut x = problem.gather(points);
    let mut gradient = vec![0.0; x.len()];
    let mut smallest = energy.smallest_determinant(points);
    energy.epsilon = first_epsilon(smallest);
    let mut positive_rounds = 0;
    let mut progress = Progress::new(limits.patience);
    let mut spent = 0;
    for round in 0..limits.rounds {
        let before = energy.evaluate(points, &mut gradient);
        // Each eps is minimised roughly only: what the schedule needs of a round is a share of the way down, not the
        // minimum.
        let (after, stopped) = minimise_energy(&mut energy, &mut x, points, limits, &mut spent, context);
        smallest = energy.smallest_determinant(points);
        context.report("untangle", round as u64, Some(limits.rounds as u64), || {
            format!("smallest determinant {smallest:.3e}, valid when positive")
        });
        // Positive terms are positive corners; the Bernstein form says whether the cells are positive inside, too.
        if smallest > 0.0 {
            let failing = add_failing_terms(problem, points, &mut energy);
            if failing == 0 {
                positive_rounds += 1;
                if positive_rounds > limits.extra_rounds || stopped.is_some() {
                    return stopped;
                }
            }
            smallest = energy.smallest_determinant(points);
        }
        if stopped.is_some() {
            return stopped;
        }
        let n_bad = energy.n_not_positive();
        let is_hopeless = round + 1 >= limits.late && is_hopeless(n_bad, problem);
        if spent >= limits.total || is_hopeless || progress.is_stale(n_bad, smallest) {
            break;
        }
        energy.epsilon = next_epsilon(energy.epsilon, smallest, before, after);
        // Cells change their size while they untangle, and a term is read in units of its hex.
        energy.measure(points);
        smallest = energy.smallest_determinant(points);
        // New units can only be met by an eps that keeps the energy finite.
        if smallest <= 0.0 {
            energy.epsilon = energy.epsilon.max(1e-6 * (1.0 + smallest.abs()));
        }
    }
    None
}

/// Minimises the energy with its eps from the variables `x`, which are those of `points`; both end as the best. Returns the value, and why it was
/// told to stop.
fn minimise_energy(
    energy: &mut Energy<'_>,
    x: &mut [f64],
    points: &mut [Vector],
    limits: UntangleLimits,
    spent: &mut usize,
    context: &Context<'_>,
) -> (f64, Option<StopReason>) {
    let problem = energy.problem;
    let diagonal = energy.inverse_diagonal();
    let mut stopped = None;
    let work = Limits { iterations: limits.iterations, relative_decrease: 1e-3, memory: 8 };
    let found = minimise(
        x,
        &diagonal,
        work,
        |x, g| {
            problem.scatter(x, points);
            energy.evaluate(points, g)
        },
        |_, _| {
            stopped = context.stop();
            *spent += 1;
            stopped.is_some() || *spent >= limits.total
        },
    );
    problem.scatter(x, points);
    (found.value, stopped)
}

/// Whether rounds still lead anywhere.
struct Progress {
    /// Cells that are not positive, and the smallest determinant, at the best.
    best: (usize, f64),
    /// Rounds since then.
    stale: usize,
    patience: usize,
}

impl Progress {
    fn new(patience: usize) -> Self {
        Self { best: (usize::MAX, f64::NEG_INFINITY), stale: 0, patience }
    }

    /// Counts a round; true if patience is at its end.
    fn is_stale(&mut self, n_bad: usize, smallest: f64) -> bool {
        let best = self.best;
        if n_bad < best.0 || n_bad == best.0 && smallest > best.1 + 0.01 * best.1.abs() {
            (self.best, self.stale) = ((n_bad, smallest), 0);
            return false;
        }
        self.stale += 1;
        self.stale >= self.patience
    }
}

/// The first eps: tiny on a valid start, else a fifth of the most negative determinant.
fn first_epsilon(smallest: f64) -> f64 {
    if smallest > 0.0 { 1e-10 } else { (1e-4 + 0.04 * smallest * smallest).sqrt() }
}

/// The eps after one that lowered the energy from `before` to `after`: see the module page.
fn next_epsilon(epsilon: f64, smallest: f64, before: f64, after: f64) -> f64 {
    // The start may have been infinite; then nothing is known of the fall, and half is as good a guess as any.
    let ratio = if before.is_finite() && before > 0.0 { after / before } else { 0.5 };
    let sigma = (1.0 - ratio).max(0.1);
    let mu = (1.0 - sigma) * chi(epsilon, smallest);
    if smallest < mu { 2.0 * (mu * (mu - smallest)).sqrt() } else { 1e-10 }
}

/// Adds to each cell that fails the Bernstein test the mixed determinants that are not positive
/// (or, if all are and bisection still fails, all of them). Returns how many cells fail.
fn add_failing_terms(problem: &Problem, points: &[Vector], energy: &mut Energy<'_>) -> usize {
    let mut signs = vec![Sign::Positive; problem.hexes.len()];
    problem.map_hexes(&mut signs, |h| {
        // A pyramid is what its base corners say.
        if problem.is_pyramid(h) {
            Sign::Positive
        } else {
            Frame::new(&problem.corners_of(h, points)).sign(WORKING_BOXES)
        }
    });
    let mut failing = 0;
    for (h, sign) in signs.into_iter().enumerate() {
        if sign == Sign::Positive {
            continue;
        }
        failing += 1;
        let frame = Frame::new(&problem.corners_of(h, points));
        for (n, m) in MIXED.iter().enumerate() {
            let [a, b, c] = m.edges;
            // Sufficient and not necessary: a cell with all mixed determinants positive is positive inside, so only
            // cells that fail the test pay for them.
            if det(frame.0[0][a], frame.0[1][b], frame.0[2][c]) <= 0.0 {
                energy.terms[h] |= 1 << n;
            }
        }
    }
    failing
}
