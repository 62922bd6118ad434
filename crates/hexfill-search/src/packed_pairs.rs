//! [`PackedPairs`]: the blocked pairs of a state in a few words.
//!
//! Source: ours.

use crate::cavity::{MAX_VERTICES, Pairs};

/// Largest cap on the number of quads of a growing ball: what a table of pairs has room for.
pub const MAX_CAP: usize = 44;
const PAIR_WORDS: usize = (MAX_CAP + 2) * (MAX_CAP + 1) / 2 / 64 + 1;

/// Blocked pairs of a canonical cavity, packed: pair (a, b), a < b, is bit `b (b - 1) / 2 + a`.
pub(crate) type PackedPairs = [u64; PAIR_WORDS];

/// Pairs, packed.
pub(crate) fn pack(pairs: &Pairs, n_vertices: usize) -> PackedPairs {
    let mut packed = [0; PAIR_WORDS];
    for (b, row) in pairs.iter().enumerate().take(n_vertices).skip(1) {
        let row = row & ((1 << b) - 1);
        let (word, bit) = ((b * (b - 1) / 2) / 64, (b * (b - 1) / 2) % 64);
        packed[word] |= row << bit;
        if bit + b > 64 {
            packed[word + 1] |= row >> (64 - bit);
        }
    }
    packed
}

/// The pairs of packed ones.
pub(crate) fn unpack(packed: &PackedPairs, n_vertices: usize) -> Pairs {
    let mut pairs = [0; MAX_VERTICES];
    for b in 1..n_vertices {
        let (word, bit) = ((b * (b - 1) / 2) / 64, (b * (b - 1) / 2) % 64);
        let mut row = packed[word] >> bit;
        if bit + b > 64 {
            row |= packed[word + 1] << (64 - bit);
        }
        row &= (1 << b) - 1;
        pairs[b] |= row;
        while row != 0 {
            pairs[row.trailing_zeros() as usize] |= 1 << b;
            row &= row - 1;
        }
    }
    pairs
}

/// Whether all pairs of one are in the other.
pub(crate) fn is_subset(a: &PackedPairs, b: &PackedPairs) -> bool {
    a.iter().zip(b).all(|(a, b)| a & !b == 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packed_pairs_come_back() {
        let mut pairs = [0; MAX_VERTICES];
        let mut state = 1u64;
        for b in 1..MAX_CAP + 2 {
            for a in 0..b {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                if state >> 40 & 1 == 1 {
                    pairs[a] |= 1 << b;
                    pairs[b] |= 1 << a;
                }
            }
        }
        assert_eq!(unpack(&pack(&pairs, MAX_CAP + 2), MAX_CAP + 2), pairs);
    }
}
