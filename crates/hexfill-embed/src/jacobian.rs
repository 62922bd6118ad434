//! The Jacobian of the trilinear map of one hex: Bernstein form, corner and whole-cell bounds, in floating point.
//!
//! Idea: the three columns of J are bilinear, each the interpolation of the four edge vectors of one direction,
//! so a sub-box of the cell is again twelve vectors ([`Frame`]) and the same formulas serve every box.
//! det J is tri-quadratic; its 27 Bernstein coefficients are averages of mixed determinants of edge vectors
//! (Johnen, Weill, Remacle 2017, arXiv 1706.01613), and all of them positive implies det J > 0 on the whole box.
//! With N the same averages of the products of edge lengths, `B >= t N` and `t >= 0` imply that the scaled
//! Jacobian is at least `t` on the whole box, because a length is a convex function of the interpolated vectors.
//!
//! These are judgements in floating point, used to steer and to report; proofs are the business of `hexfill-check`.

use crate::vector::{Vector, add, cross, det, dot, midpoint, norm, scale, sub};

/// The edge vectors of a box: four along x indexed by `y + 2 z`, four along y by `x + 2 z`, four along z by `x + 2 y`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame(pub(crate) [[Vector; 4]; 3]);

/// Ends (from, to) of the edges of a hex in the order of [`Frame`], edge `4 * direction + index`.
pub(crate) const FRAME_EDGES: [[usize; 2]; 12] =
    [[0, 1], [3, 2], [4, 5], [7, 6], [0, 3], [1, 2], [4, 7], [5, 6], [0, 4], [1, 5], [3, 7], [2, 6]];

/// One of the 64 mixed determinants: its three edges and the Bernstein coefficient (`9 i + 3 j + k`) it belongs to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mixed {
    /// Index (0..4) of the edge along x, y and z.
    pub(crate) edges: [usize; 3],
    /// The Bernstein coefficient.
    pub(crate) coefficient: usize,
}

/// The 64 mixed determinants; number `16 e1 + 4 e2 + e3`.
pub(crate) const MIXED: [Mixed; 64] = {
    let mut table = [Mixed { edges: [0; 3], coefficient: 0 }; 64];
    let mut n = 0;
    while n < 64 {
        let (e1, e2, e3) = (n / 16, n / 4 % 4, n % 4);
        let i = e2 % 2 + e3 % 2;
        let j = e1 % 2 + e3 / 2;
        let k = e1 / 2 + e2 / 2;
        table[n] = Mixed { edges: [e1, e2, e3], coefficient: 9 * i + 3 * j + k };
        n += 1;
    }
    table
};

/// How many mixed determinants each Bernstein coefficient averages.
const MIXED_COUNT: [f64; 27] = {
    let mut count = [0.0; 27];
    let mut n = 0;
    while n < 64 {
        count[MIXED[n].coefficient] += 1.0;
        n += 1;
    }
    count
};

/// The mixed determinants that are the Jacobian at the eight corners, as a bit set over [`MIXED`].
pub(crate) const CORNERS: u64 = {
    let mut set = 0;
    let mut n = 0;
    while n < 64 {
        let c = MIXED[n].coefficient;
        if c / 9 != 1 && c / 3 % 3 != 1 && c % 3 != 1 {
            set |= 1 << n;
        }
        n += 1;
    }
    set
};

/// The members of [`CORNERS`].
pub(crate) const CORNER_MIXED: [usize; 8] = {
    let mut list = [0; 8];
    let (mut n, mut found) = (0, 0);
    while n < 64 {
        if CORNERS >> n & 1 == 1 {
            list[found] = n;
            found += 1;
        }
        n += 1;
    }
    list
};

/// What floating point says of the sign of det J on a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sign {
    /// Positive everywhere.
    Positive,
    /// Zero or negative somewhere.
    NotPositive,
    /// Not settled within the box limit; treated as not positive.
    Unsettled,
}

impl Frame {
    /// The frame of a hex from its eight corners in VTK order.
    #[inline]
    pub(crate) fn new(p: &[Vector; 8]) -> Self {
        let e = |n: usize| sub(p[FRAME_EDGES[n][1]], p[FRAME_EDGES[n][0]]);
        Self([[e(0), e(1), e(2), e(3)], [e(4), e(5), e(6), e(7)], [e(8), e(9), e(10), e(11)]])
    }

