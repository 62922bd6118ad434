//! [`LaidMesh`]: what laying makes.
//!
//! Source: ours.

use crate::step::Step;
use hexfill_geometry::Vector;
use hexfill_mesh::HexMesh;

/// A mesh with valid positions, but for what the surface leaves no room for.
#[derive(Clone, Debug)]
pub struct LaidMesh {
    /// The mesh; vertices of the surface keep their ids.
    pub mesh: HexMesh,
    /// All positions; those of the surface bit for bit.
    pub points: Vec<Vector>,
    /// What made each hex.
    pub steps: Vec<Step>,
    /// Hexes of the first pillow that are not valid: at surface vertices where no single interior edge sees all quads, or hardly.
    pub invalid: usize,
    /// Pillows put in, the first included; some may have gone again.
    pub pillows: u32,
}
