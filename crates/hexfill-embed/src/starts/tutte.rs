//! Start positions: every free vertex at the weighted mean of its neighbours (Tutte 1963, "How to draw a graph"; graph Laplacian).
//!
//! With the fixed vertices' part moved to the right the matrix is symmetric, and positive definite wherever a path of edges joins a
//! variable to a fixed vertex, so conjugate gradients solve it; the diagonal preconditions. Unit weights for the first start, random
//! weights for restarts. The fixed vertices do not move. (Tutte's theorem is about planar graphs: in space cells may well be inverted.)
//!
//! Source: Tutte 1963.

use crate::problem::Problem;
use crate::solvers::conjugate_gradients::{Limits, conjugate_gradients};
use crate::solvers::long_vectors::{dot_long, fill};
use hexfill_geometry::Vector;
use hexfill_mesh::cube::EDGES;
use hexfill_mesh::{Context, Random};

/// How neighbours count.
pub(crate) enum Weights<'r> {
    /// All the same.
    Unit,
    /// Each edge `exp(r)`, with r uniform in [-1, 1).
    Random(&'r mut Random),
}

/// Neighbours and weights of the free vertices, row by row.
struct Laplacian {
    start: Vec<u32>,
    /// Neighbour vertex and weight.
    entries: Vec<(u32, f64)>,
    diagonal: Vec<f64>,
}

impl Laplacian {
    fn new(problem: &Problem, weights: Weights<'_>) -> Self {
        let mut edges: Vec<(u32, u32)> = problem
            .hexes
            .iter()
            .flat_map(|h| EDGES.map(|[i, j]| if h[i] < h[j] { (h[i], h[j]) } else { (h[j], h[i]) }))
            .collect();
        edges.sort_unstable();
        edges.dedup();
        let weights: Vec<f64> = match weights {
            Weights::Unit => vec![1.0; edges.len()],
            Weights::Random(random) => edges.iter().map(|_| random.signed().exp()).collect(),
        };
        let n = problem.free.len();
        // Rows of free vertices only; fixed neighbours are entries that go to the right side later. The edges are
        // sorted, so the sums have one order.
        let mut start = vec![0u32; n + 1];
        let slot = |v: u32| problem.slot[v as usize] as usize;
        for &(a, b) in &edges {
            for v in [a, b] {
                if slot(v) < n {
                    start[slot(v) + 1] += 1;
                }
            }
        }
        for s in 0..n {
            start[s + 1] += start[s];
        }
        let mut cursor = start.clone();
        let mut entries = vec![(0, 0.0); start[n] as usize];
        let mut diagonal = vec![0.0; n];
        for (&(a, b), &w) in edges.iter().zip(&weights) {
            for (v, other) in [(a, b), (b, a)] {
                if slot(v) < n {
                    let at = &mut cursor[slot(v)];
                    entries[*at as usize] = (other, w);
                    *at += 1;
                    diagonal[slot(v)] += w;
                }
            }
        }
        Self { start, entries, diagonal }
    }

    fn row(&self, s: usize) -> &[(u32, f64)] {
        &self.entries[self.start[s] as usize..self.start[s + 1] as usize]
    }

    /// `out = L x` over the variables, one coordinate.
    fn apply(&self, problem: &Problem, x: &[f64], out: &mut [f64]) {
        fill(out, |s| {
            let mut sum = self.diagonal[s] * x[s];
            for &(v, w) in self.row(s) {
                let other = problem.slot[v as usize] as usize;
                if other < x.len() {
                    sum -= w * x[other];
                }
            }
            sum
        });
    }
}

/// Places the free vertices of `points`; with `is_guess` they start from where they are. Variables that no path of edges joins to a fixed
/// vertex stay where they are. Told to stop, it leaves them on the way if there are many.
pub(crate) fn place_at_means(
    problem: &Problem,
    points: &mut [Vector],
    weights: Weights<'_>,
    is_guess: bool,
    context: &Context<'_>,
) {
    let laplacian = Laplacian::new(problem, weights);
    let n = problem.free.len();
    // The centre of the fixed points is a better first guess than the origin.
    let fixed: Vec<usize> = (0..problem.n_vertices).filter(|&v| problem.slot[v] as usize >= n).collect();
    for k in 0..3 {
        let centre = fixed.iter().map(|&v| points[v][k]).sum::<f64>() / fixed.len().max(1) as f64;
        let mut right = vec![0.0; n];
        fill(&mut right, |s| {
            let row = laplacian.row(s).iter();
            row.filter(|(v, _)| problem.slot[*v as usize] as usize >= n).map(|&(v, w)| w * points[v as usize][k]).sum()
        });
        let guess = problem.free.iter().map(|&v| if is_guess { points[v as usize][k] } else { centre }).collect();
        let x = solve(problem, &laplacian, &right, guess, context);
        for (s, &v) in problem.free.iter().enumerate() {
            points[v as usize][k] = x[s];
        }
    }
}

/// So few variables are solved for in a moment.
const QUICK: usize = 10_000;

/// Solves `L x = right` from a guess, one coordinate.
fn solve(problem: &Problem, laplacian: &Laplacian, right: &[f64], guess: Vec<f64>, context: &Context<'_>) -> Vec<f64> {
    let n = right.len();
    let mut x = guess;
    let mut applied = vec![0.0; n];
    laplacian.apply(problem, &x, &mut applied);
    let residual: Vec<f64> = right.iter().zip(&applied).map(|(b, a)| b - a).collect();
    let scaled: Vec<f64> = right.iter().zip(&laplacian.diagonal).map(|(r, d)| r / d).collect();
    let limits =
        Limits { iterations: 2000.min(4 * n + 10), residual: 1e-20 * dot_long(right, &scaled).max(f64::MIN_POSITIVE) };
    let apply = |x: &[f64], out: &mut [f64]| laplacian.apply(problem, x, out);
    let stop = || n > QUICK && context.stop().is_some();
    conjugate_gradients(&mut x, residual, &laplacian.diagonal, limits, apply, stop);
    x
}
