//! Points are taken off the boundary again: what the refinement did to the surface is undone (George, Borouchaki, Saltel 2003; Si
//! and Gärtner 2005).
//!
//! A point on the boundary is drawn onto a neighbour if the tets allow it. Else it moves inward, and the flat
//! polygon round it is triangulated without it: the new triangles and the moved point are new tets, which it sees
//! because it lies on the inner side of their planes.
//!
//! Source: George, Borouchaki, Saltel 2003 and Si and Gärtner 2005 for points that leave the boundary again; the moves are ours.

use super::conform::TriangleId;
use super::solid::{Solid, unit_or_zero};
use hexfill_geometry::{Vector, cross, dot, sub};
use hexfill_mesh::{Context, StopReason, VertexId};

/// Least quality that a removal may leave, unless it was worse before.
pub(super) const FLOOR: f64 = 0.01;

/// Shares (see [`Solid::share`]) up to this are those of rounded points on one line.
const FLAT: f64 = 1e-9;

/// A polygon of the boundary, and the triangle of the surface that it is part of.
type Polygon = (Vec<VertexId>, TriangleId);

impl Solid {
    /// Takes every point that is not a vertex of the surface off the boundary.
    ///
    /// # Errors
    /// The number of points that could not be taken off, or the reason to stop.
    pub(super) fn clear_boundary(&mut self, ctx: &Context<'_>) -> Result<Result<(), usize>, StopReason> {
        let mut left: Vec<VertexId> = self.points.ids().skip(self.n_surface).rev().collect();
        left.retain(|&v| !self.faces_at[v].is_empty());
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
                // Last of all with no floor: a needle is better than a point of our own on a surface that is to stay
                // as it is.
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
    fn cycle(&self, v: VertexId) -> Option<Vec<(VertexId, TriangleId)>> {
        let mut steps: Vec<(VertexId, VertexId, TriangleId)> = Vec::new();
        for &f in &self.faces_at[v] {
            let ([a, b, c], tag) = self.faces[f];
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
        let mut distinct: Vec<VertexId> = cycle.iter().map(|c| c.0).collect();
        distinct.sort_unstable();
        distinct.dedup();
        (here == cycle[0].0 && distinct.len() == steps.len()).then_some(cycle)
    }

    /// The polygons round a boundary point without it, one for each triangle of the surface it belongs to.
    fn polygons(&self, v: VertexId) -> Option<Vec<Polygon>> {
        let mut cycle = self.cycle(v)?;
        let n = cycle.len();
        let changes: Vec<usize> = (0..n).filter(|&k| cycle[k].1 != cycle[(k + n - 1) % n].1).collect();
        match *changes.as_slice() {
            [] => Some(vec![(cycle.iter().map(|c| c.0).collect(), cycle[0].1)]),
            // On an edge of the surface: a polygon on either side, each with the two neighbours along the edge.
            [first, second] => {
                cycle.rotate_left(first);
                let k = second - first;
                let one = cycle[..=k].iter().map(|c| c.0).collect();
                let mut two: Vec<VertexId> = cycle[k..].iter().map(|c| c.0).collect();
                two.push(cycle[0].0);
                Some(vec![(one, cycle[0].1), (two, cycle[k].1)])
            }
            _ => None,
        }
    }

    /// Draws a boundary point onto a neighbour that lies on the same edge or in the same triangle.
    fn draw_along_boundary(&mut self, v: VertexId, floor: f64) -> bool {
        let Some(polygons) = self.polygons(v) else { return false };
        let floor = floor.min(self.least_now(v) / 2.0).max(0.0);
        let candidates: Vec<VertexId> = match polygons.as_slice() {
            [(all, _)] => all.clone(),
            [(one, _), _] => vec![one[0], one[one.len() - 1]],
            _ => return false,
        };
        let mut best: Option<(f64, VertexId)> = None;
        for u in candidates {
            // Boundary triangles must face as the surface does, or the boundary folds back in its plane and the tets
            // overlap though all are positive.
            let fits =
                polygons.iter().all(|(polygon, tag)| fan(polygon, u).iter().all(|t| self.share(*t, *tag) > FLAT));
            if !fits {
                continue;
            }
            if let Some(q) = self.least_drawn(best.map_or(floor, |b| b.0), v, u) {
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
    fn share(&self, face: [VertexId; 3], tag: TriangleId) -> f64 {
        let [a, b, c] = face.map(|v| self.at(v));
        let longest = [sub(a, b), sub(b, c), sub(c, a)].map(|d| dot(d, d)).into_iter().fold(0.0, f64::max);
        dot(cross(sub(b, a), sub(c, a)), self.normals[tag]) / longest
    }

    /// The triangulation of a flat polygon whose worst triangle is best, by dynamic programming (Klincsek 1980). All its
    /// triangles face outward, so it is one even if the polygon is not convex.
    fn cut(&self, polygon: &[VertexId], tag: TriangleId) -> Option<Vec<([VertexId; 3], TriangleId)>> {
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
                // Also bad parts are kept: whether the whole can be cut is asked once, at the end.
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
    fn move_inward(&mut self, v: VertexId) -> bool {
        let Some(polygons) = self.polygons(v) else { return false };
        let mut faces = Vec::new();
        let mut inward = [0.0; 3];
        for (polygon, tag) in &polygons {
            match self.cut(polygon, *tag) {
                Some(cut) => faces.extend(cut),
                None => return false,
            }
            inward = sub(inward, self.normals[*tag]);
        }
        // The new tets stand on the polygons that close the boundary below the point. Where it has to go to make all
        // of them positive depends on them: against the normals on a smooth part, towards its neighbours where the
        // boundary bends in.
        let mut tets = self.star(v);
        tets.extend(faces.iter().map(|([a, b, c], _)| [v, *a, *b, *c]));
        let mut trial = tets.clone();
        let neighbours = self.neighbours(v);
        let here = self.at(v);
        let mean: Vector =
            std::array::from_fn(|c| neighbours.iter().map(|&w| self.at(w)[c]).sum::<f64>() / neighbours.len() as f64);
        let reach = neighbours.iter().map(|&w| sub(self.at(w), here)).map(|d| dot(d, d)).fold(0.0, f64::max).sqrt();
        let mut best = (0.0, here, 0.0);
        for direction in [unit_or_zero(inward), unit_or_zero(sub(mean, here))] {
            let mut step = reach;
            // Every length is tried and not the first that works: the best of them is where the climb starts.
            for _ in 0..30 {
                let p = std::array::from_fn(|c| here[c] + step * direction[c]);
                if let Some(q) = self.least_above(best.0, &mut trial, v, p) {
                    best = (q, p, step);
                }
                step /= 2.0;
            }
        }
        if best.0 <= 0.0 {
            return false;
        }
        let p = self.climb(&mut trial, v, best);
        self.points[v] = p;
        self.replace_tets(v, &tets);
        self.replace_faces(v, &faces);
        true
    }
}

/// A polygon cut into triangles from its corner `u`.
fn fan(polygon: &[VertexId], u: VertexId) -> Vec<[VertexId; 3]> {
    let n = polygon.len();
    let sides = (0..n).map(|k| [polygon[k], polygon[(k + 1) % n]]);
    sides.filter(|s| !s.contains(&u)).map(|[x, y]| [u, x, y]).collect()
}
