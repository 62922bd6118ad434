//! Every hex mesh with n cubes, one of each isomorphism class: J.-C. Weill's BruteBuilder ("A tentative to break the
//! pyramid's code"), made exact and fast.
//!
//! * A [`Complex`] is a few hundred bytes and is extended by one cube in every legal way, under one of two
//!   [rules](Rule): [`extend_strict`] and [`extend_weill`].
//! * [`canonical`] gives its canonical [`Code`], the order of its automorphism group and more in about a microsecond.
//! * Two engines: level by level with a set of hashes ([`all_levels`]), and canonical augmentation without memory
//!   ([`Plan`], [`run_whole`]). They share the extension and the canonical form and nothing else; the exact mass
//!   formula ([`Tally::mass_balances`]) checks both.
//! * The work falls into [chunks](Chunk) that add up; drivers are threads, job arrays and MPI, with a [`Ledger`] that
//!   survives being killed.
//!
//! Not for meshes of a given boundary: most of what is enumerated has another one (`hexfill-prove` searches a boundary to the end, `hexfill-search` looks one
//! up). Not for many cubes either: at most [`MAX_CUBES`] fit, and numbers of classes grow some ninefold with each cube.
//!
//! Invariants: each isomorphism class (mirror images alike) is counted once; counts and lists are the same for any number of threads and any cut into
//! chunks; sums of 1 / |Aut| are kept exactly, as multiples of 1 / [`MASS_UNIT`]. Source: Weill (key of the book's bibliography); canonical augmentation as in
//! Brinkmann, McKay 2007.
//!
//! ```
//! use hexfill_enumerate::{LevelOptions, Params, Plan, Rule, Wanted, run_whole};
//! use hexfill_mesh::Context;
//!
//! let ctx = Context::default();
//! let plan = Plan::prepare(&Params::new(5, Rule::Strict), &LevelOptions::default(), &ctx)?;
//! let (tally, _) = run_whole(&plan, 1, Wanted::default(), &ctx)?;
//! assert_eq!((tally.classes, tally.balls), (240, 60));
//! assert!(tally.mass_balances());
//! # Ok::<(), hexfill_enumerate::EnumerateError>(())
//! ```

// The inner loops run one index over several small tables at once.
#![allow(clippy::needless_range_loop)]

mod augment;
mod boundary;
mod canonical;
mod chunk;
mod complex;
mod driver;
mod error;
mod frames;
mod hashset;
mod ledger;
mod level;
mod listing;
mod params;
mod report;
mod shape;
mod strict;
mod tally;
mod targets;
mod weill;

pub use boundary::{Boundary, Components};
pub use canonical::{Code, FORM_VERSION, Labelling, canonical, canonical_over_all_flags};
pub use chunk::{Chunk, ChunkResult, Plan};
pub use complex::{Complex, MAX_CUBES};
pub use driver::{Checkpointed, chunks_of_part, run_checkpointed, run_in_order, run_whole};
pub use error::EnumerateError;
pub use hexfill_ledger::default_chunks;
pub use ledger::{Header, Ledger, Merged, Record, ledger_path, merge, read_ledger, read_ledgers};
pub use level::{Keep, Level, LevelOptions, all_levels, first_level, next_level};
pub use listing::{ListFormat, line, mesh_of, mirror_lines, weill_order};
pub use params::{Filter, Params, Rule};
pub use report::{histograms, table};
pub use shape::{Selection, Shape, parse_range, shape};
pub use strict::{StrictOptions, extend_strict, strict_violations};
pub use tally::{Histogram, MASS_UNIT, Tally};
pub use targets::{Found, Target, Wanted};
pub use weill::{extend_weill, weill_violations};
