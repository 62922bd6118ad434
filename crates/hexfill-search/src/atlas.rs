//! [`Atlas`]: boundary class -> smallest known fillings, each stored as the flips that shell it from one cube.
//!
//! A state costs a parent, a flip and the hash of its class. The hash only points: a filling is replayed and its
//! boundary compared before it is handed out, so a clash of hashes costs time and never a wrong answer.
//!
//! Source: Verhetsel et al. 2019, figure 1 (meshes of small cavities computed once and looked up); kept as flips, by class and blocked pairs, is ours.

use crate::atlas_index::{AtlasIndex, HASH_BITS};
use crate::atlas_states::AtlasStates;
use crate::ball::Ball;
use crate::canonical::Canonical;
use crate::cavity::Cavity;
use crate::flip::Flip;
use crate::grow::{Growth, class_hash};
use std::sync::LazyLock;

/// Marks a state that is kept as a step to others only.
pub(crate) const STEP: u64 = 0;

/// A class hash shortened for storage; never [`STEP`].
pub(crate) fn short_hash(class: u128) -> u64 {
    ((class >> (128 - HASH_BITS)) as u64).max(1)
}

/// An immutable table of fillings. See the module page.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Atlas {
    /// First state of each level; level 1 is the cube.
    pub(crate) level_starts: Vec<u32>,
    /// Per state: the state it grew from (one level below), the flip on that state's canonical cavity.
    pub(crate) states: AtlasStates,
    /// The states that are more than steps, by the short hash of their class, then ascending (fewest hexes first).
    pub(crate) index: AtlasIndex,
}

/// Counts of an atlas.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AtlasStats {
    /// States in all, steps included.
    pub states: usize,
    /// Per number of quads.
    pub classes: std::collections::BTreeMap<usize, ClassStats>,
    /// Number of levels.
    pub levels: usize,
}

/// Counts over the classes with one number of quads, of the smallest filling of each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ClassStats {
    /// How many classes have a filling.
    pub classes: usize,
    /// Hexes.
    pub hexes: Spread,
    /// Interior vertices.
    pub interior: Spread,
}

/// The spread of a number over some classes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Spread {
    /// The smallest.
    pub fewest: u32,
    /// The one in the middle; the smaller of two.
    pub median: u32,
    /// The largest.
    pub most: u32,
    /// Their sum.
    pub sum: u64,
}

impl Spread {
    fn of(mut values: Vec<u32>) -> Self {
        values.sort_unstable();
        let at = |i: usize| values.get(i).copied().unwrap_or(0);
        let last = values.len().saturating_sub(1);
        Self { fewest: at(0), median: at(last / 2), most: at(last), sum: values.iter().map(|&v| u64::from(v)).sum() }
    }
}

impl Atlas {
    pub(crate) fn from_parts(level_starts: Vec<u32>, parents: Vec<u32>, flips: Vec<Flip>, hashes: Vec<u64>) -> Self {
        let states = AtlasStates::new(&parents, &flips);
        let index = AtlasIndex::new(&hashes, STEP, states.is_wide());
        Self { level_starts, states, index }
    }

    /// All states of a growth.
    pub fn from_growth(growth: &Growth) -> Self {
        let mut hashes = vec![STEP; growth.states.len()];
        for (class, newest) in growth.classes() {
            let mut at = newest;
            while at != u32::MAX {
                hashes[at as usize] = short_hash(class);
                at = growth.states[at as usize].previous;
            }
        }
        Self::from_parts(
            growth.level_starts.clone(),
            growth.states.iter().map(|s| s.parent).collect(),
            growth.states.iter().map(|s| s.flip).collect(),
            hashes,
        )
    }

