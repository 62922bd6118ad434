//! Edge vectors of a hex, the 27 Bernstein coefficients of det J, and their halving by de Casteljau's rule.
//!
//! Unit cube, corners `V[a][b][c]`. Edge vectors `E1[b][c] = V[1bc] - V[0bc]`, `E2[a][c]`, `E3[a][b]` alike. With
//! `J1 = E1` bilinear in (b, c) and so on, det J = det(J1, J2, J3) is quadratic in each variable and
//! `B_ijk = mean of det(E1[b][c], E2[a'][c'], E3[a''][b''])` over `a'+a''=i, b+b''=j, c+c'=k`. The 8 corner and 12 edge
//! coefficients give the rest: because the edge vectors are differences of 8 points,
//! `face = (2 * its four edges - its four corners) / 4` and `centre = (all edges - all corners) / 4`.
//!
//! Source: Johnen, Weill, Remacle 2017 (abstract: 20 determinants give all 27 coefficients).

use hexfill_mesh::cube::corner_at;

pub(crate) type Vector = [f64; 3];

/// The unit roundoff of `f64`.
pub(crate) const UNIT: f64 = f64::EPSILON / 2.0;

/// Index of coefficient (i, j, k), each 0..3.
#[inline]
pub(crate) const fn at(i: usize, j: usize, k: usize) -> usize {
    i + 3 * j + 9 * k
}

/// The eight coefficients that are values of det J at the corners.
pub(crate) const CORNERS: [usize; 8] = [0, 2, 6, 8, 18, 20, 24, 26];

/// The edge vectors: `e[0][b + 2 c]`, `e[1][a + 2 c]`, `e[2][a + 2 b]`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub(crate) e: [[Vector; 4]; 3],
}

/// A length per edge vector, in the order of [`Frame::e`].
pub(crate) type Lengths = [[f64; 4]; 3];

#[inline]
fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline]
fn plus(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline]
pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline]
pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline]
pub(crate) fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// The two corners (VTK order) of each edge vector, start and end, in the order of [`Frame::e`].
pub(crate) const fn edge_corners() -> [[[usize; 2]; 4]; 3] {
    let mut table = [[[0; 2]; 4]; 3];
    let mut i = 0;
    while i < 4 {
        let (s, t) = ((i & 1) as u8, (i >> 1) as u8);
        table[0][i] = [corner_at(0, s, t), corner_at(1, s, t)];
        table[1][i] = [corner_at(s, 0, t), corner_at(s, 1, t)];
        table[2][i] = [corner_at(s, t, 0), corner_at(s, t, 1)];
        i += 1;
    }
    table
}

const EDGE_CORNERS: [[[usize; 2]; 4]; 3] = edge_corners();

/// Smallest and largest edge components for which the error bound of [`Frame::coefficients`] holds without regard to
/// underflow and overflow.
const SAFE: std::ops::RangeInclusive<f64> = 1e-70..=1e70;

impl Frame {
    /// The edge vectors of a hex; each component is a correctly rounded difference.
    #[inline]
    pub(crate) fn new(p: &[Vector; 8]) -> Self {
        let e = EDGE_CORNERS.map(|axis| axis.map(|[from, to]| minus(p[to], p[from])));
        Self { e }
    }

    /// The lengths of the edge vectors.
    #[inline]
    pub(crate) fn lengths(&self) -> Lengths {
        self.e.map(|axis| axis.map(norm))
    }

