//! Coordinates for hex meshes: start, untangle, optimise.
//!
//! The way of a mesh through this crate:
//! 1. **start**: interior vertices at weighted means of their neighbours (graph Laplacian), or where the caller says;
//! 2. **untangle**: minimise an energy that is finite on inverted cells and a barrier in the end (L-BFGS), then make
//!    whole cells positive in the Bernstein sense, not only their corners;
//! 3. **optimise**: raise the worst scaled Jacobian by linear programs in a trust region and by barriers, or lower the worst condition number;
//! 4. **report**: validity in floating point, worst cells, and the vertex-star upper bounds no embedding can beat.
//!
//! | folder | what is in it | may use |
//! |---|---|---|
//! | `solvers` | L-BFGS, conjugate gradients, the interior-point solver's programs, long vectors | - |
//! | `cell` | one cell: Jacobian, Bernstein form, bisection, scaled Jacobian, condition number, Hessian | - |
//! | `problem` | hexes with free and fixed vertices, symmetric variables, patches | solvers |
//! | `quality` | all cells judged; `Verdict`, which of two embeddings is better | problem, cell |
//! | `starts` | means of neighbours; the canonical polyhedron of a surface | problem, solvers |
//! | `bounds` | what no embedding can beat: vertex stars, angles, limits of a surface | problem, solvers |
//! | `improvement` | untangling, barriers, programs, each on all or on patches | all above but starts, bounds |
//! | `pipeline` | normal coordinates, one start, the best of several, the report | all above |
//! | `embed` | the public verbs | all above |
//!
//! No two files use each other, in a circle or at once.
//!
//! Boundary vertices keep the bits they were given. Nothing here is a proof: that is for `hexfill-check`.
//! What bounds every mesh of a surface, or every one-edge layer, is known before there is one ([`surface_limits`]).
//! Surfaces without coordinates get those of the canonical polyhedron ([`canonical_polyhedron`]).
//!
//! Not for moving the boundary, and not for a mesh whose connectivity is to change: a mesh that no positions make valid stays invalid, and the report says
//! by how many cells ([`EmbedReport::n_invalid`]) and whether the boundary itself forbids it ([`EmbedReport::is_impossible`]).
//!
//! Invariants: the same bytes for any number of threads as long as no clock ends the work; a step is kept only if the worst value over whole cells rises;
//! positions are scaled by powers of two only, so that no bit is lost. Papers: Garanzha et al. 2021 (untangling), Johnen, Weill, Remacle 2017 (whole cells),
//! Tutte 1963 (starts), Bobenko, Springborn 2004 and Springborn 2005 (canonical polyhedron), Nocedal 1980 and Lewis and Overton 2013 (L-BFGS); the keys are
//! those of the book's bibliography, and its page `embedding` tells the whole story.

#![warn(unreachable_pub)]
// Matrices and small vectors read like their formulas with indices.
#![allow(clippy::needless_range_loop)]

mod bounds;
mod cell;
mod embed;
mod error;
mod improvement;
mod open;
mod options;
mod pipeline;
mod problem;
mod quality;
mod report;
mod serial;
mod solvers;
mod starts;

pub use bounds::{CornerLimit, EdgeLimit, SideLimit, StarBound, SurfaceLimits, VertexLimit, surface_limits};
pub use embed::{embed, inflate, quick_star_bound, star_bounds, tutte_start, untangle_near};
pub use error::EmbedError;
pub use open::{Open, OpenEffort, open_start};
pub use options::{Objective, Options};
pub use report::{CellQuality, EmbedReport, Embedding};
pub use starts::canonical_polyhedron;
