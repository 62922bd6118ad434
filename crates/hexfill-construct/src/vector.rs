//! Points and vectors of three doubles, for every step that reads positions.

pub(crate) type Point = [f64; 3];

pub(crate) fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The determinant with these columns.
pub(crate) fn det([a, b, c]: [Point; 3]) -> f64 {
    dot(a, cross(b, c))
}

/// Six times the signed volume of a tetrahedron.
pub(crate) fn volume([a, b, c, d]: [Point; 4]) -> f64 {
    det([sub(b, a), sub(c, a), sub(d, a)])
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
