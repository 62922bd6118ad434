//! Flips: gluing one hex on a disk of `k` quads of a cavity, which replaces them by the hex's other `6 - k` facets.
//!
//! | kind | quads | new vertices | buried vertices |
//! |---|---|---|---|
//! | 1->5 | +4 | 4 | 0 |
//! | 2->4 | +2 | 2 | 0 |
//! | 3->3 corner | 0 | 1 | 1 |
//! | 3->3 strip | 0 | 0 | 0 |
//! | 4->2 | -2 | 0 | 2 |
//! | 5->1 | -4 | 0 | 4 |
//!
//! (Bern, Eppstein, Erickson, "Flipping cubical meshes", 2002.) Legality costs O(1): two hexes that share a set S of
//! at least two vertices meet properly iff no pair of S is a body diagonal, a diagonal of a quad forces that whole quad,
//! and otherwise S is one edge. So every edge of the new hex that the covered quads do not have, every diagonal of a
//! quad that is not covered and every body diagonal must join a pair that nothing has used yet.
//!
//! Source: Bern, Eppstein and Erickson 2002; that pairs of vertices decide is ours (proof: `topology/star.rs` of `hexfill-check`).

use crate::cavity::{Cavity, MAX_QUADS, MAX_VERTICES, Pairs, next, turn};
use hexfill_mesh::cube::{BODY_DIAGONALS, EDGES, FACET_DIAGONALS, FACETS};
use std::sync::LazyLock;

/// The kind of a flip, named by the number of quads before and after.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Hash)]
#[repr(u8)]
pub enum FlipKind {
    /// A quad.
    OneToFive = 0,
    /// Two quads at an edge.
    TwoToFour = 1,
    /// Three quads round a vertex of degree 3.
    Corner = 2,
    /// A quad and two opposite neighbours.
    Strip = 3,
    /// The quads round an edge with two ends of degree 3.
    FourToTwo = 4,
    /// A quad with four corners of degree 3, and its neighbours.
    FiveToOne = 5,
}

impl FlipKind {
    /// All kinds, in the order of their numbers.
    pub const ALL: [Self; 6] =
        [Self::OneToFive, Self::TwoToFour, Self::Corner, Self::Strip, Self::FourToTwo, Self::FiveToOne];

    /// How many quads the boundary gains.
    pub const fn gain(self) -> i32 {
        [4, 2, 0, 0, -2, -4][self as usize]
    }

    /// How many vertices the hex brings.
    pub const fn new_vertices(self) -> i32 {
        [4, 2, 1, 0, 0, 0][self as usize]
    }
}

/// A flip of a given cavity: its kind and the dart of the cavity it starts from. Two bytes in a file.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Hash)]
pub struct Flip {
    /// The kind.
    pub kind: FlipKind,
    /// The dart that carries side 0 of the hex's bottom facet.
    pub dart: u8,
}

impl Flip {
    /// The flip as two bytes: kind, dart.
    pub const fn to_bytes(self) -> [u8; 2] {
        [self.kind as u8, self.dart]
    }

    /// The flip of two bytes; `None` if the kind is none.
    pub fn from_bytes([kind, dart]: [u8; 2]) -> Option<Self> {
        Some(Self { kind: *FlipKind::ALL.get(usize::from(kind))?, dart })
    }
}

/// The bottom facet `z-`; every flip covers it. Its sides 0..4 touch the facets x-, y+, x+, y-.
const BOTTOM: usize = 4;
/// A corner no covered quad gives: the hex brings a new vertex there.
pub(crate) const NEW: u8 = u8::MAX;

/// What a flip kind covers and must check, in corners of the reference cube.
struct KindTable {
    /// Covered facets other than the bottom: (side of the bottom they touch, facet, their side that touches the bottom).
    around: Vec<(u8, usize, u8)>,
    /// Pairs of covered facets round the bottom that must touch each other: (facet, side, facet, side).
    closing: Vec<(usize, u8, usize, u8)>,
    /// Facets that are not covered.
    open: Vec<usize>,
    covered: [bool; 6],
    new_corners: Vec<usize>,
    buried_corners: Vec<usize>,
    /// Pairs of old corners that must be unused.
    must_be_free: Vec<[usize; 2]>,
    /// Pairs of surviving or new corners that become blocked.
    blocks: Vec<[usize; 2]>,
}

