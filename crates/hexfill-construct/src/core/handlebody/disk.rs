//! The shortest loop that may bound a disk inside: null there and not on the surface.
//!
//! A loop that does not bound on the surface but does inside is found among the fundamental loops of breadth-first trees (as shortest
//! non-separating loops are, Erickson and Har-Peled 2004), and where these do not have one, in a covering graph.
//!
//! Source: Erickson and Har-Peled 2004 for fundamental loops of shortest paths; the homology that decides is of `surface/linking.rs`, the covering graph
//! ours.

use super::cutting::Cutting;
use crate::error::ConstructError;
use crate::surface::polygons::{DartId, Darts, tree_cotree, tree_loop};
use hexfill_mesh::{Context, IdVec, VertexId};
use std::collections::HashSet;

/// Darts looked at in the search for one loop, over all roots.
const SEARCH: usize = 30_000_000;

/// States of one search in the covering graph, and roots it starts from.
const STATES: usize = 400_000;
const ROOTS: usize = 6;

/// The shortest loop found that is null inside and not on the surface, as darts.
pub(super) fn shortest_disk(cutting: &Cutting, ctx: &Context<'_>) -> Result<Option<Vec<DartId>>, ConstructError> {
    let s = &cutting.s;
    let bits = classes(s);
    let first = s.vertex_darts();
    let usable: Vec<VertexId> = first.enumerate().filter(|(_, d)| d.is_some()).map(|(v, _)| v).collect();
    // Not from every vertex: a loop a little longer than the shortest cuts as well, it only makes larger fans.
    let n_roots = (SEARCH / (s.len() * (1 + cutting.inside.width))).clamp(4, usable.len());
    let mut search = Search::new(cutting, &bits, &first);
    let mut best: Option<Vec<DartId>> = None;
    for i in 0..n_roots {
        if let Some(reason) = ctx.stop() {
            return Err(ConstructError::Stopped(reason));
        }
        let root = usable[i * usable.len() / n_roots];
        let limit = best.as_ref().map_or(usize::MAX, Vec::len);
        if let Some(path) = search.from(root, limit).filter(|path| path.len() < limit) {
            best = Some(path);
        }
    }
    if best.is_some() { Ok(best) } else { disk_in_cover(cutting, &bits, ctx) }
}

/// Z/2 classes of loops on the surface: bit `k` of a loop counts its crossings with the `k`-th dual loop.
fn classes(s: &Darts) -> IdVec<DartId, u64> {
    let trees = tree_cotree(s);
    let mut bits = IdVec::filled(0u64, s.len());
    for k in 0..trees.left.len() {
        let mut values = vec![0i64; trees.left.len()];
        values[k] = 1;
        for (d, x) in trees.closed_cochain(s, &values).enumerate() {
            bits[d] |= u64::from(x.rem_euclid(2) == 1) << k;
        }
    }
    bits
}

/// Breadth-first searches from one root after the other, with the class of the tree path to every vertex.
struct Search<'a> {
    cutting: &'a Cutting,
    bits: &'a IdVec<DartId, u64>,
    first: &'a IdVec<VertexId, DartId>,
    depth: IdVec<VertexId, u32>,
    parent: IdVec<VertexId, DartId>,
    /// Per vertex its numbers of the homology inside.
    sum: Vec<i64>,
    bit: IdVec<VertexId, u64>,
    order: Vec<VertexId>,
}

impl<'a> Search<'a> {
    fn new(cutting: &'a Cutting, bits: &'a IdVec<DartId, u64>, first: &'a IdVec<VertexId, DartId>) -> Self {
        let n = first.len();
        Self {
            cutting,
            bits,
            first,
            depth: IdVec::filled(u32::MAX, n),
            parent: IdVec::filled(DartId::NONE, n),
            sum: vec![0i64; cutting.inside.width * n],
            bit: IdVec::filled(0u64, n),
            order: Vec::new(),
        }
    }

