//! The foldover-free energy of a hex mesh (Garanzha, Kaporin, Kudryavtseva, Protais, Ray, Sokolov 2021, arXiv 2102.03069).
//!
//! Every term takes three edge vectors of one hex, one per direction, as the columns of a 3 x 3 matrix J measured in the
//! hex's own length: `f = (tr J^T J / 3)^(3/2) / chi(eps, det J)` with `chi(e, D) = (D + sqrt(e^2 + D^2)) / 2`.
//! A volume term `(D^2 + 1) / (2 chi)` can be added with a weight.
//! With eps > 0 it is finite on inverted terms and pulls them right; as eps falls to 0 it becomes a barrier.
//! A hex starts with the eight corner terms; any of the 64 mixed determinants of its Bernstein form can be added,
//! and with all of them positive det J is positive in the whole cell.
//!
//! Source: Garanzha et al. 2021; the mixed determinants as further terms are ours, after Johnen, Weill, Remacle 2017.

use crate::cell::frame::{BOTTOM_CORNERS, CORNER_MIXED, CORNERS, FRAME_EDGES, Frame, MIXED, PYRAMID_EDGES};
use crate::problem::Problem;
use hexfill_geometry::{Vector, add_scaled, cross, det, dot, norm, sub};

/// The energy and its work space.
pub(crate) struct Energy<'p> {
    pub(crate) problem: &'p Problem,
    /// Per hex: which of the 64 mixed determinants take part.
    pub(crate) terms: Vec<u64>,
    /// Per hex: its length, the unit of its terms.
    sizes: Vec<f64>,
    /// Per hex: its value and the gradient by corner.
    rows: Vec<(f64, [Vector; 8])>,
    /// The regularisation, dimensionless.
    pub(crate) epsilon: f64,
    /// Weight of the volume term `(D^2 + 1) / (2 chi)`; if positive, every hex has the same unit of length.
    volume_weight: f64,
}

/// `chi(e, D)`, without cancellation for negative D.
pub(crate) fn chi(epsilon: f64, d: f64) -> f64 {
    1.0 / inverse_chi(epsilon, d, (epsilon * epsilon + d * d).sqrt())
}

/// `1 / chi(e, D)` given `sqrt(e^2 + D^2)`.
fn inverse_chi(epsilon: f64, d: f64, hypotenuse: f64) -> f64 {
    let sum = hypotenuse + d.abs();
    // For d << 0 the sum d + hypotenuse cancels to nothing; e^2 over their difference is the same number.
    if d > 0.0 { 2.0 / sum } else { 2.0 * sum / (epsilon * epsilon) }
}

impl<'p> Energy<'p> {
    /// The energy with the corner terms; sizes are taken from `points`.
    ///
    /// With `volume_weight` 0 only shapes count, and each hex is measured in its own length. With a positive one every cell is
    /// also pushed towards the same share of the volume, which keeps inverted cells from hiding by shrinking.
    pub(crate) fn new(problem: &'p Problem, points: &[Vector], volume_weight: f64) -> Self {
        let n = problem.hexes.len();
        let mut energy = Self {
            problem,
            terms: (0..n).map(|h| if problem.is_pyramid(h) { BOTTOM_CORNERS } else { CORNERS }).collect(),
            sizes: vec![1.0; n],
            rows: vec![(0.0, [[0.0; 3]; 8]); n],
            epsilon: 1.0,
            volume_weight,
        };
        energy.measure(points);
        energy
    }

