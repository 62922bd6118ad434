//! 3-connected quad spheres: all of a size, and random ones.
//!
//! Theorem (Brinkmann, Greenberg, Greenhill, McKay, Thomas, Wollan, "Generation of simple quadrangulations of the sphere",
//! 2005): every one arises from a pseudo-double wheel by the expansions P1 (split off a vertex of degree 3: one quad more)
//! and P3 (a ring of four quads inside a quad: four quads more), staying 3-connected all the way. Their counts for 6, 8, ..., 20 quads are
//! 1, 1, 3, 11, 58, 451, 4461, 49957. A surface stays 3-connected as long as no vertex pair is twice an edge or diagonal
//! (see [`crate::improper_pairs`]) and no degree falls below 3, so each move is judged by a look at a table of pairs.
//!
//! Source: Brinkmann et al. 2005 (3-connected quadrangulations from pseudo-double wheels).

use super::{Random, cube_surface};
use crate::surface::QuadSurface;
use crate::surface_signature::surface_signature;
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeMap;

/// The pseudo-double wheel with two poles of degree `k`: `2 k` quads, a rim of `2 k` vertices joined in turn to the two poles
/// (`k = 3` is the cube). `None` below 3.
pub fn pseudo_double_wheel(k: u32) -> Option<QuadSurface> {
    if k < 3 || k as usize > QuadSurface::MAX_QUADS / 2 {
        return None;
    }
    // Poles 0 (joined to even rim vertices) and 1 (odd ones); rim vertex i is 2 + i.
    let rim = |i: u32| 2 + i % (2 * k);
    let mut quads = Vec::with_capacity(2 * k as usize);
    for i in 0..k {
        quads.push([0, rim(2 * i), rim(2 * i + 1), rim(2 * i + 2)]);
        quads.push([1, rim(2 * i + 3), rim(2 * i + 2), rim(2 * i + 1)]);
    }
    QuadSurface::try_new(2 * k as usize + 2, &quads).ok()
}

/// All 3-connected quad spheres with `n_quads` quads up to isomorphism (mirror images are one), ordered by signature.
/// Practical to 20 quads or so; use [`all_spheres_up_to`] for several sizes.
pub fn all_spheres(n_quads: usize) -> Vec<QuadSurface> {
    all_spheres_up_to(n_quads).pop().unwrap_or_default()
}

/// As [`all_spheres`], for each size `0..=n_quads`.
pub fn all_spheres_up_to(n_quads: usize) -> Vec<Vec<QuadSurface>> {
    let mut levels: Vec<Vec<QuadSurface>> = Vec::with_capacity(n_quads + 1);
    for n in 0..=n_quads {
        let mut classes = BTreeMap::new();
        let mut add = |surface: QuadSurface| {
            classes.entry(surface_signature(&surface)).or_insert(surface);
        };
        // Each size from smaller ones by the theorem on the page: wheels, P1 from one quad less, P3 from four less.
        // Every place is tried, and classes are told by their names: slower than plantri, which makes each once, and
        // independent of it.
        if n % 2 == 0 {
            pseudo_double_wheel(n as u32 / 2).into_iter().for_each(&mut add);
        }
        if n >= 1 {
            for parent in &levels[n - 1] {
                let sphere = Sphere::of(parent);
                for d in parent.darts() {
                    let (v, c) = (parent.origin(d).0, parent.target(d).0);
                    if sphere.may_split(v, c) {
                        let mut child = sphere.clone();
                        child.split(v, c);
                        add(child.surface());
                    }
                }
            }
        }
        if n >= 4 {
            for parent in &levels[n - 4] {
                for q in 0..parent.n_quads() {
                    let mut child = Sphere::of(parent);
                    child.insert_ring(q);
                    add(child.surface());
                }
            }
        }
        levels.push(classes.into_values().collect());
    }
    levels
}

