//! Surfaces of several components: which lies inside which, and filling solids that lie apart one by one. A solid is a component that faces
//! outward with the cavities in it; an island in a cavity is a solid of its own.

use crate::fill::{FillError, FillOptions, FillResult, Filled, Route, check_fillable, fill_component};
use crate::last_resort::LastResort;
use crate::problem::Problem;
use hexfill_embed::tutte_start;
use hexfill_geometry::halves;
use hexfill_mesh::{Context, HexMesh, QuadId, QuadSurface, StopReason, VertexId};

/// Which other components each component lies in: an even number for an outer boundary, an odd one for the boundary of a cavity. Exact for
/// disjoint closed surfaces; whatever the rounding says where surfaces cross.
fn holders(surface: &QuadSurface, points: &[[f64; 3]]) -> Vec<Vec<usize>> {
    let mut triangles: Vec<Vec<[[f64; 3]; 3]>> = vec![Vec::new(); surface.n_components()];
    for (q, quad) in surface.quads().iter().enumerate() {
        triangles[surface.component(QuadId::new(q))].extend(halves(quad.map(|v| points[v.index()])));
    }
    hexfill_geometry::holders(&triangles)
}

/// How many other components each component lies in: 0 for an outer boundary, 1 for the boundary of a cavity, 2 for an
/// island in a cavity, and so on.
pub(crate) fn depths(surface: &QuadSurface, points: &[[f64; 3]]) -> Vec<u32> {
    holders(surface, points).iter().map(|h| h.len() as u32).collect()
}

/// The components of each solid, its outer boundary first. Without positions all components lie apart.
pub(crate) fn solids(surface: &QuadSurface, points: Option<&[[f64; 3]]>) -> Vec<Vec<usize>> {
    let n = surface.n_components();
    let Some(points) = points.filter(|_| n > 1) else { return (0..n).map(|c| vec![c]).collect() };
    let holders = holders(surface, points);
    let mut solids: Vec<Vec<usize>> = (0..n).filter(|&c| holders[c].len().is_multiple_of(2)).map(|c| vec![c]).collect();
    for c in (0..n).filter(|&c| holders[c].len() % 2 == 1) {
        let owner = holders[c].iter().find(|&&h| holders[h].len() + 1 == holders[c].len());
        match owner.and_then(|o| solids.iter_mut().find(|s| s[0] == *o)) {
            Some(solid) => solid.push(c),
            // Surfaces that cross: each for itself.
            None => solids.push(vec![c]),
        }
    }
    solids
}

/// Some components as a surface of their own: with the map to the old vertex ids.
fn part(surface: &QuadSurface, components: &[usize]) -> (QuadSurface, Vec<VertexId>) {
    let quads = (0..).zip(surface.quads()).filter(|(q, _)| components.contains(&surface.component(QuadId::new(*q))));
    let mut quads: Vec<[u32; 4]> = quads.map(|(_, quad)| quad.map(|v| v.0)).collect();
    let mut old: Vec<u32> = quads.iter().flatten().copied().collect();
    old.sort_unstable();
    old.dedup();
    for v in quads.iter_mut().flatten() {
        *v = old.binary_search(v).expect("every vertex was collected") as u32;
    }
    let part = QuadSurface::try_new(old.len(), &quads).expect("components of a surface are a surface");
    (part, old.into_iter().map(VertexId).collect())
}

/// Fills solids that lie apart, each for itself, and puts the meshes side by side. Of each the smallest mesh is taken.
pub(crate) fn fill_apart(
    problem: &Problem,
    solids: &[Vec<usize>],
    options: &FillOptions,
    ctx: &Context<'_>,
) -> Result<FillResult, FillError> {
    let mut result = FillResult { meshes: Vec::new(), stop: StopReason::Finished, tried: Vec::new() };
    let one = FillOptions { count: 1, growth_log: None, ..options.clone() };
    let mut hexes = Vec::new();
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
        result.tried.extend(made.tried.drain(..).map(|t| format!("component {c}: {t}")));
        if result.stop == StopReason::Finished {
            result.stop = made.stop;
        }
        let Some(filled) = made.meshes.pop() else { return Ok(result) };
        let n_part = part.surface.n_vertices();
        let first = n_vertices;
        let place = |v: u32| if (v as usize) < n_part { vertices[v as usize].0 } else { first + v - n_part as u32 };
        hexes.extend(filled.mesh.hexes_raw().into_iter().map(|h| h.map(place)));
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
        result.meshes.push(Filled { mesh, route, start, stages: Vec::new(), coarse: None });
    }
    Ok(result)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fill::fill;

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