    /// Takes each hex's length afresh: the geometric mean of its edges, none counted below 1e-3 of its longest
    /// (a collapsed hex must not make its terms infinite).
    pub(crate) fn measure(&mut self, points: &[Vector]) {
        let problem = self.problem;
        let mut sizes = std::mem::take(&mut self.sizes);
        // The signed volumes add up to the volume inside the boundary, however tangled the cells are.
        problem.map_hexes(&mut sizes, |h| {
            Frame::new(&problem.corners_of(h, points)).bernstein().iter().sum::<f64>() / 27.0
        });
        let volume: f64 = sizes.iter().sum();
        let share = (volume.abs() / problem.hexes.len() as f64).cbrt().max(1e-12);
        if self.volume_weight > 0.0 {
            sizes.fill(share);
        } else {
            problem.map_hexes(&mut sizes, |h| {
                let p = problem.corners_of(h, points);
                let lengths = FRAME_EDGES.map(|[a, b]| norm(sub(p[b], p[a])));
                let longest = lengths.iter().fold(0.0, |m: f64, &l| m.max(l)).max(0.01 * share);
                let log = |n: usize| lengths[n].max(1e-3 * longest).ln();
                if problem.is_pyramid(h) {
                    return (PYRAMID_EDGES.map(log).iter().sum::<f64>() / 8.0).exp();
                }
                ((0..12).map(log).sum::<f64>() / 12.0).exp()
            });
        }
        self.sizes = sizes;
    }

    /// The smallest determinant of a term, in units of its hex.
    pub(crate) fn smallest_determinant(&mut self, points: &[Vector]) -> f64 {
        let (problem, terms, sizes) = (self.problem, &self.terms, &self.sizes);
        problem.map_hexes(&mut self.rows, |h| {
            let frame = Frame::new(&problem.corners_of(h, points));
            let unit = sizes[h].powi(-3);
            let smallest = bits(terms[h])
                .map(|n| {
                    let [a, b, c] = MIXED[n].edges;
                    unit * det(frame.0[0][a], frame.0[1][b], frame.0[2][c])
                })
                .fold(f64::INFINITY, |m, d| if d < m || d.is_nan() { d } else { m });
            (smallest, [[0.0; 3]; 8])
        });
        self.rows.iter().fold(f64::INFINITY, |m, &(d, _)| if d < m || d.is_nan() { d } else { m })
    }

    /// How many hexes had a term that was not positive when [`smallest_determinant`](Self::smallest_determinant) was last asked.
    pub(crate) fn n_not_positive(&self) -> usize {
        self.rows.iter().filter(|row| row.0.is_nan() || row.0 <= 0.0).count()
    }

    /// The value at `points`, and the gradient by variable (three numbers each).
    pub(crate) fn evaluate(&mut self, points: &[Vector], gradient: &mut [f64]) -> f64 {
        let (problem, terms, sizes, epsilon) = (self.problem, &self.terms, &self.sizes, self.epsilon);
        let volume_weight = self.volume_weight;
        problem.map_hexes(&mut self.rows, |h| {
            hex_energy(&problem.corners_of(h, points), terms[h], sizes[h], epsilon, volume_weight)
        });
        problem.sum_at_variables(&self.rows, gradient);
        self.rows.iter().map(|row| row.0).sum()
    }

    /// Per number of the variables: an inverse diagonal of the right order for L-BFGS, 1 / sum of 1 / size^2.
    pub(crate) fn inverse_diagonal(&self) -> Vec<f64> {
        self.problem.by_variable(|s| {
            let sum: f64 = self.problem.places(s).iter().map(|&p| self.sizes[p as usize / 8].powi(-2)).sum();
            0.1 / sum
        })
    }
}

/// The numbers of the bits set.
fn bits(mut set: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        (set != 0).then(|| {
            let n = set.trailing_zeros() as usize;
            set &= set - 1;
            n
        })
    })
}

