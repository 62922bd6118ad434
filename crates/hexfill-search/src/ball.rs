//! [`Ball`]: a shelled hex ball, replayed from its flips, and its placement in a surface.
//!
//! An atlas stores a ball as the flips that lead from one cube to it, each named on the *canonical* cavity of the state
//! before. Replaying keeps the true vertex numbers beside the canonical ones; a canonical cavity may be the mirror image
//! of the true one, which is tracked so that every hex comes out positively oriented.
//!
//! Source: ours.

use crate::canonical::{Canonical, decode};
use crate::cavity::{Cavity, MAX_VERTICES};
use crate::flip::{Flip, apply, is_legal, place};
use hexfill_mesh::cube::FACETS;

/// A hex ball that was shelled from one cube.
#[derive(Clone, Debug)]
pub struct Ball {
    /// Corners of each hex in VTK order, positively oriented; vertices in order of creation.
    pub hexes: Vec<[u32; 8]>,
    /// Number of vertices.
    pub n_vertices: u32,
    /// The boundary, outward, with the pairs its inside blocks.
    pub boundary: Cavity,
    /// Ball vertex of each vertex of `boundary`.
    pub boundary_vertices: Vec<u32>,
}

/// The mirror image of a hex: bottom and top exchanged.
pub(crate) fn mirror_hex(h: [u32; 8]) -> [u32; 8] {
    [h[4], h[5], h[6], h[7], h[0], h[1], h[2], h[3]]
}

/// A cavity in canonical form: what a flip of the atlas refers to.
pub(crate) struct CanonicalCavity {
    pub cavity: Cavity,
    /// Canonical number of each vertex of the cavity it was made from.
    pub numbers: [u8; MAX_VERTICES],
    pub mirrored: bool,
}

/// The canonical form of a cavity with its blocked pairs.
pub(crate) fn canonical_cavity(cavity: &Cavity, canonical: &mut Canonical) -> CanonicalCavity {
    canonical.compute(cavity);
    let (image, flag) = canonical.blocked_image(cavity);
    let mut out = decode(canonical.code()).expect("a canonical code is a sphere");
    out.blocked = image;
    CanonicalCavity { cavity: out, numbers: Canonical::vertex_numbers(cavity, flag), mirrored: flag.mirrored }
}

impl Ball {
    /// Replays flips from one cube, each on the canonical cavity of the ball so far. `None` if a flip is not legal there
    /// (the flips are then not from an atlas of this version).
    pub fn replay(flips: impl IntoIterator<Item = Flip>) -> Option<Self> {
        let mut canonical = Canonical::new();
        let mut hexes = vec![[0, 1, 2, 3, 4, 5, 6, 7]];
        let mut n_vertices = 8u32;
        let mut boundary = Cavity::cube();
        // Ball vertex per vertex of `boundary`; whether `boundary` is the mirror image of the ball's outside.
        let mut ids: Vec<u32> = (0..8).collect();
        let mut mirrored = false;
        for flip in flips {
            let form = canonical_cavity(&boundary, &mut canonical);
            let mut canonical_ids = vec![0; ids.len()];
            for (v, &id) in ids.iter().enumerate() {
                canonical_ids[usize::from(form.numbers[v])] = id;
            }
            // The canonical cavity may show the ball's outside in a mirror; two mirrors cancel, and hexes glued
            // behind one are turned.
            mirrored ^= form.mirrored;
            if usize::from(flip.dart) >= 4 * form.cavity.n_quads() {
                return None;
            }
            let placement = place(&form.cavity, &form.cavity.degrees(), flip)?;
            let grown = form.cavity.n_quads() as i32 + flip.kind.gain();
            if grown > crate::MAX_QUADS as i32 || !is_legal(&placement, &form.cavity.marked()) {
                return None;
            }
            let (after, before) = apply(&form.cavity, &placement);
            let brought = placement.corners.iter().filter(|&&c| usize::from(c) >= canonical_ids.len()).count() as u32;
            canonical_ids.extend(n_vertices..n_vertices + brought);
            n_vertices += brought;
            let hex = placement.corners.map(|c| canonical_ids[usize::from(c)]);
            hexes.push(if mirrored { mirror_hex(hex) } else { hex });
            ids = before[..after.n_vertices()].iter().map(|&v| canonical_ids[usize::from(v)]).collect();
            boundary = after;
        }
        if mirrored {
            boundary = mirror_image(&boundary);
        }
        Some(Self { hexes, n_vertices, boundary, boundary_vertices: ids })
    }

    /// The boundary as a cavity to fill: nothing blocked.
    pub fn boundary_only(&self) -> Cavity {
        let mut cavity = self.boundary.clone();
        cavity.blocked = [0; MAX_VERTICES];
        cavity
    }

    /// Number of hexes.
    pub fn n_hexes(&self) -> usize {
        self.hexes.len()
    }

