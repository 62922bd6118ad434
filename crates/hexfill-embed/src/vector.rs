//! Vectors in three dimensions as plain arrays: those of `hexfill-geometry`.

pub(crate) use hexfill_geometry::{Vector, add, add_scaled, cross, det, dot, midpoint, norm, scale, sub, unit};
