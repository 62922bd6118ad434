//! Blocks: a solid that is no columns as a whole is cut where two blocks meet, and each is columns, or cells of a grid, for itself.
//!
//! Idea: legs of a bracket, lugs, bores that cross: each block has a direction of its own, and where two of them meet a loop of edges runs straight round
//! the solid, often through a concave crease. A loop with four corners and sides of equal lengths is the rim of a grid of quads (the *cut*), which closes both parts.
//! Blocks are cut off, the largest first, until what is left is a block as well. (Users of sweeping tools do this by hand.)
//!
//! Invariant: the quads of the surface stay; vertices inside a cut are new, and both its blocks have them.
//!
//! Source: ours; decomposition into parts that can be swept is White, Saigal, Benzley 2004 (abstract), who read it off feature edges.

use crate::angles::wanted_hexes;
use crate::dart::next;
use crate::develop::develop;
use crate::front::{Front, NONE};
use crate::polycube::polycube;
use crate::section::columns;
use hexfill_geometry::{Vector, cone, dot, sub};
use hexfill_mesh::{Context, Dart, QuadSurface};

/// Surfaces of more quads are not cut.
const MOST_QUADS: usize = 10_000;
/// Blocks at most.
const MOST_BLOCKS: usize = 12;
/// Loops that are looked at for each cut.
const MOST_LOOPS: usize = 500;
/// Vertices a loop may pass where more than one way goes on, and the degree beyond which it passes none: tips have hundreds of ways.
const MOST_IRREGULAR: usize = 3;
const MOST_DEGREE: usize = 8;
/// Edges that loops are followed along, in all, for each quad of a part.
const STEPS: usize = 64;
/// Quads of the parts that are tried, in all.
const MOST_TRIED: usize = 1_000_000;
/// An edge that wants fewer hexes than this cannot be parted.
const PARTED: f32 = 1.5;
/// An edge that wants more is concave.
const CONCAVE: f32 = 2.5;
/// The cosine beyond which two edges of a loop meet in a corner of its cut: that of 135 degrees.
const CORNER: f64 = -std::f64::consts::FRAC_1_SQRT_2;

/// Beyond this one edge goes straight on from another.
const STRAIGHT: f64 = -0.9;

/// Part of the solid: its quads with the vertices of the whole.
type Quads = Vec<[u32; 4]>;
type Hexes = Vec<[u32; 8]>;

/// The hexes of a solid that is cut into blocks, vertices of the surface first; `None` if no cuts were found.
pub(crate) fn blocks(surface: &QuadSurface, points: &[Vector], ctx: &Context<'_>) -> Option<Hexes> {
    if surface.n_components() > 1 || surface.n_quads() > MOST_QUADS {
        return None;
    }
    let points = points.iter().copied().map(Some).collect();
    let mut solid = Solid { points, hexes: Vec::new(), tried: 0 };
    let whole: Quads = surface.quads_raw();
    let mut rest = whole.clone();
    for _ in 1..MOST_BLOCKS {
        let (block, other, is_last) = solid.cut_off(&rest, ctx)?;
        solid.fill(&block)?;
        if is_last {
            solid.fill(&other)?;
            Front::try_from_parts(solid.points.len() as u32, &whole, &solid.hexes, &[]).ok()?;
            return Some(solid.hexes);
        }
        rest = other;
    }
    None
}

/// What is filled so far.
struct Solid {
    /// Per vertex: where it is, if it lies on the surface or a cut.
    points: Vec<Option<Vector>>,
    hexes: Hexes,
    /// Quads of the parts that were tried.
    tried: usize,
}

/// A part as a surface of its own.
struct Part {
    surface: QuadSurface,
    points: Vec<Vector>,
    wanted: Vec<f32>,
    /// Its vertices in the whole.
    vertices: Vec<u32>,
}

/// A loop of edges and the grid of quads inside, which runs along it.
struct Cut {
    darts: Vec<u32>,
    rim: Vec<u32>,
    grid: [usize; 2],
}

/// The cosine of the angle at `b`.
fn cosine(a: Vector, b: Vector, c: Vector) -> f64 {
    let (u, w) = (sub(a, b), sub(c, b));
    dot(u, w) / (dot(u, u) * dot(w, w)).sqrt()
}

