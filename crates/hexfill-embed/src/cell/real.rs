//! [`Real`]: what a formula of cells is written in, once for one cell and for [`LANES`] in step.
//!
//! Lanes never meet, and every operation rounds as IEEE 754 says, so a cell gets the same bits alone, in step with others, and on every processor.
//! Nothing is fused: a fused product and sum would round once.
//!
//! Source: ours.

use std::ops::{Add, Div, Mul, Sub};

/// Cells in step: what a vector register of today's processors holds.
pub(crate) const LANES: usize = 4;

/// A number, or one for each of several cells.
pub(crate) trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// The same number for all.
    fn of(x: f64) -> Self;
    /// The square root.
    fn sqrt(self) -> Self;
    /// Without its sign.
    fn abs(self) -> Self;
    /// `then` where this is positive, `other` elsewhere.
    fn if_positive(self, then: Self, other: Self) -> Self;
}

impl Real for f64 {
    #[inline(always)]
    fn of(x: f64) -> Self {
        x
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn if_positive(self, then: Self, other: Self) -> Self {
        if self > 0.0 { then } else { other }
    }
}

/// One number for each of [`LANES`] cells.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lanes(pub(crate) [f64; LANES]);

impl Lanes {
    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        self.with(self, |x, _| f(x))
    }

    #[inline(always)]
    fn with(mut self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        // A loop and not `array::map`, which is not always inlined: what is not loses the instructions it was called for.
        for k in 0..LANES {
            self.0[k] = f(self.0[k], other.0[k]);
        }
        self
    }
}

impl Real for Lanes {
    #[inline(always)]
    fn of(x: f64) -> Self {
        Self([x; LANES])
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.map(f64::abs)
    }

    #[inline(always)]
    fn if_positive(mut self, then: Self, other: Self) -> Self {
        for k in 0..LANES {
            self.0[k] = if self.0[k] > 0.0 { then.0[k] } else { other.0[k] };
        }
        self
    }
}

macro_rules! lane_by_lane {
    ($trait:ident, $function:ident, $operator:tt) => {
        impl $trait for Lanes {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                self.with(other, |a, b| a $operator b)
            }
        }
    };
}

lane_by_lane!(Add, add, +);
lane_by_lane!(Sub, sub, -);
lane_by_lane!(Mul, mul, *);
lane_by_lane!(Div, div, /);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_are_numbers_side_by_side() {
        let (a, b) = (Lanes([1.5, -2.0, 0.0, f64::NAN]), Lanes([0.1, 3.0, -0.0, 1.0]));
        fn formula<R: Real>(a: R, b: R) -> R {
            ((a + b) * (a - b) / (b.abs().sqrt() + R::of(0.3))).if_positive(a, b)
        }
        let together = formula(a, b);
        for k in 0..LANES {
            assert_eq!(together.0[k].to_bits(), formula(a.0[k], b.0[k]).to_bits());
        }
    }
}
