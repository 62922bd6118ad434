//! Maximise the worst scaled Jacobian: sequential linear programming in a trust region, with curvature where it stalls.
//!
//! At each step the scaled Jacobians near the worst are linearised, `s + g . d >= t`, with every free vertex held within
//! `radius` times its shortest edge, and t is maximised (linear program). Where the optimum is flat, linear steps zigzag; the
//! multipliers of the last program then weight the second derivatives of the rows (made convex), and a quadratic
//! program gives the step. A step is taken only if the true minimum over whole cells rises and every cell
//! stays positive in the Bernstein sense, so validity is never traded for corners.

use crate::curvature::{hessian, positive_part};
use crate::jacobian::{FRAME_EDGES, Frame, MIXED, columns, scaled, scaled_with_gradient, weights_at};
use crate::problem::Problem;
use crate::program::Program;
use crate::vector::{Vector, cross, norm, sub};
use hexfill_mesh::cube::POSITIONS;
use hexfill_mesh::{Context, StopReason};

/// Limits of a run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MaxMinLimits {
    /// Programs solved at most.
    pub(crate) iterations: usize,
    /// Stop when the minimum reaches this.
    pub(crate) target: f64,
    /// Rows this far above the worst take part.
    pub(crate) band: f64,
    /// Stop when a step promises less than this.
    pub(crate) tolerance: f64,
}

/// What a run came to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MaxMin {
    /// The worst scaled Jacobian over all cells, whole.
    pub(crate) value: f64,
    /// Programs solved.
    pub(crate) iterations: usize,
    /// Set if the context asked to stop.
    pub(crate) stopped: Option<StopReason>,
}

/// A linearised scaled Jacobian: where, value, and gradient by corner of its hex.
struct Row {
    place: Place,
    value: f64,
    gradient: [Vector; 8],
}

/// A point of a cell: the hex, and coordinates in its unit cube.
#[derive(Clone, Copy, Debug)]
struct Place {
    hex: usize,
    at: Vector,
}

/// What is known of the cells at some coordinates.
pub(crate) struct Cells {
    /// Per hex: its worst scaled Jacobian (the lower bound, if that is not positive), and the inner points that are worst.
    pub(crate) each: Vec<(f64, Vec<Vector>)>,
    /// The smallest of them.
    pub(crate) worst: f64,
}

/// Judges all cells at `points`; cells better than `cutoff` only as far as to know that.
pub(crate) fn judge(problem: &Problem, points: &[Vector], cutoff: f64) -> Cells {
    let mut each = vec![(0.0, Vec::new()); problem.hexes.len()];
    problem.map_hexes(&mut each, |h| {
        let worst = Frame::new(&problem.corners_of(h, points)).worst(cutoff, 1e-6, 200);
        (if worst.lower > 0.0 { worst.upper } else { worst.upper.min(-1e-12) }, worst.inner)
    });
    let worst = each.iter().map(|c| c.0).fold(f64::INFINITY, f64::min);
    Cells { each, worst }
}

/// Raises the worst scaled Jacobian of `points` as far as it goes within the limits. If some cell is not valid to begin
/// with, the worst value is raised all the same.
pub(crate) fn maximise(
    problem: &Problem,
    points: &mut Vec<Vector>,
    limits: MaxMinLimits,
    context: &Context<'_>,
) -> MaxMin {
    const SEEN: f64 = 0.02;
    let mut cells = judge(problem, points, 1.0);
    let mut radius: f64 = 0.5;
    let mut curved = false;
    let mut multipliers: Vec<(Place, f64)> = Vec::new();
    let mut iterations = 0;
    let mut stopped = None;
    let mut rejected = 0;
    while iterations < limits.iterations && cells.worst < limits.target && radius > 1e-9 && !problem.free.is_empty() {
        stopped = context.stop();
        if stopped.is_some() {
            break;
        }
        iterations += 1;
        let reach = reach(problem, points);
        let rows = linearise(problem, points, &cells, cells.worst + limits.band);
        let curvature = if curved { multipliers.as_slice() } else { &[] };
        let Some(step) = solve(problem, points, &rows, &reach, radius, curvature) else {
            radius *= 0.25;
            curved = false;
            continue;
        };
        if step.promised < limits.tolerance {
            if curved || radius >= 0.5 {
                break;
            }
            radius = 0.5;
            curved = true;
            continue;
        }
        let mut trial = points.clone();
        for (s, &v) in problem.free.iter().enumerate() {
            for k in 0..3 {
                trial[v as usize][k] += step.direction[3 * s + k];
            }
        }
        let reached = judge(problem, &trial, cells.worst + step.promised + SEEN);
        let gain = reached.worst - cells.worst;
        if std::env::var("DBG").is_ok() {
            eprintln!("{iterations} value {:.9} radius {radius:.2e} promised {:.2e} gain {gain:.2e} rows {} curved {curved}", cells.worst, step.promised, rows.len());
        }
        multipliers = step.multipliers;
        if gain > 0.0 {
            *points = trial;
            cells = reached;
            rejected = 0;
        } else {
            rejected += 1;
        }
        if gain < 0.25 * step.promised {
            radius *= 0.35;
            if rejected >= 2 || gain > 0.0 {
                curved = true;
            }
        } else if gain > 0.7 * step.promised {
            radius = (2.0 * radius).min(1.0);
        }
    }
    MaxMin { value: cells.worst, iterations, stopped }
}

