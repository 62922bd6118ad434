//! What can be wrong with a request for coordinates.

use hexfill_mesh::{Offenders, QuadId, VertexId};

/// Why no coordinates can even be looked for. Not finding a valid embedding is not an error: the report says so.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EmbedError {
    /// The mesh has no hex.
    #[error("the mesh has no hexes; there is nothing to embed")]
    NoHexes,
    /// The mesh has no boundary quad.
    #[error("the mesh has no boundary: a closed 3-manifold has no embedding in space")]
    NoBoundary,
    /// Boundary vertices without a position.
    #[error(
        "{} boundary vertices have no position: {vertices}; {given} positions were given, one for each vertex id up to {limit} is needed",
        vertices.count
    )]
    MissingPositions {
        /// The vertices.
        vertices: Offenders<VertexId>,
        /// Number of positions given.
        given: usize,
        /// The largest boundary vertex id.
        limit: usize,
    },
    /// A position that is infinite or not a number.
    #[error("{} vertices have a coordinate that is not finite: {vertices}; repair the file", vertices.count)]
    NotFinite {
        /// The vertices.
        vertices: Offenders<VertexId>,
    },
    /// The boundary has no extent that floating point can work with.
    #[error(
        "the boundary spans {given:e} in its widest direction; at least {limit:e} is needed (are all points the same?): scale the input"
    )]
    NoExtent {
        /// The widest extent.
        given: f64,
        /// The least that can be worked with.
        limit: f64,
    },
    /// A start of the wrong length.
    #[error("the start has {given} points, the mesh {limit} vertices; give one point per vertex")]
    StartLength {
        /// Points given.
        given: usize,
        /// Vertices of the mesh.
        limit: usize,
    },
    /// A canonical polyhedron exists for spheres only.
    #[error("the surface is not one sphere ({components} components, genus {genus}): it has no canonical polyhedron")]
    NotASphere {
        /// Number of components.
        components: usize,
        /// Sum of the genera.
        genus: u64,
    },
    /// A canonical polyhedron exists for 3-connected surfaces only.
    #[error(
        "the surface is not 3-connected: quads {first} and {second} share vertices {a} and {b} but no edge {a}-{b}; it is the surface of no convex polyhedron"
    )]
    NotThreeConnected {
        /// A quad.
        first: QuadId,
        /// Another quad.
        second: QuadId,
        /// A vertex both have.
        a: VertexId,
        /// Another vertex both have.
        b: VertexId,
    },
    /// The circle packing did not converge.
    #[error(
        "the circle packing stopped at angle error {given:e}, above {limit:e}: the surface is too large or too uneven for double precision"
    )]
    NotConverged {
        /// The error reached.
        given: f64,
        /// The error wanted.
        limit: f64,
    },
    /// The number of worker threads could not be had.
    #[error("could not start {given} threads")]
    Threads {
        /// The number asked for.
        given: usize,
    },
}
