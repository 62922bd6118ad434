//! Limited-memory BFGS with a diagonal preconditioner and a weak Wolfe search.
//!
//! Nocedal 1980 (two-loop recursion); the line search brackets a weak Wolfe point by doubling and halving
//! (Lewis and Overton 2013), which also serves functions that are infinite outside a domain.
//! Invariant: only pairs with positive curvature are kept, so every direction is a descent direction.
//!
//! Source: Nocedal 1980, as algorithm 7.4 of Nocedal, Wright 2006 states it; Lewis and Overton 2013, section 4 (algorithm 4.6) for the line search.

use super::long_vectors::{add_long, dot_long};
use std::collections::VecDeque;

/// When to stop, and how much to remember.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// Iterations at most.
    pub(crate) iterations: usize,
    /// Stop when the function fell by less than this fraction over ten iterations.
    pub(crate) relative_decrease: f64,
    /// Pairs remembered.
    pub(crate) memory: usize,
}

/// Outcome of [`minimise`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Minimum {
    /// The value reached.
    pub(crate) value: f64,
}

/// Minimises `f` from `x`, which ends as the best point. `f(x, gradient)` writes the gradient and returns the value,
/// infinite or NaN outside its domain. `inverse_diagonal` scales the first direction (one number a variable).
/// `stop(iteration, value)` is asked after every iteration.
pub(crate) fn minimise(
    x: &mut [f64],
    inverse_diagonal: &[f64],
    limits: Limits,
    mut f: impl FnMut(&[f64], &mut [f64]) -> f64,
    mut stop: impl FnMut(usize, f64) -> bool,
) -> Minimum {
    let n = x.len();
    let mut gradient = vec![0.0; n];
    let mut value = f(x, &mut gradient);
    let mut trial = x.to_vec();
    let mut trial_gradient = vec![0.0; n];
    let mut direction = vec![0.0; n];
    let mut pairs: VecDeque<(Vec<f64>, Vec<f64>, f64)> = VecDeque::new();
    let mut history = vec![value];
    let mut iterations = 0;
    while iterations < limits.iterations && value.is_finite() {
        two_loop(&pairs, inverse_diagonal, &gradient, &mut direction);
        let mut slope = dot_long(&gradient, &direction);
        // Rounding alone can do this, since every pair has positive curvature: forget them rather than give up.
        if slope >= 0.0 && !pairs.is_empty() {
            pairs.clear();
            two_loop(&pairs, inverse_diagonal, &gradient, &mut direction);
            slope = dot_long(&gradient, &direction);
        }
        if slope >= 0.0 || !slope.is_finite() {
            break;
        }
        let found = weak_wolfe(value, slope, |step| {
            trial.copy_from_slice(x);
            add_long(&mut trial, step, &direction);
            let v = f(&trial, &mut trial_gradient);
            (v, dot_long(&trial_gradient, &direction))
        });
        let Some(v) = found else {
            // Once more along the steepest descent, if that was not it.
            if pairs.is_empty() {
                break;
            }
            pairs.clear();
            continue;
        };
        let s: Vec<f64> = trial.iter().zip(&*x).map(|(a, b)| a - b).collect();
        let y: Vec<f64> = trial_gradient.iter().zip(&gradient).map(|(a, b)| a - b).collect();
        let sy = dot_long(&s, &y);
        // The weak Wolfe condition makes this positive but for rounding, and for the step taken where no such point
        // was found.
        if sy > 1e-14 * (dot_long(&s, &s) * dot_long(&y, &y)).sqrt() {
            if pairs.len() == limits.memory {
                pairs.pop_front();
            }
            pairs.push_back((s, y, 1.0 / sy));
        }
        x.copy_from_slice(&trial);
        std::mem::swap(&mut gradient, &mut trial_gradient);
        value = v;
        iterations += 1;
        history.push(value);
        if stop(iterations, value) {
            break;
        }
        if iterations >= 10 && history[iterations - 10] - value <= limits.relative_decrease * value.abs() {
            break;
        }
    }
    Minimum { value }
}

/// A weak Wolfe point by doubling and bracketing, or where there is none within forty trials the longest step known to decrease enough. `at(step)` tries
/// a step, and gives the value and the slope there; the last one tried is the one returned. `None` if no step decreases.
fn weak_wolfe(value: f64, slope: f64, mut at: impl FnMut(f64) -> (f64, f64)) -> Option<f64> {
    // `low` is always a step with enough decrease (or 0).
    let (mut low, mut high, mut step) = (0.0, f64::INFINITY, 1.0);
    for _ in 0..40 {
        let (v, slope_there) = at(step);
        // Infinite outside the domain compares as too high, so the search comes back by itself; no projection is
        // needed.
        if v.is_nan() || v > value + 1e-4 * step * slope {
            high = step;
        } else {
            low = step;
            if slope_there >= 0.9 * slope {
                return Some(v);
            }
        }
        step = if high.is_finite() { 0.5 * (low + high) } else { 2.0 * low };
    }
    (low > 0.0).then(|| at(low).0)
}

/// The direction of the pairs (Nocedal 1980): the product of the approximate inverse Hessian with the gradient, negative.
fn two_loop(pairs: &VecDeque<(Vec<f64>, Vec<f64>, f64)>, diagonal: &[f64], gradient: &[f64], out: &mut [f64]) {
    out.copy_from_slice(gradient);
    let mut alphas = Vec::with_capacity(pairs.len());
    for (s, y, rho) in pairs.iter().rev() {
        let alpha = rho * dot_long(s, out);
        add_long(out, -alpha, y);
        alphas.push(alpha);
    }
    // The usual scaling of the first matrix by the newest pair (Nocedal 1980), measured in the metric of the
    // diagonal.
    let gamma = pairs.back().map_or(1.0, |(_, y, rho)| {
        let scaled: Vec<f64> = y.iter().zip(diagonal).map(|(y, d)| y * d).collect();
        1.0 / (rho * dot_long(y, &scaled))
    });
    for (o, d) in out.iter_mut().zip(diagonal) {
        *o *= gamma * d;
    }
    for ((s, y, rho), alpha) in pairs.iter().zip(alphas.into_iter().rev()) {
        let beta = rho * dot_long(y, out);
        add_long(out, alpha - beta, s);
    }
    out.iter_mut().for_each(|o| *o = -*o);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_minimum_of_rosenbrock_and_stays_in_a_domain() {
        let limits = Limits { iterations: 500, relative_decrease: 0.0, memory: 8 };
        let mut x = vec![-1.2, 1.0];
        let found = minimise(
            &mut x,
            &[1.0, 1.0],
            limits,
            |x, g| {
                let (a, b) = (1.0 - x[0], x[1] - x[0] * x[0]);
                g[0] = -2.0 * a - 400.0 * x[0] * b;
                g[1] = 200.0 * b;
                a * a + 100.0 * b * b
            },
            |_, value| value < 1e-20,
        );
        assert!((x[0] - 1.0).abs() < 1e-8 && found.value < 1e-16, "{x:?} {found:?}");
        // x - ln x, infinite for x <= 0.
        let mut x = vec![100.0];
        minimise(
            &mut x,
            &[1e4],
            limits,
            |x, g| {
                g[0] = 1.0 - 1.0 / x[0];
                if x[0] > 0.0 { x[0] - x[0].ln() } else { f64::INFINITY }
            },
            |_, _| false,
        );
        assert!((x[0] - 1.0).abs() < 1e-6);
    }
}
