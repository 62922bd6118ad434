//! The one table of node orders. Everything inside the program is in the order of VTK_HEXAHEDRON
//! (see the drawing in `hexfill_mesh::cube`), which is also that of Gmsh, MEDIT, Exodus, Abaqus (C3D8) and meshio.
//!
//! Each entry is a list of positions in the VTK order: `theirs[i] = vtk[TABLE[i]]`. The tables of
//! [`VOXEL`], [`PIXEL`] and [`OVM_ADD_CELL`] are involutions, so the same line also goes back.
//! Wedges and pyramids are passed on as they come: the formats agree on their order in practice.
//!
//! Source: the manuals of the formats (the VTK formats, the Gmsh manual, Frey 2001, Kremer et al. 2013).

/// VTK_VOXEL (VTK cell type 11), geogram and ultimaille: x fastest, then y, then z.
pub const VOXEL: [usize; 8] = [0, 1, 3, 2, 4, 5, 7, 6];

/// VTK_PIXEL (VTK cell type 8): x fastest, then y.
pub const PIXEL: [usize; 4] = [0, 1, 3, 2];

/// `add_cell` of OpenVolumeMesh's hexahedral kernel.
pub const OVM_ADD_CELL: [usize; 8] = [0, 3, 2, 1, 4, 5, 6, 7];

/// The six half-faces of a hexahedron in an OVM file, in the order `add_cell` makes them: opposite ones side by side,
/// each counter-clockwise seen from *inside* the cell.
pub const OVM_HALF_FACES: [[usize; 4]; 6] =
    [[0, 1, 2, 3], [7, 6, 5, 4], [3, 2, 6, 7], [4, 5, 1, 0], [3, 7, 4, 0], [2, 1, 5, 6]];

/// The faces S1 to S6 of C3D8 in Abaqus and CalculiX, here counter-clockwise seen from outside.
pub const ABAQUS_FACES: [[usize; 4]; 6] =
    [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

/// The edges of a quad, in the order of the middle nodes of VTK_QUADRATIC_QUAD, Gmsh, Abaqus and Nastran.
pub const QUAD_EDGES: [[usize; 2]; 4] = [[0, 1], [1, 2], [2, 3], [3, 0]];

/// The edges of a hexahedron, in the order of the middle nodes of VTK_QUADRATIC_HEXAHEDRON and of C3D20: bottom, top, upright.
pub const HEX_EDGES: [[usize; 2]; 12] =
    [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];

/// The 20-node hexahedron of Gmsh: middles in the order of their smaller, then of their larger corner.
pub const GMSH_HEX20: [usize; 20] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 16, 9, 17, 10, 18, 19, 12, 15, 13, 14];

/// `CHEXA` of Nastran with 20 nodes: bottom, upright, top.
pub const NASTRAN_HEX20: [usize; 20] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15];

/// The parabolic quadrilateral of I-DEAS: corners and middles by turns.
pub const UNV_QUAD8: [usize; 8] = [0, 4, 1, 5, 2, 6, 3, 7];

/// The parabolic brick of I-DEAS: bottom corners and middles by turns, upright middles, top corners and middles by turns.
pub const UNV_HEX20: [usize; 20] = [0, 8, 1, 9, 2, 10, 3, 11, 16, 17, 18, 19, 4, 12, 5, 13, 6, 14, 7, 15];

/// Puts the nodes of one order into the other (`PIXEL`, `VOXEL`, `OVM_ADD_CELL`: either way).
#[inline]
pub fn reorder<const N: usize>(nodes: [u32; N], table: [usize; N]) -> [u32; N] {
    table.map(|i| nodes[i])
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::cube::{FACETS, POSITIONS};

    #[test]
    fn tables_are_involutions() {
        for table in [VOXEL, OVM_ADD_CELL] {
            assert_eq!(table.map(|i| table[i]), [0, 1, 2, 3, 4, 5, 6, 7]);
        }
        assert_eq!(PIXEL.map(|i| PIXEL[i]), [0, 1, 2, 3]);
    }

    #[test]
    fn middles_stand_on_edges_once() {
        for [a, b] in HEX_EDGES {
            let apart = (0..3).filter(|&k| POSITIONS[a][k] != POSITIONS[b][k]).count();
            assert_eq!(apart, 1, "{a} {b}");
        }
        for table in [GMSH_HEX20, NASTRAN_HEX20, UNV_HEX20] {
            let mut sorted = table;
            sorted.sort_unstable();
            assert!(sorted.iter().copied().eq(0..20));
        }
        let ends =
            |i: usize| [HEX_EDGES[i - 8][0].min(HEX_EDGES[i - 8][1]), HEX_EDGES[i - 8][0].max(HEX_EDGES[i - 8][1])];
        assert!(GMSH_HEX20[8..].is_sorted_by_key(|&i| ends(i)));
    }

    #[test]
    fn voxel_counts_in_binary() {
        for (i, &corner) in VOXEL.iter().enumerate() {
            assert_eq!(POSITIONS[corner].map(usize::from), [i & 1, i >> 1 & 1, i >> 2]);
        }
    }

    #[test]
    fn abaqus_faces_are_the_facets() {
        for face in ABAQUS_FACES {
            let turns = |f: &[usize; 4]| (0..4).any(|r| (0..4).all(|k| f[(k + r) % 4] == face[k]));
            assert!(FACETS.iter().any(turns), "{face:?}");
        }
    }

    #[test]
    fn half_faces_are_the_facets_seen_from_inside() {
        for (k, half_face) in OVM_HALF_FACES.iter().enumerate() {
            let mut outside = *half_face;
            outside.reverse();
            let is_rotation = |f: &[usize; 4]| {
                (0..4).any(|r| {
                    let mut turned = *f;
                    turned.rotate_left(r);
                    turned == outside
                })
            };
            assert!(FACETS.iter().any(is_rotation), "half-face {k}");
            assert!(half_face.iter().all(|c| !OVM_HALF_FACES[k ^ 1].contains(c)), "opposite ones side by side");
        }
    }
}
