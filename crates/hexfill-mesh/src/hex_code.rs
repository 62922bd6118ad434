//! The breadth-first code of a hex mesh from a flag, and the smallest code over all flags.
//!
//! A flag is a hex and one of its 48 frames (see [`symmetries`]); the hex's corners in frame order get the labels 0..7. Then each hex in turn looks across
//! its six facets in frame order: the code has 0 for a boundary facet, nothing for a hex already visited, and for a new hex its four far corners, each
//! 0 for a vertex met for the first time (it gets the next label) or (next label - its label); the first of the four is raised by 1 to leave room
//! for the boundary. The new hex's frame is the old one pushed through the facet. As vertices are labelled, identifications that no facet causes count too.
//! Flags are restricted to a rare kind and to one for each orbit, as in `surface_code.rs`.
//!
//! Source: ours, after Brinkmann, McKay 2007 for surfaces.

use crate::cube::{FACET_DIAGONALS, FACETS, POSITIONS, corner_at, symmetries};
use crate::hexmesh::{Facet, HexMesh};
use crate::ids::{HexId, VertexId};
use crate::orbits::{Orbits, keep_rarest, mix};
use std::cmp::Ordering;
use std::sync::OnceLock;

const UNLABELLED: u32 = u32::MAX;

/// Corner `i` of the frame is corner `frame[i]` of the hex.
pub(crate) type Frame = [u8; 8];

/// Index tables over the cube's symmetries.
struct Tables {
    /// The 48 frames, rotations first.
    frames: [Frame; 48],
    /// Index of the frame with given images of the corners 0, 1, 3 (as an octal number).
    index: [u8; 512],
    /// The facet that has a diagonal between two corners.
    facet_with_diagonal: [[u8; 8]; 8],
    /// Per facet and corner: the corner at the other end of the edge across the facet's direction.
    across: [[u8; 8]; 6],
}

fn tables() -> &'static Tables {
    static TABLES: OnceLock<Tables> = OnceLock::new();
    TABLES.get_or_init(|| {
        let frames = symmetries().map(|s| s.map(|k| k as u8));
        // A frame is told by three of its corners, so three octal digits are an index.
        let mut index = [u8::MAX; 512];
        for (i, frame) in frames.iter().enumerate() {
            index[octal(frame)] = i as u8;
        }
        let mut facet_with_diagonal = [[u8::MAX; 8]; 8];
        for (side, diagonals) in FACET_DIAGONALS.iter().enumerate() {
            for &[a, b] in diagonals {
                facet_with_diagonal[a][b] = side as u8;
                facet_with_diagonal[b][a] = side as u8;
            }
        }
        let across = std::array::from_fn(|side| {
            std::array::from_fn(|corner| {
                let mut p = POSITIONS[corner];
                p[side / 2] ^= 1;
                corner_at(p[0], p[1], p[2]) as u8
            })
        });
        Tables { frames, index, facet_with_diagonal, across }
    })
}

fn octal(frame: &Frame) -> usize {
    usize::from(frame[0]) << 6 | usize::from(frame[1]) << 3 | usize::from(frame[3])
}

/// The corner of the reference cube across facet `side` from `corner`.
pub(crate) fn corner_across(side: usize, corner: usize) -> usize {
    tables().across[side][corner].into()
}

/// Whether a frame is a reflection.
pub(crate) fn is_mirrored(frame: &Frame) -> bool {
    tables().index[octal(frame)] >= 24
}

/// A hex and the index (0..48) of one of its frames.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct HexFlag {
    pub hex: HexId,
    pub frame: u8,
}

impl HexFlag {
    fn index(self) -> usize {
        48 * self.hex.index() + usize::from(self.frame)
    }
}

/// Labels and visits of one walk; reused from walk to walk.
pub(crate) struct HexWalker<'a> {
    mesh: &'a HexMesh,
    label: Vec<u32>,
    visited: Vec<bool>,
    /// Vertices by label.
    pub order: Vec<VertexId>,
    /// Visited hexes with their frames, in order of visit.
    pub entered: Vec<(HexId, Frame)>,
}

impl<'a> HexWalker<'a> {
    pub(crate) fn new(mesh: &'a HexMesh) -> Self {
        Self {
            mesh,
            label: vec![UNLABELLED; mesh.n_vertices()],
            visited: vec![false; mesh.n_hexes()],
            order: Vec::new(),
            entered: Vec::new(),
        }
    }

    /// Forgets the last walk; costs as much as it visited.
    fn clear(&mut self) {
        for v in self.order.drain(..) {
            self.label[v.index()] = UNLABELLED;
        }
        for (h, _) in self.entered.drain(..) {
            self.visited[h.index()] = false;
        }
    }

