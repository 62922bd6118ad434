//! The pipeline: start, untangle, optimise, over several starts, and the report.
//!
//! Work is done in coordinates centred on the boundary and scaled by a power of two, so that sizes of 1e-300 and 1e300
//! are the same problem; boundary vertices are returned with the bits they came with, and the result is judged at the points
//! as returned. Starts run in batches whose sizes do not depend on the threads, and the best start is chosen by value and
//! then by number, so the result does not either.

use crate::error::EmbedError;
use crate::interior::interior_bound;
use crate::jacobian::{Frame, columns, weights_at};
use crate::local;
use crate::maxmin::{self, Goal};
use crate::measure::log_condition;
use crate::patch::Incidence;
use crate::problem::Problem;
use crate::raise;
use crate::report::{CellQuality, EmbedReport, Embedding, Objective, Options, is_impossible};
use crate::star::{self, Star, StarBound};
use crate::symmetry;
use crate::tutte;
use crate::untangle::{UntangleLimits, bad_cells, untangle};
use crate::vector::{Vector, norm, sub};
use hexfill_mesh::Random;
use hexfill_mesh::cube::{EDGES, POSITIONS};
use hexfill_mesh::{Context, HexId, HexMesh, Offenders, StopReason, VertexId};
use rayon::prelude::*;

/// Starts tried at once after the first.
const BATCH: u32 = 4;

/// The cells named in the report.
const WORST_CELLS: usize = 10;

/// Meshes of so many hexes are left to the linear programs.
const SMALL: usize = 100;

/// Meshes of more hexes are raised where they are poor only, however poor that is.
const LARGE: usize = 2000;

/// They are raised to this share of their upper bound: the last digits of a bound take most of the time.
const ENOUGH: f64 = 0.995;

/// Where only valid cells are asked for, large meshes are raised to this share of their upper bound, which takes few cells.
const BARELY: f64 = 0.05;

/// Nothing is gained so near the upper bound.
const NEAR_OPTIMUM: f64 = 1e-8;

/// A balanced result keeps this share of the optimum.
const BALANCED_SHARE: f64 = 0.95;

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
pub fn embed(
    mesh: &HexMesh,
    boundary_points: &[[f64; 3]],
    start: Option<&[[f64; 3]]>,
    options: &Options,
    context: &Context<'_>,
) -> Result<Embedding, EmbedError> {
    let mut frame = Normal::new(mesh, boundary_points, start)?;
    if options.symmetric {
        frame.problem.symmetry = symmetry::find(mesh, &frame.problem, &frame.points);
    }
    if options.threads == 0 {
        return Ok(frame.run_also_from_symmetric(mesh, start, options, context));
    }
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build()
        .map_err(|_| EmbedError::Threads { given: options.threads })?;
    Ok(pool.install(|| frame.run_also_from_symmetric(mesh, start, options, context)))
}

/// The graph-Laplacian (Tutte) start: every interior vertex at the mean of its neighbours, boundary vertices as given.
///
/// # Errors
/// As [`embed`].
pub fn tutte_start(mesh: &HexMesh, boundary_points: &[[f64; 3]]) -> Result<Vec<[f64; 3]>, EmbedError> {
    let normal = Normal::new(mesh, boundary_points, None)?;
    let mut points = normal.points.clone();
    tutte::place(&normal.problem, &mut points, 0.0, false, &mut Random::of_task(0, 0), &Context::default());
    Ok(normal.restore(&points))
}

/// The vertex-star upper bounds of all boundary vertices, ascending by vertex. All count the corners with at most one free edge;
/// those that decide the smallest bound count the others, too (branch and bound over the directions of the free edges).
///
/// The worst scaled Jacobian of any embedding with this boundary is at most the smallest of them.
///
/// # Errors
/// As [`embed`].
pub fn star_bounds(mesh: &HexMesh, boundary_points: &[[f64; 3]]) -> Result<Vec<StarBound>, EmbedError> {
    let normal = Normal::new(mesh, boundary_points, None)?;
    let mut points = normal.points.clone();
    tutte::place(&normal.problem, &mut points, 0.0, false, &mut Random::of_task(0, 0), &Context::default());
    let mut stars = star::bounds(&normal.problem, &normal.points);
    star::refine(&mut stars, &points, &Context::default());
    Ok(stars.into_iter().map(|s| s.bound).collect())
}

