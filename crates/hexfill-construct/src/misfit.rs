//! [`TetMisfit`]: how tetrahedra differ from what was asked for.
//!
//! Source: ours.

use crate::ids::{FaceId, TetId};
use hexfill_mesh::{QuadId, VertexId};

/// Why tetrahedra do not fill the inner surface that was asked for. Indices count from 0 and are those of the tetrahedra given.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TetMisfit {
    /// Vertices of the surface are not there.
    #[error("{given} vertices given, at least {needed} needed")]
    TooFewVertices {
        /// How many there are.
        given: usize,
        /// How many the surface has.
        needed: usize,
    },
    /// A vertex index is too large.
    #[error("tetrahedron {} uses vertex index {} of {limit}", tet.0, vertex.0)]
    IndexOutOfRange {
        /// The tetrahedron.
        tet: TetId,
        /// The vertex.
        vertex: VertexId,
        /// Number of vertices.
        limit: usize,
    },
    /// Not four different vertices.
    #[error("tetrahedron {} uses a vertex twice", tet.0)]
    RepeatedVertex {
        /// The tetrahedron.
        tet: TetId,
    },
    /// The positions are not one a vertex.
    #[error("{given} positions given for {needed} vertices")]
    PositionsCount {
        /// Number of positions.
        given: usize,
        /// Number of vertices.
        needed: usize,
    },
    /// A face with too many tetrahedra.
    #[error("face {} is in {given} tetrahedra", face.0)]
    CrowdedFace {
        /// The face.
        face: FaceId,
        /// In how many it is.
        given: u8,
    },
    /// Two faces of the boundary where one is asked for.
    #[error("two boundary faces have the vertices {:?}", vertices.map(|v| v.0))]
    DoubleFace {
        /// Their vertices, ascending.
        vertices: [VertexId; 3],
    },
    /// Another number of triangles on the boundary.
    #[error("{given} boundary triangles given, {needed} asked for")]
    TrianglesCount {
        /// How many the boundary has.
        given: usize,
        /// How many it was to have.
        needed: usize,
    },
    /// A triangle bounds a tetrahedron on its outer side.
    #[error("triangle {:?} has its tetrahedron on the wrong side", vertices.map(|v| v.0))]
    WrongSide {
        /// Its vertices, counter-clockwise seen from outside.
        vertices: [VertexId; 3],
    },
    /// A triangle that is not on the boundary.
    #[error("triangle {:?} is missing", vertices.map(|v| v.0))]
    MissingTriangle {
        /// Its vertices, counter-clockwise seen from outside.
        vertices: [VertexId; 3],
    },
    /// A face named for a triangle has other vertices.
    #[error("face {} has other vertices than its triangle", face.0)]
    OtherFace {
        /// The face.
        face: FaceId,
    },
    /// The dual surface does not meet a quad's inner facet as the layer does.
    #[error("Sigma disagrees with the inner facet of quad {}", quad.0)]
    SigmaAtBoundary {
        /// The quad.
        quad: QuadId,
    },
    /// The cut edges of a tetrahedron are not 0, 3 or 4 that separate its vertices.
    #[error("Sigma is no surface in tetrahedron {}", tet.0)]
    SigmaInside {
        /// The tetrahedron.
        tet: TetId,
    },
    /// tetgen lost vertices.
    #[error("tetgen returned {given} vertices of {needed}")]
    TetgenVertices {
        /// How many it returned.
        given: usize,
        /// How many it was given.
        needed: usize,
    },
    /// tetgen changed the boundary in spite of its option.
    #[error("tetgen did not keep {missing} of {triangles} triangles: it split or flipped the boundary")]
    TetgenBoundary {
        /// How many are missing.
        missing: usize,
        /// How many were given.
        triangles: usize,
    },
    /// tetgen filled the other side.
    #[error("tetgen left the inner side of triangle {:?} empty: does it face inward?", vertices.map(|v| v.0))]
    TetgenEmptySide {
        /// The triangle's vertices.
        vertices: [VertexId; 3],
    },
}
