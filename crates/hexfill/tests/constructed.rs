//! Constructed meshes have coordinates: det J > 0 certified in every hex, from the surface alone.

use hexfill::{Context, FillOptions, Objective, Placed, Problem, Route, Strategy};
use hexfill_mesh::generate::torus;

fn placed(problem: &Problem, objective: Option<Objective>) -> Placed {
    let options = FillOptions::default().with_strategy(Strategy::Construct);
    let ctx = Context::default();
    let mut result = hexfill::fill(problem, &options, &ctx).unwrap();
    assert_eq!(result.meshes[0].route(), Route::Construction);
    let how = objective.map(hexfill::EmbedOptions::new);
    let (_, placed) = hexfill::place(result.meshes.remove(0), problem, how.as_ref(), &ctx).unwrap();
    let boundary = problem.positions().unwrap();
    assert_eq!(placed.points()[..boundary.len()], boundary[..]);
    placed
}

/// A torus of `n * m` quads round the z axis.
fn round_torus(n: u32, m: u32) -> Problem {
    let surface = torus(n, m, 0).unwrap();
    let around = |k: u32, of: u32| (f64::from(k) / f64::from(of) * std::f64::consts::TAU).sin_cos();
    let points: Vec<[f64; 3]> = (0..n * m)
        .map(|v| {
            let ((s, c), (t, u)) = (around(v % n, n), around(v / n, m));
            [(3.0 + u) * c, (3.0 + u) * s, t]
        })
        .collect();
    let quads = surface.quads_raw();
    let data = hexfill::io::MeshData { points, quads, has_coordinates: true, ..Default::default() };
    Problem::from_data("torus", &data).unwrap()
}

#[test]
fn cube_spindle_and_pyramid_reach_a_tenth() {
    for name in [":cube", ":octagonal-spindle", ":schneiders-pyramid"] {
        let report = placed(&Problem::load(name, None).unwrap(), Some(Objective::ScaledJacobian)).report();
        assert_eq!(report.certified, report.hexes, "{name}");
        let least = report.certified_scaled_jacobian.unwrap();
        assert!(least >= 0.1, "{name}: {least}");
    }
}

#[test]
fn star_shaped_surfaces_are_valid_as_constructed() {
    for name in [":cube", ":octagonal-spindle", ":schneiders-pyramid"] {
        assert!(placed(&Problem::load(name, None).unwrap(), None).is_certified(), "{name}");
    }
}

#[test]
fn a_torus_is_valid_once_embedded() {
    // Tetrahedra of the core by `DelaunayTets`; a torus is not star-shaped.
    assert!(placed(&round_torus(16, 8), Some(Objective::UntangleOnly)).is_certified());
}

#[test]
fn coarse_tori_that_are_odd_round_the_axis_are_valid_once_embedded() {
    // No two-colouring: the cells beside the edges that Sigma crosses (`bw-ldhh`, `bw-oolh`) have positions of their own.
    for (n, m) in [(9, 6), (11, 6), (15, 8)] {
        assert!(placed(&round_torus(n, m), Some(Objective::UntangleOnly)).is_certified(), "{n} x {m}");
    }
}
