//! Growth of the atlas: dynamic programming over cavities, level by level.
//!
//! Outward from one cube, a shellable ball grows by flips on its outside. What may be added next depends only on the
//! *state*: the class of the boundary and which of its vertex pairs are blocked. Level L holds states reached with L
//! hexes. A state is dominated, and dropped, if its class was reached with no more hexes and a subset of its blocked
//! pairs. Per class at most `width` states are kept, but one with fewer blocked pairs than all of them always enters:
//! without that rule the growth dies out early, the blocked pairs matter. With unlimited width every Pareto state is
//! kept and "nothing below H hexes with cavities of at most C quads" is a theorem. A beam gives that up for reach: with only
//! the least blocked classes of each size kept, larger cavities can be afforded, and the fillings get smaller.
//!
//! Determinism: the children of a level are gathered in sets whose content does not depend on their order of arrival,
//! then numbered by class hash. Any number of threads gives the same atlas.
//!
//! Source: ours; gluing outward by flips is Verhetsel et al. 2019 (abstract: a flip of the boundary is a hex glued on it) turned round.

use crate::ball::Ball;
use crate::canonical::{Canonical, MAX_CODE, code_len, decode};
use crate::cavity::Cavity;
use crate::flip::{Flip, apply, candidates, is_legal, place};
use crate::packed_pairs::{MAX_CAP, PackedPairs, is_subset, pack, unpack};
use hexfill_mesh::{Context, StopReason};
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use xxhash_rust::xxh3::xxh3_128;

const SHARDS: usize = 64;

/// Name of a class in tables: xxh3-128 of its canonical code.
pub(crate) type ClassHash = u128;

pub(crate) fn class_hash(code: &[u8]) -> ClassHash {
    xxh3_128(code)
}

/// The class of the cube.
pub(crate) fn cube_class() -> ClassHash {
    let mut canonical = Canonical::new();
    canonical.compute(&Cavity::cube());
    class_hash(canonical.code())
}

/// How far and how densely to grow.
///
/// | option | default |
/// |---|---|
/// | cap | 24 quads |
/// | width | 1 state a class |
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GrowOptions {
    pub(crate) cap: usize,
    pub(crate) width: u32,
}

impl Default for GrowOptions {
    fn default() -> Self {
        Self { cap: 24, width: 1 }
    }
}

impl GrowOptions {
    /// Most quads a ball's boundary may have on the way (at most [`MAX_CAP`]).
    #[must_use]
    pub fn with_cap(self, cap: usize) -> Self {
        Self { cap, ..self }
    }

    /// How many states to keep per class; `u32::MAX` keeps every Pareto state.
    #[must_use]
    pub fn with_width(self, width: u32) -> Self {
        Self { width, ..self }
    }

    /// Most quads a ball's boundary may have on the way.
    pub fn cap(&self) -> usize {
        self.cap
    }

    /// How many states are kept per class.
    pub fn width(&self) -> u32 {
        self.width
    }
}

/// A kept state: how it was reached.
#[derive(Clone, Copy, Debug)]
pub(crate) struct State {
    /// The state it grew from (itself for the cube).
    pub parent: u32,
    /// The flip on the parent's canonical cavity.
    pub flip: Flip,
    /// Number of blocked pairs.
    pub n_blocked: u16,
    /// The state of the same class kept before this one, or `u32::MAX`.
    pub previous: u32,
}

/// A state whose flips have not been tried yet.
#[derive(Clone, Copy)]
struct FrontierState {
    id: u32,
    n_quads: u8,
    code: [u8; code_len(MAX_CAP)],
    blocked: PackedPairs,
}

impl FrontierState {
    fn cavity(&self) -> Cavity {
        let mut cavity = decode(&self.code[..code_len(usize::from(self.n_quads))]).expect("a kept code is a sphere");
        cavity.blocked = unpack(&self.blocked, cavity.n_vertices());
        cavity
    }
}

/// A child waiting for the end of the level. The derived order decides which children of a class are kept.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Candidate {
    n_blocked: u16,
    blocked: PackedPairs,
    parent: u32,
    flip: Flip,
}

struct PendingClass {
    n_quads: u8,
    code: [u8; code_len(MAX_CAP)],
    /// The smallest candidates, ascending, at most `width`, distinct in `blocked`.
    candidates: Vec<Candidate>,
}

