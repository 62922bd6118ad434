//! Union-find with parity over hexes, shared by all threads without locks.
//!
//! Each entry holds `parent << 1 | parity`, parity 1 meaning "ordered in the sense opposite to the parent". A root is
//! the smallest index of its part whatever the order of the unions, so parts and colours do not depend on the threads.
//! Concurrent linking by compare-and-swap after Anderson and Woll (1991); path halving keeps every relation true.
//!
//! Source: Anderson and Woll 1991; the parity in the lowest bit is ours.

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

pub(crate) struct ParityForest {
    entries: Vec<AtomicU32>,
}

impl ParityForest {
    /// `n` singletons, `n < 2^31`.
    pub(crate) fn new(n: usize) -> Self {
        Self { entries: (0..n as u32).map(|i| AtomicU32::new(i << 1)).collect() }
    }

    /// The root of `i`, and whether `i` is opposite to it.
    pub(crate) fn find(&self, i: u32) -> (u32, bool) {
        let (mut at, mut parity) = (i, 0);
        loop {
            let entry = self.entries[at as usize].load(Relaxed);
            let parent = entry >> 1;
            if parent == at {
                return (at, parity != 0);
            }
            let above = self.entries[parent as usize].load(Relaxed);
            if above >> 1 != parent {
                // Point at the grandparent; a failed exchange only means that somebody else did better.
                let shortcut = above ^ (entry & 1);
                let _ = self.entries[at as usize].compare_exchange_weak(entry, shortcut, Relaxed, Relaxed);
            }
            parity ^= entry & 1;
            at = parent;
        }
    }

    /// Joins the parts of `a` and `b`, which are in opposite senses iff `opposite`. `false` if they were already joined
    /// with the other relation: that part cannot be oriented.
    pub(crate) fn union(&self, a: u32, b: u32, opposite: bool) -> bool {
        loop {
            let (ra, pa) = self.find(a);
            let (rb, pb) = self.find(b);
            let parity = pa ^ pb ^ opposite;
            if ra == rb {
                return !parity;
            }
            let (low, high) = (ra.min(rb), ra.max(rb));
            let linked = low << 1 | u32::from(parity);
            if self.entries[high as usize].compare_exchange(high << 1, linked, Relaxed, Relaxed).is_ok() {
                return true;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayon::prelude::*;

    #[test]
    fn a_long_chain_joined_in_any_order_is_one_part_with_alternating_senses() {
        let n = 100_000;
        let forest = ParityForest::new(n);
        assert!((0..n as u32 - 1).into_par_iter().all(|i| forest.union(i, i + 1, true)));
        assert!((0..n as u32).all(|i| forest.find(i) == (0, i % 2 == 1)));
        assert!(forest.union(0, n as u32 - 1, true));
        assert!(!forest.union(0, n as u32 - 2, true), "an odd cycle is refused");
    }
}
