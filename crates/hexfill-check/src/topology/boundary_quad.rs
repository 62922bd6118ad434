//! Boundary quads.
//!
//! Source: ours.

/// A quad in exactly one hex, as a cycle that is counter-clockwise seen from outside, smallest vertex first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct BoundaryQuad {
    pub(crate) cycle: [u32; 4],
    pub(crate) hex: u32,
}
