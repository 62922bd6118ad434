//! The best known meshes of the catalogue, laid into surfaces that are one of its own up to numbering, orientation and coordinates: templates.
//!
//! Source: ours.

use crate::problem::catalog;
use hexfill_mesh::{HexMesh, QuadSurface, VertexId, surface_isomorphism};

/// The stored mesh of a surface; its vertices keep their ids, interior vertices follow.
pub(crate) fn stored_mesh(surface: &QuadSurface) -> Option<HexMesh> {
    catalog::entries().iter().find_map(|entry| {
        let data = entry.data();
        if data.quads.len() != surface.n_quads() {
            return None;
        }
        let known = QuadSurface::try_new(data.vertex_count(), &data.quads).ok()?;
        let map = surface_isomorphism(&known, surface)?;
        let mesh = entry.best_mesh()?;
        let turned = is_mirrored(&known, surface, &map)?;
        let n = (known.n_vertices() as u32, surface.n_vertices() as u32);
        let image = |v: u32| if v < n.0 { map[v as usize].map(|w| w.0) } else { Some(v - n.0 + n.1) };
        let hexes: Vec<[u32; 8]> = mesh
            .hexes
            .iter()
            .map(|hex| {
                let order = if turned { [0, 3, 2, 1, 4, 7, 6, 5] } else { [0, 1, 2, 3, 4, 5, 6, 7] };
                order.map(|k: usize| image(hex[k])).into_iter().collect::<Option<Vec<u32>>>()?.try_into().ok()
            })
            .collect::<Option<_>>()?;
        let n_vertices = hexes.iter().flatten().max().map_or(0, |&v| v as usize + 1).max(surface.n_vertices());
        HexMesh::try_new(n_vertices, &hexes).ok()
    })
}

/// Whether a map of surfaces reverses orientation.
fn is_mirrored(from: &QuadSurface, to: &QuadSurface, map: &[Option<VertexId>]) -> Option<bool> {
    let quad = from.quads().first()?.map(|v| map[v.index()]);
    let [a, b, c, d] = [quad[0]?, quad[1]?, quad[2]?, quad[3]?];
    to.quads().iter().find_map(|q| {
        let at = q.iter().position(|&v| v == a)?;
        let round: [VertexId; 4] = std::array::from_fn(|k| q[(at + k) % 4]);
        if round == [a, b, c, d] { Some(false) } else { (round == [a, d, c, b]).then_some(true) }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fill::filled::Route;
    use crate::fill::judged::verify;
    use crate::problem::Problem;
    use hexfill_mesh::Random;

    #[test]
    fn every_stored_mesh_fits_its_surface_however_numbered_and_turned() {
        let mut random = Random::new(3);
        let mut seen = 0;
        for entry in catalog::entries().iter().filter(|e| e.best_mesh().is_some()) {
            let known = Problem::named(entry.name).unwrap().surface;
            for mirrored in [false, true] {
                let mut ids: Vec<u32> = (0..known.n_vertices() as u32).collect();
                random.shuffle(&mut ids);
                let mut quads: Vec<[u32; 4]> = known.quads().iter().map(|q| q.map(|v| ids[v.index()])).collect();
                random.shuffle(&mut quads);
                if mirrored {
                    quads.iter_mut().for_each(|q| q.reverse());
                }
                let surface = QuadSurface::try_new(known.n_vertices(), &quads).unwrap();
                let mesh = stored_mesh(&surface).unwrap();
                assert_eq!(mesh.n_hexes(), entry.best_mesh().unwrap().hexes.len());
                verify(&surface, &mesh, Route::Catalogue).unwrap();
                seen += 1;
            }
        }
        assert_eq!(seen, 16);
        let other = Problem::named("cube").unwrap().surface;
        assert!(stored_mesh(&other).is_none());
    }
}
