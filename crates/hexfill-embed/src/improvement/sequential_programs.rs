//! Sequential linear programming in a trust region: raise the worst scaled Jacobian, or lower the worst condition number.
//!
//! At each step the quantities near the worst are linearised, `s + g . d >= t`, with every free vertex held within
//! `radius` times its shortest edge, and t is maximised (linear program; Madsen 1975 for max-min problems, Fletcher 1987, chapter 14). Where the optimum is flat, linear steps zigzag; the
//! multipliers of the last program then weight the second derivatives of the rows (made convex), and a quadratic
//! program gives the step. A step is taken only if the true worst value over whole cells improves and every cell
//! stays positive, so validity is never traded for corners: the worst value of a cell comes from bisection, and the points
//! where it was seen become rows of the next program.
//!
//! Source: Madsen 1975; Fletcher 1987, chapter 14.

use super::goal::Goal;
use super::program_rows::{Place, linearise};
use super::program_step::{Model, solve};
use crate::problem::Problem;
use crate::quality::{Cells, Precision, judge, judge_near_worst, judge_within, worst_log_condition};
use hexfill_geometry::Vector;
use hexfill_mesh::{Context, StopReason};

/// Limits of a run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ProgramLimits {
    /// Programs solved at most.
    pub(crate) iterations: usize,
    /// Rows this far above the worst take part.
    pub(crate) band: f64,
    /// Stop when a step promises less than this.
    pub(crate) tolerance: f64,
}

/// What a run came to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Climb {
    /// The worst scaled Jacobian over all cells, whole.
    pub(crate) scaled_jacobian: f64,
    /// Set if the context asked to stop.
    pub(crate) stopped: Option<StopReason>,
}

/// How far above the worst value cells are looked at closely.
const SEEN: f64 = 0.02;

/// Improves `points` as far as it goes within the limits. For [`Goal::ScaledJacobian`] some cells may be invalid to begin with;
/// for [`Goal::Condition`] the floor must hold.
pub(crate) fn climb(
    problem: &Problem,
    points: &mut Vec<Vector>,
    goal: Goal,
    limits: ProgramLimits,
    context: &Context<'_>,
) -> Climb {
    let mut climber = Climber::new(problem, points, goal, limits);
    let mut iterations = 0;
    let mut stopped = None;
    // Below the smallest radius steps are rounding.
    while iterations < limits.iterations && climber.radius > 1e-9 && problem.n_variables() > 0 {
        // On the way cells are judged with a coarse error; whether the target is reached is not for such a value to
        // say.
        if climber.has_reached_target() {
            if !climber.look_closely(points) {
                break;
            }
            continue;
        }
        stopped = context.stop();
        if stopped.is_some() {
            break;
        }
        iterations += 1;
        let before = climber.value;
        match climber.step(points) {
            Turn::Moved => {
                context.report("optimise", iterations as u64, Some(limits.iterations as u64), || goal.progress(before))
            }
            Turn::Again => {}
            Turn::End => break,
        }
    }
    Climb { scaled_jacobian: climber.cells.worst, stopped }
}

/// What a program led to.
enum Turn {
    /// A step was tried.
    Moved,
    /// There was none worth trying in this trust region or with this model.
    Again,
    /// There is none.
    End,
}

/// A climb on its way. Invariant: `cells` and `value` are those of the points.
struct Climber<'p> {
    problem: &'p Problem,
    goal: Goal,
    limits: ProgramLimits,
    cells: Cells,
    value: f64,
    /// Of the trust region, in shortest edges.
    radius: f64,
    /// Whether the multipliers bend the next program.
    curved: bool,
    multipliers: Vec<(Place, f64)>,
    /// Steps refused in a row.
    rejected: usize,
    precision: Precision,
}

