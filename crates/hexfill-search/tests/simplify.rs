//! Simplification against the judge: fewer hexes, proper, the same boundary, whatever the mesh, the numbers or the threads.

mod common;

use common::{assert_sound, pillowed};
use hexfill_mesh::cube::FACETS;
use hexfill_mesh::generate::{all_spheres, grid, grid_mesh_of, shuffled_mesh};
use hexfill_mesh::{Context, HexMesh, StopReason, VertexId};
use hexfill_search::{
    Atlas, Cavity, Collapse, FillOptions, Simplified, SimplifyOptions, fill_from_atlas, simplification_atlas, simplify,
};
use std::sync::atomic::AtomicBool;

fn run(mesh: &HexMesh, balls: u64, seed: u64) -> Simplified {
    let ctx = Context { seed, ..Context::default() };
    simplify(
        mesh,
        simplification_atlas(),
        &SimplifyOptions::default().with_balls(balls).with_collapse(Collapse::Nothing),
        &ctx,
    )
}

#[test]
fn pillows_go_again() {
    for size in [[1, 1, 1], [2, 1, 1], [2, 2, 1], [2, 2, 2], [3, 2, 1], [3, 3, 3]] {
        let mesh = grid(size[0], size[1], size[2]).unwrap();
        let n = mesh.n_hexes();
        let big = pillowed(&mesh, |_| true);
        assert!(big.n_hexes() > n);
        let made = run(&big, 6000, 1);
        assert_sound(&big, &made);
        assert!(made.mesh.n_hexes() <= n, "{size:?} pillowed: {} -> {}", big.n_hexes(), made.mesh.n_hexes());
    }
    let mesh = grid(4, 3, 3).unwrap();
    let big = pillowed(&mesh, |h| h < 2);
    let made = run(&big, 6000, 1);
    assert_sound(&big, &made);
    assert!(made.mesh.n_hexes() <= 36, "{}", made.mesh.n_hexes());
}

#[test]
fn what_is_smallest_stays_as_it_is() {
    for size in [[1, 1, 1], [2, 1, 1], [2, 2, 1]] {
        let mesh = grid(size[0], size[1], size[2]).unwrap();
        let made = run(&mesh, 500, 0);
        assert_eq!(made.mesh, mesh);
        assert!(made.origin.iter().enumerate().all(|(v, o)| *o == Some(VertexId(v as u32))));
    }
    let none = HexMesh::try_new(3, &[]).unwrap();
    assert_eq!(run(&none, 100, 0).mesh, none);
    assert_eq!(run(&grid(3, 3, 3).unwrap(), 0, 0).mesh.n_hexes(), 27);
}

#[test]
fn small_spheres_lose_hexes_of_their_pillows() {
    let mut sums = [0, 0];
    for surface in [6, 8, 10, 12].into_iter().flat_map(all_spheres) {
        let ctx = Context::default();
        let filled = fill_from_atlas(&surface, Atlas::embedded(), &FillOptions::default(), &ctx).unwrap();
        let small = &filled.fillings[0].mesh;
        let big = pillowed(small, |_| true);
        let made = run(&big, 2000, 3);
        assert_sound(&big, &made);
        sums = [sums[0] + big.n_hexes(), sums[1] + made.mesh.n_hexes()];
    }
    assert!(10 * sums[1] < 9 * sums[0], "{sums:?}");
}

#[test]
fn the_result_depends_on_the_seed_and_not_on_the_threads() {
    let mesh = pillowed(&pillowed(&grid(3, 3, 2).unwrap(), |_| true), |h| h < 3);
    let with = |threads: usize, seed: u64| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| run(&mesh, 1500, seed))
    };
    let one = with(1, 7);
    assert_sound(&mesh, &one);
    for threads in [2, 5] {
        let other = with(threads, 7);
        assert_eq!(one.mesh, other.mesh);
        assert_eq!((one.origin.clone(), one.report.clone()), (other.origin, other.report));
    }
    assert_ne!(one.mesh, with(2, 8).mesh);
}

#[test]
fn other_numbers_of_the_vertices_do_no_harm() {
    let mesh = pillowed(&grid(2, 2, 2).unwrap(), |_| true);
    for seed in 0..5 {
        let (other, _) = shuffled_mesh(&mesh, seed);
        let made = run(&other, 6000, 0);
        assert_sound(&other, &made);
        assert!(made.mesh.n_hexes() <= 8, "seed {seed}: {} hexes", made.mesh.n_hexes());
    }
}

#[test]
fn meshes_that_are_no_balls_keep_their_holes() {
    // A ring and a shell round a cavity, pillowed on all sides.
    let ring = grid_mesh_of([3, 3, 1], |[x, y, _]| x != 1 || y != 1).unwrap();
    let shell = grid_mesh_of([3, 3, 3], |p| p != [1, 1, 1]).unwrap();
    let mut smaller = 0;
    for mesh in [ring, shell] {
        let big = pillowed(&mesh, |_| true);
        let made = run(&big, 4000, 2);
        assert_sound(&big, &made);
        smaller += usize::from(made.mesh.n_hexes() < big.n_hexes());
    }
    assert!(smaller >= 1);
}

#[test]
fn stopped_work_returns_what_it_has() {
    let mesh = pillowed(&grid(2, 2, 2).unwrap(), |_| true);
    let cancel = AtomicBool::new(true);
    let ctx = Context { cancel: Some(&cancel), ..Context::default() };
    let made = simplify(&mesh, simplification_atlas(), &SimplifyOptions::default(), &ctx);
    assert_eq!((made.report.stop, made.mesh.n_hexes()), (StopReason::Cancelled, mesh.n_hexes()));
    // Stopped after the first, second, ... report: always a sound mesh.
    for after in [1, 5, 40] {
        let (cancel, seen) = (AtomicBool::new(false), std::sync::atomic::AtomicU32::new(0));
        let progress = |_: &hexfill_mesh::Progress| {
            if seen.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1 == after {
                cancel.store(true, std::sync::atomic::Ordering::Relaxed);
            }
        };
        let ctx = Context { cancel: Some(&cancel), progress: Some(&progress), ..Context::default() };
        let made = simplify(&mesh, simplification_atlas(), &SimplifyOptions::default(), &ctx);
        assert_eq!(made.report.stop, StopReason::Cancelled);
        assert_sound(&mesh, &made);
    }
}

#[test]
fn a_small_atlas_and_small_balls_do_too() {
    // An atlas of one state: the cube. Only balls bounded by six quads change.
    let cube = Atlas::embedded().pruned(1, |quads, _| quads == 6);
    let mesh = pillowed(&grid(1, 1, 1).unwrap(), |_| true);
    let made = simplify(&mesh, &cube, &SimplifyOptions::default().with_balls(50), &Context::default());
    assert_sound(&mesh, &made);
    assert_eq!(made.mesh.n_hexes(), 1);
    assert_eq!(FACETS.len(), made.mesh.boundary_quads().len());
    assert!(Cavity::cube().n_quads() == 6);
}
