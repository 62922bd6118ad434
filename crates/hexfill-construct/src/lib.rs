//! A hex mesh for any quad surface that can have one.
//!
//! A pipeline, each step a function in its own folder, read aloud by [`construct`](crate::construct()):
//!
//! | step | from | to |
//! |---|---|---|
//! | `plan` | the surface | its colours, and light sides that suit positions |
//! | `core` | the inner copy of the surface | tetrahedra ([`TetComplex`]) by one of five makers ([`Core`]) |
//! | `layer` | a cube between each quad and its copy | light sides, ids of all points, patterns of the cubes ([`Pattern`]) |
//! | `cut` | the edges of the tetrahedra | those that Sigma, the dual surface, crosses |
//! | `hexes` | patterns, tetrahedra, cuts | hexes by table look-up ([`CellLibrary`]) |
//! | `positions` | the inner copy, templates of cells | start positions |
//! | `joins` | pairs of odd components | a ball each, filled by the construction itself |
//!
//! Below them: `surface` (what the surface alone tells: [`existence()`]) and `cells` (cells as data).
//! The surface stays exactly as it is.
//! Sources: J. Erickson, "Efficiently hex-meshing things with topology" (2014); D. Eppstein (1999);
//! K. Verhetsel, J. Pellerin, J.-F. Remacle (2019). The book's page `construction` tells the whole story in the same order.

#![warn(unreachable_pub)]

mod cells;
mod construct;
mod core;
mod cut;
mod error;
mod hexes;
mod ids;
mod joins;
mod layer;
mod options;
mod plan;
mod positions;
mod report;
mod surface;

pub use cells::cell::Cell;
pub use cells::library::{CellChoice, CellLibrary, PlacedCell};
pub use cells::pattern::{Pattern, Role, SYMMETRIES, Side, Symmetry};
pub use cells::template::{template, template_position};
pub use construct::construct;
pub use core::complex::{TET_EDGES, TetComplex, tet_edge};
pub use core::cone::{BallCore, ConeTets};
pub use core::delaunay::DelaunayTets;
pub use core::from_caller::GivenTets;
pub use core::handlebody::HandlebodyTets;
pub use core::maker::{Core, InteriorTets};
pub use core::request::TetRequest;
pub use core::tetgen::TetgenTets;
pub use core::triangles::core_triangles;
pub use error::ConstructError;
pub use ids::{EdgeId, FaceId, TetId};
pub use options::{ConstructOptions, RouteChoice};
pub use plan::colouring::{Colouring, all_black, colouring};
pub use plan::matching::{LightSides, light_sides};
pub use report::{Construction, Report, Route};
pub use surface::existence::{Existence, existence, forbidden};
