//! Positions of any size: those far larger or smaller than 1 are scaled by a power of two, which changes no digit.
//!
//! Source: ours.

use hexfill_geometry::Vector;
use std::borrow::Cow;

/// Sizes up to two to this power, and down to its inverse, are ordinary: products of a dozen lengths are far from the ends of the range.
const ORDINARY: i32 = 64;

/// The power of two next to the largest coordinate; 0 if that is an ordinary size, or 0.
pub(crate) fn exponent(points: &[Vector]) -> i32 {
    let largest = points.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    let exponent = largest.log2().round();
    if exponent.is_finite() && exponent.abs() > f64::from(ORDINARY) { exponent as i32 } else { 0 }
}

/// `x` times a power of two, in two steps: neither factor leaves the range of doubles.
pub(crate) fn times(x: f64, exponent: i32) -> f64 {
    let half = exponent / 2;
    x * 2f64.powi(half) * 2f64.powi(exponent - half)
}

/// The same shape with an ordinary size.
pub(crate) fn at_ordinary_size(points: &[Vector]) -> Cow<'_, [Vector]> {
    match exponent(points) {
        0 => Cow::Borrowed(points),
        e => Cow::Owned(points.iter().map(|p| p.map(|x| times(x, -e))).collect()),
    }
}
