//! Sections: a solid between caps and upright walls is columns over one plane quad mesh, whatever its steps, bosses, pockets and holes.
//!
//! Idea: where every crease is a right angle, one quad called a *cap* tells for all others whether they are caps (facing up or down) or walls, and how
//! high each vertex lies in edges. Walls are upright, so every cap is seen from above as it is; caps that share an edge seen from above, on the same side,
//! are one quad of the *section*. Taking that for all edges at once folds the surface onto the section, also where only a flat side shows its inner quads
//! (words are folded onto graphs so). Over each quad of the section the caps must be, from low to high, down, up, down, up: the columns are between.
//!
//! Round holes, curved walls and caps are no matter, as angles within a section are not looked at; chamfers and countersinks are levels of their walls.
//! Where edges are rounded, caps are what faces an axis.
//!
//! Invariant: a corner of a hex is told by its vertex of the section and its height; a surface with two vertices at one such place is refused.
//!
//! Source: ours; the folding is that of Stallings 1983; sweeps with several sources and targets are Mingwu et al. 1996 (abstract), which imprint caps on each
//! other: here the surface says already how they lie.

use crate::angles::FLAT;
use crate::classes::Classes;
use crate::dart::{next, opposite, prev, turn};
use crate::front::Front;
use hexfill_geometry::{Vector, add_scaled, cross, direction, dot, norm, scale, sub, unit};
use hexfill_mesh::{Context, Dart, QuadSurface};
use rustc_hash::FxHashMap;

/// How labels go from quad to quad; all in right angles.
#[derive(Clone, Copy)]
struct Rule {
    /// A cap ends at edges that bend by more.
    cap: f32,
    /// A wall ends where the next quad would lean by more.
    wall: f32,
    /// Edges that bend by less leave the lean of a wall as it is; where all do, walls stay upright.
    least: f32,
}

/// First as if every crease were one of a box. Then with chamfers and countersinks as levels of their walls: a cap ends at half a right angle, and a wall
/// goes on over one.
const RULES: [Rule; 2] =
    [Rule { cap: 0.5, wall: 0.5, least: f32::INFINITY }, Rule { cap: 0.4, wall: 0.6, least: 0.25 }];
/// Smooth patches that are tried as the first caps, the largest ones.
const MOST_PATCHES: usize = 16;
/// More hexes than this are not made.
const MOST_HEXES: i64 = 4_000_000;

/// Directions that are tried where creases do not tell caps from walls, and of how many quads they are taken.
const MOST_AXES: usize = 3;
const SAMPLES: usize = 60;
/// How often an axis is made that of its caps.
const STRAIGHTENED: usize = 4;
/// The cosine from which on a quad faces an axis, and that from which on it is a cap. The latter is that of 49 degrees, as rounded edges often have a quad at
/// 45, which belongs to one side on all of them.
const PARALLEL: f64 = 0.98;
const CAP: f64 = 0.65;

/// What a quad is, for somebody who knows where up is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Label {
    Unknown,
    FacesUp,
    FacesDown,
    /// The dart that leads up.
    Wall(u32),
}

impl Label {
    fn is_wall(self) -> bool {
        matches!(self, Self::Wall(_))
    }
}

/// Columns over a section.
#[derive(Clone, Debug)]
pub(crate) struct Columns {
    /// Vertices of the surface first.
    pub hexes: Vec<[u32; 8]>,
    /// Per vertex: the one of the section, and how high above it in edges.
    places: Vec<(u32, i32)>,
}

impl Columns {
    /// Positions of all vertices, those inside spread evenly between the ends of their columns; `points` are the surface's.
    pub(crate) fn spread(&self, points: &[Vector]) -> Option<Vec<Vector>> {
        let mut column: Vec<u32> = (0..self.places.len() as u32).collect();
        column.sort_unstable_by_key(|&v| self.places[v as usize]);
        // The next vertex of the surface further on, of any column.
        let mut above = vec![None; column.len()];
        let mut next = None;
        for (i, &v) in column.iter().enumerate().rev() {
            next = if (v as usize) < points.len() { Some(v) } else { next };
            above[i] = next;
        }
        let mut at: Vec<Option<Vector>> = points.iter().copied().map(Some).collect();
        at.resize(self.places.len(), None);
        let mut below: Option<u32> = None;
        for (&v, above) in column.iter().zip(above) {
            let (section, z) = self.places[v as usize];
            if (v as usize) < points.len() {
                below = Some(v);
                continue;
            }
            let ends = [below?, above?];
            if ends.iter().any(|&w| self.places[w as usize].0 != section) {
                return None;
            }
            let [low, high] = ends.map(|w| self.places[w as usize].1);
            let [a, b] = ends.map(|w| points[w as usize]);
            at[v as usize] = Some(add_scaled(a, f64::from(z - low) / f64::from(high - low), sub(b, a)));
        }
        at.into_iter().collect()
    }
}

