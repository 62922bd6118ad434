//! Cavities, flips, the atlas of smallest known fillings, complete search and simplification.

mod cavity;
mod flip;

pub use cavity::{Cavity, MAX_QUADS, MAX_VERTICES, Pairs};
pub use flip::{Flip, FlipKind, Placement, apply, is_legal, legal_flips, place};
