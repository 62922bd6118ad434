//! Regular hex meshes.
//!
//! Source: ours.

use crate::cube::POSITIONS;
use crate::hexmesh::{HexMesh, HexMeshError};
use rustc_hash::FxHashMap;

/// A block of `nx * ny * nz` hexes; vertex (i, j, k) is `i + (nx + 1) * (j + (ny + 1) * k)`.
///
/// # Errors
/// [`HexMeshError::TooLarge`].
pub fn grid(nx: usize, ny: usize, nz: usize) -> Result<HexMesh, HexMeshError> {
    let n_hexes = nx.saturating_mul(ny).saturating_mul(nz);
    if n_hexes > HexMesh::MAX_HEXES {
        return Err(HexMeshError::TooLarge { what: "hexes", given: n_hexes, limit: HexMesh::MAX_HEXES });
    }
    let mut hexes = Vec::with_capacity(n_hexes);
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                hexes.push(POSITIONS.map(|p| {
                    let [x, y, z] = [i + p[0] as usize, j + p[1] as usize, k + p[2] as usize];
                    (x + (nx + 1) * (y + (ny + 1) * z)) as u32
                }));
            }
        }
    }
    HexMesh::try_new((nx + 1) * (ny + 1) * (nz + 1), &hexes)
}

/// The filled cells of a grid of `size` unit cells as hexes; vertices numbered by first use, cells in the order x fastest.
///
/// # Errors
/// [`HexMeshError::TooLarge`].
pub fn grid_mesh_of(size: [usize; 3], filled: impl Fn([usize; 3]) -> bool) -> Result<HexMesh, HexMeshError> {
    let mut ids = FxHashMap::default();
    let mut hexes = Vec::new();
    for z in 0..size[2] {
        for y in 0..size[1] {
            for x in 0..size[0] {
                if filled([x, y, z]) {
                    hexes.push(POSITIONS.map(|p| {
                        let next = ids.len() as u32;
                        *ids.entry([x + p[0] as usize, y + p[1] as usize, z + p[2] as usize]).or_insert(next)
                    }));
                }
            }
        }
    }
    HexMesh::try_new(ids.len(), &hexes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_are_blocks() {
        let mesh = grid(2, 3, 4).unwrap();
        mesh.debug_check();
        assert_eq!((mesh.n_hexes(), mesh.boundary_facets().count(), mesh.n_interior_vertices()), (24, 52, 6));
        assert!(grid(1 << 20, 1 << 20, 1 << 20).is_err());
        let tray = grid_mesh_of([3, 3, 1], |[x, y, _]| (x, y) != (1, 1)).unwrap();
        assert_eq!((tray.n_hexes(), tray.boundary_facets().count()), (8, 32));
    }
}
