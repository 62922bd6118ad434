//! Shelling from the surface to certified coordinates: what users of real surfaces get.

use hexfill::{
    Attempt, BoundaryLayers, Context, FillOptions, PlaceOptions, Prefer, Problem, Route, Strategy, fill_placed,
};

/// The boundary of filled cells with its positions.
fn voxels(size: [usize; 3], filled: impl Fn([usize; 3]) -> bool) -> Problem {
    let (surface, points) = hexfill_mesh::generate::voxels(size, filled).unwrap();
    Problem::new("test", surface, points.into_iter().map(|p| p.map(f64::from)).collect()).unwrap()
}

/// Hexes and certified worst scaled Jacobian of what `fill` makes.
fn filled(problem: &Problem, options: &FillOptions) -> (usize, f64, Vec<[u32; 8]>) {
    let how = PlaceOptions::default();
    let made = fill_placed(problem, options, &how, &Context::default()).unwrap();
    let (filled, placed) = &made.meshes[0];
    assert_eq!(filled.route(), Route::Shelling);
    let placed = placed.as_ref().unwrap();
    assert_eq!(&placed.points()[..problem.surface().n_vertices()], problem.points().unwrap());
    (filled.mesh().n_hexes(), if placed.is_certified() { placed.worst() } else { -1.0 }, filled.mesh().hexes_raw())
}

#[test]
fn voxel_solids_are_their_voxels() {
    type Solid = ([usize; 3], fn([usize; 3]) -> bool, usize);
    let solids: [Solid; 7] = [
        ([3, 3, 3], |_| true, 27),
        ([4, 5, 6], |_| true, 120),
        ([4, 4, 3], |[x, y, _]| x < 2 || y < 2, 36),
        // A frame, a plate with two tunnels, a hollow box, stairs.
        ([3, 3, 2], |[x, y, _]| x != 1 || y != 1, 16),
        ([5, 3, 1], |[x, y, _]| y != 1 || x % 2 == 0, 13),
        ([3, 3, 3], |p| p != [1, 1, 1], 26),
        ([4, 3, 4], |[x, _, z]| z <= x, 30),
    ];
    for (size, is_filled, cells) in solids {
        let problem = voxels(size, is_filled);
        let (hexes, worst, _) = filled(&problem, &FillOptions::default());
        assert_eq!(hexes, cells, "{size:?}");
        assert!(worst > 1.0 - 1e-9, "{size:?}: {worst}");
    }
}

#[test]
fn real_surfaces_get_a_few_good_hexes_a_quad_for_any_number_of_threads() {
    for (name, most, least) in [("cubespikes", 2900, 0.7), ("bamboo_pen", 4640, 0.2)] {
        let file = format!("{}/../../corpus/surfaces/{name}.obj", env!("CARGO_MANIFEST_DIR"));
        let problem = Problem::load(&file, None).unwrap();
        let mut meshes = Vec::new();
        for threads in [1, 2] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let (hexes, worst, mesh) = pool.install(|| filled(&problem, &FillOptions::default()));
            assert!(hexes <= most && worst >= least, "{name}: {hexes} hexes, {worst}");
            meshes.push(mesh);
        }
        assert!(meshes[0] == meshes[1], "{name}: the number of threads changes the mesh");
    }
}

#[test]
fn large_balls_are_coarser_inside() {
    let (surface, points) = hexfill_mesh::generate::cubed_sphere(16).unwrap();
    let problem = Problem::new("ball", surface, points).unwrap();
    let quads = problem.surface().n_quads();
    let (hexes, worst, _) = filled(&problem, &FillOptions::default());
    assert!(hexes <= 2 * quads && worst >= 0.6, "{hexes} hexes, {worst}");
    // Nothing is lost: who wants the best angles gets all the sheets.
    let best = FillOptions::default().with_prefer(Prefer::Quality);
    let (hexes, worst, _) = filled(&problem, &best);
    assert_eq!(hexes, 16 * 16 * 16 + quads);
    assert!(worst >= 0.75, "{worst}");
    // Boxes are coarser only for those who want that.
    let fewest = FillOptions::default().with_prefer(Prefer::Hexes);
    let (hexes, worst, _) = filled(&voxels([12, 12, 12], |_| true), &fewest);
    assert!(hexes < 1200 && worst >= 0.5, "{hexes} hexes, {worst}");
}

