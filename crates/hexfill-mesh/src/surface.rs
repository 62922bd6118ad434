//! [`QuadSurface`]: a closed, oriented 2-manifold cut into quads, of any genus and with any number of components.
//!
//! Parse, don't validate: [`QuadSurface::try_new`] is the only way in, so a value of the type *is* closed,
//! manifold and consistently oriented. Vertices are ids only; positions live with the caller.
//! Invariant: `twin[twin[d]] = d`, and the twin of a dart joins the same two vertices the other way round.
//!
//! Source: ours.

use crate::ids::{Dart, Edge, Offenders, QuadId, VertexId};
use std::fmt;

/// A closed oriented quad surface. See the module page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct QuadSurface {
    n_vertices: usize,
    quads: Vec<[VertexId; 4]>,
    /// Per dart: the dart of the neighbouring quad along the same edge.
    twin: Vec<Dart>,
    /// Per quad: index of its connected component, numbered by smallest quad.
    component: Vec<u32>,
    n_components: usize,
    /// Per vertex: number of quads round it; 0 for a vertex no quad uses.
    degree: Vec<u32>,
    /// Quads whose orientation was reversed to agree with the majority of their component.
    reversed: Vec<QuadId>,
}

/// Why an array of polygons is not a closed oriented quad surface.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SurfaceError {
    /// No face at all.
    #[error("the surface has no faces; give at least 6 quads")]
    Empty,
    /// More than the id types can name.
    #[error("{given} {what} given, the limit is {limit}; split the surface")]
    TooLarge {
        /// What is too many.
        what: &'static str,
        /// How many were given.
        given: usize,
        /// How many are allowed.
        limit: usize,
    },
    /// Faces that are not quads.
    #[error("{} of the faces are not quads: {offenders}; hexahedra need an all-quad boundary: split or merge these faces first", offenders.count)]
    NotQuads {
        /// The faces and their number of sides.
        offenders: Offenders<FaceSides>,
    },
    /// A vertex index beyond the vertices.
    #[error("quad {quad} uses vertex index {given}, but there are only {limit} vertices (0-based indices)")]
    IndexOutOfRange {
        /// The quad.
        quad: QuadId,
        /// The index given.
        given: u32,
        /// The number of vertices.
        limit: usize,
    },
    /// A quad that uses one vertex twice.
    #[error("quad {quad} uses vertex {vertex} twice; remove or repair the degenerate face")]
    RepeatedVertex {
        /// The quad.
        quad: QuadId,
        /// The vertex.
        vertex: VertexId,
    },
    /// Quads with the same four vertices.
    #[error("{} quads have the same four vertices as an earlier one: {quads}; remove the copies", quads.count)]
    RepeatedQuads {
        /// The copies.
        quads: Offenders<QuadId>,
    },
    /// Edges with one quad only.
    #[error("the surface is open: {} boundary edges with one quad only: {edges}; close the holes (or merge duplicate points)", edges.count)]
    Open {
        /// The edges.
        edges: Offenders<Edge>,
    },
    /// Edges with three or more quads.
    #[error("{} non-manifold edges, each in three or more quads: {edges}; split the surface there", edges.count)]
    NonManifoldEdges {
        /// The edges.
        edges: Offenders<Edge>,
    },
    /// Vertices whose quads form more than one fan.
    #[error("{} non-manifold vertices, each joining several fans of quads: {vertices}; duplicate the point, one copy a fan", vertices.count)]
    NonManifoldVertices {
        /// The vertices.
        vertices: Offenders<VertexId>,
    },
    /// No consistent orientation exists (a Moebius band of quads).
    #[error(
        "the surface is not orientable: walking from quad to quad reaches {quad} both ways round, across edge {edge}; it bounds no solid"
    )]
    NotOrientable {
        /// A quad reached with both orientations.
        quad: QuadId,
        /// The edge where the orientations clash.
        edge: Edge,
    },
}

/// A face and its number of sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FaceSides {
    /// Index of the face (0-based, order of the file).
    pub face: usize,
    /// Its number of sides.
    pub sides: usize,
}

impl fmt::Display for FaceSides {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "face {} ({} sides)", self.face, self.sides)
    }
}

const NONE: Dart = Dart(u32::MAX);

