//! Pillows between the stages of a shelled mesh, until it has valid positions.
//!
//! Meshes of surfaces whose chords cross themselves heavily close with few hexes and then do not embed: too many of them meet in the void that
//! the sweep left. A pillow, a sheet of one hex a quad, can be put round any set of hexes whose surface is a sphere (Mitchell, Tautges 1995), so before any stage of the shelling after the fact; it takes neighbours apart that share too much. A
//! search puts pillows near corners that are not positive, untangles what lies round them, and keeps what brings the corners nearer to positive for
//! the hexes it costs. Measured in `record/self-crossing-2026-11-22.md`, section 1; counts bound the work, not a clock.
//!
//! Source: Mitchell, Tautges 1995 (the pillow); the search for places is ours.

use hexfill_embed::untangle_near;
use hexfill_geometry::{Vector, cross, dot, norm, sub};
use hexfill_mesh::cube::CORNER_NEIGHBOURS;
use hexfill_mesh::{Context, HexMesh, QuadSurface, Random, StopReason};
use hexfill_shell::{Pillowed, pillow};
use rayon::prelude::*;

/// How far to go.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PillowLimits {
    /// Pillows tried at most in a mesh of [`USUAL`] hexes; in larger ones fewer, as each takes longer.
    pub(crate) trials: u32,
    /// Most hexes a quad.
    pub(crate) most: f64,
    /// Meshes with more bad corners at first are not tried.
    pub(crate) most_bad: usize,
}

/// Hexes of a mesh in which all trials are made. Without that a torus of 128 quads with two vertices at one place took two minutes, 6 hexes bad all along.
const USUAL: usize = 80;
/// What a hex a quad costs against corners that are not positive.
const HEX_COST: f64 = 0.3;
/// Pillows tried at once: each gets a quick untangling, and the best few of them a full one.
const TOGETHER: usize = 6;
const FULL: usize = 2;
/// Draws for that many: not every set of hexes has a sphere round it.
const DRAWS: usize = 40;
/// Rings of vertices and iterations of the two untanglings.
const QUICK: (usize, usize) = (2, 300);
const THOROUGH: (usize, usize) = (3, 4000);
/// After so many rounds in vain something worse is taken, by so much at most: the last bad corner seldom goes by what helps at once.
const PATIENCE: u32 = 1;
const WORSE: f64 = 2.0;
/// Rounds in vain after which the search ends.
const MOST_STALE: u32 = 30;

/// A mesh with pillows: hexes in shelling order, positions, and how bad they are.
#[derive(Clone)]
struct Stage {
    hexes: Vec<[u32; 8]>,
    /// Per hex which one of the mesh it was; `None` for those of pillows.
    origin: Vec<Option<u32>>,
    points: Vec<Vector>,
    /// Hexes with a corner that is not positive; if there are none, those that are not valid for another reason.
    bad: Vec<usize>,
    /// 0 for a valid mesh.
    score: f64,
}

/// The mesh with pillows at valid positions, and per hex which one it was, if any; `None` if the search ends before it finds one. `points` are where the embedding of the mesh failed; the first
/// `n_surface` vertices are those of the surface and stay.
pub(crate) fn with_pillows(
    mesh: &HexMesh,
    points: &[Vector],
    surface: &QuadSurface,
    limits: PillowLimits,
    ctx: &Context<'_>,
) -> Option<(HexMesh, Vec<Vector>, Vec<Option<u32>>)> {
    let n_quads = surface.n_quads() as f64;
    let cost = |stage: &Stage| stage.score + HEX_COST * stage.hexes.len() as f64 / n_quads;
    let origin = (0..mesh.n_hexes() as u32).map(Some).collect();
    let start = Stage { hexes: mesh.hexes_raw(), origin, points: points.to_vec(), bad: Vec::new(), score: 0.0 };
    let mut best = start.untangled(THOROUGH, ctx)?;
    let most_hexes = (limits.most * n_quads) as usize;
    let mut random = Random::new(ctx.seed);
    let most_tried = u64::from(limits.trials) * USUAL as u64;
    let (mut tried, mut stale) = (0, 0);
    while !best.bad.is_empty() {
        let is_hopeless = best.bad.len() > limits.most_bad || tried >= most_tried || stale > MOST_STALE;
        if is_hopeless || ctx.stop().is_some() {
            return None;
        }
        ctx.report("pillows", tried, Some(most_tried), || {
            format!("{} hexes, {} of them bad", best.hexes.len(), best.bad.len())
        });
        let drawn: Vec<Stage> = (0..DRAWS)
            .filter_map(|_| best.pillowed(surface.n_vertices(), &mut random))
            .filter(|stage| stage.hexes.len() <= most_hexes)
            .take(TOGETHER)
            .collect();
        tried += (drawn.len().max(1) * best.hexes.len().max(USUAL)) as u64;
        // A short untangling tells which pillows may help; only the best few get a long one.
        let mut quick: Vec<Stage> = drawn.into_par_iter().filter_map(|stage| stage.untangled(QUICK, ctx)).collect();
        quick.sort_by(|a, b| cost(a).total_cmp(&cost(b)));
        quick.truncate(FULL);
        let full: Vec<Stage> = quick
            .into_par_iter()
            .filter_map(|stage| if stage.bad.is_empty() { Some(stage) } else { stage.untangled(THOROUGH, ctx) })
            .collect();
        let next = full.into_iter().min_by(|a, b| cost(a).total_cmp(&cost(b)));
        let allowed = cost(&best) + if stale > PATIENCE { WORSE } else { 0.0 };
        match next.filter(|stage| cost(stage) < allowed) {
            Some(stage) => (best, stale) = (stage, 0),
            None => stale += 1,
        }
    }
    let mesh = HexMesh::try_new(best.points.len(), &best.hexes).ok()?;
    Some((mesh, best.points, best.origin))
}

