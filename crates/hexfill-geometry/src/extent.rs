//! How large things are and where: boxes round points, volumes of tetrahedra, centroids of surfaces.
//!
//! Source: textbook knowledge.

use crate::vector::{Vector, cross, det, norm, sub};

/// Six times the signed volume of a tetrahedron: positive if vertices 1, 2, 3 are clockwise seen from 0.
#[inline]
pub fn tet_volume([a, b, c, d]: [Vector; 4]) -> f64 {
    det(sub(b, a), sub(c, a), sub(d, a))
}

/// The lower corner of the box round the points, its upper corner, and the longest of its sides (positive).
pub fn bounding_box(points: &[Vector]) -> (Vector, Vector, f64) {
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

/// The centroid of triangles by area; the first corner if they have none.
///
/// # Panics
/// If there are no triangles.
pub fn centroid(triangles: impl IntoIterator<Item = [Vector; 3]>) -> Vector {
    let mut sum = [0.0; 3];
    let mut weight = 0.0;
    let mut first = None;
    for [a, b, c] in triangles {
        first = first.or(Some(a));
        let area = norm(cross(sub(b, a), sub(c, a)));
        weight += area;
        for k in 0..3 {
            sum[k] += area * (a[k] + b[k] + c[k]) / 3.0;
        }
    }
    if weight > 0.0 { sum.map(|s| s / weight) } else { first.expect("at least one triangle") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_corner_of_the_cube_is_a_sixth_of_it() {
        let corner = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert_eq!(tet_volume(corner), 1.0);
        let face = [corner[1], corner[2], corner[3]];
        assert_eq!(centroid([face, face]), [1.0 / 3.0; 3]);
        assert_eq!(centroid([[corner[1]; 3]]), corner[1]);
        assert_eq!(bounding_box(&corner), ([0.0; 3], [1.0; 3], 1.0));
    }
}
