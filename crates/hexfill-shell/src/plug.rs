//! Plugs: a handle of the void is cut by a slice of hexes across it.
//!
//! A simple chord of the front is a ring of k quads with two rims. Where the rims bound disks inside the void and the ring does not separate the
//! front, it is the cross-section of a handle. For even k the ring is replaced by a slice of hexes between its rims, over a quadrangulation of the
//! k-gon; each rim is closed by a copy of it, and the genus is one less. (Where k is odd no hex mesh exists.)
//! Whether a rim bounds a disk inside (a meridian) or outside (a longitude) is decided by positions: the fan from its centroid must lie inside.
//!
//! The slice joins the strands that crossed the ring in pairs, by the chords of the quadrangulation. Strands joined badly make chords that cross
//! themselves, which no flip can undo; so among all rings and quadrangulations that plug is taken that leaves the fewest self-crossings (measured
//! essential), then the fewest hexes.
//!
//! Source: ours.

use crate::classes::Classes;
use crate::dart::{next, opposite, prev};
use crate::front::{Front, NONE};
use crate::inside::{centroid_is_inside, fan_is_inside};
use crate::quadrangulation::Quadrangulation;
use rustc_hash::FxHashMap;

/// A ring of distinct quads: the darts across which its chord enters them. Quad i is (o_i, t_i, t_i+1, o_i+1).
struct Ring(Vec<u32>);

/// The simple chords of even length at least 4 whose rims have distinct vertices, each once.
fn rings(front: &Front) -> Vec<Ring> {
    let mut seen = vec![false; 4 * front.n_slots() as usize];
    let mut rings = Vec::new();
    for start in front.slots().flat_map(|q| 4 * q..4 * q + 4) {
        if seen[start as usize] {
            continue;
        }
        let mut darts = Vec::new();
        let mut at = start;
        loop {
            seen[at as usize] = true;
            seen[opposite(at) as usize] = true;
            darts.push(at);
            at = front.twin(opposite(at));
            if at == start {
                break;
            }
        }
        let distinct = |mut all: Vec<u32>| {
            let n = all.len();
            all.sort_unstable();
            all.dedup();
            all.len() == n
        };
        let simple = distinct(darts.iter().map(|d| d / 4).collect())
            && distinct(darts.iter().flat_map(|&d| [front.origin(d), front.target(d)]).collect());
        if simple && darts.len() % 2 == 0 && darts.len() >= 4 {
            rings.push(Ring(darts));
        }
    }
    rings
}

impl Ring {
    /// Whether the front falls apart without the ring.
    fn separates(&self, front: &Front) -> bool {
        let mut seen = vec![false; front.n_slots() as usize];
        self.0.iter().for_each(|&d| seen[d as usize / 4] = true);
        let (from, to) = (front.twin(next(self.0[0])) / 4, front.twin(prev(self.0[0])) / 4);
        if seen[from as usize] || seen[to as usize] {
            // Rims that touch: the ring is two quads wide at most; not a ring to cut along.
            return true;
        }
        let mut stack = vec![from];
        seen[from as usize] = true;
        while let Some(q) = stack.pop() {
            if q == to {
                return false;
            }
            for d in 4 * q..4 * q + 4 {
                let r = front.twin(d) / 4;
                if !std::mem::replace(&mut seen[r as usize], true) {
                    stack.push(r);
                }
            }
        }
        true
    }

    fn rim(&self, front: &Front, points: &[[f64; 3]]) -> Vec<[f64; 3]> {
        self.0.iter().map(|&d| points[front.target(d) as usize]).collect()
    }
}

/// The strands left of the other chords when a ring is taken out.
struct Strands {
    /// Per quad outside the ring (in the order of slots): the strands through it, with how many such quads.
    crossings: Vec<([u32; 2], u32)>,
    /// Strand at each quad of the ring, on the side of the t-rim and of the o-rim.
    at_ring: Vec<[u32; 2]>,
    n: u32,
}

impl Strands {
    fn of(front: &Front, ring: &Ring) -> Self {
        let mut place = FxHashMap::default();
        for (i, &d) in ring.0.iter().enumerate() {
            place.insert(next(d), (i, 0));
            place.insert(prev(d), (i, 1));
            place.insert(d, (i, 2));
            place.insert(opposite(d), (i, 2));
        }
        let mut of = vec![[NONE; 2]; front.n_slots() as usize];
        let mut at_ring = vec![[NONE; 2]; ring.0.len()];
        // First the strands that end at the ring: the slice will join them in pairs. What is not met by these is
        // closed already and crosses itself or not, whatever the slice is.
        let mut n = 0;
        for (i, &d) in ring.0.iter().enumerate() {
            for (side, rim) in [next(d), prev(d)].into_iter().enumerate() {
                if at_ring[i][side] != NONE {
                    continue;
                }
                at_ring[i][side] = n;
                let mut at = front.twin(rim);
                loop {
                    if let Some(&(j, side)) = place.get(&at) {
                        at_ring[j][side] = n;
                        break;
                    }
                    of[at as usize / 4][at as usize % 2] = n;
                    at = front.twin(opposite(at));
                }
                n += 1;
            }
        }
        let is_ring = |q: u32| place.contains_key(&(4 * q));
        for start in front.slots().filter(|&q| !is_ring(q)).flat_map(|q| [4 * q, 4 * q + 1]) {
            if of[start as usize / 4][start as usize % 2] != NONE {
                continue;
            }
            let mut at = start;
            while of[at as usize / 4][at as usize % 2] == NONE {
                of[at as usize / 4][at as usize % 2] = n;
                at = front.twin(opposite(at));
            }
            n += 1;
        }
        let mut pairs: Vec<[u32; 2]> = front.slots().filter(|&q| !is_ring(q)).map(|q| of[q as usize]).collect();
        pairs.iter_mut().for_each(|p| p.sort_unstable());
        pairs.sort_unstable();
        // Crossings by pair of strands: when the slice joins two strands, crossings of the one with the other become
        // self-crossings, which are all that counts.
        let crossings = pairs.chunk_by(|a, b| a == b).map(|run| (run[0], run.len() as u32)).collect();
        Self { crossings, at_ring, n }
    }

