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

/// The dart `by` sides after `d` round its quad.
const fn turn(d: u32, by: usize) -> u32 {
    (d & !3) | ((d + by as u32) & 3)
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
        // Dart on side 0 of each covered facet.
        let mut under = [NONE; 6];
        under[BOTTOM] = d;
        for &side in patch.sides() {
            let (g, j) = ADJACENT[BOTTOM][side];
            under[g] = turn(self.twin(turn(d, side)), 4 - j);
        }
        let covered: Vec<usize> = (0..6).filter(|&f| under[f] != NONE).collect();
        let open: Vec<usize> = (0..6).filter(|&f| under[f] == NONE).collect();
        let mut slots: Vec<u32> = covered.iter().map(|&f| under[f] / 4).collect();
        let mut corners = [NONE; 8];
        for &f in &covered {
            for (i, &k) in FACETS[f].iter().enumerate() {
                corners[k] = self.origin(turn(under[f], i));
            }
        }
        // What lies across the rim, and what is wanted there and within.
        let mut rim = [[NONE; 4]; 6];
        let mut rim_want = [[0.0; 4]; 6];
        let wants = self.has_wants();
        for &f in &covered {
            for i in 0..4 {
                let (g, j) = ADJACENT[f][i];
                let at = turn(under[f], i);
                if under[g] == NONE {
                    rim[g][j] = self.twin(at);
                    if slots.contains(&(self.twin(at) / 4)) {
                        return Err(Refused::Improper);
                    }
                    if wants {
                        rim_want[g][j] = self.want(at);
                    }
                } else if wants && f < g {
                    pending.cost += square(self.want(at) - 1.0);
                }
            }
        }
        let old = corners;
        for corner in corners.iter_mut().filter(|c| **c == NONE) {
            *corner = self.push_vertex();
        }
        let holds = |f: usize, k: usize| FACETS[f].contains(&k);
        for [i, j] in EDGES {
            let is_new = !covered.iter().any(|&f| holds(f, i) && holds(f, j));
            if is_new && old[i] != NONE && old[j] != NONE && self.neighbours(old[i]).binary_search(&old[j]).is_ok() {
                pending.double.push([old[i].min(old[j]), old[i].max(old[j])]);
            }
        }
        let h = self.push_hex(corners);
        pending.hexes.push(h);
        slots.iter().for_each(|&q| self.remove_quad(q));
        let mut slot_of = [NONE; 6];
        for &g in &open {
            // Seen from the void the facet runs the other way: its dart j lies on side 3 - j.
            let quad = [0, 3, 2, 1].map(|i| corners[FACETS[g][i]]);
            slot_of[g] = self.put_quad(slots.pop(), quad);
        }
        for &g in &open {
            for i in 0..4 {
                let at = 4 * slot_of[g] + 3 - i as u32;
                let (f, j) = ADJACENT[g][i];
                if under[f] == NONE {
                    if f < g {
                        self.glue(at, 4 * slot_of[f] + 3 - j as u32);
                        if wants {
                            self.set_want(at, 3.0);
                        }
                    }
                } else {
                    self.glue(at, rim[g][i]);
                    if wants {
                        self.set_want(at, rim_want[g][i] - 1.0);
                        pending.rim.extend([at, rim[g][i]]);
                    }
                }
            }
        }
        for (k, &v) in corners.iter().enumerate() {
            let gain = open.iter().filter(|&&g| holds(g, k)).count() as u32;
            let loss = covered.iter().filter(|&&f| holds(f, k)).count() as u32;
            self.set_degree(v, self.degree(v) + gain - loss);
            let g = open.iter().find(|&&g| holds(g, k)).expect("three facets in a row leave one at every corner");
            let at = (0..4).map(|i| 4 * slot_of[*g] + i).find(|&at| self.origin(at) == v);
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
