//! Sequential linear programming in a trust region: raise the worst scaled Jacobian, or lower the worst condition number.
//!
//! At each step the quantities near the worst are linearised, `s + g . d >= t`, with every free vertex held within
//! `radius` times its shortest edge, and t is maximised (linear program). Where the optimum is flat, linear steps zigzag; the
//! multipliers of the last program then weight the second derivatives of the rows (made convex), and a quadratic
//! program gives the step. A step is taken only if the true worst value over whole cells improves and every cell
//! stays positive, so validity is never traded for corners: the worst value of a cell comes from bisection, and the points
//! where it was seen become rows of the next program.

use crate::jacobian::{FRAME_EDGES, Frame, MIXED, columns, scaled, scaled_with_gradient, weights_at};
use crate::measure::{log_condition, log_condition_with_gradient};
use crate::problem::Problem;
use crate::program::Program;
use crate::vector::{Vector, cross};
use hexfill_mesh::cube::POSITIONS;
use hexfill_mesh::{Context, StopReason};

/// What is improved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Goal {
    /// Raise the worst scaled Jacobian; stop when it reaches the target.
    ScaledJacobian {
        /// Enough.
        target: f64,
    },
    /// Lower the worst corner condition number, keeping the scaled Jacobian at least at the floor.
    Condition {
        /// The floor.
        floor: f64,
    },
}

/// Limits of a run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
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

/// A point of a cell: the hex, and coordinates in its unit cube.
#[derive(Clone, Copy, Debug)]
struct Place {
    hex: usize,
    at: Vector,
}

/// A linearised quantity that must stay at least t (an objective row) or at least the floor: where, value, and gradient by
/// corner of its hex.
struct Row {
    place: Place,
    objective: bool,
    value: f64,
    gradient: [Vector; 8],
}

/// What is known of the cells at some coordinates.
pub(crate) struct Cells {
    /// Per hex: its worst scaled Jacobian (negative unless the lower bound is positive), and the inner points that are worst.
    pub(crate) each: Vec<(f64, Vec<Vector>)>,
    /// The smallest of them.
    pub(crate) worst: f64,
}

/// Judges all cells at `points`; cells better than `cutoff` only as far as to know that.
pub(crate) fn judge(problem: &Problem, points: &[Vector], cutoff: f64) -> Cells {
    judge_within(problem, points, cutoff, COARSE)
}

/// How closely cells are judged on the way,
const COARSE: (f64, usize) = (1e-6, 200);
/// and once the target seems to be reached: the largest error, and the boxes this may take.
const FINE: (f64, usize) = (1e-10, 2000);

fn judge_within(problem: &Problem, points: &[Vector], cutoff: f64, (error, boxes): (f64, usize)) -> Cells {
    let mut each = vec![(0.0, Vec::new()); problem.hexes.len()];
    problem.map_hexes(&mut each, |h| {
        let worst = Frame::new(&problem.corners_of(h, points)).worst(cutoff, error, boxes);
        (if worst.lower > 0.0 { worst.upper } else { worst.upper.min(-1e-12) }, worst.inner)
    });
    let worst = each.iter().map(|c| c.0).fold(f64::INFINITY, f64::min);
    Cells { each, worst }
}

/// Judges all cells, those more than `band` above the worst and `floor` only as far as to know that.
pub(crate) fn judge_near_worst(problem: &Problem, points: &[Vector], floor: f64, band: f64) -> Cells {
    let mut corners = vec![0.0; problem.hexes.len()];
    problem.map_hexes(&mut corners, |h| {
        let p = problem.corners_of(h, points);
        corner_points().map(|at| scaled(&columns(&p, &weights_at(at)))).fold(f64::INFINITY, f64::min)
    });
    // The worst over whole cells is at most the worst corner.
    judge(problem, points, corners.into_iter().fold(1.0, f64::min).max(floor).max(0.0) + band)
}

/// The value the goal wants large: the worst scaled Jacobian, or minus the logarithm of the worst condition number.
fn merit(problem: &Problem, points: &[Vector], cells: &Cells, goal: Goal) -> f64 {
    match goal {
        Goal::ScaledJacobian { .. } => cells.worst,
        Goal::Condition { floor } if cells.worst < floor => f64::NEG_INFINITY,
        Goal::Condition { .. } => {
            let mut each = vec![0.0; problem.hexes.len()];
            problem.map_hexes(&mut each, |h| {
                let p = problem.corners_of(h, points);
                corner_points().map(|at| log_condition(&columns(&p, &weights_at(at)))).fold(0.0, f64::max)
            });
            -each.iter().copied().fold(0.0, f64::max)
        }
    }
}

