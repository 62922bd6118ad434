//! [`State`]: some hexes placed inside a quad sphere, any way they may lie in a finished ball, and the front that is left.
//!
//! The *front* is the set of open quads: those that still need a hex, each written as the facet that hex must have. The hexes need not
//! form a ball, nor be connected. What is kept:
//! * the pair table: each pair of vertices is *marked* if it is an edge, a diagonal of a quad or a body diagonal of a hex; edges with
//!   open quads and diagonals of open quads are known apart. A new hex is legal iff its edges are unmarked or open edges, its face
//!   diagonals are unmarked or those of an open quad that is its facet, its body diagonals are unmarked. (Two hexes share a set of at
//!   least two vertices: no pair of it is a body diagonal; a face diagonal makes it a quad of both; else it is an edge of both.)
//! * the link of each edge: paths of hexes from open quad to open quad; `twin` joins the ends of a path. The boundary's outside counts
//!   as a path. A path may close only when it is the last one: then the link is a circle.
//! * of each vertex the numbers of its open corners, edges, quads and hexes. A vertex without open corners must have a sphere or a
//!   disk as its link.
//!
//! All changes are journalled; `undo` goes back.
//!
//! Source: ours; the pair table is that of `topology/star.rs` in `hexfill-check`.

use crate::error::ProveError;
use crate::journal::Journal;
use hexfill_mesh::cube::{BODY_DIAGONALS, EDGES, FACET_DIAGONALS, FACETS};
use hexfill_mesh::{QuadSurface, bipartition};
use std::sync::OnceLock;

/// Most vertices of a mesh, so that a row of the pair table is a `u128`.
pub(crate) const MAX_VERTICES: usize = 128;
/// Most quads a state meets.
pub(crate) const MAX_QUADS: usize = 1024;
const NO_QUAD: u16 = u16::MAX;

/// A hex: eight vertices in VTK order.
pub(crate) type Hex = [u8; 8];

/// Of each of the 12 edges of the cube, the two facets that hold it: facet, and side of the facet on which it runs.
pub(crate) struct EdgeSides {
    ends: [usize; 2],
    /// Facet where it runs from the first end to the second, and the side there.
    along: (usize, usize),
    /// Facet where it runs back, and the side there.
    back: (usize, usize),
}

fn edge_sides() -> &'static [EdgeSides; 12] {
    static TABLE: OnceLock<[EdgeSides; 12]> = OnceLock::new();
    TABLE.get_or_init(|| {
        EDGES.map(|[u, v]| {
            let side = |a: usize, b: usize| {
                (0..6)
                    .flat_map(|f| (0..4).map(move |k| (f, k)))
                    .find(|&(f, k)| FACETS[f][k] == a && FACETS[f][(k + 1) % 4] == b)
                    .expect("every edge runs both ways")
            };
            EdgeSides { ends: [u, v], along: side(u, v), back: side(v, u) }
        })
    })
}

/// Numbers of cells, open quads and hexes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Counts {
    pub vertices: i32,
    pub edges: i32,
    pub quads: i32,
    pub hexes: i32,
    pub open: i32,
}

/// Which open quads a legal hex is glued on, by facet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Glue {
    quads: [u16; 6],
}

impl Glue {
    /// Number of glued facets.
    pub(crate) fn n_glued(&self) -> usize {
        self.quads.iter().filter(|&&q| q != NO_QUAD).count()
    }
}

/// A point in time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moment {
    rows: usize,
    bytes: usize,
    words: usize,
    quads: usize,
    counts: Counts,
}

/// See the module page.
#[derive(Clone)]
pub(crate) struct State {
    /// Rows of bits: see the `row` functions.
    rows: Journal<u128>,
    /// Open quads per edge, and four numbers a vertex.
    bytes: Journal<u8>,
    /// Quad of each diagonal, then twins of darts.
    words: Journal<u16>,
    /// Every quad met, as the facet of the hex that covers it; dart `4 q + k` runs from corner `k` to the next.
    quads: Vec<[u8; 4]>,
    pub(crate) hexes: Vec<Hex>,
    pub(crate) counts: Counts,
    /// Which vertices have the second colour of the 2-colouring.
    pub(crate) coloured: u128,
    n_boundary: usize,
}

