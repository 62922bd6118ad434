//! Solids that lie apart, filled one by one.
//!
//! Source: ours.

use crate::fill::attempt::Attempt;
use crate::fill::component::fill_component;
use crate::fill::error::{FillError, check_fillable};
use crate::fill::filled::{FillResult, Filled, Route};
use crate::fill::last_resort::LastResort;
use crate::fill::maker::Maker;
use crate::fill::options::{FillOptions, InteriorFrom};
use crate::problem::Problem;
use crate::problem::solids::part;
use hexfill_embed::tutte_start;
use hexfill_mesh::{Context, HexMesh, StopReason, VertexId};

/// Meshes of solids that lie apart, put side by side.
pub(crate) struct SideBySide {
    hexes: Vec<[u32; 8]>,
    makers: Vec<Maker>,
    n_vertices: usize,
    route: Route,
    points: Option<Vec<[f64; 3]>>,
}

impl SideBySide {
    /// Nothing but the surface of the whole.
    pub(crate) fn new(problem: &Problem) -> Self {
        let (n_vertices, points) = (problem.surface.n_vertices(), problem.positions());
        Self { hexes: Vec::new(), makers: Vec::new(), n_vertices, route: Route::Atlas, points }
    }

    /// Puts the mesh of a solid beside the others. `vertices` are those of its surface in the whole, `points` the positions of all of its own.
    pub(crate) fn add(&mut self, filled: &Filled, vertices: &[VertexId], points: Option<&[[f64; 3]]>) {
        let (n_part, first) = (vertices.len(), self.n_vertices);
        let place =
            |v: u32| vertices.get(v as usize).map_or_else(|| (first + v as usize - n_part) as u32, |whole| whole.0);
        self.hexes.extend(filled.mesh.hexes_raw().into_iter().map(|h| h.map(place)));
        self.makers.extend(&filled.makers);
        self.n_vertices += filled.mesh.n_vertices() - n_part;
        if filled.route != Route::Atlas {
            self.route = filled.route;
        }
        if let Some(all) = &mut self.points {
            all.extend(points.into_iter().flat_map(|points| &points[n_part..]));
            all.resize(self.n_vertices, [0.0; 3]);
        }
    }

    /// One mesh of all of them; its start are the positions.
    pub(crate) fn into_filled(self) -> Filled {
        let Self { hexes, makers, n_vertices, route, points } = self;
        let mesh = HexMesh::try_new(n_vertices, &hexes).expect("meshes without common vertices glue properly");
        Filled { start: points, makers, ..Filled::by(route, mesh) }
    }
}

/// A solid as a problem of its own, and its surface's vertices in the whole.
///
/// # Errors
/// [`FillError::NoMesh`]: a whole with an even number of quads can have parts with odd numbers.
pub(crate) fn problem_of(
    problem: &Problem,
    number: usize,
    solid: &[usize],
) -> Result<(Problem, Vec<VertexId>), FillError> {
    let (surface, vertices) = part(&problem.surface, solid);
    check_fillable(&surface)?;
    let mut part = Problem::from_surface(&format!("component {number} of {}", problem.name), surface);
    part.points = problem.points.as_ref().map(|p| vertices.iter().map(|v| p[v.index()]).collect());
    Ok((part, vertices))
}

/// What was tried, as it is told of one of several components.
pub(crate) fn of_component(component: usize, tried: Vec<Attempt>) -> impl Iterator<Item = Attempt> {
    tried.into_iter().map(move |a| Attempt::Component { component, attempt: Box::new(a) })
}

/// Whether solids are filled one by one: where tetrahedra of the interior come from elsewhere, they are those of the whole.
pub(crate) fn lie_apart(solids: &[Vec<usize>], options: &FillOptions) -> bool {
    solids.len() > 1 && matches!(options.interior, InteriorFrom::BuiltIn)
}

/// Fills solids that lie apart, each for itself, and puts the meshes side by side. Of each the smallest mesh is taken.
pub(crate) fn fill_apart(
    problem: &Problem,
    solids: &[Vec<usize>],
    options: &FillOptions,
    ctx: &Context<'_>,
) -> Result<FillResult, FillError> {
    let mut result = FillResult::new();
    let one = FillOptions { count: 1, growth_log: None, ..options.clone() };
    let mut whole = SideBySide::new(problem);
    let mut last_resort = LastResort::default();
    for (c, solid) in solids.iter().enumerate() {
        let (part, vertices) = problem_of(problem, c, solid)?;
        let mut made = fill_component(&part, &one, ctx)?;
        last_resort.fill(&part, &one, ctx, &mut made)?;
        result.tried.extend(of_component(c, made.tried));
        if result.stop == StopReason::Finished {
            result.stop = made.stop;
        }
        // A solid left empty is no mesh of the surface: all or nothing.
        let Some(filled) = made.meshes.pop() else { return Ok(result) };
        let start = part.points.as_ref().and_then(|points| match &filled.start {
            Some(start) => Some(start.clone()),
            None => tutte_start(&filled.mesh, points).ok(),
        });
        whole.add(&filled, &vertices, start.as_deref());
    }
    let filled = whole.into_filled();
    if filled.mesh.n_hexes() as u64 <= u64::from(options.max_hexes) {
        result.meshes.push(filled);
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
