//! The automatic strategy where coordinates count: candidates of several engines, embedded, and the best of them.
//!
//! Engines in this order, the next only if none before brought a good mesh: atlas and shelling, inward flips, construction.
//! The order of meshes: certified ones first, then those whose worst scaled Jacobian is at least [`GOOD`], then fewest
//! hexes for their quality ([`Prefer`]).

use crate::fill::{FillError, FillOptions, Filled, Route, Strategy, construct, search, shelled, verify};
use crate::geometry::{Placed, place, place_as_it_is, place_points};
use crate::placed_fill::{Next, PlaceOptions, PlacedFill, no_room};
use crate::problem::Problem;
use hexfill_embed::quick_star_bound;
use hexfill_mesh::{Context, StopReason};
use hexfill_search::MAX_QUADS;
use hexfill_shell::{Layer, SplitOptions, cut_boundary_layers, split_stars};
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

/// Surfaces of at most so many quads have many fillings in the atlas.
const SMALLEST: usize = 24;
/// Cavities inward flips may look at where shelling found nothing valid.
const MOST_CAVITIES: u64 = 30_000;

/// Surfaces of more quads are constructed only if nothing else filled them.
const MOST_CONSTRUCTED: usize = 300;

/// The place of a mesh in the order; smaller is better.
type Rank = (u8, f64);

fn rank(filled: &Filled, placed: &Placed, prefer: Prefer) -> Rank {
    let invalid = placed.cells.iter().filter(|c| !c.valid).count();
    if placed.cells.is_empty() || invalid > 0 {
        return (2, if placed.cells.is_empty() { f64::MAX } else { invalid as f64 });
    }
    let worst = placed.worst();
    (u8::from(worst < GOOD), within(filled.mesh.n_hexes(), worst, prefer))
}

/// The order among good meshes.
fn within(hexes: usize, worst: f64, prefer: Prefer) -> f64 {
    match prefer {
        Prefer::Balance => hexes as f64 / worst.powi(3),
        Prefer::Hexes => hexes as f64,
        Prefer::Quality => -worst,
    }
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
    let surface = &problem.surface;
    let mut result = crate::fill::FillResult { meshes: Vec::new(), stop: StopReason::Finished, tried: Vec::new() };
    let small = surface.is_sphere() && surface.n_quads() <= MAX_QUADS;
    let mut trial = Trial { problem, options, boundary, how, ctx, embed, best: None, seen: Vec::new() };
    if small && options.strategy == Strategy::Auto {
        // One cavity: the surface itself.
        search(surface, &FillOptions { inward_cavities: 1, ..options.clone() }, ctx, &mut result)?;
    }
    for filled in result.meshes.drain(..) {
        trial.consider(filled)?;
    }
    for filled in shelled(problem, options, ctx, &mut result)? {
        if ctx.stop().is_some() && trial.best.is_some() {
            break;
        }
        trial.consider(filled)?;
    }
    let mut why_none = None;
    if options.strategy == Strategy::Auto && !trial.is_good() && ctx.stop().is_none() {
        why_none = no_room(surface, boundary);
        let has_valid = trial.class() == Some(1);
        if small && why_none.is_none() {
            if !has_valid {
                let cavities = options.inward_cavities.min(MOST_CAVITIES);
                let inward = FillOptions { inward_cavities: cavities, ..options.clone() };
                search(surface, &inward, ctx, &mut result)?;
                for filled in result.meshes.drain(..) {
                    trial.consider(filled)?;
                }
            }
            // The atlas knows many fillings of the smallest surfaces.
            let next = Next { problem, options, embed, boundary };
            if !trial.is_good()
                && surface.n_quads() <= SMALLEST
                && let Some((filled, _)) = next.more_fillings(&|| trial.limited(), ctx, &mut result.tried)?
            {
                trial.consider(filled)?;
            }
        }
        // A construction has some 46 hexes a quad: where shelling left a few of its own invalid, it is tried on small surfaces only.
        let worth_trying = match trial.class() {
            None => true,
            Some(2) => why_none.is_none() && surface.n_quads() <= MOST_CONSTRUCTED,
            Some(_) => false,
        };
        if worth_trying && ctx.stop().is_none() {
            construct(problem, options, ctx, &mut result)?;
            for filled in result.meshes.drain(..) {
                trial.consider(filled)?;
            }
        }
    }
    trial.polish();
    let layered = trial.cut_layers()?;
    let Trial { best, seen, .. } = trial;
    let choice = match (why_none, seen.len()) {
        (Some(why), _) => Some(format!("no other mesh was tried, since none can be valid: {why}")),
        (None, 0 | 1) => None,
        (None, _) => best.as_ref().map(|(_, filled, _)| format!("{}, the best of {}", words(filled), seen.join(", "))),
    };
    let stop = if result.stop == StopReason::Finished { ctx.stop().unwrap_or(result.stop) } else { result.stop };
    let choice = match layered {
        Some(layers) => Some(choice.map_or(layers.clone(), |c| format!("{c}; {layers}"))),
        None => choice,
    };
    let meshes = best.into_iter().map(|(_, filled, placed)| (filled, Some(placed))).collect();
    Ok(PlacedFill { meshes, stop, tried: result.tried, choice })
}

/// The best mesh so far and what was tried.
struct Trial<'a> {
    problem: &'a Problem,
    options: &'a FillOptions,
    boundary: &'a [[f64; 3]],
    how: &'a PlaceOptions,
    ctx: &'a Context<'a>,
    embed: &'a hexfill_embed::Options,
    best: Option<(Rank, Filled, Placed)>,
    seen: Vec<String>,
}

