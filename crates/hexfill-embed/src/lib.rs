//! Coordinates for hex meshes: start, untangle, optimise.
//!
//! The way of a mesh through this crate:
//! 1. **start**: interior vertices at weighted means of their neighbours (graph Laplacian), or where the caller says;
//! 2. **untangle**: minimise an energy that is finite on inverted cells and a barrier in the end (L-BFGS), then make
//!    whole cells positive in the Bernstein sense, not only their corners;
//! 3. **optimise**: raise the worst scaled Jacobian by linear programs in a trust region, or lower the worst condition number;
//! 4. **report**: validity in floating point, worst cells, and the vertex-star upper bounds no embedding can beat.
//!
//! Boundary vertices keep the bits they were given. Nothing here is a proof: that is for `hexfill-check`.
//! What bounds every mesh of a surface, or every one-edge layer, is known before there is one ([`surface_limits`]).
//! Surfaces without coordinates get those of the canonical polyhedron ([`canonical_polyhedron`]).

// Matrices and small vectors read like their formulas with indices.
#![allow(clippy::needless_range_loop)]

mod canonical;
mod curvature;
mod embed;
mod energy;
mod error;
mod interior;
mod jacobian;
mod lbfgs;
mod lengths;
mod lift;
mod local;
mod maxmin;
mod measure;
mod patch;
mod problem;
mod program;
mod raise;
mod report;
#[cfg(test)]
mod samples;
mod star;
mod star_search;
mod surface_limits;
mod symmetry;
mod tutte;
mod untangle;
mod vector;

pub use canonical::canonical_polyhedron;
pub use embed::{embed, quick_star_bound, star_bounds, tutte_start};
pub use error::EmbedError;
pub use report::{CellQuality, EmbedReport, Embedding, Objective, Options};
pub use star::StarBound;
pub use surface_limits::{CornerLimit, EdgeLimit, SurfaceLimits, VertexLimit, surface_limits};
