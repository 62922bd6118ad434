//! A prism of three tets between a triangle of one component and a triangle of another.
//!
//! Source: ours.

use crate::surface::polygons::GonId;
use hexfill_mesh::VertexId;

/// A prism between a triangle of one component and a triangle of another. Its corners are numbered 0, 1, 2 on the one
/// and 3, 4, 5 on the other, 3 next to 0. Its six side triangles take the place of the two.
pub(super) struct Prism {
    /// The triangles of the sides.
    pub(super) sides: [GonId; 6],
    /// Vertices by corner.
    pub(super) vertices: [VertexId; 6],
}

/// The corners of a prism's sides, and of its tets (no cyclic choice of diagonals, so three tets fill it).
pub(super) const SIDES: [[usize; 3]; 6] = [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 5], [0, 3, 5]];
pub(super) const PRISM_TETS: [[usize; 4]; 3] = [[0, 1, 5, 2], [0, 1, 4, 5], [0, 3, 5, 4]];
