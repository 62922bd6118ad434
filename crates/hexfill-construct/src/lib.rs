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
//!
//! Not for small or good meshes: it makes some tens of hexes a quad, many of them flat. It is the answer where everything else (atlas, shelling, inward
//! flips) found none; `hexfill::fill` asks the engines in this order.
//!
//! Invariants: the surface stays exactly as it is, its vertices first and with their ids; every hex mesh that a theorem allows is made where the interior is
//! known (a ball, a handlebody with positions, tetrahedra given), and a refusal names the theorem and its certificate ([`Existence`]); linear time and the same
//! bytes for the same input. Papers: Erickson 2014 (section 4 existence, section 5 the construction), Eppstein 1999 (the buffer layer), Verhetsel et al. 2019
//! (cells), Thurston 1993 and Mitchell 1996 (parity), Shewchuk 1997 and 1998 (Delaunay tetrahedra); the keys are those of the book's bibliography, and its page
//! `construction` tells the whole story in the same order.

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
mod misfit;
mod missing;
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
pub use joins::no_chain::NoChain;
pub use misfit::TetMisfit;
pub use missing::MissingInterior;
pub use options::{ConstructOptions, RouteChoice};
pub use plan::colouring::{Colouring, all_black, colouring};
pub use plan::matching::{LightSides, light_sides};
pub use report::{Construction, Report, Route};
pub use surface::existence::{Existence, existence, forbidden};
pub use surface::undecided::Undecided;
