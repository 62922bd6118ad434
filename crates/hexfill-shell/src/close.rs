//! Closing a small void from the atlas of smallest known fillings.
//!
//! What is behind the front blocks pairs of its vertices: the filling must avoid them, and the atlas knows several fillings of many spheres. Where none
//! fits, a pillow goes first: behind it nothing is blocked.

use crate::front::Front;
use hexfill_mesh::QuadSurface;
use hexfill_search::{Atlas, Cavity};

impl Front {
    /// The state with the void filled from the atlas, by the fewest hexes. `None` if the front is not one sphere that the atlas knows.
    pub fn closed_from(&self, atlas: &Atlas) -> Option<Self> {
        let direct = self.filled_from(atlas);
        let behind_pillow = self.pillowed().0.filled_from(atlas);
        let both = [direct, behind_pillow].into_iter().flatten();
        both.min_by_key(|state| state.hexes().len())
    }

    fn filled_from(&self, atlas: &Atlas) -> Option<Self> {
        let front = QuadSurface::try_new(self.n_vertices() as usize, &self.quads()).ok()?;
        let (mut cavity, ids) = Cavity::from_surface(&front)?;
        let mut own = std::collections::BTreeSet::new();
        for quad in cavity.quads() {
            own.extend(quad.iter().flat_map(|&a| quad.iter().map(move |&b| (a, b))));
        }
        let n = ids.len() as u8;
        for (a, b) in (0..n).flat_map(|a| (a + 1..n).map(move |b| (a, b))) {
            if !own.contains(&(a, b)) && self.is_joined(ids[usize::from(a)], ids[usize::from(b)]) {
                cavity.block(a, b);
            }
        }
        let (ball, map, mirrored) = atlas.best_fit(&cavity, u32::MAX)?;
        let boundary: Vec<u32> = map.iter().map(|&v| ids[usize::from(v)]).collect();
        let (inner, fresh) = ball.hexes_in(&boundary, mirrored, self.n_vertices());
        let hexes: Vec<[u32; 8]> = self.hexes().iter().copied().chain(inner).collect();
        self.with(self.n_vertices() + fresh, &hexes, &[]).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::{SweepOptions, sweep};
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