/// The energy of one hex, and its gradient by corner.
fn hex_energy(p: &[Vector; 8], terms: u64, size: f64, epsilon: f64, volume_weight: f64) -> (f64, [Vector; 8]) {
    let inverse = 1.0 / size;
    let frame = Frame(Frame::new(p).0.map(|d| d.map(|e| e.map(|x| x * inverse))));
    let mut sum = Sum { squares: frame.0.map(|d| d.map(|e| dot(e, e))), frame, value: 0.0, edges: [[[0.0; 3]; 4]; 3] };
    if terms == CORNERS {
        // Nearly every hex. The compiler knows these, which makes it faster by half.
        CORNER_MIXED.into_iter().for_each(|n| sum.add(n, epsilon, volume_weight));
    } else {
        bits(terms).for_each(|n| sum.add(n, epsilon, volume_weight));
    }
    let mut gradient = [[0.0; 3]; 8];
    for (n, [from, to]) in FRAME_EDGES.into_iter().enumerate() {
        let g = sum.edges[n / 4][n % 4];
        gradient[to] = add_scaled(gradient[to], inverse, g);
        gradient[from] = add_scaled(gradient[from], -inverse, g);
    }
    if sum.value.is_finite() { (sum.value, gradient) } else { (f64::INFINITY, [[0.0; 3]; 8]) }
}

/// The terms of one hex as they add up.
struct Sum {
    frame: Frame,
    /// Squared lengths of the edges.
    squares: [[f64; 4]; 3],
    value: f64,
    /// The gradient by edge.
    edges: [[Vector; 4]; 3],
}

impl Sum {
    /// Adds the term of one mixed determinant. Untangling spends most of its time here.
    #[inline(always)]
    fn add(&mut self, mixed: usize, epsilon: f64, volume_weight: f64) {
        let [a, b, c] = MIXED[mixed].edges;
        let (e1, e2, e3) = (self.frame.0[0][a], self.frame.0[1][b], self.frame.0[2][c]);
        let trace = (self.squares[0][a] + self.squares[1][b] + self.squares[2][c]) / 3.0;
        let n1 = cross(e2, e3);
        let d = dot(e1, n1);
        let hypotenuse = (epsilon * epsilon + d * d).sqrt();
        let inverse = inverse_chi(epsilon, d, hypotenuse);
        let root = trace.sqrt();
        let value = (root * trace + volume_weight * 0.5 * (d * d + 1.0)) * inverse;
        self.value += value;
        // d chi / d D = chi / sqrt(e^2 + D^2).
        let along_edge = root * inverse;
        let along_det = volume_weight * d * inverse - value / hypotenuse;
        for ((axis, n), e, normal) in [((0, a), e1, n1), ((1, b), e2, cross(e3, e1)), ((2, c), e3, cross(e1, e2))] {
            let row = &mut self.edges[axis][n];
            *row = add_scaled(add_scaled(*row, along_edge, e), along_det, normal);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::Random;

    #[test]
    fn gradient_matches_differences() {
        let mut random = Random::of_task(5, 0);
        for terms in [CORNERS, u64::MAX, CORNERS | 1 << 17] {
            let p: [Vector; 8] = hexfill_mesh::cube::POSITIONS.map(|p| p.map(|x| f64::from(x) + 0.8 * random.signed()));
            let (_, g) = hex_energy(&p, terms, 0.7, 0.5, 0.3);
            for corner in 0..8 {
                for k in 0..3 {
                    let h = 1e-6;
                    let at = |t: f64| {
                        let mut q = p;
                        q[corner][k] += t;
                        hex_energy(&q, terms, 0.7, 0.5, 0.3).0
                    };
                    let slope = (at(h) - at(-h)) / (2.0 * h);
                    assert!((slope - g[corner][k]).abs() < 1e-5 * (1.0 + slope.abs()), "{slope} {}", g[corner][k]);
                }
            }
        }
    }

    #[test]
    fn chi_is_smooth_and_positive() {
        for d in [-10.0, -1.0, -1e-9, 0.0, 1e-9, 1.0] {
            assert!(chi(1e-3, d) > 0.0);
        }
        assert!((chi(0.0, 2.0) - 2.0).abs() < 1e-15);
        assert!((chi(1.0, -1e-9) - chi(1.0, 1e-9)).abs() < 1e-8);
    }
}
