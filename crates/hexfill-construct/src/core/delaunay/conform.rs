//! Refines a Delaunay tetrahedralisation until the surface is a union of its faces.
//!
//! A missing piece of an edge is split: in the middle, or next to a corner at a distance that is a power of two, so that
//! the pieces of edges that meet at an acute angle are cut at equal distances and stop to be in each other's way (Ruppert
//! 1995, Shewchuk 1998). A triangle whose faces do not close gets a point where an edge pierces it, the one farthest
//! from what the triangle has already; if that lies in the diametral ball of a piece of its own edges, this is split instead.
//! No two-dimensional triangulation is kept: the faces whose corners all belong to a triangle tile it iff its edges are
//! there and no face has a free side. Ties need no care, the faces are those that the tetrahedra chose.
//! Rounded points of one triangle may be the corners of a flat tet; [`Conforming::inside`] leaves such tets outside.
//!
//! Source: Ruppert 1995 (concentric shells) and Shewchuk 1998 (points in diametral balls); that no two-dimensional triangulation is kept is ours.

use super::mesh::{Delaunay, orient};
use crate::core::complex::{OUTWARD, TET_EDGES};
use crate::ids::TetId;
use crate::missing::MissingInterior;
use hexfill_geometry::{Vector, bounding_box, cross, dot, norm, sub};
use hexfill_mesh::{Buckets, Context, IdVec, StopReason, VertexId, id_type};

id_type!(
    /// A triangle of the surface.
    TriangleId, "t"
);
id_type!(
    /// An edge of the surface.
    SideId, "e"
);

/// What a vertex belongs to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Origin {
    /// A vertex of the surface.
    Input,
    /// A corner of the huge tet.
    Far,
    /// A point on an edge of the surface.
    Edge(SideId),
    /// A point in a triangle of the surface.
    Triangle(TriangleId),
    /// A point inside.
    Inside,
}

/// Why there is no answer.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The surface is at fault.
    Reason(MissingInterior),
    /// Told to stop.
    Stopped(StopReason),
}

impl From<MissingInterior> for Failure {
    fn from(reason: MissingInterior) -> Self {
        Self::Reason(reason)
    }
}

/// An edge of the surface.
pub(crate) struct SurfaceEdge {
    ends: [VertexId; 2],
    triangles: [TriangleId; 2],
    /// The vertices on it, from end to end.
    chain: Vec<VertexId>,
}

/// Rounds of points for triangles that are not there yet. Ordinary surfaces take a few, which add most of their points; where two triangles
/// all but lie in each other, each round adds two points, and every one looks at all tets.
const ROUNDS: u64 = 200;

/// The surface and the tetrahedralisation that is to conform to it.
pub(crate) struct Conforming<'a> {
    pub(super) dt: Delaunay,
    triangles: &'a IdVec<TriangleId, [VertexId; 3]>,
    pub(super) origin: IdVec<VertexId, Origin>,
    edges: IdVec<SideId, SurfaceEdge>,
    /// Per triangle its edges; edge `k` joins its vertices `k` and `k + 1`.
    triangle_edges: IdVec<TriangleId, [SideId; 3]>,
    /// Per vertex of the surface its triangles.
    triangles_at: Buckets<VertexId, TriangleId>,
    /// Number of vertices of the surface.
    n_surface: usize,
    /// Per triangle: the points in it.
    inner: IdVec<TriangleId, Vec<VertexId>>,
    /// How many points may still be added.
    pub(super) budget: usize,
}

/// The tets inside the surface with their boundary.
pub(crate) struct Inside {
    /// Positions: the surface's vertices, then further ones.
    pub points: IdVec<VertexId, Vector>,
    /// The tets.
    pub tets: IdVec<TetId, [VertexId; 4]>,
    /// The boundary, outward, with the surface's triangle it is part of.
    pub boundary: Vec<([VertexId; 3], TriangleId)>,
}

