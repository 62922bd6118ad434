//! [`waists`]: where a body is narrow.
//!
//! A closed circuit of edges that separates some quads from others is a cut of the dual graph, and the shortest one is a minimal cut, whose length is the
//! largest flow between the two (Ford, Fulkerson 1956). So the narrowest place between a tip and what is far from it costs one flow.
//!
//! Source: Ford, Fulkerson 1956 (minimal cuts); which quads are held apart, and the rank by length and area, are ours.

use hexfill_geometry::{Vector, cross, norm, sub};
use hexfill_mesh::{Dart, QuadId, QuadSurface};
use std::collections::VecDeque;

/// Tips looked at, each as far as can be from those before.
const TIPS: usize = 10;
/// Shares of the quads that are kept with the tip, one after the other, and the share that is kept apart from it.
const NEAR: [usize; 4] = [32, 16, 8, 4];
const FAR: usize = 4;
/// Fewer quads are no piece.
const FEWEST: usize = 60;
/// A waist is worth a cut if its length is at most so many times the root of the smaller area it cuts off: half of a rod four times as long as wide has
/// 1.4, half of a cube 2.3, a hemisphere 2.5.
const NARROW: f64 = 2.7;

/// A circuit that cuts a sphere in two.
#[derive(Clone, Debug)]
pub(crate) struct Waist {
    /// Its vertices in order, with `near` on its left seen from outside.
    pub(crate) circuit: Vec<u32>,
    /// Per quad whether it lies on that side.
    pub(crate) near: Vec<bool>,
    /// Length by root of the smaller area.
    pub(crate) narrowness: f64,
}

/// The waists of a sphere whose vertices are at `points`, the narrowest first, each once.
pub(crate) fn waists(surface: &QuadSurface, points: &[Vector]) -> Vec<Waist> {
    let n = surface.n_quads();
    let mut waists: Vec<Waist> = Vec::new();
    for tip in tips(surface) {
        let order = outward(surface, &[tip]);
        let far = &order[n - n / FAR..];
        for near in NEAR.map(|share| n / share).into_iter().filter(|near| *near > 0) {
            let Some(side) = Flow::new(surface, points).cut(&order[..near], far) else { continue };
            waists.extend(Waist::of(surface, points, side).filter(|w| w.narrowness <= NARROW));
        }
    }
    // Stable: among equals the first.
    waists.sort_by(|a, b| a.narrowness.total_cmp(&b.narrowness));
    waists.dedup_by(|a, b| a.near == b.near);
    waists
}

/// Quads that stick out: each as far as can be from those before.
fn tips(surface: &QuadSurface) -> Vec<usize> {
    let mut tips: Vec<usize> = outward(surface, &[0]).last().copied().into_iter().collect();
    while tips.len() < TIPS {
        tips.extend(outward(surface, &tips).last());
    }
    tips
}

/// The quads across the sides of one, with the darts that lead there.
fn across(surface: &QuadSurface, quad: usize) -> impl Iterator<Item = (Dart, usize)> + '_ {
    (0..4).map(move |side| Dart::new(QuadId::new(quad), side)).map(|d| (d, surface.twin(d).quad().index()))
}

/// All quads, the nearest to the given ones first.
fn outward(surface: &QuadSurface, from: &[usize]) -> Vec<usize> {
    let mut seen = vec![false; surface.n_quads()];
    let mut order = from.to_vec();
    from.iter().for_each(|&q| seen[q] = true);
    let mut at = 0;
    while at < order.len() {
        for (_, next) in across(surface, order[at]) {
            if !std::mem::replace(&mut seen[next], true) {
                order.push(next);
            }
        }
        at += 1;
    }
    order
}

/// A flow over the edges of a surface, each of which lets through its length.
struct Flow<'a> {
    surface: &'a QuadSurface,
    /// Per dart what may still go from its quad to the one across.
    room: Vec<f64>,
    least: f64,
}

impl<'a> Flow<'a> {
    fn new(surface: &'a QuadSurface, points: &[Vector]) -> Self {
        let at = |d: Dart| [surface.origin(d), surface.target(d)].map(|v| points[v.index()]);
        let room: Vec<f64> = surface.darts().map(at).map(|[p, q]| norm(sub(p, q))).collect();
        let least = 1e-9 * room.iter().fold(0.0, |a: f64, &b| a.max(b));
        Self { surface, room, least }
    }

    /// The quads that a shortest cut leaves with `from`, none of `to` among them; the others are connected. `None` if the two meet.
    fn cut(mut self, from: &[usize], to: &[usize]) -> Option<Vec<bool>> {
        let mut is_to = vec![false; self.surface.n_quads()];
        to.iter().for_each(|&q| is_to[q] = true);
        if from.iter().any(|&q| is_to[q]) {
            return None;
        }
        loop {
            let (came, end) = self.spread(from, &is_to);
            let Some(end) = end else {
                return Some(self.without_islands(&came, to));
            };
            let back = |q: usize| came[q].filter(|d| d.is_some());
            let way: Vec<Dart> = std::iter::successors(back(end), |d| back(d.quad().index())).collect();
            let most = way.iter().map(|d| self.room[d.index()]).fold(f64::INFINITY, f64::min);
            for d in way {
                self.room[d.index()] -= most;
                self.room[self.surface.twin(d).index()] += most;
            }
        }
    }

