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

use crate::pairs::{OldPair, PairTable};
use hexfill_mesh::{QuadSurface, SurfaceError};

/// "No dart": the slot of a quad that is gone, or a vertex that is not on the front.
pub(crate) const NONE: u32 = u32::MAX;

/// The dart after `d` round its quad.
#[inline]
pub(crate) const fn next(d: u32) -> u32 {
    (d & !3) | ((d + 1) & 3)
}

/// The dart before `d` round its quad.
#[inline]
pub(crate) const fn prev(d: u32) -> u32 {
    (d & !3) | ((d + 3) & 3)
}

/// The dart opposite to `d` in its quad.
#[inline]
pub(crate) const fn opposite(d: u32) -> u32 {
    d ^ 2
}

/// One change, with what was there before.
#[derive(Clone, Copy, Debug)]
enum Change {
    Origin(u32, u32),
    Twin(u32, u32),
    Degree(u32, u32),
    DartOf(u32, u32),
    Want(u32, f32),
    Quads(u32),
    Corner(u32, u8, u32),
    /// A hex was pushed.
    Hex,
    /// A vertex was pushed.
    Vertex,
    /// An empty slot was pushed.
    Slot,
    /// The star of a vertex grew; its length before.
    Star(u32, u32),
    Pair(OldPair),
}

