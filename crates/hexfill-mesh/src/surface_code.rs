//! The breadth-first code of a quad surface from a flag, and the smallest code over all flags.
//!
//! A flag is a dart and a handedness; it puts one corner, edge and quad first. From it the quads of a component are visited breadth first: the
//! first quad's corners get the labels 0..3, then each quad in turn looks across its sides, in the flag's sense of rotation, and a quad found there
//! for the first time contributes its two far corners. The code lists these corners: 0 for a vertex met for the first time (it gets the next
//! label), else (next label - its label). Two flags have the same code exactly if an isomorphism takes one to the other, because the code can be
//! decoded. Idea: plantri (Brinkmann, McKay 2007); flags of a rare kind only: Hopcroft, Wong 1974.
//!
//! Symmetric surfaces would make the minimum quadratic (equal codes never differ early), so each automorphism found merges the orbits of the flags,
//! and one flag an orbit is tried: a group of order g is found with log2 g full codes.
//!
//! Source: Brinkmann, McKay 2007; Hopcroft, Wong 1974; McKay 1998 for what automorphisms save.

use crate::ids::{Dart, VertexId};
use crate::orbits::{Orbits, keep_rarest, mix};
use crate::surface::QuadSurface;
use std::cmp::Ordering;

const UNLABELLED: u32 = u32::MAX;

/// A dart and a handedness: `mirrored` runs along the dart backwards, with the quad on its right.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Flag {
    pub dart: Dart,
    pub mirrored: bool,
}

impl Flag {
    fn index(self) -> usize {
        2 * self.dart.index() + usize::from(self.mirrored)
    }

    #[cfg(test)]
    fn from_index(i: usize) -> Self {
        Self { dart: Dart((i / 2) as u32), mirrored: i % 2 == 1 }
    }

    /// The flag `steps` sides further round its quad, in its own sense.
    fn rotated(self, steps: u32) -> Self {
        let by = if self.mirrored { 4 - steps } else { steps };
        Self { dart: Dart((self.dart.0 & !3) | ((self.dart.0 + by) & 3)), mirrored: self.mirrored }
    }

    /// The corners of the quad, in the flag's sense from its start.
    fn corners(self, surface: &QuadSurface) -> [VertexId; 4] {
        let quad = surface.quad(self.dart.quad());
        let side = self.dart.side();
        // Mirrored, the edge of the dart runs from its target to its origin.
        std::array::from_fn(|i| quad[if self.mirrored { side + 5 - i } else { side + i } % 4])
    }
}

/// Labels and visits of one walk; reused from walk to walk.
pub(crate) struct Walker<'a> {
    surface: &'a QuadSurface,
    label: Vec<u32>,
    visited: Vec<bool>,
    /// Vertices by label.
    pub order: Vec<VertexId>,
    /// The dart by which each visited quad is entered, in order of visit.
    pub entered: Vec<Dart>,
}

impl<'a> Walker<'a> {
    pub(crate) fn new(surface: &'a QuadSurface) -> Self {
        Self {
            surface,
            label: vec![UNLABELLED; surface.n_vertices()],
            visited: vec![false; surface.n_quads()],
            order: Vec::new(),
            entered: Vec::new(),
        }
    }

    /// Forgets the last walk; costs as much as it visited.
    fn clear(&mut self) {
        for v in self.order.drain(..) {
            self.label[v.index()] = UNLABELLED;
        }
        for d in self.entered.drain(..) {
            self.visited[d.quad().index()] = false;
        }
    }

