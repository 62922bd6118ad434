//! From the hexes of a ball to flips: an order that shells it through small boundaries.
//!
//! An atlas stores a filling as flips, and no boundary on the way may have more quads than its [cap](MAX_CAP). A filling that comes as a mesh (from
//! [`simplify`](crate::simplify())) needs such an order. It is searched for by a beam over sets of hexes that are balls, those with the fewest quads first;
//! `None` means "not found".
//!
//! Source: ours.

use crate::ball::{canonical_cavity, mirror_hex};
use crate::canonical::Canonical;
use crate::cavity::Cavity;
use crate::flip::{Flip, Placement, apply, legal_flips};
use crate::packed_pairs::MAX_CAP;
use crate::simplify::{LiveMesh, Region};
use hexfill_mesh::{HexMesh, cube};
use rustc_hash::FxHashSet;

/// Sets of hexes kept on each level, one effort after the other.
const BEAMS: [usize; 3] = [30, 300, 3_000];

/// Most hexes of a ball: an atlas counts them in a byte.
pub(crate) const MOST_HEXES: usize = 255;

/// Some of the hexes.
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
struct Set([u128; 2]);

impl Set {
    fn has(self, hex: u32) -> bool {
        self.0[hex as usize / 128] >> (hex % 128) & 1 == 1
    }

    fn with(mut self, hex: u32) -> Self {
        self.0[hex as usize / 128] |= 1 << (hex % 128);
        self
    }

    /// A number that favours no hex.
    fn stirred(self) -> u128 {
        let [low, high] = self.0;
        (low ^ high.rotate_left(64)).wrapping_mul(0x9E37_79B9_7F4A_7C15_F39C_C060_5CED_C835)
    }
}

/// A ball of some of the hexes.
#[derive(Clone, Copy)]
struct Part {
    /// Hex `h` is bit `h`.
    set: Set,
    quads: usize,
    /// The hex that joined last, and the entry of the trail with the one before.
    last: u32,
    before: u32,
}

/// The flips that shell a ball of at most [`MOST_HEXES`] hexes from one of them, no boundary on the way with more than [`MAX_CAP`] quads.
pub(crate) fn narrow_shelling(mesh: &HexMesh) -> Option<Vec<Flip>> {
    if mesh.n_hexes() > MOST_HEXES {
        return None;
    }
    let live = LiveMesh::new(mesh);
    let order = BEAMS.iter().find_map(|&beam| narrow_order(&live, beam))?;
    flips_of(&order.iter().map(|&h| *live.hex(h)).collect::<Vec<_>>())
}

/// An order of the hexes in which each part is a ball with a small boundary.
fn narrow_order(live: &LiveMesh, beam: usize) -> Option<Vec<u32>> {
    let n = live.n_hexes() as u32;
    let start = |h: u32| Part { set: Set::default().with(h), quads: 6, last: h, before: u32::MAX };
    let mut parts: Vec<Part> = (0..n).map(start).collect();
    let mut trail: Vec<(u32, u32)> = Vec::new();
    let mut region = Region::new();
    for _ in 1..n {
        let mut next: Vec<Part> = Vec::new();
        let mut seen = FxHashSet::default();
        for part in &parts {
            let mut members = (0..n).filter(|h| part.set.has(*h));
            region.start(live, members.next()?);
            members.for_each(|h| region.join(live, h));
            trail.push((part.last, part.before));
            for candidate in region.candidates(live, MAX_CAP) {
                let set = part.set.with(candidate.hex);
                if seen.insert(set) {
                    let quads = part.quads + 6 - 2 * candidate.shared as usize;
                    next.push(Part { set, quads, last: candidate.hex, before: trail.len() as u32 - 1 });
                }
            }
        }
        // Sets with as many quads in an order that favours no hex.
        next.sort_unstable_by_key(|p| (p.quads, p.set.stirred(), p.set));
        next.truncate(beam);
        parts = next;
    }
    let whole = parts.first()?;
    let mut order = vec![whole.last];
    let mut at = whole.before;
    while at != u32::MAX {
        let (hex, before) = trail[at as usize];
        order.push(hex);
        at = before;
    }
    order.reverse();
    Some(order)
}

/// The flips that glue these hexes, positively oriented, one by one: what [`Ball::replay`](crate::Ball::replay) undoes.
fn flips_of(hexes: &[[u32; 8]]) -> Option<Vec<Flip>> {
    let (first, rest) = hexes.split_first()?;
    let mut canonical = Canonical::new();
    let mut boundary = Cavity::cube();
    // Mesh vertex per vertex of `boundary`; whether `boundary` is the mirror image of the outside.
    let mut ids = first.to_vec();
    let mut mirrored = false;
    let mut flips = Vec::with_capacity(rest.len());
    for &hex in rest {
        let form = canonical_cavity(&boundary, &mut canonical);
        let mut at = vec![0; ids.len()];
        for (v, &id) in ids.iter().enumerate() {
            at[usize::from(form.numbers[v])] = id;
        }
        mirrored ^= form.mirrored;
        let hex = if mirrored { mirror_hex(hex) } else { hex };
        let lies_at = |p: Placement| corners_of(&hex, &p, &at).map(|corners| (p, corners));
        let (placement, corners) = legal_flips(&form.cavity, MAX_CAP).into_iter().find_map(lies_at)?;
        let (after, before) = apply(&form.cavity, &placement);
        let mut id = at;
        id.resize(form.cavity.n_vertices() + 8, 0);
        for (&c, v) in placement.corners.iter().zip(corners) {
            id[usize::from(c)] = v;
        }
        ids = before[..after.n_vertices()].iter().map(|&v| id[usize::from(v)]).collect();
        boundary = after;
        flips.push(placement.flip);
    }
    Some(flips)
}

/// The vertices of `hex` at the corners of a placement, if that is where it lies: `at[v]` for a vertex of the cavity, none of `at` for a new one.
fn corners_of(hex: &[u32; 8], placement: &Placement, at: &[u32]) -> Option<[u32; 8]> {
    let fits = |map: &&[usize; 8]| {
        placement.corners.iter().zip(**map).all(|(&c, i)| match at.get(usize::from(c)) {
            Some(&v) => v == hex[i],
            None => !at.contains(&hex[i]),
        })
    };
    cube::symmetries()[..24].iter().find(fits).map(|map| map.map(|i| hex[i]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Atlas, Ball};

    #[test]
    fn a_filling_is_shelled_again_in_another_order() {
        let atlas = Atlas::fewest();
        for state in (0..atlas.n_states() as u32).step_by(atlas.n_states() / 40) {
            let ball = Ball::replay(atlas.flips_to(state)).unwrap();
            let mesh = HexMesh::try_new(ball.n_vertices as usize, &ball.hexes).unwrap();
            let flips = narrow_shelling(&mesh).expect("the atlas knows an order");
            let again = Ball::replay(flips).expect("legal flips");
            again.debug_check();
            let other = HexMesh::try_new(again.n_vertices as usize, &again.hexes).unwrap();
            let names = [&mesh, &other].map(|m| hexfill_mesh::hex_signature(m).unwrap());
            assert_eq!(names[0], names[1]);
        }
    }
}
