//! [`Void`]: what is left to fill while a surface is swept inward, its front, and what was glued already.
//!
//! Invariants: the front is closed and oriented as the surface (outward of the void); `twin[twin[d]] = d`; every pair of
//! vertices of one cell or front quad is in the pair table with its kind; `wanted` and `length` agree on both darts of an
//! edge. Darts are `4 * quad + side`.
//!
//! Source: ours.

use crate::compress::Coarse;
use crate::dart::next;
use crate::front::Front;
use crate::pairs::{OldPair, PairTable};
use hexfill_mesh::cube::EDGES;
use rustc_hash::FxHashMap;

/// How much less than its angle says an edge inside a pillow differs from flat: the pillow's hexes take up the rest.
const SOFTENED: f32 = 0.3;

/// The void with its front.
#[derive(Clone, Debug)]
pub(crate) struct Void {
    /// The front.
    pub quads: Vec<[u32; 4]>,
    pub twin: Vec<u32>,
    /// Per dart: hexes still wanted round its edge.
    pub wanted: Vec<f32>,
    /// Per dart: fine edges on its edge.
    pub length: Vec<u32>,
    pub n_vertices: u32,
    /// Vertices below this lie on the surface.
    pub n_surface: u32,
    pub hexes: Vec<[u32; 8]>,
    pub pairs: PairTable,
    /// The pairs that changed since [`mark`](Self::mark).
    journal: Vec<OldPair>,
}

/// What a move starts from, to come back to where it is not legal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mark {
    n_hexes: usize,
    n_vertices: u32,
}

impl Void {
    /// Nothing glued yet.
    pub(crate) fn new(coarse: &Coarse) -> Self {
        let surface = &coarse.surface;
        let quads: Vec<[u32; 4]> = surface.quads_raw();
        let mut pairs = PairTable::default();
        for quad in &quads {
            pairs.add_quad(quad);
        }
        Self {
            twin: surface.darts().map(|d| surface.twin(d).0).collect(),
            wanted: coarse.wanted.clone(),
            length: coarse.length.clone(),
            n_vertices: surface.n_vertices() as u32,
            n_surface: surface.n_vertices() as u32,
            hexes: Vec::new(),
            pairs,
            journal: Vec::new(),
            quads,
        }
    }

    #[inline]
    pub(crate) fn origin(&self, d: u32) -> u32 {
        self.quads[(d >> 2) as usize][(d & 3) as usize]
    }

    #[inline]
    pub(crate) fn target(&self, d: u32) -> u32 {
        self.origin(next(d))
    }

    pub(crate) fn n_darts(&self) -> u32 {
        4 * self.quads.len() as u32
    }

    /// One hex on every quad of the front: what is inside is then free of the surface. Always proper.
    pub(crate) fn pillow(&mut self) {
        let mut inner = FxHashMap::default();
        for quad in &mut self.quads {
            let outer = *quad;
            for v in quad.iter_mut() {
                *v = *inner.entry(*v).or_insert_with(|| {
                    self.n_vertices += 1;
                    self.n_vertices - 1
                });
            }
            // New vertices only, so no pair that any cell has can come again: this is why a pillow is always proper.
            let [a, b, c, d] = *quad;
            self.hexes.push([a, b, c, d, outer[0], outer[1], outer[2], outer[3]]);
        }
        for hex in &self.hexes[self.hexes.len() - self.quads.len()..] {
            let fits = self.pairs.add_hex(hex, |_| ());
            debug_assert!(fits, "a pillow is proper with everything");
        }
        for w in &mut self.wanted {
            *w = 2.0 + SOFTENED * (*w - 2.0);
        }
    }

    /// The void as a front that flips and plugs work on; `surface` are the quads that are never merged.
    pub(crate) fn to_front(&self, surface: &[[u32; 4]]) -> Option<Front> {
        Front::try_from_parts(self.n_vertices, surface, &self.hexes, &self.quads).ok()
    }

