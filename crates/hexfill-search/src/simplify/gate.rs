//! [`Gate`]: who may refuse an exchange that is proper, because of what this crate does not know (positions, say).
//!
//! Source: ours.

/// Asked about each exchange before it is made. Vertices have the ids of the mesh at work: those of the input as they were; new ones, when an exchange
/// brings them, ids from the input's number of vertices on or ids that are free again.
pub trait Gate {
    /// Whether the hexes `added` may take the place of `removed`; ids from `first_new` on stand for vertices that they bring.
    fn admits(&mut self, removed: &[[u32; 8]], added: &[[u32; 8]], first_new: u32) -> bool;

    /// The exchange admitted last was made: `added` in the same order, with the ids its new vertices got.
    fn made(&mut self, added: &[[u32; 8]]);
}