    /// The first loop met from `root`, if one shorter than `limit` may still come. Later loops from the same root are no shorter by
    /// more than their stem.
    fn from(&mut self, root: VertexId, limit: usize) -> Option<Vec<DartId>> {
        let (s, w) = (&self.cutting.s, self.cutting.inside.width);
        for &v in &self.order {
            self.depth[v] = u32::MAX;
        }
        self.order.clear();
        self.order.push(root);
        self.depth[root] = 0;
        self.parent[root] = DartId::NONE;
        self.sum[w * root.index()..w * (root.index() + 1)].fill(0);
        self.bit[root] = 0;
        let mut at = 0;
        while at < self.order.len() {
            let v = self.order[at];
            at += 1;
            // Any loop closed from here on has at least this many darts: two tree paths of that depth and a dart.
            if 2 * self.depth[v] as usize + 1 >= limit {
                return None;
            }
            for d in s.round(self.first[v]) {
                let t = s.target(d);
                let values = self.cutting.inside.of(d);
                let (from, to) = (w * v.index(), w * t.index());
                if self.depth[t] == u32::MAX {
                    self.depth[t] = self.depth[v] + 1;
                    self.parent[t] = d;
                    self.bit[t] = self.bit[v] ^ self.bits[d];
                    for (j, value) in values.iter().enumerate() {
                        self.sum[to + j] = self.sum[from + j] + value;
                    }
                    self.order.push(t);
                // The classes of path, dart and path back add up to the loop's: not zero on the surface, so it does
                // not separate; zero inside in integers, so it is null-homologous there and may bound a disk.
                } else if self.bit[v] ^ self.bits[d] != self.bit[t]
                    && (0..w).all(|j| self.sum[from + j] + values[j] == self.sum[to + j])
                {
                    return Some(tree_loop(s, &self.parent, d));
                }
            }
        }
        None
    }
}

/// A vertex with the class of the path to it.
struct State {
    vertex: VertexId,
    bit: u64,
    sum: Vec<i64>,
    /// The state before, and the dart between.
    from: Option<(usize, DartId)>,
}

/// As [`shortest_disk`], by a search in the covering graph: a state is a vertex with the homology
/// of the path to it, so loops are found that are no tree path, edge and tree path. Needed where components
/// are joined: the loop goes through the prism and back. Bounded.
fn disk_in_cover(
    cutting: &Cutting,
    bits: &IdVec<DartId, u64>,
    ctx: &Context<'_>,
) -> Result<Option<Vec<DartId>>, ConstructError> {
    let s = &cutting.s;
    let first = s.vertex_darts();
    // Loops that need the covering graph run through a prism, so they pass a corner of one: roots elsewhere would
    // only find them later.
    let corners = cutting.prisms.iter().flat_map(|p| p.sides).flat_map(|g| s.sides(g));
    let mut roots: Vec<VertexId> = corners.map(|d| s.origin[d]).collect();
    roots.sort_unstable();
    roots.dedup();
    if roots.is_empty() {
        roots.extend(first.ids().find(|&v| first[v].is_some()));
    }
    for root in roots.into_iter().take(ROOTS) {
        let nothing = vec![0i64; cutting.inside.width];
        let mut known: HashSet<(VertexId, u64, Vec<i64>)> = HashSet::from([(root, 0, nothing.clone())]);
        let mut states = vec![State { vertex: root, bit: 0, sum: nothing, from: None }];
        let mut at = 0;
        while at < states.len() && states.len() < STATES {
            if at % 1024 == 0
                && let Some(reason) = ctx.stop()
            {
                return Err(ConstructError::Stopped(reason));
            }
            let v = states[at].vertex;
            // A path that is back at the root goes no further.
            let darts = if at == 0 || v != root { s.round(first[v]).collect() } else { Vec::new() };
            for d in darts {
                let t = s.target(d);
                let sum: Vec<i64> = states[at].sum.iter().zip(cutting.inside.of(d)).map(|(x, y)| x + y).collect();
                let bit = states[at].bit ^ bits[d];
                if !known.insert((t, bit, sum.clone())) {
                    continue;
                }
                // Null-homologous is necessary for a disk and not sufficient: a commutator is null as well.
                let closes = t == root && bit != 0 && sum.iter().all(|&x| x == 0);
                states.push(State { vertex: t, bit, sum, from: Some((at, d)) });
                if closes && let Some(path) = simple_path(s, &states) {
                    return Ok(Some(path));
                }
            }
            at += 1;
        }
    }
    Ok(None)
}

/// The darts to the last state, if they pass no vertex twice.
fn simple_path(s: &Darts, states: &[State]) -> Option<Vec<DartId>> {
    let mut path = Vec::new();
    let mut state = states.len() - 1;
    while let Some((before, d)) = states[state].from {
        path.push(d);
        state = before;
    }
    path.reverse();
    let mut through: Vec<VertexId> = path.iter().map(|&d| s.origin[d]).collect();
    through.sort_unstable();
    (path.len() > 2 && through.windows(2).all(|p| p[0] != p[1])).then_some(path)
}
