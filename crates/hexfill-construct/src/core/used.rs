//! The vertices that triangles use, numbered without gaps: what a mesher of points must not see more of.
//!
//! Source: ours.

use super::request::TetRequest;
use hexfill_geometry::Vector;
use hexfill_mesh::VertexId;

/// The vertices that the triangles of a request use, in their own numbers.
pub(super) struct Used {
    /// Per own number the vertex of the request, ascending.
    pub(super) vertices: Vec<VertexId>,
    /// The triangles in own numbers.
    pub(super) triangles: Vec<[VertexId; 3]>,
    /// Vertices of the request.
    n_vertices: usize,
}

impl Used {
    pub(super) fn of(request: &TetRequest<'_>) -> Self {
        let mut vertices: Vec<VertexId> = request.triangles.iter().flatten().copied().collect();
        vertices.sort_unstable();
        vertices.dedup();
        let mut number = vec![VertexId::NONE; request.n_vertices];
        for (i, v) in vertices.iter().enumerate() {
            number[v.index()] = VertexId::new(i);
        }
        let triangles = request.triangles.iter().map(|t| t.map(|v| number[v.index()])).collect();
        Self { vertices, triangles, n_vertices: request.n_vertices }
    }

    /// Their positions.
    pub(super) fn points(&self, points: &[Vector]) -> Vec<Vector> {
        self.vertices.iter().map(|v| points[v.index()]).collect()
    }

    /// The vertex of an own number; larger numbers are new vertices, which follow those of the request.
    pub(super) fn back(&self, v: VertexId) -> VertexId {
        match self.vertices.get(v.index()) {
            Some(&old) => old,
            None => VertexId::new(self.n_vertices + v.index() - self.vertices.len()),
        }
    }
}