const MARKED: usize = 0;
const OPEN_EDGE: usize = MAX_VERTICES;
const OPEN_DIAGONAL: usize = 2 * MAX_VERTICES;
const LIVE: usize = 3 * MAX_VERTICES;
const OPEN: usize = LIVE + 1;
const N_ROWS: usize = OPEN + MAX_QUADS / 128;

const PAIRS: usize = MAX_VERTICES * MAX_VERTICES;
const CORNERS: usize = PAIRS;
const LINK_EDGES: usize = CORNERS + MAX_VERTICES;
const LINK_QUADS: usize = LINK_EDGES + MAX_VERTICES;
const LINK_HEXES: usize = LINK_QUADS + MAX_VERTICES;
const N_BYTES: usize = LINK_HEXES + MAX_VERTICES;

impl State {
    /// The empty inside of a quad sphere whose vertices are all used. The surface is taken as seen from outside.
    ///
    /// # Errors
    /// [`ProveError::BadSurface`].
    pub(crate) fn new(surface: &QuadSurface) -> Result<Self, ProveError> {
        let bad = |why: &str| Err(ProveError::BadSurface { why: why.into() });
        if !surface.is_sphere() || surface.n_used_vertices() != surface.n_vertices() {
            return bad("it is not one sphere all of whose vertices are used");
        }
        if surface.n_vertices() >= MAX_VERTICES {
            return bad("it has too many vertices");
        }
        let Ok(colour) = bipartition(surface) else { return bad("its vertices have no 2-colouring") };
        let mut s = Self {
            rows: Journal::new(N_ROWS, 0),
            bytes: Journal::new(N_BYTES, 0),
            words: Journal::new(PAIRS + 4 * MAX_QUADS, NO_QUAD),
            quads: Vec::new(),
            hexes: Vec::new(),
            counts: Counts {
                vertices: surface.n_vertices() as i32,
                edges: surface.n_edges() as i32,
                quads: 0,
                hexes: 0,
                open: 0,
            },
            coloured: 0,
            n_boundary: surface.n_vertices(),
        };
        s.coloured = colour.iter().enumerate().fold(0, |set, (v, &c)| set | u128::from(c) << v);
        s.rows.set(LIVE, u128::MAX);
        for v in 0..MAX_VERTICES {
            // A vertex is joined to itself: so no row ever offers a hex the same vertex twice.
            s.rows.set(MARKED + v, 1 << v);
        }
        for quad in surface.quads() {
            s.add_quad(quad.map(|v| v.0 as u8));
        }
        // An edge of the sphere is open between its two quads; the outside counts as the path from the one to the
        // other, so the last hex there closes a circle.
        for d in surface.darts() {
            let (u, v) = (surface.origin(d).index(), surface.target(d).index());
            s.words.set(PAIRS + d.index(), surface.twin(d).0 as u16);
            s.mark(u, v);
            s.set_open_edge(u, v, true);
            s.bytes.set(u * MAX_VERTICES + v, 2);
            s.bytes.set(LINK_EDGES + u, s.bytes[LINK_EDGES + u] + 1);
        }
        Ok(s)
    }

    /// Number of vertices.
    pub(crate) fn n(&self) -> usize {
        self.counts.vertices as usize
    }

    /// Vertices that a hex at `v` may have as neighbours along an edge.
    #[inline]
    pub(crate) fn edge_row(&self, v: u8) -> u128 {
        !self.rows[MARKED + usize::from(v)] | self.rows[OPEN_EDGE + usize::from(v)]
    }

    /// Vertices that may be diagonally opposite to `v` in a facet.
    #[inline]
    pub(crate) fn diagonal_row(&self, v: u8) -> u128 {
        !self.rows[MARKED + usize::from(v)] | self.rows[OPEN_DIAGONAL + usize::from(v)]
    }

    /// Vertices that may be opposite to `v` in a hex.
    #[inline]
    pub(crate) fn body_row(&self, v: u8) -> u128 {
        !self.rows[MARKED + usize::from(v)]
    }

    /// Vertices that are not finished (those not made yet included).
    #[inline]
    pub(crate) fn live(&self) -> u128 {
        self.rows[LIVE]
    }

