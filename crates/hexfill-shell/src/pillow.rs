//! [`pillow`]: one sheet more, round some hexes of a mesh.

use crate::cells::{Cells, is_sphere};

/// A mesh with a pillow.
#[derive(Clone, Debug)]
pub struct Pillowed {
    /// The hexes of the mesh in their order, those inside with copies of the vertices on their surface, then the pillow's.
    pub hexes: Vec<[u32; 8]>,
    /// The vertices that were copied, ascending; their copies follow the vertices there were, in this order.
    pub copied: Vec<u32>,
}

/// Puts a pillow round the hexes of `set` (ascending) of a mesh: a sheet of one hex over each facet of their surface (Mitchell, Tautges, *Pillowing
/// doublets*, 1995). `None` if that surface is no sphere. The boundary of the mesh stays as it is, and cells that met properly still do.
pub fn pillow(n_vertices: usize, hexes: &[[u32; 8]], set: &[u32]) -> Option<Pillowed> {
    let mut cells = Cells::of(n_vertices, hexes.to_vec());
    let mut skin = cells.skin(set);
    skin.sort_unstable();
    if !is_sphere(&skin) {
        return None;
    }
    let copied = cells.shrink(set, &skin).copied;
    Some(Pillowed { hexes: cells.into_hexes(), copied })
}
