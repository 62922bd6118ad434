//! [`Frame`]: where the work is done.
//!
//! Source: ours.

use hexfill_geometry::{Vector, norm, sub};

/// Where the work is done: the mean of some points at the origin, the farthest at distance 1.
pub(crate) struct Frame {
    centre: Vector,
    size: f64,
}

impl Frame {
    pub(crate) fn of(points: &[Vector]) -> Self {
        let share = 1.0 / points.len().max(1) as f64;
        let centre = std::array::from_fn(|axis| points.iter().map(|p| share * p[axis]).sum());
        let size = points.iter().map(|&p| norm(sub(p, centre))).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
        Self { centre, size }
    }

    pub(crate) fn enter(&self, p: Vector) -> Vector {
        sub(p, self.centre).map(|x| x / self.size)
    }

    pub(crate) fn leave(&self, p: Vector) -> Vector {
        std::array::from_fn(|axis| self.size.mul_add(p[axis], self.centre[axis]))
    }
}
