//! One more cube under rule `strict`: any two cubes share nothing, a vertex, an edge of both, or a facet of both.
//!
//! All identifications of vertices come from gluing facets, so a new cube N may merge vertices that were different
//! (a builder that forgets this misses complexes from five cubes on). The rule does not depend on the order of the cubes:
//! removing a cube that does not disconnect leaves a legal complex, which is what canonical augmentation needs.
//!
//! Each new cube is made once: its facet on the lowest quad of its gluing set is its bottom, seen in one fixed frame; the
//! other five facets are free or glued to a later quad by one of four maps (eight with non-orientable gluings).
//! Vertices that can never be merged (they share a cube, or their cubes meet in a way that would become improper) are
//! tabulated first, which settles most trials with two bit tests.
//!
//! Source: ours.

use crate::boundary::{Boundary, MAX_QUADS};
use crate::complex::{Complex, FREE, MAX_CUBES, MAX_VERTICES, reach, set_of};
use crate::frames::JOINED;

/// How to extend under rule `strict`.
///
/// | option | default |
/// |---|---|
/// | non-orientable | no |
/// | merges | yes |
/// | fewest first | yes |
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct StrictOptions {
    nonorientable: bool,
    merges: bool,
    fewest_first: bool,
}

impl Default for StrictOptions {
    fn default() -> Self {
        Self { nonorientable: false, merges: true, fewest_first: true }
    }
}

impl StrictOptions {
    /// Whether facets may be glued so that the complex becomes non-orientable.
    #[must_use]
    pub fn with_nonorientable(self, nonorientable: bool) -> Self {
        Self { nonorientable, ..self }
    }

    /// Whether vertices may be merged. Without, the builder is wrong: it exists so that a test can show that the mass
    /// formula notices.
    #[must_use]
    pub fn with_merges(self, merges: bool) -> Self {
        Self { merges, ..self }
    }

    /// Whether to make only the children in which the new cube has the fewest glued facets among the cubes that do not
    /// disconnect the child. This is the first part of the rule by which a child chooses its parent, so nothing is lost,
    /// and most trials are never begun.
    #[must_use]
    pub fn with_fewest_first(self, fewest_first: bool) -> Self {
        Self { fewest_first, ..self }
    }
}

/// The side of N over edge `i` of its bottom (from corner `i` to corner `i + 1`).
const SIDE_OVER: [usize; 4] = [2, 1, 3, 0];
const BOTTOM: usize = 4;
const TOP: usize = 5;

/// Calls `visit(child, number of glued facets)` for every complex that one legal new cube makes of `parent`; the new cube is
/// the last. Distinct gluings are visited once each, in a fixed order.
///
/// # Panics
/// If `parent` has [`MAX_CUBES`] cubes.
///
/// # Example
/// One more cube on a cube: always the same complex, glued by one quad.
/// ```
/// use hexfill_enumerate::{Complex, StrictOptions, canonical, extend_strict};
/// use std::collections::BTreeSet;
///
/// let mut names = BTreeSet::new();
/// extend_strict(&Complex::cube(), StrictOptions::default(), |child, n_glued| {
///     assert_eq!((child.n_cubes(), n_glued), (2, 1));
///     names.insert(canonical(child).code.to_text());
/// });
/// assert_eq!(names.len(), 1);
/// ```
pub fn extend_strict(parent: &Complex, options: StrictOptions, mut visit: impl FnMut(&Complex, u8)) {
    assert!(parent.n_cubes() < MAX_CUBES, "no room for one more cube");
    let boundary = Boundary::of(parent);
    let conflict = conflicts(parent);
    let mut limit = 6;
    let mut must_touch = 0u16;
    if options.fewest_first {
        // A cube that may go and is glued by d facets stays so (or gets d + 1): N has at most that many.
        let non_cut = parent.non_cut();
        limit = u8::MAX;
        for a in (0..parent.n_cubes()).filter(|a| non_cut >> a & 1 == 1) {
            let most = parent.n_glued(a) + 1;
            if most < limit {
                limit = most;
                must_touch = 0;
            }
            if most == limit {
                must_touch |= 1 << a;
            }
        }
        // N has one facet for each cube it touches: more cubes than that cannot all be touched, so at the limit
        // nothing is left.
        if must_touch.count_ones() > u32::from(limit) {
            limit -= 1;
            must_touch = 0;
        }
        limit = limit.max(1);
    }
    let mut site = Site {
        parent,
        boundary: &boundary,
        conflict: &conflict,
        adjacency: parent.adjacency(),
        options,
        limit,
        must_touch,
        visit: &mut visit,
    };
    for base in 0..boundary.n_quads() {
        let mut state = State {
            corners: [0; 8],
            own: 0,
            classes: [0; 8],
            n_classes: 0,
            on: [u8::MAX; 6],
            used: 1,
            touched: 1 << boundary.owner[base].0,
            base,
        };
        for (slot, v) in state.corners.iter_mut().zip(boundary.corners[base]) {
            *slot = 1 << v;
            state.own |= 1 << v;
        }
        state.on[BOTTOM] = base as u8;
        site.decide(0, &state);
    }
}

