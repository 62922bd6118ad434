//! Coordinates from connectivity alone: the canonical (midscribed) polyhedron of a 3-connected quad sphere.
//!
//! Koebe, Andreev, Thurston: every 3-connected planar graph is the graph of a convex polyhedron whose edges touch the unit
//! sphere, unique up to Moebius maps; with the touching points centred at the origin it is unique up to rotation
//! (Springborn 2005). Computed as an orthogonal circle packing of vertices and faces in the plane (Bobenko, Springborn 2004):
//! send one touching point to infinity, so that its two vertices and two faces become the sides of a rectangle; the
//! logarithmic radii of all others minimise a convex function whose gradient is "target angle minus sum of kite angles",
//! `2 atan(r_j / r_i)` per kite; lay the kites out; lift by stereographic projection; centre with Lorentz boosts.
//! A vertex is the apex of the cone that touches the sphere along its circle.

use crate::error::EmbedError;
use crate::vector::{Vector, add, add_scaled, cross, dot, norm, scale, sub, unit};
use hexfill_mesh::{Dart, QuadId, QuadSurface, VertexId};
use std::collections::BinaryHeap;
use std::f64::consts::{PI, TAU};

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
    let mut touching = packing.lift(surface);
    centre(&mut touching);
    let points = apexes(surface, &touching);
    if points.iter().flatten().any(|x| !x.is_finite()) {
        return Err(EmbedError::NotConverged { given: f64::INFINITY, limit: 1e-12 });
    }
    Ok(points)
}

/// On a quad sphere, 3-connected means that no two quads share both ends of a diagonal.
fn check_three_connected(surface: &QuadSurface) -> Result<(), EmbedError> {
    let mut diagonals: Vec<(VertexId, VertexId, QuadId)> = Vec::with_capacity(2 * surface.n_quads());
    for (q, &[a, b, c, d]) in surface.quads().iter().enumerate() {
        for (s, t) in [(a, c), (b, d)] {
            diagonals.push((s.min(t), s.max(t), QuadId::new(q)));
        }
    }
    diagonals.sort_unstable();
    match diagonals.windows(2).find(|w| (w[0].0, w[0].1) == (w[1].0, w[1].1)) {
        Some(w) => Err(EmbedError::NotThreeConnected { first: w[0].2, second: w[1].2, a: w[0].0, b: w[0].1 }),
        None => Ok(()),
    }
}

/// The circles: one per vertex (index v) and one per quad (index n_vertices + q). A kite is a dart: the circle of its
/// origin and the circle of its quad, from the touching point of the dart's edge to that of the previous dart's.
struct Packing {
    n_vertices: usize,
    /// The dart whose touching point is at infinity; its ends and the quads on both sides are lines.
    infinite: Dart,
    /// Logarithms of the radii; meaningless for the four lines.
    log_radius: Vec<f64>,
    is_line: Vec<bool>,
    /// The finite kites as pairs of circles.
    kites: Vec<(usize, usize)>,
    /// Per circle the sum its kite angles must have.
    target: Vec<f64>,
}

impl Packing {
    fn new(surface: &QuadSurface) -> Result<Self, EmbedError> {
        let n_vertices = surface.n_vertices();
        let n = n_vertices + surface.n_quads();
        // The edge with the largest degrees leaves the fewest and most even circles.
        let infinite = surface
            .darts()
            .max_by_key(|&d| {
                let degrees = surface.degree(surface.origin(d)) + surface.degree(surface.target(d));
                (degrees, std::cmp::Reverse(d))
            })
            .expect("a sphere has edges");
        let mut is_line = vec![false; n];
        is_line[surface.origin(infinite).index()] = true;
        is_line[surface.target(infinite).index()] = true;
        is_line[n_vertices + infinite.quad().index()] = true;
        is_line[n_vertices + surface.twin(infinite).quad().index()] = true;
        let mut target = vec![TAU; n];
        let mut kites = Vec::new();
        for d in surface.darts() {
            let (v, q) = (surface.origin(d).index(), n_vertices + d.quad().index());
            match (is_line[v], is_line[q]) {
                (false, false) => kites.push((v, q)),
                // The angle of a kite with a line is straight.
                (false, true) => target[v] -= PI,
                (true, false) => target[q] -= PI,
                (true, true) => {}
            }
        }
        let mut packing = Self { n_vertices, infinite, log_radius: vec![0.0; n], is_line, kites, target };
        packing.solve(surface)?;
        Ok(packing)
    }