/// Per variable: how far its vertex may move at radius 1, its shortest edge.
fn reach(problem: &Problem, points: &[Vector]) -> Vec<f64> {
    (0..problem.free.len())
        .map(|s| {
            let mut shortest = f64::INFINITY;
            for &place in problem.places(s) {
                let hex = &problem.hexes[place as usize / 8];
                let corner = place as usize % 8;
                for [a, b] in FRAME_EDGES {
                    if a == corner || b == corner {
                        shortest = shortest.min(norm(sub(points[hex[a] as usize], points[hex[b] as usize])));
                    }
                }
            }
            shortest.max(1e-9)
        })
        .collect()
}

fn linearise(problem: &Problem, points: &[Vector], cells: &Cells, limit: f64) -> Vec<Row> {
    let mut rows = Vec::new();
    for (hex, (worst, inner)) in cells.each.iter().enumerate() {
        let p = problem.corners_of(hex, points);
        // The inner points move with the cell's minimum, so each step takes the ones seen last.
        let near = if *worst <= limit { inner.as_slice() } else { &[] };
        for at in POSITIONS.map(|p| p.map(f64::from)).iter().chain(near) {
            let weights = weights_at(*at);
            let Some((value, by_column)) = scaled_with_gradient(&columns(&p, &weights)) else { continue };
            if value > limit {
                continue;
            }
            let mut gradient = [[0.0; 3]; 8];
            for (g, w) in gradient.iter_mut().zip(&weights) {
                for d in 0..3 {
                    for k in 0..3 {
                        g[k] += w[d] * by_column[d][k];
                    }
                }
            }
            rows.push(Row { place: Place { hex, at: *at }, value, gradient });
        }
    }
    rows
}

struct Step {
    direction: Vec<f64>,
    promised: f64,
    /// The rows that hold the step, with their multipliers.
    multipliers: Vec<(Place, f64)>,
}

