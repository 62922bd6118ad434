//! Step 3: the buffer layer and its diagonals. Every point between the surface and its inner copy gets its
//! id here, by rank and not by hashing, so gluing is a table look-up and takes linear time. (Erickson 2014, the buffer layer.)
//!
//! Id ranges, in this order: the surface's own vertices, inner copies, middles of white columns, points of the
//! edges (`e` or `ed eo`, then `x`, `y z` or `s`), points of the quads (`d`, then `f` or `fl fp` of both triangles).
//!
//! Source: Eppstein 1999 and Erickson 2014, section 5 (a buffer layer); numbering without hashing is ours.

use crate::cells::library::CellLibrary;
use crate::cells::pattern::{Pattern, Role, Side};
use crate::core::Inside;
use crate::core::triangles::turn_of;
use crate::error::ConstructError;
use crate::ids::PointId;
use crate::plan::matching::{LightSides, light_sides};
use crate::plan::{Plan, stage};
use hexfill_mesh::{Context, Dart, IdVec, QuadId, QuadSurface, VertexId};

/// Points of one buffer cube in the whole mesh, and its kind.
pub(crate) struct Layer<'a> {
    surface: &'a QuadSurface,
    white: &'a IdVec<VertexId, bool>,
    /// Per vertex: its inner copy.
    inner: IdVec<VertexId, PointId>,
    /// Per white vertex: the middle of its column.
    middle: IdVec<VertexId, PointId>,
    /// Per dart: the first of the points of its edge (equal for twins).
    edge: IdVec<Dart, PointId>,
    sides: LightSides,
    /// Per dart of a heavy black-black edge: whether the star is joined to the outer origin of this dart.
    star_at_origin: IdVec<Dart, bool>,
    /// Per quad: the first of the points of its inner facet.
    facet: IdVec<QuadId, PointId>,
    /// Per quad: the corner of the quad that is corner 0 of its pattern (0 or 1).
    turn: IdVec<QuadId, u8>,
    /// First id after the layer's walls; inner points of cells and the core follow.
    end: PointId,
}

/// Chooses the light sides, unless the plan did already for all quads, and numbers the points of the layer.
///
/// # Errors
/// As [`light_sides`] and [`Layer::new`].
pub(crate) fn layer<'a>(plan: &'a Plan<'_>, inside: &Inside, ctx: &Context<'_>) -> Result<Layer<'a>, ConstructError> {
    stage("matching", ctx)?;
    let open: Vec<QuadId> = inside.corridors.iter().flat_map(|c| c.quads).collect();
    let sides = match &plan.sides {
        Some(sides) if open.is_empty() => sides.clone(),
        _ => light_sides(plan.surface, &open, plan.options.matching(), ctx)?,
    };
    stage("buffer layer", ctx)?;
    Layer::new(plan, sides)
}

