//! The boundary of a complex: its quads, how they meet along edges, chords, keys, components and genera.
//!
//! Two boundary quads meet along an edge when the fan of cubes round the edge that begins at one ends at the other.
//! So an edge that the solid touches twice (allowed by rule `strict`) is two edges of the boundary, and the boundary
//! is always a closed surface; vertices are split in the same way when genera are counted.
//!
//! The *key* (Weill) is the multiset of pairs of the lengths of the two chords through each quad, where a chord's
//! length is the number of distinct quads it passes.
//!
//! Source: ours; keys: Weill.

use crate::complex::{Complex, FREE, MAX_CUBES};
use crate::frames::TURN;
use hexfill_mesh::cube::FACETS;
use hexfill_mesh::{Key, QuadSurface, SurfaceError};

/// Most boundary quads: a tree of 12 cubes has 6 * 12 - 2 * 11 = 50.
pub(crate) const MAX_QUADS: usize = 64;

/// The boundary quads and how they meet. Quads are in the order of (cube, side).
#[derive(Clone, Copy, Debug)]
pub struct Boundary {
    pub(crate) n_quads: u8,
    /// Cube and side of each quad.
    pub(crate) owner: [(u8, u8); MAX_QUADS],
    /// Corners, outward.
    pub(crate) corners: [[u8; 4]; MAX_QUADS],
    /// Per edge `k` (from corner `k` to corner `k + 1`): `4 * quad + edge` on the other side.
    pub(crate) partner: [[u8; 4]; MAX_QUADS],
}

/// Where a corner stands in a side's list of corners.
const PLACE: [[u8; 8]; 6] = {
    let mut out = [[0u8; 8]; 6];
    let mut f = 0;
    while f < 6 {
        let mut k = 0;
        while k < 4 {
            out[f][FACETS[f][k]] = k as u8;
            k += 1;
        }
        f += 1;
    }
    out
};

impl Boundary {
    /// The boundary of a complex.
    ///
    /// # Example
    /// ```
    /// use hexfill_enumerate::{Boundary, Complex};
    ///
    /// let two = Complex::from_cubes(&[[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11]])?;
    /// let boundary = Boundary::of(&two);
    /// assert_eq!((boundary.n_quads(), boundary.n_chords()), (10, 4));
    /// assert_eq!(boundary.key().to_string(), "8x[4,6] 2x[6,6]");
    /// # Ok::<(), hexfill_enumerate::EnumerateError>(())
    /// ```
    pub fn of(c: &Complex) -> Self {
        let mut b = Self {
            n_quads: 0,
            owner: [(0, 0); MAX_QUADS],
            corners: [[0; 4]; MAX_QUADS],
            partner: [[u8::MAX; 4]; MAX_QUADS],
        };
        let mut index = [[0u8; 6]; MAX_CUBES];
        let mut n = 0;
        for a in 0..c.n_cubes() {
            for f in 0..6 {
                if c.next[a][f] == FREE {
                    index[a][f] = n as u8;
                    b.owner[n & (MAX_QUADS - 1)] = (a as u8, f as u8);
                    b.corners[n & (MAX_QUADS - 1)] = FACETS[f].map(|i| c.cubes[a][i]);
                    n += 1;
                }
            }
        }
        b.n_quads = n as u8;
        for q in 0..n {
            for k in 0..4 {
                if b.partner[q][k] != u8::MAX {
                    continue;
                }
                let (a, f) = b.owner[q];
                let mut a = a as usize % MAX_CUBES;
                let (mut g, mut l) = TURN[f as usize][k];
                // Through the fan of cubes round the edge to the other boundary quad of the same fan: an edge that
                // the solid touches twice is two edges here.
                while c.next[a][g as usize % 6] != FREE {
                    let side = g as usize % 6;
                    let (p, r) = (FACETS[side][l as usize & 3], FACETS[side][(l as usize + 1) & 3]);
                    let (p, r) = (c.glued_corner(a, side, p), c.glued_corner(a, side, r));
                    let other = c.opposite_side(a, side) % 6;
                    let (p, r) = (PLACE[other][p & 7], PLACE[other][r & 7]);
                    // The edge starts at whichever end comes first in the neighbour's cyclic order.
                    let start = if (p + 1) & 3 == r { p } else { r };
                    a = c.next[a][side] as usize % MAX_CUBES;
                    (g, l) = TURN[other][start as usize & 3];
                }
                let far = index[a][g as usize % 6];
                b.partner[q][k] = 4 * far + l;
                b.partner[far as usize & (MAX_QUADS - 1)][l as usize & 3] = (4 * q + k) as u8;
            }
        }
        b
    }

