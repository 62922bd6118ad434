//! Complete search: every hex ball with at most H hexes on a given quad sphere, or the proof that there is none.
//!
//! Front branching: the open quad that the fewest hexes can cover is covered in each of these ways, until no quad is open. What lies in
//! between may be anything, so meshes that cannot be shelled are found too. A subgroup of the boundary's automorphisms may be imposed:
//! then whole orbits of hexes are placed at once, and the answer is about meshes that have these symmetries.
//!
//! * [`Problem`] says what is searched for, [`Plan`] cuts the tree into tasks that add up, [`Outcome`] is what they found.
//! * Each mesh found is judged by `hexfill-check` before it counts.
//!
//! Not for finding a mesh where any will do: the tree grows exponentially with H, and surfaces of more than 98 quads are refused.
//! `hexfill-search` finds small fillings in a moment and proves nothing; this crate finds all of them, or none and then there is none.
//!
//! Invariants: every ball with at most H hexes (and the symmetries imposed) is met, up to symmetries of the surface, and none twice in
//! one piece of the tree; the pieces a tree is cut into depend on surface, bound and group alone, not on threads or machines; a run is
//! finished only if every piece is in the ledger. Papers: Verhetsel et al. 2018 (abstract: a bound by such a search), Smith 1938 (what a
//! mirror fixes); the keys are those of the book's bibliography, and its page `search` says what was proved.
//!
//! ```
//! use hexfill_mesh::{Context, QuadSurface, cube::FACETS};
//! use hexfill_prove::{Plan, Problem, search_whole};
//!
//! let cube = QuadSurface::try_new(8, &FACETS.map(|f| f.map(|v| v as u32)))?;
//! let ctx = Context::default();
//! let plan = Plan::prepare(Problem::new(&cube, 7)?, &ctx)?;
//! let outcome = search_whole(&plan, 1, &ctx)?;
//! // The cube itself, and the tesseract less a cube.
//! assert_eq!(outcome.classes().into_iter().collect::<Vec<_>>(), [(1, 1), (7, 1)]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bound;
mod code;
mod corners;
mod cover;
mod driver;
mod error;
mod journal;
mod mesh;
mod mirror;
mod orbit;
mod plan;
mod state;
mod symmetry;
mod tree;

pub use driver::{Header, Record, Searched, merge, search, search_whole};
pub use error::ProveError;
pub use mesh::Mesh;
pub use plan::{Outcome, Plan, Problem};
pub use symmetry::{MAX_ORDER, Subgroup, Symmetries};
