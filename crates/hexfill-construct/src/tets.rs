//! Step 5: tetrahedra of the core as a complex of cells, and who can provide them.
//!
//! A [`TetComplex`] names its edges and faces itself, so two edges may join the same two vertices (a handlebody cut
//! along disks has such edges). Invariant: local edge `k` of a tet joins its vertices [`TET_EDGES`]`[k]`, local face `i`
//! is opposite its vertex `i`, and every tet is positively oriented (vertices 1, 2, 3 counter-clockwise seen from 0 are
//! clockwise; that is, det(v1-v0, v2-v0, v3-v0) > 0 in an embedding).

use crate::error::ConstructError;
use hexfill_mesh::Context;

/// Ends of the six local edges of a tet.
pub const TET_EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// The local edge between local vertices `i` and `j`.
#[inline]
pub const fn tet_edge(i: usize, j: usize) -> usize {
    const TABLE: [[usize; 4]; 4] = [[6, 0, 1, 2], [0, 6, 3, 4], [1, 3, 6, 5], [2, 4, 5, 6]];
    TABLE[i][j]
}

/// What the tetrahedra have to fill: the triangulated inner copy of the surface.
#[derive(Clone, Debug)]
pub struct TetRequest<'a> {
    /// Number of vertex ids (those of the surface).
    pub n_vertices: usize,
    /// The triangles, outward; triangles `2 q` and `2 q + 1` share the diagonal of quad `q`.
    pub triangles: &'a [[u32; 3]],
    /// Positions of the vertices, if the surface has any.
    pub points: Option<&'a [[f64; 3]]>,
}

impl TetRequest<'_> {
    /// Per triangle its component, numbered by smallest triangle, and how many there are.
    pub fn components(&self) -> (Vec<usize>, usize) {
        let mut root: Vec<u32> = (0..self.n_vertices as u32).collect();
        for t in self.triangles {
            for k in 0..2 {
                let (a, b) = (find(&mut root, t[k]), find(&mut root, t[k + 1]));
                root[a.max(b) as usize] = a.min(b);
            }
        }
        let mut number = vec![usize::MAX; self.n_vertices];
        let mut n = 0;
        let of = |t: &[u32; 3]| {
            let slot = &mut number[find(&mut root, t[0]) as usize];
            if *slot == usize::MAX {
                *slot = n;
                n += 1;
            }
            *slot
        };
        let components = self.triangles.iter().map(of).collect();
        (components, n)
    }

    /// Sum of the genera of the components, and how many components there are.
    pub fn shape(&self) -> (u64, usize) {
        let (_, components) = self.components();
        let mut used = vec![false; self.n_vertices];
        self.triangles.iter().flatten().for_each(|&v| used[v as usize] = true);
        let vertices = used.iter().filter(|&&u| u).count() as i64;
        let euler = vertices - self.triangles.len() as i64 / 2;
        (((2 * components as i64 - euler) / 2).max(0) as u64, components)
    }

    /// The error of a maker that cannot fill this request.
    pub fn interior_needed(&self, reason: impl Into<String>) -> ConstructError {
        let (genus, components) = self.shape();
        ConstructError::InteriorNeeded { genus, components, reason: reason.into() }
    }
}

pub(crate) fn find(root: &mut [u32], mut v: u32) -> u32 {
    while root[v as usize] != v {
        root[v as usize] = root[root[v as usize] as usize];
        v = root[v as usize];
    }
    v
}

/// A tetrahedral mesh as a cell complex. See the module page.
#[derive(Clone, Debug, Default)]
pub struct TetComplex {
    /// Number of vertex ids; the first ones are those of the request.
    pub n_vertices: usize,
    /// Vertices of the tets.
    pub tets: Vec<[u32; 4]>,
    /// Edges of the tets.
    pub tet_edges: Vec<[u32; 6]>,
    /// Faces of the tets.
    pub tet_faces: Vec<[u32; 4]>,
    /// Number of edges.
    pub n_edges: usize,
    /// Number of faces.
    pub n_faces: usize,
    /// Positions of all vertices, if known.
    pub points: Option<Vec<[f64; 3]>>,
}

/// Provides tetrahedra inside a triangulated surface.
///
/// The boundary of what is returned must be exactly the triangles asked for (further vertices only inside). It is
/// compared with the request, always.
pub trait InteriorTets {
    /// A word for the report.
    fn name(&self) -> &'static str;

    /// Fills the surface.
    ///
    /// # Errors
    /// [`ConstructError::InteriorNeeded`] or [`ConstructError::TetBoundary`] with the reason.
    fn fill(&self, request: &TetRequest<'_>, ctx: &Context<'_>) -> Result<TetComplex, ConstructError>;
}

