//! A little geometry that several rooms need: vectors, angles, winding numbers, and the best directions of a vertex star's free edges.
//!
//! The scaled Jacobian of a hex corner is the determinant of its three unit edges. With two edges given it is linear in the
//! third, so the best direction of one free edge at a vertex is a max-min program with a closed form
//! ([`best_direction`]); with several free edges every determinant is linear in each of them, and [`climb_star`] looks for
//! good directions. The first is exact up to rounding, an upper bound and attained; the second is attained only, and says nothing about
//! what cannot be reached.
//!
//! | question | verb |
//! |---|---|
//! | vectors as arrays | [`dot`], [`cross`], [`det`], [`unit()`] and their like |
//! | the angle of a corner, the dihedral angle at an edge | [`corner_angle`], [`dihedral_angle`] |
//! | inside or outside of a closed surface, and which of several surfaces lies in which | [`winding_number`], [`holders`] |
//! | where a quadratic polynomial vanishes | [`quadratic_roots`] |
//! | the best direction of one free edge, good directions of several | [`best_direction`], [`climb_star`] |
//!
//! Not for decisions that must be exact: all of it is plain floating point. Where a sign decides (Delaunay tetrahedra, crossings) the `robust` predicates are
//! asked, and what is certified of a mesh is computed by `hexfill-check`, which shares nothing with this crate but the definition of a number.
//!
//! Invariants: no type of its own for a vector, `[f64; 3]` throughout, so nothing is converted; lengths are in the unit of the points given, angles in
//! radians; the same input gives the same bits. Papers: Wolfe 1976 (one free edge), van Oosterom, Strackee 1983 (solid angles); the keys are those of the
//! book's bibliography.
//!
//! ```
//! use hexfill_geometry::{best_direction, winding_number};
//!
//! // The tetrahedron of three unit axes, its faces seen from outside counter-clockwise.
//! let p = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
//! let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(|f| f.map(|v: usize| p[v]));
//! assert!((winding_number(faces, [0.1, 0.1, 0.1]) - 1.0).abs() < 1e-12);
//! assert!(winding_number(faces, [1.0, 1.0, 1.0]).abs() < 1e-12);
//!
//! // One edge between three walls at right angles does best in the middle: 1 / sqrt 3.
//! let best = best_direction(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
//! assert!((best.value - 3.0f64.sqrt().recip()).abs() < 1e-12);
//! ```

// Vectors read like their formulas with indices.
#![allow(clippy::needless_range_loop)]

mod angle;
mod direction;
mod extent;
mod quad;
mod roots;
mod star;
mod vector;
mod winding;

pub use angle::{corner_angle, dihedral_angle};
pub use direction::{Best, best_direction};
pub use extent::{bounding_box, centroid, tet_volume};
pub use quad::{cone, halves};
pub use roots::quadratic_roots;
pub use star::{Ray, Reached, climb_star, star_bound};
pub use vector::{Vector, add, add_scaled, cross, det, direction, dot, midpoint, norm, scale, sub, unit};
pub use winding::{holders, solid_angle, winding_number};
