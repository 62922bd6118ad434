//! The context: cancelled at any time, progress by stage, the same bytes whatever runs beside; and random voxel surfaces.

mod common;

use common::{box_at, check, one_more, plate, together, torus_at, voxels};
use hexfill_construct::{ConstructError, ConstructOptions, RouteChoice, construct};
use hexfill_mesh::generate::{Random, random_sphere};
use hexfill_mesh::{Context, Progress, QuadSurface, StopReason};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

type Case = (QuadSurface, Option<Vec<[f64; 3]>>, RouteChoice);

fn cases() -> Vec<Case> {
    let placed = |(s, p): (QuadSurface, Vec<[f64; 3]>), route| (s, Some(p), route);
    let o = [0.0; 3];
    vec![
        (random_sphere(60, 5).unwrap(), None, RouteChoice::Auto),
        placed(box_at(4, 1.0, o, true), RouteChoice::Erickson),
        placed(plate(2, 2, &[]), RouteChoice::Auto),
        placed(torus_at(6, 5, true, 1.0, o, true), RouteChoice::Auto),
        placed(together(&[one_more(box_at(3, 10.0, o, true)), one_more(box_at(3, 2.0, o, false))]), RouteChoice::Auto),
    ]
}

#[test]
fn cancelled_after_any_report() {
    for (surface, points, route) in cases() {
        let run = |after: usize| {
            let cancel = AtomicBool::new(after == 0);
            let calls = AtomicUsize::new(0);
            let progress = |_: &Progress| {
                if calls.fetch_add(1, Ordering::Relaxed) + 1 == after {
                    cancel.store(true, Ordering::Relaxed);
                }
            };
            let ctx = Context { cancel: Some(&cancel), progress: Some(&progress), ..Context::default() };
            let before = Instant::now();
            let made = construct(&surface, points.as_deref(), &ConstructOptions::default().with_route(route), &ctx);
            assert!(before.elapsed() < Duration::from_secs(20));
            (made, calls.load(Ordering::Relaxed))
        };
        let (made, n_calls) = run(usize::MAX);
        assert!(made.is_ok() && n_calls >= 6, "{n_calls}");
        let mut stopped = 0;
        for after in 0..=n_calls {
            let (made, _) = run(after);
            match made {
                Err(ConstructError::Stopped(StopReason::Cancelled)) => stopped += 1,
                // The last report comes when nothing is left to stop.
                Ok(_) => assert!(after >= n_calls, "report {after} of {n_calls} did not stop the work"),
                Err(other) => panic!("{other}"),
            }
        }
        assert!(stopped >= n_calls, "{stopped} {n_calls}");
    }
}

#[test]
fn a_deadline_in_the_past_stops_at_once() {
    let (surface, points) = plate(1, 2, &[]);
    let ctx = Context::default().with_time_limit(Duration::ZERO);
    match construct(&surface, Some(&points), &ConstructOptions::default(), &ctx) {
        Err(ConstructError::Stopped(StopReason::TimeLimit)) => {}
        other => panic!("{other:?}"),
    }
}

#[test]
fn progress_names_the_stages_in_order() {
    let (surface, points) = torus_at(6, 5, true, 1.0, [0.0; 3], true);
    let stages: Mutex<Vec<&'static str>> = Mutex::new(Vec::new());
    let progress = |p: &Progress| {
        assert!(p.total.is_none_or(|t| p.done <= t));
        let mut stages = stages.lock().unwrap();
        if stages.last() != Some(&p.stage) {
            stages.push(p.stage);
        }
    };
    let ctx = Context { progress: Some(&progress), ..Context::default() };
    construct(&surface, Some(&points), &ConstructOptions::default(), &ctx).unwrap();
    let expected = ["colouring", "tetrahedra", "disks", "matching", "buffer layer", "sigma", "cells", "core", "mesh"];
    assert_eq!(*stages.lock().unwrap(), expected);
}

#[test]
fn the_same_bytes_alone_and_beside_others() {
    let bytes = |(surface, points, route): &Case| -> (Vec<[u32; 8]>, Vec<[u64; 3]>, String) {
        let options = ConstructOptions::default().with_route(*route);
        let made = construct(surface, points.as_deref(), &options, &Context::default()).unwrap();
        let start = made.start.unwrap_or_default().iter().map(|p| p.map(f64::to_bits)).collect();
        (made.mesh.hexes().iter().map(|h| h.map(|v| v.0)).collect(), start, made.report.to_string())
    };
    let cases = cases();
    let alone: Vec<_> = cases.iter().map(bytes).collect();
    // The construction has no threads of its own; two and four runs at a time share nothing but the cells.
    for n_threads in [2, 4] {
        std::thread::scope(|scope| {
            let runs: Vec<_> =
                (0..n_threads).map(|_| scope.spawn(|| cases.iter().map(bytes).collect::<Vec<_>>())).collect();
            for run in runs {
                assert!(run.join().unwrap() == alone);
            }
        });
    }
}

/// Blocks with random tunnels and bubbles: manifold voxel surfaces of any genus, with cavities and pieces apart.
#[test]
fn random_voxel_surfaces() {
    let slow = std::env::var_os("HEXFILL_SLOW").is_some();
    let (wanted, size) = (if slow { 500 } else { 40 }, [5usize, 5, 5]);
    let (mut genera, mut components) = ([0usize; 8], [0usize; 6]);
    let mut random = Random::new(3);
    let mut n = 0;
    while n < wanted {
        let mut filled = [true; 125];
        let at = |p: [usize; 3]| p[0] + 5 * (p[1] + 5 * p[2]);
        for _ in 0..random.below(5) {
            let (axis, u, v) = (random.below(3), random.below(5), random.below(5));
            for w in 0..5 {
                let mut p = [w; 3];
                p[(axis + 1) % 3] = u;
                p[(axis + 2) % 3] = v;
                filled[at(p)] = false;
            }
        }
        for _ in 0..random.below(4) {
            filled[at([0; 3].map(|_: usize| 1 + random.below(3)))] = false;
        }
        // Solids that touch along an edge or at a point have no surface.
        let is_filled = |p: [usize; 3]| filled[at(p)];
        if hexfill_mesh::generate::voxel_surface(size, is_filled).is_err() {
            continue;
        }
        let (surface, points) = voxels(size, is_filled);
        if !hexfill_mesh::is_proper(&surface) || surface.genus() > 7 || surface.n_components() > 5 {
            continue;
        }
        let made = construct(&surface, Some(&points), &ConstructOptions::default(), &Context::default()).unwrap();
        check(&surface, &made);
        genera[surface.genus() as usize] += 1;
        components[surface.n_components()] += 1;
        n += 1;
    }
    println!("voxel surfaces by genus: {genera:?}, by number of components: {components:?}");
    assert!(genera[..4].iter().all(|&g| g > 0) && components[2] > 0);
}
