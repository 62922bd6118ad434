//! A fill that is cancelled, at whatever progress report, returns a mesh that the judge accepts or none, and says why it ended.

use hexfill::io::MeshData;
use hexfill::unstable::check::{Judged, Level, judge};
use hexfill::{
    BoundaryLayers, Context, FillOptions, PlaceOptions, PlacedFill, Problem, Progress, StopReason, Strategy,
    fill_placed,
};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// The surface of a cube of n^3 cells, its vertices moved to the `radius` in their direction.
fn ball(n: u32, radius: impl Fn([f64; 3]) -> f64) -> Problem {
    let (mut ids, mut points, mut quads) = (std::collections::BTreeMap::new(), Vec::new(), Vec::new());
    for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, n)]) {
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let mut quad = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(a, b)| {
                let mut p = [side; 3];
                (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (a, b);
                *ids.entry(p).or_insert_with(|| {
                    let q = p.map(|x| 2.0 * f64::from(x) / f64::from(n) - 1.0);
                    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
                    let unit = q.map(|x| x / length);
                    points.push(unit.map(|x| x * radius(unit)));
                    points.len() as u32 - 1
                })
            });
            if side == 0 {
                quad.reverse();
            }
            quads.push(quad);
        }
    }
    problem(points, &quads)
}

/// A round torus, n quads round the axis and m round the tube.
fn torus(n: u32, m: u32) -> Problem {
    let at = |i: u32, j: u32| (i % n) * m + j % m;
    let angle = |i: u32, n: u32| std::f64::consts::TAU * f64::from(i) / f64::from(n);
    let points = (0..n * m).map(|v| (angle(v / m, n), angle(v % m, m))).map(|(a, b)| {
        let r = 2.0 + b.cos();
        [r * a.cos(), r * a.sin(), b.sin()]
    });
    let quads: Vec<[u32; 4]> = (0..n * m)
        .map(|v| (v / m, v % m))
        .map(|(i, j)| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)])
        .collect();
    problem(points.collect(), &quads)
}

fn problem(points: Vec<[f64; 3]>, quads: &[[u32; 4]]) -> Problem {
    Problem::from_data("test", &MeshData::from_quads(points, quads.to_vec())).unwrap()
}

fn spiky(n: u32) -> Problem {
    ball(n, |[x, y, z]| 1.0 + 0.5 * (7.0 * x + 1.0).sin() * (5.0 * y + 2.0).sin() * (6.0 * z + 3.0).cos())
}

/// Fills and places; cancels at the k-th progress report. With the number of reports.
fn cancelled_at(problem: &Problem, options: &FillOptions, k: u64) -> (PlacedFill, u64) {
    let (cancel, reports) = (AtomicBool::new(k == 0), AtomicU64::new(0));
    let progress = |_: &Progress| {
        if reports.fetch_add(1, Ordering::Relaxed) + 1 == k {
            cancel.store(true, Ordering::Relaxed);
        }
    };
    let ctx = Context { cancel: Some(&cancel), progress: Some(&progress), ..Context::default() };
    let how = PlaceOptions::default();
    let made = fill_placed(problem, options, &how, &ctx).unwrap();
    (made, reports.into_inner())
}

/// The judge accepts every mesh, with the positions of the surface bit for bit.
fn accept(problem: &Problem, made: &PlacedFill) {
    let quads: Vec<[u32; 4]> = problem.surface().quads_raw();
    for (filled, placed) in &made.meshes {
        let hexes = filled.mesh().hexes_raw();
        let judged = Judged::connectivity(filled.mesh().n_vertices(), &hexes).with_surface(&quads);
        let options = hexfill::unstable::check::Options::default().with_up_to(Level::L3);
        assert!(judge(&judged, &options, &Context::default()).passed(Level::L3));
        if let (Some(placed), Some(points)) = (placed, problem.points()) {
            assert_eq!(&placed.points()[..points.len()], points);
        }
    }
}

/// Cancels at these reports; a surface that can be constructed is left with a mesh.
fn cancel_at(name: &str, problem: &Problem, reports: &[u64]) {
    for &k in reports {
        let (made, n) = cancelled_at(problem, &FillOptions::default(), k);
        accept(problem, &made);
        assert_eq!(made.meshes.len(), 1, "{name}: nothing after report {k}: {:?}", made.tried);
        let expected = if n < k { StopReason::Finished } else { StopReason::Cancelled };
        assert_eq!(made.stop, expected, "{name}: report {k} of {n}");
    }
}

/// Up to `most` numbers from 0 to n, ends included.
fn spread(n: u64, most: u64) -> Vec<u64> {
    let mut ks: Vec<u64> = (0..most).map(|i| i * n / (most - 1)).collect();
    ks.dedup();
    ks
}

/// Two copies of a surface side by side.
fn twice(one: &Problem) -> Problem {
    let data = one.data();
    let n = data.points.len() as u32;
    let beside = data.points.iter().map(|p| [p[0] + 10.0, p[1], p[2]]);
    let quads: Vec<[u32; 4]> = (0..2).flat_map(|i| data.quads.iter().map(move |q| q.map(|v| v + i * n))).collect();
    problem(data.points.iter().copied().chain(beside).collect(), &quads)
}

#[test]
fn cancelled_at_any_report_there_is_a_mesh() {
    let spindle = Problem::load(":octagonal-spindle", None).unwrap();
    for (name, problem) in [("spindle", spindle), ("ball", ball(4, |_| 1.0)), ("torus", torus(7, 6))] {
        let (made, n) = cancelled_at(&problem, &FillOptions::default(), u64::MAX);
        assert_eq!(made.stop, StopReason::Finished, "{name}");
        cancel_at(name, &problem, &spread(n, 6));
    }
}

#[test]
fn hard_surfaces_are_constructed_if_nothing_else_came_first() {
    // Whole fills of these take long: their last report is not waited for.
    let cell = Problem::load(":buffer-cube-20", None).unwrap();
    for (name, problem) in [("spiky", spiky(4)), ("cell", cell), ("two", twice(&spiky(3)))] {
        cancel_at(name, &problem, &[0, 1, 2, 3, 5, 8, 13, 21, 34]);
    }
}

#[test]
fn a_single_engine_that_is_cancelled_brings_a_mesh_or_stops_cleanly() {
    let layers = BoundaryLayers { count: 2, height: None, growth: 1.0 };
    let options = [
        FillOptions::default().with_strategy(Strategy::Shell),
        FillOptions::default().with_strategy(Strategy::Atlas),
        FillOptions::default().with_strategy(Strategy::Construct),
        FillOptions::default().with_count(3),
        FillOptions::default().with_max_hexes(10),
        FillOptions::default().with_layers(layers),
    ];
    let problem = spiky(2);
    for (i, options) in options.iter().enumerate() {
        for k in [0, 1, 2, 3, 5, 8] {
            let (made, n) = cancelled_at(&problem, options, k);
            accept(&problem, &made);
            assert!(n < k || made.stop == StopReason::Cancelled, "options {i}, report {k} of {n}: {:?}", made.stop);
        }
    }
}
