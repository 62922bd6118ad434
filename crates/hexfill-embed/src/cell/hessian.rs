//! Second derivatives of the scaled Jacobian with respect to the three columns, made positive semidefinite.
//!
//! For `s = det(u1, u2, u3)` with unit vectors `u = c / |c|`: across two columns the derivative of the cross product,
//! within one column, with `n = u_l x u_m`, `-(n u' + u n') - s (I - 3 u u')` over `|c|^2`.
//!
//! Source: ours; calculus.

use hexfill_geometry::{Vector, cross, det, norm, scale};

/// A 9 x 9 matrix, row `3 * column + coordinate`.
pub(crate) type Matrix9 = [[f64; 9]; 9];

/// The Hessian of the scaled Jacobian.
pub(crate) fn hessian(c: &[Vector; 3]) -> Matrix9 {
    let length = c.map(norm);
    let u: [Vector; 3] = std::array::from_fn(|k| scale(1.0 / length[k], c[k]));
    let s = det(u[0], u[1], u[2]);
    let mut h = [[0.0; 9]; 9];
    for k in 0..3 {
        let (l, m) = ((k + 1) % 3, (k + 2) % 3);
        let n = cross(u[l], u[m]);
        // Lengths do not count, so the derivative along a column vanishes: directions are projected, and curvature
        // falls with the square of the length.
        let within = 1.0 / (length[k] * length[k]);
        for a in 0..3 {
            for b in 0..3 {
                let unit = if a == b { 1.0 } else { 0.0 };
                h[3 * k + a][3 * k + b] =
                    within * (-(n[a] * u[k][b] + u[k][a] * n[b]) - s * (unit - 3.0 * u[k][a] * u[k][b]));
            }
        }
        // d2 s / dc_k dc_l: s = x . (y x z) with x = u_k, y = u_l, z = u_m; the bilinear form in (x, y) is [z]_x,
        // projected on both sides.
        let z = u[m];
        let skew = [[0.0, z[2], -z[1]], [-z[2], 0.0, z[0]], [z[1], -z[0], 0.0]];
        let project = |u: Vector, a: usize, b: usize| (if a == b { 1.0 } else { 0.0 }) - u[a] * u[b];
        for a in 0..3 {
            for b in 0..3 {
                let mut sum = 0.0;
                for p in 0..3 {
                    for q in 0..3 {
                        sum += project(u[k], a, p) * skew[p][q] * project(u[l], q, b);
                    }
                }
                let value = sum / (length[k] * length[l]);
                h[3 * k + a][3 * l + b] = value;
                h[3 * l + b][3 * k + a] = value;
            }
        }
    }
    h
}

/// The nearest positive semidefinite matrix to a symmetric one: negative eigenvalues become 0 (cyclic Jacobi).
pub(crate) fn positive_part(matrix: &Matrix9) -> Matrix9 {
    let mut a = *matrix;
    let mut v = [[0.0; 9]; 9];
    for (i, row) in v.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    for _ in 0..30 {
        let off: f64 = (0..9).flat_map(|i| (0..i).map(move |j| (i, j))).map(|(i, j)| a[i][j] * a[i][j]).sum();
        let diagonal: f64 = (0..9).map(|i| a[i][i] * a[i][i]).sum();
        // Jacobi converges quadratically, so this is reached in a few sweeps; relative, as entries span many orders
        // of magnitude.
        if off <= 1e-24 * (off + diagonal) {
            break;
        }
        for p in 0..9 {
            for q in p + 1..9 {
                if a[p][q] == 0.0 {
                    continue;
                }
                // The smaller of the two rotations that make the entry vanish; `hypot` keeps it finite whatever the
                // scales.
                let theta = 0.5 * (a[q][q] - a[p][p]) / a[p][q];
                let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
                let c = 1.0 / t.hypot(1.0);
                let s = t * c;
                for row in &mut a {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
                for k in 0..9 {
                    (a[p][k], a[q][k]) = (c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]);
                }
                for row in &mut v {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
            }
        }
    }
    let mut out = [[0.0; 9]; 9];
    for k in 0..9 {
        // Nearest in the Frobenius norm: the eigenvectors stay, negative values go.
        let value = a[k][k].max(0.0);
        for i in 0..9 {
            for j in 0..9 {
                out[i][j] += value * v[i][k] * v[j][k];
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cell::scaled_jacobian::scaled_with_gradient;
    use hexfill_mesh::Random;

    #[test]
    fn hessian_matches_differences_of_the_gradient() {
        let mut random = Random::of_task(11, 0);
        for _ in 0..20 {
            let c: [Vector; 3] =
                std::array::from_fn(|k| std::array::from_fn(|x| f64::from(u8::from(k == x)) + 0.5 * random.signed()));
            let h = hessian(&c);
            for i in 0..9 {
                let step = 1e-5;
                let (mut high, mut low) = (c, c);
                high[i / 3][i % 3] += step;
                low[i / 3][i % 3] -= step;
                let (gh, gl) = (scaled_with_gradient(&high).unwrap().1, scaled_with_gradient(&low).unwrap().1);
                for j in 0..9 {
                    let slope = (gh[j / 3][j % 3] - gl[j / 3][j % 3]) / (2.0 * step);
                    assert!((slope - h[i][j]).abs() < 1e-6 * (1.0 + slope.abs()), "{i} {j} {slope} {}", h[i][j]);
                }
            }
        }
    }

    #[test]
    fn positive_part_splits_a_matrix() {
        let mut random = Random::of_task(12, 0);
        let mut m = [[0.0; 9]; 9];
        for i in 0..9 {
            for j in 0..=i {
                m[i][j] = random.signed();
                m[j][i] = m[i][j];
            }
        }
        let negated = m.map(|r| r.map(|x| -x));
        let (plus, minus) = (positive_part(&m), positive_part(&negated));
        for i in 0..9 {
            for j in 0..9 {
                assert!((plus[i][j] - minus[i][j] - m[i][j]).abs() < 1e-12);
                let product: f64 = (0..9).map(|k| plus[i][k] * minus[k][j]).sum();
                assert!(product.abs() < 1e-12);
            }
        }
    }
}
