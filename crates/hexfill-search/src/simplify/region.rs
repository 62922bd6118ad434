//! [`Region`]: a ball of hexes of a mesh that grows hex by hex.
//!
//! A hex may join if what it shares with the ball is exactly the closure of the quads they share, and those form a disk: then
//! ball and hex together are a ball again (two balls glued along a disk). The test is local: the six quads as a mask, the
//! corners that no shared quad has must not be in the ball, and edges between its other corners that no shared quad has must
//! not be edges of the ball's boundary. Every region is therefore shellable, in the order of its hexes.
//!
//! Source: Verhetsel et al. 2018 (balls grown in the mesh).

use crate::cavity::{Cavity, MAX_QUADS};
use crate::simplify::live::{LiveMesh, NONE};
use hexfill_mesh::cube::{EDGES, FACETS};
use std::sync::LazyLock;

/// What a set of facets of a cube, as a mask, looks like.
#[derive(Clone, Default)]
struct Mask {
    /// Whether the facets form a disk that is not the whole sphere.
    is_disk: bool,
    /// Corners of none of the facets.
    free_corners: Vec<usize>,
    /// Edges of none of the facets whose ends are corners of some.
    open_edges: Vec<[usize; 2]>,
}

static MASKS: LazyLock<Vec<Mask>> = LazyLock::new(|| {
    (0..64usize)
        .map(|mask| {
            let chosen: Vec<usize> = (0..6).filter(|f| mask >> f & 1 == 1).collect();
            let has = |k: usize| chosen.iter().any(|&f| FACETS[f].contains(&k));
            let has_edge = |e: [usize; 2]| chosen.iter().any(|&f| e.iter().all(|k| FACETS[f].contains(k)));
            // Connected and with a connected, non-empty rest: a pair of opposite facets fails on one of the two sides.
            let is_disk = match chosen.len() {
                1 | 5 => true,
                2 => chosen[0] ^ 1 != chosen[1],
                3 => true,
                4 => {
                    let rest: Vec<usize> = (0..6).filter(|f| mask >> f & 1 == 0).collect();
                    rest[0] ^ 1 != rest[1]
                }
                _ => false,
            };
            Mask {
                is_disk,
                free_corners: (0..8).filter(|&k| !has(k)).collect(),
                open_edges: EDGES.into_iter().filter(|&e| !has_edge(e) && has(e[0]) && has(e[1])).collect(),
            }
        })
        .collect()
});

/// A hex that may join the region.
#[derive(Clone, Copy)]
pub(crate) struct Candidate {
    pub hex: u32,
    /// Quads it shares with the region.
    pub shared: u32,
}

/// A growing ball. One is used again and again; marks are numbered, so that starting anew costs nothing.
pub(crate) struct Region {
    hexes: Vec<u32>,
    /// Boundary facets, each of a hex of the region.
    boundary: Vec<u32>,
    /// Per hex of the mesh: the mark of the last region it was in.
    hex_mark: Vec<u32>,
    /// Per vertex of the mesh: the mark of the last region that had it.
    vertex_mark: Vec<u32>,
    /// Per vertex: its number on the cavity, if `local_mark` is current.
    local: Vec<u8>,
    local_mark: Vec<u32>,
    mark: u32,
    local_at: u32,
    candidates: Vec<Candidate>,
}

impl Region {
    pub(crate) fn new() -> Self {
        Self {
            hexes: Vec::new(),
            boundary: Vec::new(),
            hex_mark: Vec::new(),
            vertex_mark: Vec::new(),
            local: Vec::new(),
            local_mark: Vec::new(),
            mark: 0,
            local_at: 0,
            candidates: Vec::new(),
        }
    }

    /// The hexes, in an order that shells the region.
    pub(crate) fn hexes(&self) -> &[u32] {
        &self.hexes
    }

    pub(crate) fn n_quads(&self) -> usize {
        self.boundary.len()
    }

    #[inline]
    pub(crate) fn contains(&self, hex: u32) -> bool {
        self.hex_mark[hex as usize] == self.mark
    }

    /// Starts anew from one hex.
    pub(crate) fn start(&mut self, mesh: &LiveMesh, hex: u32) {
        self.hex_mark.resize(mesh.n_hex_slots(), 0);
        self.vertex_mark.resize(mesh.n_vertex_slots(), 0);
        self.local.resize(mesh.n_vertex_slots(), 0);
        self.local_mark.resize(mesh.n_vertex_slots(), 0);
        if self.mark == u32::MAX {
            self.hex_mark.fill(0);
            self.vertex_mark.fill(0);
            self.mark = 0;
        }
        self.mark += 1;
        self.hexes.clear();
        self.boundary.clear();
        self.join(mesh, hex);
    }

    /// Lets a hex join; it must be a candidate or the first.
    pub(crate) fn join(&mut self, mesh: &LiveMesh, hex: u32) {
        self.hexes.push(hex);
        self.hex_mark[hex as usize] = self.mark;
        for &v in mesh.hex(hex) {
            self.vertex_mark[v as usize] = self.mark;
        }
        self.boundary.retain(|&f| mesh.neighbour(f) / 6 != hex);
        for f in 6 * hex..6 * hex + 6 {
            let across = mesh.neighbour(f);
            if across == NONE || !self.contains(across / 6) {
                self.boundary.push(f);
            }
        }
    }