    /// Number of quads.
    pub fn n_quads(&self) -> usize {
        self.n_quads as usize
    }

    /// The corners of the quads, outward.
    pub fn quads(&self) -> &[[u8; 4]] {
        &self.corners[..self.n_quads()]
    }

    /// The cube and the side of each quad.
    pub fn owners(&self) -> &[(u8, u8)] {
        &self.owner[..self.n_quads()]
    }

    /// The chords: their number, and per quad the lengths of the two chords through it, shorter first.
    pub fn chords(&self) -> (usize, [[u8; 2]; MAX_QUADS]) {
        let n = self.n_quads();
        let mut chord = [[u8::MAX; 2]; MAX_QUADS];
        let mut length = [0u8; 2 * MAX_QUADS];
        let mut count = 0;
        for q in 0..n {
            for d in 0..2 {
                if chord[q][d] != u8::MAX {
                    continue;
                }
                let (mut at, mut slot) = (q, d);
                while chord[at & (MAX_QUADS - 1)][slot & 1] == u8::MAX {
                    let strips = &mut chord[at & (MAX_QUADS - 1)];
                    // A quad that the chord crosses itself in counts once.
                    length[count] += u8::from(strips[slot & 1 ^ 1] != count as u8);
                    strips[slot & 1] = count as u8;
                    let next = self.partner[at & (MAX_QUADS - 1)][slot & 3 ^ 2];
                    (at, slot) = (next as usize / 4, next as usize & 3);
                }
                count += 1;
            }
        }
        let mut lengths = [[0u8; 2]; MAX_QUADS];
        for (pair, strips) in lengths.iter_mut().zip(&chord[..n]) {
            let [a, b] = strips.map(|s| length[s as usize & (2 * MAX_QUADS - 1)]);
            *pair = [a.min(b), a.max(b)];
        }
        (count, lengths)
    }

    /// Number of chords.
    pub fn n_chords(&self) -> usize {
        self.chords().0
    }

    /// Per pair of chord lengths (shorter first) the number of quads, ascending: the key as numbers.
    fn key_counts(&self) -> Vec<([usize; 2], usize)> {
        let mut pairs: Vec<[u8; 2]> = self.chords().1[..self.n_quads()].to_vec();
        pairs.sort_unstable();
        pairs.chunk_by(|a, b| a == b).map(|run| (run[0].map(usize::from), run.len())).collect()
    }

    /// The key of the boundary; empty for a closed complex.
    pub fn key(&self) -> Key {
        let items: Vec<String> = self.key_counts().iter().map(|([a, b], n)| format!("{n}x[{a},{b}]")).collect();
        items.join(" ").parse().unwrap_or_default()
    }

    /// Whether the boundary has this key.
    pub fn has_key(&self, key: &Key) -> bool {
        key.n_quads() == self.n_quads() && key.counts().eq(self.key_counts())
    }

    /// The boundary as a quad surface, with the complex's vertex names.
    ///
    /// # Errors
    /// The mesh crate's [`SurfaceError`] if it is empty or touches itself in an edge or a vertex.
    pub fn to_surface(&self) -> Result<QuadSurface, SurfaceError> {
        let quads: Vec<[u32; 4]> = self.quads().iter().map(|q| q.map(u32::from)).collect();
        QuadSurface::try_new(64, &quads)
    }

