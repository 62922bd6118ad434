//! What is wrong with a surface, all at once, and the smallest change that mends it.
//!
//! [`examine`] takes points and faces as a file holds them ([`Soup`]) and says everything that keeps them from being filled, or filled well: holes,
//! copies, triangles (and which pairs to merge), an odd number of quads (and the smallest change that mends it), faces that cross. Nothing stops at the first
//! fault. [`mend`] makes the changes that have one smallest answer. Limits of quality and the existence theorems need a closed surface; other
//! rooms tell them (`hexfill-embed`, `hexfill-construct`), and the facade puts all together.
//!
//! Faces are numbered as in the file. Linear time but for sorting, the search for crossings (a tree of boxes) and the matching of triangles.
//!
//! Not for repair at any price: where a fault has several answers (a hole to be closed, faces that cross) it is named and left, and no point is ever moved.
//! Not a judge of hex meshes either (`hexfill-check` is).
//!
//! Invariants: what is found comes in order of ids, the first ten and the count; findings do not depend on the order in which faults are looked for; whether
//! faces cross is decided by exact predicates; [`mend`] keeps every face and point it does not have to touch, with its number told. Papers: Shewchuk 1997
//! (predicates), Edmonds 1965 (triangles merged in pairs); the keys are those of the book's bibliography.
//!
//! ```
//! use hexfill_doctor::{MendOptions, Severity, Soup, examine, mend};
//!
//! // A cube whose top was cut into two triangles.
//! let mut faces: Vec<Vec<u32>> = [[0, 3, 2, 1], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]].map(Vec::from).into();
//! faces.extend([vec![4, 5, 6], vec![4, 6, 7]]);
//! let soup = Soup { points: Vec::new(), faces };
//! assert!(examine(&soup).findings.iter().any(|f| f.severity == Severity::Fatal));
//! let mended = mend(&soup, &MendOptions::default());
//! assert_eq!(mended.soup.faces.len(), 6);
//! assert!(examine(&mended.soup).findings.iter().all(|f| f.severity != Severity::Fatal));
//! ```

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