    /// The atlas compiled into the library, looked up where it lies. It was made by `hexfill atlas build` and `atlas prune`; see `record/`.
    pub fn embedded() -> &'static Self {
        static ATLAS: LazyLock<Atlas> = LazyLock::new(|| Atlas::compiled_in(include_bytes!("../data/default.hxatlas")));
        &ATLAS
    }

    /// The smallest fillings known of all 54,943 3-connected spheres of up to 20 quads, compiled into the library. For connectivity alone: where positions
    /// are wanted the [embedded](Self::embedded) atlas serves better, whose fillings have more hexes and embed more often. Made by `hexfill atlas complete`;
    /// see `record/`.
    pub fn fewest() -> &'static Self {
        static ATLAS: LazyLock<Atlas> =
            LazyLock::new(|| Atlas::compiled_in(include_bytes!("../data/spheres-20.hxatlas")));
        &ATLAS
    }

    /// Number of states, steps included.
    pub fn n_states(&self) -> usize {
        self.states.len()
    }

    /// The short hash of the class of each state, or [`STEP`].
    pub(crate) fn hashes(&self) -> Vec<u64> {
        self.index.hashes(self.n_states(), STEP)
    }

    /// Number of hexes of a state.
    pub fn hexes_of(&self, state: u32) -> u32 {
        self.level_starts.partition_point(|&first| first <= state) as u32
    }

    /// The states whose class has this name, fewest hexes first; a hash only points.
    pub(crate) fn states_of(&self, class: u128) -> impl Iterator<Item = u32> + '_ {
        self.index.states_with(short_hash(class))
    }

    /// The flips that lead from the cube to a state.
    pub fn flips_to(&self, mut state: u32) -> Vec<Flip> {
        let mut flips = Vec::new();
        while state != 0 {
            flips.push(self.states.flip(state));
            state = self.states.parent(state);
        }
        flips.reverse();
        flips
    }

    /// Fewest hexes on record for a boundary with this canonical form, without replaying: a promise to be checked.
    pub(crate) fn hexes_hint(&self, class: u128) -> Option<u32> {
        self.states_of(class).next().map(|state| self.hexes_of(state))
    }

    /// The fillings on record whose boundary is isomorphic to the cavity's, fewest hexes first; whether they fit the
    /// cavity's blocked pairs is for [`Ball::placements`] to say.
    ///
    /// # Example
    /// ```
    /// use hexfill_mesh::QuadSurface;
    /// use hexfill_search::{Atlas, Cavity};
    ///
    /// // Two cubes in a row, as a surface: two hexes are the fewest.
    /// let quads = [
    ///     [0, 3, 2, 1], [8, 9, 10, 11],
    ///     [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7],
    ///     [4, 5, 9, 8], [5, 6, 10, 9], [6, 7, 11, 10], [7, 4, 8, 11],
    /// ];
    /// let (cavity, _) = Cavity::from_surface(&QuadSurface::try_new(12, &quads)?).expect("a small sphere");
    /// let ball = Atlas::embedded().balls_for(&cavity).next().expect("on record");
    /// assert_eq!(ball.n_hexes(), 2);
    /// # Ok::<(), hexfill_mesh::SurfaceError>(())
    /// ```
    pub fn balls_for<'a>(&'a self, cavity: &Cavity) -> impl Iterator<Item = Ball> + use<'a> {
        let mut canonical = Canonical::new();
        canonical.compute(cavity);
        let code = canonical.code().to_vec();
        self.states_of(class_hash(&code)).filter_map(move |state| {
            let ball = Ball::replay(self.flips_to(state))?;
            let mut form = Canonical::new();
            form.compute(&ball.boundary);
            (form.code() == code).then_some(ball)
        })
    }

    /// The smallest filling on record that avoids the cavity's blocked pairs, and where it goes.
    pub fn best_fit(&self, cavity: &Cavity, max_hexes: u32) -> Option<(Ball, Vec<u8>, bool)> {
        self.balls_for(cavity).take_while(|ball| ball.n_hexes() <= max_hexes as usize).find_map(|ball| {
            let (map, mirrored) = ball.placements(cavity).into_iter().next()?;
            Some((ball, map, mirrored))
        })
    }

    /// Number of boundary quads of every state.
    fn quads(&self) -> Vec<u8> {
        self.along_the_flips(6, |flip| flip.kind.gain())
    }

    /// A number of every state that starts with that of the cube and changes with each flip.
    fn along_the_flips(&self, cube: u8, gain: impl Fn(Flip) -> i32) -> Vec<u8> {
        let mut values = vec![cube; self.n_states()];
        for s in 1..self.n_states() as u32 {
            let parent = self.states.parent(s);
            values[s as usize] = (i32::from(values[parent as usize]) + gain(self.states.flip(s))) as u8;
        }
        values
    }

    /// A smaller atlas: the states of classes for which `keep(quads, hexes)` holds, the first `width` per class, and the
    /// steps that lead there, renumbered so that siblings stand together.
    #[must_use]
    pub fn pruned(&self, width: usize, keep: impl Fn(usize, u32) -> bool) -> Self {
        let quads = self.quads();
        let mut wanted = vec![false; self.n_states()];
        let mut named = vec![false; self.n_states()];
        named[0] = true;
        for class in self.index.classes() {
            for state in class.into_iter().take(width) {
                named[state as usize] |= keep(usize::from(quads[state as usize]), self.hexes_of(state));
            }
        }
        // A parent has a smaller number than its child, so one pass downward marks all that a kept state needs.
        for state in (0..self.n_states()).rev() {
            wanted[state] |= named[state] || state == 0;
            if wanted[state] {
                wanted[self.states.parent(state as u32) as usize] = true;
            }
        }
        let hashes = self.hashes();
        let mut renumbered = vec![u32::MAX; self.n_states()];
        let mut out = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for (level, &first) in self.level_starts.iter().enumerate() {
            let end = self.level_starts.get(level + 1).map_or(self.n_states(), |&e| e as usize);
            let mut members: Vec<u32> = (first..end as u32).filter(|&s| wanted[s as usize]).collect();
            if members.is_empty() {
                break;
            }
            members.sort_by_key(|&s| {
                let parent = self.states.parent(s);
                (if s == 0 { 0 } else { renumbered[parent as usize] }, self.states.flip(s))
            });
            out.0.push(out.1.len() as u32);
            for s in members {
                renumbered[s as usize] = out.1.len() as u32;
                out.1.push(if s == 0 { 0 } else { renumbered[self.states.parent(s) as usize] });
                out.2.push(self.states.flip(s));
                out.3.push(if named[s as usize] { hashes[s as usize] } else { STEP });
            }
        }
        Self::from_parts(out.0, out.1, out.2, out.3)
    }

    /// Counts by number of boundary quads.
    pub fn stats(&self) -> AtlasStats {
        let quads = self.quads();
        let vertices = self.along_the_flips(8, |flip| flip.kind.new_vertices());
        let mut smallest = std::collections::BTreeMap::<usize, (Vec<u32>, Vec<u32>)>::new();
        for class in self.index.classes() {
            let state = class[0];
            let n = quads[state as usize];
            let (hexes, interior) = smallest.entry(usize::from(n)).or_default();
            hexes.push(self.hexes_of(state));
            interior.push(u32::from(vertices[state as usize] - (n + 2)));
        }
        let spread = |(hexes, interior): (Vec<u32>, Vec<u32>)| ClassStats {
            classes: hexes.len(),
            hexes: Spread::of(hexes),
            interior: Spread::of(interior),
        };
        let classes = smallest.into_iter().map(|(quads, both)| (quads, spread(both))).collect();
        AtlasStats { states: self.n_states(), classes, levels: self.level_starts.len() }
    }
}