/// A quick upper bound on the worst scaled Jacobian of any embedding with this boundary: the smallest vertex-star bound that counts the
/// corners with at most one free edge only. Linear time.
///
/// # Errors
/// As [`embed`].
pub fn quick_star_bound(mesh: &HexMesh, boundary_points: &[[f64; 3]]) -> Result<f64, EmbedError> {
    let normal = Normal::new(mesh, boundary_points, None)?;
    Ok(least_bound(&star::bounds(&normal.problem, &normal.points)))
}

/// The problem in normal coordinates, and the way back.
struct Normal {
    problem: Problem,
    /// Fixed points in normal coordinates; free ones at the origin.
    points: Vec<Vector>,
    /// What was given, per vertex; free vertices at the centre.
    given: Vec<Vector>,
    centre: Vector,
    /// A power of two.
    scale: f64,
}

impl Normal {
    /// [`run`](Self::run), for a small mesh also from its best symmetric positions, if it has any: a flat optimum, which linear
    /// programs approach slowly in all variables, is near in a quarter of them. They come first: where they lead to the upper
    /// bound nothing else is tried.
    fn run_also_from_symmetric(
        &mut self,
        mesh: &HexMesh,
        start: Option<&[Vector]>,
        options: &Options,
        context: &Context<'_>,
    ) -> Embedding {
        let may_help = start.is_none()
            && !options.symmetric
            && options.objective == Objective::ScaledJacobian
            && mesh.n_hexes() <= SMALL;
        let symmetric = if may_help { self.run_from_symmetric(mesh, options, context) } else { None };
        let value = |e: &Embedding| {
            if e.report.valid_in_floating_point { e.report.scaled_jacobian } else { f64::NEG_INFINITY }
        };
        if let Some(made) = symmetric.as_ref().filter(|e| value(e) >= e.report.upper_bound - NEAR_OPTIMUM) {
            return made.clone();
        }
        let made = self.run(mesh, start, options, context);
        let Some(mut better) = symmetric.filter(|e| value(e) > value(&made)) else { return made };
        better.report.best_start = made.report.starts;
        better.report.starts = made.report.starts + 1;
        better.report.valid_starts = made.report.valid_starts + 1;
        better
    }

    /// The positions found from symmetric ones, in all variables again; `None` if there are no valid symmetric ones.
    fn run_from_symmetric(&mut self, mesh: &HexMesh, options: &Options, context: &Context<'_>) -> Option<Embedding> {
        self.problem.symmetry = symmetry::find(mesh, &self.problem, &self.points);
        self.problem.symmetry.as_ref()?;
        let one = Options { starts: 1, ..*options };
        let symmetric = self.run(mesh, None, &one, context);
        self.problem.symmetry = None;
        let report = &symmetric.report;
        (report.valid_in_floating_point && report.upper_bound > 1e-9)
            .then(|| self.run(mesh, Some(&symmetric.points), &one, context))
    }

    fn new(mesh: &HexMesh, boundary_points: &[Vector], start: Option<&[Vector]>) -> Result<Self, EmbedError> {
        const LEAST_EXTENT: f64 = 1e-305;
        if mesh.n_hexes() == 0 {
            return Err(EmbedError::NoHexes);
        }
        let fixed = mesh.boundary_vertices();
        let boundary: Vec<usize> = (0..fixed.len()).filter(|&v| fixed[v]).collect();
        let Some(&last) = boundary.last() else { return Err(EmbedError::NoBoundary) };
        let missing: Offenders<VertexId> =
            boundary.iter().filter(|&&v| v >= boundary_points.len()).map(|&v| VertexId::new(v)).collect();
        if !missing.is_empty() {
            let given = boundary_points.len();
            return Err(EmbedError::MissingPositions { vertices: missing, given, limit: last });
        }
        let finite = |p: Vector| p.iter().all(|x| x.is_finite());
        let mut not_finite: Offenders<VertexId> =
            boundary.iter().filter(|&&v| !finite(boundary_points[v])).map(|&v| VertexId::new(v)).collect();
        if let Some(start) = start {
            if start.len() != mesh.n_vertices() {
                return Err(EmbedError::StartLength { given: start.len(), limit: mesh.n_vertices() });
            }
            (0..start.len())
                .filter(|&v| !fixed[v] && !finite(start[v]))
                .for_each(|v| not_finite.push(VertexId::new(v)));
        }
        if !not_finite.is_empty() {
            return Err(EmbedError::NotFinite { vertices: not_finite });
        }
        // Halves, so that the span of the largest doubles does not overflow.
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for &v in &boundary {
            for k in 0..3 {
                low[k] = low[k].min(0.5 * boundary_points[v][k]);
                high[k] = high[k].max(0.5 * boundary_points[v][k]);
            }
        }
        let half = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
        if 2.0 * half < LEAST_EXTENT {
            return Err(EmbedError::NoExtent { given: 2.0 * half, limit: LEAST_EXTENT });
        }
        let scale = 2f64.powi(half.log2().round() as i32);
        let centre: Vector = std::array::from_fn(|k| low[k] + high[k]);
        let mut given = vec![centre; mesh.n_vertices()];
        for (v, point) in given.iter_mut().enumerate() {
            if fixed[v] {
                *point = boundary_points[v];
            }
        }
        let problem = Problem::new(mesh.n_vertices(), mesh.hexes_raw(), &fixed);
        let points = given.iter().map(|&p| normalise(p, centre, scale)).collect();
        Ok(Self { problem, points, given, centre, scale })
    }

