//! Orbits under the automorphisms found so far: union-find over flag indices, with a mark for orbits that need no further test.
//!
//! Invariant: members of one orbit have the same code, so what one test shows holds for all of them.
//!
//! Source: McKay 1998 for pruning by automorphisms; orbits of flags in a forest are ours.

#[derive(Default)]
pub(crate) struct Orbits {
    /// By index of the flag, which may exceed 2^32.
    parent: Vec<usize>,
    done: Vec<bool>,
}

impl Orbits {
    /// Makes each of the given indices (below `n`) an orbit of its own; the table is kept from one use to the next.
    pub(crate) fn reset(&mut self, n: usize, indices: impl Iterator<Item = usize>) {
        if self.parent.len() < n {
            self.parent.resize(n, 0);
            self.done.resize(n, false);
        }
        for i in indices {
            self.parent[i] = i;
            self.done[i] = false;
        }
    }

    fn root(&mut self, mut i: usize) -> usize {
        while self.parent[i] != i {
            let grand = self.parent[self.parent[i]];
            self.parent[i] = grand;
            i = grand;
        }
        i
    }

    pub(crate) fn same(&mut self, a: usize, b: usize) -> bool {
        self.root(a) == self.root(b)
    }

    pub(crate) fn is_done(&mut self, i: usize) -> bool {
        let root = self.root(i);
        self.done[root]
    }

    /// Marks the orbit of `i` as one that cannot have the smallest code.
    pub(crate) fn finish(&mut self, i: usize) {
        let root = self.root(i);
        self.done[root] = true;
    }

    pub(crate) fn union(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        let (low, high) = (a.min(b), a.max(b));
        self.parent[high] = low;
        self.done[low] |= self.done[high];
    }
}

/// One step of a hash with a fixed specification (it decides which flags are tried, so it is part of a signature's version).
pub(crate) fn mix(hash: u64, number: u32) -> u64 {
    let x = (hash ^ u64::from(number)).wrapping_add(0x9E37_79B9_7F4A_7C15).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x ^ (x >> 29)
}

/// Keeps the flags whose kind has the fewest flags, of equally rare kinds the smallest.
pub(crate) fn keep_rarest<T: Copy>(flags: &mut Vec<T>, mut kind: impl FnMut(T) -> u64) {
    let kinds: Vec<u64> = flags.iter().map(|&f| kind(f)).collect();
    let rarest = if kinds.len() < 512 {
        let mut sorted = kinds.clone();
        sorted.sort_unstable();
        sorted.chunk_by(|a, b| a == b).map(|run| (run.len(), run[0])).min()
    } else {
        let mut counts: rustc_hash::FxHashMap<u64, usize> = Default::default();
        for &k in &kinds {
            *counts.entry(k).or_default() += 1;
        }
        counts.into_iter().map(|(k, n)| (n, k)).min()
    };
    let mut at = 0;
    flags.retain(|_| {
        at += 1;
        rarest.is_some_and(|(_, k)| kinds[at - 1] == k)
    });
}
