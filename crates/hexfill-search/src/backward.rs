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
use crate::flip::{Placement, apply, legal_flips};
use crate::grow::{ClassHash, class_hash};
use crate::hole::Hole;
use crate::known::Known;
use crate::packed_pairs::{PackedPairs, pack};
use hexfill_mesh::{Context, HexMesh};
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
pub(crate) struct Way {
    pub start: u32,
    pub classes: Vec<ClassHash>,
    /// Hexes of the ball at the end.
    pub hexes: u32,
    /// The hexes taken off, and what is inside of them.
    taken: Vec<[u32; 8]>,
    inner: Hole,
}

impl Way {
    /// The filling of the target, whose vertices keep their numbers; others follow.
    pub(crate) fn filling(&self, known: &Known) -> Option<HexMesh> {
        let ball = known.ball(self.start)?;
        let (map, mirrored) = ball.placements(&self.inner.sphere()).into_iter().next()?;
        let ids: Vec<u32> = map.iter().map(|&v| self.inner.ids[usize::from(v)]).collect();
        let (mut hexes, fresh) = ball.hexes_in(&ids, mirrored, self.inner.n_vertices);
        hexes.extend(&self.taken);
        HexMesh::try_new((self.inner.n_vertices + fresh) as usize, &hexes).ok()
    }
}

/// A hex taken off, the class of the sphere inside of it, and the hex before.
struct Taken {
    hex: [u32; 8],
    class: ClassHash,
    before: Option<u32>,
}

/// A flip of a hole on the beam: a sphere some hexes inside the one to reach, whose blocked pairs are those the hexes use.
struct Inner {
    class: ClassHash,
    parent: u32,
    placement: Placement,
    score: u32,
    key: (ClassHash, PackedPairs),
}

/// The best way to `target` with less than `limit` hexes; `None` if there is none, or if the work was stopped.
pub(crate) fn shorter_way(
    target: &Cavity,
    limit: u32,
    known: &Known,
    breadth: &Breadth,
    ctx: &Context<'_>,
) -> Option<Way> {
    let mut canonical = Canonical::new();
    canonical.compute(target);
    let outermost = class_hash(canonical.code());
    let mut trail: Vec<Taken> = Vec::new();
    let n = target.n_vertices() as u32;
    let mut beam = vec![Hole::inside(target, (0..n).collect(), n)];
    let mut best: Option<Way> = None;
    let mut fewest = limit;
    let mut seen = FxHashSet::default();
    // Breadth first, a beam wide: the way back is short, since hexes glued near the end decide the boundary, and
    // forward the known states do the rest.
    for depth in 1..=breadth.depth {
        let mut inside: Vec<Inner> = Vec::new();
        for (parent, hole) in beam.iter().enumerate() {
            if ctx.stop().is_some() {
                return None;
            }
            for placement in legal_flips(&hole.cavity, MOST_QUADS) {
                let cavity = apply(&hole.cavity, &placement).0;
                canonical.compute(&cavity);
                let class = class_hash(canonical.code());
                let image = canonical.blocked_image(&cavity).0;
                let key = (class, pack(&image, cavity.n_vertices()));
                // The same sphere with the same blocked pairs, reached in another order: what is inside of it has the
                // same number of hexes.
                if !seen.insert(key) {
                    continue;
                }
                let (score, meeting) = meet(&cavity, class, &canonical, known);
                if let Some((start, hexes)) = meeting
                    && hexes + depth < fewest
                {
                    fewest = hexes + depth;
                    let (mut classes, mut taken, mut at) = (Vec::new(), vec![hole.hex(&placement)], hole.last);
                    while let Some(Taken { hex, class, before }) = at.map(|at| &trail[at as usize]) {
                        classes.push(*class);
                        taken.push(*hex);
                        at = *before;
                    }
                    classes.push(outermost);
                    let inner = hole.after(&placement, u32::MAX);
                    best = Some(Way { start, classes, hexes: fewest, taken, inner });
                }
                inside.push(Inner { class, parent: parent as u32, placement, score, key });
            }
        }
        if breadth.first && best.is_some() {
            break;
        }
        // Ties by name and never by arrival: the beam must not depend on the order of the flips.
        inside.sort_unstable_by_key(|i| (i.score, i.key));
        inside.truncate(breadth.beam);
        let mut next = Vec::with_capacity(inside.len());
        for Inner { class, parent, placement, .. } in inside {
            let hole = &beam[parent as usize];
            next.push(hole.after(&placement, trail.len() as u32));
            trail.push(Taken { hex: hole.hex(&placement), class, before: hole.last });
        }
        beam = next;
    }
    best
}

/// A score of a sphere inside the target, hexes of the best state plus a penalty for each pair in its way, and the smallest known state of its class that
/// leaves its pairs free, with its hexes.
fn meet(cavity: &Cavity, class: ClassHash, canonical: &Canonical, known: &Known) -> (u32, Option<(u32, u32)>) {
    const PENALTY: u32 = 2;
    let n = cavity.n_vertices();
    if known.fewest(class).is_none() {
        return (1000 + 16 * n as u32 + cavity.n_blocked(), None);
    }
    let mut score = u32::MAX;
    let mut best: Option<(u32, u32)> = None;
    for &flag in canonical.flags() {
        let image = pack(&relabel(&cavity.blocked, n, &Canonical::vertex_numbers(cavity, flag)), n);
        for state in known.states_of(class) {
            let overlap: u32 = image.iter().zip(known.blocked(state)).map(|(a, b)| (a & b).count_ones()).sum();
            let hexes = known.hexes(state);
            score = score.min(hexes + PENALTY * overlap);
            if overlap == 0 && best.is_none_or(|(_, fewest)| hexes < fewest) {
                best = Some((state, hexes));
            }
        }
    }
    (score, best)
}
