//! The surface while it is cut: triangles over copies of vertices, with the interior's homology on the darts.
//!
//! Cutting along a loop that bounds a disk and capping both sides is surgery: the genus drops by one if the loop does not separate.
//!
//! Source: Erickson 2014 needs tetrahedra; to have them by surgery on loops is ours, from textbooks (Hatcher 2002, chapter 1).

use super::prism::Prism;
use crate::surface::polygons::{DartId, Darts, GonId};
use hexfill_geometry::Vector;
use hexfill_mesh::{IdVec, VertexId};

/// The surface while it is cut. Its vertices are *copies*: a vertex on a loop that was cut has one on each side.
pub(super) struct Cutting {
    pub(super) s: Darts,
    /// Per copy: the vertex of the tets.
    pub(super) vertex: IdVec<VertexId, VertexId>,
    pub(super) inside: Homology,
    /// Pairs of triangles to glue again.
    pub(super) glued: Vec<[GonId; 2]>,
    pub(super) prisms: Vec<Prism>,
}

/// Closed cochains: per dart some numbers, which sum to zero round every polygon and change sign with the direction.
#[derive(Clone, Debug)]
pub(super) struct Homology {
    /// Numbers a dart.
    pub(super) width: usize,
    numbers: Vec<i64>,
}

impl Homology {
    pub(super) fn zero(width: usize, n_darts: usize) -> Self {
        Self { width, numbers: vec![0; width * n_darts] }
    }

    /// The numbers of a dart.
    pub(super) fn of(&self, d: DartId) -> &[i64] {
        &self.numbers[self.width * d.index()..self.width * (d.index() + 1)]
    }

    pub(super) fn of_mut(&mut self, d: DartId) -> &mut [i64] {
        &mut self.numbers[self.width * d.index()..self.width * (d.index() + 1)]
    }

    fn resize(&mut self, n_darts: usize) {
        self.numbers.resize(self.width * n_darts, 0);
    }
}

impl Cutting {
    pub(super) fn new(s: Darts, inside: Homology) -> Self {
        let vertex = (0..s.n_vertices).map(VertexId::new).collect();
        Self { s, vertex, inside, glued: Vec::new(), prisms: Vec::new() }
    }

    /// Makes room for `n` more triangles; the first of them.
    pub(super) fn add_triangles(&mut self, n: usize) -> GonId {
        let first = GonId::new(self.s.n_gons());
        let n_darts = self.s.len() + 3 * n;
        self.s.origin.resize(n_darts, VertexId::NONE);
        self.s.twin.resize(n_darts, DartId::NONE);
        self.inside.resize(n_darts);
        first
    }

    /// The mean of the vertices of a loop.
    pub(super) fn mean(&self, path: &[DartId], points: &[Vector]) -> Vector {
        let mut sum = [0.0; 3];
        for &d in path {
            let p = points[self.vertex[self.s.origin[d]].index()];
            sum = std::array::from_fn(|k| sum[k] + p[k] / path.len() as f64);
        }
        sum
    }

    /// Cuts along a simple loop that is null inside and caps both sides round the tet vertex `centre`.
    pub(super) fn cut(&mut self, path: &[DartId], centre: VertexId) {
        let n = path.len();
        let on_left: Vec<VertexId> = path.iter().map(|&d| self.s.origin[d]).collect();
        let on_right = self.copy_right_side(path);
        let [left_centre, right_centre] = [centre; 2].map(|v| self.vertex.push(v));
        self.s.n_vertices = self.vertex.len();
        let base = self.add_triangles(2 * n).0 as usize;
        let (left, right) = (|i: usize| GonId::new(base + i), |i: usize| GonId::new(base + n + i));
        // Potentials along the loop, so that fans are closed (its sum is zero).
        let mut potential = vec![0i64; self.inside.width];
        for i in 0..n {
            let j = (i + 1) % n;
            let (d, t) = (path[i], self.s.twin[path[i]]);
            // Left fan i: b a, a centre, centre b; right fan i: a' b', b' centre, centre a'.
            let [ab, ac, cb] = [0, 1, 2].map(|k| self.s.side(left(i), k));
            let [ba, bc, ca] = [0, 1, 2].map(|k| self.s.side(right(i), k));
            for (e, v) in [(ab, on_left[j]), (ac, on_left[i]), (cb, left_centre)] {
                self.s.origin[e] = v;
            }
            for (e, v) in [(ba, on_right[i]), (bc, on_right[j]), (ca, right_centre)] {
                self.s.origin[e] = v;
            }
            // The left fan closes the side that keeps the old vertices, the right fan the side that got copies; as
            // triangles of tets the two are one disk.
            self.s.join(d, ab);
            self.s.join(t, ba);
            // The spoke to b is that of the next fan to its a; right the other way round.
            self.s.join(cb, self.s.side(left(j), 1));
            self.s.join(bc, self.s.side(right(j), 2));
            for (k, slot) in potential.iter_mut().enumerate() {
                let value = self.inside.of(d)[k];
                let (here, there) = (*slot, *slot + value);
                // From a vertex to the centre it is minus the potential.
                for (e, x) in [(ab, -value), (ac, -here), (cb, there), (ba, value), (bc, -there), (ca, here)] {
                    self.inside.of_mut(e)[k] = x;
                }
                *slot = there;
            }
            self.glued.push([left(i), right(i)]);
        }
    }

    /// Right of the loop every vertex gets a copy: walk clockwise from the loop's dart out to its dart in.
    fn copy_right_side(&mut self, path: &[DartId]) -> Vec<VertexId> {
        let n = path.len();
        let mut copies = Vec::with_capacity(n);
        let mut turned: Vec<(DartId, VertexId)> = Vec::new();
        for i in 0..n {
            // A copy is a new vertex of the surface and the old one of the tets: the apex may see it twice.
            let copy = self.vertex.push(self.vertex[self.s.origin[path[i]]]);
            copies.push(copy);
            let (d, back) = (path[i], self.s.twin[path[(i + n - 1) % n]]);
            let mut at = d;
            loop {
                at = self.s.next(self.s.twin[at]);
                turned.push((at, copy));
                if at == back {
                    break;
                }
            }
        }
        for (d, copy) in turned {
            self.s.origin[d] = copy;
        }
        copies
    }
}
