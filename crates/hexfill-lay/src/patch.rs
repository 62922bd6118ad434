//! [`Patch`]: what lies round the void, where hexes are laid; the rest of the mesh need not be looked at.
//!
//! Source: ours.

use crate::laid_mesh::LaidMesh;
use crate::open_mesh::OpenMesh;
use crate::step::Step;
use hexfill_geometry::Vector;
use hexfill_mesh::HexMesh;

/// Rings of hexes round the void.
const RINGS: usize = 4;
/// Meshes of at most so many hexes are all patch, and those without a void.
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
        let mut inside = vec![open.hexes.len() <= SMALL || open.front.is_empty(); open.hexes.len()];
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
        stays[..open.n_fixed].fill(true);
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

    /// The patch alone round its void.
    pub(crate) fn cut_out(&self, open: &OpenMesh) -> OpenMesh {
        let mut own = vec![u32::MAX; open.points.len()];
        (0..).zip(&self.ids).for_each(|(own_id, &v)| own[v as usize] = own_id);
        let numbers = (0..open.hexes.len() as u32).filter(|&h| self.inside[h as usize]);
        let forgiven =
            (0..).zip(numbers).filter(|(_, h)| open.forgiven.binary_search(h).is_ok()).map(|(own_id, _)| own_id);
        let hexes = open.hexes.iter().zip(&self.inside).filter(|(_, is_in)| **is_in).map(|(hex, _)| hex);
        OpenMesh {
            hexes: hexes.map(|hex| hex.map(|v| own[v as usize])).collect(),
            steps: open.steps.iter().zip(&self.inside).filter(|(_, is_in)| **is_in).map(|(step, _)| *step).collect(),
            points: self.ids.iter().map(|&v| open.points[v as usize]).collect(),
            n_fixed: self.n_fixed,
            front: open.front.iter().map(|q| q.map(|v| own[v as usize])).collect(),
            apex: open.apex,
            forgiven: forgiven.collect(),
        }
    }

    pub(crate) fn n_hexes(&self) -> usize {
        self.inside.iter().filter(|is_in| **is_in).count()
    }

    /// Vertices of the patch that stay.
    pub(crate) fn n_fixed(&self) -> usize {
        self.n_fixed
    }

    /// The whole mesh, once the patch and its void are filled by `laid`, whose first vertices are those of the patch that stay.
    pub(crate) fn put_back(&self, open: &OpenMesh, laid: LaidMesh) -> Option<LaidMesh> {
        let LaidMesh { mesh, points, steps: inner, pillows, .. } = laid;
        let outside = |h: &usize| !self.inside[*h];
        let mut steps: Vec<Step> = (0..open.hexes.len()).filter(outside).map(|h| open.steps[h]).collect();
        steps.extend(inner);
        let mut hexes: Vec<[u32; 8]> = (0..open.hexes.len()).filter(outside).map(|h| open.hexes[h]).collect();
        let n = open.points.len() as u32;
        let place = |v: u32| if (v as usize) < self.n_fixed { self.ids[v as usize] } else { n + v };
        hexes.extend(mesh.hexes_raw().iter().map(|hex| hex.map(place)));
        let at = |v: u32| if v < n { open.points[v as usize] } else { points[(v - n) as usize] };
        // Vertices in their old order, without those of no hex.
        let mut kept: Vec<u32> = (0..open.n_fixed as u32).chain(hexes.iter().flatten().copied()).collect();
        kept.sort_unstable();
        kept.dedup();
        let mut name = vec![u32::MAX; n as usize + points.len()];
        (0..).zip(&kept).for_each(|(new, &old)| name[old as usize] = new);
        hexes.iter_mut().flatten().for_each(|v| *v = name[*v as usize]);
        let points: Vec<Vector> = kept.into_iter().map(at).collect();
        let mesh = HexMesh::try_new(points.len(), &hexes).ok()?;
        Some(LaidMesh { mesh, points, steps, invalid: open.forgiven.len(), pillows })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::cube::{CORNER_NEIGHBOURS, FACETS};
    use hexfill_mesh::generate::grid;

    const N: usize = 12;

    /// N^3 cubes without the one in the middle, surface first; the corners of that one.
    fn block_with_a_void() -> (OpenMesh, [u32; 8]) {
        let mesh = grid(N, N, N).unwrap();
        let on = mesh.boundary_vertices();
        let mut order: Vec<usize> = (0..mesh.n_vertices()).collect();
        order.sort_by_key(|&v| !on[v]);
        let mut name = vec![0; order.len()];
        (0..).zip(&order).for_each(|(new, &old)| name[old] = new);
        // Whether x or z runs fastest does not matter here.
        let m = N + 1;
        let at = |v: usize| [v % m, v / m % m, v / (m * m)].map(|x| x as f64);
        let mut hexes: Vec<[u32; 8]> = mesh.hexes_raw().iter().map(|h| h.map(|v| name[v as usize])).collect();
        let points: Vec<Vector> = order.iter().map(|&v| at(v)).collect();
        let centre = [N as f64 / 2.0; 3];
        let middle = hexes.iter().position(|h| {
            h.iter().all(|&v| {
                let p = points[v as usize];
                (0..3).all(|k| p[k] - centre[k] == 0.0 || p[k] - centre[k] == 1.0)
            })
        });
        let gone = hexes.remove(middle.unwrap());
        let front = FACETS.map(|f| f.map(|i| gone[i])).to_vec();
        let n_fixed = on.iter().filter(|on| **on).count();
        let steps = vec![Step::Sweep; hexes.len()];
        (OpenMesh { hexes, steps, points, front, apex: centre.map(|x| x + 0.5), forgiven: Vec::new(), n_fixed }, gone)
    }

    #[test]
    fn a_patch_is_cut_out_and_put_back() {
        let (open, gone) = block_with_a_void();
        let patch = Patch::round(&open);
        // Four rings round a cube, and what lies on their outside stays.
        assert_eq!((patch.n_hexes(), patch.n_fixed()), (9 * 9 * 9 - 1, 1000 - 512));
        let cut = patch.cut_out(&open);
        assert_eq!(cut.hexes.len(), patch.n_hexes());
        let mut hexes = cut.hexes.clone();
        let own = |v: u32| patch.ids.iter().position(|&id| id == v).unwrap() as u32;
        hexes.push(gone.map(own));
        let mesh = HexMesh::try_new(cut.points.len(), &hexes).unwrap();
        let steps = [cut.steps, vec![Step::Laid]].concat();
        let laid = LaidMesh { mesh, points: cut.points.clone(), steps, invalid: 0, pillows: 0 };
        let LaidMesh { mesh: whole, points, steps, .. } = patch.put_back(&open, laid).unwrap();
        assert!(steps.len() == whole.n_hexes() && steps.ends_with(&[Step::Sweep, Step::Laid]));
        assert_eq!((whole.n_hexes(), points.len()), (N * N * N, open.points.len()));
        assert_eq!(points[..open.n_fixed], open.points[..open.n_fixed]);
        for hex in whole.hexes_raw() {
            let at = |k: usize| points[hex[k] as usize];
            for (k, neighbours) in CORNER_NEIGHBOURS.iter().enumerate() {
                let steps = neighbours.map(|j| (0..3).map(|x| (at(j)[x] - at(k)[x]).abs()).sum::<f64>());
                assert_eq!(steps, [1.0; 3]);
            }
        }
    }
}
