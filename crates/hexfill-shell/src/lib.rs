//! Shelling: closed quad surfaces of any size swept inward by their own dual curves, until nothing is left to fill.
//!
//! `angles` what every edge wants -> `compress` parallel chords become one -> `solve` layers and closings (`layer`) on the
//! void (`void`, `pairs`) -> `lift` back to the fine surface.

mod angles;
mod compress;
mod layer;
mod lift;
mod pairs;
mod shell;
mod solve;
mod void;

pub use shell::{ShellOptions, Shelled, Shelling, shell};