impl Solid {
    fn part(&self, quads: &Quads) -> Option<Part> {
        let mut vertices: Vec<u32> = quads.iter().flatten().copied().collect();
        vertices.sort_unstable();
        vertices.dedup();
        let number = |v: u32| vertices.binary_search(&v).expect("all vertices are listed") as u32;
        let own: Quads = quads.iter().map(|q| q.map(number)).collect();
        let surface = QuadSurface::try_new(vertices.len(), &own).ok()?;
        let points = vertices.iter().map(|&v| self.points[v as usize]).collect::<Option<Vec<Vector>>>()?;
        let wanted = wanted_hexes(&surface, Some(&points));
        Some(Part { surface, points, wanted, vertices })
    }

    /// Fills a part that is a block.
    fn fill(&mut self, quads: &Quads) -> Option<()> {
        let part = self.part(quads)?;
        let hexes = part.filled()?;
        let first = self.points.len() as u32;
        let n = part.vertices.len() as u32;
        let n_vertices = hexes.iter().flatten().max().map_or(0, |v| v + 1).max(n);
        self.points.resize((first + n_vertices - n) as usize, None);
        self.hexes
            .extend(hexes.iter().map(|h| h.map(|v| if v < n { part.vertices[v as usize] } else { first + v - n })));
        Some(())
    }

    /// Cuts the largest block off: its quads, the others, and whether these are a block as well.
    fn cut_off(&mut self, quads: &Quads, ctx: &Context<'_>) -> Option<(Quads, Quads, bool)> {
        let part = self.part(quads)?;
        let n_points = self.points.len();
        let mut best: Option<(usize, Cut, bool)> = None;
        let mut is_last = false;
        for cut in part.cuts() {
            if ctx.stop().is_some() || self.tried > MOST_TRIED {
                return None;
            }
            let sides = self.parted(&part, &cut);
            let is_block = sides.map(|sides| {
                let sizes = sides.each_ref().map(Vec::len);
                self.tried += sizes[0] + sizes[1];
                (sizes, sides.map(|quads| self.part(&quads).is_some_and(|p| p.filled().is_some())))
            });
            // Only a trial: the cut is made again if it is taken.
            self.points.truncate(n_points);
            match is_block {
                Some((_, [true, true])) => {
                    (best, is_last) = (Some((0, cut, false)), true);
                    break;
                }
                // What is left is cut again, so the less the better.
                Some((sizes, [first, second])) if first != second => {
                    let left = sizes[usize::from(first)];
                    if best.as_ref().is_none_or(|(least, ..)| left < *least) {
                        best = Some((left, cut, second));
                    }
                }
                _ => (),
            }
        }
        let (_, cut, is_second) = best?;
        let [first, second] = self.parted(&part, &cut)?;
        Some(if is_second { (second, first, is_last) } else { (first, second, is_last) })
    }

    /// Both sides of a cut, with new vertices inside of it; `None` if the loop does not part the surface, or the cut lies outside.
    fn parted(&mut self, part: &Part, cut: &Cut) -> Option<[Quads; 2]> {
        let n = part.surface.n_quads();
        let mut is_rim = vec![false; 4 * n];
        for &d in &cut.darts {
            is_rim[d as usize] = true;
            is_rim[part.surface.twin(Dart(d)).index()] = true;
        }
        let mut side = vec![false; n];
        let mut work = vec![cut.darts[0] / 4];
        side[work[0] as usize] = true;
        while let Some(q) = work.pop() {
            for d in (4 * q..4 * q + 4).filter(|&d| !is_rim[d as usize]) {
                let t = part.surface.twin(Dart(d)).quad();
                if !std::mem::replace(&mut side[t.index()], true) {
                    work.push(t.0);
                }
            }
        }
        let is_left = |d: u32| side[(d / 4) as usize];
        if cut.darts.iter().any(|&d| !is_left(d) || is_left(part.surface.twin(Dart(d)).0)) {
            return None;
        }
        let across = self.grid(part, cut);
        let mut sides = [Quads::new(), Quads::new()];
        for (q, quad) in part.surface.quads().iter().enumerate() {
            sides[usize::from(!side[q])].push(quad.map(|v| part.vertices[v.index()]));
        }
        sides[0].extend(across.iter().map(|&[a, b, c, d]| [d, c, b, a]));
        sides[1].extend(across);
        let volume = |quads: &Quads| -> Option<f64> {
            quads
                .iter()
                .map(|q| q.map(|v| self.points[v as usize]))
                .map(|[a, b, c, d]| Some(cone([a?, b?, c?, d?])))
                .sum()
        };
        // A cut through the air has a part that is inside out.
        sides.iter().all(|quads| volume(quads).is_some_and(|v| v > 0.0)).then_some(sides)
    }