    fn restore(&self, points: &[Vector]) -> Vec<Vector> {
        let mut out = self.given.clone();
        for &v in &self.problem.free {
            let p = points[v as usize];
            out[v as usize] = std::array::from_fn(|k| self.centre[k] + self.scale * p[k]);
        }
        out
    }

    fn run(&self, mesh: &HexMesh, start: Option<&[Vector]>, options: &Options, context: &Context<'_>) -> Embedding {
        let problem = &self.problem;
        let stars = star::bounds(problem, &self.points);
        let start: Option<Vec<Vector>> = start.map(|s| {
            let mut points = self.points.clone();
            for &v in &problem.free {
                points[v as usize] = normalise(s[v as usize], self.centre, self.scale);
            }
            points
        });
        let inside = interior_bound(problem);
        let upper_bound = least_bound(&stars).min(inside);
        let mut search =
            Search { normal: self, start: start.as_deref(), stars, inside, refined: false, upper_bound, options };
        let outcome = search.best(context);
        if outcome.valid_starts == 0 || options.objective != Objective::UntangleOnly {
            search.refine(&outcome.points, context);
        }
        let (mut upper_bound, target) = (search.upper_bound, search.target());
        if outcome.value > upper_bound + 1e-9 {
            // Only a surface that crosses itself can beat its angles.
            search.stars.iter_mut().for_each(|s| s.bound.bound = s.by_direction);
            upper_bound = least_bound(&search.stars);
        }
        let mut stars: Vec<StarBound> = search.stars.iter().map(|s| s.bound).collect();
        stars.sort_by(|a, b| a.bound.total_cmp(&b.bound).then(a.vertex.cmp(&b.vertex)));
        stars.truncate(10);
        let points = self.restore(&outcome.points);
        let judged: Vec<Vector> = points.iter().map(|&p| normalise(p, self.centre, self.scale)).collect();
        let mut cells: Vec<(f64, f64, f64)> = vec![(0.0, 0.0, 0.0); problem.hexes.len()];
        problem.map_hexes(&mut cells, |h| {
            let p = problem.corners_of(h, &judged);
            let worst = Frame::new(&p).worst(1.0, 1e-2, 20);
            let log = POSITIONS.iter().map(|at| log_condition(&columns(&p, &weights_at(at.map(f64::from)))));
            (worst.lower, worst.upper, log.fold(0.0, f64::max))
        });
        // Only what may be among the ten worst is cut fine.
        let mut uppers: Vec<f64> = cells.iter().map(|c| c.1).collect();
        let tenth = uppers.len().min(WORST_CELLS) - 1;
        let (_, &mut limit, _) = uppers.select_nth_unstable_by(tenth, f64::total_cmp);
        let coarse = cells.clone();
        problem.map_hexes(&mut cells, |h| {
            let (lower, upper, log) = coarse[h];
            if lower > limit {
                return (lower, upper, log);
            }
            let worst = Frame::new(&problem.corners_of(h, &judged)).worst(1.0, 1e-9, 2000);
            (worst.lower, worst.upper, log)
        });
        let bad = bad_cells(problem, &judged);
        for &h in &bad {
            cells[h].1 = cells[h].1.min(0.0);
        }
        let mut order: Vec<usize> = (0..cells.len()).collect();
        order.sort_by(|&a, &b| cells[a].1.total_cmp(&cells[b].1).then(a.cmp(&b)));
        order.truncate(WORST_CELLS);
        let shortest = problem
            .hexes
            .iter()
            .flat_map(|h| EDGES.map(|[i, j]| norm(sub(judged[h[i] as usize], judged[h[j] as usize]))))
            .fold(f64::INFINITY, f64::min);
        debug_assert_eq!(points.len(), mesh.n_vertices());
        let report = EmbedReport {
            objective: options.objective,
            valid_in_floating_point: bad.is_empty(),
            n_invalid: bad.len(),
            symmetries: problem.symmetry.as_ref().map_or(1, |s| s.order),
            starts: outcome.starts,
            valid_starts: outcome.valid_starts,
            best_start: outcome.best_start,
            scaled_jacobian: cells[order[0]].1,
            scaled_jacobian_bound: cells.iter().map(|c| c.0).fold(f64::INFINITY, f64::min),
            condition: cells.iter().map(|c| c.2).fold(0.0, f64::max).exp(),
            shortest_edge: shortest * self.scale,
            worst_cells: order
                .iter()
                .map(|&h| CellQuality { hex: HexId::new(h), scaled_jacobian: cells[h].1 })
                .collect(),
            upper_bound,
            target,
            star_bounds: stars,
            stop: outcome.stop,
        };
        Embedding { points, report }
    }
}

