//! A hex mesh for any quad surface that can have one.
//!
//! One file per step: [`colouring`](crate::colouring()), matching, buffer layer, tetrahedra, Sigma, splitting,
//! assembly. [`construct`] runs them all. The surface stays exactly as it is.
//! Sources: J. Erickson, "Efficiently hex-meshing things with topology" (2014); D. Eppstein (1999);
//! K. Verhetsel, J. Pellerin, J.-F. Remacle (2019). The book's page `construction` tells the whole story.

mod assemble;
mod ball;
mod cell;
mod colouring;
mod construct;
mod darts;
mod delaunay;
mod error;
mod existence;
mod given;
mod handlebody;
mod join;
mod layer;
mod linking;
mod matching;
mod pattern;
mod report;
mod sigma;
#[cfg(test)]
mod sigma_oracle;
mod solids;
mod split;
mod start;
mod strain;
mod tetgen;
mod tets;
mod vector;

pub use ball::{BallCore, BallTets};
pub use cell::{Cell, CellChoice, CellLibrary, PlacedCell};
pub use colouring::{Colouring, all_black, colouring};
pub use construct::{Construction, Options, RouteChoice, construct, core_triangles};
pub use delaunay::DelaunayTets;
pub use error::ConstructError;
pub use existence::{Existence, existence};
pub use given::GivenTets;
pub use handlebody::HandlebodyTets;
pub use matching::{LightSides, light_sides};
pub use pattern::{Pattern, Role, SYMMETRIES, Side, Symmetry};
pub use report::{Report, Route};
pub use start::{template, template_position};
pub use tetgen::TetgenTets;
pub use tets::{InteriorTets, TET_EDGES, TetComplex, TetRequest, tet_edge};
