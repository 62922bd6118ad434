//! A closed oriented surface of `k`-gons as darts, and its tree-cotree decomposition: the 2 g edges whose
//! fundamental loops are a basis of the first homology (Eppstein 2003, "Dynamic generators of topologically
//! embedded graphs"). Used for quads and for triangles.
//!
//! Source: Eppstein 2003 (tree and cotree).

use hexfill_mesh::{IdVec, QuadSurface, VertexId, id_type};

id_type!(
    /// A directed side of a polygon: dart `k g + i` is side `i` of polygon `g`.
    DartId, "d"
);
id_type!(
    /// A polygon of a surface.
    GonId, "g"
);

/// The darts of a surface. See the module page.
#[derive(Clone, Debug)]
pub(crate) struct Darts {
    /// Sides of a polygon.
    pub(crate) k: u32,
    pub(crate) n_vertices: usize,
    pub(crate) origin: IdVec<DartId, VertexId>,
    pub(crate) twin: IdVec<DartId, DartId>,
}

impl Darts {
    pub(crate) fn of_surface(surface: &QuadSurface) -> Self {
        Self {
            k: 4,
            n_vertices: surface.n_vertices(),
            origin: surface.darts().map(|d| surface.origin(d)).collect(),
            twin: surface.darts().map(|d| DartId(surface.twin(d).0)).collect(),
        }
    }

    /// The darts of triangles that form a closed surface. Two vertices may be joined by one edge only.
    pub(crate) fn of_triangles(n_vertices: usize, triangles: &[[VertexId; 3]]) -> Self {
        let origin: IdVec<DartId, VertexId> = triangles.iter().flatten().copied().collect();
        let twin = IdVec::filled(DartId::NONE, origin.len());
        let mut darts = Self { k: 3, n_vertices, origin, twin };
        let ends = |d: DartId| {
            let (a, b) = (darts.origin[d], darts.target(d));
            (a.min(b), a.max(b), d)
        };
        let mut keys: Vec<(VertexId, VertexId, DartId)> = darts.ids().map(ends).collect();
        keys.sort_unstable();
        for pair in keys.chunks_exact(2) {
            darts.join(pair[0].2, pair[1].2);
        }
        darts
    }

    /// Number of darts.
    pub(crate) fn len(&self) -> usize {
        self.origin.len()
    }

    pub(crate) fn ids(&self) -> impl DoubleEndedIterator<Item = DartId> + use<> {
        self.origin.ids()
    }

    /// Makes two darts twins.
    pub(crate) fn join(&mut self, d: DartId, e: DartId) {
        self.twin[d] = e;
        self.twin[e] = d;
    }

    pub(crate) fn next(&self, d: DartId) -> DartId {
        DartId(if d.0 % self.k == self.k - 1 { d.0 + 1 - self.k } else { d.0 + 1 })
    }

    pub(crate) fn target(&self, d: DartId) -> VertexId {
        self.origin[self.next(d)]
    }

    pub(crate) fn gon(&self, d: DartId) -> GonId {
        GonId(d.0 / self.k)
    }

    /// Side `i` of a polygon.
    pub(crate) fn side(&self, g: GonId, i: usize) -> DartId {
        DartId(g.0 * self.k + i as u32)
    }

    /// All sides of a polygon.
    pub(crate) fn sides(&self, g: GonId) -> impl Iterator<Item = DartId> + use<> {
        (g.0 * self.k..(g.0 + 1) * self.k).map(DartId)
    }

    pub(crate) fn n_gons(&self) -> usize {
        self.origin.len() / self.k as usize
    }

    /// One dart from each vertex, or none.
    pub(crate) fn vertex_darts(&self) -> IdVec<VertexId, DartId> {
        let mut first = IdVec::filled(DartId::NONE, self.n_vertices);
        for d in self.ids().rev() {
            first[self.origin[d]] = d;
        }
        first
    }

    /// The darts from the origin of `d`, clockwise.
    pub(crate) fn round(&self, d: DartId) -> impl Iterator<Item = DartId> + '_ {
        let mut at = Some(d);
        std::iter::from_fn(move || {
            let now = at?;
            let next = self.next(self.twin[now]);
            at = (next != d).then_some(next);
            Some(now)
        })
    }
}

