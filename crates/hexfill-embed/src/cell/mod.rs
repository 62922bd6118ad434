//! One cell: its Jacobian, what is known of it on the whole cell, and measures at a point.
//!
//! Source: Johnen, Weill, Remacle 2017 for the Bernstein form.

pub(crate) mod bisection;
pub(crate) mod condition;
pub(crate) mod frame;
pub(crate) mod hessian;
pub(crate) mod real;
pub(crate) mod scaled_jacobian;
