//! The pipeline against the independent judge.

mod common;

use common::{Sample, assert_boundary_kept, ball, certified, grid};
use hexfill_embed::{Objective, Options, embed, star_bounds, tutte_start};
use hexfill_mesh::{Context, HexMesh, StopReason};
use std::time::{Duration, Instant};

#[test]
fn refinement_cubes_reach_their_star_bound() {
    for name in ["refine_9to1_13", "refine_16to4_28"] {
        let sample = Sample::read(name);
        let mesh = sample.mesh();
        let done = embed(&mesh, &sample.boundary_points, None, &Options::default(), &Context::default()).unwrap();
        let (valid, [lower, upper]) = certified(&mesh, &done.points);
        assert!(valid && done.report.valid_in_floating_point);
        assert_boundary_kept(&mesh, &sample.boundary_points, &done.points);
        // The bound is met, so this is the optimum for this boundary.
        assert!((done.report.upper_bound - 0.5).abs() < 1e-9);
        assert!(lower > 0.5 - 1e-6 && upper <= 0.5 + 1e-9, "{name} {lower} {upper}");
        assert!((done.report.scaled_jacobian - lower).abs() < 1e-6);
        assert_eq!(done.report.stop, StopReason::Finished);
    }
}

#[test]
fn the_pyramid_with_36_hexes_reaches_its_optimum() {
    let sample = Sample::read("pyramid_36");
    let mesh = sample.mesh();
    let optimum = 0.1f64.sqrt();
    let done = embed(&mesh, &sample.boundary_points, None, &Options::default(), &Context::default()).unwrap();
    let (valid, [lower, _]) = certified(&mesh, &done.points);
    assert!(valid && lower >= 0.3162277, "{lower}");
    assert!((done.report.upper_bound - optimum).abs() < 1e-12, "{}", done.report.upper_bound);
    assert_boundary_kept(&mesh, &sample.boundary_points, &done.points);
    let options = Options::new(Objective::Balanced);
    let done = embed(&mesh, &sample.boundary_points, None, &options, &Context::default()).unwrap();
    let (valid, [lower, _]) = certified(&mesh, &done.points);
    assert!(valid && lower >= 0.30 && done.report.condition <= 51.0, "{lower} {}", done.report.condition);
}

#[test]
fn the_spindle_with_40_hexes_has_coordinates() {
    let sample = Sample::read("spindle_40");
    let mesh = sample.mesh();
    // One start may end at another optimum, 0.234.
    let options = Options::default().with_starts(2);
    let done = embed(&mesh, &sample.boundary_points, None, &options, &Context::default()).unwrap();
    let (valid, [lower, _]) = certified(&mesh, &done.points);
    assert!(valid && lower >= 0.239, "{lower}");
    assert!(done.report.upper_bound >= done.report.scaled_jacobian && done.report.upper_bound < 0.5);
    for star in star_bounds(&mesh, &sample.boundary_points).unwrap() {
        // What the directions of a star reach is no proof of a mesh, but it must not exceed their bound.
        assert!(star.bound >= done.report.scaled_jacobian && star.bound <= 1.0, "{star:?}");
        assert!(star.angle_bound >= star.bound && star.attained < 1.0, "{star:?}");
    }
}

/// Classes with 40, 42 and 44 hexes that are as good as the one with 36: their bound is 1/sqrt(10), too. Four hexes
/// on the base and the spindle's 40 above them make two more with 44, according to which way the spindle is
/// turned: that of Verhetsel, Pellerin and Remacle (2018), and one that is better than any with fewer hexes.
#[test]
fn larger_pyramids_reach_the_same_optimum_and_one_more() {
    let optimum = 0.1f64.sqrt();
    for (name, hexes, least, bound) in [
        ("pyramid_40", 40, 0.3162, optimum),
        ("pyramid_42", 42, 0.3162, optimum),
        ("pyramid_44", 44, 0.31, optimum),
        ("pyramid_44_2018", 44, 0.22961, f64::NAN),
        ("pyramid_44_best", 44, 0.3971, f64::NAN),
    ] {
        let sample = Sample::read(name);
        let mesh = sample.mesh();
        assert_eq!(mesh.n_hexes(), hexes);
        let options = Options::default().with_starts(1);
        let done = embed(&mesh, &sample.boundary_points, None, &options, &Context::default()).unwrap();
        let (valid, [lower, _]) = certified(&mesh, &done.points);
        assert!(valid && lower >= least, "{name} {lower}");
        let reached = done.report.upper_bound;
        assert!(bound.is_nan() || (reached - bound).abs() < 1e-12, "{name} {reached}");
        assert!(reached >= lower, "{name} {reached}");
        assert_boundary_kept(&mesh, &sample.boundary_points, &done.points);
    }
}

