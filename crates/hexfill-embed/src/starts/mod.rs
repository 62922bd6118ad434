//! First positions: means of neighbours, and for surfaces without points those of a polyhedron.
//!
//! Source: each file names its own.

mod canonical_polyhedron;
mod circle_layout;
mod circle_packing;
mod tutte;

pub use canonical_polyhedron::canonical_polyhedron;
pub(crate) use tutte::{Weights, place_at_means};