#[test]
fn where_no_sweep_has_valid_positions_hexes_are_laid_one_by_one() {
    let file = format!("{}/../../corpus/surfaces/radial_12.obj", env!("CARGO_MANIFEST_DIR"));
    let problem = Problem::load(&file, None).unwrap();
    let made = fill_placed(&problem, &FillOptions::default(), &PlaceOptions::default(), &Context::default()).unwrap();
    let (filled, placed) = &made.meshes[0];
    let placed = placed.as_ref().unwrap();
    assert_eq!(filled.route(), Route::Laying, "{:?}", made.choice);
    assert!(placed.is_certified() && placed.worst() > 0.2, "{}", placed.worst());
    assert!(filled.mesh().n_hexes() <= 5 * problem.surface().n_quads());
    assert!(made.tried.iter().any(|t| matches!(t, Attempt::Laying { meshes } if *meshes > 0)));
}

#[test]
fn boundary_layers_lie_under_the_whole_surface() {
    let problem = voxels([2, 2, 2], |_| true);
    let layers = BoundaryLayers { count: 3, height: Some(0.05), growth: 1.5 };
    let options = FillOptions::default().with_strategy(Strategy::Shell).with_layers(layers);
    let (hexes, worst, _) = filled(&problem, &options);
    // Three layers and what is left of the pillow on 24 quads, and the 8 cubes.
    assert_eq!(hexes, 4 * 24 + 8);
    assert!(worst > 0.2, "{worst}");
}

#[test]
fn boundary_layers_are_refused_where_nothing_would_cut_them() {
    let layers = BoundaryLayers { count: 2, height: None, growth: 1.0 };
    let options = FillOptions::default().with_layers(layers).with_strategy(Strategy::Construct);
    let made = fill_placed(&voxels([2, 1, 1], |_| true), &options, &PlaceOptions::default(), &Context::default());
    assert!(made.is_err_and(|e| e.to_string().contains("auto or shell")));
}

#[test]
fn a_cancelled_shelling_returns_nothing_or_a_mesh() {
    let file = format!("{}/../../corpus/surfaces/cubespikes.obj", env!("CARGO_MANIFEST_DIR"));
    let problem = Problem::load(&file, None).unwrap();
    let cancel = std::sync::atomic::AtomicBool::new(true);
    let ctx = Context { cancel: Some(&cancel), ..Context::default() };
    let how = PlaceOptions::default();
    let only = FillOptions::default().with_strategy(Strategy::Shell);
    let made = fill_placed(&problem, &only, &how, &ctx).unwrap();
    assert_eq!(made.stop, hexfill::StopReason::Cancelled);
    assert!(made.meshes.is_empty());
}

#[test]
fn where_no_mesh_can_be_valid_it_is_said_what_was_tried() {
    let cubes = voxels([3, 3, 3], |_| true);
    // A corner of the box onto the line between two of its neighbours: the quad is straight there, and no star is perfect.
    let mut points = cubes.points().unwrap().to_vec();
    let corner = points.iter().position(|p| *p == [0.0; 3]).unwrap();
    points[corner] = [0.5, 0.5, 0.0];
    let problem = Problem::new("dented", cubes.surface().clone(), points).unwrap();
    let how = PlaceOptions::default();
    let made = fill_placed(&problem, &FillOptions::default(), &how, &Context::default()).unwrap();
    assert!(!made.meshes[0].1.as_ref().unwrap().is_certified());
    let choice = made.choice.unwrap().to_string();
    assert!(choice.contains("the best of"), "{choice}");
    assert!(choice.contains("no further mesh was tried, since none can be valid: quad"), "{choice}");
}
