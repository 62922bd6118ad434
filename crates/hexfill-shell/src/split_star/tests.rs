//! Splits on voxel solids and spheres with vertices no direction serves, judged and embedded.

use super::choose::Chooser;
use super::{Layer, SplitOptions, SplitStars, split_stars};
use crate::cells::Cells;
use hexfill_check::{Judged, Level, Options, judge};
use hexfill_embed::{Embedding, Objective, embed};
use hexfill_mesh::generate::{grid, grid_mesh_of};
use hexfill_mesh::{Context, HexMesh, QuadSurface, Random};

type Point = [f64; 3];

/// A layer of hexes under the whole boundary.
fn pillowed(mesh: &HexMesh) -> HexMesh {
    let mut cells = Cells::new(mesh);
    let all: Vec<u32> = (0..mesh.n_hexes() as u32).collect();
    cells.shrink(&all, &quads_of(mesh));
    cells.to_mesh().unwrap()
}

fn quads_of(mesh: &HexMesh) -> Vec<[u32; 4]> {
    mesh.boundary_quads_raw()
}

/// Four cubes of 2 x 2 x 2 in a chain round their common point, each cut into n^3: the faces at that point look both ways along
/// two axes. With the positions of the boundary's vertices.
fn chain(n: usize) -> (HexMesh, Vec<Point>) {
    let filled = |p: [usize; 3]| [[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1]].contains(&p.map(|x| x / n));
    voxels([2 * n; 3], filled)
}

/// Voxels with their positions.
fn voxels(size: [usize; 3], filled: impl Fn([usize; 3]) -> bool) -> (HexMesh, Vec<Point>) {
    let mesh = grid_mesh_of(size, &filled).unwrap();
    // The hexes come cell by cell; their first corner is the lowest.
    let mut points = vec![[f64::NAN; 3]; mesh.n_vertices()];
    let mut hexes = mesh.hexes().iter();
    for_each_cell(size, |cell| {
        if filled(cell) {
            let hex = hexes.next().unwrap();
            for (i, p) in hexfill_mesh::cube::POSITIONS.iter().enumerate() {
                points[hex[i].index()] = std::array::from_fn(|k| (cell[k] + usize::from(p[k])) as f64);
            }
        }
    });
    (mesh, points)
}

fn for_each_cell(size: [usize; 3], mut f: impl FnMut([usize; 3])) {
    for z in 0..size[2] {
        for y in 0..size[1] {
            (0..size[0]).for_each(|x| f([x, y, z]));
        }
    }
}

/// Asserts L1 to L3 with the boundary of `before`.
fn assert_proper(made: &HexMesh, before: &HexMesh) {
    let hexes = made.hexes_raw();
    let quads = quads_of(before);
    let report = judge(
        &Judged::connectivity(made.n_vertices(), &hexes).with_surface(&quads),
        &Options::default(),
        &Context::default(),
    );
    assert!(report.passed(Level::L3), "{report:?}");
}

/// Asserts that every hex is valid, by the judge, at positions made by `hexfill-embed`; returns the worst scaled Jacobian.
fn certified(mesh: &HexMesh, surface: &HexMesh, points: &[Point]) -> f64 {
    let made = embedded(mesh, points, Objective::ScaledJacobian);
    // Where the surface's own mesh has inner vertices, the judge must not ask for their positions.
    let fixed = surface.boundary_vertices();
    let given: Vec<Point> = (0..points.len()).map(|v| if fixed[v] { points[v] } else { made.points[v] }).collect();
    let hexes = mesh.hexes_raw();
    let quads = quads_of(surface);
    let mut judged = Judged::connectivity(mesh.n_vertices(), &hexes).with_surface(&quads).with_points(&made.points);
    judged.surface_points = Some(&given);
    let report = judge(&judged, &Options::default(), &Context::default());
    assert!(report.passed(Level::L5), "{report:?}");
    made.report.scaled_jacobian
}

fn embedded(mesh: &HexMesh, points: &[Point], objective: Objective) -> Embedding {
    embed(mesh, points, None, &hexfill_embed::Options::new(objective), &Context::default()).unwrap()
}

fn split(mesh: &HexMesh, points: &[Point]) -> Option<SplitStars> {
    split_stars(mesh, points, &SplitOptions::default(), &Context::default())
}