    /// Largest component in absolute value, per direction.
    #[inline]
    pub(crate) fn sizes(&self) -> [f64; 3] {
        self.e.map(|axis| axis.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs())))
    }

    /// The product of the three sizes if all are in the range for which error bounds are proved, else `None`.
    #[inline]
    pub(crate) fn safe_size(&self) -> Option<f64> {
        let s = self.sizes();
        s.iter().all(|d| SAFE.contains(d)).then(|| s[0] * s[1] * s[2])
    }

    /// The 27 coefficients.
    ///
    /// Error of each at most `ERROR * size` with `size` from [`Frame::safe_size`]. Let u = 2^-53 and P the product of the
    /// sizes. A triple product has 6 terms of at most P, each with at most 8 roundings (3 differences, 2 products, 3 sums):
    /// 48.01 u P. An edge coefficient is the mean of two (here a dot product with a sum of two cross products, one rounding
    /// more): 55 u P. A face: inputs (8 * 55 + 4 * 49) / 4 = 159 u P, and 11 sums of at most 72 P: 198 u P. The centre: inputs
    /// (12 * 55 + 8 * 49) / 4 = 263 u P and 19 sums of at most 120 P: 570 u P. So 900 u P bounds all; `ERROR` is 1024 u, which
    /// also covers the roundings of P itself. Underflow adds less than 1e-250, while u P >= 1e-226.
    #[inline]
    pub(crate) fn coefficients(&self) -> [f64; 27] {
        let [e1, e2, e3] = &self.e;
        let mut b = [0.0; 27];
        // Crosses of E2[a][c] with E3[a][b] and with E3[1 - a][b], index a + 2 b + 4 c.
        let mut same = [[0.0; 3]; 8];
        let mut other = [[0.0; 3]; 8];
        for (i, (same, other)) in same.iter_mut().zip(&mut other).enumerate() {
            let (a, y, c) = (i & 1, i >> 1 & 1, i >> 2);
            *same = cross(e2[a + 2 * c], e3[a + 2 * y]);
            *other = cross(e2[a + 2 * c], e3[1 - a + 2 * y]);
        }
        // Eight values and twelve means of two give all 27: of 64 triple products 32 are computed. The error bound
        // above counts on this order of sums.
        let (mut corner_sum, mut edge_sum) = (0.0, 0.0);
        for (i, &cross) in same.iter().enumerate() {
            let (a, y, c) = (i & 1, i >> 1 & 1, i >> 2);
            let value = dot(e1[y + 2 * c], cross);
            b[at(2 * a, 2 * y, 2 * c)] = value;
            corner_sum += value;
        }
        for s in 0..2 {
            for t in 0..2 {
                let x = 0.5 * dot(e1[s + 2 * t], plus(other[2 * s + 4 * t], other[1 + 2 * s + 4 * t]));
                b[at(1, 2 * s, 2 * t)] = x;
                let y = 0.5 * (dot(e1[2 * t], same[s + 2 + 4 * t]) + dot(e1[1 + 2 * t], same[s + 4 * t]));
                b[at(2 * s, 1, 2 * t)] = y;
                let z = 0.5 * (dot(e1[t], same[s + 2 * t + 4]) + dot(e1[t + 2], same[s + 2 * t]));
                b[at(2 * s, 2 * t, 1)] = z;
                edge_sum += x + y + z;
            }
        }
        for side in [0, 2] {
            let face = |c: [usize; 4], e: [usize; 4]| {
                let corners = b[c[0]] + b[c[1]] + b[c[2]] + b[c[3]];
                0.25 * (2.0 * (b[e[0]] + b[e[1]] + b[e[2]] + b[e[3]]) - corners)
            };
            let x = face(
                [at(side, 0, 0), at(side, 2, 0), at(side, 0, 2), at(side, 2, 2)],
                [at(side, 1, 0), at(side, 1, 2), at(side, 0, 1), at(side, 2, 1)],
            );
            let y = face(
                [at(0, side, 0), at(2, side, 0), at(0, side, 2), at(2, side, 2)],
                [at(1, side, 0), at(1, side, 2), at(0, side, 1), at(2, side, 1)],
            );
            let z = face(
                [at(0, 0, side), at(2, 0, side), at(0, 2, side), at(2, 2, side)],
                [at(1, 0, side), at(1, 2, side), at(0, 1, side), at(2, 1, side)],
            );
            b[at(side, 1, 1)] = x;
            b[at(1, side, 1)] = y;
            b[at(1, 1, side)] = z;
        }
        b[at(1, 1, 1)] = 0.25 * (edge_sum - corner_sum);
        b
    }

    /// The edge vectors of the two halves along `axis`, up to a factor per direction that cancels in the scaled Jacobian.
    pub(crate) fn halves(&self, axis: usize) -> [Self; 2] {
        let mut halves = [*self, *self];
        for (d, table) in self.e.iter().enumerate() {
            // Position of `axis` among the two variables of direction d, if it is one of them.
            let stride = match (d, axis) {
                (0, 1) | (1, 0) | (2, 0) => 1,
                (0, 2) | (1, 2) | (2, 1) => 2,
                _ => continue,
            };
            for i in [0, 3 - stride] {
                let mid = plus(table[i], table[i + stride]).map(|x| 0.5 * x);
                halves[0].e[d][i + stride] = mid;
                halves[1].e[d][i] = mid;
            }
        }
        halves
    }
}