    /// Euler characteristic of each component of the boundary surface (vertices split), ascending.
    pub fn components(&self) -> Components {
        let n = self.n_quads();
        let mut component = [u8::MAX; MAX_QUADS];
        let mut euler = [0i8; MAX_CUBES];
        let mut count = 0;
        for seed in 0..n {
            if component[seed] != u8::MAX {
                continue;
            }
            component[seed] = count as u8;
            let mut todo = 1u64 << seed;
            while todo != 0 {
                let q = todo.trailing_zeros() as usize;
                todo &= todo - 1;
                // Two edges a quad: V - E + F = V - F.
                euler[count % MAX_CUBES] -= 1;
                for p in self.partner[q] {
                    let other = (p as usize / 4) & (MAX_QUADS - 1);
                    if component[other] == u8::MAX {
                        component[other] = count as u8;
                        todo |= 1 << other;
                    }
                }
            }
            count += 1;
        }
        // A vertex counts once for each fan of quads: one that the boundary passes twice is two.
        let mut seen = [0u8; MAX_QUADS];
        for q in 0..n {
            for k in 0..4 {
                if seen[q] >> k & 1 == 1 {
                    continue;
                }
                // Walk round one fan of boundary quads at this corner.
                euler[component[q] as usize % MAX_CUBES] += 1;
                let v = self.corners[q][k];
                let (mut at, mut corner, mut edge) = (q, k, k);
                while seen[at & (MAX_QUADS - 1)] >> corner & 1 == 0 {
                    seen[at & (MAX_QUADS - 1)] |= 1 << corner;
                    let p = self.partner[at & (MAX_QUADS - 1)][edge & 3] as usize;
                    let (next, e) = ((p / 4) & (MAX_QUADS - 1), p & 3);
                    at = next;
                    if self.corners[next][e] == v {
                        corner = e;
                        edge = (e + 3) & 3;
                    } else {
                        corner = (e + 1) & 3;
                        edge = corner;
                    }
                }
            }
        }
        let mut out = Components { count: count as u8, euler };
        out.euler[..count.min(MAX_CUBES)].sort_unstable_by(|a, b| b.cmp(a));
        out
    }
}

/// Euler characteristics of the components of a boundary, descending (spheres first).
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Components {
    count: u8,
    euler: [i8; MAX_CUBES],
}

impl Components {
    /// Euler characteristic of each component, descending.
    pub fn euler(&self) -> &[i8] {
        &self.euler[..self.count as usize]
    }

    /// Whether the boundary is one sphere.
    pub fn is_one_sphere(&self) -> bool {
        self.euler() == [2]
    }

    /// The genera as text, spheres first: "0", "0+1", "closed" without boundary. A non-orientable component of odd
    /// Euler characteristic x prints as "(x)".
    pub fn text(&self) -> String {
        if self.count == 0 {
            return "closed".into();
        }
        let parts: Vec<String> = self
            .euler()
            .iter()
            .map(|&x| if x % 2 == 0 { ((2 - x) / 2).to_string() } else { format!("({x})") })
            .collect();
        parts.join("+")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cube_has_three_chords_of_four() {
        let b = Boundary::of(&Complex::cube());
        assert_eq!((b.n_quads(), b.n_chords()), (6, 3));
        assert_eq!(b.key().to_string(), "6x[4,4]");
        assert!(b.components().is_one_sphere());
        assert_eq!("6x[4,4]".parse::<Key>().unwrap(), b.key());
        assert!(b.has_key(&b.key()) && !b.has_key(&"6x[4,5]".parse().unwrap()));
    }

    #[test]
    fn a_ring_of_three_is_a_torus() {
        let ring = [[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11], [8, 9, 10, 11, 0, 1, 2, 3]];
        let b = Boundary::of(&Complex::from_cubes(&ring).unwrap());
        assert_eq!((b.n_quads(), b.n_chords(), b.components().text().as_str()), (12, 7, "1"));
    }

    #[test]
    fn two_ways_to_the_key_agree() {
        let five = [
            [0, 1, 2, 3, 4, 5, 6, 7],
            [0, 1, 5, 4, 8, 9, 10, 11],
            [1, 2, 6, 5, 12, 13, 14, 15],
            [4, 0, 8, 11, 16, 17, 14, 13],
            [2, 6, 14, 13, 18, 19, 8, 11],
        ];
        let c = Complex::from_cubes(&five).unwrap();
        let b = Boundary::of(&c);
        let surface = b.to_surface().unwrap();
        assert_eq!(hexfill_mesh::key(&surface), b.key());
        assert!(b.has_key(&b.key()));
        assert_eq!(b.components().euler(), [surface.euler_characteristic() as i8]);
    }
}
