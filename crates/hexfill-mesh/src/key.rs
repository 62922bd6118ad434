//! Weill's key of a surface: for each quad the lengths of the two chords through it, as a multiset of pairs.
//!
//! The length of a chord is the number of distinct quads it passes (a quad where it crosses itself counts once).
//! Printed as `8x[8,16] 8x[16,16]`, pairs ascending. The key is an invariant, not a name: different surfaces may share it.
//!
//! Source: Weill.

use crate::chords::{Chord, chords, chords_by_quad};
use crate::surface::QuadSurface;
use std::collections::BTreeMap;
use std::fmt;
use std::str::FromStr;

/// The key of a surface. See the module page.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
pub struct Key {
    /// Number of quads by pair of chord lengths, the smaller length first.
    counts: BTreeMap<[usize; 2], usize>,
}

impl Key {
    /// Number of quads by pair of chord lengths `[shorter, longer]`, pairs ascending.
    pub fn counts(&self) -> impl Iterator<Item = ([usize; 2], usize)> + '_ {
        self.counts.iter().map(|(&pair, &n)| (pair, n))
    }

    /// Number of quads in all.
    pub fn n_quads(&self) -> usize {
        self.counts.values().sum()
    }
}

/// The key of a surface. Linear time.
///
/// # Example
/// ```
/// use hexfill_mesh::{Key, QuadSurface, key};
///
/// let quads = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
/// let key = key(&QuadSurface::try_new(8, &quads)?);
/// assert_eq!(key.to_string(), "6x[4,4]");
/// assert_eq!("6x[4,4]".parse::<Key>()?, key);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn key(surface: &QuadSurface) -> Key {
    key_of_chords(surface, &chords(surface))
}

/// As [`key`], from the [`chords`] of the surface.
pub fn key_of_chords(surface: &QuadSurface, chords: &[Chord]) -> Key {
    let mut counts = BTreeMap::new();
    for [i, j] in chords_by_quad(surface, chords) {
        let (a, b) = (chords[i].length(), chords[j].length());
        *counts.entry([a.min(b), a.max(b)]).or_insert(0) += 1;
    }
    Key { counts }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, ([a, b], n)) in self.counts().enumerate() {
            write!(f, "{}{n}x[{a},{b}]", if i == 0 { "" } else { " " })?;
        }
        Ok(())
    }
}

/// Why a text is not a [`Key`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum KeyError {
    /// No item at all.
    #[error("the key is empty; expected items such as 6x[4,4]")]
    Empty,
    /// An item of another form.
    #[error("'{given}' is not an item of a key; expected COUNTx[LENGTH,LENGTH] such as 8x[8,16]")]
    BadItem {
        /// The item.
        given: String,
    },
    /// A number of quads or a length of zero.
    #[error("'{given}' has a zero; counts and chord lengths are positive")]
    Zero {
        /// The item.
        given: String,
    },
    /// More quads than a surface may have.
    #[error("the key counts more quads than the limit {limit}")]
    TooLarge {
        /// The limit.
        limit: usize,
    },
}

impl FromStr for Key {
    type Err = KeyError;

    /// Reads items separated by white space, in any order; equal pairs are added up.
    fn from_str(text: &str) -> Result<Self, KeyError> {
        let mut key = Self::default();
        let mut total = 0usize;
        for item in text.split_whitespace() {
            let bad = || KeyError::BadItem { given: item.chars().take(40).collect() };
            let number = |s: &str| {
                let digits = !s.is_empty() && s.bytes().all(|b| b.is_ascii_digit());
                if digits { s.parse::<usize>().map_err(|_| bad()) } else { Err(bad()) }
            };
            let (n, pair) = item.split_once("x[").ok_or_else(bad)?;
            let (a, b) = pair.strip_suffix(']').and_then(|p| p.split_once(',')).ok_or_else(bad)?;
            let (n, a, b) = (number(n)?, number(a)?, number(b)?);
            if n == 0 || a == 0 || b == 0 {
                return Err(KeyError::Zero { given: item.into() });
            }
            total = total
                .checked_add(n)
                .filter(|&t| t <= QuadSurface::MAX_QUADS)
                .ok_or(KeyError::TooLarge { limit: QuadSurface::MAX_QUADS })?;
            *key.counts.entry([a.min(b), a.max(b)]).or_insert(0) += n;
        }
        if total == 0 { Err(KeyError::Empty) } else { Ok(key) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{all_spheres, cube_surface, octagonal_spindle, schneiders_pyramid};

    #[test]
    fn published_keys() {
        assert_eq!(key(&cube_surface()).to_string(), "6x[4,4]");
        assert_eq!(key(&schneiders_pyramid()).to_string(), "8x[8,16] 8x[16,16]");
        assert_eq!(key(&octagonal_spindle()).to_string(), "8x[8,8]");
    }

    #[test]
    fn keys_are_read_back() {
        for s in (6..=12).flat_map(all_spheres) {
            let k = key(&s);
            assert_eq!(k.n_quads(), s.n_quads());
            assert_eq!(k.to_string().parse::<Key>().unwrap(), k);
        }
        assert_eq!("8x[16,16]  8x[16,8]".parse::<Key>().unwrap().to_string(), "8x[8,16] 8x[16,16]");
    }

    #[test]
    fn bad_keys_are_refused() {
        assert_eq!("".parse::<Key>(), Err(KeyError::Empty));
        for bad in
            ["6x[4,4", "6[4,4]", "x[4,4]", "6x[4]", "6x[4,4,4]", "-6x[4,4]", "+6x[4,4]", "6x[é,4]", "6x[4,4]7x[5,5]"]
        {
            assert!(matches!(bad.parse::<Key>(), Err(KeyError::BadItem { .. })), "{bad}");
        }
        assert!(matches!("0x[4,4]".parse::<Key>(), Err(KeyError::Zero { .. })));
        assert!(matches!("99999999999x[4,4]".parse::<Key>(), Err(KeyError::TooLarge { .. })));
        assert!("99999999999999999999999999x[4,4]".parse::<Key>().is_err());
    }
}
