//! What a surface allows before any mesh is made of it: directions at its vertices, angles of its corners and edges.
//!
//! Four limits, from hard to soft:
//! * a **corner** of a quad is a corner of some hex in every mesh, and a scaled Jacobian there is at most the sine of its angle;
//! * a **side** of a quad is crossed by straight lines to the opposite side, as the facet of the hex is bilinear, and the scaled Jacobian on the side is at most the sine of the angle to them. Where
//!   a quad is bent or has a reflex corner these lines turn, and may come much nearer to the side between its ends than at the corners;
//! * an **edge** has m >= 1 hexes round it, whose corners share its dihedral angle: one of them has at most a / m, and the sine of that
//!   bounds it (for an angle below 90 degrees the best is m = 1); angle / 90 is how many hexes it wants;
//! * a **vertex** with one interior edge, as behind any layer of one hex a quad, needs a direction that sees all its quads. Where there is
//!   none ([`VertexLimit::bound`] <= 0), no such layer is valid, whatever lies behind it; a second interior edge can be
//!   (`hexfill-shell`, split stars).
//!
//! Angles are seen from the vertex itself, along edges, as Jacobians are. All in floating point: nothing here is a proof.
//!
//! Source: ours.

use crate::serial::{serialize_edge, serialize_quad, serialize_vertex};
use hexfill_geometry::{
    Vector, add, add_scaled, best_direction, corner_angle, cross, dihedral_angle, direction, dot, norm,
    quadratic_roots, scale, sub,
};
use hexfill_mesh::{Dart, Edge, QuadId, QuadSurface, VertexId};
use rayon::prelude::*;
use serde::Serialize;
use std::f64::consts::{PI, TAU};

/// What bounds the meshes of a surface; each list worst first, ties by id.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SurfaceLimits {
    /// Every used vertex, by [`VertexLimit::bound`].
    pub vertices: Vec<VertexLimit>,
    /// Every corner of every quad, by [`CornerLimit::bound`].
    pub corners: Vec<CornerLimit>,
    /// Every side of every quad, by [`SideLimit::bound`].
    pub sides: Vec<SideLimit>,
    /// Every edge, sharpest first.
    pub edges: Vec<EdgeLimit>,
}

/// What one interior edge can reach at a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct VertexLimit {
    /// The vertex.
    #[serde(serialize_with = "serialize_vertex")]
    pub vertex: VertexId,
    /// The largest possible worst scaled Jacobian of the corners at the vertex, if each of its quads has one hex and all
    /// these share one interior edge. Not positive: no direction sees all quads.
    pub bound: f64,
    /// The unit direction that reaches it.
    pub direction: [f64; 3],
}

/// The angle of a quad at one of its corners.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct CornerLimit {
    /// The quad.
    #[serde(serialize_with = "serialize_quad")]
    pub quad: QuadId,
    /// The corner.
    #[serde(serialize_with = "serialize_vertex")]
    pub vertex: VertexId,
    /// The angle in degrees: near 0 a needle, near 180 flat, above 180 reflex (the quad is not convex).
    pub degrees: f64,
    /// No hex mesh has a larger scaled Jacobian at this corner: the sine of the angle, without its sign; 0 for an edge of length 0.
    pub bound: f64,
}

/// The angle between a side of a quad and the lines that cross the quad from it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SideLimit {
    /// The quad.
    #[serde(serialize_with = "serialize_quad")]
    pub quad: QuadId,
    /// The side.
    #[serde(serialize_with = "serialize_edge")]
    pub edge: Edge,
    /// Where on the side the angle is sharpest or flattest: 0 at the smaller of its two vertices, 1 at the other.
    pub at: f64,
    /// No hex mesh has a larger scaled Jacobian there: the sine of the angle; 0 for a side of length 0. At most those of the corners at its ends.
    pub bound: f64,
}

