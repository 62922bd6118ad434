//! [`HexMesh`]: hexahedra as connectivity, with their facet incidence.
//!
//! A value satisfies rule R1: every hex has 8 distinct vertices in range and every facet belongs to one hex
//! (boundary) or two. Proper intersection, links and the prescribed boundary are for `hexfill-check` to judge.
//!
//! Source: ours.

use crate::cube::{EDGES, FACETS};
use crate::ids::{HexId, Offenders, VertexId};
use std::fmt;

/// A facet of a hex: side `side` (0..6, order of [`FACETS`]) of hex `hex`, as `6 * hex + side`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[repr(transparent)]
pub struct Facet(pub u32);

impl Facet {
    /// Marks a boundary facet in a neighbour table.
    pub const NONE: Self = Self(u32::MAX);

    /// Side `side` of `hex`.
    #[inline]
    pub const fn new(hex: HexId, side: usize) -> Self {
        Self(6 * hex.0 + side as u32)
    }

    /// The hex.
    #[inline]
    pub const fn hex(self) -> HexId {
        HexId(self.0 / 6)
    }

    /// The side (0..6).
    #[inline]
    pub const fn side(self) -> usize {
        (self.0 % 6) as usize
    }

    /// The facet as an index.
    #[inline]
    pub const fn index(self) -> usize {
        self.0 as usize
    }

    /// The facet opposite in the hex.
    #[inline]
    pub const fn opposite(self) -> Self {
        Self::new(self.hex(), self.side() ^ 1)
    }
}

impl fmt::Display for Facet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.hex(), self.side())
    }
}

/// A combinatorial hex mesh. See the module page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HexMesh {
    n_vertices: usize,
    hexes: Vec<[VertexId; 8]>,
    /// Per facet: the facet glued to it, or [`Facet::NONE`].
    neighbour: Vec<Facet>,
}

/// Why an array of hexes is not a [`HexMesh`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum HexMeshError {
    /// More than the id types can name.
    #[error("{given} {what} given, the limit is {limit}")]
    TooLarge {
        /// What is too many.
        what: &'static str,
        /// How many were given.
        given: usize,
        /// How many are allowed.
        limit: usize,
    },
    /// A vertex index beyond the vertices.
    #[error("hex {hex} uses vertex index {given}, but there are only {limit} vertices (0-based indices)")]
    IndexOutOfRange {
        /// The hex.
        hex: HexId,
        /// The index given.
        given: u32,
        /// The number of vertices.
        limit: usize,
    },
    /// A hex that uses one vertex twice.
    #[error("hex {hex} uses vertex {vertex} twice")]
    RepeatedVertex {
        /// The hex.
        hex: HexId,
        /// The vertex.
        vertex: VertexId,
    },
    /// Facets with the same four vertices that cannot be one glued pair.
    #[error("{} quads are in three or more hexes, or in two hexes in another cyclic order: {facets}", facets.count)]
    BadFacets {
        /// One facet of each.
        facets: Offenders<Facet>,
    },
}

impl HexMesh {
    /// Most hexes a mesh may have.
    pub const MAX_HEXES: usize = (u32::MAX / 6) as usize - 1;

    /// Builds the incidence of `hexes`, each 8 vertex indices in VTK_HEXAHEDRON order (see [`crate::cube`]).
    /// Linear time and memory.
    ///
    /// # Errors
    /// [`HexMeshError`] if rule R1 fails.
    ///
    /// # Example
    /// Two cubes on one quad: ten quads are left on the boundary.
    /// ```
    /// use hexfill_mesh::{Facet, HexId, HexMesh, HexMeshError};
    ///
    /// let hexes = [[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11]];
    /// let mesh = HexMesh::try_new(12, &hexes)?;
    /// assert_eq!(mesh.boundary_quads().len(), 10);
    /// // Side 5 of the first hex is side 4 of the second.
    /// assert_eq!(mesh.neighbour(Facet::new(HexId(0), 5)), Some(Facet::new(HexId(1), 4)));
    ///
    /// let twice = HexMesh::try_new(8, &[[0, 1, 2, 3, 4, 5, 6, 6]]);
    /// assert!(matches!(twice, Err(HexMeshError::RepeatedVertex { .. })));
    /// # Ok::<(), HexMeshError>(())
    /// ```
    pub fn try_new(n_vertices: usize, hexes: &[[u32; 8]]) -> Result<Self, HexMeshError> {
        if hexes.len() > Self::MAX_HEXES {
            return Err(HexMeshError::TooLarge { what: "hexes", given: hexes.len(), limit: Self::MAX_HEXES });
        }
        if n_vertices > u32::MAX as usize {
            return Err(HexMeshError::TooLarge { what: "vertices", given: n_vertices, limit: u32::MAX as usize });
        }
        for (h, hex) in hexes.iter().enumerate() {
            for (i, &v) in hex.iter().enumerate() {
                if v as usize >= n_vertices {
                    return Err(HexMeshError::IndexOutOfRange { hex: HexId::new(h), given: v, limit: n_vertices });
                }
                if hex[..i].contains(&v) {
                    return Err(HexMeshError::RepeatedVertex { hex: HexId::new(h), vertex: VertexId(v) });
                }
            }
        }
        let hexes: Vec<[VertexId; 8]> = hexes.iter().map(|h| h.map(VertexId)).collect();
        let neighbour = glue_facets(n_vertices, &hexes)?;
        Ok(Self { n_vertices, hexes, neighbour })
    }

