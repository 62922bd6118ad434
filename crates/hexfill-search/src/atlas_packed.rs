//! The *packed* form of an atlas, which ships: its tables as they are looked up, so that nothing is unpacked when a program starts.
//!
//! Magic, xxh3-64 of the rest; five numbers (whether states are wide, bits of a bucket, levels, states, named states) and the first state of each
//! level, 4 bytes each; the [words of the states](crate::atlas_states); the [index](crate::atlas_index): starts, entries. All numbers little-endian.
//!
//! Source: ours.

use crate::atlas::Atlas;
use crate::atlas_index::{AtlasIndex, HASH_BITS, Shape};
use crate::atlas_states::{AtlasStates, word_bytes};
use std::borrow::Cow;
use std::io::{self, Write};
use xxhash_rust::xxh3::xxh3_64;

pub(crate) const PACKED_MAGIC: &[u8; 8] = b"HXATLAS2";
const HEADER_BYTES: usize = 8 + 8;

impl Atlas {
    /// Writes the packed form.
    ///
    /// # Errors
    /// Whatever the writer says.
    pub fn write_packed(&self, out: &mut impl Write) -> io::Result<()> {
        let wide = u32::from(self.states.is_wide());
        let counts = [self.level_starts.len(), self.n_states(), self.index.len()].map(|n| n as u32);
        let numbers =
            [wide, self.index.bucket_bits()].into_iter().chain(counts).chain(self.level_starts.iter().copied());
        let mut body: Vec<u8> = numbers.flat_map(u32::to_le_bytes).collect();
        body.extend_from_slice(self.states.as_bytes());
        self.index.as_bytes().into_iter().for_each(|bytes| body.extend_from_slice(bytes));
        out.write_all(PACKED_MAGIC)?;
        out.write_all(&xxh3_64(&body).to_le_bytes())?;
        out.write_all(&body)
    }

    /// Reads the packed form.
    ///
    /// # Errors
    /// What is wrong with the bytes.
    pub fn read_packed(bytes: &[u8]) -> Result<Self, &'static str> {
        let body = bytes.strip_prefix(PACKED_MAGIC).ok_or("not a packed atlas of this version")?;
        let (sum, body) = body.split_first_chunk().ok_or("truncated")?;
        if xxh3_64(body) != u64::from_le_bytes(*sum) {
            return Err("checksum does not match");
        }
        let atlas = Self::of_body(body, |table| Cow::Owned(table.to_vec())).ok_or("a table has another length")?;
        atlas.is_sound().then_some(atlas).ok_or("a state, flip or bucket that does not exist")
    }

    /// An atlas that is part of the program: looked up where it lies, and not checked at each start (a test does).
    pub(crate) fn compiled_in(bytes: &'static [u8]) -> Self {
        Self::of_body(&bytes[HEADER_BYTES..], Cow::Borrowed).expect("the shipped atlas is intact")
    }

    /// The tables in the bytes after the header, if their lengths are right.
    fn of_body<'a>(mut body: &'a [u8], table: impl Fn(&'a [u8]) -> Cow<'static, [u8]>) -> Option<Self> {
        let mut number = || {
            let (bytes, rest) = body.split_first_chunk()?;
            body = rest;
            Some(u32::from_le_bytes(*bytes))
        };
        let (wide, bucket_bits) = (number()?, number()?);
        let [n_levels, n_states, n_named] = [number()?, number()?, number()?].map(|n| n as usize);
        let level_starts: Vec<u32> = (0..n_levels).map_while(|_| number()).collect();
        let wide = wide == 1;
        if level_starts.len() < n_levels || !(Shape::fewest_bucket_bits(wide)..HASH_BITS - 7).contains(&bucket_bits) {
            return None;
        }
        let shape = Shape::new(bucket_bits, wide);
        let (starts, entries) = shape.bytes(n_named);
        let (states, body) = body.split_at_checked(n_states * word_bytes(wide))?;
        let (starts, body) = body.split_at_checked(starts)?;
        if body.len() != entries {
            return None;
        }
        Some(Self {
            level_starts,
            states: AtlasStates::from_bytes(table(states), wide),
            index: AtlasIndex::from_bytes(shape, table(starts), table(body)),
        })
    }

    /// Whether every state grew from one on the level below by a flip that there is, and the index knows no others.
    fn is_sound(&self) -> bool {
        let n = self.n_states();
        let ends = self.level_starts.iter().skip(1).copied().chain([n as u32]);
        let mut below = 0..0;
        for (level, (&start, end)) in self.level_starts.iter().zip(ends).enumerate() {
            let grew = |s| if level == 0 { self.states.parent(s) == 0 } else { below.contains(&self.states.parent(s)) };
            // One cube, and one alone, has no parent.
            if start != below.end || end <= start || end as usize > n || level == 0 && end != 1 {
                return false;
            }
            if !(start..end).all(|s| grew(s) && self.states.try_flip(s).is_some()) {
                return false;
            }
            below = start..end;
        }
        n > 0 && below.end as usize == n && self.index.is_sound(n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{GrowOptions, Growth};
    use hexfill_mesh::Context;

    fn grown() -> Atlas {
        let mut growth = Growth::new(GrowOptions { cap: 18, width: 2 });
        while growth.level() < 9 {
            growth.grow(&Context::default());
        }
        Atlas::from_growth(&growth)
    }

    #[test]
    fn packed_atlases_come_back_and_damage_is_noticed() {
        let atlas = grown();
        for atlas in [atlas.pruned(1, |quads, _| quads <= 14), atlas] {
            let mut bytes = Vec::new();
            atlas.write_packed(&mut bytes).unwrap();
            assert_eq!(Atlas::read_packed(&bytes).unwrap(), atlas);
            for at in 0..bytes.len() {
                bytes[at] ^= 0x10;
                assert!(Atlas::read_packed(&bytes).is_err(), "byte {at}");
                bytes[at] ^= 0x10;
                assert!(Atlas::read_packed(&bytes[..at]).is_err());
            }
        }
    }

    #[test]
    fn tables_that_point_outside_are_refused_though_their_checksum_is_right() {
        let mut bytes = Vec::new();
        grown().pruned(1, |quads, _| quads <= 10).write_packed(&mut bytes).unwrap();
        for at in (HEADER_BYTES..HEADER_BYTES + 400).chain(bytes.len() - 400..bytes.len()) {
            for flip in [0x10, 0x80] {
                let mut bad = bytes.clone();
                bad[at] ^= flip;
                let sum = xxh3_64(&bad[HEADER_BYTES..]).to_le_bytes();
                bad[8..HEADER_BYTES].copy_from_slice(&sum);
                // A flip that exists but is not legal is found when it is replayed.
                if let Ok(atlas) = Atlas::read_packed(&bad) {
                    atlas.stats();
                    (0..atlas.n_states() as u32).for_each(|s| drop(crate::Ball::replay(atlas.flips_to(s))));
                }
            }
        }
    }

    #[test]
    fn what_is_compiled_in_is_intact() {
        for (bytes, atlas) in [
            (include_bytes!("../data/default.hxatlas").as_slice(), Atlas::embedded()),
            (include_bytes!("../data/spheres-20.hxatlas").as_slice(), Atlas::fewest()),
        ] {
            assert_eq!(&Atlas::read_packed(bytes).unwrap(), atlas);
        }
    }
}
