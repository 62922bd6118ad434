//! Canonical form of a complex: the least breadth-first code over its flags.
//!
//! A *flag* is a cube and one of its 48 frames. Walking breadth first from a flag, sides in frame order, numbers
//! cubes and vertices; the code lists, per new cube, the facet it was reached through and the numbers of its four
//! far corners. The code determines the complex, so the least code over all flags is a canonical form, and the
//! flags that attain it are the images of one flag under the automorphism group, which acts freely on flags.
//!
//! Only the flags of the rarest class of a cheap invariant are tried, and a flag is given up as soon as its code
//! exceeds the best. Reflections count as isomorphisms (all 48 frames). No other canonical labelling program is
//! needed; nauty serves as an oracle outside this crate.
//!
//! The form depends on the constants in this file: [`FORM_VERSION`] goes into every ledger.
//!
//! Source: Brinkmann, McKay 2007 (codes of plane graphs), for cubes ours.

use crate::complex::{Complex, FREE, MAX_CUBES, MAX_VERTICES};
use crate::error::EnumerateError;
use crate::frames::{COMPOSE, FRAMES, FRAMES_AT, JOINED, MIRROR, SIDE, SIDE_CORNERS};
use hexfill_mesh::cube::CORNER_NEIGHBOURS;

/// Number of the canonical form; raised whenever a change alters any code.
pub const FORM_VERSION: u32 = 1;

/// A canonical code: per cube after the first, one word of five bytes: the facet it was reached through
/// (`6 * position + side`), then the numbers of the four far corners.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Code {
    n_cubes: u8,
    words: [u64; MAX_CUBES - 1],
}

impl Code {
    /// Number of cubes.
    pub fn n_cubes(&self) -> usize {
        self.n_cubes as usize
    }

    /// The bytes of the code: the number of cubes, then five per cube after the first.
    pub fn write_bytes<'a>(&self, buffer: &'a mut [u8; 1 + 5 * (MAX_CUBES - 1)]) -> &'a [u8] {
        buffer[0] = self.n_cubes;
        let used = self.n_cubes() - 1;
        for (slot, word) in buffer[1..].chunks_exact_mut(5).zip(&self.words[..used]) {
            slot.copy_from_slice(&word.to_be_bytes()[3..]);
        }
        &buffer[..1 + 5 * used]
    }

    /// The code from its bytes.
    ///
    /// # Errors
    /// [`EnumerateError::BadCode`] if the length does not fit the number of cubes.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, EnumerateError> {
        let n = bytes.first().copied().unwrap_or(0) as usize;
        if n == 0 || n > MAX_CUBES || bytes.len() != 1 + 5 * (n - 1) {
            return Err(EnumerateError::BadCode { given: hex_text(bytes), why: "its length is wrong".into() });
        }
        let mut words = [0; MAX_CUBES - 1];
        for (word, b) in words.iter_mut().zip(bytes[1..].chunks_exact(5)) {
            *word = u64::from_be_bytes([0, 0, 0, b[0], b[1], b[2], b[3], b[4]]);
        }
        Ok(Self { n_cubes: n as u8, words })
    }

    /// xxh3-128 of the bytes: a hash with a fixed specification, which may be persisted.
    pub fn hash128(&self) -> u128 {
        let mut buffer = [0; 1 + 5 * (MAX_CUBES - 1)];
        xxhash_rust::xxh3::xxh3_128(self.write_bytes(&mut buffer))
    }

    /// The code as text: two hexadecimal digits a byte.
    pub fn to_text(&self) -> String {
        let mut buffer = [0; 1 + 5 * (MAX_CUBES - 1)];
        hex_text(self.write_bytes(&mut buffer))
    }

    /// The complex with this code, its cubes in the order of the code; positively oriented if it is orientable.
    ///
    /// # Errors
    /// [`EnumerateError::BadCode`] or [`EnumerateError::BadComplex`] if no complex has this code.
    pub fn decode(&self) -> Result<Complex, EnumerateError> {
        let bad = |why: &str| Err(EnumerateError::BadCode { given: self.to_text(), why: why.into() });
        let mut cubes = [[0u8; 8]; MAX_CUBES];
        cubes[0] = [0, 1, 2, 3, 4, 5, 6, 7];
        for (i, word) in self.words[..self.n_cubes() - 1].iter().enumerate() {
            let (from, side) = ((word >> 32) as usize / 6, (word >> 32) as usize % 6);
            if from > i {
                return bad("a cube is reached from a later one");
            }
            let mut cube = [0u8; 8];
            for k in SIDE_CORNERS[side] {
                cube[MIRROR[side / 2][k as usize] as usize] = cubes[from][k as usize];
            }
            for (k, corner) in SIDE_CORNERS[side].into_iter().enumerate() {
                cube[corner as usize] = (word >> (24 - 8 * k)) as u8;
            }
            cubes[i + 1] = cube;
        }
        Complex::from_cubes(&cubes[..self.n_cubes()])
    }
}

