//! The canonical form of a cavity: its class (the sphere up to isomorphism, mirror images identified) and, within it,
//! the canonical image of the blocked pairs.
//!
//! The class is named by the smallest breadth-first code over flags (a dart and one of two orientations). Quads are
//! numbered as they are reached; the code lists, side by side, which quad lies beyond and by which of its sides it is
//! entered. Only the flags of the rarest local kind are tried (any isomorphism-invariant choice will do), and a flag
//! is given up at the first byte that exceeds the best code so far. Flags that reach the same best code differ by an
//! automorphism of the class; among them the smallest image of the blocked pairs is the canonical one.
//!
//! Source: Brinkmann, McKay 2007 (codes of plane graphs); the image of the blocked pairs is ours.

use crate::cavity::{Cavity, MAX_DARTS, MAX_QUADS, MAX_VERTICES, Pairs, next, turn};

/// Longest code: four bytes for the first quad, three for each further one.
pub(crate) const MAX_CODE: usize = 3 * MAX_QUADS + 1;

/// Length of the code of a sphere of `n_quads` quads.
pub(crate) const fn code_len(n_quads: usize) -> usize {
    3 * n_quads + 1
}

/// One way to number a cavity that gives its canonical code.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Flag {
    pub dart: u8,
    pub mirrored: bool,
}

/// The canonical code of a cavity and all flags that produce it.
pub(crate) struct Canonical {
    code: [u8; MAX_CODE],
    len: usize,
    flags: Vec<Flag>,
}

/// A small number spread over 32 bits, so that sums tell multisets apart.
#[inline]
fn scatter(x: u32) -> u32 {
    let h = (x + 1).wrapping_mul(0x9e37_79b1);
    (h ^ h >> 15).wrapping_mul(0x85eb_ca6b)
}

impl Canonical {
    pub(crate) fn new() -> Self {
        Self { code: [0; MAX_CODE], len: 0, flags: Vec::with_capacity(64) }
    }

    /// The code.
    pub(crate) fn code(&self) -> &[u8] {
        &self.code[..self.len]
    }

    /// The flags that give the code: as many as the class has automorphisms (reflections included).
    pub(crate) fn flags(&self) -> &[Flag] {
        &self.flags
    }