impl QuadSurface {
    /// Most quads a surface may have.
    pub const MAX_QUADS: usize = (u32::MAX / 4) as usize - 1;

    /// Builds the surface from `n_vertices` and quads of 0-based vertex indices.
    ///
    /// Mixed orientation is repaired: in each component the quads in the minority are reversed
    /// (see [`reversed`](Self::reversed)). Vertices no quad uses are allowed and keep their ids.
    ///
    /// # Errors
    /// [`SurfaceError`], naming the first offenders and their number.
    ///
    /// # Example
    /// ```
    /// use hexfill_mesh::{QuadSurface, SurfaceError};
    ///
    /// let mut quads = vec![[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
    /// let cube = QuadSurface::try_new(8, &quads)?;
    /// assert_eq!((cube.n_edges(), cube.genus(), cube.is_sphere()), (12, 0, true));
    ///
    /// quads[1].reverse();
    /// assert_eq!(QuadSurface::try_new(8, &quads)?.reversed().len(), 1);
    ///
    /// quads.pop();
    /// match QuadSurface::try_new(8, &quads) {
    ///     Err(SurfaceError::Open { edges }) => assert_eq!(edges.count, 4),
    ///     other => panic!("{other:?}"),
    /// }
    /// # Ok::<(), SurfaceError>(())
    /// ```
    pub fn try_new(n_vertices: usize, quads: &[[u32; 4]]) -> Result<Self, SurfaceError> {
        if quads.is_empty() {
            return Err(SurfaceError::Empty);
        }
        if quads.len() > Self::MAX_QUADS {
            return Err(SurfaceError::TooLarge { what: "quads", given: quads.len(), limit: Self::MAX_QUADS });
        }
        if n_vertices > u32::MAX as usize {
            return Err(SurfaceError::TooLarge { what: "vertices", given: n_vertices, limit: u32::MAX as usize });
        }
        for (q, quad) in quads.iter().enumerate() {
            for (i, &v) in quad.iter().enumerate() {
                if v as usize >= n_vertices {
                    return Err(SurfaceError::IndexOutOfRange { quad: QuadId::new(q), given: v, limit: n_vertices });
                }
                if quad[..i].contains(&v) {
                    return Err(SurfaceError::RepeatedVertex { quad: QuadId::new(q), vertex: VertexId(v) });
                }
            }
        }
        let mut surface = Self {
            n_vertices,
            quads: quads.iter().map(|quad| quad.map(VertexId)).collect(),
            twin: Vec::new(),
            component: vec![u32::MAX; quads.len()],
            n_components: 0,
            degree: vec![0; n_vertices],
            reversed: Vec::new(),
        };
        for quad in &surface.quads {
            for v in quad {
                surface.degree[v.index()] += 1;
            }
        }
        // In this order: orientation needs pairs of edges, and a vertex has one fan only if the quads round it turn
        // the same way.
        surface.pair_edges()?;
        surface.orient()?;
        surface.check_fans()?;
        Ok(surface)
    }

    /// As [`try_new`](Self::try_new), from polygons of any number of sides.
    ///
    /// # Errors
    /// [`SurfaceError::NotQuads`] if a polygon has not four sides, else as [`try_new`](Self::try_new).
    pub fn try_from_polygons<P: AsRef<[u32]>>(n_vertices: usize, polygons: &[P]) -> Result<Self, SurfaceError> {
        let mut quads = Vec::with_capacity(polygons.len());
        let mut offenders = Offenders::default();
        for (face, polygon) in polygons.iter().enumerate() {
            match polygon.as_ref() {
                &[a, b, c, d] => quads.push([a, b, c, d]),
                other => offenders.push(FaceSides { face, sides: other.len() }),
            }
        }
        if offenders.is_empty() { Self::try_new(n_vertices, &quads) } else { Err(SurfaceError::NotQuads { offenders }) }
    }