#[test]
fn behind_a_layer_only_a_split_is_valid() {
    // Plain, and with the upper part pushed over the lower one.
    for (n, bend, least) in [(1, 0.0, 0.25), (2, 0.0, 0.3), (2, 0.6, 0.25)] {
        let (mesh, mut points) = chain(n);
        let c = n as f64;
        for [x, y, z] in &mut points {
            *y -= bend * (*z - c) / c * (c - (*x - c).powi(2).min(c * c) / c);
        }
        let layered = pillowed(&mesh);
        let before = embedded(&layered, &points, Objective::UntangleOnly).report;
        assert!(before.n_invalid > 0 && before.upper_bound < 1e-9, "{n} {bend}: {}", before.upper_bound);
        let made = split(&layered, &points).unwrap();
        assert_eq!((made.splits.len(), made.left.len(), made.layered), (1, 0, false));
        assert!(made.splits[0].before < 1e-9 && made.splits[0].after > 0.6, "{:?}", made.splits);
        assert_eq!(made.mesh.n_hexes(), layered.n_hexes() + made.splits[0].hexes);
        assert_proper(&made.mesh, &mesh);
        let reached = certified(&made.mesh, &mesh, &points);
        assert!(reached > least, "{n} {bend}: {reached}");
    }
}

#[test]
fn voxels_need_no_split() {
    let (mesh, points) = chain(2);
    assert!(split(&mesh, &points).is_none());
    let options = SplitOptions { layer: Layer::Always, ..SplitOptions::default() };
    let made = split_stars(&mesh, &points, &options, &Context::default()).unwrap();
    assert!(made.layered && made.splits.len() == 1);
    assert_proper(&made.mesh, &mesh);
    // Positions that are missing or not finite are no reason to panic.
    assert!(split(&mesh, &points[..10]).is_none());
    assert!(split(&mesh, &vec![[f64::NAN; 3]; points.len()]).is_none());
}

/// A ball of random voxels without edges or vertices where they touch only; each cut into eight.
fn random_voxels(seed: u64) -> Option<(HexMesh, Vec<Point>)> {
    const SIZE: usize = 5;
    let mut random = Random::new(seed);
    let mut filled = vec![[2usize, 2, 2]];
    while filled.len() < 40 {
        let mut p = filled[random.below(filled.len())];
        let k = random.below(3);
        p[k] = (p[k] + if random.below(2) == 0 { 1 } else { SIZE - 1 }) % SIZE;
        if !filled.contains(&p) {
            filled.push(p);
        }
    }
    let (mesh, points) = voxels([2 * SIZE; 3], |p| filled.contains(&p.map(|x| x / 2)));
    QuadSurface::try_new(mesh.n_vertices(), &quads_of(&mesh)).is_ok().then_some((mesh, points))
}

#[test]
fn random_solids_are_split_where_needed_by_any_number_of_threads() {
    let solids: Vec<_> = (0..40).filter_map(random_voxels).collect();
    assert!(solids.len() >= 3, "{}", solids.len());
    let mut n_splits = 0;
    for (mesh, points) in &solids {
        let layered = pillowed(mesh);
        let Some(made) = split(&layered, points) else { continue };
        assert!(made.left.is_empty() && made.splits.iter().all(|s| s.after > 0.3), "{:?}", made.splits);
        assert_proper(&made.mesh, mesh);
        n_splits += made.splits.len();
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let again = one.install(|| split(&layered, points)).unwrap();
        assert!(again.mesh == made.mesh && again.splits == made.splits);
    }
    assert!(n_splits > 3, "{n_splits}");
}

#[test]
fn crumpled_cubes_get_better_and_stay_proper() {
    let mesh = grid(4, 4, 4).unwrap();
    let layered = pillowed(&mesh);
    let (mut before, mut after) = (0, 0);
    for seed in 0..6 {
        let mut random = Random::new(seed);
        let points: Vec<Point> = (0..mesh.n_vertices())
            .map(|v| [v % 5, v / 5 % 5, v / 25].map(|x| x as f64 + 1.6 * (random.unit() - 0.5)))
            .collect();
        let quads = quads_of(&layered);
        let surface = QuadSurface::try_new(layered.n_vertices(), &quads).unwrap();
        let chooser = Chooser::new(&surface, &points, SplitOptions::default());
        let invalid = |mesh: &HexMesh| {
            let cells = Cells::new(mesh);
            let poor = chooser.still_poor(&cells, &chooser.vertices_no_direction_serves());
            poor.iter().filter(|p| p.1 <= 0.0).count()
        };
        before += invalid(&layered);
        if let Some(made) = split(&layered, &points) {
            assert_proper(&made.mesh, &mesh);
            after += invalid(&made.mesh);
        }
    }
    assert!(before > 10 && 4 * after < before, "{before} {after}");
}
