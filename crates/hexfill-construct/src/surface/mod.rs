//! What the surface alone tells about its inside, without one tetrahedron: which components bound one solid, which loops bound
//! inside, and so whether a hex mesh exists.

pub(crate) mod existence;
pub(crate) mod linking;
pub(crate) mod nesting;
pub(crate) mod polygons;
pub(crate) mod undecided;
