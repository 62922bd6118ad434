//! The crate's error type.

use std::path::PathBuf;

/// What can go wrong with ledgers.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LedgerError {
    /// Parts and chunks that do not go together.
    #[error("{why}")]
    BadParameters {
        /// What is wrong, and what would be right.
        why: String,
    },
    /// A file that cannot be read or written.
    #[error("{path}: {source}")]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A ledger whose contents cannot be trusted.
    #[error("{path}: line {line}: {why}")]
    BadLedger {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What is wrong.
        why: String,
    },
    /// A ledger for other parameters than those asked for.
    #[error("{path} was made with other parameters: {differences}")]
    OtherParameters {
        /// The file.
        path: PathBuf,
        /// Each difference: name, value found, value expected.
        differences: String,
    },
    /// Chunks that do not make a whole.
    #[error("the chunks do not make a whole: {why}")]
    Incomplete {
        /// The chunks missing or overlapping.
        why: String,
    },
}
