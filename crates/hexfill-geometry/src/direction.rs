//! The best direction of one free edge: the maximum over unit `u` of the minimum of `u . n` over some normals.
//!
//! If it is positive, it is the distance from the origin to the convex hull of the normals, and `u` points to the nearest point of the
//! hull (duality): found by walking over supports of at most three normals (P. Wolfe, *Finding the nearest point in a polytope*,
//! 1976). If the hull holds the origin, the maximum is not positive, and at the optimum three normals have equal products (the hull's
//! nearest facet): all triples are tried. Either way the value is that of the direction returned.
//!
//! Source: Wolfe 1976 (the nearest point of a polytope).

use crate::vector::{Vector, add, add_scaled, cross, dot, norm, scale, sub, unit};

/// A direction and the least product it has with the normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Best {
    /// The least product, the largest possible one.
    pub value: f64,
    /// The unit vector that has it.
    pub direction: Vector,
}

/// The unit vector `u` with the largest minimum of `u . n` over `normals`, exact up to rounding. With normals `e_i x e_{i+1}` of
/// the unit edges round a vertex the value is the best worst scaled Jacobian a single further edge can have there.
///
/// Zero normals give 0. No normals at all: value 1 by convention. Linear time where the value is positive, else cubic.
///
/// # Example
/// Three axes, and a fourth edge between them: the diagonal is best, with cos 54.7 degrees to each.
/// ```
/// use hexfill_geometry::best_direction;
///
/// let best = best_direction(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
/// assert!((best.value - 1.0 / 3f64.sqrt()).abs() < 1e-12);
/// // Opposite normals: no direction is better than across both.
/// assert!(best_direction(&[[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]).value.abs() < 1e-12);
/// ```
pub fn best_direction(normals: &[Vector]) -> Best {
    let Some(&first) = normals.first() else { return Best { value: 1.0, direction: [0.0, 0.0, 1.0] } };
    if let Some(u) = nearest_of_hull(normals, first).and_then(unit) {
        let value = least(normals, u);
        if value > 0.0 {
            return Best { value, direction: u };
        }
    }
    by_triples(normals)
}

fn least(normals: &[Vector], u: Vector) -> f64 {
    normals.iter().map(|&n| dot(u, n)).fold(f64::INFINITY, f64::min)
}

/// The point of the hull nearest to the origin; `None` if the hull holds the origin, up to rounding.
fn nearest_of_hull(normals: &[Vector], first: Vector) -> Option<Vector> {
    let mut support = vec![first];
    let mut p = first;
    // The distance falls strictly, so no support comes twice but by rounding.
    for _ in 0..100 + 2 * normals.len() {
        let square = dot(p, p);
        if square < 1e-24 {
            return None;
        }
        let worst = normals.iter().copied().min_by(|&a, &b| dot(a, p).total_cmp(&dot(b, p)))?;
        if dot(worst, p) >= square * (1.0 - 1e-14) || support.contains(&worst) {
            return Some(p);
        }
        support.push(worst);
        let (nearest, face) = nearest_of_simplex(&support);
        if support.len() == 4 && support.iter().any(|&n| dot(n, nearest) < dot(nearest, nearest) - 1e-13) {
            return None;
        }
        if dot(nearest, nearest) >= square {
            return Some(p);
        }
        (p, support) = (nearest, face);
    }
    Some(p)
}

/// The point nearest to the origin in a vertex, edge or triangle of at most four points, and that face's vertices.
fn nearest_of_simplex(points: &[Vector]) -> (Vector, Vec<Vector>) {
    let mut best = (points[0], vec![points[0]]);
    let mut consider = |p: Vector, face: &[Vector]| {
        if dot(p, p) < dot(best.0, best.0) {
            best = (p, face.to_vec());
        }
    };
    for (i, &a) in points.iter().enumerate() {
        consider(a, &[a]);
        for (j, &b) in points[..i].iter().enumerate() {
            let along = sub(b, a);
            let t = -dot(a, along) / dot(along, along);
            if t > 0.0 && t < 1.0 {
                consider(add_scaled(a, t, along), &[a, b]);
            }
            for &c in &points[..j] {
                let other = sub(c, a);
                let normal = cross(along, other);
                let square = dot(normal, normal);
                // Barycentric coordinates of the origin's projection.
                let s = -dot(cross(a, other), normal) / square;
                let t = -dot(cross(along, a), normal) / square;
                if s > 0.0 && t > 0.0 && s + t < 1.0 {
                    consider(add(a, add(scale(s, along), scale(t, other))), &[a, b, c]);
                }
            }
        }
    }
    best
}

