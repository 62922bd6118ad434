//! A mesh found, judged before it counts.

use crate::error::ProveError;
use crate::state::Hex;
use hexfill_check::{Judged, Level, Options, Parts, judge};
use hexfill_mesh::{Context, HexMesh, QuadSurface, hex_signature};

/// A finished mesh: hexes over the surface's vertex ids, interior vertices after them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mesh {
    /// Number of vertices.
    pub n_vertices: usize,
    /// The hexes in VTK order.
    pub hexes: Vec<[u32; 8]>,
}

/// The mesh and its signature if the judge accepts it to level 3; `None` if its vertices' links are no spheres or disks, which the search does
/// not look for.
///
/// # Errors
/// [`ProveError::Refused`] if it breaks another rule: the search was wrong.
pub(crate) fn judged(surface: &QuadSurface, hexes: &[Hex]) -> Result<Option<(String, Mesh)>, ProveError> {
    let hexes: Vec<[u32; 8]> = hexes.iter().map(|h| h.map(u32::from)).collect();
    let n_vertices = hexes.iter().flatten().max().map_or(0, |&v| v as usize + 1);
    let quads: Vec<[u32; 4]> = surface.quads().iter().map(|q| q.map(|v| v.0)).collect();
    let options = Options::default().up_to(Level::L3).parts(Parts::One);
    let report = judge(&Judged::connectivity(n_vertices, &hexes).with_surface(&quads), &options, &Context::default());
    if !report.passed(Level::L3) {
        let rules = report.broken_rules();
        return Err(ProveError::Refused { rules: rules.join(", "), hexes });
    }
    let refused = |e: String| ProveError::Refused { rules: e, hexes: hexes.clone() };
    let mesh = HexMesh::try_new(n_vertices, &hexes).map_err(|e| refused(e.to_string()))?;
    let signature = hex_signature(&mesh).map_err(|e| refused(e.to_string()))?;
    Ok(Some((signature, Mesh { n_vertices, hexes })))
}