    /// [`to_front`](Self::to_front) that knows how many hexes its edges want.
    pub(crate) fn to_wanting_front(&self, surface: &[[u32; 4]]) -> Option<Front> {
        let mut front = self.to_front(surface)?;
        let mut wanted: FxHashMap<(u32, u32), f32> = FxHashMap::default();
        for d in 0..self.n_darts() {
            wanted.insert((self.origin(d), self.target(d)), self.wanted[d as usize]);
        }
        front.set_wants(|a, b| wanted.get(&(a, b)).copied().unwrap_or(2.0));
        Some(front)
    }

    /// This void after hexes were added to it as a front without merging any vertices: an edge of the old front wants what the new
    /// hexes at it leave, a new one 4 hexes in all. Every edge that is new has length 1.
    pub(crate) fn after(&self, front: &Front) -> Option<Self> {
        let mut wanted: FxHashMap<(u32, u32), f32> = FxHashMap::default();
        for d in 0..self.n_darts() {
            wanted.insert((self.origin(d), self.target(d)), self.wanted[d as usize]);
        }
        let key = |a: u32, b: u32| (a.min(b), a.max(b));
        let mut placed: FxHashMap<(u32, u32), f32> = FxHashMap::default();
        let mut void = self.clone();
        for hex in &front.hexes()[self.hexes.len()..] {
            for [i, j] in EDGES {
                *placed.entry(key(hex[i], hex[j])).or_insert(0.0) += 1.0;
            }
            if !void.pairs.add_hex(hex, |_| ()) {
                return None;
            }
        }
        void.hexes = front.hexes().to_vec();
        void.n_vertices = front.n_vertices();
        let quads = front.quads();
        let edges = quads.iter().flat_map(|q| (0..4).map(|i| (q[i], q[(i + 1) & 3])));
        let left = edges
            .map(|(a, b)| {
                let before = wanted.get(&(a, b)).or_else(|| wanted.get(&(b, a))).copied().unwrap_or(4.0);
                before - placed.get(&key(a, b)).copied().unwrap_or(0.0)
            })
            .collect();
        let length = vec![1; 4 * quads.len()];
        void.set_front(quads, left, length)?;
        Some(void)
    }

    /// Adds a hex; false if a pair of its vertices has another kind already.
    pub(crate) fn push_hex(&mut self, hex: [u32; 8]) -> bool {
        self.hexes.push(hex);
        let journal = &mut self.journal;
        self.pairs.add_hex(&hex, |old| journal.push(old))
    }

    /// A state to come back to, before the first hex of a move; the one before loses its meaning.
    pub(crate) fn mark(&mut self) -> Mark {
        self.journal.clear();
        Mark { n_hexes: self.hexes.len(), n_vertices: self.n_vertices }
    }

    /// Takes the hexes and vertices since the last mark back.
    pub(crate) fn take_back(&mut self, mark: Mark) {
        while let Some(old) = self.journal.pop() {
            self.pairs.restore(old);
        }
        self.hexes.truncate(mark.n_hexes);
        self.n_vertices = mark.n_vertices;
    }

    /// Replaces the front. `edges` has for every dart of the new quads what is wanted there and its length.
    /// `None`, and nothing changes, if the quads do not close to a surface.
    pub(crate) fn set_front(&mut self, quads: Vec<[u32; 4]>, wanted: Vec<f32>, length: Vec<u32>) -> Option<()> {
        let twin = pair_darts(&quads)?;
        (self.quads, self.twin, self.wanted, self.length) = (quads, twin, wanted, length);
        Some(())
    }
}

/// The twin of every dart; `None` if an edge is not in two quads that run along it in opposite directions.
fn pair_darts(quads: &[[u32; 4]]) -> Option<Vec<u32>> {
    let mut open: FxHashMap<(u32, u32), u32> = FxHashMap::default();
    open.reserve(4 * quads.len());
    for (q, quad) in quads.iter().enumerate() {
        for i in 0..4 {
            // The same direction twice: two quads lie on one side of the edge, or an edge joins its ends twice.
            if open.insert((quad[i], quad[(i + 1) & 3]), (4 * q + i) as u32).is_some() {
                return None;
            }
        }
    }
    let mut twin = Vec::with_capacity(4 * quads.len());
    for quad in quads {
        for i in 0..4 {
            twin.push(*open.get(&(quad[(i + 1) & 3], quad[i]))?);
        }
    }
    Some(twin)
}