fn normalise(p: Vector, centre: Vector, scale: f64) -> Vector {
    // Halves first: the difference of two large doubles may overflow.
    std::array::from_fn(|k| 2.0 * ((0.5 * p[k] - 0.5 * centre[k]) / scale))
}

/// The least bound of any star, at most 1.
fn least_bound(stars: &[Star]) -> f64 {
    stars.iter().map(|s| s.bound.bound).fold(1.0, f64::min)
}

struct Search<'a> {
    normal: &'a Normal,
    start: Option<&'a [Vector]>,
    stars: Vec<Star>,
    /// The bound by interior vertices and edges.
    inside: f64,
    /// Whether the stars count corners with several free edges.
    refined: bool,
    upper_bound: f64,
    options: &'a Options,
}

/// One start, worked out.
struct Candidate {
    number: u32,
    points: Vec<Vector>,
    /// The points before quality was raised.
    untangled: Vec<Vector>,
    n_bad: usize,
    /// The worst scaled Jacobian.
    value: f64,
    stopped: Option<StopReason>,
}

struct Outcome {
    points: Vec<Vector>,
    /// The worst scaled Jacobian.
    value: f64,
    starts: u32,
    valid_starts: u32,
    best_start: u32,
    stop: StopReason,
}

impl Search<'_> {
    /// Sharpens the star bounds, once.
    fn refine(&mut self, hint: &[Vector], context: &Context<'_>) {
        if !std::mem::replace(&mut self.refined, true) {
            star::refine(&mut self.stars, hint, context);
            self.upper_bound = least_bound(&self.stars).min(self.inside);
        }
    }

    fn best(&mut self, context: &Context<'_>) -> Outcome {
        let n_hexes = self.normal.problem.hexes.len();
        let first_valid_is_enough =
            self.options.objective == Objective::UntangleOnly || self.options.starts == 0 && n_hexes > 400;
        let starts = match (self.options.starts, n_hexes) {
            // Nothing can move.
            _ if self.normal.problem.free.is_empty() => 1,
            (0, 0..=100) => 8,
            (0, 101..=5000) => 4,
            // What a given start does not lead to is out of reach of means of neighbours.
            (0, _) if self.start.is_some() => 1,
            (0, _) => 2,
            (n, _) => n,
        };
        let mut found: Vec<Candidate> = Vec::new();
        let mut stop = StopReason::Finished;
        while (found.len() as u32) < starts {
            let from = found.len() as u32;
            let batch = if from == 0 { 1 } else { BATCH.min(starts - from) };
            // Progress comes from the driving thread: only a lone start reports in detail.
            let inner = if batch == 1 { *context } else { Context { progress: None, ..*context } };
            let mut new: Vec<Candidate> =
                (from..from + batch).into_par_iter().map(|number| self.one(number, &inner)).collect();
            found.append(&mut new);
            let best = found.iter().map(|c| c.value).fold(f64::NEG_INFINITY, f64::max);
            context.report("starts", found.len() as u64, Some(u64::from(starts)), || format!("best {best:.6}"));
            if let Some(reason) = found.iter().find_map(|c| c.stopped) {
                stop = reason;
                break;
            }
            let valid = found.iter().any(|c| c.n_bad == 0);
            if valid && (first_valid_is_enough || self.is_optimal(best)) {
                break;
            }
            if !valid {
                // Where no placement is valid, one start is as good as many.
                let hint = found[0].points.clone();
                self.refine(&hint, context);
                if is_impossible(self.upper_bound) {
                    break;
                }
            }
        }
        let starts = found.len() as u32;
        let valid_starts = found.iter().filter(|c| c.n_bad == 0).count() as u32;
        found.sort_by(|a, b| a.n_bad.cmp(&b.n_bad).then(b.value.total_cmp(&a.value)).then(a.number.cmp(&b.number)));
        if self.options.objective == Objective::Balanced && found[0].n_bad == 0 && stop == StopReason::Finished {
            stop = self.balance(&mut found, context);
        }
        let best = found.swap_remove(0);
        Outcome { points: best.points, value: best.value, starts, valid_starts, best_start: best.number, stop }
    }

    /// The worst scaled Jacobian that is strived for.
    fn target(&self) -> f64 {
        if self.normal.problem.hexes.len() > LARGE { ENOUGH * self.upper_bound } else { self.upper_bound - 1e-9 }
    }

    fn is_optimal(&self, value: f64) -> bool {
        value >= self.upper_bound - NEAR_OPTIMUM
    }

    /// Works out one start.
    fn one(&self, number: u32, context: &Context<'_>) -> Candidate {
        let problem = &self.normal.problem;
        let mut points = self.normal.points.clone();
        match self.start {
            Some(start) if number == 0 => {
                points.copy_from_slice(start);
                if self.options.smooth_start {
                    tutte::place(problem, &mut points, 0.0, true, &mut Random::of_task(0, 0), context);
                }
            }
            given => {
                let plain = number == u32::from(given.is_some());
                let mut random = Random::of_task(context.seed, u64::from(number));
                tutte::place(problem, &mut points, if plain { 0.0 } else { 1.0 }, false, &mut random, context);
            }
        }
        let n_hexes = problem.hexes.len();
        let as_given = number == 0 && self.start.is_some() && !self.options.smooth_start;
        let by_parts = (n_hexes > self.options.local_limit || as_given) && problem.symmetry.is_none();
        if problem.symmetry.is_some() {
            let x = problem.gather(&points);
            problem.scatter(&x, &mut points);
        }
        let mut stopped;
        let mut bad;
        if by_parts {
            (bad, stopped) = local::untangle_bad(problem, &mut points, context);
            if bad.is_empty() && !as_given {
                local::round_shapes(problem, &mut points, context);
            }
        } else {
            (bad, stopped) = local::untangle_whole(problem, &mut points, context);
        }
        if let Some(given) = self.start.filter(|_| as_given && !bad.is_empty() && problem.symmetry.is_none()) {
            // A start that could not be untangled comes back no worse than it was.
            let rank =
                |points: &[Vector], bad: usize| (bad, -maxmin::judge_near_worst(problem, points, 0.0, 0.0).worst);
            let before = bad_cells(problem, given);
            let (old, new) = (rank(given, before.len()), rank(&points, bad.len()));
            if old.0 < new.0 || old.0 == new.0 && old.1 <= new.1 {
                points.copy_from_slice(given);
                bad = before;
            }
        }
        let climbs = self.options.objective != Objective::UntangleOnly && bad.is_empty();
        let target = self.target();
        let untangled = points.clone();
        if climbs && stopped.is_none() {
            stopped = self.improve(&mut points, target, context);
            bad = bad_cells(problem, &points);
        }
        if bad.is_empty() && stopped.is_none() && !climbs && n_hexes > LARGE && problem.symmetry.is_none() {
            stopped = local::lift_barely_valid(problem, &mut points, BARELY * target, context);
        }
        let value = maxmin::judge_near_worst(problem, &points, 0.0, 0.0).worst;
        Candidate { number, points, untangled, n_bad: bad.len(), value, stopped }
    }

    /// Raises the worst scaled Jacobian of valid cells. Small meshes go by linear programs alone, which follow thin
    /// ridges best; larger ones by barriers first, from the start as it is and from a smoothed one, as a program's cost grows
    /// faster than the mesh.
    fn improve(&self, points: &mut Vec<Vector>, target: f64, context: &Context<'_>) -> Option<StopReason> {
        let problem = &self.normal.problem;
        let n_hexes = problem.hexes.len();
        if n_hexes <= SMALL {
            return self.climb(points, target, self.options.programs, context);
        }
        // A round judges every cell.
        let rounds = self.options.programs / 5;
        let by_patches = |points: &mut Vec<Vector>| {
            local::climb_worst(problem, &Incidence::new(problem), points, target, rounds, context)
        };
        let patchy = n_hexes > self.options.whole_limit && problem.symmetry.is_none();
        if patchy && n_hexes > LARGE {
            return local::raise_large(problem, points, target, context);
        }
        if patchy && local::is_worst_isolated(problem, points) {
            return by_patches(points);
        }
        let limits = raise::Limits { rounds: self.options.programs, iterations: 80 };
        let mut smooth = points.clone();
        let shapes = UntangleLimits { extra_rounds: 4, ..UntangleLimits::new() };
        let stopped = untangle(problem, &mut smooth, shapes, context).stopped;
        let stopped = stopped.or_else(|| raise::raise(problem, points, target, limits, context));
        if stopped.is_some() {
            return stopped;
        }
        if bad_cells(problem, &smooth).is_empty() {
            let stopped = raise::raise(problem, &mut smooth, target, limits, context);
            let worst = |points: &[Vector]| maxmin::judge_near_worst(problem, points, 0.0, 0.0).worst;
            if worst(&smooth) > worst(points) {
                *points = smooth;
            }
            if stopped.is_some() {
                return stopped;
            }
        }
        if patchy {
            return by_patches(points);
        }
        self.climb(points, target, self.options.programs * SMALL / n_hexes / 2, context)
    }

    /// Linear programs over the whole mesh.
    fn climb(
        &self,
        points: &mut Vec<Vector>,
        target: f64,
        programs: usize,
        context: &Context<'_>,
    ) -> Option<StopReason> {
        let limits = maxmin::Limits { iterations: programs, band: 0.3, tolerance: 1e-9 };
        maxmin::climb(&self.normal.problem, points, Goal::ScaledJacobian { target }, limits, context).stopped
    }

    /// Lowers the condition numbers of the good candidates and puts the best first.
    fn balance(&self, found: &mut Vec<Candidate>, context: &Context<'_>) -> StopReason {
        let problem = &self.normal.problem;
        let floor = BALANCED_SHARE * found[0].value;
        found.retain(|c| c.n_bad == 0 && c.value > floor);
        found.truncate(BATCH as usize);
        let quiet = Context { progress: None, ..*context };
        let limits = maxmin::Limits { iterations: self.options.programs, band: 0.1, tolerance: 1e-4 };
        let stops: Vec<Option<StopReason>> = found
            .par_iter_mut()
            .map(|c| {
                // The optimum is often thin; the way up passes the floor in better shape. Try both, keep the better.
                let mut early = c.untangled.clone();
                let rise = maxmin::Limits { tolerance: 1e-6, ..limits };
                let target = Goal::ScaledJacobian { target: floor + 1e-3 * floor.abs() };
                let up = maxmin::climb(problem, &mut early, target, rise, &quiet);
                let goal = Goal::Condition { floor };
                let late = maxmin::climb(problem, &mut c.points, goal, limits, &quiet);
                let mut stopped = up.stopped.or(late.stopped);
                if up.scaled_jacobian >= floor && bad_cells(problem, &early).is_empty() {
                    stopped = stopped.or(maxmin::climb(problem, &mut early, goal, limits, &quiet).stopped);
                    if self.condition(&early) < self.condition(&c.points) {
                        std::mem::swap(&mut c.points, &mut early);
                    }
                }
                stopped
            })
            .collect();
        found.sort_by(|a, b| {
            self.condition(&a.points).total_cmp(&self.condition(&b.points)).then(a.number.cmp(&b.number))
        });
        stops.into_iter().flatten().next().unwrap_or(StopReason::Finished)
    }

    /// The logarithm of the worst condition number.
    fn condition(&self, points: &[Vector]) -> f64 {
        let problem = &self.normal.problem;
        let mut each = vec![0.0; problem.hexes.len()];
        problem.map_hexes(&mut each, |h| {
            let p = problem.corners_of(h, points);
            POSITIONS.iter().map(|at| log_condition(&columns(&p, &weights_at(at.map(f64::from))))).fold(0.0, f64::max)
        });
        each.into_iter().fold(0.0, f64::max)
    }
}