impl Stage {
    /// Untangled round its bad cells: rings of vertices, then iterations on all. `None` if it was stopped or is no mesh.
    fn untangled(self, (rings, whole): (usize, usize), ctx: &Context<'_>) -> Option<Self> {
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

    /// One more pillow, drawn at random: two times in three before a late stage of the shelling near a bad hex, else round a bad hex and some neighbours.
    fn pillowed(&self, n_surface: usize, random: &mut Random) -> Option<Self> {
        let near = self.bad[random.below(self.bad.len())];
        let n = self.hexes.len();
        if random.below(3) > 0 {
            let at = if random.below(4) > 0 { (near + random.below(9)).saturating_sub(4) } else { random.below(n) };
            if at == 0 || at + 4 > n {
                return None;
            }
            return self.with_pillow(&(0..n).map(|h| h >= at).collect::<Vec<_>>());
        }
        let mut inside = vec![false; n];
        inside[near] = true;
        for _ in 0..random.below(3) {
            let shared = if random.below(2) == 0 { 4 } else { 2 };
            self.grow(&mut inside, shared);
        }
        // The surface stays where it is.
        for (is_inside, hex) in inside.iter_mut().zip(&self.hexes) {
            *is_inside &= hex.iter().all(|&v| v as usize >= n_surface);
        }
        self.with_pillow(&inside)
    }

    /// Adds the hexes that share so many vertices with those inside.
    fn grow(&self, inside: &mut [bool], shared: usize) {
        let mut touched = vec![false; self.points.len()];
        for (hex, _) in self.hexes.iter().zip(inside.iter()).filter(|(_, is_inside)| **is_inside) {
            hex.iter().for_each(|&v| touched[v as usize] = true);
        }
        for (hex, is_inside) in self.hexes.iter().zip(inside) {
            *is_inside |= hex.iter().filter(|&&v| touched[v as usize]).count() >= shared;
        }
    }

    /// A pillow round the hexes inside; `None` if their surface is no sphere. Its hexes come before the first of those in the order.
    fn with_pillow(&self, inside: &[bool]) -> Option<Self> {
        let set: Vec<u32> = (0..).zip(inside).filter(|(_, is_inside)| **is_inside).map(|(h, _)| h).collect();
        let first = *set.first()? as usize;
        let Pillowed { mut hexes, copied } = pillow(self.points.len(), &self.hexes, &set)?;
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
fn worst_corner(hex: &[u32; 8], points: &[Vector]) -> f64 {
    let at = |k: usize| points[hex[k] as usize];
    (0..8)
        .map(|corner| {
            let [a, b, c] = CORNER_NEIGHBOURS[corner].map(|k| sub(at(k), at(corner)));
            dot(cross(a, b), c) / (norm(a) * norm(b) * norm(c)).max(f64::MIN_POSITIVE)
        })
        .fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fill::filled::Route;
    use crate::fill::judged::verify;

    /// n^3 cubes, their positions, and their surface.
    fn cubes(n: u32) -> (Stage, QuadSurface) {
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
            let inside: Vec<bool> = (0..64).map(inside).collect();
            let made = stage.with_pillow(&inside).unwrap();
            assert_eq!(made.hexes.len(), 64 + more);
            let mesh = HexMesh::try_new(made.points.len(), &made.hexes).unwrap();
            verify(&surface, &mesh, Route::Shelling).unwrap();
            assert_eq!(made.origin.iter().flatten().copied().collect::<Vec<u32>>(), (0..64).collect::<Vec<u32>>());
            // Each new vertex is drawn into what it bounds: the pillow has a height.
            assert!(made.hexes.iter().all(|hex| worst_corner(hex, &made.points) > 0.0));
        }
        // Two cubes that share an edge only have no sphere round them.
        let inside: Vec<bool> = (0..64).map(|c| c == 21 || c == 26).collect();
        assert!(stage.with_pillow(&inside).is_none());
    }

    #[test]
    fn a_valid_mesh_needs_no_pillow_and_a_folded_one_is_untangled() {
        let (stage, surface) = cubes(2);
        let mesh = HexMesh::try_new(stage.points.len(), &stage.hexes).unwrap();
        let mut points = stage.points.clone();
        points[13] = [1.9, 1.9, 2.5];
        let limits = PillowLimits { trials: 10, most: 4.0, most_bad: 8 };
        let (made, at, _) = with_pillows(&mesh, &points, &surface, limits, &Context::default()).unwrap();
        assert_eq!(made.n_hexes(), 8);
        assert!(made.hexes_raw().iter().all(|hex| worst_corner(hex, &at) > 0.0));
    }
}
