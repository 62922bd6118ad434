//! [`Tally`]: what is counted, in a form that adds up over chunks, threads and machines in any order.
//!
//! The mass sums are exact: the automorphism group of a complex of n cubes acts freely on its 48 n flags, so
//! 1 / |Aut| is a multiple of 1 / [`MASS_UNIT`] for every n up to 12.
//!
//! Source: ours; the orbit-stabiliser theorem.

use crate::boundary::Boundary;
use crate::canonical::Labelling;
use crate::complex::Complex;
use crate::shape::{self, Shape};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Masses are counted in units of 1 / 1330560: 48 times the least common multiple of 1..=12.
pub const MASS_UNIT: u128 = 48 * 27720;

/// Counts by a small number, in ascending order.
#[derive(Clone, PartialEq, Eq, Debug, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Histogram<K: Ord>(pub BTreeMap<K, u64>);

impl<K: Ord + Clone> Histogram<K> {
    /// Adds `n` at `key`.
    #[inline]
    pub fn add(&mut self, key: K, n: u64) {
        *self.0.entry(key).or_insert(0) += n;
    }

    /// Adds all counts of another.
    pub fn merge(&mut self, other: &Self) {
        for (key, n) in &other.0 {
            self.add(key.clone(), *n);
        }
    }

    /// Sum of the counts.
    pub fn total(&self) -> u64 {
        self.0.values().sum()
    }

    /// Smallest key.
    pub fn min(&self) -> Option<&K> {
        self.0.keys().next()
    }
}

/// Counts of one level: children tried, classes found and their shapes.
#[derive(Clone, PartialEq, Eq, Debug, Default, Serialize, Deserialize)]
pub struct Tally {
    /// Parents extended.
    pub parents: u64,
    /// Legal new cubes, summed over the parents ("raw").
    pub raw: u64,
    /// The same by number of glued facets.
    pub raw_by_glued: Histogram<u8>,
    /// Legal new cubes that give a closed complex (counted in `raw` too).
    pub raw_closed: u64,
    /// Classes up to isomorphism, reflections included.
    pub classes: u64,
    /// Classes that differ from their mirror image: with mirror images distinct there are `classes + chiral`. Not counted
    /// (0) in runs with non-orientable gluings.
    pub chiral: u64,
    /// Classes without boundary.
    pub closed: u64,
    /// Balls: orientable, every vertex link a disk or a sphere, boundary one sphere, Euler characteristic 1.
    pub balls: u64,
    /// Classes that the selection asks for.
    pub selected: u64,
    /// By number of chords of the boundary.
    pub chords: Histogram<u8>,
    /// By number of boundary quads.
    pub boundary_quads: Histogram<u8>,
    /// By number of vertices.
    pub vertices: Histogram<u8>,
    /// By order of the automorphism group.
    pub automorphisms: Histogram<u16>,
    /// By Euler characteristic of the complex.
    pub euler: Histogram<i16>,
    /// By genera of the boundary components ("0+1": a sphere and a torus).
    pub boundary_genera: Histogram<String>,
    /// Sum of the 128-bit hashes of the canonical codes, modulo 2^128: independent of order.
    #[serde(with = "hex128")]
    pub hash_sum: u128,
    /// Sum over the legal new cubes of [`MASS_UNIT`] / |Aut(parent)|.
    #[serde(with = "hex128")]
    pub mass_of_parents: u128,
    /// Sum over the classes of [`MASS_UNIT`] * (cubes that may be removed) / |Aut|.
    #[serde(with = "hex128")]
    pub mass_of_children: u128,
}

impl Tally {
    /// Adds another tally.
    pub fn merge(&mut self, other: &Self) {
        self.parents += other.parents;
        self.raw += other.raw;
        self.raw_by_glued.merge(&other.raw_by_glued);
        self.raw_closed += other.raw_closed;
        self.classes += other.classes;
        self.chiral += other.chiral;
        self.closed += other.closed;
        self.balls += other.balls;
        self.selected += other.selected;
        self.chords.merge(&other.chords);
        self.boundary_quads.merge(&other.boundary_quads);
        self.vertices.merge(&other.vertices);
        self.automorphisms.merge(&other.automorphisms);
        self.euler.merge(&other.euler);
        self.boundary_genera.merge(&other.boundary_genera);
        self.hash_sum = self.hash_sum.wrapping_add(other.hash_sum);
        self.mass_of_parents += other.mass_of_parents;
        self.mass_of_children += other.mass_of_children;
    }

    /// Classes with at most `k` chords.
    pub fn with_at_most_chords(&self, k: u8) -> u64 {
        self.chords.0.range(..=k).map(|(_, n)| n).sum()
    }

    /// Whether the two sides of the mass formula agree.
    pub fn mass_balances(&self) -> bool {
        self.mass_of_parents == self.mass_of_children
    }
}