impl std::str::FromStr for Code {
    type Err = EnumerateError;

    fn from_str(text: &str) -> Result<Self, EnumerateError> {
        let bad = |why: &str| EnumerateError::BadCode { given: text.into(), why: why.into() };
        if !text.is_ascii() || !text.len().is_multiple_of(2) {
            return Err(bad("an even number of hexadecimal digits is needed"));
        }
        let bytes: Result<Vec<u8>, _> =
            (0..text.len() / 2).map(|i| u8::from_str_radix(&text[2 * i..2 * i + 2], 16)).collect();
        Self::from_bytes(&bytes.map_err(|_| bad("only hexadecimal digits are possible"))?)
    }
}

fn hex_text(bytes: &[u8]) -> String {
    use std::fmt::Write;
    bytes.iter().fold(String::new(), |mut text, b| {
        // Writing to a string cannot fail.
        let _ = write!(text, "{b:02x}");
        text
    })
}

/// What [`canonical`] finds besides the code.
#[derive(Clone, Copy, Debug)]
pub struct Labelling {
    /// The canonical code.
    pub code: Code,
    /// Order of the automorphism group, reflections included.
    pub automorphisms: u16,
    /// For an oriented complex: whether some automorphism reverses the orientation (then it equals its mirror image).
    pub reversing: bool,
    /// Per cube: its first position over all canonical labellings. Two cubes are in one orbit of the automorphism
    /// group exactly if these are equal.
    pub first_position: [u8; MAX_CUBES],
}

