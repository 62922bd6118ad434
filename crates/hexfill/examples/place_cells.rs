//! Gives buffer cells positions: `place_cells SECONDS CELL.cell ...` looks for points of the sides and of the inner facet with which
//! a cell embeds best in the cube, and writes `CELL.cell.placed`.
//!
//! Sides are planar and congruent, so that neighbours fit. The parameters are raised for the star bound first, then
//! for the scaled Jacobian of an embedding from the last one, `SECONDS` each, by an evolution strategy with one parent and one child; in the end
//! the inner points are balanced. `SIDES=m,e,yu,yz,zu,zz,xu,xz,edu,edz,su,sz` keeps the first numbers of the sides, as many as
//! are given: those of another cell. `BOUND=1` stops after the star bound and writes nothing.

use hexfill::Context;
use hexfill::unstable::construct::{Cell, Pattern, Role, Side};
use hexfill::unstable::embed::{Embedding, Objective, Options, embed, star_bounds};
use hexfill_mesh::{HexMesh, Random};
use std::time::{Duration, Instant};

type Point = [f64; 3];

/// Numbers of the sides: m; e; y (u, z); z (u, z); x (u, z); the point of a cut edge at its odd end (u, z), mirrored at the other; the
/// star of a side whose star is joined to the diagonal corner (u, z), mirrored if it is joined to the other.
const N_SIDES: usize = 12;
/// Numbers of the inner facet: the diagonal point, then f, or fl and fp, of both triangles (x, y, z each).
const N_FACET: usize = 15;

/// What is moved: the sides' numbers, then the inner facet's.
type Parameters = [f64; N_SIDES + N_FACET];

const START: Parameters = [
    0.4, 0.5, 0.35, 0.7, 0.0, 0.5, -0.1, -0.1, 0.35, 1.3, 0.0, 0.5, // sides
    0.05, 0.05, 1.0, // d
    -0.4, 0.4, 1.0, -0.2, 0.2, 1.1, // triangle 0
    0.4, -0.4, 1.0, 0.2, -0.2, 1.1, // triangle 1
];
const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]];

/// Whether the strategy may move a number: the facet of a cell that Sigma does not meet stays planar.
fn is_free(pattern: &Pattern, i: usize) -> bool {
    let white = pattern.white;
    match i.checked_sub(N_SIDES) {
        Some(j) => j % 3 != 2 || white != [true, true],
        None if i < 8 => white.contains(&true),
        None => white.contains(&false),
    }
}

fn position(role: Role, pattern: &Pattern, p: &Parameters) -> Point {
    let at = |k: u8, z: f64| [CORNERS[usize::from(k)][0], CORNERS[usize::from(k)][1], z];
    let on_side = |k: u8, u: f64, z: f64| {
        let (a, b) = (at(Pattern::diagonal_corner(k), z), at(Pattern::odd_corner(k), z));
        let s = (1.0 + u) / 2.0;
        [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), z]
    };
    let in_facet = |i: usize| [p[N_SIDES + 3 * i], p[N_SIDES + 3 * i + 1], p[N_SIDES + 3 * i + 2]];
    match role {
        Role::Outer(k) => at(k, -1.0),
        Role::Inner(k) => at(k, 1.0),
        Role::Middle(k) => at(k, p[0]),
        Role::Edge(k) => on_side(k, p[1], 1.0),
        Role::Y(k) => on_side(k, p[2], p[3]),
        Role::Z(k) => on_side(k, p[4], p[5]),
        Role::X(k) => on_side(k, p[6], p[7]),
        Role::EdgeOdd(k) => on_side(k, p[8], p[9]),
        Role::EdgeDiagonal(k) => on_side(k, -p[8], p[9]),
        Role::Star(k) if pattern.sides[usize::from(k)] == Side::StarOdd => on_side(k, -p[10], p[11]),
        Role::Star(k) => on_side(k, p[10], p[11]),
        Role::Diagonal => in_facet(0),
        Role::Face(t) | Role::FaceLone(t) => in_facet(1 + 2 * usize::from(t)),
        Role::FacePair(t) => in_facet(2 + 2 * usize::from(t)),
        Role::Interior(_) => [0.0; 3],
    }
}

/// Numbers that are normally distributed (Box and Muller).
struct Normal(Random);