impl<'a> Trial<'a> {
    fn limited(&self) -> Context<'a> {
        self.how.limit.map_or(*self.ctx, |limit| self.ctx.with_time_limit(limit))
    }

    fn class(&self) -> Option<u8> {
        self.best.as_ref().map(|((class, _), ..)| *class)
    }

    fn is_good(&self) -> bool {
        self.class() == Some(0)
    }

    /// Embeds a mesh and keeps it if it is the best.
    fn consider(&mut self, mut filled: Filled) -> Result<(), FillError> {
        let prefer = self.options.prefer;
        if self.options.layers.is_some() && filled.route != Route::Shelling {
            // Layers are cut out of a pillow, which shelling puts by itself.
            let mut pillow = SplitOptions::default();
            (pillow.below, pillow.layer) = (-1.0, Layer::Always);
            let Some(pillowed) = split_stars(&filled.mesh, self.boundary, &pillow, self.ctx) else { return Ok(()) };
            verify(&self.problem.surface, &pillowed.mesh, filled.route)?;
            filled = filled.changed("pillow", pillowed.mesh);
        }
        let placed = if filled.route == Route::Shelling {
            // Its surface vertices lie where the surface's do, so there is one way to place it.
            let perfect = (0, within(filled.mesh.n_hexes(), 1.0, prefer));
            if self.best.as_ref().is_some_and(|(r, ..)| *r <= perfect) {
                return Ok(());
            }
            let bound = quick_star_bound(&filled.mesh, self.boundary).unwrap_or(1.0);
            if let Some(split) = self.split(&filled, bound)? {
                self.consider(split)?;
            }
            if bound <= NO_ROOM && self.best.is_some() {
                self.seen.push(format!("{} (star bound {bound:.3})", words(&filled)));
                return Ok(());
            }
            let mut one = *self.embed;
            one.starts = one.starts.max(1);
            one.programs = one.programs.min(SCREENING);
            one.smooth_start = true;
            place_as_it_is(&filled, self.boundary, Some(&one), &self.limited())
        } else {
            place(&mut filled, self.problem, self.boundary, Some(self.embed), &self.limited())
        };
        let rank = rank(&filled, &placed, prefer);
        let valid = if placed.is_certified() { format!("{:.3}", placed.worst()) } else { "not certified".to_owned() };
        self.seen.push(format!("{} ({valid})", words(&filled)));
        if self.best.as_ref().is_none_or(|(r, ..)| rank < *r) {
            self.best = Some((rank, filled, placed));
        }
        Ok(())
    }

    /// The mesh with the stars split that leave (next to) no room; `None` if there are none, or none can be helped.
    fn split(&self, filled: &Filled, bound: f64) -> Result<Option<Filled>, FillError> {
        let mut options = SplitOptions::default();
        // Pillows are candidates of their own.
        options.layer = Layer::Never;
        if bound >= options.below {
            return Ok(None);
        }
        let Some(split) = split_stars(&filled.mesh, self.boundary, &options, self.ctx) else { return Ok(None) };
        let after = quick_star_bound(&split.mesh, self.boundary).unwrap_or(1.0);
        if split.splits.is_empty() || after <= bound {
            return Ok(None);
        }
        verify(&self.problem.surface, &split.mesh, filled.route)?;
        Ok(Some(filled.changed("split stars", split.mesh)))
    }
}

impl Trial<'_> {
    /// Raises the best mesh further, if it was only screened.
    fn polish(&mut self) {
        let limited = self.limited();
        let Some((_, filled, placed)) = &mut self.best else { return };
        let open = placed.embedding.as_ref().is_some_and(|e| placed.worst() < RELATIVE * e.target);
        if filled.route != Route::Shelling || !placed.is_certified() || !open || limited.stop().is_some() {
            return;
        }
        let mut more = *self.embed;
        more.starts = 1;
        more.programs = more.programs.min(PROGRAMS);
        let from = Filled { start: Some(placed.points.clone()), ..filled.clone() };
        let polished = place_as_it_is(&from, self.boundary, Some(&more), &limited);
        if polished.is_certified() && polished.worst() > placed.worst() {
            *placed = polished;
        }
    }
}

impl Trial<'_> {
    /// Cuts the pillow of the best mesh into the layers asked for, and says so.
    fn cut_layers(&mut self) -> Result<Option<String>, FillError> {
        let (Some(layers), Some((_, filled, placed))) = (self.options.layers, &mut self.best) else { return Ok(None) };
        let surface = &self.problem.surface;
        let Some((mesh, points)) = cut_boundary_layers(&filled.mesh, surface, &placed.points, &layers) else {
            return Err(FillError::NotForStrategy {
                what: "no mesh with a layer of one hexahedron under every quad was found, so there is nothing to cut into boundary layers"
                    .to_owned(),
                remedy: "leave --layers out",
            });
        };
        verify(surface, &mesh, filled.route)?;
        *filled = filled.changed("boundary layers", mesh);
        *placed = place_points(filled, self.boundary, points, placed.embedding.take());
        Ok(Some(format!("{} boundary layers", layers.count)))
    }
}

/// A worst scaled Jacobian of this share of what was strived for is not raised further.
const RELATIVE: f64 = 0.999;

fn words(filled: &Filled) -> String {
    format!("{} hexes by {}", filled.mesh.n_hexes(), filled.route.words())
}

/// Linear programs for a shelled mesh while the best is looked for, and once it is found: it is near its best where it
/// starts, and the last digits take most of the time.
const SCREENING: usize = 5;
const PROGRAMS: usize = 20;

/// Stars that reach no more than this leave no room for a valid mesh.
const NO_ROOM: f64 = 1e-6;

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