    /// Computes the canonical code of `cavity`, reusing the buffers.
    pub(crate) fn compute(&mut self, cavity: &Cavity) {
        let n = cavity.n_quads();
        let n_darts = 4 * n;
        self.len = code_len(n);
        self.flags.clear();
        // Vertex colours: degree, then one round over the quads. Sums are order-free, so mirror images agree.
        let degrees = cavity.degrees();
        let mut colour = [0u32; MAX_VERTICES];
        for d in 0..n_darts as u8 {
            let near = u32::from(degrees[usize::from(cavity.origin[usize::from(next(d))])]);
            let far = u32::from(degrees[usize::from(cavity.origin[usize::from(turn(d, 2))])]);
            let at = &mut colour[usize::from(cavity.origin[usize::from(d)])];
            *at = at.wrapping_add(scatter(near)).wrapping_add(scatter(far + 64));
        }
        let mut dart_colour = [0u32; MAX_DARTS];
        for (slot, &v) in dart_colour.iter_mut().zip(&cavity.origin[..n_darts]) {
            let v = usize::from(v);
            *slot = (colour[v] ^ colour[v] >> 15).wrapping_add(u32::from(degrees[v]) << 27);
        }
        // Flag kinds: the colours round the quad in the flag's order, hashed to a byte.
        let mut kinds = [[0u8; 2]; MAX_DARTS];
        let mut count = [0u8; 256];
        for d in 0..n_darts as u8 {
            let [a, b, c, e] = [0, 1, 2, 3].map(|i| dart_colour[usize::from(turn(d, i))]);
            // The quad across makes kinds rarer, and every flag that is not tried saves a code.
            let across = dart_colour[usize::from(turn(cavity.twin[usize::from(d)], 2))];
            let across2 = dart_colour[usize::from(turn(cavity.twin[usize::from(d)], 3))];
            let hash = |p: [u32; 6]| {
                let mut h = 0u32;
                for (x, m) in
                    p.iter().zip([0x9e37_79b1u32, 0x85eb_ca77, 0xc2b2_ae3d, 0x27d4_eb2f, 0x1656_67b1, 0x2c1b_3c6d])
                {
                    h = h.wrapping_add((x ^ x >> 13).wrapping_mul(m));
                }
                ((h ^ h >> 16).wrapping_mul(0x7feb_352d) >> 24) as u8
            };
            // Forward the flag starts at the dart's origin, mirrored at its target; the quad across is met in step.
            let pair = [hash([a, b, c, e, across, across2]), hash([b, a, e, c, across2, across])];
            for k in pair {
                count[usize::from(k)] = count[usize::from(k)].saturating_add(1);
            }
            kinds[usize::from(d)] = pair;
        }
        // The smallest of the rarest kinds, with the count before the kind in one number; kinds that do not occur come last.
        let ranks = count.iter().zip(0u16..).map(|(&count, kind)| u16::from(count.wrapping_sub(1)) << 8 | kind);
        // Any choice that isomorphisms respect will do, and hashes collide alike in both copies: a collision costs
        // flags to try, never a wrong name.
        let rarest = ranks.fold(u16::MAX, u16::min) as u8;
        for d in 0..n_darts as u8 {
            for (i, mirrored) in [false, true].into_iter().enumerate() {
                if kinds[usize::from(d)][i] == rarest {
                    self.try_flag(cavity, Flag { dart: d, mirrored });
                }
            }
        }
    }

    /// Writes the code of one flag over the best one where it is smaller; remembers the flag where it ties.
    fn try_flag(&mut self, cavity: &Cavity, flag: Flag) {
        let first = self.flags.is_empty();
        let mut better = first;
        let mut number = [u8::MAX; MAX_QUADS];
        let mut entry = [0u8; MAX_QUADS];
        number[usize::from(flag.dart >> 2)] = 0;
        entry[0] = flag.dart;
        let mut reached = 1u8;
        let mut at = 0;
        let n = cavity.n_quads();
        // Sides are met as dart, dart + 1, ... or, mirrored, as dart, dart - 1, ...
        let step = if flag.mirrored { 3u8 } else { 1 };
        for i in 0..n {
            let d = entry[i];
            let mut side = if i == 0 { 0 } else { step };
            for _ in usize::from(i > 0)..4 {
                let t = cavity.twin[usize::from(turn(d, side))];
                side = side.wrapping_add(step);
                let q = usize::from(t >> 2);
                let byte = if number[q] == u8::MAX {
                    number[q] = reached;
                    entry[usize::from(reached)] = t;
                    reached += 1;
                    4 * number[q]
                } else {
                    let e = entry[usize::from(number[q])];
                    let by = if flag.mirrored { e.wrapping_sub(t) } else { t.wrapping_sub(e) } & 3;
                    4 * number[q] + by
                };
                if better {
                    self.code[at] = byte;
                } else if byte != self.code[at] {
                    // Most flags end here after a few bytes, which is what makes the form cheap.
                    if byte > self.code[at] {
                        return;
                    }
                    better = true;
                    self.code[at] = byte;
                }
                at += 1;
            }
        }
        // A smaller code makes all flags so far void; an equal one adds an automorphism.
        if better {
            self.flags.clear();
        }
        self.flags.push(flag);
    }

