//! Every hex mesh with n cubes, without isomorphic copies (BruteBuilder)

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
pub use driver::{Checkpointed, chunks_of_part, default_chunks, run_checkpointed, run_in_order, run_whole};
pub use error::EnumerateError;
pub use ledger::{Header, Ledger, Merged, Record, ledger_path, merge, read_ledger, read_ledgers};
pub use level::{Keep, Level, LevelOptions, all_levels, first_level, next_level};
pub use listing::{ListFormat, line, mesh_of, weill_order};
pub use params::{Filter, Params, Rule};
pub use report::{histograms, table};
pub use shape::{Selection, Shape, parse_range, shape};
pub use strict::{StrictOptions, extend_strict, strict_violations};
pub use tally::{Histogram, MASS_UNIT, Tally};
pub use targets::{Found, Target, Wanted};
pub use weill::{extend_weill, weill_violations};
