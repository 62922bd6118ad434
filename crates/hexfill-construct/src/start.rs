//! Step 9: start positions. Every buffer cube is the trilinear image of its cell's template, the core's points are
//! means of the tets' corners. What an embedding then has to do is local.
//!
//! The template lives in `[-1, 1]^3` with the surface at z = -1 and the core above: corner 0 at (-1, -1), 1 at (-1, 1),
//! 2 at (1, 1), 3 at (1, -1). All sides are planar and congruent: a point of a side has coordinates (u, z), u = -1 at
//! the diagonal corner and +1 at the odd corner, so neighbours agree on it. The inner copy of the surface is the
//! surface scaled by one half towards a point that sees all of it, if the core is a cone from there, else an offset along
//! the vertex normals by a part of the shortest edge at the vertex.

use crate::ball::centroid;
use crate::cell::{Cell, CellLibrary};
use crate::layer::Layer;
use crate::pattern::{Pattern, Role, Side};
use crate::split::CorePoints;
use crate::tets::{TET_EDGES, TetComplex, others};
use crate::vector::{Point, bounding_box, cross, dot, sub, volume};
use hexfill_mesh::cube::EDGES;
use hexfill_mesh::{Dart, QuadId, QuadSurface};

/// Share of the shortest edge by which the inner copy is moved inward; more where there is room.
const OFFSET: f64 = 0.4;
const OFFSET_IF_STAR: f64 = 0.6;

/// Position of corner `k` of the template in the plane.
const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]];

/// Where the template has a boundary point of a pattern's cell.
pub fn template_position(pattern: &Pattern, role: Role) -> Point {
    let at = |k: u8, z: f64| {
        let [x, y] = CORNERS[usize::from(k)];
        [x, y, z]
    };
    let on_side = |k: u8, u: f64, z: f64| {
        let a = CORNERS[usize::from(Pattern::diagonal_corner(k))];
        let b = CORNERS[usize::from(Pattern::odd_corner(k))];
        let s = (1.0 + u) / 2.0;
        [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), z]
    };
    // Along the line from the centre to the odd corner of a triangle.
    let in_triangle = |t: u8, s: f64| {
        let [x, y] = CORNERS[usize::from(2 * t + 1)];
        [s * x, s * y, 1.0]
    };
    match role {
        Role::Outer(k) => at(k, -1.0),
        Role::Inner(k) => at(k, 1.0),
        Role::Middle(k) => at(k, 0.3241692943093266),
        Role::Edge(k) => on_side(k, 0.3818478484319652, 1.0),
        // A little above the corners: the light black-black side has a quad between them and the corners. Mirror images, because
        // what is the odd corner here may be the diagonal corner of the neighbour.
        Role::EdgeDiagonal(k) => on_side(k, -0.35, 1.38),
        Role::EdgeOdd(k) => on_side(k, 0.35, 1.38),
        Role::X(k) => on_side(k, 0.04649937557664252, -0.04567703642278415),
        Role::Y(k) => on_side(k, 0.25102760006182834, 0.7354842617333364),
        Role::Z(k) => on_side(k, -0.06305424588624131, 0.543869623529535),
        Role::Star(k) if pattern.sides[usize::from(k)] == Side::StarOdd => on_side(k, -0.05, 0.55),
        Role::Star(k) => on_side(k, 0.05, 0.55),
        Role::Diagonal => [0.0, 0.0, 1.0],
        Role::Face(t) => in_triangle(t, 0.4),
        Role::FaceLone(t) => in_triangle(t, 0.5),
        Role::FacePair(t) => in_triangle(t, 0.25),
        Role::Interior(_) => [0.0; 3],
    }
}

/// Positions of all points of a cell in the template: those of its file, else [`template_position`] and, inside, means
/// of the neighbours.
pub fn template(cell: &Cell) -> Vec<Point> {
    if let Some(positions) = &cell.positions {
        return positions.clone();
    }
    let mut p: Vec<Point> = cell.points.iter().map(|&r| template_position(&cell.pattern, r)).collect();
    let mut neighbours = vec![Vec::new(); p.len()];
    for hex in &cell.hexes {
        for [i, j] in EDGES {
            let (a, b) = (hex[i], hex[j]);
            for (v, w) in [(a, b), (b, a)] {
                if !neighbours[usize::from(v)].contains(&w) {
                    neighbours[usize::from(v)].push(w);
                }
            }
        }
    }
    for _ in 0..200 {
        for v in cell.n_boundary..p.len() {
            let n = neighbours[v].len() as f64;
            p[v] = std::array::from_fn(|c| neighbours[v].iter().map(|&w| p[usize::from(w)][c]).sum::<f64>() / n);
        }
    }
    p
}

