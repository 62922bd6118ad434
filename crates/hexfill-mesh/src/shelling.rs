//! Greedy shelling: an order in which hexes can be added so that each meets the earlier ones in a disk.
//!
//! A hex may be added if the facets it shares with earlier hexes form a disk on its surface (any 1 to 5 facets but two opposite ones alone or a ring of
//! four) and every vertex and edge it shares lies on these facets. So every stage is a ball if the mesh is shellable by this order. The last hex of
//! a closed mesh meets the others in its whole surface, which is allowed for the last one: the union is then a 3-sphere. Deciding shellability is
//! NP-complete (Goaoc, Patak, Patakova, Tancer, Wagner 2019), even for balls (Patak, Tancer 2023); a greedy order is tried from a few starts, so `None` means
//! "not found", not "none exists".
//!
//! Source: Goaoc et al. 2019 (abstract: the theorem) and Paták, Tancer 2023 for what cannot be hoped for; the test of one hex and the greedy order are ours.

use crate::cube::{EDGES, FACETS};
use crate::hexmesh::{Facet, HexMesh};
use crate::ids::HexId;
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeSet;

/// A shelling order of a mesh, if the greedy search finds one: each hex meets the earlier ones in a disk (the last hex of a closed mesh in a sphere).
/// The search prefers hexes that share many facets, lowest id first, and starts from a few hexes spread over the mesh.
/// Near linear time a start for bounded valences. `None` also for an empty mesh.
///
/// # Example
/// Three cubes in a row, the middle one listed last: it cannot close a gap between two that are apart.
/// ```
/// use hexfill_mesh::{HexId, HexMesh, greedy_shelling, is_shelling};
///
/// let row = [[0, 1, 2, 3, 4, 5, 6, 7], [8, 9, 10, 11, 12, 13, 14, 15], [4, 5, 6, 7, 8, 9, 10, 11]];
/// let mesh = HexMesh::try_new(16, &row)?;
/// let order = greedy_shelling(&mesh).expect("a row of cubes is shelled from its end");
/// assert!(is_shelling(&mesh, &order));
/// assert!(!is_shelling(&mesh, &[HexId(0), HexId(1), HexId(2)]));
/// # Ok::<(), hexfill_mesh::HexMeshError>(())
/// ```
pub fn greedy_shelling(mesh: &HexMesh) -> Option<Vec<HexId>> {
    const STARTS: usize = 8;
    let n = mesh.n_hexes();
    let shelling = Shelling::new(mesh);
    let mut starts: Vec<usize> = (0..STARTS).map(|i| i * n / STARTS).filter(|&h| h < n).collect();
    starts.dedup();
    starts.into_iter().find_map(|start| shelling.grow(HexId::new(start)))
}

/// Whether an order is a shelling in the sense of [`greedy_shelling`]: a permutation of the hexes, each meeting the earlier ones in a disk.
pub fn is_shelling(mesh: &HexMesh, order: &[HexId]) -> bool {
    if order.len() != mesh.n_hexes() || order.is_empty() {
        return false;
    }
    let shelling = Shelling::new(mesh);
    let mut state = State::new(&shelling);
    order.iter().enumerate().all(|(i, &h)| {
        let fits = h.index() < mesh.n_hexes() && !state.added[h.index()];
        let fits = fits && (i == 0 || state.shared_facets(h, i + 1 == order.len()).is_some());
        if fits {
            state.add(h);
        }
        fits
    })
}

/// Whether a mesh of at most 128 hexes has a shelling, decided by trying every order, dead ends remembered. `false` for more hexes. Exponential time at
/// worst; see [`greedy_shelling`] for an order of large meshes.
pub fn is_shellable(mesh: &HexMesh) -> bool {
    let n = mesh.n_hexes();
    let shelling = Shelling::new(mesh);
    let mut dead = FxHashSet::default();
    n <= 128 && (0..n).any(|h| State::new(&shelling).with(HexId::new(h)).can_be_finished(1 << h, &mut dead))
}

/// Incidences that do not change while hexes are added.
struct Shelling<'a> {
    mesh: &'a HexMesh,
    /// Per hex the ids of its edges.
    edges: Vec<[u32; 12]>,
    n_edges: usize,
    /// Hexes at each vertex: `at_vertex[start[v]..start[v + 1]]`.
    start: Vec<usize>,
    at_vertex: Vec<HexId>,
}

