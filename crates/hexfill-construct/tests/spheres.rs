//! Every small sphere, random ones: judged proper, boundary identical.

mod common;

use common::{box_at, voxels};
use hexfill_check::{Judged, Level, cell_quality, judge};
use hexfill_construct::{BallCore, CellChoice, ConstructOptions, Construction, Core, construct};
use hexfill_mesh::generate::{all_spheres_up_to, octagonal_spindle, random_sphere, schneiders_pyramid};
use hexfill_mesh::{Context, QuadSurface};

fn check(surface: &QuadSurface, made: &Construction) {
    let hexes: Vec<[u32; 8]> = made.mesh.hexes().iter().map(|h| h.map(|v| v.0)).collect();
    let quads: Vec<[u32; 4]> = surface.quads_raw();
    let input = Judged::connectivity(made.mesh.n_vertices(), &hexes).with_surface(&quads);
    let report = judge(&input, &hexfill_check::Options::default().with_up_to(Level::L3), &Context::default());
    assert!(report.passed(Level::L3), "{:?}", report.failures);
    assert_eq!(hexes.len(), made.report.n_hexes());
    assert!(made.mesh.used_vertices().iter().all(|&u| u));
}

fn fill(surface: &QuadSurface, ball_core: BallCore) -> Construction {
    let options = ConstructOptions::default().with_ball_core(ball_core);
    let made = construct(surface, None, &options, &Context::default()).unwrap();
    check(surface, &made);
    made
}

#[test]
fn named_spheres() {
    for (surface, quads) in [(octagonal_spindle(), 8), (schneiders_pyramid(), 16)] {
        let made = fill(&surface, BallCore::Centred);
        println!("{}", made.report);
        assert_eq!(surface.n_quads(), quads);
        assert!(made.report.n_hexes() <= 46 * quads);
        let fewer = fill(&surface, BallCore::Fewest);
        println!("{}", fewer.report);
        assert!(fewer.report.n_hexes() < made.report.n_hexes());
    }
}

#[test]
fn every_three_connected_sphere() {
    let slow = std::env::var_os("HEXFILL_SLOW").is_some();
    let limit = if slow { 16 } else { 14 };
    let all = all_spheres_up_to(limit);
    let counts: Vec<usize> = (6..=limit).step_by(2).map(|n| all[n].len()).collect();
    assert_eq!(counts, [1, 1, 3, 11, 58, 451][..counts.len()]);
    for surface in all.iter().flatten().filter(|s| s.n_quads() % 2 == 0) {
        for core in [BallCore::Centred, BallCore::Fewest] {
            let made = fill(surface, core);
            assert!(made.report.n_hexes() <= 46 * surface.n_quads());
        }
    }
}

#[test]
fn random_spheres() {
    let slow = std::env::var_os("HEXFILL_SLOW").is_some();
    for i in 0..if slow { 10_000 } else { 40 } {
        let surface = random_sphere(18 + 2 * (i % 92), i as u64).unwrap();
        let core = if i % 2 == 0 { BallCore::Fewest } else { BallCore::Centred };
        let made = fill(&surface, core);
        assert!(made.report.hexes_per_quad() <= 46.0);
    }
}

/// Certified hexes, and the least certified scaled Jacobian, as constructed.
fn quality(surface: &QuadSurface, points: &[[f64; 3]]) -> (Construction, usize, f64) {
    let options = ConstructOptions::default().with_cells(CellChoice::Embeddable);
    let made = construct(surface, Some(points), &options, &Context::default()).unwrap();
    check(surface, &made);
    let hexes = made.mesh.hexes_raw();
    let judged = Judged::connectivity(made.mesh.n_vertices(), &hexes).with_points(made.start.as_ref().unwrap());
    let cells: Vec<_> = cell_quality(&judged).into_iter().flatten().collect();
    let valid = cells.iter().filter(|c| c.valid).count();
    (made, valid, cells.iter().map(|c| c.certified_lower).fold(f64::INFINITY, f64::min))
}

#[test]
fn a_fine_ball_has_graded_tetrahedra_and_a_coarse_one_a_cone() {
    for (k, cone) in [(6, true), (9, false)] {
        let (surface, points) = box_at(k, 1.0, [0.0; 3], true);
        let round = |p: &[f64; 3]| {
            let q = p.map(|x| (x * std::f64::consts::FRAC_PI_4).tan());
            let length = (q[0] * q[0] + q[1] * q[1] + q[2] * q[2]).sqrt();
            [1.5 * q[0] / length, q[1] / length, 0.8 * q[2] / length]
        };
        let points: Vec<[f64; 3]> = points.iter().map(round).collect();
        let (made, valid, least) = quality(&surface, &points);
        println!("{}\nleast {least}", made.report);
        assert_eq!(valid, made.mesh.n_hexes());
        assert_eq!(made.report.tets_by == Core::Cone, cone);
        if cone {
            assert_eq!(made.report.n_hexes(), 46 * surface.n_quads());
            assert_eq!(made.report.n_cone_hexes, None);
        } else {
            assert!(made.report.hexes_per_quad() < 49.0 && least > 0.01);
            assert_eq!(made.report.n_cone_hexes, Some(8 * surface.n_quads()));
        }
    }
}

#[test]
fn a_surface_that_its_centroid_does_not_see_is_coned_from_its_kernel() {
    // An angle: only points in the corner see both arms.
    let (surface, points) = voxels([4, 4, 1], |[x, y, _]| x == 0 || y == 0);
    let (made, valid, _) = quality(&surface, &points);
    assert_eq!(made.report.tets_by, Core::Cone);
    assert_eq!(valid, made.mesh.n_hexes());
    let skewed: Vec<[f64; 3]> = points.iter().map(|p| [p[0] + 100.0, p[1] + 0.3 * p[0], 2.0 * p[2]]).collect();
    assert_eq!(quality(&surface, &skewed).0.report.tets_by, Core::Cone);
}
