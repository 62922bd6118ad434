//! The two sides of each mirror.
//!
//! A mirror of a ball mesh fixes a disk that cuts the ball in two halves, which it exchanges (Smith's theorem: the fixed points of an
//! involution of a ball are acyclic over Z/2; here they are surfaces, and the boundary's circle is in them). So
//! * every vertex is on the mirror or on one of its sides, and a cell that the mirror does not keep has all its vertices on the mirror or
//!   on one side: an inner point of it on the mirror would be in the cell's image too;
//! * such a cell and its image share what the cell has on the mirror, nothing else.
//!
//! Source: Smith 1938 (the fixed points of an involution); the two rules are ours.

use crate::state::MAX_VERTICES;
use hexfill_mesh::{Forest, VertexId};

/// A mirror of a group, and the vertices strictly on each of its sides.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mirror {
    /// Its number among the elements.
    pub element: usize,
    pub sides: [u128; 2],
}

/// On which side of some mirrors something lies: a bit a mirror.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sides {
    first: u64,
    second: u64,
}

impl Sides {
    /// Says the side of mirror number `k`.
    pub(crate) fn add(&mut self, k: usize, second: bool) {
        *(if second { &mut self.second } else { &mut self.first }) |= 1 << k;
    }

    /// The side of mirror number `k`, if it is said: whether it is the second.
    #[inline]
    pub(crate) fn of(self, k: usize) -> Option<bool> {
        if self.first >> k & 1 == 1 { Some(false) } else { (self.second >> k & 1 == 1).then_some(true) }
    }
}

/// The sides of the sphere that an automorphism exchanges; `None` if it is no mirror.
pub(crate) fn halves(quads: &[[u8; 4]], image: &[u8]) -> Option<[u128; 2]> {
    let mut forest: Forest<VertexId> = Forest::new(image.len());
    let moved = |v: u8| image[usize::from(v)] != v;
    for quad in quads {
        let kept = quad.iter().all(|v| quad.contains(&image[usize::from(*v)]));
        for k in 0..4 {
            for j in [k + 1, k + 2] {
                let (u, v) = (quad[k], quad[j % 4]);
                // The mirror passes through a quad that it keeps, and through an edge that it turns.
                let parted = kept && (j == k + 2 || image[usize::from(u)] == v);
                if moved(u) && moved(v) && !parted {
                    forest.union(VertexId(u.into()), VertexId(v.into()));
                }
            }
        }
    }
    let half = forest.names().into_vec();
    let mut sides = [0u128; 2];
    let first = half[(0..image.len()).find(|&v| moved(v as u8))?];
    for v in (0..image.len()).filter(|&v| moved(v as u8)) {
        sides[usize::from(half[v] != first)] |= 1 << v;
    }
    let exchanged = (0..image.len()).all(|v| sides[0] >> v & 1 == sides[1] >> image[v] & 1);
    let whole = (0..image.len()).all(|v| sides[1] >> v & 1 == 0 || half[v] == half[sides[1].trailing_zeros() as usize]);
    debug_assert!(image.len() < MAX_VERTICES);
    (exchanged && whole && sides[1] != 0).then_some(sides)
}
