//! Conjugate gradients with a diagonal preconditioner (Hestenes and Stiefel 1952).
//!
//! For a symmetric positive semidefinite matrix, given by what it does to a vector; a singular one needs a residual in its range.
//!
//! Source: Hestenes, Stiefel 1952.

use super::long_vectors::{add_long, dot_long};

/// When conjugate gradients stop.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// Iterations at most.
    pub(crate) iterations: usize,
    /// Stop when `r' D^-1 r` is at most this, for the residual r and the diagonal D.
    pub(crate) residual: f64,
}

/// Moves `x` towards the solution of `A x = b`, where `apply(x, out)` writes A x, `residual` is b - A x, and `diagonal` is that of A (infinite
/// holds an entry where it is). `stop` is asked before every iteration.
pub(crate) fn conjugate_gradients(
    x: &mut [f64],
    mut residual: Vec<f64>,
    diagonal: &[f64],
    limits: Limits,
    apply: impl Fn(&[f64], &mut [f64]),
    stop: impl Fn() -> bool,
) {
    let mut applied = vec![0.0; x.len()];
    let mut z = vec![0.0; x.len()];
    divide(&residual, diagonal, &mut z);
    let mut p = z.clone();
    let mut rz = dot_long(&residual, &z);
    for _ in 0..limits.iterations {
        if rz <= limits.residual || stop() {
            break;
        }
        apply(&p, &mut applied);
        let alpha = rz / dot_long(&p, &applied);
        if !alpha.is_finite() {
            break;
        }
        add_long(x, alpha, &p);
        add_long(&mut residual, -alpha, &applied);
        divide(&residual, diagonal, &mut z);
        let next = dot_long(&residual, &z);
        let beta = next / rz;
        rz = next;
        p.iter_mut().zip(&z).for_each(|(p, z)| *p = z + beta * *p);
    }
}

/// `out = a / b`, entry by entry.
fn divide(a: &[f64], b: &[f64], out: &mut [f64]) {
    out.iter_mut().zip(a.iter().zip(b)).for_each(|(o, (a, b))| *o = a / b);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_with_one_entry_held_is_solved() {
        // 2 x_i - x_(i-1) - x_(i+1) = 0 between 0 and 1; the entry in the middle is held where it is.
        let n = 9;
        let apply = |x: &[f64], out: &mut [f64]| {
            for i in 0..n {
                let at = |j: usize| if j < n { x[j] } else { 0.0 };
                out[i] = 2.0 * x[i] - at(i.wrapping_sub(1)) - at(i + 1);
            }
        };
        let mut diagonal = vec![2.0; n];
        diagonal[4] = f64::INFINITY;
        let mut x = vec![0.0; n];
        x[4] = 3.0;
        let mut applied = vec![0.0; n];
        apply(&x, &mut applied);
        let residual = (0..n).map(|i| f64::from(u8::from(i == n - 1)) - applied[i]).collect();
        conjugate_gradients(&mut x, residual, &diagonal, Limits { iterations: 50, residual: 1e-28 }, apply, || false);
        let wanted = [0.6, 1.2, 1.8, 2.4, 3.0, 2.6, 2.2, 1.8, 1.4];
        assert!(x.iter().zip(wanted).all(|(x, w)| (x - w).abs() < 1e-12), "{x:?}");
    }
}