/// The inner copy of every vertex: where a fan of hexes under the surface ends.
pub(crate) struct InnerCopy {
    outer: Vec<Point>,
    /// Per vertex: from the surface to its inner copy.
    step: Vec<Point>,
    /// Per vertex: a dart that starts there.
    first: Vec<Option<Dart>>,
}

impl InnerCopy {
    /// Half way to `centre`, a point that sees the whole surface.
    pub(crate) fn half_way(surface: &QuadSurface, points: &[Point], centre: Point) -> Self {
        let step = points.iter().map(|&p| std::array::from_fn(|c| (centre[c] - p[c]) / 2.0)).collect();
        Self { outer: points.to_vec(), step, first: surface.dart_of_vertices() }
    }

    /// Along the directions that all quads at a vertex face, as far as every buffer cube keeps positive corners. A
    /// star-shaped surface has room for longer steps.
    pub(crate) fn offset(surface: &QuadSurface, points: &[Point], is_star: bool) -> Self {
        let outer = points.to_vec();
        let first = surface.dart_of_vertices();
        let share = if is_star { OFFSET_IF_STAR } else { OFFSET };
        let mut copy = Self { outer, step: offsets(surface, points, share), first };
        copy.shorten(surface, |copy, blame| {
            for q in 0..surface.n_quads() {
                let corners = surface.quad(QuadId::new(q)).map(|v| v.index());
                if !copy.cube_is_positive(&corners) {
                    blame.extend(corners);
                }
            }
        });
        copy
    }

    /// Where the inner copy of vertex `v` lies.
    pub(crate) fn at(&self, v: usize) -> Point {
        std::array::from_fn(|c| self.outer[v][c] + self.step[v][c])
    }

    /// All of them.
    pub(crate) fn points(&self) -> Vec<Point> {
        (0..self.outer.len()).map(|v| self.at(v)).collect()
    }

    /// Shortens the steps until no tetrahedron is inside out that is right with the surface's own positions. Tetrahedra that
    /// are only topological (a share of them is inside out from the start) are left alone.
    pub(crate) fn fit_to_tets(&mut self, surface: &QuadSurface, complex: &TetComplex) {
        let Some(points) = complex.points.as_ref() else { return };
        let n_surface = self.outer.len();
        let right = |tet: &[u32; 4], at: &dyn Fn(u32) -> Point| volume(tet.map(at)) > 0.0;
        let geometric: Vec<&[u32; 4]> = complex.tets.iter().filter(|t| right(t, &|v| points[v as usize])).collect();
        if 100 * geometric.len() < 99 * complex.tets.len() {
            return;
        }
        self.shorten(surface, |inner, blame| {
            let at = |v: u32| if (v as usize) < n_surface { inner.at(v as usize) } else { points[v as usize] };
            for tet in &geometric {
                if !right(tet, &at) {
                    blame.extend(tet.iter().map(|&v| v as usize).filter(|&v| v < n_surface));
                }
            }
        });
    }

    /// Halves the steps of the vertices that `faults` names until it names none, or often enough; a step that is much longer
    /// than a neighbour's is shortened as well, so that the layer's cubes keep their shape.
    fn shorten(&mut self, surface: &QuadSurface, faults: impl Fn(&Self, &mut Vec<usize>)) {
        const STEEPEST: f64 = 1.5;
        let length = |p: &Point| dot(*p, *p).sqrt();
        let mut blame = Vec::new();
        for _ in 0..SHORTENINGS {
            blame.clear();
            faults(self, &mut blame);
            if blame.is_empty() {
                return;
            }
            blame.sort_unstable();
            blame.dedup();
            for &v in &blame {
                self.step[v] = self.step[v].map(|x| x / 2.0);
            }
            // Outward from what was shortened; every vertex is entered only to become shorter.
            while let Some(v) = blame.pop() {
                let Some(start) = self.first[v].filter(|_| self.step[v] != [0.0; 3]) else { continue };
                for d in surface.round_vertex(start) {
                    let w = surface.target(d).index();
                    let most = STEEPEST * length(&self.step[v]);
                    let now = length(&self.step[w]);
                    if now > most * (1.0 + 1e-9) {
                        self.step[w] = self.step[w].map(|x| x * (most / now));
                        blame.push(w);
                    }
                }
            }
        }
    }

