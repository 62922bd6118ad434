//! [`Quotient`]: hexes that are pressed flat, and the cells that become one by it. When the result is a proper mesh of the same
//! space with the same boundary.
//!
//! The fibres of the map (what is pressed into one point) are trees if the cells made one are linked without a cycle: trees of
//! vertices over a vertex, of edges over an edge, of quads over a quad. A map of a 3-manifold onto a complex whose fibres are
//! contractible has a homeomorphic image (Cohen, "Simplicial structures and transverse cellularity", 1967; for manifolds of
//! dimension 3 any contractible fibre is cellular). A tree with at most one boundary vertex leaves the boundary alone: with a
//! collar put round the mesh the fibres are inside it, so the image of the mesh, the collar taken off again, is a manifold too.
//!
//! Proper intersection is the table of vertex pairs: the cells after the collapse that join the vertices of a pair (an edge, or a
//! quad by its diagonal, or a hex by its body diagonal) must be at most one. Only pairs with a merged vertex can change, so
//! the hexes at merged vertices are all that is looked at.
//!
//! Source: Cohen 1967 (maps whose fibres are contractible); reducing them to trees is ours.

use crate::simplify::live::{LiveMesh, NONE};
use hexfill_mesh::cube::{EDGES, FACET_DIAGONALS};
use rustc_hash::FxHashMap;
use std::hash::Hash;
use std::sync::LazyLock;

/// What a collapse does to a mesh. The links are those of the fibres, each given once.
#[derive(Default)]
pub(crate) struct Quotient {
    /// The hexes that are pressed flat.
    pub removed: Vec<u32>,
    /// Vertices that become one.
    pub vertices: Vec<[u32; 2]>,
    /// Edges, smaller vertex first, that become one.
    pub edges: Vec<[[u32; 2]; 2]>,
    /// Facets of removed hexes that become one quad.
    pub facets: Vec<[u32; 2]>,
}

/// Why a collapse is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Refusal {
    /// It would merge two boundary vertices, or take a hex at the boundary that must stay.
    Boundary,
    /// Cells would merge round a cycle, or a hex that stays would lose a corner.
    Cycle,
    /// Two hexes would meet improperly.
    Improper,
}

/// What a collapse must keep of the boundary.
pub(crate) struct Kept<'a> {
    /// Per vertex whether it is on the boundary; the vertices after the last are not.
    pub is_boundary: &'a [bool],
    /// Whether all hexes that have a boundary vertex must stay too.
    pub hexes: bool,
}

