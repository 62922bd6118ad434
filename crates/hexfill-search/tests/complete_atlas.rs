//! `data/spheres-20.hxatlas` holds a filling of every 3-connected sphere of 6 to 20 quads: replayed, placed and judged here.
//!
//! It is not the embedded atlas: its fillings are smaller, but fewer of them embed (`record/atlas-2026-11-22.md`).

use hexfill_check::{Ball, Judged, Level, Options, judge};
use hexfill_mesh::generate::{all_spheres_up_to, random_sphere};
use hexfill_mesh::{Context, QuadSurface};
use hexfill_search::{Atlas, Cavity};
use rayon::prelude::*;

/// 3-connected spheres of 6, 8, ..., 20 quads (Brinkmann et al. 2005).
const CLASSES: [usize; 8] = [1, 1, 3, 11, 58, 451, 4_461, 49_957];
const WORST: u32 = 75;

/// The hexes of the atlas's filling of a sphere, judged a ball with that boundary; `None` if it has none.
fn hexes_of_judged_filling(surface: &QuadSurface) -> Option<u64> {
    let (cavity, ids) = Cavity::from_surface(surface).unwrap();
    let (ball, map, mirrored) = Atlas::fewest().best_fit(&cavity, WORST)?;
    let boundary_ids: Vec<u32> = map.iter().map(|&v| ids[usize::from(v)]).collect();
    let first_new = surface.n_vertices() as u32;
    let (hexes, fresh) = ball.hexes_in(&boundary_ids, mirrored, first_new);
    let quads: Vec<[u32; 4]> = surface.quads_raw();
    let judged = Judged::connectivity((first_new + fresh) as usize, &hexes).with_surface(&quads);
    let report = judge(&judged, &Options::default().with_up_to(Level::L3), &Context::default());
    assert!(report.passed(Level::L3), "{report}");
    assert!(matches!(report.facts.ball, Some(Ball::Yes | Ball::Homology)), "{report}");
    Some(hexes.len() as u64)
}

#[test]
fn the_atlas_has_as_many_classes_as_there_are() {
    let stats = Atlas::fewest().stats();
    let mut hexes = 0;
    for (quads, classes) in (6..=20).step_by(2).zip(CLASSES) {
        let class = &stats.classes[&quads];
        assert_eq!(class.classes, classes, "{quads} quads");
        assert!(class.hexes.most <= WORST);
        hexes += class.hexes.sum;
    }
    assert!(hexes <= 43 * CLASSES.iter().sum::<usize>() as u64, "mean of at most 43 hexes");
    // The octagonal spindle, the only 3-connected sphere of 8 quads: one hex less than the 40 that were published.
    assert_eq!(stats.classes[&8].hexes.most, 39);
}

/// All of at most 16 quads, every tenth of 18 and random ones of 20; with `HEXFILL_SLOW=1` all.
#[test]
fn small_spheres_have_judged_fillings() {
    let slow = std::env::var_os("HEXFILL_SLOW").is_some();
    let mut by_size = all_spheres_up_to(if slow { 20 } else { 18 });
    if !slow {
        by_size.extend([Vec::new(), (0..500).map(|seed| random_sphere(20, seed).unwrap()).collect()]);
    }
    for (quads, classes) in (6..=20).step_by(2).zip(CLASSES) {
        let spheres = &by_size[quads];
        assert!(spheres.len() == classes || (quads == 20 && !slow));
        let step = if quads == 18 && !slow { 10 } else { 1 };
        let spheres: Vec<&QuadSurface> = spheres.iter().step_by(step).collect();
        let found: Vec<u64> = spheres.par_iter().filter_map(|s| hexes_of_judged_filling(s)).collect();
        assert_eq!(found.len(), spheres.len(), "{quads} quads");
        if spheres.len() == classes {
            assert_eq!(found.iter().sum::<u64>(), Atlas::fewest().stats().classes[&quads].hexes.sum, "{quads} quads");
        }
    }
}
