//! [`RegionsError`].

use crate::fill::error::FillError;
use crate::problem::ProblemError;
use hexfill_mesh::{Edge, HexId, Offenders, QuadId};

/// Why regions cannot be told or filled.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RegionsError {
    /// Faces that are not quads, points that are not finite, a boundary that is no surface.
    #[error(transparent)]
    Problem(#[from] ProblemError),
    /// An edge of one face only.
    #[error(
        "{name}: {} non-manifold edges, each in three or more quads: {shared}; they could be walls between regions, but walls end at {} edges: {edges}; close the walls, or split the surface",
        shared.count, edges.count
    )]
    Open {
        /// The input.
        name: String,
        /// The edges of one face.
        edges: Offenders<Edge>,
        /// The edges of more than two.
        shared: Offenders<Edge>,
    },
    /// A face with the same region on both sides.
    #[error("{name}: {} faces have the same region on both sides: {quads}; remove them, or close the walls they belong to", quads.count)]
    Baffle {
        /// The input.
        name: String,
        /// The faces, in the order of the file.
        quads: Offenders<QuadId>,
    },
    /// Hexes whose corners are listed in mirrored order: the void would be looked for on their wrong side.
    #[error("{name}: hexes of the file are inside out ({}): {hexes}; mirror the order of their corners", hexes.count)]
    InsideOut {
        /// The input.
        name: String,
        /// The hexes.
        hexes: Offenders<HexId>,
    },
    /// A region cannot be filled.
    #[error("region {region}: {source}")]
    Fill {
        /// Its number, from 1.
        region: usize,
        /// Why.
        source: FillError,
    },
    /// Hexes on both sides of a wall share too much, whatever was tried.
    #[error("the fillings of the regions do not fit together: {rules}; refine the walls")]
    DoNotFit {
        /// The rules of the judge that fail.
        rules: String,
    },
}
