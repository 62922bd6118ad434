//! The scaled Jacobian at a point of a cell, and its gradient.
//!
//! The determinant of the three columns of J over the product of their lengths: the volume that their directions span, 1 for a cube.
//!
//! Source: Knupp et al. 2006, chapter 7, section Scaled Jacobian, for the measure at corners; at any point of a cell it is the same formula.

use hexfill_geometry::{Vector, add, cross, det, norm, scale};

/// The weights of J at a point of the unit cube: column `d` is the sum of `weights[corner][d] * vertex`.
pub(crate) fn weights_at(x: [f64; 3]) -> [[f64; 3]; 8] {
    let mut out = [[0.0; 3]; 8];
    for (corner, position) in hexfill_mesh::cube::POSITIONS.iter().enumerate() {
        let value = |d: usize| if position[d] == 1 { x[d] } else { 1.0 - x[d] };
        let slope = |d: usize| if position[d] == 1 { 1.0 } else { -1.0 };
        out[corner] = [slope(0) * value(1) * value(2), value(0) * slope(1) * value(2), value(0) * value(1) * slope(2)];
    }
    out
}

/// The columns of J at a lattice point.
#[inline]
pub(crate) fn columns(p: &[Vector; 8], weights: &[[f64; 3]; 8]) -> [Vector; 3] {
    let mut c = [[0.0; 3]; 3];
    for (p, w) in p.iter().zip(weights) {
        for d in 0..3 {
            for k in 0..3 {
                c[d][k] += w[d] * p[k];
            }
        }
    }
    c
}

/// Scaled Jacobian of three columns and its gradient with respect to each; `None` if a column vanishes.
#[inline]
pub(crate) fn scaled_with_gradient(c: &[Vector; 3]) -> Option<(f64, [Vector; 3])> {
    let length = c.map(norm);
    if !length.iter().all(|&l| l > 0.0 && l.is_finite()) {
        return None;
    }
    let u: [Vector; 3] = std::array::from_fn(|k| scale(1.0 / length[k], c[k]));
    let s = det(u[0], u[1], u[2]);
    let gradient = std::array::from_fn(|k| {
        let n = cross(u[(k + 1) % 3], u[(k + 2) % 3]);
        scale(1.0 / length[k], [n[0] - s * u[k][0], n[1] - s * u[k][1], n[2] - s * u[k][2]])
    });
    Some((s, gradient))
}

/// Scaled Jacobian of three columns; -1 if a column vanishes.
#[inline]
pub(crate) fn scaled(c: &[Vector; 3]) -> f64 {
    let s = det(c[0], c[1], c[2]) / (norm(c[0]) * norm(c[1]) * norm(c[2]));
    if s.is_finite() { s } else { -1.0 }
}

/// Adds `slope` times the gradient by columns `g` at a point with these weights to the gradient by corner.
#[inline]
pub(crate) fn add_by_corner(gradient: &mut [Vector; 8], weights: &[Vector; 8], slope: f64, g: &[Vector; 3]) {
    for (sum, w) in gradient.iter_mut().zip(weights) {
        for d in 0..3 {
            *sum = add(*sum, g[d].map(|x| slope * w[d] * x));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::Random;

    #[test]
    fn gradient_of_the_scaled_jacobian() {
        let mut random = Random::of_task(3, 0);
        for _ in 0..50 {
            let c: [Vector; 3] = std::array::from_fn(|_| std::array::from_fn(|_| random.signed()));
            let (s, g) = scaled_with_gradient(&c).unwrap();
            assert!((s - scaled(&c)).abs() < 1e-14);
            for k in 0..3 {
                for x in 0..3 {
                    let h = 1e-6;
                    let (mut high, mut low) = (c, c);
                    high[k][x] += h;
                    low[k][x] -= h;
                    let slope = (scaled(&high) - scaled(&low)) / (2.0 * h);
                    assert!((slope - g[k][x]).abs() < 1e-6 * (1.0 + slope.abs()) / norm(c[k]).min(1.0).powi(3));
                }
            }
        }
    }
}
