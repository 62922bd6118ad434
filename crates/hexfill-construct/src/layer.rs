//! Steps 3 and 4: the buffer layer and its diagonals. Every point between the surface and its inner copy gets its
//! id here, by rank and not by hashing, so gluing is a table look-up and takes linear time.
//!
//! Id ranges, in this order: the surface's own vertices, inner copies, middles of white columns, points of the
//! edges (`e` or `ed eo`, then `x`, `y z` or `s`), points of the quads (`d`, then `f` or `fl fp` of both triangles).

use crate::cell::CellLibrary;
use crate::colouring::Colouring;
use crate::error::ConstructError;
use crate::matching::LightSides;
use crate::pattern::{Pattern, Role, Side};
use hexfill_mesh::{Dart, QuadId, QuadSurface, VertexId};

/// Points of one buffer cube in the whole mesh, and its kind.
#[derive(Clone, Debug)]
pub struct Layer<'a> {
    surface: &'a QuadSurface,
    white: &'a [bool],
    /// Per vertex: id of its inner copy.
    inner: Vec<u32>,
    /// Per white vertex: id of the middle of its column.
    middle: Vec<u32>,
    /// Per dart: first id of the points of its edge (equal for twins).
    edge: Vec<u32>,
    /// Per dart: whether its side is heavy (equal for twins).
    heavy: Vec<bool>,
    /// Per dart of a heavy black-black edge: whether the star is joined to the outer origin of this dart.
    star_at_origin: Vec<bool>,
    /// Per quad: first id of the points of its inner facet.
    facet: Vec<u32>,
    /// Per quad: the corner of the quad that is corner 0 of its pattern (0 or 1).
    turn: Vec<u8>,
    /// Per quad: whether its cube is left open (see `join.rs`).
    open: Vec<bool>,
    /// First id after the layer's walls; inner points of cells and the core follow.
    n_points: u32,
}

/// The corner of a quad that is corner 0 of its pattern (0 or 1): a black one with a black one opposite.
fn turn_of(surface: &QuadSurface, white: &[bool], q: QuadId) -> u8 {
    let corners = surface.quad(q);
    u8::from(white[corners[0].index()] || white[corners[2].index()])
}

/// The triangles of the inner copy, outward, as vertices of the surface; triangle `2 q + t` is triangle `t` of
/// quad `q`: (corner 0, corner 1, corner 2) or (corner 2, corner 3, corner 0) of its pattern.
pub fn triangles(surface: &QuadSurface, colouring: &Colouring) -> Vec<[u32; 3]> {
    (0..surface.n_quads())
        .flat_map(|q| {
            let q = QuadId::new(q);
            let turn = usize::from(turn_of(surface, &colouring.white, q));
            let corners = surface.quad(q);
            [[0, 1, 2], [2, 3, 0]].map(|t| t.map(|k| corners[(k + turn) % 4].0))
        })
        .collect()
}

impl<'a> Layer<'a> {
    /// Numbers the points of the layer.
    ///
    /// # Errors
    /// [`ConstructError::TooLarge`]; [`ConstructError::NoCell`] if the library lacks a pattern that is needed.
    pub fn new(
        surface: &'a QuadSurface,
        colouring: &'a Colouring,
        sides: &LightSides,
        library: &CellLibrary,
    ) -> Result<Self, ConstructError> {
        let white = colouring.white.as_slice();
        let n_quads = surface.n_quads();
        // At most 3 points an edge and 5 a quad, 2 a vertex; checked once so that plain u32 arithmetic is safe.
        let bound = 3 * surface.n_vertices() + 6 * n_quads + 5 * n_quads;
        if bound > u32::MAX as usize {
            return Err(ConstructError::TooLarge { what: "vertices", given: bound, limit: u32::MAX as usize });
        }
        let mut next = surface.n_vertices() as u32;
        let mut take = |n: u32| {
            next += n;
            next - n
        };
        let used = |v: usize| surface.degree(VertexId::new(v)) > 0;
        let inner = (0..surface.n_vertices()).map(|v| if used(v) { take(1) } else { u32::MAX }).collect();
        let middle = (0..surface.n_vertices()).map(|v| if white[v] { take(1) } else { u32::MAX }).collect();
        let heavy: Vec<bool> = sides.light.iter().map(|&l| !l).collect();
        let mut edge = vec![u32::MAX; 4 * n_quads];
        for d in surface.darts() {
            let twin = surface.twin(d);
            if d < twin {
                // Uncut: e and x, or e, y, z. Cut: ed and eo, and s if heavy.
                let first = take(2 + u32::from(heavy[d.index()]));
                edge[d.index()] = first;
                edge[twin.index()] = first;
            }
        }
        let mut turn = vec![0u8; n_quads];
        let mut facet = vec![0u32; n_quads];
        for q in 0..n_quads {
            let corners = surface.quad(QuadId::new(q));
            turn[q] = turn_of(surface, white, QuadId::new(q));
            let odd = [1, 3].map(|k| corners[(k + usize::from(turn[q])) % 4]);
            facet[q] = take(1 + odd.iter().map(|v| if white[v.index()] { 1 } else { 2 }).sum::<u32>());
        }
        let mut layer = Self {
            surface,
            white,
            inner,
            middle,
            edge,
            heavy,
            star_at_origin: vec![false; 4 * n_quads],
            facet,
            turn,
            open: sides.open.clone(),
            n_points: next,
        };
        layer.choose_stars(library);
        for q in 0..n_quads {
            let pattern = layer.pattern(QuadId::new(q));
            if !layer.open[q] && library.find(&pattern).is_none() {
                return Err(ConstructError::NoCell { pattern });
            }
        }
        Ok(layer)
    }