/// `ADJACENT[f][i]`: the facet and its side along side `i` of facet `f`.
static ADJACENT: LazyLock<[[(usize, u8); 4]; 6]> = LazyLock::new(|| {
    std::array::from_fn(|f| {
        std::array::from_fn(|i| {
            let (a, b) = (FACETS[f][i], FACETS[f][(i + 1) % 4]);
            (0..6)
                .filter(|&g| g != f)
                .find_map(|g| (0..4).find(|&j| FACETS[g][j] == b && FACETS[g][(j + 1) % 4] == a).map(|j| (g, j as u8)))
                .expect("every edge of the cube has two facets")
        })
    })
});

static KINDS: LazyLock<[KindTable; 6]> = LazyLock::new(|| {
    let sides: [&[u8]; 6] = [&[], &[0], &[0, 1], &[0, 2], &[0, 1, 3], &[0, 1, 2, 3]];
    sides.map(|sides| {
        let mut covered = [false; 6];
        covered[BOTTOM] = true;
        let around: Vec<_> = sides
            .iter()
            .map(|&s| {
                let (g, j) = ADJACENT[BOTTOM][usize::from(s)];
                covered[g] = true;
                (s, g, j)
            })
            .collect();
        let mut closing = Vec::new();
        for &(_, f, _) in &around {
            for i in 0..4u8 {
                let (g, j) = ADJACENT[f][usize::from(i)];
                if g != BOTTOM && covered[g] && f < g {
                    closing.push((f, i, g, j));
                }
            }
        }
        let open: Vec<usize> = (0..6).filter(|&f| !covered[f]).collect();
        let touches = |f: usize, k: usize| FACETS[f].contains(&k);
        let old = |k: usize| (0..6).any(|f| covered[f] && touches(f, k));
        let survives = |k: usize| open.iter().any(|&f| touches(f, k));
        let of_covered = |e: [usize; 2]| (0..6).any(|f| covered[f] && e.iter().all(|&k| touches(f, k)));
        let of_open = |e: [usize; 2]| open.iter().any(|&f| e.iter().all(|&k| touches(f, k)));
        // Of the hex's 28 pairs those on covered quads are used by the very quads it is glued on; all others that
        // join old vertices must not be used by anything, or two cells would share more than a vertex, an edge or a
        // quad of both.
        let mut must_be_free: Vec<[usize; 2]> = EDGES.into_iter().filter(|&e| !of_covered(e)).collect();
        must_be_free.extend(open.iter().flat_map(|&f| FACET_DIAGONALS[f]));
        must_be_free.extend(BODY_DIAGONALS);
        must_be_free.retain(|e| e.iter().all(|&k| old(k)));
        // What stays forbidden after the flip: pairs of the hex between vertices still on the surface that are no
        // edge or diagonal of a quad there. Those are told by the surface itself.
        let mut blocks: Vec<[usize; 2]> = EDGES.into_iter().filter(|&e| !of_open(e)).collect();
        blocks.extend((0..6).filter(|&f| covered[f]).flat_map(|f| FACET_DIAGONALS[f]));
        blocks.extend(BODY_DIAGONALS);
        blocks.retain(|e| e.iter().all(|&k| survives(k)));
        KindTable {
            around,
            closing,
            covered,
            new_corners: (0..8).filter(|&k| !old(k)).collect(),
            buried_corners: (0..8).filter(|&k| !survives(k)).collect(),
            open,
            must_be_free,
            blocks,
        }
    })
});

/// A flip worked out on its cavity: where the hex's corners and covered facets lie.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    /// The flip.
    pub flip: Flip,
    /// Cavity vertex per corner of the hex, or a value not below `n_vertices` for a new vertex
    /// (numbered `n_vertices, n_vertices + 1, ...` in the order of the corners).
    pub corners: [u8; 8],
    /// Per covered facet: the dart under its side 0 (which runs the other way).
    facet_dart: [u8; 6],
}

