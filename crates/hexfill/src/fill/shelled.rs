//! The surface swept inward by its own dual curves.
//!
//! Source: ours.

use crate::fill::attempt::Attempt;
use crate::fill::error::FillError;
use crate::fill::filled::{FillResult, Filled, Route};
use crate::fill::judged::verify;
use crate::fill::maker::Maker;
use crate::fill::options::FillOptions;
use crate::problem::Problem;
use hexfill_mesh::Context;
use hexfill_shell::{Stage, shell};

/// Complete meshes by shelling, judged, those with least cost first.
pub(crate) fn shelled(
    problem: &Problem,
    options: &FillOptions,
    ctx: &Context<'_>,
    result: &mut FillResult,
) -> Result<Vec<Filled>, FillError> {
    let points = problem.positions();
    let mut how = options.shell.clone();
    if options.layers.is_some() {
        how = how.with_pillows(vec![1]);
    }
    let made = shell(&problem.surface, points.as_deref(), &how, ctx);
    result.stop = ctx.stop().unwrap_or(result.stop);
    // Where nothing was swept and nothing found, nothing was tried.
    if how.is_swept() || !made.meshes.is_empty() {
        let (coarse_quads, meshes, left) = (made.coarse_quads, made.meshes.len(), made.left);
        result.tried.push(Attempt::Shelling { coarse_quads, meshes, left });
    }
    let mut meshes = Vec::new();
    for shelled in made.meshes {
        if ctx.stop().is_some() && !meshes.is_empty() {
            break;
        }
        if shelled.mesh.n_hexes() as u64 <= u64::from(options.max_hexes) {
            verify(&problem.surface, &shelled.mesh, Route::Shelling)?;
            let of_stage = |&(stage, n): &(Stage, usize)| std::iter::repeat_n(Maker::of_stage(stage), n);
            meshes.push(Filled {
                mesh: shelled.mesh,
                route: Route::Shelling,
                start: shelled.points,
                is_placed: shelled.is_placed,
                makers: shelled.stages.iter().flat_map(of_stage).collect(),
                coarse: shelled.coarse,
            });
        }
    }
    Ok(meshes)
}
