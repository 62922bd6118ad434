//! One more cube under rule `weill`: the definition that reproduces the BruteBuilder's published table
//! (J.-C. Weill, "A tentative to break the pyramid's code").
//!
//! A new cube N is glued on 1 to 6 exterior quads. Vertices are never merged: adjacent facets of N go on quads that
//! share the edge already; two opposite facets may go on quads without common vertices, in four rotations. Then
//! 1. each free facet of N shares at most two vertices with any earlier cube,
//! 2. N shares at most four vertices with any earlier cube,
//! 3. each boundary edge is in exactly two boundary quads afterwards.
//!
//! The rule is not hereditary (a cube may be removable without the rest being reachable).
//! Each new cube is made once: its glued facet on the lowest quad is its bottom, seen in one fixed rotation.
//!
//! Source: Weill; the exact rule was found by experiment against his table (book, page `enumerate`, "Two rules").

use crate::boundary::Boundary;
use crate::complex::{Complex, FREE, MAX_CUBES, MAX_VERTICES, set_of, side_set_of};
use crate::frames::EDGES_OFF;
use hexfill_mesh::cube::{EDGES, FACETS};
use std::collections::BTreeMap;

/// The side of N over edge `i` of its bottom (from corner `i` to corner `i + 1`).
const SIDE_OVER: [usize; 4] = [2, 1, 3, 0];
const BOTTOM: usize = 4;
const TOP: usize = 5;

/// A new cube: its corners (new vertices are `n_vertices..`) and the boundary quads its sides are glued to.
struct Candidate {
    corners: [u8; 8],
    /// Per side: the boundary quad, or `u8::MAX`.
    on: [u8; 6],
}

/// Calls `visit(child, number of glued facets)` for every complex that one legal new cube makes of `parent`.
/// The new cube is the last. Distinct new cubes are visited once each, in a fixed order.
///
/// # Panics
/// If `parent` has [`MAX_CUBES`] cubes.
pub fn extend_weill(parent: &Complex, mut visit: impl FnMut(&Complex, u8)) {
    assert!(parent.n_cubes() < MAX_CUBES, "no room for one more cube");
    let boundary = Boundary::of(parent);
    let n = boundary.n_quads();
    let mut sets = [0u64; crate::boundary::MAX_QUADS];
    // Per vertex, the vertices at the other ends of boundary edges.
    let mut along = [0u64; MAX_VERTICES];
    for (q, corners) in boundary.quads().iter().enumerate() {
        for k in 0..4 {
            let (v, w) = (corners[k] as usize & 63, corners[(k + 1) & 3] as usize & 63);
            sets[q] |= 1 << v;
            along[v] |= 1 << w;
            along[w] |= 1 << v;
        }
    }
    let mut site = Site { parent, boundary: &boundary, along: &along, visit: &mut visit };
    for base in 0..n {
        let quad = boundary.corners[base];
        site.beside(base, 0, false, &sets);
        for sides in 1..16u8 {
            site.beside(base, sides, false, &sets);
            site.beside(base, sides, true, &sets);
        }
        // Bottom and top only, on two quads without a common vertex: four rotations.
        for q in base + 1..n {
            if sets[q] & sets[base] != 0 {
                continue;
            }
            let far = boundary.corners[q];
            for r in 0..4 {
                // The top is seen from inside N on the far quad: its order is reversed.
                let top: [u8; 4] = std::array::from_fn(|i| far[(r + 4 - i) & 3]);
                let corners = [quad[0], quad[1], quad[2], quad[3], top[0], top[1], top[2], top[3]];
                let mut on = [u8::MAX; 6];
                on[BOTTOM] = base as u8;
                on[TOP] = q as u8;
                site.offer(&Candidate { corners, on });
            }
        }
    }
}

struct Site<'a, F> {
    parent: &'a Complex,
    boundary: &'a Boundary,
    along: &'a [u64; MAX_VERTICES],
    visit: &'a mut F,
}

