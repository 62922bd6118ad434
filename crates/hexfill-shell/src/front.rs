//! [`Front`]: the closed quad surface of what is left to fill, the hexes glued so far, and a journal to take changes back.
//!
//! Idea: a hex mesh is glued hex by hex on the inside of the surface. What is left, the *void*, is bounded by the front; its quads
//! are oriented as those of the surface, outward of the void. Darts are `4 * slot + side` as on a `QuadSurface`; slots of quads
//! that are gone stay empty. Vertices are `u32` ids: those of the surface keep theirs, new ones follow.
//!
//! Invariants (between operations; see [`Front::debug_check`]): `twin[twin[d]] = d`, and twins run opposite ways; every vertex has one fan of
//! quads or none; no vertex has degree 1 or 2; two front edges never join the same two vertices; the pair table is that of the surface's quads
//! and the glued hexes, without a clash (rule R2); `star[v]` lists the hexes at `v`.
//! Every change is written to the journal, so that [`Front::take_back`] restores the state exactly.
//!
//! Source: ours; one hex at a time on a front is Bern, Eppstein and Erickson 2002 read as a filling.

mod check;
mod journal;

pub use journal::Mark;

use crate::dart::{next, prev};
use crate::pairs::PairTable;
use hexfill_mesh::{QuadSurface, SurfaceError};
use journal::Change;
use smallvec::SmallVec;

/// "No dart": the slot of a quad that is gone, or a vertex that is not on the front.
pub(crate) const NONE: u32 = u32::MAX;

/// Why hexes and a front are no state to go on from.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FrontError {
    /// The front is no closed quad surface.
    #[error("the front is no closed quad surface: {0}")]
    Front(#[from] SurfaceError),
    /// A vertex index beyond the vertices.
    #[error("vertex index {given} is used, but there are only {limit} vertices")]
    IndexOutOfRange {
        /// The index given.
        given: u32,
        /// The number of vertices.
        limit: u32,
    },
    /// Two cells meet improperly (rule R2), so no filling can be proper.
    #[error("two cells of the surface or the hexes share more than a vertex, an edge or a quad of both")]
    Improper,
}

/// The front, the hexes glued so far and the journal. See the module page.
#[derive(Clone, Debug)]
pub struct Front {
    origin: Vec<u32>,
    twin: Vec<u32>,
    /// Per dart: how many hexes are still wanted round its edge; empty if nothing is wanted. Twins have the same.
    want: Vec<f32>,
    n_quads: u32,
    /// Per vertex: number of front quads round it.
    degree: Vec<u32>,
    /// Per vertex: some dart from it, or [`NONE`].
    dart_of: Vec<u32>,
    /// Per vertex: whether it belongs to the surface and must keep its own place.
    fixed: Vec<bool>,
    hexes: Vec<[u32; 8]>,
    star: Vec<SmallVec<[u32; 8]>>,
    pairs: PairTable,
    /// The surface's quads, and per fixed vertex its neighbours along surface edges.
    surface: Vec<[u32; 4]>,
    surface_neighbours: Vec<Vec<u32>>,
    /// Vertex ids below this one keep their names.
    n_kept: u32,
    journal: Vec<Change>,
}

impl Front {
    /// The state before the first hex: the front is the surface.
    ///
    /// # Errors
    /// [`FrontError::Improper`] if quads of the surface meet improperly.
    pub fn new(surface: &QuadSurface) -> Result<Self, FrontError> {
        let quads: Vec<[u32; 4]> = surface.quads_raw();
        let state = Self::try_from_parts(surface.n_vertices() as u32, &quads, &[], &quads)?;
        Ok(Self { n_kept: surface.n_vertices() as u32, ..state })
    }

