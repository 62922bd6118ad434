//! [`Patch`]: what lies round the void, where hexes are laid; the rest of the mesh need not be looked at.

use crate::laying::Laying;
use crate::open_mesh::OpenMesh;
use hexfill_geometry::Vector;
use hexfill_mesh::HexMesh;

/// Rings of hexes round the void.
const RINGS: usize = 4;
/// Meshes of at most so many hexes are all patch.
const SMALL: usize = 600;

/// The hexes round a void, on vertices of their own: those that stay come first.
pub(crate) struct Patch {
    /// Per hex of the mesh whether it is in the patch.
    inside: Vec<bool>,
    /// Per vertex of the patch its id in the mesh.
    ids: Vec<u32>,
    /// Vertices of the patch that stay: those of the surface, and those of hexes outside.
    n_fixed: usize,
}

impl Patch {
    /// What lies round the void of `open`.
    pub(crate) fn round(open: &OpenMesh) -> Self {
        let n = open.points.len();
        let mut inside = vec![open.hexes.len() <= SMALL; open.hexes.len()];
        let mut touched = vec![false; n];
        open.front.iter().flatten().for_each(|&v| touched[v as usize] = true);
        for _ in 0..RINGS {
            for (is_in, hex) in inside.iter_mut().zip(&open.hexes) {
                *is_in |= hex.iter().any(|&v| touched[v as usize]);
            }
            for hex in open.hexes.iter().zip(&inside).filter(|(_, is_in)| **is_in).map(|(hex, _)| hex) {
                hex.iter().for_each(|&v| touched[v as usize] = true);
            }
        }
        let mut stays = vec![false; n];
        stays[..open.n_surface].fill(true);
        let mut used = vec![false; n];
        for (hex, &is_in) in open.hexes.iter().zip(&inside) {
            let marks = if is_in { &mut used } else { &mut stays };
            hex.iter().for_each(|&v| marks[v as usize] = true);
        }
        open.front.iter().flatten().for_each(|&v| used[v as usize] = true);
        let of =
            |fixed: bool| (0..n as u32).filter(|&v| used[v as usize] && stays[v as usize] == fixed).collect::<Vec<_>>();
        let mut ids = of(true);
        let n_fixed = ids.len();
        ids.extend(of(false));
        Self { inside, ids, n_fixed }
    }

    /// Where hexes are laid: the patch and the void.
    pub(crate) fn laying(&self, open: &OpenMesh) -> Laying {
        let mut own = vec![u32::MAX; open.points.len()];
        (0..).zip(&self.ids).for_each(|(own_id, &v)| own[v as usize] = own_id);
        let numbers = (0..open.hexes.len() as u32).filter(|&h| self.inside[h as usize]);
        let forgiven =
            (0..).zip(numbers).filter(|(_, h)| open.forgiven.binary_search(h).is_ok()).map(|(own_id, _)| own_id);
        Laying::new(
            open.hexes
                .iter()
                .zip(&self.inside)
                .filter(|(_, is_in)| **is_in)
                .map(|(hex, _)| hex.map(|v| own[v as usize]))
                .collect(),
            self.ids.iter().map(|&v| open.points[v as usize]).collect(),
            open.front.iter().map(|q| q.map(|v| own[v as usize])).collect(),
            open.apex,
            forgiven.collect(),
            self.n_fixed,
        )
    }

    pub(crate) fn n_hexes(&self) -> usize {
        self.inside.iter().filter(|is_in| **is_in).count()
    }

    /// Vertices of the patch that stay.
    pub(crate) fn n_fixed(&self) -> usize {
        self.n_fixed
    }

    /// The whole mesh, once the patch and its void are filled by `mesh` at `points`, whose first vertices are those of the patch that stay.
    pub(crate) fn put_back(
        &self,
        open: &OpenMesh,
        mesh: &HexMesh,
        points: &[Vector],
    ) -> Option<(HexMesh, Vec<Vector>)> {
        let mut hexes: Vec<[u32; 8]> =
            open.hexes.iter().zip(&self.inside).filter(|(_, is_in)| !**is_in).map(|(hex, _)| *hex).collect();
        let n = open.points.len() as u32;
        let place = |v: u32| if (v as usize) < self.n_fixed { self.ids[v as usize] } else { n + v };
        hexes.extend(mesh.hexes_raw().iter().map(|hex| hex.map(place)));
        let at = |v: u32| if v < n { open.points[v as usize] } else { points[(v - n) as usize] };
        // Vertices in their old order, without those of no hex.
        let mut kept: Vec<u32> = (0..open.n_surface as u32).chain(hexes.iter().flatten().copied()).collect();
        kept.sort_unstable();
        kept.dedup();
        let mut name = vec![u32::MAX; n as usize + points.len()];
        (0..).zip(&kept).for_each(|(new, &old)| name[old as usize] = new);
        hexes.iter_mut().flatten().for_each(|v| *v = name[*v as usize]);
        let points: Vec<Vector> = kept.into_iter().map(at).collect();
        Some((HexMesh::try_new(points.len(), &hexes).ok()?, points))
    }
}