impl TetComplex {
    /// The complex of tets in which an edge is its two vertices and a face its three. Tets are taken as positively
    /// oriented. Time n log n (one sort each for edges and faces).
    pub fn from_simplices(n_vertices: usize, tets: Vec<[u32; 4]>) -> Self {
        let (tet_edges, n_edges) = number(&tets, TET_EDGES);
        let (tet_faces, n_faces) = number(&tets, [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]]);
        Self { n_vertices, tets, tet_edges, tet_faces, n_edges, n_faces, points: None }
    }

    /// Per face: how many tets have it.
    pub fn face_degrees(&self) -> Vec<u8> {
        let mut degree = vec![0u8; self.n_faces];
        for f in self.tet_faces.iter().flatten() {
            degree[*f as usize] = degree[*f as usize].saturating_add(1);
        }
        degree
    }

    /// Per face: its vertices and edges, edge `k` opposite vertex `k`.
    pub fn faces(&self) -> Vec<([u32; 3], [u32; 3])> {
        let mut out = vec![([0; 3], [0; 3]); self.n_faces];
        for (t, tet) in self.tets.iter().enumerate() {
            for i in 0..4 {
                let [a, b, c] = others(i);
                let edges = [tet_edge(b, c), tet_edge(a, c), tet_edge(a, b)].map(|e| self.tet_edges[t][e]);
                out[self.tet_faces[t][i] as usize] = ([tet[a], tet[b], tet[c]], edges);
            }
        }
        out
    }

    /// Matches the boundary with the triangles of a request: per triangle its face.
    ///
    /// # Errors
    /// [`ConstructError::TetBoundary`] if the boundary is anything but those triangles.
    pub fn match_boundary(&self, request: &TetRequest<'_>) -> Result<Vec<u32>, ConstructError> {
        fn err<T>(reason: String) -> Result<T, ConstructError> {
            Err(ConstructError::TetBoundary { reason })
        }
        if self.n_vertices < request.n_vertices {
            return err(format!("{} vertices given, at least {} needed", self.n_vertices, request.n_vertices));
        }
        if let Some(t) = self.tets.iter().position(|t| t.iter().any(|&v| v as usize >= self.n_vertices)) {
            return err(format!("tetrahedron {t} uses a vertex beyond the {} given", self.n_vertices));
        }
        let degree = self.face_degrees();
        if let Some(f) = degree.iter().position(|&d| d > 2) {
            return err(format!("face {f} is in {} tetrahedra", degree[f]));
        }
        let sorted = |mut t: [u32; 3]| {
            t.sort_unstable();
            t
        };
        // Boundary faces as (sorted vertices, outward parity, face).
        let mut have: Vec<([u32; 3], [u32; 3], u32)> = Vec::new();
        for (t, tet) in self.tets.iter().enumerate() {
            for (i, outward) in OUTWARD.iter().enumerate() {
                let f = self.tet_faces[t][i];
                if degree[f as usize] == 1 {
                    let [a, b, c] = outward.map(|k| tet[k]);
                    have.push((sorted([a, b, c]), smallest_first([a, b, c]), f));
                }
            }
        }
        have.sort_unstable();
        if let Some(w) = have.windows(2).find(|w| w[0].0 == w[1].0) {
            return err(format!("two boundary faces have the vertices {:?}", w[0].0));
        }
        if have.len() != request.triangles.len() {
            return err(format!("{} boundary triangles given, {} asked for", have.len(), request.triangles.len()));
        }
        request
            .triangles
            .iter()
            .map(|&t| match have.binary_search_by_key(&sorted(t), |h| h.0) {
                Ok(i) if have[i].1 == smallest_first(t) => Ok(have[i].2),
                Ok(_) => err(format!("triangle {t:?} has its tetrahedron on the wrong side")),
                Err(_) => err(format!("triangle {t:?} is missing")),
            })
            .collect()
    }
}

/// The local vertices other than `i`, ascending.
#[inline]
pub(crate) const fn others(i: usize) -> [usize; 3] {
    [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]][i]
}

/// The local vertices other than `i`, counter-clockwise seen from outside a positively oriented tet.
pub(crate) const OUTWARD: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

fn smallest_first(mut t: [u32; 3]) -> [u32; 3] {
    while t[0] > t[1] || t[0] > t[2] {
        t.rotate_left(1);
    }
    t
}

/// Numbers the sub-simplices with `K` vertices by vertex set, in sorted order.
fn number<const K: usize, const N: usize>(tets: &[[u32; 4]], table: [[usize; K]; N]) -> (Vec<[u32; N]>, usize) {
    let mut keys: Vec<([u32; K], u32)> = Vec::with_capacity(N * tets.len());
    for (t, tet) in tets.iter().enumerate() {
        for (k, local) in table.iter().enumerate() {
            let mut key = local.map(|i| tet[i]);
            key.sort_unstable();
            keys.push((key, (N * t + k) as u32));
        }
    }
    keys.sort_unstable();
    let mut ids = vec![[0u32; N]; tets.len()];
    let mut n = 0usize;
    for i in 0..keys.len() {
        n += usize::from(i == 0 || keys[i].0 != keys[i - 1].0);
        let at = keys[i].1 as usize;
        ids[at / N][at % N] = (n - 1) as u32;
    }
    (ids, n)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_tet_has_its_outward_boundary() {
        let t = TetComplex::from_simplices(4, vec![[0, 1, 2, 3]]);
        assert_eq!((t.n_edges, t.n_faces), (6, 4));
        // v0 origin, v1 x, v2 y, v3 z: the face opposite v0 faces away from the origin as 1 2 3.
        let triangles = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];
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
