//! What a surface is: genus, chords, key, signature, whether a hex mesh exists and why.
//!
//! Source: ours; keys: Weill.

use crate::info::existence::ExistenceInfo;
use crate::info::limits::{self, LimitsInfo};
use crate::problem::size::at_ordinary_size;
use hexfill_construct::Existence;
use hexfill_mesh::{
    QuadSurface, VertexId, bipartition, chords, improper_pairs, key, surface_automorphisms, surface_signature,
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
    /// Whether a hex mesh exists, and why.
    #[serde(flatten)]
    pub existence: ExistenceInfo,
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

/// Larger surfaces are not searched for symmetries, nor printed as a signature.
pub(crate) const SIGNATURE_LIMIT: usize = 20_000;

/// Describes a surface; `points` are the positions of its vertices, one for each id, in any unit: without them, or with too few, whether a mesh exists may
/// remain unknown. Never fails.
///
/// ```
/// use hexfill::{Problem, describe_surface};
/// let spindle = Problem::named("octagonal-spindle")?;
/// let info = describe_surface(spindle.surface(), spindle.points());
/// assert_eq!((info.chords.len(), info.chords[0].self_crossings), (1, 8));
/// assert_eq!(info.existence.hex_mesh, "exists");
/// assert!(info.limits.is_some_and(|limits| limits.one_edge < 0.52));
/// # Ok::<(), hexfill::ProblemError>(())
/// ```
pub fn describe_surface(surface: &QuadSurface, points: Option<&[[f64; 3]]>) -> SurfaceInfo {
    let small = surface.n_quads() <= SIGNATURE_LIMIT;
    let scaled = points.map(at_ordinary_size);
    let points = scaled.as_deref();
    let colours = bipartition(surface);
    let existence = hexfill_construct::existence(surface, points);
    let bounding_cycle = match &existence {
        Existence::OddCycleBounds { cycle } => Some(cycle.iter().map(|e| [e.0.0, e.1.0]).collect()),
        _ => None,
    };
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
        existence: ExistenceInfo::from(&existence),
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
