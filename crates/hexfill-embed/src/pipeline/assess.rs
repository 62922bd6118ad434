//! The report: positions judged as they are returned.
//!
//! Source: ours.

use super::normal::Normal;
use crate::cell::frame::Frame;
use crate::quality::{bad_cells, log_condition_of};
use crate::report::CellQuality;
use hexfill_geometry::{Vector, norm, sub};
use hexfill_mesh::HexId;
use hexfill_mesh::cube::EDGES;

/// The cells named in the report.
const WORST_CELLS: usize = 10;

/// What is said of positions.
pub(super) struct Assessment {
    pub(super) n_invalid: usize,
    /// The worst cells, worst first; at least one.
    pub(super) worst_cells: Vec<CellQuality>,
    /// A lower bound on all scaled Jacobians.
    pub(super) bound: f64,
    /// The largest condition number at a corner.
    pub(super) condition: f64,
    /// In the unit of the caller.
    pub(super) shortest_edge: f64,
}

/// What is known of a cell: bounds of its worst scaled Jacobian and the logarithm of its largest condition number.
#[derive(Clone, Copy, Default)]
struct Known {
    lower: f64,
    upper: f64,
    log_condition: f64,
}

/// Judges `points`, in the coordinates of the caller.
pub(super) fn assess(normal: &Normal, points: &[Vector]) -> Assessment {
    let problem = &normal.problem;
    let points = normal.normalise(points);
    let mut cells = judge_cells(normal, &points);
    let bad = bad_cells(problem, &points);
    for &h in &bad {
        cells[h].upper = cells[h].upper.min(0.0);
    }
    let mut order: Vec<usize> = (0..cells.len()).collect();
    order.sort_by(|&a, &b| cells[a].upper.total_cmp(&cells[b].upper).then(a.cmp(&b)));
    order.truncate(WORST_CELLS);
    let shortest = problem
        .hexes
        .iter()
        .flat_map(|h| EDGES.map(|[i, j]| norm(sub(points[h[i] as usize], points[h[j] as usize]))))
        .fold(f64::INFINITY, f64::min);
    let named = |&h: &usize| CellQuality { hex: HexId::new(h), scaled_jacobian: cells[h].upper };
    Assessment {
        n_invalid: bad.len(),
        worst_cells: order.iter().map(named).collect(),
        bound: cells.iter().map(|c| c.lower).fold(f64::INFINITY, f64::min),
        condition: cells.iter().map(|c| c.log_condition).fold(0.0, f64::max).exp(),
        shortest_edge: shortest * normal.scale,
    }
}

/// Bounds of all cells; only those that may be among the worst are cut fine.
fn judge_cells(normal: &Normal, points: &[Vector]) -> Vec<Known> {
    let problem = &normal.problem;
    let mut cells = vec![Known::default(); problem.hexes.len()];
    problem.map_hexes(&mut cells, |h| {
        let worst = Frame::new(&problem.corners_of(h, points)).worst(1.0, 1e-2, 20);
        Known { lower: worst.lower, upper: worst.upper, log_condition: log_condition_of(problem, h, points) }
    });
    let mut uppers: Vec<f64> = cells.iter().map(|c| c.upper).collect();
    let last = uppers.len().min(WORST_CELLS) - 1;
    let (_, &mut limit, _) = uppers.select_nth_unstable_by(last, f64::total_cmp);
    let coarse = cells.clone();
    problem.map_hexes(&mut cells, |h| {
        if coarse[h].lower > limit {
            return coarse[h];
        }
        let worst = Frame::new(&problem.corners_of(h, points)).worst(1.0, 1e-9, 2000);
        Known { lower: worst.lower, upper: worst.upper, ..coarse[h] }
    });
    cells
}
