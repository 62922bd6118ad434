//! Flips: the tets round an inner edge, or the two at an inner face, are replaced if their worst one gets better.
//!
//! Rounded points that lie almost on a circle or in a plane make tets with hardly any volume (a Delaunay tetrahedralisation
//! takes them as they come), and such tets bar every move of their corners. Removing an edge (Freitag and Ollivier-Gooch 1997)
//! tries all triangulations of the ring of vertices round it, by dynamic programming (Klincsek 1980). No flip touches the boundary.
//!
//! Source: Freitag and Ollivier-Gooch 1997 (removing edges), Klincsek 1980 (the best triangulation of a ring).

use super::solid::{FLOOR_INSIDE, Solid};
use crate::core::complex::{OUTWARD, TET_EDGES};
use crate::ids::TetId;
use hexfill_geometry::{Vector, cross, dot, midpoint, norm, sub};
use hexfill_mesh::{Context, StopReason, VertexId};

/// Tets of less quality are worked on.
const GOOD: f64 = 0.15;

/// Tets of less quality are worth a new point.
const FLAT: f64 = 1e-4;

/// Longest ring that is triangulated anew.
const RING: usize = 10;

/// Most passes over the bad tets.
const PASSES: usize = 4;

/// Tets to take out, and those that fill the same place.
type Exchange = (Vec<TetId>, Vec<[VertexId; 4]>);

/// An edge and the vertices round it, in order.
struct Ring {
    ends: [VertexId; 2],
    vertices: Vec<VertexId>,
}

impl Ring {
    /// The tets of both ends on a triangle of the ring.
    fn both(&self, i: usize, j: usize, k: usize) -> [[VertexId; 4]; 2] {
        let ([a, b], [x, y, z]) = (self.ends, [i, j, k].map(|i| self.vertices[i]));
        [[a, x, y, z], [b, x, z, y]]
    }
}

impl Solid {
    /// Flips and moves until no bad tet gets better that way.
    pub(super) fn improve(&mut self, ctx: &Context<'_>) -> Result<(), StopReason> {
        for _ in 0..PASSES {
            let mut bad: Vec<(f64, TetId)> = Vec::new();
            for (t, &tet) in self.tets.enumerate().filter(|(_, tet)| tet[0].is_some()) {
                let q = self.quality(tet);
                if q < GOOD {
                    bad.push((q, t));
                }
            }
            bad.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let mut done = 0;
            for (_, t) in bad {
                if let Some(reason) = ctx.stop() {
                    return Err(reason);
                }
                if self.tets[t][0].is_some() && self.improve_tet(t) {
                    done += 1;
                }
            }
            if done == 0 {
                break;
            }
        }
        Ok(())
    }

    /// The best flip of an edge or a face of a tet, else a move of one of its inner points.
    fn improve_tet(&mut self, t: TetId) -> bool {
        let tet = self.tets[t];
        let mut best: Option<(f64, Exchange)> = None;
        // Nothing that is no better than what is there, or than the best flip so far, is worth looking at to its end.
        let bound = |old: &[TetId], best: &Option<(f64, Exchange)>| {
            (self.least_of(old) * 1.0001).max(best.as_ref().map_or(0.0, |b| b.0))
        };
        // The union of the tets round an inner edge is a ball whose surface does not change: any positive
        // triangulation of the ring with both ends fills the same place.
        for (old, ring) in TET_EDGES.iter().filter_map(|&[i, j]| self.ring(tet[i], tet[j])) {
            if let Some((after, new)) = self.triangulate(&ring, bound(&old, &best)) {
                best = Some((after, (old, new)));
            }
        }
        for (old, new) in (0..4).filter_map(|i| self.without_face(t, i)) {
            let after = new.iter().map(|&u| self.quality(u)).fold(f64::INFINITY, f64::min);
            if after > bound(&old, &best) {
                best = Some((after, (old, new)));
            }
        }
        if let Some((_, (old, new))) = best {
            self.replace(&old, &new);
            return true;
        }
        let before = self.quality(tet);
        if before > FLOOR_INSIDE {
            return false;
        }
        for v in tet {
            if v.index() >= self.n_surface && self.faces_at[v].is_empty() {
                self.smooth(v);
            }
        }
        self.quality(tet) > before * 1.01
    }

