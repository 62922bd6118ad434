//! [`Known`]: the states of an atlas with their blocked pairs, by class, to which shorter ways are added.
//!
//! States are numbered as in the atlas; those added follow. The parent of a state always has one hex less.
//!
//! Source: ours.

use crate::atlas::{Atlas, STEP, short_hash};
use crate::ball::{Ball, canonical_cavity};
use crate::canonical::Canonical;
use crate::cavity::Cavity;
use crate::flip::{Flip, apply, is_legal, legal_flips, place};
use crate::grow::{ClassHash, GrowOptions, Growth, State, class_hash};
use crate::packed_pairs::{MAX_CAP, PackedPairs, pack};

/// A growing table of states. See the module page.
pub(crate) struct Known {
    growth: Growth,
    /// Number of hexes of each state.
    hexes: Vec<u8>,
}

/// One flip of a way outward, and the state it leads to.
struct Step {
    flip: Flip,
    class: ClassHash,
    blocked: PackedPairs,
    n_blocked: u16,
}

impl Known {
    /// The states of an atlas, replayed. `None` if a flip is not legal where it stands.
    pub(crate) fn from_atlas(atlas: &Atlas) -> Option<Self> {
        let mut growth = Growth::new(GrowOptions { cap: MAX_CAP, width: 1 });
        let mut hexes = vec![1];
        for level in 1..atlas.level_starts.len() {
            let start = atlas.level_starts[level] as usize;
            let end = atlas.level_starts.get(level + 1).map_or(atlas.n_states(), |&e| e as usize);
            let states = start as u32..end as u32;
            let parents: Vec<u32> = states.clone().map(|s| atlas.states.parent(s)).collect();
            let flips: Vec<Flip> = states.map(|s| atlas.states.flip(s)).collect();
            growth.replay_level(&parents, &flips)?;
            hexes.resize(end, level as u8 + 1);
        }
        Some(Self { growth, hexes })
    }

    /// Number of hexes of a state.
    pub(crate) fn hexes(&self, state: u32) -> u32 {
        u32::from(self.hexes[state as usize])
    }

    /// The pairs a state blocks, in the numbers of its canonical cavity.
    pub(crate) fn blocked(&self, state: u32) -> &PackedPairs {
        &self.growth.blocked[state as usize]
    }

