//! [`PairTable`]: how two vertices are joined by what is already there, which decides rule R2 in constant time a hex.
//!
//! Two cells (hexes, or quads of the surface) meet properly iff every pair of vertices that both hold is an edge of both, or a
//! diagonal of one quad that both hold; a body diagonal belongs to one hex only. (Proof: `topology/star.rs` of `hexfill-check`.) So each pair has one
//! kind, and a diagonal names its quad by the quad's other two corners.
//! Invariant: `count` is the number of cells that hold the pair, at most 2 for a diagonal and 1 for a body diagonal.
//!
//! Source: ours; the lemma is proved on the page of `topology/star.rs` in `hexfill-check`.

use hexfill_mesh::cube::{BODY_DIAGONALS, EDGES, FACET_DIAGONALS};
use rustc_hash::FxHashMap;
use std::collections::hash_map::Entry;

/// What joins two vertices.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Join {
    /// An edge.
    Edge,
    /// A diagonal of the quad whose other two corners, smaller first, are given.
    Diagonal(u32, u32),
    /// A body diagonal of a hex.
    Body,
}

/// A joined pair and the number of cells that hold it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Pair {
    join: Join,
    count: u32,
}

/// A pair and what it was before: enough to take a change back.
pub(crate) type OldPair = (u64, Option<Pair>);

/// The pairs of all cells, each with its kind. See the module page.
#[derive(Clone, Default, PartialEq, Eq, Debug)]
pub(crate) struct PairTable(FxHashMap<u64, Pair>);

#[inline]
fn key(a: u32, b: u32) -> u64 {
    u64::from(a.min(b)) << 32 | u64::from(a.max(b))
}

#[inline]
fn diagonal(a: u32, b: u32) -> Join {
    Join::Diagonal(a.min(b), a.max(b))
}

/// The 28 pairs of a hex.
fn pairs_of_hex(h: &[u32; 8]) -> impl Iterator<Item = (u32, u32, Join)> + '_ {
    let edges = EDGES.iter().map(|&[i, j]| (h[i], h[j], Join::Edge));
    let diagonals = FACET_DIAGONALS
        .iter()
        .flat_map(|&[[i, j], [k, l]]| [(h[i], h[j], diagonal(h[k], h[l])), (h[k], h[l], diagonal(h[i], h[j]))]);
    edges.chain(diagonals).chain(BODY_DIAGONALS.iter().map(|&[i, j]| (h[i], h[j], Join::Body)))
}

/// The pairs of a hex that are others once it has other corners: before and after.
fn changed<'h>(
    before: &'h [u32; 8],
    after: &'h [u32; 8],
) -> impl Iterator<Item = ((u32, u32, Join), (u32, u32, Join))> + 'h {
    pairs_of_hex(before).zip(pairs_of_hex(after)).filter(|(b, a)| b != a)
}

/// The 6 pairs of a quad.
fn pairs_of_quad(q: &[u32; 4]) -> [(u32, u32, Join); 6] {
    let [a, b, c, d] = *q;
    [
        (a, b, Join::Edge),
        (b, c, Join::Edge),
        (c, d, Join::Edge),
        (d, a, Join::Edge),
        (a, c, diagonal(b, d)),
        (b, d, diagonal(a, c)),
    ]
}

impl PairTable {
    /// What joins two vertices, if anything.
    pub(crate) fn join(&self, a: u32, b: u32) -> Option<Join> {
        self.0.get(&key(a, b)).map(|p| p.join)
    }

    /// Adds a pair; `false` if it clashes with what is there. `old` receives what it was.
    fn add(&mut self, (a, b, join): (u32, u32, Join), old: &mut impl FnMut(OldPair)) -> bool {
        if a == b {
            return false;
        }
        let most = match join {
            Join::Edge => u32::MAX,
            Join::Diagonal(..) => 2,
            Join::Body => 1,
        };
        let key = key(a, b);
        match self.0.entry(key) {
            Entry::Vacant(free) => {
                old((key, None));
                free.insert(Pair { join, count: 1 });
            }
            Entry::Occupied(mut there) => {
                let before = *there.get();
                if before.join != join || before.count >= most {
                    return false;
                }
                old((key, Some(before)));
                there.get_mut().count += 1;
            }
        }
        true
    }

