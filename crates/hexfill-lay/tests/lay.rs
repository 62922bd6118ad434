//! Meshes laid in a surface whose chords cross themselves heavily, judged by the independent checker.

use hexfill_check::{Judged, Level, Options, judge};
use hexfill_lay::{LaidMesh, LayOptions, Step, lay};
use hexfill_mesh::generate::{cube_surface, torus, voxels};
use hexfill_mesh::{Context, QuadSurface};
use std::path::Path;
use std::sync::atomic::AtomicBool;

type Points = Vec<[f64; 3]>;

/// The radial surface of 12 random points: 30 quads.
fn radial() -> (QuadSurface, Points) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus/surfaces/radial_12.obj");
    let data = hexfill_io::read_path(&path, None).unwrap();
    (QuadSurface::try_new(data.points.len(), &data.quads).unwrap(), data.points)
}

fn assert_sound(surface: &QuadSurface, points: &[[f64; 3]], laid: &LaidMesh) {
    let n = |step: Step| laid.steps.iter().filter(|s| **s == step).count();
    assert!(laid.steps.len() == laid.mesh.n_hexes() && n(Step::Laid) > 0 && n(Step::Sweep) > 0);
    assert!(n(Step::Pillow) <= surface.n_quads() && n(Step::Plug) == 0);
    assert_judged(surface, points, laid);
}

fn assert_judged(surface: &QuadSurface, points: &[[f64; 3]], laid: &LaidMesh) {
    assert!(laid.points[..points.len()] == *points, "the surface stays to the bit");
    let (hexes, quads) = (laid.mesh.hexes_raw(), surface.quads_raw());
    let judged = Judged::connectivity(laid.mesh.n_vertices(), &hexes).with_points(&laid.points).with_surface(&quads);
    let report = judge(&judged, &Options::default().with_up_to(Level::L5), &Context::default());
    assert!(report.passed(Level::L5), "{:?}", report.failures);
}

#[test]
fn a_surface_that_no_sweep_embeds_gets_valid_meshes_of_few_hexes() {
    let (surface, points) = radial();
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    // Two at once in twenty rounds.
    let options = LayOptions::default().with_attempts(2).with_batches(1);
    let made = one.install(|| lay(&surface, &points, &options, &Context::default()));
    assert!(made[0].mesh.n_hexes() <= 5 * surface.n_quads(), "{}", made[0].mesh.n_hexes());
    for laid in &made {
        assert_sound(&surface, &points, laid);
    }
    // The same for any number of threads.
    let three = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
    let again = three.install(|| lay(&surface, &points, &options, &Context::default()));
    assert_eq!(made.len(), again.len());
    assert!(made.iter().zip(&again).all(|(a, b)| a.mesh == b.mesh && a.points == b.points));
}

/// Two blocks joined by a bar: cut across the bar, each piece filled for itself.
#[test]
fn a_body_with_a_waist_is_filled_in_pieces() {
    let is_in = |[x, y, z]: [usize; 3]| !(7..11).contains(&x) || (2..5).contains(&y) && (2..5).contains(&z);
    let (surface, cells) = voxels([18, 7, 7], is_in).unwrap();
    let points: Points = cells.into_iter().map(|p| p.map(f64::from)).collect();
    let made = lay(&surface, &points, &LayOptions::default(), &Context::default());
    assert_eq!(made.len(), 1);
    assert_judged(&surface, &points, &made[0]);
}

#[test]
fn place_and_size_do_not_matter() {
    let (surface, points) = radial();
    let moved: Points =
        points.iter().map(|p| [0, 1, 2].map(|k: usize| 1e-4f64.mul_add(p[k], [5.0, -3.0, 0.25][k]))).collect();
    let options = LayOptions::default().with_attempts(1).with_batches(1);
    let made = lay(&surface, &moved, &options, &Context::default());
    assert_sound(&surface, &moved, &made[0]);
}

#[test]
fn no_mesh_for_other_surfaces_and_none_when_told_to_stop() {
    let torus = torus(4, 4, 0).unwrap();
    let points = vec![[0.0; 3]; torus.n_vertices()];
    assert!(lay(&torus, &points, &LayOptions::default(), &Context::default()).is_empty());
    // Flat: nothing has a volume.
    let flat = cube_surface();
    let points: Points = (0..8).map(|v| [f64::from(v & 1), f64::from(v >> 1 & 1), 0.0]).collect();
    assert!(lay(&flat, &points, &LayOptions::default(), &Context::default()).is_empty());
    let (surface, points) = radial();
    let stop = AtomicBool::new(true);
    let ctx = Context { cancel: Some(&stop), ..Context::default() };
    assert!(lay(&surface, &points, &LayOptions::default(), &ctx).is_empty());
}