    /// Whether the frame of every corner of a buffer cube is well positive.
    fn cube_is_positive(&self, quad: &[usize; 4]) -> bool {
        let low = quad.map(|v| self.outer[v]);
        let high = quad.map(|v| self.at(v));
        let well =
            |a: Point, b: Point, c: Point| dot(a, cross(b, c)) > 0.02 * (dot(a, a) * dot(b, b) * dot(c, c)).sqrt();
        // Outward quads: the inner copy lies behind them.
        (0..4).all(|k| {
            let (next, prev) = ((k + 1) % 4, (k + 3) % 4);
            let up = sub(low[k], high[k]);
            well(sub(low[next], low[k]), sub(low[prev], low[k]), up)
                && well(sub(high[next], high[k]), sub(high[prev], high[k]), up)
        })
    }
}

/// A point that sees every corner of every quad of a single component, if one is found: the surface is then star-shaped. The
/// centroid, or else a point moved away from the plane it is least behind, over and over by less (a subgradient method for the
/// centre of the largest ball in the kernel). What is returned was tested.
pub(crate) fn star_centre(surface: &QuadSurface, points: &[Point]) -> Option<Point> {
    const STEPS: usize = 300;
    if surface.n_components() != 1 {
        return None;
    }
    let corners: Vec<[u32; 3]> =
        surface.darts().map(|d| [surface.origin(d.prev()).0, surface.origin(d).0, surface.target(d).0]).collect();
    let sees = |centre: Point| {
        corners.iter().all(|t| {
            let [a, b, c] = t.map(|v| sub(points[v as usize], centre));
            dot(a, cross(b, c)) > 0.0
        })
    };
    let mut centre = centroid(points, &corners);
    if sees(centre) {
        return Some(centre);
    }
    let planes: Vec<(Point, f64)> = corners
        .iter()
        .filter_map(|t| {
            let [a, b, c] = t.map(|v| points[v as usize]);
            let normal = cross(sub(b, a), sub(c, a));
            let length = dot(normal, normal).sqrt();
            let unit = normal.map(|x| x / length);
            (length > 0.0).then(|| (unit, dot(unit, a)))
        })
        .collect();
    let (_, _, size) = bounding_box(points);
    for step in 0..STEPS {
        // How far the point is behind each plane.
        let depth = |(normal, height): &(Point, f64)| height - dot(*normal, centre);
        let least = planes.iter().min_by(|a, b| depth(a).total_cmp(&depth(b)))?;
        if depth(least) > 0.0 && sees(centre) {
            return Some(centre);
        }
        // From a place outside straight behind the plane; less and less of it, so that it settles.
        let by = (0.25 * size / (step + 1) as f64).max(-depth(least));
        centre = std::array::from_fn(|c| centre[c] - by * least.0[c]);
    }
    None
}

/// How often a step may be halved.
const SHORTENINGS: usize = 12;

/// Per vertex: a step inward, `share` of the shortest edge there long, in the direction whose smallest product with the
/// inward normals of the quads' corners is largest (found by leaning towards the worst one, over and over).
fn offsets(surface: &QuadSurface, points: &[Point], share: f64) -> Vec<Point> {
    let at = |d: Dart| points[surface.origin(d).index()];
    let scaled = |p: Point, by: f64| p.map(|x| x * by);
    let first = surface.dart_of_vertices();
    let offset = |v: usize| -> Option<Point> {
        let mut normals: Vec<Point> = Vec::new();
        let mut shortest = f64::INFINITY;
        for d in surface.round_vertex(first[v]?) {
            let here = sub(at(d.next()), at(d));
            let n = cross(sub(at(d.prev()), at(d)), here);
            let length = dot(n, n).sqrt();
            if length > 0.0 {
                normals.push(scaled(n, 1.0 / length));
            }
            shortest = shortest.min(dot(here, here).sqrt());
        }
        let mut sum = normals.iter().fold([0.0; 3], |s, n| std::array::from_fn(|c| s[c] + n[c]));
        for step in 0..100 {
            let worst = normals.iter().min_by(|a, b| dot(**a, sum).total_cmp(&dot(**b, sum)))?;
            let weight = dot(sum, sum).sqrt() / f64::from(step + 4);
            sum = std::array::from_fn(|c| sum[c] + weight * worst[c]);
        }
        let length = dot(sum, sum).sqrt();
        (length > 1e-9 && shortest.is_finite()).then(|| scaled(sum, share * shortest / length))
    };
    (0..points.len()).map(|v| offset(v).unwrap_or([0.0; 3])).collect()
}

