//! How far the corners of quads are from straight.
//!
//! Source: ours.

use hexfill_geometry::{Vector, cross, dot, norm, sub};

/// The least sine of the corners of quads, each seen against the common normal of all of them; negative for reflex ones, 1 if all are right angles.
/// Corners without directions do not count.
pub(crate) fn least_sine(quads: &[[Vector; 4]]) -> f64 {
    let corners = || quads.iter().flat_map(|q| (0..4).map(|k| (sub(q[(k + 1) % 4], q[k]), sub(q[(k + 3) % 4], q[k]))));
    let normals = || corners().map(|(a, b)| cross(a, b));
    let sum: Vector = normals().fold([0.0; 3], |s, n| [0, 1, 2].map(|k: usize| s[k] + n[k]));
    let size = norm(sum);
    let sines = corners().map(|(a, b)| dot(cross(a, b), sum) / (size * (norm(a) * norm(b))));
    sines.fold(1.0, |m, x| if x >= m { m } else { x })
}
