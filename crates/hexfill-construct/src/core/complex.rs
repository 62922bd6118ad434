//! Tetrahedra of the core as a complex of cells.
//!
//! A [`TetComplex`] names its edges and faces itself, so two edges may join the same two vertices (a handlebody cut
//! along disks has such edges). Invariant: local edge `k` of a tet joins its vertices [`TET_EDGES`]`[k]`, local face `i`
//! is opposite its vertex `i`, and every tet is positively oriented (vertices 1, 2, 3 counter-clockwise seen from 0 are
//! clockwise; that is, det(v1-v0, v2-v0, v3-v0) > 0 in an embedding).
//!
//! Source: ours; complexes in which two edges may join the same vertices are the Delta-complexes of Hatcher 2002, section 2.1.

use super::request::TetRequest;
use crate::error::ConstructError;
use crate::ids::{EdgeId, FaceId, TetId};
use crate::misfit::TetMisfit;
use hexfill_mesh::{Id, IdVec, VertexId};

/// Ends of the six local edges of a tet.
pub const TET_EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// The local edge between local vertices `i` and `j`.
#[inline]
pub const fn tet_edge(i: usize, j: usize) -> usize {
    const TABLE: [[usize; 4]; 4] = [[6, 0, 1, 2], [0, 6, 3, 4], [1, 3, 6, 5], [2, 4, 5, 6]];
    TABLE[i][j]
}

/// The local vertices other than `i`, ascending.
#[inline]
pub(crate) const fn others(i: usize) -> [usize; 3] {
    [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]][i]
}

/// The local vertices other than `i`, counter-clockwise seen from outside a positively oriented tet.
pub(crate) const OUTWARD: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// A tetrahedral mesh as a cell complex. See the module page.
#[derive(Clone, Debug, Default)]
pub struct TetComplex {
    /// Number of vertex ids; the first ones are those of the request.
    pub n_vertices: usize,
    /// Vertices of the tets.
    pub tets: IdVec<TetId, [VertexId; 4]>,
    /// Edges of the tets.
    pub tet_edges: IdVec<TetId, [EdgeId; 6]>,
    /// Faces of the tets.
    pub tet_faces: IdVec<TetId, [FaceId; 4]>,
    /// Number of edges.
    pub n_edges: usize,
    /// Number of faces.
    pub n_faces: usize,
    /// Positions of all vertices, if known.
    pub points: Option<Vec<[f64; 3]>>,
}