    /// The two halves of the box along `axis`, as frames (edge vectors along `axis` keep their length:
    /// a positive factor on a column changes neither a sign nor a scaled Jacobian).
    fn halves(&self, axis: usize) -> [Self; 2] {
        let (mut low, mut high) = (*self, *self);
        for d in 0..3 {
            if d == axis {
                continue;
            }
            // Position of `axis` among the two indices of direction d: lower axis has stride 1.
            let first = axis == if d == 0 { 1 } else { 0 };
            let pairs = if first { [[0, 1], [2, 3]] } else { [[0, 2], [1, 3]] };
            for [a, b] in pairs {
                let middle = midpoint(self.0[d][a], self.0[d][b]);
                low.0[d][b] = middle;
                high.0[d][a] = middle;
            }
        }
        [low, high]
    }

    /// The 27 Bernstein coefficients of det J.
    pub(crate) fn bernstein(&self) -> [f64; 27] {
        let mut b = [0.0; 27];
        for e2 in 0..4 {
            for e3 in 0..4 {
                let c = cross(self.0[1][e2], self.0[2][e3]);
                for e1 in 0..4 {
                    b[MIXED[16 * e1 + 4 * e2 + e3].coefficient] += dot(self.0[0][e1], c);
                }
            }
        }
        for (b, n) in b.iter_mut().zip(MIXED_COUNT) {
            *b /= n;
        }
        b
    }

    /// The 27 averages of products of edge lengths that go with [`bernstein`](Self::bernstein).
    pub(crate) fn lengths(&self) -> [f64; 27] {
        let l = self.0.map(|d| d.map(norm));
        let mut n = [0.0; 27];
        for m in &MIXED {
            n[m.coefficient] += l[0][m.edges[0]] * l[1][m.edges[1]] * l[2][m.edges[2]];
        }
        for (n, count) in n.iter_mut().zip(MIXED_COUNT) {
            *n /= count;
        }
        n
    }

    /// The scaled Jacobian at the eight corners of the box, each with its number in [`MIXED`]; -1 if an edge is zero.
    fn corner_values(&self) -> [(f64, usize); 8] {
        let l = self.0.map(|d| d.map(norm));
        CORNER_MIXED.map(|n| {
            let [a, b, c] = MIXED[n].edges;
            let s = det(self.0[0][a], self.0[1][b], self.0[2][c]) / (l[0][a] * l[1][b] * l[2][c]);
            (if s.is_finite() { s } else { -1.0 }, n)
        })
    }

    /// Whether det J > 0 on the whole box, by bisection with at most `max_boxes` boxes. A determinant counts as positive
    /// when it exceeds 1e-14 of the product of the lengths in it, well above its rounding error.
    pub(crate) fn sign(&self, max_boxes: usize) -> Sign {
        const RELATIVE: f64 = 1e-14;
        let mut stack = vec![(*self, 0usize)];
        let mut boxes = 0;
        while let Some((frame, depth)) = stack.pop() {
            boxes += 1;
            let (b, n) = (frame.bernstein(), frame.lengths());
            let positive = |c: usize| b[c] > RELATIVE * n[c];
            if [0, 2, 6, 8, 18, 20, 24, 26].into_iter().any(|c| !positive(c)) {
                return Sign::NotPositive;
            }
            if (0..27).all(positive) {
                continue;
            }
            if boxes + stack.len() >= max_boxes {
                return Sign::Unsettled;
            }
            stack.extend(frame.halves(depth % 3).map(|half| (half, depth + 1)));
        }
        Sign::Positive
    }

