//! [`Goal`]: what linear programs improve.
//!
//! Source: ours.

/// What is improved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Goal {
    /// Raise the worst scaled Jacobian; stop when it reaches the target.
    ScaledJacobian {
        /// Enough.
        target: f64,
    },
    /// Lower the worst corner condition number, keeping the scaled Jacobian at least at the floor.
    Condition {
        /// The floor.
        floor: f64,
    },
}