    /// Pairs the darts by their undirected edge (orientation is settled later).
    fn pair_edges(&mut self) -> Result<(), SurfaceError> {
        // Counting sort of the darts by smaller end vertex: linear time and memory at any size.
        let n_darts = 4 * self.quads.len();
        let edge_of = |d: usize| {
            let quad = &self.quads[d / 4];
            Edge::new(quad[d % 4], quad[(d + 1) % 4])
        };
        let mut start = vec![0u32; self.n_vertices + 1];
        for d in 0..n_darts {
            start[edge_of(d).0.index() + 1] += 1;
        }
        for v in 0..self.n_vertices {
            start[v + 1] += start[v];
        }
        let mut cursor = start.clone();
        let mut sorted = vec![0u32; n_darts];
        for d in 0..n_darts {
            let slot = &mut cursor[edge_of(d).0.index()];
            sorted[*slot as usize] = d as u32;
            *slot += 1;
        }
        let mut open = Offenders::default();
        let mut non_manifold = Offenders::default();
        let mut twin = vec![NONE; n_darts];
        for v in 0..self.n_vertices {
            let bucket = &mut sorted[start[v] as usize..start[v + 1] as usize];
            bucket.sort_unstable_by_key(|&d| (edge_of(d as usize).1, d));
            for run in bucket.chunk_by(|&a, &b| edge_of(a as usize) == edge_of(b as usize)) {
                match *run {
                    [d] => open.push(edge_of(d as usize)),
                    [a, b] => {
                        twin[a as usize] = Dart(b);
                        twin[b as usize] = Dart(a);
                    }
                    _ => non_manifold.push(edge_of(run[0] as usize)),
                }
            }
        }
        if !non_manifold.is_empty() {
            // A quad listed twice shows as edges with too many quads; its copies are the cause and what there is to
            // remove.
            let quads = self.copies();
            if !quads.is_empty() {
                return Err(SurfaceError::RepeatedQuads { quads });
            }
            return Err(SurfaceError::NonManifoldEdges { edges: non_manifold });
        }
        if !open.is_empty() {
            return Err(SurfaceError::Open { edges: open });
        }
        self.twin = twin;
        Ok(())
    }

    /// Quads with the vertices of an earlier quad: the likely cause of edges with too many quads.
    fn copies(&self) -> Offenders<QuadId> {
        let mut named: Vec<([VertexId; 4], usize)> = self
            .quads
            .iter()
            .enumerate()
            .map(|(q, quad)| {
                let mut vertices = *quad;
                vertices.sort_unstable();
                (vertices, q)
            })
            .collect();
        named.sort_unstable();
        let mut copies: Vec<usize> =
            named.chunk_by(|a, b| a.0 == b.0).flat_map(|run| run[1..].iter().map(|(_, q)| *q)).collect();
        copies.sort_unstable();
        copies.into_iter().map(QuadId::new).collect()
    }

    /// Numbers the components and reverses the minority orientation in each.
    fn orient(&mut self) -> Result<(), SurfaceError> {
        let mut flip = vec![false; self.quads.len()];
        let mut stack = Vec::new();
        for seed in 0..self.quads.len() {
            if self.component[seed] != u32::MAX {
                continue;
            }
            let id = self.n_components as u32;
            self.n_components += 1;
            self.component[seed] = id;
            stack.push(seed);
            let mut members = Vec::new();
            while let Some(q) = stack.pop() {
                members.push(q);
                for side in 0..4 {
                    let d = Dart((4 * q + side) as u32);
                    let t = self.twin[d.index()];
                    let other = t.quad().index();
                    // Two quads agree when they run along their common edge in opposite directions.
                    let agree = self.origin(d) != self.origin(t);
                    let wanted = flip[q] == agree;
                    if self.component[other] == u32::MAX {
                        self.component[other] = id;
                        flip[other] = wanted;
                        stack.push(other);
                    } else if flip[other] != wanted {
                        return Err(SurfaceError::NotOrientable {
                            quad: QuadId::new(other),
                            edge: Edge::new(self.origin(d), self.origin(d.next())),
                        });
                    }
                }
            }
            // Which of the two orientations is wanted nobody says: the one that most quads have already, so that few
            // change.
            let minority_is_flipped = 2 * members.iter().filter(|&&q| flip[q]).count() <= members.len();
            if !minority_is_flipped {
                for q in members {
                    flip[q] = !flip[q];
                }
            }
        }
        if flip.iter().any(|&f| f) {
            for (q, quad) in self.quads.iter_mut().enumerate() {
                if flip[q] {
                    quad.swap(1, 3);
                    self.reversed.push(QuadId::new(q));
                }
            }
            self.pair_edges()?;
        }
        Ok(())
    }

