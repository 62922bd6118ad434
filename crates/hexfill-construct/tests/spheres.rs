//! Every small sphere, random ones: judged proper, boundary identical.

use hexfill_check::{Judged, Level, judge};
use hexfill_construct::{BallCore, Construction, Options, construct};
use hexfill_mesh::generate::{all_spheres_up_to, octagonal_spindle, random_sphere, schneiders_pyramid};
use hexfill_mesh::{Context, QuadSurface};

fn check(surface: &QuadSurface, made: &Construction) {
    let hexes: Vec<[u32; 8]> = made.mesh.hexes().iter().map(|h| h.map(|v| v.0)).collect();
    let quads: Vec<[u32; 4]> = surface.quads().iter().map(|q| q.map(|v| v.0)).collect();
    let input = Judged::connectivity(made.mesh.n_vertices(), &hexes).with_surface(&quads);
    let report = judge(&input, &hexfill_check::Options::default().up_to(Level::L3), &Context::default());
    assert!(report.passed(Level::L3), "{:?}", report.failures);
    assert_eq!(hexes.len(), made.report.n_hexes());
    assert!(made.mesh.used_vertices().iter().all(|&u| u));
}

fn fill(surface: &QuadSurface, ball_core: BallCore) -> Construction {
    let options = Options { ball_core, ..Options::default() };
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