/// A spanning forest of the vertices, one of the polygons that crosses none of its edges, and the edges left over.
pub(crate) struct TreeCotree {
    /// Per vertex: the tree dart that leads to it, or none at a root.
    pub(crate) parent: IdVec<VertexId, DartId>,
    /// Polygons in breadth-first order with the dart that leads to the parent polygon (none at a root).
    pub(crate) gon_order: Vec<(GonId, DartId)>,
    /// One dart of each edge in neither tree: 2 g of them.
    pub(crate) left: Vec<DartId>,
}

pub(crate) fn tree_cotree(s: &Darts) -> TreeCotree {
    let parent = vertex_forest(s);
    let mut in_tree = IdVec::filled(false, s.len());
    for &d in parent.iter().filter(|d| d.is_some()) {
        in_tree[d] = true;
        in_tree[s.twin[d]] = true;
    }
    let mut seen: IdVec<GonId, bool> = IdVec::filled(false, s.n_gons());
    let mut gon_order: Vec<(GonId, DartId)> = Vec::with_capacity(s.n_gons());
    let mut crossed: IdVec<DartId, bool> = IdVec::filled(false, s.len());
    for root in seen.ids() {
        if seen[root] {
            continue;
        }
        seen[root] = true;
        let mut at = gon_order.len();
        gon_order.push((root, DartId::NONE));
        while at < gon_order.len() {
            let (g, _) = gon_order[at];
            at += 1;
            for d in s.sides(g) {
                let t = s.twin[d];
                if !in_tree[d] && !seen[s.gon(t)] {
                    seen[s.gon(t)] = true;
                    crossed[d] = true;
                    crossed[t] = true;
                    gon_order.push((s.gon(t), t));
                }
            }
        }
    }
    let left = s.ids().filter(|&d| d < s.twin[d] && !in_tree[d] && !crossed[d]).collect();
    TreeCotree { parent, gon_order, left }
}

/// Per vertex the dart that leads to it in a breadth-first forest.
fn vertex_forest(s: &Darts) -> IdVec<VertexId, DartId> {
    let first = s.vertex_darts();
    let mut parent = IdVec::filled(DartId::NONE, s.n_vertices);
    let mut seen: IdVec<VertexId, bool> = IdVec::filled(false, s.n_vertices);
    let mut queue = Vec::new();
    for root in first.ids() {
        if seen[root] || first[root].is_none() {
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
                let w = s.target(d);
                if !seen[w] {
                    seen[w] = true;
                    parent[w] = d;
                    queue.push(w);
                }
            }
        }
    }
    parent
}

/// The closed walk of a dart between two branches of a tree (per vertex the dart that leads to it), without their common stem.
pub(crate) fn tree_loop(s: &Darts, parent: &IdVec<VertexId, DartId>, d: DartId) -> Vec<DartId> {
    let up = |mut v: VertexId| {
        let mut path = Vec::new();
        while parent[v].is_some() {
            path.push(parent[v]);
            v = s.origin[parent[v]];
        }
        path
    };
    let (mut there, mut back) = (up(s.origin[d]), up(s.target(d)));
    while there.last().is_some() && there.last() == back.last() {
        there.pop();
        back.pop();
    }
    there.reverse();
    there.push(d);
    there.extend(back.into_iter().map(|e| s.twin[e]));
    there
}

impl TreeCotree {
    /// The closed cochain that is 0 on the tree and has the given values on the edges left over (per dart;
    /// antisymmetric). Each polygon sums to 0.
    pub(crate) fn closed_cochain(&self, s: &Darts, values: &[i64]) -> IdVec<DartId, i64> {
        let mut w = IdVec::filled(0i64, s.len());
        for (&d, &value) in self.left.iter().zip(values) {
            w[d] = value;
            w[s.twin[d]] = -value;
        }
        // Leaves first: the edge to the parent is the only one unknown.
        for &(g, up) in self.gon_order.iter().rev() {
            if up.is_some() {
                let rest: i64 = s.sides(g).filter(|&d| d != up).map(|d| w[d]).sum();
                w[up] = -rest;
                w[s.twin[up]] = rest;
            }
        }
        w
    }
}
