//! Laying: hexes put one by one from a quad surface inward, at valid positions all the way.
//!
//! The sweep of `hexfill-shell` fills surfaces whose chords cross themselves heavily with few hexes, and then no untangling finds positions for all of
//! them at once. Here each hex is laid where it is valid before the next one comes:
//!
//! 1. `plan`: which hexes fill the void, by a sweep, by stirring what it leaves, by the atlas where little is left; topology alone.
//! 2. `void_front`: which of them can be laid now, so that what is left stays a ball.
//! 3. `laying`: the hexes laid, with positions. The void is held open by pyramids to one apex (`hexfill_embed::Open`), so a pillow can always be put in
//!    by scaling its front towards the apex. Where no hex finds room a pillow gives it; where that does not help there is a new plan behind it.
//! 4. `fewer`: sheets that are not needed any more go, as long as the rest has valid positions.
//!
//! When not to use it: where a sweep embeds as it is, which is cheaper and has fewer hexes; on surfaces whose first pillow has no valid positions with
//! one interior edge a vertex (`hexfill_embed::surface_limits` names these), or that an apex cannot hold open.
//!
//! Why a hex always finds room behind enough pillows: the facets of a cube that lie on the front are a disk, its rim a simple circuit of the cube, and
//! every such circuit is the shadow boundary of some convex position of the cube (Barnette 1970); pillows turn the front, which is
//! star-shaped, into any other star-shaped one. How many are needed is not bounded by this argument; here they are counted, and it ends.
//! Measured in `record/self-crossing-2026-11-22.md`.

#![warn(unreachable_pub)]

mod fewer;
mod laid_mesh;
mod lay;
mod laying;
mod plan;
mod void_front;

pub use laid_mesh::LaidMesh;
pub use lay::{LayOptions, lay};
