//! Why a surface is not filled.

use crate::cells::pattern::Pattern;
use crate::joins::no_chain::NoChain;
use crate::misfit::TetMisfit;
use crate::missing::MissingInterior;
use crate::surface::existence::Existence;
use hexfill_mesh::{HexMeshError, StopReason};

/// Why there is no construction.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ConstructError {
    /// A theorem forbids every mesh of the surface.
    #[error("no hex mesh exists: {0}")]
    NoMesh(Existence),
    /// Two components of a solid have odd numbers of quads and no chain of hexes was found that joins them.
    #[error(
        "components {components:?} have odd numbers of quads and could not be joined by a chain of hexes: {reason}"
    )]
    OddJoin {
        /// The components.
        components: [usize; 2],
        /// What went wrong.
        reason: NoChain,
    },
    /// Tetrahedra of the interior are needed and not at hand.
    #[error("tetrahedra of the interior are needed (genus {genus}, {components} component(s)): {reason}")]
    InteriorNeeded {
        /// Sum of the genera.
        genus: u64,
        /// Number of components.
        components: usize,
        /// What was missing or went wrong.
        reason: MissingInterior,
    },
    /// The tetrahedra do not fill the inner surface that was asked for.
    #[error("the tetrahedra do not have the boundary that was asked for: {reason}")]
    TetBoundary {
        /// What differs.
        reason: TetMisfit,
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
