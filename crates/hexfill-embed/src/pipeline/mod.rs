//! The way of a mesh: normal coordinates, starts in batches, each worked out, the best one reported.
//!
//! Source: ours.

mod assess;
mod balance;
mod best_start;
mod improve;
mod normal;
mod one_start;

pub(crate) use best_start::{NEAR_OPTIMUM, run};
pub(crate) use improve::SMALL;
pub(crate) use normal::Normal;
