//! The matching for coordinates: of those that cost the same, one that keeps sharp vertices free of hexes.
//!
//! A buffer cube has few hexes at some corners of its outer quad and many at others (in the embedded 22-cell 6, 4, 3 and 7), so the
//! choice of its light side decides how many hexes share the solid angle at a vertex, and with it what scaled Jacobian is
//! possible there. The *strain* of a vertex is its number of hexes by its solid angle. Exchanging matched and unmatched edges along
//! short alternating cycles lowers the sum of a high power of the strains. Measured on Schneiders' pyramid: the worst
//! scaled Jacobian of an embedding follows the largest strain (see `record/`).
//!
//! Source: ours; measured in `record/construct-2026-11-21.md`.

use super::matching::LightSides;
use crate::cells::library::CellLibrary;
use crate::cells::pattern::Role;
use hexfill_geometry::{Vector, cross, det, dot, norm, sub};
use hexfill_mesh::{Dart, IdVec, QuadId, QuadSurface, VertexId};

/// Matched edges of an alternating cycle at most; fewer for large surfaces, so that the work stays linear.
const CYCLE: usize = 5;
const CYCLE_IF_LARGE: usize = 2;
const LARGE: usize = 20_000;
/// Sweeps over all matched pairs at most.
const SWEEPS: usize = 12;
/// The power of the strains that is summed: large, for the worst vertex counts.
const POWER: i32 = 6;
/// No solid angle counts as less (steradians).
const LEAST_ANGLE: f64 = 0.05;

/// A cell with one light side: its hexes at the outer corners, from the black end of the light side on.
fn loads(library: &CellLibrary) -> Option<[f64; 4]> {
    let pattern = "ww-lhhh".parse().ok()?;
    let cell = &library.cells()[library.find(&pattern)?.cell];
    let at = |k: u8| {
        let corner = cell.points.iter().position(|&r| r == Role::Outer(k));
        cell.hexes.iter().flatten().filter(|&&v| Some(usize::from(v)) == corner).count() as f64
    };
    Some([at(0), at(1), at(2), at(3)])
}

/// The solid angle inside the surface at every vertex: the area of a spherical polygon (Girard's theorem).
fn solid_angles(surface: &QuadSurface, points: &[Vector]) -> IdVec<VertexId, f64> {
    use std::f64::consts::PI;
    let first = surface.dart_of_vertices();
    let angle = |v: usize| {
        let Some(start) = first[v] else { return 2.0 * PI };
        let ends: Vec<Vector> =
            surface.round_vertex(start).map(|d| sub(points[surface.target(d).index()], points[v])).collect();
        let k = ends.len();
        let mut sum = 0.0;
        for i in 0..k {
            let (before, e, after) = (ends[(i + k - 1) % k], ends[i], ends[(i + 1) % k]);
            let (m, n) = (cross(before, e), cross(e, after));
            let length = norm(e);
            // Exterior turn at this corner of the spherical polygon, left positive.
            let turn = (det(e, m, n) / length).atan2(dot(m, n));
            sum += if turn.is_finite() { turn } else { 0.0 };
        }
        // Clockwise from outside is counter-clockwise on the sphere of directions: the inside is on the left.
        (2.0 * PI - sum).rem_euclid(4.0 * PI).max(LEAST_ANGLE)
    };
    (0..surface.n_vertices()).map(angle).collect()
}

/// The matching under improvement.
struct Strain<'a> {
    surface: &'a QuadSurface,
    white: &'a IdVec<VertexId, bool>,
    loads: [f64; 4],
    angle: IdVec<VertexId, f64>,
    /// Per vertex: hexes of the buffer cubes there.
    hexes: IdVec<VertexId, f64>,
    /// Per quad: its light dart.
    light: IdVec<QuadId, Dart>,
    cost: f64,
    cycle: usize,
}

impl Strain<'_> {
    /// Adds (or takes away) the hexes of quad `d.quad()` with light side `d`.
    fn add(&mut self, d: Dart, sign: f64) {
        let corners = self.surface.quad(d.quad());
        let k = d.side();
        // From the black end of the light side, away along it, round the quad.
        let black_first = !self.white[corners[k]];
        for i in 0..4 {
            let corner = if black_first { (k + i) % 4 } else { (k + 5 - i) % 4 };
            let v = corners[corner];
            self.cost -= self.term(v);
            self.hexes[v] += sign * self.loads[i];
            self.cost += self.term(v);
        }
    }

    fn term(&self, v: VertexId) -> f64 {
        (self.hexes[v] / self.angle[v]).powi(POWER)
    }

    fn set_light(&mut self, d: Dart) {
        let old = self.light[d.quad()];
        self.add(old, -1.0);
        self.add(d, 1.0);
        self.light[d.quad()] = d;
    }

    /// Looks for an alternating cycle that closes at `start` and lowers the cost below `bound`; `lost` has lost its mate.
    fn extend(&mut self, start: QuadId, lost: QuadId, path: &mut Vec<QuadId>, bound: f64) -> bool {
        let before = self.light[lost];
        for k in 0..4 {
            let d = Dart::new(lost, k);
            let across = self.surface.twin(d);
            let other = across.quad();
            // The lost quad needs a mate other than the one it had.
            if d == before || other == lost {
                continue;
            }
            if other == start {
                // The edge that was given up first is no way back.
                let first = self.light[start];
                if across == first {
                    continue;
                }
                self.set_light(d);
                self.set_light(across);
                if self.cost < bound {
                    return true;
                }
                // Both ends get back the side they had.
                self.set_light(first);
                self.set_light(before);
            } else if path.len() < self.cycle && !path.contains(&other) {
                let mate = self.light[other];
                let next = self.surface.twin(mate).quad();
                if path.contains(&next) || next == start {
                    continue;
                }
                self.set_light(d);
                self.set_light(across);
                path.push(other);
                path.push(next);
                let found = self.extend(start, next, path, bound);
                path.truncate(path.len() - 2);
                if found {
                    return true;
                }
                self.set_light(mate);
                self.set_light(before);
            }
        }
        false
    }
}

