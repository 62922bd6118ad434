//! Every small sphere, filled through the facade and judged.

use hexfill::mesh::generate::all_spheres;
use hexfill::unstable::check::{Ball, Judged, Level, Options, judge};
use hexfill::{Context, FillOptions, Problem, Route, Strategy, fill};

/// Quads up to which all spheres are filled; `HEXFILL_SLOW=1` goes to 16 (521 more spheres).
fn largest() -> usize {
    if std::env::var_os("HEXFILL_SLOW").is_some() { 16 } else { 12 }
}

fn fill_all(strategy: Strategy) -> Vec<(usize, Route)> {
    let mut found = Vec::new();
    for quads in (6..=largest()).step_by(2) {
        for surface in all_spheres(quads) {
            let boundary: Vec<[u32; 4]> = surface.quads_raw();
            let problem = Problem::from_surface("sphere", surface);
            let options = FillOptions::default().with_strategy(strategy);
            let result = fill(&problem, &options, &Context::default()).unwrap();
            let made = &result.meshes[0];
            let hexes = made.mesh().hexes_raw();
            let judged = Judged::connectivity(made.mesh().n_vertices(), &hexes).with_surface(&boundary);
            let report = judge(&judged, &Options::default().with_up_to(Level::L3), &Context::default());
            assert!(report.passed(Level::L3), "{report}");
            assert!(matches!(report.facts.ball, Some(Ball::Yes | Ball::Homology)), "{report}");
            found.push((hexes.len(), made.route()));
        }
    }
    found
}

#[test]
fn every_small_sphere_is_filled_from_the_atlas_or_inward() {
    let found = fill_all(Strategy::Auto);
    let spheres: usize = [1, 1, 3, 11, 58, 451][..(largest() - 4) / 2].iter().sum();
    assert_eq!(found.len(), spheres);
    assert!(
        found.iter().all(|&(hexes, route)| hexes <= 72 && matches!(route, Route::Atlas | Route::InwardFlips)),
        "{found:?}"
    );
}

#[test]
fn every_small_sphere_is_constructed() {
    let found = fill_all(Strategy::Construct);
    assert!(found.iter().all(|&(_, route)| route == Route::Construction));
}
