//! A mesh found, judged before it counts.
//!
//! Source: ours.

use crate::error::ProveError;
use crate::state::Hex;
use hexfill_check::{Ball, Judged, Level, Options, Parts, Rule, judge};
use hexfill_mesh::{Context, HexMesh, QuadSurface, hex_signature};

/// A finished mesh: hexes over the surface's vertex ids, interior vertices after them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mesh {
    /// Number of vertices.
    pub n_vertices: usize,
    /// The hexes in VTK order.
    pub hexes: Vec<[u32; 8]>,
}

impl Mesh {
    pub(crate) fn new(hexes: &[Hex]) -> Self {
        let hexes: Vec<[u32; 8]> = hexes.iter().map(|h| h.map(u32::from)).collect();
        Self { n_vertices: hexes.iter().flatten().max().map_or(0, |&v| v as usize + 1), hexes }
    }
}

/// What may be wrong with the link of a vertex whose parts are all right: the tree does not look for it, so such a mesh is no ball but
/// no defect either.
const PINCHED: [Rule; 3] = [Rule::VertexPinched, Rule::VertexLinkNotDisk, Rule::VertexLinkNotSphere];

/// The signature of a mesh that the judge accepts to level 3, boundary and all, and does not find to be no ball; `None` if vertices are pinched,
/// or if the homology over GF(2) is not a ball's. (Euler's formula and the links do not tell a ball from, say, a punctured projective space; the
/// tree leads to both.)
///
/// # Errors
/// [`ProveError::Refused`] if it breaks another rule: the search was wrong.
pub(crate) fn signature_of(surface: &QuadSurface, mesh: &Mesh) -> Result<Option<String>, ProveError> {
    let quads: Vec<[u32; 4]> = surface.quads_raw();
    let options = Options::default().with_up_to(Level::L3).with_parts(Parts::One);
    let judged = Judged::connectivity(mesh.n_vertices, &mesh.hexes).with_surface(&quads);
    let report = judge(&judged, &options, &Context::default());
    let refused = |rules: String| ProveError::Refused { rules, hexes: mesh.hexes.clone() };
    if !report.passed(Level::L3) {
        if report.failures.iter().all(|f| PINCHED.contains(&f.rule)) {
            return Ok(None);
        }
        return Err(refused(report.broken_rules().join(", ")));
    }
    if report.facts.ball == Some(Ball::No) {
        return Ok(None);
    }
    let mesh = HexMesh::try_new(mesh.n_vertices, &mesh.hexes).map_err(|e| refused(e.to_string()))?;
    Ok(Some(hex_signature(&mesh).map_err(|e| refused(e.to_string()))?))
}
