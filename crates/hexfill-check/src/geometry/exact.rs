//! det J > 0 in exact arithmetic. Doubles are dyadic rationals: scaled by one power of two the coordinates of a hex are
//! integers, and so are 8 times its Bernstein coefficients. The statement is about the stored numbers.
//!
//! Source: Johnen, Weill, Remacle 2017 (abstract) for the coefficients; exact arithmetic instead of a tolerance is ours.

use super::bernstein::{CORNERS, Cell, Vector, at, edge_corners};
use super::verdict::Positivity;
use dashu_int::IBig;

/// Halvings after which a box is given up (20 along each axis).
const MAX_DEPTH: u32 = 60;
/// Boxes after which a hex is given up.
const MAX_BOXES: usize = 20_000;

/// Mantissa and exponent: the double is `m * 2^e`.
fn parts(x: f64) -> (i64, i32) {
    let bits = x.to_bits();
    let field = (bits >> 52 & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let (m, e) = if field == 0 { (fraction, -1074) } else { (fraction | 1 << 52, field - 1075) };
    (if bits >> 63 == 1 { -m } else { m }, e)
}

/// The eight points times one power of two, as integers. All coordinates are finite.
fn integers(p: &[Vector; 8]) -> [[IBig; 3]; 8] {
    // One power of two for all: it scales det J by its cube and leaves every sign, so nothing has to be divided.
    let low = p.iter().flatten().map(|&x| parts(x)).filter(|x| x.0 != 0).map(|x| x.1).min().unwrap_or(0);
    p.map(|v| {
        v.map(|x| {
            let (m, e) = parts(x);
            if m == 0 { IBig::ZERO } else { IBig::from(m) << (e - low) as usize }
        })
    })
}

type Big = [IBig; 3];

fn cross(a: &Big, b: &Big) -> Big {
    [&a[1] * &b[2] - &a[2] * &b[1], &a[2] * &b[0] - &a[0] * &b[2], &a[0] * &b[1] - &a[1] * &b[0]]
}

fn det(a: &Big, b: &Big, c: &Big) -> IBig {
    let x = cross(b, c);
    &a[0] * &x[0] + &a[1] * &x[1] + &a[2] * &x[2]
}

fn frame(p: &[[IBig; 3]; 8]) -> [[Big; 4]; 3] {
    edge_corners().map(|axis| axis.map(|[from, to]| std::array::from_fn(|k| &p[to][k] - &p[from][k])))
}

/// The signs of det J at the eight corners, in the order of [`CORNERS`].
fn corner_values(e: &[[Big; 4]; 3]) -> [IBig; 8] {
    std::array::from_fn(|i| {
        let (a, b, c) = (i & 1, i >> 1 & 1, i >> 2);
        det(&e[0][b + 2 * c], &e[1][a + 2 * c], &e[2][a + 2 * b])
    })
}

/// 8 times the Bernstein coefficients, given the corner values.
fn coefficients(e: &[[Big; 4]; 3], corners: &[IBig; 8]) -> Vec<IBig> {
    let mut b = vec![IBig::ZERO; 27];
    let mixed = |y: usize, z: usize, a1: usize, z1: usize, a2: usize, y2: usize| {
        det(&e[0][y + 2 * z], &e[1][a1 + 2 * z1], &e[2][a2 + 2 * y2])
    };
    for (value, &slot) in corners.iter().zip(&CORNERS) {
        b[slot] = value * IBig::from(8);
    }
    for s in 0..2 {
        for t in 0..2 {
            let four = IBig::from(4);
            // In eighths edge coefficients are multiples of 4 and corner ones of 8, so that the divisions by 4 below
            // leave no rest.
            b[at(1, 2 * s, 2 * t)] = (mixed(s, t, 0, t, 1, s) + mixed(s, t, 1, t, 0, s)) * &four;
            b[at(2 * s, 1, 2 * t)] = (mixed(0, t, s, t, s, 1) + mixed(1, t, s, t, s, 0)) * &four;
            b[at(2 * s, 2 * t, 1)] = (mixed(t, 0, s, 1, s, t) + mixed(t, 1, s, 0, s, t)) * &four;
        }
    }
    let is_edge = |i: usize| [i % 3, i / 3 % 3, i / 9].iter().filter(|&&x| x == 1).count() == 1;
    // face = (2 edges - corners) / 4, centre = (edges - corners) / 4; all in eighths already.
    let sum = |fixed: usize, side: usize| {
        let (mut edges, mut corners) = (IBig::ZERO, IBig::ZERO);
        for i in (0..27).filter(|i| fixed == 3 || [i % 3, i / 3 % 3, i / 9][fixed] == side) {
            if is_edge(i) {
                edges += &b[i];
            } else if CORNERS.contains(&i) {
                corners += &b[i];
            }
        }
        (edges, corners)
    };
    let mut rest = Vec::new();
    for side in [0, 2] {
        for (axis, slot) in [(0, at(side, 1, 1)), (1, at(1, side, 1)), (2, at(1, 1, side))] {
            let (edges, corners) = sum(axis, side);
            rest.push((slot, (edges * IBig::from(2) - corners) >> 2));
        }
    }
    let (edges, corners) = sum(3, 0);
    rest.push((at(1, 1, 1), (edges - corners) >> 2));
    for (slot, value) in rest {
        b[slot] = value;
    }
    b
}

/// 4 times the coefficients on the two halves along `axis`.
fn halve(b: &[IBig], axis: usize) -> [Vec<IBig>; 2] {
    let stride = [1, 3, 9][axis];
    let (mut low, mut high) = (b.to_vec(), b.to_vec());
    for i in (0..27).filter(|i| i / stride % 3 == 0) {
        let (p, q, r) = (&b[i], &b[i + stride], &b[i + 2 * stride]);
        // Times four: each halving would bring quarters. All coefficients of a box share the factor, so their signs
        // and their order stay.
        let (pq, qr) = (p + q, q + r);
        let mid = &pq + &qr;
        low[i] = p << 2usize;
        low[i + stride] = &pq << 1usize;
        low[i + 2 * stride] = mid.clone();
        high[i] = mid;
        high[i + stride] = qr << 1usize;
        high[i + 2 * stride] = r << 2usize;
    }
    [low, high]
}

/// Decides det J > 0 on the whole hex. All coordinates are finite.
pub(crate) fn positivity(p: &[Vector; 8]) -> Positivity {
    // Differences of integers are exact here. In floating point they are rounded once, which is why a filter's "no"
    // proves nothing of the stored numbers.
    let e = frame(&integers(p));
    let corners = corner_values(&e);
    // All eight negative is as a rule a hex listed in mirrored order; that deserves a name of its own.
    if corners.iter().all(|c| *c < IBig::ZERO) {
        return Positivity::InsideOut;
    }
    if let Some(i) = (0..8).find(|&i| corners[i] <= IBig::ZERO) {
        return Positivity::NotPositive { at: Cell::WHOLE.corner(i), zero: corners[i].is_zero() };
    }
    let mut boxes = vec![(coefficients(&e, &corners), Cell::WHOLE)];
    let mut visited = 0;
    while let Some((b, cell)) = boxes.pop() {
        visited += 1;
        if let Some(i) = (0..8).find(|&i| b[CORNERS[i]] <= IBig::ZERO) {
            return Positivity::NotPositive { at: cell.corner(i), zero: b[CORNERS[i]].is_zero() };
        }
        if b.iter().all(|c| *c > IBig::ZERO) {
            continue;
        }
        // A hex that is positive but for a point on its inside, or nearly so, can be halved for ever. Undecided is
        // then the honest word; the rule has a name of its own.
        if cell.depth >= MAX_DEPTH || visited >= MAX_BOXES {
            return Positivity::Undecided;
        }
        let [low, high] = halve(&b, cell.axis());
        let [low_cell, high_cell] = cell.halves();
        // The half with the smaller least coefficient first: a bad point is found sooner.
        if low.iter().min() <= high.iter().min() {
            boxes.push((high, high_cell));
            boxes.push((low, low_cell));
        } else {
            boxes.push((low, low_cell));
            boxes.push((high, high_cell));
        }
    }
    Positivity::Positive
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::bernstein::{ERROR, Frame};

    #[test]
    fn doubles_come_apart_exactly() {
        for x in [1.0, -0.1, 1e300, -5e-324, 2.2250738585072014e-308, 0.0, -0.0, f64::MAX] {
            let (m, e) = parts(x);
            let half = e / 2;
            assert_eq!(m as f64 * 2f64.powi(half) * 2f64.powi(e - half), x);
        }
    }

    #[test]
    fn exact_and_floating_coefficients_agree_within_the_bound() {
        let mut seed = 3u64;
        let mut unit = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            // Few bits, so that the exact coefficients fit in a double.
            (seed >> 58) as f64 / 64.0
        };
        for _ in 0..100 {
            let p = hexfill_mesh::cube::POSITIONS.map(|p| p.map(|x| f64::from(x) + unit()));
            let f = Frame::new(&p);
            let (b, size) = (f.coefficients(), f.safe_size().unwrap());
            let ints = integers(&p);
            let low = p.iter().flatten().map(|&x| parts(x)).filter(|x| x.0 != 0).map(|x| x.1).min().unwrap();
            let e = frame(&ints);
            let exact = coefficients(&e, &corner_values(&e));
            for i in 0..27 {
                let value = exact[i].to_f64().value() * 2f64.powi(3 * low - 3);
                assert!((b[i] - value).abs() <= ERROR * size, "{i}: {} {value}", b[i]);
            }
        }
    }
}
