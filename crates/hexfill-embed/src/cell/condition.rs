//! The condition number of the Jacobian at a corner.
//!
//! It is Verdict's: `|J| |J^-1| / 3` in the Frobenius norm, 1 for a cube
//! (Knupp et al., Verdict library reference manual, 2006).
//!
//! Source: Knupp et al. 2006, chapter 7, section Maximum Aspect Frobenius, which says that this was called the condition number.

use hexfill_geometry::{Vector, cross, dot};

/// Logarithm of the condition number of three columns; infinite unless the determinant is positive.
pub(crate) fn log_condition(c: &[Vector; 3]) -> f64 {
    log_condition_with_gradient(c).map_or(f64::INFINITY, |(value, _)| value)
}

/// As [`log_condition`], with the gradient with respect to each column; `None` unless the determinant is positive.
pub(crate) fn log_condition_with_gradient(c: &[Vector; 3]) -> Option<(f64, [Vector; 3])> {
    let n: [Vector; 3] = std::array::from_fn(|k| cross(c[(k + 1) % 3], c[(k + 2) % 3]));
    let d = dot(c[0], n[0]);
    let lengths: f64 = c.iter().map(|&v| dot(v, v)).sum();
    let areas: f64 = n.iter().map(|&v| dot(v, v)).sum();
    let value = 0.5 * (lengths.ln() + areas.ln()) - d.ln() - 3f64.ln();
    if !(d > 0.0 && value.is_finite()) {
        return None;
    }
    let gradient = std::array::from_fn(|k| {
        let (l, m) = ((k + 1) % 3, (k + 2) % 3);
        // |c_k x c_l|^2 and |c_m x c_k|^2 depend on c_k: their gradients are c_l x (c_k x c_l) and (c_m x c_k) x c_m, doubled.
        let a = cross(c[l], n[m]);
        let b = cross(n[l], c[m]);
        std::array::from_fn(|x| c[k][x] / lengths + (a[x] + b[x]) / areas - n[k][x] / d)
    });
    Some((value, gradient))
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::Random;

    #[test]
    fn condition_of_a_cube_is_one_and_the_gradient_is_right() {
        assert!(log_condition(&[[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]]).abs() < 1e-15);
        let mut random = Random::of_task(31, 0);
        for _ in 0..20 {
            let c: [Vector; 3] =
                std::array::from_fn(|k| std::array::from_fn(|x| f64::from(u8::from(k == x)) + 0.4 * random.signed()));
            let Some((_, g)) = log_condition_with_gradient(&c) else { continue };
            for i in 0..9 {
                let (mut high, mut low) = (c, c);
                high[i / 3][i % 3] += 1e-6;
                low[i / 3][i % 3] -= 1e-6;
                let slope = (log_condition(&high) - log_condition(&low)) / 2e-6;
                assert!((slope - g[i / 3][i % 3]).abs() < 1e-6 * (1.0 + slope.abs()), "{slope} {g:?}");
            }
        }
    }
}