    /// A state to go on from: `n_vertices` vertices in all, the quads of the surface (whose vertices are never merged), the
    /// hexes glued so far (VTK_HEXAHEDRON order) and the front they leave, oriented as the surface.
    ///
    /// # Errors
    /// [`FrontError`].
    pub fn try_from_parts(
        n_vertices: u32,
        surface: &[[u32; 4]],
        hexes: &[[u32; 8]],
        front: &[[u32; 4]],
    ) -> Result<Self, FrontError> {
        let used = surface.iter().flatten().chain(hexes.iter().flatten()).chain(front.iter().flatten());
        if let Some(&given) = used.clone().find(|&&v| v >= n_vertices) {
            return Err(FrontError::IndexOutOfRange { given, limit: n_vertices });
        }
        let n = n_vertices as usize;
        let mut state = Self {
            origin: Vec::new(),
            twin: Vec::new(),
            want: Vec::new(),
            n_quads: front.len() as u32,
            degree: vec![0; n],
            dart_of: vec![NONE; n],
            fixed: vec![false; n],
            hexes: hexes.to_vec(),
            star: vec![SmallVec::new(); n],
            pairs: PairTable::default(),
            surface: surface.to_vec(),
            surface_neighbours: vec![Vec::new(); n],
            n_kept: surface.iter().flatten().max().map_or(0, |v| v + 1),
            journal: Vec::new(),
        };
        if !front.is_empty() {
            let front = QuadSurface::try_new(n, front)?;
            state.origin = front.quads().iter().flatten().map(|v| v.0).collect();
            state.twin = front.darts().map(|d| front.twin(d).0).collect();
        }
        for (d, &v) in state.origin.iter().enumerate().rev() {
            state.degree[v as usize] += 1;
            state.dart_of[v as usize] = d as u32;
        }
        for quad in surface {
            for i in 0..4 {
                let (a, b) = (quad[i] as usize, quad[(i + 1) % 4] as usize);
                state.fixed[a] = true;
                state.surface_neighbours[a].push(b as u32);
            }
        }
        for (h, hex) in hexes.iter().enumerate() {
            for &v in hex {
                state.star[v as usize].push(h as u32);
            }
        }
        let proper = surface.iter().all(|q| state.pairs.add_quad(q))
            && hexes.iter().all(|h| state.pairs.add_hex(h, |_| ()))
            && state.degree.iter().all(|&d| d == 0 || d > 2);
        if proper { Ok(state) } else { Err(FrontError::Improper) }
    }

    /// Number of front quads.
    pub fn n_quads(&self) -> usize {
        self.n_quads as usize
    }

    /// Number of vertex ids given out so far, used or not.
    pub fn n_vertices(&self) -> u32 {
        self.degree.len() as u32
    }

    /// The hexes glued so far.
    pub fn hexes(&self) -> &[[u32; 8]] {
        &self.hexes
    }

    /// The front quads, oriented as the surface, in the order of their slots.
    pub fn quads(&self) -> Vec<[u32; 4]> {
        self.slots().map(|q| self.quad(q)).collect()
    }

    /// The surface's quads.
    pub(crate) fn surface(&self) -> &[[u32; 4]] {
        &self.surface
    }

    /// Number of vertex ids that keep their names: those of the surface.
    pub(crate) fn n_kept(&self) -> u32 {
        self.n_kept
    }

    /// The same surface with other hexes and another front.
    pub(crate) fn with(&self, n_vertices: u32, hexes: &[[u32; 8]], front: &[[u32; 4]]) -> Result<Self, FrontError> {
        let state = Self::try_from_parts(n_vertices, &self.surface, hexes, front)?;
        Ok(Self { n_kept: self.n_kept, ..state })
    }

    /// Whether a vertex belongs to the surface.
    pub fn is_fixed(&self, v: u32) -> bool {
        self.fixed[v as usize]
    }

    /// Number of front quads round a vertex.
    #[inline]
    pub fn degree(&self, v: u32) -> u32 {
        self.degree[v as usize]
    }

    /// Number of slots, empty ones included.
    pub(crate) fn n_slots(&self) -> u32 {
        self.origin.len() as u32 / 4
    }

