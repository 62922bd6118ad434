//! Untangling: from any start to coordinates with det J > 0 in every cell, if the energy finds them.
//!
//! Minimise the energy of [`crate::energy`] for a falling sequence of eps. The schedule is that of Garanzha et al. 2021:
//! with F before and F' after a minimisation, `sigma = max(1 - F'/F, 1/10)`, `mu = (1 - sigma) chi(eps, Dmin)`, and the
//! next eps is `2 sqrt(mu (mu - Dmin))` while `Dmin < mu`, else tiny. When all terms are positive the cells are put
//! to the Bernstein test, and the mixed determinants of the cells that fail it join the energy.

use crate::energy::{Energy, chi};
use crate::jacobian::{Frame, MIXED, Sign};
use crate::lbfgs::{Limits, minimise};
use crate::problem::Problem;
use crate::vector::{Vector, det};
use hexfill_mesh::{Context, StopReason};

/// Boxes a cell may be cut into when its sign is judged while working.
pub(crate) const WORKING_BOXES: usize = 200;

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
    /// Give up after so many rounds with neither fewer bad cells nor a better smallest determinant.
    pub(crate) patience: usize,
    /// Weight of the volume term of the energy.
    pub(crate) volume_weight: f64,
}

impl UntangleLimits {
    /// The usual limits, shapes only.
    pub(crate) const fn new() -> Self {
        Self { rounds: 100, iterations: 200, total: usize::MAX, extra_rounds: 0, patience: 15, volume_weight: 0.0 }
    }
}

/// What untangling came to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Untangled {
    /// Set if the context asked to stop.
    pub(crate) stopped: Option<StopReason>,
}

/// Moves the free vertices of `points` until every cell is positive or the limits are reached.
pub(crate) fn untangle(
    problem: &Problem,
    points: &mut [Vector],
    limits: UntangleLimits,
    context: &Context<'_>,
) -> Untangled {
    let mut energy = Energy::new(problem, points, limits.volume_weight);
    let mut x = problem.gather(points);
    let mut gradient = vec![0.0; x.len()];
    let mut smallest = energy.smallest_determinant(points);
    energy.epsilon = first_epsilon(smallest);
    let mut positive_rounds = 0;
    let mut best = (usize::MAX, f64::NEG_INFINITY);
    let (mut stale, mut spent) = (0, 0);
    for round in 0..limits.rounds {
        let before = energy.evaluate(points, &mut gradient);
        let diagonal = energy.inverse_diagonal();
        let mut stopped = None;
        let work = Limits { iterations: limits.iterations, relative_decrease: 1e-3, memory: 8 };
        let found = minimise(
            &mut x,
            &diagonal,
            work,
            |x, g| {
                problem.scatter(x, points);
                energy.evaluate(points, g)
            },
            |_, _| {
                stopped = context.stop();
                spent += 1;
                stopped.is_some() || spent >= limits.total
            },
        );
        problem.scatter(&x, points);
        smallest = energy.smallest_determinant(points);
        context.report("untangle", round as u64, Some(limits.rounds as u64), || {
            format!("smallest determinant {smallest:.3e} at eps {:.3e}", energy.epsilon)
        });
        if smallest > 0.0 {
            let failing = add_failing_terms(problem, points, &mut energy);
            if failing == 0 {
                positive_rounds += 1;
                if positive_rounds > limits.extra_rounds || stopped.is_some() {
                    return Untangled { stopped };
                }
            }
            smallest = energy.smallest_determinant(points);
        }
        if stopped.is_some() {
            return Untangled { stopped };
        }
        if spent >= limits.total {
            break;
        }
        let now = (energy.n_not_positive(), smallest);
        if now.0 < best.0 || now.0 == best.0 && now.1 > best.1 + 0.01 * best.1.abs() {
            (best, stale) = (now, 0);
        } else {
            stale += 1;
            if stale >= limits.patience {
                break;
            }
        }
        energy.epsilon = next_epsilon(energy.epsilon, smallest, before, found.value);
        energy.measure(points);
        smallest = energy.smallest_determinant(points);
        // New units can only be met by an eps that keeps the energy finite.
        if smallest <= 0.0 {
            energy.epsilon = energy.epsilon.max(1e-6 * (1.0 + smallest.abs()));
        }
    }
    Untangled { stopped: None }
}

fn first_epsilon(smallest: f64) -> f64 {
    if smallest > 0.0 { 1e-10 } else { (1e-4 + 0.04 * smallest * smallest).sqrt() }
}

fn next_epsilon(epsilon: f64, smallest: f64, before: f64, after: f64) -> f64 {
    let ratio = if before.is_finite() && before > 0.0 { after / before } else { 0.5 };
    let sigma = (1.0 - ratio).max(0.1);
    let mu = (1.0 - sigma) * chi(epsilon, smallest);
    if smallest < mu { 2.0 * (mu * (mu - smallest)).sqrt() } else { 1e-10 }
}

/// Adds to each cell that fails the Bernstein test the mixed determinants that are not positive
/// (or, if all are and bisection still fails, all of them). Returns how many cells fail.
fn add_failing_terms(problem: &Problem, points: &[Vector], energy: &mut Energy<'_>) -> usize {
    let mut signs = vec![Sign::Positive; problem.hexes.len()];
    problem.map_hexes(&mut signs, |h| Frame::new(&problem.corners_of(h, points)).sign(WORKING_BOXES));
    let mut failing = 0;
    for (h, sign) in signs.into_iter().enumerate() {
        if sign == Sign::Positive {
            continue;
        }
        failing += 1;
        let frame = Frame::new(&problem.corners_of(h, points));
        for (n, m) in MIXED.iter().enumerate() {
            let [a, b, c] = m.edges;
            if det(frame.0[0][a], frame.0[1][b], frame.0[2][c]) <= 0.0 {
                energy.terms[h] |= 1 << n;
            }
        }
    }
    failing
}

/// The cells that are not positive in floating point, ascending.
pub(crate) fn bad_cells(problem: &Problem, points: &[Vector]) -> Vec<usize> {
    let mut signs = vec![Sign::Positive; problem.hexes.len()];
    problem.map_hexes(&mut signs, |h| Frame::new(&problem.corners_of(h, points)).sign(WORKING_BOXES));
    (0..signs.len()).filter(|&h| signs[h] != Sign::Positive).collect()
}
