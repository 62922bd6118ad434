//! [`Complex`]: a small hex mesh in a few hundred bytes, copied and changed without allocation.
//!
//! Vertices are bytes below 64, so that a cube's vertex set is one machine word and an intersection of two
//! cubes is an `and`. Invariant: two sides with the same four vertices are glued to each other; cubes are
//! connected through glued sides. When the complex was made orientable, every cube is positively oriented
//! (outward sides run against each other along the common quad), which the enumerators preserve.
//!
//! Source: ours.

use crate::error::EnumerateError;
use crate::frames::{ACROSS, MIRROR, SIDE};
use hexfill_mesh::HexMesh;
use hexfill_mesh::cube::FACETS;

/// Most cubes a complex can have: 12 cubes glued one after another have 8 + 11 * 4 = 52 vertices.
pub const MAX_CUBES: usize = 12;
/// Number of bits in a vertex set.
pub(crate) const MAX_VERTICES: usize = 64;
/// No neighbour.
pub(crate) const FREE: u8 = u8::MAX;

/// A hex mesh of at most [`MAX_CUBES`] cubes. See the module page.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Complex {
    pub(crate) n_cubes: u8,
    pub(crate) n_vertices: u8,
    /// Corners in VTK order.
    pub(crate) cubes: [[u8; 8]; MAX_CUBES],
    /// Vertex set of each cube.
    pub(crate) sets: [u64; MAX_CUBES],
    /// Per side: the cube on the other side, or [`FREE`].
    pub(crate) next: [[u8; 6]; MAX_CUBES],
    /// Per glued side: how a frame is carried to the neighbour (see [`crate::frames::ACROSS`]).
    pub(crate) across: [[u8; 6]; MAX_CUBES],
}

/// The vertex set of a cube.
#[inline]
pub(crate) fn set_of(corners: &[u8; 8]) -> u64 {
    corners.iter().fold(0, |set, &v| set | 1 << (v & 63))
}

/// The vertex set of a side of a cube.
#[inline]
pub(crate) fn side_set_of(corners: &[u8; 8], side: usize) -> u64 {
    FACETS[side].iter().fold(0, |set, &i| set | 1 << (corners[i] & 63))
}

impl Complex {
    /// One cube.
    pub fn cube() -> Self {
        let mut c = Self {
            n_cubes: 1,
            n_vertices: 8,
            cubes: [[0; 8]; MAX_CUBES],
            sets: [0; MAX_CUBES],
            next: [[FREE; 6]; MAX_CUBES],
            across: [[0; 6]; MAX_CUBES],
        };
        c.cubes[0] = [0, 1, 2, 3, 4, 5, 6, 7];
        c.sets[0] = 0xff;
        c
    }

    /// A complex from cubes given as vertex indices in VTK order. Sides with equal vertex sets are glued.
    ///
    /// # Errors
    /// [`EnumerateError::BadComplex`] if there are more than [`MAX_CUBES`] cubes or 64 vertices, a cube repeats a
    /// vertex, a quad is in three cubes or in two in different cyclic orders, or the cubes are not connected.
    pub fn from_cubes(cubes: &[[u8; 8]]) -> Result<Self, EnumerateError> {
        let bad = |why: String| Err(EnumerateError::BadComplex { why });
        if cubes.is_empty() || cubes.len() > MAX_CUBES {
            return bad(format!("{} cubes given, 1 to {MAX_CUBES} are possible", cubes.len()));
        }
        let mut c = Self::cube();
        c.n_cubes = cubes.len() as u8;
        let mut top = 0;
        for (i, corners) in cubes.iter().enumerate() {
            if let Some(v) = corners.iter().find(|&&v| v as usize >= MAX_VERTICES) {
                return bad(format!("vertex index {v} given, the limit is {MAX_VERTICES}"));
            }
            c.cubes[i] = *corners;
            c.sets[i] = set_of(corners);
            if c.sets[i].count_ones() != 8 {
                return bad(format!("cube h{i} repeats a vertex"));
            }
            top = top.max(*corners.iter().max().expect("eight corners"));
        }
        c.n_vertices = top + 1;
        c.next = [[FREE; 6]; MAX_CUBES];
        for a in 0..cubes.len() {
            for b in 0..a {
                // Fewer than four common vertices hold no side.
                let common = c.sets[a] & c.sets[b];
                if common.count_ones() < 4 {
                    continue;
                }
                for fa in 0..6 {
                    let set = side_set_of(&c.cubes[a], fa);
                    if set & common != set {
                        continue;
                    }
                    if let Some(fb) = (0..6).find(|&fb| side_set_of(&c.cubes[b], fb) == set) {
                        let taken = c.next[a][fa] != FREE || c.next[b][fb] != FREE;
                        if taken || !c.glue(a, fa, b, fb) {
                            return bad(format!("side {fa} of h{a} and side {fb} of h{b} cannot be glued"));
                        }
                    }
                }
            }
        }
        if c.reachable(0, u16::MAX) != c.all() {
            return bad("the cubes are not connected through quads".into());
        }
        Ok(c)
    }

