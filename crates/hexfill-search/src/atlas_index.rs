//! [`AtlasIndex`]: from the short hash of a class to its states, a table of buckets.
//!
//! Short hashes are uniform in 40 bits, so their leading bits choose one of about `n / 4` buckets of a few entries each, and
//! the other bits, at most 32, share a word with the state: a look-up reads two places in memory. The table is made by
//! one pass of counting; nothing is sorted, as a program that fills one small surface looks up a handful of the half million states.

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
    /// The low 32 bits of a hash, then its state; ascending by state within a bucket.
    entries: Vec<u64>,
}

impl AtlasIndex {
    /// The table of all states whose hash is not `step`; `hashes[s]` is the hash of state `s`, below 2^40.
    pub(crate) fn new(hashes: &[u64], step: u64) -> Self {
        let n = hashes.iter().filter(|&&h| h != step).count();
        let bucket_bits = (n / 4).max(1).ilog2().clamp(FEWEST_BUCKET_BITS, HASH_BITS - 8);
        let shift = HASH_BITS - bucket_bits;
        // Counted one place further on than the start belongs, so that filling a bucket moves its start to where it belongs.
        let mut starts = vec![0u32; (1 << bucket_bits) + 2];
        for &hash in hashes.iter().filter(|&&h| h != step) {
            starts[(hash >> shift) as usize + 2] += 1;
        }
        for b in 1..starts.len() {
            starts[b] += starts[b - 1];
        }
        let mut entries = vec![0; n];
        for (state, &hash) in hashes.iter().enumerate().filter(|&(_, &h)| h != step) {
            let next = &mut starts[(hash >> shift) as usize + 1];
            entries[*next as usize] = hash << 32 | state as u64;
            *next += 1;
        }
        starts.pop();
        Self { bucket_bits, starts, entries }
    }

    /// The states with this hash, ascending.
    pub(crate) fn states_with(&self, hash: u64) -> impl Iterator<Item = u32> + '_ {
        let low = hash as u32;
        self.bucket((hash >> (HASH_BITS - self.bucket_bits)) as usize)
            .iter()
            .filter(move |&&entry| (entry >> 32) as u32 == low)
            .map(|&entry| entry as u32)
    }

    /// The states of each class: classes by hash, states ascending.
    pub(crate) fn classes(&self) -> impl Iterator<Item = Vec<u32>> + '_ {
        (0..self.starts.len().saturating_sub(1)).flat_map(|b| {
            let mut entries = self.bucket(b).to_vec();
            entries.sort_unstable();
            let classes = entries.chunk_by(|a, b| a >> 32 == b >> 32);
            classes.map(|class| class.iter().map(|&entry| entry as u32).collect()).collect::<Vec<Vec<u32>>>()
        })
    }

    fn bucket(&self, b: usize) -> &[u64] {
        match self.starts.get(b..).and_then(|rest| rest.first_chunk()) {
            Some(&[start, end]) => &self.entries[start as usize..end as usize],
            None => &[],
        }
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
                let found: Vec<u32> = index.states_with(wanted).collect();
                let expected: Vec<u32> = (0..n as u32).filter(|&s| hashes[s as usize] == wanted).collect();
                assert_eq!(found, expected);
            }
            let mut classes = std::collections::BTreeMap::<u64, Vec<u32>>::new();
            hashes.iter().zip(0..).filter(|&(&h, _)| h != 0).for_each(|(&h, s)| classes.entry(h).or_default().push(s));
            assert!(index.classes().eq(classes.into_values()));
        }
        assert_eq!(AtlasIndex::default().states_with(9).next(), None);
    }
}
