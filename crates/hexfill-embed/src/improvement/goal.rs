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

impl Goal {
    /// How far it is, in words: `value` is the worst scaled Jacobian, or minus the logarithm of the worst condition number.
    pub(crate) fn progress(self, value: f64) -> String {
        match self {
            Self::ScaledJacobian { target } => format!("worst scaled Jacobian {value:.6}, at best {target:.6}"),
            Self::Condition { .. } => format!("worst condition number {:.3}", (-value).exp()),
        }
    }
}