    /// Canonical number of each vertex of the cavity under `flag`: order of first meeting along the code.
    pub(crate) fn vertex_numbers(cavity: &Cavity, flag: Flag) -> [u8; MAX_VERTICES] {
        let n = cavity.n_quads();
        let mut number = [u8::MAX; MAX_QUADS];
        let mut entry = [0u8; MAX_QUADS];
        let mut vertex = [u8::MAX; MAX_VERTICES];
        let mut n_vertices = 0u8;
        number[usize::from(flag.dart >> 2)] = 0;
        entry[0] = flag.dart;
        let mut reached = 1u8;
        let step = if flag.mirrored { 3u8 } else { 1 };
        for i in 0..n {
            // The same walk as in `try_flag`, vertices numbered on the way. Kept apart: the code is computed for
            // every flag of every child, the numbers for few.
            let mut d = entry[i];
            for _ in 0..4 {
                let start = if flag.mirrored { next(d) } else { d };
                let v = &mut vertex[usize::from(cavity.origin[usize::from(start)])];
                if *v == u8::MAX {
                    *v = n_vertices;
                    n_vertices += 1;
                }
                let t = cavity.twin[usize::from(d)];
                let q = usize::from(t >> 2);
                if number[q] == u8::MAX {
                    number[q] = reached;
                    entry[usize::from(reached)] = t;
                    reached += 1;
                }
                d = turn(d, step);
            }
        }
        vertex
    }

    /// The canonical image of the cavity's blocked pairs, and the first flag that gives it.
    pub(crate) fn blocked_image(&self, cavity: &Cavity) -> (Pairs, Flag) {
        let mut best: Option<(Pairs, Flag)> = None;
        for &flag in &self.flags {
            let image = relabel(&cavity.blocked, cavity.n_vertices(), &Self::vertex_numbers(cavity, flag));
            if best.as_ref().is_none_or(|(b, _)| image < *b) {
                best = Some((image, flag));
            }
        }
        best.expect("compute() was called first")
    }
}

/// Pairs under a renumbering of the vertices.
pub(crate) fn relabel(pairs: &Pairs, n_vertices: usize, number: &[u8]) -> Pairs {
    let mut image = [0; MAX_VERTICES];
    for v in 0..n_vertices {
        let mut row = pairs[v];
        let out = &mut image[usize::from(number[v])];
        while row != 0 {
            *out |= 1 << number[row.trailing_zeros() as usize];
            row &= row - 1;
        }
    }
    image
}