    /// All ways to put the ball into `cavity` so that their boundaries coincide and nothing the ball uses is blocked in
    /// `cavity`: for each, the cavity vertex of every boundary vertex of the ball, and whether the ball is mirrored.
    /// At most one per automorphism of the boundary, in a fixed order. Empty if the boundaries are not isomorphic.
    pub fn placements(&self, cavity: &Cavity) -> Vec<(Vec<u8>, bool)> {
        let (mut mine, mut theirs) = (Canonical::new(), Canonical::new());
        mine.compute(&self.boundary);
        theirs.compute(cavity);
        if mine.code() != theirs.code() {
            return Vec::new();
        }
        // One flag of the ball against all of the cavity: every isomorphism once, as automorphisms of the one are
        // those of the other.
        let flag = mine.flags()[0];
        let numbers = Canonical::vertex_numbers(&self.boundary, flag);
        let mut found = Vec::new();
        for &other in theirs.flags() {
            let map = compose(&numbers, &Canonical::vertex_numbers(cavity, other), cavity.n_vertices());
            let fits = (0..cavity.n_vertices()).all(|v| {
                let mut row = self.boundary.blocked[v];
                let taken = cavity.blocked[usize::from(map[v])];
                while row != 0 {
                    if taken >> map[row.trailing_zeros() as usize] & 1 == 1 {
                        return false;
                    }
                    row &= row - 1;
                }
                true
            });
            if fits {
                found.push((map, flag.mirrored != other.mirrored));
            }
        }
        found
    }

    /// The ball's hexes in the vertex numbers of its surroundings: `boundary_ids[v]` for boundary vertex `v`,
    /// `first_new, first_new + 1, ...` for the interior vertices in order of creation.
    /// Returns the hexes and the number of interior vertices.
    pub fn hexes_in(&self, boundary_ids: &[u32], mirrored: bool, first_new: u32) -> (Vec<[u32; 8]>, u32) {
        let mut id = vec![u32::MAX; self.n_vertices as usize];
        for (&ball_vertex, &outside) in self.boundary_vertices.iter().zip(boundary_ids) {
            id[ball_vertex as usize] = outside;
        }
        let mut fresh = 0;
        for slot in &mut id {
            if *slot == u32::MAX {
                *slot = first_new + fresh;
                fresh += 1;
            }
        }
        let hexes = self.hexes.iter().map(|h| {
            let h = h.map(|v| id[v as usize]);
            if mirrored { mirror_hex(h) } else { h }
        });
        (hexes.collect(), fresh)
    }

    /// Checks that the boundary is what the hexes leave open; for tests.
    ///
    /// # Panics
    /// If it is not.
    pub fn debug_check(&self) {
        self.boundary.debug_check();
        let mut open = std::collections::BTreeSet::new();
        for hex in &self.hexes {
            for facet in FACETS {
                let q = facet.map(|i| hex[i]);
                let rotations = |q: [u32; 4]| (0..4).map(move |i| [0, 1, 2, 3].map(|k| q[(k + i) % 4]));
                let reversed = [q[3], q[2], q[1], q[0]];
                if !rotations(reversed).any(|r| open.remove(&r)) {
                    open.insert(q);
                }
            }
        }
        let quads = self.boundary.quads();
        assert_eq!(open.len(), quads.len());
        for q in quads {
            let q = q.map(|v| self.boundary_vertices[usize::from(v)]);
            assert!((0..4).any(|i| open.contains(&[0, 1, 2, 3].map(|k| q[(k + i) % 4]))), "quad {q:?} faces outward");
        }
    }
}

/// `number_a` then the inverse of `number_b`, both onto `0..n`.
fn compose(number_a: &[u8; MAX_VERTICES], number_b: &[u8; MAX_VERTICES], n: usize) -> Vec<u8> {
    let mut back = vec![0u8; n];
    for v in 0..n {
        back[usize::from(number_b[v])] = v as u8;
    }
    (0..n).map(|v| back[usize::from(number_a[v])]).collect()
}

/// The same cavity seen from the other side: every quad reversed.
pub(crate) fn mirror_image(cavity: &Cavity) -> Cavity {
    let mut out = cavity.clone();
    // Side i (corner i to i + 1) becomes side 3 - i - 1 of the reversed quad [3, 2, 1, 0]: dart d -> (2 - side) mod 4.
    let image = |d: u8| (d & !3) | (2u8.wrapping_sub(d & 3) & 3);
    for d in 0..4 * cavity.n_quads {
        let e = usize::from(image(d));
        out.twin[e] = image(cavity.twin[usize::from(d)]);
        // Dart d runs a -> b; its image runs b -> a.
        out.origin[e] = cavity.origin[usize::from(crate::cavity::next(d))];
    }
    out
}