    /// Every vertex must have one fan: walking round it meets all its quads.
    fn check_fans(&self) -> Result<(), SurfaceError> {
        let mut seen = vec![false; self.n_vertices];
        let mut vertices = Offenders::default();
        let mut bad = std::collections::BTreeSet::new();
        for d in self.darts() {
            let v = self.origin(d);
            if seen[v.index()] {
                continue;
            }
            seen[v.index()] = true;
            // Edges are in two quads each, so the fan at a dart closes; quads it does not reach are a fan of their
            // own, pinched on.
            if self.round_vertex(d).count() as u32 != self.degree(v) {
                bad.insert(v);
            }
        }
        bad.into_iter().for_each(|v| vertices.push(v));
        if vertices.is_empty() { Ok(()) } else { Err(SurfaceError::NonManifoldVertices { vertices }) }
    }

    /// Number of vertex ids, used or not.
    pub fn n_vertices(&self) -> usize {
        self.n_vertices
    }

    /// Number of vertices that some quad uses.
    pub fn n_used_vertices(&self) -> usize {
        self.degree.iter().filter(|&&d| d > 0).count()
    }

    /// Number of quads.
    pub fn n_quads(&self) -> usize {
        self.quads.len()
    }

    /// Number of edges: two per quad.
    pub fn n_edges(&self) -> usize {
        2 * self.quads.len()
    }

    /// The quads, consistently oriented, in the order given.
    pub fn quads(&self) -> &[[VertexId; 4]] {
        &self.quads
    }

    /// The quads as plain arrays, for writers and foreign code.
    pub fn quads_raw(&self) -> Vec<[u32; 4]> {
        self.quads.iter().map(|q| q.map(|v| v.0)).collect()
    }

    /// The corners of a quad.
    pub fn quad(&self, q: QuadId) -> [VertexId; 4] {
        self.quads[q.index()]
    }

    /// Quads that [`try_new`](Self::try_new) had to reverse.
    pub fn reversed(&self) -> &[QuadId] {
        &self.reversed
    }

    /// All darts, ascending.
    pub fn darts(&self) -> impl Iterator<Item = Dart> + use<> {
        (0..4 * self.quads.len() as u32).map(Dart)
    }

    /// The vertex a dart starts from.
    #[inline]
    pub fn origin(&self, d: Dart) -> VertexId {
        self.quads[d.quad().index()][d.side()]
    }

    /// The vertex a dart leads to.
    #[inline]
    pub fn target(&self, d: Dart) -> VertexId {
        self.origin(d.next())
    }

    /// The dart of the neighbouring quad along the same edge.
    #[inline]
    pub fn twin(&self, d: Dart) -> Dart {
        self.twin[d.index()]
    }