    /// The worst scaled Jacobian of the cell, by bisection with at most `max_boxes` boxes: boxes whose lower bound is
    /// above `cutoff`, or within `tolerance` of the worst value seen, are not cut further, nor any once that value is not positive.
    pub(crate) fn worst(&self, cutoff: f64, tolerance: f64, max_boxes: usize) -> Worst {
        struct Part {
            bound: f64,
            frame: Frame,
            origin: Vector,
            size: Vector,
            depth: usize,
        }
        let mut seen: Vec<(f64, Vector)> = Vec::new();
        let mut visit = |frame: &Self, origin: Vector, size: Vector| {
            let values = frame.corner_values();
            for (value, n) in values {
                let c = MIXED[n].coefficient;
                let at = [c / 9, c / 3 % 3, c % 3];
                seen.push((value, std::array::from_fn(|d| origin[d] + if at[d] == 2 { size[d] } else { 0.0 })));
            }
            values.iter().map(|v| v.0).fold(f64::INFINITY, f64::min)
        };
        let (origin, size) = ([0.0; 3], [1.0; 3]);
        let mut upper = visit(self, origin, size);
        let mut lower = f64::INFINITY;
        let mut boxes = 1;
        let mut open = vec![Part { bound: self.lower_bound(), frame: *self, origin, size, depth: 0 }];
        // The box with the least bound comes next, so the first one that needs no cut ends the search.
        while let Some(next) = (0..open.len()).min_by(|&a, &b| open[a].bound.total_cmp(&open[b].bound)) {
            let part = open.swap_remove(next);
            if part.bound >= cutoff || part.bound >= upper - tolerance || boxes >= max_boxes || upper <= 0.0 {
                lower = part.bound;
                break;
            }
            let axis = part.depth % 3;
            for (side, half) in part.frame.halves(axis).into_iter().enumerate() {
                boxes += 1;
                let (mut origin, mut size) = (part.origin, part.size);
                size[axis] *= 0.5;
                origin[axis] += side as f64 * size[axis];
                upper = upper.min(visit(&half, origin, size));
                open.push(Part { bound: half.lower_bound(), frame: half, origin, size, depth: part.depth + 1 });
            }
        }
        seen.retain(|&(value, at)| value <= upper + 0.01 && at.iter().any(|&x| x > 0.0 && x < 1.0));
        seen.sort_by(|a, b| a.0.total_cmp(&b.0).then_with(|| a.1.partial_cmp(&b.1).expect("positions are finite")));
        seen.dedup();
        seen.truncate(8);
        Worst { lower: lower.min(upper), upper, inner: seen.into_iter().map(|(_, at)| at).collect() }
    }

    /// The largest t >= 0 for which the Bernstein form of this box proves that the scaled Jacobian is at least t; else -1.
    fn lower_bound(&self) -> f64 {
        let (b, n) = (self.bernstein(), self.lengths());
        let t = b.iter().zip(n).map(|(b, n)| b / n).fold(f64::INFINITY, |t, r| if r < t || r.is_nan() { r } else { t });
        if t >= 0.0 { t } else { -1.0 }
    }
}

/// The worst scaled Jacobian of a cell: see [`Frame::worst`].
#[derive(Clone, Debug)]
pub(crate) struct Worst {
    /// It is at least this, up to rounding; -1 if not known to be positive.
    pub(crate) lower: f64,
    /// It is at most this: the smallest value seen.
    pub(crate) upper: f64,
    /// Points other than the corners, in the unit cube, where values within 0.01 of the smallest were seen; worst first.
    pub(crate) inner: Vec<Vector>,
}

/// The weights of J at a point of the unit cube: column `d` is the sum of `weights[corner][d] * vertex`.
pub(crate) fn weights_at(x: [f64; 3]) -> [[f64; 3]; 8] {
    let mut out = [[0.0; 3]; 8];
    for (corner, position) in hexfill_mesh::cube::POSITIONS.iter().enumerate() {
        let value = |d: usize| if position[d] == 1 { x[d] } else { 1.0 - x[d] };
        let slope = |d: usize| if position[d] == 1 { 1.0 } else { -1.0 };
        out[corner] = [slope(0) * value(1) * value(2), value(0) * slope(1) * value(2), value(0) * value(1) * slope(2)];
    }
    out
}

/// The columns of J at a lattice point.
#[inline]
pub(crate) fn columns(p: &[Vector; 8], weights: &[[f64; 3]; 8]) -> [Vector; 3] {
    let mut c = [[0.0; 3]; 3];
    for (p, w) in p.iter().zip(weights) {
        for d in 0..3 {
            for k in 0..3 {
                c[d][k] += w[d] * p[k];
            }
        }
    }
    c
}

/// Scaled Jacobian of three columns and its gradient with respect to each; `None` if a column vanishes.
#[inline]
pub(crate) fn scaled_with_gradient(c: &[Vector; 3]) -> Option<(f64, [Vector; 3])> {
    let length = c.map(norm);
    if !length.iter().all(|&l| l > 0.0 && l.is_finite()) {
        return None;
    }
    let u: [Vector; 3] = std::array::from_fn(|k| scale(1.0 / length[k], c[k]));
    let s = det(u[0], u[1], u[2]);
    let gradient = std::array::from_fn(|k| {
        let n = cross(u[(k + 1) % 3], u[(k + 2) % 3]);
        scale(1.0 / length[k], [n[0] - s * u[k][0], n[1] - s * u[k][1], n[2] - s * u[k][2]])
    });
    Some((s, gradient))
}