    /// Number of cubes.
    pub fn n_cubes(&self) -> usize {
        self.n_cubes as usize
    }

    /// Number of vertex ids (all used in complexes made by the enumerators).
    pub fn n_vertices(&self) -> usize {
        self.n_vertices as usize
    }

    /// The corners of the cubes, VTK order.
    pub fn cubes(&self) -> &[[u8; 8]] {
        &self.cubes[..self.n_cubes()]
    }

    /// The corners of the cubes as the mesh crate takes them.
    pub fn cubes_wide(&self) -> Vec<[u32; 8]> {
        self.cubes().iter().map(|c| c.map(u32::from)).collect()
    }

    /// A small mesh as a complex, vertices renumbered in order of appearance.
    ///
    /// # Errors
    /// As [`from_cubes`](Self::from_cubes).
    pub fn from_hex_mesh(mesh: &HexMesh) -> Result<Self, EnumerateError> {
        let mut names = std::collections::HashMap::new();
        let cubes: Vec<[u8; 8]> = mesh
            .hexes()
            .iter()
            .take(MAX_CUBES + 1)
            .map(|hex| {
                hex.map(|v| {
                    let next = names.len().min(u8::MAX as usize) as u8;
                    *names.entry(v).or_insert(next)
                })
            })
            .collect();
        Self::from_cubes(&cubes)
    }

    /// The same as a [`HexMesh`].
    ///
    /// # Errors
    /// [`EnumerateError::Mesh`] if a quad is in three cubes, which no enumerator makes.
    pub fn to_hex_mesh(&self) -> Result<HexMesh, EnumerateError> {
        Ok(HexMesh::try_new(self.n_vertices(), &self.cubes_wide())?)
    }

    /// Glues side `fa` of cube `a` to side `fb` of cube `b`; `false` if the cyclic orders differ.
    pub(crate) fn glue(&mut self, a: usize, fa: usize, b: usize, fb: usize) -> bool {
        let qa = FACETS[fa].map(|i| self.cubes[a][i]);
        let qb = FACETS[fb].map(|i| self.cubes[b][i]);
        let Some(j) = qb.iter().position(|&v| v == qa[0]) else { return false };
        let reversed = if qb[(j + 3) % 4] == qa[1] {
            1
        } else if qb[(j + 1) % 4] == qa[1] {
            0
        } else {
            return false;
        };
        if qb[(j + 2) % 4] != qa[2] {
            return false;
        }
        let i = if reversed == 1 { j } else { (4 - j) % 4 };
        self.next[a][fa] = b as u8;
        self.next[b][fb] = a as u8;
        self.across[a][fa] = ACROSS[fa][fb][j][reversed];
        self.across[b][fb] = ACROSS[fb][fa][i][reversed];
        true
    }

    /// The side of the neighbour glued to side `f` of cube `a`.
    #[inline]
    pub(crate) fn opposite_side(&self, a: usize, f: usize) -> usize {
        SIDE[self.across[a][f] as usize % 48][f ^ 1] as usize
    }

    /// The corner of the neighbour across side `f` of cube `a` that is glued to corner `i` of `a`.
    #[inline]
    pub(crate) fn glued_corner(&self, a: usize, f: usize, i: usize) -> usize {
        crate::frames::FRAMES[self.across[a][f] as usize % 48][MIRROR[f / 2][i & 7] as usize] as usize
    }

    /// Whether no side is free.
    #[inline]
    pub fn is_closed(&self) -> bool {
        self.next[..self.n_cubes()].iter().all(|sides| !sides.contains(&FREE))
    }

    /// Bit set of all cubes.
    #[inline]
    pub(crate) fn all(&self) -> u16 {
        (1u16 << self.n_cubes) - 1
    }

    /// Number of glued sides of a cube.
    #[inline]
    pub(crate) fn n_glued(&self, a: usize) -> u8 {
        self.next[a].iter().map(|&b| u8::from(b != FREE)).sum()
    }

    /// Per cube, the bit set of its neighbours.
    #[inline]
    pub(crate) fn adjacency(&self) -> [u16; MAX_CUBES] {
        let mut out = [0u16; MAX_CUBES];
        for (slot, next) in out.iter_mut().zip(&self.next[..self.n_cubes()]) {
            for &b in next {
                if b != FREE {
                    *slot |= 1 << (b & 15);
                }
            }
        }
        out
    }

    /// The cubes reachable from `start` through glued sides inside `allowed`.
    pub(crate) fn reachable(&self, start: usize, allowed: u16) -> u16 {
        reach(&self.adjacency(), start, allowed)
    }