/// A random 3-connected quad sphere: grown by random expansions, then mixed by random edge slides. Not uniform over the classes.
/// `None` if there is none: fewer than 6 quads, or 7. Near linear time.
pub fn random_sphere(n_quads: usize, seed: u64) -> Option<QuadSurface> {
    if n_quads < 6 || n_quads == 7 || n_quads > QuadSurface::MAX_QUADS / 2 {
        return None;
    }
    let mut random = Random::new(seed ^ (n_quads as u64).rotate_left(32));
    // A large wheel now and then: no slide leads to it.
    let from_wheel = n_quads >= 8 && random.below(64) == 0;
    let from_cube = n_quads == 6 || n_quads >= 10 && !from_wheel && random.below(2) == 0;
    let poles = if from_wheel { 4 + random.below(n_quads / 2 - 3) as u32 } else { 4 };
    let mut sphere = Sphere::of(&if from_cube { cube_surface() } else { pseudo_double_wheel(poles)? });
    while sphere.quads.len() < n_quads {
        let missing = n_quads - sphere.quads.len();
        // A ring now and then: splits alone never make two nested 4-cycles.
        let ring = missing >= 4 && random.below(16) == 0;
        let split = !ring && (0..200).any(|_| sphere.split_somewhere(&mut random));
        if !split {
            if missing >= 4 {
                sphere.insert_ring(random.below(sphere.quads.len()));
            } else if !sphere.split_anywhere() {
                sphere.slide_somewhere(&mut random);
            }
        }
    }
    for _ in 0..8 * n_quads {
        sphere.slide_somewhere(&mut random);
    }
    Some(sphere.surface())
}

/// A 3-connected quad sphere under construction.
#[derive(Clone)]
struct Sphere {
    quads: Vec<[u32; 4]>,
    /// Quad on the left of each directed edge.
    left: FxHashMap<(u32, u32), u32>,
    /// Every edge and every diagonal, smaller vertex first. Invariant: no pair twice.
    pairs: FxHashSet<(u32, u32)>,
    degree: Vec<u32>,
}

fn pair(a: u32, b: u32) -> (u32, u32) {
    (a.min(b), a.max(b))
}

impl Sphere {
    fn of(surface: &QuadSurface) -> Self {
        let n = surface.n_vertices();
        let mut sphere = Self {
            quads: Vec::with_capacity(surface.n_quads() + 4),
            left: FxHashMap::default(),
            pairs: FxHashSet::default(),
            degree: vec![0; n],
        };
        for quad in surface.quads() {
            sphere.push(quad.map(|v| v.0));
        }
        sphere
    }

    fn surface(&self) -> QuadSurface {
        QuadSurface::try_new(self.degree.len(), &self.quads).expect("the moves keep a surface a surface")
    }

    fn push(&mut self, quad: [u32; 4]) {
        self.quads.push([0; 4]);
        self.set(self.quads.len() - 1, quad);
    }

    /// Puts a quad in a free slot.
    fn set(&mut self, q: usize, quad: [u32; 4]) {
        self.quads[q] = quad;
        for i in 0..4 {
            let (a, b) = (quad[i], quad[(i + 1) % 4]);
            self.left.insert((a, b), q as u32);
            self.pairs.insert(pair(a, b));
            self.degree[a as usize] += 1;
        }
        self.pairs.insert(pair(quad[0], quad[2]));
        self.pairs.insert(pair(quad[1], quad[3]));
    }

    /// Takes a quad out; pairs of edges that another quad still uses stay only until that one is set again, so callers that keep an edge
    /// must set a quad on it.
    fn take(&mut self, q: usize) {
        let quad = self.quads[q];
        for i in 0..4 {
            let (a, b) = (quad[i], quad[(i + 1) % 4]);
            self.left.remove(&(a, b));
            if !self.left.contains_key(&(b, a)) {
                self.pairs.remove(&pair(a, b));
            }
            self.degree[a as usize] -= 1;
        }
        self.pairs.remove(&pair(quad[0], quad[2]));
        self.pairs.remove(&pair(quad[1], quad[3]));
    }