/// Trilinear map of the template's cube to the hexahedron with outer corners `low` and inner corners `high`.
fn trilinear(low: &[Point; 4], high: &[Point; 4], p: Point) -> Point {
    let weight = |k: usize| (1.0 + CORNERS[k][0] * p[0]) * (1.0 + CORNERS[k][1] * p[1]) / 4.0;
    let s = (1.0 + p[2]) / 2.0;
    std::array::from_fn(|c| (0..4).map(|k| weight(k) * ((1.0 - s) * low[k][c] + s * high[k][c])).sum())
}

/// Start positions of every vertex of the mesh; those of the surface are its own, bit for bit.
pub(crate) fn start_positions(
    surface: &QuadSurface,
    inner: &InnerCopy,
    layer: &Layer<'_>,
    library: &CellLibrary,
    complex: &TetComplex,
    core: &CorePoints,
) -> Vec<Point> {
    let points = inner.outer.as_slice();
    let mut out = vec![[0.0; 3]; core.end as usize];
    out[..points.len()].copy_from_slice(points);
    // Core first: what lies on the inner facets is then written again by the cells.
    let vertex = |v: u32| match complex.points.as_ref() {
        _ if (v as usize) < points.len() => inner.at(v as usize),
        Some(p) => p[v as usize],
        None => [0.0; 3],
    };
    for (t, tet) in complex.tets.iter().enumerate() {
        let p = tet.map(vertex);
        let mean = |local: &[usize], weights: &[f64]| -> Point {
            let total: f64 = weights.iter().sum();
            std::array::from_fn(|c| local.iter().zip(weights).map(|(&i, w)| w * p[i][c]).sum::<f64>() / total)
        };
        let mut side = [false; 4];
        for (k, &[i, j]) in TET_EDGES.iter().enumerate() {
            let [low, high] = core.edge[complex.tet_edges[t][k] as usize];
            let (i, j) = if tet[i] < tet[j] { (i, j) } else { (j, i) };
            if low == high {
                out[low as usize] = mean(&[i, j], &[1.0, 1.0]);
            } else {
                out[low as usize] = mean(&[i, j], &[2.0, 1.0]);
                out[high as usize] = mean(&[i, j], &[1.0, 2.0]);
            }
            if i == 0 || j == 0 {
                side[i.max(j)] = low != high;
            }
        }
        let split = |local: &[usize], near: bool| {
            let weights: Vec<f64> = local.iter().map(|&i| if side[i] == near { 2.0 } else { 1.0 }).collect();
            mean(local, &weights)
        };
        for i in 0..4 {
            let f = others(i);
            let [lone, pair] = core.face[complex.tet_faces[t][i] as usize];
            if lone == pair {
                out[lone as usize] = mean(&f, &[1.0; 3]);
            } else {
                let n_far = f.iter().filter(|&&k| side[k]).count();
                out[lone as usize] = split(&f, n_far == 1);
                out[pair as usize] = split(&f, n_far == 2);
            }
        }
        let [near, far] = core.tet[t];
        out[near as usize] = if near == far { mean(&[0, 1, 2, 3], &[1.0; 4]) } else { split(&[0, 1, 2, 3], false) };
        if near != far {
            out[far as usize] = split(&[0, 1, 2, 3], true);
        }
        for (i, &v) in tet.iter().enumerate() {
            out[core.vertex[v as usize] as usize] = p[i];
        }
    }
    let templates: Vec<Vec<Point>> = library.cells().iter().map(template).collect();
    let mut next = layer.n_points() as usize;
    for q in 0..surface.n_quads() {
        let quad = QuadId::new(q);
        let Some(cell) = library.find(&layer.pattern(quad)) else { continue };
        let corners = [0, 1, 2, 3].map(|k| layer.corner(quad, k).index());
        let (low, high) = (corners.map(|v| points[v]), corners.map(|v| inner.at(v)));
        for (i, &p) in templates[cell.cell].iter().enumerate() {
            let at = trilinear(&low, &high, cell.symmetry.position(p));
            match cell.boundary.get(i) {
                Some(&role) => {
                    let id = layer.point(quad, role) as usize;
                    if id >= points.len() {
                        out[id] = at;
                    }
                }
                None => {
                    out[next] = at;
                    next += 1;
                }
            }
        }
    }
    out
}