    /// Walks from a flag and hands each number of the code to `visit`, until it returns `false` or the component is done.
    #[inline]
    fn walk(&mut self, flag: Flag, mut visit: impl FnMut(u32) -> bool) {
        self.clear();
        let surface = self.surface;
        for v in flag.corners(surface) {
            self.label[v.index()] = self.order.len() as u32;
            self.order.push(v);
        }
        self.visited[flag.dart.quad().index()] = true;
        self.entered.push(flag.dart);
        let mut i = 0;
        while i < self.entered.len() {
            let mut d = self.entered[i];
            // The side by which a quad was entered leads back; only the first quad has news there.
            let sides = if i == 0 { 4 } else { 3 };
            if i > 0 {
                d = if flag.mirrored { d.prev() } else { d.next() };
            }
            i += 1;
            for _ in 0..sides {
                let t = surface.twin(d);
                d = if flag.mirrored { d.prev() } else { d.next() };
                let q = t.quad().index();
                if self.visited[q] {
                    continue;
                }
                self.visited[q] = true;
                self.entered.push(t);
                // In the flag's sense the corners of the new quad are (end, start of the crossed side, far corner, far corner).
                let [_, _, near_start, near_end] = Flag { dart: t, mirrored: flag.mirrored }.corners(surface);
                for v in [near_start, near_end] {
                    let next = self.order.len() as u32;
                    let label = &mut self.label[v.index()];
                    let number = if *label == UNLABELLED {
                        *label = next;
                        self.order.push(v);
                        0
                    } else {
                        next - *label
                    };
                    if !visit(number) {
                        return;
                    }
                }
            }
        }
    }

    /// The code of a flag.
    pub(crate) fn code(&mut self, flag: Flag) -> Vec<u32> {
        let mut code = Vec::new();
        self.walk(flag, |number| {
            code.push(number);
            true
        });
        code
    }

    /// Compares the code of a flag with `best` (of the same component) and makes `best` the smaller one.
    fn improve(&mut self, flag: Flag, best: &mut [u32]) -> Ordering {
        let mut at = 0;
        let mut order = Ordering::Equal;
        self.walk(flag, |number| {
            if order == Ordering::Equal {
                order = number.cmp(&best[at]);
            }
            if order == Ordering::Less {
                best[at] = number;
            }
            at += 1;
            order != Ordering::Greater
        });
        order
    }

    /// A fingerprint of what lies round a flag: the first `length` numbers of its code and the degrees of the vertices met.
    fn fingerprint(&mut self, flag: Flag, length: usize) -> u64 {
        let mut hash = 0u64;
        let mut left = length;
        self.walk(flag, |number| {
            hash = mix(hash, number);
            left -= 1;
            left > 0
        });
        for v in &self.order {
            hash = mix(hash, self.surface.degree(*v));
        }
        hash
    }
}

/// The canonical form of one component.
pub(crate) struct Canonical {
    /// The smallest code over the flags tried.
    pub code: Vec<u32>,
    /// A flag that has it.
    pub flag: Flag,
    /// All flags that have it: the images of `flag` under the automorphisms, ascending by (dart, mirrored). Automorphisms act freely on the flags of a component.
    pub flags: Vec<Flag>,
}

/// Which flags a canonical form is taken over.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Handedness {
    Both,
    Only { mirrored: bool },
}

/// Computes canonical forms of the components of one surface; keeps its tables from one to the next.
pub(crate) struct Canonizer<'a> {
    walker: Walker<'a>,
    orbits: Orbits,
    place: Vec<u32>,
}

impl<'a> Canonizer<'a> {
    pub(crate) fn new(surface: &'a QuadSurface) -> Self {
        Self { walker: Walker::new(surface), orbits: Orbits::default(), place: vec![0; surface.n_quads()] }
    }

    /// The canonical form of the component that holds the quads `quads` (all of them).
    pub(crate) fn canonical(&mut self, quads: &[u32], handedness: Handedness) -> Canonical {
        let Self { walker, orbits, place } = self;
        let candidates = candidates(walker, quads, handedness);
        orbits.reset(8 * walker.surface.n_quads(), candidates.iter().map(|f| f.index()));
        let mut flag = candidates[0];
        let mut best = walker.code(flag);
        // The walk of the best flag, kept to read automorphisms off.
        let mut best_entered = walker.entered.clone();
        for &other in &candidates[1..] {
            if orbits.is_done(other.index()) || orbits.same(other.index(), flag.index()) {
                continue;
            }
            match walker.improve(other, &mut best) {
                Ordering::Greater => orbits.finish(other.index()),
                Ordering::Less => {
                    orbits.finish(flag.index());
                    flag = other;
                    best_entered.clone_from(&walker.entered);
                }
                Ordering::Equal => {
                    merge_by(orbits, place, (flag, &best_entered), (other, &walker.entered), &candidates)
                }
            }
        }
        let flags = candidates.into_iter().filter(|f| orbits.same(f.index(), flag.index())).collect();
        Canonical { code: best, flag, flags }
    }
}