    /// The quads of a cut, along its loop; its inner vertices lie evenly between the sides (Coons patch).
    fn grid(&mut self, part: &Part, cut: &Cut) -> Quads {
        let [p, q] = cut.grid;
        let rim = |i: usize| cut.rim[i % cut.rim.len()];
        let at = |i: usize| part.points[rim(i) as usize];
        let mut vertex = vec![NONE; (p + 1) * (q + 1)];
        for (i, j) in (0..=q).flat_map(|j| (0..=p).map(move |i| (i, j))) {
            // The loop runs along the low side, up, back along the high side, and down.
            let [low, right, high, left] = [i, p + j, p + q + (p - i), 2 * p + q + (q - j)];
            vertex[j * (p + 1) + i] = match (i, j) {
                (_, 0) => part.vertices[rim(low) as usize],
                (i, _) if i == p => part.vertices[rim(right) as usize],
                (_, j) if j == q => part.vertices[rim(high) as usize],
                (0, _) => part.vertices[rim(left) as usize],
                _ => {
                    let (x, y) = (i as f64 / p as f64, j as f64 / q as f64);
                    let corners = [0, p, p + q, 2 * p + q].map(at);
                    let point = |k: usize| {
                        let across = (1.0 - y) * at(low)[k] + y * at(high)[k];
                        let along = (1.0 - x) * at(left)[k] + x * at(right)[k];
                        let [a, b, c, d] = corners.map(|c| c[k]);
                        across + along - (1.0 - y) * ((1.0 - x) * a + x * b) - y * ((1.0 - x) * d + x * c)
                    };
                    self.points.push(Some([0, 1, 2].map(point)));
                    self.points.len() as u32 - 1
                }
            };
        }
        let corner = |i: usize, j: usize| vertex[j * (p + 1) + i];
        let quad = |n: usize| {
            let (i, j) = (n % p, n / p);
            [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]
        };
        (0..p * q).map(quad).collect()
    }
}

impl Part {
    /// The hexes of a block.
    fn filled(&self) -> Option<Hexes> {
        develop(&self.surface, &self.wanted, Some(&self.points)).and_then(|d| polycube(&self.surface, &d)).or_else(
            || {
                columns(&self.surface, &self.wanted, None, &Context::default())
                    .into_iter()
                    .next()
                    .map(|made| made.hexes)
            },
        )
    }

    /// Loops that have cuts, those through concave creases first.
    fn cuts(&self) -> Vec<Cut> {
        let mut starts: Vec<u32> = (0..4 * self.surface.n_quads() as u32)
            .filter(|&d| d < self.surface.twin(Dart(d)).0 && self.wanted[d as usize] >= PARTED)
            .collect();
        starts.sort_by_key(|&d| self.wanted[d as usize] < CONCAVE);
        let mut known = vec![false; 4 * self.surface.n_quads()];
        let mut cuts = Vec::new();
        let mut steps = STEPS * self.surface.n_quads();
        for d in starts {
            if cuts.len() >= MOST_LOOPS || steps == 0 {
                break;
            }
            if known[d as usize] {
                continue;
            }
            for darts in self.loops(d, &mut steps) {
                for &d in &darts {
                    known[d as usize] = true;
                    known[self.surface.twin(Dart(d)).index()] = true;
                }
                cuts.extend(self.cut(darts));
            }
        }
        cuts
    }