    /// The gradient: target minus angle sum; zero at lines and unused vertices.
    fn gradient(&self, log_radius: &[f64], used: &[bool]) -> Vec<f64> {
        let mut g: Vec<f64> = (0..used.len()).map(|i| if used[i] { self.target[i] } else { 0.0 }).collect();
        for &(v, q) in &self.kites {
            let ratio = (log_radius[q] - log_radius[v]).exp();
            g[v] -= 2.0 * ratio.atan();
            g[q] -= 2.0 * ratio.recip().atan();
        }
        g
    }

    /// Newton's method; the Hessian is the Laplacian with weight 1 / cosh(difference) per kite.
    fn solve(&mut self, surface: &QuadSurface) -> Result<(), EmbedError> {
        const LIMIT: f64 = 1e-9;
        let used: Vec<bool> = (0..self.target.len())
            .map(|i| !self.is_line[i] && (i >= self.n_vertices || surface.degree(VertexId::new(i)) > 0))
            .collect();
        let mut rho = self.log_radius.clone();
        let mut g = self.gradient(&rho, &used);
        let largest = |g: &[f64]| g.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        for _ in 0..60 {
            if largest(&g) < 4e-15 {
                break;
            }
            let weights: Vec<f64> = self.kites.iter().map(|&(v, q)| 1.0 / (rho[q] - rho[v]).cosh()).collect();
            let step = self.laplacian_solve(&weights, &g, &used);
            let slope: f64 = -g.iter().zip(&step).map(|(g, s)| g * s).sum::<f64>();
            let mut t = 1.0;
            let mut moved = None;
            for _ in 0..40 {
                let trial: Vec<f64> = rho.iter().zip(&step).map(|(r, s)| r - t * s).collect();
                let trial_g = self.gradient(&trial, &used);
                // The function is convex: its derivative along the step must not have overshot.
                let along: f64 = -trial_g.iter().zip(&step).map(|(g, s)| g * s).sum::<f64>();
                if along <= 0.9 * slope.abs() {
                    moved = Some((trial, trial_g));
                    break;
                }
                t *= 0.5;
            }
            let Some((trial, trial_g)) = moved else { break };
            // At rounding level further steps only shuffle the last bits.
            if largest(&g) < 1e-12 && largest(&trial_g) >= largest(&g) {
                break;
            }
            (rho, g) = (trial, trial_g);
        }
        self.log_radius = rho;
        let reached = largest(&g);
        if reached < LIMIT { Ok(()) } else { Err(EmbedError::NotConverged { given: reached, limit: LIMIT }) }
    }

    /// Solves L x = g by conjugate gradients; L is singular along constants, and so is g orthogonal to them.
    fn laplacian_solve(&self, weights: &[f64], g: &[f64], used: &[bool]) -> Vec<f64> {
        let n = g.len();
        let mut diagonal = vec![0.0; n];
        for (&(v, q), &w) in self.kites.iter().zip(weights) {
            diagonal[v] += w;
            diagonal[q] += w;
        }
        let apply = |x: &[f64]| {
            let mut out = vec![0.0; n];
            for (&(v, q), &w) in self.kites.iter().zip(weights) {
                let flow = w * (x[v] - x[q]);
                out[v] += flow;
                out[q] -= flow;
            }
            out
        };
        let precondition =
            |r: &[f64]| -> Vec<f64> { (0..n).map(|i| if used[i] { r[i] / diagonal[i] } else { 0.0 }).collect() };
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let mean = g.iter().sum::<f64>() / used.iter().filter(|&&u| u).count() as f64;
        let mut r: Vec<f64> = (0..n).map(|i| if used[i] { g[i] - mean } else { 0.0 }).collect();
        let mut x = vec![0.0; n];
        let mut z = precondition(&r);
        let mut p = z.clone();
        let mut rz = product(&r, &z);
        let enough = 1e-26 * rz;
        for _ in 0..20 * n {
            if rz <= enough {
                break;
            }
            let ap = apply(&p);
            let alpha = rz / product(&p, &ap);
            if !alpha.is_finite() {
                break;
            }
            for i in 0..n {
                x[i] += alpha * p[i];
                r[i] -= alpha * ap[i];
            }
            z = precondition(&r);
            let next = product(&r, &z);
            let beta = next / rz;
            rz = next;
            for i in 0..n {
                p[i] = z[i] + beta * p[i];
            }
        }
        x
    }