/// Improves a perfect matching; returns the sum of powers of the strains it ends with. `None` (and nothing done) if a quad has
/// more than one light side or the surface is not bipartite.
pub(crate) fn relieve(
    surface: &QuadSurface,
    points: &[Vector],
    white: &IdVec<VertexId, bool>,
    sides: &mut LightSides,
    library: &CellLibrary,
) -> Option<f64> {
    let loads = loads(library)?;
    let bipartite = surface.darts().all(|d| white[surface.origin(d)] != white[surface.target(d)]);
    if sides.n_unmatched > 0 || !bipartite {
        return None;
    }
    let n = surface.n_quads();
    let darts = |q: usize| (0..4).map(move |k| Dart::new(QuadId::new(q), k));
    // One light side a quad: a perfect matching of the dual graph. Exchanging along an alternating cycle keeps it
    // perfect, so hexes stay as few as they are.
    let light = (0..n).filter_map(|q| darts(q).find(|&d| sides.light[d])).collect();
    let mut strain = Strain {
        surface,
        white,
        loads,
        angle: solid_angles(surface, points),
        hexes: IdVec::filled(0.0, surface.n_vertices()),
        light,
        cost: 0.0,
        cycle: 2 * if n <= LARGE { CYCLE } else { CYCLE_IF_LARGE },
    };
    for q in (0..n).map(QuadId::new) {
        strain.add(strain.light[q], 1.0);
    }
    for _ in 0..SWEEPS {
        let mut improved = false;
        for start in strain.light.ids() {
            let mate = surface.twin(strain.light[start]).quad();
            // Each matched pair once.
            if mate <= start {
                continue;
            }
            // Running sums drift; an improvement has to be one.
            let bound = strain.cost * (1.0 - 1e-9);
            improved |= strain.extend(start, mate, &mut vec![start, mate], bound);
        }
        if !improved {
            break;
        }
    }
    sides.light = IdVec::filled(false, 4 * n);
    for &d in &strain.light {
        sides.light[d] = true;
    }
    Some(strain.hexes.ids().map(|v| strain.term(v)).sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cells::library::CellChoice;
    use crate::plan::colouring::colouring;
    use crate::plan::matching::light_sides;
    use hexfill_mesh::Context;
    use hexfill_mesh::generate::{cube_surface, voxel_surface};
    use std::f64::consts::PI;

    /// The unit cubes' corners in the order of `voxel_surface` are found by the faces' own geometry: any points will do
    /// for the cube, whose surface has them in VTK order.
    fn cube_points() -> Vec<Vector> {
        hexfill_mesh::cube::POSITIONS.map(|p| p.map(f64::from)).to_vec()
    }

    #[test]
    fn solid_angles_of_a_cube_its_inversion_and_a_flat_vertex() {
        let cube = cube_surface();
        for (surface, expected) in [(cube.clone(), PI / 2.0), (cube.inverted(), 3.5 * PI)] {
            let angles = solid_angles(&surface, &cube_points());
            assert!(angles.iter().all(|a| (a - expected).abs() < 1e-12), "{angles:?}");
        }
    }

    #[test]
    fn relief_lowers_the_strain_and_keeps_a_perfect_matching() {
        let surface = voxel_surface([3, 3, 2], |_| true).unwrap();
        // A squeezed box: the vertices of one side crowd together, so their solid angles are small.
        let n = surface.n_vertices();
        let points: Vec<Vector> = (0..n)
            .map(|v| {
                let t = v as f64 * 2.399_963;
                let z = 1.0 - 2.0 * (v as f64 + 0.5) / n as f64;
                let r = (1.0 - z * z).sqrt();
                [r * t.cos(), r * t.sin(), z]
            })
            .collect();
        let colours = colouring(&surface, false);
        let library = CellLibrary::built_in(CellChoice::Embeddable);
        let before = light_sides(&surface, &[], 0, &Context::default()).unwrap();
        assert_eq!(before.n_unmatched, 0);
        let mut after = before.clone();
        let first = relieve(&surface, &points, &colours.white, &mut after, library).unwrap();
        for d in surface.darts() {
            assert_eq!(after.light[d], after.light[surface.twin(d)]);
        }
        assert!(after.light.as_slice().chunks(4).all(|c| c.iter().filter(|&&x| x).count() == 1));
        assert_ne!(before, after);
        // Nothing is left to gain, and the same sum comes out when counted afresh.
        let mut again = after.clone();
        let second = relieve(&surface, &points, &colours.white, &mut again, library).unwrap();
        assert!((first - second).abs() <= 1e-9 * first);
        assert_eq!(again, after);
    }
}
