//! Refines a Delaunay tetrahedralisation until the surface is a union of its faces.
//!
//! A missing piece of an edge is split: in the middle, or next to a corner at a distance that is a power of two, so that
//! the pieces of edges that meet at an acute angle are cut at equal distances and stop to be in each other's way (Ruppert
//! 1995, Shewchuk 1998). A triangle whose faces do not close gets a point where an edge pierces it, the one farthest
//! from what the triangle has already; if that lies in the diametral ball of a piece of its own edges, this is split instead.
//! No two-dimensional triangulation is kept: the faces whose corners all belong to a triangle tile it iff its edges are
//! there and no face has a free side. Ties need no care, the faces are those that the tetrahedra chose.
//! Rounded points of one triangle may be the corners of a flat tet; [`Conforming::inside`] leaves such tets outside.

use super::mesh::{Delaunay, NONE, orient};
use crate::tets::OUTWARD;
use crate::vector::{Point, bounding_box, cross, dot, sub};
use hexfill_mesh::{Context, StopReason};

/// What a vertex belongs to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Origin {
    /// A vertex of the surface.
    Input,
    /// A corner of the huge tet.
    Far,
    /// A point on an edge of the surface.
    Edge(u32),
    /// A point in a triangle of the surface.
    Triangle(u32),
    /// A point inside.
    Inside,
}

/// Why there is no answer.
#[derive(Debug)]
pub(crate) enum Failure {
    /// In words.
    Reason(String),
    /// Told to stop.
    Stopped(StopReason),
}

impl From<String> for Failure {
    fn from(reason: String) -> Self {
        Self::Reason(reason)
    }
}

/// An edge of the surface.
pub(crate) struct SurfaceEdge {
    ends: [u32; 2],
    triangles: [u32; 2],
    /// The vertices on it, from end to end.
    chain: Vec<u32>,
}

/// The surface and the tetrahedralisation that is to conform to it.
pub(crate) struct Conforming<'a> {
    pub(super) dt: Delaunay,
    triangles: &'a [[u32; 3]],
    pub(super) origin: Vec<Origin>,
    edges: Vec<SurfaceEdge>,
    /// Per triangle its edges; edge `k` joins its vertices `k` and `k + 1`.
    triangle_edges: Vec<[u32; 3]>,
    /// Per vertex of the surface its triangles.
    triangles_at: Vec<Vec<u32>>,
    /// Per triangle: the points in it.
    inner: Vec<Vec<u32>>,
    /// How many points may still be added.
    pub(super) budget: usize,
}

/// The tets inside the surface with their boundary.
pub(crate) struct Inside {
    /// Positions: the surface's vertices, then further ones.
    pub points: Vec<Point>,
    /// The tets.
    pub tets: Vec<[u32; 4]>,
    /// The boundary, outward, with the surface's triangle it is part of.
    pub boundary: Vec<([u32; 3], u32)>,
}

impl<'a> Conforming<'a> {
    /// The tetrahedralisation of the surface's vertices.
    pub fn new(points: &[Point], triangles: &'a [[u32; 3]], budget: usize) -> Result<Self, Failure> {
        let mut dt = Delaunay::new(points);
        for v in morton_order(points) {
            dt.insert(v).map_err(|w| format!("vertices {} and {} are at the same place", v.min(w), v.max(w)))?;
        }
        let mut sides: Vec<([u32; 2], u32, u8)> = Vec::with_capacity(3 * triangles.len());
        let mut triangles_at = vec![Vec::new(); points.len()];
        for (t, tri) in triangles.iter().enumerate() {
            for k in 0..3 {
                let (a, b) = (tri[k], tri[(k + 1) % 3]);
                sides.push(([a.min(b), a.max(b)], t as u32, k as u8));
                triangles_at[a as usize].push(t as u32);
            }
        }
        sides.sort_unstable();
        let mut edges = Vec::with_capacity(sides.len() / 2);
        let mut triangle_edges = vec![[NONE; 3]; triangles.len()];
        for pair in sides.chunks(2) {
            let &[(ends, t, i), (other, u, j)] = pair else {
                return Err("a triangle has a free side".to_owned().into());
            };
            if ends != other {
                return Err(format!("edge {ends:?} is not in two triangles").into());
            }
            triangle_edges[t as usize][usize::from(i)] = edges.len() as u32;
            triangle_edges[u as usize][usize::from(j)] = edges.len() as u32;
            edges.push(SurfaceEdge { ends, triangles: [t, u], chain: ends.to_vec() });
        }
        let mut origin = vec![Origin::Input; points.len()];
        origin.extend([Origin::Far; 4]);
        let inner = vec![Vec::new(); triangles.len()];
        Ok(Self { dt, triangles, origin, edges, triangle_edges, triangles_at, inner, budget })
    }

