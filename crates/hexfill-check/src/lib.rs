//! The independent judge: says which rule of the validity ladder a hex mesh breaks, and on which cells.
//!
//! It reads raw arrays, so that bad meshes can be judged, and shares no algorithm with the crates that make meshes: from
//! `hexfill-mesh` it takes the ids and the reference cube's tables only. Levels (see [`Level`]): L1 indices and hex shape;
//! L2 face pairing and proper intersection; L3 manifold, oriented, boundary = input; L4 positions finite, boundary
//! bit-identical; L5 det J > 0 certified everywhere in every hex. Time and memory are linear in the mesh.
//!
//! | question | verb |
//! |---|---|
//! | which rules does this mesh break, and where | [`judge()`] |
//! | the numbers of every hex | [`cell_quality`], [`write_cell_csv`] |
//! | a statement that somebody else can verify | [`certify`], [`verify_certificate`] |
//!
//! Not for mending: it names offenders and changes nothing (`hexfill-doctor` mends surfaces). Not for meshes with cells other than hexes, nor
//! for hexes with curved edges: a hex here is the trilinear image of a cube.
//!
//! Invariants: nothing is assumed of the input; no failure hides another level that still has a meaning; offenders come in order of ids and the report is
//! the same for any number of threads; "valid" is said only where it is proved (interval filter, then Bernstein form, then exact arithmetic), and where
//! neither a proof nor a counterexample was found the report says "undecided". Papers: Johnen, Weill, Remacle 2017 (det J > 0 on a whole hex), Forman 1998 and
//! Benedetti, Lutz 2014 (Betti numbers), Anderson, Woll 1991 (orientation), Weill (his rules); the keys are those of the book's bibliography.
//!
//! ```
//! use hexfill_check::{judge, Judged, Level, Options};
//! use hexfill_mesh::Context;
//!
//! let cube = [[0, 1, 2, 3, 4, 5, 6, 7]];
//! let report = judge(&Judged::connectivity(8, &cube), &Options::default(), &Context::default());
//! assert!(report.passed(Level::L3));
//! assert_eq!(report.facts.betti, Some([1, 0, 0, 0]));
//! ```

mod certificate;
mod geometry;
mod input;
mod judge;
mod parallel;
mod report;
mod rule;
mod topology;

pub use certificate::{Certificate, CertificateError, certificate_of, certify, verify_certificate};
pub use geometry::overlap::Overlap;
pub use geometry::quality::{CellQuality, Quality, WorstCell, cell_quality, write_cell_csv};
pub use input::{Judged, Options, Parts};
pub use judge::judge;
pub use report::{Ball, BoundaryPart, Facts, Failure, Geometry, LevelReport, Offender, Outcome, Report, SurfaceSense};
pub use rule::{Level, Rule, Rules};