fn corner_points() -> impl Iterator<Item = Vector> {
    POSITIONS.iter().map(|p| p.map(f64::from))
}

/// Improves `points` as far as it goes within the limits. For [`Goal::ScaledJacobian`] some cells may be invalid to begin with;
/// for [`Goal::Condition`] the floor must hold.
pub(crate) fn climb(
    problem: &Problem,
    points: &mut Vec<Vector>,
    goal: Goal,
    limits: Limits,
    context: &Context<'_>,
) -> Climb {
    const SEEN: f64 = 0.02;
    let mut cells = match goal {
        Goal::ScaledJacobian { .. } => judge_near_worst(problem, points, 0.0, limits.band + SEEN),
        Goal::Condition { .. } => judge(problem, points, 1.0),
    };
    let mut value = merit(problem, points, &cells, goal);
    let target = if let Goal::ScaledJacobian { target } = goal { target } else { 0.0 };
    let mut radius: f64 = 0.5;
    let mut curved = false;
    let mut multipliers: Vec<(Place, f64)> = Vec::new();
    let mut iterations = 0;
    let mut stopped = None;
    let mut rejected = 0;
    let mut closely = COARSE;
    while iterations < limits.iterations && radius > 1e-9 && problem.n_variables() > 0 {
        if value >= target {
            if closely == FINE || !matches!(goal, Goal::ScaledJacobian { .. }) {
                break;
            }
            // The error on the way may be larger than what is left.
            closely = FINE;
            cells = judge_within(problem, points, value + SEEN, closely);
            value = cells.worst;
            continue;
        }
        stopped = context.stop();
        if stopped.is_some() {
            break;
        }
        iterations += 1;
        let reach = reach(problem, points);
        let rows = linearise(problem, points, &cells, goal, value, limits.band);
        let curvature = if curved { multipliers.as_slice() } else { &[] };
        let Some(step) = solve(problem, points, &rows, goal, value, &reach, radius, curvature) else {
            radius *= 0.25;
            curved = false;
            continue;
        };
        if step.promised < limits.tolerance {
            if curved || radius >= 0.5 {
                break;
            }
            radius = 0.5;
            curved = true;
            continue;
        }
        let mut trial = points.clone();
        let mut x = problem.gather(points);
        x.iter_mut().zip(&step.direction).for_each(|(x, d)| *x += d);
        problem.scatter(&x, &mut trial);
        let trial_cells = match goal {
            Goal::ScaledJacobian { .. } => judge_within(problem, &trial, value + step.promised + SEEN, closely),
            Goal::Condition { floor } => judge(problem, &trial, floor + SEEN),
        };
        let reached = merit(problem, &trial, &trial_cells, goal);
        let gain = reached - value;
        context.report("optimise", iterations as u64, Some(limits.iterations as u64), || {
            format!("{goal:?}, now {value:.6}")
        });
        multipliers = step.multipliers;
        if gain > 0.0 {
            *points = trial;
            cells = trial_cells;
            value = reached;
            rejected = 0;
        } else {
            rejected += 1;
        }
        if gain < 0.25 * step.promised {
            radius *= 0.35;
            if rejected >= 2 || gain > 0.0 {
                curved = true;
            }
        } else if gain > 0.7 * step.promised {
            radius = (2.0 * radius).min(1.0);
        }
    }
    Climb { scaled_jacobian: cells.worst, stopped }
}

/// Per variable: how far its vertex may move at radius 1, its shortest edge.
fn reach(problem: &Problem, points: &[Vector]) -> Vec<f64> {
    problem.by_variable(|s| problem.shortest_edge_at(s, points).max(1e-9))
}

