//! Tetrahedra made elsewhere, made to fit the layer: no edge of theirs may join the two odd corners of a quad.
//!
//! The layer's inner facet of a quad is two triangles, and the proof that cells and core meet properly (book, page
//! `construction`, "Why the result is proper", 2) needs a tet to meet them in one simplex.
//!
//! Source: ours (book, page `construction`, "Why the result is proper").

use super::complex::{TET_EDGES, TetComplex};
use super::request::TetRequest;
use hexfill_geometry::{Vector, midpoint};
use hexfill_mesh::VertexId;
use std::collections::{BTreeMap, BTreeSet};

/// The complex of tets made elsewhere: inner vertices without a tet are dropped, and edges that join the two odd corners
/// of a quad are split in the middle.
///
/// Such an edge would make a tet meet the quad's inner facet in more than one simplex (both triangles of a bent quad may even
/// belong to one tet), and a hex at one of its corners two quads of one cell: improper. Without it, tets that form a
/// simplicial complex meet each inner facet in one simplex.
pub(crate) fn fitted(
    request: &TetRequest<'_>,
    n_vertices: usize,
    mut tets: Vec<[VertexId; 4]>,
    mut points: Option<Vec<Vector>>,
) -> TetComplex {
    let pairs: BTreeSet<[VertexId; 2]> =
        request.triangles.chunks_exact(2).map(|t| [t[0][1].min(t[1][1]), t[0][1].max(t[1][1])]).collect();
    let edges = |tet: &[VertexId; 4]| TET_EDGES.map(|[i, j]| [tet[i].min(tet[j]), tet[i].max(tet[j])]);
    // Tets by edge to be split; a split makes new tets with the other such edges of the old one.
    let mut around: BTreeMap<[VertexId; 2], Vec<usize>> = BTreeMap::new();
    for (t, tet) in tets.iter().enumerate() {
        for edge in edges(tet).into_iter().filter(|e| pairs.contains(e)) {
            around.entry(edge).or_default().push(t);
        }
    }
    let mut n_vertices = n_vertices;
    // In the order of vertex ids, so that the same tets give the same points. It ends: a split makes no new edge
    // between old vertices, so the list of edges only gets shorter.
    while let Some((edge, ring)) = around.pop_first() {
        let middle = VertexId::new(n_vertices);
        n_vertices += 1;
        if let Some(p) = &mut points {
            let [a, b] = edge.map(|v| p[v.index()]);
            p.push(midpoint(a, b));
        }
        for t in ring {
            let old = tets[t];
            // Listed before another split took the edge away from this tet.
            if !edge.iter().all(|v| old.contains(v)) {
                continue;
            }
            let [one, other] = edge.map(|v| old.map(|x| if x == v { middle } else { x }));
            tets[t] = one;
            tets.push(other);
            for e in edges(&other).into_iter().filter(|e| pairs.contains(e)) {
                around.entry(e).or_default().push(tets.len() - 1);
            }
        }
    }
    // Vertices of the request stay whether used or not: their ids are the surface's.
    let mut used = vec![false; n_vertices];
    used[..request.n_vertices.min(n_vertices)].fill(true);
    tets.iter().flatten().for_each(|v| used[v.index()] = true);
    let mut number = vec![VertexId::NONE; n_vertices];
    let mut next = 0;
    for (number, _) in number.iter_mut().zip(&used).filter(|u| *u.1) {
        *number = VertexId::new(next);
        next += 1;
    }
    tets.iter_mut().flatten().for_each(|v| *v = number[v.index()]);
    let mut complex = TetComplex::from_simplices(next, tets);
    complex.points = points.map(|p| p.into_iter().zip(&used).filter(|u| *u.1).map(|(p, _)| p).collect());
    complex
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tet_on_both_triangles_of_a_quad_is_split() {
        // One tet over the quad 0 1 2 3 (diagonal 0 2), and a vertex that no tet uses.
        let triangles = [[0, 1, 2], [2, 3, 0]].map(|t| t.map(VertexId));
        let request = TetRequest { n_vertices: 4, triangles: &triangles, points: None };
        let complex = fitted(&request, 5, vec![[0, 1, 3, 2].map(VertexId)], None);
        assert_eq!((complex.n_vertices, complex.tets.len(), complex.n_faces), (5, 2, 7));
        assert!(complex.tets.iter().all(|t| !(t.contains(&VertexId(1)) && t.contains(&VertexId(3)))));
    }
}