    /// How many quads are crossed by one chord twice when the ring is replaced by two copies of `cut`.
    fn self_crossings(&self, cut: &Quadrangulation) -> u32 {
        let (of_quad, of_side) = cut.chords();
        let n_inner = of_quad.iter().flatten().max().map_or(0, |&m| m as u32 + 1);
        // Strands, then the chords of the one copy and of the other.
        let mut classes = Classes::new((self.n + 2 * n_inner) as usize);
        for (i, strands) in self.at_ring.iter().enumerate() {
            for (side, &strand) in strands.iter().enumerate() {
                let chord = self.n + side as u32 * n_inner + of_side[i] as u32;
                classes.join(strand, chord);
            }
        }
        let outside = self.crossings.iter().map(|&(pair, n)| (pair, n));
        let shift = [self.n, self.n + n_inner];
        let inside = shift.into_iter().flat_map(|s| of_quad.iter().map(move |p| (p.map(|c| s + c as u32), 1)));
        outside.chain(inside).filter(|(p, _)| classes.root(p[0]) == classes.root(p[1])).map(|(_, n)| n).sum()
    }
}

impl Front {
    /// The state with the ring replaced by a slice over `cut`; positions of new vertices are added to `points`. `None` if it is improper.
    fn plugged(&self, ring: &Ring, cut: &Quadrangulation, points: &mut Vec<[f64; 3]>) -> Option<Self> {
        let k = ring.0.len();
        let n_before = self.n_vertices();
        let mut rims = [0, 1].map(|side: u32| -> Vec<u32> {
            let first = n_before + side * cut.n_inner as u32;
            let at_rim = ring.0.iter().map(|&d| if side == 0 { self.target(d) } else { self.origin(d) });
            at_rim.chain(first..first + cut.n_inner as u32).collect()
        });
        let mut hexes = self.hexes().to_vec();
        let mut is_ring = vec![false; self.n_slots() as usize];
        ring.0.iter().for_each(|&d| is_ring[d as usize / 4] = true);
        let mut quads: Vec<[u32; 4]> = self.slots().filter(|&q| !is_ring[q as usize]).map(|q| self.quad(q)).collect();
        for &quad in &cut.quads {
            let [a, b, c, d] = quad.map(|i| rims[0][i]);
            let [e, f, g, h] = quad.map(|i| rims[1][i]);
            hexes.push([a, b, c, d, e, f, g, h]);
            quads.extend([[a, b, c, d], [e, h, g, f]]);
        }
        let state = self.with(n_before + 2 * cut.n_inner as u32, &hexes, &quads).ok()?;
        for rim in &mut rims {
            rim.truncate(k);
            let sum = rim.iter().fold([0.0; 3], |s, &v| [0, 1, 2].map(|c| s[c] + points[v as usize][c]));
            points.extend(std::iter::repeat_n(sum.map(|x| x / k as f64), cut.n_inner));
        }
        Some(state)
    }

    /// Cuts one handle of the void by the plug that leaves the fewest self-crossings of chords, then the fewest hexes. `None` if no ring of the
    /// front is a cross-section of a handle. `points` holds a position for each vertex (of the surface, or near it); it grows with the vertices.
    pub fn plug(&self, points: &mut Vec<[f64; 3]>) -> Option<Self> {
        let mut plugs = Vec::new();
        let rings = rings(self);
        let mut cuts: FxHashMap<usize, Vec<Quadrangulation>> = FxHashMap::default();
        for (r, ring) in rings.iter().enumerate() {
            if ring.separates(self) || !centroid_is_inside(self.surface(), points, &ring.rim(self, points)) {
                continue;
            }
            let strands = Strands::of(self, ring);
            let cuts = cuts.entry(ring.0.len()).or_insert_with_key(|&k| Quadrangulation::all(k));
            for (c, cut) in cuts.iter().enumerate() {
                // Strands are fixed for a ring, so a quadrangulation is judged by union-find on them and nothing is
                // built before it is chosen.
                plugs.push((strands.self_crossings(cut), cut.quads.len(), r, c));
            }
        }
        plugs.sort_unstable();
        // The whole fan is looked at last, and once a ring: winding numbers take time.
        let mut meridian = vec![None; rings.len()];
        plugs.into_iter().find_map(|(_, _, r, c)| {
            let ring = &rings[r];
            let inside =
                meridian[r].get_or_insert_with(|| fan_is_inside(self.surface(), points, &ring.rim(self, points)));
            if *inside { self.plugged(ring, &cuts[&ring.0.len()][c], points) } else { None }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::QuadSurface;

    #[test]
    fn a_torus_is_cut_across_its_tube() {
        let (surface, points) = crate::test_surfaces::torus_at(12, 8);
        let front = Front::new(&surface).unwrap();
        let mut all = points.clone();
        let plugged = front.plug(&mut all).unwrap();
        plugged.debug_check();
        assert_eq!((plugged.hexes().len(), plugged.n_quads()), (3, 94));
        let sphere = QuadSurface::try_new(plugged.n_vertices() as usize, &plugged.quads()).unwrap();
        assert!(sphere.is_sphere());
        assert_eq!(all.len() as u32, plugged.n_vertices());
    }
}
