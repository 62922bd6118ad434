//! A mesh is considered: its star bound is asked, it is embedded, and kept if it is the best so far.
//!
//! Source: ours.

use crate::best::choice::{Candidate, Outcome};
use crate::best::choose::{Tangled, Trial};
use crate::best::leader::Leader;
use crate::best::rank::{GOOD, rank, within};
use crate::fill::error::FillError;
use crate::fill::filled::{Filled, Route};
use crate::fill::judged::verify;
use crate::fill::maker::Maker;
use crate::place::placed::Placed;
use crate::place::{place_as_it_is, place_at};
use crate::simplify::carried_positions;
use hexfill_embed::quick_star_bound;
use hexfill_mesh::VertexId;
use hexfill_shell::{Layer, SplitOptions, split_stars};

/// Stars that reach no more than this leave no room for a valid mesh.
pub(super) const NO_ROOM: f64 = 1e-6;
/// Positions that reach so much of the star bound are not looked for once more.
const REACHED: f64 = 0.98;

impl Trial<'_> {
    /// Considers the meshes that an engine found.
    pub(super) fn consider_found(&mut self) -> Result<(), FillError> {
        std::mem::take(&mut self.result.meshes).into_iter().try_for_each(|filled| self.consider(filled))
    }

    /// Embeds a mesh and keeps it if it is the best. The start positions of a shelling are a guess.
    pub(super) fn consider(&mut self, filled: Filled) -> Result<(), FillError> {
        let is_guess = filled.route == Route::Shelling;
        self.consider_from(filled, is_guess)
    }

    /// [`Self::consider`], where start positions are a guess, to be smoothed first, or what to begin with.
    pub(super) fn consider_from(&mut self, mut filled: Filled, is_guess: bool) -> Result<(), FillError> {
        let prefer = self.options.prefer;
        let has_pillow = filled.route == Route::Shelling || filled.makers.contains(&Maker::Pillows);
        if self.options.layers.is_some() && !has_pillow {
            // Layers are cut out of a pillow, which shelling puts by itself.
            let pillow = SplitOptions::default().with_below(-1.0).with_layer(Layer::Always);
            let Some(pillowed) = split_stars(&filled.mesh, self.boundary, &pillow, self.ctx) else { return Ok(()) };
            verify(&self.problem.surface, &pillowed.mesh, filled.route)?;
            filled = filled.changed(Maker::Pillows, pillowed.mesh);
        }
        let is_shelled = filled.route == Route::Shelling;
        if is_shelled {
            self.consider_coarser(&filled)?;
            // Even at a worst scaled Jacobian of 1 it would have too many hexes to be kept; embedding is what costs,
            // so it is not begun.
            if self.is_beaten(&filled, 1.0) {
                return Ok(());
            }
        }
        let mut bound = 1.0;
        if is_shelled || matches!(filled.route, Route::Laying | Route::Construction) {
            bound = quick_star_bound(&filled.mesh, self.boundary).unwrap_or(1.0);
            if let Some(split) = self.split(&filled, bound)? {
                self.consider(split)?;
            }
            // The bound is a theorem for this mesh: no positions of inner vertices beat it. Something must be
            // returned, so the first one is kept all the same.
            let is_beaten = is_shelled && self.is_beaten(&filled, bound);
            if is_beaten || bound <= NO_ROOM && !self.is_first_of(filled.route) {
                self.seen.push(Candidate::new(&filled, Outcome::Bounded(bound)));
                return Ok(());
            }
        }
        let placed = if is_shelled || filled.route == Route::Laying {
            // Its surface vertices lie where the surface's do, so there is one way to place it.
            let one = self
                .embed
                .with_starts(self.embed.starts().max(1))
                .with_programs(self.embed.programs().min(self.budget.screening))
                .with_smooth_start(is_guess && !filled.is_placed);
            let placed = place_as_it_is(&filled, self.boundary, Some(&one), &self.limited());
            let placed = self.placed_from_guess(&filled, placed, &one, bound);
            self.placed_from_coarse(&filled, placed, one)
        } else {
            let mut how = self.embed.with_programs(self.embed.programs().min(self.budget.others));
            let is_late = self.best.is_some() || filled.route == Route::Construction;
            if how.starts() == 0 && is_late && self.hopeless().is_some() {
                how = how.with_starts(1);
            }
            let (turned, placed) = place_at(filled, self.problem, self.boundary, Some(&how), &self.limited());
            filled = turned;
            placed
        };
        if is_shelled && !placed.is_certified() {
            let bad = placed.cells.iter().filter(|c| c.corner_scaled_jacobian <= 0.0).count();
            let least = self.tangled.as_ref().map(|t| (t.bad, t.filled.mesh.n_hexes()));
            if least.is_none_or(|least| (bad, filled.mesh.n_hexes()) < least) {
                // Fewest bad corners first, as pillows mend corners; then fewest hexes, as each pillow brings more.
                self.tangled = Some(Tangled { bad, filled: filled.clone(), points: placed.points.clone() });
            }
        }
        if filled.route == Route::Laying && !placed.is_certified() {
            let bad = placed.cells.iter().filter(|c| !c.valid).count();
            self.nearly.push(Tangled { bad, filled: filled.clone(), points: placed.points.clone() });
        }
        let rank = rank(&filled, &placed, prefer, self.boundary.len());
        let outcome = if placed.is_certified() { Outcome::Certified(placed.worst()) } else { Outcome::NotCertified };
        self.seen.push(Candidate::new(&filled, outcome));
        if self.best.as_ref().is_none_or(|leader| rank < leader.rank) {
            self.best = Some(Leader { rank, filled, placed, is_polished: false });
        }
        Ok(())
    }

    /// Whether a mesh whose worst scaled Jacobian is at most `bound` comes behind the best so far.
    pub(super) fn is_beaten(&self, filled: &Filled, bound: f64) -> bool {
        let reaches = (u8::from(bound < GOOD), within(filled.mesh.n_hexes(), bound, self.options.prefer));
        self.best.as_ref().is_some_and(|leader| leader.rank <= reaches)
    }

    /// The better of two placements of a mesh; the first if they are as good.
    fn better(&self, filled: &Filled, first: Placed, second: Placed) -> Placed {
        let rank = |placed| rank(filled, placed, self.options.prefer, self.boundary.len());
        if rank(&second) < rank(&first) { second } else { first }
    }

    /// A mesh that was placed from positions of its own, or placed once more as if these were a guess, if it is not as good as its star bound.
    fn placed_from_guess(&self, filled: &Filled, placed: Placed, how: &hexfill_embed::Options, bound: f64) -> Placed {
        if !filled.is_placed || placed.is_certified() && placed.worst() >= REACHED * bound || self.ctx.stop().is_some()
        {
            return placed;
        }
        let how = how.with_smooth_start(true);
        self.better(filled, placed, place_as_it_is(filled, self.boundary, Some(&how), &self.limited()))
    }

    /// A mesh that was placed, or placed once more if it is not good: from the positions of the coarse mesh it was lifted from, which has
    /// few hexes and is often valid where the fine one is not.
    fn placed_from_coarse(&self, filled: &Filled, placed: Placed, how: hexfill_embed::Options) -> Placed {
        let is_good = placed.is_certified() && placed.worst() >= GOOD;
        let Some(coarse) = filled.coarse.as_ref().filter(|_| !is_good && self.ctx.stop().is_none()) else {
            return placed;
        };
        let at = hexfill_embed::embed(coarse.mesh(), &coarse.boundary(), None, &how, &self.limited());
        let Some(start) = at.ok().and_then(|at| coarse.lifted(&at.points)) else { return placed };
        let from = Filled { start: Some(start), ..filled.clone() };
        let how = how.with_smooth_start(false);
        self.better(filled, placed, place_as_it_is(&from, self.boundary, Some(&how), &self.limited()))
    }

    /// The mesh with the stars split that leave (next to) no room; `None` if there are none, or none can be helped.
    fn split(&self, filled: &Filled, bound: f64) -> Result<Option<Filled>, FillError> {
        // Pillows are candidates of their own.
        let options = SplitOptions::default().with_layer(Layer::Never);
        if bound >= options.below() {
            return Ok(None);
        }
        let Some(split) = split_stars(&filled.mesh, self.boundary, &options, self.ctx) else { return Ok(None) };
        let after = quick_star_bound(&split.mesh, self.boundary).unwrap_or(1.0);
        if split.splits.is_empty() || after <= bound {
            return Ok(None);
        }
        verify(&self.problem.surface, &split.mesh, filled.route)?;
        let mut made = filled.changed(Maker::SplitStars, split.mesh);
        // These start from positions of their own.
        let is_placed = matches!(filled.route, Route::Laying | Route::Construction);
        let start = filled.start.as_ref().filter(|_| is_placed);
        made.start = start.map(|points| {
            let origin: Vec<Option<VertexId>> =
                (0..made.mesh.n_vertices()).map(|v| (v < points.len()).then(|| VertexId::new(v))).collect();
            carried_positions(&made.mesh, &origin, points)
        });
        Ok(Some(made))
    }
}
