//! Tiny cells deep inside grow.
//!
//! A scaled Jacobian knows no sizes, so nothing hinders whoever raises it from leaving cells a thousand times smaller than the surface's quads: the hexes
//! laid round an apex shrink by a factor from pillow to pillow. Here space is stretched round the smallest cell: in the largest ball without a
//! vertex that is fixed, of radius R round it, what is at distance r goes to `R (r/R)^gamma` with gamma below 1. That multiplies the logarithm of
//! the ratio of sizes by gamma and makes a small cell flatter by 1/gamma, no more, whatever its size; the cells that it makes poor are lifted again, and so on.
//! Minimising an energy of sizes instead, inside a barrier on scaled Jacobians, was tried and hardly moved: the whole nest must grow at once.
//!
//! Source: ours.

use super::edge_floors::EdgeFloors;
use super::patch_barriers::{lift_poor_cells, visits};
use crate::cell::frame::{FRAME_EDGES, Frame};
use crate::problem::{FIXED, Incidence, Problem};
use crate::quality::{bad_cells, worst_value};
use hexfill_geometry::{Vector, add, norm, scale, sub};
use hexfill_mesh::Context;

/// Cells smaller than this share of the fixed edges' mean are tiny.
const TINY: f64 = 0.05;
/// Times that space is stretched at most.
const STRETCHES: usize = 12;
/// Exponents, the first is taken that leaves the worst scaled Jacobian at this share of what it was before it is lifted.
const GAMMAS: [f64; 5] = [0.6, 0.7, 0.8, 0.9, 0.95];
const LEFT: f64 = 0.25;
/// A stretch makes the smallest cell greater by this factor, or it is the last.
const WORTH: f64 = 1.05;

/// Stretches space round tiny cells as long as the worst scaled Jacobian of a valid mesh stays at `floor` or comes back to it. Returns whether any grew.
pub(crate) fn inflate(problem: &Problem, points: &mut Vec<Vector>, floor: f64, context: &Context<'_>) -> bool {
    let incidence = Incidence::new(problem);
    let before = worst_value(problem, points);
    let tiny = TINY * mean_fixed_edge(problem, points);
    let (mut cell, mut size) = smallest(problem, points);
    let mut grew = false;
    for _ in 0..STRETCHES {
        if size >= tiny || context.stop().is_some() {
            break;
        }
        let stretched = GAMMAS
            .iter()
            .map(|&gamma| stretch(problem, points, cell, gamma))
            .find(|trial| bad_cells(problem, trial).is_empty() && worst_value(problem, trial) >= LEFT * before);
        let Some(mut trial) = stretched else { break };
        let floors = EdgeFloors::new(problem, &trial);
        let mut left = visits(problem.hexes.len());
        lift_poor_cells(problem, &incidence, &mut trial, &floors, before, &mut left, context);
        if worst_value(problem, &trial) < floor || !bad_cells(problem, &trial).is_empty() {
            break;
        }
        let (next, grown) = smallest(problem, &trial);
        if grown < WORTH * size {
            break;
        }
        *points = trial;
        (cell, size) = (next, grown);
        grew = true;
    }
    grew
}

/// The smallest cell and its size: the edge of the cube that has its volume.
fn smallest(problem: &Problem, points: &[Vector]) -> (usize, f64) {
    let size = |h| (Frame::new(&problem.corners_of(h, points)).bernstein().iter().sum::<f64>() / 27.0).cbrt();
    (0..problem.hexes.len())
        .map(|h| (h, size(h)))
        .fold((0, f64::INFINITY), |least, next| if next.1 < least.1 { next } else { least })
}

/// The mean length of the edges whose ends are both fixed, each taken as often as there are cells round it; zero if there is none.
fn mean_fixed_edge(problem: &Problem, points: &[Vector]) -> f64 {
    let edges = problem.hexes.iter().flat_map(|hex| FRAME_EDGES.map(|edge| edge.map(|c| hex[c] as usize)));
    let fixed = edges.filter(|edge| edge.iter().all(|&v| problem.slot[v] == FIXED));
    let (sum, count) =
        fixed.fold((0.0, 0u32), |(sum, count), [a, b]| (sum + norm(sub(points[a], points[b])), count + 1));
    sum / f64::from(count.max(1))
}

/// The points with space stretched round a cell.
fn stretch(problem: &Problem, points: &[Vector], cell: usize, gamma: f64) -> Vec<Vector> {
    let corners = problem.corners_of(cell, points);
    let centre = scale(1.0 / 8.0, corners.iter().fold([0.0; 3], |sum, &p| add(sum, p)));
    let fixed = (0..points.len()).filter(|&v| problem.slot[v] == FIXED);
    let reach = fixed.map(|v| norm(sub(points[v], centre))).fold(f64::INFINITY, f64::min);
    let mut stretched = points.to_vec();
    for &v in &problem.free {
        let p = &mut stretched[v as usize];
        let r = norm(sub(*p, centre));
        if 0.0 < r && r < reach {
            let further = (r / reach).powf(gamma - 1.0);
            *p = std::array::from_fn(|k| centre[k] + further * (p[k] - centre[k]));
        }
    }
    stretched
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::samples::{grid, grid_points};

    #[test]
    fn a_nest_of_tiny_cells_grows_and_keeps_its_quality() {
        let n = 6;
        let mesh = grid(n);
        let problem = Problem::new(mesh.n_vertices(), mesh.hexes_raw(), &mesh.boundary_vertices());
        let exact = grid_points(n);
        let half = n as f64 / 2.0;
        // Interior vertices drawn together towards the middle: by the distance along axes, so that cubes stay cubes.
        let mut points: Vec<Vector> = exact
            .iter()
            .map(|p| {
                let far = p.iter().map(|x| (x - half).abs()).fold(0.0, f64::max);
                p.map(|x| half + (x - half) * (far / half).powi(8))
            })
            .collect();
        let before = worst_value(&problem, &points);
        let small = smallest(&problem, &points).1;
        assert!(before > 0.1 && bad_cells(&problem, &points).is_empty(), "{before}");
        let fixed = points.clone();
        assert!(inflate(&problem, &mut points, 0.9 * before, &Context::default()));
        assert!(worst_value(&problem, &points) >= 0.9 * before && bad_cells(&problem, &points).is_empty());
        let large = smallest(&problem, &points).1;
        assert!(large > 3.0 * small, "{small} {large}");
        assert!((0..points.len()).filter(|&v| problem.slot[v] == FIXED).all(|v| points[v] == fixed[v]));
        // Nothing is tiny in a grid.
        let mut even = exact.clone();
        assert!(!inflate(&problem, &mut even, 0.9, &Context::default()) && even == exact);
    }
}
