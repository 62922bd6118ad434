//! [`Stage`]: a mesh on the way to valid positions, to which pillows are added one by one.
//!
//! Source: Mitchell, Tautges 1995 (the pillow).

use hexfill_embed::untangle_near;
use hexfill_geometry::{Vector, cross, dot, norm, sub};
use hexfill_mesh::cube::CORNER_NEIGHBOURS;
use hexfill_mesh::{Context, HexMesh, StopReason};
use hexfill_shell::{Pillowed, pillow};

/// What a hex a quad costs against corners that are not positive.
const HEX_COST: f64 = 0.3;

/// A mesh with pillows: hexes in shelling order, positions, and how bad they are.
#[derive(Clone)]
pub(super) struct Stage {
    pub(super) hexes: Vec<[u32; 8]>,
    /// Per hex which one of the mesh it was; `None` for those of pillows.
    pub(super) origin: Vec<Option<u32>>,
    pub(super) points: Vec<Vector>,
    /// Hexes with a corner that is not positive; if there are none, those that are not valid for another reason.
    pub(super) bad: Vec<usize>,
    /// 0 for a valid mesh.
    score: f64,
}

impl Stage {
    /// A mesh as it is, not looked at yet.
    pub(super) fn of(mesh: &HexMesh, points: &[Vector]) -> Self {
        let origin = (0..mesh.n_hexes() as u32).map(Some).collect();
        Self { hexes: mesh.hexes_raw(), origin, points: points.to_vec(), bad: Vec::new(), score: 0.0 }
    }

    /// The mesh with its positions, and per hex which one it was, if any.
    pub(super) fn finished(self) -> Option<(HexMesh, Vec<Vector>, Vec<Option<u32>>)> {
        let mesh = HexMesh::try_new(self.points.len(), &self.hexes).ok()?;
        Some((mesh, self.points, self.origin))
    }

    /// What is to become small, for a surface of so many quads: how bad it is, and a little for each hex.
    pub(super) fn cost(&self, n_quads: usize) -> f64 {
        self.score + HEX_COST * self.hexes.len() as f64 / n_quads as f64
    }

    /// Untangled round its bad cells: rings of vertices, then iterations on all. `None` if it was stopped or is no mesh.
    pub(super) fn untangled(self, (rings, whole): (usize, usize), ctx: &Context<'_>) -> Option<Self> {
        let mesh = HexMesh::try_new(self.points.len(), &self.hexes).ok()?;
        let quiet = Context { progress: None, ..*ctx };
        let (points, invalid) = untangle_near(&mesh, &self.points, rings, whole, &quiet).ok()?;
        if ctx.stop().unwrap_or(StopReason::Finished) != StopReason::Finished && !invalid.is_empty() {
            return None;
        }
        let worst: Vec<f64> = self.hexes.iter().map(|hex| worst_corner(hex, &points)).collect();
        let corners: Vec<usize> = (0..worst.len()).filter(|&h| worst[h] <= 0.0).collect();
        // A valid cell has positive corners; one whose corners are positive is nearly there.
        let score = corners.iter().map(|&h| 0.5 - worst[h]).sum::<f64>() + 0.02 * invalid.len() as f64;
        let bad = if corners.is_empty() { invalid.iter().map(|h| h.index()).collect() } else { corners };
        Some(Self { points, bad, score, ..self })
    }

    /// A pillow round the hexes of the set, ascending; `None` if their surface is no sphere. Its hexes come before the first of those in the order.
    pub(super) fn with_pillow(&self, set: &[u32]) -> Option<Self> {
        let first = *set.first()? as usize;
        let Pillowed { mut hexes, copied } = pillow(self.points.len(), &self.hexes, set)?;
        let sheet = hexes.split_off(self.hexes.len());
        let mut origin = self.origin.clone();
        origin.splice(first..first, sheet.iter().map(|_| None));
        hexes.splice(first..first, sheet);
        let mut points = self.points.clone();
        points.extend(copied.iter().map(|&v| self.points[v as usize]));
        // Copies lie on their originals, and a sheet without volume gives untangling nothing to start from.
        draw_apart(&hexes, &mut points, self.points.len());
        Some(Self { hexes, origin, points, bad: Vec::new(), score: 0.0 })
    }
}

