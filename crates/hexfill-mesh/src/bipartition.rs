//! Two-colouring of the vertices of a surface, or an odd cycle as the reason why there is none.
//!
//! A quad sphere always has one (all faces are even); on other surfaces an odd cycle may exist, and no hex mesh does if an odd
//! cycle bounds a surface inside the domain (Erickson 2014).
//!
//! Source: Erickson 2014, section 4 (why odd cycles matter).

use crate::ids::VertexId;
use crate::surface::QuadSurface;
use std::collections::VecDeque;

/// A closed walk of odd length along edges, each vertex once: `vertices[i]` and `vertices[i + 1]` are joined, the last and the first too.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the surface has an odd cycle of {} edges through {}, so its vertices have no two-colouring", .vertices.len(), .vertices[0])]
pub struct OddCycle {
    /// The vertices in order.
    pub vertices: Vec<VertexId>,
}

/// Per vertex its colour, such that every edge joins different colours; in each component the smallest vertex gets `false`, as do
/// vertices no quad uses. Linear time.
///
/// # Errors
/// [`OddCycle`] if there is none.
///
/// # Example
/// ```
/// use hexfill_mesh::{QuadSurface, bipartition};
///
/// let quads = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
/// let colours = bipartition(&QuadSurface::try_new(8, &quads)?)?;
/// assert_eq!(colours, [false, true, false, true, true, false, true, false]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn bipartition(surface: &QuadSurface) -> Result<Vec<bool>, OddCycle> {
    const UNSEEN: u32 = u32::MAX;
    let dart = surface.dart_of_vertices();
    let mut parent = vec![VertexId(UNSEEN); surface.n_vertices()];
    let mut colour = vec![false; surface.n_vertices()];
    let mut queue = VecDeque::new();
    for root in 0..surface.n_vertices() {
        if dart[root].is_none() || parent[root].0 != UNSEEN {
            continue;
        }
        parent[root] = VertexId::new(root);
        queue.push_back(VertexId::new(root));
        // Breadth first, so that the odd cycle, where there is one, is made of two shortest paths and short.
        while let Some(v) = queue.pop_front() {
            let Some(first) = dart[v.index()] else { continue };
            for d in surface.round_vertex(first) {
                let w = surface.target(d);
                if parent[w.index()].0 == UNSEEN {
                    parent[w.index()] = v;
                    colour[w.index()] = !colour[v.index()];
                    queue.push_back(w);
                } else if colour[w.index()] == colour[v.index()] {
                    return Err(odd_cycle(&parent, v, w));
                }
            }
        }
    }
    Ok(colour)
}

/// The cycle of the tree paths from `v` and `w` to their last common ancestor and the edge `vw`. Both have the same depth in a
/// breadth-first tree (an edge joins depths that differ by one at most, and the colours agree), so the paths go up in step.
fn odd_cycle(parent: &[VertexId], v: VertexId, w: VertexId) -> OddCycle {
    let (mut left, mut right) = (vec![v], vec![w]);
    let (mut a, mut b) = (v, w);
    loop {
        (a, b) = (parent[a.index()], parent[b.index()]);
        left.push(a);
        if a == b {
            break;
        }
        right.push(b);
    }
    left.extend(right.into_iter().rev());
    OddCycle { vertices: left }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{all_spheres, torus};

    #[test]
    fn spheres_are_bipartite() {
        for s in (6..=12).flat_map(all_spheres) {
            let colour = bipartition(&s).unwrap();
            for d in s.darts() {
                assert_ne!(colour[s.origin(d).index()], colour[s.target(d).index()]);
            }
        }
    }

    #[test]
    fn a_torus_is_bipartite_unless_it_has_an_odd_way_round() {
        for n in 3..8 {
            for m in 3..8 {
                for shift in 0..n {
                    let t = torus(n, m, shift).unwrap();
                    let edges: std::collections::BTreeSet<_> = t.darts().map(|d| (t.origin(d), t.target(d))).collect();
                    match bipartition(&t) {
                        Ok(_) => assert!(n % 2 == 0 && (m + shift) % 2 == 0),
                        Err(OddCycle { vertices }) => {
                            assert!(n % 2 == 1 || (m + shift) % 2 == 1);
                            assert_eq!(vertices.len() % 2, 1);
                            for (i, &v) in vertices.iter().enumerate() {
                                assert!(!vertices[..i].contains(&v));
                                assert!(edges.contains(&(v, vertices[(i + 1) % vertices.len()])));
                            }
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn unused_vertices_and_components_are_coloured() {
        let quads: Vec<[u32; 4]> = [1, 20]
            .iter()
            .flat_map(|o| {
                crate::generate::cube_surface().quads().iter().map(|q| q.map(|v| v.0 + o)).collect::<Vec<_>>()
            })
            .collect();
        let s = QuadSurface::try_new(30, &quads).unwrap();
        let colour = bipartition(&s).unwrap();
        assert_eq!(colour.iter().filter(|c| **c).count(), 8);
        assert!(!colour[0] && !colour[1] && !colour[20]);
    }
}