    /// Goes on from some quads wherever there is room: per quad reached the dart it was reached by ([`Dart::NONE`] for the first), and the first quad of
    /// the other end, if one was reached.
    fn spread(&self, from: &[usize], is_to: &[bool]) -> (Vec<Option<Dart>>, Option<usize>) {
        let mut came = vec![None; self.surface.n_quads()];
        from.iter().for_each(|&q| came[q] = Some(Dart::NONE));
        let mut queue: VecDeque<usize> = from.iter().copied().collect();
        while let Some(quad) = queue.pop_front() {
            for (d, next) in across(self.surface, quad) {
                if came[next].is_none() && self.room[d.index()] > self.least {
                    came[next] = Some(d);
                    if is_to[next] {
                        return (came, Some(next));
                    }
                    queue.push_back(next);
                }
            }
        }
        (came, None)
    }

    /// What was reached, and what it shuts off from the other end.
    fn without_islands(&self, came: &[Option<Dart>], to: &[usize]) -> Vec<bool> {
        let mut near = vec![true; came.len()];
        let mut stack = to.to_vec();
        to.iter().for_each(|&q| near[q] = false);
        while let Some(quad) = stack.pop() {
            for (_, next) in across(self.surface, quad) {
                if came[next].is_none() && std::mem::replace(&mut near[next], false) {
                    stack.push(next);
                }
            }
        }
        near
    }
}

impl Waist {
    /// The border of some quads, if it is one circuit that meets no vertex twice and both sides are large enough.
    fn of(surface: &QuadSurface, points: &[Vector], near: Vec<bool>) -> Option<Self> {
        let n_near = near.iter().filter(|near| **near).count();
        if n_near.min(near.len() - n_near) < FEWEST {
            return None;
        }
        let is_near = |d: Dart| near[d.quad().index()];
        let border: Vec<Dart> = surface.darts().filter(|&d| is_near(d) && !is_near(surface.twin(d))).collect();
        let mut next = vec![u32::MAX; surface.n_vertices()];
        for &d in &border {
            // A second way on: the border is pinched.
            if std::mem::replace(&mut next[surface.origin(d).index()], surface.target(d).0) != u32::MAX {
                return None;
            }
        }
        let first = surface.origin(*border.first()?).0;
        let on = |&v: &u32| Some(next[v as usize]).filter(|&v| v != first);
        let circuit: Vec<u32> = std::iter::successors(Some(first), on).take(border.len()).collect();
        let length: f64 = border
            .iter()
            .map(|&d| norm(sub(points[surface.origin(d).index()], points[surface.target(d).index()])))
            .sum();
        let area = |side: bool| -> f64 {
            let quads = surface.quads().iter().zip(&near).filter(|(_, near)| **near == side);
            quads.map(|(q, _)| area(q.map(|v| points[v.index()]))).sum()
        };
        let narrowness = length / area(true).min(area(false)).sqrt();
        (circuit.len() == border.len()).then_some(Self { circuit, near, narrowness })
    }
}

/// The area of a quad, as if it were flat.
fn area([a, b, c, d]: [Vector; 4]) -> f64 {
    0.5 * norm(cross(sub(c, a), sub(d, b)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::generate::voxels;

    #[test]
    fn the_narrowest_waist_of_two_blocks_is_their_bar() {
        let is_in = |[x, y, z]: [usize; 3]| !(7..11).contains(&x) || (2..5).contains(&y) && (2..5).contains(&z);
        let (surface, points) = voxels([18, 7, 7], is_in).unwrap();
        let points: Vec<Vector> = points.into_iter().map(|p| p.map(f64::from)).collect();
        let waists = waists(&surface, &points);
        let Waist { circuit, near, narrowness } = &waists[0];
        // Round the bar in one plane, and what is near is to the left: seen from outside the quads there have these edges as they are.
        let x = points[circuit[0] as usize][0];
        assert!(circuit.len() == 12 && (7.0..=11.0).contains(&x));
        assert!(circuit.iter().all(|&v| points[v as usize][0] == x));
        let has = |q: &[u32; 4], a, b| (0..4).any(|i| q[i] == a && q[(i + 1) % 4] == b);
        let quads = surface.quads_raw();
        for (i, &a) in circuit.iter().enumerate() {
            let left = quads.iter().position(|q| has(q, a, circuit[(i + 1) % 12])).unwrap();
            assert!(near[left]);
        }
        // At one end of the bar a block has 294 - 9 quads, and some of the bar.
        assert!(*narrowness <= 12.0 / 285f64.sqrt() && *narrowness > 12.0 / 330f64.sqrt());
    }
}