    /// Walks from a flag and hands each number of the code to `visit`, until it returns `false` or the component is done.
    #[inline]
    fn walk(&mut self, flag: HexFlag, mut visit: impl FnMut(u32) -> bool) {
        self.clear();
        let tables = tables();
        let first = tables.frames[usize::from(flag.frame)];
        let hex = self.mesh.hex(flag.hex);
        for k in first {
            let v = hex[usize::from(k)];
            self.label[v.index()] = self.order.len() as u32;
            self.order.push(v);
        }
        self.visited[flag.hex.index()] = true;
        self.entered.push((flag.hex, first));
        let mut at = 0;
        while at < self.entered.len() {
            let (h, frame) = self.entered[at];
            at += 1;
            let hex = self.mesh.hex(h);
            for (s, corners) in FACETS.iter().enumerate() {
                // Frames may be reflections, so a facet is not told by its number in the frame alone: a diagonal of
                // it tells.
                let [a, _, c, _] = corners.map(|i| usize::from(frame[i]));
                let side = usize::from(tables.facet_with_diagonal[a][c]);
                let Some(other) = self.mesh.neighbour(Facet::new(h, side)) else {
                    if !visit(0) {
                        return;
                    }
                    continue;
                };
                let other_hex = other.hex();
                if self.visited[other_hex.index()] {
                    continue;
                }
                self.visited[other_hex.index()] = true;
                let vertices = self.mesh.hex(other_hex);
                let near = FACETS[other.side()];
                let mut pushed = [0u8; 8];
                for &i in corners {
                    let v = hex[usize::from(frame[i])];
                    let k = near.into_iter().find(|&k| vertices[k] == v).expect("glued facets have the same vertices");
                    // As if the hex were moved across the facet: shared vertices take the places opposite, far ones
                    // theirs, so that directions go straight on.
                    pushed[usize::from(tables.across[s][i])] = k as u8;
                    pushed[i] = tables.across[other.side()][k];
                }
                self.entered.push((other_hex, pushed));
                for (j, &i) in corners.iter().enumerate() {
                    let v = vertices[usize::from(pushed[i])];
                    let next = self.order.len() as u32;
                    let label = &mut self.label[v.index()];
                    let number = if *label == UNLABELLED {
                        *label = next;
                        self.order.push(v);
                        0
                    } else {
                        next - *label
                    };
                    // The first of the four is one higher, as 0 in its place says "boundary".
                    if !visit(number + u32::from(j == 0)) {
                        return;
                    }
                }
            }
        }
    }

    /// The code of a flag.
    pub(crate) fn code(&mut self, flag: HexFlag) -> Vec<u32> {
        let mut code = Vec::new();
        self.walk(flag, |number| {
            code.push(number);
            true
        });
        code
    }

    /// Compares the code of a flag with `best` (of the same component) and makes `best` the smaller one.
    fn improve(&mut self, flag: HexFlag, best: &mut Vec<u32>) -> Ordering {
        let mut at = 0;
        let mut order = Ordering::Equal;
        self.walk(flag, |number| {
            if order == Ordering::Equal {
                // Codes are not all of one length here, but none is the beginning of another: the code says itself where it ends.
                order = number.cmp(&best[at]);
                if order == Ordering::Less {
                    best.truncate(at);
                }
            }
            if order == Ordering::Less {
                best.push(number);
            }
            at += 1;
            order != Ordering::Greater
        });
        order
    }

    /// A fingerprint of what lies round a flag: the first `length` numbers of its code and the valences of the vertices met.
    fn fingerprint(&mut self, flag: HexFlag, length: usize, valence: &[u32]) -> u64 {
        let mut hash = 0u64;
        let mut left = length;
        self.walk(flag, |number| {
            hash = mix(hash, number);
            left -= 1;
            left > 0
        });
        self.order.iter().fold(hash, |hash, v| mix(hash, valence[v.index()]))
    }
}

/// The canonical form of one component (connected through facets).
pub(crate) struct HexCanonical {
    /// The smallest code over the flags tried.
    pub code: Vec<u32>,
    /// A flag that has it.
    pub flag: HexFlag,
    /// All flags that have it, ascending; automorphisms act freely on the flags of a component.
    pub flags: Vec<HexFlag>,
}

/// Which frames a canonical form is taken over.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Frames {
    All,
    Rotations,
}

/// Computes canonical forms of the components of one mesh; keeps its tables from one to the next.
pub(crate) struct HexCanonizer<'a> {
    walker: HexWalker<'a>,
    orbits: Orbits,
    place: Vec<u32>,
    valence: Vec<u32>,
}

impl<'a> HexCanonizer<'a> {
    pub(crate) fn new(mesh: &'a HexMesh) -> Self {
        Self {
            walker: HexWalker::new(mesh),
            orbits: Orbits::default(),
            place: vec![0; mesh.n_hexes()],
            valence: crate::valence::vertex_valences(mesh),
        }
    }