    fn least_of(&self, tets: &[TetId]) -> f64 {
        tets.iter().map(|&u| self.quality(self.tets[u])).fold(f64::INFINITY, f64::min)
    }

    /// Removes edges of three tets where the two that take their place are good enough: one tet less each.
    pub(super) fn save_tets(&mut self) {
        // Tets that come of this are looked at next time.
        for t in self.tets.ids() {
            let tet = self.tets[t];
            if tet[0].is_none() {
                continue;
            }
            for [i, j] in TET_EDGES {
                let Some((old, ring)) = self.ring(tet[i], tet[j]).filter(|(old, _)| old.len() == 3) else { continue };
                let Some((after, new)) = self.triangulate(&ring, 0.0) else { continue };
                if after >= self.least_of(&old).min(5.0 * FLOOR_INSIDE) {
                    self.replace(&old, &new);
                    break;
                }
            }
        }
    }

    /// Last resort against flat tets: splits an inner edge of each and moves the new point to where they get volume.
    pub(super) fn split_flat(&mut self, ctx: &Context<'_>) -> Result<(), StopReason> {
        let is_flat = |solid: &Self, t: TetId| solid.tets[t][0].is_some() && solid.quality(solid.tets[t]) < FLAT;
        let flat: Vec<TetId> = self.tets.ids().filter(|&t| is_flat(self, t)).collect();
        let any = !flat.is_empty();
        for t in flat {
            if let Some(reason) = ctx.stop() {
                return Err(reason);
            }
            // One split may have mended its neighbour.
            if is_flat(self, t) {
                self.split_edge_of(t);
            }
        }
        if any { self.improve(ctx) } else { Ok(()) }
    }

    fn split_edge_of(&mut self, t: TetId) {
        let tet = self.tets[t];
        let v = self.points.next_id();
        let mut best: Option<(f64, Vector, Exchange)> = None;
        // A flat tet that no exchange of tets mends has corners near a plane that cannot all be moved. A point on one
        // of its inner edges, pushed out of the plane, opens it; edges of the boundary are not to be touched.
        for [i, j] in TET_EDGES {
            let (a, b) = (tet[i], tet[j]);
            if self.faces_at[a].iter().any(|&f| self.faces[f].0.contains(&b)) {
                continue;
            }
            let old: Vec<TetId> = self.tets_at[a].iter().copied().filter(|&u| self.tets[u].contains(&b)).collect();
            let with = |end: VertexId| old.iter().map(move |&u| (u, end));
            let new: Vec<[VertexId; 4]> =
                with(a).chain(with(b)).map(|(u, end)| self.tets[u].map(|w| if w == end { v } else { w })).collect();
            let (p, q) = (self.points[a], self.points[b]);
            let middle = midpoint(p, q);
            let [x, y, z] = [0, 1, 2].map(|k| self.points[tet[k + 1]]);
            let normals = OUTWARD.map(|f| {
                let [x, y, z] = f.map(|k| self.points[tet[k]]);
                cross(sub(y, x), sub(z, x))
            });
            let reach = [sub(p, q), sub(x, y), sub(y, z)].map(|d| dot(d, d)).into_iter().fold(0.0, f64::max).sqrt();
            let mut trial = new.clone();
            // From far to near, since with points near a plane the room is a thin cone whose width nobody knows.
            let mut found = (0.0, middle, 0.0);
            for normal in normals {
                let length = norm(normal);
                let mut step = reach;
                for _ in 0..20 {
                    let at = std::array::from_fn(|c| middle[c] - step * normal[c] / length);
                    if let Some(here) = self.least_above(found.0, &mut trial, v, at) {
                        found = (here, at, step);
                    }
                    step /= 2.0;
                }
            }
            if found.0 > 0.0 {
                let at = self.climb(&mut trial, v, found);
                let bound = best.as_ref().map_or(f64::NEG_INFINITY, |b| b.0);
                if let Some(here) = self.least_above(bound, &mut trial, v, at) {
                    best = Some((here, at, (old, new)));
                }
            }
        }
        let Some((worst, at, (old, new))) = best else { return };
        // A point more is a cost of its own, in hexes; it has to pay.
        if worst > 2.0 * self.quality(tet) {
            self.points.push(at);
            self.tets_at.push(Vec::new());
            self.faces_at.push(Vec::new());
            self.replace(&old, &new);
        }
    }

