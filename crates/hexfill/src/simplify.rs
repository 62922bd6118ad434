//! `simplify`: a mesh with fewer hexes and the same boundary, judged before it is given out.
//!
//! Source: Verhetsel et al. 2018, by way of `hexfill-search`; Schneiders 1996, by way of `hexfill-shell`.

use crate::keep_valid::Valid;
use hexfill_check::{Judged, Level, Parts, judge};
use hexfill_io::{MeshData, TagOn};
use hexfill_mesh::{Context, HexMesh, HexMeshError, StopReason, VertexId};
use hexfill_search::{
    Atlas, Simplified, SimplifyOptions, SimplifyReport, collapse, simplification_atlas, simplify as simplify_mesh,
    simplify_gated,
};
use hexfill_shell::{Coarsened, Coarsening};

/// Why a mesh cannot be simplified.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SimplifyError {
    /// The hexes do not glue.
    #[error(transparent)]
    Mesh(#[from] HexMeshError),
    /// The mesh breaks a rule of levels 1 to 3: exchanging parts of it could make it worse.
    #[error("the mesh is not proper, it fails {rules}; `hexfill check` says where")]
    NotProper {
        /// The rules it breaks.
        rules: String,
    },
    /// A mesh was made that the judge refused: a defect of this program.
    #[error("internal error: the simplified mesh fails {rules}; please report this mesh")]
    Refused {
        /// The rules it breaks.
        rules: String,
    },
}

/// A mesh as file data after [`simplify`].
#[derive(Clone, Debug)]
pub struct SimplifiedData {
    /// The mesh. Points of the input that are still used keep their order, position, tag and data; new ones lie at the mean of
    /// their neighbours and have tag 0 and no data. The faces of the file stay, in their order, with their tags and data.
    pub data: MeshData,
    /// Per point: the point of the input it was, or `None`.
    pub origin: Vec<Option<VertexId>>,
    /// What was done.
    pub report: SimplifyReport,
}

/// How many balls to try where neither a number nor a time is given: ten a hex, and 20,000 at least.
pub fn default_balls(hexes: usize) -> u64 {
    (10 * hexes as u64).max(20_000)
}

/// Collapses closed sheets and columns and replaces balls of hexes by smaller fillings from the atlas (without one:
/// [`simplification_atlas`]); the boundary stays as it is, its positions bit for bit. What comes back has passed levels 1 to 3 of the judge, its boundary being the input's; if
/// nothing smaller was found it is the input. Embed again afterwards: new interior points only have means of positions.
///
/// ```
/// use hexfill::{Context, FillOptions, Problem, SimplifyOptions, Strategy, fill, mesh_data, simplify};
///
/// let (cube, ctx) = (Problem::named("cube")?, Context::default());
/// let constructed = fill(&cube, &FillOptions::default().with_strategy(Strategy::Construct), &ctx)?;
/// let data = mesh_data(&cube, constructed.meshes[0].mesh(), None);
/// let made = simplify(&data, &SimplifyOptions::default().with_balls(100), None, &ctx)?;
/// assert!(made.report.after < made.report.before && made.data.hexes.len() == made.report.after);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`SimplifyError::Mesh`] or [`SimplifyError::NotProper`] for hexes that are no proper mesh; [`SimplifyError::Refused`] for a defect of this program.
pub fn simplify(
    data: &MeshData,
    options: &SimplifyOptions,
    atlas: Option<&Atlas>,
    ctx: &Context<'_>,
) -> Result<SimplifiedData, SimplifyError> {
    let mesh = HexMesh::try_new(data.vertex_count(), &data.hexes)?;
    // Proper before is what the exchange of balls keeps; of an improper mesh nothing could be promised.
    judged(&mesh, None).map_err(|rules| SimplifyError::NotProper { rules })?;
    let made = simplified(&mesh, options, atlas, ctx);
    let points = data.has_coordinates.then(|| carried_positions(&made.mesh, &made.origin, &data.points));
    carried(data, &mesh, made, points)
}