impl<F: FnMut(&Complex, u8)> Site<'_, F> {
    /// Bottom on `base`, the sides of the set `sides` on the quads across the edges of `base`, and if `with_top` the top on
    /// the quad across the far edge of those.
    fn beside(&mut self, base: usize, sides: u8, with_top: bool, sets: &[u64; crate::boundary::MAX_QUADS]) {
        let quad = self.boundary.corners[base];
        let mut top = [u8::MAX; 4];
        let mut on = [u8::MAX; 6];
        on[BOTTOM] = base as u8;
        for i in 0..4 {
            if sides >> i & 1 == 0 {
                continue;
            }
            let partner = self.boundary.partner[base][i] as usize;
            let (q, e) = ((partner / 4) & 63, partner & 3);
            if q <= base {
                return;
            }
            let other = self.boundary.corners[q];
            // Edge `i` of the base is edge `e` of the other quad, backwards.
            for (corner, v) in [(i, other[(e + 2) & 3]), ((i + 1) & 3, other[(e + 3) & 3])] {
                if top[corner] != u8::MAX && top[corner] != v {
                    return;
                }
                top[corner] = v;
            }
            on[SIDE_OVER[i]] = q as u8;
            if with_top {
                let partner = self.boundary.partner[q][(e + 2) & 3] as usize;
                let (q, e) = ((partner / 4) & 63, partner & 3);
                if q <= base || (on[TOP] != u8::MAX && on[TOP] != q as u8) {
                    return;
                }
                on[TOP] = q as u8;
                let other = self.boundary.corners[q];
                for k in 0..4 {
                    // Corner `e + k` of the top quad lies over corner `i + 1 - k` of the base.
                    let (corner, v) = ((i + 5 - k) & 3, other[(e + k) & 3]);
                    if top[corner] != u8::MAX && top[corner] != v {
                        return;
                    }
                    top[corner] = v;
                }
            }
        }
        let old_top = top.iter().fold(0u64, |set, &v| if v == u8::MAX { set } else { set | 1 << (v & 63) });
        let n_old = top.iter().filter(|&&v| v != u8::MAX).count();
        if old_top.count_ones() as usize != n_old || old_top & sets[base] != 0 {
            return;
        }
        // A top that happens to lie on an exterior quad without being glued is refused below (rule 1), and made with it.
        let mut fresh = self.parent.n_vertices;
        for v in &mut top {
            if *v == u8::MAX {
                *v = fresh;
                fresh += 1;
            }
        }
        let corners = [quad[0], quad[1], quad[2], quad[3], top[0], top[1], top[2], top[3]];
        self.offer(&Candidate { corners, on });
    }

    /// Visits the child if the candidate is legal.
    fn offer(&mut self, candidate: &Candidate) {
        let parent = self.parent;
        let own = set_of(&candidate.corners);
        if own.count_ones() != 8 {
            return;
        }
        let mut glued = 0u8;
        for (f, &q) in candidate.on.iter().enumerate() {
            glued |= u8::from(q != u8::MAX) << f;
        }
        // Boundary edges (3): a free edge of N must not be a boundary edge already.
        let mut edges = EDGES_OFF[glued as usize & 63];
        while edges != 0 {
            let e = edges.trailing_zeros() as usize;
            edges &= edges - 1;
            let [i, j] = EDGES[e % 12];
            if self.along[candidate.corners[i] as usize & 63] >> (candidate.corners[j] & 63) & 1 == 1 {
                return;
            }
        }
        // Rules 1 and 2.
        // Sets of vertices in one word: an intersection is an `and`, and most candidates end here.
        let free: [u64; 6] =
            std::array::from_fn(|f| if glued >> f & 1 == 1 { 0 } else { side_set_of(&candidate.corners, f) });
        for other in &parent.sets[..parent.n_cubes()] {
            let common = own & other;
            let n = common.count_ones();
            if n <= 2 {
                continue;
            }
            if n > 4 || free.iter().any(|facet| (facet & common).count_ones() > 2) {
                return;
            }
        }
        let mut child = *parent;
        let new = parent.n_cubes();
        child.cubes[new] = candidate.corners;
        child.sets[new] = own;
        child.n_cubes += 1;
        child.n_vertices = parent.n_vertices.max(candidate.corners.iter().fold(0, |m, &v| m.max(v + 1)));
        for (f, &q) in candidate.on.iter().enumerate() {
            if q != u8::MAX {
                let (a, side) = self.boundary.owner[q as usize & 63];
                let done = child.glue(new, f, a as usize, side as usize);
                debug_assert!(done, "candidates are glued consistently");
            }
        }
        (self.visit)(&child, glued.count_ones() as u8);
    }
}

/// Whether cube `m` of a complex that rule `weill` made could have been the last one added, given that the others are a
/// legal complex: rules 1 and 2 against every other cube (rule 3 is a property of the whole complex).
pub(crate) fn could_be_last(c: &Complex, m: usize) -> bool {
    let own = c.sets[m];
    let free: [u64; 6] = std::array::from_fn(|f| if c.next[m][f] == FREE { side_set_of(&c.cubes[m], f) } else { 0 });
    (0..c.n_cubes()).filter(|&a| a != m).all(|a| {
        let common = own & c.sets[a];
        match common.count_ones() {
            0..=2 => true,
            3 | 4 => free.iter().all(|facet| (facet & common).count_ones() <= 2),
            _ => false,
        }
    })
}

/// The rules a complex breaks as a rule-`weill` addition of its last cube to the others, in words; empty if it is legal.
/// Slow and separate from [`extend_weill`], for reports.
pub fn weill_violations(c: &Complex) -> Vec<String> {
    let mut out = Vec::new();
    let n = c.n_cubes() - 1;
    let own = c.sets[n];
    for (o, &other) in c.sets[..n].iter().enumerate() {
        if (own & other).count_ones() > 4 {
            out.push(format!("h{n} shares {} vertices with h{o}", (own & other).count_ones()));
        }
        for f in 0..6 {
            let common = (side_set_of(&c.cubes[n], f) & other).count_ones();
            if c.next[n][f] == FREE && common > 2 {
                out.push(format!("free facet {f} of h{n} shares {common} vertices with h{o}"));
            }
        }
    }
    for ([v, w], n) in boundary_edge_uses(c) {
        if n != 2 {
            out.push(format!("boundary edge v{v} v{w} is in {n} boundary quads"));
        }
    }
    out
}

/// Per edge of the boundary, the number of boundary quads that contain it.
fn boundary_edge_uses(c: &Complex) -> BTreeMap<[u8; 2], u32> {
    let mut uses = BTreeMap::new();
    for a in 0..c.n_cubes() {
        for f in (0..6).filter(|&f| c.next[a][f] == FREE) {
            for k in 0..4 {
                let (v, w) = (c.cubes[a][FACETS[f][k]], c.cubes[a][FACETS[f][(k + 1) % 4]]);
                *uses.entry([v.min(w), v.max(w)]).or_insert(0) += 1;
            }
        }
    }
    uses
}

/// Rule 3: whether each boundary edge is in exactly two boundary quads.
pub(crate) fn edges_are_manifold(c: &Complex) -> bool {
    boundary_edge_uses(c).values().all(|&n| n == 2)
}
