//! The automatic strategy where coordinates count: candidates of several engines, embedded, and the best of them.
//!
//! Engines in this order, the next only if none before brought a good mesh: atlas and shelling, inward flips, construction.
//! The order of meshes is [`rank()`]'s.
//!
//! Source: ours; measured in `record/embed-2026-11-21.md` and `record/shelling-2026-11-22.md`.

use crate::best::budget::Budget;
use crate::best::choice::{Candidate, Choice, Outcome};
use crate::best::consider::NO_ROOM;
use crate::best::hopeless::{Hopeless, hopeless};
use crate::best::leader::Leader;
use crate::best::mend::mended;
use crate::best::no_room::no_room;
use crate::best::pillows::with_pillows;
use crate::best::{PlaceOptions, PlacedFill};
use crate::fill::attempt::Attempt;
use crate::fill::construct::construct;
use crate::fill::error::FillError;
use crate::fill::filled::{FillResult, Filled, Route};
use crate::fill::judged::verify;
use crate::fill::last_resort::{LastResort, leaving_time};
use crate::fill::maker::Maker;
use crate::fill::options::{Effort, FillOptions, Strategy};
use crate::fill::search::{search, smallest_on_record};
use crate::fill::shelled::shelled;
use crate::fill::stored::stored_mesh;
use crate::place::place_best;
use crate::place::placed::Placed;
use crate::problem::Problem;
use hexfill_embed::quick_star_bound;
use hexfill_lay::lay;
use hexfill_mesh::{Context, HexMesh, StopReason, hex_isomorphism, surface_symmetry_order};
use hexfill_search::MAX_QUADS;
use hexfill_shell::{CutLayers, ShellOptions, cut_boundary_layers};

/// Surfaces of at most so many quads have many fillings in the atlas.
const SMALLEST: usize = 24;
/// Starts for each of these: the first ones find most of what many find.
const STARTS: u32 = 2;

/// Surfaces of more quads are constructed only if nothing else filled them.
const MOST_CONSTRUCTED: usize = 1000;

/// Hexes are laid one by one in surfaces of at most so many quads.
pub(crate) const MOST_LAID: usize = 2500;

/// What a sweep leaves is stirred until it closes up to so many quads; beyond, few such meshes have valid positions, so hexes are laid there first.
const MOST_STIRRED: usize = 100;

/// Meshes whose last bad hexes are mended, one after the other until one is valid.
const MOST_MENDED: usize = 4;

/// Pillows are put into meshes of surfaces of at most so many quads.
const MOST_PILLOWED: usize = 160;

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
    let result = FillResult::new();
    let early = leaving_time(problem, options, ctx);
    let budget = options.effort.budget(&options.shell);
    let mut trial = Trial {
        problem,
        options,
        boundary,
        how,
        ctx,
        early,
        embed,
        budget,
        result,
        best: None,
        seen: Vec::new(),
        tangled: None,
        nearly: Vec::new(),
        hopeless: None,
    };
    trial.look_up()?;
    trial.shell()?;
    let why_none = trial.go_on()?;
    trial.resort()?;
    trial.polish();
    trial.inflate();
    let layers = trial.cut_layers()?;
    Ok(trial.finish(why_none, layers))
}

/// The best mesh so far and what was tried.
pub(super) struct Trial<'a> {
    pub(super) problem: &'a Problem,
    pub(super) options: &'a FillOptions,
    pub(super) boundary: &'a [[f64; 3]],
    pub(super) how: &'a PlaceOptions,
    pub(super) ctx: &'a Context<'a>,
    /// For engines that may find nothing.
    pub(super) early: Context<'a>,
    pub(super) embed: &'a hexfill_embed::Options,
    pub(super) budget: Budget,
    /// What the engines say; their meshes stay here until they are considered.
    pub(super) result: FillResult,
    pub(super) best: Option<Leader>,
    /// The meshes considered.
    pub(super) seen: Vec<Candidate>,
    /// The shelled mesh nearest to valid positions, while none has any: bad corners first, then hexes.
    pub(super) tangled: Option<Tangled>,
    /// The laid meshes without valid positions.
    pub(super) nearly: Vec<Tangled>,
    /// Why no work is spent beyond the first trials, once that was asked.
    pub(super) hopeless: Option<Option<Hopeless>>,
}

