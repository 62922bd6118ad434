//! The worst scaled Jacobian of every cell, over the whole cell, as closely as is asked for.
//!
//! Source: ours, on the bisection of Johnen, Weill, Remacle 2017.

use crate::cell::bisection::Sign;
use crate::cell::condition::log_condition;
use crate::cell::frame::Frame;
use crate::cell::scaled_jacobian::{columns, scaled, weights_at};
use crate::problem::Problem;
use hexfill_geometry::Vector;
use hexfill_mesh::cube::POSITIONS;

/// Boxes a cell may be cut into when its sign is judged while working.
pub(crate) const WORKING_BOXES: usize = 200;

/// Boxes a cell may be cut into when its worst value is wanted: fewer leave elongated cells with a value that is too good.
const VALUE_BOXES: usize = 2000;

/// How closely cells are judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Precision {
    /// On the way,
    Coarse,
    /// and once the target seems to be reached.
    Fine,
}

impl Precision {
    /// The largest error of a worst value.
    fn error(self) -> f64 {
        match self {
            Self::Coarse => 1e-6,
            Self::Fine => 1e-10,
        }
    }
}

/// What is known of the cells at some coordinates.
pub(crate) struct Cells {
    /// One per hex.
    pub(crate) each: Vec<WorstOfCell>,
    /// The smallest of their values.
    pub(crate) worst: f64,
}

/// What is known of a cell.
#[derive(Clone, Debug, Default)]
pub(crate) struct WorstOfCell {
    /// Its worst scaled Jacobian; negative unless the lower bound is positive.
    pub(crate) value: f64,
    /// The points inside, in the unit cube, where it is nearly as bad as that.
    pub(crate) inner: Vec<Vector>,
}

/// Judges all cells at `points`; cells better than `cutoff` only as far as to know that.
pub(crate) fn judge(problem: &Problem, points: &[Vector], cutoff: f64) -> Cells {
    judge_within(problem, points, cutoff, Precision::Coarse)
}

/// As [`judge`], as closely as is said.
pub(crate) fn judge_within(problem: &Problem, points: &[Vector], cutoff: f64, precision: Precision) -> Cells {
    let mut each = vec![WorstOfCell::default(); problem.hexes.len()];
    problem.map_hexes(&mut each, |h| {
        let worst = Frame::new(&problem.corners_of(h, points)).worst(cutoff, precision.error(), VALUE_BOXES);
        let value = if worst.lower > 0.0 { worst.upper } else { worst.upper.min(-1e-12) };
        WorstOfCell { value, inner: worst.inner }
    });
    let worst = each.iter().map(|c| c.value).fold(f64::INFINITY, f64::min);
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

/// The worst scaled Jacobian over whole cells.
pub(crate) fn worst_value(problem: &Problem, points: &[Vector]) -> f64 {
    judge_near_worst(problem, points, 0.0, 0.0).worst
}

/// The cells that are not positive in floating point, ascending.
pub(crate) fn bad_cells(problem: &Problem, points: &[Vector]) -> Vec<usize> {
    let mut signs = vec![Sign::Positive; problem.hexes.len()];
    problem.map_hexes(&mut signs, |h| Frame::new(&problem.corners_of(h, points)).sign(WORKING_BOXES));
    (0..signs.len()).filter(|&h| signs[h] != Sign::Positive).collect()
}

/// The logarithm of the largest condition number at a corner of the hex; infinite if one is not positive.
pub(crate) fn log_condition_of(problem: &Problem, hex: usize, points: &[Vector]) -> f64 {
    let p = problem.corners_of(hex, points);
    corner_points().map(|at| log_condition(&columns(&p, &weights_at(at)))).fold(0.0, f64::max)
}

/// The logarithm of the largest condition number at any corner; infinite if one is not positive.
pub(crate) fn worst_log_condition(problem: &Problem, points: &[Vector]) -> f64 {
    let mut each = vec![0.0; problem.hexes.len()];
    problem.map_hexes(&mut each, |h| log_condition_of(problem, h, points));
    each.into_iter().fold(0.0, f64::max)
}

/// The corners of the unit cube.
pub(crate) fn corner_points() -> impl Iterator<Item = Vector> {
    POSITIONS.iter().map(|p| p.map(f64::from))
}
