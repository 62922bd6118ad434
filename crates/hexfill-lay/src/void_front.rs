//! [`VoidFront`]: what can be laid on the front of the void next.
//!
//! Source: ours; what may be glued so that the rest stays a ball is Müller-Hannemann 2001's shelling from outside, one hex at a time.

use hexfill_mesh::cube::{EDGES, FACETS};
use rustc_hash::{FxHashMap, FxHashSet};

/// "Not laid yet": the id of a vertex that no hex has had so far.
pub(crate) const NOT_YET: u32 = u32::MAX;

/// The quads, edges and vertices of a front, to be asked for.
#[derive(Clone, Debug, Default)]
pub(crate) struct VoidFront {
    quads: FxHashMap<[u32; 4], [u32; 4]>,
    edges: FxHashSet<[u32; 2]>,
    vertices: FxHashSet<u32>,
}

fn sorted<const N: usize>(mut ids: [u32; N]) -> [u32; N] {
    ids.sort_unstable();
    ids
}

impl VoidFront {
    /// Of a front given by its quads.
    pub(crate) fn new(front: &[[u32; 4]]) -> Self {
        Self {
            quads: front.iter().map(|&q| (sorted(q), q)).collect(),
            edges: front.iter().flat_map(|q| (0..4).map(|i| sorted([q[i], q[(i + 1) % 4]]))).collect(),
            vertices: front.iter().flatten().copied().collect(),
        }
    }

    /// The facets of a hex that lie on the front, as a bit set, if the hex can be laid there so that what is left stays a ball: they form a disk, and
    /// nothing else of the hex touches the front. A hex that all six facets of the front belong to is the last one.
    pub(crate) fn covered_by(&self, hex: &[u32; 8]) -> Option<u8> {
        let is_on = |facet: &[usize; 4]| self.quads.contains_key(&sorted(facet.map(|i| hex[i])));
        let covered = (0..6).filter(|&f| is_on(&FACETS[f])).fold(0u8, |set, f| set | 1 << f);
        if covered == 63 {
            return (self.quads.len() == 6).then_some(covered);
        }
        if covered == 0 || is_two_opposite(covered) || is_two_opposite(63 & !covered) {
            return None;
        }
        let is_in = |f: usize| covered >> f & 1 == 1;
        let touches_vertex = |i: usize| (0..6).any(|f| is_in(f) && FACETS[f].contains(&i));
        let touches_edge = |e: &[usize; 2]| (0..6).any(|f| is_in(f) && e.iter().all(|i| FACETS[f].contains(i)));
        let is_free = (0..8).all(|i| touches_vertex(i) || !self.vertices.contains(&hex[i]))
            && EDGES.iter().all(|e| touches_edge(e) || !self.edges.contains(&sorted(e.map(|i| hex[i]))));
        is_free.then_some(covered)
    }
}

/// Whether a set of facets is one of the three pairs of opposite ones.
fn is_two_opposite(set: u8) -> bool {
    matches!(set, 0b11 | 0b1100 | 0b11_0000)
}

/// The front after a hex was laid over the facets in `covered`.
pub(crate) fn advanced(front: &[[u32; 4]], hex: &[u32; 8], covered: u8) -> Vec<[u32; 4]> {
    let facet = |f: usize| FACETS[f].map(|i| hex[i]);
    let gone: Vec<[u32; 4]> = (0..6).filter(|f| covered >> f & 1 == 1).map(|f| sorted(facet(f))).collect();
    let mut after: Vec<[u32; 4]> = front.iter().copied().filter(|&q| !gone.contains(&sorted(q))).collect();
    // Facets are outward of the hex, so into the void: the front is outward of the void.
    after.extend((0..6).filter(|f| covered >> f & 1 == 0).map(facet).map(|[a, b, c, d]| [a, d, c, b]));
    after
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::QuadSurface;
    use hexfill_mesh::generate::grid;

    /// Laying the cubes of a block in any order that is allowed keeps the front a sphere, and what is allowed is all that keeps it one.
    #[test]
    fn a_hex_can_be_laid_exactly_where_the_rest_stays_a_ball() {
        let block = grid(3, 3, 2).unwrap();
        let hexes = block.hexes_raw();
        let surface = |quads: &[[u32; 4]]| QuadSurface::try_new(block.n_vertices(), quads).is_ok_and(|s| s.is_sphere());
        let mut random = hexfill_mesh::Random::new(7);
        for _ in 0..40 {
            let mut front: Vec<[u32; 4]> = block.boundary_quads_raw();
            let mut rest: Vec<usize> = (0..hexes.len()).collect();
            while !rest.is_empty() {
                let sets = VoidFront::new(&front);
                let mut legal = Vec::new();
                for &h in &rest {
                    let boundary = hexfill_mesh::HexMesh::try_new(
                        block.n_vertices(),
                        &rest.iter().filter(|&&r| r != h).map(|&r| hexes[r]).collect::<Vec<_>>(),
                    )
                    .map(|m| m.boundary_quads_raw());
                    let keeps = boundary.is_ok_and(|b: Vec<[u32; 4]>| b.is_empty() || surface(&b));
                    let covered = sets.covered_by(&hexes[h]);
                    assert_eq!(covered.is_some(), keeps || rest.len() == 1, "{h} of {rest:?}");
                    legal.extend(covered.map(|c| (h, c)));
                }
                let (h, covered) = legal[random.below(legal.len())];
                front = advanced(&front, &hexes[h], covered);
                rest.retain(|&r| r != h);
            }
            assert!(front.is_empty());
        }
    }
}
