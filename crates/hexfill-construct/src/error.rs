//! Why a surface is not filled.

use crate::cells::pattern::Pattern;
use hexfill_mesh::{Edge, HexMeshError, ImproperPair, Offenders, StopReason};

/// Why there is no construction.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ConstructError {
    /// The number of quads is odd.
    #[error("the surface has {given} quads, an odd number: every hex mesh has an even number of boundary quads")]
    OddQuads {
        /// Number of quads.
        given: usize,
    },
    /// A component and the cavities in it have an odd number of quads together: no hex mesh exists, even if the
    /// whole surface has an even number.
    #[error(
        "component {component} with its cavities has {given} quads, an odd number: every hex mesh of a connected solid has an even number"
    )]
    OddComponent {
        /// The component with the smallest quad.
        component: usize,
        /// The number of quads.
        given: usize,
    },
    /// Two components of a solid have odd numbers of quads and no chain of hexes was found that joins them.
    #[error(
        "components {components:?} have odd numbers of quads and could not be joined by a chain of hexes: {reason}"
    )]
    OddJoin {
        /// The components.
        components: [usize; 2],
        /// What went wrong.
        reason: String,
    },
    /// Quads that share too much, so that no proper hex mesh has them in its boundary.
    #[error("{} pairs of quads share more than a vertex or an edge: {pairs}; split these quads", pairs.count)]
    ImproperQuads {
        /// The pairs.
        pairs: Offenders<ImproperPair>,
    },
    /// An odd cycle of surface edges bounds a surface in the interior.
    #[error("an odd cycle of {} edges bounds inside, so no hex mesh exists: {edges}", edges.count)]
    OddCycleBounds {
        /// The first edges; the whole cycle is in `cycle`.
        edges: Offenders<Edge>,
        /// The whole cycle, sorted.
        cycle: Vec<Edge>,
    },
    /// Tetrahedra of the interior are needed and not at hand.
    #[error("tetrahedra of the interior are needed (genus {genus}, {components} component(s)): {reason}")]
    InteriorNeeded {
        /// Sum of the genera.
        genus: u64,
        /// Number of components.
        components: usize,
        /// What was missing or went wrong.
        reason: String,
    },
    /// The tetrahedra do not fill the inner surface that was asked for.
    #[error("the tetrahedra do not have the boundary that was asked for: {reason}")]
    TetBoundary {
        /// What differs.
        reason: String,
    },
    /// The positions are not one a vertex.
    #[error("{given} positions given for {needed} vertices")]
    Points {
        /// Number of positions.
        given: usize,
        /// Number of vertices.
        needed: usize,
    },
    /// No cell for a pattern.
    #[error("the cell library has no cell for pattern {pattern}")]
    NoCell {
        /// The pattern.
        pattern: Pattern,
    },
    /// The mesh would exceed the id types.
    #[error("{given} {what} needed, the limit is {limit}; split the surface")]
    TooLarge {
        /// What is too many.
        what: &'static str,
        /// How many are needed.
        given: usize,
        /// How many are allowed.
        limit: usize,
    },
    /// The assembled hexes break rule R1: a cell or tetrahedra given are at fault.
    #[error("the assembled hexes are not a mesh: {0}")]
    Mesh(#[from] HexMeshError),
    /// The work was told to stop.
    #[error("stopped before the mesh was complete: {0:?}")]
    Stopped(StopReason),
}