/// A mesh whose embedding failed.
pub(super) struct Tangled {
    /// Hexes with a corner that is not positive.
    pub(super) bad: usize,
    pub(super) filled: Filled,
    pub(super) points: Vec<[f64; 3]>,
}

impl<'a> Trial<'a> {
    /// Looks a small sphere up in the atlas, and any surface in the catalogue.
    fn look_up(&mut self) -> Result<(), FillError> {
        if self.options.strategy != Strategy::Auto {
            return Ok(());
        }
        if self.is_small() {
            // One cavity: the surface itself.
            self.flip_inward(1)?;
        }
        let Some(mesh) = stored_mesh(&self.problem.surface) else {
            return if self.is_small() { self.look_up_smallest() } else { Ok(()) };
        };
        if self.is_new(&mesh) && mesh.n_hexes() as u64 <= u64::from(self.options.max_hexes) {
            verify(&self.problem.surface, &mesh, Route::Catalogue)?;
            self.consider(Filled::by(Route::Catalogue, mesh))?;
        }
        Ok(())
    }

    /// Considers the smallest filling on record, too, unless its star bound says that it cannot be better than what is there.
    fn look_up_smallest(&mut self) -> Result<(), FillError> {
        let is_done = self.options.effort == Effort::Fast && self.is_enough();
        if self.options.atlas.is_some() || self.options.layers.is_some() || is_done || self.ctx.stop().is_some() {
            return Ok(());
        }
        let surface = &self.problem.surface;
        let Some(filled) = smallest_on_record(surface, self.options, self.ctx)?.filter(|f| self.is_new(&f.mesh)) else {
            return Ok(());
        };
        // On a surface with symmetries the mesh may lie another way, which has another bound.
        let has_one_way = surface_symmetry_order(surface) == 1;
        if has_one_way
            && self.best.is_some()
            && let Ok(bound) = quick_star_bound(&filled.mesh, self.boundary)
            && (bound <= NO_ROOM || self.is_beaten(&filled, bound))
        {
            self.seen.push(Candidate::new(&filled, Outcome::Bounded(bound)));
            return Ok(());
        }
        self.consider(filled)
    }

    /// Whether a mesh is not the best one, renumbered.
    fn is_new(&self, mesh: &HexMesh) -> bool {
        self.best.as_ref().is_none_or(|leader| hex_isomorphism(&leader.filled.mesh, mesh) == Ok(None))
    }

    /// Shells the surface.
    fn shell(&mut self) -> Result<(), FillError> {
        if self.options.effort == Effort::Fast && self.is_enough() && self.options.layers.is_none() {
            return Ok(());
        }
        let shell = self.budget.shell.clone();
        let shell = if self.is_laid_first() { shell.with_largest_residual(MOST_STIRRED) } else { shell };
        if self.options.layers.is_some() || self.budget.enough.is_none() {
            return self.shell_by(shell).map(drop);
        }
        // Where the surface says what its columns are, sweeps have nothing better, and their embedding takes the time.
        let found = self.shell_by(shell.clone().with_sweeps(false))?;
        if found && self.is_enough() { Ok(()) } else { self.shell_by(shell.with_direct(false)).map(drop) }
    }

    /// Whether hexes are laid before the large residual of a sweep is stirred.
    fn is_laid_first(&self) -> bool {
        let surface = &self.problem.surface;
        let is_asked = self.options.strategy == Strategy::Auto && self.options.layers.is_none();
        is_asked && surface.is_sphere() && surface.n_quads() <= MOST_LAID
    }

    /// Whether a sweep left a residual that was not stirred.
    fn is_left_open(&self) -> bool {
        let is_large =
            |t: &Attempt| matches!(t, Attempt::Shelling { left, .. } if (MOST_STIRRED + 1..usize::MAX).contains(left));
        self.is_laid_first() && self.result.tried.iter().any(is_large)
    }

    /// Shells the surface with these options; whether that brought a mesh.
    fn shell_by(&mut self, shell: ShellOptions) -> Result<bool, FillError> {
        let how = FillOptions { shell, ..self.options.clone() };
        let made = shelled(self.problem, &how, &self.early, &mut self.result)?;
        let found = !made.is_empty();
        for filled in made {
            if self.best.is_some()
                && (self.ctx.stop().is_some() || self.options.effort == Effort::Fast && self.is_enough())
            {
                break;
            }
            self.consider(filled)?;
        }
        Ok(found)
    }

