//! [`NoChain`]: why two odd components were not joined.
//!
//! Source: ours.

use hexfill_mesh::SurfaceError;

/// Why no chain of hexes joins two components with odd numbers of quads.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoChain {
    /// Every way of tetrahedra crosses that of a pair joined before.
    #[error("earlier chains bar the way")]
    Barred,
    /// The tetrahedra between them hold no hexes that follow each other.
    #[error("no hexes of the core lie between them")]
    NoHexes,
    /// The boundary of cubes and chain is no surface.
    #[error("{0}")]
    Surface(#[from] SurfaceError),
    /// The boundary of cubes and chain is a surface and no sphere, or faces inward in part.
    #[error("the chains found touch themselves")]
    TouchesItself,
    /// The sphere has quads that no proper mesh allows.
    #[error("the chains found have quads that share too much")]
    Improper,
}
