//! Parts of a hex mesh, and its orientation.
//!
//! Source: ours; breadth-first search.

use crate::hexmesh::{Facet, HexMesh};
use crate::ids::HexId;

/// The hexes of each part connected through quads, parts ordered by their smallest hex, hexes ascending. Linear time.
pub fn facet_components(mesh: &HexMesh) -> Vec<Vec<HexId>> {
    let mut seen = vec![false; mesh.n_hexes()];
    let mut parts = Vec::new();
    let mut stack = Vec::new();
    for start in 0..mesh.n_hexes() {
        if std::mem::replace(&mut seen[start], true) {
            continue;
        }
        let mut part = vec![];
        stack.push(HexId::new(start));
        while let Some(h) = stack.pop() {
            part.push(h);
            for other in neighbours(mesh, h) {
                if !std::mem::replace(&mut seen[other.index()], true) {
                    stack.push(other);
                }
            }
        }
        part.sort_unstable();
        parts.push(part);
    }
    parts
}

/// Number of parts connected through vertices. Near linear time.
pub fn n_vertex_components(mesh: &HexMesh) -> usize {
    let mut parent: Vec<u32> = (0..mesh.n_vertices() as u32).collect();
    let mut count = mesh.used_vertices().iter().filter(|used| **used).count();
    for hex in mesh.hexes() {
        for v in &hex[1..] {
            let (a, b) = (root(&mut parent, hex[0].0), root(&mut parent, v.0));
            if a != b {
                parent[a.max(b) as usize] = a.min(b);
                count -= 1;
            }
        }
    }
    count
}

/// Root in a union-find forest whose roots are their smallest members; shortens the path.
pub(crate) fn root(parent: &mut [u32], mut i: u32) -> u32 {
    while parent[i as usize] != i {
        let grand = parent[parent[i as usize] as usize];
        parent[i as usize] = grand;
        i = grand;
    }
    i
}

fn neighbours(mesh: &HexMesh, h: HexId) -> impl Iterator<Item = HexId> + '_ {
    (0..6).filter_map(move |side| mesh.neighbour(Facet::new(h, side))).map(Facet::hex)
}

/// Two hexes through which no consistent orientation exists, or (from [`disagreement`]) that disagree as given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the hex mesh is not orientable: walking through quads from {} to its neighbour {} arrives mirrored", hexes[0], hexes[1])]
pub struct NotOrientable {
    /// Two neighbours where the orientations clash.
    pub hexes: [HexId; 2],
}

/// Whether two glued facets, as given, belong to hexes of the same handedness: they run round their common quad in opposite senses.
fn agree(mesh: &HexMesh, f: Facet, g: Facet) -> bool {
    let (a, b) = (mesh.facet_vertices(f), mesh.facet_vertices(g));
    let i = b.iter().position(|v| *v == a[0]).expect("glued facets have the same vertices");
    b[(i + 3) % 4] == a[1]
}

/// Two neighbours of opposite handedness as given, if there are any.
pub fn disagreement(mesh: &HexMesh) -> Option<[HexId; 2]> {
    let clash = |f: &Facet| mesh.neighbour(*f).filter(|&g| !agree(mesh, *f, g));
    mesh.facets().find_map(|f| clash(&f).map(|g| [f.hex(), g.hex()]))
}

/// Per hex whether it must be reflected for all hexes of a part to have the handedness of its smallest hex. Linear time.
///
/// # Errors
/// [`NotOrientable`].
pub fn orientation(mesh: &HexMesh) -> Result<Vec<bool>, NotOrientable> {
    let mut reflect: Vec<Option<bool>> = vec![None; mesh.n_hexes()];
    let mut stack = Vec::new();
    for start in 0..mesh.n_hexes() {
        if reflect[start].is_some() {
            continue;
        }
        reflect[start] = Some(false);
        stack.push((HexId::new(start), false));
        while let Some((h, sign)) = stack.pop() {
            for side in 0..6 {
                let f = Facet::new(h, side);
                let Some(g) = mesh.neighbour(f) else { continue };
                // Two hexes of one handedness see their common quad in opposite senses.
                let wanted = sign == agree(mesh, f, g);
                match reflect[g.hex().index()] {
                    None => {
                        reflect[g.hex().index()] = Some(wanted);
                        stack.push((g.hex(), wanted));
                    }
                    Some(given) if given != wanted => return Err(NotOrientable { hexes: [h, g.hex()] }),
                    Some(_) => {}
                }
            }
        }
    }
    Ok(reflect.into_iter().map(|r| r.unwrap_or(false)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cube::symmetries;
    use crate::generate::{Random, grid};

    #[test]
    fn parts_through_quads_and_through_vertices() {
        let two = [[0, 1, 2, 3, 4, 5, 6, 7], [6, 8, 9, 10, 11, 12, 13, 14], [15, 16, 17, 18, 19, 20, 21, 22]];
        let mesh = HexMesh::try_new(25, &two).unwrap();
        assert_eq!(facet_components(&mesh), [[HexId(0)], [HexId(1)], [HexId(2)]]);
        assert_eq!(n_vertex_components(&mesh), 2);
        assert_eq!(facet_components(&grid(3, 2, 2).unwrap()).len(), 1);
        assert_eq!(n_vertex_components(&grid(0, 2, 2).unwrap()), 0);
    }

    #[test]
    fn orientation_is_found_again() {
        let mesh = grid(3, 3, 2).unwrap();
        assert_eq!(disagreement(&mesh), None);
        let mut random = Random::new(3);
        let turned: Vec<bool> = (0..mesh.n_hexes()).map(|_| random.below(2) == 0).collect();
        let hexes: Vec<[u32; 8]> = mesh
            .hexes_raw()
            .iter()
            .zip(&turned)
            .map(|(h, t)| symmetries()[random.below(24) + if *t { 24 } else { 0 }].map(|k| h[k]))
            .collect();
        let mixed = HexMesh::try_new(mesh.n_vertices(), &hexes).unwrap();
        assert!(disagreement(&mixed).is_some());
        let found = orientation(&mixed).unwrap();
        assert!(found.iter().zip(&turned).all(|(f, t)| (f ^ t) == turned[0]));
    }

    #[test]
    fn a_ring_closed_with_a_mirror_is_not_orientable() {
        // Three cubes in a ring; the last facet is glued to the first one reflected in a mirror.
        let ring = [[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11], [8, 9, 10, 11, 1, 0, 3, 2]];
        let mesh = HexMesh::try_new(12, &ring).unwrap();
        assert_eq!(mesh.boundary_facets().count(), 12);
        assert!(orientation(&mesh).is_err());
    }
}