#[test]
fn a_start_that_cannot_be_untangled_comes_back_no_worse() {
    // A boundary pushed through itself: nothing is valid, whatever the inside does.
    let (mesh, mut start) = grid(4, 0.3);
    let before = start.clone();
    start[0] = [2.0, 2.0, 2.0];
    let count = |points: &[[f64; 3]]| {
        let hexes = mesh.hexes_raw();
        let input = hexfill_check::Judged::connectivity(mesh.n_vertices(), &hexes).with_points(points);
        hexfill_check::cell_quality(&input).into_iter().flatten().filter(|c| !c.valid).count()
    };
    let mut bad = before;
    bad[0] = start[0];
    let done = embed(&mesh, &bad, Some(&bad), &Options::default(), &Context::default()).unwrap();
    assert!(count(&bad) > 0 && count(&done.points) <= count(&bad), "{} {}", count(&bad), count(&done.points));
    assert!(!done.report.valid_in_floating_point);
}

#[test]
fn symmetric_positions_are_symmetric_and_as_good() {
    for (name, order, least) in [("pyramid_36", 4, 0.3162), ("spindle_40", 4, 0.19)] {
        let sample = Sample::read(name);
        let mesh = sample.mesh();
        let options = Options::default().with_symmetric(true).with_starts(2);
        let done = embed(&mesh, &sample.boundary_points, None, &options, &Context::default()).unwrap();
        assert_eq!(done.report.symmetries, order, "{name}");
        let (valid, [lower, _]) = certified(&mesh, &done.points);
        assert!(valid && lower >= least, "{name} {lower}");
        assert_boundary_kept(&mesh, &sample.boundary_points, &done.points);
        // Every automorphism that keeps distances on the boundary keeps all distances.
        let fixed = mesh.boundary_vertices();
        let distance =
            |v: usize, w: usize| (0..3).map(|k| (done.points[v][k] - done.points[w][k]).powi(2)).sum::<f64>().sqrt();
        let n = done.points.len();
        let keeps = |image: &[hexfill_mesh::VertexId], among: &dyn Fn(usize) -> bool| {
            (0..n).filter(|&v| among(v)).all(|v| {
                (0..v)
                    .filter(|&w| among(w))
                    .all(|w| (distance(v, w) - distance(image[v].index(), image[w].index())).abs() < 1e-9)
            })
        };
        let symmetric = hexfill_mesh::hex_automorphisms(&mesh)
            .unwrap()
            .into_iter()
            .filter(|a| keeps(&a.vertices, &|v| fixed[v]))
            .map(|a| assert!(keeps(&a.vertices, &|_| true), "{name}"))
            .count();
        assert_eq!(symmetric, order, "{name}");
    }
}

#[test]
fn balanced_keeps_most_of_the_optimum_and_lowers_the_condition() {
    let sample = Sample::read("refine_9to1_13");
    let mesh = sample.mesh();
    let run = |objective| {
        embed(&mesh, &sample.boundary_points, None, &Options::new(objective), &Context::default()).unwrap().report
    };
    let (best, balanced) = (run(Objective::ScaledJacobian), run(Objective::Balanced));
    assert!(balanced.scaled_jacobian >= 0.95 * best.scaled_jacobian - 1e-9);
    assert!(balanced.condition < best.condition);
}

