//! Several components: apart, nested, inside out.

use hexfill::io::MeshData;
use hexfill::mesh::cube::{FACETS, POSITIONS};
use hexfill::unstable::check::{Judged, Level, Options, judge};
use hexfill::{BoundaryLayers, Context, FillOptions, PlaceOptions, Problem, fill, fill_placed};

/// Axis-parallel cubes given by edge length, lowest corner and whether they are turned inside out.
fn cubes(parts: &[(f64, f64, bool)]) -> MeshData {
    let mut points = Vec::new();
    let mut quads = Vec::new();
    for &(size, low, inside_out) in parts {
        let first = points.len() as u32;
        points.extend(POSITIONS.map(|p| p.map(|x| low + size * f64::from(x))));
        quads.extend(FACETS.map(|f| {
            let [a, b, c, d] = f.map(|v| first + v as u32);
            if inside_out { [a, d, c, b] } else { [a, b, c, d] }
        }));
    }
    MeshData::from_quads(points, quads)
}

fn filled(data: &MeshData) -> (Problem, hexfill::FillResult) {
    let problem = Problem::from_data("cubes", data).unwrap();
    let result = fill(&problem, &FillOptions::default(), &Context::default()).unwrap();
    (problem, result)
}

#[test]
fn components_apart_are_filled_one_by_one() {
    for turned in [false, true] {
        let (problem, result) = filled(&cubes(&[(1.0, 0.0, false), (2.0, 5.0, turned), (1.0, -7.0, false)]));
        assert_eq!(problem.notes().len(), usize::from(turned));
        let mesh = result.meshes[0].mesh();
        assert_eq!((mesh.n_hexes(), mesh.n_vertices()), (3, 24));
        let hexes = mesh.hexes_raw();
        let quads: Vec<[u32; 4]> = problem.surface().quads_raw();
        let points = problem.points().unwrap();
        let judged = Judged::connectivity(24, &hexes).with_surface(&quads).with_points(points);
        let report = judge(&judged, &Options::default(), &Context::default());
        assert!(report.passed(Level::L5), "{report}");
    }
}

#[test]
fn a_cavity_is_left_empty() {
    for turned in [false, true] {
        let (problem, result) = filled(&cubes(&[(5.0, 0.0, false), (1.0, 2.0, turned)]));
        assert_eq!(problem.notes().len(), usize::from(!turned), "the inner quads face the cavity");
        let mesh = result.meshes[0].mesh();
        let hexes = mesh.hexes_raw();
        let quads: Vec<[u32; 4]> = problem.surface().quads_raw();
        let judged = Judged::connectivity(mesh.n_vertices(), &hexes).with_surface(&quads);
        let report = judge(&judged, &Options::default(), &Context::default());
        assert!(report.passed(Level::L3), "{report}");
        assert_eq!(report.facts.betti, Some([1, 0, 1, 0]), "a ball with a cavity");
    }
}

/// Two balls of 6 x 6 quads a face, apart.
fn two_balls() -> MeshData {
    let (surface, ball) = hexfill_mesh::generate::cubed_sphere(6).unwrap();
    let n = ball.len() as u32;
    let other = ball.iter().map(|[x, y, z]| [x + 4.0, *y, *z]);
    let quads = surface.quads_raw();
    let beside = quads.iter().map(|q: &[u32; 4]| q.map(|v| v + n));
    MeshData::from_quads(ball.iter().copied().chain(other).collect(), quads.iter().copied().chain(beside).collect())
}

#[test]
fn each_component_gets_the_best_of_its_meshes() {
    let problem = Problem::from_data("balls", &two_balls()).unwrap();
    let (ctx, how) = (Context::default(), PlaceOptions::default());
    let made = fill_placed(&problem, &FillOptions::default(), &how, &ctx).unwrap();
    let (filled, placed) = &made.meshes[0];
    let placed = placed.as_ref().unwrap();
    // Without a pillow it would be 432 at 0.19.
    assert!(placed.is_certified() && placed.worst() > 0.7, "{}", placed.worst());
    assert_eq!(&placed.points()[..problem.surface().n_vertices()], problem.points().unwrap());
    let pillows = filled.mesh().n_hexes();
    assert!(pillows <= 2 * 432);
    assert_eq!(made.choice.unwrap().components.len(), 2);
    // Boundary layers under both.
    let layers = BoundaryLayers { count: 2, height: None, growth: 1.0 };
    let made = fill_placed(&problem, &FillOptions::default().with_layers(layers), &how, &ctx).unwrap();
    let (layered, placed) = &made.meshes[0];
    assert!(placed.as_ref().unwrap().is_certified());
    assert_eq!(layered.layers().iter().filter(|&&layer| layer == 2).count(), 432);
}