/// Works out a flip. `None` if the quads there do not have the pattern of its kind or the eight corners are not distinct.
/// Legality against the pair table is for [`is_legal`].
pub fn place(cavity: &Cavity, degrees: &[u8; MAX_VERTICES], flip: Flip) -> Option<Placement> {
    let table = &KINDS[flip.kind as usize];
    let (twin, origin) = (&cavity.twin, &cavity.origin);
    let d = flip.dart;
    let deg = |d: u8| degrees[usize::from(origin[usize::from(d)])];
    // Side i of the bottom runs over dart turn(d, -i); corners of the patch buried by the flip have degree 3.
    match flip.kind {
        FlipKind::OneToFive | FlipKind::TwoToFour | FlipKind::Strip => {}
        FlipKind::Corner => {
            if deg(d) != 3 {
                return None;
            }
        }
        FlipKind::FourToTwo => {
            if deg(d) != 3 || deg(next(d)) != 3 {
                return None;
            }
        }
        FlipKind::FiveToOne => {
            if (0..4).any(|i| deg(turn(d, i)) != 3) {
                return None;
            }
        }
    }
    // The cube is laid with its bottom on the dart's quad; the other covered facets are found from there through
    // twins, in the order of the table.
    let mut facet_dart = [NEW; 6];
    facet_dart[BOTTOM] = d;
    for &(side, facet, touch) in &table.around {
        let under = turn(d, 4 - side);
        facet_dart[facet] = turn(twin[usize::from(under)], touch);
    }
    // Every facet but the bottom was found on one way; where two of them share an edge on the cube, they have to
    // share it here. (Degree 3 above is the same demand at buried corners.)
    for &(f, i, g, j) in &table.closing {
        let a = turn(facet_dart[f], 4 - i);
        let b = turn(facet_dart[g], 4 - j);
        if twin[usize::from(a)] != b {
            return None;
        }
    }
    let mut corners = [NEW; 8];
    for f in 0..6 {
        if table.covered[f] {
            for (i, &corner) in FACETS[f].iter().enumerate() {
                let under = turn(facet_dart[f], 4 - i as u8);
                corners[corner] = origin[usize::from(next(under))];
            }
        }
    }
    let mut seen = 0u64;
    let mut fresh = cavity.n_vertices;
    for corner in &mut corners {
        if *corner == NEW {
            *corner = fresh;
            fresh += 1;
        } else {
            // The patch may touch itself beyond the edges looked at above; a hex has eight distinct corners.
            if seen >> *corner & 1 == 1 {
                return None;
            }
            seen |= 1 << *corner;
        }
    }
    Some(Placement { flip, corners, facet_dart })
}

/// Whether the hex meets everything behind the cavity properly; `marked` is the table of used pairs of the cavity.
#[inline]
pub fn is_legal(placement: &Placement, marked: &Pairs) -> bool {
    KINDS[placement.flip.kind as usize]
        .must_be_free
        .iter()
        .all(|&[i, j]| marked[usize::from(placement.corners[i])] >> placement.corners[j] & 1 == 0)
}

/// All candidate flips of a cavity, each once, in ascending order of kind and dart; `max_quads` bounds the result's size.
pub(crate) fn candidates(cavity: &Cavity, max_quads: usize) -> impl Iterator<Item = Flip> + '_ {
    FlipKind::ALL.into_iter().filter(move |k| cavity.n_quads() as i32 + k.gain() <= max_quads as i32).flat_map(
        move |kind| {
            (0..4 * cavity.n_quads).filter(move |&d| starts_once(cavity, kind, d)).map(move |dart| Flip { kind, dart })
        },
    )
}

/// Whether `d` is the one dart among those that give the same hex from which the flip is listed.
fn starts_once(cavity: &Cavity, kind: FlipKind, d: u8) -> bool {
    match kind {
        FlipKind::OneToFive | FlipKind::FiveToOne => d & 3 == 0,
        FlipKind::TwoToFour | FlipKind::FourToTwo => d < cavity.twin[usize::from(d)],
        FlipKind::Strip => d & 3 < 2,
        FlipKind::Corner => {
            let b = next(cavity.twin[usize::from(d)]);
            let c = next(cavity.twin[usize::from(b)]);
            next(cavity.twin[usize::from(c)]) == d && d < b && d < c
        }
    }
}