/// The dihedral angle inside the solid at an edge.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct EdgeLimit {
    /// The edge.
    #[serde(serialize_with = "serialize_edge")]
    pub edge: Edge,
    /// The angle in degrees, the smaller of those at its two ends; 0 where a quad is degenerate. At one end it may
    /// exceed 360, where the surface overlaps itself.
    pub degrees: f64,
    /// The larger of the two; near or above 360 the outside closes up.
    pub most_degrees: f64,
    /// How many hexes the edge wants round it: degrees / 90.
    pub hexes: f64,
    /// No hex mesh of a surface that does not cross itself has a larger worst corner at this edge: 1 from 90 degrees on, else the sine.
    pub bound: f64,
}

/// The limits of a surface whose quads face outward, with `points[v]` the position of vertex v, in any unit.
/// Returns `None` if a used vertex has no finite position. Linear time but for the sorting, on all threads of the surrounding pool.
///
/// # Example
/// ```
/// use hexfill_embed::surface_limits;
/// use hexfill_mesh::QuadSurface;
///
/// let quads = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
/// let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
/// let limits = surface_limits(&QuadSurface::try_new(8, &quads)?, &corners.map(|p| p.map(f64::from)));
/// let limits = limits.expect("one finite position a vertex");
/// assert!(limits.edges.iter().all(|edge| (edge.degrees - 90.0).abs() < 1e-9));
/// assert!(limits.vertices[0].bound > 0.57); // one more edge in a corner of a cube: along its diagonal
/// # Ok::<(), hexfill_mesh::SurfaceError>(())
/// ```
pub fn surface_limits(surface: &QuadSurface, points: &[[f64; 3]]) -> Option<SurfaceLimits> {
    let placed = |v: &VertexId| points.get(v.index()).is_some_and(|p| p.iter().all(|x| x.is_finite()));
    if !surface.quads().iter().flatten().all(placed) {
        return None;
    }
    let placed = Placed { surface, points };
    let firsts: Vec<Dart> = surface.dart_of_vertices().into_iter().flatten().collect();
    let all: Vec<Dart> = surface.darts().collect();
    let mut vertices: Vec<VertexLimit> = firsts.par_iter().with_min_len(256).map(|&d| placed.vertex_limit(d)).collect();
    let mut corners: Vec<CornerLimit> = all.par_iter().with_min_len(1024).map(|&d| placed.corner_limit(d)).collect();
    let mut sides: Vec<SideLimit> = all.par_iter().with_min_len(1024).map(|&d| placed.side_limit(d)).collect();
    let one_of_two = |d: &&Dart| **d < surface.twin(**d);
    let mut edges: Vec<EdgeLimit> =
        all.par_iter().with_min_len(1024).filter(one_of_two).map(|&d| placed.edge_limit(d)).collect();
    vertices.par_sort_by(|a, b| a.bound.total_cmp(&b.bound).then(a.vertex.cmp(&b.vertex)));
    corners.par_sort_by(|a, b| a.bound.total_cmp(&b.bound).then((a.quad, a.vertex).cmp(&(b.quad, b.vertex))));
    sides.par_sort_by(|a, b| a.bound.total_cmp(&b.bound).then((a.quad, a.edge).cmp(&(b.quad, b.edge))));
    edges.par_sort_by(|a, b| a.degrees.total_cmp(&b.degrees).then(a.edge.cmp(&b.edge)));
    Some(SurfaceLimits { vertices, corners, sides, edges })
}

/// A surface all of whose vertices have finite positions.
struct Placed<'a> {
    surface: &'a QuadSurface,
    points: &'a [Vector],
}

