//! Volume balance: what the hexes hold against what the boundary encloses.
//!
//! The volume of a trilinear hex is the mean of its 27 Bernstein coefficients. The flux of x/3 through a bilinear quad is the
//! mean over the two ways of cutting it into triangles. Interior quads cancel, so the two sums agree up to rounding in every
//! mesh whose quads pair up in opposite senses: the balance is a check of the arithmetic and of the incidence.
//!
//! Source: ours; the theorem of Gauss.

use super::bernstein::{Vector, cross, dot};
use crate::topology::boundary_quad::BoundaryQuad;

/// Neumaier's compensated sum.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sum {
    sum: f64,
    rest: f64,
}

impl Sum {
    pub(crate) fn add(&mut self, x: f64) {
        let t = self.sum + x;
        self.rest += if self.sum.abs() >= x.abs() { (self.sum - t) + x } else { (x - t) + self.sum };
        self.sum = t;
    }

    pub(crate) fn value(self) -> f64 {
        self.sum + self.rest
    }
}

/// The volume enclosed by the boundary, outward quads counted positive.
pub(crate) fn enclosed(boundary: &[BoundaryQuad], points: &[Vector]) -> f64 {
    let Some(first) = boundary.first() else { return 0.0 };
    // Measured from a point of the boundary: less cancellation.
    let origin = points[first.cycle[0] as usize];
    let mut sum = Sum::default();
    for quad in boundary {
        let [a, b, c, d] = quad.cycle.map(|v| {
            let p = points[v as usize];
            [p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]]
        });
        let det = |x, y, z| dot(x, cross(y, z));
        sum.add((det(a, b, c) + det(a, c, d) + det(a, b, d) + det(b, c, d)) / 12.0);
    }
    sum.value()
}