/// Per vertex, the vertices it can never be merged with.
fn conflicts(c: &Complex) -> [u64; MAX_VERTICES] {
    let mut out = [0u64; MAX_VERTICES];
    let n = c.n_cubes();
    for (a, cube) in c.cubes().iter().enumerate() {
        let set = c.sets[a];
        for &v in cube {
            out[v as usize & 63] |= set;
        }
        for (b, other) in c.cubes().iter().enumerate().take(n).skip(a + 1) {
            let common = set & c.sets[b];
            let blocked = match common.count_ones() {
                0 => continue,
                // With the merged vertex they would share two: these must be an edge of both.
                1 => (far_from(cube, common), far_from(other, common)),
                // They would share three or more without a common facet, or more than the facet.
                _ => (set, c.sets[b]),
            };
            for &v in cube {
                let far = blocked.0 >> (v & 63) & 1 == 1;
                out[v as usize & 63] |= if far { c.sets[b] } else { blocked.1 };
            }
            for &w in other {
                let far = blocked.1 >> (w & 63) & 1 == 1;
                out[w as usize & 63] |= if far { set } else { blocked.0 };
            }
        }
    }
    out
}

/// The vertices of a cube that are not joined by an edge to its vertex `at` (a set of one).
fn far_from(cube: &[u8; 8], at: u64) -> u64 {
    let i = place(cube, at);
    let mut out = 0;
    for (j, &v) in cube.iter().enumerate() {
        if JOINED[i & 7] >> j & 1 == 0 {
            out |= 1 << (v & 63);
        }
    }
    out
}

/// The corner of a cube at a vertex (a set of one).
#[inline]
fn place(cube: &[u8; 8], at: u64) -> usize {
    let v = at.trailing_zeros() as u8;
    cube.iter().position(|&w| w == v).unwrap_or(0)
}

/// Whether two vertices (a set of two) are joined by an edge of the cube.
#[inline]
fn joined(cube: &[u8; 8], two: u64) -> bool {
    let i = place(cube, two & two.wrapping_neg());
    let j = place(cube, two & (two - 1));
    JOINED[i & 7] >> j & 1 == 1
}

/// A partly decided new cube. Vertices of the parent that are merged stand as classes (bit sets).
#[derive(Clone, Copy)]
struct State {
    /// Per corner of N: its class, or 0 while it is new.
    corners: [u64; 8],
    /// Union of the corners' classes.
    own: u64,
    /// Classes of two and more vertices.
    classes: [u64; 8],
    n_classes: usize,
    /// Per side of N: the quad it is glued to.
    on: [u8; 6],
    used: u8,
    /// Cubes of the parent that N is glued to.
    touched: u16,
    base: usize,
}

impl State {
    #[inline]
    fn class_of(&self, v: u8) -> u64 {
        let bit = 1u64 << (v & 63);
        for &class in &self.classes[..self.n_classes] {
            if class & bit != 0 {
                return class;
            }
        }
        bit
    }
}

struct Site<'a, F> {
    parent: &'a Complex,
    boundary: &'a Boundary,
    conflict: &'a [u64; MAX_VERTICES],
    adjacency: [u16; MAX_CUBES],
    options: StrictOptions,
    /// Most facets to glue.
    limit: u8,
    /// The cubes that must be glued to N if it is glued by `limit` facets.
    must_touch: u16,
    visit: &'a mut F,
}

