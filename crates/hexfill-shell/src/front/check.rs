//! The invariants of a front, checked by tests.

use super::Front;
use hexfill_mesh::cube::FACETS;
use rustc_hash::{FxHashMap, FxHashSet};

impl Front {
    /// Checks the invariants; for tests. Linear time.
    ///
    /// # Panics
    /// If one is broken.
    pub fn debug_check(&self) {
        let mut degree = vec![0; self.degree.len()];
        let mut edges = FxHashSet::default();
        assert_eq!(self.slots().count(), self.n_quads());
        for q in self.slots() {
            for d in 4 * q..4 * q + 4 {
                let t = self.twin(d);
                assert!(self.is_quad(t / 4) && self.twin(t) == d && t != d);
                assert_eq!(
                    (self.origin(d), self.target(d)),
                    (self.target(t), self.origin(t)),
                    "twins run opposite ways"
                );
                assert!(!self.has_wants() || self.want(d) == self.want(t));
                assert!(edges.insert((self.origin(d), self.target(d))), "one front edge a pair");
                degree[self.origin(d) as usize] += 1;
            }
        }
        assert_eq!(degree, self.degree);
        for v in 0..self.n_vertices() {
            let d = self.dart_of[v as usize];
            assert!(self.degree(v) == 0 || self.degree(v) > 2);
            if self.degree(v) > 0 {
                assert_eq!(self.origin(d), v);
                assert_eq!(self.round_vertex(d).count() as u32, self.degree(v), "one fan");
            }
        }
        self.pairs.debug_check(&self.hexes, &self.surface);
        for (v, star) in self.star.iter().enumerate().filter(|(_, s)| !s.is_empty()) {
            // The star of a vertex that was merged into another is left as it was.
            let current: Vec<u32> =
                star.iter().copied().filter(|&h| self.hexes[h as usize].contains(&(v as u32))).collect();
            assert!(current.is_empty() || current.len() == star.len());
        }
        for (h, hex) in self.hexes.iter().enumerate() {
            assert!(hex.iter().all(|&v| self.star(v).contains(&(h as u32))));
        }
        // The front is what the surface and the hexes leave: every quad of it is in one cell, all others in two.
        let mut sides = FxHashMap::default();
        let sorted = |mut q: [u32; 4]| {
            q.sort_unstable();
            q
        };
        for quad in self.hexes.iter().flat_map(|h| FACETS.map(|f| f.map(|i| h[i]))) {
            *sides.entry(sorted(quad)).or_insert(0) += 1;
        }
        for quad in &self.surface {
            *sides.entry(sorted(*quad)).or_insert(0) += 1;
        }
        for q in self.slots() {
            *sides.entry(sorted(self.quad(q))).or_insert(0) += 1;
        }
        assert!(sides.values().all(|&n| n == 2), "every quad has two sides");
    }

    /// Whether two states are the same, journal apart; for tests.
    pub fn is_same(&self, other: &Self) -> bool {
        (&self.origin, &self.twin, self.n_quads, &self.degree, &self.dart_of)
            == (&other.origin, &other.twin, other.n_quads, &other.degree, &other.dart_of)
            && (&self.fixed, &self.hexes, &self.star) == (&other.fixed, &other.hexes, &other.star)
            && (&self.pairs, &self.want) == (&other.pairs, &other.want)
    }
}