/// The cavity with a given canonical code, vertices numbered by first meeting; blocked pairs empty.
/// `None` if the bytes are no code of a sphere.
pub(crate) fn decode(code: &[u8]) -> Option<Cavity> {
    let n = (code.len().checked_sub(1)?) / 3;
    if code.len() != code_len(n) || !(6..=MAX_QUADS).contains(&n) {
        return None;
    }
    let mut cavity = Cavity::empty();
    cavity.n_quads = n as u8;
    cavity.twin = [u8::MAX; MAX_DARTS];
    let mut reached = 1usize;
    let mut bytes = code.iter();
    for i in 0..n {
        if i >= reached {
            return None;
        }
        for side in u8::from(i > 0)..4 {
            let d = 4 * i + usize::from(side);
            let t = usize::from(*bytes.next()?);
            if t >> 2 == reached && t & 3 == 0 {
                reached += 1;
            }
            // Codes come from files too: every index is looked at before it is used.
            if t >> 2 >= reached.min(n) || t == d {
                return None;
            }
            cavity.twin[d] = t as u8;
            if t & 3 == 0 && cavity.twin[t] == u8::MAX {
                // The side by which a quad is first entered is not in the code again.
                cavity.twin[t] = d as u8;
            }
        }
    }
    for d in 0..4 * n {
        let t = usize::from(cavity.twin[d]);
        if t >= 4 * n || usize::from(cavity.twin[t]) != d {
            return None;
        }
    }
    cavity.origin = [u8::MAX; MAX_DARTS];
    for d in 0..4 * n as u8 {
        if cavity.origin[usize::from(d)] != u8::MAX {
            continue;
        }
        if usize::from(cavity.n_vertices) >= n + 2 {
            return None;
        }
        let mut e = d;
        loop {
            cavity.origin[usize::from(e)] = cavity.n_vertices;
            e = next(cavity.twin[usize::from(e)]);
            if e == d {
                break;
            }
        }
        cavity.n_vertices += 1;
    }
    // Euler: closed and connected with n quads and n + 2 vertices is a sphere.
    (usize::from(cavity.n_vertices) == n + 2).then_some(cavity)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flip::{apply, legal_flips};
    use std::collections::HashSet;

    /// Renumbers darts and vertices at random-looking places, optionally mirrored.
    fn shuffled(cavity: &Cavity, seed: u64, mirrored: bool) -> Cavity {
        let n = cavity.n_vertices() as u32;
        let mut order: Vec<u32> = (0..n).collect();
        let mut quads: Vec<[u32; 4]> = cavity.quads().iter().map(|q| q.map(u32::from)).collect();
        let mut state = seed | 1;
        let mut random = |limit: usize| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as usize % limit
        };
        for i in (1..order.len()).rev() {
            order.swap(i, random(i + 1));
        }
        for i in (1..quads.len()).rev() {
            quads.swap(i, random(i + 1));
        }
        for quad in &mut quads {
            *quad = quad.map(|v| order[v as usize]);
            quad.rotate_left(random(4));
            if mirrored {
                quad.reverse();
            }
        }
        let surface = hexfill_mesh::QuadSurface::try_new(n as usize, &quads).unwrap();
        let mut out = Cavity::from_surface(&surface).unwrap().0;
        for [a, b] in cavity.blocked_list() {
            out.block(order[usize::from(a)] as u8, order[usize::from(b)] as u8);
        }
        out
    }

    #[test]
    fn relabelling_and_reflection_change_nothing_and_codes_decode() {
        let mut level = vec![Cavity::cube()];
        let mut canonical = Canonical::new();
        for depth in 0..4 {
            let mut codes = HashSet::new();
            let mut after = Vec::new();
            for cavity in &level {
                for placement in legal_flips(cavity, 22) {
                    let child = apply(cavity, &placement).0;
                    canonical.compute(&child);
                    let code = canonical.code().to_vec();
                    let image = canonical.blocked_image(&child).0;
                    for seed in 0..4 {
                        let other = shuffled(&child, seed, seed % 2 == 1);
                        let mut again = Canonical::new();
                        again.compute(&other);
                        assert_eq!(again.code(), code);
                        assert_eq!(again.blocked_image(&other).0, image);
                        assert_eq!(again.flags().len(), canonical.flags().len());
                    }
                    let decoded = decode(&code).unwrap();
                    decoded.debug_check();
                    let mut again = Canonical::new();
                    again.compute(&decoded);
                    assert_eq!(again.code(), code);
                    // The vertices of the decoded sphere carry the canonical numbers.
                    let image_again = relabel(
                        &child.blocked,
                        child.n_vertices(),
                        &Canonical::vertex_numbers(&child, canonical.flags()[0]),
                    );
                    let mut with_blocked = decoded;
                    with_blocked.blocked = image_again;
                    with_blocked.debug_check();
                    if codes.insert((code, image)) {
                        after.push(child);
                    }
                }
            }
            after.truncate(if depth < 2 { 1000 } else { 200 });
            level = after;
        }
        canonical.compute(&Cavity::cube());
        assert_eq!(canonical.flags().len(), 48);
    }

    #[test]
    fn no_bytes_make_decode_panic() {
        let mut canonical = Canonical::new();
        canonical.compute(&Cavity::cube());
        let good = canonical.code().to_vec();
        for i in 0..good.len() {
            for byte in 0..=255 {
                let mut bad = good.clone();
                bad[i] = byte;
                if let Some(cavity) = decode(&bad) {
                    cavity.debug_check();
                }
            }
            assert!(decode(&good[..i]).is_none());
        }
    }
}
