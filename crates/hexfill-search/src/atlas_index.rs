//! [`AtlasIndex`]: from the short hash of a class to its states, a table of buckets.
//!
//! Short hashes are uniform in 40 bits, so their leading bits choose one of about `n / 4` buckets of a few entries each, and
//! the other bits, at most 32, share a word with the state: a look-up reads two places in memory, and the table is made by
//! one pass of counting instead of a sort of everything.

/// Bits of a short hash.
pub(crate) const HASH_BITS: u32 = 40;
/// At least so many bits choose the bucket: the others fit beside a state.
const FEWEST_BUCKET_BITS: u32 = HASH_BITS - 32;

/// An immutable table from short hashes to states.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct AtlasIndex {
    /// How many leading bits of a hash choose its bucket.
    bucket_bits: u32,
    /// First entry of each bucket, and the end.
    starts: Vec<u32>,
    /// The low 32 bits of a hash, then its state; ascending within a bucket.
    entries: Vec<u64>,
}

/// The state of an entry.
pub(crate) const fn state_of(entry: u64) -> u32 {
    entry as u32
}

impl AtlasIndex {
    /// The table of all states whose hash is not `step`; `hashes[s]` is the hash of state `s`, below 2^40.
    pub(crate) fn new(hashes: &[u64], step: u64) -> Self {
        let n = hashes.iter().filter(|&&h| h != step).count();
        let bucket_bits = (n / 4).max(1).ilog2().clamp(FEWEST_BUCKET_BITS, HASH_BITS - 8);
        let shift = HASH_BITS - bucket_bits;
        let mut starts = vec![0u32; (1 << bucket_bits) + 1];
        for &hash in hashes.iter().filter(|&&h| h != step) {
            starts[(hash >> shift) as usize + 1] += 1;
        }
        for b in 1..starts.len() {
            starts[b] += starts[b - 1];
        }
        let mut ends = starts.clone();
        let mut entries = vec![0; n];
        for (state, &hash) in hashes.iter().enumerate().filter(|&(_, &h)| h != step) {
            let end = &mut ends[(hash >> shift) as usize];
            entries[*end as usize] = hash << 32 | state as u64;
            *end += 1;
        }
        for bucket in starts.windows(2) {
            entries[bucket[0] as usize..bucket[1] as usize].sort_unstable();
        }
        Self { bucket_bits, starts, entries }
    }

    /// The entries of the states with this hash, ascending by state.
    pub(crate) fn entries_with(&self, hash: u64) -> &[u64] {
        let bucket = (hash >> (HASH_BITS - self.bucket_bits)) as usize;
        let Some(&[start, end]) = self.starts.get(bucket..).and_then(|rest| rest.first_chunk()) else {
            return &[];
        };
        let bucket = &self.entries[start as usize..end as usize];
        let low = hash as u32;
        let first = bucket.partition_point(|&e| ((e >> 32) as u32) < low);
        let len = bucket[first..].iter().take_while(|&&e| (e >> 32) as u32 == low).count();
        &bucket[first..first + len]
    }

    /// The entries of each class, classes by hash, states ascending.
    pub(crate) fn classes(&self) -> impl Iterator<Item = &[u64]> {
        self.starts
            .windows(2)
            .flat_map(|b| self.entries[b[0] as usize..b[1] as usize].chunk_by(|a, b| a >> 32 == b >> 32))
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
            let index = AtlasIndex::new(&hashes, 0);
            for wanted in hashes.iter().copied().chain([3, mask]).filter(|&h| h != 0) {
                let found: Vec<u32> = index.entries_with(wanted).iter().map(|&e| state_of(e)).collect();
                let expected: Vec<u32> = (0..n as u32).filter(|&s| hashes[s as usize] == wanted).collect();
                assert_eq!(found, expected);
            }
            let listed: Vec<u64> = index.classes().map(|c| hashes[state_of(c[0]) as usize]).collect();
            let mut distinct: Vec<u64> = hashes.iter().copied().filter(|&h| h != 0).collect();
            distinct.sort_unstable();
            distinct.dedup();
            assert_eq!(listed, distinct);
        }
        assert!(AtlasIndex::default().entries_with(9).is_empty());
    }
}
