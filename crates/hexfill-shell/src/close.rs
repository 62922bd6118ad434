//! Closing a small void: from the atlas of smallest known fillings, or by inward flips that lead there.
//!
//! What is behind the front blocks pairs of its vertices: the filling must avoid them, so that the whole is proper. The atlas knows several
//! fillings of many spheres. Where none fits, or blocked pairs cost too much, a pillow goes first: behind it nothing is blocked.
//!
//! Source: Verhetsel et al. 2019, figure 1 (a cavity is looked up among known meshes); fillings that avoid what is there already are ours.

use crate::front::Front;
use hexfill_mesh::{Context, QuadSurface};
use hexfill_search::{Atlas, FillOptions, MAX_QUADS, fill_avoiding};

/// Cavities that inward flips may look at, for a void with its blocked pairs and for one in a pillow.
const CAVITIES: u64 = 10_000;
/// Cavities kept on each level.
const BEAM: usize = 200;

impl Front {
    /// The state with the void filled from the atlas, by the fewest hexes. `None` if the front is not one sphere that the atlas knows.
    pub fn closed_from(&self, atlas: &Atlas) -> Option<Self> {
        // One cavity: the void itself.
        let fill = |front: &Self| front.filled(atlas, 1, &Context::default());
        let both = [fill(self), fill(&self.pillowed().0)].into_iter().flatten();
        both.min_by_key(|state| state.hexes().len())
    }

    /// The state with the void filled by inward flips, if the atlas does not know it. `None` if the front is too large, no sphere, or nothing
    /// was found.
    pub(crate) fn closed(&self, ctx: &Context<'_>) -> Option<Self> {
        if self.n_quads() == 0 {
            return Some(self.clone());
        }
        let fill = |front: &Self| front.filled(Atlas::embedded(), CAVITIES, ctx);
        let plain = fill(self);
        if plain.as_ref().is_some_and(|state| state.hexes().len() <= self.hexes().len() + self.n_quads()) {
            return plain;
        }
        let both = [plain, fill(&self.pillowed().0)].into_iter().flatten();
        both.min_by_key(|state| state.hexes().len())
    }

    /// The state with the void filled as it is, by looking at so many cavities at most.
    fn filled(&self, atlas: &Atlas, max_cavities: u64, ctx: &Context<'_>) -> Option<Self> {
        if self.n_quads() > MAX_QUADS {
            return None;
        }
        let surface = QuadSurface::try_new(self.n_vertices() as usize, &self.quads()).ok()?;
        let options = FillOptions::default().with_max_cavities(max_cavities).with_beam(BEAM);
        let quiet = Context { progress: None, ..*ctx };
        let outcome = fill_avoiding(&surface, &self.joined_pairs(), atlas, &options, &quiet)?;
        let filling = &outcome.fillings.first()?.mesh;
        let hexes: Vec<[u32; 8]> = self.hexes().iter().copied().chain(filling.hexes_raw()).collect();
        self.with(filling.n_vertices() as u32, &hexes, &[]).ok()
    }

    /// The pairs of front vertices that are both in one cell. Quadratic time, for small fronts.
    fn joined_pairs(&self) -> Vec<[u32; 2]> {
        let vertices: Vec<u32> = (0..self.n_vertices()).filter(|&v| self.degree(v) > 0).collect();
        let pairs = vertices.iter().enumerate().flat_map(|(i, &a)| vertices[..i].iter().map(move |&b| [a, b]));
        pairs.filter(|&[a, b]| self.is_joined(a, b)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::sweep;
    use crate::sweep_options::SweepOptions;
    use crate::test_surfaces::judged;
    use hexfill_mesh::Context;
    use hexfill_mesh::generate::{octagonal_spindle, random_sphere, refined, schneiders_pyramid};

    #[test]
    fn small_voids_are_closed() {
        let options = SweepOptions { atlas: Some(Atlas::embedded()), ..Default::default() };
        let mut surfaces = vec![octagonal_spindle(), schneiders_pyramid(), refined(&octagonal_spindle(), 2).unwrap()];
        surfaces.extend((0..20).map(|seed| random_sphere(12 + 2 * (seed as usize / 5), seed).unwrap()));
        let mut closed = 0;
        for surface in surfaces {
            let swept = sweep(&surface, None, &options, &Context::default());
            if swept.front.is_empty() {
                closed += 1;
                println!("{} quads: {} hexes", surface.n_quads(), judged(&surface, &swept));
            }
        }
        assert!(closed >= 15, "{closed}");
    }
}
