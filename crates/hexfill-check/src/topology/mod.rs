//! Levels 1 to 3: everything that needs no coordinates.

pub(crate) mod boundary;
pub(crate) mod boundary_quad;
pub(crate) mod cells;
pub(crate) mod homology;
pub(crate) mod parity;
pub(crate) mod shape;
pub(crate) mod star;
pub(crate) mod stars;
pub(crate) mod weill;
