//! The verbs: coordinates for a mesh, a start, and bounds.
//!
//! Source: ours: which steps, in which order (book, page `embedding`, "The way of a mesh").

use crate::bounds::{StarBound, least_bound, refine_stars, star_bounds_of};
use crate::error::EmbedError;
use crate::improvement::{self, untangle_rings, untangle_whole};
use crate::options::{Objective, Options};
use crate::pipeline::{NEAR_OPTIMUM, Normal, SMALL, run};
use crate::problem::find_symmetry;
use crate::quality::bad_cells;
use crate::report::Embedding;
use crate::starts::{Weights, place_at_means};
use hexfill_geometry::Vector;
use hexfill_mesh::{Context, HexId, HexMesh};

/// Finds coordinates for `mesh`.
///
/// `boundary_points[v]` is the position of vertex v, for every v on a boundary quad; these vertices are returned bit for bit.
/// Entries of other vertices are not read. `start`, if given (one point per vertex), is the first start; else the first
/// start is the graph-Laplacian one with unit weights. The result is valid only if the report says so.
///
/// Deterministic by the options and [`Context::seed`], for any number of threads, as long as no time limit cuts it short.
///
/// # Errors
/// [`EmbedError`] if the request makes no sense. Finding nothing valid is not an error.
///
/// # Example
/// A cube within a cube, joined by six hexes: the corners of the inner one are free, and find their places.
/// ```
/// use hexfill_embed::{Options, embed};
/// use hexfill_mesh::{Context, HexMesh, cube::FACETS};
///
/// let mut hexes = vec![[8, 9, 10, 11, 12, 13, 14, 15]];
/// hexes.extend(FACETS.map(|f| f.map(|v| v as u32)).map(|[a, b, c, d]| [a + 8, b + 8, c + 8, d + 8, a, b, c, d]));
/// let mesh = HexMesh::try_new(16, &hexes)?;
/// let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
/// let mut points = corners.map(|p| p.map(f64::from)).to_vec();
/// points.resize(16, [0.0; 3]); // those of inner vertices are not read
/// let made = embed(&mesh, &points, None, &Options::default(), &Context::default())?;
/// assert!(made.report.valid_in_floating_point && made.report.scaled_jacobian > 0.5);
/// assert_eq!(made.points[..8], points[..8]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn embed(
    mesh: &HexMesh,
    boundary_points: &[[f64; 3]],
    start: Option<&[[f64; 3]]>,
    options: &Options,
    context: &Context<'_>,
) -> Result<Embedding, EmbedError> {
    let mut normal = Normal::new(mesh, boundary_points, start)?;
    if options.symmetric {
        normal.problem.symmetry = find_symmetry(mesh, &normal.problem, &normal.points);
    }
    if options.threads == 0 {
        return Ok(run_also_from_symmetric(normal, mesh, start, options, context));
    }
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build()
        .map_err(|_| EmbedError::Threads { given: options.threads })?;
    Ok(pool.install(|| run_also_from_symmetric(normal, mesh, start, options, context)))
}

/// [`run`], for a small mesh also from its best symmetric positions, if it has any: a flat optimum, which linear
/// programs approach slowly in all variables, is near in a quarter of them. They come first: where they lead to the upper
/// bound nothing else is tried.
fn run_also_from_symmetric(
    mut normal: Normal,
    mesh: &HexMesh,
    start: Option<&[Vector]>,
    options: &Options,
    context: &Context<'_>,
) -> Embedding {
    let may_help = start.is_none()
        && !options.symmetric
        && options.objective == Objective::ScaledJacobian
        && mesh.n_hexes() <= SMALL;
    let symmetric = if may_help { run_from_symmetric(&mut normal, mesh, options, context) } else { None };
    let value =
        |e: &Embedding| if e.report.valid_in_floating_point { e.report.scaled_jacobian } else { f64::NEG_INFINITY };
    if let Some(optimal) = symmetric.as_ref().filter(|e| value(e) >= e.report.upper_bound - NEAR_OPTIMUM) {
        return optimal.clone();
    }
    let made = run(&normal, start, options, context);
    let Some(mut better) = symmetric.filter(|e| value(e) > value(&made)) else { return made };
    better.report.best_start = made.report.starts;
    better.report.starts = made.report.starts + 1;
    better.report.valid_starts = made.report.valid_starts + 1;
    better
}

/// The positions found from symmetric ones, in all variables again; `None` if there are no valid symmetric ones.
fn run_from_symmetric(
    normal: &mut Normal,
    mesh: &HexMesh,
    options: &Options,
    context: &Context<'_>,
) -> Option<Embedding> {
    normal.problem.symmetry = find_symmetry(mesh, &normal.problem, &normal.points);
    normal.problem.symmetry.as_ref()?;
    let one = Options { starts: 1, ..*options };
    let symmetric = run(normal, None, &one, context);
    normal.problem.symmetry = None;
    let report = &symmetric.report;
    (report.valid_in_floating_point && report.upper_bound > 1e-9)
        .then(|| run(normal, Some(&symmetric.points), &one, context))
}

