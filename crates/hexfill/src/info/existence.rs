//! [`ExistenceInfo`]: whether a hex mesh exists, for people and for JSON.
//!
//! Source: Erickson 2014, section 4.

use hexfill_construct::Existence;
use serde::Serialize;
use std::fmt;

/// Whether a hex mesh exists.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct ExistenceInfo {
    /// "exists", "none" or "unknown".
    pub hex_mesh: &'static str,
    /// The theorem, or what stands in the way.
    pub because: String,
}

impl From<&Existence> for ExistenceInfo {
    fn from(existence: &Existence) -> Self {
        let hex_mesh = match existence {
            Existence::Exists { .. } => "exists",
            no if no.is_none() => "none",
            _ => "unknown",
        };
        Self { hex_mesh, because: existence.to_string() }
    }
}

impl fmt::Display for ExistenceInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.hex_mesh {
            "exists" => write!(f, "hex mesh: exists ({})", self.because),
            "none" => write!(f, "hex mesh: none exists: {}", self.because),
            _ => write!(f, "hex mesh: not known: {}", self.because),
        }
    }
}