#[inline]
fn mix(x: u64) -> u64 {
    let x = (x ^ (x >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x ^ (x >> 32)
}

/// Weight of a vertex in the sum of a cube, by the number of cubes round it.
static DEGREE_WEIGHT: [u64; 16] = {
    let mut out = [0; 16];
    let mut i = 0;
    let mut x = 0x9e37_79b9_7f4a_7c15u64;
    while i < 16 {
        x ^= x << 13;
        x ^= x >> 7;
        x ^= x << 17;
        out[i] = x;
        i += 1;
    }
    out
};

/// Number of cubes round each vertex.
#[inline]
pub(crate) fn cube_degrees(c: &Complex) -> [u8; MAX_VERTICES] {
    let mut degree = [0u8; MAX_VERTICES];
    for cube in c.cubes() {
        for &v in cube {
            degree[v as usize & 63] += 1;
        }
    }
    degree
}

/// An invariant of each cube under isomorphism: degrees of its vertices, its gluings, and the same of its neighbours.
#[inline]
pub(crate) fn cube_invariants(c: &Complex) -> [u64; MAX_CUBES] {
    let degree = cube_degrees(c);
    let mut first = [0u64; MAX_CUBES];
    for (slot, cube) in first.iter_mut().zip(c.cubes()) {
        *slot = mix(cube
            .iter()
            .fold(0u64, |sum, &v| sum.wrapping_add(DEGREE_WEIGHT[degree[v as usize & 63] as usize & 15])));
    }
    let mut second = [0u64; MAX_CUBES];
    for a in 0..c.n_cubes() {
        let mut sum = first[a];
        for f in 0..6 {
            let b = c.next[a][f];
            if b != FREE {
                // Whether the cube goes straight on behind tells a bar from a bend.
                let straight = u64::from(c.next[a][f ^ 1] != FREE);
                sum = sum.wrapping_add(mix(first[b as usize % MAX_CUBES].wrapping_add(straight)) | 1);
            }
        }
        second[a] = mix(sum);
    }
    second
}

/// The canonical labelling of a complex. A few hundred nanoseconds at seven cubes.
///
/// # Example
/// Two cubes side by side, in two numberings.
/// ```
/// use hexfill_enumerate::{Complex, canonical};
///
/// let a = canonical(&Complex::from_cubes(&[[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11]])?);
/// let b = canonical(&Complex::from_cubes(&[[11, 8, 9, 10, 7, 4, 5, 6], [7, 4, 5, 6, 3, 0, 1, 2]])?);
/// assert_eq!(a.code, b.code);
/// assert_eq!(a.automorphisms, 16); // of a square prism, mirror images counted
/// # Ok::<(), hexfill_enumerate::EnumerateError>(())
/// ```
pub fn canonical(c: &Complex) -> Labelling {
    let invariants = cube_invariants(c);
    search(c, &invariants)
}

/// As [`canonical`], with the cubes' invariants at hand.
pub(crate) fn search(c: &Complex, invariants: &[u64; MAX_CUBES]) -> Labelling {
    let n = c.n_cubes();
    let mut walk =
        Walk { c, best: [u64::MAX; MAX_CUBES - 1], automorphisms: 0, signs: 0, first_position: [u8::MAX; MAX_CUBES] };
    // The rarest class of cubes, the smallest value among equals.
    let mut chosen = (usize::MAX, 0u64);
    for &value in &invariants[..n] {
        // Quadratic, in at most twelve values.
        let count = invariants[..n].iter().filter(|&&other| other == value).count();
        chosen = chosen.min((count, value));
    }
    // Values of vertices, and from them of the corners of the chosen cubes.
    let mut value = [0u64; MAX_VERTICES];
    for (cube, &w) in c.cubes().iter().zip(invariants) {
        let w = mix(w);
        for &v in cube {
            let slot = &mut value[v as usize & 63];
            *slot = slot.wrapping_add(w);
        }
    }
    let mut corners = [(0u8, 0u8); 8 * MAX_CUBES];
    let mut corner_values = [0u64; 8 * MAX_CUBES];
    let mut n_corners = 0;
    for (a, cube) in c.cubes().iter().enumerate() {
        if invariants[a] != chosen.1 {
            continue;
        }
        let at = cube.map(|v| value[v as usize & 63]);
        for (i, &own) in at.iter().enumerate() {
            let [x, y, z] = CORNER_NEIGHBOURS[i];
            corners[n_corners] = (a as u8, i as u8);
            corner_values[n_corners] =
                own.wrapping_mul(3).wrapping_add(mix(at[x]).wrapping_add(mix(at[y])).wrapping_add(mix(at[z])));
            n_corners += 1;
        }
    }
    let mut rarest = (usize::MAX, 0u64);
    let values = &corner_values[..n_corners];
    for &v in values {
        let count = values.iter().filter(|&&other| other == v).count();
        rarest = rarest.min((count, v));
    }
    for (&(a, i), &v) in corners.iter().zip(values) {
        if v != rarest.1 {
            continue;
        }
        let cube = &c.cubes[a as usize % MAX_CUBES];
        for s in FRAMES_AT[i as usize & 7] {
            // Directions in ascending order of the value behind them; equal ones both ways.
            let frame = &FRAMES[s as usize];
            let [x, y, z] = [1, 3, 4].map(|k: usize| value[cube[frame[k] as usize & 7] as usize & 63]);
            // The order of directions is part of the invariant, so of six frames at a corner one is left, or those
            // that ties make equal.
            if x <= y && y <= z {
                walk.start_at(a as usize, s as usize);
            }
        }
    }
    Labelling {
        code: Code { n_cubes: c.n_cubes, words: walk.finished() },
        automorphisms: walk.automorphisms,
        reversing: walk.signs == 0b11,
        first_position: walk.first_position,
    }
}

/// As [`canonical`], trying all flags: slower and independent of the invariants, for tests.
pub fn canonical_over_all_flags(c: &Complex) -> Labelling {
    let mut walk =
        Walk { c, best: [u64::MAX; MAX_CUBES - 1], automorphisms: 0, signs: 0, first_position: [u8::MAX; MAX_CUBES] };
    for a in 0..c.n_cubes() {
        for s in 0..48 {
            walk.start_at(a, s);
        }
    }
    Labelling {
        code: Code { n_cubes: c.n_cubes, words: walk.finished() },
        automorphisms: walk.automorphisms,
        reversing: walk.signs == 0b11,
        first_position: walk.first_position,
    }
}

/// The walks from flags, and the best code so far.
struct Walk<'a> {
    c: &'a Complex,
    best: [u64; MAX_CUBES - 1],
    automorphisms: u16,
    /// Bit 0: some best flag is a rotation; bit 1: some is a reflection.
    signs: u8,
    first_position: [u8; MAX_CUBES],
}

impl Walk<'_> {
    /// Words beyond the last cube are zero, so that codes of one size compare and hash as arrays.
    fn finished(&self) -> [u64; MAX_CUBES - 1] {
        let mut words = self.best;
        for word in &mut words[self.c.n_cubes() - 1..] {
            *word = 0;
        }
        words
    }

    /// Walks breadth first from one flag and keeps the code if it is the least so far.
    #[inline]
    fn start_at(&mut self, cube: usize, frame: usize) {
        let c = self.c;
        let n = c.n_cubes();
        let mut label = [u8::MAX; MAX_VERTICES];
        for i in 0..8 {
            label[c.cubes[cube % MAX_CUBES][FRAMES[frame % 48][i] as usize & 7] as usize & 63] = i as u8;
        }
        let mut next_label = 8u8;
        let mut order = [0u8; MAX_CUBES];
        let mut frames = [0u8; MAX_CUBES];
        order[0] = cube as u8;
        frames[0] = frame as u8;
        let mut visited = 1u16 << cube;
        let mut found = 1;
        let mut words = [u64::MAX; MAX_CUBES - 1];
        let mut less = self.automorphisms == 0;
        let mut at = 0;
        'walk: while found < n {
            let (a, s) = (order[at] as usize % MAX_CUBES, frames[at] as usize % 48);
            for f in 0..6 {
                let side = SIDE[s][f] as usize % 6;
                let b = c.next[a][side];
                if b == FREE || visited >> (b & 15) & 1 == 1 {
                    continue;
                }
                visited |= 1 << (b & 15);
                // The frame pushed through the facet: from the first flag on no further choice is made, so the code
                // is that of the flag alone.
                let t = COMPOSE[c.across[a][side] as usize % 48][s];
                let other = &c.cubes[b as usize % MAX_CUBES];
                let seen = &FRAMES[t as usize % 48];
                let mut word = (6 * at + f) as u64;
                for corner in SIDE_CORNERS[f] {
                    let slot = &mut label[other[seen[corner as usize & 7] as usize & 7] as usize & 63];
                    if *slot == u8::MAX {
                        *slot = next_label;
                        next_label += 1;
                    }
                    word = word << 8 | u64::from(*slot);
                }
                let index = found - 1;
                words[index] = word;
                if !less {
                    if word > self.best[index] {
                        return;
                    }
                    // Codes that tie to the end belong to flags that an automorphism carries to each other;
                    // automorphisms act freely on flags, so the ties count the group.
                    less = word < self.best[index];
                }
                order[found] = b;
                frames[found] = t;
                found += 1;
                if found == n {
                    break 'walk;
                }
            }
            at += 1;
        }
        if less {
            self.best = words;
            self.automorphisms = 0;
            self.signs = 0;
            self.first_position = [u8::MAX; MAX_CUBES];
        }
        self.automorphisms += 1;
        // Rotations come first in the table of frames.
        self.signs |= if frame < 24 { 1 } else { 2 };
        for (i, &b) in order[..n].iter().enumerate() {
            let slot = &mut self.first_position[b as usize % MAX_CUBES];
            *slot = (*slot).min(i as u8);
        }
    }
}

