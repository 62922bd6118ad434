//! A point that sees the whole surface, if there is one.
//!
//! Source: ours: a subgradient method for a linear program in three unknowns, whose answer is tested and not trusted.

use hexfill_geometry::{Vector, add_scaled, bounding_box, centroid, cross, det, dot, norm, sub};
use hexfill_mesh::{QuadSurface, VertexId};

/// A point that sees every corner of every quad of a single component, if one is found: the surface is then star-shaped. The
/// centroid, or else a point moved away from the plane it is least behind, over and over by less (a subgradient method for the
/// centre of the largest ball in the kernel). What is returned was tested.
pub(crate) fn star_centre(surface: &QuadSurface, points: &[Vector]) -> Option<Vector> {
    const STEPS: usize = 300;
    if surface.n_components() != 1 {
        return None;
    }
    let corners: Vec<[VertexId; 3]> =
        surface.darts().map(|d| [surface.origin(d.prev()), surface.origin(d), surface.target(d)]).collect();
    let placed = |t: &[VertexId; 3]| t.map(|v| points[v.index()]);
    let sees = |centre: Vector| {
        corners.iter().all(|t| {
            let [a, b, c] = placed(t).map(|p| sub(p, centre));
            det(a, b, c) > 0.0
        })
    };
    let mut centre = centroid(corners.iter().map(placed));
    if sees(centre) {
        return Some(centre);
    }
    let planes: Vec<(Vector, f64)> = corners
        .iter()
        .filter_map(|t| {
            let [a, b, c] = placed(t);
            let normal = cross(sub(b, a), sub(c, a));
            let length = norm(normal);
            let unit = normal.map(|x| x / length);
            (length > 0.0).then(|| (unit, dot(unit, a)))
        })
        .collect();
    let (_, _, size) = bounding_box(points);
    for step in 0..STEPS {
        // How far the point is behind each plane.
        let depth = |(normal, height): &(Vector, f64)| height - dot(*normal, centre);
        let least = planes.iter().min_by(|a, b| depth(a).total_cmp(&depth(b)))?;
        if depth(least) > 0.0 && sees(centre) {
            return Some(centre);
        }
        // From a place outside straight behind the plane; less and less of it, so that it settles.
        let by = (0.25 * size / (step + 1) as f64).max(-depth(least));
        centre = add_scaled(centre, -by, least.0);
    }
    None
}