    /// The darts that start from the origin of `d`, clockwise, `d` first.
    pub fn round_vertex(&self, d: Dart) -> impl Iterator<Item = Dart> + '_ {
        let mut at = Some(d);
        std::iter::from_fn(move || {
            let now = at?;
            let next = self.twin(now).next();
            at = (next != d).then_some(next);
            Some(now)
        })
    }

    /// Per vertex: the smallest dart that starts from it, `None` for a vertex no quad uses. Linear time.
    pub fn dart_of_vertices(&self) -> Vec<Option<Dart>> {
        let mut dart = vec![None; self.n_vertices];
        for d in self.darts() {
            dart[self.origin(d).index()].get_or_insert(d);
        }
        dart
    }

    /// Number of quads round a vertex (0: unused).
    #[inline]
    pub fn degree(&self, v: VertexId) -> u32 {
        self.degree[v.index()]
    }

    /// Number of connected components.
    pub fn n_components(&self) -> usize {
        self.n_components
    }

    /// Component of a quad, components being numbered by their smallest quad.
    pub fn component(&self, q: QuadId) -> usize {
        self.component[q.index()] as usize
    }

    /// Euler characteristic V - E + F of the whole surface, unused vertices not counted.
    pub fn euler_characteristic(&self) -> i64 {
        self.n_used_vertices() as i64 - self.quads.len() as i64
    }

    /// Sum of the genera of the components.
    pub fn genus(&self) -> u64 {
        ((2 * self.n_components as i64 - self.euler_characteristic()) / 2) as u64
    }

    /// Whether the surface is one sphere.
    pub fn is_sphere(&self) -> bool {
        self.n_components == 1 && self.euler_characteristic() == 2
    }

    /// The same surface with every quad reversed (inside out).
    #[must_use]
    pub fn inverted(&self) -> Self {
        let quads: Vec<[u32; 4]> = self.quads.iter().map(|q| [q[0].0, q[3].0, q[2].0, q[1].0]).collect();
        let mut out = Self::try_new(self.n_vertices, &quads).expect("reversing all quads keeps a surface a surface");
        out.reversed.clone_from(&self.reversed);
        out
    }

    /// Checks the invariants; for tests and debug builds.
    ///
    /// # Panics
    /// If one is broken.
    pub fn debug_check(&self) {
        for d in self.darts() {
            let t = self.twin(d);
            assert_eq!(self.twin(t), d);
            assert_eq!(self.origin(t), self.target(d));
            assert_eq!(self.target(t), self.origin(d));
            assert_eq!(self.component(d.quad()), self.component(t.quad()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube() -> Vec<[u32; 4]> {
        crate::cube::FACETS.iter().map(|f| f.map(|v| v as u32)).collect()
    }

    #[test]
    fn the_cube_is_a_sphere() {
        let s = QuadSurface::try_new(8, &cube()).unwrap();
        s.debug_check();
        assert!(s.is_sphere());
        assert_eq!((s.n_edges(), s.genus(), s.n_components()), (12, 0, 1));
        assert!(s.reversed().is_empty());
    }

    #[test]
    fn mixed_orientation_is_repaired_and_reported() {
        for mask in 0..64u32 {
            let mut quads = cube();
            for (q, quad) in quads.iter_mut().enumerate() {
                if mask >> q & 1 == 1 {
                    quad.swap(1, 3);
                }
            }
            let s = QuadSurface::try_new(8, &quads).unwrap();
            s.debug_check();
            assert!(s.reversed().len() <= 3);
            assert_eq!(s.reversed().len(), mask.count_ones().min(6 - mask.count_ones()) as usize);
        }
    }

    #[test]
    fn bad_surfaces_are_refused_by_name() {
        let mut open = cube();
        open.pop();
        match QuadSurface::try_new(8, &open) {
            Err(SurfaceError::Open { edges }) => assert_eq!(edges.count, 4),
            other => panic!("{other:?}"),
        }
        let mut twice = cube();
        twice.push([2, 1, 0, 3]);
        match QuadSurface::try_new(8, &twice) {
            Err(SurfaceError::RepeatedQuads { quads }) => assert_eq!(quads.first, [QuadId(6)]),
            other => panic!("{other:?}"),
        }
        let mut three = cube();
        three.push([0, 1, 9, 8]);
        assert!(matches!(QuadSurface::try_new(10, &three), Err(SurfaceError::NonManifoldEdges { .. })));
        let mut pinched = cube();
        pinched.extend(cube().iter().map(|q| q.map(|v| if v == 0 { 0 } else { v + 7 })));
        match QuadSurface::try_new(15, &pinched) {
            Err(SurfaceError::NonManifoldVertices { vertices }) => assert_eq!(vertices.first, [VertexId(0)]),
            other => panic!("{other:?}"),
        }
        assert!(matches!(
            QuadSurface::try_new(7, &cube()),
            Err(SurfaceError::IndexOutOfRange { given: 7, limit: 7, .. })
        ));
        assert!(matches!(QuadSurface::try_new(8, &[[0, 1, 1, 2]]), Err(SurfaceError::RepeatedVertex { .. })));
        assert!(matches!(QuadSurface::try_new(8, &[]), Err(SurfaceError::Empty)));
        let faces: [&[u32]; 2] = [&[0, 1, 2], &[0, 1, 2, 3]];
        assert!(matches!(QuadSurface::try_from_polygons(8, &faces), Err(SurfaceError::NotQuads { .. })));
    }

    #[test]
    fn the_klein_bottle_is_not_orientable() {
        let at = |i: u32, j: u32| {
            let (i, j) = if i == 4 { (0, (4 - j) % 4) } else { (i, j % 4) };
            4 * i + j
        };
        let mut quads = Vec::new();
        for i in 0..4 {
            for j in 0..4 {
                quads.push([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
        assert!(matches!(QuadSurface::try_new(16, &quads), Err(SurfaceError::NotOrientable { .. })));
    }
}
