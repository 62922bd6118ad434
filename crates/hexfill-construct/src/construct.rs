//! The construction from end to end: each step a function, in the order of the folders.
//!
//! Source: Erickson 2014, section 5; the order of the steps is that of the book's page `construction`.

use crate::core::core;
use crate::cut::cut;
use crate::error::ConstructError;
use crate::hexes::hexes;
use crate::joins::{ball_of, ball_options, replace};
use crate::layer::layer;
use crate::options::ConstructOptions;
use crate::plan::{plan, stage};
use crate::positions::positions;
use crate::report::Construction;
use hexfill_mesh::{Context, HexMesh, QuadSurface};

/// Fills `surface` with hexes; `points` are the positions of its vertices, if any.
///
/// Linear time and memory (the tetrahedra's edges and faces are sorted). The same bytes for the same input.
///
/// # Errors
/// [`ConstructError`]: no hex mesh exists (with the certificate), the interior is not known, or the work was stopped.
///
/// # Example
/// ```
/// use hexfill_construct::{ConstructOptions, construct};
/// use hexfill_mesh::{Context, QuadSurface};
///
/// let quads = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
/// let cube = QuadSurface::try_new(8, &quads)?;
/// let made = construct(&cube, None, &ConstructOptions::default(), &Context::default())?;
/// assert_eq!(made.mesh.boundary_quads().len(), 6);
/// assert_eq!(made.mesh.n_hexes(), made.report.n_hexes());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn construct(
    surface: &QuadSurface,
    points: Option<&[[f64; 3]]>,
    options: &ConstructOptions,
    ctx: &Context<'_>,
) -> Result<Construction, ConstructError> {
    let plan = plan(surface, points, options, ctx)?;
    let mut core = core(&plan, ctx)?;
    let layer = layer(&plan, &core, ctx)?;
    let cut = cut(&plan, &core, &layer, ctx)?;
    let (mut hexes, mut report) = hexes(&plan, &core, &layer, &cut, ctx)?;
    // Before the joins: their balls take positions from the hexes round them.
    let mut start = positions(&plan, &mut core, &layer, &hexes.core);
    let mut fillings = Vec::with_capacity(core.corridors.len());
    for corridor in &core.corridors {
        stage("odd components", ctx)?;
        let ball = ball_of(corridor, &layer, &hexes, start.as_ref(), ctx)?;
        let quiet = Context { progress: None, ..*ctx };
        // A ball is a sphere with an even number of quads, so it needs no join of its own: the recursion is one deep.
        let filling = construct(&ball.surface, ball.points.as_deref(), &ball_options(plan.library), &quiet)?;
        report.count_join(ball.n_removed(), filling.mesh.n_hexes());
        fillings.push((ball, filling));
    }
    replace(&fillings, surface.n_vertices(), &mut hexes, start.as_mut())?;
    stage("mesh", ctx)?;
    // The mesh needs as much memory as all before it.
    drop((core, layer, cut));
    let n_vertices = hexes.core.end.index();
    let hexes: Vec<[u32; 8]> = hexes.hexes.into_iter().map(|h| h.map(|p| p.0)).collect();
    let mesh = HexMesh::try_new(n_vertices, &hexes)?;
    Ok(Construction { mesh, report, start: start.map(|start| start.into_vec()) })
}