impl<'a> Layer<'a> {
    /// Numbers the points of the layer.
    ///
    /// # Errors
    /// [`ConstructError::TooLarge`]; [`ConstructError::NoCell`] if the library lacks a pattern that is needed.
    fn new(plan: &'a Plan<'_>, sides: LightSides) -> Result<Self, ConstructError> {
        let (surface, white) = (plan.surface, &plan.colours.white);
        let (n_quads, n_vertices) = (surface.n_quads(), surface.n_vertices());
        // At most 3 points an edge and 5 a quad, 2 a vertex; checked once so that plain u32 arithmetic is safe.
        let bound = 3 * n_vertices + 6 * n_quads + 5 * n_quads;
        if bound > u32::MAX as usize {
            return Err(ConstructError::TooLarge { what: "vertices", given: bound, limit: u32::MAX as usize });
        }
        let mut next = PointId::new(n_vertices);
        // Ranks, not hashes: what a point is called follows from its vertex, edge or quad alone, so the cells on both
        // sides of an edge name it alike without knowing of each other.
        let mut take = |n: u32| {
            let first = next;
            next = next.plus(n);
            first
        };
        let vertices = || (0..n_vertices).map(VertexId::new);
        let used = |v: VertexId| surface.degree(v) > 0;
        let inner = vertices().map(|v| if used(v) { take(1) } else { PointId::NONE }).collect();
        let middle = vertices().map(|v| if white[v] { take(1) } else { PointId::NONE }).collect();
        let mut edge = IdVec::filled(PointId::NONE, 4 * n_quads);
        for d in surface.darts() {
            let twin = surface.twin(d);
            if d < twin {
                // Uncut: e and x, or e, y, z. Cut: ed and eo, and s if heavy.
                let first = take(2 + u32::from(!sides.light[d]));
                edge[d] = first;
                edge[twin] = first;
            }
        }
        let turn: IdVec<QuadId, u8> = (0..n_quads).map(|q| turn_of(surface, white, QuadId::new(q))).collect();
        let points_of = |(q, &turn): (QuadId, &u8)| {
            let corners = surface.quad(q);
            // Diagonals join black corners and Sigma never crosses them. So a triangle has no cut edge (its odd
            // corner is white: one point) or two (black: a point on either side).
            let odd = [1, 3].map(|k| corners[(k + usize::from(turn)) % 4]);
            take(1 + odd.iter().map(|&v| if white[v] { 1 } else { 2 }).sum::<u32>())
        };
        let facet = turn.enumerate().map(points_of).collect();
        // A consistent start: the star at the end with the smaller id.
        let star_at_origin = surface.darts().map(|d| surface.origin(d) < surface.target(d)).collect();
        let mut layer = Self { surface, white, inner, middle, edge, sides, star_at_origin, facet, turn, end: next };
        layer.choose_stars(plan.library);
        // Asked before anything is made: the built-in libraries have every pattern, one of the caller's may not.
        let mut patterns = (0..n_quads).map(QuadId::new).filter(|&q| !layer.is_open(q)).map(|q| layer.pattern(q));
        match patterns.find(|pattern| plan.library.find(pattern).is_none()) {
            Some(pattern) => Err(ConstructError::NoCell { pattern }),
            None => Ok(layer),
        }
    }

    /// The star of a heavy black-black side may be joined to either end: take the end that makes the two cells
    /// small, or gives them cells that have positions. Two sweeps; the order is that of the darts, so the result is always the same.
    fn choose_stars(&mut self, library: &CellLibrary) {
        let surface = self.surface;
        let cost = |layer: &Self, d: Dart| -> usize {
            [d, surface.twin(d)].map(|d| library.cost(&layer.pattern(d.quad()))).iter().sum()
        };
        // Only the two cells at an edge change with its star, so the sum over all cells falls with every exchange
        // that is kept.
        for _ in 0..2 {
            for d in surface.darts() {
                let twin = surface.twin(d);
                if d > twin || !self.is_heavy(d) || !self.is_cut(d) {
                    continue;
                }
                let before = cost(self, d);
                for e in [d, twin] {
                    self.star_at_origin[e] ^= true;
                }
                if cost(self, d) >= before {
                    for e in [d, twin] {
                        self.star_at_origin[e] ^= true;
                    }
                }
            }
        }
    }

    fn is_heavy(&self, d: Dart) -> bool {
        !self.sides.light[d]
    }

    /// Whether Sigma crosses the inner edge under a dart.
    pub(crate) fn is_cut(&self, d: Dart) -> bool {
        !self.white[self.surface.origin(d)] && !self.white[self.surface.target(d)]
    }

    /// Whether the cube of a quad is left open.
    pub(crate) fn is_open(&self, q: QuadId) -> bool {
        self.sides.open[q]
    }

    /// First id after the layer's walls.
    pub(crate) fn end(&self) -> PointId {
        self.end
    }

    /// Quads of the surface.
    pub(crate) fn n_quads(&self) -> usize {
        self.turn.len()
    }