    /// The hexes that may join with at most `max_quads` quads afterwards, in the order of the boundary.
    pub(crate) fn candidates(&mut self, mesh: &LiveMesh, max_quads: usize) -> &[Candidate] {
        let mut found = std::mem::take(&mut self.candidates);
        found.clear();
        for &f in &self.boundary {
            let across = mesh.neighbour(f);
            if across == NONE {
                continue;
            }
            let hex = across / 6;
            match found.iter_mut().find(|c| c.hex == hex) {
                Some(c) => c.shared += 1,
                None => found.push(Candidate { hex, shared: 1 }),
            }
        }
        let n = self.boundary.len();
        // Each shared quad goes from both: n + 6 - 2 s are left.
        found.retain(|c| n + 6 <= max_quads + 2 * c.shared as usize && self.may_join(mesh, c.hex));
        self.candidates = found;
        &self.candidates
    }

    fn may_join(&self, mesh: &LiveMesh, hex: u32) -> bool {
        let mut mask = 0;
        for side in 0..6 {
            let across = mesh.neighbour(6 * hex + side);
            if across != NONE && self.contains(across / 6) {
                mask |= 1 << side;
            }
        }
        let shape = &MASKS[mask];
        let corners = mesh.hex(hex);
        shape.is_disk
            && shape.free_corners.iter().all(|&k| self.vertex_mark[corners[k] as usize] != self.mark)
            && shape.open_edges.iter().all(|&[i, j]| !self.has_boundary_edge(mesh, corners[i], corners[j]))
    }

    fn has_boundary_edge(&self, mesh: &LiveMesh, a: u32, b: u32) -> bool {
        self.boundary.iter().any(|&f| {
            let quad = mesh.facet(f);
            (0..4).any(|i| quad[i] == a && quad[(i + 1) % 4] == b)
        })
    }

    /// The boundary, outward, nothing blocked, and the mesh vertex of each of its vertices.
    /// `None` if it is larger than a [`Cavity`] can be.
    pub(crate) fn cavity(&mut self, mesh: &LiveMesh) -> Option<(Cavity, Vec<u32>)> {
        let n = self.boundary.len();
        if n > MAX_QUADS {
            return None;
        }
        if self.local_at == u32::MAX {
            self.local_mark.fill(0);
            self.local_at = 0;
        }
        self.local_at += 1;
        let mut cavity = Cavity::empty();
        cavity.n_quads = n as u8;
        let mut ids = Vec::with_capacity(n + 2);
        for (q, &f) in self.boundary.iter().enumerate() {
            for (side, v) in mesh.facet(f).into_iter().enumerate() {
                if self.local_mark[v as usize] != self.local_at {
                    self.local_mark[v as usize] = self.local_at;
                    self.local[v as usize] = ids.len() as u8;
                    ids.push(v);
                }
                cavity.origin[4 * q + side] = self.local[v as usize];
            }
        }
        debug_assert_eq!(ids.len(), n + 2, "the boundary of a ball is a sphere");
        // Euler: a quad sphere of n quads has n + 2 vertices. A ball grown hex by hex is one; this is the last guard
        // before a table look-up that relies on it.
        if ids.len() != n + 2 {
            return None;
        }
        cavity.n_vertices = ids.len() as u8;
        // A table of pairs and no map: the boundary is small, and this runs for every ball.
        let mut dart_to = [[u8::MAX; 64]; 64];
        for d in 0..4 * n as u8 {
            let (a, b) = (cavity.origin[usize::from(d)], cavity.origin[usize::from(crate::cavity::next(d))]);
            dart_to[usize::from(a)][usize::from(b)] = d;
        }
        for d in 0..4 * n as u8 {
            let (a, b) = (cavity.origin[usize::from(d)], cavity.origin[usize::from(crate::cavity::next(d))]);
            let twin = dart_to[usize::from(b)][usize::from(a)];
            if twin == u8::MAX {
                return None;
            }
            cavity.twin[usize::from(d)] = twin;
        }
        Some((cavity, ids))
    }

    /// Blocks every pair of the boundary's vertices that a hex outside uses as an edge, a diagonal or a body diagonal and the
    /// boundary's quads do not. `cavity` and `ids` are what [`cavity`](Self::cavity) returned last.
    pub(crate) fn block_outside(&self, mesh: &LiveMesh, cavity: &mut Cavity, ids: &[u32]) {
        let surface = cavity.surface_pairs();
        // A pair shows at both its vertices: the one with the most hexes (the apex of a cone has very many) need not be asked.
        let busiest = (0..ids.len()).max_by_key(|&v| mesh.degree(ids[v])).unwrap_or(0);
        for (a, &vertex) in ids.iter().enumerate().filter(|&(a, _)| a != busiest) {
            let mut row = 0u64;
            for hex in mesh.hexes_at(vertex) {
                if self.contains(hex) {
                    continue;
                }
                for &w in mesh.hex(hex) {
                    if self.local_mark[w as usize] == self.local_at {
                        row |= 1 << self.local[w as usize];
                    }
                }
            }
            row &= !surface[a] & !(1 << a);
            cavity.blocked[a] |= row;
            while row != 0 {
                cavity.blocked[row.trailing_zeros() as usize] |= 1 << a;
                row &= row - 1;
            }
        }
    }
}