impl Normal {
    fn next(&mut self) -> f64 {
        (-2.0 * (1.0 - self.0.unit()).ln()).sqrt() * (std::f64::consts::TAU * self.0.unit()).cos()
    }

    fn child(&mut self, parent: &Parameters, free: &[usize], width: f64) -> Parameters {
        let mut child = *parent;
        free.iter().for_each(|&i| child[i] += width * self.next());
        child
    }
}

fn quality(e: &Embedding) -> (i64, f64) {
    (-(e.report.n_invalid as i64), e.report.scaled_jacobian)
}

/// The parameters, the least star bound with them, and the embedding if there is time for one.
fn place(cell: &Cell, time: Duration, sides: &[f64]) -> Option<(Parameters, f64, Option<Embedding>)> {
    let hexes: Vec<[u32; 8]> = cell.hexes.iter().map(|h| h.map(u32::from)).collect();
    let mesh = HexMesh::try_new(cell.points.len(), &hexes).ok()?;
    let ctx = Context::default();
    let boundary =
        |p: &Parameters| -> Vec<Point> { cell.points.iter().map(|&r| position(r, &cell.pattern, p)).collect() };
    let bound = |p: &Parameters| {
        let stars = star_bounds(&mesh, &boundary(p));
        stars.map_or(-1.0, |stars| stars.iter().map(|s| s.bound).fold(1.0, f64::min))
    };
    let free: Vec<usize> = (sides.len()..START.len()).filter(|&i| is_free(&cell.pattern, i)).collect();
    let mut normal = Normal(Random::new(0));
    let mut parent = START;
    parent[..sides.len()].copy_from_slice(sides);
    let (mut best, mut width) = (bound(&parent), 0.1);
    let begin = Instant::now();
    while begin.elapsed() < time {
        let child = normal.child(&parent, &free, width);
        let value = bound(&child);
        width = if value > best { 1.5 * width } else { (0.98 * width).max(1e-3) };
        if value > best {
            (best, parent) = (value, child);
        }
    }
    if std::env::var_os("BOUND").is_some() {
        return Some((parent, best, None));
    }
    let mut how = Options::new(Objective::ScaledJacobian).with_starts(4);
    let mut made = embed(&mesh, &boundary(&parent), None, &how, &ctx).ok()?;
    how = how.with_starts(1).with_programs(25);
    let (begin, mut width) = (Instant::now(), 0.05);
    while begin.elapsed() < time {
        let child = normal.child(&parent, &free, width);
        let next = embed(&mesh, &boundary(&child), Some(&made.points), &how, &ctx).ok()?;
        let better = quality(&next) > quality(&made);
        width = if better { 1.4 * width } else { (0.93 * width).max(2e-3) };
        if better {
            (parent, made) = (child, next);
        }
    }
    how = Options::new(Objective::Balanced);
    let balanced = embed(&mesh, &made.points, Some(&made.points), &how, &ctx).ok()?;
    Some((parent, best, Some(if balanced.report.n_invalid == 0 { balanced } else { made })))
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let Some(seconds) = arguments.next().and_then(|s| s.parse().ok()) else {
        return println!("usage: place_cells SECONDS CELL.cell ...");
    };
    let sides = std::env::var("SIDES").unwrap_or_default();
    let sides: Vec<f64> = sides.split(',').filter_map(|x| x.parse().ok()).take(N_SIDES).collect();
    let time = Duration::from_secs(seconds);
    for file in arguments {
        let read = std::fs::read_to_string(&file).map_err(|e| e.to_string()).and_then(|text| Cell::parse(&text));
        let mut cell = match read {
            Ok(cell) => cell,
            Err(e) => {
                println!("{file}: {e}");
                continue;
            }
        };
        let Some((parameters, bound, made)) = place(&cell, time, &sides) else {
            println!("{file}: cannot be placed");
            continue;
        };
        let n = cell.hexes.len();
        println!("{file}: {n} hexes, star bound {bound:.4}");
        let Some(made) = made else { continue };
        let r = &made.report;
        println!("  {} invalid, scaled Jacobian {:.5}, condition {:.2}", r.n_invalid, r.scaled_jacobian, r.condition);
        println!("  parameters {parameters:.6?}");
        cell.positions = Some(made.points);
        if let Err(e) = std::fs::write(format!("{file}.placed"), cell.to_text()) {
            println!("{file}.placed: {e}");
        }
    }
}
