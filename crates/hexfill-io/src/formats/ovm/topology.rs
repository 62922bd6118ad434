//! Edges and faces of a mesh to write, each found again by its vertices.
//!
//! A facet of a cell has three or four sides, so a face is kept as four half-edges and known by four vertices, sorted as far as
//! its cycle allows. Two tables of numbers find edges and faces again; keys are not kept.

use rustc_hash::FxHasher;
use std::hash::Hasher;

/// Fills the fourth place of a triangle, and all places of a face with more than four sides.
const NONE: u32 = u32::MAX;

/// Edges and faces in the order of their first use, fewer than 2^31 of each.
#[derive(Default)]
pub(super) struct Topology {
    /// The ends of each edge as it was first used.
    pub(super) edges: Vec<[u32; 2]>,
    edge_table: Table,
    /// The half-edges of each face of three or four sides.
    faces: Vec<[u32; 4]>,
    face_table: Table,
}

impl Topology {
    /// The half-edge from one vertex to another: twice the edge's number, one more against it.
    pub(super) fn half_edge(&mut self, from: u32, to: u32) -> u32 {
        let key = |[a, b]: [u32; 2]| u128::from(a.min(b)) << 32 | u128::from(a.max(b));
        let fresh = self.edges.len() as u32;
        let edges = &mut self.edges;
        let edge = self.edge_table.find_or_insert(key([from, to]), fresh, |e| key(edges[e as usize]));
        if edge == fresh {
            edges.push([from, to]);
        }
        2 * edge + u32::from(edges[edge as usize][0] != from)
    }

    /// One more face; facets with its vertices are its half-faces unless there was such a face before.
    pub(super) fn add_face(&mut self, cycle: &[u32]) {
        let fresh = self.faces.len() as u32;
        if cycle.len() > 4 {
            // No facet is like it.
            (0..cycle.len()).for_each(|k| _ = self.half_edge(cycle[k], cycle[(k + 1) % cycle.len()]));
            return self.faces.push([NONE; 4]);
        }
        let (wanted, _) = unturned(packed(cycle));
        self.find_or_insert(wanted, fresh);
        self.push(cycle);
    }

    /// The half-face of a facet of three or four sides, a new face if need be: twice the face's number, one more for its reverse.
    pub(super) fn half_face(&mut self, cycle: &[u32]) -> u32 {
        let (wanted, turned) = unturned(packed(cycle));
        let fresh = self.faces.len() as u32;
        let face = self.find_or_insert(wanted, fresh);
        if face == fresh {
            self.push(cycle);
        }
        2 * face + u32::from(unturned(vertices(&self.edges, self.faces[face as usize])).1 != turned)
    }

    /// Number of faces.
    pub(super) fn n_faces(&self) -> usize {
        self.faces.len()
    }

    /// The half-edges of a face of three or four sides.
    pub(super) fn half_edges(&self, face: usize) -> &[u32] {
        let sides = &self.faces[face];
        &sides[..if sides[3] == NONE { 3 } else { 4 }]
    }

    fn find_or_insert(&mut self, wanted: u128, fresh: u32) -> u32 {
        let (edges, faces) = (&self.edges, &self.faces);
        self.face_table.find_or_insert(wanted, fresh, |f| unturned(vertices(edges, faces[f as usize])).0)
    }

    fn push(&mut self, cycle: &[u32]) {
        let mut face = [NONE; 4];
        for (k, slot) in face.iter_mut().enumerate().take(cycle.len()) {
            *slot = self.half_edge(cycle[k], cycle[(k + 1) % cycle.len()]);
        }
        self.faces.push(face);
    }
}

/// Where the half-edges of a face begin.
fn vertices(edges: &[[u32; 2]], face: [u32; 4]) -> [u32; 4] {
    face.map(|h| if h == NONE { NONE } else { edges[h as usize / 2][h as usize % 2] })
}

fn packed(cycle: &[u32]) -> [u32; 4] {
    match *cycle {
        [a, b, c] => [a, b, c, NONE],
        [a, b, c, d] => [a, b, c, d],
        _ => [NONE; 4],
    }
}

/// The same name for a cycle, its rotations and its reverse: smallest vertex first, then the smaller of its neighbours, 32 bits each; and
/// whether that is against the cycle.
fn unturned(cycle: [u32; 4]) -> (u128, bool) {
    let n = if cycle[3] == NONE { 3 } else { 4 };
    let first = (0..n).min_by_key(|&k| cycle[k]).unwrap_or(0);
    let at = |k: usize| cycle[(first + k) % n];
    let turned = at(1) > at(n - 1);
    let step = if turned { n - 1 } else { 1 };
    // A triangle must not be named as the quad with vertex 0 before it.
    let none = if n == 3 { u128::from(NONE) } else { 0 };
    ((0..n).fold(none, |name, k| name << 32 | u128::from(at(k * step))), turned)
}

/// A hash table of numbers with open addressing; who asks says which key a number stands for.
#[derive(Default)]
struct Table {
    /// Numbers, or [`NONE`]; a power of two, at least half of them free.
    slots: Vec<u32>,
    len: usize,
}

impl Table {
    /// The number whose key is `wanted`; if there is none, `fresh` is inserted and given.
    fn find_or_insert(&mut self, wanted: u128, fresh: u32, key_of: impl Fn(u32) -> u128) -> u32 {
        if 2 * (self.len + 1) > self.slots.len() {
            self.grow(&key_of);
        }
        let mask = self.slots.len() - 1;
        let mut at = hash(wanted) & mask;
        while self.slots[at] != NONE {
            if key_of(self.slots[at]) == wanted {
                return self.slots[at];
            }
            at = (at + 1) & mask;
        }
        self.slots[at] = fresh;
        self.len += 1;
        fresh
    }

    fn grow(&mut self, key_of: impl Fn(u32) -> u128) {
        let larger = vec![NONE; (2 * self.slots.len()).max(16)];
        let mask = larger.len() - 1;
        for number in std::mem::replace(&mut self.slots, larger).into_iter().filter(|&n| n != NONE) {
            let mut at = hash(key_of(number)) & mask;
            while self.slots[at] != NONE {
                at = (at + 1) & mask;
            }
            self.slots[at] = number;
        }
    }
}

fn hash(key: u128) -> usize {
    let mut hasher = FxHasher::default();
    hasher.write_u128(key);
    hasher.finish() as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_are_found_by_every_rotation_and_reflection_and_by_nothing_else() {
        let mut topology = Topology::default();
        topology.add_face(&[5, 2, 9, 7]);
        topology.add_face(&[4, 1, 3]);
        topology.add_face(&[0, 1, 2, 3, 4]);
        topology.add_face(&[2, 5, 7, 9]);
        for k in 0..4 {
            let mut cycle = [5, 2, 9, 7];
            cycle.rotate_left(k);
            assert_eq!(topology.half_face(&cycle), 0);
            cycle.reverse();
            assert_eq!(topology.half_face(&cycle), 1);
        }
        assert_eq!(topology.half_face(&[1, 3, 4]), 2);
        assert_eq!(topology.half_face(&[1, 4, 3]), 3);
        assert_eq!(topology.n_faces(), 4);
        // The same vertices in another cyclic order are another face.
        assert_eq!(topology.half_face(&[5, 9, 2, 7]), 8);
        assert_eq!(topology.half_edges(4).len(), 4);
        assert_eq!([topology.half_face(&[0, 1, 3, 4]), topology.half_face(&[3, 1, 4, 0])], [10, 12]);
        assert_eq!(topology.half_edge(2, 5), 1);
        assert_eq!(topology.half_edge(2, 9), 2);
    }
}