/// The hexes of every way to see the surface as a section with columns, vertices of the surface first. `wanted` is per dart; where creases do not tell
/// caps from walls, `points` may.
pub(crate) fn columns(
    surface: &QuadSurface,
    wanted: &[f32],
    points: Option<&[Vector]>,
    ctx: &Context<'_>,
) -> Vec<Columns> {
    // What an edge bends, more than flat if convex.
    let bend: Vec<f32> = wanted.iter().map(|w| FLAT - w).collect();
    let mut by_rule = RULES.into_iter().map(|rule| columns_by(rule, surface, &bend, ctx));
    if let Some(found) = by_rule.find(|found| !found.is_empty()) {
        return found;
    }
    let Some(points) = points.filter(|_| surface.n_components() == 1) else { return Vec::new() };
    let normals: Vec<Vector> = surface.quads().iter().map(|q| area(q.map(|v| points[v.index()]))).collect();
    axes(&normals)
        .into_iter()
        .filter_map(|axis| hexes(surface, &labels_along(surface, points, &normals, axis)))
        .collect()
}

/// The vector area of a quad.
fn area([a, b, c, d]: [Vector; 4]) -> Vector {
    scale(0.5, cross(sub(c, a), sub(d, b)))
}

/// Up to [`MOST_AXES`] directions that much of the surface faces, or faces away from; those of the largest areas.
fn axes(normals: &[Vector]) -> Vec<Vector> {
    let step = normals.len().div_ceil(SAMPLES);
    let facing = |axis: Vector| -> f64 {
        let along = normals.iter().map(|&n| (dot(n, axis).abs(), norm(n)));
        along.filter(|(along, area)| *along > PARALLEL * area).map(|(_, area)| area).sum()
    };
    // What faces an axis roughly says better where it points than one quad, on a torus as on a plate with a few dents.
    let straightened = |axis: Vector| {
        let caps = normals.iter().filter(|&&n| dot(n, axis).abs() > CAP * norm(n));
        unit(caps.fold([0.0; 3], |sum, &n| add_scaled(sum, dot(n, axis).signum(), n)))
    };
    let mut found: Vec<(f64, Vector)> = normals
        .iter()
        .step_by(step)
        .filter_map(|&n| (0..STRAIGHTENED).try_fold(unit(n)?, |axis, _| straightened(axis)))
        .map(|axis| (facing(axis), axis))
        .collect();
    // Stable: equals in the order of their quads.
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut axes: Vec<Vector> = Vec::new();
    for (_, axis) in found {
        if axes.len() < MOST_AXES && axes.iter().all(|&other| dot(axis, other).abs() < CAP) {
            axes.push(axis);
        }
    }
    axes
}

/// What quads are by how they face: caps along an axis, walls across it, whose edge nearest to it leads up.
fn labels_along(surface: &QuadSurface, points: &[Vector], normals: &[Vector], axis: Vector) -> Vec<Label> {
    let rise = |d: u32| {
        let [a, b] = [surface.origin(Dart(d)), surface.target(Dart(d))].map(|v| points[v.index()]);
        direction(a, b).map_or(0.0, |along| dot(along, axis))
    };
    let label = |(q, &normal): (u32, &Vector)| match dot(normal, axis) / norm(normal) {
        x if x > CAP => Label::FacesUp,
        x if x < -CAP => Label::FacesDown,
        _ => {
            let up = (4 * q..4 * q + 4).max_by(|&a, &b| rise(a).total_cmp(&rise(b)));
            Label::Wall(up.expect("a quad has four darts"))
        }
    };
    (0..).zip(normals).map(label).collect()
}

