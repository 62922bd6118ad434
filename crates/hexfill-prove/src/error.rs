//! The crate's error type.

/// What can go wrong in a complete search.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProveError {
    /// A surface that the search does not take.
    #[error("the complete search does not take this surface: {why}")]
    BadSurface {
        /// What is wrong.
        why: String,
    },
    /// Parameters that do not go together.
    #[error("{why}")]
    BadParameters {
        /// What is wrong, and what would be right.
        why: String,
    },
    /// A ledger.
    #[error(transparent)]
    Ledger(#[from] hexfill_ledger::LedgerError),
    /// A mesh found is none: a defect of this crate.
    #[error("the judge refuses a mesh found ({rules}): {hexes:?}")]
    Refused {
        /// What it breaks.
        rules: String,
        /// The hexes.
        hexes: Vec<[u32; 8]>,
    },
    /// The work was stopped.
    #[error("stopped before the end: {reason}")]
    Stopped {
        /// Why.
        reason: hexfill_mesh::StopReason,
    },
}
