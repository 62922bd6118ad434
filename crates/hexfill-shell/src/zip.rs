//! Flips with zips: one hex glued on the three front quads round a vertex of degree 3.
//!
//! The hex brings one new vertex w, and its three other facets take the place of the quads: in the dual a triangle is pushed over. Where that
//! leaves a front vertex of degree 2, its two quads `(u, p, s, q)` and `(u, q, t, p)` lie on each other: *zip* identifies s with t, the two quads
//! are gone, and so on until no degree 2 is left. 4->2, 5->1 and closing the cube are the cases with one, two and three zips; a flip whose
//! neighbours have *different* tops becomes possible by merging the tops.
//!
//! Taken back as a whole are flips where a zip would leave degree 1 (a chord with a loop of one crossing), merge two vertices of the surface, or
//! split the void, and those that break rule R2 (the pair table, after the last zip) or leave two edges between the same two vertices.
//! The last is counted: merging s and t makes one edge pair of each common neighbour, and only gluing the two front edges makes it one edge.
//!
//! Where wants are stated (r hexes still wanted round each front edge), a flip has a cost: the sum of (r - 1)^2 over the edges the hex buries, of r^2
//! over those that a zip buries, and of max(0, 1 - r)^2 over the edges at its rim, which lost one and need one more at least.
//!
//! Source: Bern, Eppstein and Erickson 2002 (flips); merging two tops by zips is ours.

use crate::dart::{next, opposite, prev};
use crate::front::{Front, NONE};
use smallvec::SmallVec;

/// Why a flip was not made; the front is as before.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Refused {
    /// The vertex has not three quads.
    NotDegreeThree,
    /// A zip would leave a vertex of degree 1.
    Loop,
    /// A zip would merge two vertices of the surface.
    Fixed,
    /// A zip would split the void in two.
    Split,
    /// Two edges would join the same two vertices.
    DoubleEdge,
    /// Two cells would share more than a vertex, an edge or a quad of both.
    Improper,
}

/// What the zips of one flip have to remember until the last of them.
#[derive(Default)]
pub(crate) struct Pending {
    /// Vertices whose degree fell.
    pub(crate) queue: SmallVec<[u32; 16]>,
    /// New hexes, whose pairs are not in the table yet.
    pub(crate) hexes: SmallVec<[u32; 2]>,
    /// Hexes that were renamed, each with its corners before; the first entry of a hex is what the table knows. Most flips that are
    /// refused are so before the table has to be asked.
    renamed: SmallVec<[(u32, [u32; 8]); 8]>,
    /// One entry for each front edge too many between two vertices.
    pub(crate) double: SmallVec<[[u32; 2]; 8]>,
    /// Darts of edges that stay on the front with fewer hexes wanted.
    pub(crate) rim: SmallVec<[u32; 12]>,
    pub(crate) cost: f32,
}

/// `powi` may round differently elsewhere.
pub(crate) fn square(x: f32) -> f32 {
    x * x
}

impl Pending {
    fn rename(&mut self, from: u32, to: u32) {
        for v in self.queue.iter_mut().chain(self.double.iter_mut().flatten()) {
            if *v == from {
                *v = to;
            }
        }
    }
}

impl Front {
    /// Glues a hex on the three quads round `v` and zips; its cost, 0 if no wants are stated. The front is unchanged if the flip is refused.
    ///
    /// # Errors
    /// [`Refused`].
    pub fn flip(&mut self, v: u32) -> Result<f32, Refused> {
        if v >= self.n_vertices() || self.degree(v) != 3 {
            return Err(Refused::NotDegreeThree);
        }
        let mark = self.mark();
        let result = self.flip_and_zip(v);
        if result.is_err() {
            self.take_back(mark);
        }
        result
    }

    fn flip_and_zip(&mut self, v: u32) -> Result<f32, Refused> {
        let mut pending = Pending::default();
        self.push_over(v, &mut pending);
        self.zip_all(pending)
    }