fn columns_by(rule: Rule, surface: &QuadSurface, bend: &[f32], ctx: &Context<'_>) -> Vec<Columns> {
    let mut found: Vec<Columns> = Vec::new();
    // Two patches of one way are both its caps.
    let mut is_cap = vec![false; surface.n_quads()];
    for seed in patches(rule, surface, bend).into_iter().take(MOST_PATCHES) {
        if ctx.stop().is_some() {
            break;
        }
        if is_cap[seed as usize] {
            continue;
        }
        let Some(labels) = labels(rule, surface, bend, seed) else { continue };
        is_cap.iter_mut().zip(&labels).for_each(|(is_cap, label)| *is_cap |= !label.is_wall());
        // Solids of cubes are columns in three directions, with the same hexes.
        let made = hexes(surface, &labels);
        found.extend(made.filter(|made| found.iter().all(|other| other.hexes.len() != made.hexes.len())));
    }
    found
}

/// A quad of each smooth patch, largest patches first.
fn patches(rule: Rule, surface: &QuadSurface, bend: &[f32]) -> Vec<u32> {
    let mut patch = Classes::new(surface.n_quads());
    for d in surface.darts().filter(|d| bend[d.index()].abs() < rule.cap) {
        patch.join(d.quad().0, surface.twin(d).quad().0);
    }
    let mut size = vec![0u32; surface.n_quads()];
    (0..surface.n_quads() as u32).for_each(|q| size[patch.root(q) as usize] += 1);
    let mut seeds: Vec<u32> = (0..surface.n_quads() as u32).filter(|&q| size[q as usize] > 0).collect();
    // Stable: equals in the order of their quads.
    seeds.sort_by_key(|&q| std::cmp::Reverse(size[q as usize]));
    seeds
}

/// What all quads are if `seed` is a cap that faces up; `None` if some quad would be two things.
fn labels(rule: Rule, surface: &QuadSurface, bend: &[f32], seed: u32) -> Option<Vec<Label>> {
    let mut labels = vec![Label::Unknown; surface.n_quads()];
    // Per wall: how far it faces up (1: as a cap does) or down (-1).
    let mut lean = vec![0.0; surface.n_quads()];
    labels[seed as usize] = Label::FacesUp;
    let mut work = vec![seed];
    while let Some(q) = work.pop() {
        for d in 4 * q..4 * q + 4 {
            let t = surface.twin(Dart(d)).0;
            let (label, leans) = beyond(rule, labels[q as usize], lean[q as usize], d, t, bend[d as usize]);
            let slot = &mut labels[(t >> 2) as usize];
            if *slot == Label::Unknown {
                *slot = label;
                lean[(t >> 2) as usize] = leans;
                work.push(t >> 2);
            }
            if *slot != label {
                return None;
            }
        }
    }
    // A surface of several components says nothing about how they lie to each other.
    (!labels.contains(&Label::Unknown)).then_some(labels)
}

/// What the quad beyond dart `d` is, and how it leans if it is a wall; `t` is its dart there. Seen from outside, a wall goes round counter-clockwise: up on
/// the right, back along the top, down on the left.
fn beyond(rule: Rule, label: Label, lean: f32, d: u32, t: u32, bend: f32) -> (Label, f32) {
    match label {
        Label::Wall(up) if d == up => (Label::Wall(opposite(t)), lean),
        Label::Wall(up) if d == opposite(up) => (Label::Wall(t), lean),
        Label::Wall(up) => {
            let is_top = d == next(up);
            let turned = if is_top { lean + bend } else { lean - bend };
            let lean = if bend.abs() > rule.least { turned } else { lean };
            match turned {
                x if x > rule.wall => (Label::FacesUp, 0.0),
                x if x < -rule.wall => (Label::FacesDown, 0.0),
                _ => (Label::Wall(if is_top { next(t) } else { prev(t) }), lean),
            }
        }
        _ if bend.abs() < rule.cap => (label, 0.0),
        // A wall goes down from a convex edge of what faces up, and rises from a concave one. What is missing to a right angle is its lean.
        _ => {
            let missing = if bend.abs() > rule.least { 1.0 - bend.abs() } else { 0.0 };
            let faces_up = label == Label::FacesUp;
            let goes_down = faces_up == (bend > 0.0);
            (Label::Wall(if goes_down { prev(t) } else { next(t) }), if faces_up { missing } else { -missing })
        }
    }
}

