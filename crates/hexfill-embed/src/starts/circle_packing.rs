//! Circle packings: an orthogonal packing of vertices and quads of a sphere in the plane.
//!
//! Every 3-connected planar graph has one circle a vertex and one a face, touching along edges and orthogonal across them, unique up to Moebius
//! maps (Koebe 1936, Andreev 1970, Thurston). Radii as in Bobenko, Springborn 2004 ("Variational principles for circle patterns and
//! Koebe's theorem"): send one touching point to infinity, so that its two vertices and two faces become the sides of a rectangle; the
//! logarithmic radii of all others minimise a convex function whose gradient is "target angle minus sum of kite angles",
//! `2 atan(r_j / r_i)` per kite.
//!
//! Source: Bobenko, Springborn 2004; existence: Koebe 1936, Andreev 1970.

use crate::error::EmbedError;
use crate::solvers::conjugate_gradients::{Limits, conjugate_gradients};
use crate::solvers::long_vectors::dot_long;
use hexfill_mesh::{Dart, QuadSurface, VertexId};
use std::f64::consts::{PI, TAU};

/// The circles: one per vertex (index v) and one per quad (index n_vertices + q). A kite is a dart: the circle of its
/// origin and the circle of its quad, from the touching point of the dart's edge to that of the previous dart's.
pub(super) struct Packing {
    pub(super) n_vertices: usize,
    /// The dart whose touching point is at infinity; its ends and the quads on both sides are lines.
    pub(super) infinite: Dart,
    /// Logarithms of the radii; meaningless for the four lines.
    pub(super) log_radius: Vec<f64>,
    pub(super) is_line: Vec<bool>,
    /// The finite kites as pairs of circles.
    kites: Vec<(usize, usize)>,
    /// Per circle the sum its kite angles must have.
    target: Vec<f64>,
}

impl Packing {
    /// Solves for the radii.
    ///
    /// # Errors
    /// [`EmbedError::NotConverged`].
    pub(super) fn new(surface: &QuadSurface) -> Result<Self, EmbedError> {
        let n_vertices = surface.n_vertices();
        let n = n_vertices + surface.n_quads();
        // The edge with the largest degrees leaves the fewest and most even circles.
        let infinite = surface
            .darts()
            .max_by_key(|&d| {
                let degrees = surface.degree(surface.origin(d)) + surface.degree(surface.target(d));
                (degrees, std::cmp::Reverse(d))
            })
            .expect("a sphere has edges");
        // A circle through the point at infinity is a line: sending one touching point there takes four circles out
        // of the unknowns, and the others keep plain angle sums.
        let mut is_line = vec![false; n];
        is_line[surface.origin(infinite).index()] = true;
        is_line[surface.target(infinite).index()] = true;
        is_line[n_vertices + infinite.quad().index()] = true;
        is_line[n_vertices + surface.twin(infinite).quad().index()] = true;
        // Kites round a circle fill the full angle.
        let mut target = vec![TAU; n];
        let mut kites = Vec::new();
        for d in surface.darts() {
            let (v, q) = (surface.origin(d).index(), n_vertices + d.quad().index());
            match (is_line[v], is_line[q]) {
                (false, false) => kites.push((v, q)),
                // The angle of a kite with a line is straight.
                (false, true) => target[v] -= PI,
                (true, false) => target[q] -= PI,
                (true, true) => {}
            }
        }
        let mut packing = Self { n_vertices, infinite, log_radius: vec![0.0; n], is_line, kites, target };
        packing.solve(surface)?;
        Ok(packing)
    }

    /// The gradient: target minus angle sum; zero at lines and unused vertices.
    fn gradient(&self, log_radius: &[f64], used: &[bool]) -> Vec<f64> {
        let mut g: Vec<f64> = (0..used.len()).map(|i| if used[i] { self.target[i] } else { 0.0 }).collect();
        for &(v, q) in &self.kites {
            let ratio = (log_radius[q] - log_radius[v]).exp();
            g[v] -= 2.0 * ratio.atan();
            g[q] -= 2.0 * ratio.recip().atan();
        }
        g
    }