/// The cavity after the flip, and for each of its vertices the vertex before (new vertices: `n_vertices..` in the
/// numbering of [`Placement::corners`]).
pub fn apply(cavity: &Cavity, placement: &Placement) -> (Cavity, [u8; MAX_VERTICES]) {
    let table = &KINDS[placement.flip.kind as usize];
    let mut covered = 0u64;
    for f in 0..6 {
        if table.covered[f] {
            covered |= 1 << (placement.facet_dart[f] >> 2);
        }
    }
    let mut buried = 0u64;
    for &k in &table.buried_corners {
        buried |= 1 << placement.corners[k];
    }
    let mut after = Cavity::empty();
    let mut before = [0u8; MAX_VERTICES];
    let renamed = keep_vertices(cavity, buried, table.new_corners.len() as u8, &mut after, &mut before);
    let quad_of = keep_quads(cavity, covered, &renamed, &mut after);
    add_open_facets(cavity, placement, &renamed, &quad_of, &mut after);
    keep_pairs(cavity, buried, &renamed, &mut after);
    // What the hex uses and no longer shows: edges and diagonals between corners that are still on the outside,
    // buried in it.
    for &[i, j] in &table.blocks {
        let a = renamed[usize::from(placement.corners[i])];
        let b = renamed[usize::from(placement.corners[j])];
        after.block(a, b);
    }
    (after, before)
}

/// Per vertex before, old or new: the vertex after, or [`NEW`] if it is buried.
type Renamed = [u8; MAX_VERTICES + 4];

/// Numbers the vertices after the flip: the survivors in order, then the new ones.
#[inline]
fn keep_vertices(
    cavity: &Cavity,
    buried: u64,
    n_new: u8,
    after: &mut Cavity,
    before: &mut [u8; MAX_VERTICES],
) -> Renamed {
    let mut renamed = [NEW; MAX_VERTICES + 4];
    // A new vertex of a full cavity has no bit in `buried` (a corner flip of 64 vertices brings one before it buries one),
    // and needs none: no flip buries what it brings.
    let brought = cavity.n_vertices..cavity.n_vertices + n_new;
    for v in (0..cavity.n_vertices).filter(|&v| buried >> v & 1 == 0).chain(brought) {
        renamed[usize::from(v)] = after.n_vertices;
        before[usize::from(after.n_vertices)] = v;
        after.n_vertices += 1;
    }
    renamed
}

/// Takes over the quads that the hex does not cover, in order, joined to each other as before. Per quad before: the quad
/// after, or [`NEW`] if it is covered.
#[inline]
fn keep_quads(cavity: &Cavity, covered: u64, renamed: &Renamed, after: &mut Cavity) -> [u8; MAX_QUADS] {
    let mut quad_of = [NEW; MAX_QUADS];
    for q in 0..cavity.n_quads {
        if covered >> q & 1 == 0 {
            quad_of[usize::from(q)] = after.n_quads;
            let (from, to) = (4 * usize::from(q), 4 * usize::from(after.n_quads));
            for i in 0..4 {
                after.origin[to + i] = renamed[usize::from(cavity.origin[from + i])];
            }
            after.n_quads += 1;
        }
    }
    // Twins need the numbers of both quads.
    for q in 0..cavity.n_quads {
        let new = quad_of[usize::from(q)];
        if new == NEW {
            continue;
        }
        for i in 0..4u8 {
            let t = cavity.twin[usize::from(4 * q + i)];
            let tq = quad_of[usize::from(t >> 2)];
            if tq != NEW {
                after.twin[usize::from(4 * new + i)] = 4 * tq + (t & 3);
            }
        }
    }
    quad_of
}

