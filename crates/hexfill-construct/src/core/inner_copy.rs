//! The inner copy of the surface: the boundary of the core, in space.
//!
//! It is the surface scaled by one half towards a point that sees all of it, if the core is a cone from there, else an offset
//! along the vertex normals by a part of the shortest edge at the vertex, shortened until the buffer cubes have positive corners.
//!
//! Source: ours (book, page `construction`, "Positions: from topology to geometry").

use super::complex::TetComplex;
use hexfill_geometry::{Vector, add, add_scaled, cross, det, dot, norm, scale, sub, tet_volume};
use hexfill_mesh::{Dart, QuadSurface, VertexId};

/// Share of the shortest edge by which the inner copy is moved inward; more where there is room.
const OFFSET: f64 = 0.4;
const OFFSET_IF_STAR: f64 = 0.6;

/// How often a step may be halved.
const SHORTENINGS: usize = 12;

/// The inner copy of every vertex: where a fan of hexes under the surface ends.
pub(crate) struct InnerCopy {
    pub(crate) outer: Vec<Vector>,
    /// Per vertex: from the surface to its inner copy.
    step: Vec<Vector>,
    /// Per vertex: a dart that starts there.
    first: Vec<Option<Dart>>,
}

impl InnerCopy {
    /// Half way to `centre`, a point that sees the whole surface.
    pub(crate) fn half_way(surface: &QuadSurface, points: &[Vector], centre: Vector) -> Self {
        let step = points.iter().map(|&p| std::array::from_fn(|c| (centre[c] - p[c]) / 2.0)).collect();
        Self { outer: points.to_vec(), step, first: surface.dart_of_vertices() }
    }

    /// Along the directions that all quads at a vertex face, as far as every buffer cube keeps positive corners. A
    /// star-shaped surface has room for longer steps.
    pub(crate) fn offset(surface: &QuadSurface, points: &[Vector], is_star: bool) -> Self {
        let outer = points.to_vec();
        let first = surface.dart_of_vertices();
        let share = if is_star { OFFSET_IF_STAR } else { OFFSET };
        let mut copy = Self { outer, step: offsets(surface, points, share), first };
        copy.shorten(surface, |copy, blame| {
            for quad in surface.quads() {
                if !copy.cube_is_positive(quad) {
                    blame.extend(quad);
                }
            }
        });
        copy
    }

    /// Where the inner copy of vertex `v` lies.
    pub(crate) fn at(&self, v: VertexId) -> Vector {
        add(self.outer[v.index()], self.step[v.index()])
    }

    /// All of them.
    pub(crate) fn points(&self) -> Vec<Vector> {
        (0..self.outer.len()).map(|v| self.at(VertexId::new(v))).collect()
    }

    /// Shortens the steps until no tetrahedron is inside out that is right with the surface's own positions. Tetrahedra that
    /// are only topological (a share of them is inside out from the start) are left alone.
    pub(crate) fn fit_to_tets(&mut self, surface: &QuadSurface, complex: &TetComplex) {
        let Some(points) = complex.points.as_ref() else { return };
        let n_surface = self.outer.len();
        let right = |tet: &[VertexId; 4], at: &dyn Fn(VertexId) -> Vector| tet_volume(tet.map(at)) > 0.0;
        let geometric: Vec<&[VertexId; 4]> = complex.tets.iter().filter(|t| right(t, &|v| points[v.index()])).collect();
        if 100 * geometric.len() < 99 * complex.tets.len() {
            return;
        }
        self.shorten(surface, |inner, blame| {
            let at = |v: VertexId| if v.index() < n_surface { inner.at(v) } else { points[v.index()] };
            for tet in &geometric {
                if !right(tet, &at) {
                    blame.extend(tet.iter().filter(|v| v.index() < n_surface));
                }
            }
        });
    }

    /// Halves the steps of the vertices that `faults` names until it names none, or often enough; a step that is much longer
    /// than a neighbour's is shortened as well, so that the layer's cubes keep their shape.
    fn shorten(&mut self, surface: &QuadSurface, faults: impl Fn(&Self, &mut Vec<VertexId>)) {
        const STEEPEST: f64 = 1.5;
        let mut blame: Vec<VertexId> = Vec::new();
        for _ in 0..SHORTENINGS {
            blame.clear();
            faults(self, &mut blame);
            if blame.is_empty() {
                return;
            }
            blame.sort_unstable();
            blame.dedup();
            for &v in &blame {
                self.step[v.index()] = self.step[v.index()].map(|x| x / 2.0);
            }
            // Outward from what was shortened; every vertex is entered only to become shorter.
            while let Some(v) = blame.pop() {
                let here = self.step[v.index()];
                let Some(start) = self.first[v.index()].filter(|_| here != [0.0; 3]) else { continue };
                for d in surface.round_vertex(start) {
                    let w = surface.target(d);
                    let most = STEEPEST * norm(here);
                    let now = norm(self.step[w.index()]);
                    if now > most * (1.0 + 1e-9) {
                        self.step[w.index()] = scale(most / now, self.step[w.index()]);
                        blame.push(w);
                    }
                }
            }
        }
    }

    /// Whether the frame of every corner of a buffer cube is well positive.
    fn cube_is_positive(&self, quad: &[VertexId; 4]) -> bool {
        let low = quad.map(|v| self.outer[v.index()]);
        let high = quad.map(|v| self.at(v));
        let well = |a: Vector, b: Vector, c: Vector| det(a, b, c) > 0.02 * (dot(a, a) * dot(b, b) * dot(c, c)).sqrt();
        // Outward quads: the inner copy lies behind them.
        (0..4).all(|k| {
            let (next, prev) = ((k + 1) % 4, (k + 3) % 4);
            let up = sub(low[k], high[k]);
            well(sub(low[next], low[k]), sub(low[prev], low[k]), up)
                && well(sub(high[next], high[k]), sub(high[prev], high[k]), up)
        })
    }
}

/// Per vertex: a step inward, `share` of the shortest edge there long, in the direction whose smallest product with the
/// inward normals of the quads' corners is largest (found by leaning towards the worst one, over and over).
fn offsets(surface: &QuadSurface, points: &[Vector], share: f64) -> Vec<Vector> {
    let at = |d: Dart| points[surface.origin(d).index()];
    let first = surface.dart_of_vertices();
    let offset = |v: usize| -> Option<Vector> {
        let mut normals: Vec<Vector> = Vec::new();
        let mut shortest = f64::INFINITY;
        for d in surface.round_vertex(first[v]?) {
            let here = sub(at(d.next()), at(d));
            let n = cross(sub(at(d.prev()), at(d)), here);
            let length = norm(n);
            if length > 0.0 {
                normals.push(scale(1.0 / length, n));
            }
            shortest = shortest.min(norm(here));
        }
        let mut sum = normals.iter().fold([0.0; 3], |s, n| add(s, *n));
        for step in 0..100 {
            let worst = normals.iter().min_by(|a, b| dot(**a, sum).total_cmp(&dot(**b, sum)))?;
            let weight = norm(sum) / f64::from(step + 4);
            sum = add_scaled(sum, weight, *worst);
        }
        let length = norm(sum);
        (length > 1e-9 && shortest.is_finite()).then(|| scale(share * shortest / length, sum))
    };
    (0..points.len()).map(|v| offset(v).unwrap_or([0.0; 3])).collect()
}
