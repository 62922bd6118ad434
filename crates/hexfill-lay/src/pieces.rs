//! [`Pieces`]: a body with limbs cut across its waists, and the meshes of the pieces put together again.
//!
//! Source: ours.

use crate::laid_mesh::LaidMesh;
use crate::membrane::cut_at;
use crate::waist::waists;
use hexfill_geometry::Vector;
use hexfill_mesh::{HexMesh, QuadSurface, VertexId};
use hexfill_shell::Front;

/// Spheres of at most so many quads are not cut.
const WHOLE: usize = 500;
/// Waists tried for one cut.
const TRIED: usize = 6;

/// A sphere cut into smaller ones by membranes.
pub(crate) struct Pieces {
    /// Each with the ids of its vertices among all.
    pub(crate) pieces: Vec<(QuadSurface, Vec<VertexId>)>,
    /// Positions: of the surface's vertices, then of those of the membranes.
    pub(crate) points: Vec<Vector>,
}

impl Pieces {
    /// The sphere cut wherever it is narrow; one piece where it is not. `None` for other surfaces.
    pub(crate) fn of(surface: &QuadSurface, points: &[Vector]) -> Option<Self> {
        if !surface.is_sphere() {
            return None;
        }
        let mut points = points.to_vec();
        let mut open = vec![surface.quads_raw()];
        let mut pieces = Vec::new();
        while let Some(quads) = open.pop() {
            match cut(&quads, &mut points) {
                Some(two) => open.extend(two),
                None => pieces.push(QuadSurface::on_own_vertices(quads).ok()?),
            }
        }
        Some(Self { pieces, points })
    }

    /// Positions of the vertices of a piece.
    pub(crate) fn points_of(&self, ids: &[VertexId]) -> Vec<Vector> {
        ids.iter().map(|v| self.points[v.index()]).collect()
    }

    /// One mesh of all, given one for each piece; `None` if two of them meet improperly.
    pub(crate) fn joined(&self, surface: &QuadSurface, laid: Vec<LaidMesh>) -> Option<LaidMesh> {
        let mut points = self.points.clone();
        let (mut hexes, mut steps, mut invalid, mut pillows) = (Vec::new(), Vec::new(), 0, 0);
        for ((_, ids), laid) in self.pieces.iter().zip(laid) {
            let first = (points.len() - ids.len()) as u32;
            let name = |v: u32| ids.get(v as usize).map_or(first + v, |id| id.0);
            hexes.extend(laid.mesh.hexes_raw().iter().map(|hex| hex.map(name)));
            points.extend(&laid.points[ids.len()..]);
            steps.extend(laid.steps);
            invalid += laid.invalid;
            pillows += laid.pillows;
        }
        // Each piece is proper, but two of them may join two vertices of a waist in two ways.
        Front::try_from_parts(points.len() as u32, &surface.quads_raw(), &hexes, &[]).ok()?;
        let mesh = HexMesh::try_new(points.len(), &hexes).ok()?;
        Some(LaidMesh { mesh, points, steps, invalid, pillows })
    }
}

/// A sphere as two, cut at the narrowest place that a membrane fits into.
fn cut(quads: &[[u32; 4]], points: &mut Vec<Vector>) -> Option<[Vec<[u32; 4]>; 2]> {
    if quads.len() <= WHOLE {
        return None;
    }
    let (surface, ids) = QuadSurface::on_own_vertices(quads.to_vec()).ok()?;
    let at: Vec<Vector> = ids.iter().map(|v| points[v.index()]).collect();
    waists(&surface, &at).into_iter().take(TRIED).find_map(|mut waist| {
        waist.circuit.iter_mut().for_each(|v| *v = ids[*v as usize].0);
        cut_at(&waist, quads, points)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::generate::voxels;

    /// Two blocks of 7 x 7 x 7 cubes joined by a bar of 3 x 3 x 4.
    fn dumbbell() -> (QuadSurface, Vec<Vector>) {
        let (surface, cells) =
            voxels([18, 7, 7], |[x, y, z]| !(7..11).contains(&x) || (2..5).contains(&y) && (2..5).contains(&z))
                .unwrap();
        (surface, cells.into_iter().map(|p| p.map(f64::from)).collect())
    }

    #[test]
    fn a_dumbbell_is_cut_across_its_bar() {
        let (surface, points) = dumbbell();
        let Pieces { pieces, points: all } = Pieces::of(&surface, &points).unwrap();
        assert_eq!(pieces.len(), 2);
        // A grid of 3 x 3 quads across the bar, with four vertices of its own.
        assert_eq!(pieces.iter().map(|(p, _)| p.n_quads()).sum::<usize>(), surface.n_quads() + 18);
        assert_eq!((&all[..points.len()], all.len()), (&points[..], points.len() + 4));
        for (piece, ids) in &pieces {
            assert!(piece.is_sphere() && piece.n_quads().is_multiple_of(2));
            assert_eq!(piece.n_vertices(), ids.len());
        }
    }

    #[test]
    fn small_spheres_and_other_surfaces_are_not_cut() {
        let (block, points) = voxels([9, 9, 9], |_| true).unwrap();
        let points: Vec<Vector> = points.into_iter().map(|p| p.map(f64::from)).collect();
        assert_eq!(Pieces::of(&block, &points).unwrap().pieces.len(), 1);
        // A frame has no two sides.
        let (frame, points) =
            voxels([24, 24, 3], |[x, y, _]| !(3..=20).contains(&x) || !(3..=20).contains(&y)).unwrap();
        let points: Vec<Vector> = points.into_iter().map(|p| p.map(f64::from)).collect();
        assert!(Pieces::of(&frame, &points).is_none());
    }
}