impl TetComplex {
    /// The complex of tets in which an edge is its two vertices and a face its three. Tets are taken as positively
    /// oriented. Time n log n (one sort each for edges and faces).
    pub fn from_simplices(n_vertices: usize, tets: Vec<[VertexId; 4]>) -> Self {
        let (tet_edges, n_edges) = number(&tets, TET_EDGES);
        let (tet_faces, n_faces) = number(&tets, [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]]);
        Self { n_vertices, tets: tets.into(), tet_edges, tet_faces, n_edges, n_faces, points: None }
    }

    /// Per face: how many tets have it.
    pub fn face_degrees(&self) -> IdVec<FaceId, u8> {
        let mut degree = IdVec::filled(0u8, self.n_faces);
        for &f in self.tet_faces.iter().flatten() {
            degree[f] = u8::saturating_add(degree[f], 1);
        }
        degree
    }

    /// Per face: its vertices and edges, edge `k` opposite vertex `k`.
    pub fn faces(&self) -> IdVec<FaceId, ([VertexId; 3], [EdgeId; 3])> {
        let mut out = IdVec::filled(([VertexId(0); 3], [EdgeId(0); 3]), self.n_faces);
        for (t, tet) in self.tets.enumerate() {
            for i in 0..4 {
                let [a, b, c] = others(i);
                let edges = [tet_edge(b, c), tet_edge(a, c), tet_edge(a, b)].map(|e| self.tet_edges[t][e]);
                out[self.tet_faces[t][i]] = ([tet[a], tet[b], tet[c]], edges);
            }
        }
        out
    }

    /// Per edge: its ends.
    pub(crate) fn edge_ends(&self) -> IdVec<EdgeId, [VertexId; 2]> {
        let mut ends = IdVec::filled([VertexId(0); 2], self.n_edges);
        for (t, tet) in self.tets.enumerate() {
            for (k, &[i, j]) in TET_EDGES.iter().enumerate() {
                ends[self.tet_edges[t][k]] = [tet[i], tet[j]];
            }
        }
        ends
    }

    /// Matches the boundary with the triangles of a request: per triangle its face.
    ///
    /// # Errors
    /// [`ConstructError::TetBoundary`] if the boundary is anything but those triangles.
    pub fn match_boundary(&self, request: &TetRequest<'_>) -> Result<Vec<FaceId>, ConstructError> {
        fn err<T>(reason: TetMisfit) -> Result<T, ConstructError> {
            Err(ConstructError::TetBoundary { reason })
        }
        if self.n_vertices < request.n_vertices {
            return err(TetMisfit::TooFewVertices { given: self.n_vertices, needed: request.n_vertices });
        }
        let beyond = |&v: &VertexId| v.index() >= self.n_vertices;
        if let Some((tet, vertex)) =
            self.tets.enumerate().find_map(|(t, tet)| Some((t, tet.iter().copied().find(beyond)?)))
        {
            return err(TetMisfit::IndexOutOfRange { tet, vertex, limit: self.n_vertices });
        }
        let degree = self.face_degrees();
        if let Some((face, &given)) = degree.enumerate().find(|(_, d)| **d > 2) {
            return err(TetMisfit::CrowdedFace { face, given });
        }
        // Boundary faces as (sorted vertices, outward parity, face).
        let mut have: Vec<([VertexId; 3], [VertexId; 3], FaceId)> = Vec::new();
        for (t, tet) in self.tets.enumerate() {
            for (i, outward) in OUTWARD.iter().enumerate() {
                let f = self.tet_faces[t][i];
                if degree[f] == 1 {
                    let corners = outward.map(|k| tet[k]);
                    have.push((sorted(corners), smallest_first(corners), f));
                }
            }
        }
        have.sort_unstable();
        // Faces are named, so two may have the same vertices (an apex with two edges to one vertex); on the boundary
        // that would leave open which of them is meant.
        if let Some(w) = have.windows(2).find(|w| w[0].0 == w[1].0) {
            return err(TetMisfit::DoubleFace { vertices: w[0].0 });
        }
        if have.len() != request.triangles.len() {
            return err(TetMisfit::TrianglesCount { given: have.len(), needed: request.triangles.len() });
        }
        request
            .triangles
            .iter()
            .map(|&t| match have.binary_search_by_key(&sorted(t), |h| h.0) {
                Ok(i) if have[i].1 == smallest_first(t) => Ok(have[i].2),
                Ok(_) => err(TetMisfit::WrongSide { vertices: t }),
                Err(_) => err(TetMisfit::MissingTriangle { vertices: t }),
            })
            .collect()
    }
}

pub(crate) fn sorted<T: Ord, const N: usize>(mut all: [T; N]) -> [T; N] {
    all.sort_unstable();
    all
}

fn smallest_first(mut t: [VertexId; 3]) -> [VertexId; 3] {
    while t[0] > t[1] || t[0] > t[2] {
        t.rotate_left(1);
    }
    t
}

/// Numbers the sub-simplices with `K` vertices by vertex set, in sorted order.
fn number<I: Id, const K: usize, const N: usize>(
    tets: &[[VertexId; 4]],
    table: [[usize; K]; N],
) -> (IdVec<TetId, [I; N]>, usize) {
    let mut keys: Vec<([VertexId; K], u32)> = Vec::with_capacity(N * tets.len());
    for (t, tet) in tets.iter().enumerate() {
        for (k, local) in table.iter().enumerate() {
            keys.push((sorted(local.map(|i| tet[i])), (N * t + k) as u32));
        }
    }
    keys.sort_unstable();
    let mut ids = vec![[I::at(0); N]; tets.len()];
    let mut n = 0usize;
    for i in 0..keys.len() {
        n += usize::from(i == 0 || keys[i].0 != keys[i - 1].0);
        let at = keys[i].1 as usize;
        ids[at / N][at % N] = I::at(n - 1);
    }
    (ids.into(), n)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_tet_has_its_outward_boundary() {
        let t = TetComplex::from_simplices(4, vec![[0, 1, 2, 3].map(VertexId)]);
        assert_eq!((t.n_edges, t.n_faces), (6, 4));
        // v0 origin, v1 x, v2 y, v3 z: the face opposite v0 faces away from the origin as 1 2 3.
        let triangles = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]].map(|t| t.map(VertexId));
        let request = TetRequest { n_vertices: 4, triangles: &triangles, points: None };
        assert_eq!(t.match_boundary(&request).unwrap().len(), 4);
        let inward = triangles.map(|[a, b, c]| [a, c, b]);
        let request = TetRequest { n_vertices: 4, triangles: &inward, points: None };
        assert!(matches!(t.match_boundary(&request), Err(ConstructError::TetBoundary { .. })));
        for (k, [i, j]) in TET_EDGES.into_iter().enumerate() {
            assert_eq!((tet_edge(i, j), tet_edge(j, i)), (k, k));
        }
    }
}