impl<'a> Shelling<'a> {
    fn new(mesh: &'a HexMesh) -> Self {
        let mut ids = FxHashMap::default();
        let mut start = vec![0; mesh.n_vertices() + 1];
        let edges = mesh
            .hexes()
            .iter()
            .map(|hex| {
                EDGES.map(|[i, j]| {
                    // Numbers by first occurrence: the map is only looked up and never gone through, so its order
                    // does not matter.
                    let next = ids.len() as u32;
                    *ids.entry((hex[i].min(hex[j]), hex[i].max(hex[j]))).or_insert(next)
                })
            })
            .collect();
        for v in mesh.hexes().iter().flatten() {
            start[v.index() + 1] += 1;
        }
        for v in 0..mesh.n_vertices() {
            start[v + 1] += start[v];
        }
        let mut cursor = start.clone();
        let mut at_vertex = vec![HexId(0); 8 * mesh.n_hexes()];
        for (h, hex) in mesh.hexes().iter().enumerate() {
            for v in hex {
                at_vertex[cursor[v.index()]] = HexId::new(h);
                cursor[v.index()] += 1;
            }
        }
        Self { mesh, edges, n_edges: ids.len(), start, at_vertex }
    }

    /// One greedy run.
    fn grow(&self, first: HexId) -> Option<Vec<HexId>> {
        let mut state = State::new(self);
        let mut order = Vec::with_capacity(self.mesh.n_hexes());
        // What may be added now: (number of facets it would leave open, hex).
        let mut ready: BTreeSet<(u32, HexId)> = BTreeSet::new();
        let mut rank: Vec<Option<u32>> = vec![None; self.mesh.n_hexes()];
        let mut next = Some(first);
        while let Some(h) = next {
            state.add(h);
            order.push(h);
            let last = order.len() + 1 == self.mesh.n_hexes();
            for v in self.mesh.hex(h) {
                for &other in &self.at_vertex[self.start[v.index()]..self.start[v.index() + 1]] {
                    // What may be added changes only at vertices of the hex just added, so ranks are kept up to date
                    // locally.
                    let now =
                        if state.added[other.index()] { None } else { state.shared_facets(other, last).map(|n| 6 - n) };
                    let before = std::mem::replace(&mut rank[other.index()], now);
                    if before != now {
                        before.map(|r| ready.remove(&(r, other)));
                        now.map(|r| ready.insert((r, other)));
                    }
                }
            }
            next = ready.pop_first().map(|(_, h)| h);
            if let Some(h) = next {
                rank[h.index()] = None;
            }
        }
        (order.len() == self.mesh.n_hexes()).then_some(order)
    }
}

/// What has been added.
#[derive(Clone)]
struct State<'a> {
    shelling: &'a Shelling<'a>,
    added: Vec<bool>,
    on_vertex: Vec<bool>,
    on_edge: Vec<bool>,
}

impl<'a> State<'a> {
    fn new(shelling: &'a Shelling<'a>) -> Self {
        Self {
            shelling,
            added: vec![false; shelling.mesh.n_hexes()],
            on_vertex: vec![false; shelling.mesh.n_vertices()],
            on_edge: vec![false; shelling.n_edges],
        }
    }

    fn add(&mut self, h: HexId) {
        self.added[h.index()] = true;
        for v in self.shelling.mesh.hex(h) {
            self.on_vertex[v.index()] = true;
        }
        for e in self.shelling.edges[h.index()] {
            self.on_edge[e as usize] = true;
        }
    }

    fn with(mut self, h: HexId) -> Self {
        self.add(h);
        self
    }

    /// Whether the hexes added, a bit each in `built`, can be continued to the whole mesh; sets for which that failed join `dead`.
    fn can_be_finished(&self, built: u128, dead: &mut FxHashSet<u128>) -> bool {
        let n = self.added.len();
        let n_built = built.count_ones() as usize;
        if n_built == n {
            return true;
        }
        // Whether a set can be finished does not depend on the order it was built in.
        dead.insert(built)
            && (0..n).filter(|&h| !self.added[h]).any(|h| {
                let next = HexId::new(h);
                self.shared_facets(next, n_built + 1 == n).is_some()
                    && self.clone().with(next).can_be_finished(built | 1 << h, dead)
            })
    }

