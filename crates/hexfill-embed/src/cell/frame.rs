//! The Jacobian of the trilinear map of one hex in Bernstein form.
//!
//! Idea: the three columns of J are bilinear, each the interpolation of the four edge vectors of one direction,
//! so a sub-box of the cell is again twelve vectors ([`Frame`]) and the same formulas serve every box.
//! det J is tri-quadratic; its 27 Bernstein coefficients are averages of mixed determinants of edge vectors
//! (Johnen, Weill, Remacle 2017, arXiv 1706.01613), and all of them positive implies det J > 0 on the whole box, as the basis is positive.
//! With N the same averages of the products of edge lengths, `B >= t N` and `t >= 0` imply that the scaled
//! Jacobian is at least `t` on the whole box, because a length is a convex function of the interpolated vectors.
//!
//! Source: Johnen, Weill, Remacle 2017; the row for the scaled Jacobian is ours.

use hexfill_geometry::{Vector, cross, det, dot, midpoint, norm, sub};

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

/// Those of [`CORNERS`] that are at the bottom facet: what a pyramid has, whose top facet is its apex, four times.
pub(crate) const BOTTOM_CORNERS: u64 = {
    let mut set = 0;
    let mut n = 0;
    while n < 64 {
        if CORNERS >> n & 1 == 1 && MIXED[n].coefficient.is_multiple_of(3) {
            set |= 1 << n;
        }
        n += 1;
    }
    set
};

/// Those of [`FRAME_EDGES`] that a pyramid has.
pub(crate) const PYRAMID_EDGES: [usize; 8] = [0, 1, 4, 5, 8, 9, 10, 11];

/// The members of [`CORNERS`].
pub(crate) const CORNER_MIXED: [usize; 8] = members(CORNERS);

/// The members of [`BOTTOM_CORNERS`].
pub(crate) const BOTTOM_MIXED: [usize; 4] = members(BOTTOM_CORNERS);

/// The numbers of the bits of a set of `N`.
const fn members<const N: usize>(set: u64) -> [usize; N] {
    let mut list = [0; N];
    let (mut n, mut found) = (0, 0);
    while n < 64 {
        if set >> n & 1 == 1 {
            list[found] = n;
            found += 1;
        }
        n += 1;
    }
    list
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
    pub(super) fn halves(&self, axis: usize) -> [Self; 2] {
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
    pub(super) fn corner_values(&self) -> [(f64, usize); 8] {
        let l = self.0.map(|d| d.map(norm));
        CORNER_MIXED.map(|n| {
            let [a, b, c] = MIXED[n].edges;
            let s = det(self.0[0][a], self.0[1][b], self.0[2][c]) / (l[0][a] * l[1][b] * l[2][c]);
            (if s.is_finite() { s } else { -1.0 }, n)
        })
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::cell::scaled_jacobian::{columns, weights_at};
    use hexfill_mesh::Random;
    use hexfill_mesh::cube::POSITIONS;

    pub(in crate::cell) fn random_hex(random: &mut Random, size: f64) -> [Vector; 8] {
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
}