/// What a level brought.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LevelReport {
    /// Number of hexes of the balls of this level.
    pub level: u32,
    /// Legal flips tried to get there.
    pub children: u64,
    /// States kept on this level.
    pub kept: u64,
    /// Classes reached so far.
    pub classes: u64,
    /// States kept so far.
    pub states: u64,
    /// States left out on this level to stay within the memory limit.
    pub thinned: u64,
    /// Why the level was not finished; its states are then discarded.
    pub stopped: Option<StopReason>,
}

/// The growing atlas.
pub struct Growth {
    pub(crate) options: GrowOptions,
    pub(crate) states: Vec<State>,
    pub(crate) blocked: Vec<PackedPairs>,
    /// Per shard: the newest state of each class.
    newest: Vec<FxHashMap<ClassHash, u32>>,
    /// First state of each level, level 1 first.
    pub(crate) level_starts: Vec<u32>,
    frontier: Vec<FrontierState>,
    /// Most classes to accept on a level, of each number of quads.
    beam: Option<usize>,
}

fn shard_of(class: ClassHash) -> usize {
    (class >> 122) as usize % SHARDS
}

impl Growth {
    /// The atlas of one cube.
    pub fn new(options: GrowOptions) -> Self {
        let options = GrowOptions { cap: options.cap.clamp(6, MAX_CAP), width: options.width.max(1) };
        let cube = Cavity::cube();
        let mut canonical = Canonical::new();
        canonical.compute(&cube);
        let blocked = pack(&canonical.blocked_image(&cube).0, cube.n_vertices());
        let mut code = [0; code_len(MAX_CAP)];
        code[..canonical.code().len()].copy_from_slice(canonical.code());
        let mut newest = vec![FxHashMap::default(); SHARDS];
        let class = class_hash(canonical.code());
        newest[shard_of(class)].insert(class, 0);
        let flip = Flip { kind: crate::flip::FlipKind::OneToFive, dart: 0 };
        Self {
            options,
            states: vec![State { parent: 0, flip, n_blocked: cube.n_blocked() as u16, previous: u32::MAX }],
            blocked: vec![blocked],
            newest,
            level_starts: vec![0],
            frontier: vec![FrontierState { id: 0, n_quads: 6, code, blocked }],
            beam: None,
        }
    }

    /// From now on, keeps on each level only so many classes of each number of quads: those with the fewest blocked pairs.
    #[must_use]
    pub fn with_beam(mut self, beam: usize) -> Self {
        self.beam = Some(beam);
        self
    }

    /// Number of hexes of the balls on the newest level.
    pub fn level(&self) -> u32 {
        self.level_starts.len() as u32
    }

    /// Whether no state is left to grow from.
    pub fn is_exhausted(&self) -> bool {
        self.frontier.is_empty()
    }

    /// Number of classes reached.
    pub fn n_classes(&self) -> u64 {
        self.newest.iter().map(|s| s.len() as u64).sum()
    }

    /// Number of states kept.
    pub fn n_states(&self) -> u64 {
        self.states.len() as u64
    }

    /// Bytes held, roughly: states, pairs, tables and frontier.
    pub fn memory(&self) -> u64 {
        let per_state = size_of::<State>() + size_of::<PackedPairs>();
        let tables: usize = self.newest.iter().map(|s| s.capacity() * (size_of::<(ClassHash, u32)>() + 1)).sum();
        (self.states.capacity() * per_state + tables + self.frontier.capacity() * size_of::<FrontierState>()) as u64
    }

