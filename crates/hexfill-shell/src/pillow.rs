//! [`pillow`]: one sheet more, round some hexes of a mesh.
//!
//! Source: Mitchell, Tautges 1995.

use crate::cells::{Cells, is_sphere};

/// A mesh with a pillow.
#[derive(Clone, Debug)]
pub struct Pillowed {
    /// The hexes of the mesh in their order, those inside with copies of the vertices on their surface, then the pillow's.
    pub hexes: Vec<[u32; 8]>,
    /// The vertices that were copied, ascending; their copies follow the vertices there were, in this order.
    pub copied: Vec<u32>,
}

/// Puts a pillow round the hexes of `set` (ascending) of a mesh: a sheet of one hex over each facet of their surface (Mitchell, Tautges 1995). `None` if that surface is no sphere. The boundary of the mesh stays as it is, and cells that met properly still do.
///
/// # Example
/// A pillow round one of two cubes: it stays inside, six hexes more.
/// ```
/// use hexfill_mesh::HexMesh;
/// use hexfill_shell::pillow;
///
/// let hexes = [[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11]];
/// let made = pillow(12, &hexes, &[0]).expect("the surface of one hex is a sphere");
/// assert_eq!((made.hexes.len(), made.copied.len()), (8, 8));
/// assert_eq!(HexMesh::try_new(20, &made.hexes)?.boundary_quads().len(), 10);
/// # Ok::<(), hexfill_mesh::HexMeshError>(())
/// ```
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
