//! Inward flips over all sizes up to the limit of a cavity: none may fail for want of room in its tables.

use hexfill_check::{Judged, Level, Options, judge};
use hexfill_mesh::generate::{random_sphere, voxel_surface};
use hexfill_mesh::{Context, QuadSurface};
use hexfill_search::{Atlas, FillOptions, MAX_QUADS, fill_from_atlas};

/// Fills with a small bound and judges what came out; returns the number of fillings.
fn fill(surface: &QuadSurface, beam: usize, max_cavities: u64) -> usize {
    let options = FillOptions::default().with_beam(beam).with_max_cavities(max_cavities);
    let outcome = fill_from_atlas(surface, Atlas::embedded(), &options, &Context::default()).unwrap();
    for filling in &outcome.fillings {
        let hexes: Vec<[u32; 8]> = filling.mesh.hexes().iter().map(|h| h.map(|v| v.0)).collect();
        let report = judge(
            &Judged::connectivity(filling.mesh.n_vertices(), &hexes),
            &Options::default().with_up_to(Level::L3).with_quality(false),
            &Context::default(),
        );
        assert!(report.passed(Level::L3), "{report:?}");
    }
    outcome.fillings.len()
}

#[test]
fn random_spheres_of_all_sizes_up_to_the_limit() {
    for n_quads in (44..=MAX_QUADS).step_by(2) {
        for seed in 0..40 {
            fill(&random_sphere(n_quads, seed).unwrap(), 20, 3_000);
        }
    }
    // Nothing is claimed where nothing exists.
    for n_quads in (45..MAX_QUADS).step_by(2) {
        assert_eq!(fill(&random_sphere(n_quads, 1).unwrap(), 10, 1_000), 0);
    }
}

/// `hexfill fill` on this surface once ended in a panic: its beam reaches 62 quads.
#[test]
fn the_box_of_27_voxels() {
    let surface = voxel_surface([3, 3, 3], |_| true).unwrap();
    assert_eq!(surface.n_quads(), 54);
    fill(&surface, 1000, 30_000);
}
