//! Points and vectors of three doubles, for every step that reads positions: those of `hexfill-geometry`, and boxes.

use hexfill_geometry::det;
pub(crate) use hexfill_geometry::{Vector as Point, cross, dot, sub};

/// Six times the signed volume of a tetrahedron.
pub(crate) fn volume([a, b, c, d]: [Point; 4]) -> f64 {
    det(sub(b, a), sub(c, a), sub(d, a))
}

/// The lower corner of the box round the points, its upper corner, and the longest of its sides (positive).
pub(crate) fn bounding_box(points: &[Point]) -> (Point, Point, f64) {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for p in points {
        for c in 0..3 {
            low[c] = low[c].min(p[c]);
            high[c] = high[c].max(p[c]);
        }
    }
    let size = (0..3).map(|c| high[c] - low[c]).fold(f64::MIN_POSITIVE, f64::max);
    (low, high, size)
}
