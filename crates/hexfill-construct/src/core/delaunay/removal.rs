//! Inner points are removed as long as the tets stay good enough, and those that stay are moved to better places.
//!
//! Source: Freitag and Ollivier-Gooch 1997 (smoothing beside swapping); what is good enough is ours.

use super::solid::{FLOOR_INSIDE, Solid};
use hexfill_mesh::{Context, StopReason, VertexId};

impl Solid {
    /// Removes inner points by drawing them onto neighbours, and moves those that stay to better places.
    pub(super) fn remove_points(&mut self, ctx: &Context<'_>) -> Result<(), StopReason> {
        for round in 0..6 {
            self.improve(ctx)?;
            let mut removed = 0;
            for v in self.points.ids().skip(self.n_surface).rev() {
                if let Some(reason) = ctx.stop() {
                    return Err(reason);
                }
                if self.tets_at[v].is_empty() || !self.faces_at[v].is_empty() {
                    continue;
                }
                if self.draw_inside(v) {
                    removed += 1;
                } else {
                    self.smooth(v);
                }
            }
            ctx.report("points removed", round, None, || format!("{removed}"));
            self.save_tets();
            if removed == 0 {
                break;
            }
        }
        self.improve(ctx)?;
        self.split_flat(ctx)
    }

    fn draw_inside(&mut self, v: VertexId) -> bool {
        let floor = FLOOR_INSIDE.min(self.least_now(v)).max(0.0);
        let mut best: Option<(f64, VertexId)> = None;
        for u in self.neighbours(v) {
            if let Some(q) = self.least_drawn(best.map_or(floor, |b| b.0), v, u) {
                best = Some((q, u));
            }
        }
        let Some((_, u)) = best else { return false };
        let tets = self.drawn(v, u);
        self.replace_tets(v, &tets);
        true
    }
}
