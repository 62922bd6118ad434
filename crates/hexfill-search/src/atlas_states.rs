//! [`AtlasStates`]: the parent and the flip of every state, in one word each, read where they lie.
//!
//! Low bits first: 8 bits of the flip's dart, 3 of its kind, then the parent. A word has 4 bytes, or 8 if there are more states than the
//! other 21 bits can number. Little-endian, so that a file or the program itself can hold the table as it is: nothing is unpacked before a look-up.
//!
//! Source: ours.

use crate::flip::Flip;
use std::borrow::Cow;

const FLIP_BITS: u32 = 11;
/// Most states that words of 4 bytes, and short entries of an index, can number.
pub(crate) const MOST_NARROW: usize = 1 << (32 - FLIP_BITS);

/// An immutable table of states. See the module page.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct AtlasStates {
    words: Cow<'static, [u8]>,
    wide: bool,
}

/// Bytes of a word.
pub(crate) const fn word_bytes(wide: bool) -> usize {
    if wide { 8 } else { 4 }
}

impl AtlasStates {
    /// The table of states with these parents and flips.
    pub(crate) fn new(parents: &[u32], flips: &[Flip]) -> Self {
        let wide = parents.len() > MOST_NARROW;
        let mut words = Vec::with_capacity(parents.len() * word_bytes(wide));
        for (&parent, flip) in parents.iter().zip(flips) {
            let word = u64::from(parent) << FLIP_BITS | (flip.kind as u64) << 8 | u64::from(flip.dart);
            words.extend_from_slice(&word.to_le_bytes()[..word_bytes(wide)]);
        }
        Self { words: words.into(), wide }
    }

    /// The table in these bytes, a whole number of words.
    pub(crate) fn from_bytes(words: Cow<'static, [u8]>, wide: bool) -> Self {
        Self { words, wide }
    }

    pub(crate) fn as_bytes(&self) -> &[u8] {
        &self.words
    }

    pub(crate) fn is_wide(&self) -> bool {
        self.wide
    }

    pub(crate) fn len(&self) -> usize {
        self.words.len() / word_bytes(self.wide)
    }

    fn word(&self, state: u32) -> u64 {
        let mut word = [0; 8];
        let n = word_bytes(self.wide);
        let at = n * state as usize;
        word[..n].copy_from_slice(&self.words[at..at + n]);
        u64::from_le_bytes(word)
    }

    /// The state it grew from, one level below.
    pub(crate) fn parent(&self, state: u32) -> u32 {
        (self.word(state) >> FLIP_BITS) as u32
    }

    /// The flip on the parent's canonical cavity. `None` if there is no such flip: the table was then not made by [`Self::new`].
    pub(crate) fn try_flip(&self, state: u32) -> Option<Flip> {
        let [dart, kind, ..] = self.word(state).to_le_bytes();
        Flip::from_bytes([kind & 7, dart])
    }

    /// [`Self::try_flip`] of a table that was checked.
    pub(crate) fn flip(&self, state: u32) -> Flip {
        self.try_flip(state).expect("the table was checked when it was read")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flip::FlipKind;

    #[test]
    fn states_come_back_from_words_of_both_sizes() {
        let flips: Vec<Flip> = (0..=255).flat_map(|dart| FlipKind::ALL.map(|kind| Flip { kind, dart })).collect();
        for largest in [MOST_NARROW as u32 - 1, u32::MAX] {
            let parents: Vec<u32> = (0..flips.len() as u32).map(|s| largest - s).collect();
            let narrow = AtlasStates::new(&parents, &flips);
            let wide = {
                let words = (0..narrow.len()).flat_map(|s| {
                    let word =
                        u64::from(parents[s]) << FLIP_BITS | (flips[s].kind as u64) << 8 | u64::from(flips[s].dart);
                    word.to_le_bytes()
                });
                AtlasStates::from_bytes(words.collect::<Vec<u8>>().into(), true)
            };
            let tables = if largest == u32::MAX { vec![wide] } else { vec![narrow, wide] };
            for table in tables {
                assert_eq!(table.len(), flips.len());
                for (s, (&parent, &flip)) in parents.iter().zip(&flips).enumerate() {
                    assert_eq!((table.parent(s as u32), table.flip(s as u32)), (parent, flip));
                }
            }
        }
    }
}