/// The flags of the rarest kind. Every test here is an invariant, so isomorphic components choose corresponding flags.
fn candidates(walker: &mut Walker<'_>, quads: &[u32], handedness: Handedness) -> Vec<Flag> {
    /// So few flags are tried without a further look.
    const FEW: usize = 32;
    /// How far the second look goes.
    const FAR: usize = 64;
    let surface = walker.surface;
    let hands: &[bool] = match handedness {
        Handedness::Both => &[false, true],
        Handedness::Only { mirrored: false } => &[false],
        Handedness::Only { mirrored: true } => &[true],
    };
    let flags_of = |q: u32| (0..4).flat_map(move |side| hands.iter().map(move |&mirrored| (4 * q + side, mirrored)));
    let mut flags: Vec<Flag> =
        quads.iter().flat_map(|&q| flags_of(q)).map(|(dart, mirrored)| Flag { dart: Dart(dart), mirrored }).collect();
    let kind = |flag: Flag| {
        let degrees = flag.corners(surface).map(|v| u64::from(surface.degree(v).min(0xFFFF)));
        degrees.iter().fold(0, |key, d| key << 16 | d)
    };
    keep_rarest(&mut flags, kind);
    if flags.len() > FEW {
        keep_rarest(&mut flags, |flag| walker.fingerprint(flag, FAR));
    }
    flags
}

/// Merges the orbits by the automorphism that takes one flag to another, each given with the darts by which its walk entered the quads.
/// `place` is scratch, one number a quad.
fn merge_by(
    orbits: &mut Orbits,
    place: &mut [u32],
    (a, from): (Flag, &[Dart]),
    (b, to): (Flag, &[Dart]),
    candidates: &[Flag],
) {
    for (i, d) in from.iter().enumerate() {
        place[d.quad().index()] = i as u32;
    }
    for &flag in candidates {
        // `flag` is so many sides after the entry of its quad, in the sense of `a`; its image so many after the entry of the image quad, in that of `b`.
        let i = place[flag.dart.quad().index()] as usize;
        let ahead = (flag.dart.0 + 4 - from[i].0 % 4) % 4;
        let steps = if a.mirrored { (4 - ahead) % 4 } else { ahead };
        let start = Flag { dart: to[i], mirrored: b.mirrored };
        let image = Flag { dart: start.rotated(steps).dart, mirrored: flag.mirrored ^ a.mirrored ^ b.mirrored };
        orbits.union(flag.index(), image.index());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{all_spheres, torus};

    #[test]
    fn flags_turn_in_their_own_sense() {
        for s in all_spheres(8) {
            for i in 0..8 * s.n_quads() {
                let flag = Flag::from_index(i);
                assert_eq!(flag.index(), i);
                let c = flag.corners(&s);
                for steps in 0..4u32 {
                    let mut expected = c;
                    expected.rotate_left(steps as usize);
                    assert_eq!(flag.rotated(steps).corners(&s), expected);
                }
                let (o, t) = (s.origin(flag.dart), s.target(flag.dart));
                assert_eq!([c[0], c[1]], if flag.mirrored { [t, o] } else { [o, t] });
            }
        }
    }

    #[test]
    fn orbits_agree_with_all_codes() {
        let mut surfaces: Vec<QuadSurface> = (6..=12).flat_map(all_spheres).collect();
        surfaces.extend([torus(4, 4, 0).unwrap(), torus(3, 5, 1).unwrap(), torus(5, 5, 2).unwrap()]);
        for s in surfaces {
            let quads: Vec<u32> = (0..s.n_quads() as u32).collect();
            let c = Canonizer::new(&s).canonical(&quads, Handedness::Both);
            let mut walker = Walker::new(&s);
            let equal: Vec<Flag> =
                (0..8 * s.n_quads()).map(Flag::from_index).filter(|&f| walker.code(f) == c.code).collect();
            assert_eq!(c.flags, equal);
            assert!(c.flags.contains(&c.flag));
            assert_eq!((8 * s.n_quads()) % equal.len(), 0, "automorphisms act freely on flags");
        }
    }
}