/// A place in the journal to go back to.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct Mark(usize);

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
    star: Vec<Vec<u32>>,
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
        let quads: Vec<[u32; 4]> = surface.quads().iter().map(|q| q.map(|v| v.0)).collect();
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
            star: vec![Vec::new(); n],
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
    pub(crate) fn neighbours(&self, v: u32) -> Vec<u32> {
        let mut all = self.surface_neighbours[v as usize].clone();
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
    pub(crate) fn common_neighbours(&self, a: u32, b: u32) -> Vec<u32> {
        let near = self.neighbours(b);
        let mut common = vec![false; near.len()];
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

    // Journalled changes.

    /// Sets what is wanted round the edge of a dart.
    pub(crate) fn set_want(&mut self, d: u32, want: f32) {
        for d in [d, self.twin(d)] {
            self.journal.push(Change::Want(d, self.want[d as usize]));
            self.want[d as usize] = want;
        }
    }

    /// A place to come back to.
    pub fn mark(&self) -> Mark {
        Mark(self.journal.len())
    }

    /// Makes everything since the start final; older marks lose their meaning.
    pub fn commit(&mut self) {
        self.journal.clear();
    }

    pub(crate) fn set_origin(&mut self, d: u32, v: u32) {
        self.journal.push(Change::Origin(d, self.origin[d as usize]));
        self.origin[d as usize] = v;
    }

    /// Makes two darts twins.
    pub(crate) fn glue(&mut self, a: u32, b: u32) {
        for (d, t) in [(a, b), (b, a)] {
            self.journal.push(Change::Twin(d, self.twin[d as usize]));
            self.twin[d as usize] = t;
        }
    }

    pub(crate) fn set_degree(&mut self, v: u32, degree: u32) {
        self.journal.push(Change::Degree(v, self.degree[v as usize]));
        self.degree[v as usize] = degree;
    }

    pub(crate) fn set_dart_of(&mut self, v: u32, d: u32) {
        self.journal.push(Change::DartOf(v, self.dart_of[v as usize]));
        self.dart_of[v as usize] = d;
    }

    /// Empties the slot of a quad; degrees are the caller's task.
    pub(crate) fn remove_quad(&mut self, slot: u32) {
        self.journal.push(Change::Quads(self.n_quads));
        self.n_quads -= 1;
        for i in 0..4 {
            self.set_origin(4 * slot + i, NONE);
        }
    }

    /// Puts a quad into an empty slot, or a new one; its slot. Twins and degrees are the caller's task.
    pub(crate) fn put_quad(&mut self, slot: Option<u32>, quad: [u32; 4]) -> u32 {
        let slot = slot.unwrap_or_else(|| {
            self.journal.push(Change::Slot);
            self.origin.extend([NONE; 4]);
            self.twin.extend([NONE; 4]);
            if self.has_wants() {
                self.want.extend([0.0; 4]);
            }
            self.n_slots() - 1
        });
        self.journal.push(Change::Quads(self.n_quads));
        self.n_quads += 1;
        for (i, v) in quad.into_iter().enumerate() {
            self.set_origin(4 * slot + i as u32, v);
        }
        slot
    }

    /// A new interior vertex, not yet on the front.
    pub(crate) fn push_vertex(&mut self) -> u32 {
        self.journal.push(Change::Vertex);
        self.degree.push(0);
        self.dart_of.push(NONE);
        self.fixed.push(false);
        self.star.push(Vec::new());
        self.surface_neighbours.push(Vec::new());
        self.degree.len() as u32 - 1
    }

    /// Adds a hex to the list and the stars, not yet to the pair table.
    pub(crate) fn push_hex(&mut self, hex: [u32; 8]) -> u32 {
        let h = self.hexes.len() as u32;
        self.journal.push(Change::Hex);
        self.hexes.push(hex);
        for v in hex {
            self.push_star(v, h);
        }
        h
    }

    fn push_star(&mut self, v: u32, h: u32) {
        self.journal.push(Change::Star(v, self.star[v as usize].len() as u32));
        self.star[v as usize].push(h);
    }

    /// Renames vertex `from` to `to` in the hexes. The pair table is not told yet.
    pub(crate) fn rename(&mut self, from: u32, to: u32) {
        for i in 0..self.star[from as usize].len() {
            let h = self.star[from as usize][i];
            for corner in 0..8u8 {
                if self.hexes[h as usize][usize::from(corner)] == from {
                    self.journal.push(Change::Corner(h, corner, from));
                    self.hexes[h as usize][usize::from(corner)] = to;
                }
            }
            self.push_star(to, h);
        }
    }

    /// Puts the pairs of a hex into the table; `false` at a clash.
    pub(crate) fn add_pairs(&mut self, h: u32) -> bool {
        let (pairs, journal) = (&mut self.pairs, &mut self.journal);
        pairs.add_hex(&self.hexes[h as usize], |old| journal.push(Change::Pair(old)))
    }

    /// Tells the pair table that hexes (each with its corners as the table knows them) have others now; `false` at a clash.
    pub(crate) fn update_pairs(&mut self, renamed: &[(u32, [u32; 8])]) -> bool {
        let (pairs, journal, hexes) = (&mut self.pairs, &mut self.journal, &self.hexes);
        for (h, before) in renamed {
            pairs.remove_changed(before, &hexes[*h as usize], |old| journal.push(Change::Pair(old)));
        }
        renamed
            .iter()
            .all(|(h, before)| pairs.add_changed(before, &hexes[*h as usize], |old| journal.push(Change::Pair(old))))
    }

    /// The slots of quads that changed since `mark`, ascending; for those who keep something per quad.
    pub(crate) fn changed_slots(&self, mark: Mark) -> Vec<u32> {
        let mut slots: Vec<u32> = self.journal[mark.0..]
            .iter()
            .filter_map(|c| match *c {
                Change::Origin(d, _) | Change::Twin(d, _) => Some(d / 4),
                _ => None,
            })
            .collect();
        slots.sort_unstable();
        slots.dedup();
        slots
    }

    /// Takes everything since `mark` back, exactly.
    pub fn take_back(&mut self, mark: Mark) {
        while self.journal.len() > mark.0 {
            match self.journal.pop().expect("longer than the mark") {
                Change::Origin(d, v) => self.origin[d as usize] = v,
                Change::Twin(d, t) => self.twin[d as usize] = t,
                Change::Want(d, want) => self.want[d as usize] = want,
                Change::Degree(v, degree) => self.degree[v as usize] = degree,
                Change::DartOf(v, d) => self.dart_of[v as usize] = d,
                Change::Quads(n) => self.n_quads = n,
                Change::Corner(h, corner, v) => self.hexes[h as usize][usize::from(corner)] = v,
                Change::Slot => {
                    let n = self.origin.len() - 4;
                    self.origin.truncate(n);
                    self.twin.truncate(n);
                    self.want.truncate(n);
                }
                Change::Hex => {
                    self.hexes.pop();
                }
                Change::Vertex => {
                    self.degree.pop();
                    self.dart_of.pop();
                    self.fixed.pop();
                    self.star.pop();
                    self.surface_neighbours.pop();
                }
                Change::Star(v, length) => self.star[v as usize].truncate(length as usize),
                Change::Pair(old) => self.pairs.restore(old),
            }
        }
    }

    /// Checks the invariants; for tests. Linear time.
    ///
    /// # Panics
    /// If one is broken.
    pub fn debug_check(&self) {
        let mut degree = vec![0; self.degree.len()];
        let mut edges = rustc_hash::FxHashSet::default();
        assert_eq!(self.slots().count(), self.n_quads());
        for q in self.slots() {
            for d in 4 * q..4 * q + 4 {
                let t = self.twin(d);
                assert!(self.is_quad(t / 4) && self.twin(t) == d && t != d);
                assert_eq!(
                    (self.origin(d), self.target(d)),
                    (self.target(t), self.origin(t)),
                    "twins run opposite ways"
                );
                assert!(!self.has_wants() || self.want(d) == self.want(t));
                assert!(edges.insert((self.origin(d), self.target(d))), "one front edge a pair");
                degree[self.origin(d) as usize] += 1;
            }
        }
        assert_eq!(degree, self.degree);
        for v in 0..self.n_vertices() {
            let d = self.dart_of[v as usize];
            assert!(self.degree(v) == 0 || self.degree(v) > 2);
            if self.degree(v) > 0 {
                assert_eq!(self.origin(d), v);
                assert_eq!(self.round_vertex(d).count() as u32, self.degree(v), "one fan");
            }
        }
        self.pairs.debug_check(&self.hexes, &self.surface);
        for (v, star) in self.star.iter().enumerate().filter(|(_, s)| !s.is_empty()) {
            // The star of a vertex that was merged into another is left as it was.
            let current: Vec<u32> =
                star.iter().copied().filter(|&h| self.hexes[h as usize].contains(&(v as u32))).collect();
            assert!(current.is_empty() || current.len() == star.len());
        }
        for (h, hex) in self.hexes.iter().enumerate() {
            assert!(hex.iter().all(|&v| self.star(v).contains(&(h as u32))));
        }
        // The front is what the surface and the hexes leave: every quad of it is in one cell, all others in two.
        let mut sides = rustc_hash::FxHashMap::default();
        let sorted = |mut q: [u32; 4]| {
            q.sort_unstable();
            q
        };
        for quad in self.hexes.iter().flat_map(|h| hexfill_mesh::cube::FACETS.map(|f| f.map(|i| h[i]))) {
            *sides.entry(sorted(quad)).or_insert(0) += 1;
        }
        for quad in &self.surface {
            *sides.entry(sorted(*quad)).or_insert(0) += 1;
        }
        for q in self.slots() {
            *sides.entry(sorted(self.quad(q))).or_insert(0) += 1;
        }
        assert!(sides.values().all(|&n| n == 2), "every quad has two sides");
    }

    /// Whether two states are the same, journal apart; for tests.
    pub fn is_same(&self, other: &Self) -> bool {
        (&self.origin, &self.twin, self.n_quads, &self.degree, &self.dart_of)
            == (&other.origin, &other.twin, other.n_quads, &other.degree, &other.dart_of)
            && (&self.fixed, &self.hexes, &self.star) == (&other.fixed, &other.hexes, &other.star)
            && (&self.pairs, &self.want) == (&other.pairs, &other.want)
    }
}