    /// The states of a class, newest first.
    pub(crate) fn states_of(&self, class: ClassHash) -> impl Iterator<Item = u32> + '_ {
        let mut at = self.newest[shard_of(class)].get(&class).copied();
        std::iter::from_fn(move || {
            let now = at?;
            let previous = self.states[now as usize].previous;
            at = (previous != u32::MAX).then_some(previous);
            Some(now)
        })
    }

    /// Adds a state of a class beside the levels.
    pub(crate) fn push(&mut self, mut state: State, class: ClassHash, blocked: PackedPairs) {
        let id = self.states.len() as u32;
        state.previous = self.newest[shard_of(class)].insert(class, id).unwrap_or(u32::MAX);
        self.states.push(state);
        self.blocked.push(blocked);
    }

    /// Every class with its newest state, in no particular order.
    pub(crate) fn classes(&self) -> impl Iterator<Item = (ClassHash, u32)> + '_ {
        self.newest.iter().flatten().map(|(&class, &state)| (class, state))
    }

    /// The flips that lead from the cube to a state.
    pub(crate) fn flips_to(&self, mut state: u32) -> Vec<Flip> {
        let mut flips = Vec::new();
        while state != 0 {
            let at = self.states[state as usize];
            flips.push(at.flip);
            state = at.parent;
        }
        flips.reverse();
        flips
    }

    /// The smallest balls known whose boundary is isomorphic to the cavity's, fewest hexes first.
    pub fn balls_for(&self, cavity: &Cavity) -> impl Iterator<Item = Ball> + '_ {
        let mut canonical = Canonical::new();
        canonical.compute(cavity);
        let mut states: Vec<u32> = self.states_of(class_hash(canonical.code())).collect();
        states.reverse();
        states.into_iter().map(|s| Ball::replay(self.flips_to(s)).expect("kept flips are legal"))
    }

    /// The options the growth was made with (clamped to their limits).
    pub fn options(&self) -> GrowOptions {
        self.options
    }

    /// The states of the newest level with their classes, in order.
    pub(crate) fn newest_level(&self) -> Vec<(State, ClassHash)> {
        self.frontier
            .iter()
            .map(|f| (self.states[f.id as usize], class_hash(&f.code[..code_len(usize::from(f.n_quads))])))
            .collect()
    }

    /// Adds a level that was grown before: each state's parent (on the newest level) and flip, in order.
    /// `None` if a flip is not legal on its parent; the growth is then unusable.
    pub(crate) fn replay_level(&mut self, parents: &[u32], flips: &[Flip]) -> Option<()> {
        // Flips are replayed in parallel and states numbered one after the other: numbers are those of the log.
        let first = *self.level_starts.last().expect("level 1 exists");
        let remade: Option<Vec<(ClassHash, FrontierState, u16)>> = parents
            .par_iter()
            .zip(flips)
            .map_init(Canonical::new, |canonical, (&parent, &flip)| {
                let parent = self.frontier.get(parent.checked_sub(first)? as usize)?;
                let cavity = parent.cavity();
                if usize::from(flip.dart) >= 4 * cavity.n_quads() {
                    return None;
                }
                let placement = place(&cavity, &cavity.degrees(), flip)?;
                let quads = cavity.n_quads() as i32 + flip.kind.gain();
                if quads > self.options.cap as i32 || !is_legal(&placement, &cavity.marked()) {
                    return None;
                }
                let child = apply(&cavity, &placement).0;
                canonical.compute(&child);
                let blocked = pack(&canonical.blocked_image(&child).0, child.n_vertices());
                let mut code = [0; code_len(MAX_CAP)];
                code[..canonical.code().len()].copy_from_slice(canonical.code());
                let state = FrontierState { id: 0, n_quads: child.n_quads, code, blocked };
                Some((class_hash(canonical.code()), state, child.n_blocked() as u16))
            })
            .collect();
        let remade = remade?;
        self.level_starts.push(self.states.len() as u32);
        self.frontier.clear();
        for ((&parent, &flip), (class, mut state, n_blocked)) in parents.iter().zip(flips).zip(remade) {
            state.id = u32::try_from(self.states.len()).ok()?;
            let previous = self.newest[shard_of(class)].insert(class, state.id).unwrap_or(u32::MAX);
            self.states.push(State { parent, flip, n_blocked, previous });
            self.blocked.push(state.blocked);
            self.frontier.push(state);
        }
        Some(())
    }

    /// Grows by one level.
    ///
    /// # Example
    /// Balls of one and two hexes have one boundary each; those of three have three: a row, an L, and three hexes round an edge.
    /// ```
    /// use hexfill_mesh::Context;
    /// use hexfill_search::{GrowOptions, Growth};
    ///
    /// let mut growth = Growth::new(GrowOptions::default().with_cap(20));
    /// assert_eq!(growth.n_classes(), 1);
    /// growth.grow(&Context::default());
    /// assert_eq!((growth.level(), growth.n_classes()), (2, 2));
    /// growth.grow(&Context::default());
    /// assert_eq!((growth.level(), growth.n_classes()), (3, 5));
    /// ```
    pub fn grow(&mut self, ctx: &Context<'_>) -> LevelReport {
        let pending: Vec<Mutex<FxHashMap<ClassHash, PendingClass>>> =
            (0..SHARDS).map(|_| Mutex::new(FxHashMap::default())).collect();
        let stop = AtomicBool::new(false);
        let children = AtomicU64::new(0);
        let done = AtomicU64::new(0);
        let total = self.frontier.len() as u64;
        let level = self.level() + 1;
        let start = std::time::Instant::now();
        // States of a level grow independently: what they bring is gathered as a set and settled when all have come.
        self.frontier.par_chunks(256).for_each_init(Canonical::new, |canonical, chunk| {
            if stop.load(Ordering::Relaxed) {
                return;
            }
            if ctx.stop().is_some() {
                stop.store(true, Ordering::Relaxed);
                return;
            }
            let mut tried = 0;
            for state in chunk {
                tried += self.expand(state, canonical, &pending);
            }
            children.fetch_add(tried, Ordering::Relaxed);
            let so_far = done.fetch_add(chunk.len() as u64, Ordering::Relaxed) + chunk.len() as u64;
            if so_far.is_multiple_of(256) {
                ctx.report("atlas level", so_far, Some(total), || {
                    let rate = children.load(Ordering::Relaxed) as f64 / start.elapsed().as_secs_f64();
                    format!(
                        "{level} hexes, {} classes, {} states, {rate:.0} flips/s, {} MB",
                        self.n_classes(),
                        self.n_states(),
                        self.memory() >> 20
                    )
                });
            }
        });
        let mut report = LevelReport {
            level,
            children: children.into_inner(),
            kept: 0,
            classes: self.n_classes(),
            states: self.n_states(),
            thinned: 0,
            stopped: None,
        };
        if stop.into_inner() {
            report.stopped = ctx.stop().or(Some(StopReason::Cancelled));
            return report;
        }
        let pending = pending.into_iter().map(|m| m.into_inner().expect("no thread panicked")).collect();
        match self.settle(pending, ctx.memory_limit) {
            Some(thinned) => report.thinned = thinned,
            None => {
                report.stopped = Some(StopReason::MemoryLimit);
                return report;
            }
        }
        report.kept = self.frontier.len() as u64;
        report.classes = self.n_classes();
        report.states = self.n_states();
        report
    }

    /// Tries every flip of a state; hands the children that may be kept to `pending`. Returns how many were legal.
    fn expand(
        &self,
        state: &FrontierState,
        canonical: &mut Canonical,
        pending: &[Mutex<FxHashMap<ClassHash, PendingClass>>],
    ) -> u64 {
        let cavity = state.cavity();
        let (marked, degrees) = (cavity.marked(), cavity.degrees());
        let mut legal = 0;
        for flip in candidates(&cavity, self.options.cap) {
            let Some(placement) = place(&cavity, &degrees, flip) else { continue };
            if !is_legal(&placement, &marked) {
                continue;
            }
            legal += 1;
            let child = apply(&cavity, &placement).0;
            canonical.compute(&child);
            let class = class_hash(canonical.code());
            let n_blocked = child.n_blocked() as u16;
            let shard = shard_of(class);
            // Cheap refusals first: the front of earlier levels is complete and only read here.
            let mut kept = 0;
            let mut fewest = u16::MAX;
            for old in self.states_of(class) {
                kept += 1;
                fewest = fewest.min(self.states[old as usize].n_blocked);
            }
            // Within the width anything may enter, and beyond it only what blocks less than all that is kept: without
            // this rule the growth dies out early.
            if n_blocked >= fewest && kept >= self.options.width {
                continue;
            }
            let blocked = pack(&canonical.blocked_image(&child).0, child.n_vertices());
            // Dominated: whatever can be glued on it can be glued on the old state, which has no more hexes.
            if kept > 0 && self.states_of(class).any(|old| is_subset(&self.blocked[old as usize], &blocked)) {
                continue;
            }
            let candidate = Candidate { n_blocked, blocked, parent: state.id, flip };
            let mut shard = pending[shard].lock().expect("no thread panicked");
            let slot = shard.entry(class).or_insert_with(|| {
                let mut code = [0; code_len(MAX_CAP)];
                code[..canonical.code().len()].copy_from_slice(canonical.code());
                PendingClass { n_quads: child.n_quads, code, candidates: Vec::new() }
            });
            slot.offer(candidate, self.options.width);
        }
        legal
    }

    /// Ends a level: accepts the pending states class by class, in the order of their hashes. Returns how many classes were
    /// left out for want of memory; `None`, with nothing changed, if no room is left for any.
    fn settle(&mut self, pending: Vec<FxHashMap<ClassHash, PendingClass>>, memory_limit: Option<u64>) -> Option<u64> {
        let mut classes: Vec<(ClassHash, PendingClass)> = pending.into_iter().flatten().collect();
        // Hash maps gave no order; this gives one that is the same for any number of threads.
        classes.par_sort_unstable_by_key(|(class, _)| *class);
        let mut thinned = self.beam.map_or(0, |beam| keep_the_least_blocked(&mut classes, beam));
        if let Some(limit) = memory_limit {
            let per_class = size_of::<State>() + size_of::<PackedPairs>() + 2 * size_of::<(ClassHash, u32)>();
            // A class may bring several states.
            let coming = |classes: &[(ClassHash, PendingClass)]| {
                let n: usize = classes.iter().map(|(_, pending)| pending.candidates.len()).sum();
                self.memory() + (n * (per_class + size_of::<FrontierState>())) as u64
            };
            let mut cap = MAX_CAP;
            while coming(&classes) > limit && cap > 6 {
                // Thin the largest classes first: the records known pass through them least.
                let before = classes.len();
                classes.retain(|(_, p)| usize::from(p.n_quads) < cap);
                thinned += (before - classes.len()) as u64;
                cap -= 2;
            }
            if classes.is_empty() && thinned > 0 {
                return None;
            }
        }
        self.frontier.clear();
        self.level_starts.push(self.states.len() as u32);
        for (class, pending) in classes {
            let start = self.states.len();
            for candidate in pending.candidates {
                // Ascending in the number of blocked pairs: only an earlier one can dominate.
                if self.blocked[start..].iter().any(|b| is_subset(b, &candidate.blocked)) {
                    continue;
                }
                let Ok(id) = u32::try_from(self.states.len()) else { return Some(thinned) };
                let previous = self.newest[shard_of(class)].insert(class, id).unwrap_or(u32::MAX);
                self.states.push(State {
                    parent: candidate.parent,
                    flip: candidate.flip,
                    n_blocked: candidate.n_blocked,
                    previous,
                });
                self.blocked.push(candidate.blocked);
                self.frontier.push(FrontierState {
                    id,
                    n_quads: pending.n_quads,
                    code: pending.code,
                    blocked: candidate.blocked,
                });
            }
        }
        Some(thinned)
    }
}