/// Per vertex: its height in edges; `None` if that differs from way to way.
fn heights(surface: &QuadSurface, labels: &[Label]) -> Option<Vec<i32>> {
    let rise = |d: u32| match labels[(d >> 2) as usize] {
        Label::Wall(up) if d == up => 1,
        Label::Wall(up) if d == opposite(up) => -1,
        _ => 0,
    };
    let mut height = vec![i32::MIN; surface.n_vertices()];
    let mut is_done = vec![false; surface.n_quads()];
    is_done[0] = true;
    height[surface.origin(Dart(0)).index()] = 0;
    let mut work = vec![0];
    while let Some(first) = work.pop() {
        let mut d = first;
        for _ in 0..4 {
            let at = height[surface.origin(Dart(d)).index()] + rise(d);
            let slot = &mut height[surface.target(Dart(d)).index()];
            if *slot == i32::MIN {
                *slot = at;
            }
            if *slot != at {
                return None;
            }
            let t = surface.twin(Dart(d)).0;
            if !std::mem::replace(&mut is_done[(t >> 2) as usize], true) {
                work.push(t);
            }
            d = next(d);
        }
    }
    Some(height)
}

/// The surface folded onto its section. Edges of the section are told by darts, in both directions.
struct Section<'a> {
    surface: &'a QuadSurface,
    labels: &'a [Label],
    vertex: Classes,
    edge: Classes,
    quad: Classes,
    /// Per root of `edge`: the cap on its left seen from above, and which of its four sides that is.
    left: Vec<Option<(u32, usize)>>,
}

impl<'a> Section<'a> {
    fn new(surface: &'a QuadSurface, labels: &'a [Label]) -> Self {
        let n = surface.n_quads();
        let mut section = Self {
            surface,
            labels,
            vertex: Classes::new(surface.n_vertices()),
            edge: Classes::new(4 * n),
            quad: Classes::new(n),
            left: vec![None; 4 * n],
        };
        for (q, label) in (0..n as u32).zip(labels) {
            if !label.is_wall() {
                for i in 0..4 {
                    let side = section.side(q, i) as usize;
                    section.left[side] = Some((q, i));
                }
            }
        }
        for label in labels {
            if let &Label::Wall(up) = label {
                section.join(next(up), surface.twin(Dart(prev(up))).0);
            }
        }
        section
    }

    /// Side `side` of a cap, counter-clockwise seen from above.
    fn side(&self, cap: u32, side: usize) -> u32 {
        match self.labels[cap as usize] {
            Label::FacesUp => 4 * cap + side as u32,
            _ => self.surface.twin(Dart(turn(4 * cap, 3 - side))).0,
        }
    }

    /// Makes two directed edges one, and with them all that follows.
    fn join(&mut self, a: u32, b: u32) {
        let mut work = vec![(a, b)];
        while let Some((a, b)) = work.pop() {
            let (from, to) = (self.edge.root(a), self.edge.root(b));
            if from == to {
                continue;
            }
            self.edge.join(from, to);
            let [one, other] = [a, b].map(Dart);
            self.vertex.join(self.surface.origin(one).0, self.surface.origin(other).0);
            self.vertex.join(self.surface.target(one).0, self.surface.target(other).0);
            work.push((self.surface.twin(one).0, self.surface.twin(other).0));
            let (kept, gone) = (from.min(to) as usize, from.max(to) as usize);
            match (self.left[kept], self.left[gone]) {
                // Two caps on the same side of one edge are one quad of the section.
                (Some((p, i)), Some((q, j))) => {
                    self.quad.join(p, q);
                    (1..4).for_each(|k| work.push((self.side(p, (i + k) % 4), self.side(q, (j + k) % 4))));
                }
                (None, cap) => self.left[kept] = cap,
                _ => {}
            }
        }
    }
}

