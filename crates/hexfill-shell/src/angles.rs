//! How many hexes each surface edge wants round it: its dihedral angle inside the solid, in right angles.
//!
//! A hex is happiest with right angles, so an edge of angle a wants a / 90 degrees of them. 1 is a crease of a box, 2 is
//! flat, 3 is the inner edge of an L.
//!
//! Source: ours; the same wish stands in Reberol et al. 2023 (valences nearest to angle / 90 degrees).

use hexfill_geometry::{cross, dot, sub};
use hexfill_mesh::{Dart, QuadSurface};

/// What a flat edge wants.
pub(crate) const FLAT: f32 = 2.0;

/// Per dart: the angle inside the solid at its edge, in right angles (0 to 4); 2 everywhere without positions.
/// The two darts of an edge have the same number.
pub(crate) fn wanted_hexes(surface: &QuadSurface, points: Option<&[[f64; 3]]>) -> Vec<f32> {
    let n = 4 * surface.n_quads();
    let Some(points) = points else { return vec![FLAT; n] };
    let at = |d: Dart| points[surface.origin(d).index()];
    // Outward normal of the quad near the edge: along the edge, then towards the middle of the opposite edge.
    let normal = |d: Dart| {
        let [a, b, c, e] = [at(d), at(d.next()), at(d.opposite()), at(d.prev())];
        let inward: [f64; 3] = std::array::from_fn(|k| c[k] + e[k] - a[k] - b[k]);
        cross(sub(b, a), inward)
    };
    let mut wanted = vec![FLAT; n];
    for d in surface.darts() {
        let t = surface.twin(d);
        if t < d {
            wanted[d.index()] = wanted[t.index()];
            continue;
        }
        let along = sub(at(d.next()), at(d));
        let (n1, n2) = (normal(d), normal(t));
        let sine = dot(cross(n1, n2), along) / dot(along, along).sqrt();
        // Outward normals: equal on a flat edge, apart on a convex one; the angle is that inside the solid.
        let angle = std::f64::consts::PI - sine.atan2(dot(n1, n2));
        if angle.is_finite() {
            wanted[d.index()] = (angle / std::f64::consts::FRAC_PI_2) as f32;
        }
    }
    wanted
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::cube::POSITIONS;

    #[test]
    fn a_cube_wants_one_hex_at_every_edge_and_its_outside_three() {
        let surface = hexfill_mesh::generate::cube_surface();
        let points: Vec<[f64; 3]> = POSITIONS.iter().map(|p| p.map(f64::from)).collect();
        assert!(wanted_hexes(&surface, Some(&points)).iter().all(|w| (w - 1.0).abs() < 1e-6));
        let outside = surface.inverted();
        assert!(wanted_hexes(&outside, Some(&points)).iter().all(|w| (w - 3.0).abs() < 1e-6));
    }
}
