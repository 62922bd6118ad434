//! Solids that lie apart, filled one by one.
//!
//! Source: ours.

use crate::fill::attempt::Attempt;
use crate::fill::component::fill_component;
use crate::fill::error::{FillError, check_fillable};
use crate::fill::filled::{FillResult, Filled, Route};
use crate::fill::last_resort::LastResort;
use crate::fill::options::FillOptions;
use crate::problem::Problem;
use crate::problem::solids::part;
use hexfill_embed::tutte_start;
use hexfill_mesh::{Context, HexMesh, StopReason};

/// Fills solids that lie apart, each for itself, and puts the meshes side by side. Of each the smallest mesh is taken.
pub(crate) fn fill_apart(
    problem: &Problem,
    solids: &[Vec<usize>],
    options: &FillOptions,
    ctx: &Context<'_>,
) -> Result<FillResult, FillError> {
    let mut result = FillResult::new();
    let one = FillOptions { count: 1, growth_log: None, ..options.clone() };
    let (mut hexes, mut makers) = (Vec::new(), Vec::new());
    let mut n_vertices = problem.surface.n_vertices() as u32;
    let mut route = Route::Atlas;
    let mut start = problem.points.clone();
    let mut last_resort = LastResort::default();
    for (c, solid) in solids.iter().enumerate() {
        let (surface, vertices) = part(&problem.surface, solid);
        let mut part = Problem::from_surface(&format!("component {c} of {}", problem.name), surface);
        part.points = problem.points.as_ref().map(|p| vertices.iter().map(|v| p[v.index()]).collect());
        // A whole with an even number of quads can have parts with odd numbers.
        check_fillable(&part.surface)?;
        let mut made = fill_component(&part, &one, ctx)?;
        last_resort.fill(&part, &one, ctx, &mut made)?;
        let tried = made.tried.drain(..);
        result.tried.extend(tried.map(|a| Attempt::Component { component: c, attempt: Box::new(a) }));
        if result.stop == StopReason::Finished {
            result.stop = made.stop;
        }
        // A solid left empty is no mesh of the surface: all or nothing.
        let Some(filled) = made.meshes.pop() else { return Ok(result) };
        let n_part = part.surface.n_vertices();
        let first = n_vertices;
        let place = |v: u32| if (v as usize) < n_part { vertices[v as usize].0 } else { first + v - n_part as u32 };
        hexes.extend(filled.mesh.hexes_raw().into_iter().map(|h| h.map(place)));
        makers.extend(&filled.makers);
        n_vertices += (filled.mesh.n_vertices() - n_part) as u32;
        if filled.route != Route::Atlas {
            route = filled.route;
        }
        if let (Some(start), Some(points)) = (&mut start, &part.points) {
            let placed = match filled.start {
                Some(placed) => Some(placed),
                None => tutte_start(&filled.mesh, points).ok(),
            };
            let interior = placed.map_or_else(Vec::new, |p| p[n_part..].to_vec());
            start.extend(interior);
            start.resize(n_vertices as usize, [0.0; 3]);
        }
    }
    let mesh = HexMesh::try_new(n_vertices as usize, &hexes).expect("meshes without common vertices glue properly");
    if mesh.n_hexes() as u64 <= u64::from(options.max_hexes) {
        result.meshes.push(Filled { start, makers, ..Filled::by(route, mesh) });
    }
    Ok(result)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fill::fill;
    use crate::problem::solids::solids;

    /// The boundary of filled cells with its positions.
    fn voxels(size: [usize; 3], filled: impl Fn([usize; 3]) -> bool) -> Problem {
        let (surface, points) = hexfill_mesh::generate::voxels(size, filled).unwrap();
        let mut problem = Problem::from_surface("voxels", surface);
        problem.points = Some(points.into_iter().map(|p| p.map(f64::from)).collect());
        problem
    }

    #[test]
    fn solids_own_their_cavities() {
        // A box with a cavity, an island in it, and a box beside.
        let filled = |[x, y, z]: [usize; 3]| {
            let off = [x, y, z].map(|c| c.abs_diff(3)).into_iter().max().unwrap();
            x == 8 || x < 7 && off != 2 && off != 1
        };
        let problem = voxels([9, 7, 7], filled);
        assert_eq!(problem.surface.n_components(), 4);
        let solids = solids(&problem.surface, problem.points.as_deref());
        assert_eq!(solids.iter().map(Vec::len).sum::<usize>(), 4);
        assert_eq!(solids.len(), 3);
        let cells = (0..9 * 49).filter(|i| filled([i % 9, i / 9 % 7, i / 63])).count();
        let made = fill(&problem, &FillOptions::default(), &Context::default()).unwrap();
        assert_eq!(made.meshes[0].mesh.n_hexes(), cells);
    }
}
