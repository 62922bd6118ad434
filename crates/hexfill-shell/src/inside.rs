//! Inside or outside of the surface, of points and of fans.
//!
//! Source: van Oosterom, Strackee 1983 (winding numbers).

use hexfill_geometry::{Vector, add, add_scaled, halves, midpoint, sub};

/// The winding number of the closed surface of `quads` round `p`: 1 inside of one that faces outward, 0 outside. Linear time.
pub(crate) fn winding_number(quads: &[[u32; 4]], points: &[Vector], p: Vector) -> f64 {
    let triangles = quads.iter().flat_map(|q| halves(q.map(|v| points[v as usize])));
    hexfill_geometry::winding_number(triangles, p)
}

/// The mean of points.
fn centroid(polygon: &[Vector]) -> Vector {
    let n = polygon.len() as f64;
    polygon.iter().fold([0.0; 3], |s, &p| add(s, p.map(|x| x / n)))
}

/// Whether the centroid of a closed polygon lies inside the surface.
pub(crate) fn centroid_is_inside(quads: &[[u32; 4]], points: &[Vector], polygon: &[Vector]) -> bool {
    winding_number(quads, points, centroid(polygon)) > 0.5
}

/// Whether the fan from the centroid of a closed polygon to its sides lies inside the surface, as far as samples tell.
pub(crate) fn fan_is_inside(quads: &[[u32; 4]], points: &[Vector], polygon: &[Vector]) -> bool {
    let centre = centroid(polygon);
    let is_inside = |p| winding_number(quads, points, p) > 0.5;
    let between = |p, t: f64| add_scaled(centre, t, sub(p, centre));
    is_inside(centre)
        && [0.9, 0.5].into_iter().all(|t| {
            (0..polygon.len()).all(|i| {
                let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
                is_inside(between(a, t)) && is_inside(between(midpoint(a, b), t))
            })
        })
}
