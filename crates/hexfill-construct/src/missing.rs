//! [`MissingInterior`]: why nobody could say what the inside of a surface is.

use hexfill_mesh::{QuadId, VertexId};

/// Why tetrahedra of an interior are not at hand. Displayed as a clause that says what to do where something can be done.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MissingInterior {
    /// Cutting along disks needs positions.
    #[error("without positions nothing tells which loops bound inside; give positions or tetrahedra")]
    NoPositions,
    /// Delaunay tetrahedra need positions.
    #[error("Delaunay tetrahedra need positions; give tetrahedra, or install tetgen")]
    NoPositionsForDelaunay,
    /// tetgen needs positions.
    #[error("tetgen needs positions")]
    NoPositionsForTetgen,
    /// Some vertices have no position, or there is nothing to fill.
    #[error("one position a vertex is needed; give tetrahedra, or install tetgen")]
    PositionsCount,
    /// A coordinate is infinite, not a number, or beyond 1e60.
    #[error("the position of vertex {} is not a number or too large; give tetrahedra, or install tetgen", vertex.0)]
    PositionNotFinite {
        /// The vertex.
        vertex: VertexId,
    },
    /// Two vertices at one place.
    #[error("vertices {} and {} are at the same place; give tetrahedra, or install tetgen", vertices[0].0, vertices[1].0)]
    SamePlace {
        /// The vertices, ascending.
        vertices: [VertexId; 2],
    },
    /// A triangle without area.
    #[error("half of quad {} has no area, so no tetrahedron stands on it; give tetrahedra, or install tetgen", quad.0)]
    NoArea {
        /// The quad it is half of.
        quad: QuadId,
    },
    /// The triangles given are not closed: a number of sides that is odd.
    #[error("a triangle has a free side; give tetrahedra, or install tetgen")]
    FreeSide,
    /// The triangles given are not closed here.
    #[error("edge {:?} is not in two triangles; give tetrahedra, or install tetgen", vertices.map(|v| v.0))]
    OpenEdge {
        /// The ends of the edge.
        vertices: [VertexId; 2],
    },
    /// Points kept being needed on the surface.
    #[error(
        "the surface meets itself or nearly does: recovering it took too many points; give tetrahedra, or install tetgen"
    )]
    TooManyPoints,
    /// A point of one part of the surface fell on another.
    #[error("the surface meets itself: two of its points coincide; give tetrahedra, or install tetgen")]
    PointsCoincide,
    /// What is inside of one face is outside of another.
    #[error(
        "the surface meets itself or faces inward: its sides contradict each other; give tetrahedra, or install tetgen"
    )]
    SidesContradict,
    /// Points added to the surface stayed there.
    #[error("{given} points could not be taken off the boundary; give tetrahedra, or install tetgen")]
    PointsOnBoundary {
        /// How many.
        given: usize,
    },
    /// Linking numbers need a finite position of every vertex.
    #[error("the positions are missing or not finite")]
    PositionsMissing,
    /// A loop cannot be pushed off a face without a normal.
    #[error("the corners of a face lie on a line, so that the positions do not tell the inside; see `hexfill doctor`")]
    FaceWithoutNormal,
    /// Linking numbers came out between whole numbers.
    #[error("linking numbers are not whole: the surface is degenerate or meets itself")]
    LinkingNotWhole,
    /// Linking numbers and intersections of loops do not go together.
    #[error("linking numbers contradict the intersections of loops: the surface meets itself")]
    LinkingAgainstIntersections,
    /// The linking numbers do not have half the rank of the loops.
    #[error("linking numbers contradict Alexander duality: the surface meets itself")]
    LinkingAgainstDuality,
    /// An outer component is turned inside out.
    #[error("component {component} is the outside of a solid and faces inward: reverse its quads")]
    OutsideFacesInward {
        /// The component, from 0.
        component: usize,
    },
    /// A cavity is turned inside out.
    #[error("component {component} is a cavity and faces outward: reverse its quads")]
    CavityFacesOutward {
        /// The component, from 0.
        component: usize,
    },
    /// A cavity of nothing.
    #[error("component {component} is in no solid: components meet each other")]
    InNoSolid {
        /// The component, from 0.
        component: usize,
    },
    /// More handles than the search for disks can tell apart.
    #[error("more than 32 handles: give tetrahedra of the interior")]
    TooManyHandles,
    /// No disk cuts a handle.
    #[error("no loop was found that could bound a disk inside: the interior is no handlebody; give tetrahedra")]
    NoHandlebody,
    /// A file or process of tetgen could not be reached.
    #[error("{at}: {error}")]
    TetgenIo {
        /// The path or program.
        at: String,
        /// What the system says.
        error: String,
    },
    /// tetgen could not be started.
    #[error("{program}: {error}; install tetgen or give tetrahedra")]
    TetgenNotStarted {
        /// The program.
        program: String,
        /// What the system says.
        error: String,
    },
    /// tetgen ended with an error.
    #[error("{program} failed ({status}); tetgen ends like this where the surface meets itself or nearly does: {said}")]
    TetgenFailed {
        /// The program.
        program: String,
        /// How it ended.
        status: String,
        /// The end of what it printed.
        said: String,
    },
    /// tetgen left no answer, or one that cannot be read.
    #[error("{program} ended without an error, but {what}: is it tetgen?")]
    TetgenAnswer {
        /// The program.
        program: String,
        /// What is wrong with the answer.
        what: String,
    },
    /// What a maker of the caller's own says.
    #[error("{0}")]
    Other(String),
}
