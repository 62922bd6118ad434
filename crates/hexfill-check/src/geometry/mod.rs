//! Levels 4 and 5: everything that needs coordinates.
//!
//! The determinant of the trilinear map is tri-quadratic; its 27 Bernstein coefficients bound it on the whole hex.
//!
//! Source: Johnen, Weill, Remacle 2017 (arXiv:1706.01613).

pub(crate) mod bernstein;
pub(crate) mod exact;
pub(crate) mod overlap;
pub(crate) mod positions;
pub(crate) mod positivity;
pub(crate) mod quality;
pub(crate) mod scaled;
pub(crate) mod verdict;
pub(crate) mod volume;