    /// The loops that run straight on from a dart, with all ways to pass vertices where several go on, in at most so many steps.
    fn loops(&self, first: u32, steps: &mut usize) -> Vec<Vec<u32>> {
        let start = self.surface.origin(Dart(first));
        let most = self.surface.n_quads();
        let mut found = Vec::new();
        let mut path = vec![first];
        // Depth first: how long the path was, how many choices it had met, and where it goes on instead.
        let mut others: Vec<(usize, usize, u32)> = Vec::new();
        let mut choices = 0;
        loop {
            let last = *path.last().expect("a path has its first dart");
            let ahead = self.straight(last);
            let is_closed = self.surface.target(Dart(last)) == start;
            if is_closed && ahead.contains(&first) {
                found.push(path.clone());
            }
            *steps = steps.saturating_sub(1);
            let is_choice = usize::from(ahead.len() > 1);
            if !is_closed
                && path.len() <= most
                && !ahead.is_empty()
                && choices + is_choice <= MOST_IRREGULAR
                && *steps > 0
            {
                choices += is_choice;
                others.extend(ahead[1..].iter().rev().map(|&d| (path.len(), choices, d)));
                path.push(ahead[0]);
            } else if let Some((length, met, d)) = others.pop().filter(|_| *steps > 0) {
                path.truncate(length);
                choices = met;
                path.push(d);
            } else {
                return found;
            }
        }
    }

    /// The darts that go on from the target of `d` and can be parted, two edges or more away from it on both sides.
    fn straight(&self, d: u32) -> Vec<u32> {
        let mut round = Vec::new();
        let mut at = next(d);
        while at != self.surface.twin(Dart(d)).0 {
            round.push(at);
            at = next(self.surface.twin(Dart(at)).0);
        }
        if round.len() >= MOST_DEGREE {
            return Vec::new();
        }
        let inner = round.get(1..round.len().saturating_sub(1)).unwrap_or(&[]);
        let ahead: Vec<u32> = inner.iter().copied().filter(|&d| self.wanted[d as usize] >= PARTED).collect();
        // Squares with round holes meet in vertices of degree eight: one of the ways is plainly the straight one.
        let bend = |&other: &u32| cosine(self.point(d), self.point(next(d)), self.point(next(other)));
        let straightest = ahead.iter().copied().min_by(|a, b| bend(a).total_cmp(&bend(b)));
        match straightest {
            Some(d) if ahead.len() > 1 && bend(&d) < STRAIGHT => vec![d],
            _ => ahead,
        }
    }

    /// Where a dart starts.
    fn point(&self, d: u32) -> Vector {
        self.points[self.surface.origin(Dart(d)).index()]
    }

