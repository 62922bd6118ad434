//! Shelling: closed quad surfaces of any size swept inward by their own dual curves, until nothing is left to fill.
//!
//! Two engines. By layers: `angles` what every edge wants -> `compress` parallel chords become one -> `solve` layers and
//! closings (`layer`) on the void (`void`) -> `lift` back to the fine surface. By flips: `front` what is left -> `lens` the
//! smallest lens of its dual -> `zip` flips that empty it -> `sweep` until nothing is left. Both know by a pair table (`pairs`)
//! what is joined already.
//! Before them: `plug` cuts handles, `bridge` joins cavities to the outside. Without any sweep: `polycube`, `section`, `blocks`, `between`.
//!
//! | question | verb |
//! |---|---|
//! | meshes of a surface, all engines | [`shell()`] |
//! | one sweep by flips, and what it left | [`sweep()`] |
//! | a second inner edge at vertices that no single one can serve | [`split_stars`] |
//! | one sheet more round some hexes | [`pillow()`] |
//! | thin layers under the surface | [`cut_boundary_layers`] |
//! | fewer hexes where the surface is far | [`Coarsening`] |
//!
//! Not a guarantee: a surface whose chords cross themselves may be left with a void ([`Shelling::left`]); `hexfill-construct` fills every surface that can
//! be filled, with more hexes. What is returned is complete, but it is for `hexfill-check` to judge.
//!
//! Invariants: the surface's vertices keep their ids and come first; every stage is a ball glued on (both engines refuse a hex that would use a pair of
//! vertices twice, the theorem of `hexfill-search`'s page on flips); the same result for any number of threads. Papers: Thurston 1993 and Folwell, Mitchell
//! 1999 (sheets swept by curve contraction), Bern, Eppstein and Erickson 2002 (flips), Gordon, Hall 1973 (blocks); the keys are those of the book's bibliography.

mod angles;
mod between;
mod blend;
mod blocks;
mod boundary_layers;
mod bridge;
mod cells;
mod classes;
mod close;
mod coarsen;
mod compress;
mod dart;
mod develop;
mod deviation;
mod front;
mod glue;
mod inside;
mod layer;
mod lens;
mod lift;
mod pairs;
mod pillow;
mod plug;
mod polycube;
mod quadrangulation;
mod section;
mod shell;
mod shell_options;
mod solve;
mod split_star;
mod stacks;
mod stage;
mod stir;
mod sweep;
mod sweep_options;
mod sweeper;
mod void;
mod zip;

#[cfg(test)]
mod sweep_tests;
#[cfg(test)]
mod test_surfaces;

pub use boundary_layers::{BoundaryLayers, CutLayers, cut_boundary_layers};
pub use coarsen::{Coarsened, Coarsening};
pub use front::{Front, FrontError, Mark};
pub use lift::CoarseMesh;
pub use pillow::{Pillowed, pillow};
pub use quadrangulation::Quadrangulation;
pub use shell::{Shelled, Shelling, shell};
pub use shell_options::ShellOptions;
pub use split_star::{Layer, SplitOptions, SplitStars, SplitVertex, split_stars};
pub use stage::Stage;
pub use stir::stir_front;
pub use sweep::{Swept, sweep, sweep_front};
pub use sweep_options::{EdgeWant, SweepOptions};
pub use zip::Refused;