    pub(super) fn at(&self, v: u32) -> Point {
        self.dt.points[v as usize]
    }

    /// Adds points until the surface is there.
    pub fn refine(&mut self, ctx: &Context<'_>) -> Result<(), Failure> {
        for round in 0.. {
            self.recover_edges(ctx)?;
            let open = self.open_triangles();
            ctx.report("conforming tetrahedra", round, None, || {
                format!(
                    "{} points added, {} triangles open",
                    self.origin.len() - 4 - self.triangles_at.len(),
                    open.len()
                )
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
        Ok(())
    }

    /// Splits edges until all pieces are edges of tets.
    fn recover_edges(&mut self, ctx: &Context<'_>) -> Result<(), Failure> {
        loop {
            let mut missing = 0usize;
            for e in 0..self.edges.len() {
                if e.is_multiple_of(256)
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
    fn split_edge(&mut self, e: usize, k: usize) -> Result<(), Failure> {
        let ends = self.edges[e].ends;
        let [a, b] = [self.edges[e].chain[k], self.edges[e].chain[k + 1]];
        let along = sub(self.at(b), self.at(a));
        let length = dot(along, along).sqrt();
        // Between a third and two thirds of the length.
        let shell = (2.0 * length / 3.0).log2().floor().exp2() / length;
        let share = match (ends.contains(&a), ends.contains(&b)) {
            (true, false) => shell,
            (false, true) => 1.0 - shell,
            _ => 0.5,
        };
        let from = self.at(a);
        let v = self.add(std::array::from_fn(|c| from[c] + share * along[c]), a, Origin::Edge(e as u32))?;
        self.edges[e].chain.insert(k + 1, v);
        Ok(())
    }

    fn add(&mut self, p: Point, near: u32, origin: Origin) -> Result<u32, Failure> {
        if self.budget == 0 {
            return Err("the surface meets itself or nearly does: recovering it took too many points"
                .to_owned()
                .into());
        }
        self.budget -= 1;
        let v = self.dt.add(p, near).map_err(|_| "the surface meets itself: two of its points coincide".to_owned())?;
        self.origin.push(origin);
        Ok(v)
    }

    /// The surface's triangles that a vertex belongs to.
    fn triangles_of(&self, v: u32) -> &[u32] {
        match &self.origin[v as usize] {
            Origin::Input => &self.triangles_at[v as usize],
            Origin::Far | Origin::Inside => &[],
            Origin::Edge(e) => &self.edges[*e as usize].triangles,
            Origin::Triangle(t) => std::slice::from_ref(t),
        }
    }

    fn is_on_edge(&self, v: u32, e: u32) -> bool {
        match self.origin[v as usize] {
            Origin::Input => self.edges[e as usize].ends.contains(&v),
            Origin::Edge(f) => e == f,
            _ => false,
        }
    }

    /// The triangle of the surface that all three vertices belong to, unless they all lie on one of its edges.
    pub(super) fn common(&self, face: [u32; 3]) -> Option<u32> {
        let [a, b, c] = face.map(|v| self.triangles_of(v));
        let found = a.iter().copied().filter(|t| b.contains(t) && c.contains(t));
        found
            .into_iter()
            .find(|&t| !self.triangle_edges[t as usize].iter().any(|&e| face.iter().all(|&v| self.is_on_edge(v, e))))
    }

    /// Per triangle of the surface: the faces that are parts of it, each once, as (triangle, sorted corners).
    fn parts(&self) -> Vec<(u32, [u32; 3])> {
        let mut parts = Vec::new();
        for t in self.dt.in_use() {
            for (i, face) in OUTWARD.iter().enumerate() {
                // Every face of the surface is between two tets.
                if self.dt.around[t][i] != NONE && (self.dt.around[t][i] as usize) < t {
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
    fn open_triangles(&self) -> Vec<u32> {
        let parts = self.parts();
        let mut open = Vec::new();
        let mut next = 0;
        for t in 0..self.triangles.len() as u32 {
            let first = next;
            while next < parts.len() && parts[next].0 == t {
                next += 1;
            }
            let mut sides: Vec<[u32; 2]> = Vec::new();
            for (_, [a, b, c]) in &parts[first..next] {
                sides.extend([[*a, *b], [*b, *c], [*a, *c]]);
            }
            sides.sort_unstable();
            let mut border: Vec<[u32; 2]> = Vec::new();
            for &e in &self.triangle_edges[t as usize] {
                border.extend(self.edges[e as usize].chain.windows(2).map(|w| [w[0].min(w[1]), w[0].max(w[1])]));
            }
            border.sort_unstable();
            let complete = border.iter().all(|s| sides.binary_search(s).is_ok());
            let closed = sides.chunk_by(|x, y| x == y).all(|c| c.len() > 1 || border.binary_search(&c[0]).is_ok());
            if !complete || !closed {
                open.push(t);
            }
        }
        open
    }

    /// All vertices that belong to a triangle.
    fn members(&self, t: u32) -> Vec<u32> {
        let mut members = self.inner[t as usize].clone();
        for &e in &self.triangle_edges[t as usize] {
            members.extend(&self.edges[e as usize].chain);
        }
        members.sort_unstable();
        members.dedup();
        members
    }

    /// Adds a point to an open triangle, or to one of its edges.
    fn pierce(&mut self, t: u32) -> Result<(), Failure> {
        let members = self.members(t);
        let corners = self.triangles[t as usize].map(|v| self.at(v));
        let [a, b, c] = corners;
        let mut seen = std::collections::HashSet::new();
        let mut queue: Vec<u32> = Vec::new();
        for &m in &members {
            for s in self.dt.star(m) {
                if seen.insert(s) {
                    queue.push(s);
                }
            }
        }
        let mut best: Option<(f64, Point, u32)> = None;
        while let Some(s) = queue.pop() {
            let tet = self.dt.tets[s as usize];
            for [i, j] in crate::tets::TET_EDGES {
                let [x, y] = [tet[i].min(tet[j]), tet[i].max(tet[j])];
                if members.binary_search(&x).is_ok() || members.binary_search(&y).is_ok() {
                    continue;
                }
                let [p, q] = [self.at(x), self.at(y)];
                let [above, below] = [orient([p, a, b, c]), orient([q, a, b, c])];
                if above * below > 0.0 || (above == 0.0 && below == 0.0) {
                    continue;
                }
                let turn = if above > 0.0 || below < 0.0 { 1.0 } else { -1.0 };
                if [[a, b], [b, c], [c, a]].iter().any(|&[u, v]| turn * orient([p, q, u, v]) < 0.0) {
                    continue;
                }
                for k in (0..4).filter(|&k| k != i && k != j) {
                    let other = self.dt.around[s as usize][k];
                    if other != NONE && seen.insert(other) {
                        queue.push(other);
                    }
                }
                let share = above.abs() / (above.abs() + below.abs());
                let at: Point = std::array::from_fn(|k| p[k] + share * (q[k] - p[k]));
                let nearest = members
                    .iter()
                    .map(|&m| {
                        let d = sub(self.at(m), at);
                        dot(d, d)
                    })
                    .fold(f64::INFINITY, f64::min);
                // Ties by position, so that the walk's order does not matter.
                if best.is_none_or(|b| (nearest, at) > (b.0, b.1)) {
                    best = Some((nearest, at, if above.abs() < below.abs() { x } else { y }));
                }
            }
        }
        let Some((_, at, near)) = best else {
            // A point beside a free side: nothing pierces, but rounded points lie crosswise.
            let at: Point = std::array::from_fn(|k| (a[k] + b[k] + c[k]) / 3.0);
            let v = self.add(at, members[0], Origin::Triangle(t))?;
            self.inner[t as usize].push(v);
            return Ok(());
        };
        for e in self.triangle_edges[t as usize] {
            let chain = &self.edges[e as usize].chain;
            let in_ball = |w: &[u32]| dot(sub(self.at(w[0]), at), sub(self.at(w[1]), at)) <= 0.0;
            if let Some(k) = chain.windows(2).position(in_ball) {
                return self.split_edge(e as usize, k);
            }
        }
        let v = self.add(at, near, Origin::Triangle(t))?;
        self.inner[t as usize].push(v);
        Ok(())
    }

    /// Per tet whether it lies inside the surface, which must be complete (see [`refine`](Self::refine)); and the faces of the
    /// surface as seen from both sides: tet, place in it, corners, triangle.
    #[allow(clippy::type_complexity)] // two halves of one walk
    fn sides(&self) -> Result<(Vec<bool>, Vec<(usize, usize, [u32; 3], u32)>), Failure> {
        let n_tets = self.dt.tets.len();
        let shared = |tet: [u32; 4]| {
            let first = self.triangles_of(tet[0]);
            first.iter().any(|t| tet[1..].iter().all(|&v| self.triangles_of(v).contains(t)))
        };
        // Regions between the surface's faces.
        let mut region = vec![NONE; n_tets];
        let mut is_flat: Vec<bool> = Vec::new();
        let mut is_far: Vec<bool> = Vec::new();
        for seed in self.dt.in_use() {
            if region[seed] != NONE {
                continue;
            }
            let number = is_flat.len() as u32;
            let (mut flat, mut far) = (true, false);
            let mut stack = vec![seed];
            region[seed] = number;
            while let Some(t) = stack.pop() {
                let tet = self.dt.tets[t];
                flat &= shared(tet);
                far |= tet.iter().any(|&v| self.origin[v as usize] == Origin::Far);
                for (i, face) in OUTWARD.iter().enumerate() {
                    let other = self.dt.around[t][i];
                    if other != NONE && region[other as usize] == NONE && self.common(face.map(|k| tet[k])).is_none() {
                        region[other as usize] = number;
                        stack.push(other as usize);
                    }
                }
            }
            is_flat.push(flat);
            is_far.push(far);
        }
        // Every face votes for the regions on its two sides: inside behind it, outside before it.
        let mut votes = vec![[0usize; 2]; is_flat.len()];
        let mut faces = Vec::new();
        for t in self.dt.in_use() {
            for (i, face) in OUTWARD.iter().enumerate() {
                let face = face.map(|k| self.dt.tets[t][k]);
                if let Some(f) = self.common(face) {
                    let [a, b, c] = face.map(|v| self.at(v));
                    let [p, q, r] = self.triangles[f as usize].map(|v| self.at(v));
                    let same = dot(cross(sub(b, a), sub(c, a)), cross(sub(q, p), sub(r, p))) > 0.0;
                    votes[region[t] as usize][usize::from(!same)] += 1;
                    faces.push((t, i, face, f));
                }
            }
        }
        let mut keep = vec![false; is_flat.len()];
        for (r, &[behind, before]) in votes.iter().enumerate() {
            if is_flat[r] {
                continue;
            }
            if behind > 0 && (before > 0 || is_far[r]) {
                return Err("the surface meets itself or faces inward: its sides contradict each other"
                    .to_owned()
                    .into());
            }
            keep[r] = behind > 0;
        }
        let inside = region.iter().map(|&r| r != NONE && keep[r as usize]).collect();
        Ok((inside, faces))
    }

    /// Per tet whether it lies inside.
    ///
    /// # Errors
    /// As [`inside`](Self::inside).
    pub(super) fn kept(&self) -> Result<Vec<bool>, Failure> {
        Ok(self.sides()?.0)
    }

    /// The tets inside the surface. It must be complete (see [`refine`](Self::refine)).
    ///
    /// # Errors
    /// A surface whose sides contradict each other.
    pub fn inside(self) -> Result<Inside, Failure> {
        let (kept, faces) = self.sides()?;
        let is_kept = |t: u32| t != NONE && kept[t as usize];
        let boundary: Vec<([u32; 3], u32)> = faces
            .into_iter()
            .filter(|&(t, i, ..)| is_kept(t as u32) && !is_kept(self.dt.around[t][i]))
            .map(|(_, _, face, f)| (face, f))
            .collect();
        let tets: Vec<[u32; 4]> = self.dt.in_use().filter(|&t| is_kept(t as u32)).map(|t| self.dt.tets[t]).collect();
        // The four far corners go.
        let n = self.triangles_at.len() as u32;
        let number = |v: u32| if v < n { v } else { v - 4 };
        let without_far = |k: usize| !(n as usize..n as usize + 4).contains(&k);
        Ok(Inside {
            points: self.dt.points.iter().enumerate().filter(|(k, _)| without_far(*k)).map(|(_, p)| *p).collect(),
            tets: tets.into_iter().map(|t| t.map(number)).collect(),
            boundary: boundary.into_iter().map(|(face, f)| (face.map(number), f)).collect(),
        })
    }
}

/// The vertices along a space-filling curve: neighbours in it are near each other, so walks are short.
fn morton_order(points: &[Point]) -> Vec<u32> {
    let (low, _, size) = bounding_box(points);
    let key = |p: &Point| {
        let grid: [u64; 3] = std::array::from_fn(|c| ((p[c] - low[c]) / size * 1023.0) as u64);
        (0..10).rev().fold(0u64, |key, bit| (0..3).fold(key, |key, c| key << 1 | (grid[c] >> bit & 1)))
    };
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    order.sort_by_key(|&v| (key(&points[v as usize]), v));
    order
}
