//! Ids of the core and of the mesh that is made. Vertices of the surface and of the core are [`VertexId`](hexfill_mesh::VertexId)s:
//! the core's first ones are those of the surface.
//!
//! Source: ours.

use hexfill_mesh::id_type;

id_type!(
    /// A tetrahedron of the core (0-based).
    TetId, "t"
);
id_type!(
    /// An edge of the tetrahedra (0-based). Two edges may join the same two vertices.
    EdgeId, "e"
);
id_type!(
    /// A triangle of the tetrahedra (0-based).
    FaceId, "f"
);
id_type!(
    /// A vertex of the hex mesh (0-based): those of the surface first, with their own ids.
    PointId, "p"
);

impl PointId {
    /// The id `n` further on.
    #[inline]
    pub(crate) const fn plus(self, n: u32) -> Self {
        Self(self.0 + n)
    }
}