    /// The quad left of `a -> b`, rotated to start with them.
    fn quad_from(&self, a: u32, b: u32) -> (usize, [u32; 4]) {
        let q = self.left[&(a, b)] as usize;
        let mut quad = self.quads[q];
        let i = quad.iter().position(|&v| v == a).expect("the quad left of an edge has its ends");
        quad.rotate_left(i);
        (q, quad)
    }

    /// Whether the neighbour `c` of `v` may be taken over by a new vertex of degree 3 (P1).
    fn may_split(&self, v: u32, c: u32) -> bool {
        let a = self.quad_from(v, c).1[3];
        let b = self.quad_from(c, v).1[2];
        self.degree[v as usize] >= 4 && !self.pairs.contains(&pair(a, b))
    }

    /// P1: a new vertex x takes the neighbour `c` of `v`; x is joined to c and to the neighbours of `v` on both sides of c.
    fn split(&mut self, v: u32, c: u32) {
        let (p, [_, _, pc, a]) = self.quad_from(v, c);
        let (q, [_, _, b, qc]) = self.quad_from(c, v);
        let x = self.degree.len() as u32;
        self.degree.push(0);
        self.take(p);
        self.take(q);
        self.set(p, [x, c, pc, a]);
        self.set(q, [c, x, b, qc]);
        self.push([v, b, x, a]);
    }

    fn random_edge(&self, random: &mut Random) -> (u32, u32) {
        let quad = self.quads[random.below(self.quads.len())];
        let i = random.below(4);
        (quad[i], quad[(i + 1) % 4])
    }

    fn split_somewhere(&mut self, random: &mut Random) -> bool {
        let (v, c) = self.random_edge(random);
        let may = self.may_split(v, c);
        if may {
            self.split(v, c);
        }
        may
    }

    /// The first split there is; none on a pseudo-double wheel whose every split is improper.
    fn split_anywhere(&mut self) -> bool {
        let found = self.quads.iter().flat_map(|q| (0..4).map(|i| (q[i], q[(i + 1) % 4])));
        let found = found.into_iter().find(|&(v, c)| self.may_split(v, c));
        if let Some((v, c)) = found {
            self.split(v, c);
        }
        found.is_some()
    }

    /// P3: four new vertices inside quad `q`, joined to its corners and in a ring (the flip 1->5).
    fn insert_ring(&mut self, q: usize) {
        let [a, b, c, d] = self.quads[q];
        let w = self.degree.len() as u32;
        let (x, y, z) = (w + 1, w + 2, w + 3);
        self.degree.extend([0; 4]);
        self.take(q);
        self.set(q, [w, x, y, z]);
        for quad in [[a, b, x, w], [b, c, y, x], [c, d, z, y], [d, a, w, z]] {
            self.push(quad);
        }
    }

    /// Two quads at an edge form a hexagon; the edge becomes its next long diagonal (either way round), where that stays 3-connected.
    fn slide_somewhere(&mut self, random: &mut Random) -> bool {
        let (a, d) = self.random_edge(random);
        self.slide(a, d, random.below(2) == 0)
    }

