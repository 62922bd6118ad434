//! Angles between directions, in radians.
//!
//! Source: textbook knowledge; by the arctangent, which keeps its digits near 0 and 180 degrees where the arccosine does not.

use crate::vector::{Vector, add_scaled, cross, dot, norm, unit};
use std::f64::consts::TAU;

/// The angle from `a` to `b`, counter-clockwise seen against `normal`: below pi at a convex corner of a face with this
/// outward normal, above pi at a reflex one; in [0, 2 pi). Lengths do not matter; pi / 2 and the like are exact to rounding.
pub fn corner_angle(a: Vector, b: Vector, normal: Vector) -> f64 {
    let n = cross(a, b);
    let sine = norm(n);
    let angle = sine.atan2(dot(a, b));
    if dot(n, normal) < 0.0 { TAU - angle } else { angle }
}

/// The angle round the unit vector `edge` that turns `from` into `to` (right-handed), in [0, 2 pi); `None` if one of the two is parallel
/// to the edge. The dihedral angle inside a solid, at one end of an edge, runs from the side of the face on the edge's right (seen from outside) to
/// that of the face on its left.
pub fn dihedral_angle(edge: Vector, from: Vector, to: Vector) -> Option<f64> {
    let tangent = |d: Vector| unit(add_scaled(d, -dot(d, edge), edge));
    let (from, to) = (tangent(from)?, tangent(to)?);
    Some(dot(edge, cross(from, to)).atan2(dot(from, to)).rem_euclid(TAU))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    #[test]
    fn right_angles() {
        let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 1.0]);
        assert_eq!(corner_angle(x, y, z), FRAC_PI_2);
        assert_eq!(corner_angle(y, x, z), 3.0 * FRAC_PI_2);
        assert_eq!(corner_angle(x, [-3.0, 0.0, 0.0], z), PI);
        assert_eq!(dihedral_angle(z, x, y), Some(FRAC_PI_2));
        assert_eq!(dihedral_angle(z, y, [1.0, 0.0, 5.0]), Some(3.0 * FRAC_PI_2));
        assert_eq!(dihedral_angle(z, x, z), None);
    }
}