/// New vertices, which lie where those do that they are copies of, go half the way to the mean of their neighbours, two times.
fn draw_apart(hexes: &[[u32; 8]], points: &mut [Vector], first: usize) {
    for _ in 0..2 {
        let mut sums = vec![([0.0; 3], 0.0); points.len() - first];
        for hex in hexes {
            for (corner, neighbours) in CORNER_NEIGHBOURS.iter().enumerate() {
                let Some((sum, n)) = (hex[corner] as usize).checked_sub(first).map(|v| &mut sums[v]) else { continue };
                for &k in neighbours {
                    let p = points[hex[k] as usize];
                    (0..3).for_each(|axis| sum[axis] += p[axis]);
                    *n += 1.0;
                }
            }
        }
        for (point, (sum, n)) in points[first..].iter_mut().zip(sums) {
            (0..3).for_each(|axis| point[axis] = 0.5 * (point[axis] + sum[axis] / n));
        }
    }
}

/// The least scaled Jacobian of a hex at its corners.
pub(super) fn worst_corner(hex: &[u32; 8], points: &[Vector]) -> f64 {
    let at = |k: usize| points[hex[k] as usize];
    (0..8)
        .map(|corner| {
            let [a, b, c] = CORNER_NEIGHBOURS[corner].map(|k| sub(at(k), at(corner)));
            dot(cross(a, b), c) / (norm(a) * norm(b) * norm(c)).max(f64::MIN_POSITIVE)
        })
        .fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::fill::filled::Route;
    use crate::fill::judged::verify;
    use hexfill_mesh::QuadSurface;

    /// n^3 cubes, their positions, and their surface.
    pub(in crate::best) fn cubes(n: u32) -> (Stage, QuadSurface) {
        let m = n + 1;
        let at = |x: u32, y: u32, z: u32| x + m * (y + m * z);
        let points: Vec<Vector> = (0..m * m * m).map(|v| [v % m, v / m % m, v / m / m].map(f64::from)).collect();
        let hexes: Vec<[u32; 8]> = (0..n * n * n)
            .map(|c| (c % n, c / n % n, c / n / n))
            .map(|(x, y, z)| {
                let ring = [(0, 0), (1, 0), (1, 1), (0, 1)];
                std::array::from_fn(|k| at(x + ring[k % 4].0, y + ring[k % 4].1, z + k as u32 / 4))
            })
            .collect();
        let mesh = HexMesh::try_new(points.len(), &hexes).unwrap();
        let quads: Vec<[u32; 4]> = mesh.boundary_quads_raw();
        let surface = QuadSurface::try_new(points.len(), &quads).unwrap();
        (
            Stage { origin: (0..hexes.len() as u32).map(Some).collect(), hexes, points, bad: vec![0], score: 0.0 },
            surface,
        )
    }

    #[test]
    fn a_pillow_round_any_ball_inside_is_a_proper_mesh_with_the_same_surface() {
        let (stage, surface) = cubes(4);
        let inner = |c: usize| [c % 4, c / 4 % 4, c / 16].iter().all(|x| (1..3).contains(x));
        let one = |c: usize| c == 21;
        let bar = |c: usize| c == 21 || c == 22;
        for (inside, more) in [(&inner as &dyn Fn(usize) -> bool, 24), (&one, 6), (&bar, 10)] {
            let set: Vec<u32> = (0..64).filter(|&c| inside(c as usize)).collect();
            let made = stage.with_pillow(&set).unwrap();
            assert_eq!(made.hexes.len(), 64 + more);
            let mesh = HexMesh::try_new(made.points.len(), &made.hexes).unwrap();
            verify(&surface, &mesh, Route::Shelling).unwrap();
            assert_eq!(made.origin.iter().flatten().copied().collect::<Vec<u32>>(), (0..64).collect::<Vec<u32>>());
            // Each new vertex is drawn into what it bounds: the pillow has a height.
            assert!(made.hexes.iter().all(|hex| worst_corner(hex, &made.points) > 0.0));
        }
        // Two cubes that share an edge only have no sphere round them.
        assert!(stage.with_pillow(&[21, 26]).is_none());
    }
}