#[test]
fn tangled_grids_are_untangled() {
    let context = Context::default();
    for (n, noise) in [(3, 1.0), (4, 3.0), (6, 0.8)] {
        let (mesh, start) = grid(n, noise);
        assert!(!certified(&mesh, &start).0, "the start is tangled");
        let options = Options::new(Objective::UntangleOnly);
        let done = embed(&mesh, &start, Some(&start), &options, &context).unwrap();
        assert!(certified(&mesh, &done.points).0 && done.report.valid_in_floating_point, "{n} {noise}");
        assert_boundary_kept(&mesh, &start, &done.points);
    }
    // All interior vertices in one point, and all outside the cube.
    for place in [[0.5; 3], [7.0, -3.0, 2.0]] {
        let (mesh, mut start) = grid(4, 0.0);
        for (v, &on) in mesh.boundary_vertices().iter().enumerate() {
            if !on {
                start[v] = place;
            }
        }
        let options = Options::new(Objective::UntangleOnly);
        let done = embed(&mesh, &start, Some(&start), &options, &context).unwrap();
        assert!(certified(&mesh, &done.points).0, "{place:?}");
    }
}

#[test]
fn a_grid_is_restored_to_nearly_perfect() {
    let (mesh, start) = grid(3, 0.9);
    let done = embed(&mesh, &start, Some(&start), &Options::default(), &Context::default()).unwrap();
    assert!(done.report.scaled_jacobian > 0.999, "{}", done.report.scaled_jacobian);
}

#[test]
fn only_bad_cells_move_in_large_meshes() {
    let n = 12;
    let (mesh, mut points) = grid(n, 0.0);
    // Swap two interior neighbours far from the corner at the origin.
    let at = |i: usize, j: usize, k: usize| i + (n + 1) * (j + (n + 1) * k);
    points.swap(at(9, 9, 9), at(10, 9, 9));
    let options = Options::new(Objective::UntangleOnly);
    let done = embed(&mesh, &points, Some(&points), &options, &Context::default()).unwrap();
    assert!(certified(&mesh, &done.points).0);
    for (i, j, k) in [(2, 2, 2), (5, 5, 5), (1, 10, 10)] {
        let (new, old) = (done.points[at(i, j, k)], points[at(i, j, k)]);
        assert!((0..3).all(|x| (new[x] - old[x]).abs() < 1e-12), "{new:?} {old:?}");
    }
    assert_ne!(done.points[at(9, 9, 9)], points[at(9, 9, 9)]);
}

#[test]
fn same_bytes_for_any_number_of_threads() {
    let sample = Sample::read("refine_16to4_28");
    let (grid_mesh, grid_start) = grid(5, 0.9);
    let mesh = sample.mesh();
    let run = |threads: usize| {
        let options = Options::default().with_threads(threads).with_starts(3);
        let context = Context { seed: 42, ..Context::default() };
        let a = embed(&mesh, &sample.boundary_points, None, &options, &context).unwrap();
        let options = options.with_whole_limit(20).with_programs(6); // patches
        let b = embed(&grid_mesh, &grid_start, Some(&grid_start), &options, &context).unwrap();
        (a, b)
    };
    let one = run(1);
    for threads in [2, 5] {
        let many = run(threads);
        for (a, b) in [(&one.0, &many.0), (&one.1, &many.1)] {
            assert_eq!(a.report, b.report);
            assert!(a.points.iter().flatten().zip(b.points.iter().flatten()).all(|(x, y)| x.to_bits() == y.to_bits()));
        }
    }
}

#[test]
fn tiny_and_huge_coordinates_are_the_same_problem() {
    let sample = Sample::read("refine_9to1_13");
    let mesh = sample.mesh();
    let run = |scale: f64| {
        let boundary: Vec<[f64; 3]> = sample.boundary_points.iter().map(|p| p.map(|x| x * scale)).collect();
        embed(&mesh, &boundary, None, &Options::default(), &Context::default()).unwrap().report
    };
    let one = run(1.0).scaled_jacobian;
    for scale in [1e-300, 1e-30, 1e30, 1e300] {
        let report = run(scale);
        assert!(report.valid_in_floating_point);
        assert!((report.scaled_jacobian - one).abs() < 1e-6, "{scale} {}", report.scaled_jacobian);
    }
}

