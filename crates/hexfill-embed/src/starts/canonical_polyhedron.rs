//! Coordinates from connectivity alone: the canonical (midscribed) polyhedron of a 3-connected quad sphere.
//!
//! Koebe, Andreev, Thurston: every 3-connected planar graph is the graph of a convex polyhedron whose edges touch the unit
//! sphere, unique up to Moebius maps; with the touching points centred at the origin it is unique up to rotation
//! (Springborn 2005, "A unique representation of polyhedral types"). Computed as a circle packing of vertices and quads
//! ([`super::circle_packing`]), laid out and lifted to the sphere ([`super::circle_layout`]), and centred with Lorentz boosts.
//! A vertex is the apex of the cone that touches the sphere along its circle.
//!
//! Source: Springborn 2005 (abstract: the lemma on barycentres, the unique representative); Bobenko, Springborn 2004.

use super::circle_layout::touching_points;
use super::circle_packing::Packing;
use crate::error::EmbedError;
use hexfill_geometry::{Vector, add, add_scaled, cross, dot, norm, scale, sub, unit};
use hexfill_mesh::{Edge, ImproperPair, QuadSurface, improper_pairs};

/// The vertices of the canonical polyhedron of a surface, outward oriented: edges tangent to the unit sphere, touching points
/// centred at the origin, quads planar (to about 1e-14 for surfaces of up to some hundred quads). One point per vertex id;
/// ids no quad uses get the origin. The rotation is fixed by the numbering.
///
/// # Errors
/// [`EmbedError::NotASphere`], [`EmbedError::NotThreeConnected`], [`EmbedError::NotConverged`].
pub fn canonical_polyhedron(surface: &QuadSurface) -> Result<Vec<[f64; 3]>, EmbedError> {
    if !surface.is_sphere() {
        return Err(EmbedError::NotASphere { components: surface.n_components(), genus: surface.genus() });
    }
    check_three_connected(surface)?;
    let packing = Packing::new(surface)?;
    let mut touching = touching_points(&packing, surface);
    centre(&mut touching);
    let points = apexes(surface, &touching);
    if points.iter().flatten().any(|x| !x.is_finite()) {
        return Err(EmbedError::NotConverged { given: f64::INFINITY, limit: 1e-12 });
    }
    Ok(points)
}

/// On a quad sphere, 3-connected means that no two quads share both ends of a diagonal: it has no improper pair.
fn check_three_connected(surface: &QuadSurface) -> Result<(), EmbedError> {
    match improper_pairs(surface).first.first() {
        Some(&ImproperPair { quads: [first, second], vertices: Edge(a, b) }) => {
            Err(EmbedError::NotThreeConnected { first, second, a, b })
        }
        None => Ok(()),
    }
}

/// Moves points of the unit sphere by Lorentz boosts until their mean is the origin (Springborn 2005: a convex problem in the
/// boost; Newton from the current position each time).
fn centre(points: &mut [Vector]) {
    let count = points.len() as f64;
    let mut last = f64::INFINITY;
    for _ in 0..100 {
        let mean = scale(1.0 / count, points.iter().fold([0.0; 3], |s, &p| add(s, p)));
        let size = norm(mean);
        if size < 1e-16 || size < 1e-13 && size >= last {
            break;
        }
        last = size;
        // Hessian of the mean logarithm: I - mean of p p'.
        let mut h = [[0.0; 3]; 3];
        for (i, row) in h.iter_mut().enumerate() {
            row[i] = 1.0;
        }
        for p in points.iter() {
            for i in 0..3 {
                for j in 0..3 {
                    h[i][j] -= p[i] * p[j] / count;
                }
            }
        }
        let Some(klein) = solve3(h, mean) else { break };
        let length = norm(klein);
        // A full Newton step may leave the ball, in which all boosts are.
        let klein = if length > 0.9 { scale(0.9 / length, klein) } else { klein };
        // The same boost in the ball model that acts on the sphere by inversions.
        let c = scale(1.0 / (1.0 + (1.0 - dot(klein, klein)).sqrt()), klein);
        for p in points.iter_mut() {
            let d = sub(*p, c);
            let moved = add_scaled(scale(-1.0, c), (1.0 - dot(c, c)) / dot(d, d), d);
            *p = unit(moved).unwrap_or(*p);
        }
    }
}

fn solve3(m: [Vector; 3], b: Vector) -> Option<Vector> {
    let n = [cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])];
    let d = dot(m[0], n[0]);
    let x = std::array::from_fn(|k| (b[0] * n[0][k] + b[1] * n[1][k] + b[2] * n[2][k]) / d);
    (d != 0.0 && x.iter().all(|x: &f64| x.is_finite())).then_some(x)
}

