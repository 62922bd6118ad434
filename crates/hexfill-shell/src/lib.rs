//! Shelling: closed quad surfaces of any size swept inward by their own dual curves, until nothing is left to fill.

mod close;
mod front;
mod glue;
mod inside;
mod lens;
mod pairs;
mod plug;
mod stir;
mod sweep;
#[cfg(test)]
mod sweep_tests;
mod sweeper;
#[cfg(test)]
mod test_surfaces;
mod zip;

pub use front::{Front, FrontError, Mark};
pub use stir::stir_front;
pub use sweep::{EdgeWant, SweepOptions, Swept, sweep, sweep_front};
pub use zip::Refused;
