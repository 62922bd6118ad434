//! Whether a ball can be shelled: built hex by hex so that it is a ball at every step. Decided by trying, with the dead ends remembered.

use crate::mesh::Mesh;
use hexfill_mesh::cube::{EDGES, FACETS};
use rustc_hash::{FxHashMap, FxHashSet};

/// Per hex its facets' neighbours, and the vertices and edges it touches.
struct Shells<'a> {
    mesh: &'a Mesh,
    neighbour: Vec<[Option<usize>; 6]>,
    dead: FxHashSet<u128>,
}

/// Whether the mesh, of at most 128 hexes, has a shelling. Exponential time at worst.
pub fn is_shellable(mesh: &Mesh) -> bool {
    let n = mesh.hexes.len();
    if n > 128 {
        return false;
    }
    let mut first: FxHashMap<[u32; 4], (usize, usize)> = FxHashMap::default();
    let mut neighbour = vec![[None; 6]; n];
    for (h, hex) in mesh.hexes.iter().enumerate() {
        for (f, facet) in FACETS.iter().enumerate() {
            let mut quad = facet.map(|i| hex[i]);
            quad.sort_unstable();
            if let Some(&(k, g)) = first.get(&quad) {
                (neighbour[h][f], neighbour[k][g]) = (Some(k), Some(h));
            } else {
                first.insert(quad, (h, f));
            }
        }
    }
    let mut shells = Shells { mesh, neighbour, dead: FxHashSet::default() };
    (0..n).any(|h| shells.go_on(1 << h))
}

impl Shells<'_> {
    /// Whether the hexes built can be continued to the whole mesh.
    fn go_on(&mut self, built: u128) -> bool {
        let n = self.mesh.hexes.len();
        if built.count_ones() as usize == n {
            return true;
        }
        if !self.dead.insert(built) {
            return false;
        }
        (0..n).any(|h| built >> h & 1 == 0 && self.fits(built, h) && self.go_on(built | 1 << h))
    }

    /// Whether hex `h` meets what is built in a disk of its facets, or closes the last cavity of a ball with all six.
    fn fits(&self, built: u128, h: usize) -> bool {
        let glued: Vec<bool> = self.neighbour[h].iter().map(|k| k.is_some_and(|k| built >> k & 1 == 1)).collect();
        let count = glued.iter().filter(|&&g| g).count();
        // Facets f and f ^ 1 are opposite: two sets of facets are no disks, an opposite pair and its complement.
        let pairs = (0..3).filter(|&a| glued[2 * a] && glued[2 * a + 1]).count();
        let free_pairs = (0..3).filter(|&a| !glued[2 * a] && !glued[2 * a + 1]).count();
        if count == 0 || count == 6 || count == 2 && pairs == 1 || count == 4 && free_pairs == 1 {
            return false;
        }
        let hex = &self.mesh.hexes[h];
        let on_glued = |corners: &[usize]| (0..6).any(|f| glued[f] && corners.iter().all(|c| FACETS[f].contains(c)));
        let used = |corners: &[usize]| {
            self.mesh
                .hexes
                .iter()
                .enumerate()
                .any(|(k, other)| built >> k & 1 == 1 && corners.iter().all(|&c| other.contains(&hex[c])))
        };
        (0..8).all(|c| on_glued(&[c]) || !used(&[c])) && EDGES.iter().all(|e| on_glued(e) || !used(e))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_shellable_and_a_ring_with_its_core_missing_is_not() {
        let row = Mesh { n_vertices: 12, hexes: vec![[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11]] };
        assert!(is_shellable(&row));
        // Eight cubes round a missing ninth.
        let grid = |x: u32, y: u32, z: u32| x + 4 * y + 16 * z;
        let ring: Vec<[u32; 8]> = (0..9)
            .filter(|i| *i != 4)
            .map(|i| {
                let (x, y) = (i % 3, i / 3);
                let bottom = [grid(x, y, 0), grid(x + 1, y, 0), grid(x + 1, y + 1, 0), grid(x, y + 1, 0)];
                std::array::from_fn(|k| if k < 4 { bottom[k] } else { bottom[k - 4] + 16 })
            })
            .collect();
        assert!(!is_shellable(&Mesh { n_vertices: 32, hexes: ring }));
    }
}
