//! [`Cells`]: a hex mesh that sheets can be put into, locally, and taken out of again.
//!
//! Invariant: `at[v]` holds the hexes at vertex v, ascending; facets are glued by their vertices, so no neighbour table has to follow
//! the changes. A set of hexes whose surface is a sphere is *shrunk* (a local pillow; Mitchell, Tautges 1995): its surface vertices are copied, its hexes take the copies, and one new hex fills the gap over each of its facets, those
//! on the mesh's boundary included. The mesh's boundary stays as it is, and cells that met properly still do.
//!
//! Source: Mitchell, Tautges 1995 (pillows round any set of hexes); taking sheets out: Borden et al. 2002.

use hexfill_mesh::cube::{CORNER_NEIGHBOURS, FACETS};
use hexfill_mesh::{HexMesh, HexMeshError, QuadSurface};

/// Hexes with their incidence. See the module page.
#[derive(Clone, Debug)]
pub(crate) struct Cells {
    hexes: Vec<[u32; 8]>,
    at: Vec<Vec<u32>>,
}

/// How to take a shrinking back; only the last one can be.
#[derive(Debug)]
pub(crate) struct Undo {
    set: Vec<u32>,
    n_hexes: usize,
    /// Old vertices, ascending; their copies follow the vertices there were.
    pub(crate) copied: Vec<u32>,
}

impl Cells {
    pub(crate) fn new(mesh: &HexMesh) -> Self {
        Self::of(mesh.n_vertices(), mesh.hexes_raw())
    }

    /// The hexes of a mesh.
    pub(crate) fn of(n_vertices: usize, hexes: Vec<[u32; 8]>) -> Self {
        let mut at = vec![Vec::new(); n_vertices];
        for (h, hex) in hexes.iter().enumerate() {
            hex.iter().for_each(|&v| at[v as usize].push(h as u32));
        }
        Self { hexes, at }
    }

    pub(crate) fn to_mesh(&self) -> Result<HexMesh, HexMeshError> {
        HexMesh::try_new(self.at.len(), &self.hexes)
    }

    pub(crate) fn into_hexes(self) -> Vec<[u32; 8]> {
        self.hexes
    }

    pub(crate) fn n_hexes(&self) -> usize {
        self.hexes.len()
    }

    /// The hexes at a vertex, ascending.
    pub(crate) fn hexes_at(&self, v: u32) -> &[u32] {
        &self.at[v as usize]
    }

    /// The hexes that have all these vertices.
    fn hexes_with<'a>(&'a self, vertices: &'a [u32]) -> impl Iterator<Item = u32> + 'a {
        let (&first, rest) = vertices.split_first().unwrap_or((&0, &[]));
        self.at[first as usize]
            .iter()
            .copied()
            .filter(move |&h| rest.iter().all(|v| self.hexes[h as usize].contains(v)))
    }

    /// The hex with this quad of the boundary.
    pub(crate) fn owner(&self, quad: [u32; 4]) -> Option<u32> {
        self.hexes_with(&quad).next()
    }

    /// The corners at a vertex, as right-handed triples of the ends of their edges; those of the hexes in the sorted `set` left out.
    pub(crate) fn corners_at(&self, v: u32, set: &[u32]) -> Vec<[u32; 3]> {
        let outside = self.at[v as usize].iter().filter(|h| set.binary_search(h).is_err());
        outside
            .filter_map(|&h| {
                let hex = &self.hexes[h as usize];
                let corner = hex.iter().position(|&w| w == v)?;
                Some(CORNER_NEIGHBOURS[corner].map(|n| hex[n]))
            })
            .collect()
    }

    /// The facets that the sorted `set` does not share with itself, seen from outside counter-clockwise.
    pub(crate) fn skin(&self, set: &[u32]) -> Vec<[u32; 4]> {
        let mut skin = Vec::new();
        for &h in set {
            for facet in FACETS {
                let quad = facet.map(|i| self.hexes[h as usize][i]);
                if !self.hexes_with(&quad).any(|g| g != h && set.binary_search(&g).is_ok()) {
                    skin.push(quad);
                }
            }
        }
        skin
    }

    /// Fills the gap between the hexes of the sorted `set`, shrunk, and their `skin`. Returns the way back.
    pub(crate) fn shrink(&mut self, set: &[u32], skin: &[[u32; 4]]) -> Undo {
        let n_hexes = self.hexes.len();
        let first_copy = self.at.len() as u32;
        let mut copied: Vec<u32> = skin.iter().flatten().copied().collect();
        copied.sort_unstable();
        copied.dedup();
        let copy = |v: u32| copied.binary_search(&v).map_or(v, |i| first_copy + i as u32);
        self.at.resize_with(first_copy as usize + copied.len(), Vec::new);
        for &h in set {
            for v in &mut self.hexes[h as usize] {
                let new = copy(*v);
                if new != *v {
                    self.at[*v as usize].retain(|&g| g != h);
                    self.at[new as usize].push(h);
                    *v = new;
                }
            }
        }
        for &[a, b, c, d] in skin {
            // Seen from outside a b c d is counter-clockwise: the copies are the bottom, the skin is the top.
            let hex = [copy(a), copy(b), copy(c), copy(d), a, b, c, d];
            hex.iter().for_each(|&v| self.at[v as usize].push(self.hexes.len() as u32));
            self.hexes.push(hex);
        }
        Undo { set: set.to_vec(), n_hexes, copied }
    }

    /// Takes the last shrinking back.
    pub(crate) fn undo(&mut self, undo: &Undo) {
        let first_copy = (self.at.len() - undo.copied.len()) as u32;
        self.hexes.truncate(undo.n_hexes);
        self.at.truncate(first_copy as usize);
        for &v in &undo.copied {
            self.at[v as usize].retain(|&h| (h as usize) < undo.n_hexes);
        }
        for &h in &undo.set {
            for v in &mut self.hexes[h as usize] {
                if *v >= first_copy {
                    *v = undo.copied[(*v - first_copy) as usize];
                    self.at[*v as usize].push(h);
                }
            }
        }
        // Lists are ascending: what was added last and what came back have to find their places.
        for &v in &undo.copied {
            self.at[v as usize].sort_unstable();
        }
    }
}

/// Whether a skin is one sphere: then the set behind it can be shrunk.
pub(crate) fn is_sphere(skin: &[[u32; 4]]) -> bool {
    QuadSurface::on_own_vertices(skin.to_vec()).is_ok_and(|(surface, _)| surface.is_sphere())
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::generate::grid;

    #[test]
    fn shrinking_can_be_taken_back() {
        let mesh = grid(3, 3, 3).unwrap();
        let mut cells = Cells::new(&mesh);
        let before = cells.clone();
        let quads = mesh.boundary_quads();
        for set in [vec![0], vec![0, 1], vec![12, 13, 14], (0..27).collect()] {
            let skin = cells.skin(&set);
            assert!(is_sphere(&skin));
            let undo = cells.shrink(&set, &skin);
            let made = cells.to_mesh().unwrap();
            assert_eq!(made.n_hexes(), 27 + skin.len());
            let mut left: Vec<_> = quads.clone();
            left.retain(|q| !made.boundary_quads().iter().any(|p| (0..4).all(|i| p.contains(&q[i]))));
            assert!(left.is_empty() && made.boundary_quads().len() == quads.len());
            cells.undo(&undo);
            assert_eq!((&cells.hexes, &cells.at), (&before.hexes, &before.at));
        }
        // Two hexes that share an edge only have no manifold skin.
        assert!(!is_sphere(&cells.skin(&[0, 4])));
    }
}
