//! Laying: what a sweep leaves is filled by hexes put one by one at valid positions.
//!
//! The sweep of `hexfill-shell` fills surfaces whose chords cross themselves heavily with few hexes, and then no untangling finds positions for all of
//! them at once. What cannot be placed is what fills the last void. So here the sweep stops at the void, all it made is placed, and in the void each hex is
//! laid where it is valid before the next one comes:
//!
//! 0. `pieces`: a large body with limbs is cut across its `waist`s by `membrane`s, disks of quads, into spheres that are filled one by one.
//! 1. `open_mesh`: sweeps behind a pillow, each until no lens can be emptied. The void is held open by pyramids to one apex (`hexfill_embed::Open`);
//!    hexes and pyramids are untangled at once. That takes a moment and works nearly always.
//! 2. `patch`: what lies round the void, so that the rest of a large mesh is not looked at any more.
//! 3. `plan`: which hexes fill the void, by a sweep, by stirring what it leaves, by the atlas where little is left; topology alone.
//! 4. `void_front`: which of them can be laid now, so that what is left stays a ball.
//! 5. `laying`: the hexes laid, with positions. A pillow can always be put in by scaling the front towards the apex. Where no hex finds room a pillow
//!    gives it; where that does not help there is a new plan behind it.
//! 6. `fewer`: sheets that are not needed any more go, as long as the rest has valid positions.
//!
//! When not to use it: where a sweep embeds as it is, which is cheaper and has fewer hexes; where a sweep leaves several voids, or one that no point sees
//! all of though no waist cuts it.
//!
//! Why a hex always finds room behind enough pillows: the facets of a cube that lie on the front are a disk, its rim a simple circuit of the cube, and
//! every such circuit is the shadow boundary of some convex position of the cube (Barnette 1970); pillows turn the front, which is
//! star-shaped, into any other star-shaped one. How many are needed is not bounded by this argument; here they are counted, and it ends.
//! Measured in `record/self-crossing-2026-11-22.md`.
//!
//! Invariants: the surface's vertices stay where they are, to the bit, and come first; between two hexes everything laid is valid in floating point, as is
//! every pyramid over the front (so a pillow is always possible); attempts are numbered and independent, so the result is the same for any number of threads.
//! Nothing is proved here: that is for `hexfill-check`. Papers: Barnette 1970 (room for a hex), Mitchell, Tautges 1995 (pillows), Borden et al. 2002 (sheets
//! taken out); the keys are those of the book's bibliography.
//!
//! ```
//! use hexfill_lay::{LayOptions, lay};
//! use hexfill_mesh::{Context, QuadSurface};
//!
//! // A cube needs no laying: its sweep leaves no void, so nothing is laid and the sweep's own mesh is the answer.
//! let quads = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
//! let cube = QuadSurface::try_new(8, &quads)?;
//! let points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]].map(|p| p.map(f64::from));
//! assert!(lay(&cube, &points, &LayOptions::default(), &Context::default()).is_empty());
//! # Ok::<(), hexfill_mesh::SurfaceError>(())
//! ```

#![warn(unreachable_pub)]

mod fewer;
mod frame;
mod laid_mesh;
mod lay;
mod laying;
mod membrane;
mod open_mesh;
mod patch;
mod pieces;
mod plan;
mod step;
mod void_front;
mod waist;

pub use laid_mesh::LaidMesh;
pub use lay::{LayOptions, lay};
pub use step::Step;
