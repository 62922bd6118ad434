//! Quads taken for two triangles.
//!
//! Source: ours.

use crate::vector::{Vector, det};

/// The two triangles of a quad.
#[inline]
pub fn halves([a, b, c, d]: [Vector; 4]) -> [[Vector; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

/// Six times the volume of the cone from the origin to the two triangles of a quad: positive if it faces away from the origin. Over a closed
/// surface that faces outward these add up to six times its volume.
#[inline]
pub fn cone(quad: [Vector; 4]) -> f64 {
    let [[a, b, c], [e, f, g]] = halves(quad);
    det(a, b, c) + det(e, f, g)
}
