//! Roots of quadratic polynomials.
//!
//! Source: Forsythe 1970 (the root without cancellation first, the other from the product).

/// The real roots of `c[0] + 2 c[1] t + c[2] t^2`; `None` if there are none. One may be infinite, or NaN where all vanish: whoever asks for roots in a range sees neither.
///
/// # Example
/// ```
/// use hexfill_geometry::quadratic_roots;
///
/// let mut roots = quadratic_roots([1e-20, -0.5, 1.0]).expect("both are real");
/// roots.sort_by(f64::total_cmp);
/// assert_eq!(roots, [1e-20, 1.0]);
/// assert_eq!(quadratic_roots([1.0, 0.0, 1.0]), None);
/// ```
pub fn quadratic_roots([c0, c1, c2]: [f64; 3]) -> Option<[f64; 2]> {
    let d = c1 * c1 - c0 * c2;
    // Nothing is subtracted here but what has the same sign.
    let q = -(c1 + d.sqrt().copysign(c1));
    (d >= 0.0).then(|| [q / c2, c0 / q])
}
