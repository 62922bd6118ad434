//! Pillows between the stages of a shelled mesh, until it has valid positions.
//!
//! Meshes of surfaces whose chords cross themselves heavily close with few hexes and then do not embed: too many of them meet in the void that
//! the sweep left. A pillow, a sheet of one hex a quad, can be put round any set of hexes whose surface is a sphere (Mitchell, Tautges 1995), so before any stage of the shelling after the fact; it takes neighbours apart that share too much. A
//! search puts pillows near corners that are not positive, untangles what lies round them, and keeps what brings the corners nearer to positive for
//! the hexes it costs. Measured in `record/self-crossing-2026-11-22.md`, section 1; counts bound the work, not a clock.
//!
//! Source: Mitchell, Tautges 1995 (the pillow); the search for places is ours.

use crate::best::stage::Stage;
use hexfill_geometry::Vector;
use hexfill_mesh::{Context, HexMesh, QuadSurface, Random};
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

/// The mesh with pillows at valid positions, and per hex which one it was, if any; `None` if the search ends before it finds one. `points` are where the embedding of the mesh failed; the first
/// `n_surface` vertices are those of the surface and stay.
pub(crate) fn with_pillows(
    mesh: &HexMesh,
    points: &[Vector],
    surface: &QuadSurface,
    limits: PillowLimits,
    ctx: &Context<'_>,
) -> Option<(HexMesh, Vec<Vector>, Vec<Option<u32>>)> {
    let cost = |stage: &Stage| stage.cost(surface.n_quads());
    let mut best = Stage::of(mesh, points).untangled(THOROUGH, ctx)?;
    let most_hexes = (limits.most * surface.n_quads() as f64) as usize;
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
    best.finished()
}

impl Stage {
    /// One more pillow, drawn at random: two times in three before a late stage of the shelling near a bad hex, else round a bad hex and some neighbours.
    fn pillowed(&self, n_surface: usize, random: &mut Random) -> Option<Self> {
        let near = self.bad[random.below(self.bad.len())];
        let n = self.hexes.len();
        if random.below(3) > 0 {
            let at = if random.below(4) > 0 { (near + random.below(9)).saturating_sub(4) } else { random.below(n) };
            if at == 0 || at + 4 > n {
                return None;
            }
            return self.with_pillow(&(at as u32..n as u32).collect::<Vec<_>>());
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
        let set: Vec<u32> = (0..).zip(&inside).filter(|(_, is_inside)| **is_inside).map(|(h, _)| h).collect();
        self.with_pillow(&set)
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
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::best::stage::tests::cubes;
    use crate::best::stage::worst_corner;

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
