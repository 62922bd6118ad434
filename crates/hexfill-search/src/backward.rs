//! A shorter way to a class, searched backward: the hexes glued last are taken off first.
//!
//! A ball that is shelled from one cube ends with some flip; without its last k hexes its boundary is another sphere. Seen
//! from the class to reach, these k hexes are glued on the *inside*, and what they use must be free in the ball that is left.
//! So a known state completes the way if the pairs it blocks and the pairs the k hexes use are disjoint, under one of the
//! automorphisms of the sphere where they meet. The growth of an atlas forgets most states of a class; this
//! finds which of those it knows would have been better remembered.
//!
//! Source: ours.

use crate::canonical::{Canonical, relabel};
use crate::cavity::Cavity;
use crate::flip::{apply, legal_flips};
use crate::grow::{ClassHash, class_hash};
use crate::known::Known;
use crate::packed_pairs::{PackedPairs, pack};
use rustc_hash::FxHashSet;

/// Most quads of a cavity on the way: each two more make the search several times as wide.
const MOST_QUADS: usize = 26;

/// How widely to search.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Breadth {
    /// Most hexes to take off.
    pub depth: u32,
    /// Spheres kept at each depth.
    pub beam: usize,
    /// Whether to end at the first depth at which there is a way.
    pub first: bool,
}

/// A known state and the classes through which it leads to the one searched for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Way {
    pub start: u32,
    pub classes: Vec<ClassHash>,
    /// Hexes of the ball at the end.
    pub hexes: u32,
}

/// A sphere some hexes inside the one to reach; its blocked pairs are those the hexes use.
struct Inner {
    cavity: Cavity,
    class: ClassHash,
    /// Index of the class it came from, in the trail.
    from: u32,
    score: u32,
    key: (ClassHash, PackedPairs),
}

/// The best way to `target` with less than `limit` hexes.
pub(crate) fn shorter_way(target: &Cavity, limit: u32, known: &Known, breadth: &Breadth) -> Option<Way> {
    let mut canonical = Canonical::new();
    canonical.compute(target);
    // Classes met, and where each came from.
    let mut trail = vec![(class_hash(canonical.code()), u32::MAX)];
    let mut beam = vec![(target.clone(), 0u32)];
    let mut best: Option<(u32, u32, Inner)> = None;
    let mut fewest = limit;
    let mut seen = FxHashSet::default();
    // Breadth first, a beam wide: the way back is short, since hexes glued near the end decide the boundary, and
    // forward the known states do the rest.
    for depth in 1..=breadth.depth {
        let mut inside: Vec<Inner> = Vec::new();
        for (cavity, from) in &beam {
            for placement in legal_flips(cavity, MOST_QUADS) {
                let cavity = apply(cavity, &placement).0;
                canonical.compute(&cavity);
                let class = class_hash(canonical.code());
                let image = canonical.blocked_image(&cavity).0;
                let key = (class, pack(&image, cavity.n_vertices()));
                // The same sphere with the same blocked pairs, reached in another order: what is inside of it has the
                // same number of hexes.
                if !seen.insert(key) {
                    continue;
                }
                let mut inner = Inner { cavity, class, from: *from, score: u32::MAX, key };
                let meeting = meet(&mut inner, &canonical, known);
                if let Some((start, hexes)) = meeting
                    && hexes + depth < fewest
                {
                    fewest = hexes + depth;
                    best = Some((start, fewest, Inner { cavity: inner.cavity.clone(), ..inner }));
                }
                inside.push(inner);
            }
        }
        if breadth.first && best.is_some() {
            break;
        }
        // Ties by name and never by arrival: the beam must not depend on the order of the flips.
        inside.sort_unstable_by_key(|i| (i.score, i.key));
        inside.truncate(breadth.beam);
        beam.clear();
        for inner in inside {
            trail.push((inner.class, inner.from));
            beam.push((inner.cavity, trail.len() as u32 - 1));
        }
    }
    let (start, hexes, inner) = best?;
    let mut classes = Vec::new();
    let mut at = inner.from;
    while at != u32::MAX {
        let (class, from) = trail[at as usize];
        classes.push(class);
        at = from;
    }
    Some(Way { start, classes, hexes })
}

/// The smallest known state of the sphere's class that leaves its pairs free. Scores the sphere: hexes of the best state plus a
/// penalty for each pair in its way.
fn meet(inner: &mut Inner, canonical: &Canonical, known: &Known) -> Option<(u32, u32)> {
    const PENALTY: u32 = 2;
    let n = inner.cavity.n_vertices();
    if known.fewest(inner.class).is_none() {
        inner.score = 1000 + 16 * n as u32 + inner.cavity.n_blocked();
        return None;
    }
    let mut best: Option<(u32, u32)> = None;
    for &flag in canonical.flags() {
        let image = pack(&relabel(&inner.cavity.blocked, n, &Canonical::vertex_numbers(&inner.cavity, flag)), n);
        for state in known.states_of(inner.class) {
            let overlap: u32 = image.iter().zip(known.blocked(state)).map(|(a, b)| (a & b).count_ones()).sum();
            let hexes = known.hexes(state);
            inner.score = inner.score.min(hexes + PENALTY * overlap);
            if overlap == 0 && best.is_none_or(|(_, fewest)| hexes < fewest) {
                best = Some((state, hexes));
            }
        }
    }
    best
}
