//! Points inside, so that tets grow gently from the surface inward.
//!
//! A Delaunay tetrahedralisation of the surface's vertices alone has needles that reach across a thick solid, and the hexes of a
//! needle are as thin. Delaunay refinement (Chew 1989, Ruppert 1995, Shewchuk 1998) puts a point into the centre of the
//! circumsphere of each tet whose radius is long beside its shortest edge, or nearer to that edge. A point is passed over if it lies outside, or so
//! near to the surface that a face of the surface would go, or lies in its smallest ball: no point is added to the boundary here.
//! Most of the points are removed again later, as far as that leaves tets that are good enough (`removal.rs`).
//!
//! Source: Shewchuk 1998; Chew 1989, Ruppert 1995; Üngör 2004 (points off the centre).

use super::conform::{Conforming, Failure, Origin};
use crate::core::complex::{OUTWARD, TET_EDGES};
use crate::ids::TetId;
use hexfill_geometry::{Vector, cross, dot, sub};
use hexfill_mesh::{Context, VertexId};
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Circumradius by shortest edge that a tet may have.
const RATIO: f64 = 2.0;

/// How far from the shortest edge, in units of it, a point is added at most (off-centres, Üngör 2004).
const REACH: f64 = 2.0;

/// A tet with its ratio; the largest ratio is the greatest, ties by vertices.
#[derive(PartialEq)]
struct Entry {
    ratio: f64,
    tet: [VertexId; 4],
    place: TetId,
}

impl Eq for Entry {}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> Ordering {
        self.ratio.total_cmp(&other.ratio).then(self.tet.cmp(&other.tet))
    }
}

/// The centre of the circumsphere and the square of its radius.
fn circumsphere([a, b, c, d]: [Vector; 4]) -> (Vector, f64) {
    let (u, v, w) = (sub(b, a), sub(c, a), sub(d, a));
    let (uu, vv, ww) = (dot(u, u), dot(v, v), dot(w, w));
    let (vw, wu, uv) = (cross(v, w), cross(w, u), cross(u, v));
    let twice = 2.0 * dot(u, vw);
    let from_a: Vector = std::array::from_fn(|k| (uu * vw[k] + vv * wu[k] + ww * uv[k]) / twice);
    (std::array::from_fn(|k| a[k] + from_a[k]), dot(from_a, from_a))
}

/// The centre of the circumsphere, or a point on the way there from the middle of the shortest edge: a centre may lie far off.
fn near_shortest_edge(points: [Vector; 4]) -> Vector {
    let (centre, _) = circumsphere(points);
    let square = |[i, j]: [usize; 2]| {
        let d = sub(points[i], points[j]);
        dot(d, d)
    };
    let [i, j] = TET_EDGES.into_iter().fold(TET_EDGES[0], |a, b| if square(b) < square(a) { b } else { a });
    let middle: Vector = std::array::from_fn(|k| 0.5 * (points[i][k] + points[j][k]));
    let way = sub(centre, middle);
    let share = REACH * (square([i, j]) / dot(way, way)).sqrt();
    if share < 1.0 { std::array::from_fn(|k| middle[k] + share * way[k]) } else { centre }
}

/// Whether `p` lies in the smallest ball that has the three points on its sphere.
fn is_in_ball([a, b, c]: [Vector; 3], p: Vector) -> bool {
    let (u, v) = (sub(b, a), sub(c, a));
    let n = cross(u, v);
    let (from_u, from_v) = (cross(v, n), cross(n, u));
    let twice = 2.0 * dot(n, n);
    let (uu, vv) = (dot(u, u), dot(v, v));
    let centre: Vector = std::array::from_fn(|k| (uu * from_u[k] + vv * from_v[k]) / twice);
    let (r, q) = (centre, sub(sub(p, a), centre));
    dot(q, q) < dot(r, r)
}