/// An edge by its ends.
pub(crate) fn edge(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

impl Quotient {
    /// The vertices that go, each with the one it becomes: the boundary vertex among those that become one, or the smallest.
    ///
    /// # Errors
    /// Why the collapse is not allowed.
    pub(crate) fn merges(&self, mesh: &LiveMesh, kept: &Kept<'_>) -> Result<Vec<[u32; 2]>, Refusal> {
        let on_boundary = |v: u32| kept.is_boundary.get(v as usize).is_some_and(|b| *b);
        if kept.hexes && self.removed.iter().any(|&h| mesh.hex(h).iter().any(|&v| on_boundary(v))) {
            return Err(Refusal::Boundary);
        }
        // The cheapest refusal first; two boundary vertices may still come together through others, which the trees
        // tell.
        if self.vertices.iter().any(|pair| pair.iter().all(|&v| on_boundary(v))) {
            return Err(Refusal::Boundary);
        }
        // Trees, or a fibre is not contractible and the image no longer the same space (Cohen 1967).
        let mut vertices = Sets::forest(&self.vertices)?;
        let mut edges = Sets::forest(&self.edges)?;
        let name = |f: u32| f.min(mesh.neighbour(f));
        let mut quads = Sets::forest(&self.facets.iter().map(|pair| pair.map(name)).collect::<Vec<_>>())?;

        let mut touched: Vec<u32> = self.vertices.iter().flatten().copied().collect();
        touched.sort_unstable();
        touched.dedup();
        let mut target: FxHashMap<u32, u32> = FxHashMap::default();
        for &v in touched.iter().filter(|&&v| on_boundary(v)) {
            // With one boundary vertex at most a fibre lies inside a collar and leaves the boundary alone; with two
            // it would press the boundary.
            if target.insert(vertices.root(v), v).is_some() {
                return Err(Refusal::Boundary);
            }
        }
        let becomes: FxHashMap<u32, u32> =
            touched.iter().map(|&v| (v, *target.entry(vertices.root(v)).or_insert(v))).collect();

        let mut removed = self.removed.clone();
        removed.sort_unstable();
        // The vertices that become one, those with few hexes first: what is refused is mostly refused there.
        let mut classes: Vec<(u32, u32)> = touched.iter().map(|&v| (becomes[&v], v)).collect();
        classes.sort_unstable();
        let mut classes: Vec<&[(u32, u32)]> = classes.chunk_by(|x, y| x.0 == y.0).collect();
        classes.sort_by_key(|class| class.iter().map(|&(_, v)| mesh.degree(v)).sum::<u32>());
        // (other vertex, cell): what joins the merged vertex to others.
        let mut joined: Vec<(u32, [u32; 3])> = Vec::new();
        for class in classes {
            joined.clear();
            let target = class[0].0;
            for &(_, v) in class {
                for h in mesh.hexes_at(v).filter(|h| removed.binary_search(h).is_err()) {
                    let old = mesh.hex(h);
                    let Some(i) = old.iter().position(|&w| w == v) else { continue };
                    for (j, &w) in old.iter().enumerate().filter(|&(j, _)| j != i) {
                        let other = becomes.get(&w).copied().unwrap_or(w);
                        if other == target {
                            return Err(Refusal::Cycle);
                        }
                        let cell = match JOINS[i][j] {
                            Join::Edge => {
                                let [a, b] = edges.root(edge(v, w));
                                [0, a, b]
                            }
                            Join::Diagonal(side) => [1, quads.root(name(6 * h + side)), NONE],
                            Join::Body => [2, h, NONE],
                        };
                        joined.push((other, cell));
                    }
                }
            }
            joined.sort_unstable();
            joined.dedup();
            // Two different cells on one pair: the pair table of the whole mesh, asked only where it can change.
            if joined.windows(2).any(|w| w[0].0 == w[1].0) {
                return Err(Refusal::Improper);
            }
        }
        Ok(touched.into_iter().map(|v| [v, becomes[&v]]).filter(|[v, to]| v != to).collect())
    }
}

/// What joins two corners of a cube.
#[derive(Clone, Copy)]
enum Join {
    Edge,
    /// The diagonal of the facet on this side.
    Diagonal(u32),
    Body,
}

/// Per two corners what joins them; nothing is asked of a corner and itself.
static JOINS: LazyLock<[[Join; 8]; 8]> = LazyLock::new(|| {
    let mut joins = [[Join::Body; 8]; 8];
    let mut set = |[i, j]: [usize; 2], join| (joins[i][j], joins[j][i]) = (join, join);
    EDGES.into_iter().for_each(|pair| set(pair, Join::Edge));
    for (side, diagonals) in (0..).zip(FACET_DIAGONALS) {
        diagonals.into_iter().for_each(|pair| set(pair, Join::Diagonal(side)));
    }
    joins
});

/// Disjoint sets of a few keys; a key that was never joined is alone. The root is the smallest key.
struct Sets<K>(FxHashMap<K, K>);

impl<K: Copy + Ord + Hash> Sets<K> {
    /// The sets that the links join, if no link closes a cycle.
    fn forest(links: &[[K; 2]]) -> Result<Self, Refusal> {
        let mut sets = Self(FxHashMap::default());
        for &[a, b] in links {
            let (a, b) = (sets.root(a), sets.root(b));
            if a == b {
                return Err(Refusal::Cycle);
            }
            sets.0.insert(a.max(b), a.min(b));
        }
        Ok(sets)
    }

    fn root(&mut self, key: K) -> K {
        let mut root = key;
        while let Some(&up) = self.0.get(&root) {
            root = up;
        }
        let mut at = key;
        while at != root {
            at = self.0.insert(at, root).unwrap_or(root);
        }
        root
    }
}
