//! [`Cavity`]: a sphere of quads with its pair table, small enough to live in bytes.
//!
//! Seen from a growing ball it is the ball's outside; seen from a surface to fill it is what is left to fill.
//! Both views use the same flips, since a hex glued on either side covers a disk of quads and shows the rest of
//! its facets. Invariants: `twin[twin[d]] = d`; darts are `4 * quad + side`; vertices are `0..n + 2`, all used;
//! `blocked` is symmetric and disjoint from the edges and diagonals of the quads.
//!
//! Limit: [`MAX_QUADS`] quads, so that darts fit in a `u8` and rows of the pair table in a `u64`.
//!
//! Source: ours.

use hexfill_mesh::{Dart, QuadSurface};

/// Most quads of a cavity: 248 darts in a `u8`, 64 vertices in a `u64`.
pub const MAX_QUADS: usize = 62;
/// Most vertices of a cavity.
pub const MAX_VERTICES: usize = MAX_QUADS + 2;
pub(crate) const MAX_DARTS: usize = 4 * MAX_QUADS;

/// A set of vertex pairs as one row of bits per vertex (symmetric).
pub type Pairs = [u64; MAX_VERTICES];

/// A quad sphere with at most [`MAX_QUADS`] quads and the vertex pairs that are blocked by what lies behind it.
#[derive(Clone)]
pub struct Cavity {
    pub(crate) n_quads: u8,
    pub(crate) n_vertices: u8,
    pub(crate) twin: [u8; MAX_DARTS],
    pub(crate) origin: [u8; MAX_DARTS],
    pub(crate) blocked: Pairs,
}

impl std::fmt::Debug for Cavity {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Cavity").field("quads", &self.quads()).field("blocked", &self.blocked_list()).finish()
    }
}

#[inline]
pub(crate) const fn next(d: u8) -> u8 {
    (d & !3) | ((d + 1) & 3)
}

#[inline]
pub(crate) const fn turn(d: u8, by: u8) -> u8 {
    (d & !3) | (d.wrapping_add(by) & 3)
}

impl Cavity {
    pub(crate) const fn empty() -> Self {
        Self { n_quads: 0, n_vertices: 0, twin: [0; MAX_DARTS], origin: [0; MAX_DARTS], blocked: [0; MAX_VERTICES] }
    }

    /// The boundary of one cube, with its body diagonals blocked: the start of every shelling.
    pub fn cube() -> Self {
        let quads = hexfill_mesh::cube::FACETS.map(|f| f.map(|v| v as u32));
        let surface = QuadSurface::try_new(8, &quads).expect("the cube's facets close");
        let mut cavity = Self::from_surface(&surface).expect("the cube is a small sphere").0;
        for [i, j] in hexfill_mesh::cube::BODY_DIAGONALS {
            // Vertex ids of a surface whose vertices are all used are kept.
            cavity.block(i as u8, j as u8);
        }
        cavity
    }

    /// A cavity without blocked pairs from one sphere, and the surface vertex of each cavity vertex (ascending).
    /// `None` if the surface is not a sphere of at most [`MAX_QUADS`] quads.
    pub fn from_surface(surface: &QuadSurface) -> Option<(Self, Vec<u32>)> {
        if !surface.is_sphere() || surface.n_quads() > MAX_QUADS {
            return None;
        }
        let mut old: Vec<u32> = surface.quads().iter().flatten().map(|v| v.0).collect();
        old.sort_unstable();
        old.dedup();
        let mut cavity = Self::empty();
        cavity.n_quads = surface.n_quads() as u8;
        cavity.n_vertices = old.len() as u8;
        for d in surface.darts() {
            cavity.twin[d.index()] = surface.twin(d).0 as u8;
            cavity.origin[d.index()] = old.binary_search(&surface.origin(d).0).expect("collected above") as u8;
        }
        Some((cavity, old))
    }

    /// Number of quads.
    pub fn n_quads(&self) -> usize {
        usize::from(self.n_quads)
    }

    /// Number of vertices: `n_quads + 2`.
    pub fn n_vertices(&self) -> usize {
        usize::from(self.n_vertices)
    }

    /// The vertices of each quad.
    pub fn quads(&self) -> Vec<[u8; 4]> {
        self.origin[..4 * self.n_quads()].chunks_exact(4).map(|c| [c[0], c[1], c[2], c[3]]).collect()
    }

    /// The cavity as a surface with the same vertex and quad numbers.
    pub fn to_surface(&self) -> QuadSurface {
        let quads: Vec<[u32; 4]> = self.quads().iter().map(|q| q.map(u32::from)).collect();
        QuadSurface::try_new(self.n_vertices(), &quads).expect("a cavity is a sphere")
    }

    /// The blocked pairs, smaller vertex first, ascending.
    pub fn blocked_list(&self) -> Vec<[u8; 2]> {
        let mut list = Vec::new();
        for a in 0..self.n_vertices {
            let mut row = self.blocked[usize::from(a)] >> a >> 1 << 1 << a;
            while row != 0 {
                list.push([a, row.trailing_zeros() as u8]);
                row &= row - 1;
            }
        }
        list
    }

    /// Number of blocked pairs.
    pub fn n_blocked(&self) -> u32 {
        self.blocked[..self.n_vertices()].iter().map(|r| r.count_ones()).sum::<u32>() / 2
    }

    /// Blocks a pair of vertices.
    #[inline]
    pub fn block(&mut self, a: u8, b: u8) {
        self.blocked[usize::from(a)] |= 1 << b;
        self.blocked[usize::from(b)] |= 1 << a;
    }

    /// Pairs that are edges or diagonals of the quads.
    pub(crate) fn surface_pairs(&self) -> Pairs {
        let mut pairs = [0; MAX_VERTICES];
        for q in self.origin[..4 * self.n_quads()].chunks_exact(4) {
            let all = 1u64 << q[0] | 1 << q[1] | 1 << q[2] | 1 << q[3];
            for &v in q {
                pairs[usize::from(v)] |= all & !(1 << v);
            }
        }
        pairs
    }

    /// Pairs of any kind: what a new hex may not use again.
    pub(crate) fn marked(&self) -> Pairs {
        let mut pairs = self.surface_pairs();
        for (row, blocked) in pairs.iter_mut().zip(&self.blocked) {
            *row |= blocked;
        }
        pairs
    }

    /// Number of quads round each vertex.
    pub(crate) fn degrees(&self) -> [u8; MAX_VERTICES] {
        let mut degrees = [0; MAX_VERTICES];
        for &v in &self.origin[..4 * self.n_quads()] {
            degrees[usize::from(v)] += 1;
        }
        degrees
    }

    /// Checks the invariants; for tests.
    ///
    /// # Panics
    /// If one is broken.
    pub fn debug_check(&self) {
        let surface = self.to_surface();
        assert!(surface.is_sphere());
        assert_eq!(self.n_vertices, self.n_quads + 2);
        for d in surface.darts() {
            assert_eq!(surface.twin(d), Dart(u32::from(self.twin[d.index()])));
        }
        let pairs = self.surface_pairs();
        for (a, row) in pairs.iter().enumerate().take(self.n_vertices()) {
            assert_eq!(self.blocked[a] & row, 0, "blocked pair of v{a} lies on the surface");
            assert_eq!(self.blocked[a].checked_shr(u32::from(self.n_vertices)).unwrap_or(0), 0);
            for b in 0..self.n_vertices() {
                assert_eq!(self.blocked[a] >> b & 1, self.blocked[b] >> a & 1);
            }
        }
    }
}