/// The optimum where it is not positive: the best of finitely many candidates.
fn by_triples(normals: &[Vector]) -> Best {
    // Most candidates fall at once by the normal that felled the last one.
    let mut order = normals.to_vec();
    let mut best =
        Best { value: -1.0 - normals.iter().map(|&n| norm(n)).fold(0.0, f64::max), direction: [0.0, 0.0, 1.0] };
    let mut consider = |candidate: Vector| {
        let Some(u) = unit(candidate) else { return };
        for u in [u, scale(-1.0, u)] {
            let mut value = f64::INFINITY;
            for i in 0..order.len() {
                value = value.min(dot(u, order[i]));
                if value <= best.value {
                    order.swap(i, 0);
                    break;
                }
            }
            if value > best.value {
                best = Best { value, direction: u };
            }
        }
    };
    for (i, &a) in normals.iter().enumerate() {
        consider(a);
        // Opposite normals: the best is any direction across them, with value 0.
        for axis in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
            consider(cross(a, axis));
        }
        for (j, &b) in normals.iter().enumerate().take(i) {
            let along = sub(b, a);
            // The point of the line a b nearest to the origin: equal products with a and b, within their plane.
            let square = dot(along, along);
            if square > 0.0 {
                consider(add_scaled(a, -dot(a, along) / square, along));
            }
            for &c in &normals[..j] {
                consider(cross(along, sub(c, a)));
            }
        }
    }
    // All normals zero: every direction gives 0.
    if normals.iter().all(|n| dot(*n, *n) == 0.0) { Best { value: 0.0, ..best } } else { best }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::Random;

    fn random_vector(random: &mut Random) -> Vector {
        std::array::from_fn(|_| 2.0 * random.unit() - 1.0)
    }

    #[test]
    fn closed_form_beats_and_meets_a_dense_sampling() {
        let mut random = Random::new(21);
        for case in 0..40 {
            let lift = if case < 20 { 1.3 } else { 0.1 };
            let normals: Vec<Vector> =
                (0..1 + case % 8).map(|_| add(random_vector(&mut random), [0.0, 0.0, lift])).collect();
            let exact = best_direction(&normals);
            assert!((least(&normals, exact.direction) - exact.value).abs() < 1e-12);
            let mut sampled = f64::NEG_INFINITY;
            for _ in 0..20000 {
                if let Some(u) = unit(random_vector(&mut random)) {
                    sampled = sampled.max(least(&normals, u));
                }
            }
            assert!(sampled <= exact.value + 1e-12 && exact.value < sampled + 0.08, "{exact:?} {sampled}");
        }
    }

    #[test]
    fn both_ways_agree() {
        let mut random = Random::new(5);
        let mut positive = 0;
        for case in 0..2000 {
            let lift = [0.0, 0.5, 1.0, 1.5][case % 4];
            let normals: Vec<Vector> =
                (0..1 + case % 9).map(|_| add(random_vector(&mut random), [0.0, 0.0, lift])).collect();
            let (fast, slow) = (best_direction(&normals).value, by_triples(&normals).value);
            assert!((fast - slow).abs() < 1e-10, "{fast} {slow} {normals:?}");
            positive += usize::from(fast > 0.0);
        }
        assert!((500..1900).contains(&positive), "{positive}");
    }

    #[test]
    fn opposite_normals_leave_zero_not_less() {
        let (up, down) = ([0.0, 0.0, 1.0], [0.0, 0.0, -0.5]);
        assert_eq!(best_direction(&[up, down]).value, 0.0);
        // A third normal is met by turning across the first two.
        assert!(best_direction(&[up, down, [0.6, 0.0, 0.8]]).value.abs() < 1e-12);
        assert!(best_direction(&[up, down, [0.6, 0.0, 0.0], [-0.6, 0.0, 0.0]]).value.abs() < 1e-12);
        assert_eq!(best_direction(&[[0.0; 3]]).value, 0.0);
    }
}
