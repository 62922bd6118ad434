//! Every hex mesh with n cubes, without isomorphic copies (BruteBuilder)

mod augment;
mod boundary;
mod canonical;
mod chunk;
mod complex;
mod error;
mod frames;
mod hashset;
mod level;
mod params;
mod shape;
mod strict;
mod tally;
mod targets;
mod weill;

pub use boundary::{Boundary, Components};
pub use canonical::{Code, FORM_VERSION, Labelling, canonical, canonical_over_all_flags};
pub use chunk::{Chunk, ChunkResult, Plan};
pub use complex::{Complex, MAX_CUBES};
pub use error::EnumerateError;
pub use level::{Keep, Level, LevelOptions, all_levels, first_level, next_level};
pub use params::{Filter, Params, Rule};
pub use shape::{Selection, Shape, parse_range, shape};
pub use strict::{StrictOptions, extend_strict, strict_violations};
pub use tally::{Histogram, MASS_UNIT, Tally};
pub use targets::{Found, Target, Wanted};
pub use weill::{extend_weill, weill_violations};
