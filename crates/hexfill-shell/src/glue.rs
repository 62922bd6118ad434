//! The other flips: one hex on one, two or three front quads in a row.
//!
//! | flip | covered | front quads | new vertices |
//! |---|---|---|---|
//! | 1->5 | a quad | +4 | 4 |
//! | 2->4 | two quads at an edge | +2 | 2 |
//! | 3->3 strip | a quad and two opposite neighbours | 0 | 0 |
//!
//! (Bern, Eppstein, Erickson, "Flipping cubical meshes", 2002.) Together with the flips of `zip`, whose checks and zips they share, they are all ways
//! to glue a hex on a disk of quads. A hex edge that joins two old vertices which are joined already is a double edge, unless a zip glues the two.
//!
//! Source: Bern, Eppstein and Erickson 2002 (the flips of a cube).

use crate::dart::turn;
use crate::front::{Front, NONE};
use crate::zip::{Pending, Refused, square};
use hexfill_mesh::cube::{EDGES, FACETS};
use std::sync::LazyLock;

/// Which quads a hex covers.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(crate) enum Patch {
    /// One quad (1->5). Stirring with it was measured to be no better.
    #[cfg_attr(not(test), expect(dead_code, reason = "the third flip of the set; tests use it"))]
    Quad,
    /// Two quads at an edge (2->4).
    Pair,
    /// A quad and the neighbours across two opposite edges (3->3 strip).
    Strip,
}

impl Patch {
    /// Sides of the bottom facet whose neighbours are covered with it.
    const fn sides(self) -> &'static [usize] {
        match self {
            Self::Quad => &[],
            Self::Pair => &[0],
            Self::Strip => &[0, 2],
        }
    }
}

/// The facet of the hex that lies on the quad of the given dart, side 0 on the dart.
const BOTTOM: usize = 4;

/// `ADJACENT[f][i]`: the facet and its side along side `i` of facet `f`.
static ADJACENT: LazyLock<[[(usize, usize); 4]; 6]> = LazyLock::new(|| {
    std::array::from_fn(|f| {
        std::array::from_fn(|i| {
            let (a, b) = (FACETS[f][i], FACETS[f][(i + 1) % 4]);
            let side = |g: usize| (0..4).find(|&j| FACETS[g][j] == b && FACETS[g][(j + 1) % 4] == a).map(|j| (g, j));
            (0..6).filter(|&g| g != f).find_map(side).expect("every edge of the cube has two facets")
        })
    })
});

/// Where a hex is put: what it covers of the front, and what lies round that.
struct Covering {
    /// Dart on side 0 of each covered facet, [`NONE`] for the open ones.
    under: [u32; 6],
    /// The corners of the hex, [`NONE`] for those to be made.
    corners: [u32; 8],
    /// Per open facet and side: the dart across the rim, and what is wanted there; unless the side lies between open facets.
    rim: [[u32; 4]; 6],
    rim_want: [[f32; 4]; 6],
}

impl Covering {
    /// The hex on the patch whose first quad and side are those of dart `d`.
    fn new(front: &Front, d: u32, patch: Patch) -> Self {
        let mut under = [NONE; 6];
        under[BOTTOM] = d;
        for &side in patch.sides() {
            let (g, j) = ADJACENT[BOTTOM][side];
            under[g] = turn(front.twin(turn(d, side)), 4 - j);
        }
        let mut this = Self { under, corners: [NONE; 8], rim: [[NONE; 4]; 6], rim_want: [[0.0; 4]; 6] };
        for f in (0..6).filter(|&f| under[f] != NONE) {
            for (i, &k) in FACETS[f].iter().enumerate() {
                let at = turn(under[f], i);
                this.corners[k] = front.origin(at);
                let (g, j) = ADJACENT[f][i];
                if under[g] == NONE {
                    this.rim[g][j] = front.twin(at);
                    this.rim_want[g][j] = if front.has_wants() { front.want(at) } else { 0.0 };
                }
            }
        }
        this
    }

    fn covered(&self) -> impl DoubleEndedIterator<Item = usize> + '_ {
        (0..6).filter(|&f| self.under[f] != NONE)
    }

    fn open(&self) -> impl Iterator<Item = usize> + '_ {
        (0..6).filter(|&f| self.under[f] == NONE)
    }

    /// Whether two covered quads meet along an edge that the hex would keep.
    fn meets_itself(&self) -> bool {
        let slots = || self.covered().map(|f| self.under[f] / 4);
        self.rim.iter().flatten().any(|&across| across != NONE && slots().any(|slot| slot == across / 4))
    }

    /// How far the covered edges are from the one hex they should still want.
    fn cost(&self, front: &Front) -> f32 {
        let mut cost = 0.0;
        for f in self.covered() {
            for i in (0..4).filter(|&i| f < ADJACENT[f][i].0 && self.under[ADJACENT[f][i].0] != NONE) {
                cost += square(front.want(turn(self.under[f], i)) - 1.0);
            }
        }
        cost
    }

    /// The new edges of the hex between vertices that an edge joins already; smaller vertex first.
    fn double_edges(&self, front: &Front) -> impl Iterator<Item = [u32; 2]> {
        EDGES.into_iter().filter_map(|[i, j]| {
            let (a, b) = (self.corners[i], self.corners[j]);
            let is_new = !self.covered().any(|f| holds(f, i) && holds(f, j));
            let is_double = is_new && a != NONE && b != NONE && front.neighbours(a).binary_search(&b).is_ok();
            is_double.then_some([a.min(b), a.max(b)])
        })
    }
}

/// Whether a facet has a corner.
fn holds(facet: usize, corner: usize) -> bool {
    FACETS[facet].contains(&corner)
}

