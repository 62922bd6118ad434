//! Surfaces whose positions leave no room for a valid mesh.
//!
//! Source: ours.

use hexfill_geometry::{cone, cross, dot, sub};
use hexfill_mesh::{QuadId, QuadSurface, VertexId};

/// Why no mesh of the surface has det J > 0, whatever its connectivity; `None` if no such reason is seen.
pub(crate) fn no_room(surface: &QuadSurface, points: &[[f64; 3]]) -> Option<String> {
    // Seen from one vertex, in halves so that nothing overflows, and about as large as one.
    let origin = points[surface.quads().first()?[0].index()];
    let seen = |v: VertexId| [0, 1, 2].map(|k: usize| 0.5 * points[v.index()][k] - 0.5 * origin[k]);
    let largest =
        surface.quads().iter().flatten().flat_map(|&v| seen(v)).fold(f64::MIN_POSITIVE, |m, x| m.max(x.abs()));
    let at = |v: VertexId| seen(v).map(|x| x / largest);
    let corner = |quad: &[VertexId; 4], k: usize| {
        let at = |i: usize| at(quad[(k + i) % 4]);
        cross(sub(at(1), at(0)), sub(at(3), at(0)))
    };
    let mut volume = 0.0;
    for (q, quad) in surface.quads().iter().enumerate() {
        let normals: [[f64; 3]; 4] = std::array::from_fn(|k| corner(quad, k));
        let size = normals.iter().map(|n| dot(*n, *n)).fold(0.0, f64::max);
        let flat = normals.iter().all(|&n| {
            let off = cross(n, normals[0]);
            dot(off, off) <= 1e-24 * size * size
        });
        // A straight corner makes det J zero there; in a plane, a corner the other way makes it zero on a line.
        let sum: [f64; 3] = std::array::from_fn(|c| normals.iter().map(|n| n[c]).sum());
        let bad = |n: &[f64; 3]| dot(*n, *n) <= 1e-24 * size || flat && dot(*n, sum) <= 0.0;
        if let Some(k) = normals.iter().position(bad) {
            return Some(format!(
                "quad {} is straight or not convex at vertex {}, so that no hex on it has det J > 0 everywhere; move its vertices",
                QuadId::new(q),
                quad[k]
            ));
        }
        // Cut along both diagonals.
        let [a, b, c, d] = quad.map(at);
        volume += cone([a, b, c, d]) + cone([b, c, d, a]);
    }
    (volume <= 1e-12).then(|| "it encloses no volume, or faces inward".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::Problem;

    #[test]
    fn what_leaves_no_room_is_told_from_what_is_far_away() {
        let problem = Problem::named("schneiders-pyramid").unwrap();
        let points = problem.points.clone().unwrap();
        let moved = |f: &dyn Fn([f64; 3]) -> [f64; 3]| -> Option<String> {
            no_room(&problem.surface, &points.iter().map(|p| f(*p)).collect::<Vec<_>>())
        };
        assert_eq!(moved(&|p| p.map(|x| 1e6 + 1e-3 * x)), None);
        assert_eq!(moved(&|p| p.map(|x| 1e300 * x)), None);
        assert_eq!(moved(&|p| p.map(|x| 1e-300 * x)), None);
        assert!(moved(&|p| [p[0], p[1], 0.0]).is_some());
        assert!(moved(&|p| [p[0], p[1], -p[2]]).is_some_and(|why| why.contains("faces inward")));
        assert!(moved(&|_| [1.0; 3]).is_some());
        let mut bent = points.clone();
        let base = problem.surface.quads()[0];
        // A corner of a planar quad beyond the line of its neighbours.
        let [a, b, c] = [0, 1, 2].map(|k: usize| base[k].index());
        bent[b] = [0, 1, 2].map(|k: usize| 0.6 * (points[a][k] + points[c][k]) - 0.2 * points[b][k]);
        assert!(no_room(&problem.surface, &bent).is_some_and(|why| why.contains("not convex")));
    }
}
