//! What a surface or a hex mesh is: genus, chords, sheets, key, signature, whether a hex mesh exists and why.

use crate::fill::check_fillable;
use crate::limits::{self, LimitsInfo};
use crate::scale::at_ordinary_size;
use hexfill_construct::{Existence, existence};
use hexfill_io::MeshData;
use hexfill_mesh::{
    HexMeshError, QuadSurface, VertexId, bipartition, chords, hex_signature, improper_pairs, key, sheets,
    surface_automorphisms, surface_signature,
};
use serde::Serialize;
use std::collections::BTreeMap;

/// What a surface is, for people and for JSON.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct SurfaceInfo {
    /// "surface" or "mesh".
    pub kind: &'static str,
    /// Quads.
    pub quads: usize,
    /// Vertices that are used.
    pub vertices: usize,
    /// Edges.
    pub edges: usize,
    /// Connected components.
    pub components: usize,
    /// Quads and genus of each component, where there are several.
    pub parts: Vec<PartInfo>,
    /// Genus, summed over the components.
    pub genus: u64,
    /// Euler characteristic.
    pub euler: i64,
    /// Whether all cycles of edges are even.
    pub bipartite: bool,
    /// The vertices of an odd cycle of edges, if there is one.
    pub odd_cycle: Option<Vec<u32>>,
    /// "exists", "none" or "unknown".
    pub hex_mesh: &'static str,
    /// Why.
    pub because: String,
    /// The odd cycle that bounds inside, if that is why there is none.
    pub bounding_cycle: Option<Vec<[u32; 2]>>,
    /// How many pairs of quads share more than a vertex or an edge.
    pub improper_pairs: usize,
    /// The first of these pairs.
    pub first_improper_pairs: Vec<[u32; 2]>,
    /// How many vertices have which degree.
    pub degrees: BTreeMap<u32, usize>,
    /// The chords of the dual.
    pub chords: Vec<ChordInfo>,
    /// The key of the chords.
    pub key: String,
    /// Number of automorphisms, reflections included; absent for several components and for large surfaces.
    pub automorphisms: Option<usize>,
    /// Canonical signature; absent for large ones.
    pub signature: Option<String>,
    /// What the positions allow any mesh to reach; absent without positions.
    pub limits: Option<LimitsInfo>,
}

/// One component.
#[derive(Clone, Debug, Serialize)]
pub struct PartInfo {
    /// Quads.
    pub quads: usize,
    /// Genus, summed over the components.
    pub genus: u64,
}

/// One chord.
#[derive(Clone, Debug, Serialize)]
pub struct ChordInfo {
    /// Distinct quads.
    pub quads: usize,
    /// Passages through quads: a quad in which it crosses itself counts twice.
    pub passages: usize,
    /// How often it crosses itself.
    pub self_crossings: usize,
}

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

/// Larger surfaces are not searched for symmetries, nor printed as a signature.
const SIGNATURE_LIMIT: usize = 20_000;

/// Whether a hex mesh exists, why, and the cycle that forbids it.
fn verdict(surface: &QuadSurface, points: Option<&[[f64; 3]]>) -> (&'static str, String, Option<Vec<[u32; 2]>>) {
    if let Err(refusal) = check_fillable(surface) {
        return ("none", refusal.to_string(), None);
    }
    match existence(surface, points) {
        Existence::Exists { because } => ("exists", because.to_owned(), None),
        Existence::OddCycleBounds { cycle } => {
            let edges: Vec<[u32; 2]> = cycle.iter().map(|e| [e.0.0, e.1.0]).collect();
            let shown: Vec<String> = cycle.iter().take(20).map(ToString::to_string).collect();
            let more = if cycle.len() > 20 { " ..." } else { "" };
            let because = format!("an odd cycle of {} edges bounds inside: {}{more}", cycle.len(), shown.join(" "));
            ("none", because, Some(edges))
        }
        Existence::OddSolid { components, given } => {
            let names: Vec<String> = components.iter().map(ToString::to_string).collect();
            let (noun, bound) = if names.len() == 1 { ("component", "bounds") } else { ("components", "bound") };
            let because = format!(
                "{noun} {} {bound} one solid with {given} quads, an odd number: every hex mesh of a connected solid has an even number of boundary quads (Thurston 1993)",
                names.join(", ")
            );
            ("none", because, None)
        }
        Existence::Unknown { reason } => ("unknown", reason, None),
        Existence::OddQuads { given } => ("none", format!("the surface has {given} quads, an odd number"), None),
        Existence::ImproperQuads { pairs } => ("none", format!("quads share too much: {pairs}"), None),
        // A verdict of a later version of the library.
        other => ("unknown", format!("{other:?}"), None),
    }
}

/// Describes a surface; `points` are the positions of its vertices.
pub fn describe_surface(surface: &QuadSurface, points: Option<&[[f64; 3]]>) -> SurfaceInfo {
    let small = surface.n_quads() <= SIGNATURE_LIMIT;
    let scaled = points.map(at_ordinary_size);
    let points = scaled.as_deref();
    let colours = bipartition(surface);
    let (hex_mesh, because, bounding_cycle) = verdict(surface, points);
    let mut degrees = BTreeMap::new();
    for v in 0..surface.n_vertices() {
        let degree = surface.degree(VertexId::new(v));
        if degree > 0 {
            *degrees.entry(degree).or_insert(0) += 1;
        }
    }
    let chords = chords(surface);
    let pairs = improper_pairs(surface);
    let parts = if surface.n_components() > 1 { surface.split_components() } else { Vec::new() };
    SurfaceInfo {
        kind: "surface",
        quads: surface.n_quads(),
        vertices: surface.n_used_vertices(),
        edges: surface.n_edges(),
        components: surface.n_components(),
        parts: parts.iter().map(|(s, _, _)| PartInfo { quads: s.n_quads(), genus: s.genus() }).collect(),
        genus: surface.genus(),
        euler: surface.euler_characteristic(),
        bipartite: colours.is_ok(),
        odd_cycle: colours.err().map(|c| c.vertices.iter().map(|v| v.0).collect()),
        hex_mesh,
        because,
        bounding_cycle,
        improper_pairs: pairs.count,
        first_improper_pairs: pairs.first.iter().map(|p| p.quads.map(|q| q.0)).collect(),
        degrees,
        chords: chords
            .iter()
            .map(|c| ChordInfo {
                quads: c.length(),
                passages: c.crossings.len(),
                self_crossings: c.self_crossings.len(),
            })
            .collect(),
        key: key(surface).to_string(),
        automorphisms: (small && surface.n_components() == 1).then(|| surface_automorphisms(surface).len()),
        signature: small.then(|| surface_signature(surface)),
        limits: points.and_then(|points| limits::describe(surface, points)),
    }
}

/// Describes the hexes of a file.
///
/// # Errors
/// [`HexMeshError`] if they do not glue.
pub fn describe_mesh(data: &MeshData) -> Result<MeshInfo, HexMeshError> {
    let mesh = data.hex_mesh()?;
    let quads: Vec<[u32; 4]> = mesh.boundary_quads().iter().map(|q| q.map(|v| v.0)).collect();
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