/// Per vertex the apex of the cone along its circle: the pole of the plane of its touching points.
fn apexes(surface: &QuadSurface, touching: &[Vector]) -> Vec<Vector> {
    let mut points = vec![[0.0; 3]; surface.n_vertices()];
    let mut done = vec![false; surface.n_vertices()];
    for d in surface.darts() {
        let v = surface.origin(d).index();
        if std::mem::replace(&mut done[v], true) {
            continue;
        }
        let ring: Vec<Vector> = surface.round_vertex(d).map(|e| touching[e.index()]).collect();
        let middle = scale(1.0 / ring.len() as f64, ring.iter().fold([0.0; 3], |s, &p| add(s, p)));
        // Newell's normal of the ring, relative to its middle; the ring runs clockwise.
        let mut normal = [0.0; 3];
        for (i, &p) in ring.iter().enumerate() {
            let q = ring[(i + 1) % ring.len()];
            normal = add(normal, cross(sub(q, middle), sub(p, middle)));
        }
        // The pole of the plane n . x = n . m with respect to the unit sphere: n / (n . m), the apex of the cone that
        // touches along its circle.
        points[v] = scale(1.0 / dot(normal, middle), normal);
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest distance of a corner of a quad from the plane of the other three, over the length of its diagonals.
    fn planarity(surface: &QuadSurface, points: &[Vector]) -> f64 {
        let mut worst = 0.0f64;
        for quad in surface.quads() {
            let p = quad.map(|v| points[v.index()]);
            for i in 0..4 {
                let [a, b, c, d] = std::array::from_fn(|k| p[(i + k) % 4]);
                let normal = unit(cross(sub(b, a), sub(c, a))).unwrap();
                worst = worst.max(dot(normal, sub(d, a)).abs() / norm(sub(c, a)).max(norm(sub(d, b))));
            }
        }
        worst
    }

    /// Every vertex strictly inside the half-space of every quad it is not on.
    fn is_convex_outward(surface: &QuadSurface, points: &[Vector]) -> bool {
        surface.quads().iter().all(|quad| {
            let p = quad.map(|v| points[v.index()]);
            let normal = unit(cross(sub(p[2], p[0]), sub(p[3], p[1]))).unwrap();
            (0..points.len()).all(|v| quad.iter().any(|w| w.index() == v) || dot(normal, sub(points[v], p[0])) < -1e-9)
        })
    }

    fn check(surface: &QuadSurface) -> Vec<Vector> {
        let points = canonical_polyhedron(surface).unwrap();
        assert!(planarity(surface, &points) < 1e-12, "{}", planarity(surface, &points));
        assert!(is_convex_outward(surface, &points));
        let mut mean = [0.0; 3];
        for d in surface.darts() {
            let (a, b) = (points[surface.origin(d).index()], points[surface.target(d).index()]);
            let along = unit(sub(b, a)).unwrap();
            let nearest = add_scaled(a, -dot(a, along), along);
            assert!((norm(nearest) - 1.0).abs() < 1e-12, "edge at distance {}", norm(nearest));
            mean = add(mean, nearest);
        }
        assert!(norm(mean) < 1e-10);
        points
    }

    fn surface(n: usize, quads: &[[u32; 4]]) -> QuadSurface {
        QuadSurface::try_new(n, quads).unwrap()
    }

    #[test]
    fn the_cube_is_a_cube() {
        let quads = hexfill_mesh::cube::FACETS.map(|f| f.map(|v| v as u32));
        let points = check(&surface(8, &quads));
        // Edges at distance 1 from the centre: vertices at distance sqrt(3/2).
        for p in points {
            assert!((norm(p) - 1.5f64.sqrt()).abs() < 1e-12);
        }
    }

    #[test]
    fn trapezohedra_of_many_sides() {
        for n in [4u32, 5, 8, 20] {
            let ring = |i: u32| 2 + i % (2 * n);
            let mut quads = Vec::new();
            for i in 0..n {
                quads.push([0, ring(2 * i), ring(2 * i + 1), ring(2 * i + 2)]);
                quads.push([1, ring(2 * i + 3), ring(2 * i + 2), ring(2 * i + 1)]);
            }
            check(&surface(2 + 2 * n as usize, &quads));
        }
    }

    #[test]
    fn refined_cubes() {
        for n in [2usize, 4] {
            let mesh = crate::problem::samples::grid(n);
            let quads: Vec<[u32; 4]> = mesh.boundary_quads_raw();
            let s = surface(mesh.n_vertices(), &quads);
            // Unused ids (the interior vertices of the grid) get the origin; leave them out of the convexity check.
            let (part, _, _) = s.split_components().remove(0);
            check(&part);
        }
    }

    #[test]
    fn surfaces_without_a_polyhedron_are_refused() {
        // Two cubes glued along a facet share no diagonal problem; a pillow over one facet does.
        let mut quads: Vec<[u32; 4]> = hexfill_mesh::cube::FACETS.iter().map(|f| f.map(|v| v as u32)).collect();
        let top = quads.pop().unwrap();
        quads.push([top[0], top[1], top[2], 8]);
        quads.push([top[0], 8, top[2], top[3]]);
        match canonical_polyhedron(&surface(9, &quads)) {
            Err(EmbedError::NotThreeConnected { .. }) => {}
            other => panic!("{other:?}"),
        }
    }
}