    /// The slots that hold a quad, ascending.
    pub(crate) fn slots(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.n_slots()).filter(|&q| self.is_quad(q))
    }

    /// Whether a slot holds a quad.
    #[inline]
    pub(crate) fn is_quad(&self, slot: u32) -> bool {
        self.origin[4 * slot as usize] != NONE
    }

    /// The corners of a quad.
    pub(crate) fn quad(&self, slot: u32) -> [u32; 4] {
        let d = 4 * slot as usize;
        [self.origin[d], self.origin[d + 1], self.origin[d + 2], self.origin[d + 3]]
    }

    /// The vertex a dart starts from.
    #[inline]
    pub(crate) fn origin(&self, d: u32) -> u32 {
        self.origin[d as usize]
    }

    /// The vertex a dart leads to.
    #[inline]
    pub(crate) fn target(&self, d: u32) -> u32 {
        self.origin[next(d) as usize]
    }

    /// The dart of the neighbouring quad along the same edge.
    #[inline]
    pub(crate) fn twin(&self, d: u32) -> u32 {
        self.twin[d as usize]
    }

    /// Some dart from a vertex of the front.
    #[inline]
    pub(crate) fn dart_of(&self, v: u32) -> u32 {
        self.dart_of[v as usize]
    }

    /// The darts from the vertex of `d`, counter-clockwise seen from outside the void, `d` first.
    pub(crate) fn round_vertex(&self, d: u32) -> impl Iterator<Item = u32> + '_ {
        let mut at = Some(d);
        std::iter::from_fn(move || {
            let now = at?;
            let after = self.twin(prev(now));
            at = (after != d).then_some(after);
            Some(now)
        })
    }

    /// Whether two vertices are both in one cell.
    pub(crate) fn is_joined(&self, a: u32, b: u32) -> bool {
        self.pairs.join(a, b).is_some()
    }

    /// The hexes at a vertex.
    pub(crate) fn star(&self, v: u32) -> &[u32] {
        &self.star[v as usize]
    }

    /// The vertices joined to `v` by an edge of a hex or of the surface, ascending.
    pub(crate) fn neighbours(&self, v: u32) -> SmallVec<[u32; 32]> {
        let mut all = SmallVec::from_slice(&self.surface_neighbours[v as usize]);
        for &h in &self.star[v as usize] {
            let hex = &self.hexes[h as usize];
            for i in (0..8).filter(|&i| hex[i] == v) {
                all.extend(hexfill_mesh::cube::CORNER_NEIGHBOURS[i].map(|k| hex[k]));
            }
        }
        all.sort_unstable();
        all.dedup();
        all
    }

    /// The vertices joined to both by an edge, ascending; `b` had better be the one with fewer hexes.
    pub(crate) fn common_neighbours(&self, a: u32, b: u32) -> SmallVec<[u32; 8]> {
        let near = self.neighbours(b);
        let mut common: SmallVec<[bool; 32]> = SmallVec::from_elem(false, near.len());
        let mut mark = |v: &u32| {
            if let Ok(i) = near.binary_search(v) {
                common[i] = true;
            }
        };
        self.surface_neighbours[a as usize].iter().for_each(&mut mark);
        for &h in &self.star[a as usize] {
            let hex = &self.hexes[h as usize];
            for i in (0..8).filter(|&i| hex[i] == a) {
                hexfill_mesh::cube::CORNER_NEIGHBOURS[i].iter().for_each(|&k| mark(&hex[k]));
            }
        }
        near.into_iter().zip(common).filter(|(_, common)| *common).map(|(v, _)| v).collect()
    }

    /// States how many hexes are wanted round each front edge: on the surface its angle / 90 degrees, inside 4 less those that are there.
    pub fn set_wants(&mut self, want: impl Fn(u32, u32) -> f32) {
        self.want = vec![0.0; self.origin.len()];
        for q in 0..self.n_slots() {
            if self.is_quad(q) {
                for d in 4 * q..4 * q + 4 {
                    let t = self.twin(d);
                    if d < t {
                        let wanted = want(self.origin(d), self.target(d));
                        let wanted = if wanted.is_finite() { wanted } else { 2.0 };
                        (self.want[d as usize], self.want[t as usize]) = (wanted, wanted);
                    }
                }
            }
        }
    }

    /// Forgets what is wanted.
    pub(crate) fn clear_wants(&mut self) {
        self.want.clear();
    }

    /// How many hexes are still wanted round the edge of a dart.
    #[inline]
    pub(crate) fn want(&self, d: u32) -> f32 {
        self.want[d as usize]
    }

    /// Whether wants were stated.
    pub(crate) fn has_wants(&self) -> bool {
        !self.want.is_empty()
    }

    /// The same state without empty slots. Marks lose their meaning.
    pub(crate) fn compact(&self) -> Self {
        let mut same = self.with(self.n_vertices(), &self.hexes, &self.quads()).expect("the state is proper");
        if self.has_wants() {
            same.want = self.slots().flat_map(|q| 4 * q..4 * q + 4).map(|d| self.want(d)).collect();
        }
        same
    }
}