/// Upper bounds `N_ijk` of |J1| |J2| |J3|: the same means of products of norms, so that `B >= t N` for all 27 gives a
/// scaled Jacobian of at least t. `slack` is added to each norm for the rounding of the edge vectors.
pub(crate) fn norm_products(lengths: &Lengths, slack: f64) -> [f64; 27] {
    let n = lengths.map(|axis| axis.map(|n| n * (1.0 + 8.0 * UNIT) + slack));
    let mut sums = [0.0; 27];
    for z in 0..4usize {
        // The bits of y, z pick the norm of J1, those of (a1, z1) and (a2, y2) the others.
        let (y, z) = (z & 1, z >> 1);
        for i in 0..4usize {
            let (a1, z1) = (i & 1, i >> 1);
            let pair = n[0][y + 2 * z] * n[1][a1 + 2 * z1];
            for j in 0..4usize {
                let (a2, y2) = (j & 1, j >> 1);
                sums[at(a1 + a2, y + y2, z + z1)] += pair * n[2][a2 + 2 * y2];
            }
        }
    }
    // Products and sums of positive numbers: at most 11 roundings; the counts are powers of two.
    std::array::from_fn(|i| sums[i] * WEIGHTS[i] * (1.0 + 16.0 * UNIT))
}

/// One over the number of mixed products that make up a coefficient: half for each index that is 1.
const WEIGHTS: [f64; 27] = {
    let mut weights = [1.0; 27];
    let mut i = 0;
    while i < 27 {
        let ones = (i % 3 == 1) as i32 + (i / 3 % 3 == 1) as i32 + (i / 9 == 1) as i32;
        weights[i] = [1.0, 0.5, 0.25, 0.125][ones as usize];
        i += 1;
    }
    weights
};

/// Relative error of [`Frame::coefficients`].
pub(crate) const ERROR: f64 = 1024.0 * UNIT;

/// The coefficients on the two halves of the box along `axis`.
/// If the error was at most `e` and no coefficient exceeds `m`, it is at most `e + 4 u m` afterwards: a middle value takes two
/// roundings of numbers up to m in each step, and means do not increase errors.
pub(crate) fn halve(b: &[f64; 27], axis: usize) -> [[f64; 27]; 2] {
    let stride = [1, 3, 9][axis];
    let (mut low, mut high) = (*b, *b);
    for i in (0..27).filter(|i| i / stride % 3 == 0) {
        let (p, q, r) = (b[i], b[i + stride], b[i + 2 * stride]);
        let (pq, qr) = (0.5 * (p + q), 0.5 * (q + r));
        let mid = 0.5 * (pq + qr);
        low[i + stride] = pq;
        low[i + 2 * stride] = mid;
        high[i] = mid;
        high[i + stride] = qr;
    }
    [low, high]
}

/// A box of the unit cube: lower corner and size as powers of two, for naming points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell {
    pub(crate) low: Vector,
    pub(crate) size: Vector,
    pub(crate) depth: u32,
}

impl Cell {
    pub(crate) const WHOLE: Self = Self { low: [0.0; 3], size: [1.0; 3], depth: 0 };

    /// The axis along which this box is cut next.
    pub(crate) fn axis(&self) -> usize {
        (self.depth % 3) as usize
    }

