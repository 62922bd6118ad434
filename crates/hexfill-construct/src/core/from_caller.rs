//! Tetrahedra given by the caller.
//!
//! They must fill exactly the triangles of [`crate::core_triangles`]; the boundary is compared with the request by
//! the construction.
//!
//! Source: Erickson 2014, section 5, takes tetrahedra of the interior as given; so does this.

use super::complex::TetComplex;
use super::fit::fitted;
use super::maker::{Core, InteriorTets};
use super::request::TetRequest;
use crate::error::ConstructError;
use crate::ids::TetId;
use crate::misfit::TetMisfit;
use hexfill_geometry::tet_volume;
use hexfill_mesh::{Context, VertexId};

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
    fn core(&self) -> Core {
        Core::Given
    }

    fn fill(&self, request: &TetRequest<'_>, _ctx: &Context<'_>) -> Result<TetComplex, ConstructError> {
        let err = |reason| Err(ConstructError::TetBoundary { reason });
        for (t, corners) in self.tets.iter().enumerate() {
            let tet = TetId::new(t);
            if let Some(&v) = corners.iter().find(|&&v| v as usize >= self.n_vertices) {
                return err(TetMisfit::IndexOutOfRange { tet, vertex: VertexId(v), limit: self.n_vertices });
            }
            if (0..4).any(|i| corners[..i].contains(&corners[i])) {
                return err(TetMisfit::RepeatedVertex { tet });
            }
        }
        let mut tets: Vec<[VertexId; 4]> = self.tets.iter().map(|t| t.map(VertexId)).collect();
        if let Some(points) = &self.points {
            if points.len() != self.n_vertices {
                return err(TetMisfit::PositionsCount { given: points.len(), needed: self.n_vertices });
            }
            for tet in &mut tets {
                if tet_volume(tet.map(|v| points[v.index()])) < 0.0 {
                    tet.swap(2, 3);
                }
            }
        }
        Ok(fitted(request, self.n_vertices, tets, self.points.clone()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