    /// Bit set of the cubes whose removal leaves the others connected (all of them for one cube).
    pub(crate) fn non_cut(&self) -> u16 {
        let adjacency = self.adjacency();
        let all = self.all();
        if self.n_cubes <= 2 {
            return all;
        }
        let mut out = 0;
        for a in 0..self.n_cubes() {
            let rest = all & !(1 << a);
            // A cube with one neighbour never cuts.
            if adjacency[a].count_ones() == 1 || reach(&adjacency, rest.trailing_zeros() as usize, rest) == rest {
                out |= 1 << a;
            }
        }
        out
    }

    /// Whether all cubes can be oriented so that neighbours run against each other along their common quad.
    pub fn is_orientable(&self) -> bool {
        let mut sign = [0i8; MAX_CUBES];
        sign[0] = 1;
        let mut stack = vec![0usize];
        while let Some(a) = stack.pop() {
            for f in 0..6 {
                let b = self.next[a][f];
                if b == FREE {
                    continue;
                }
                // `across` is a rotation for exactly the consistent gluings.
                let wanted = if self.across[a][f] < 24 { sign[a] } else { -sign[a] };
                let slot = &mut sign[b as usize];
                if *slot == 0 {
                    *slot = wanted;
                    stack.push(b as usize);
                } else if *slot != wanted {
                    return false;
                }
            }
        }
        true
    }

    /// The complex without cube `a`: the last cube takes its place, vertices keep their names (some may be unused), and
    /// all gluings and identifications of the other cubes stay as they are. The rest may be disconnected.
    pub(crate) fn removed(&self, a: usize) -> Self {
        let mut out = *self;
        let last = self.n_cubes() - 1;
        for f in 0..6 {
            let b = self.next[a][f];
            if b != FREE {
                out.next[b as usize % MAX_CUBES][self.opposite_side(a, f) % 6] = FREE;
            }
        }
        // The order of cubes is no part of a complex, so the gap is closed with the last one and one cube is renamed.
        out.cubes[a] = out.cubes[last];
        out.sets[a] = out.sets[last];
        out.next[a] = out.next[last];
        out.across[a] = out.across[last];
        if a != last {
            for f in 0..6 {
                let b = out.next[a][f];
                if b != FREE {
                    let side = out.opposite_side(a, f) % 6;
                    out.next[b as usize % MAX_CUBES][side] = a as u8;
                }
            }
        }
        out.next[last] = [FREE; 6];
        out.n_cubes -= 1;
        out
    }

    /// Whether all cubes are positively oriented as they stand.
    #[inline]
    pub(crate) fn is_oriented(&self) -> bool {
        (0..self.n_cubes()).all(|a| (0..6).all(|f| self.next[a][f] == FREE || self.across[a][f] < 24))
    }
}

/// The nodes reachable from `start` inside `allowed`.
#[inline]
pub(crate) fn reach(adjacency: &[u16; MAX_CUBES], start: usize, allowed: u16) -> u16 {
    let mut seen = 1u16 << (start & 15);
    let mut todo = seen;
    while todo != 0 {
        let a = todo.trailing_zeros() as usize;
        todo &= todo - 1;
        let new = adjacency[a % MAX_CUBES] & allowed & !seen;
        seen |= new;
        todo |= new;
    }
    seen
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_cubes_are_glued_both_ways() {
        let c = Complex::from_cubes(&[[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11]]).unwrap();
        assert_eq!((c.next[0][5], c.next[1][4]), (1, 0));
        assert_eq!((c.opposite_side(0, 5), c.opposite_side(1, 4)), (4, 5));
        for i in 4..8 {
            assert_eq!(c.cubes[1][c.glued_corner(0, 5, i)], c.cubes[0][i]);
        }
        for i in 0..4 {
            assert_eq!(c.cubes[0][c.glued_corner(1, 4, i)], c.cubes[1][i]);
        }
        assert!(c.is_orientable());
        assert_eq!(c.non_cut(), 0b11);
        for a in 0..2 {
            assert_eq!(crate::canonical(&c.removed(a)).code, crate::canonical(&Complex::cube()).code);
        }
    }

    #[test]
    fn impossible_complexes_are_refused() {
        let cube = [0, 1, 2, 3, 4, 5, 6, 7];
        assert!(Complex::from_cubes(&[]).is_err());
        assert!(Complex::from_cubes(&[[0, 1, 2, 3, 4, 5, 6, 6]]).is_err());
        assert!(Complex::from_cubes(&[[0, 1, 2, 3, 4, 5, 6, 64]]).is_err());
        assert!(Complex::from_cubes(&[cube, [4, 6, 5, 7, 8, 9, 10, 11]]).is_err());
        assert!(Complex::from_cubes(&[cube, [8, 9, 10, 11, 12, 13, 14, 15]]).is_err());
    }
}