impl Front {
    /// Glues a hex on the patch whose first quad and side are those of dart `d`, and zips; its cost. The front is unchanged if that is refused.
    ///
    /// # Errors
    /// [`Refused`].
    pub(crate) fn glue_hex(&mut self, d: u32, patch: Patch) -> Result<f32, Refused> {
        let mark = self.mark();
        let mut pending = Pending::default();
        let result = self.cover(d, patch, &mut pending).and_then(|()| self.zip_all(pending));
        if result.is_err() {
            self.take_back(mark);
        }
        result
    }

    /// The hex and its open facets, before any zip.
    fn cover(&mut self, d: u32, patch: Patch, pending: &mut Pending) -> Result<(), Refused> {
        let mut covering = Covering::new(self, d, patch);
        // Two covered quads that meet along an edge the hex keeps would give that edge the hex twice.
        if covering.meets_itself() {
            return Err(Refused::Improper);
        }
        if self.has_wants() {
            pending.cost += covering.cost(self);
        }
        // Not refused at once: a zip may glue the new edge to the old one.
        pending.double.extend(covering.double_edges(self));
        for corner in covering.corners.iter_mut().filter(|c| **c == NONE) {
            *corner = self.push_vertex();
        }
        pending.hexes.push(self.push_hex(covering.corners));
        let slot_of = self.exchange_quads(&covering);
        self.join_quads(&covering, &slot_of, pending);
        self.count_corners(&covering, &slot_of, pending)
    }

    /// Takes the covered quads away and puts the open facets in their place; the slot of each.
    fn exchange_quads(&mut self, covering: &Covering) -> [u32; 6] {
        covering.covered().for_each(|f| self.remove_quad(covering.under[f] / 4));
        let mut free = covering.covered().map(|f| covering.under[f] / 4).rev();
        let mut slot_of = [NONE; 6];
        for g in covering.open() {
            // Seen from the void the facet runs the other way: its dart j lies on side 3 - j.
            let quad = [0, 3, 2, 1].map(|i| covering.corners[FACETS[g][i]]);
            slot_of[g] = self.put_quad(free.next(), quad);
        }
        slot_of
    }

    /// Joins the open facets to each other and to what lies across the rim, and says what is wanted there.
    fn join_quads(&mut self, covering: &Covering, slot_of: &[u32; 6], pending: &mut Pending) {
        let wants = self.has_wants();
        for g in covering.open() {
            for i in 0..4 {
                let at = 4 * slot_of[g] + 3 - i as u32;
                let (f, j) = ADJACENT[g][i];
                if covering.under[f] != NONE {
                    let across = covering.rim[g][i];
                    self.glue(at, across);
                    if wants {
                        self.set_want(at, covering.rim_want[g][i] - 1.0);
                        pending.rim.extend([at, across]);
                    }
                } else if f < g {
                    self.glue(at, 4 * slot_of[f] + 3 - j as u32);
                    if wants {
                        self.set_want(at, 3.0);
                    }
                }
            }
        }
    }

    /// Gives every corner of the hex its degree and a dart, and has it looked at.
    fn count_corners(&mut self, covering: &Covering, slot_of: &[u32; 6], pending: &mut Pending) -> Result<(), Refused> {
        for (k, &v) in covering.corners.iter().enumerate() {
            let gain = covering.open().filter(|&g| holds(g, k)).count() as u32;
            let loss = covering.covered().filter(|&f| holds(f, k)).count() as u32;
            self.set_degree(v, self.degree(v) + gain - loss);
            let g = covering.open().find(|&g| holds(g, k)).expect("three facets in a row leave one at every corner");
            let at = (0..4).map(|i| 4 * slot_of[g] + i).find(|&at| self.origin(at) == v);
            self.set_dart_of(v, at.ok_or(Refused::Improper)?);
            pending.queue.push(v);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::generate::{cube_surface, random_sphere, voxel_surface};

    #[test]
    fn a_row_of_voxels_is_taken_away_by_strips() {
        let mut front = Front::new(&voxel_surface([3, 3, 1], |_| true).unwrap()).unwrap();
        let n = front.n_quads();
        let made = (0..4 * front.n_slots()).filter(|&d| {
            let mark = front.mark();
            let made = front.glue_hex(d, Patch::Strip).is_ok();
            front.debug_check();
            front.take_back(mark);
            made
        });
        assert!(made.count() > 0);
        front.debug_check();
        assert_eq!(front.n_quads(), n);
    }

    #[test]
    fn glued_hexes_are_taken_back_exactly() {
        let mut made = [0; 3];
        for seed in 0..8 {
            let surface = if seed == 0 { cube_surface() } else { random_sphere(10 + seed as usize, seed).unwrap() };
            let mut front = Front::new(&surface).unwrap();
            if seed % 2 == 0 {
                front.set_wants(|a, b| ((a + b) % 4) as f32);
            }
            let start = front.clone();
            for round in 0..3 {
                for (p, patch) in [Patch::Quad, Patch::Pair, Patch::Strip].into_iter().enumerate() {
                    for d in (round..4 * front.n_slots()).step_by(11) {
                        if !front.is_quad(d / 4) {
                            continue;
                        }
                        let before = front.clone();
                        let mark = front.mark();
                        if front.glue_hex(d, patch).is_ok() {
                            front.debug_check();
                            made[p] += 1;
                            let after = front.clone();
                            front.take_back(mark);
                            assert!(front.is_same(&before));
                            front = after;
                        }
                        assert!(front.is_same(&before) || front.hexes().len() > before.hexes().len());
                    }
                }
            }
            let zero = start.mark();
            front.take_back(zero);
            assert!(front.is_same(&start));
        }
        assert!(made.iter().all(|&m| m > 3), "{made:?}");
    }
}
