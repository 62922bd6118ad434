//! Meshes become coarser inside: sheets fixed by the surface need not go all the way through.
//!
//! Source: ours; measured in `record/coarsening-2026-11-24.md`.

use crate::best::choose::Trial;
use crate::fill::attempt::Attempt;
use crate::fill::error::FillError;
use crate::fill::filled::Filled;
use crate::fill::judged::verify;
use crate::fill::maker::Maker;
use crate::fill::options::Prefer;
use hexfill_shell::Coarsening;

/// A round that leaves more than so much of the hexes is not worth it.
const WORTH: f64 = 0.9;

impl Trial<'_> {
    /// Considers what a shelled mesh becomes round by round, as long as each is the best so far. This comes before the mesh itself, which often need not be
    /// embedded then.
    pub(super) fn consider_coarser(&mut self, fine: &Filled) -> Result<(), FillError> {
        if !self.may_be_coarser(fine) {
            return Ok(());
        }
        let mut coarsening = Coarsening::new(&fine.mesh);
        let mut before = fine.mesh.n_hexes();
        while self.ctx.stop().is_none() && coarsening.round(self.ctx) {
            let Ok(made) = coarsening.mesh() else { break };
            let after = made.mesh.n_hexes();
            if after as f64 > WORTH * before as f64 {
                break;
            }
            verify(&self.problem.surface, &made.mesh, fine.route)?;
            let start = fine.start.as_ref().map(|at| made.vertices.iter().map(|&v| at[v as usize]).collect());
            let coarse = fine.remade(Maker::Coarsening, made.mesh, &made.origin);
            self.consider_from(Filled { start, ..coarse }, true)?;
            let leader = self.best.as_mut().filter(|leader| leader.filled.mesh.n_hexes() == after);
            let found = leader.is_some();
            // Its worst hexes are at the turns, where more work brings next to nothing.
            leader.into_iter().for_each(|leader| leader.is_polished = true);
            self.result.tried.push(Attempt::Coarsening { before, after, found });
            if !found {
                break;
            }
            before = after;
        }
        Ok(())
    }

    /// Under a pillow what is inside is free; without one it is the sweep of the surface that someone had in mind, and stays, unless fewest hexes are
    /// preferred.
    fn may_be_coarser(&self, fine: &Filled) -> bool {
        let is_asked = match self.options.prefer {
            Prefer::Hexes => true,
            Prefer::Balance => fine.makers.contains(&Maker::Pillows),
            Prefer::Quality => false,
        };
        is_asked && !fine.makers.contains(&Maker::Coarsening)
    }
}