fn linearise(problem: &Problem, points: &[Vector], cells: &Cells, goal: Goal, value: f64, band: f64) -> Vec<Row> {
    let scaled_limit = match goal {
        Goal::ScaledJacobian { .. } => value + band,
        Goal::Condition { floor } => floor + band,
    };
    let mut rows = Vec::new();
    let mut push = |place, objective, value, by_column: [Vector; 3], weights: &[[f64; 3]; 8]| {
        let mut gradient = [[0.0; 3]; 8];
        for (g, w) in gradient.iter_mut().zip(weights) {
            for d in 0..3 {
                for k in 0..3 {
                    g[k] += w[d] * by_column[d][k];
                }
            }
        }
        rows.push(Row { place, objective, value, gradient });
    };
    for (hex, (worst, inner)) in cells.each.iter().enumerate() {
        let p = problem.corners_of(hex, points);
        if problem.symmetry.as_ref().is_some_and(|s| !s.is_first_hex[hex]) {
            continue;
        }
        // The inner points move with the cell's minimum, so each step takes the ones seen last.
        let near = if *worst <= scaled_limit { inner.as_slice() } else { &[] };
        for (n, at) in corner_points().chain(near.iter().copied()).enumerate() {
            let weights = weights_at(at);
            let c = columns(&p, &weights);
            let place = Place { hex, at };
            if let Some((s, gradient)) = scaled_with_gradient(&c).filter(|(s, _)| *s <= scaled_limit) {
                push(place, matches!(goal, Goal::ScaledJacobian { .. }), s, gradient, &weights);
            }
            if let Goal::Condition { .. } = goal
                && n < 8
                && let Some((log, gradient)) = log_condition_with_gradient(&c)
                // Condition numbers within a factor e of the worst.
                && -log <= value + 1.0
            {
                push(place, true, -log, gradient.map(|g| g.map(|x| -x)), &weights);
            }
        }
    }
    rows
}

struct Step {
    direction: Vec<f64>,
    promised: f64,
    /// The scaled Jacobian rows that hold the step, with their multipliers.
    multipliers: Vec<(Place, f64)>,
}

#[allow(clippy::too_many_arguments)] // one call site; a struct would only rename them
fn solve(
    problem: &Problem,
    points: &[Vector],
    rows: &[Row],
    goal: Goal,
    value: f64,
    reach: &[f64],
    radius: f64,
    curvature: &[(Place, f64)],
) -> Option<Step> {
    let n = problem.free.len();
    let t = problem.n_variables();
    let mut cost = vec![0.0; t + 1];
    cost[t] = -1.0;
    let mut program = Program::new(cost);
    // Variables: d_v / (radius * reach_v) in [-1, 1], and t - value.
    let coefficients = |hex: usize, gradient: &[Vector; 8], sign: f64| {
        let mut out = Vec::with_capacity(25);
        for (corner, g) in gradient.iter().enumerate() {
            let s = problem.slot[problem.hexes[hex][corner] as usize] as usize;
            if s < n {
                for k in (0..3).filter(|&k| g[k] != 0.0) {
                    let value = sign * radius * g[k];
                    match &problem.symmetry {
                        None => out.push((3 * s + k, value * reach[3 * s + k])),
                        Some(symmetry) => out.extend(symmetry.expand(s, k).map(|(i, c)| (i, value * c * reach[i]))),
                    }
                }
            }
        }
        if problem.symmetry.is_some() {
            // Corners of one orbit share variables.
            out.sort_by_key(|entry| entry.0);
            out.dedup_by(|b, a| {
                a.0 == b.0 && {
                    a.1 += b.1;
                    true
                }
            });
        }
        out
    };
    for row in rows {
        let mut c = coefficients(row.place.hex, &row.gradient, -1.0);
        if row.objective {
            c.push((t, 1.0));
            program.row(c, row.value - value);
        } else if let Goal::Condition { floor } = goal {
            // The step must not be refused for a rounding error of the floor.
            program.row(c, (row.value - floor - 1e-9).max(0.0));
        }
    }
    let n_rows = program.n_rows();
    for i in 0..t {
        program.row([(i, 1.0)], 1.0);
        program.row([(i, -1.0)], 1.0);
    }
    keep_positive(problem, points, rows, &mut program, &coefficients);
    let mut model = Vec::new();
    for &(place, multiplier) in curvature {
        bend(problem, points, place, multiplier, |i, j, value| {
            let value = value * radius * radius * reach[i] * reach[j];
            program.curvature(i, j, value);
            model.push((i, j, value));
        });
    }
    let solution = program.solve()?;
    let bent: f64 = model
        .iter()
        .map(|&(i, j, v)| (if i == j { 0.5 } else { 1.0 }) * v * solution.point[i] * solution.point[j])
        .sum();
    let multipliers = rows
        .iter()
        .zip(&solution.multipliers[..n_rows])
        .filter(|(row, m)| **m > 1e-7 && (row.objective == matches!(goal, Goal::ScaledJacobian { .. })))
        .map(|(row, &m)| (row.place, m))
        .collect();
    let direction = (0..t).map(|i| solution.point[i].clamp(-1.0, 1.0) * radius * reach[i]).collect();
    Some(Step { direction, promised: solution.point[t] - bent, multipliers })
}

