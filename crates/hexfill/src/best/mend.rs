//! Pillows round the last hexes that are not valid, those on the surface included.
//!
//! A quad that is bent, or has a reflex corner, asks its four corners for directions that the quads beside it do not see. A pillow round the hex on it and
//! a few beside gives these quads edges of their own. Which hexes help cannot be told from the stars of the vertices, as the facet between the corners
//! must be positive, too: so all small sets near the worst hexes are tried, what lies round them is untangled, and the best set stays, round after
//! round. Measured in `record/self-crossing-2026-11-22.md`.
//!
//! Source: Mitchell, Tautges 1995 (the pillow); the sets are ours.

use crate::best::stage::{Stage, worst_corner};
use hexfill_geometry::Vector;
use hexfill_mesh::{Context, HexMesh, QuadSurface};
use rayon::prelude::*;
use rustc_hash::FxHashSet;

/// Meshes with more bad hexes are not tried.
const MOST_BAD: usize = 12;
/// The worst hexes, round which sets are looked for.
const WORST: usize = 3;
/// Rounds at most, and rounds in turn that bring nothing better.
const MOST_ROUNDS: usize = 10;
const PATIENCE: usize = 2;
/// Rings of vertices and iterations on all of the two untanglings, and the sets that get the second.
const QUICK: (usize, usize) = (2, 0);
const THOROUGH: (usize, usize) = (3, 1000);
const FULL: usize = 4;

/// The mesh with pillows at valid positions, and per hex which one it was, if any; `None` if no set of hexes helps. `points` are where the embedding of the
/// mesh failed; the vertices of the surface stay. The same for any number of threads.
pub(super) fn mended(
    mesh: &HexMesh,
    points: &[Vector],
    surface: &QuadSurface,
    ctx: &Context<'_>,
) -> Option<(HexMesh, Vec<Vector>, Vec<Option<u32>>)> {
    let cost = |stage: &Stage| stage.cost(surface.n_quads());
    let mut now = Stage::of(mesh, points).untangled(QUICK, ctx)?;
    let (mut least, mut stale) = (cost(&now), 0);
    for round in 0..MOST_ROUNDS {
        if now.bad.is_empty() || now.bad.len() > MOST_BAD || stale > PATIENCE {
            break;
        }
        ctx.report("mending", round as u64, Some(MOST_ROUNDS as u64), || {
            format!("{} hexes, {} of them bad", now.hexes.len(), now.bad.len())
        });
        let by_cost = |stages: &mut Vec<Stage>| stages.sort_by(|a, b| cost(a).total_cmp(&cost(b)));
        let pillowed = sets(&now).into_par_iter().filter_map(|set| now.with_pillow(&set)?.untangled(QUICK, ctx));
        let mut tried: Vec<Stage> = pillowed.collect();
        by_cost(&mut tried);
        tried.truncate(FULL);
        let full = tried
            .into_par_iter()
            .filter_map(|stage| if stage.bad.is_empty() { Some(stage) } else { stage.untangled(THOROUGH, ctx) });
        let mut tried: Vec<Stage> = full.collect();
        by_cost(&mut tried);
        if ctx.stop().is_some() {
            break;
        }
        // Even if it is worse: a set may have to be followed by another.
        now = tried.into_iter().next()?;
        if cost(&now) < least {
            (least, stale) = (cost(&now), 0);
        } else {
            stale += 1;
        }
    }
    if now.bad.is_empty() { now.finished() } else { None }
}