    /// Zips until no vertex of degree 2 is left, and checks the whole; the cost.
    pub(crate) fn zip_all(&mut self, mut pending: Pending) -> Result<f32, Refused> {
        while let Some(u) = pending.queue.pop() {
            match self.degree(u) {
                1 => return Err(Refused::Loop),
                // Two quads at a vertex of degree 2 share three corners: to leave them would be improper, so this is
                // no choice but the only way on.
                2 => self.zip(u, &mut pending)?,
                _ => {}
            }
        }
        // Edges may be double on the way, as long as later zips glue them; only what is left at the end counts.
        if !pending.double.is_empty() {
            return Err(Refused::DoubleEdge);
        }
        // Stable: the first entry of a hex stays first.
        pending.renamed.sort_by_key(|r| r.0);
        pending.renamed.dedup_by_key(|r| r.0);
        // New hexes are entered as they are now, old ones exchanged for what they were. Asked last and once: most
        // refusals above need no table.
        pending.renamed.retain(|r| !pending.hexes.contains(&r.0));
        if !self.update_pairs(&pending.renamed) || !pending.hexes.into_iter().all(|h| self.add_pairs(h)) {
            return Err(Refused::Improper);
        }
        let mut rim = pending.rim;
        rim.retain(|d| self.is_quad(*d / 4));
        rim.iter_mut().for_each(|d| *d = (*d).min(self.twin(*d)));
        rim.sort_unstable();
        rim.dedup();
        let lacking = |&d: &u32| square((1.0 - self.want(d)).max(0.0));
        Ok(pending.cost + rim.iter().map(lacking).sum::<f32>())
    }

    /// The hex and its three facets, before any zip.
    ///
    /// Round v, counter-clockwise: the quads (v, a, x, b), (v, b, y, c), (v, c, z, a); outer cycle a x b y c z. The quads
    /// (w, x, b, y), (w, y, c, z), (w, z, a, x) take their slots so that one outer dart of each keeps its place.
    fn push_over(&mut self, v: u32, pending: &mut Pending) {
        let first = self.dart_of(v);
        let second = self.twin(prev(first));
        let third = self.twin(prev(second));
        let darts = [first, second, third];
        let [a, b, c] = darts.map(|d| self.target(d));
        let [x, y, z] = darts.map(|d| self.target(next(d)));
        let outer = darts.map(|d| self.twin(next(d)));
        let wants = self.has_wants().then(|| darts.map(|d| [d, next(d), opposite(d)].map(|d| self.want(d))));
        let w = self.push_vertex();
        pending.hexes.push(self.push_hex([v, b, x, a, c, y, w, z]));
        // Slot of (v, a, x, b): v->a, a->x, x->b, b->v become y->w, w->x, x->b, b->y.
        let new = [[y, w, x, b], [z, w, y, c], [x, w, z, a]];
        for (d, [p, w, q, r]) in darts.into_iter().zip(new) {
            for (dart, vertex) in [(d, p), (next(d), w), (opposite(d), q), (prev(d), r)] {
                if self.origin(dart) != vertex {
                    self.set_origin(dart, vertex);
                }
            }
        }
        for i in 0..3 {
            // b->y of the first quad was b->y of the second; w->x of the first meets x->w of the third.
            let after = (i + 1) % 3;
            self.glue(prev(darts[i]), outer[after]);
            self.glue(darts[i], next(darts[after]));
        }
        if let Some(wants) = wants {
            for i in 0..3 {
                pending.cost += square(wants[i][0] - 1.0);
                // The three buried edges should have wanted this one hex and no more, hence the cost; rim edges have
                // one more than before; a new inner edge wants four and has its first.
                self.set_want(prev(darts[i]), wants[(i + 1) % 3][1] - 1.0);
                self.set_want(opposite(darts[i]), wants[i][2] - 1.0);
                self.set_want(darts[i], 3.0);
                let rim = [prev(darts[i]), opposite(darts[i])];
                pending.rim.extend(rim.into_iter().flat_map(|d| [d, self.twin(d)]));
            }
        }
        self.set_degree(v, 0);
        self.set_dart_of(v, NONE);
        self.set_degree(w, 3);
        self.set_dart_of(w, next(first));
        for (i, (near, far)) in [(b, x), (c, y), (a, z)].into_iter().enumerate() {
            self.set_degree(near, self.degree(near) - 1);
            self.set_dart_of(near, prev(darts[i]));
            self.set_degree(far, self.degree(far) + 1);
            self.set_dart_of(far, opposite(darts[i]));
        }
        // Only these lost a quad, so only here may a vertex of degree 2 have come up.
        pending.queue.extend([a, b, c]);
    }