/// [`simplify`] that never worsens the geometry: an exchange of balls is made only if its new points have positions with which no more hexes fail the judge's certificate
/// than before and the smallest certified scaled Jacobian of the hexes exchanged is no smaller. No point that stays is moved, and nothing is collapsed; only exchanges for
/// fewer hexes are looked for.
///
/// # Errors
/// As [`simplify`]; data without coordinates are treated as [`simplify`] treats them.
pub fn simplify_keeping_valid(
    data: &MeshData,
    options: &SimplifyOptions,
    atlas: Option<&Atlas>,
    ctx: &Context<'_>,
) -> Result<SimplifiedData, SimplifyError> {
    if !data.has_coordinates {
        return simplify(data, options, atlas, ctx);
    }
    let mesh = HexMesh::try_new(data.vertex_count(), &data.hexes)?;
    judged(&mesh, None).map_err(|rules| SimplifyError::NotProper { rules })?;
    let mut gate = Valid::new(data.points.clone());
    let (made, ids) = simplify_gated(&mesh, atlas.unwrap_or_else(|| simplification_atlas()), options, &mut gate, ctx);
    let points = ids.iter().map(|&v| gate.point(v)).collect();
    carried(data, &mesh, made, Some(points))
}

/// Three sheets that lie one on the other become one inside ([`Coarsening`]), in so many rounds at most; every stack is folded once a round. What comes back has passed levels 1 to
/// 3 of the judge, and its points are those of the input: untangle it with [`embed_mesh`](crate::embed_mesh) afterwards, as hexes at the turns are flat.
///
/// ```
/// use hexfill::{Context, FillOptions, Problem, coarsen, fill, mesh_data};
///
/// let (surface, points) = hexfill_mesh::generate::voxels([12, 12, 12], |_| true)?;
/// let problem = Problem::new("box", surface, points.into_iter().map(|p| p.map(f64::from)).collect())?;
/// let ctx = Context::default();
/// let filled = fill(&problem, &FillOptions::default(), &ctx)?;
/// let data = mesh_data(&problem, filled.meshes[0].mesh(), None);
/// let made = coarsen(&data, u32::MAX, &ctx)?;
/// assert!(made.report.before == 1728 && made.report.after < 1200);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`simplify`].
pub fn coarsen(data: &MeshData, rounds: u32, ctx: &Context<'_>) -> Result<SimplifiedData, SimplifyError> {
    let mesh = HexMesh::try_new(data.vertex_count(), &data.hexes)?;
    judged(&mesh, None).map_err(|rules| SimplifyError::NotProper { rules })?;
    let mut coarsening = Coarsening::new(&mesh);
    for _ in 0..rounds {
        if ctx.stop().is_some() || !coarsening.round(ctx) {
            break;
        }
    }
    let Coarsened { mesh: coarse, vertices, .. } = coarsening.mesh()?;
    let origin = vertices.iter().map(|&v| Some(VertexId(v))).collect();
    let mut report = SimplifyReport::new(mesh.n_hexes());
    report.after = coarse.n_hexes();
    report.stop = ctx.stop().unwrap_or(StopReason::Finished);
    let points = data.has_coordinates.then(|| vertices.iter().map(|&v| data.points[v as usize]).collect());
    carried(data, &mesh, Simplified { mesh: coarse, origin, report }, points)
}

