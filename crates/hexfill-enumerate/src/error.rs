//! The crate's error type.

/// What can go wrong while enumerating.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EnumerateError {
    /// Cubes that are not a small connected hex mesh.
    #[error("not a complex: {why}")]
    BadComplex {
        /// What is wrong.
        why: String,
    },
    /// Parameters that do not go together.
    #[error("{why}")]
    BadParameters {
        /// What is wrong, and what would be right.
        why: String,
    },
    /// A text that is not a boundary key.
    #[error(transparent)]
    Key(#[from] hexfill_mesh::KeyError),
    /// A text that is not a signature.
    #[error(transparent)]
    Signature(#[from] hexfill_mesh::SignatureError),
    /// A code that is not a complex.
    #[error("{given:?} is not a code: {why}")]
    BadCode {
        /// The text.
        given: String,
        /// What is wrong.
        why: String,
    },
    /// Not a mesh in the sense of the mesh crate.
    #[error(transparent)]
    Mesh(#[from] hexfill_mesh::HexMeshError),
    /// A checkpoint that cannot be read or written.
    #[error("{path}: {source}")]
    Io {
        /// The file.
        path: std::path::PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A ledger whose contents cannot be trusted.
    #[error("{path}: line {line}: {why}")]
    BadLedger {
        /// The file.
        path: std::path::PathBuf,
        /// The line, from 1.
        line: usize,
        /// What is wrong.
        why: String,
    },
    /// A ledger for other parameters than those asked for.
    #[error("{path} was made with other parameters: {differences}")]
    OtherParameters {
        /// The file.
        path: std::path::PathBuf,
        /// Each difference: name, value found, value expected.
        differences: String,
    },
    /// Chunks that do not make a whole.
    #[error("the chunks do not make a whole: {why}")]
    Incomplete {
        /// The chunks missing or overlapping.
        why: String,
    },
    /// The work was stopped.
    #[error("stopped before the end: {reason:?}")]
    Stopped {
        /// Why.
        reason: hexfill_mesh::StopReason,
    },
}

impl From<hexfill_ledger::LedgerError> for EnumerateError {
    fn from(error: hexfill_ledger::LedgerError) -> Self {
        use hexfill_ledger::LedgerError as L;
        match error {
            L::BadParameters { why } => Self::BadParameters { why },
            L::Io { path, source } => Self::Io { path, source },
            L::BadLedger { path, line, why } => Self::BadLedger { path, line, why },
            L::OtherParameters { path, differences } => Self::OtherParameters { path, differences },
            L::Incomplete { why } => Self::Incomplete { why },
            other => Self::BadParameters { why: other.to_string() },
        }
    }
}
