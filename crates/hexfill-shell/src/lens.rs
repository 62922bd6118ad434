//! Lenses of the front's dual: disks bounded by two arcs of chords between two crossings.
//!
//! A crossing of the dual is a front quad, a face is a front vertex. A lens is found from one of its two corners: the corner of a quad, given by
//! the dart d from the vertex v inside. The arcs leave the quad across the two edges at v; they are followed until one meets the other in a quad where
//! they close round a corner again. The vertices inside are those reached from v without crossing an arc; they are a disk iff their curvatures
//! 4 - degree sum to 2 (discrete Gauss-Bonnet with two corners).
//!
//! In a *minimal* lens (no lens inside) every other chord runs from one arc to the other, so that the faces along an arc are distinct and neither
//! arc is longer than the number of vertices inside. Hence looking `limit` quads far from every corner finds every minimal lens of at most
//! `limit` vertices. Minimal lenses have a triangle at an arc (Steinitz' lemma; Chang, Erickson, "Untangling planar curves", 2017).
//!
//! Source: Chang, Erickson 2017 (minimal bigons and Steinitz' lemma on their triangles); the bound on where to look is ours.

use crate::dart::{next, opposite, prev};
use crate::front::Front;

/// Marks that are wiped by taking the next stamp.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stamps {
    marks: Vec<(u32, u32)>,
    stamp: u32,
}

impl Stamps {
    /// Wipes all marks and makes room for `n` places.
    pub(crate) fn clear(&mut self, n: usize) {
        if self.stamp == u32::MAX {
            self.marks.fill((0, 0));
            self.stamp = 0;
        }
        self.stamp += 1;
        if self.marks.len() < n {
            self.marks.resize(n, (0, 0));
        }
    }

    /// The value at a place, if it is marked.
    #[inline]
    pub(crate) fn get(&self, i: u32) -> Option<u32> {
        let (stamp, value) = self.marks[i as usize];
        (stamp == self.stamp).then_some(value)
    }

    /// Whether a place is marked.
    #[inline]
    pub(crate) fn is_set(&self, i: u32) -> bool {
        self.marks[i as usize].0 == self.stamp
    }

    /// Takes one mark away.
    #[inline]
    pub(crate) fn unset(&mut self, i: u32) {
        self.marks[i as usize].0 = 0;
    }

    /// Marks a place.
    #[inline]
    pub(crate) fn set(&mut self, i: u32, value: u32) {
        self.marks[i as usize] = (self.stamp, value);
    }
}

/// Finds lenses; holds the marks it needs.
#[derive(Clone, Debug, Default)]
pub(crate) struct LensFinder {
    /// Per quad: its number on the first arc, from 1; 0 for the quad of the corner.
    first: Stamps,
    /// Per quad: passed by the second arc.
    second: Stamps,
    /// Per dart: crossed by an arc.
    wall: Stamps,
    /// Per vertex: inside.
    inside: Stamps,
    /// The entering darts of both arcs.
    arcs: [Vec<u32>; 2],
    best: Vec<u32>,
    found: Vec<u32>,
}

impl LensFinder {
    /// The smallest lens at the corner of dart `d` with at most `limit` vertices inside and arcs of at most `limit` steps: its inner vertices.
    pub(crate) fn find(&mut self, front: &Front, d: u32, limit: usize) -> Option<&[u32]> {
        let n_slots = front.n_slots() as usize;
        self.first.clear(n_slots);
        self.second.clear(n_slots);
        let home = d / 4;
        self.first.set(home, 0);
        self.second.set(home, 0);
        self.arcs.iter_mut().for_each(Vec::clear);
        // The inner vertex is the target of the first arc's entering darts and the origin of the second's.
        let mut at = front.twin(d);
        for i in 1..=limit as u32 {
            // An arc that meets itself bounds no lens beyond this quad: chords of a lens are simple arcs.
            if self.first.is_set(at / 4) {
                break;
            }
            self.first.set(at / 4, i);
            self.arcs[0].push(at);
            at = front.twin(opposite(at));
        }
        let (mut nearest, mut most) = (u32::MAX, limit);
        self.best.clear();
        at = front.twin(prev(d));
        for j in 1..=limit {
            if self.second.is_set(at / 4) {
                break;
            }
            self.second.set(at / 4, 0);
            self.arcs[1].push(at);
            // Only ever nearer on the first arc: a crossing farther out on both arcs bounds a lens that holds the one
            // before, or none.
            if let Some(i) = self.first.get(at / 4).filter(|&i| i < nearest) {
                nearest = i;
                // Either they close round a corner on the same side, which is a lens, or they cross and go on.
                let meets = next(self.arcs[0][i as usize - 1]) == at;
                if meets && self.flood(front, d, i as usize, j, most) {
                    std::mem::swap(&mut self.best, &mut self.found);
                    if self.best.len() == 1 {
                        break;
                    }
                    most = self.best.len() - 1;
                }
                if nearest == 1 {
                    break;
                }
            }
            at = front.twin(opposite(at));
        }
        (!self.best.is_empty()).then_some(&self.best)
    }

    /// Collects the vertices inside the first `i` and `j` steps of the arcs; whether they are a disk of at most `limit` vertices.
    fn flood(&mut self, front: &Front, d: u32, i: usize, j: usize, limit: usize) -> bool {
        // Marks with a time stamp: to clear them is to raise it, so a small lens costs its size and not that of the
        // front.
        self.wall.clear(4 * front.n_slots() as usize);
        for &e in self.arcs[0][..i].iter().chain(&self.arcs[1][..j]) {
            self.wall.set(e, 0);
            self.wall.set(front.twin(e), 0);
        }
        self.inside.clear(front.n_vertices() as usize);
        self.found.clear();
        let v = front.origin(d);
        self.inside.set(v, 0);
        self.found.push(v);
        let mut curvature = 0;
        let mut done = 0;
        while done < self.found.len() {
            let v = self.found[done];
            done += 1;
            curvature += 4 - front.degree(v) as i64;
            for e in front.round_vertex(front.dart_of(v)) {
                let to = front.target(e);
                if !self.wall.is_set(e) && !self.inside.is_set(to) {
                    if self.found.len() == limit {
                        return false;
                    }
                    self.inside.set(to, 0);
                    self.found.push(to);
                }
            }
        }
        // Connected by the flood and bounded by two arcs: it is a disk iff the curvature says so. A handle or a hole
        // inside would lower the sum.
        curvature == 2
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::generate::{cube_surface, voxel_surface};

    fn smallest(front: &Front, limit: usize) -> Vec<usize> {
        let mut finder = LensFinder::default();
        let darts = front.slots().flat_map(|q| 4 * q..4 * q + 4);
        let mut sizes: Vec<usize> = darts.filter_map(|d| finder.find(front, d, limit).map(<[u32]>::len)).collect();
        sizes.sort_unstable();
        sizes
    }

    #[test]
    fn lenses_of_boxes_are_their_edges() {
        let cube = Front::new(&cube_surface()).unwrap();
        // Each of the 12 edges is a lens of two vertices with two corners.
        assert_eq!(smallest(&cube, 8), [2; 24]);
        for n in 2..6 {
            let front = Front::new(&voxel_surface([n, n, n], |_| true).unwrap()).unwrap();
            assert_eq!(smallest(&front, n), Vec::<usize>::new());
            assert_eq!(smallest(&front, n + 1), vec![n + 1; 24]);
        }
    }
}