/// What was made of the mesh `before` as file data, at these positions.
fn carried(
    data: &MeshData,
    mesh: &HexMesh,
    made: Simplified,
    points: Option<Vec<[f64; 3]>>,
) -> Result<SimplifiedData, SimplifyError> {
    if made.report.after == made.report.before {
        return Ok(SimplifiedData { data: data.clone(), origin: made.origin, report: made.report });
    }
    let mut number = vec![u32::MAX; mesh.n_vertices()];
    for (new, old) in made.origin.iter().enumerate() {
        if let Some(old) = old {
            number[old.index()] = new as u32;
        }
    }
    let boundary: Vec<[u32; 4]> = mesh.boundary_quads().into_iter().map(|q| q.map(|v| number[v.index()])).collect();
    judged(&made.mesh, Some(&boundary)).map_err(|rules| SimplifyError::Refused { rules })?;

    let mut out = data.clone();
    out.hexes = made.mesh.hexes_raw();
    // Faces inside the mesh may be gone with their points; those of the boundary never are.
    let stays = |face: &[u32]| face.iter().all(|&v| number[v as usize] != u32::MAX);
    let kept: Vec<usize> = (0..data.quads.len()).filter(|&q| stays(&data.quads[q])).collect();
    out.quads = kept.iter().map(|&q| data.quads[q].map(|v| number[v as usize])).collect();
    let on_kept = |values: &Vec<f64>| kept.iter().map(|&q| values[q]).collect();
    out.quad_data = data.quad_data.iter().map(|(name, values)| (name.clone(), on_kept(values))).collect();
    out.quad_tags = data.quad_tags.as_ref().map(|tags| kept.iter().map(|&q| tags[q]).collect());
    if kept.len() < data.quads.len() {
        out.notes.push(format!("{} faces inside the mesh are gone with their points", data.quads.len() - kept.len()));
    }
    // Exchanged hexes belong to the material of those they stand for only if there is one.
    let material = data.hex_tags.as_ref().map(|tags| (tags[0], tags.iter().all(|&t| t == tags[0])));
    out.hex_tags = material.filter(|&(_, single)| single).map(|(tag, _)| vec![tag; out.hexes.len()]);
    if material.is_some_and(|(_, single)| !single) {
        out.tag_names.retain(|n| n.on != TagOn::Cells);
    }
    if !data.hex_data.is_empty() || out.hex_tags.is_none() && data.hex_tags.is_some() {
        out.notes
            .push("data of hexes and their tags, if they differ, are dropped: the hexes are others now".to_owned());
    }
    out.hex_data = Vec::new();
    let at = |values: &Vec<f64>| made.origin.iter().map(|o| o.map_or(f64::NAN, |v| values[v.index()])).collect();
    out.point_data = data.point_data.iter().map(|(name, values)| (name.clone(), at(values))).collect();
    let tag = |tags: &Vec<i64>| made.origin.iter().map(|o| o.map_or(0, |v| tags[v.index()])).collect();
    out.point_tags = data.point_tags.as_ref().map(tag);
    if let Some(points) = points {
        out.points = points;
    }
    Ok(SimplifiedData { data: out, origin: made.origin, report: made.report })
}

/// The mesh made smaller. An atlas is grown only if there are balls to look up.
pub(crate) fn simplified(
    mesh: &HexMesh,
    options: &SimplifyOptions,
    atlas: Option<&Atlas>,
    ctx: &Context<'_>,
) -> Simplified {
    if options.balls() == 0 {
        return collapse(mesh, options.collapses(), ctx);
    }
    simplify_mesh(mesh, atlas.unwrap_or_else(|| simplification_atlas()), options, ctx)
}

/// Positions after a simplification: those of vertices that stayed, bit for bit; new vertices move to the mean of their
/// neighbours, a few times over so that new ones next to new ones settle.
pub(crate) fn carried_positions(mesh: &HexMesh, origin: &[Option<VertexId>], points: &[[f64; 3]]) -> Vec<[f64; 3]> {
    const ROUNDS: usize = 32;
    let mut placed: Vec<Option<[f64; 3]>> = origin.iter().map(|o| o.map(|v| points[v.index()])).collect();
    let fresh: Vec<usize> = (0..origin.len()).filter(|&v| origin[v].is_none()).collect();
    let mut neighbours: Vec<Vec<usize>> = vec![Vec::new(); fresh.len()];
    for [a, b] in mesh.edges() {
        for (v, w) in [(a, b), (b, a)] {
            if let Ok(i) = fresh.binary_search(&v.index()) {
                neighbours[i].push(w.index());
            }
        }
    }
    for _ in 0..ROUNDS {
        for (&v, around) in fresh.iter().zip(&neighbours) {
            let known: Vec<[f64; 3]> = around.iter().filter_map(|&w| placed[w]).collect();
            if !known.is_empty() {
                // Divided before they are added: no finite input overflows.
                let share = 1.0 / known.len() as f64;
                placed[v] = Some([0, 1, 2].map(|k| known.iter().map(|p| p[k] * share).sum()));
            }
        }
    }
    placed.into_iter().map(Option::unwrap_or_default).collect()
}

/// Levels 1 to 3 of the judge; the rules broken if it refuses.
fn judged(mesh: &HexMesh, boundary: Option<&[[u32; 4]]>) -> Result<(), String> {
    let hexes = mesh.hexes_raw();
    let mut judged = Judged::connectivity(mesh.n_vertices(), &hexes);
    if let Some(quads) = boundary {
        judged = judged.with_surface(quads);
    }
    let options = hexfill_check::Options::default()
        .with_up_to(Level::L3)
        .with_parts(Parts::Any)
        .with_betti(false)
        .with_quality(false);
    let report = judge(&judged, &options, &Context::default());
    if report.passed(Level::L3) { Ok(()) } else { Err(report.broken_rules().join(", ")) }
}
