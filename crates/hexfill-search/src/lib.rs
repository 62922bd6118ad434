//! Cavities, flips, the atlas of smallest known fillings, filling by inward flips, and simplification.
//!
//! | question | verb |
//! |---|---|
//! | which hexes may be glued on this ball | [`legal_flips`], [`apply`] |
//! | the smallest filling on record of a small sphere | [`Atlas::balls_for`], [`Atlas::best_fit`] |
//! | a filling of a sphere that is not on record | [`fill_from_atlas`], [`fill_avoiding`] |
//! | an atlas of one's own | [`Growth`], [`complete()`] |
//! | the same boundary with fewer hexes | [`simplify()`], [`collapse()`] |
//!
//! Not for large surfaces: a [`Cavity`] is a sphere of at most [`MAX_QUADS`] quads, kept in a few hundred bytes. Nothing here proves that a filling is
//! the smallest one or that none exists: a growth is cut by width and size (`hexfill-prove` searches to the end).
//!
//! Invariants: an atlas hash only points, every filling is replayed from its flips and compared before it is used; pairs of vertices that a cell has used
//! are never used again ([`flip`](is_legal), the theorem on its page); the same result for any number of threads. Papers: Bern, Eppstein and Erickson 2002
//! (flips), Verhetsel et al. 2018 and 2019 (the search by known balls), Borden et al. 2002 and Ledoux, Shepherd 2010 (sheets pressed flat); the keys are those
//! of the book's bibliography.
//!
//! ```
//! use hexfill_mesh::{Context, HexMesh};
//! use hexfill_search::{Atlas, SimplifyOptions, simplify};
//!
//! // Seven hexes where one will do: a cube within a cube, joined by six.
//! let mut hexes = vec![[8, 9, 10, 11, 12, 13, 14, 15]];
//! hexes.extend(hexfill_mesh::cube::FACETS.map(|f| {
//!     let outer = f.map(|v| v as u32);
//!     [outer[0] + 8, outer[1] + 8, outer[2] + 8, outer[3] + 8, outer[0], outer[1], outer[2], outer[3]]
//! }));
//! let mesh = HexMesh::try_new(16, &hexes)?;
//! let made = simplify(&mesh, Atlas::embedded(), &SimplifyOptions::default().with_balls(100), &Context::default());
//! assert_eq!((made.report.before, made.report.after), (7, 1));
//! # Ok::<(), hexfill_mesh::HexMeshError>(())
//! ```

mod atlas;
mod atlas_file;
mod atlas_index;
mod atlas_packed;
mod atlas_states;
mod backward;
mod ball;
mod canonical;
mod cavity;
mod complete;
mod exchange;
mod flip;
mod grow;
mod halves;
mod hole;
mod inward;
mod known;
mod narrow_shelling;
mod packed_pairs;
mod refill;
mod simplify;

pub use atlas::{Atlas, AtlasStats, ClassStats, Spread};
pub use atlas_file::{AtlasError, GrowthLog};
pub use ball::Ball;
pub use cavity::{Cavity, MAX_QUADS, MAX_VERTICES, Pairs};
pub use complete::{CompleteError, CompleteOptions, CompleteReport, GivenFilling, complete};
pub use flip::{Flip, FlipKind, Placement, apply, is_legal, legal_flips, place};
pub use grow::{GrowOptions, Growth, LevelReport};
pub use halves::{Membranes, two_halves};
pub use inward::{FillOptions, FillOutcome, Filling, fill_avoiding, fill_from_atlas};
pub use packed_pairs::MAX_CAP;
pub use simplify::{
    Collapse, Gate, Simplified, SimplifyOptions, SimplifyReport, WithoutSheet, collapse, simplification_atlas,
    simplify, simplify_gated, single_sheet_collapses,
};
