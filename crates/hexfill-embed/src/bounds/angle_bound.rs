//! What angles allow: corners that tile a solid or dihedral angle share it.
//!
//! In a valid mesh of a surface that does not cross itself the corners at a boundary vertex tile its solid angle, and
//! those at a boundary edge its dihedral angle. So some corner has at most the mean of either, and the determinant of three unit vectors is
//! bounded by the angles they span.
//!
//! Source: ours.

use hexfill_geometry::{Vector, dihedral_angle};
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI};

/// What the angles at a vertex allow, if the corners (right-handed triples of edges, given by their other ends) form a disk in the
/// link; else 1. `direction` gives the unit directions of the fixed edges; those on the disk's rim must be.
///
/// Of n corners in the solid angle `W` one has at most `W / n`, and among spherical triangles of an area up to a quarter of the half-sphere
/// the equilateral one has the largest determinant (with a side and the area given, the third point lies on a circle, Lexell 1784, and is
/// farthest from the side's plane in the isosceles case). Of m corners in the dihedral angle `a` one has at most `a / m`, and a
/// determinant is at most the sine of its dihedral angle.
pub(super) fn angle_bound(corners: &[[u32; 3]], direction: impl Fn(u32) -> Option<Vector>) -> f64 {
    // Arcs a -> b of the link's triangles that no neighbour has as b -> a: the rim, with the disk on the left.
    let arcs: Vec<[u32; 2]> = corners.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    let mut back: Vec<[u32; 2]> = arcs.iter().map(|&[a, b]| [b, a]).collect();
    back.sort_unstable();
    let rim: BTreeMap<u32, u32> =
        arcs.iter().filter(|arc| back.binary_search(arc).is_err()).map(|&[a, b]| (a, b)).collect();
    let Some((&first, _)) = rim.first_key_value() else { return 1.0 };
    let (mut bound, mut sum, mut n_rim) = (1.0f64, 0.0, 0);
    let (mut before, mut at) = (first, rim[&first]);
    loop {
        let Some(&after) = rim.get(&at) else { return 1.0 };
        let (Some(e), Some(p), Some(q)) = (direction(at), direction(before), direction(after)) else { return 1.0 };
        let Some(angle) = dihedral_angle(e, q, p) else { return 1.0 };
        let share = angle / corners.iter().filter(|c| c.contains(&at)).count() as f64;
        if share < FRAC_PI_2 {
            bound = bound.min(share.sin());
        }
        (sum, n_rim) = (sum + angle, n_rim + 1);
        (before, at) = (at, after);
        if before == first || n_rim > rim.len() {
            break;
        }
    }
    if n_rim != rim.len() || n_rim < 3 {
        return 1.0;
    }
    // The area of a spherical polygon by its angles (Girard).
    let solid = sum - (n_rim as f64 - 2.0) * PI;
    let share = solid / corners.len() as f64;
    if solid > 1e-9 && share < FRAC_PI_2 {
        bound = bound.min(equilateral(share));
    }
    // Too small an angle to tell from nothing says nothing.
    if bound > 1e-9 { bound } else { 1.0 }
}

/// The determinant of three unit vectors with equal angles that span this solid angle.
pub(super) fn equilateral(solid: f64) -> f64 {
    let cos_angle = ((solid + PI) / 3.0).cos();
    let c = cos_angle / (1.0 - cos_angle);
    (1.0 - c) * (1.0 + 2.0 * c).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_geometry::{best_direction, cross, dot, unit};
    use hexfill_mesh::Random;

    #[test]
    fn no_triangle_of_an_area_beats_the_equilateral_one() {
        assert!((equilateral(std::f64::consts::FRAC_PI_2) - 1.0).abs() < 1e-12);
        let mut random = Random::of_task(22, 0);
        let (mut seen, mut near) = (0, 0.0f64);
        for _ in 0..200_000 {
            let size = 0.2 + random.unit();
            let mut direction = || unit([1.0, size * random.signed(), size * random.signed()]).unwrap();
            let (a, b, c) = (direction(), direction(), direction());
            let d = dot(a, cross(b, c));
            let solid = 2.0 * d.atan2(1.0 + dot(a, b) + dot(b, c) + dot(c, a));
            if solid > 1e-3 && solid < std::f64::consts::FRAC_PI_2 {
                seen += 1;
                near = near.max(d / equilateral(solid));
                assert!(d <= equilateral(solid) + 1e-12, "{d} {solid}");
            }
        }
        assert!(seen > 10_000 && near > 0.99, "{seen} {near}");
    }

    #[test]
    fn angles_of_a_cube_corner_cut_in_three() {
        // The octant in three equal corners: the true optimum is that of the ray in the middle.
        let rays = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let corners = [[0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let bound = angle_bound(&corners, |w| rays.get(w as usize).copied());
        // Each of the three edges has 90 degrees for two corners; the solid angle is pi / 2 for three.
        let by_solid = equilateral(std::f64::consts::FRAC_PI_2 / 3.0);
        assert!((bound - by_solid.min(0.5f64.sqrt())).abs() < 1e-12);
        let normals: Vec<Vector> = [[0, 1], [1, 2], [2, 0]].iter().map(|&[i, j]| cross(rays[i], rays[j])).collect();
        assert!(best_direction(&normals).value <= bound + 1e-12);
        // Seen from the other side the angles are those outside; a rim with a free edge says nothing.
        let outside = [[1, 0, 3], [2, 1, 3], [0, 2, 3]];
        assert_eq!(angle_bound(&outside, |w| rays.get(w as usize).copied()), 1.0);
        let apart = [[0, 1, 2], [0, 2, 3]];
        assert_eq!(angle_bound(&apart, |w| rays.get(w as usize).copied()), 1.0);
    }
}