    /// The slide of the edge `ad`, if it may be made.
    fn slide(&mut self, a: u32, d: u32, clockwise: bool) -> bool {
        if self.degree[a as usize] < 4 || self.degree[d as usize] < 4 {
            return false;
        }
        let (p, [_, _, e, f]) = self.quad_from(a, d);
        let (q, [_, _, b, c]) = self.quad_from(d, a);
        let ((x, y), quads) =
            if clockwise { ((b, e), [[a, b, e, f], [b, c, d, e]]) } else { ((c, f), [[c, d, e, f], [a, b, c, f]]) };
        // Either way b-f and c-e become diagonals; of the four old ones two stay.
        if [(x, y), (b, f), (c, e)].iter().any(|&(s, t)| self.pairs.contains(&pair(s, t))) {
            return false;
        }
        let gone = if clockwise { [(a, c), (d, f)] } else { [(a, e), (b, d)] };
        for (s, t) in gone.into_iter().chain([(a, d)]) {
            self.pairs.remove(&pair(s, t));
        }
        for (s, t) in [(x, y), (b, f), (c, e)] {
            self.pairs.insert(pair(s, t));
        }
        for (v, w) in [(a, x), (d, y)] {
            self.degree[v as usize] -= 1;
            self.degree[w as usize] += 1;
        }
        self.left.remove(&(a, d));
        self.left.remove(&(d, a));
        for (slot, quad) in [p, q].into_iter().zip(quads) {
            self.quads[slot] = quad;
            for i in 0..4 {
                self.left.insert((quad[i], quad[(i + 1) % 4]), slot as u32);
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::improper::is_three_connected;

    #[test]
    fn counts_are_the_published_ones() {
        let sizes: Vec<usize> = all_spheres_up_to(16).iter().map(Vec::len).collect();
        assert_eq!(sizes, [0, 0, 0, 0, 0, 0, 1, 0, 1, 1, 3, 3, 11, 18, 58, 139, 451]);
    }

    #[test]
    fn random_spheres_are_three_connected_and_reproducible() {
        for n in (6..60).filter(|&n| n != 7) {
            for seed in 0..10 {
                let s = random_sphere(n, seed).unwrap();
                s.debug_check();
                assert_eq!(s.n_quads(), n);
                assert!(is_three_connected(&s), "{n} {seed}");
                assert_eq!(s, random_sphere(n, seed).unwrap());
            }
        }
        assert!(random_sphere(5, 0).is_none() && random_sphere(7, 0).is_none());
    }

    #[test]
    fn random_spheres_reach_every_class_of_fourteen_quads() {
        let classes: std::collections::BTreeSet<String> =
            (0..3000).map(|seed| surface_signature(&random_sphere(14, seed).unwrap())).collect();
        assert_eq!(classes.len(), 58);
    }

    #[test]
    fn the_tables_stay_those_of_the_quads() {
        let mut random = Random::new(9);
        let mut sphere = Sphere::of(&pseudo_double_wheel(4).unwrap());
        for step in 0..3000 {
            match random.below(if sphere.quads.len() < 60 { 40 } else { 30 }) {
                0..30 => sphere.slide_somewhere(&mut random),
                30..39 => sphere.split_somewhere(&mut random),
                _ => {
                    sphere.insert_ring(random.below(sphere.quads.len()));
                    true
                }
            };
            if step % 50 == 0 {
                let again = Sphere::of(&sphere.surface());
                assert_eq!((&again.left, &again.pairs), (&sphere.left, &sphere.pairs));
                assert_eq!((&again.quads, &again.degree), (&sphere.quads, &sphere.degree));
                assert_eq!(again.pairs.len(), 4 * again.quads.len(), "2 edges and 2 diagonals a quad, all different");
            }
        }
        assert!(sphere.quads.len() >= 60);
    }

    /// Slides can be undone, so between any two classes A, B of one size: (slides A to B) / |Aut A| = (slides B to A) / |Aut B|. This ties the
    /// signatures, the orders of the groups and the completeness of the list together.
    #[test]
    fn slides_balance() {
        for n in [10, 11, 12, 13, 14] {
            let all = all_spheres(n);
            let index: BTreeMap<String, usize> = all.iter().map(surface_signature).zip(0..).collect();
            let order: Vec<u128> = all.iter().map(crate::surface_symmetry_order).collect();
            let mut slides: BTreeMap<(usize, usize), u128> = BTreeMap::new();
            for (i, s) in all.iter().enumerate() {
                let sphere = Sphere::of(s);
                for d in s.darts() {
                    for clockwise in [false, true] {
                        let mut other = sphere.clone();
                        // Each edge is two darts: every slide is counted twice on both sides.
                        if other.slide(s.origin(d).0, s.target(d).0, clockwise) {
                            *slides.entry((i, index[&surface_signature(&other.surface())])).or_insert(0) += 1;
                        }
                    }
                }
            }
            assert!(slides.len() > all.len() / 2);
            for (&(i, j), &count) in &slides {
                let back = slides.get(&(j, i)).copied().unwrap_or(0);
                assert_eq!(count * order[j], back * order[i], "{n}: classes {i} and {j}");
            }
        }
    }
}
