//! What no embedding, or no mesh, can beat.
//!
//! | file | bound |
//! |---|---|
//! | `vertex_star` | the directions of the edges at a boundary vertex, the free ones placed best |
//! | `star_directions`, `star_program`, `star_climb`, `star_search`, `sphere_piece` | several free edges at one vertex: programs, branch and bound |
//! | `angle_bound` | solid and dihedral angles shared by corners |
//! | `interior_bound` | how many hexes are round an interior vertex or edge |
//! | `surface_limits` | what a surface allows before there is a mesh |
//!
//! Source: ours; each file names what it builds on.

mod angle_bound;
mod interior_bound;
mod sphere_piece;
mod star_climb;
mod star_directions;
mod star_program;
mod star_search;
mod surface_limits;
mod vertex_star;

pub(crate) use interior_bound::interior_bound;
pub use surface_limits::{CornerLimit, EdgeLimit, SideLimit, SurfaceLimits, VertexLimit, surface_limits};
pub use vertex_star::StarBound;
pub(crate) use vertex_star::{Star, least_bound, refine_stars, star_bounds_of};
