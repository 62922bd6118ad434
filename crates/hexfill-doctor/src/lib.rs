//! What is wrong with a surface, all at once, and the smallest change that mends it.
//!
//! [`examine`] takes points and faces as a file holds them ([`Soup`]) and says everything that keeps them from being filled, or filled well: holes,
//! copies, triangles (and which pairs to merge), an odd number of quads (and the smallest change that mends it), faces that cross. Nothing stops at the first
//! fault. [`mend`] makes the changes that have one smallest answer. Limits of quality and the existence theorems need a closed surface; other
//! rooms tell them (`hexfill-embed`, `hexfill-construct`), and the facade puts all together.
//!
//! Faces are numbered as in the file. Linear time but for sorting, the search for crossings (a tree of boxes) and the matching of triangles.

mod crossing;
mod cut;
mod faults;
mod findings;
mod mend;
mod parity;
mod sines;
mod soup;
mod triangles;

pub use crossing::crossings;
pub use faults::{
    coincident_points, degenerate_faces, points_not_finite, repeated_faces, slivers_and_reflex, unused_points,
};
pub use findings::{Finding, Findings, Severity, examine};
pub use mend::{MendOptions, Mended, mend};
pub use parity::{ParityChange, parity_changes};
pub use soup::Soup;
pub use triangles::{MergedPair, merged_triangles};
