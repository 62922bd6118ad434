//! The sign of det J and the worst scaled Jacobian of a whole cell, by bisection.
//!
//! A box is settled by its Bernstein form or cut in two (Johnen, Weill, Remacle 2017, arXiv 1706.01613); the values at the corners of boxes are true
//! values, hence bounds from the other side. The Bernstein bounds converge quadratically, so few boxes are cut.
//!
//! These are judgements in floating point, used to steer and to report; proofs are the business of `hexfill-check`.
//!
//! Source: Johnen, Weill, Remacle 2017.

use super::frame::{Frame, MIXED};
use hexfill_geometry::Vector;

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

impl Frame {
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
            // Corner coefficients are values of det J: one that is not positive settles the whole cell.
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
            // All axes in turn: halved along one alone a box would stay as curved along the others.
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
        // By value and then by place, so that the points watched are the same for any order of boxes.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cell::frame::tests::random_hex;
    use crate::cell::scaled_jacobian::{columns, scaled, weights_at};
    use hexfill_mesh::Random;

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
}
