//! What a surface or a hex mesh is, for people and for JSON.

pub(crate) mod existence;
pub(crate) mod limits;
pub(crate) mod mesh;
pub(crate) mod surface;