impl<'a> Conforming<'a> {
    /// The tetrahedralisation of the surface's vertices.
    pub(super) fn new(
        points: &[Vector],
        triangles: &'a IdVec<TriangleId, [VertexId; 3]>,
        budget: usize,
    ) -> Result<Self, Failure> {
        let mut dt = Delaunay::new(points);
        // Any order gives the same tets but for ties, and this one is fixed; along the curve the walk to the next
        // point is short.
        for v in morton_order(points) {
            let placed = dt.insert(v);
            placed.map_err(|w| MissingInterior::SamePlace { vertices: [v.min(w), v.max(w)] })?;
        }
        let mut sides: Vec<([VertexId; 2], TriangleId, u8)> = Vec::with_capacity(3 * triangles.len());
        for (t, tri) in triangles.enumerate() {
            for k in 0..3u8 {
                let (a, b) = (tri[usize::from(k)], tri[usize::from(k + 1) % 3]);
                sides.push(([a.min(b), a.max(b)], t, k));
            }
        }
        let corners = triangles.enumerate().flat_map(|(t, tri)| tri.map(|v| (v, t)));
        let triangles_at = Buckets::new(points.len(), corners);
        sides.sort_unstable();
        let mut edges: IdVec<SideId, SurfaceEdge> = IdVec::with_capacity(sides.len() / 2);
        let mut triangle_edges = IdVec::filled([SideId::NONE; 3], triangles.len());
        for pair in sides.chunks(2) {
            let &[(ends, t, i), (other, u, j)] = pair else {
                return Err(MissingInterior::FreeSide.into());
            };
            if ends != other {
                return Err(MissingInterior::OpenEdge { vertices: ends }.into());
            }
            let edge = edges.push(SurfaceEdge { ends, triangles: [t, u], chain: ends.to_vec() });
            triangle_edges[t][usize::from(i)] = edge;
            triangle_edges[u][usize::from(j)] = edge;
        }
        let mut origin = IdVec::filled(Origin::Input, points.len());
        origin.extend([Origin::Far; 4]);
        let inner = IdVec::filled(Vec::new(), triangles.len());
        let n_surface = points.len();
        Ok(Self { dt, triangles, origin, edges, triangle_edges, triangles_at, n_surface, inner, budget })
    }

    pub(super) fn at(&self, v: VertexId) -> Vector {
        self.dt.points[v]
    }

    /// Adds points until the surface is there.
    pub(super) fn refine(&mut self, ctx: &Context<'_>) -> Result<(), Failure> {
        for round in 0..ROUNDS {
            self.recover_edges(ctx)?;
            let open = self.open_triangles();
            ctx.report("conforming tetrahedra", round, None, || {
                format!("{} points added, {} triangles open", self.origin.len() - 4 - self.n_surface, open.len())
            });
            if open.is_empty() {
                return Ok(());
            }
            for t in open {
                if let Some(reason) = ctx.stop() {
                    return Err(Failure::Stopped(reason));
                }
                self.pierce(t)?;
            }
        }
        Err(MissingInterior::TooManyPoints.into())
    }

    /// Splits edges until all pieces are edges of tets.
    fn recover_edges(&mut self, ctx: &Context<'_>) -> Result<(), Failure> {
        loop {
            let mut missing = 0usize;
            for e in self.edges.ids() {
                if e.0.is_multiple_of(256)
                    && let Some(reason) = ctx.stop()
                {
                    return Err(Failure::Stopped(reason));
                }
                let mut k = 0;
                while k + 1 < self.edges[e].chain.len() {
                    let [a, b] = [self.edges[e].chain[k], self.edges[e].chain[k + 1]];
                    if !self.dt.has_edge(a, b) {
                        missing += 1;
                        self.split_edge(e, k)?;
                        k += 1;
                    }
                    k += 1;
                }
            }
            if missing == 0 {
                return Ok(());
            }
        }
    }

    /// Adds a point between places `k` and `k + 1` of an edge.
    fn split_edge(&mut self, e: SideId, k: usize) -> Result<(), Failure> {
        let ends = self.edges[e].ends;
        let [a, b] = [self.edges[e].chain[k], self.edges[e].chain[k + 1]];
        let along = sub(self.at(b), self.at(a));
        let length = norm(along);
        // Between a third and two thirds of the length.
        // Powers of two: pieces that end at a common corner are cut at the same distances from it, so the points of
        // one edge stop to encroach on the other (concentric shells, Ruppert 1995).
        let shell = (2.0 * length / 3.0).log2().floor().exp2() / length;
        let share = match (ends.contains(&a), ends.contains(&b)) {
            (true, false) => shell,
            (false, true) => 1.0 - shell,
            _ => 0.5,
        };
        let from = self.at(a);
        let v = self.add(std::array::from_fn(|c| from[c] + share * along[c]), a, Origin::Edge(e))?;
        self.edges[e].chain.insert(k + 1, v);
        Ok(())
    }