impl Placed<'_> {
    /// The unit direction of a dart. A degenerate edge has none: everything it is part of is worth 0.
    fn along(&self, d: Dart) -> Vector {
        let (from, to) = (self.surface.origin(d), self.surface.target(d));
        direction(self.points[from.index()], self.points[to.index()]).unwrap_or([0.0; 3])
    }

    /// The direction from a dart's origin to the corner before it.
    fn along_back(&self, d: Dart) -> Vector {
        // Three steps on is one back.
        scale(-1.0, self.along(d.next().next().next()))
    }

    /// The edges at a dart's origin in its quad: the dart, and to the corner before.
    fn edges_at(&self, d: Dart) -> (Vector, Vector) {
        (self.along(d), self.along_back(d))
    }

    /// Of the origin of a dart.
    fn vertex_limit(&self, first: Dart) -> VertexLimit {
        // The frame (next edge, previous edge, inward) of an outward quad's corner is left-handed.
        let normal = |d: Dart| {
            let (next, previous) = self.edges_at(d);
            cross(previous, next)
        };
        let normals: Vec<Vector> = self.surface.round_vertex(first).map(normal).collect();
        let best = best_direction(&normals);
        VertexLimit { vertex: self.surface.origin(first), bound: best.value.min(1.0), direction: best.direction }
    }

    /// Of the corner at the origin of a dart, in its quad.
    fn corner_limit(&self, d: Dart) -> CornerLimit {
        let (next, previous) = self.edges_at(d);
        // The mean normal, from all four corners, tells a reflex corner from a convex one.
        let mut normal = [0.0; 3];
        let mut at = d;
        for _ in 0..4 {
            let (a, b) = self.edges_at(at);
            normal = add(normal, cross(a, b));
            at = at.next();
        }
        let angle = corner_angle(next, previous, normal);
        let bound = if next == [0.0; 3] || previous == [0.0; 3] { 0.0 } else { angle.sin().abs() };
        CornerLimit { quad: d.quad(), vertex: self.surface.origin(d), degrees: angle.to_degrees(), bound }
    }

    /// Of the side of a quad along a dart.
    fn side_limit(&self, d: Dart) -> SideLimit {
        let (from, to) = (self.surface.origin(d), self.surface.target(d));
        let at = |v: VertexId| self.points[v.index()];
        let (before, after) = (self.surface.origin(d.next().next().next()), self.surface.origin(d.next().next()));
        let (near, far) = (sub(at(before), at(from)), sub(at(after), at(to)));
        let (t, bound) = direction(at(from), at(to)).map_or((0.0, 0.0), |along| least_sine(along, near, far));
        let edge = Edge::new(from, to);
        let t = if from < to { t } else { 1.0 - t };
        SideLimit { quad: d.quad(), edge, at: t, bound }
    }

    /// Of the edge of a dart.
    fn edge_limit(&self, d: Dart) -> EdgeLimit {
        let (least, most) = self.angles(d).unwrap_or((0.0, 0.0));
        let (degrees, most_degrees) = (least.to_degrees(), most.to_degrees());
        let bound = if degrees < 90.0 { least.sin() } else { 1.0 };
        let edge = Edge::new(self.surface.origin(d), self.surface.target(d));
        EdgeLimit { edge, degrees, most_degrees, hexes: degrees / 90.0, bound }
    }

    /// The angles inside at both ends of an edge, ascending. Between the ends both quads turn about the edge as straight lines between their two
    /// sides do, by less than half a turn, so the angle at one end tells the other with its full turns; in a valid mesh both are positive.
    fn angles(&self, d: Dart) -> Option<(f64, f64)> {
        let (twin, e) = (self.surface.twin(d), self.along(d));
        let (left, right) = (self.along_back(d), self.along(twin.next()));
        let (far_left, far_right) = (self.along(d.next()), self.along_back(twin));
        let turn = |from: Vector, to: Vector| dihedral_angle(e, from, to).map(|t| if t > PI { t - TAU } else { t });
        let here = dihedral_angle(e, right, left)?;
        let there = here + turn(left, far_left)? - turn(right, far_right)?;
        let (least, most) = (here.min(there), here.max(there));
        // Zero up to rounding is no reason for a further turn.
        let turns = if least < -1e-9 { (-least / TAU).ceil() * TAU } else { 0.0 };
        Some(((least + turns).max(0.0), most + turns))
    }
}