/// Drops all but the `beam` classes of each size with the fewest blocked pairs, the rest in order. Returns how many went.
fn keep_the_least_blocked(classes: &mut Vec<(ClassHash, PendingClass)>, beam: usize) -> u64 {
    let before = classes.len();
    for quads in (6..=MAX_CAP as u8).step_by(2) {
        let mut ranks: Vec<(u16, ClassHash)> =
            classes.iter().filter(|(_, p)| p.n_quads == quads).map(|(c, p)| (p.candidates[0].n_blocked, *c)).collect();
        if ranks.len() > beam {
            let first_out = *ranks.select_nth_unstable(beam).1;
            classes.retain(|(class, p)| p.n_quads != quads || (p.candidates[0].n_blocked, *class) < first_out);
        }
    }
    (before - classes.len()) as u64
}

impl PendingClass {
    /// Keeps the `width` smallest candidates. Which ones those are does not depend on the order of the offers.
    fn offer(&mut self, candidate: Candidate, width: u32) {
        let same = self.candidates.iter().position(|c| c.blocked == candidate.blocked);
        match same {
            Some(i) if self.candidates[i] <= candidate => return,
            Some(i) => {
                self.candidates.remove(i);
            }
            None => {}
        }
        let at = self.candidates.partition_point(|c| *c < candidate);
        if (at as u64) < u64::from(width) {
            self.candidates.insert(at, candidate);
            self.candidates.truncate(width as usize);
        }
    }
}

const _: () = assert!(code_len(MAX_CAP) <= MAX_CODE);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_levels_are_the_same_for_any_number_of_threads() {
        let run = |threads: usize, width: u32| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let mut growth = Growth::new(GrowOptions { cap: 20, width });
                let reports: Vec<LevelReport> = (0..7).map(|_| growth.grow(&Context::default())).collect();
                let trail: Vec<(u32, Flip)> = growth.states.iter().map(|s| (s.parent, s.flip)).collect();
                (reports, trail)
            })
        };
        for width in [1, 4, u32::MAX] {
            let one = run(1, width);
            assert_eq!(one, run(2, width));
            assert_eq!(one, run(5, width));
        }
    }
}
