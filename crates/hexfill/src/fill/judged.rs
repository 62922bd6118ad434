//! Nothing is let out that the judge refused.
//!
//! Source: ours; that every answer passes the checker is varisat's rule.

use crate::fill::error::FillError;
use crate::fill::filled::{FillResult, Filled, Route};
use crate::fill::options::FillOptions;
use hexfill_check::{Judged, Level, judge};
use hexfill_mesh::{Context, HexMesh, QuadSurface, hex_signature};

/// Judges a mesh and keeps it, unless an isomorphic one is kept already or enough are.
pub(crate) fn accept(
    surface: &QuadSurface,
    filled: Filled,
    options: &FillOptions,
    result: &mut FillResult,
) -> Result<(), FillError> {
    if result.meshes.len() >= options.count {
        return Ok(());
    }
    if options.count > 1 {
        let name = hex_signature(&filled.mesh).ok();
        if name.is_some() && result.meshes.iter().any(|m| hex_signature(&m.mesh).ok() == name) {
            return Ok(());
        }
    }
    verify(surface, &filled.mesh, filled.route)?;
    result.meshes.push(filled);
    Ok(())
}

/// Levels 1 to 3 of the judge against the surface.
///
/// # Errors
/// [`FillError::Refused`].
pub(crate) fn verify(surface: &QuadSurface, mesh: &HexMesh, route: Route) -> Result<(), FillError> {
    let hexes = mesh.hexes_raw();
    let quads = surface.quads_raw();
    let judged = Judged::connectivity(mesh.n_vertices(), &hexes).with_surface(&quads);
    let options = hexfill_check::Options::default().with_up_to(Level::L3).with_betti(false).with_quality(false);
    let report = judge(&judged, &options, &Context::default());
    if report.passed(Level::L3) {
        Ok(())
    } else {
        Err(FillError::Refused { route, rules: report.broken_rules().join(", ") })
    }
}
