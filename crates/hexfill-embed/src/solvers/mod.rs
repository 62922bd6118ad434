//! Numerical methods that know nothing of hexes.

pub(crate) mod conjugate_gradients;
pub(crate) mod interior_point;
pub(crate) mod lbfgs;
pub(crate) mod long_vectors;
