//! The pair table: what every two vertices of one cell are to each other.
//!
//! Two hexes meet properly iff no pair of vertices they share is a body diagonal of one, a shared face diagonal is that
//! of the same quad in both, and a shared edge is an edge of both. So it is enough that every pair of vertices has one
//! kind in all cells that hold it (`theory.md`, section 2).

use hexfill_mesh::cube::{BODY_DIAGONALS, EDGES, FACETS};
use rustc_hash::FxHashMap;

/// What two vertices are to each other.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Kind {
    Edge,
    /// Diagonal of the quad whose other diagonal is this pair.
    Diagonal([u32; 2]),
    Body,
}

/// The kinds of all pairs, with a log so that the latest can be taken back.
#[derive(Clone, Debug, Default)]
pub(crate) struct PairKinds {
    kinds: FxHashMap<[u32; 2], Kind>,
    log: Vec<[u32; 2]>,
}

fn pair(a: u32, b: u32) -> [u32; 2] {
    if a < b { [a, b] } else { [b, a] }
}

impl PairKinds {
    /// The kind of a pair, if any cell holds it.
    pub fn get(&self, a: u32, b: u32) -> Option<Kind> {
        self.kinds.get(&pair(a, b)).copied()
    }

    fn put(&mut self, a: u32, b: u32, kind: Kind) -> bool {
        match self.kinds.entry(pair(a, b)) {
            std::collections::hash_map::Entry::Occupied(old) => *old.get() == kind && kind != Kind::Body,
            std::collections::hash_map::Entry::Vacant(free) => {
                free.insert(kind);
                self.log.push(pair(a, b));
                true
            }
        }
    }

    /// Enters a quad; false if one of its pairs has another kind.
    pub fn put_quad(&mut self, [a, b, c, d]: [u32; 4]) -> bool {
        [[a, b], [b, c], [c, d], [d, a]].into_iter().all(|[x, y]| self.put(x, y, Kind::Edge))
            && self.put(a, c, Kind::Diagonal(pair(b, d)))
            && self.put(b, d, Kind::Diagonal(pair(a, c)))
    }

    /// Enters a hex; false if one of its pairs has another kind.
    pub fn put_hex(&mut self, hex: &[u32; 8]) -> bool {
        EDGES.iter().all(|&[i, j]| self.put(hex[i], hex[j], Kind::Edge))
            && FACETS.iter().all(|f| {
                let [a, b, c, d] = f.map(|i| hex[i]);
                self.put(a, c, Kind::Diagonal(pair(b, d))) && self.put(b, d, Kind::Diagonal(pair(a, c)))
            })
            && BODY_DIAGONALS.iter().all(|&[i, j]| self.put(hex[i], hex[j], Kind::Body))
    }

    /// A mark to [`take_back`](Self::take_back) to.
    pub fn mark(&self) -> usize {
        self.log.len()
    }

    /// Takes back what was entered since `mark`.
    pub fn take_back(&mut self, mark: usize) {
        for pair in self.log.drain(mark..) {
            self.kinds.remove(&pair);
        }
    }
}
