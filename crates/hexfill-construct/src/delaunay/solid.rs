//! Tets inside a surface that are edited: points taken off the boundary, points removed, points moved.
//!
//! Every edit replaces the star of one vertex. The star is a polyhedron; if its new tets are all positively oriented and
//! have its boundary, they tile it, so nothing else has to be looked at. Orientation is exact.
//!
//! [`Solid::clear_boundary`] undoes what the refinement did to the surface (George, Borouchaki, Saltel 2003; Si and Gärtner
//! 2005): a point on the boundary is drawn onto a neighbour if the tets allow it. Else it moves inward, and the flat
//! polygon round it is triangulated without it: the new triangles and the moved point are new tets, which it sees
//! because it lies on the inner side of their planes.

use super::conform::Inside;
use super::mesh::{NONE, orient};
use crate::tets::TET_EDGES;
use crate::vector::{Point, cross, dot, sub};
use hexfill_mesh::{Context, StopReason};

/// Least quality that a removal may leave, unless it was worse before.
pub(super) const FLOOR: f64 = 0.01;

/// Least quality that the removal of an inner point may leave, unless it was worse before: the hexes of such a tet have scaled
/// Jacobians of about as much. With 0.01 a ball has 47.0 hexes a quad, with 0.1 49.8.
pub(super) const FLOOR_INSIDE: f64 = 0.05;

/// Shares (see [`Solid::share`]) up to this are those of rounded points on one line.
const FLAT: f64 = 1e-9;

/// Tets with, per vertex, those that have it.
pub(crate) struct Solid {
    pub(super) points: Vec<Point>,
    /// A removed tet has [`NONE`] first.
    pub(super) tets: Vec<[u32; 4]>,
    pub(super) tets_at: Vec<Vec<u32>>,
    /// The boundary, outward; a removed face has [`NONE`] first.
    pub(super) faces: Vec<([u32; 3], u32)>,
    pub(super) faces_at: Vec<Vec<u32>>,
    /// Per triangle of the surface its unit outward normal.
    normals: Vec<Point>,
    /// Number of vertices of the surface.
    pub(super) n_surface: usize,
}

fn unit(v: Point) -> Point {
    let length = dot(v, v).sqrt();
    if length > 0.0 { v.map(|x| x / length) } else { v }
}

/// Six times the volume over the cube of the root mean square of the edges: 0.7 at best. Its sign is exact.
fn quality(p: [Point; 4]) -> f64 {
    let volume = orient(p);
    let square: f64 = TET_EDGES
        .iter()
        .map(|&[i, j]| {
            let d = sub(p[i], p[j]);
            dot(d, d)
        })
        .sum::<f64>()
        / 6.0;
    let q = volume / (square * square.sqrt());
    // A volume that underflows in the quotient keeps its sign.
    if volume > 0.0 { q.max(f64::MIN_POSITIVE) } else { q.min(0.0) }
}

