//! Quad surfaces and hex meshes as connectivity: ids, incidence, chords, sheets, canonical signatures.
//!
//! The data structures know no algorithm; an algorithm is a free function in a file of its own.
//! No floats and no files here: topology knows no positions.

mod context;
pub mod cube;
mod hexmesh;
mod ids;
mod surface;

pub use context::{Context, Progress, StopReason};
pub use hexmesh::{Facet, HexMesh, HexMeshError};
pub use ids::{Dart, Edge, HexId, Offenders, QuadId, VertexId};
pub use surface::{FaceSides, QuadSurface, SurfaceError};