    /// Lays the circles out, largest first, and lifts the touching points to the sphere: one per dart, the same for a dart and
    /// its twin.
    fn lift(&self, surface: &QuadSurface) -> Vec<Vector> {
        let darts = 4 * surface.n_quads();
        let mut touch: Vec<Option<[f64; 2]>> = vec![None; darts];
        let mut centre: Vec<Option<[f64; 2]>> = vec![None; self.log_radius.len()];
        // A circle waits with its centre, and one dart whose edge it touches at a known point.
        let mut queue: BinaryHeap<(u64, usize, Dart)> = BinaryHeap::new();
        let priority = |circle: usize| {
            // Order of f64 as integers: larger radius first.
            let bits = self.log_radius[circle].to_bits();
            if bits >> 63 == 1 { !bits } else { bits | 1 << 63 }
        };
        let is_vertex = |circle: usize| circle < self.n_vertices;
        let circles_of = |d: Dart| (surface.origin(d).index(), self.n_vertices + d.quad().index());
        let first = surface
            .darts()
            .flat_map(|d| [(circles_of(d).0, d), (circles_of(d).1, d)])
            .filter(|&(circle, _)| !self.is_line[circle])
            .max_by_key(|&(circle, d)| (priority(circle), std::cmp::Reverse(d)));
        let Some((circle, dart)) = first else { return vec![[0.0; 3]; darts] };
        centre[circle] = Some([0.0; 2]);
        touch[dart.index()] = Some([self.log_radius[circle].exp(), 0.0]);
        touch[surface.twin(dart).index()] = touch[dart.index()];
        queue.push((priority(circle), circle, dart));
        let mut done = vec![false; self.log_radius.len()];
        while let Some((_, circle, from)) = queue.pop() {
            if std::mem::replace(&mut done[circle], true) {
                continue;
            }
            let c = centre[circle].expect("a queued circle has a centre");
            let at = touch[from.index()].expect("a queued circle has a touching point");
            let radius = self.log_radius[circle].exp();
            let mut angle = (at[1] - c[1]).atan2(at[0] - c[0]);
            let mut d = from;
            // Once round, counter-clockwise: each kite leads from one touching point to the next.
            loop {
                // The kite after the touching point of d: for a vertex that of dart d, for a quad that of the next dart.
                let (kite, next) = if is_vertex(circle) { (d, surface.twin(d.prev())) } else { (d.next(), d.next()) };
                let (v, q) = circles_of(kite);
                let other = if is_vertex(circle) { q } else { v };
                let half = if self.is_line[other] {
                    0.5 * PI
                } else {
                    (self.log_radius[other] - self.log_radius[circle]).exp().atan()
                };
                if !self.is_line[other] && centre[other].is_none() {
                    let distance = radius.hypot(self.log_radius[other].exp());
                    let direction = angle + half;
                    centre[other] = Some([c[0] + distance * direction.cos(), c[1] + distance * direction.sin()]);
                    // The other circle touches the same edge: as its own quad's dart, or as the dart that starts at its vertex.
                    let handle = if is_vertex(circle) { d } else { surface.twin(d) };
                    queue.push((priority(other), other, handle));
                }
                angle += 2.0 * half;
                d = next;
                if d == from {
                    break;
                }
                if touch[d.index()].is_none() {
                    let point = [c[0] + radius * angle.cos(), c[1] + radius * angle.sin()];
                    touch[d.index()] = Some(point);
                    touch[surface.twin(d).index()] = Some(point);
                }
            }
        }
        self.project(surface, &touch)
    }

    /// Stereographic lift after centring and scaling to median distance 1, the infinite point to the south pole.
    fn project(&self, surface: &QuadSurface, touch: &[Option<[f64; 2]>]) -> Vec<Vector> {
        let known: Vec<[f64; 2]> = touch.iter().flatten().copied().collect();
        let count = known.len().max(1) as f64;
        let middle = [0, 1].map(|k| known.iter().map(|p| p[k]).sum::<f64>() / count);
        let mut distances: Vec<f64> = known.iter().map(|p| (p[0] - middle[0]).hypot(p[1] - middle[1])).collect();
        distances.sort_by(f64::total_cmp);
        let size = distances.get(distances.len() / 2).copied().unwrap_or(1.0);
        let infinite = [self.infinite, surface.twin(self.infinite)];
        surface
            .darts()
            .map(|d| match touch[d.index()] {
                Some(p) if !infinite.contains(&d) => {
                    let (x, y) = ((p[0] - middle[0]) / size, (p[1] - middle[1]) / size);
                    let square = x * x + y * y;
                    [2.0 * x / (1.0 + square), 2.0 * y / (1.0 + square), (1.0 - square) / (1.0 + square)]
                }
                _ => [0.0, 0.0, -1.0],
            })
            .collect()
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
            let mesh = crate::samples::grid(n);
            let quads: Vec<[u32; 4]> = mesh.boundary_quads().iter().map(|q| q.map(|v| v.0)).collect();
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