impl Conforming<'_> {
    /// Adds points inside until no circumradius exceeds [`RATIO`] times the shortest edge of its tet, where that can be done
    /// without touching the surface, which must be complete.
    ///
    /// # Errors
    /// As [`inside`](Self::inside), or the reason to stop. A spent budget is no error.
    pub(super) fn grade(&mut self, ctx: &Context<'_>) -> Result<(), Failure> {
        let mut kept = self.kept()?;
        let mut heap = BinaryHeap::new();
        for (t, _) in kept.enumerate().filter(|(_, kept)| **kept) {
            heap.extend(self.entry(t));
        }
        let (mut added, mut passed) = (0u64, 0u64);
        while let Some(Entry { tet, place, .. }) = heap.pop() {
            // Entries are not taken out when a tet goes: its place may hold another one by now.
            if self.dt.tets[place] != tet {
                continue;
            }
            if (added + passed).is_multiple_of(256)
                && let Some(reason) = ctx.stop()
            {
                return Err(Failure::Stopped(reason));
            }
            if self.budget == 0 {
                break;
            }
            let centre = near_shortest_edge(tet.map(|v| self.at(v)));
            if !centre.iter().all(|x| x.is_finite()) {
                continue;
            }
            let from = self.dt.locate(centre, place);
            // Ruppert's remedy would be to split the face in the way. Not here: points on the boundary have to be
            // taken off again, and that is the dear part.
            if !kept[from] || !self.leaves_surface(centre, from) {
                passed += 1;
                continue;
            }
            let Ok(v) = self.dt.add(centre, tet[0]) else { continue };
            self.origin.push(Origin::Inside);
            self.budget -= 1;
            added += 1;
            kept.resize(self.dt.tets.len(), false);
            // The hole did not pass a face of the surface, so all that fills it is inside as the tets before were.
            for t in self.dt.star(v) {
                kept[t] = true;
                heap.extend(self.entry(t));
            }
        }
        ctx.report("grade", added, None, || format!("{added} points inside, {passed} too near to the surface"));
        Ok(())
    }

    fn entry(&self, place: TetId) -> Option<Entry> {
        let tet = self.dt.tets[place];
        let points = tet.map(|v| self.at(v));
        let (_, square) = circumsphere(points);
        let shortest = TET_EDGES.iter().map(|&[i, j]| {
            let d = sub(points[i], points[j]);
            dot(d, d)
        });
        let size = shortest.fold(f64::INFINITY, f64::min);
        let ratio = (square / size).sqrt();
        (ratio > RATIO && ratio.is_finite()).then_some(Entry { ratio, tet, place })
    }

    /// Whether a point in tet `from` can be inserted so that all faces of the surface stay, and lies in the ball of none near by.
    fn leaves_surface(&mut self, p: Vector, from: TetId) -> bool {
        let mut hole = vec![from];
        let stamp = self.dt.new_stamp(from);
        let mut next = 0;
        // As the hole of an insertion, but the first face of the surface in the way ends it.
        while next < hole.len() {
            let t = hole[next];
            next += 1;
            for (i, face) in OUTWARD.iter().enumerate() {
                let face = face.map(|k| self.dt.tets[t][k]);
                let other = self.dt.around[t][i];
                let is_new = other.is_some() && self.dt.mark[other] != stamp;
                let joins = is_new && self.dt.is_in_sphere(other, p);
                if self.common(face).is_some() {
                    if joins || other.is_some() && !is_new || is_in_ball(face.map(|v| self.at(v)), p) {
                        return false;
                    }
                } else if joins {
                    self.dt.mark[other] = stamp;
                    hole.push(other);
                }
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spheres_and_balls() {
        let s = 0.5f64.sqrt();
        let (centre, square) = circumsphere([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        assert!(centre.iter().all(|x| (x - 0.5).abs() < 1e-15) && (square - 0.75).abs() < 1e-15);
        let face = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]];
        assert!(is_in_ball(face, [s, -s + 0.01, 0.0]) && is_in_ball(face, [0.0, 0.0, 0.99]));
        assert!(!is_in_ball(face, [s, -s - 0.01, 0.0]) && !is_in_ball(face, [0.0, 0.0, 1.01]));
    }
}