    /// Quads that the matching left over.
    pub(crate) fn n_unmatched(&self) -> usize {
        self.sides.n_unmatched
    }

    /// The inner copy of a vertex.
    pub(crate) fn inner(&self, v: VertexId) -> PointId {
        self.inner[v]
    }

    /// The dart of side `k` of a quad's pattern.
    pub(crate) fn dart(&self, q: QuadId, k: u8) -> Dart {
        Dart::new(q, u32::from((k + self.turn[q]) % 4))
    }

    /// The vertex at corner `k` of a quad's pattern.
    pub(crate) fn corner(&self, q: QuadId, k: u8) -> VertexId {
        self.surface.origin(self.dart(q, k))
    }

    /// The pattern of a quad's cell.
    pub(crate) fn pattern(&self, q: QuadId) -> Pattern {
        let white = [1, 3].map(|k| self.white[self.corner(q, k)]);
        let side = |k: u8| {
            let d = self.dart(q, k);
            if !self.is_heavy(d) {
                Side::Light
            } else if !self.is_cut(d) {
                Side::Heavy
            } else if self.star_at_origin[d] == k.is_multiple_of(2) {
                // Sides 0 and 2 start from a diagonal corner, 1 and 3 from an odd one.
                Side::StarDiagonal
            } else {
                Side::StarOdd
            }
        };
        Pattern { white, sides: [side(0), side(1), side(2), side(3)] }
    }

    /// The point of the inner edge under dart `d` on the side of its origin (both sides agree if it is not cut).
    pub(crate) fn edge_point(&self, d: Dart) -> PointId {
        let twin = self.surface.twin(d);
        let first = self.edge[d];
        if self.is_cut(d) { first.plus(u32::from(d > twin)) } else { first }
    }

    /// The points of the inner edge under dart `d` at its origin and at its target (equal if it is not cut).
    pub(crate) fn edge_points(&self, d: Dart) -> (PointId, PointId) {
        (self.edge_point(d), self.edge_point(self.surface.twin(d)))
    }

    /// Midpoint of the diagonal of a quad's inner facet.
    pub(crate) fn diagonal_point(&self, q: QuadId) -> PointId {
        self.facet[q]
    }

    /// The point of inner triangle `t` of a quad on the side of its odd corner (`lone`) or of its diagonal; both
    /// agree if the triangle is not cut.
    pub(crate) fn face_point(&self, q: QuadId, t: u8, lone: bool) -> PointId {
        let white = |t: u8| self.white[self.corner(q, 2 * t + 1)];
        let size = |t: u8| if white(t) { 1 } else { 2 };
        let first = self.facet[q].plus(1 + if t == 1 { size(0) } else { 0 });
        first.plus(u32::from(!white(t) && !lone))
    }

    /// The id of a boundary point of a quad's cell.
    pub(crate) fn point(&self, q: QuadId, role: Role) -> PointId {
        let edge = |k: u8| self.edge[self.dart(q, k)];
        match role {
            Role::Outer(k) => PointId(self.corner(q, k).0),
            Role::Inner(k) => self.inner(self.corner(q, k)),
            Role::Middle(k) => self.middle[self.corner(q, k)],
            Role::Edge(k) => edge(k),
            Role::EdgeDiagonal(k) => {
                let d = self.dart(q, k);
                self.edge_point(if k.is_multiple_of(2) { d } else { self.surface.twin(d) })
            }
            Role::EdgeOdd(k) => {
                let d = self.dart(q, k);
                self.edge_point(if k.is_multiple_of(2) { self.surface.twin(d) } else { d })
            }
            Role::X(k) | Role::Y(k) => edge(k).plus(1),
            Role::Z(k) | Role::Star(k) => edge(k).plus(2),
            Role::Diagonal => self.diagonal_point(q),
            Role::Face(t) | Role::FaceLone(t) => self.face_point(q, t, true),
            Role::FacePair(t) => self.face_point(q, t, false),
            Role::Interior(_) => PointId::NONE,
        }
    }
}
