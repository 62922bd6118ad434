//! Surfaces of several components: which lies inside which, and filling those that lie apart one by one.

use crate::fill::{FillError, FillOptions, FillResult, Filled, Route, check_fillable, fill_component};
use crate::problem::Problem;
use hexfill_embed::tutte_start;
use hexfill_mesh::{Context, HexMesh, QuadSurface, VertexId};

/// How many other components each component lies in: 0 for an outer boundary, 1 for the boundary of a cavity, 2 for an
/// island in a cavity, and so on. Exact for disjoint closed surfaces; whatever the rounding says where surfaces cross.
pub(crate) fn depths(surface: &QuadSurface, points: &[[f64; 3]]) -> Vec<u32> {
    let n = surface.n_components();
    let mut representative = vec![None; n];
    let mut quads_of: Vec<Vec<[VertexId; 4]>> = vec![Vec::new(); n];
    for (q, quad) in surface.quads().iter().enumerate() {
        let c = surface.component(hexfill_mesh::QuadId::new(q));
        representative[c].get_or_insert(quad[0]);
        quads_of[c].push(*quad);
    }
    let inside = |v: VertexId, quads: &[[VertexId; 4]]| winding(points[v.index()], quads, points).abs() > 0.5;
    (0..n)
        .map(|c| {
            let v = representative[c].expect("a component has quads");
            (0..n).filter(|&other| other != c && inside(v, &quads_of[other])).count() as u32
        })
        .collect()
}

/// Winding number of a closed surface about a point: solid angles of its triangles over 4 pi (van Oosterom and Strackee 1983).
fn winding(at: [f64; 3], quads: &[[VertexId; 4]], points: &[[f64; 3]]) -> f64 {
    let largest = points.iter().flatten().fold(1e-300f64, |m, x| m.max(x.abs()));
    let to = |v: VertexId| [0, 1, 2].map(|k| points[v.index()][k] / largest - at[k] / largest);
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let angle = |a: [f64; 3], b: [f64; 3], c: [f64; 3]| {
        let [la, lb, lc] = [a, b, c].map(|p| dot(p, p).sqrt());
        let det = a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0]);
        2.0 * det.atan2(la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb)
    };
    let total: f64 = quads
        .iter()
        .map(|q| {
            let [a, b, c, d] = q.map(to);
            angle(a, b, c) + angle(a, c, d)
        })
        .sum();
    total / (4.0 * std::f64::consts::PI)
}

/// Fills components that lie apart, each for itself, and puts the meshes side by side. Of each the smallest mesh is taken.
pub(crate) fn fill_apart(problem: &Problem, options: &FillOptions, ctx: &Context<'_>) -> Result<FillResult, FillError> {
    let mut result = FillResult { meshes: Vec::new(), stop: hexfill_mesh::StopReason::Finished, tried: Vec::new() };
    let one = FillOptions { count: 1, growth_log: None, ..options.clone() };
    let mut hexes = Vec::new();
    let mut n_vertices = problem.surface.n_vertices() as u32;
    let mut route = Route::Atlas;
    let mut start = problem.points.clone();
    for (c, (surface, vertices, _)) in problem.surface.split_components().into_iter().enumerate() {
        let mut part = Problem::from_surface(&format!("component {c} of {}", problem.name), surface);
        part.points = problem.points.as_ref().map(|p| vertices.iter().map(|v| p[v.index()]).collect());
        // A whole with an even number of quads can have parts with odd numbers.
        check_fillable(&part.surface)?;
        let mut made = fill_component(&part, &one, ctx)?;
        result.tried.extend(made.tried.drain(..).map(|t| format!("component {c}: {t}")));
        result.stop = made.stop;
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
        result.meshes.push(Filled { mesh, route, start, stages: Vec::new() });
    }
    Ok(result)
}