    /// Asks the other engines where no mesh is good yet. Says why none can be valid, if that is known.
    fn go_on(&mut self) -> Result<Option<String>, FillError> {
        if self.is_enough() || self.ctx.stop().is_some() {
            return Ok(None);
        }
        if self.options.strategy != Strategy::Auto {
            self.lay()?;
            self.mend()?;
            self.put_pillows()?;
            return Ok(None);
        }
        let none_valid = no_room(&self.problem.surface, self.boundary).map(|why| format!("none can be valid: {why}"));
        let why_none = none_valid.or_else(|| match self.hopeless() {
            Some(Hopeless::Crosses(why) | Hopeless::Folded(why)) => {
                Some(format!("{why} (--best goes on all the same)"))
            }
            _ => None,
        });
        // The atlas has many fillings of the smallest surfaces, with fewer hexes than can be laid.
        let smallest = self.problem.surface.n_quads() <= SMALLEST;
        if why_none.is_none() && !smallest {
            self.lay()?;
        }
        if self.best.is_none() && self.is_left_open() && self.ctx.stop().is_none() {
            self.shell_by(self.budget.shell.clone())?;
        }
        if self.is_small() && why_none.is_none() {
            if self.class() != Some(1) || self.budget.enough.is_none() {
                self.flip_inward(self.options.inward_cavities.min(self.budget.cavities))?;
            }
            self.look_at_more_fillings()?;
        }
        if why_none.is_none() {
            if smallest {
                self.lay()?;
            }
            self.mend()?;
            self.put_pillows()?;
        }
        // A construction has some 46 hexes a quad: where shelling left a few of its own invalid, it is tried on small surfaces only.
        let worth_trying = match self.class() {
            None => true,
            Some(2) => why_none.is_none() && self.problem.surface.n_quads() <= MOST_CONSTRUCTED,
            Some(_) => false,
        };
        if worth_trying && self.ctx.stop().is_none() {
            construct(self.problem, self.options, self.ctx, &mut self.result)?;
            self.consider_found()?;
        }
        Ok(why_none)
    }

    /// Lays hexes one by one if no mesh has valid positions yet, in the one void that a sweep leaves.
    fn lay(&mut self) -> Result<(), FillError> {
        let surface = &self.problem.surface;
        let is_worth = matches!(self.class(), None | Some(2)) && surface.n_quads() <= MOST_LAID;
        if !is_worth || self.options.layers.is_some() || self.ctx.stop().is_some() {
            return Ok(());
        }
        let made = lay(surface, self.boundary, &self.budget.lay, &self.early);
        self.result.tried.push(Attempt::Laying { meshes: made.len() });
        for laid in made {
            if laid.mesh.n_hexes() as u64 > u64::from(self.options.max_hexes) {
                continue;
            }
            verify(surface, &laid.mesh, Route::Laying)?;
            let makers = laid.steps.iter().map(|&step| Maker::of_laying(step)).collect();
            let filled = Filled { start: Some(laid.points), makers, ..Filled::by(Route::Laying, laid.mesh) };
            self.consider_from(filled, false)?;
            // What was screened says little of what it may become, and the next have more hexes.
            self.polish();
            if self.class() == Some(0) {
                break;
            }
        }
        Ok(())
    }