/// Scaled Jacobian of three columns; -1 if a column vanishes.
#[inline]
pub(crate) fn scaled(c: &[Vector; 3]) -> f64 {
    let s = det(c[0], c[1], c[2]) / (norm(c[0]) * norm(c[1]) * norm(c[2]));
    if s.is_finite() { s } else { -1.0 }
}

/// Adds `slope` times the gradient by columns `g` at a point with these weights to the gradient by corner.
#[inline]
pub(crate) fn add_by_corner(gradient: &mut [Vector; 8], weights: &[Vector; 8], slope: f64, g: &[Vector; 3]) {
    for (sum, w) in gradient.iter_mut().zip(weights) {
        for d in 0..3 {
            *sum = add(*sum, g[d].map(|x| slope * w[d] * x));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::Random;
    use hexfill_mesh::cube::POSITIONS;

    fn random_hex(random: &mut Random, size: f64) -> [Vector; 8] {
        POSITIONS.map(|p| p.map(|x| f64::from(x) + size * random.signed()))
    }

    #[test]
    fn bernstein_form_is_the_determinant() {
        let mut random = Random::of_task(1, 0);
        for _ in 0..100 {
            let p = random_hex(&mut random, 1.0);
            let b = Frame::new(&p).bernstein();
            let x = [random.unit(), random.unit(), random.unit()];
            let c = columns(&p, &weights_at(x));
            let basis = |x: f64| [(1.0 - x) * (1.0 - x), 2.0 * x * (1.0 - x), x * x];
            let [bx, by, bz] = x.map(basis);
            let mut sum = 0.0;
            for i in 0..3 {
                for j in 0..3 {
                    for k in 0..3 {
                        sum += b[9 * i + 3 * j + k] * bx[i] * by[j] * bz[k];
                    }
                }
            }
            assert!((sum - det(c[0], c[1], c[2])).abs() < 1e-12);
        }
    }

    #[test]
    fn sign_agrees_with_a_fine_lattice() {
        let mut lattice = Vec::new();
        for n in 0..17usize.pow(3) {
            lattice.push(weights_at([n / 289, n / 17 % 17, n % 17].map(|i| i as f64 / 16.0)));
        }
        let mut random = Random::of_task(2, 0);
        let (mut valid, mut invalid_with_good_corners) = (0, 0);
        for _ in 0..400 {
            let p = random_hex(&mut random, 0.6);
            let frame = Frame::new(&p);
            let sampled = lattice.iter().map(|w| scaled(&columns(&p, w))).fold(f64::INFINITY, f64::min);
            match frame.sign(4000) {
                Sign::Positive => {
                    valid += 1;
                    assert!(sampled > 0.0);
                    let worst = frame.worst(1.0, 1e-3, 4000);
                    assert!(worst.lower <= sampled && sampled <= worst.upper + 0.02, "{worst:?} {sampled}");
                    for at in worst.inner {
                        let value = scaled(&columns(&p, &weights_at(at)));
                        assert!(value >= worst.upper - 1e-12 && value <= worst.upper + 0.01 + 1e-12);
                    }
                }
                Sign::NotPositive => {
                    assert!(sampled < 0.02);
                    invalid_with_good_corners += usize::from(frame.corner_values().iter().all(|v| v.0 > 0.0));
                }
                Sign::Unsettled => {}
            }
        }
        assert!(valid > 20 && invalid_with_good_corners > 0, "{valid} {invalid_with_good_corners}");
    }

    #[test]
    fn gradient_of_the_scaled_jacobian() {
        let mut random = Random::of_task(3, 0);
        for _ in 0..50 {
            let c: [Vector; 3] = std::array::from_fn(|_| std::array::from_fn(|_| random.signed()));
            let (s, g) = scaled_with_gradient(&c).unwrap();
            assert!((s - scaled(&c)).abs() < 1e-14);
            for k in 0..3 {
                for x in 0..3 {
                    let h = 1e-6;
                    let (mut high, mut low) = (c, c);
                    high[k][x] += h;
                    low[k][x] -= h;
                    let slope = (scaled(&high) - scaled(&low)) / (2.0 * h);
                    assert!((slope - g[k][x]).abs() < 1e-6 * (1.0 + slope.abs()) / norm(c[k]).min(1.0).powi(3));
                }
            }
        }
    }
}