    /// Number of vertex ids, used or not.
    pub fn n_vertices(&self) -> usize {
        self.n_vertices
    }

    /// Number of hexes.
    pub fn n_hexes(&self) -> usize {
        self.hexes.len()
    }

    /// The hexes, corners in VTK order.
    pub fn hexes(&self) -> &[[VertexId; 8]] {
        &self.hexes
    }

    /// The hexes as plain arrays, for writers and foreign code.
    pub fn hexes_raw(&self) -> Vec<[u32; 8]> {
        self.hexes.iter().map(|h| h.map(|v| v.0)).collect()
    }

    /// The corners of a hex.
    pub fn hex(&self, h: HexId) -> [VertexId; 8] {
        self.hexes[h.index()]
    }

    /// All facets, ascending.
    pub fn facets(&self) -> impl Iterator<Item = Facet> + use<> {
        (0..6 * self.hexes.len() as u32).map(Facet)
    }

    /// The four vertices of a facet, counter-clockwise seen from outside its hex.
    #[inline]
    pub fn facet_vertices(&self, f: Facet) -> [VertexId; 4] {
        let hex = &self.hexes[f.hex().index()];
        FACETS[f.side()].map(|i| hex[i])
    }

    /// The facet glued to `f`, if it is interior.
    #[inline]
    pub fn neighbour(&self, f: Facet) -> Option<Facet> {
        let n = self.neighbour[f.index()];
        (n != Facet::NONE).then_some(n)
    }

    /// The facets with one hex only, ascending.
    pub fn boundary_facets(&self) -> impl Iterator<Item = Facet> + '_ {
        self.facets().filter(|f| self.neighbour[f.index()] == Facet::NONE)
    }

    /// The boundary quads, outward, in the order of [`boundary_facets`](Self::boundary_facets).
    pub fn boundary_quads(&self) -> Vec<[VertexId; 4]> {
        self.boundary_facets().map(|f| self.facet_vertices(f)).collect()
    }

    /// [`Self::boundary_quads`] as plain arrays, for writers and foreign code.
    pub fn boundary_quads_raw(&self) -> Vec<[u32; 4]> {
        self.boundary_quads().into_iter().map(|q| q.map(|v| v.0)).collect()
    }

    /// Per vertex: whether it lies on a boundary quad.
    pub fn boundary_vertices(&self) -> Vec<bool> {
        let mut on = vec![false; self.n_vertices];
        for f in self.boundary_facets() {
            for v in self.facet_vertices(f) {
                on[v.index()] = true;
            }
        }
        on
    }

    /// Per vertex: whether some hex uses it.
    pub fn used_vertices(&self) -> Vec<bool> {
        let mut used = vec![false; self.n_vertices];
        for v in self.hexes.iter().flatten() {
            used[v.index()] = true;
        }
        used
    }

    /// Number of used vertices that are not on the boundary.
    pub fn n_interior_vertices(&self) -> usize {
        let boundary = self.boundary_vertices();
        self.used_vertices().iter().zip(boundary).filter(|(used, on)| **used && !on).count()
    }

    /// All distinct edges `[a, b]` with `a < b`, sorted.
    pub fn edges(&self) -> Vec<[VertexId; 2]> {
        let mut edges: Vec<[VertexId; 2]> = self
            .hexes
            .iter()
            .flat_map(|h| {
                EDGES.map(|[i, j]| {
                    let (a, b) = (h[i], h[j]);
                    if a < b { [a, b] } else { [b, a] }
                })
            })
            .collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// Checks the invariants; for tests and debug builds.
    ///
    /// # Panics
    /// If one is broken.
    pub fn debug_check(&self) {
        for f in self.facets() {
            if let Some(g) = self.neighbour(f) {
                assert_eq!(self.neighbour(g), Some(f));
                let mut a = self.facet_vertices(f);
                let mut b = self.facet_vertices(g);
                a.sort_unstable();
                b.sort_unstable();
                assert_eq!(a, b);
            }
        }
    }
}

