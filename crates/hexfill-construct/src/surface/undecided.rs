//! [`Undecided`]: why it is not known whether a mesh exists.
//!
//! Source: ours.

use crate::missing::MissingInterior;
use hexfill_mesh::StopReason;

/// Why existence is open. Displayed as a clause that says what to give.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Undecided {
    /// Which components bound one solid decides, and only positions tell.
    #[error("some components have odd numbers of quads; positions are needed to see which of them bound one solid")]
    OddComponents,
    /// Which odd cycles bound inside decides, and only positions tell.
    #[error("the surface has odd cycles; positions are needed to see which of them bound inside")]
    OddCycles,
    /// There are positions, and they do not tell what is inside.
    #[error(transparent)]
    Interior(#[from] MissingInterior),
    /// Told to stop before the answer.
    #[error("stopped: {0}")]
    Stopped(StopReason),
}