/// A tally in the making: flat arrays, so that counting an object costs a few additions.
#[derive(Clone)]
pub(crate) struct Counter {
    tally: Tally,
    raw_by_glued: [u64; 8],
    chords: [u64; 128],
    quads: [u64; 64],
    vertices: [u64; 64],
    automorphisms: [u64; 1 + 48 * 12],
    euler: [u64; 256],
    genera: BTreeMap<crate::boundary::Components, u64>,
    nonorientable: bool,
}

impl Counter {
    /// `nonorientable`: whether complexes may be so; then mirror images are not counted.
    pub(crate) fn new(nonorientable: bool) -> Self {
        Self {
            nonorientable,
            tally: Tally::default(),
            raw_by_glued: [0; 8],
            chords: [0; 128],
            quads: [0; 64],
            vertices: [0; 64],
            automorphisms: [0; 1 + 48 * 12],
            euler: [0; 256],
            genera: BTreeMap::new(),
        }
    }

    pub(crate) fn parent(&mut self) {
        self.tally.parents += 1;
    }

    /// A legal new cube on a parent with the given number of automorphisms.
    #[inline]
    pub(crate) fn raw(&mut self, glued: u8, parent_automorphisms: u16) {
        self.tally.raw += 1;
        self.raw_by_glued[glued as usize & 7] += 1;
        self.tally.mass_of_parents += MASS_UNIT / u128::from(parent_automorphisms);
    }

    #[inline]
    pub(crate) fn raw_closed(&mut self) {
        self.tally.raw_closed += 1;
    }

    #[inline]
    pub(crate) fn removable(&mut self, n: u32, automorphisms: u16) {
        self.tally.mass_of_children += MASS_UNIT / u128::from(automorphisms) * u128::from(n);
    }

    /// A new class. Returns its shape and boundary for further use.
    pub(crate) fn class(&mut self, c: &Complex, labelling: &Labelling, hash: u128) -> (Boundary, Shape) {
        let orientable = !self.nonorientable || c.is_orientable();
        debug_assert!(self.nonorientable || c.is_oriented(), "the extension keeps the orientation");
        let boundary = Boundary::of(c);
        let shape = shape::measure(c, &boundary, orientable);
        let t = &mut self.tally;
        t.classes += 1;
        t.chiral += u64::from(!self.nonorientable && !labelling.reversing);
        t.closed += u64::from(boundary.n_quads() == 0);
        t.balls += u64::from(shape.is_ball);
        t.hash_sum = t.hash_sum.wrapping_add(hash);
        self.chords[shape.chords as usize & 127] += 1;
        self.quads[boundary.n_quads() & 63] += 1;
        self.vertices[shape.vertices as usize & 63] += 1;
        self.automorphisms[(labelling.automorphisms as usize).min(48 * 12)] += 1;
        self.euler[(shape.euler + 128).clamp(0, 255) as usize] += 1;
        *self.genera.entry(shape.components).or_insert(0) += 1;
        (boundary, shape)
    }

    pub(crate) fn selected(&mut self) {
        self.tally.selected += 1;
    }

    pub(crate) fn finish(self) -> Tally {
        let mut t = self.tally;
        fn fill<K: Ord + Clone>(to: &mut Histogram<K>, from: &[u64], key: impl Fn(usize) -> K) {
            for (i, &n) in from.iter().enumerate().filter(|(_, n)| **n > 0) {
                to.add(key(i), n);
            }
        }
        fill(&mut t.raw_by_glued, &self.raw_by_glued, |i| i as u8);
        fill(&mut t.chords, &self.chords, |i| i as u8);
        fill(&mut t.boundary_quads, &self.quads, |i| i as u8);
        fill(&mut t.vertices, &self.vertices, |i| i as u8);
        fill(&mut t.automorphisms, &self.automorphisms, |i| i as u16);
        fill(&mut t.euler, &self.euler, |i| i as i16 - 128);
        for (components, n) in self.genera {
            t.boundary_genera.add(components.text(), n);
        }
        t
    }
}

/// 128-bit numbers as 32 hexadecimal digits: JSON readers lose digits of large numbers.
mod hex128 {
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    pub(super) fn serialize<S: Serializer>(x: &u128, s: S) -> Result<S::Ok, S::Error> {
        s.serialize_str(&format!("{x:032x}"))
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(d: D) -> Result<u128, D::Error> {
        let text = String::deserialize(d)?;
        u128::from_str_radix(&text, 16).map_err(D::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canonical::canonical;

    #[test]
    fn tallies_add_up_in_any_order_and_survive_json() {
        let cube = Complex::cube();
        let mut one = Counter::new(false);
        one.parent();
        one.raw(1, 48);
        let label = canonical(&cube);
        one.class(&cube, &label, label.code.hash128());
        one.removable(1, 48);
        let one = one.finish();
        assert_eq!((one.classes, one.balls, one.chiral, one.with_at_most_chords(3)), (1, 1, 0, 1));
        assert!(one.mass_balances());
        let mut two = one.clone();
        two.merge(&one);
        let mut three = one.clone();
        three.merge(&two);
        two.merge(&one);
        assert_eq!(two, three);
        let text = serde_json::to_string(&three).unwrap();
        assert_eq!(serde_json::from_str::<Tally>(&text).unwrap(), three);
    }
}
