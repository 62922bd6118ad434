//! [`Leader`]: the best mesh so far, and what makes it better still without another mesh.
//!
//! Source: ours; measured in `record/embed-2026-11-21.md` and `record/self-crossing-2026-11-22.md`.

use crate::best::rank::{GOOD, Rank, rank};
use crate::fill::filled::{Filled, Route};
use crate::fill::options::Prefer;
use crate::place::place_as_it_is;
use crate::place::placed::Placed;
use hexfill_mesh::Context;

/// A worst scaled Jacobian of this share of what was strived for is not raised further.
const RELATIVE: f64 = 0.999;

/// The share of the worst scaled Jacobian that is kept while tiny cells grow.
const EVEN: f64 = 0.9;

/// The best mesh so far.
pub(super) struct Leader {
    /// Its place in the order.
    pub(super) rank: Rank,
    pub(super) filled: Filled,
    pub(super) placed: Placed,
    /// Whether it was raised as far as it is worth.
    pub(super) is_polished: bool,
}

impl Leader {
    /// Raises the mesh further by so many programs, if it was only screened; by all that `embed` allows, if it is not good yet.
    pub(super) fn polish(
        &mut self,
        boundary: &[[f64; 3]],
        embed: &hexfill_embed::Options,
        programs: usize,
        prefer: Prefer,
        ctx: &Context<'_>,
    ) {
        if self.is_polished || programs == 0 {
            return;
        }
        self.is_polished = true;
        let Self { filled, placed, .. } = self;
        let is_open = placed.embedding.as_ref().is_some_and(|e| placed.worst() < RELATIVE * e.target);
        let is_screened = matches!(filled.route, Route::Shelling | Route::Laying) && placed.is_certified() && is_open;
        if !is_screened || ctx.stop().is_some() {
            return;
        }
        let all = embed.programs();
        let programs = if placed.worst() >= GOOD { all.min(programs) } else { all };
        let from = Filled { start: Some(placed.points.clone()), ..filled.clone() };
        let polished = place_as_it_is(&from, boundary, Some(&embed.with_starts(1).with_programs(programs)), ctx);
        // What was screened is certified already; the raise must not lose that.
        if polished.is_certified() && polished.worst() > placed.worst() {
            self.rank = rank(filled, &polished, prefer, boundary.len());
            self.placed = polished;
        }
    }

    /// Lets tiny cells of a laid mesh grow. A scaled Jacobian knows no sizes, and hexes laid round an apex shrink from pillow to pillow.
    pub(super) fn inflate(&mut self, boundary: &[[f64; 3]], ctx: &Context<'_>) {
        let Self { filled, placed, .. } = self;
        if filled.route != Route::Laying || !placed.is_certified() {
            return;
        }
        let worst = placed.worst();
        let floor = if worst >= GOOD { GOOD.max(EVEN * worst) } else { EVEN * worst };
        // The judge's lower bounds are a little lower.
        let asked = 1.02 * floor;
        let Ok(Some(points)) = hexfill_embed::inflate(&filled.mesh, &placed.points, asked, ctx) else { return };
        let inflated = Placed::judged(&filled.mesh, boundary, points, placed.embedding.clone(), None);
        // Whoever judges has the last word.
        if inflated.is_certified() && inflated.worst() >= floor {
            self.placed = inflated;
        }
    }
}
