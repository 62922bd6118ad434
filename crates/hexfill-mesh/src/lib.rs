//! Quad surfaces and hex meshes as connectivity: ids, incidence, chords, sheets, canonical signatures.
//!
//! The data structures know no algorithm; an algorithm is a free function in a file of its own.
//! No floats and no files here: topology knows no positions.
//!
//! | to have | from |
//! |---|---|
//! | a surface that is closed, oriented and manifold, by its type | [`QuadSurface::try_new`]: quads as arrays of 0-based vertex indices |
//! | hexes with their facet incidence | [`HexMesh::try_new`]: hexes in VTK order (see [`cube`]) |
//! | the dual | [`chords()`], [`sheets()`] |
//! | a name up to renumbering | [`surface_signature`], [`hex_signature`], [`canonical_surface`] |
//! | whether a proper mesh is ruled out | [`improper_pairs`], [`bipartition()`] |
//! | an order to build a mesh in | [`greedy_shelling`], [`is_shelling`] |
//!
//! Not for filling surfaces (`hexfill` does that), nor for judging foreign meshes: a [`HexMesh`] is only known to be glued facet on facet
//! (rule R1), and `hexfill-check` says the rest.
//!
//! Invariants: ids are 0-based and `u32`; a facet belongs to one hex or two, an edge of a surface to two quads; results come in order of ids,
//! never in that of a hash map. Papers: Thurston 1993, Mitchell 1996 and Folwell, Mitchell 1999 (sheets), Weill (keys), Brinkmann et al. 2005 and
//! Brinkmann, McKay 2007 (spheres and their codes), Goaoc et al. 2019 (shellings), Tarjan 1975 (forests); the keys are those of the book's bibliography.
//!
//! ```
//! use hexfill_mesh::{QuadSurface, chords, surface_symmetry_order};
//!
//! let quads = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
//! let cube = QuadSurface::try_new(8, &quads)?;
//! assert_eq!(chords(&cube).len(), 3);
//! assert_eq!(surface_symmetry_order(&cube), 48);
//! # Ok::<(), hexfill_mesh::SurfaceError>(())
//! ```

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
mod own_vertices;
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
