//! [`Estimate`]: how long a filling may take and how many hexes it may have, told before the work.
//!
//! Ranges from what was measured (`record/estimate-2026-11-22.md`), not from a model: the processor time of a filling differs by a
//! factor of a hundred between surfaces of one size. What tells most is whether a chord crosses itself: such surfaces close rarely by layers,
//! are stirred, and at last constructed, with some 46 hexes a quad.
//!
//! Source: ours.

use crate::best::PlaceOptions;
use crate::best::choose::MOST_LAID;
use crate::fill::options::{Effort, FillOptions, Strategy};
use crate::fill::stored::stored_mesh;
use crate::problem::Problem;
use hexfill_mesh::chords;
use serde::Serialize;
use std::fmt;

/// What a filling may take, before it begins.
#[derive(Clone, PartialEq, Debug, Serialize)]
#[non_exhaustive]
pub struct Estimate {
    /// The engines in the order in which they are asked; the later ones only if none before brings a good mesh.
    pub engines: Vec<&'static str>,
    /// Least and most seconds on one idle core.
    pub seconds: [f64; 2],
    /// Fewest and most hexes.
    pub hexes: [u64; 2],
}

/// Below this many seconds at most there is nothing to say.
const LONG: f64 = 10.0;
/// Surfaces of at most so many quads are looked up, mostly.
const LOOKED_UP: usize = 26;
/// Hexes a quad of the construction, rounded up.
const CONSTRUCTED: u64 = 47;

/// What filling a problem with these options may take. `None` if it takes some seconds at most, or if nothing is known: no positions are wanted,
/// several meshes or the best one are asked for.
pub fn estimate(problem: &Problem, options: &FillOptions, how: &PlaceOptions) -> Option<Estimate> {
    let surface = problem.surface();
    let n = surface.n_quads();
    let is_plain = options.count == 1 && !options.improve && options.layers.is_none() && how.embed.is_some();
    let is_bounded = is_plain && options.effort != Effort::Best && options.strategy != Strategy::Atlas;
    if !is_bounded || n <= LOOKED_UP || is_grid(problem) || stored_mesh(surface).is_some() {
        return None;
    }
    let quads = n as f64;
    let is_tangled = chords(surface).iter().any(|chord| !chord.self_crossings.is_empty());
    let handles = surface.genus() as f64 + (surface.n_components() - 1) as f64;
    let seconds = match (options.strategy, is_tangled) {
        (Strategy::Construct, _) => [0.02 * quads, 0.5 * quads],
        (_, true) => [0.5, 35.0 + 0.3 * quads],
        (_, false) => [0.0004 * quads, 0.02 * quads + handles],
    };
    let n = n as u64;
    let hexes = match (options.strategy, is_tangled) {
        (Strategy::Construct, _) => [40 * n, CONSTRUCTED * n],
        (Strategy::Auto, true) => [n / 2, CONSTRUCTED * n],
        // A solid of a^3 hexes has 6 a^2 quads.
        _ => [n / 4, (4 * n).max((2.0 * (quads / 6.0).powf(1.5)) as u64)],
    };
    let small = surface.is_sphere() && surface.n_quads() <= hexfill_search::MAX_QUADS;
    let is_laid = surface.n_quads() <= MOST_LAID;
    let engines = match options.strategy {
        Strategy::Construct => vec!["construction"],
        Strategy::Shell if is_laid => vec!["shelling", "laying"],
        Strategy::Shell => vec!["shelling"],
        _ if small => vec!["atlas", "shelling", "laying", "inward flips", "construction"],
        _ if is_laid => vec!["shelling", "laying", "construction"],
        _ => vec!["shelling", "construction"],
    };
    (seconds[1] >= LONG).then_some(Estimate { engines, seconds, hexes })
}

/// Whether every edge runs along an axis: the cells of a grid fill such a surface at once.
fn is_grid(problem: &Problem) -> bool {
    problem.points().is_some_and(|points| {
        problem.surface().quads().iter().all(|quad| {
            (0..4).all(|i| {
                let [a, b] = [quad[i], quad[(i + 1) % 4]].map(|v| points[v.index()]);
                (0..3).filter(|&k| a[k] != b[k]).count() <= 1
            })
        })
    })
}

/// "0.5", "12", "150".
fn rounded(x: f64) -> String {
    if x < 0.95 {
        return format!("{:.1}", x.max(0.1));
    }
    let step = 10f64.powf(x.log10().floor() - 1.0).max(1.0);
    format!("{:.0}", (x / step).round() * step)
}

impl fmt::Display for Estimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [low, high] = self.seconds.map(rounded);
        let [few, many] = self.hexes.map(|n| rounded(n as f64));
        let engines = self.engines.join(", then ");
        write!(f, "about {low} to {high} s of processor time and {few} to {many} hexes, by {engines}")?;
        if self.engines.len() > 1 {
            write!(f, " (each only if none before brings a good mesh)")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(problem: &Problem) -> Option<Estimate> {
        estimate(problem, &FillOptions::default(), &PlaceOptions::default())
    }

    #[test]
    fn small_work_and_grids_are_passed_over() {
        for name in ["cube", "schneiders-pyramid", "octagonal-spindle"] {
            assert_eq!(told(&Problem::named(name).unwrap()), None);
        }
        let (surface, cells) = hexfill_mesh::generate::voxels([20, 20, 20], |_| true).unwrap();
        let points = cells.into_iter().map(|p| p.map(f64::from)).collect();
        assert_eq!(told(&Problem::new("box", surface, points).unwrap()), None);
    }

    #[test]
    fn long_work_is_told_in_a_line() {
        let (surface, cells) = hexfill_mesh::generate::voxels([10, 10, 10], |_| true).unwrap();
        let bent = cells.into_iter().map(|[x, y, z]| [x, y, z].map(f64::from)).map(|[x, y, z]| [x + 0.1 * y * y, y, z]);
        let problem = Problem::new("bent", surface, bent.collect()).unwrap();
        let made = told(&problem).unwrap();
        assert_eq!(made.engines, ["shelling", "laying", "construction"]);
        assert_eq!(
            made.to_string(),
            "about 0.2 to 12 s of processor time and 150 to 2400 hexes, by shelling, then laying, then construction (each only if none before brings a good mesh)"
        );
        let best = FillOptions::default().with_effort(Effort::Best);
        assert_eq!(estimate(&problem, &best, &PlaceOptions::default()), None);
    }
}
