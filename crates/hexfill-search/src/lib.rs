//! Cavities, flips, the atlas of smallest known fillings, complete search and simplification.

mod atlas;
mod atlas_file;
mod atlas_index;
mod backward;
mod ball;
mod canonical;
mod cavity;
mod complete;
mod flip;
mod grow;
mod inward;
mod known;
mod simplify;

pub use atlas::{Atlas, AtlasStats, ClassStats, Spread};
pub use atlas_file::{AtlasError, GrowthLog};
pub use ball::Ball;
pub use cavity::{Cavity, MAX_QUADS, MAX_VERTICES, Pairs};
pub use complete::{CompleteOptions, CompleteReport, complete};
pub use flip::{Flip, FlipKind, Placement, apply, is_legal, legal_flips, place};
pub use grow::{GrowOptions, Growth, LevelReport, MAX_CAP};
pub use inward::{FillOptions, FillOutcome, Filling, fill_avoiding, fill_from_atlas};
pub use simplify::{
    Collapse, Simplified, SimplifyOptions, SimplifyReport, collapse, simplification_atlas, simplify,
    single_sheet_collapses,
};
