//! Start positions: every free vertex at the weighted mean of its neighbours (Tutte 1963; graph Laplacian).
//!
//! Solved by conjugate gradients with the diagonal as preconditioner; unit weights for the first start, random
//! weights for restarts. The fixed vertices do not move.

use crate::problem::{Problem, add_long, dot_long, fill};
use crate::vector::Vector;
use hexfill_mesh::cube::EDGES;
use hexfill_mesh::{Context, Random};

/// Neighbours and weights of the free vertices, row by row.
struct Laplacian {
    start: Vec<u32>,
    /// Neighbour vertex and weight.
    entries: Vec<(u32, f64)>,
    diagonal: Vec<f64>,
}

impl Laplacian {
    /// `spread` = 0 gives unit weights; else a weight is `exp(spread * r)` with r uniform in [-1, 1).
    fn new(problem: &Problem, spread: f64, random: &mut Random) -> Self {
        let mut edges: Vec<(u32, u32)> = problem
            .hexes
            .iter()
            .flat_map(|h| EDGES.map(|[i, j]| if h[i] < h[j] { (h[i], h[j]) } else { (h[j], h[i]) }))
            .collect();
        edges.sort_unstable();
        edges.dedup();
        let weights: Vec<f64> =
            edges.iter().map(|_| if spread > 0.0 { (spread * random.signed()).exp() } else { 1.0 }).collect();
        let n = problem.free.len();
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

/// Places the free vertices of `points`; with `is_guess` they start from where they are. Variables that no path of edges joins to a fixed vertex stay where they are.
/// Told to stop, it leaves them on the way.
pub(crate) fn place(
    problem: &Problem,
    points: &mut [Vector],
    spread: f64,
    is_guess: bool,
    random: &mut Random,
    context: &Context<'_>,
) {
    let laplacian = Laplacian::new(problem, spread, random);
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
        let x = conjugate_gradients(problem, &laplacian, &right, guess, context);
        for (s, &v) in problem.free.iter().enumerate() {
            points[v as usize][k] = x[s];
        }
    }
}

fn conjugate_gradients(
    problem: &Problem,
    laplacian: &Laplacian,
    right: &[f64],
    guess: Vec<f64>,
    context: &Context<'_>,
) -> Vec<f64> {
    let n = right.len();
    let mut x = guess;
    let mut applied = vec![0.0; n];
    laplacian.apply(problem, &x, &mut applied);
    let mut residual: Vec<f64> = right.iter().zip(&applied).map(|(b, a)| b - a).collect();
    let precondition = |r: &[f64]| -> Vec<f64> { r.iter().zip(&laplacian.diagonal).map(|(r, d)| r / d).collect() };
    let mut z = precondition(&residual);
    let mut p = z.clone();
    let mut rz = dot_long(&residual, &z);
    let enough = 1e-20 * dot_long(right, &precondition(right)).max(f64::MIN_POSITIVE);
    for _ in 0..2000.min(4 * n + 10) {
        if rz <= enough || context.stop().is_some() {
            break;
        }
        laplacian.apply(problem, &p, &mut applied);
        let alpha = rz / dot_long(&p, &applied);
        if !alpha.is_finite() {
            break;
        }
        add_long(&mut x, alpha, &p);
        add_long(&mut residual, -alpha, &applied);
        z = precondition(&residual);
        let next = dot_long(&residual, &z);
        let beta = next / rz;
        rz = next;
        p.iter_mut().zip(&z).for_each(|(p, z)| *p = z + beta * *p);
    }
    x
}