/// Pairs facets by vertex set: counting sort by smallest vertex, then a small sort in each bucket.
fn glue_facets(n_vertices: usize, hexes: &[[VertexId; 8]]) -> Result<Vec<Facet>, HexMeshError> {
    let quad = |f: u32| {
        let hex = &hexes[(f / 6) as usize];
        FACETS[(f % 6) as usize].map(|i| hex[i].0)
    };
    let sorted_quad = |f: u32| {
        let mut q = quad(f);
        q.sort_unstable();
        q
    };
    let smallest = |f: u32| quad(f).into_iter().min().expect("four vertices");
    let n_facets = 6 * hexes.len() as u32;
    let mut start = vec![0u32; n_vertices + 1];
    for f in 0..n_facets {
        start[smallest(f) as usize + 1] += 1;
    }
    for v in 0..n_vertices {
        start[v + 1] += start[v];
    }
    let mut cursor = start.clone();
    let mut order = vec![0u32; n_facets as usize];
    for f in 0..n_facets {
        let slot = &mut cursor[smallest(f) as usize];
        order[*slot as usize] = f;
        *slot += 1;
    }
    drop(cursor);
    // Two facets with the same four vertices are one quad if their cycles agree. In another cycle an edge of the one
    // would be a diagonal of the other, which no mesh may have. Sorted and not hashed: the first offender named must
    // not depend on a hash.
    let mut neighbour = vec![Facet::NONE; n_facets as usize];
    let mut bad = Offenders::default();
    for v in 0..n_vertices {
        let bucket = &mut order[start[v] as usize..start[v + 1] as usize];
        bucket.sort_unstable_by_key(|&f| (sorted_quad(f), f));
        for run in bucket.chunk_by(|&f, &g| sorted_quad(f) == sorted_quad(g)) {
            match *run {
                [_] => {}
                [f, g] if same_cycle(quad(f), quad(g)) => {
                    neighbour[f as usize] = Facet(g);
                    neighbour[g as usize] = Facet(f);
                }
                _ => bad.push(Facet(run[0])),
            }
        }
    }
    if bad.is_empty() { Ok(neighbour) } else { Err(HexMeshError::BadFacets { facets: bad }) }
}

/// Whether two quads on the same vertices have the same diagonals (either orientation).
fn same_cycle(a: [u32; 4], b: [u32; 4]) -> bool {
    let i = b.iter().position(|&v| v == a[0]);
    i.is_some_and(|i| b[(i + 2) % 4] == a[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_cubes_share_a_facet() {
        let m = HexMesh::try_new(12, &[[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11]]).unwrap();
        m.debug_check();
        assert_eq!(m.boundary_facets().count(), 10);
        assert_eq!(m.neighbour(Facet::new(HexId(0), 5)), Some(Facet::new(HexId(1), 4)));
        assert_eq!((m.edges().len(), m.n_interior_vertices()), (20, 0));
    }

    #[test]
    fn rule_r1_is_enforced() {
        let cube = [0, 1, 2, 3, 4, 5, 6, 7];
        assert!(matches!(HexMesh::try_new(7, &[cube]), Err(HexMeshError::IndexOutOfRange { given: 7, .. })));
        assert!(matches!(HexMesh::try_new(8, &[[0, 1, 2, 3, 4, 5, 6, 0]]), Err(HexMeshError::RepeatedVertex { .. })));
        assert!(matches!(HexMesh::try_new(8, &[cube, cube, cube]), Err(HexMeshError::BadFacets { .. })));
        let twisted = [4, 6, 5, 7, 8, 9, 10, 11];
        assert!(matches!(HexMesh::try_new(12, &[cube, twisted]), Err(HexMeshError::BadFacets { .. })));
    }
}