    /// The canonical form of the component that consists of `hexes`.
    pub(crate) fn canonical(&mut self, hexes: &[HexId], frames: Frames) -> HexCanonical {
        let candidates = self.candidates(hexes, frames);
        let Self { walker, orbits, place, .. } = self;
        // Orbits are kept by position among the candidates: all 48 flags of every hex would take far more memory than the mesh.
        orbits.reset(candidates.len(), 0..candidates.len());
        let mut first = 0;
        let mut best = walker.code(candidates[first]);
        let mut best_entered = walker.entered.clone();
        for other in 1..candidates.len() {
            if orbits.is_done(other) || orbits.same(other, first) {
                continue;
            }
            match walker.improve(candidates[other], &mut best) {
                Ordering::Greater => orbits.finish(other),
                Ordering::Less => {
                    orbits.finish(first);
                    first = other;
                    best_entered.clone_from(&walker.entered);
                }
                Ordering::Equal => merge_by(orbits, place, &best_entered, &walker.entered, &candidates),
            }
        }
        let flags = (0..candidates.len()).filter(|&i| orbits.same(i, first)).map(|i| candidates[i]).collect();
        HexCanonical { code: best, flag: candidates[first], flags }
    }

    /// The flags of the rarest kind; every test is an invariant.
    fn candidates(&mut self, hexes: &[HexId], frames: Frames) -> Vec<HexFlag> {
        const FEW: usize = 48;
        const FAR: usize = 96;
        let n_frames = if frames == Frames::All { 48 } else { 24 };
        let Self { walker, valence, .. } = self;
        // First the rarest kind of hex, whatever its frame, so that large meshes never hold all their flags.
        let mut rare: Vec<HexId> = hexes.to_vec();
        keep_rarest(&mut rare, |h| {
            let mut around = walker.mesh.hex(h).map(|v| valence[v.index()]);
            around.sort_unstable();
            around.iter().fold(0, |hash, &n| mix(hash, n))
        });
        let mut flags: Vec<HexFlag> =
            rare.iter().flat_map(|&hex| (0..n_frames).map(move |frame| HexFlag { hex, frame })).collect();
        keep_rarest(&mut flags, |flag| {
            let hex = walker.mesh.hex(flag.hex);
            let frame = tables().frames[usize::from(flag.frame)];
            frame.iter().fold(0, |hash, &k| mix(hash, valence[hex[usize::from(k)].index()]))
        });
        if flags.len() > FEW {
            keep_rarest(&mut flags, |flag| walker.fingerprint(flag, FAR, valence));
        }
        flags
    }
}

/// Merges the orbits by the automorphism that takes one walk to another with the same code.
fn merge_by(
    orbits: &mut Orbits,
    place: &mut [u32],
    from: &[(HexId, Frame)],
    to: &[(HexId, Frame)],
    candidates: &[HexFlag],
) {
    let tables = tables();
    for (i, (h, _)) in from.iter().enumerate() {
        place[h.index()] = i as u32;
    }
    for (position, flag) in candidates.iter().enumerate() {
        let i = place[flag.hex.index()] as usize;
        let ((_, source), (image, target)) = (from[i], to[i]);
        // Corner source[k] of the hex goes to corner target[k] of its image.
        let mut corner = [0u8; 8];
        for k in 0..8 {
            corner[usize::from(source[k])] = target[k];
        }
        let frame = tables.frames[usize::from(flag.frame)].map(|k| corner[usize::from(k)]);
        let image = HexFlag { hex: image, frame: tables.index[octal(&frame)] };
        // The candidates are ascending and closed under automorphisms.
        let image = candidates.binary_search_by_key(&image.index(), |f| f.index());
        orbits.union(position, image.expect("an automorphism keeps the kind of a flag"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{grid, grid_mesh_of};

    #[test]
    fn tables_invert_each_other() {
        let t = tables();
        for (i, frame) in t.frames.iter().enumerate() {
            assert_eq!(usize::from(t.index[octal(frame)]), i);
        }
        for (side, facet) in FACETS.iter().enumerate() {
            for corner in 0..8 {
                let other = corner_across(side, corner);
                assert_eq!(corner_across(side, other), corner);
                assert_ne!(facet.contains(&corner), facet.contains(&other));
            }
        }
    }

    #[test]
    fn orbits_agree_with_all_codes() {
        let tray = grid_mesh_of([3, 3, 1], |[x, y, _]| (x, y) != (1, 1)).unwrap();
        let bent =
            grid_mesh_of([2, 2, 2], |[x, y, z]| [[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1]].contains(&[x, y, z]));
        for mesh in [grid(1, 1, 1), grid(2, 1, 1), grid(2, 2, 3), grid(2, 2, 2), Ok(tray), bent] {
            let mesh = mesh.unwrap();
            let hexes: Vec<HexId> = (0..mesh.n_hexes()).map(HexId::new).collect();
            for (frames, n) in [(Frames::All, 48), (Frames::Rotations, 24)] {
                let c = HexCanonizer::new(&mesh).canonical(&hexes, frames);
                let mut walker = HexWalker::new(&mesh);
                let all = hexes.iter().flat_map(|&hex| (0..n).map(move |frame| HexFlag { hex, frame }));
                let equal: Vec<HexFlag> = all.filter(|&f| walker.code(f) == c.code).collect();
                assert_eq!(c.flags, equal);
                assert!(equal.contains(&c.flag));
            }
        }
    }
}
