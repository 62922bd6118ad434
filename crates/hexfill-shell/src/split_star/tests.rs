//! Splits on voxel solids and spheres with vertices no direction serves, judged and embedded.

use super::cells::Cells;
use super::{SplitOptions, split_stars};
use hexfill_check::{Judged, Level, Options, judge};
use hexfill_mesh::generate::grid_mesh_of;
use hexfill_mesh::{Context, HexMesh, Random};

type Point = [f64; 3];

/// A layer of hexes under the whole boundary.
pub(super) fn pillowed(mesh: &HexMesh) -> HexMesh {
    let mut cells = Cells::new(mesh);
    let all: Vec<u32> = (0..mesh.n_hexes() as u32).collect();
    let quads: Vec<[u32; 4]> = mesh.boundary_quads().iter().map(|q| q.map(|v| v.0)).collect();
    cells.shrink(&all, &quads);
    cells.to_mesh().unwrap()
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
pub(super) fn assert_proper(made: &HexMesh, before: &HexMesh) {
    let hexes = made.hexes_raw();
    let quads: Vec<[u32; 4]> = before.boundary_quads().iter().map(|q| q.map(|v| v.0)).collect();
    let mut judged = Judged::connectivity(made.n_vertices(), &hexes);
    judged.surface = Some(&quads);
    let report = judge(&judged, &Options::default(), &Context::default());
    assert!(report.passed(Level::L3), "{report:?}");
}

#[test]
fn look() {
    for (n, bend) in [(1, 0.0), (2, 0.0), (2, 0.3), (2, 0.6), (3, 0.6), (3, 0.9)] {
        let (mesh, mut points) = chain(n);
        let c = n as f64;
        // Turns the upper part against the lower one, so that the two sides of the middle overhang.
        for p in &mut points {
            let h = (p[2] - c) / c;
            let (x, y) = (p[0] - c, p[1] - c);
            p[1] += -bend * h * (c - (x * x).min(c * c) / c).max(0.0);
            let _ = y;
        }
        println!("bend {bend}");
        let layered = pillowed(&mesh);
        let before =
            hexfill_embed::embed(&layered, &points, None, &Default::default(), &Context::default()).unwrap().report;
        println!(
            "{n}: {} hexes, invalid {} sj {} bound {}",
            layered.n_hexes(),
            before.n_invalid,
            before.scaled_jacobian,
            before.upper_bound
        );
        let t = std::time::Instant::now();
        let split = split_stars(&layered, &points, &SplitOptions::default(), &Context::default()).unwrap();
        println!("  {:?} left {:?} {:?}", split.splits, split.left, t.elapsed());
        assert_proper(&split.mesh, &mesh);
        let after =
            hexfill_embed::embed(&split.mesh, &points, None, &Default::default(), &Context::default()).unwrap().report;
        println!(
            "{n}: {} hexes, invalid {} sj {} bound {}",
            split.mesh.n_hexes(),
            after.n_invalid,
            after.scaled_jacobian,
            after.upper_bound
        );
    }
}

#[test]
fn look_random() {
    for seed in 0..12 {
        let mut random = Random::new(seed);
        let size = 5;
        let mut filled = vec![[2usize, 2, 2]];
        while filled.len() < 40 {
            let mut p = filled[random.below(filled.len())];
            let k = random.below(3);
            p[k] = (p[k] + if random.below(2) == 0 { 1 } else { size - 1 }) % size;
            if p.iter().all(|&x| x < size) && !filled.contains(&p) {
                filled.push(p);
            }
        }
        let (mesh, points) = voxels([2 * size; 3], |p| filled.contains(&p.map(|x| x / 2)));
        let quads: Vec<[u32; 4]> = mesh.boundary_quads().iter().map(|q| q.map(|v| v.0)).collect();
        if hexfill_mesh::QuadSurface::try_new(mesh.n_vertices(), &quads).is_err() {
            println!("seed {seed} not manifold");
            continue;
        }
        let layered = pillowed(&mesh);
        let before =
            hexfill_embed::embed(&layered, &points, None, &Default::default(), &Context::default()).unwrap().report;
        println!(
            "{seed}: {} hexes, invalid {} sj {} bound {}",
            layered.n_hexes(),
            before.n_invalid,
            before.scaled_jacobian,
            before.upper_bound
        );
        let t = std::time::Instant::now();
        let Some(split) = split_stars(&layered, &points, &SplitOptions::default(), &Context::default()) else {
            println!("none");
            continue;
        };
        for s in &split.splits {
            println!("   {s:?}");
        }
        println!("   left {:?} {:?}", split.left, t.elapsed());
        assert_proper(&split.mesh, &mesh);
        let after =
            hexfill_embed::embed(&split.mesh, &points, None, &Default::default(), &Context::default()).unwrap().report;
        println!(
            "{seed}: {} hexes, invalid {} sj {} bound {}",
            split.mesh.n_hexes(),
            after.n_invalid,
            after.scaled_jacobian,
            after.upper_bound
        );
    }
}

#[test]
fn explore() {
    use super::choose::Chooser;
    let (mesh, points) = chain(1);
    let layered = pillowed(&mesh);
    let quads: Vec<[u32; 4]> = layered.boundary_quads().iter().map(|q| q.map(|v| v.0)).collect();
    let surface = hexfill_mesh::QuadSurface::try_new(layered.n_vertices(), &quads).unwrap();
    let chooser = Chooser::new(&surface, &points, SplitOptions::default());
    let mut cells = Cells::new(&layered);
    let poor = chooser.vertices_no_direction_serves();
    for choice in chooser.all_choices(&cells, poor[0]) {
        let undo = cells.shrink(&choice.set, &choice.skin);
        let m = cells.to_mesh().unwrap();
        let after = hexfill_embed::embed(&m, &points, None, &Default::default(), &Context::default()).unwrap().report;
        println!(
            "set {:?} worth {} value {} invalid {} sj {} bound {}",
            choice.set,
            choice.worth,
            chooser.value(&cells, poor[0]),
            after.n_invalid,
            after.scaled_jacobian,
            after.upper_bound
        );
        cells.undo(&undo);
    }
}
