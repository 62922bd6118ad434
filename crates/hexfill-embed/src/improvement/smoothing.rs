//! A few sweeps of smoothing: every free vertex towards the mean of its neighbours.
//!
//! Damped Jacobi iteration for the graph Laplacian, each edge weighted by the hexes round it. It takes off what changes from cell to cell, and leaves the
//! shape at large as it is (the smoother of multigrid methods: Briggs, Henson and McCormick 2000, chapter 2): in a grid, what changes sign along all
//! axes falls to a third a sweep. Without damping it would only change its sign.
//!
//! Source: Briggs, Henson, McCormick 2000, chapter 2.

use crate::problem::Problem;
use crate::solvers::long_vectors::fill;
use hexfill_geometry::{Vector, add, add_scaled, scale};
use hexfill_mesh::cube::CORNER_NEIGHBOURS;

const DAMPING: f64 = 2.0 / 3.0;

/// Moves the free vertices of `points` by so many sweeps. Not for symmetric variables.
pub(super) fn smooth(problem: &Problem, points: &mut [Vector], sweeps: usize) {
    let mut moved = vec![[0.0; 3]; problem.free.len()];
    for _ in 0..sweeps {
        let at = &*points;
        fill(&mut moved, |s| {
            let places = problem.places(s);
            let mut sum = [0.0; 3];
            for &place in places {
                let hex = &problem.hexes[place as usize / 8];
                for n in CORNER_NEIGHBOURS[place as usize % 8] {
                    sum = add(sum, at[hex[n] as usize]);
                }
            }
            let mean = scale(1.0 / (3 * places.len()) as f64, sum);
            add_scaled(scale(1.0 - DAMPING, at[problem.free[s] as usize]), DAMPING, mean)
        });
        for (&v, &p) in problem.free.iter().zip(&moved) {
            points[v as usize] = p;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::samples::{grid, grid_points};
    use hexfill_geometry::{norm, sub};
    use hexfill_mesh::Random;

    #[test]
    fn a_grid_stays_and_noise_goes() {
        let n = 12;
        let mesh = grid(n);
        let fixed = mesh.boundary_vertices();
        let problem = Problem::new(fixed.len(), mesh.hexes_raw(), &fixed);
        let exact = grid_points(n);
        let largest = |points: &[Vector]| points.iter().zip(&exact).map(|(&a, &b)| norm(sub(a, b))).fold(0.0, f64::max);
        let mut points = exact.clone();
        smooth(&problem, &mut points, 3);
        assert!(largest(&points) < 1e-12);
        let mut random = Random::of_task(71, 0);
        for (p, _) in points.iter_mut().zip(&fixed).filter(|(_, fixed)| !**fixed) {
            *p = p.map(|x| x + 0.5 * random.signed());
        }
        let before = largest(&points);
        smooth(&problem, &mut points, 10);
        assert!(largest(&points) < 0.25 * before, "{before} {}", largest(&points));
    }
}