    fn add(&mut self, p: Vector, near: VertexId, origin: Origin) -> Result<VertexId, Failure> {
        // On a surface that meets itself two of its triangles pierce each other for ever, each point making new ones;
        // the budget is what ends it.
        if self.budget == 0 {
            return Err(MissingInterior::TooManyPoints.into());
        }
        self.budget -= 1;
        let v = self.dt.add(p, near).map_err(|_| MissingInterior::PointsCoincide)?;
        self.origin.push(origin);
        Ok(v)
    }

    /// The surface's triangles that a vertex belongs to.
    fn triangles_of(&self, v: VertexId) -> &[TriangleId] {
        match &self.origin[v] {
            Origin::Input => &self.triangles_at[v],
            Origin::Far | Origin::Inside => &[],
            Origin::Edge(e) => &self.edges[*e].triangles,
            Origin::Triangle(t) => std::slice::from_ref(t),
        }
    }

    fn is_on_edge(&self, v: VertexId, e: SideId) -> bool {
        match self.origin[v] {
            Origin::Input => self.edges[e].ends.contains(&v),
            Origin::Edge(f) => e == f,
            _ => false,
        }
    }

    /// The triangle of the surface that all three vertices belong to, unless they all lie on one of its edges.
    pub(super) fn common(&self, face: [VertexId; 3]) -> Option<TriangleId> {
        let [a, b, c] = face.map(|v| self.triangles_of(v));
        let found = a.iter().copied().filter(|t| b.contains(t) && c.contains(t));
        found
            .into_iter()
            .find(|&t| !self.triangle_edges[t].iter().any(|&e| face.iter().all(|&v| self.is_on_edge(v, e))))
    }

    /// Per triangle of the surface: the faces that are parts of it, each once, as (triangle, sorted corners).
    fn parts(&self) -> Vec<(TriangleId, [VertexId; 3])> {
        let mut parts = Vec::new();
        for t in self.dt.in_use() {
            for (i, face) in OUTWARD.iter().enumerate() {
                // Every face of the surface is between two tets.
                if self.dt.around[t][i] < t {
                    continue;
                }
                let mut face = face.map(|k| self.dt.tets[t][k]);
                if let Some(f) = self.common(face) {
                    face.sort_unstable();
                    parts.push((f, face));
                }
            }
        }
        parts.sort_unstable();
        parts
    }

    /// The triangles that are not tiled by faces.
    fn open_triangles(&self) -> Vec<TriangleId> {
        let parts = self.parts();
        let mut open = Vec::new();
        let mut next = 0;
        for t in self.triangles.ids() {
            let first = next;
            while next < parts.len() && parts[next].0 == t {
                next += 1;
            }
            let mut sides: Vec<[VertexId; 2]> = Vec::new();
            for (_, [a, b, c]) in &parts[first..next] {
                sides.extend([[*a, *b], [*b, *c], [*a, *c]]);
            }
            sides.sort_unstable();
            let mut border: Vec<[VertexId; 2]> = Vec::new();
            for &e in &self.triangle_edges[t] {
                border.extend(self.edges[e].chain.windows(2).map(|w| [w[0].min(w[1]), w[0].max(w[1])]));
            }
            border.sort_unstable();
            // Corners of these faces lie in one plane up to rounding, so faces that have the border, and no free side
            // besides, cover the triangle: nothing need be triangulated in two dimensions.
            let complete = border.iter().all(|s| sides.binary_search(s).is_ok());
            let closed = sides.chunk_by(|x, y| x == y).all(|c| c.len() > 1 || border.binary_search(&c[0]).is_ok());
            if !complete || !closed {
                open.push(t);
            }
        }
        open
    }

    /// All vertices that belong to a triangle.
    fn members(&self, t: TriangleId) -> Vec<VertexId> {
        let mut members = self.inner[t].clone();
        for &e in &self.triangle_edges[t] {
            members.extend(&self.edges[e].chain);
        }
        members.sort_unstable();
        members.dedup();
        members
    }

    /// Adds a point to an open triangle, or to one of its edges.
    fn pierce(&mut self, t: TriangleId) -> Result<(), Failure> {
        let members = self.members(t);
        let Some(Piercing { at, near, .. }) = self.piercing(t, &members) else {
            // A point beside a free side: nothing pierces, but rounded points lie crosswise.
            let [a, b, c] = self.triangles[t].map(|v| self.at(v));
            let at: Vector = std::array::from_fn(|k| (a[k] + b[k] + c[k]) / 3.0);
            let v = self.add(at, members[0], Origin::Triangle(t))?;
            self.inner[t].push(v);
            return Ok(());
        };
        // A point in the diametral ball of a piece of an edge would leave that piece without a Delaunay edge (Shewchuk 1998).
        for e in self.triangle_edges[t] {
            let chain = &self.edges[e].chain;
            let in_ball = |w: &[VertexId]| dot(sub(self.at(w[0]), at), sub(self.at(w[1]), at)) <= 0.0;
            if let Some(k) = chain.windows(2).position(in_ball) {
                return self.split_edge(e, k);
            }
        }
        let v = self.add(at, near, Origin::Triangle(t))?;
        self.inner[t].push(v);
        Ok(())
    }