/// The graph-Laplacian (Tutte) start: every interior vertex at the mean of its neighbours, boundary vertices as given.
///
/// # Errors
/// As [`embed`].
pub fn tutte_start(mesh: &HexMesh, boundary_points: &[[f64; 3]]) -> Result<Vec<[f64; 3]>, EmbedError> {
    let normal = Normal::new(mesh, boundary_points, None)?;
    Ok(normal.restore(&means(&normal)))
}

/// Moves the vertices near the cells of `start` (one point per vertex) that are not valid, in patches of up to `rings` rings, and then all at once by at
/// most `whole` iterations for each energy: a quick try, much shorter than [`embed`]. Returns the positions and the cells that are still not valid.
///
/// # Errors
/// As [`embed`].
pub fn untangle_near(
    mesh: &HexMesh,
    start: &[[f64; 3]],
    rings: usize,
    whole: usize,
    context: &Context<'_>,
) -> Result<(Vec<[f64; 3]>, Vec<HexId>), EmbedError> {
    let normal = Normal::new(mesh, start, Some(start))?;
    let problem = &normal.problem;
    let mut points = normal.with_start(start);
    let rings: Vec<usize> = (0..=rings).collect();
    let bad = bad_cells(problem, &points);
    let mut bad = untangle_rings(problem, &mut points, bad, &rings, context);
    if !bad.is_empty() && whole > 0 {
        // All at once may leave more of them than patch by patch.
        let mut trial = points.clone();
        let left = untangle_whole(problem, &mut trial, whole, context).0;
        if left.len() < bad.len() {
            (points, bad) = (trial, left);
        }
    }
    Ok((normal.restore(&points), bad.into_iter().map(HexId::new).collect()))
}

/// Positions at which cells deep inside that are tiny (less than a twentieth of the surface's edges in size) have grown, as far as the worst scaled
/// Jacobian stays at `floor` or above; `None` if there are none, or none could grow. `points`: all positions, at which every cell is valid; those of
/// the boundary stay as they are. The same for any number of threads; what `context` ends keeps what had grown.
///
/// # Errors
/// As [`embed`], for a mesh without hexes or positions that cannot be used.
pub fn inflate(
    mesh: &HexMesh,
    points: &[[f64; 3]],
    floor: f64,
    context: &Context<'_>,
) -> Result<Option<Vec<[f64; 3]>>, EmbedError> {
    let normal = Normal::new(mesh, points, Some(points))?;
    let mut at = normal.with_start(points);
    Ok(improvement::inflate(&normal.problem, &mut at, floor, context).then(|| normal.restore(&at)))
}

/// The vertex-star upper bounds of all boundary vertices, ascending by vertex. All count the corners with at most one free edge;
/// those that decide the smallest bound count the others, too (branch and bound over the directions of the free edges).
///
/// The worst scaled Jacobian of any embedding with this boundary is at most the smallest of them.
///
/// # Errors
/// As [`embed`].
///
/// # Example
/// A corner pressed nearly flat bounds every mesh with one hex there, before any coordinates are looked for.
/// ```
/// use hexfill_embed::{quick_star_bound, star_bounds};
/// use hexfill_mesh::HexMesh;
///
/// let mesh = HexMesh::try_new(8, &[[0, 1, 2, 3, 4, 5, 6, 7]])?;
/// let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
/// let mut points = corners.map(|p| p.map(f64::from));
/// points[6] = [0.51, 0.51, 1.0];
/// let worst = star_bounds(&mesh, &points)?.into_iter().min_by(|a, b| a.bound.total_cmp(&b.bound)).unwrap();
/// assert_eq!(worst.vertex.index(), 6);
/// assert!(worst.bound < 0.05 && worst.bound <= quick_star_bound(&mesh, &points)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn star_bounds(mesh: &HexMesh, boundary_points: &[[f64; 3]]) -> Result<Vec<StarBound>, EmbedError> {
    let normal = Normal::new(mesh, boundary_points, None)?;
    let mut stars = star_bounds_of(&normal.problem, &normal.points);
    refine_stars(&mut stars, &means(&normal), &Context::default());
    Ok(stars.into_iter().map(|s| s.bound).collect())
}

/// A quick upper bound on the worst scaled Jacobian of any embedding with this boundary: the smallest vertex-star bound that counts the
/// corners with at most one free edge only. Linear time.
///
/// # Errors
/// As [`embed`].
pub fn quick_star_bound(mesh: &HexMesh, boundary_points: &[[f64; 3]]) -> Result<f64, EmbedError> {
    let normal = Normal::new(mesh, boundary_points, None)?;
    Ok(least_bound(&star_bounds_of(&normal.problem, &normal.points)))
}

/// The means of neighbours, in normal coordinates.
fn means(normal: &Normal) -> Vec<Vector> {
    let mut points = normal.points.clone();
    place_at_means(&normal.problem, &mut points, Weights::Unit, false, &Context::default());
    points
}
