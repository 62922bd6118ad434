//! A little geometry that several rooms need: vectors, angles, winding numbers, and the best directions of a vertex star's free edges.
//!
//! The scaled Jacobian of a hex corner is the determinant of its three unit edges. With two edges given it is linear in the
//! third, so the best direction of one free edge at a vertex is a max-min program with a closed form
//! ([`best_direction`]); with several free edges every determinant is linear in each of them, and [`climb_star`] looks for
//! good directions. The first is exact up to rounding, an upper bound and attained; the second is attained only, and says nothing about
//! what cannot be reached.

// Vectors read like their formulas with indices.
#![allow(clippy::needless_range_loop)]

mod angle;
mod direction;
mod extent;
mod quad;
mod star;
mod vector;
mod winding;

pub use angle::{corner_angle, dihedral_angle};
pub use direction::{Best, best_direction};
pub use extent::{bounding_box, centroid, tet_volume};
pub use quad::{cone, halves};
pub use star::{Ray, Reached, climb_star, star_bound};
pub use vector::{Vector, add, add_scaled, cross, det, direction, dot, midpoint, norm, scale, sub, unit};
pub use winding::{holders, solid_angle, winding_number};