/// The hexes of the columns between caps; `None` if the caps are not, from low to high, floor and top in turn, or two vertices lie at one place.
fn hexes(surface: &QuadSurface, labels: &[Label]) -> Option<Columns> {
    let height = heights(surface, labels)?;
    let mut section = Section::new(surface, labels);
    let mut at: FxHashMap<(u32, i32), u32> = FxHashMap::default();
    for (v, &z) in (0..).zip(&height) {
        if at.insert((section.vertex.root(v), z), v).is_some() {
            return None;
        }
    }
    // By quad of the section, low to high.
    let mut caps: Vec<(u32, i32, u32)> = Vec::new();
    for q in (0..surface.n_quads() as u32).filter(|&q| !labels[q as usize].is_wall()) {
        caps.push((section.quad.root(q), height[surface.quads()[q as usize][0].index()], q));
    }
    caps.sort_unstable();
    let mut hexes = Vec::new();
    let mut n_vertices = surface.n_vertices() as u32;
    let mut n_hexes = 0;
    for pair in caps.chunks(2) {
        let &[(quad, low, floor), (same, high, top)] = pair else { return None };
        n_hexes += i64::from(high) - i64::from(low);
        let is_column = labels[floor as usize] == Label::FacesDown && labels[top as usize] == Label::FacesUp;
        if quad != same || low >= high || !is_column || n_hexes > MOST_HEXES {
            return None;
        }
        let corners = surface.quads()[top as usize].map(|v| section.vertex.root(v.0));
        let mut vertex = |corner: usize, z: i32| {
            *at.entry((corners[corner], z)).or_insert_with(|| {
                n_vertices += 1;
                n_vertices - 1
            })
        };
        for z in low..high {
            hexes.push(std::array::from_fn(|k| vertex(k % 4, z + i32::from(k >= 4))));
        }
    }
    let quads: Vec<[u32; 4]> = surface.quads_raw();
    Front::try_from_parts(n_vertices, &quads, &hexes, &[]).ok()?;
    let mut places = vec![(0, 0); n_vertices as usize];
    at.into_iter().for_each(|(place, v)| places[v as usize] = place);
    Some(Columns { hexes, places })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::angles::wanted_hexes;
    use crate::sweep::Swept;
    use crate::test_surfaces::{boundary_of, judged, torus_at, voxel_points};
    use hexfill_mesh::{Random, is_proper};
    use std::f64::consts::TAU;

    /// Judges all ways to fill a surface; the hexes of each.
    fn filled(surface: &QuadSurface, points: &[[f64; 3]]) -> Vec<usize> {
        let found = columns(surface, &wanted_hexes(surface, Some(points)), Some(points), &Context::default());
        let judge = |Columns { hexes, .. }: Columns| {
            let n_vertices = hexes.iter().flatten().max().unwrap() + 1;
            judged(surface, &Swept { n_vertices, hexes, plugs: 0, front: Vec::new(), stopped: None })
        };
        found.into_iter().map(judge).collect()
    }

    /// A ring of 4 by 12 quads about the z axis with layers from `low` to `high` on each ring, and `more` on every third sector.
    fn turned(low: [usize; 4], high: [usize; 4], more: [usize; 4]) -> (QuadSurface, Vec<[f64; 3]>, usize) {
        const ROUND: usize = 12;
        let id = |r: usize, s: usize, z: usize| (5 * (z * ROUND + s % ROUND) + r) as u32;
        let point = |v: usize| {
            let (r, s, z) = (v % 5, v / 5 % ROUND, v / 5 / ROUND);
            let (sin, cos) = (TAU * s as f64 / ROUND as f64).sin_cos();
            let out = 3.0 + r as f64;
            // Bent, so that no cap is plane.
            [out * cos, out * sin, z as f64 + 0.02 * out * out * cos]
        };
        let points: Vec<[f64; 3]> = (0..5 * ROUND * 12).map(point).collect();
        let mut hexes = Vec::new();
        for (r, s) in (0..4).flat_map(|r| (0..ROUND).map(move |s| (r, s))) {
            let corners = [(r, s), (r + 1, s), (r + 1, s + 1), (r, s + 1)];
            for z in low[r]..high[r] + if s % 3 == 0 { more[r] } else { 0 } {
                hexes.push(std::array::from_fn(|k| id(corners[k % 4].0, corners[k % 4].1, z + k / 4)));
            }
        }
        let (surface, points) = boundary_of(&points, &hexes);
        (surface, points, hexes.len())
    }

    #[test]
    fn flanges_with_steps_and_bosses() {
        for (low, high, more) in [
            ([0; 4], [2; 4], [0; 4]),
            ([0; 4], [5, 5, 2, 2], [0; 4]),
            ([1, 0, 0, 2], [5, 7, 3, 4], [0, 0, 2, 0]),
            ([2, 0, 1, 1], [4, 4, 4, 6], [3, 0, 0, 1]),
        ] {
            let (surface, points, known) = turned(low, high, more);
            // A plain ring is columns from inside out, too.
            let is_known = |made: Vec<usize>| !made.is_empty() && made.iter().all(|&n| n == known);
            assert!(is_known(filled(&surface, &points)));
            // Upside down.
            let upside_down: Vec<[f64; 3]> = points.iter().map(|&[x, y, z]| [x, -y, -z]).collect();
            assert!(is_known(filled(&surface, &upside_down)));
        }
    }

    #[test]
    fn chamfers_are_levels_of_walls() {
        // The highest and lowest vertices of the outer and the inner wall go in by what a level is high.
        let chamfered = |high: f64, depth: f64, [x, y, z]: [f64; 3]| {
            let out = x.hypot(y);
            let z = z - 0.02 * out * x;
            let off = if z < 1e-9 || z > high - 1e-9 { depth } else { 0.0 };
            let to = if out > 6.5 {
                out - off
            } else if out < 3.5 {
                out + off
            } else {
                out
            };
            [x * to / out, y * to / out, z]
        };
        for depth in [0.0, 0.5, 0.9] {
            let (surface, points, known) = turned([0; 4], [4; 4], [0; 4]);
            let points: Vec<[f64; 3]> = points.into_iter().map(|p| chamfered(4.0, depth, p)).collect();
            let made = filled(&surface, &points);
            assert!(!made.is_empty() && made.iter().all(|&n| n == known), "{depth}: {made:?}");
        }
    }

    #[test]
    fn what_is_inside_lies_evenly_between_caps() {
        let (surface, points) = voxel_points([3, 4, 5], |[x, y, z]| z < 3 || x == 0 || y > 0).unwrap();
        let made = columns(&surface, &wanted_hexes(&surface, Some(&points)), Some(&points), &Context::default());
        for columns in &made {
            let mut at = columns.spread(&points).unwrap();
            assert_eq!(at[..points.len()], points);
            // Every point of the grid once.
            let n = at.len();
            at.iter_mut().for_each(|p| *p = p.map(|x| (x * 1e6).round()));
            at.sort_by(|a, b| a.partial_cmp(b).unwrap());
            at.dedup();
            assert!(at.len() == n && at.iter().flatten().all(|x| x % 1e6 == 0.0), "{at:?}");
        }
        assert!(!made.is_empty());
    }

    #[test]
    fn a_torus_is_columns_along_its_axis() {
        let (torus, points) = torus_at(12, 16);
        assert!(
            columns(&torus, &wanted_hexes(&torus, Some(&points)), None, &Context::default()).is_empty(),
            "no edge bends enough"
        );
        assert_eq!(filled(&torus, &points), [12 * 4 * 4]);
    }

    #[test]
    fn voxel_solids_are_columns_or_refused() {
        let (mut found, mut tried) = (0, 0);
        for seed in 0..400 {
            let mut random = Random::new(seed);
            let size = [0; 3].map(|_| 2 + random.below(3));
            let empty: Vec<[usize; 3]> = (0..5).map(|_| size.map(|n| random.below(n))).collect();
            let Some((surface, points)) = voxel_points(size, |c| !empty.contains(&c)) else { continue };
            if !is_proper(&surface) {
                continue;
            }
            let n_cells = (0..size.iter().product())
                .filter(|i| !empty.contains(&[i % size[0], i / size[0] % size[1], i / size[0] / size[1]]))
                .count();
            let made = filled(&surface, &points);
            assert!(made.iter().all(|&n| n == n_cells), "{seed}: {made:?}, {n_cells} cells");
            tried += 1;
            found += usize::from(!made.is_empty());
        }
        // The others have a cavity, or nooks that no direction sees; most with five cells out touch themselves and are not tried.
        assert!(10 * found > 9 * tried && tried > 80, "{found} of {tried}");
    }

    #[test]
    fn what_has_no_caps_has_no_columns() {
        let surface = hexfill_mesh::generate::random_sphere(60, 1).unwrap();
        assert!(columns(&surface, &[2.0; 240], None, &Context::default()).is_empty());
        // With eight quads round the tube it has chamfers: one column of three hexes in each section, in four directions.
        let (torus, points) = torus_at(12, 8);
        assert_eq!(filled(&torus, &points), [36]);
        let cube = hexfill_mesh::generate::cube_surface();
        assert!(columns(&cube, &[2.0; 24], None, &Context::default()).is_empty());
        assert_eq!(columns(&cube, &[1.0; 24], None, &Context::default()).len(), 1);
    }
}