    /// Where an edge pierces a triangle, farthest from its members. The walk starts from the tets of the members and goes on
    /// through every face whose edge pierces.
    fn piercing(&mut self, t: TriangleId, members: &[VertexId]) -> Option<Piercing> {
        let corners = self.triangles[t].map(|v| self.at(v));
        let mut seen = std::collections::HashSet::new();
        let mut queue: Vec<TetId> = Vec::new();
        for &m in members {
            queue.extend(self.dt.star(m).into_iter().filter(|&s| seen.insert(s)));
        }
        let mut best: Option<Piercing> = None;
        while let Some(s) = queue.pop() {
            let tet = self.dt.tets[s];
            for [i, j] in TET_EDGES {
                let [x, y] = [tet[i].min(tet[j]), tet[i].max(tet[j])];
                if members.binary_search(&x).is_ok() || members.binary_search(&y).is_ok() {
                    continue;
                }
                // By vertex id: the same edge seen from two tets must give the same bits.
                let [p, q] = [self.at(x), self.at(y)];
                let Some((above, below)) = crossing([p, q], corners) else { continue };
                for k in (0..4).filter(|&k| k != i && k != j) {
                    let other = self.dt.around[s][k];
                    if other.is_some() && seen.insert(other) {
                        queue.push(other);
                    }
                }
                // The signs of `above` and `below` are exact, so whether there is a point is certain; where it lies
                // is rounded, and that is enough.
                let share = above.abs() / (above.abs() + below.abs());
                let at: Vector = std::array::from_fn(|k| p[k] + share * (q[k] - p[k]));
                let square = |m: &VertexId| {
                    let d = sub(self.at(*m), at);
                    dot(d, d)
                };
                let nearest = members.iter().map(square).fold(f64::INFINITY, f64::min);
                // Ties by position, so that the walk's order does not matter.
                if best.as_ref().is_none_or(|b| (nearest, at) > (b.nearest, b.at)) {
                    best = Some(Piercing { nearest, at, near: if above.abs() < below.abs() { x } else { y } });
                }
            }
        }
        best
    }

    /// The regions between the surface's faces: per tet its region, and the regions.
    fn regions(&self) -> (IdVec<TetId, usize>, Vec<Region>) {
        let shared = |tet: [VertexId; 4]| {
            let first = self.triangles_of(tet[0]);
            first.iter().any(|t| tet[1..].iter().all(|&v| self.triangles_of(v).contains(t)))
        };
        let mut region = IdVec::filled(usize::MAX, self.dt.tets.len());
        let mut regions = Vec::new();
        for seed in self.dt.in_use() {
            if region[seed] != usize::MAX {
                continue;
            }
            let number = regions.len();
            let (mut is_flat, mut is_far) = (true, false);
            let mut stack = vec![seed];
            region[seed] = number;
            while let Some(t) = stack.pop() {
                let tet = self.dt.tets[t];
                is_flat &= shared(tet);
                is_far |= tet.iter().any(|&v| self.origin[v] == Origin::Far);
                for (i, face) in OUTWARD.iter().enumerate() {
                    let other = self.dt.around[t][i];
                    let is_new = other.is_some() && region[other] == usize::MAX;
                    if is_new && self.common(face.map(|k| tet[k])).is_none() {
                        region[other] = number;
                        stack.push(other);
                    }
                }
            }
            regions.push(Region { is_flat, is_far });
        }
        (region, regions)
    }

