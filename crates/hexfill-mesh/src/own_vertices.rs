//! Surfaces of some quads of a larger whole, with vertices of their own.
//!
//! Source: ours.

use crate::ids::{QuadId, VertexId};
use crate::surface::{QuadSurface, SurfaceError};

impl QuadSurface {
    /// The surface of these quads with its vertices renumbered ascending; with the map to the old vertex ids.
    ///
    /// # Errors
    /// As [`QuadSurface::try_new`], in the new numbers.
    pub fn on_own_vertices(mut quads: Vec<[u32; 4]>) -> Result<(Self, Vec<VertexId>), SurfaceError> {
        let mut old: Vec<u32> = quads.iter().flatten().copied().collect();
        old.sort_unstable();
        old.dedup();
        for v in quads.iter_mut().flatten() {
            *v = old.binary_search(v).expect("every vertex was collected") as u32;
        }
        let surface = Self::try_new(old.len(), &quads)?;
        Ok((surface, old.into_iter().map(VertexId).collect()))
    }

    /// Each component as a surface of its own with vertices renumbered ascending; with the map to the old vertex ids and quad ids.
    pub fn split_components(&self) -> Vec<(Self, Vec<VertexId>, Vec<QuadId>)> {
        let mut parts: Vec<(Vec<[u32; 4]>, Vec<QuadId>)> = vec![Default::default(); self.n_components()];
        for (q, quad) in (0..self.n_quads()).map(QuadId::new).zip(self.quads_raw()) {
            let part = &mut parts[self.component(q)];
            part.0.push(quad);
            part.1.push(q);
        }
        parts
            .into_iter()
            .map(|(quads, ids)| {
                let (part, old) = Self::on_own_vertices(quads).expect("a component of a surface is a surface");
                (part, old, ids)
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::cube_surface;

    #[test]
    fn components_split_and_keep_their_ids() {
        let mut two = cube_surface().quads_raw();
        two.extend(cube_surface().quads_raw().iter().map(|q| q.map(|v| v + 9)));
        let s = QuadSurface::try_new(17, &two).unwrap();
        assert_eq!((s.n_components(), s.n_used_vertices(), s.genus()), (2, 16, 0));
        let parts = s.split_components();
        assert_eq!(parts[1].1[0], VertexId(9));
        assert_eq!(parts[1].2[0], QuadId(6));
    }

    #[test]
    fn quads_that_do_not_close_are_refused() {
        let mut open = cube_surface().quads_raw();
        open.pop();
        assert!(QuadSurface::on_own_vertices(open).is_err());
    }
}
