//! [`ProblemError`]: why there is no problem to work on.

use crate::problem::catalog;
use hexfill_io::ReadError;
use hexfill_mesh::{Offenders, SignatureError, SurfaceError, VertexId};

/// Why there is no problem to work on. All are the input's fault.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProblemError {
    /// The file cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The faces are no closed quad surface.
    #[error("{name}: {source}")]
    Surface {
        /// The input.
        name: String,
        /// What is wrong.
        source: SurfaceError,
    },
    /// The faces leave seams open: points in one spot that are not one point.
    #[error("{name}: {source}; welding closes it: merge points at most {tolerance} apart (--weld {tolerance})")]
    Seams {
        /// The input.
        name: String,
        /// What is open.
        source: SurfaceError,
        /// The least tolerance (rounded up) at which welding closes the surface.
        tolerance: f64,
    },
    /// The file has cells of higher order.
    #[error(
        "{name} has cells of higher order, {points} points lie between their corners; read it as straight ones (--linearise)"
    )]
    HigherOrder {
        /// The input.
        name: String,
        /// Points that are no corners.
        points: usize,
    },
    /// Ids that only a huge table could hold.
    #[error(
        "{name}: the largest vertex id is {largest}, with {faces} faces; number the vertices from 0 without large gaps"
    )]
    SparseIds {
        /// The input.
        name: String,
        /// The largest id.
        largest: usize,
        /// Number of faces.
        faces: usize,
    },
    /// The file has no faces at all.
    #[error("{name} has no faces{}; give a closed surface of quads", if *hexes > 0 { format!(" ({hexes} hexes: is it a mesh? then use `hexfill check`)") } else { String::new() })]
    NoFaces {
        /// The input.
        name: String,
        /// Hexes in the file.
        hexes: usize,
    },
    /// No such catalogue entry.
    #[error("no problem is called {given}; known are {}", catalog::names().collect::<Vec<_>>().join(", "))]
    UnknownName {
        /// What was asked for.
        given: String,
    },
    /// Not a signature.
    #[error("{given}: {source}")]
    Signature {
        /// What was given.
        given: String,
        /// What is wrong.
        source: SignatureError,
    },
    /// Not one position for each vertex.
    #[error("{name}: {given} points for {needed} vertices; give one for each vertex id")]
    PointCount {
        /// The input.
        name: String,
        /// Points given.
        given: usize,
        /// Vertices of the surface.
        needed: usize,
    },
    /// Vertices of one quad that lie on one spot are fine for topology, but non-finite positions are not.
    #[error("{name}: {} points are not finite: {points}", points.count)]
    NotFinite {
        /// The input.
        name: String,
        /// The points.
        points: Offenders<VertexId>,
    },
}