/// Adds the facets of the hex that cover nothing, in their order, joined to each other and to the rim of the patch.
#[inline]
fn add_open_facets(
    cavity: &Cavity,
    placement: &Placement,
    renamed: &Renamed,
    quad_of: &[u8; MAX_QUADS],
    after: &mut Cavity,
) {
    let table = &KINDS[placement.flip.kind as usize];
    let first_new = after.n_quads;
    let new_quad = |f: usize| first_new + table.open.iter().position(|&g| g == f).expect("facet is open") as u8;
    for &f in &table.open {
        let q = after.n_quads;
        after.n_quads += 1;
        for i in 0..4u8 {
            let d = usize::from(4 * q + i);
            after.origin[d] = renamed[usize::from(placement.corners[FACETS[f][usize::from(i)]])];
            let (g, j) = ADJACENT[f][usize::from(i)];
            if table.covered[g] {
                // The dart under side j of the covered facet leaves; its twin stays and meets the new quad.
                let under = turn(placement.facet_dart[g], 4 - j);
                let t = cavity.twin[usize::from(under)];
                let tq = quad_of[usize::from(t >> 2)];
                debug_assert_ne!(tq, NEW, "a rim edge of the patch leads out of it");
                let outer = 4 * tq + (t & 3);
                after.twin[d] = outer;
                after.twin[usize::from(outer)] = d as u8;
            } else {
                after.twin[d] = 4 * new_quad(g) + j;
            }
        }
    }
}

/// Takes over the blocked pairs among the survivors.
#[inline]
fn keep_pairs(cavity: &Cavity, buried: u64, renamed: &Renamed, after: &mut Cavity) {
    if buried == 0 {
        after.blocked[..cavity.n_vertices()].copy_from_slice(&cavity.blocked[..cavity.n_vertices()]);
        return;
    }
    for v in 0..cavity.n_vertices {
        let v2 = renamed[usize::from(v)];
        if v2 == NEW {
            continue;
        }
        let mut row = cavity.blocked[usize::from(v)] & !buried;
        // Close the gaps of the buried vertices, highest first.
        let mut holes = buried;
        while holes != 0 {
            let hole = 63 - holes.leading_zeros();
            let low = (1u64 << hole) - 1;
            row = (row & low) | (row >> 1 & !low);
            holes &= !(1 << hole);
        }
        after.blocked[usize::from(v2)] = row;
    }
}

/// All legal flips of a cavity with at most `max_quads` quads afterwards, in ascending order.
///
/// # Example
/// The cube offers nothing but its six quads: every other patch would join two ends of a diagonal that is used already.
/// ```
/// use hexfill_search::{Cavity, FlipKind, apply, legal_flips};
///
/// let flips = legal_flips(&Cavity::cube(), 24);
/// assert_eq!(flips.len(), 6);
/// assert!(flips.iter().all(|placement| placement.flip.kind == FlipKind::OneToFive));
/// assert_eq!(apply(&Cavity::cube(), &flips[0]).0.n_quads(), 10);
/// ```
pub fn legal_flips(cavity: &Cavity, max_quads: usize) -> Vec<Placement> {
    let (marked, degrees) = (cavity.marked(), cavity.degrees());
    candidates(cavity, max_quads.min(MAX_QUADS))
        .filter_map(|flip| place(cavity, &degrees, flip))
        .filter(|placement| is_legal(placement, &marked))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_flip_of_every_small_cavity_keeps_the_invariants() {
        let mut level = vec![Cavity::cube()];
        for _ in 0..3 {
            let mut after = Vec::new();
            for cavity in &level {
                for placement in legal_flips(cavity, 20) {
                    let (child, before) = apply(cavity, &placement);
                    child.debug_check();
                    assert_eq!(child.n_quads() as i32, cavity.n_quads() as i32 + placement.flip.kind.gain());
                    assert!(before[..child.n_vertices()].is_sorted());
                    after.push(child);
                }
            }
            after.truncate(4000);
            level = after;
        }
        assert!(level.iter().any(|c| c.n_quads() == 18));
    }

    #[test]
    fn the_cube_has_only_outward_flips_of_its_faces_and_edges() {
        // Its corners have degree 3, but the body diagonals and facet diagonals are used.
        let flips = legal_flips(&Cavity::cube(), 24);
        let count = |kind| flips.iter().filter(|p| p.flip.kind == kind).count();
        assert_eq!(FlipKind::ALL.map(count), [6, 0, 0, 0, 0, 0]);
    }
}