    /// Zips the two quads at `u`, of degree 2: see the page.
    fn zip(&mut self, u: u32, pending: &mut Pending) -> Result<(), Refused> {
        let one = self.dart_of(u);
        let two = self.twin(prev(one));
        if one / 4 == two / 4 {
            return Err(Refused::Loop);
        }
        let (p, q) = (self.target(one), self.target(two));
        let (s, t) = (self.target(next(one)), self.target(next(two)));
        // Darts across the outer edges, seen from outside the two quads: s->p and p->t, q->s and t->q.
        let [s_p, q_s] = [next(one), opposite(one)].map(|d| self.twin(d));
        let [t_q, p_t] = [next(two), opposite(two)].map(|d| self.twin(d));
        // Is p, or q, met by these two quads only?
        let (p_closed, q_closed) = (s_p == opposite(two), q_s == next(two));
        let kept = if s == t {
            // The tops are one vertex and quads are left beyond both p and q: gluing would part the void in two, and
            // each part would have to be filled by itself.
            if !p_closed && !q_closed {
                return Err(Refused::Split);
            }
            self.set_degree(s, self.degree(s) - 2);
            s
        } else {
            let kept = self.merge(s, t, pending)?;
            let degree = self.degree(s) + self.degree(t) - 2;
            self.set_degree(s, 0);
            self.set_degree(t, 0);
            self.set_degree(kept, degree);
            kept
        };
        self.remove_quad(one / 4);
        self.remove_quad(two / 4);
        self.set_degree(u, 0);
        self.set_dart_of(u, NONE);
        let wants = self.has_wants();
        if wants {
            pending.cost += square(self.want(one)) + square(self.want(two));
        }
        let mut dart_of_kept = NONE;
        for (end, closed, from_end, to_end) in [(p, p_closed, p_t, s_p), (q, q_closed, q_s, t_q)] {
            self.set_degree(end, self.degree(end) - 2);
            if closed {
                self.set_dart_of(end, NONE);
                if wants {
                    pending.cost += square(self.want(from_end));
                }
                continue;
            }
            // Two front edges become one.
            self.glue(from_end, to_end);
            if wants {
                // Each wanted 4 less its hexes, or one of them an angle of the surface less its hexes.
                self.set_want(from_end, self.want(from_end) + self.want(to_end) - 4.0);
                pending.rim.push(from_end);
            }
            // The edge from the merged top to this end was counted as double when the tops were merged; gluing is
            // what makes it one again.
            let edge = [kept.min(end), kept.max(end)];
            match pending.double.iter().position(|&e| e == edge) {
                Some(i) => {
                    pending.double.swap_remove(i);
                }
                None => return Err(Refused::DoubleEdge),
            }
            self.set_dart_of(end, from_end);
            dart_of_kept = to_end;
            pending.queue.push(end);
        }
        self.set_dart_of(kept, dart_of_kept);
        pending.queue.push(kept);
        Ok(())
    }