    /// The open quads in ascending order.
    pub(crate) fn open_quads(&self) -> impl Iterator<Item = u16> + '_ {
        (0..MAX_QUADS / 128).flat_map(move |i| {
            let mut bits = self.rows[OPEN + i];
            std::iter::from_fn(move || {
                (bits != 0).then(|| {
                    let q = bits.trailing_zeros();
                    bits &= bits - 1;
                    (128 * i) as u16 + q as u16
                })
            })
        })
    }

    /// The corners of a quad as the facet of the hex that is to cover it.
    #[inline]
    pub(crate) fn quad(&self, q: u16) -> [u8; 4] {
        self.quads[usize::from(q)]
    }

    /// Number of quads met so far; new ones are numbered from here.
    pub(crate) fn n_quads_met(&self) -> usize {
        self.quads.len()
    }

    /// The dart at the other end of the path of hexes round the edge of an open quad's dart.
    #[inline]
    pub(crate) fn twin(&self, dart: u16) -> u16 {
        self.words[PAIRS + usize::from(dart)]
    }

    /// Number of open quads at an edge.
    #[inline]
    pub(crate) fn open_at_edge(&self, u: u8, v: u8) -> u8 {
        self.bytes[usize::from(u) * MAX_VERTICES + usize::from(v)]
    }

    /// Number of open corners at a vertex.
    #[inline]
    pub(crate) fn corners(&self, v: usize) -> i32 {
        i32::from(self.bytes[CORNERS + v])
    }

    /// How far the link of a vertex is from its Euler characteristic when finished: vertices - edges + triangles so far, less 2 (inside)
    /// or 1 (boundary).
    #[inline]
    pub(crate) fn link_defect(&self, v: usize) -> i32 {
        let at = |kind: usize| i32::from(self.bytes[kind + v]);
        at(LINK_EDGES) - at(LINK_QUADS) + at(LINK_HEXES) - if v < self.n_boundary { 1 } else { 2 }
    }

    /// Whether the pair is marked, and not as the diagonal of an open quad at `corner`.
    #[inline]
    pub(crate) fn blocks_facet(&self, a: u8, b: u8, corner: u8) -> bool {
        if self.rows[MARKED + usize::from(a)] >> b & 1 == 0 {
            return false;
        }
        self.rows[OPEN_DIAGONAL + usize::from(a)] >> b & 1 == 0
            || !self.quads[usize::from(self.words[usize::from(a) * MAX_VERTICES + usize::from(b)])].contains(&corner)
    }

    /// The facets on the edge of an open quad's dart that a hex which covers the quad may be glued on there: of each the vertex next to the
    /// dart's origin, and the one next to its target.
    pub(crate) fn beyond(&self, dart: u16) -> (u128, u128) {
        let quad = self.quad(dart / 4);
        let [u, v] = [0, 1].map(|k| quad[usize::from((dart + k) % 4)]);
        if self.open_at_edge(u, v) == 2 {
            let t = self.twin(dart);
            let other = self.quad(t / 4);
            return (1 << other[usize::from((t + 2) % 4)], 1 << other[usize::from((t + 3) % 4)]);
        }
        let (mut by_origin, mut by_target) = (0, 0);
        let mut across = self.rows[OPEN_DIAGONAL + usize::from(v)];
        while across != 0 {
            let x = across.trailing_zeros() as usize;
            across &= across - 1;
            let other = self.quads[usize::from(self.words[usize::from(v) * MAX_VERTICES + x])];
            let at = other.iter().position(|&w| w == v).unwrap_or(0);
            if other[(at + 1) % 4] == u {
                by_origin |= 1 << x;
                by_target |= 1 << other[(at + 3) % 4];
            }
        }
        (by_origin, by_target)
    }

    /// Which vertices can complete a facet with the diagonal `a`, `b`: those of the quad that has it, or any.
    #[inline]
    pub(crate) fn fourth(&self, a: u8, b: u8) -> u128 {
        if self.rows[MARKED + usize::from(a)] >> b & 1 == 0 {
            return u128::MAX;
        }
        let q = self.words[usize::from(a) * MAX_VERTICES + usize::from(b)];
        if self.rows[OPEN_DIAGONAL + usize::from(a)] >> b & 1 == 0 {
            return 0;
        }
        self.quads[usize::from(q)].iter().fold(0, |set, &v| set | 1 << v)
    }

    /// Makes a vertex of a colour; its id is the number of vertices before.
    pub(crate) fn add_vertex(&mut self, colour: bool) {
        let bit = 1 << self.n();
        self.coloured = if colour { self.coloured | bit } else { self.coloured & !bit };
        self.counts.vertices += 1;
    }

    /// Where the state is now.
    pub(crate) fn now(&self) -> Moment {
        Moment {
            rows: self.rows.now(),
            bytes: self.bytes.now(),
            words: self.words.now(),
            quads: self.quads.len(),
            counts: self.counts,
        }
    }

    /// Goes back.
    pub(crate) fn undo(&mut self, then: &Moment) {
        self.rows.undo(then.rows);
        self.bytes.undo(then.bytes);
        self.words.undo(then.words);
        self.quads.truncate(then.quads);
        self.hexes.truncate(then.counts.hexes as usize);
        self.counts = then.counts;
    }

    fn mark(&mut self, u: usize, v: usize) {
        self.rows.set(MARKED + u, self.rows[MARKED + u] | 1 << v);
        self.rows.set(MARKED + v, self.rows[MARKED + v] | 1 << u);
    }

    fn set_bit(&mut self, row: usize, bit: usize, on: bool) {
        let old = self.rows[row];
        self.rows.set(row, if on { old | 1 << bit } else { old & !(1 << bit) });
    }

    fn set_open_edge(&mut self, u: usize, v: usize, open: bool) {
        self.set_bit(OPEN_EDGE + u, v, open);
        self.set_bit(OPEN_EDGE + v, u, open);
    }

    fn set_open(&mut self, q: u16, open: bool) {
        let [a, b, c, d] = self.quads[usize::from(q)].map(usize::from);
        self.set_bit(OPEN + usize::from(q) / 128, usize::from(q) % 128, open);
        for (x, y) in [(a, c), (b, d)] {
            self.set_bit(OPEN_DIAGONAL + x, y, open);
            self.set_bit(OPEN_DIAGONAL + y, x, open);
        }
        let step = if open { 1 } else { u8::MAX };
        for v in [a, b, c, d] {
            self.bytes.set(CORNERS + v, self.bytes[CORNERS + v].wrapping_add(step));
        }
        self.counts.open += if open { 1 } else { -1 };
    }

    /// A new open quad with these corners, as the facet of the hex that is to cover it.
    fn add_quad(&mut self, quad: [u8; 4]) -> u16 {
        let q = self.quads.len() as u16;
        self.quads.push(quad);
        let [a, b, c, d] = quad.map(usize::from);
        for (x, y) in [(a, c), (b, d)] {
            self.mark(x, y);
            self.words.set(x * MAX_VERTICES + y, q);
            self.words.set(y * MAX_VERTICES + x, q);
        }
        for v in [a, b, c, d] {
            self.bytes.set(LINK_QUADS + v, self.bytes[LINK_QUADS + v] + 1);
        }
        self.counts.quads += 1;
        self.set_open(q, true);
        q
    }

    /// The open quads a hex is glued on; `None` if the pair table forbids the hex. Vertices not made yet are unmarked.
    pub(crate) fn glue(&self, hex: &Hex) -> Option<Glue> {
        let live = self.live();
        if hex.iter().any(|&v| live >> v & 1 == 0) {
            return None;
        }
        if EDGES.iter().any(|&[i, j]| self.edge_row(hex[i]) >> hex[j] & 1 == 0)
            || BODY_DIAGONALS.iter().any(|&[i, j]| self.body_row(hex[i]) >> hex[j] & 1 == 0)
        {
            return None;
        }
        let mut quads = [NO_QUAD; 6];
        for (f, slot) in quads.iter_mut().enumerate() {
            // Both diagonals unused: a quad nobody has. Both those of one open quad: glued on it. One of each is a
            // quad that shares a diagonal with another one.
            let [free, other] = FACET_DIAGONALS[f].map(|[i, j]| self.body_row(hex[i]) >> hex[j] & 1 == 1);
            if free && other {
                continue;
            }
            let [i, j] = FACET_DIAGONALS[f][0];
            let (x, y) = (usize::from(hex[i]), usize::from(hex[j]));
            if free || other || self.rows[OPEN_DIAGONAL + x] >> y & 1 == 0 {
                return None;
            }
            let q = self.words[x * MAX_VERTICES + y];
            let facet = FACETS[f].map(|i| hex[i]);
            let turn = self.quad(q).iter().position(|&v| v == facet[0])?;
            if (0..4).any(|k| self.quad(q)[(k + turn) % 4] != facet[k]) {
                return None;
            }
            *slot = q;
        }
        Some(Glue { quads })
    }

    /// Places a hex that [`glue`](Self::glue) allows; its vertices must be made. `false` if the link of an edge or vertex can then not
    /// become a circle, path, sphere or disk: the caller must `undo`.
    pub(crate) fn place(&mut self, hex: &Hex, glue: &Glue) -> bool {
        let mut darts = [[0u16; 4]; 6];
        for (f, &q) in glue.quads.iter().enumerate() {
            let facet = FACETS[f].map(|i| hex[i]);
            if q != NO_QUAD {
                self.set_open(q, false);
                let turn = self.quad(q).iter().position(|&v| v == facet[0]).unwrap_or(0);
                darts[f] = std::array::from_fn(|k| 4 * q + ((k + turn) % 4) as u16);
            } else {
                let [a, b, c, d] = facet;
                // Written as the hex on its other side will have it, the other way round.
                let new = self.add_quad([d, c, b, a]);
                // Side k of the facet runs from corner k to k + 1: in the new quad that is dart (2 - k) modulo 4, run back.
                darts[f] = std::array::from_fn(|k| 4 * new + ((6 - k) % 4) as u16);
            }
        }
        for [i, j] in BODY_DIAGONALS {
            self.mark(usize::from(hex[i]), usize::from(hex[j]));
        }
        self.hexes.push(*hex);
        self.counts.hexes += 1;
        for &v in hex {
            let at = LINK_HEXES + usize::from(v);
            self.bytes.set(at, self.bytes[at] + 1);
        }
        edge_sides().iter().all(|e| self.join(hex, glue, &darts, e)) && hex.iter().all(|&v| self.close_vertex(v))
    }

    /// Adds the hex to the link of one of its edges.
    fn join(&mut self, hex: &Hex, glue: &Glue, darts: &[[u16; 4]; 6], e: &EdgeSides) -> bool {
        let [u, v] = e.ends.map(|i| usize::from(hex[i]));
        let glued = [e.along, e.back].map(|(f, _)| glue.quads[f] != NO_QUAD);
        let dart = [e.along, e.back].map(|(f, k)| darts[f][k]);
        if self.rows[MARKED + u] >> v & 1 == 0 {
            self.mark(u, v);
            self.set_open_edge(u, v, true);
            self.counts.edges += 1;
            for w in [u, v] {
                self.bytes.set(LINK_EDGES + w, self.bytes[LINK_EDGES + w] + 1);
            }
        }
        let mut open = self.bytes[u * MAX_VERTICES + v];
        for g in glued {
            open = if g { open - 1 } else { open + 1 };
        }
        self.bytes.set(u * MAX_VERTICES + v, open);
        self.bytes.set(v * MAX_VERTICES + u, open);
        if glued == [true, true] && self.twin(dart[0]) == dart[1] {
            self.set_open_edge(u, v, false);
            return open == 0;
        }
        // The ends of the path that the hex makes or lengthens.
        let ends: [u16; 2] = std::array::from_fn(|i| if glued[i] { self.twin(dart[i]) } else { dart[i] });
        self.words.set(PAIRS + usize::from(ends[0]), ends[1]);
        self.words.set(PAIRS + usize::from(ends[1]), ends[0]);
        true
    }

    /// A vertex without open corners is finished: its link must be a sphere or a disk.
    fn close_vertex(&mut self, v: u8) -> bool {
        if self.corners(usize::from(v)) > 0 {
            return true;
        }
        self.set_bit(LIVE, usize::from(v), false);
        self.link_defect(usize::from(v)) == 0
    }
}
