//! Level 5 for one hex: a floating-point filter with proved error bounds, bisection, and exact arithmetic where they leave a
//! doubt.
//!
//! Source: Johnen, Weill, Remacle 2017 (coefficients, then subdivision); the filter with its error bound and the exact end are ours.

use super::bernstein::{CORNERS, Cell, ERROR, Frame, UNIT, Vector, halve};
use super::exact;
use super::verdict::Positivity;

/// Boxes that floating-point bisection may visit before exact arithmetic takes over.
const FLOAT_BOXES: usize = 200;

/// The quick test: true only if det J > 0 on the whole hex is certain. No allocation.
#[inline]
pub(crate) fn surely_positive(p: &[Vector; 8]) -> bool {
    let frame = Frame::new(p);
    let Some(size) = frame.safe_size() else { return false };
    let b = frame.coefficients();
    let least = b.iter().fold(f64::INFINITY, |m, &x| m.min(x));
    least > ERROR * size
}

/// Decides det J > 0 on the whole hex. All coordinates are finite.
pub(crate) fn decide(p: &[Vector; 8]) -> Positivity {
    let frame = Frame::new(p);
    // The error bound assumes that nothing underflows or overflows.
    let Some(size) = frame.safe_size() else { return exact::positivity(p) };
    let b = frame.coefficients();
    let most = b.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let mut boxes = vec![(b, ERROR * size, Cell::WHOLE)];
    let mut visited = 0;
    while let Some((b, error, cell)) = boxes.pop() {
        visited += 1;
        // The graph of a polynomial lies in the convex hull of its Bernstein coefficients (Johnen, Weill, Remacle
        // 2017): all of them positive settles the box.
        if b.iter().all(|&x| x > error) {
            continue;
        }
        let bad = (0..8).find(|&i| b[CORNERS[i]] < -error);
        if let Some(i) = bad {
            // Only at depth 0 are the box's corners those of the hex.
            if cell.depth == 0 && CORNERS.iter().all(|&c| b[c] < -error) {
                return Positivity::InsideOut;
            }
            return Positivity::NotPositive { at: cell.corner(i), zero: false };
        }
        // A value at a corner of the box that may be zero is for exact arithmetic to decide.
        if visited >= FLOAT_BOXES || CORNERS.iter().any(|&c| b[c] <= error) {
            return exact::positivity(p);
        }
        let [low, high] = halve(&b, cell.axis());
        let [low_cell, high_cell] = cell.halves();
        let error = error + 4.0 * UNIT * most * 1.01;
        boxes.push((high, error, high_cell));
        boxes.push((low, error, low_cell));
    }
    Positivity::Positive
}