    pub(crate) fn halves(&self) -> [Self; 2] {
        let axis = self.axis();
        let mut low = Self { depth: self.depth + 1, ..*self };
        low.size[axis] *= 0.5;
        let mut high = low;
        high.low[axis] += low.size[axis];
        [low, high]
    }

    /// The point of corner `i` of [`CORNERS`].
    pub(crate) fn corner(&self, i: usize) -> Vector {
        std::array::from_fn(|k| self.low[k] + if i >> k & 1 == 1 { self.size[k] } else { 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn det(a: Vector, b: Vector, c: Vector) -> f64 {
        dot(a, cross(b, c))
    }

    /// The definition: 64 mixed determinants.
    fn by_definition(f: &Frame) -> [f64; 27] {
        let (mut sums, mut counts) = ([0.0; 27], [0.0; 27]);
        for i in 0..64usize {
            let bit = |k: usize| i >> k & 1;
            let slot = at(bit(2) + bit(4), bit(0) + bit(5), bit(1) + bit(3));
            sums[slot] += det(f.e[0][bit(0) + 2 * bit(1)], f.e[1][bit(2) + 2 * bit(3)], f.e[2][bit(4) + 2 * bit(5)]);
            counts[slot] += 1.0;
        }
        std::array::from_fn(|i| sums[i] / counts[i])
    }

    fn random_hex(seed: &mut u64) -> [Vector; 8] {
        let mut unit = || {
            *seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (*seed >> 11) as f64 / (1u64 << 53) as f64
        };
        hexfill_mesh::cube::POSITIONS.map(|p| p.map(|x| f64::from(x) + unit() - 0.5))
    }

    /// det J at a point, from the trilinear map itself.
    fn jacobian(p: &[Vector; 8], at: Vector) -> f64 {
        let mut j = [[0.0; 3]; 3];
        for (i, corner) in hexfill_mesh::cube::POSITIONS.iter().enumerate() {
            let w = |k: usize| if corner[k] == 1 { at[k] } else { 1.0 - at[k] };
            let d = |k: usize| if corner[k] == 1 { 1.0 } else { -1.0 };
            let weights = [d(0) * w(1) * w(2), w(0) * d(1) * w(2), w(0) * w(1) * d(2)];
            for (axis, weight) in weights.iter().enumerate() {
                (0..3).for_each(|c| j[axis][c] += weight * p[i][c]);
            }
        }
        det(j[0], j[1], j[2])
    }

    #[test]
    fn coefficients_are_those_of_the_definition_and_of_the_map() {
        let mut seed = 7;
        for _ in 0..200 {
            let p = random_hex(&mut seed);
            let f = Frame::new(&p);
            let (b, d) = (f.coefficients(), by_definition(&f));
            let size = f.safe_size().unwrap();
            for i in 0..27 {
                assert!((b[i] - d[i]).abs() <= ERROR * size, "coefficient {i}: {} {}", b[i], d[i]);
            }
            // Bernstein form against the map at a few points.
            for t in [[0.0, 0.0, 0.0], [0.25, 0.5, 0.75], [1.0, 0.125, 0.375]] {
                let w = |x: f64| [(1.0 - x) * (1.0 - x), 2.0 * x * (1.0 - x), x * x];
                let (x, y, z) = (w(t[0]), w(t[1]), w(t[2]));
                let sum: f64 = (0..27).map(|i| b[i] * x[i % 3] * y[i / 3 % 3] * z[i / 9]).sum();
                assert!((sum - jacobian(&p, t)).abs() < 1e-12);
            }
            // Halving is the same as the frame of the half, where the direction cut is halved as well.
            for axis in 0..3 {
                let parts = halve(&b, axis);
                let frames = f.halves(axis);
                for (part, frame) in parts.iter().zip(frames) {
                    let direct = by_definition(&frame);
                    (0..27).for_each(|i| assert!((part[i] - direct[i]).abs() < 1e-13, "axis {axis}"));
                }
            }
            // N bounds the norms.
            let n = norm_products(&f.lengths(), 0.0);
            CORNERS.iter().for_each(|&c| assert!(b[c].abs() <= n[c] * (1.0 + 1e-12)));
        }
    }
}