/// The small sets of hexes near the worst ones: a hex with up to two of those beside it, or all; the hexes at a vertex, with it and without; those at both or
/// either of two vertices.
fn sets(stage: &Stage) -> Vec<Vec<u32>> {
    let mut at: Vec<Vec<u32>> = vec![Vec::new(); stage.points.len()];
    for (h, hex) in (0..).zip(&stage.hexes) {
        hex.iter().for_each(|&v| at[v as usize].push(h));
    }
    let mut worst: Vec<(f64, usize)> =
        stage.bad.iter().map(|&h| (worst_corner(&stage.hexes[h], &stage.points), h)).collect();
    worst.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut found: Vec<Vec<u32>> = Vec::new();
    for &(_, h) in worst.iter().take(WORST) {
        let (one, hex) = (h as u32, &stage.hexes[h]);
        let shared = |g: u32| stage.hexes[g as usize].iter().filter(|v| hex.contains(v)).count();
        let mut beside: Vec<u32> = hex.iter().flat_map(|&v| &at[v as usize]).copied().collect();
        beside.sort_unstable();
        beside.dedup();
        beside.retain(|&g| g != one && shared(g) == 4);
        found.push(vec![one]);
        found.extend(beside.iter().map(|&g| vec![one, g]));
        found.extend(pairs(&beside).map(|(g, k)| vec![one, g, k]));
        found.push(beside.iter().copied().chain([one]).collect());
        for &v in hex {
            let round = &at[v as usize];
            found.push(round.clone());
            found.push(round.iter().copied().filter(|&g| g != one).collect());
        }
        for (v, w) in pairs(hex) {
            let (v, w) = (&at[v as usize], &at[w as usize]);
            found.push(v.iter().copied().filter(|g| w.contains(g)).collect());
            found.push(v.iter().chain(w).copied().collect());
        }
    }
    for set in &mut found {
        set.sort_unstable();
        set.dedup();
    }
    let mut seen = FxHashSet::default();
    found.retain(|set| seen.insert(set.clone()));
    found
}

/// All pairs, the first before the second.
fn pairs(all: &[u32]) -> impl Iterator<Item = (u32, u32)> + '_ {
    all.iter().enumerate().flat_map(|(i, &a)| all[i + 1..].iter().map(move |&b| (a, b)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::best::stage::tests::cubes;
    use crate::fill::filled::Route;
    use crate::fill::judged::verify;
    use crate::{Problem, crossing_quads};
    use hexfill_mesh::Random;

    #[test]
    fn sets_are_small_different_and_contain_hexes_near_the_bad_one() {
        let (mut stage, _) = cubes(4);
        stage.bad = vec![21];
        let all = sets(&stage);
        let unique: FxHashSet<&Vec<u32>> = all.iter().collect();
        assert_eq!(unique.len(), all.len());
        assert!(all.iter().all(|set| set.is_sorted() && set.len() <= 18), "{all:?}");
        // A hex inside has 6 beside it: itself, 6 and 15 sets with these, and all at once.
        assert_eq!(all.iter().filter(|set| set.contains(&21) && set.len() <= 3).count(), 1 + 6 + 15);
        assert!(all.iter().any(|set| set.len() == 7));
    }

    /// Eight cubes whose surface was shaken: with one edge a vertex some of the hexes cannot be valid.
    #[test]
    fn shaken_cubes_become_valid_unless_their_surface_crosses_itself() {
        let mut n_mended = 0;
        for seed in [1, 4, 6, 7, 9] {
            let (stage, surface) = cubes(2);
            let mesh = HexMesh::try_new(stage.points.len(), &stage.hexes).unwrap();
            let mut random = Random::new(seed);
            let shaken: Vec<Vector> = stage
                .points
                .iter()
                .map(|p| if *p == [1.0; 3] { *p } else { p.map(|x| x + 0.45 * (2.0 * random.unit() - 1.0)) })
                .collect();
            let untangled = Stage::of(&mesh, &shaken).untangled(THOROUGH, &Context::default()).unwrap();
            assert!(!untangled.bad.is_empty(), "{seed}");
            let mut problem = Problem::from_surface("shaken cubes", surface.clone());
            problem.points = Some(shaken.clone());
            let crosses = !crossing_quads(&problem).is_empty();
            let made = mended(&mesh, &untangled.points, &surface, &Context::default());
            assert_eq!(made.is_none(), crosses, "{seed}");
            let Some((mesh, points, origin)) = made else { continue };
            verify(&surface, &mesh, Route::Laying).unwrap();
            assert!(surface.quads().iter().flatten().all(|v| points[v.index()] == shaken[v.index()]));
            assert_eq!(origin.iter().flatten().count(), 8);
            assert!(mesh.hexes_raw().iter().all(|hex| worst_corner(hex, &points) > 0.0));
            n_mended += 1;
        }
        assert_eq!(n_mended, 4);
    }
}