// The corner table is used by the rule checks; keep the two views of the cube in step.
const _: () = assert!(JOINED[0] == 1 << 1 | 1 << 3 | 1 << 4);

#[cfg(test)]
mod tests {
    use super::*;

    /// The complex with cubes and vertices permuted and every cube seen in another frame.
    fn shuffled(c: &Complex, seed: u64) -> Complex {
        let mut state = seed.wrapping_mul(2).wrapping_add(1);
        let mut random = |n: usize| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 33) as usize % n
        };
        let mut names: Vec<u8> = (0..c.n_vertices() as u8).collect();
        for i in (1..names.len()).rev() {
            names.swap(i, random(i + 1));
        }
        let mut cubes: Vec<[u8; 8]> = c.cubes().to_vec();
        for i in (1..cubes.len()).rev() {
            cubes.swap(i, random(i + 1));
        }
        let reflect = 24 * random(2);
        for cube in &mut cubes {
            let old = cube.map(|v| names[v as usize]);
            *cube = FRAMES[reflect + random(24)].map(|i| old[i as usize]);
        }
        Complex::from_cubes(&cubes).unwrap()
    }

    fn samples() -> Vec<Complex> {
        [
            vec![[0, 1, 2, 3, 4, 5, 6, 7]],
            vec![[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11]],
            vec![[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11], [8, 9, 10, 11, 0, 1, 2, 3]],
            // The ring of five bent cubes of the design page.
            vec![
                [0, 1, 2, 3, 4, 5, 6, 7],
                [0, 1, 5, 4, 8, 9, 10, 11],
                [1, 2, 6, 5, 12, 13, 14, 15],
                [4, 0, 8, 11, 16, 17, 14, 13],
                [2, 6, 14, 13, 18, 19, 8, 11],
            ],
        ]
        .into_iter()
        .map(|cubes| Complex::from_cubes(&cubes).unwrap())
        .collect()
    }

    #[test]
    fn the_form_does_not_depend_on_names() {
        for c in samples() {
            assert!(c.across[..c.n_cubes()].iter().flatten().all(|&t| t < 24), "the sample is oriented");
            let expected = canonical(&c);
            let slow = canonical_over_all_flags(&c);
            assert_eq!(expected.automorphisms, slow.automorphisms);
            assert_eq!(expected.reversing, slow.reversing);
            for seed in 0..200 {
                let other = shuffled(&c, seed);
                let found = canonical(&other);
                assert_eq!(found.code, expected.code);
                assert_eq!(found.automorphisms, expected.automorphisms);
                assert_eq!(found.reversing, expected.reversing);
                assert_eq!(canonical_over_all_flags(&other).code, slow.code);
            }
            let back = expected.code.decode().unwrap();
            assert!(back.across[..c.n_cubes()].iter().flatten().all(|&t| t < 24), "decoding keeps the orientation");
            assert_eq!(canonical(&back).code, expected.code);
            assert_eq!(expected.code.to_text().parse::<Code>().unwrap(), expected.code);
        }
    }

    #[test]
    fn groups_of_known_complexes() {
        let orders: Vec<u16> = samples().iter().map(|c| canonical(c).automorphisms).collect();
        assert_eq!(orders[..3], [48, 16, 48]);
        assert!(samples()[..3].iter().all(|c| canonical(c).reversing));
    }

    #[test]
    fn bad_codes_are_refused() {
        for text in ["", "0", "zz", "00", "02", "0205010203", "02ff08090a0b", "ä"] {
            assert!(text.parse::<Code>().and_then(|c| c.decode()).is_err(), "{text}");
        }
    }
}