impl<'p> Climber<'p> {
    fn new(problem: &'p Problem, points: &[Vector], goal: Goal, limits: ProgramLimits) -> Self {
        let cells = match goal {
            Goal::ScaledJacobian { .. } => judge_near_worst(problem, points, 0.0, limits.band + SEEN),
            Goal::Condition { .. } => judge(problem, points, 1.0),
        };
        let value = merit(problem, points, &cells, goal);
        let (radius, multipliers) = (0.5, Vec::new());
        Self {
            problem,
            goal,
            limits,
            cells,
            value,
            radius,
            curved: false,
            multipliers,
            rejected: 0,
            precision: Precision::Coarse,
        }
    }

    fn has_reached_target(&self) -> bool {
        match self.goal {
            Goal::ScaledJacobian { target } => self.value >= target,
            // A logarithm of one is the end.
            Goal::Condition { .. } => self.value >= 0.0,
        }
    }

    /// Judges closely from now on, as the error on the way may be larger than what is left; false if that is done.
    fn look_closely(&mut self, points: &[Vector]) -> bool {
        if self.precision == Precision::Fine || !matches!(self.goal, Goal::ScaledJacobian { .. }) {
            return false;
        }
        self.precision = Precision::Fine;
        self.cells = judge_within(self.problem, points, self.value + SEEN, Precision::Fine);
        self.value = self.cells.worst;
        true
    }

    /// Solves one program and takes its step if that is good.
    fn step(&mut self, points: &mut Vec<Vector>) -> Turn {
        let problem = self.problem;
        let rows = linearise(problem, points, &self.cells, self.goal, self.value, self.limits.band);
        let curvature = if self.curved { self.multipliers.as_slice() } else { &[] };
        let model = Model { problem, points, goal: self.goal, value: self.value, radius: self.radius };
        let Some(step) = solve(&model, &rows, curvature) else {
            // The solver gave up, mostly on a model that is too curved for its region: a smaller one, and linear.
            self.radius *= 0.25;
            self.curved = false;
            return Turn::Again;
        };
        if step.promised < self.limits.tolerance {
            // A flat or curved optimum may be mistaken for one: the last word has a curved model in a wide region.
            if self.curved || self.radius >= 0.5 {
                return Turn::End;
            }
            self.radius = 0.5;
            self.curved = true;
            return Turn::Again;
        }
        let mut trial = points.clone();
        let mut x = problem.gather(points);
        x.iter_mut().zip(&step.direction).for_each(|(x, d)| *x += d);
        problem.scatter(&x, &mut trial);
        let cells = match self.goal {
            Goal::ScaledJacobian { .. } => {
                judge_within(problem, &trial, self.value + step.promised + SEEN, self.precision)
            }
            Goal::Condition { floor } => judge(problem, &trial, floor + SEEN),
        };
        let reached = merit(problem, &trial, &cells, self.goal);
        let gain = reached - self.value;
        self.multipliers = step.multipliers;
        // Trust region: what was promised against what came decides how far the next model is believed.
        self.learn(gain, step.promised);
        // By the true worst over whole cells, never by the model: no step can trade validity for corners.
        if gain > 0.0 {
            *points = trial;
            self.cells = cells;
            self.value = reached;
        }
        Turn::Moved
    }

    /// The trust region after a step: narrower where the model promised too much, wider where it held.
    fn learn(&mut self, gain: f64, promised: f64) {
        self.rejected = if gain > 0.0 { 0 } else { self.rejected + 1 };
        // The thresholds of textbook trust regions (Fletcher 1987): a quarter for a bad model, near all of it for a
        // good one.
        if gain < 0.25 * promised {
            self.radius *= 0.35;
            // Linear steps zigzag along a ridge: bend the model.
            if self.rejected >= 2 || gain > 0.0 {
                self.curved = true;
            }
        } else if gain > 0.7 * promised {
            self.radius = (2.0 * self.radius).min(1.0);
        }
    }
}

/// The value the goal wants large: the worst scaled Jacobian, or minus the logarithm of the worst condition number.
fn merit(problem: &Problem, points: &[Vector], cells: &Cells, goal: Goal) -> f64 {
    match goal {
        Goal::ScaledJacobian { .. } => cells.worst,
        Goal::Condition { floor } if cells.worst < floor => f64::NEG_INFINITY,
        Goal::Condition { .. } => -worst_log_condition(problem, points),
    }
}
