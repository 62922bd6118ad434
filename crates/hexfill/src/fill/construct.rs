//! The construction, made smaller if that was asked for.
//!
//! Source: ours.

use crate::fill::attempt::Attempt;
use crate::fill::error::FillError;
use crate::fill::filled::{FillResult, Filled, Route};
use crate::fill::judged::accept;
use crate::fill::maker::Maker;
use crate::fill::options::{FillOptions, InteriorFrom};
use crate::problem::Problem;
use crate::simplify::{carried_positions, simplified};
use hexfill_construct::{CellChoice, ConstructOptions};
use hexfill_mesh::{Context, HexMesh, VertexId};
use std::sync::Arc;
use std::time::Instant;

/// Constructions tried for each mesh asked for: some variants are isomorphic.
const VARIANTS_PER_MESH: u64 = 4;

/// The construction for everything else. Several meshes are variants of it that cost the same.
pub(crate) fn construct(
    problem: &Problem,
    options: &FillOptions,
    ctx: &Context<'_>,
    result: &mut FillResult,
) -> Result<(), FillError> {
    let points = problem.positions();
    // Tetrahedra that are given belong to the diagonals of the first variant.
    let given = matches!(options.interior, InteriorFrom::Tets(_));
    let variants = if given || options.count == 1 { 1 } else { VARIANTS_PER_MESH * options.count as u64 };
    for variant in 0..variants {
        let tets: Option<Arc<dyn hexfill_construct::InteriorTets>> = match &options.interior {
            InteriorFrom::BuiltIn => None,
            InteriorFrom::Tets(tets) => Some(tets.clone()),
            InteriorFrom::Tetgen(program) => Some(Arc::new(program.clone())),
        };
        let mut how = ConstructOptions::default().with_cells(options.cells).with_variant(variant);
        if let Some(tets) = tets {
            how = how.with_tets(tets);
        }
        let made = match hexfill_construct::construct(&problem.surface, points.as_deref(), &how, ctx) {
            Err(hexfill_construct::ConstructError::Stopped(reason)) => {
                result.stop = reason;
                result.tried.push(Attempt::ConstructionStopped);
                return Ok(());
            }
            made => made?,
        };
        // Variants differ by diagonals and matchings only; one report stands for all.
        if variant == 0 {
            result.tried.push(Attempt::Construction(Box::new(made.report)));
        }
        let constructed = Filled { start: made.start, ..Filled::by(Route::Construction, made.mesh) };
        let filled = simplify_construction(constructed, options, ctx, &mut result.tried);
        if filled.mesh.n_hexes() as u64 <= u64::from(options.max_hexes) {
            accept(&problem.surface, filled, options, result)?;
        }
        if result.meshes.len() >= options.count {
            break;
        }
    }
    Ok(())
}

/// A construction made smaller as the options of a fill ask for; its boundary comes first and keeps its ids.
/// The caller judges.
fn simplify_construction(
    constructed: Filled,
    options: &FillOptions,
    ctx: &Context<'_>,
    tried: &mut Vec<Attempt>,
) -> Filled {
    let Some(how) = &options.simplify else { return constructed };
    let left = ctx.deadline.map(|end| end.saturating_duration_since(Instant::now()));
    let share = if options.cells == CellChoice::Fewest { 0.9 } else { 0.5 };
    let limited = left.map_or(*ctx, |left| ctx.with_time_limit(left.mul_f64(share)));
    let made = simplified(&constructed.mesh, how, options.atlas.as_deref(), &limited);
    tried.push(Attempt::Simplification(made.report));
    let start = constructed.start.as_ref().map(|points| carried_positions(&made.mesh, &made.origin, points));
    let origin = hexes_that_stayed(&constructed.mesh, &made.mesh, &made.origin);
    Filled { start, ..constructed.remade(Maker::Simplification, made.mesh, &origin) }
}

/// Per hex of `after` the hex of `before` with the same vertices, if there is one; `origin` has for each vertex the one it was.
fn hexes_that_stayed(before: &HexMesh, after: &HexMesh, origin: &[Option<VertexId>]) -> Vec<Option<u32>> {
    let sorted = |mut hex: [VertexId; 8]| {
        hex.sort_unstable();
        hex
    };
    let mut known: Vec<([VertexId; 8], u32)> = (0..).zip(before.hexes()).map(|(h, &hex)| (sorted(hex), h)).collect();
    known.sort_unstable();
    let was = |hex: &[VertexId; 8]| -> Option<u32> {
        let old: Vec<VertexId> = hex.iter().map(|v| origin[v.index()]).collect::<Option<_>>()?;
        let key = sorted(old.try_into().ok()?);
        known.binary_search_by(|(k, _)| k.cmp(&key)).ok().map(|i| known[i].1)
    };
    after.hexes().iter().map(was).collect()
}
