//! Quad surfaces and hex meshes as connectivity: ids, incidence, chords, sheets, canonical signatures.
//!
//! The data structures know no algorithm; an algorithm is a free function in a file of its own.
//! No floats and no files here: topology knows no positions.

mod bipartition;
mod buckets;
mod chords;
mod components;
mod context;
pub mod cube;
mod forest;
#[cfg(any(test, feature = "generate"))]
pub mod generate;
mod hex_code;
mod hex_signature;
mod hexmesh;
mod id_vec;
mod ids;
mod improper;
mod key;
mod orbits;
mod random;
mod sheets;
mod shelling;
mod signature_text;
mod surface;
mod surface_code;
mod surface_signature;
mod valence;

pub use bipartition::{OddCycle, bipartition};
pub use buckets::Buckets;
pub use chords::{Chord, chords, chords_by_quad};
pub use components::{NotOrientable, disagreement, facet_components, n_vertex_components, orientation};
pub use context::{Context, Progress, StopReason};
pub use forest::Forest;
pub use hex_signature::{
    HexAutomorphism, HexIsomorphism, hex_automorphisms, hex_isomorphism, hex_signature, hex_symmetry_order,
    oriented_hex_signature, parse_hex_signature,
};
pub use hexmesh::{Facet, HexMesh, HexMeshError};
pub use id_vec::{Id, IdVec};
pub use ids::{Dart, Edge, HexId, Offenders, QuadId, VertexId};
pub use improper::{ImproperPair, improper_pairs, is_proper, is_three_connected};
pub use key::{Key, KeyError, key, key_of_chords};
pub use random::Random;
pub use sheets::{Sheet, sheets};
pub use shelling::{greedy_shelling, is_shellable, is_shelling};
pub use signature_text::SignatureError;
pub use surface::{FaceSides, QuadSurface, SurfaceError};
pub use surface_signature::{
    CanonicalSurface, SurfaceAutomorphism, canonical_surface, parse_surface_signature, surface_automorphisms,
    surface_isomorphism, surface_signature, surface_symmetry_order,
};
pub use valence::{
    EdgeValence, MeshStatistics, degree_histogram, edge_valences, euler_characteristic, interior_singular_edges,
    mesh_statistics, vertex_valences,
};
