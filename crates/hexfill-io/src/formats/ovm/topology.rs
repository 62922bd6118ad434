//! Edges and faces of a mesh to write, each found again by its vertices.
//!
//! A facet of a cell has three or four sides, so a face is kept as four half-edges and known by four vertices, sorted as far as
//! its cycle allows. Edges and faces hang in a chain at their smallest vertex: chains are short in a mesh, and what is near in the
//! mesh is near in memory.
//!
//! Source: ours.

/// Fills the fourth place of a triangle.
const NONE: u32 = u32::MAX;

/// Edges and faces in the order of their first use, fewer than 2^31 of each.
#[derive(Default)]
pub(super) struct Topology {
    /// The ends of each edge as it was first used.
    pub(super) edges: Vec<[u32; 2]>,
    edges_at: Chains,
    /// The half-edges of each face of three or four sides.
    faces: Vec<[u32; 4]>,
    faces_at: Chains,
}

impl Topology {
    /// The half-edge from one vertex to another: twice the edge's number, one more against it.
    pub(super) fn half_edge(&mut self, from: u32, to: u32) -> u32 {
        let smallest = from.min(to);
        let edges = &self.edges;
        let same = |e: u32| edges[e as usize] == [from, to] || edges[e as usize] == [to, from];
        let edge = self.edges_at.find(smallest, same).unwrap_or_else(|| {
            self.edges.push([from, to]);
            self.edges_at.push(Some(smallest))
        });
        2 * edge + u32::from(self.edges[edge as usize][0] != from)
    }

    /// One more face; facets with its vertices are its half-faces unless there was such a face before.
    pub(super) fn add_face(&mut self, cycle: &[u32]) {
        // No facet has other numbers of sides.
        let name = matches!(cycle.len(), 3 | 4).then(|| unturned(packed(cycle)).0);
        let hangs = name.filter(|&name| self.find(name).is_none());
        self.push(cycle);
        self.faces_at.push(hangs.map(|name| name[0]));
    }

    /// The half-face of a facet of three or four sides, a new face if need be: twice the face's number, one more for its reverse.
    pub(super) fn half_face(&mut self, cycle: &[u32]) -> u32 {
        let (name, turned) = unturned(packed(cycle));
        let face = self.find(name).unwrap_or_else(|| {
            self.push(cycle);
            self.faces_at.push(Some(name[0]))
        });
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

    fn find(&self, name: [u32; 4]) -> Option<u32> {
        self.faces_at.find(name[0], |f| unturned(vertices(&self.edges, self.faces[f as usize])).0 == name)
    }

    fn push(&mut self, cycle: &[u32]) {
        let mut face = [NONE; 4];
        for k in 0..cycle.len() {
            let side = self.half_edge(cycle[k], cycle[(k + 1) % cycle.len()]);
            if let Some(slot) = face.get_mut(k) {
                *slot = side;
            }
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

/// The same name for a cycle, its rotations and its reverse: smallest vertex first, then the smaller of its neighbours; and
/// whether that is against the cycle.
fn unturned(cycle: [u32; 4]) -> ([u32; 4], bool) {
    let n = if cycle[3] == NONE { 3 } else { 4 };
    let first = (0..n).min_by_key(|&k| cycle[k]).unwrap_or(0);
    let at = |k: usize| cycle[(first + k) % n];
    let turned = at(1) > at(n - 1);
    let step = if turned { n - 1 } else { 1 };
    let mut name = [NONE; 4];
    for (k, slot) in name.iter_mut().enumerate().take(n) {
        *slot = at(k * step);
    }
    (name, turned)
}

/// Lists of numbers by vertex.
#[derive(Default)]
struct Chains {
    /// Per vertex: the number that came last, or [`NONE`].
    first: Vec<u32>,
    /// Per number: the one before at the same vertex, or [`NONE`].
    next: Vec<u32>,
}

impl Chains {
    fn find(&self, vertex: u32, is_wanted: impl Fn(u32) -> bool) -> Option<u32> {
        let mut at = self.first.get(vertex as usize).copied().unwrap_or(NONE);
        while at != NONE && !is_wanted(at) {
            at = self.next[at as usize];
        }
        (at != NONE).then_some(at)
    }

    /// Hangs the next number at a vertex, if any, and gives it.
    fn push(&mut self, vertex: Option<u32>) -> u32 {
        let number = self.next.len() as u32;
        self.next.push(NONE);
        if let Some(vertex) = vertex.map(|v| v as usize) {
            if vertex >= self.first.len() {
                self.first.resize(vertex + 1, NONE);
            }
            self.next[number as usize] = std::mem::replace(&mut self.first[vertex], number);
        }
        number
    }
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
