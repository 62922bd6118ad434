//! The rows of a program: quantities near the worst with their gradients, and what keeps cells positive.
//!
//! Source: ours; the rows that keep cells positive are those of Johnen, Weill, Remacle 2017.

use super::goal::Goal;
use crate::cell::condition::log_condition_with_gradient;
use crate::cell::frame::{FRAME_EDGES, Frame, MIXED};
use crate::cell::scaled_jacobian::{add_by_corner, columns, scaled_with_gradient, weights_at};
use crate::problem::Problem;
use crate::quality::{Cells, corner_points};
use hexfill_geometry::{Vector, cross};

/// A point of a cell: the hex, and coordinates in its unit cube.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) hex: usize,
    pub(super) at: Vector,
}

/// A linearised quantity that must stay at least t (an objective row) or at least the floor: where, value, and gradient by
/// corner of its hex.
pub(super) struct Row {
    pub(super) place: Place,
    pub(super) objective: bool,
    pub(super) value: f64,
    pub(super) gradient: [Vector; 8],
}

/// The quantities within `band` of the worst, whose merit is `value` (or of the goal's floor).
pub(super) fn linearise(
    problem: &Problem,
    points: &[Vector],
    cells: &Cells,
    goal: Goal,
    value: f64,
    band: f64,
) -> Vec<Row> {
    let scaled_limit = match goal {
        Goal::ScaledJacobian { .. } => value + band,
        Goal::Condition { floor } => floor + band,
    };
    let mut rows = Vec::new();
    let mut push = |place, objective, value, by_column: [Vector; 3], weights: &[[f64; 3]; 8]| {
        let mut gradient = [[0.0; 3]; 8];
        add_by_corner(&mut gradient, weights, 1.0, &by_column);
        rows.push(Row { place, objective, value, gradient });
    };
    for (hex, cell) in cells.each.iter().enumerate() {
        // The images of a cell have the same rows.
        if problem.symmetry.as_ref().is_some_and(|s| !s.is_first_hex[hex]) {
            continue;
        }
        let p = problem.corners_of(hex, points);
        // The inner points move with the cell's minimum, so each step takes the ones seen last.
        let near = if cell.value <= scaled_limit { cell.inner.as_slice() } else { &[] };
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

/// A Bernstein coefficient of det J, in units of its lengths, that may fall by `slack` at most.
pub(super) struct Guard {
    pub(super) hex: usize,
    pub(super) gradient: [Vector; 8],
    pub(super) slack: f64,
}

/// Guards of the small Bernstein coefficients of the cells that have rows. All coefficients positive means a positive cell (see [`crate::cell`]);
/// those at corners are rows themselves.
pub(super) fn guards(problem: &Problem, points: &[Vector], rows: &[Row]) -> Vec<Guard> {
    let mut hexes: Vec<usize> = rows.iter().map(|r| r.place.hex).collect();
    hexes.dedup();
    let mut guards = Vec::new();
    for hex in hexes {
        let frame = Frame::new(&problem.corners_of(hex, points));
        let (b, n) = (frame.bernstein(), frame.lengths());
        for c in 0..27 {
            let ratio = b[c] / n[c];
            let is_corner = c / 9 != 1 && c / 3 % 3 != 1 && c % 3 != 1;
            if is_corner || ratio.is_nan() || ratio >= 0.05 {
                continue;
            }
            // A coefficient may fall to a fifth of its value in one step; a negative one (valid by bisection) may not fall.
            let floor = if ratio > 0.0 { 0.2 * ratio } else { ratio };
            guards.push(Guard { hex, gradient: coefficient_gradient(&frame, c, n[c]), slack: ratio - floor });
        }
    }
    guards
}

/// The gradient by corner of a Bernstein coefficient over a fixed length.
fn coefficient_gradient(frame: &Frame, coefficient: usize, length: f64) -> [Vector; 8] {
    let mut edge_gradient = [[[0.0; 3]; 4]; 3];
    let mut count = 0.0;
    for m in MIXED.iter().filter(|m| m.coefficient == coefficient) {
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
            let g = edge_gradient[e / 4][e % 4][k] / (count * length);
            gradient[to][k] += g;
            gradient[from][k] -= g;
        }
    }
    gradient
}