    /// Makes one vertex of `s` and `t` in hexes and on the front (degrees and darts are left to the caller); the one kept.
    fn merge(&mut self, s: u32, t: u32, pending: &mut Pending) -> Result<u32, Refused> {
        let (kept, gone) = match (self.is_fixed(s), self.is_fixed(t)) {
            // The boundary is exact: two vertices of the surface are two whatever the flip gains.
            (true, true) => return Err(Refused::Fixed),
            (true, false) => (s, t),
            (false, true) => (t, s),
            // The new vertex, or that with fewer hexes, is renamed.
            (false, false) => {
                if self.star(s).len() < self.star(t).len() {
                    (t, s)
                } else {
                    (s, t)
                }
            }
        };
        // Two corners of one cell stay two; so no quad ever holds a vertex twice.
        if self.star(gone).iter().any(|&h| self.hexes()[h as usize].contains(&kept)) {
            return Err(Refused::Improper);
        }
        let common = self.common_neighbours(kept, gone);
        pending.renamed.extend(self.star(gone).iter().map(|&h| (h, self.hexes()[h as usize])));
        let round: SmallVec<[u32; 8]> = self.round_vertex(self.dart_of(gone)).collect();
        for d in round {
            self.set_origin(d, kept);
        }
        self.rename(gone, kept);
        self.set_dart_of(gone, NONE);
        pending.rename(gone, kept);
        for pair in &mut pending.double {
            pair.sort_unstable();
        }
        pending.double.extend(common.into_iter().map(|v| [kept.min(v), kept.max(v)]));
        Ok(kept)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::QuadSurface;
    use hexfill_mesh::generate::{cube_surface, random_sphere, voxel_surface};

    #[test]
    fn the_cube_closes_with_three_zips() {
        let mut front = Front::new(&cube_surface()).unwrap();
        front.debug_check();
        let before = front.clone();
        assert_eq!(front.flip(0), Ok(0.0));
        front.debug_check();
        assert_eq!((front.n_quads(), front.hexes().len()), (0, 1));
        assert_eq!(front.neighbours(0).len(), 3);
        front.take_back(crate::front::Front::new(&cube_surface()).unwrap().mark());
        assert!(front.is_same(&before));
    }

    #[test]
    fn a_bar_closes_with_its_voxels() {
        let mut front = Front::new(&voxel_surface([3, 1, 1], |_| true).unwrap()).unwrap();
        while let Some(v) = (0..front.n_vertices()).find(|&v| front.degree(v) == 3) {
            assert_eq!(front.flip(v), Ok(0.0));
            front.debug_check();
        }
        assert_eq!((front.n_quads(), front.hexes().len()), (0, 3));
    }

    #[test]
    fn flips_are_taken_back_exactly() {
        let mut surfaces: Vec<QuadSurface> = (0..40).map(|i| random_sphere(20 + i as usize, i).unwrap()).collect();
        surfaces.push(voxel_surface([3, 3, 3], |_| true).unwrap());
        let mut refusals = std::collections::BTreeSet::new();
        for surface in surfaces {
            let Ok(mut front) = Front::new(&surface) else { continue };
            if surface.n_quads() % 2 == 0 {
                front.set_wants(|a, b| ((a * b + a + b) % 4) as f32);
            }
            for round in 0..20 {
                let before = front.clone();
                let mark = front.mark();
                let mut made = Vec::new();
                for v in 0..front.n_vertices() {
                    let one = front.clone();
                    let one_mark = front.mark();
                    match front.flip((v * 7 + round) % front.n_vertices()) {
                        Ok(_) => {
                            front.debug_check();
                            let after = front.clone();
                            front.take_back(one_mark);
                            assert!(front.is_same(&one));
                            front = after;
                            made.push(v);
                        }
                        Err(why) => {
                            refusals.insert(format!("{why:?}"));
                            assert!(front.is_same(&one));
                        }
                    }
                }
                let after = front.clone();
                front.take_back(mark);
                assert!(front.is_same(&before));
                front = after;
                if made.is_empty() {
                    break;
                }
            }
        }
        println!("{refusals:?}");
        assert!(refusals.len() >= 3, "{refusals:?}");
    }
}
