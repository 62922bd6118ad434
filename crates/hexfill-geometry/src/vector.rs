//! Vectors in three dimensions as plain arrays: no type to convert to, so files, solvers and pictures share them.
//!
//! Source: textbook knowledge.

/// A point or a vector.
pub type Vector = [f64; 3];

/// `a + b`.
#[inline]
pub fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// `a - b`.
#[inline]
pub fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `s * a`.
#[inline]
pub fn scale(s: f64, a: Vector) -> Vector {
    [s * a[0], s * a[1], s * a[2]]
}

/// `a + s * b`.
#[inline]
pub fn add_scaled(a: Vector, s: f64, b: Vector) -> Vector {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

/// The scalar product.
#[inline]
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector product.
#[inline]
pub fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The determinant with columns `a`, `b`, `c`: positive if they are right-handed.
#[inline]
pub fn det(a: Vector, b: Vector, c: Vector) -> f64 {
    dot(a, cross(b, c))
}

/// The Euclidean length.
#[inline]
pub fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// The point half way.
#[inline]
pub fn midpoint(a: Vector, b: Vector) -> Vector {
    [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])]
}

/// The unit vector along `a`, or `None` if `a` is zero or not finite.
pub fn unit(a: Vector) -> Option<Vector> {
    let n = norm(a);
    (n > 0.0 && n.is_finite()).then(|| scale(1.0 / n, a))
}

/// The unit direction from `a` to `b`, of points of any finite size; `None` if they are one.
pub fn direction(a: Vector, b: Vector) -> Option<Vector> {
    // Halves, so that the difference of large doubles is finite; then the largest component to 1, so that squares are.
    let half: Vector = std::array::from_fn(|k| 0.5 * b[k] - 0.5 * a[k]);
    let largest = half.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    // Dividing, as the inverse of a tiny number is not finite.
    if largest > 0.0 { unit(half.map(|x| x / largest)) } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_do_not_depend_on_the_unit() {
        let (a, b) = ([1.0, 2.0, 3.0], [4.0, -2.0, 3.0]);
        for s in [1.0, 1e-300, 1e300] {
            let d = direction(scale(s, a), scale(s, b)).unwrap();
            assert!(norm(sub(d, [0.6, -0.8, 0.0])) < 1e-12, "{d:?}");
        }
        assert!(direction([f64::MAX; 3], [-f64::MAX; 3]).is_some());
        assert!(direction(a, a).is_none() && direction(a, [f64::NAN; 3]).is_none());
    }
}