    /// A loop as the rim of a grid: four corners, sides that face each other as long as each other, no vertex twice.
    fn cut(&self, mut darts: Vec<u32>) -> Option<Cut> {
        let origin = |d: u32| self.surface.origin(Dart(d)).0;
        let mut all: Vec<u32> = darts.iter().map(|&d| origin(d)).collect();
        all.sort_unstable();
        all.dedup();
        let n = darts.len();
        let is_corner = |i: usize| {
            let [a, b, c] = [i + n - 1, i, i + 1].map(|j| self.point(darts[j % n]));
            cosine(a, b, c) > CORNER
        };
        let corners: Vec<usize> = (0..n).filter(|&i| is_corner(i)).collect();
        let &[a, b, c, d] = &corners[..] else { return None };
        if all.len() < n || b - a != d - c || c - b != a + n - d {
            return None;
        }
        darts.rotate_left(a);
        let rim = darts.iter().map(|&d| origin(d)).collect();
        Some(Cut { darts, rim, grid: [b - a, c - b] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::Swept;
    use crate::test_surfaces::{boundary_of, judged, torus_at};
    use std::collections::BTreeMap;
    use std::f64::consts::FRAC_PI_2;

    type Place<'a> = &'a dyn Fn(Vector) -> Vector;

    /// A square of side 2 with a round hole, or without, and of some layers; at the places given, welded: its surface and number of hexes.
    fn welded(parts: &[(bool, usize, Place<'_>)]) -> (QuadSurface, Vec<Vector>, usize) {
        let mut ids = BTreeMap::new();
        let (mut points, mut hexes) = (Vec::new(), Vec::new());
        for &(hole, layers, place) in parts {
            // Four patches of four quads along a side and two rings; without a hole they go on to the middle.
            let point = |patch: usize, ring: usize, along: usize| {
                let angle = FRAC_PI_2 * (along as f64 / 4.0 - 0.5);
                let t = ring as f64 / 2.0;
                let [x, y] = [
                    1.0 * t + 0.5 * angle.cos() * (1.0 - t),
                    (along as f64 / 2.0 - 1.0) * t + 0.5 * angle.sin() * (1.0 - t),
                ];
                (0..patch).fold([x, y], |[x, y], _| [-y, x])
            };
            let grid = |i: usize, j: usize| [i as f64 / 2.0 - 1.0, j as f64 / 2.0 - 1.0];
            let ring = |n: usize| {
                let (p, r, a) = (n / 8, n / 4 % 2, n % 4);
                [point(p, r, a), point(p, r + 1, a), point(p, r + 1, a + 1), point(p, r, a + 1)]
            };
            let cell = |n: usize| {
                let (i, j) = (n % 4, n / 4);
                [grid(i, j), grid(i + 1, j), grid(i + 1, j + 1), grid(i, j + 1)]
            };
            let quads: Vec<[[f64; 2]; 4]> =
                if hole { (0..32).map(ring).collect() } else { (0..16).map(cell).collect() };
            for (quad, z) in quads.iter().flat_map(|q| (0..layers).map(move |z| (q, z))) {
                let hex: [u32; 8] = std::array::from_fn(|k| {
                    let [x, y] = quad[k % 4];
                    let p = place([x + 1.0, y + 1.0, (z + k / 4) as f64 / 2.0]);
                    let key = p.map(|x| (x * 1e6).round() as i64);
                    *ids.entry(key).or_insert_with(|| {
                        points.push(p);
                        points.len() as u32 - 1
                    })
                });
                // A place may be a reflection.
                let at = [0, 1, 3, 4].map(|k| points[hex[k] as usize]);
                let [a, b, c] = [1, 2, 3].map(|k| sub(at[k], at[0]));
                let [i, j, k, l, m, n, o, p] = hex;
                hexes.push(if hexfill_geometry::det(a, b, c) > 0.0 { hex } else { [m, n, o, p, i, j, k, l] });
            }
        }
        let (surface, points) = boundary_of(&points, &hexes);
        (surface, points, hexes.len())
    }

    fn check(parts: &[(bool, usize, Place<'_>)]) {
        let (surface, points, known) = welded(parts);
        assert!(
            columns(&surface, &wanted_hexes(&surface, Some(&points)), None, &Context::default()).is_empty(),
            "one cut at least"
        );
        let hexes = blocks(&surface, &points, &Context::default()).expect("blocks");
        let n_vertices = hexes.iter().flatten().max().unwrap() + 1;
        let swept = Swept { n_vertices, hexes, plugs: 0, front: Vec::new(), stopped: None };
        assert_eq!(judged(&surface, &swept), known);
    }

    #[test]
    fn bores_in_three_directions() {
        let along_y: Place<'_> = &|[x, y, z]| [x + 2.0, z, y];
        check(&[(true, 4, &|p| p), (true, 4, along_y)]);
        check(&[(true, 4, &|p| p), (true, 4, along_y), (true, 4, &|[x, y, z]| [z, x + 2.0, y])]);
    }

    #[test]
    fn a_box_with_lugs() {
        check(&[
            (false, 4, &|p| p),
            (true, 2, &|[x, y, z]| [x + 2.0, y, z + 0.5]),
            (true, 2, &|[x, y, z]| [z + 0.5, x + 2.0, y]),
            (true, 2, &|[x, y, z]| [y, z + 0.5, x + 2.0]),
        ]);
    }

    #[test]
    fn brackets_whose_creases_pass_vertices_of_high_degree() {
        let lying: [Place<'_>; 2] = [&|[x, y, z]| [x + 2.0, y, z], &|[x, y, z]| [x + 2.0, y + 2.0, z]];
        let upright: [Place<'_>; 2] = [&|[x, y, z]| [z, y, x + 2.0], &|[x, y, z]| [z, y + 2.0, x + 2.0]];
        // The legs are as thick as the square that joins them is long.
        let joint: [Place<'_>; 2] = [&|p| p, &|[x, y, z]| [x, y + 2.0, z]];
        for rows in [1, 2] {
            let of =
                |places: &[Place<'static>; 2], hole| places[..rows].iter().map(|&p| (hole, 4, p)).collect::<Vec<_>>();
            check(&[of(&lying, true), of(&upright, true), of(&joint, false)].concat());
        }
    }

    #[test]
    fn what_has_no_cuts_is_left_alone() {
        let (torus, points) = torus_at(12, 8);
        assert!(blocks(&torus, &points, &Context::default()).is_none());
        let cube = hexfill_mesh::generate::cube_surface();
        assert!(blocks(&cube, &[[0.0; 3]; 8], &Context::default()).is_none());
    }
}
