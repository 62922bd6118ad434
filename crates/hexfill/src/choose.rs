//! The automatic strategy where coordinates count: candidates of several engines, embedded, and the best of them.
//!
//! Engines in this order, the next only if none before brought a good mesh: atlas and shelling, inward flips, construction.
//! The order of meshes: certified ones first, then those whose worst scaled Jacobian is at least [`GOOD`], then fewest
//! hexes for their quality ([`Prefer`]).

use crate::fill::{FillError, FillOptions, Filled, Route, Strategy, construct, search, shelled};
use crate::geometry::{Placed, place};
use crate::placed_fill::{Next, PlaceOptions, PlacedFill, no_room};
use crate::problem::Problem;
use hexfill_mesh::{Context, StopReason};
use hexfill_search::MAX_QUADS;
use serde::Serialize;

/// The worst scaled Jacobian from which on a mesh is good enough to compute on.
pub(crate) const GOOD: f64 = 0.2;

/// What to prefer among certified meshes whose worst scaled Jacobian is at least 0.2.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Prefer {
    /// Fewest hexes divided by the cube of the worst scaled Jacobian: twice the hexes must bring 26 % more quality.
    #[default]
    Balance,
    /// Fewest hexes.
    Hexes,
    /// Largest worst scaled Jacobian.
    Quality,
}

/// The place of a mesh in the order; smaller is better.
type Rank = (u8, f64);

fn rank(filled: &Filled, placed: &Placed, prefer: Prefer) -> Rank {
    let hexes = filled.mesh.n_hexes() as f64;
    let invalid = placed.cells.iter().filter(|c| !c.valid).count();
    if placed.cells.is_empty() || invalid > 0 {
        return (2, if placed.cells.is_empty() { f64::MAX } else { invalid as f64 });
    }
    let worst = placed.worst();
    if worst < GOOD {
        return (1, -worst);
    }
    let within = match prefer {
        Prefer::Balance => hexes / worst.powi(3),
        Prefer::Hexes => hexes,
        Prefer::Quality => -worst,
    };
    (0, within)
}

/// One mesh for the problem with coordinates, by the order above.
///
/// # Errors
/// As [`crate::fill`].
pub(crate) fn fill_best(
    problem: &Problem,
    options: &FillOptions,
    how: &PlaceOptions,
    embed: &hexfill_embed::Options,
    boundary: &[[f64; 3]],
    ctx: &Context<'_>,
) -> Result<PlacedFill, FillError> {
    let limited = || how.limit.map_or(*ctx, |limit| ctx.with_time_limit(limit));
    let surface = &problem.surface;
    let mut result = crate::fill::FillResult { meshes: Vec::new(), stop: StopReason::Finished, tried: Vec::new() };
    let small = surface.is_sphere() && surface.n_quads() <= MAX_QUADS;
    let mut best: Option<(Rank, Filled, Placed)> = None;
    let mut seen: Vec<String> = Vec::new();
    let mut consider = |mut filled: Filled, best: &mut Option<(Rank, Filled, Placed)>| {
        let placed = place(&mut filled, problem, boundary, Some(embed), &limited());
        let rank = rank(&filled, &placed, options.prefer);
        let valid = if placed.is_certified() { format!("{:.3}", placed.worst()) } else { "not certified".to_owned() };
        seen.push(format!("{} hexes by {} ({valid})", filled.mesh.n_hexes(), filled.route.words()));
        if best.as_ref().is_none_or(|(r, ..)| rank.0 < r.0 || rank.0 == r.0 && rank.1 < r.1) {
            *best = Some((rank, filled, placed));
        }
    };
    if small && options.strategy == Strategy::Auto {
        // One cavity: the surface itself.
        search(surface, &FillOptions { inward_cavities: 1, ..options.clone() }, ctx, &mut result)?;
    }
    for filled in result.meshes.drain(..) {
        consider(filled, &mut best);
    }
    // Where one component lies in another, shells do not sweep.
    let shelled = if surface.n_components() == 1 { shelled(problem, options, ctx, &mut result)? } else { Vec::new() };
    for filled in shelled {
        if ctx.stop().is_some() && best.is_some() {
            break;
        }
        consider(filled, &mut best);
    }
    let is_good = |best: &Option<(Rank, Filled, Placed)>| best.as_ref().is_some_and(|((class, _), ..)| *class == 0);
    let mut why_none = None;
    if options.strategy == Strategy::Auto && !is_good(&best) && ctx.stop().is_none() {
        why_none = no_room(surface, boundary);
        let has_valid = best.as_ref().is_some_and(|((class, _), ..)| *class == 1);
        if small && why_none.is_none() && !has_valid {
            search(surface, options, ctx, &mut result)?;
            for filled in result.meshes.drain(..) {
                consider(filled, &mut best);
            }
            let next = Next { problem, options, embed, boundary };
            if !is_good(&best)
                && let Some((filled, _)) = next.more_fillings(&limited, ctx, &mut result.tried)?
            {
                consider(filled, &mut best);
            }
        }
        let certified = best.as_ref().is_some_and(|((class, _), ..)| *class < 2);
        if (best.is_none() || why_none.is_none() && !certified) && ctx.stop().is_none() {
            construct(problem, options, ctx, &mut result)?;
            for filled in result.meshes.drain(..) {
                consider(filled, &mut best);
            }
        }
    }
    let choice = match (why_none, seen.len()) {
        (Some(why), _) => Some(format!("no other mesh was tried, since none can be valid: {why}")),
        (None, 0 | 1) => None,
        (None, _) => best.as_ref().map(|(_, filled, _)| {
            format!("{} by {}; tried: {}", filled.mesh.n_hexes(), filled.route.words(), seen.join(", "))
        }),
    };
    let stop = if result.stop == StopReason::Finished { ctx.stop().unwrap_or(result.stop) } else { result.stop };
    let meshes = best.into_iter().map(|(_, filled, placed)| (filled, Some(placed))).collect();
    Ok(PlacedFill { meshes, stop, tried: result.tried, choice })
}

impl Route {
    /// In words, for reports.
    pub fn words(self) -> &'static str {
        match self {
            Self::Atlas => "atlas look-up",
            Self::Shelling => "shelling",
            Self::InwardFlips => "inward flips and atlas",
            Self::Growth => "growth towards the surface",
            Self::Construction => "construction",
        }
    }
}