#[test]
fn the_start_honours_the_boundary_and_means() {
    let (mesh, points) = grid(4, 0.7);
    let start = tutte_start(&mesh, &points).unwrap();
    assert_boundary_kept(&mesh, &points, &start);
    // On a grid the graph-Laplacian solution is the grid itself.
    let (_, exact) = grid(4, 0.0);
    for (a, b) in start.iter().zip(&exact) {
        assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-9));
    }
    let bounds = star_bounds(&mesh, &points).unwrap();
    assert!(bounds.iter().all(|b| b.bound > 0.99));
}

#[test]
fn a_boundary_that_allows_nothing_is_named() {
    // A reflected cube: every corner is negative whatever one does.
    let mesh = HexMesh::try_new(8, &[[0, 1, 2, 3, 4, 5, 6, 7]]).unwrap();
    let mirrored: Vec<[f64; 3]> =
        hexfill_mesh::cube::POSITIONS.iter().map(|p| [-f64::from(p[0]), f64::from(p[1]), f64::from(p[2])]).collect();
    let done = embed(&mesh, &mirrored, None, &Options::default(), &Context::default()).unwrap();
    assert!(!done.report.valid_in_floating_point && done.report.is_impossible());
    assert_eq!(done.report.n_invalid, 1);
    // Flat in a plane: the bound is 0, nothing valid is found, and no claim is made beyond that.
    let (mesh, points) = grid(2, 0.0);
    let flat: Vec<[f64; 3]> = points.iter().map(|p| [p[0], p[1], 0.0]).collect();
    let done = embed(&mesh, &flat, None, &Options::default(), &Context::default()).unwrap();
    assert!(!done.report.valid_in_floating_point && done.report.upper_bound <= 1e-12 && !done.report.is_impossible());
    assert!(done.report.n_invalid == 8 && done.report.worst_cells[0].scaled_jacobian <= 0.0);
    // Two boundary vertices in one point.
    let (mesh, mut points) = grid(2, 0.0);
    points[0] = points[1];
    let done = embed(&mesh, &points, None, &Options::default(), &Context::default()).unwrap();
    assert!(!done.report.valid_in_floating_point && done.report.upper_bound <= 1e-12);
    // A boundary pushed through itself.
    let (mesh, mut points) = grid(2, 0.0);
    points[0] = [2.0, 2.0, 2.0];
    let done = embed(&mesh, &points, None, &Options::default(), &Context::default()).unwrap();
    assert!(!done.report.valid_in_floating_point);
}

#[test]
fn a_time_limit_returns_the_best_so_far() {
    let (mesh, points) = grid(10, 2.0);
    let context = Context::default().with_time_limit(Duration::from_millis(1));
    let before = Instant::now();
    let done = embed(&mesh, &points, Some(&points), &Options::default(), &context).unwrap();
    assert_eq!(done.report.stop, StopReason::TimeLimit);
    assert!(before.elapsed() < Duration::from_secs(5));
    assert_eq!(done.points.len(), mesh.n_vertices());
}

/// A corner of the cube behind the pillow has four hexes, whose best is reached in the limit of a vanishing star only. The way
/// by parts starts there from squeezed cells.
#[test]
fn a_ball_behind_a_pillow_keeps_its_edges() {
    let n = 14;
    let (mesh, points) = ball(n);
    assert_eq!(mesh.n_hexes(), n * n * n + 6 * n * n);
    let options = Options::default().with_starts(1).with_smooth_start(true);
    for local_limit in [1000, 20_000] {
        let options = options.with_local_limit(local_limit);
        let done = embed(&mesh, &points, Some(&points), &options, &Context::default()).unwrap();
        // Edges of the surface are 0.07 and longer.
        assert!(done.report.shortest_edge > 0.01, "{local_limit} {}", done.report.shortest_edge);
        assert!(done.report.condition < 10.0, "{local_limit} {}", done.report.condition);
        let (valid, [lower, _]) = certified(&mesh, &done.points);
        assert!(valid && lower >= 0.99 * done.report.upper_bound, "{local_limit} {lower}");
        assert!((done.report.upper_bound - 4.0 / 27f64.sqrt()).abs() < 1e-9, "{}", done.report.upper_bound);
    }
}
