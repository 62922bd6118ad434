//! A closed oriented surface of `k`-gons as darts, and its tree-cotree decomposition: the 2 g edges whose
//! fundamental loops are a basis of the first homology (Eppstein 2003, "Dynamic generators of topologically
//! embedded graphs"). Used for quads and for triangles.

use hexfill_mesh::QuadSurface;

pub(crate) const NONE: u32 = u32::MAX;

/// Dart `k f + i` is side `i` of face `f`.
#[derive(Clone, Debug)]
pub(crate) struct Darts {
    pub k: u32,
    pub n_vertices: usize,
    pub origin: Vec<u32>,
    pub twin: Vec<u32>,
}

impl Darts {
    pub fn of_surface(surface: &QuadSurface) -> Self {
        Self {
            k: 4,
            n_vertices: surface.n_vertices(),
            origin: surface.darts().map(|d| surface.origin(d).0).collect(),
            twin: surface.darts().map(|d| surface.twin(d).0).collect(),
        }
    }

    /// The darts of triangles that form a closed surface. Two vertices may be joined by one edge only.
    pub fn of_triangles(n_vertices: usize, triangles: &[[u32; 3]]) -> Self {
        let origin: Vec<u32> = triangles.iter().flatten().copied().collect();
        let mut keys: Vec<(u32, u32, u32)> = (0..origin.len())
            .map(|d| {
                let (a, b) = (origin[d], origin[if d % 3 == 2 { d - 2 } else { d + 1 }]);
                (a.min(b), a.max(b), d as u32)
            })
            .collect();
        keys.sort_unstable();
        let mut twin = vec![NONE; origin.len()];
        for pair in keys.chunks_exact(2) {
            twin[pair[0].2 as usize] = pair[1].2;
            twin[pair[1].2 as usize] = pair[0].2;
        }
        Self { k: 3, n_vertices, origin, twin }
    }

    pub fn len(&self) -> usize {
        self.origin.len()
    }

    pub fn next(&self, d: u32) -> u32 {
        if d % self.k == self.k - 1 { d + 1 - self.k } else { d + 1 }
    }

    pub fn target(&self, d: u32) -> u32 {
        self.origin[self.next(d) as usize]
    }

    pub fn face(&self, d: u32) -> u32 {
        d / self.k
    }

    pub fn n_faces(&self) -> usize {
        self.origin.len() / self.k as usize
    }

    /// One dart from each vertex, or [`NONE`].
    pub fn vertex_darts(&self) -> Vec<u32> {
        let mut first = vec![NONE; self.n_vertices];
        for d in (0..self.origin.len()).rev() {
            first[self.origin[d] as usize] = d as u32;
        }
        first
    }

    /// The darts from the origin of `d`, clockwise.
    pub fn round(&self, d: u32) -> impl Iterator<Item = u32> + '_ {
        let mut at = Some(d);
        std::iter::from_fn(move || {
            let now = at?;
            let next = self.next(self.twin[now as usize]);
            at = (next != d).then_some(next);
            Some(now)
        })
    }
}

/// A spanning forest of the vertices, one of the faces that crosses none of its edges, and the edges left over.
pub(crate) struct TreeCotree {
    /// Per vertex: the tree dart that leads to it, or [`NONE`] at a root.
    pub parent: Vec<u32>,
    /// Faces in breadth-first order with the dart of the face that leads to its parent face ([`NONE`] at a root).
    pub face_order: Vec<(u32, u32)>,
    /// One dart of each edge in neither tree: 2 g of them.
    pub left: Vec<u32>,
}

pub(crate) fn tree_cotree(s: &Darts) -> TreeCotree {
    let first = s.vertex_darts();
    let mut parent = vec![NONE; s.n_vertices];
    let mut seen = vec![false; s.n_vertices];
    let mut in_tree = vec![false; s.len()];
    let mut queue = Vec::new();
    for root in 0..s.n_vertices {
        if seen[root] || first[root] == NONE {
            continue;
        }
        seen[root] = true;
        queue.clear();
        queue.push(root);
        let mut at = 0;
        while at < queue.len() {
            let v = queue[at];
            at += 1;
            for d in s.round(first[v]) {
                let w = s.target(d) as usize;
                if !seen[w] {
                    seen[w] = true;
                    parent[w] = d;
                    in_tree[d as usize] = true;
                    in_tree[s.twin[d as usize] as usize] = true;
                    queue.push(w);
                }
            }
        }
    }
    let mut face_seen = vec![false; s.n_faces()];
    let mut face_order: Vec<(u32, u32)> = Vec::with_capacity(s.n_faces());
    let mut crossed = vec![false; s.len()];
    for root in 0..s.n_faces() {
        if face_seen[root] {
            continue;
        }
        face_seen[root] = true;
        let mut at = face_order.len();
        face_order.push((root as u32, NONE));
        while at < face_order.len() {
            let f = face_order[at].0;
            at += 1;
            for d in f * s.k..(f + 1) * s.k {
                let t = s.twin[d as usize];
                if !in_tree[d as usize] && !face_seen[s.face(t) as usize] {
                    face_seen[s.face(t) as usize] = true;
                    crossed[d as usize] = true;
                    crossed[t as usize] = true;
                    face_order.push((s.face(t), t));
                }
            }
        }
    }
    let left = (0..s.len() as u32)
        .filter(|&d| d < s.twin[d as usize] && !in_tree[d as usize] && !crossed[d as usize])
        .collect();
    TreeCotree { parent, face_order, left }
}

impl TreeCotree {
    /// The fundamental loop of a dart off the tree: a closed walk of darts (simple once the common stem is dropped).
    pub fn fundamental_loop(&self, s: &Darts, d: u32) -> Vec<u32> {
        let up = |mut v: u32| {
            let mut path = Vec::new();
            while self.parent[v as usize] != NONE {
                let e = self.parent[v as usize];
                path.push(e);
                v = s.origin[e as usize];
            }
            path
        };
        let mut there = up(s.origin[d as usize]);
        let mut back = up(s.target(d));
        while let (Some(a), Some(b)) = (there.last(), back.last()) {
            if a != b {
                break;
            }
            there.pop();
            back.pop();
        }
        there.reverse();
        there.push(d);
        there.extend(back.into_iter().map(|e| s.twin[e as usize]));
        there
    }

    /// The closed cochain that is 0 on the tree and has the given values on the edges left over (per dart;
    /// antisymmetric). Each face sums to 0.
    pub fn closed_cochain(&self, s: &Darts, values: &[i64]) -> Vec<i64> {
        let mut w = vec![0i64; s.len()];
        for (&d, &value) in self.left.iter().zip(values) {
            w[d as usize] = value;
            w[s.twin[d as usize] as usize] = -value;
        }
        // Leaves first: the edge to the parent is the only one unknown.
        for &(f, up) in self.face_order.iter().rev() {
            if up != NONE {
                let rest: i64 = (f * s.k..(f + 1) * s.k).filter(|&d| d != up).map(|d| w[d as usize]).sum();
                w[up as usize] = -rest;
                w[s.twin[up as usize] as usize] = rest;
            }
        }
        w
    }
}