impl Solid {
    /// What was found inside a surface with these triangles.
    pub fn new(inside: Inside, triangles: &[[u32; 3]], n_surface: usize) -> Self {
        let Inside { points, tets, boundary } = inside;
        let mut tets_at = vec![Vec::new(); points.len()];
        for (t, tet) in tets.iter().enumerate() {
            tet.iter().for_each(|&v| tets_at[v as usize].push(t as u32));
        }
        let mut faces_at = vec![Vec::new(); points.len()];
        for (f, (face, _)) in boundary.iter().enumerate() {
            face.iter().for_each(|&v| faces_at[v as usize].push(f as u32));
        }
        let normal = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| points[v as usize]);
            unit(cross(sub(b, a), sub(c, a)))
        };
        let normals = triangles.iter().map(normal).collect();
        Self { points, tets, tets_at, faces: boundary, faces_at, normals, n_surface }
    }

    fn at(&self, v: u32) -> Point {
        self.points[v as usize]
    }

    pub(super) fn quality(&self, tet: [u32; 4]) -> f64 {
        quality(tet.map(|v| self.at(v)))
    }

    /// Least quality of tets, of which `v` is taken to be at `p`.
    pub(super) fn least(&self, tets: &[[u32; 4]], v: u32, p: Point) -> f64 {
        let mut least = f64::INFINITY;
        for tet in tets {
            least = least.min(quality(tet.map(|w| if w == v { p } else { self.at(w) })));
            if least <= 0.0 {
                break;
            }
        }
        least
    }

    fn star(&self, v: u32) -> Vec<[u32; 4]> {
        self.tets_at[v as usize].iter().map(|&t| self.tets[t as usize]).collect()
    }

    fn replace_tets(&mut self, v: u32, new: &[[u32; 4]]) {
        for t in std::mem::take(&mut self.tets_at[v as usize]) {
            let tet = std::mem::replace(&mut self.tets[t as usize], [NONE; 4]);
            for w in tet.into_iter().filter(|&w| w != v) {
                self.tets_at[w as usize].retain(|&u| u != t);
            }
        }
        for tet in new {
            let t = self.tets.len() as u32;
            self.tets.push(*tet);
            tet.iter().for_each(|&w| self.tets_at[w as usize].push(t));
        }
    }

    fn replace_faces(&mut self, v: u32, new: &[([u32; 3], u32)]) {
        for f in std::mem::take(&mut self.faces_at[v as usize]) {
            let (face, _) = std::mem::replace(&mut self.faces[f as usize], ([NONE; 3], NONE));
            for w in face.into_iter().filter(|&w| w != v) {
                self.faces_at[w as usize].retain(|&u| u != f);
            }
        }
        for face in new {
            let f = self.faces.len() as u32;
            self.faces.push(*face);
            face.0.iter().for_each(|&w| self.faces_at[w as usize].push(f));
        }
    }

    /// The tets of a star after drawing `v` onto `u`.
    fn drawn(&self, v: u32, u: u32) -> Vec<[u32; 4]> {
        let others = self.tets_at[v as usize].iter().map(|&t| self.tets[t as usize]).filter(|t| !t.contains(&u));
        others.map(|t| t.map(|w| if w == v { u } else { w })).collect()
    }

    fn least_now(&self, v: u32) -> f64 {
        let tets = self.tets_at[v as usize].iter().map(|&t| self.quality(self.tets[t as usize]));
        tets.fold(f64::INFINITY, f64::min)
    }

    /// The neighbours of a vertex, ascending.
    fn neighbours(&self, v: u32) -> Vec<u32> {
        let mut all: Vec<u32> = self.star(v).into_iter().flatten().filter(|&w| w != v).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Takes every point that is not a vertex of the surface off the boundary.
    ///
    /// # Errors
    /// The number of points that could not be taken off, or the reason to stop.
    pub fn clear_boundary(&mut self, ctx: &Context<'_>) -> Result<Result<(), usize>, StopReason> {
        let mut left: Vec<u32> = (self.n_surface as u32..self.points.len() as u32).rev().collect();
        left.retain(|&v| !self.faces_at[v as usize].is_empty());
        // Drawing points onto others removes them for good, so that comes first, as often as it helps.
        self.improve(ctx)?;
        loop {
            let before = left.len();
            let mut kept = Vec::new();
            for v in left {
                if let Some(reason) = ctx.stop() {
                    return Err(reason);
                }
                if !self.draw_along_boundary(v, FLOOR) {
                    kept.push(v);
                }
            }
            left = kept;
            if left.len() == before {
                break;
            }
        }
        loop {
            self.improve(ctx)?;
            let before = left.len();
            let mut kept = Vec::new();
            for v in left {
                if let Some(reason) = ctx.stop() {
                    return Err(reason);
                }
                if !self.draw_along_boundary(v, FLOOR) && !self.move_inward(v) && !self.draw_along_boundary(v, 0.0) {
                    kept.push(v);
                }
            }
            ctx.report("points off the boundary", 0, None, || format!("{} left", kept.len()));
            left = kept;
            if left.is_empty() {
                return Ok(Ok(()));
            }
            if left.len() == before {
                return Ok(Err(before));
            }
        }
    }

    /// The boundary round a vertex: its neighbours in order, and the triangle of the surface between each and the next.
    /// `None` if it is not one simple cycle.
    fn cycle(&self, v: u32) -> Option<Vec<(u32, u32)>> {
        let mut steps: Vec<(u32, u32, u32)> = Vec::new();
        for &f in &self.faces_at[v as usize] {
            let ([a, b, c], tag) = self.faces[f as usize];
            let (x, y) = if a == v {
                (b, c)
            } else if b == v {
                (c, a)
            } else {
                (a, b)
            };
            steps.push((x, y, tag));
        }
        steps.sort_unstable();
        let mut cycle = Vec::with_capacity(steps.len());
        let mut here = steps.first()?.0;
        for _ in 0..steps.len() {
            let k = steps.binary_search_by_key(&here, |s| s.0).ok()?;
            cycle.push((here, steps[k].2));
            here = steps[k].1;
        }
        let mut distinct: Vec<u32> = cycle.iter().map(|c| c.0).collect();
        distinct.sort_unstable();
        distinct.dedup();
        (here == cycle[0].0 && distinct.len() == steps.len()).then_some(cycle)
    }

    /// The polygons round a boundary point without it, one for each triangle of the surface it belongs to.
    fn polygons(&self, v: u32) -> Option<Vec<(Vec<u32>, u32)>> {
        let mut cycle = self.cycle(v)?;
        let n = cycle.len();
        let changes: Vec<usize> = (0..n).filter(|&k| cycle[k].1 != cycle[(k + n - 1) % n].1).collect();
        match *changes.as_slice() {
            [] => Some(vec![(cycle.iter().map(|c| c.0).collect(), cycle[0].1)]),
            [first, second] => {
                cycle.rotate_left(first);
                let k = second - first;
                let one = cycle[..=k].iter().map(|c| c.0).collect();
                let mut two: Vec<u32> = cycle[k..].iter().map(|c| c.0).collect();
                two.push(cycle[0].0);
                Some(vec![(one, cycle[0].1), (two, cycle[k].1)])
            }
            _ => None,
        }
    }

    /// Draws a boundary point onto a neighbour that lies on the same edge or in the same triangle.
    fn draw_along_boundary(&mut self, v: u32, floor: f64) -> bool {
        let Some(polygons) = self.polygons(v) else { return false };
        let floor = floor.min(self.least_now(v) / 2.0);
        let candidates: Vec<u32> = match polygons.as_slice() {
            [(all, _)] => all.clone(),
            [(one, _), _] => vec![one[0], one[one.len() - 1]],
            _ => return false,
        };
        let mut best: Option<(f64, u32)> = None;
        for u in candidates {
            let fits =
                polygons.iter().all(|(polygon, tag)| fan(polygon, u).iter().all(|t| self.share(*t, *tag) > FLAT));
            if !fits {
                continue;
            }
            let q = self.least(&self.drawn(v, u), NONE, [0.0; 3]);
            if q > floor && q > 0.0 && best.is_none_or(|b| q > b.0) {
                best = Some((q, u));
            }
        }
        let Some((_, u)) = best else { return false };
        let tets = self.drawn(v, u);
        let faces: Vec<_> =
            polygons.iter().flat_map(|(polygon, tag)| fan(polygon, u).into_iter().map(|t| (t, *tag))).collect();
        self.replace_tets(v, &tets);
        self.replace_faces(v, &faces);
        true
    }

    /// Twice the area of a face over the square of its longest side, positive if it faces like triangle `tag`.
    fn share(&self, face: [u32; 3], tag: u32) -> f64 {
        let [a, b, c] = face.map(|v| self.at(v));
        let longest = [sub(a, b), sub(b, c), sub(c, a)].map(|d| dot(d, d)).into_iter().fold(0.0, f64::max);
        dot(cross(sub(b, a), sub(c, a)), self.normals[tag as usize]) / longest
    }

    /// The triangulation of a flat polygon whose worst triangle is best, by dynamic programming (Klincsek 1980). All its
    /// triangles face outward, so it is one even if the polygon is not convex.
    fn cut(&self, polygon: &[u32], tag: u32) -> Option<Vec<([u32; 3], u32)>> {
        let n = polygon.len();
        if n < 3 {
            return None;
        }
        // Entry i n + j: the polygon from i to j closed by the side i j; its worst triangle, and where the one at that side ends.
        let mut best = vec![(f64::INFINITY, 0); n * n];
        for width in 2..n {
            for i in 0..n - width {
                let j = i + width;
                let worst = |k: usize| {
                    let share = self.share([polygon[i], polygon[k], polygon[j]], tag);
                    share.min(best[i * n + k].0).min(best[k * n + j].0)
                };
                let mut found = (f64::NEG_INFINITY, i + 1);
                for k in i + 1..j {
                    let here = worst(k);
                    if here > found.0 {
                        found = (here, k);
                    }
                }
                best[i * n + j] = found;
            }
        }
        if best[n - 1].0 <= FLAT {
            return None;
        }
        let mut triangles = Vec::with_capacity(n - 2);
        let mut stack = vec![(0, n - 1)];
        while let Some((i, j)) = stack.pop() {
            if j - i >= 2 {
                let k = best[i * n + j].1;
                triangles.push(([polygon[i], polygon[k], polygon[j]], tag));
                stack.extend([(i, k), (k, j)]);
            }
        }
        Some(triangles)
    }

    /// Moves a boundary point inward and closes the boundary below it.
    fn move_inward(&mut self, v: u32) -> bool {
        let Some(polygons) = self.polygons(v) else { return false };
        let mut faces = Vec::new();
        let mut inward = [0.0; 3];
        for (polygon, tag) in &polygons {
            match self.cut(polygon, *tag) {
                Some(cut) => faces.extend(cut),
                None => return false,
            }
            inward = sub(inward, self.normals[*tag as usize]);
        }
        let mut tets = self.star(v);
        tets.extend(faces.iter().map(|([a, b, c], _)| [v, *a, *b, *c]));
        let neighbours = self.neighbours(v);
        let here = self.at(v);
        let mean: Point =
            std::array::from_fn(|c| neighbours.iter().map(|&w| self.at(w)[c]).sum::<f64>() / neighbours.len() as f64);
        let reach = neighbours.iter().map(|&w| sub(self.at(w), here)).map(|d| dot(d, d)).fold(0.0, f64::max).sqrt();
        let mut best = (0.0, here, 0.0);
        for direction in [unit(inward), unit(sub(mean, here))] {
            let mut step = reach;
            for _ in 0..30 {
                let p = std::array::from_fn(|c| here[c] + step * direction[c]);
                let q = self.least(&tets, v, p);
                if q > best.0 {
                    best = (q, p, step);
                }
                step /= 2.0;
            }
        }
        if best.0 <= 0.0 {
            return false;
        }
        let p = self.climb(&tets, v, best);
        self.points[v as usize] = p;
        self.replace_tets(v, &tets);
        self.replace_faces(v, &faces);
        true
    }

    /// Raises the least quality of tets by moving `v` from a place, with steps of at most a given length.
    pub(super) fn climb(&self, tets: &[[u32; 4]], v: u32, (mut q, mut p, mut step): (f64, Point, f64)) -> Point {
        const DIRECTIONS: [Point; 7] = [
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [0.6, 0.6, 0.6],
            [0.6, -0.6, 0.6],
            [-0.6, 0.6, 0.6],
            [-0.6, -0.6, 0.6],
        ];
        for _ in 0..8 {
            step /= 2.0;
            for _ in 0..3 {
                let from = p;
                let mut best = (q, p);
                for d in DIRECTIONS {
                    for sign in [1.0, -1.0] {
                        let to = std::array::from_fn(|c| from[c] + sign * step * d[c]);
                        let here = self.least(tets, v, to);
                        if here > best.0 {
                            best = (here, to);
                        }
                    }
                }
                if best.1 == p {
                    break;
                }
                (q, p) = best;
            }
        }
        p
    }

    /// Removes inner points by drawing them onto neighbours, and moves those that stay to better places.
    pub fn remove_points(&mut self, ctx: &Context<'_>) -> Result<(), StopReason> {
        for round in 0..6 {
            self.improve(ctx)?;
            let mut removed = 0;
            for v in (self.n_surface as u32..self.points.len() as u32).rev() {
                if let Some(reason) = ctx.stop() {
                    return Err(reason);
                }
                if self.tets_at[v as usize].is_empty() || !self.faces_at[v as usize].is_empty() {
                    continue;
                }
                if self.draw_inside(v) {
                    removed += 1;
                } else {
                    self.smooth(v);
                }
            }
            ctx.report("points removed", round, None, || format!("{removed}"));
            self.save_tets();
            if removed == 0 {
                break;
            }
        }
        self.improve(ctx)?;
        self.split_flat(ctx)
    }

    fn draw_inside(&mut self, v: u32) -> bool {
        let floor = FLOOR_INSIDE.min(self.least_now(v));
        let mut best: Option<(f64, u32)> = None;
        for u in self.neighbours(v) {
            let q = self.least(&self.drawn(v, u), NONE, [0.0; 3]);
            if q > floor && q > 0.0 && best.is_none_or(|b| q > b.0) {
                best = Some((q, u));
            }
        }
        let Some((_, u)) = best else { return false };
        let tets = self.drawn(v, u);
        self.replace_tets(v, &tets);
        true
    }

    pub(super) fn smooth(&mut self, v: u32) {
        let tets = self.star(v);
        let reach =
            tets.iter().flatten().map(|&w| sub(self.at(w), self.at(v))).map(|d| dot(d, d)).fold(0.0, f64::max).sqrt();
        let p = self.at(v);
        self.points[v as usize] = self.climb(&tets, v, (self.least(&tets, v, p), p, reach));
    }

    /// The tets, their points (the surface's first, then those still in use), and the least quality.
    pub fn finish(self) -> (Vec<Point>, Vec<[u32; 4]>, f64) {
        let mut number: Vec<u32> = (0..self.points.len() as u32).collect();
        let mut points = self.points[..self.n_surface].to_vec();
        for (v, number) in number.iter_mut().enumerate().skip(self.n_surface) {
            if !self.tets_at[v].is_empty() {
                *number = points.len() as u32;
                points.push(self.points[v]);
            }
        }
        let mut least = f64::INFINITY;
        let mut tets = Vec::new();
        for tet in self.tets.iter().filter(|t| t[0] != NONE) {
            least = least.min(self.quality(*tet));
            tets.push(tet.map(|v| number[v as usize]));
        }
        (points, tets, least)
    }
}

/// A polygon cut into triangles from its corner `u`.
fn fan(polygon: &[u32], u: u32) -> Vec<[u32; 3]> {
    let n = polygon.len();
    let sides = (0..n).map(|k| [polygon[k], polygon[(k + 1) % n]]);
    sides.filter(|s| !s.contains(&u)).map(|[x, y]| [u, x, y]).collect()
}