    /// The star of a heavy black-black side may be joined to either end: take the end that makes the two cells
    /// small, or gives them cells that have positions. Two sweeps; the order is that of the darts, so the result is always the same.
    fn choose_stars(&mut self, library: &CellLibrary) {
        let surface = self.surface;
        let cost = |layer: &Self, d: Dart| -> usize {
            [d, surface.twin(d)].iter().map(|d| library.cost(&layer.pattern(d.quad()))).sum()
        };
        for d in surface.darts() {
            // A consistent start: the star at the end with the smaller id.
            self.star_at_origin[d.index()] = surface.origin(d) < surface.target(d);
        }
        for _ in 0..2 {
            for d in surface.darts() {
                let twin = surface.twin(d);
                if d > twin || !self.heavy[d.index()] || !self.is_cut(d) {
                    continue;
                }
                let before = cost(self, d);
                for e in [d, twin] {
                    self.star_at_origin[e.index()] ^= true;
                }
                if cost(self, d) >= before {
                    for e in [d, twin] {
                        self.star_at_origin[e.index()] ^= true;
                    }
                }
            }
        }
    }

    /// Whether Sigma crosses the inner edge under a dart.
    pub fn is_cut(&self, d: Dart) -> bool {
        !self.white[self.surface.origin(d).index()] && !self.white[self.surface.target(d).index()]
    }

    /// Whether the cube of a quad is left open.
    pub fn is_open(&self, q: QuadId) -> bool {
        self.open[q.index()]
    }

    /// First id after the layer's walls.
    pub fn n_points(&self) -> u32 {
        self.n_points
    }

    /// The inner copy of a vertex.
    pub fn inner(&self, v: VertexId) -> u32 {
        self.inner[v.index()]
    }

    /// The dart of side `k` of a quad's pattern.
    pub fn dart(&self, q: QuadId, k: u8) -> Dart {
        Dart::new(q, u32::from((k + self.turn[q.index()]) % 4))
    }

    /// The vertex at corner `k` of a quad's pattern.
    pub fn corner(&self, q: QuadId, k: u8) -> VertexId {
        self.surface.origin(self.dart(q, k))
    }

    /// The pattern of a quad's cell.
    pub fn pattern(&self, q: QuadId) -> Pattern {
        let white = [1, 3].map(|k| self.white[self.corner(q, k).index()]);
        let side = |k: u8| {
            let d = self.dart(q, k);
            if !self.heavy[d.index()] {
                Side::Light
            } else if !self.is_cut(d) {
                Side::Heavy
            } else if self.star_at_origin[d.index()] == k.is_multiple_of(2) {
                // Sides 0 and 2 start from a diagonal corner, 1 and 3 from an odd one.
                Side::StarDiagonal
            } else {
                Side::StarOdd
            }
        };
        Pattern { white, sides: [side(0), side(1), side(2), side(3)] }
    }

    /// The point of the inner edge under dart `d` on the side of its origin (both sides agree if it is not cut).
    pub fn edge_point(&self, d: Dart) -> u32 {
        let twin = self.surface.twin(d);
        let first = self.edge[d.index()];
        if self.is_cut(d) { first + u32::from(d > twin) } else { first }
    }

    /// The points of the inner edge under dart `d` at its origin and at its target (equal if it is not cut).
    pub fn edge_points(&self, d: Dart) -> (u32, u32) {
        (self.edge_point(d), self.edge_point(self.surface.twin(d)))
    }

    /// Midpoint of the diagonal of a quad's inner facet.
    pub fn diagonal_point(&self, q: QuadId) -> u32 {
        self.facet[q.index()]
    }

    /// The point of inner triangle `t` of a quad on the side of its odd corner (`lone`) or of its diagonal; both
    /// agree if the triangle is not cut.
    pub fn face_point(&self, q: QuadId, t: u8, lone: bool) -> u32 {
        let white = |t: u8| self.white[self.corner(q, 2 * t + 1).index()];
        let size = |t: u8| if white(t) { 1 } else { 2 };
        let first = self.facet[q.index()] + 1 + if t == 1 { size(0) } else { 0 };
        first + u32::from(!white(t) && !lone)
    }

    /// The id of a boundary point of a quad's cell.
    pub fn point(&self, q: QuadId, role: Role) -> u32 {
        let edge = |k: u8| self.edge[self.dart(q, k).index()];
        match role {
            Role::Outer(k) => self.corner(q, k).0,
            Role::Inner(k) => self.inner(self.corner(q, k)),
            Role::Middle(k) => self.middle[self.corner(q, k).index()],
            Role::Edge(k) => edge(k),
            Role::EdgeDiagonal(k) => {
                let d = self.dart(q, k);
                self.edge_point(if k.is_multiple_of(2) { d } else { self.surface.twin(d) })
            }
            Role::EdgeOdd(k) => {
                let d = self.dart(q, k);
                self.edge_point(if k.is_multiple_of(2) { self.surface.twin(d) } else { d })
            }
            Role::X(k) | Role::Y(k) => edge(k) + 1,
            Role::Z(k) | Role::Star(k) => edge(k) + 2,
            Role::Diagonal => self.diagonal_point(q),
            Role::Face(t) | Role::FaceLone(t) => self.face_point(q, t, true),
            Role::FacePair(t) => self.face_point(q, t, false),
            Role::Interior(_) => u32::MAX,
        }
    }
}