impl<F: FnMut(&Complex, u8)> Site<'_, F> {
    #[inline]
    fn conflict_of(&self, mut class: u64) -> u64 {
        let mut out = 0;
        while class != 0 {
            out |= self.conflict[class.trailing_zeros() as usize & 63];
            class &= class - 1;
        }
        out
    }

    /// Puts corner `i` of N on vertex `v`, merging where that needs it; `false` if that can never be legal.
    #[inline]
    fn put(&self, state: &mut State, i: usize, v: u8) -> bool {
        let class = state.class_of(v);
        let mine = state.corners[i & 7];
        if mine == class {
            return true;
        }
        if class & state.own != 0 {
            // Another corner of N is there.
            return false;
        }
        if mine == 0 {
            state.corners[i & 7] = class;
            state.own |= class;
            return true;
        }
        if !self.options.merges || self.conflict_of(mine) & class != 0 {
            return false;
        }
        let union = mine | class;
        let mut kept = 0;
        for k in 0..state.n_classes {
            if state.classes[k] & union == 0 {
                state.classes[kept] = state.classes[k];
                kept += 1;
            }
        }
        state.classes[kept & 7] = union;
        state.n_classes = kept + 1;
        state.corners[i & 7] = union;
        state.own |= union;
        true
    }

    /// Whether quad `q` may be glued next, as far as cubes go.
    #[inline]
    fn allowed(&self, state: &State, q: usize) -> bool {
        let bit = 1u16 << self.boundary.owner[q].0;
        // Two facets on one cube would share six vertices or more.
        if state.touched & bit != 0 {
            return false;
        }
        !self.options.fewest_first
            || self.must_touch == 0
            || state.used + 1 < self.limit
            || self.must_touch & !(state.touched | bit) == 0
    }

    /// Decides side `step` (0..4 beside the bottom, 4 the top) and those after it.
    fn decide(&mut self, step: usize, state: &State) {
        if step == 5 || state.used >= self.limit {
            self.finish(state);
            return;
        }
        self.decide(step + 1, state);
        if step == 4 {
            return self.decide_top(state);
        }
        let (i, j) = (step, (step + 1) & 3);
        // What corners i and j of the bottom can never be.
        let not_i = self.conflict_of(state.corners[i]) & !state.corners[i];
        let not_j = self.conflict_of(state.corners[j]) & !state.corners[j];
        for q in state.base + 1..self.boundary.n_quads() {
            if !self.allowed(state, q) {
                continue;
            }
            let quad = self.boundary.corners[q & (MAX_QUADS - 1)];
            for e in 0..4 {
                // Consistent: edge e of the quad runs from corner j to corner i.
                let (a, b, c, d) = (quad[e], quad[(e + 1) & 3], quad[(e + 2) & 3], quad[(e + 3) & 3]);
                if not_i >> (b & 63) & 1 == 0 && not_j >> (a & 63) & 1 == 0 {
                    self.glue_side(step, state, q, [b, a, d, c]);
                }
                if self.options.nonorientable && not_i >> (a & 63) & 1 == 0 && not_j >> (b & 63) & 1 == 0 {
                    self.glue_side(step, state, q, [a, b, c, d]);
                }
            }
        }
    }

    /// Side `step` with corners i, j, above j, above i on the given vertices.
    fn glue_side(&mut self, step: usize, state: &State, q: usize, [i, j, above_j, above_i]: [u8; 4]) {
        let mut next = *state;
        let k = (step + 1) & 3;
        if self.put(&mut next, step, i)
            && self.put(&mut next, k, j)
            && self.put(&mut next, 4 + step, above_i)
            && self.put(&mut next, 4 + k, above_j)
        {
            next.on[SIDE_OVER[step]] = q as u8;
            next.used += 1;
            next.touched |= 1 << self.boundary.owner[q].0;
            self.decide(step + 1, &next);
        }
    }

    fn decide_top(&mut self, state: &State) {
        for q in state.base + 1..self.boundary.n_quads() {
            if !self.allowed(state, q) {
                continue;
            }
            let quad = self.boundary.corners[q & (MAX_QUADS - 1)];
            for r in 0..4 {
                for along in 0..=usize::from(self.options.nonorientable) {
                    let mut next = *state;
                    let fits = (0..4).all(|i| {
                        let k = if along == 1 { (r + i) & 3 } else { (r + 4 - i) & 3 };
                        self.put(&mut next, 4 + i, quad[k])
                    });
                    if fits {
                        next.on[TOP] = q as u8;
                        next.used += 1;
                        next.touched |= 1 << self.boundary.owner[q].0;
                        self.finish(&next);
                    }
                }
            }
        }
    }

    /// Whether N has the fewest glued facets among the cubes of the child that do not disconnect it.
    fn has_fewest(&self, state: &State) -> bool {
        let n = self.parent.n_cubes();
        let mut adjacency = self.adjacency;
        adjacency[n] = state.touched;
        for (a, slot) in adjacency[..n].iter_mut().enumerate() {
            *slot |= (state.touched >> a & 1) << n;
        }
        let all = (1u16 << (n + 1)) - 1;
        (0..n).all(|a| {
            let glued = adjacency[a].count_ones();
            let rest = all & !(1 << a);
            // In rule `strict` a cube has as many neighbours as glued facets. Cubes with one never disconnect.
            glued >= u32::from(state.used) || (glued > 1 && reach(&adjacency, n, rest) != rest)
        })
    }

    /// Checks all pairs of cubes and visits the child if it is legal.
    fn finish(&mut self, state: &State) {
        if self.options.fewest_first && !self.has_fewest(state) {
            return;
        }
        let parent = self.parent;
        let n = parent.n_cubes();
        let mut fresh = parent.n_vertices;
        let corners: [u8; 8] = std::array::from_fn(|i| {
            if state.corners[i] != 0 {
                state.corners[i].trailing_zeros() as u8
            } else {
                fresh += 1;
                fresh - 1
            }
        });
        let own = set_of(&corners);
        let renamed;
        // Most candidates merge no old vertices, and then the parent's own tables serve.
        let (cubes, sets) = if state.n_classes == 0 {
            (&parent.cubes, &parent.sets)
        } else {
            renamed = merged(parent, state);
            // A merge may make two old cubes improper that the new one does not touch.
            if !old_pairs_are_proper(parent, &renamed.0, &renamed.1) {
                return;
            }
            (&renamed.0, &renamed.1)
        };
        for a in 0..n {
            let common = own & sets[a];
            let legal = match common.count_ones() {
                0 | 1 => true,
                2 => joined(&corners, common) && joined(&cubes[a], common),
                // Four common vertices are legal only as the facet that was glued.
                4 => state.touched >> a & 1 == 1,
                _ => false,
            };
            if !legal {
                return;
            }
        }
        let mut child = *parent;
        child.cubes = *cubes;
        child.sets = *sets;
        child.cubes[n] = corners;
        child.sets[n] = own;
        child.n_cubes += 1;
        child.n_vertices = fresh;
        for (f, &q) in state.on.iter().enumerate() {
            if q != u8::MAX {
                let (a, side) = self.boundary.owner[q as usize & (MAX_QUADS - 1)];
                let done = child.glue(n, f, a as usize, side as usize);
                debug_assert!(done, "the corners were put on the quad");
            }
        }
        if state.n_classes > 0 {
            compact(&mut child);
        }
        (self.visit)(&child, state.used);
    }
}