    /// Puts pillows round the last hexes that are not valid, if only a few are left: of the best mesh, then of other laid ones.
    fn mend(&mut self) -> Result<(), FillError> {
        let surface = &self.problem.surface;
        let is_worth = self.class() == Some(2) && surface.n_quads() <= MOST_CONSTRUCTED && self.ctx.stop().is_none();
        let is_asked = self.options.effort != Effort::Fast && self.options.layers.is_none();
        if !is_worth || !is_asked {
            return Ok(());
        }
        let best = self.best.as_ref().map(|leader| (leader.filled.clone(), leader.placed.points.clone()));
        let is_best = |mesh: &HexMesh| best.as_ref().is_some_and(|(filled, _)| filled.mesh.hexes() == mesh.hexes());
        // Which mesh can be mended is luck where two or three needles keep a hex bad each: so the next best are tried, too.
        self.nearly.sort_by_key(|t| (t.bad, t.filled.mesh.n_hexes()));
        let others = self.nearly.drain(..).filter(|t| !is_best(&t.filled.mesh)).map(|t| (t.filled, t.points));
        let all: Vec<_> = best.clone().into_iter().chain(others.take(MOST_MENDED - 1)).collect();
        for (filled, points) in all {
            let is_small = |mesh: &HexMesh| mesh.n_hexes() as u64 <= u64::from(self.options.max_hexes);
            let made = mended(&filled.mesh, &points, surface, &self.early).filter(|(mesh, ..)| is_small(mesh));
            self.result.tried.push(Attempt::Mending { found: made.is_some() });
            if let Some((mesh, points, origin)) = made {
                verify(surface, &mesh, filled.route)?;
                let mended = Filled { start: Some(points), ..filled.remade(Maker::PillowsBetween, mesh, &origin) };
                self.consider_from(mended, false)?;
            }
            if self.class() != Some(2) || self.ctx.stop().is_some() {
                break;
            }
        }
        Ok(())
    }

    /// Puts pillows into the shelled mesh that is nearest to valid positions, if none has any. Only on small surfaces: the work grows with the mesh.
    fn put_pillows(&mut self) -> Result<(), FillError> {
        let surface = &self.problem.surface;
        let is_worth = self.class() == Some(2) && surface.n_quads() <= MOST_PILLOWED && self.ctx.stop().is_none();
        // Where hexes were laid, what is not valid is at vertices that pillows cannot help.
        let is_laid = self.result.tried.iter().any(|t| matches!(t, Attempt::Laying { meshes } if *meshes > 0));
        let is_worth = is_worth && !is_laid;
        let Some(limits) = self.budget.pillows.filter(|_| is_worth && self.options.layers.is_none()) else {
            return Ok(());
        };
        let Some(Tangled { filled, points, .. }) = self.tangled.take() else { return Ok(()) };
        let made = with_pillows(&filled.mesh, &points, surface, limits, &self.early);
        self.result.tried.push(Attempt::Pillows { found: made.is_some() });
        let is_small = |mesh: &HexMesh| mesh.n_hexes() as u64 <= u64::from(self.options.max_hexes);
        let Some((mesh, points, origin)) = made.filter(|(mesh, ..)| is_small(mesh)) else { return Ok(()) };
        verify(surface, &mesh, filled.route)?;
        let pillowed = Filled { start: Some(points), ..filled.remade(Maker::PillowsBetween, mesh, &origin) };
        self.consider_from(pillowed, false)
    }

    /// Constructs the surface if the work was stopped before there was a mesh.
    fn resort(&mut self) -> Result<(), FillError> {
        if self.best.is_none() {
            LastResort::default().fill(self.problem, self.options, self.ctx, &mut self.result)?;
            self.consider_found()?;
        }
        Ok(())
    }

    /// Fills by inward flips over so many cavities.
    fn flip_inward(&mut self, inward_cavities: u64) -> Result<(), FillError> {
        let inward = FillOptions { inward_cavities, ..self.options.clone() };
        search(&self.problem.surface, &inward, &self.early, &mut self.result)?;
        self.consider_found()
    }

    /// Looks at many fillings of one of the smallest surfaces, which the atlas knows.
    fn look_at_more_fillings(&mut self) -> Result<(), FillError> {
        if self.is_enough() || self.problem.surface.n_quads() > SMALLEST || self.ctx.stop().is_some() {
            return Ok(());
        }
        let more = FillOptions { count: self.budget.fillings, ..self.options.clone() };
        let mut found = FillResult::new();
        search(&self.problem.surface, &more, &self.early, &mut found)?;
        if found.stop != StopReason::Finished {
            self.result.stop = found.stop;
        }
        self.result.tried.push(Attempt::Fillings { found: found.meshes.len() });
        let mut embed = *self.embed;
        if embed.starts() == 0 {
            embed = embed.with_starts(STARTS);
        }
        match place_best(&found.meshes, self.problem, self.boundary, &embed, &self.limited()) {
            Some((filled, placed)) if placed.is_certified() => self.consider(filled),
            _ => Ok(()),
        }
    }

