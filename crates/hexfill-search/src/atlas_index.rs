//! [`AtlasIndex`]: from the short hash of a class to its states, a table of buckets.
//!
//! Short hashes are uniform in 40 bits, so their leading bits choose one of about `n / 4` buckets of a few entries each, and
//! the other bits share an entry with the state: a look-up reads two places in memory. The table is made by one pass of counting; nothing is
//! sorted. It lies in bytes, little-endian, as a file or the program itself holds it: nothing is read before a look-up.
//!
//! Source: ours.

use crate::atlas_states::MOST_NARROW;
use std::borrow::Cow;

/// Bits of a short hash.
pub(crate) const HASH_BITS: u32 = 40;

/// An immutable table from short hashes to states.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct AtlasIndex {
    shape: Shape,
    /// First entry of each bucket, and the end: 4 bytes each.
    starts: Cow<'static, [u8]>,
    /// The state, then the bits of its hash that did not choose the bucket; ascending by state within a bucket.
    entries: Cow<'static, [u8]>,
}

/// How many bits and bytes mean what.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Shape {
    /// How many leading bits of a hash choose its bucket.
    pub bucket_bits: u32,
    /// Bits of a state in an entry.
    state_bits: u32,
    entry_bytes: usize,
}

impl Shape {
    /// Entries of 6 bytes, or 8 where states are wide.
    pub(crate) fn new(bucket_bits: u32, wide: bool) -> Self {
        let (state_bits, entry_bytes) = if wide { (u32::BITS, 8) } else { (MOST_NARROW.ilog2(), 6) };
        Self { bucket_bits, state_bits, entry_bytes }
    }

    /// At least so many bits choose the bucket: the others fit beside a state.
    pub(crate) fn fewest_bucket_bits(wide: bool) -> u32 {
        let shape = Self::new(0, wide);
        HASH_BITS - (8 * shape.entry_bytes as u32 - shape.state_bits)
    }

    /// Bytes of the starts, and of `n` entries.
    pub(crate) fn bytes(self, n: usize) -> (usize, usize) {
        (4 * ((1 << self.bucket_bits) + 1), n * self.entry_bytes)
    }

    fn bucket(self, hash: u64) -> usize {
        (hash >> (HASH_BITS - self.bucket_bits)) as usize
    }

    /// The bits of a hash that do not choose its bucket.
    fn low(self, hash: u64) -> u64 {
        hash & ((1 << (HASH_BITS - self.bucket_bits)) - 1)
    }
}

impl Default for AtlasIndex {
    fn default() -> Self {
        Self::new(&[], 0, false)
    }
}

impl AtlasIndex {
    /// The table of all states whose hash is not `step`; `hashes[s]` is the hash of state `s`, below 2^40. `wide` if there are more than
    /// [`MOST_NARROW`] states.
    pub(crate) fn new(hashes: &[u64], step: u64, wide: bool) -> Self {
        let n = hashes.iter().filter(|&&h| h != step).count();
        let bucket_bits = (n / 4).max(1).ilog2().clamp(Shape::fewest_bucket_bits(wide), HASH_BITS - 8);
        let shape = Shape::new(bucket_bits, wide);
        // Counted one place further on than the start belongs, so that filling a bucket moves its start to where it belongs.
        let mut starts = vec![0u32; (1 << bucket_bits) + 2];
        for &hash in hashes.iter().filter(|&&h| h != step) {
            starts[shape.bucket(hash) + 2] += 1;
        }
        for b in 1..starts.len() {
            starts[b] += starts[b - 1];
        }
        let mut entries = vec![0; n * shape.entry_bytes];
        for (state, &hash) in hashes.iter().enumerate().filter(|&(_, &h)| h != step) {
            let next = &mut starts[shape.bucket(hash) + 1];
            let entry = shape.low(hash) << shape.state_bits | state as u64;
            let at = shape.entry_bytes * *next as usize;
            entries[at..at + shape.entry_bytes].copy_from_slice(&entry.to_le_bytes()[..shape.entry_bytes]);
            *next += 1;
        }
        starts.pop();
        let starts: Vec<u8> = starts.into_iter().flat_map(u32::to_le_bytes).collect();
        Self { shape, starts: starts.into(), entries: entries.into() }
    }

    /// The table in these bytes, which have the lengths that the shape tells.
    pub(crate) fn from_bytes(shape: Shape, starts: Cow<'static, [u8]>, entries: Cow<'static, [u8]>) -> Self {
        Self { shape, starts, entries }
    }

    /// Starts, then entries.
    pub(crate) fn as_bytes(&self) -> [&[u8]; 2] {
        [&self.starts, &self.entries]
    }

