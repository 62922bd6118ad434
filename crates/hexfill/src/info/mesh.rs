//! What a hex mesh is: sheets, signature, its boundary.
//!
//! Source: ours.

use crate::info::surface::{SIGNATURE_LIMIT, SurfaceInfo, describe_surface};
use hexfill_io::MeshData;
use hexfill_mesh::{HexMeshError, QuadSurface, hex_signature, sheets};
use serde::Serialize;

/// What a hex mesh is, for people and for JSON.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct MeshInfo {
    /// "surface" or "mesh".
    pub kind: &'static str,
    /// Hexes.
    pub hexes: usize,
    /// Vertices that are used.
    pub vertices: usize,
    /// Vertices that are not on the boundary.
    pub interior_vertices: usize,
    /// Quads of the boundary.
    pub boundary_quads: usize,
    /// The sheets of the dual.
    pub sheets: Vec<SheetInfo>,
    /// Canonical signature; absent for large ones.
    pub signature: Option<String>,
    /// The boundary as a surface; absent if it is no closed manifold.
    pub boundary: Option<SurfaceInfo>,
}

/// One sheet.
#[derive(Clone, Debug, Serialize)]
pub struct SheetInfo {
    /// Hexes.
    pub hexes: usize,
    /// How often it crosses itself.
    pub self_crossings: usize,
    /// Chords of the boundary in which it ends.
    pub boundary_chords: usize,
}

/// Describes the hexes of a file.
///
/// ```
/// let entry = hexfill::catalog::find("schneiders-pyramid").expect("in the catalogue");
/// let info = hexfill::describe_mesh(&entry.best_mesh().expect("it has one"))?;
/// assert_eq!((info.hexes, info.boundary_quads), (36, 16));
/// # Ok::<(), hexfill::mesh::HexMeshError>(())
/// ```
///
/// # Errors
/// [`HexMeshError`] if they do not glue.
pub fn describe_mesh(data: &MeshData) -> Result<MeshInfo, HexMeshError> {
    let mesh = data.hex_mesh()?;
    let quads: Vec<[u32; 4]> = mesh.boundary_quads_raw();
    let boundary = QuadSurface::try_new(mesh.n_vertices(), &quads).ok();
    Ok(MeshInfo {
        kind: "mesh",
        hexes: mesh.n_hexes(),
        vertices: mesh.used_vertices().iter().filter(|&&u| u).count(),
        interior_vertices: mesh.n_interior_vertices(),
        boundary_quads: quads.len(),
        sheets: sheets(&mesh)
            .iter()
            .map(|s| SheetInfo {
                hexes: s.n_hexes(),
                self_crossings: s.self_crossings.len(),
                boundary_chords: s.boundary.len(),
            })
            .collect(),
        signature: (mesh.n_hexes() <= SIGNATURE_LIMIT).then(|| hex_signature(&mesh).ok()).flatten(),
        boundary: boundary
            .as_ref()
            .map(|b| describe_surface(b, data.has_coordinates.then_some(data.points.as_slice()))),
    })
}