/// The parent's cubes and vertex sets after merging: a class takes the name of its lowest vertex.
fn merged(parent: &Complex, state: &State) -> ([[u8; 8]; MAX_CUBES], [u64; MAX_CUBES]) {
    let mut cubes = parent.cubes;
    let mut sets = parent.sets;
    for &class in &state.classes[..state.n_classes] {
        let name = class.trailing_zeros() as u8;
        for a in 0..parent.n_cubes() {
            if sets[a] & class != 0 {
                for v in &mut cubes[a] {
                    if class >> (*v & 63) & 1 == 1 {
                        *v = name;
                    }
                }
                sets[a] = sets[a] & !class | 1 << name;
            }
        }
    }
    (cubes, sets)
}

/// Whether the parent's cubes still have eight corners each and meet properly.
fn old_pairs_are_proper(parent: &Complex, cubes: &[[u8; 8]; MAX_CUBES], sets: &[u64; MAX_CUBES]) -> bool {
    let n = parent.n_cubes();
    for a in 0..n {
        if sets[a].count_ones() != 8 {
            return false;
        }
        for b in 0..a {
            let common = sets[a] & sets[b];
            let legal = match common.count_ones() {
                0 | 1 => true,
                2 => joined(&cubes[a], common) && joined(&cubes[b], common),
                // A new common facet would be a gluing of its own: that complex has another parent.
                4 => parent.next[a].contains(&(b as u8)),
                _ => false,
            };
            if !legal {
                return false;
            }
        }
    }
    true
}

/// Renumbers the vertices without gaps, keeping their order.
fn compact(c: &mut Complex) {
    let n = c.n_cubes();
    let used = c.sets[..n].iter().fold(0, |all, set| all | set);
    let mut rename = [FREE; MAX_VERTICES];
    let mut left = used;
    let mut count = 0;
    while left != 0 {
        rename[left.trailing_zeros() as usize & 63] = count;
        count += 1;
        left &= left - 1;
    }
    for (cube, set) in c.cubes[..n].iter_mut().zip(&mut c.sets) {
        for v in cube.iter_mut() {
            *v = rename[*v as usize & 63];
        }
        *set = set_of(cube);
    }
    c.n_vertices = count;
}

/// The pairs of cubes that break rule `strict`, in words; empty if there are none. Slow and separate from
/// [`extend_strict`], for reports.
pub fn strict_violations(c: &Complex) -> Vec<String> {
    let mut out = Vec::new();
    for a in 0..c.n_cubes() {
        for b in 0..a {
            let common = c.sets[a] & c.sets[b];
            let glued = c.next[a].iter().filter(|&&x| x == b as u8).count();
            let n = common.count_ones();
            let legal = match n {
                0 | 1 => true,
                2 => joined(&c.cubes[a], common) && joined(&c.cubes[b], common),
                4 => glued == 1,
                _ => false,
            };
            if !legal {
                let what =
                    if n == 2 { "two vertices that are not an edge of both".into() } else { format!("{n} vertices") };
                out.push(format!("h{b} and h{a} share {what} and {glued} facets"));
            }
        }
    }
    out
}