    pub(crate) fn bucket_bits(&self) -> u32 {
        self.shape.bucket_bits
    }

    /// Number of entries.
    pub(crate) fn len(&self) -> usize {
        self.entries.len() / self.shape.entry_bytes
    }

    /// Whether the buckets follow one another, and all their states are below `n_states`.
    pub(crate) fn is_sound(&self, n_states: usize) -> bool {
        let buckets = 0..1 << self.shape.bucket_bits;
        self.start(0) == 0
            && self.start(buckets.end) == self.len()
            && buckets.clone().all(|b| self.start(b) <= self.start(b + 1))
            && buckets.into_iter().flat_map(|b| self.bucket(b)).all(|(_, state)| (state as usize) < n_states)
    }

    /// The states with this hash, ascending.
    pub(crate) fn states_with(&self, hash: u64) -> impl Iterator<Item = u32> + '_ {
        let low = self.shape.low(hash);
        self.bucket(self.shape.bucket(hash)).filter(move |&(other, _)| other == low).map(|(_, state)| state)
    }

    /// The states of each class: classes by hash, states ascending.
    pub(crate) fn classes(&self) -> impl Iterator<Item = Vec<u32>> + '_ {
        (0..1 << self.shape.bucket_bits).flat_map(|b| {
            let mut entries: Vec<(u64, u32)> = self.bucket(b).collect();
            entries.sort_unstable();
            let classes = entries.chunk_by(|a, b| a.0 == b.0);
            classes.map(|class| class.iter().map(|&(_, state)| state).collect()).collect::<Vec<Vec<u32>>>()
        })
    }

    /// The hash of each of `n` states; `step` for those that are not here.
    pub(crate) fn hashes(&self, n: usize, step: u64) -> Vec<u64> {
        let mut hashes = vec![step; n];
        for b in 0..1 << self.shape.bucket_bits {
            for (low, state) in self.bucket(b) {
                hashes[state as usize] = (b as u64) << (HASH_BITS - self.shape.bucket_bits) | low;
            }
        }
        hashes
    }

    fn start(&self, bucket: usize) -> usize {
        let at = self.starts[4 * bucket..].first_chunk().expect("the last start is the end");
        u32::from_le_bytes(*at) as usize
    }

    /// The entries of a bucket: low bits of the hash, state.
    fn bucket(&self, b: usize) -> impl Iterator<Item = (u64, u32)> + '_ {
        let Shape { state_bits, entry_bytes, .. } = self.shape;
        self.entries[self.start(b) * entry_bytes..self.start(b + 1) * entry_bytes].chunks_exact(entry_bytes).map(
            move |bytes| {
                let mut entry = [0; 8];
                entry[..bytes.len()].copy_from_slice(bytes);
                let entry = u64::from_le_bytes(entry);
                (entry >> state_bits, (entry & ((1 << state_bits) - 1)) as u32)
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_state_is_found_under_its_hash_in_order_and_nothing_else() {
        for n in [0u64, 1, 5, 3000] {
            let mask = (1 << HASH_BITS) - 1;
            // Some states are steps, some share a hash, some share all bits but the leading or the last.
            let hash = |i: u64| match i % 5 {
                0 => 0,
                1 => (i / 50 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 24 & mask,
                2 => i << 32 & mask | 7,
                3 => 0xff_ffff_ff00 | (i & 3),
                _ => i + 1,
            };
            let hashes: Vec<u64> = (0..n).map(hash).collect();
            for wide in [false, true] {
                let index = AtlasIndex::new(&hashes, 0, wide);
                assert!(index.is_sound(n as usize));
                assert_eq!(index.hashes(n as usize, 0), hashes);
                let [starts, entries] = index.as_bytes().map(<[u8]>::to_vec);
                let shape = Shape::new(index.bucket_bits(), wide);
                assert_eq!(shape.bytes(index.len()), (starts.len(), entries.len()));
                assert_eq!(AtlasIndex::from_bytes(shape, starts.into(), entries.into()), index);
                for wanted in hashes.iter().copied().chain([3, mask]).filter(|&h| h != 0) {
                    let found: Vec<u32> = index.states_with(wanted).collect();
                    let expected: Vec<u32> = (0..n as u32).filter(|&s| hashes[s as usize] == wanted).collect();
                    assert_eq!(found, expected);
                }
                let mut classes = std::collections::BTreeMap::<u64, Vec<u32>>::new();
                let named = hashes.iter().zip(0..).filter(|&(&h, _)| h != 0);
                named.for_each(|(&h, s)| classes.entry(h).or_default().push(s));
                assert!(index.classes().eq(classes.into_values()));
            }
        }
        assert_eq!(AtlasIndex::default().states_with(9).next(), None);
    }
}
