//! Inside or outside: winding numbers of points with respect to the surface.

/// The winding number of the closed surface of `quads` round `p`: 1 inside of one that faces outward, 0 outside.
///
/// Sum of the solid angles of two triangles a quad (Van Oosterom, Strackee 1983). Linear time.
pub(crate) fn winding_number(quads: &[[u32; 4]], points: &[[f64; 3]], p: [f64; 3]) -> f64 {
    let mut angle = 0.0;
    for q in quads {
        let c = q.map(|v| {
            let x = points[v as usize];
            [x[0] - p[0], x[1] - p[1], x[2] - p[2]]
        });
        angle += solid_angle(c[0], c[1], c[2]) + solid_angle(c[0], c[2], c[3]);
    }
    angle / (2.0 * std::f64::consts::TAU)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The determinant of three vectors: six times the signed volume of the tetrahedron with the origin.
pub(crate) fn determinant([a, b, c]: [[f64; 3]; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}

fn solid_angle(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    let [la, lb, lc] = [a, b, c].map(|x| dot(x, x).sqrt());
    let det = determinant([a, b, c]);
    let below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    2.0 * det.atan2(below)
}

fn centroid(polygon: &[[f64; 3]]) -> [f64; 3] {
    let n = polygon.len() as f64;
    polygon.iter().fold([0.0; 3], |s, p| [0, 1, 2].map(|c| s[c] + p[c] / n))
}

/// Whether the centroid of a closed polygon lies inside the surface.
pub(crate) fn centroid_is_inside(quads: &[[u32; 4]], points: &[[f64; 3]], polygon: &[[f64; 3]]) -> bool {
    winding_number(quads, points, centroid(polygon)) > 0.5
}

/// Whether the fan from the centroid of a closed polygon to its sides lies inside the surface, as far as samples tell.
pub(crate) fn fan_is_inside(quads: &[[u32; 4]], points: &[[f64; 3]], polygon: &[[f64; 3]]) -> bool {
    let centre = centroid(polygon);
    let is_inside = |p| winding_number(quads, points, p) > 0.5;
    let between = |p: [f64; 3], t: f64| [0, 1, 2].map(|c| centre[c] + t * (p[c] - centre[c]));
    is_inside(centre)
        && [0.9, 0.5].into_iter().all(|t| {
            (0..polygon.len()).all(|i| {
                let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
                let middle = [0, 1, 2].map(|c| (a[c] + b[c]) / 2.0);
                is_inside(between(a, t)) && is_inside(between(middle, t))
            })
        })
}