/// Gives the entries (i <= j) of minus the Hessian of the scaled Jacobian at a place, times its multiplier, made convex.
fn bend(problem: &Problem, points: &[Vector], place: Place, multiplier: f64, mut entry: impl FnMut(usize, usize, f64)) {
    use crate::curvature::{hessian, positive_part};
    let n = problem.free.len();
    let hex = &problem.hexes[place.hex];
    let weights = weights_at(place.at);
    let c = columns(&problem.corners_of(place.hex, points), &weights);
    if scaled(&c) <= -1.0 {
        return;
    }
    let h = positive_part(&hessian(&c).map(|r| r.map(|x| -multiplier * x)));
    let movable: Vec<(usize, usize)> = (0..8)
        .filter(|&corner| weights[corner] != [0.0; 3])
        .map(|corner| (corner, problem.slot[hex[corner] as usize] as usize))
        .filter(|&(_, s)| s < n)
        .collect();
    for &(a, sa) in &movable {
        for &(b, sb) in &movable {
            for i in 0..3 {
                for j in 0..3 {
                    if 3 * sa + i > 3 * sb + j {
                        continue;
                    }
                    let mut sum = 0.0;
                    for d in 0..3 {
                        for e in 0..3 {
                            sum += weights[a][d] * weights[b][e] * h[3 * d + i][3 * e + j];
                        }
                    }
                    if sum != 0.0 {
                        match &problem.symmetry {
                            None => entry(3 * sa + i, 3 * sb + j, sum),
                            Some(symmetry) => {
                                // As a product of two sums; what lies off the diagonal stands for both orders.
                                let twice = if (sa, i) == (sb, j) { 1.0 } else { 2.0 };
                                for (p, x) in symmetry.expand(sa, i) {
                                    for (q, y) in symmetry.expand(sb, j) {
                                        let share = if p == q { 1.0 } else { 0.5 };
                                        entry(p.min(q), p.max(q), sum * twice * share * x * y);
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Rows that keep small Bernstein coefficients of the cells in the program from reaching zero.
fn keep_positive(
    problem: &Problem,
    points: &[Vector],
    rows: &[Row],
    program: &mut Program,
    coefficients: &impl Fn(usize, &[Vector; 8], f64) -> Vec<(usize, f64)>,
) {
    let mut hexes: Vec<usize> = rows.iter().map(|r| r.place.hex).collect();
    hexes.dedup();
    for hex in hexes {
        let frame = Frame::new(&problem.corners_of(hex, points));
        let (b, n) = (frame.bernstein(), frame.lengths());
        for c in 0..27 {
            let ratio = b[c] / n[c];
            let is_corner = c / 9 != 1 && c / 3 % 3 != 1 && c % 3 != 1;
            if is_corner || ratio.is_nan() || ratio >= 0.05 {
                continue;
            }
            let mut edge_gradient = [[[0.0; 3]; 4]; 3];
            let mut count = 0.0;
            for m in MIXED.iter().filter(|m| m.coefficient == c) {
                count += 1.0;
                let e: [Vector; 3] = std::array::from_fn(|d| frame.0[d][m.edges[d]]);
                for d in 0..3 {
                    let normal = cross(e[(d + 1) % 3], e[(d + 2) % 3]);
                    for k in 0..3 {
                        edge_gradient[d][m.edges[d]][k] += normal[k];
                    }
                }
            }
            let mut gradient = [[0.0; 3]; 8];
            for (e, [from, to]) in FRAME_EDGES.into_iter().enumerate() {
                for k in 0..3 {
                    let g = edge_gradient[e / 4][e % 4][k] / (count * n[c]);
                    gradient[to][k] += g;
                    gradient[from][k] -= g;
                }
            }
            // A coefficient may fall to a fifth of its value in one step; a negative one (valid by bisection) may not fall.
            let floor = if ratio > 0.0 { 0.2 * ratio } else { ratio };
            program.row(coefficients(hex, &gradient, -1.0), ratio - floor);
        }
    }
}