    /// Why the surface is not worth more than one trial of each mesh, asked where none is valid yet.
    pub(super) fn hopeless(&mut self) -> Option<Hopeless> {
        // Only where nothing is valid so far: a mesh in hand is better evidence than any forecast.
        if self.options.effort == Effort::Best || !matches!(self.class(), None | Some(2)) {
            return None;
        }
        let (problem, boundary) = (self.problem, self.boundary);
        self.hopeless.get_or_insert_with(|| hopeless(problem, boundary)).clone()
    }

    /// Whether a mesh of this route that cannot be valid is worth a look: the first mesh of all, or, where none is valid, the first laid one, which is all but
    /// valid as it was laid.
    pub(super) fn is_first_of(&self, route: Route) -> bool {
        let has_positions = |c: &Candidate| c.route == route && !matches!(c.outcome, Outcome::Bounded(_));
        match self.class() {
            None => true,
            Some(2) => route == Route::Laying && !self.seen.iter().any(has_positions),
            Some(_) => false,
        }
    }

    fn is_small(&self) -> bool {
        self.problem.surface.is_sphere() && self.problem.surface.n_quads() <= MAX_QUADS
    }

    pub(super) fn limited(&self) -> Context<'a> {
        self.how.limit.map_or(*self.ctx, |limit| self.ctx.with_time_limit(limit))
    }

    pub(super) fn class(&self) -> Option<u8> {
        self.best.as_ref().map(|leader| leader.rank.0)
    }

    /// Whether no other engine need be asked.
    fn is_enough(&self) -> bool {
        self.class().zip(self.budget.enough).is_some_and(|(class, enough)| class <= enough)
    }

    /// Raises the best mesh further, if it was only screened.
    fn polish(&mut self) {
        let programs = self.budget.programs;
        let limited = self.limited();
        if let Some(leader) = &mut self.best {
            leader.polish(self.boundary, self.embed, programs, self.options.prefer, &limited);
        }
    }

    /// Lets tiny cells of the best mesh grow.
    fn inflate(&mut self) {
        let limited = self.limited();
        if let Some(leader) = &mut self.best {
            leader.inflate(self.boundary, &limited);
        }
    }

    /// Cuts the pillow of the best mesh into the layers asked for, and says how many.
    fn cut_layers(&mut self) -> Result<Option<u32>, FillError> {
        let (Some(layers), Some(Leader { filled, placed, .. })) = (self.options.layers, &mut self.best) else {
            return Ok(None);
        };
        let surface = &self.problem.surface;
        let made = cut_boundary_layers(&filled.mesh, surface, &placed.points, &layers);
        let Some(CutLayers { mesh, points, origin }) = made else {
            return Err(FillError::NotForStrategy {
                what: "no mesh with a layer of one hexahedron under every quad was found, so there is nothing to cut into boundary layers"
                    .to_owned(),
                remedy: "leave --layers out",
            });
        };
        verify(surface, &mesh, filled.route)?;
        *filled = filled.remade(Maker::BoundaryLayers, mesh, &origin);
        *placed = Placed::judged(&filled.mesh, self.boundary, points, placed.embedding.take(), None);
        Ok(Some(layers.count))
    }

    /// The best mesh, and in words why it and no other.
    fn finish(self, why_none: Option<String>, layers: Option<u32>) -> PlacedFill {
        let Self { best, seen, result, ctx, hopeless, .. } = self;
        let choice = Choice {
            kept: best.as_ref().filter(|_| seen.len() > 1).map(|b| (b.filled.mesh.n_hexes(), b.filled.route)),
            candidates: seen,
            none_tried: why_none,
            one_start: match hopeless {
                Some(Some(Hopeless::Sharp(why))) => Some(why),
                _ => None,
            },
            layers,
            ..Choice::default()
        };
        let stop = if result.stop == StopReason::Finished { ctx.stop().unwrap_or(result.stop) } else { result.stop };
        let meshes = best.into_iter().map(|leader| (leader.filled, Some(leader.placed))).collect();
        PlacedFill { meshes, stop, tried: result.tried, choice: (!choice.is_empty()).then_some(choice) }
    }
}