    /// The states of a class, in a fixed order.
    pub(crate) fn states_of(&self, class: ClassHash) -> impl Iterator<Item = u32> + '_ {
        self.growth.states_of(class)
    }

    /// The smallest filling of a class.
    pub(crate) fn smallest(&self, class: ClassHash) -> Option<Ball> {
        self.ball(self.states_of(class).min_by_key(|&s| (self.hexes(s), s))?)
    }

    /// The ball of a state.
    pub(crate) fn ball(&self, state: u32) -> Option<Ball> {
        Ball::replay(self.growth.flips_to(state))
    }

    /// Fewest hexes of any state of a class.
    pub(crate) fn fewest(&self, class: ClassHash) -> Option<u32> {
        self.states_of(class).map(|state| self.hexes(state)).min()
    }

    /// Number of states.
    pub(crate) fn n_states(&self) -> usize {
        self.hexes.len()
    }

    /// Adds the states on a way outward from `start` through these classes, if there is one; returns the last.
    pub(crate) fn add_way(&mut self, start: u32, classes: &[ClassHash]) -> Option<u32> {
        let ball = self.ball(start)?;
        let mut canonical = Canonical::new();
        let mut steps = Vec::new();
        if !find_way(&ball.boundary, classes, &mut canonical, &mut steps) {
            return None;
        }
        let mut at = start;
        for step in steps {
            at = self.add(at, step)?;
        }
        Some(at)
    }

    /// Adds the states on the way of a ball from one cube; returns the last. `None` if a flip is not legal where it stands.
    pub(crate) fn add_ball(&mut self, flips: &[Flip]) -> Option<u32> {
        let mut canonical = Canonical::new();
        let mut boundary = Cavity::cube();
        let mut at = 0;
        for &flip in flips {
            let form = canonical_cavity(&boundary, &mut canonical).cavity;
            let placement = place(&form, &form.degrees(), flip).filter(|p| is_legal(p, &form.marked()))?;
            boundary = apply(&form, &placement).0;
            if boundary.n_quads() > MAX_CAP {
                return None;
            }
            at = self.add(at, step(flip, &boundary, &mut canonical))?;
        }
        Some(at)
    }

    /// The state a step leads to: one with the same blocked pairs and no more hexes, or a new one.
    fn add(&mut self, parent: u32, step: Step) -> Option<u32> {
        let hexes = self.hexes[parent as usize] + 1;
        let as_good = |&old: &u32| self.hexes[old as usize] <= hexes && *self.blocked(old) == step.blocked;
        if let Some(old) = self.states_of(step.class).find(as_good) {
            return Some(old);
        }
        let id = u32::try_from(self.n_states()).ok()?;
        self.growth.push(
            State { parent, flip: step.flip, n_blocked: step.n_blocked, previous: u32::MAX },
            step.class,
            step.blocked,
        );
        self.hexes.push(hexes);
        Some(id)
    }

    /// Adds the ways by which `other` reaches a class in fewer hexes than this table. `None` if there are too many states.
    pub(crate) fn merge(&mut self, other: &Self) -> Option<()> {
        let classes = other.class_of_each_state();
        let mut wanted = vec![false; other.n_states()];
        for (class, _) in other.growth.classes() {
            let best = other.states_of(class).min_by_key(|&s| (other.hexes(s), s)).expect("a class has a state");
            wanted[best as usize] |= self.fewest(class).is_none_or(|fewest| other.hexes(best) < fewest);
        }
        let states = &other.growth.states;
        for s in (1..states.len()).rev() {
            if wanted[s] {
                wanted[states[s].parent as usize] = true;
            }
        }
        // Both tables start with the cube.
        let mut here = vec![0; states.len()];
        for s in (1..states.len()).filter(|&s| wanted[s]) {
            let State { parent, flip, n_blocked, .. } = states[s];
            let step = Step { flip, class: classes[s], blocked: *other.blocked(s as u32), n_blocked };
            here[s] = self.add(here[parent as usize], step)?;
        }
        Some(())
    }

    fn class_of_each_state(&self) -> Vec<ClassHash> {
        let mut classes = vec![0; self.n_states()];
        for (class, _) in self.growth.classes() {
            for state in self.states_of(class) {
                classes[state as usize] = class;
            }
        }
        classes
    }

    /// The states as an atlas in which the classes that `keep` chooses have names and the others are steps.
    pub(crate) fn to_atlas(&self, keep: impl Fn(ClassHash) -> bool) -> Atlas {
        let mut order: Vec<u32> = (0..self.n_states() as u32).collect();
        order.sort_by_key(|&s| self.hexes[s as usize]);
        let mut renumbered = vec![0; order.len()];
        let mut level_starts = Vec::new();
        for (new, &old) in order.iter().enumerate() {
            renumbered[old as usize] = new as u32;
            if level_starts.len() < usize::from(self.hexes[old as usize]) {
                level_starts.push(new as u32);
            }
        }
        let name = |class| if keep(class) { short_hash(class) } else { STEP };
        let names: Vec<u64> = self.class_of_each_state().into_iter().map(name).collect();
        Atlas::from_parts(
            level_starts,
            order.iter().map(|&s| renumbered[self.growth.states[s as usize].parent as usize]).collect(),
            order.iter().map(|&s| self.growth.states[s as usize].flip).collect(),
            order.iter().map(|&s| names[s as usize]).collect(),
        )
    }
}

/// The step of a flip that leaves this cavity.
fn step(flip: Flip, after: &Cavity, canonical: &mut Canonical) -> Step {
    canonical.compute(after);
    let blocked = pack(&canonical.blocked_image(after).0, after.n_vertices());
    Step { flip, class: class_hash(canonical.code()), blocked, n_blocked: after.n_blocked() as u16 }
}

/// Finds flips that lead from a ball with this boundary through these classes, depth first.
fn find_way(boundary: &Cavity, classes: &[ClassHash], canonical: &mut Canonical, steps: &mut Vec<Step>) -> bool {
    let Some((&class, rest)) = classes.split_first() else { return true };
    let form = canonical_cavity(boundary, canonical).cavity;
    for placement in legal_flips(&form, MAX_CAP) {
        let child = apply(&form, &placement).0;
        let step = step(placement.flip, &child, canonical);
        if step.class != class {
            continue;
        }
        steps.push(step);
        if find_way(&child, rest, canonical, steps) {
            return true;
        }
        steps.pop();
    }
    false
}
