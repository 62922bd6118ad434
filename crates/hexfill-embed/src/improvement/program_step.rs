//! One program: the step that raises the linearised worst quantities most, in a trust region.
//!
//! Variables are `d / (radius * reach)` in [-1, 1], one for each of the problem, and `t - value`. With multipliers given, `d' H d / 2` is taken off, H minus
//! their sum of the second derivatives: the Lagrangian's model of sequential quadratic programming (Wilson 1963; Nocedal and Wright 2006,
//! chapter 18), each summand made convex so that the program is.
//!
//! Source: Wilson 1963; Nocedal, Wright 2006, chapter 18.

use super::goal::Goal;
use super::program_rows::{Place, Row, guards};
use crate::cell::hessian::{hessian, positive_part};
use crate::cell::scaled_jacobian::{columns, scaled, weights_at};
use crate::problem::Problem;
use crate::solvers::interior_point::Program;
use hexfill_geometry::Vector;

/// Where and how a step is looked for.
pub(super) struct Model<'a> {
    pub(super) problem: &'a Problem,
    pub(super) points: &'a [Vector],
    pub(super) goal: Goal,
    /// The merit at the points.
    pub(super) value: f64,
    /// Of the trust region, in shortest edges.
    pub(super) radius: f64,
}

/// A step in the variables of the problem.
pub(super) struct Step {
    pub(super) direction: Vec<f64>,
    /// What the model gains.
    pub(super) promised: f64,
    /// The scaled Jacobian rows that hold the step, with their multipliers.
    pub(super) multipliers: Vec<(Place, f64)>,
}

/// The best step in the model of `rows`, bent by second derivatives at the places of `curvature` with their multipliers; `None` if the solver gives up.
pub(super) fn solve(model: &Model<'_>, rows: &[Row], curvature: &[(Place, f64)]) -> Option<Step> {
    let Model { problem, points, goal, value, radius } = *model;
    let t = problem.n_variables();
    // Per variable: how far its vertex may move at radius 1, its shortest edge.
    let reach = problem.by_variable(|s| problem.shortest_edge_at(s, points).max(1e-9));
    let mut cost = vec![0.0; t + 1];
    cost[t] = -1.0;
    let mut program = Program::new(cost);
    for row in rows {
        let mut c = fall(model, &reach, row.place.hex, &row.gradient);
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
        // A box and not a ball, so that the program stays linear; each vertex moves on the scale of its own shortest
        // edge.
        program.row([(i, 1.0)], 1.0);
        program.row([(i, -1.0)], 1.0);
    }
    for guard in guards(problem, points, rows) {
        program.row(fall(model, &reach, guard.hex, &guard.gradient), guard.slack);
    }
    let mut bent = Vec::new();
    for &(place, multiplier) in curvature {
        bend(problem, points, place, multiplier, |i, j, value| {
            let value = value * radius * radius * reach[i] * reach[j];
            program.curvature(i, j, value);
            bent.push((i, j, value));
        });
    }
    let solution = program.solve()?;
    // The rows alone would promise t; along the step they bend down by this much.
    let taken_off: f64 = bent
        .iter()
        .map(|&(i, j, v)| (if i == j { 0.5 } else { 1.0 }) * v * solution.point[i] * solution.point[j])
        .sum();
    let multipliers = rows
        .iter()
        .zip(&solution.multipliers[..n_rows])
        .filter(|(row, m)| **m > 1e-7 && (row.objective == matches!(goal, Goal::ScaledJacobian { .. })))
        .map(|(row, &m)| (row.place, m))
        .collect();
    // The solver is inside its bounds up to its own tolerance.
    let direction = (0..t).map(|i| solution.point[i].clamp(-1.0, 1.0) * radius * reach[i]).collect();
    Some(Step { direction, promised: solution.point[t] - taken_off, multipliers })
}

/// How much a quantity with this gradient by corner falls, by variable of the program.
fn fall(model: &Model<'_>, reach: &[f64], hex: usize, gradient: &[Vector; 8]) -> Vec<(usize, f64)> {
    let (problem, radius) = (model.problem, model.radius);
    let n = problem.free.len();
    let mut out = Vec::with_capacity(25);
    for (corner, g) in gradient.iter().enumerate() {
        let s = problem.slot[problem.hexes[hex][corner] as usize] as usize;
        if s < n {
            for k in (0..3).filter(|&k| g[k] != 0.0) {
                let value = -radius * g[k];
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
}

/// Gives the entries (i <= j) of minus the Hessian of the scaled Jacobian at a place, times its multiplier, made convex.
fn bend(problem: &Problem, points: &[Vector], place: Place, multiplier: f64, mut entry: impl FnMut(usize, usize, f64)) {
    let n = problem.free.len();
    let hex = &problem.hexes[place.hex];
    let weights = weights_at(place.at);
    let c = columns(&problem.corners_of(place.hex, points), &weights);
    // A column without length: the measure has no derivative there.
    if scaled(&c) <= -1.0 {
        return;
    }
    // One place at a time: a sum of convex terms is convex, while the sum of the true Hessians need not be, and the
    // solver takes convex programs only.
    let h = positive_part(&hessian(&c).map(|r| r.map(|x| -multiplier * x)));
    let movable: Vec<(usize, usize)> = (0..8)
        .filter(|&corner| weights[corner] != [0.0; 3])
        .map(|corner| (corner, problem.slot[hex[corner] as usize] as usize))
        .filter(|&(_, s)| s < n)
        .collect();
    for &(a, sa) in &movable {
        for &(b, sb) in &movable {
            for (i, j) in (0..9).map(|n| (n / 3, n % 3)).filter(|&(i, j)| 3 * sa + i <= 3 * sb + j) {
                let mut sum = 0.0;
                for d in 0..3 {
                    for e in 0..3 {
                        sum += weights[a][d] * weights[b][e] * h[3 * d + i][3 * e + j];
                    }
                }
                if sum == 0.0 {
                    continue;
                }
                let Some(symmetry) = &problem.symmetry else {
                    entry(3 * sa + i, 3 * sb + j, sum);
                    continue;
                };
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
