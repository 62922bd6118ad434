//! The cell types of VTK, as numbered in `vtkCellType.h`, shared by legacy and XML files.
//!
//! Source: the VTK formats.

use crate::assembly::{Assembly, Slot};
use crate::data::MeshData;
use crate::orders::{PIXEL, VOXEL, reorder};
use crate::quadratic::{written_faces, written_hexes};

pub(crate) const TRIANGLE: u8 = 5;
pub(crate) const POLYGON: u8 = 7;
pub(crate) const PIXEL_TYPE: u8 = 8;
pub(crate) const QUAD: u8 = 9;
pub(crate) const TETRA: u8 = 10;
pub(crate) const VOXEL_TYPE: u8 = 11;
pub(crate) const HEXAHEDRON: u8 = 12;
pub(crate) const WEDGE: u8 = 13;
pub(crate) const PYRAMID: u8 = 14;
pub(crate) const QUADRATIC_QUAD: u8 = 23;
pub(crate) const QUADRATIC_HEXAHEDRON: u8 = 25;

/// Number of nodes a cell type must have; `None` if it may vary or the type is passed over.
fn nodes_of(cell_type: u8) -> Option<usize> {
    Some(match cell_type {
        TRIANGLE => 3,
        PIXEL_TYPE | QUAD | TETRA => 4,
        VOXEL_TYPE | HEXAHEDRON => 8,
        WEDGE => 6,
        PYRAMID => 5,
        _ => return None,
    })
}

/// The straight type of a cell of higher order, and its number of corners, which come first.
fn straight(cell_type: u8, n_nodes: usize) -> Option<(u8, usize)> {
    Some(match cell_type {
        22 | 34 | 69 | 76 => (TRIANGLE, 3),
        23 | 28 | 30 | 70 | 77 => (QUAD, 4),
        36 => (POLYGON, n_nodes / 2),
        24 | 71 | 78 => (TETRA, 4),
        25 | 29 | 33 | 72 | 79 => (HEXAHEDRON, 8),
        26 | 31 | 32 | 73 | 80 => (WEDGE, 6),
        27 | 37 | 74 | 81 => (PYRAMID, 5),
        _ => return None,
    })
}

/// Adds a cell; of one of higher order its corners.
///
/// # Errors
/// The number of nodes that it should have (as text).
pub(crate) fn add(out: &mut Assembly, cell_type: u8, nodes: &[u32]) -> Result<Slot, String> {
    if let Some((straight, corners)) = straight(cell_type, nodes.len()) {
        let corners = out.corners(nodes, corners);
        return add(out, straight, corners);
    }
    if let Some(due) = nodes_of(cell_type)
        && nodes.len() != due
    {
        return Err(format!("{due} nodes for VTK cell type {cell_type}"));
    }
    Ok(match cell_type {
        PIXEL_TYPE => {
            let nodes = <[u32; 4]>::try_from(nodes).unwrap_or_default();
            out.quad(reorder(nodes, PIXEL), 0)
        }
        TRIANGLE | POLYGON | QUAD => {
            if nodes.len() < 3 {
                return Err("a polygon with three or more nodes".to_owned());
            }
            out.face(nodes, 0)
        }
        VOXEL_TYPE => {
            let nodes = <[u32; 8]>::try_from(nodes).unwrap_or_default();
            out.hex(reorder(nodes, VOXEL), 0)
        }
        HEXAHEDRON => out.hex(<[u32; 8]>::try_from(nodes).unwrap_or_default(), 0),
        TETRA | WEDGE | PYRAMID => {
            out.small_cell(nodes, 0);
            Slot::Elsewhere
        }
        _ => {
            out.ignore(&title(cell_type));
            Slot::Elsewhere
        }
    })
}

fn title(cell_type: u8) -> String {
    match cell_type {
        0 => "empty cells".to_owned(),
        1 | 2 => "vertex cells".to_owned(),
        3 | 4 | 21 => "line cells".to_owned(),
        6 => "triangle strips".to_owned(),
        42 => "polyhedra".to_owned(),
        _ => format!("cells of VTK type {cell_type}"),
    }
}

/// All cells of a mesh with their types and tags, in the order they are written: faces, hexes, then the others.
pub(crate) fn all(data: &MeshData) -> impl Iterator<Item = (u8, &[u32], i64)> {
    let faces = written_faces(data).map(|(face, tag)| {
        let cell_type = match face.len() {
            3 => TRIANGLE,
            4 => QUAD,
            _ if data.quadratic.is_some() => QUADRATIC_QUAD,
            _ => POLYGON,
        };
        (cell_type, face, tag)
    });
    let hex_type = if data.quadratic.is_some() { QUADRATIC_HEXAHEDRON } else { HEXAHEDRON };
    let hexes = written_hexes(data).map(move |(hex, tag)| (hex_type, hex, tag));
    let tets = data.tets.iter().map(|c| (TETRA, c.as_slice(), 0));
    let wedges = data.wedges.iter().map(|c| (WEDGE, c.as_slice(), 0));
    let pyramids = data.pyramids.iter().map(|c| (PYRAMID, c.as_slice(), 0));
    faces.chain(hexes).chain(tets).chain(wedges).chain(pyramids)
}