fn solve(
    problem: &Problem,
    points: &[Vector],
    rows: &[Row],
    reach: &[f64],
    radius: f64,
    curvature: &[(Place, f64)],
) -> Option<Step> {
    let n = problem.free.len();
    let t = 3 * n;
    let mut cost = vec![0.0; t + 1];
    cost[t] = -1.0;
    let mut program = Program::new(cost);
    let worst = rows.iter().map(|r| r.value).fold(f64::INFINITY, f64::min);
    // Variables: d_v / (radius * reach_v) in [-1, 1], and t - worst.
    let coefficients = |hex: usize, gradient: &[Vector; 8], sign: f64| {
        let mut out = Vec::with_capacity(25);
        for (corner, g) in gradient.iter().enumerate() {
            let s = problem.slot[problem.hexes[hex][corner] as usize] as usize;
            if s < n {
                out.extend((0..3).filter(|&k| g[k] != 0.0).map(|k| (3 * s + k, sign * radius * reach[s] * g[k])));
            }
        }
        out
    };
    for row in rows {
        let mut c = coefficients(row.place.hex, &row.gradient, -1.0);
        c.push((t, 1.0));
        program.row(c, row.value - worst);
    }
    let n_value_rows = program.n_rows();
    for i in 0..t {
        program.row([(i, 1.0)], 1.0);
        program.row([(i, -1.0)], 1.0);
    }
    keep_positive(problem, points, rows, &mut program, &coefficients);
    let mut model = Vec::new();
    for &(Place { hex, at }, multiplier) in curvature {
        let weights = &weights_at(at);
        let c = columns(&problem.corners_of(hex, points), weights);
        if !(scaled(&c) > -1.0) {
            continue;
        }
        let h = positive_part(&hessian(&c).map(|r| r.map(|x| -multiplier * x)));
        for a in 0..8 {
            let sa = problem.slot[problem.hexes[hex][a] as usize] as usize;
            for b in 0..8 {
                let sb = problem.slot[problem.hexes[hex][b] as usize] as usize;
                if sa >= n || sb >= n || weights[a] == [0.0; 3] || weights[b] == [0.0; 3] {
                    continue;
                }
                for i in 0..3 {
                    for j in 0..3 {
                        let (row, column) = (3 * sa + i, 3 * sb + j);
                        if row > column {
                            continue;
                        }
                        let mut sum = 0.0;
                        for d in 0..3 {
                            for e in 0..3 {
                                sum += weights[a][d] * weights[b][e] * h[3 * d + i][3 * e + j];
                            }
                        }
                        let value = sum * radius * radius * reach[sa] * reach[sb];
                        if value != 0.0 {
                            program.curvature(row, column, value);
                            model.push((row, column, value));
                        }
                    }
                }
            }
        }
    }
    let solution = program.solve()?;
    let bend: f64 = model
        .iter()
        .map(|&(i, j, v)| (if i == j { 0.5 } else { 1.0 }) * v * solution.point[i] * solution.point[j])
        .sum();
    let promised = solution.point[t] - bend;
    let multipliers = rows
        .iter()
        .zip(&solution.multipliers[..n_value_rows])
        .filter(|(_, m)| **m > 1e-7)
        .map(|(r, &m)| (r.place, m))
        .collect();
    let direction = (0..t).map(|i| solution.point[i].clamp(-1.0, 1.0) * radius * reach[i / 3]).collect();
    Some(Step { direction, promised, multipliers })
}

/// Rows that keep small Bernstein coefficients of the cells in the program from reaching zero.
fn keep_positive(
    problem: &Problem,
    points: &[Vector],
    rows: &[Row],
    program: &mut Program,
    coefficients: &impl Fn(usize, &[Vector; 8], f64) -> Vec<(usize, f64)>,
) {
    let mut hexes: Vec<usize> = rows.iter().map(|r| r.place.hex).collect();
    hexes.dedup();
    for hex in hexes {
        let frame = Frame::new(&problem.corners_of(hex, points));
        let (b, n) = (frame.bernstein(), frame.lengths());
        for c in 0..27 {
            let ratio = b[c] / n[c];
            if !(ratio < 0.05) || c / 9 != 1 && c / 3 % 3 != 1 && c % 3 != 1 {
                continue;
            }
            let mut edge_gradient = [[[0.0; 3]; 4]; 3];
            let mut count = 0.0;
            for m in MIXED.iter().filter(|m| m.coefficient == c) {
                count += 1.0;
                let [x, y, z] = m.edges;
                let e = [frame.0[0][x], frame.0[1][y], frame.0[2][z]];
                for (d, i) in [x, y, z].into_iter().enumerate() {
                    let normal = cross(e[(d + 1) % 3], e[(d + 2) % 3]);
                    for k in 0..3 {
                        edge_gradient[d][i][k] += normal[k];
                    }
                }
            }
            let mut gradient = [[0.0; 3]; 8];
            for (e, [from, to]) in FRAME_EDGES.into_iter().enumerate() {
                for k in 0..3 {
                    let g = edge_gradient[e / 4][e % 4][k] / (count * n[c]);
                    gradient[to][k] += g;
                    gradient[from][k] -= g;
                }
            }
            // A coefficient may fall to a fifth of its value in one step; a negative one (valid by bisection) may not fall.
            let floor = if ratio > 0.0 { 0.2 * ratio } else { ratio };
            program.row(coefficients(hex, &gradient, -1.0), ratio - floor);
        }
    }
}