    /// Newton's method; the Hessian is the Laplacian with weight 1 / cosh(difference) per kite.
    fn solve(&mut self, surface: &QuadSurface) -> Result<(), EmbedError> {
        const LIMIT: f64 = 1e-9;
        let used: Vec<bool> = (0..self.target.len())
            .map(|i| !self.is_line[i] && (i >= self.n_vertices || surface.degree(VertexId::new(i)) > 0))
            .collect();
        let mut rho = self.log_radius.clone();
        let mut g = self.gradient(&rho, &used);
        let largest = |g: &[f64]| g.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        for _ in 0..60 {
            if largest(&g) < 4e-15 {
                break;
            }
            let weights: Vec<f64> = self.kites.iter().map(|&(v, q)| 1.0 / (rho[q] - rho[v]).cosh()).collect();
            let step = self.laplacian_solve(&weights, &g, &used);
            let slope: f64 = -g.iter().zip(&step).map(|(g, s)| g * s).sum::<f64>();
            let mut t = 1.0;
            let mut moved = None;
            for _ in 0..40 {
                let trial: Vec<f64> = rho.iter().zip(&step).map(|(r, s)| r - t * s).collect();
                let trial_g = self.gradient(&trial, &used);
                // The function is convex: its derivative along the step must not have overshot.
                let along: f64 = -trial_g.iter().zip(&step).map(|(g, s)| g * s).sum::<f64>();
                // Values of the function need dilogarithms and its derivative does not: convexity lets the search do
                // with slopes alone.
                if along <= 0.9 * slope.abs() {
                    moved = Some((trial, trial_g));
                    break;
                }
                t *= 0.5;
            }
            let Some((trial, trial_g)) = moved else { break };
            // At rounding level further steps only shuffle the last bits.
            if largest(&g) < 1e-12 && largest(&trial_g) >= largest(&g) {
                break;
            }
            (rho, g) = (trial, trial_g);
        }
        self.log_radius = rho;
        let reached = largest(&g);
        if reached < LIMIT { Ok(()) } else { Err(EmbedError::NotConverged { given: reached, limit: LIMIT }) }
    }

    /// Solves L x = g by conjugate gradients; L is singular along constants, and so is g orthogonal to them.
    fn laplacian_solve(&self, weights: &[f64], g: &[f64], used: &[bool]) -> Vec<f64> {
        let n = g.len();
        let mut diagonal = vec![0.0; n];
        for (&(v, q), &w) in self.kites.iter().zip(weights) {
            diagonal[v] += w;
            diagonal[q] += w;
        }
        diagonal.iter_mut().zip(used).filter(|(_, used)| !**used).for_each(|(d, _)| *d = f64::INFINITY);
        let apply = |x: &[f64], out: &mut [f64]| {
            out.fill(0.0);
            for (&(v, q), &w) in self.kites.iter().zip(weights) {
                let flow = w * (x[v] - x[q]);
                out[v] += flow;
                out[q] -= flow;
            }
        };
        // Radii are determined up to a common factor, so L is singular along constants; rounding must not put
        // anything there.
        let mean = g.iter().sum::<f64>() / used.iter().filter(|&&u| u).count() as f64;
        let residual: Vec<f64> = (0..n).map(|i| if used[i] { g[i] - mean } else { 0.0 }).collect();
        let scaled: Vec<f64> = residual.iter().zip(&diagonal).map(|(r, d)| r / d).collect();
        let limits = Limits { iterations: 20 * n, residual: 1e-26 * dot_long(&residual, &scaled) };
        let mut x = vec![0.0; n];
        conjugate_gradients(&mut x, residual, &diagonal, limits, apply, || false);
        x
    }
}
