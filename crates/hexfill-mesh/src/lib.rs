//! Quad surfaces and hex meshes as connectivity: ids, incidence, chords, sheets, canonical signatures.
//!
//! The data structures know no algorithm; an algorithm is a free function in a file of its own.
//! No floats and no files here: topology knows no positions.

mod bipartition;
mod chords;
mod context;
pub mod cube;
#[cfg(any(test, feature = "generate"))]
pub mod generate;
mod hexmesh;
mod ids;
mod improper;
mod key;
mod signature_text;
mod surface;
mod surface_code;
mod surface_signature;

pub use bipartition::{OddCycle, bipartition};
pub use chords::{Chord, chords, chords_by_quad};
pub use context::{Context, Progress, StopReason};
pub use hexmesh::{Facet, HexMesh, HexMeshError};
pub use ids::{Dart, Edge, HexId, Offenders, QuadId, VertexId};
pub use improper::{ImproperPair, improper_pairs, is_proper, is_three_connected};
pub use key::{Key, KeyError, key, key_of_chords};
pub use signature_text::SignatureError;
pub use surface::{FaceSides, QuadSurface, SurfaceError};
pub use surface_signature::{
    SurfaceAutomorphism, parse_surface_signature, surface_automorphisms, surface_isomorphism, surface_signature,
    surface_symmetry_order,
};