    fn replace(&mut self, old: &[TetId], new: &[[VertexId; 4]]) {
        for &t in old {
            for v in std::mem::replace(&mut self.tets[t], [VertexId::NONE; 4]) {
                self.tets_at[v].retain(|&u| u != t);
            }
        }
        for &tet in new {
            let t = self.tets.push(tet);
            tet.iter().for_each(|&v| self.tets_at[v].push(t));
        }
    }

    /// The tets round an inner edge, and the edge with the ring of vertices round it. `None` if the edge is on the boundary or has
    /// too many tets.
    fn ring(&self, a: VertexId, b: VertexId) -> Option<(Vec<TetId>, Ring)> {
        let old: Vec<TetId> = self.tets_at[a].iter().copied().filter(|&t| self.tets[t].contains(&b)).collect();
        if old.len() > RING || old.len() < 3 {
            return None;
        }
        // The other two corners of each, so that a, b and they are positive.
        let mut steps: Vec<[VertexId; 2]> = Vec::with_capacity(old.len());
        for &t in &old {
            let tet = self.tets[t];
            let i = tet.iter().position(|&v| v == a)?;
            let [x, y, z] = OUTWARD[i].map(|k| tet[k]);
            steps.push(if x == b {
                [y, z]
            } else if y == b {
                [z, x]
            } else {
                [x, y]
            });
        }
        let mut ring = vec![steps[0][0]];
        let mut here = steps[0][1];
        while here != ring[0] {
            ring.push(here);
            // No next one: the edge is on the boundary.
            here = steps.iter().find(|s| s[0] == here)?[1];
            if ring.len() > old.len() {
                return None;
            }
        }
        (ring.len() == old.len()).then_some((old, Ring { ends: [a, b], vertices: ring }))
    }

    /// The tets that fill the place of a ring without its edge: two on every triangle of the triangulation of the ring whose worst
    /// tet is best, if that is better than `bound` (at least 0).
    fn triangulate(&self, ring: &Ring, bound: f64) -> Option<(f64, Vec<[VertexId; 4]>)> {
        let n = ring.vertices.len();
        // Entry i n + j: the ring from i to j closed by the edge i j, its worst tet and where the triangle at that edge ends.
        let mut best = vec![(f64::INFINITY, 0); n * n];
        for width in 2..n {
            for i in 0..n - width {
                let j = i + width;
                // No triangulation is better than the bound with a part that is not.
                let mut found = (bound, 0);
                for k in i + 1..j {
                    let parts = best[i * n + k].0.min(best[k * n + j].0);
                    if parts <= found.0 {
                        continue;
                    }
                    // Above and below the triangle one tet each, to the two ends of the edge that goes.
                    let [p, q] = ring.both(i, k, j).map(|t| self.quality(t));
                    let worst = p.min(q).min(parts);
                    if worst > found.0 {
                        found = (worst, k);
                    }
                }
                best[i * n + j] = found;
            }
        }
        let after = best[n - 1].0;
        if after <= bound {
            return None;
        }
        let mut new = Vec::with_capacity(2 * n - 4);
        let mut stack = vec![(0, n - 1)];
        while let Some((i, j)) = stack.pop() {
            if j - i >= 2 {
                let k = best[i * n + j].1;
                new.extend(ring.both(i, k, j));
                stack.extend([(i, k), (k, j)]);
            }
        }
        Some((after, new))
    }

    /// The two tets at an inner face, and the three round the edge between their far corners.
    fn without_face(&self, t: TetId, i: usize) -> Option<Exchange> {
        let tet = self.tets[t];
        let [x, y, z] = OUTWARD[i].map(|k| tet[k]);
        let beside = self.tets_at[x].iter().copied().find(|&u| {
            let other = self.tets[u];
            u != t && other.contains(&y) && other.contains(&z)
        })?;
        let p = tet[i];
        let q = self.tets[beside].into_iter().find(|v| ![x, y, z].contains(v))?;
        Some((vec![t, beside], vec![[p, x, y, q], [p, y, z, q], [p, z, x, q]]))
    }
}