    /// The number of facets hex `h` shares with the added hexes, if it may be added.
    fn shared_facets(&self, h: HexId, last: bool) -> Option<u32> {
        let mesh = self.shelling.mesh;
        let shared: [bool; 6] = std::array::from_fn(|side| {
            mesh.neighbour(Facet::new(h, side)).is_some_and(|g| self.added[g.hex().index()])
        });
        let n = shared.iter().filter(|s| **s).count() as u32;
        let opposite_pairs = (0..3).filter(|&k| shared[2 * k] && shared[2 * k + 1]).count();
        // On the surface of a cube two facets are a disk unless opposite, four unless they are a ring, and a ring has
        // two opposite pairs.
        let disk = match n {
            0 => false,
            2 => opposite_pairs == 0,
            4 => opposite_pairs == 1,
            6 => last,
            _ => true,
        };
        if !disk {
            return None;
        }
        let mut on_shared = [false; 8];
        for (side, _) in shared.iter().enumerate().filter(|(_, s)| **s) {
            FACETS[side].iter().for_each(|&i| on_shared[i] = true);
        }
        let hex = mesh.hex(h);
        let vertices = (0..8).all(|i| on_shared[i] || !self.on_vertex[hex[i].index()]);
        let edges = self.shelling.edges[h.index()];
        let edges = (0..12).all(|e| {
            let on_facet = EDGE_FACETS[e].iter().any(|&side| shared[side]);
            on_facet || !self.on_edge[edges[e] as usize]
        });
        (vertices && edges).then_some(n)
    }
}

/// The two facets at each edge, in the order of [`EDGES`].
const EDGE_FACETS: [[usize; 2]; 12] =
    [[2, 4], [3, 4], [2, 5], [3, 5], [0, 4], [1, 4], [0, 5], [1, 5], [0, 2], [1, 2], [1, 3], [0, 3]];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{grid, grid_mesh_of, shuffled_mesh};
    use crate::valence::euler_characteristic;

    #[test]
    fn edges_are_on_their_facets() {
        for (e, sides) in EDGE_FACETS.iter().enumerate() {
            for (side, facet) in FACETS.iter().enumerate() {
                assert_eq!(EDGES[e].iter().all(|k| facet.contains(k)), sides.contains(&side), "{e} {side}");
            }
        }
    }

    #[test]
    fn blocks_are_shellable_and_every_stage_is_a_ball() {
        for seed in 0..20 {
            let (mesh, _) = shuffled_mesh(&grid(3, 3, 3).unwrap(), seed);
            let order = greedy_shelling(&mesh).unwrap();
            assert!(is_shelling(&mesh, &order));
            for n in 1..=order.len() {
                let hexes: Vec<[u32; 8]> = order[..n].iter().map(|&h| mesh.hex(h).map(|v| v.0)).collect();
                assert_eq!(euler_characteristic(&HexMesh::try_new(mesh.n_vertices(), &hexes).unwrap()), 1);
            }
        }
    }

    #[test]
    fn what_is_not_a_ball_has_no_shelling() {
        assert!(greedy_shelling(&grid_mesh_of([3, 3, 1], |[x, y, _]| (x, y) != (1, 1)).unwrap()).is_none());
        assert!(greedy_shelling(&grid_mesh_of([3, 3, 3], |p| p != [1, 1, 1]).unwrap()).is_none());
        assert!(greedy_shelling(&grid_mesh_of([3, 1, 1], |p| p[0] != 1).unwrap()).is_none());
        assert!(greedy_shelling(&grid(0, 1, 1).unwrap()).is_none());
    }

    #[test]
    fn a_row_is_shellable_and_a_ring_with_its_core_missing_is_not() {
        assert!(is_shellable(&grid(1, 1, 2).unwrap()));
        assert!(is_shellable(&grid(3, 2, 2).unwrap()));
        // Eight cubes round a missing ninth.
        assert!(!is_shellable(&grid_mesh_of([3, 3, 1], |[x, y, _]| (x, y) != (1, 1)).unwrap()));
    }

    #[test]
    fn the_tesseract_boundary_closes_with_a_sphere() {
        let mut hexes = Vec::new();
        for axis in 0..4 {
            for end in 0..2u32 {
                let others: Vec<u32> = (0..4).filter(|&k| k != axis).collect();
                hexes.push(
                    crate::cube::POSITIONS
                        .map(|p| (end << axis) | (0..3).map(|k| u32::from(p[k]) << others[k]).sum::<u32>()),
                );
            }
        }
        let mesh = HexMesh::try_new(16, &hexes).unwrap();
        let order = greedy_shelling(&mesh).unwrap();
        assert!(is_shelling(&mesh, &order));
    }

    #[test]
    fn wrong_orders_are_refused() {
        let mesh = grid(3, 1, 1).unwrap();
        assert!(is_shelling(&mesh, &[HexId(0), HexId(1), HexId(2)]));
        assert!(!is_shelling(&mesh, &[HexId(0), HexId(2), HexId(1)]));
        assert!(!is_shelling(&mesh, &[HexId(0), HexId(0), HexId(1)]));
        assert!(!is_shelling(&mesh, &[HexId(0), HexId(1)]));
        assert!(!is_shelling(&mesh, &[HexId(0), HexId(1), HexId(7)]));
    }
}
