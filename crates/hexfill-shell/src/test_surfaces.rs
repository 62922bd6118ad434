//! Surfaces and the judge for the tests of this crate.

use crate::sweep::Swept;
use hexfill_check::{Judged, Level, judge};
use hexfill_mesh::generate::torus;
use hexfill_mesh::{Context, HexMesh, QuadSurface};

/// A torus of `n` quads round the axis and `m` round the tube, facing outward.
pub(crate) fn torus_at(n: u32, m: u32) -> (QuadSurface, Vec<[f64; 3]>) {
    let turn = std::f64::consts::TAU;
    let mut points = Vec::new();
    for j in 0..n {
        for i in 0..m {
            let (tube, axis) = (turn * f64::from(i) / f64::from(m), turn * f64::from(j) / f64::from(n));
            let d = 3.0 + tube.cos();
            points.push([d * axis.cos(), d * axis.sin(), tube.sin()]);
        }
    }
    let surface = torus(m, n, 0).unwrap();
    let quads: Vec<[u32; 4]> = surface.quads_raw();
    let inside = crate::inside::winding_number(&quads, &points, [3.0, 0.0, 0.0]);
    (if inside > 0.0 { surface } else { surface.inverted() }, points)
}

/// The vertices and quads of an OBJ file.
pub(crate) fn read_obj(text: &str) -> (QuadSurface, Vec<[f64; 3]>) {
    let data = hexfill_io::read_from(text.as_bytes(), hexfill_io::Format::Obj, "surface").unwrap();
    (data.quad_surface().unwrap(), data.points)
}

/// Judges a complete filling with levels 1 to 3 and its Euler characteristic, half that of its boundary; the number of hexes.
pub(crate) fn judged(surface: &QuadSurface, swept: &Swept) -> usize {
    assert_eq!(swept.front.len(), 0, "complete");
    let quads: Vec<[u32; 4]> = surface.quads_raw();
    let input = Judged::connectivity(swept.n_vertices as usize, &swept.hexes).with_surface(&quads);
    let options = hexfill_check::Options::default().with_up_to(Level::L3);
    let report = judge(&input, &options, &Context::default());
    assert!(report.passed(Level::L3), "{:?}", report.failures);
    let mesh = HexMesh::try_new(swept.n_vertices as usize, &swept.hexes).unwrap();
    assert_eq!(2 * hexfill_mesh::euler_characteristic(&mesh), surface.euler_characteristic());
    swept.hexes.len()
}

/// The boundary of the filled cells of a grid, and how many hexes of the grid lie round each edge.
pub(crate) fn voxels(size: [usize; 3], filled: impl Fn([usize; 3]) -> bool) -> Option<(QuadSurface, Angles)> {
    let (surface, points) = hexfill_mesh::generate::voxels(size, &filled).ok()?;
    let is_filled =
        |cell: [i32; 3]| (0..3).all(|k| (0..size[k] as i32).contains(&cell[k])) && filled(cell.map(|x| x as usize));
    let mut angles = Angles::new();
    for d in surface.darts() {
        let (a, b) = (surface.origin(d), surface.target(d));
        let (p, q) = (points[a.index()], points[b.index()]);
        let axis = (0..3).find(|&k| p[k] != q[k]).expect("an edge has a direction");
        let round = [[0, 0], [0, -1], [-1, 0], [-1, -1]].map(|[i, j]| {
            let mut cell: [i32; 3] = std::array::from_fn(|k| p[k].min(q[k]));
            cell[(axis + 1) % 3] += i;
            cell[(axis + 2) % 3] += j;
            cell
        });
        let n = round.into_iter().filter(|&cell| is_filled(cell)).count();
        angles.insert((a.0.min(b.0), a.0.max(b.0)), n as f32);
    }
    Some((surface, angles))
}

/// The surface of some hexes, its vertices in their order.
pub(crate) fn boundary_of(points: &[[f64; 3]], hexes: &[[u32; 8]]) -> (QuadSurface, Vec<[f64; 3]>) {
    let mesh = HexMesh::try_new(points.len(), hexes).unwrap();
    let mut number = vec![u32::MAX; points.len()];
    let on: Vec<usize> = (0..points.len()).filter(|&v| mesh.boundary_vertices()[v]).collect();
    on.iter().enumerate().for_each(|(i, &v)| number[v] = i as u32);
    let quads: Vec<[u32; 4]> = mesh.boundary_quads_raw().into_iter().map(|q| q.map(|v| number[v as usize])).collect();
    let surface = QuadSurface::try_new(on.len(), &quads).unwrap();
    (surface, on.into_iter().map(|v| points[v]).collect())
}

/// Angles / 90 degrees of edges.
pub(crate) type Angles = std::collections::BTreeMap<(u32, u32), f32>;

/// The boundary of the filled cells of a grid with the positions of its vertices.
pub(crate) fn voxel_points(
    size: [usize; 3],
    filled: impl Fn([usize; 3]) -> bool,
) -> Option<(QuadSurface, Vec<[f64; 3]>)> {
    let (surface, points) = hexfill_mesh::generate::voxels(size, filled).ok()?;
    Some((surface, points.into_iter().map(|p| p.map(f64::from)).collect()))
}