/// The parameter of the least sine between a unit direction and a vector that moves along a straight line from `near` at 0 to `far` at 1, and that sine; 0 where it vanishes.
fn least_sine(along: Vector, near: Vector, far: Vector) -> (f64, f64) {
    // Only the ratio counts; this one does not overflow.
    let size = near.iter().chain(&far).fold(f64::MIN_POSITIVE, |m, x| m.max(x.abs()));
    let (near, step) = (scale(1.0 / size, near), scale(1.0 / size, sub(far, near)));
    let sine = |t: f64| {
        let v = add_scaled(near, t, step);
        let across = norm(cross(along, v));
        if across > 0.0 { (across / norm(v)).min(1.0) } else { 0.0 }
    };
    // The squares of the part across and of the whole are quadratic in t; their ratio is stationary where f'g - fg' vanishes, whose cubic term cancels.
    let square = |p: Vector, q: Vector| [dot(p, p), 2.0 * dot(p, q), dot(q, q)];
    let f = square(cross(along, near), cross(along, step));
    let g = square(near, step);
    let stationary = [f[1] * g[0] - f[0] * g[1], f[2] * g[0] - f[0] * g[2], f[2] * g[1] - f[1] * g[2]];
    let inside = quadratic_roots(stationary).into_iter().flatten().filter(|t| *t > 0.0 && *t < 1.0);
    let least = inside.chain([0.0, 1.0]).map(|t| (t, sine(t))).min_by(|a, b| a.1.total_cmp(&b.1));
    least.unwrap_or((0.0, 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::cube::{FACETS, POSITIONS};

    fn cube() -> (QuadSurface, Vec<Vector>) {
        let quads: Vec<[u32; 4]> = FACETS.iter().map(|f| f.map(|v| v as u32)).collect();
        (QuadSurface::try_new(8, &quads).unwrap(), POSITIONS.map(|p| p.map(f64::from)).to_vec())
    }

    #[test]
    fn a_cube() {
        let (surface, points) = cube();
        for scale in [1.0, 1e-200, 1e300] {
            let points: Vec<Vector> = points.iter().map(|p| p.map(|x| x * scale)).collect();
            let limits = surface_limits(&surface, &points).unwrap();
            assert_eq!((limits.vertices.len(), limits.corners.len(), limits.edges.len()), (8, 24, 12));
            assert!(limits.vertices.iter().all(|v| (v.bound - 1.0 / 3f64.sqrt()).abs() < 1e-12));
            let inward = limits.vertices.iter().find(|v| v.vertex == VertexId(0)).unwrap().direction;
            assert!(inward.iter().all(|x| (x - 1.0 / 3f64.sqrt()).abs() < 1e-12), "{inward:?}");
            assert!(limits.corners.iter().all(|c| (c.degrees - 90.0).abs() < 1e-9 && c.bound > 1.0 - 1e-12));
            assert!(limits.sides.iter().all(|s| s.bound > 1.0 - 1e-12));
            assert!(limits.edges.iter().all(|e| (e.degrees - 90.0).abs() < 1e-9 && (e.hexes - 1.0).abs() < 1e-9));
        }
        let inside_out = surface_limits(&surface.inverted(), &points).unwrap();
        assert!(inside_out.edges.iter().all(|e| (e.degrees - 270.0).abs() < 1e-9));
        assert!(surface_limits(&surface, &points[..7]).is_none());
    }

    #[test]
    fn needles_flat_corners_and_edges_of_length_zero_are_found() {
        let (surface, mut points) = cube();
        points[6] = [0.51, 0.51, 1.0];
        let limits = surface_limits(&surface, &points).unwrap();
        let worst = limits.corners[0];
        assert_eq!((worst.vertex, worst.quad), (VertexId(6), QuadId(5)));
        assert!(worst.degrees > 175.0 && worst.degrees < 180.0 && worst.bound < 0.1);
        points[6] = [0.4, 0.4, 1.0];
        let limits = surface_limits(&surface, &points).unwrap();
        assert!(limits.corners.iter().any(|c| c.degrees > 180.0 && c.vertex == VertexId(6)));
        points[6] = points[7];
        let limits = surface_limits(&surface, &points).unwrap();
        assert_eq!((limits.corners[0].bound, limits.edges[0].degrees), (0.0, 0.0));
        points = POSITIONS.map(|[x, y, z]| [f64::from(x), f64::from(y) + 10.0 * f64::from(z), f64::from(z)]).to_vec();
        let limits = surface_limits(&surface, &points).unwrap();
        assert!(limits.edges[0].degrees < 6.0 && limits.edges[0].hexes < 0.07);
    }

    #[test]
    fn a_quad_may_come_nearer_to_a_side_in_its_middle_than_at_its_corners() {
        // Lines across from the side along x lean forward and up at one end, back and down at the other.
        let (t, bound) = least_sine([1.0, 0.0, 0.0], [-1.0, 0.3, 0.1], [3.0, -0.1, 0.1]);
        assert!(t > 0.0 && t < 1.0 && bound < 0.1);
        let mut random = hexfill_mesh::Random::new(3);
        let mut n_inside = 0;
        for _ in 0..2000 {
            let mut vector = || [0; 3].map(|_| 2.0 * random.unit() - 1.0);
            let (along, near, far) = (direction([0.0; 3], vector()).unwrap(), vector(), vector());
            let (t, least) = least_sine(along, near, far);
            let sine = |t: f64| {
                let v = add_scaled(scale(1.0 - t, near), t, far);
                norm(cross(along, v)) / norm(v)
            };
            let sampled = (0..=1000).map(|i| sine(f64::from(i) / 1000.0)).fold(1.0, f64::min);
            assert!((sine(t) - least).abs() < 1e-9 && least <= sampled + 1e-9 && sampled < least + 0.01);
            n_inside += usize::from(t > 0.0 && t < 1.0);
        }
        assert!(n_inside > 300);
    }

    #[test]
    fn sides_bound_no_less_than_their_corners() {
        let (surface, mut points) = cube();
        points[6] = [0.51, 0.51, 1.0];
        let limits = surface_limits(&surface, &points).unwrap();
        assert_eq!(limits.sides.len(), 24);
        for side in &limits.sides {
            let at_end = |v: VertexId| limits.corners.iter().find(|c| (c.quad, c.vertex) == (side.quad, v)).unwrap();
            let (a, b) = (at_end(side.edge.0), at_end(side.edge.1));
            assert!(side.bound <= a.bound.min(b.bound) + 1e-12, "{side:?}");
        }
        assert_eq!(limits.sides[0].quad, QuadId(5));
    }

    #[test]
    fn angles_are_told_from_their_full_turns() {
        // The bottom, twisted about edge 0-1, leads at 1 10 degrees beyond the front: the surface overlaps itself.
        let (surface, mut points) = cube();
        let edge = |points: &[Vector]| {
            let limits = surface_limits(&surface, points).unwrap();
            limits.edges.into_iter().find(|e| e.edge == Edge::new(VertexId(0), VertexId(1))).unwrap()
        };
        let (sine, cosine) = 10f64.to_radians().sin_cos();
        points[2] = [1.0, -sine, cosine];
        let found = edge(&points);
        assert!((found.degrees - 350.0).abs() < 1e-6 && (found.most_degrees - 450.0).abs() < 1e-6, "{found:?}");
        // 10 degrees before it they leave a thin wedge.
        points[2] = [1.0, sine, cosine];
        let found = edge(&points);
        assert!((found.degrees - 10.0).abs() < 1e-6 && (found.most_degrees - 90.0).abs() < 1e-6, "{found:?}");
    }
}