    /// Per tet whether it lies inside the surface, which must be complete (see [`refine`](Self::refine)); and the faces of the
    /// surface as seen from both sides.
    fn sides(&self) -> Result<(IdVec<TetId, bool>, Vec<SurfaceFace>), Failure> {
        let (region, regions) = self.regions();
        // Every face votes for the regions on its two sides: inside behind it, outside before it.
        let mut votes = vec![[0usize; 2]; regions.len()];
        let mut faces = Vec::new();
        for t in self.dt.in_use() {
            for (i, face) in OUTWARD.iter().enumerate() {
                let corners = face.map(|k| self.dt.tets[t][k]);
                if let Some(triangle) = self.common(corners) {
                    let [a, b, c] = corners.map(|v| self.at(v));
                    let [p, q, r] = self.triangles[triangle].map(|v| self.at(v));
                    let same = dot(cross(sub(b, a), sub(c, a)), cross(sub(q, p), sub(r, p))) > 0.0;
                    votes[region[t]][usize::from(!same)] += 1;
                    faces.push(SurfaceFace { behind: t, before: self.dt.around[t][i], corners, triangle });
                }
            }
        }
        let mut keep = vec![false; regions.len()];
        for (r, &[behind, before]) in votes.iter().enumerate() {
            // Rounded points of one triangle: such tets lie in the surface, not beside it.
            if regions[r].is_flat {
                continue;
            }
            // A region on the inner side of one face and the outer side of another, or inside and infinite: no
            // closed, embedded, outward surface has one.
            if behind > 0 && (before > 0 || regions[r].is_far) {
                return Err(MissingInterior::SidesContradict.into());
            }
            keep[r] = behind > 0;
        }
        let inside = region.iter().map(|&r| r != usize::MAX && keep[r]).collect();
        Ok((inside, faces))
    }

    /// Per tet whether it lies inside.
    ///
    /// # Errors
    /// As [`inside`](Self::inside).
    pub(super) fn kept(&self) -> Result<IdVec<TetId, bool>, Failure> {
        Ok(self.sides()?.0)
    }

    /// The tets inside the surface. It must be complete (see [`refine`](Self::refine)).
    ///
    /// # Errors
    /// A surface whose sides contradict each other.
    pub(super) fn inside(self) -> Result<Inside, Failure> {
        let (kept, faces) = self.sides()?;
        // The four far corners go.
        let n = self.n_surface;
        let number = |v: VertexId| if v.index() < n { v } else { VertexId(v.0 - 4) };
        let is_boundary = |f: &&SurfaceFace| kept[f.behind] && !(f.before.is_some() && kept[f.before]);
        let boundary = faces.iter().filter(is_boundary).map(|f| (f.corners.map(number), f.triangle)).collect();
        let tets = self.dt.in_use().filter(|&t| kept[t]).map(|t| self.dt.tets[t].map(number)).collect();
        let is_far = |v: VertexId| (n..n + 4).contains(&v.index());
        let points = self.dt.points.enumerate().filter(|&(v, _)| !is_far(v)).map(|(_, p)| *p).collect();
        Ok(Inside { points, tets, boundary })
    }
}

/// A point at which an edge pierces a triangle.
struct Piercing {
    /// The square of its distance from the nearest member of the triangle.
    nearest: f64,
    at: Vector,
    /// The nearer end of the edge.
    near: VertexId,
}

/// A region between the surface's faces.
struct Region {
    /// Whether each of its tets has its corners in one triangle of the surface.
    is_flat: bool,
    /// Whether it reaches the huge tet.
    is_far: bool,
}

/// A face of the surface seen from one of its sides.
struct SurfaceFace {
    behind: TetId,
    before: TetId,
    corners: [VertexId; 3],
    triangle: TriangleId,
}

/// How far the ends of a segment are above and below a triangle, in units of volume, if it meets the triangle in a point.
fn crossing([p, q]: [Vector; 2], [a, b, c]: [Vector; 3]) -> Option<(f64, f64)> {
    let [above, below] = [orient([p, a, b, c]), orient([q, a, b, c])];
    if above * below > 0.0 || (above == 0.0 && below == 0.0) {
        return None;
    }
    let turn = if above > 0.0 || below < 0.0 { 1.0 } else { -1.0 };
    let beside = [[a, b], [b, c], [c, a]].iter().any(|&[u, v]| turn * orient([p, q, u, v]) < 0.0);
    (!beside).then_some((above, below))
}

/// The vertices along a space-filling curve: neighbours in it are near each other, so walks are short (Morton 1966).
fn morton_order(points: &[Vector]) -> Vec<VertexId> {
    let (low, _, size) = bounding_box(points);
    let key = |p: &Vector| {
        let grid: [u64; 3] = std::array::from_fn(|c| ((p[c] - low[c]) / size * 1023.0) as u64);
        (0..10).rev().fold(0u64, |key, bit| (0..3).fold(key, |key, c| key << 1 | (grid[c] >> bit & 1)))
    };
    let mut order: Vec<VertexId> = (0..points.len()).map(VertexId::new).collect();
    order.sort_by_key(|&v| (key(&points[v.index()]), v));
    order
}
