//! What can be said of det J.
//!
//! Source: ours.

use super::bernstein::Vector;

/// What is known about det J of a hex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Positivity {
    /// Positive everywhere.
    Positive,
    /// Negative at all eight corners.
    InsideOut,
    /// Zero or negative at a point of the unit cube.
    NotPositive { at: Vector, zero: bool },
    /// The depth limit was reached.
    Undecided,
}
