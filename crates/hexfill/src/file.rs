//! Meshes as file data, and into files.
//!
//! Source: ours.

use crate::fill::filled::Filled;
use crate::place::placed::Placed;
use crate::problem::Problem;
use hexfill_io::{MeshData, TagName, TagOn, WriteError};
use hexfill_mesh::HexMesh;
use std::path::Path;

/// Writes a mesh with its positions and numbers per hex: `engine` and `layer` ([`Filled::flag`]) and, if positions were judged, `certified_positive` and
/// `scaled_jacobian` ([`Placed::flag`]). The format follows from
/// the extension; the file appears whole or not at all.
///
/// # Errors
/// [`WriteError`]: the format is unknown or holds no hexes, or the file cannot be written.
pub fn save(path: &Path, problem: &Problem, filled: &Filled, placed: Option<&Placed>) -> Result<(), WriteError> {
    let mut data = mesh_data(problem, &filled.mesh, placed.map(|p| p.points.clone()));
    if let Some(placed) = placed.filter(|p| !p.cells.is_empty()) {
        placed.flag(&mut data);
    }
    filled.flag(&mut data);
    hexfill_io::write_path(path, None, &data)
}

/// The mesh as file data: the surface's points first, bit for bit, its quads in their order with their tags, then the hexes.
/// `points` are the positions of all vertices of `mesh`, one each, or `None` for connectivity alone; `mesh` is one of the problem's surface, whose ids come
/// first. Nothing is checked here: writing refuses arrays that do not fit together ([`MeshData::check_for`]).
pub fn mesh_data(problem: &Problem, mesh: &HexMesh, points: Option<Vec<[f64; 3]>>) -> MeshData {
    let mut data = problem.data();
    data.hexes = mesh.hexes_raw();
    data.has_coordinates = points.is_some();
    data.points = points.unwrap_or_default();
    if let Some(tags) = &mut data.point_tags {
        tags.resize(mesh.n_vertices(), 0);
    }
    for (_, values) in &mut data.point_data {
        values.resize(mesh.n_vertices(), f64::NAN);
    }
    if data.quad_tags.is_some() {
        // Programs that work with groups want one for the cells, too.
        data.hex_tags = Some(vec![1; data.hexes.len()]);
        data.tag_names.push(TagName { on: TagOn::Cells, tag: 1, name: "volume".to_owned() });
    }
    data
}