    /// Takes a pair of a cell out again.
    fn remove(&mut self, (a, b, join): (u32, u32, Join), old: &mut impl FnMut(OldPair)) {
        let key = key(a, b);
        let before = self.0.get(&key).copied();
        debug_assert!(before.is_some_and(|p| p.join == join), "a cell that was added is taken out");
        old((key, before));
        match before {
            Some(p) if p.count > 1 => self.0.insert(key, Pair { count: p.count - 1, ..p }),
            _ => self.0.remove(&key),
        };
    }

    /// Adds the pairs of a hex; `false` at the first clash (what was added by then is in `old`).
    pub(crate) fn add_hex(&mut self, hex: &[u32; 8], mut old: impl FnMut(OldPair)) -> bool {
        pairs_of_hex(hex).all(|p| self.add(p, &mut old))
    }

    /// Takes those pairs of a hex out that it will not have once its corners are `after`.
    pub(crate) fn remove_changed(&mut self, before: &[u32; 8], after: &[u32; 8], mut old: impl FnMut(OldPair)) {
        changed(before, after).for_each(|(p, _)| self.remove(p, &mut old));
    }

    /// Adds those pairs of a hex that it did not have when its corners were `before`; `false` at the first clash.
    pub(crate) fn add_changed(&mut self, before: &[u32; 8], after: &[u32; 8], mut old: impl FnMut(OldPair)) -> bool {
        changed(before, after).all(|(_, p)| self.add(p, &mut old))
    }

    /// Adds the pairs of a quad of the surface; `false` at the first clash.
    pub(crate) fn add_quad(&mut self, quad: &[u32; 4]) -> bool {
        pairs_of_quad(quad).into_iter().all(|p| self.add(p, &mut |_| ()))
    }

    /// Puts a pair back to what it was.
    pub(crate) fn restore(&mut self, (key, before): OldPair) {
        match before {
            Some(pair) => self.0.insert(key, pair),
            None => self.0.remove(&key),
        };
    }

    /// Checks that the table is that of these cells; for tests.
    ///
    /// # Panics
    /// If it is not.
    pub(crate) fn debug_check(&self, hexes: &[[u32; 8]], quads: &[[u32; 4]]) {
        let mut again = Self::default();
        assert!(quads.iter().all(|q| again.add_quad(q)), "the surface is proper");
        assert!(hexes.iter().all(|h| again.add_hex(h, |_| ())), "the hexes are proper");
        assert_eq!(self.0, again.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_hexes_may_share_a_quad_and_no_more() {
        let mut table = PairTable::default();
        assert!(table.add_hex(&[0, 1, 2, 3, 4, 5, 6, 7], |_| ()));
        assert_eq!(table.join(0, 6), Some(Join::Body));
        assert_eq!(table.join(7, 5), Some(Join::Diagonal(4, 6)));
        assert_eq!(table.join(0, 8), None);
        let before = table.clone();
        // On the top facet: fine; on the top facet twisted: its diagonals are edges.
        for (hex, fine) in [([4, 5, 6, 7, 8, 9, 10, 11], true), ([4, 6, 5, 7, 8, 9, 10, 11], false)] {
            let mut old = Vec::new();
            assert_eq!(table.add_hex(&hex, |o| old.push(o)), fine);
            if fine {
                // A third cell on the same quad is one too many.
                assert!(!table.clone().add_hex(&[4, 5, 6, 7, 12, 13, 14, 15], |_| ()));
            }
            old.into_iter().rev().for_each(|o| table.restore(o));
            assert_eq!(table.0, before.0);
        }
    }
}
