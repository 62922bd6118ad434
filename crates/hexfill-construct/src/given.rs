//! Tetrahedra given by the caller.
//!
//! They must fill exactly the triangles of [`crate::core_triangles`]; the boundary is compared with the request by
//! the construction.

use crate::error::ConstructError;
use crate::tets::{InteriorTets, TET_EDGES, TetComplex, TetRequest};
use crate::vector::volume;
use hexfill_mesh::Context;
use std::collections::{BTreeMap, BTreeSet};

/// A tetrahedral mesh given by the caller: the vertices of the surface first, with the same ids.
#[derive(Clone, Debug, Default)]
pub struct GivenTets {
    /// Number of vertices.
    pub n_vertices: usize,
    /// The tets, in any orientation if positions are given, else positively oriented.
    pub tets: Vec<[u32; 4]>,
    /// Positions of all vertices, if known.
    pub points: Option<Vec<[f64; 3]>>,
}

impl InteriorTets for GivenTets {
    fn name(&self) -> &'static str {
        "given"
    }

    fn fill(&self, request: &TetRequest<'_>, _ctx: &Context<'_>) -> Result<TetComplex, ConstructError> {
        let err = |reason: String| Err(ConstructError::TetBoundary { reason });
        for (t, tet) in self.tets.iter().enumerate() {
            if let Some(v) = tet.iter().find(|&&v| v as usize >= self.n_vertices) {
                return err(format!("tetrahedron {t} uses vertex index {v} of {}", self.n_vertices));
            }
            if (0..4).any(|i| tet[..i].contains(&tet[i])) {
                return err(format!("tetrahedron {t} uses a vertex twice"));
            }
        }
        let mut tets = self.tets.clone();
        if let Some(points) = &self.points {
            if points.len() != self.n_vertices {
                return err(format!("{} positions given for {} vertices", points.len(), self.n_vertices));
            }
            for tet in &mut tets {
                if volume(tet.map(|v| points[v as usize])) < 0.0 {
                    tet.swap(2, 3);
                }
            }
        }
        Ok(fitted(request, self.n_vertices, tets, self.points.clone()))
    }
}

/// The complex of tets made elsewhere: inner vertices without a tet are dropped, and edges that join the two odd corners
/// of a quad are split in the middle.
///
/// Such an edge would make a tet meet the quad's inner facet in more than one simplex (both triangles of a bent quad may even
/// belong to one tet), and a hex at one of its corners two quads of one cell: improper. Without it, tets that form a
/// simplicial complex meet each inner facet in one simplex.
pub(crate) fn fitted(
    request: &TetRequest<'_>,
    n_vertices: usize,
    mut tets: Vec<[u32; 4]>,
    mut points: Option<Vec<[f64; 3]>>,
) -> TetComplex {
    let pairs: BTreeSet<[u32; 2]> =
        request.triangles.chunks_exact(2).map(|t| [t[0][1].min(t[1][1]), t[0][1].max(t[1][1])]).collect();
    let edges = |tet: &[u32; 4]| TET_EDGES.map(|[i, j]| [tet[i].min(tet[j]), tet[i].max(tet[j])]);
    // Tets by edge to be split; a split makes new tets with the other such edges of the old one.
    let mut around: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
    for (t, tet) in tets.iter().enumerate() {
        for edge in edges(tet).into_iter().filter(|e| pairs.contains(e)) {
            around.entry(edge).or_default().push(t);
        }
    }
    let mut n_vertices = n_vertices;
    while let Some((edge, ring)) = around.pop_first() {
        let middle = n_vertices as u32;
        n_vertices += 1;
        if let Some(p) = &mut points {
            let [a, b] = edge.map(|v| p[v as usize]);
            p.push(std::array::from_fn(|k| (a[k] + b[k]) / 2.0));
        }
        for t in ring {
            let old = tets[t];
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
    let mut used = vec![false; n_vertices];
    used[..request.n_vertices.min(n_vertices)].fill(true);
    tets.iter().flatten().for_each(|&v| used[v as usize] = true);
    let mut number = vec![0u32; n_vertices];
    let mut next = 0;
    for (number, _) in number.iter_mut().zip(&used).filter(|u| *u.1) {
        *number = next;
        next += 1;
    }
    tets.iter_mut().flatten().for_each(|v| *v = number[*v as usize]);
    let mut complex = TetComplex::from_simplices(next as usize, tets);
    complex.points = points.map(|p| p.into_iter().zip(&used).filter(|u| *u.1).map(|(p, _)| p).collect());
    complex
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tet_on_both_triangles_of_a_quad_is_split() {
        // One tet over the quad 0 1 2 3 (diagonal 0 2), and a vertex that no tet uses.
        let triangles = [[0, 1, 2], [2, 3, 0]];
        let request = TetRequest { n_vertices: 4, triangles: &triangles, points: None };
        let complex = fitted(&request, 5, vec![[0, 1, 3, 2]], None);
        assert_eq!((complex.n_vertices, complex.tets.len(), complex.n_faces), (5, 2, 7));
        assert!(complex.tets.iter().all(|t| !(t.contains(&1) && t.contains(&3))));
    }

    #[test]
    fn bad_tetrahedra_are_refused() {
        let request = TetRequest { n_vertices: 4, triangles: &[], points: None };
        let fill =
            |tets: Vec<[u32; 4]>| GivenTets { n_vertices: 4, tets, points: None }.fill(&request, &Context::default());
        assert!(matches!(fill(vec![[0, 1, 2, 4]]), Err(ConstructError::TetBoundary { .. })));
        assert!(matches!(fill(vec![[0, 1, 2, 2]]), Err(ConstructError::TetBoundary { .. })));
        assert_eq!(fill(vec![[0, 1, 2, 3]]).unwrap().n_faces, 4);
    }
}
