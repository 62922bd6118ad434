//! [`Directions`]: a vertex star as determinants of unit directions, some of them free.
//!
//! Every corner is the determinant of three directions, linear in each of them. With `u = c + d` it is its value at the centres c, plus a part linear in the
//! d, plus `p . (d_j x d_k)` for each pair of free directions in it, plus the determinant of three d.
//!
//! Source: ours.

use hexfill_geometry::{Ray, Vector, det, scale};

/// Corners as triples of rays, right-handed.
#[derive(Clone, Debug)]
pub(super) struct Directions {
    pub(super) corners: Vec<[Ray; 3]>,
    pub(super) n_free: usize,
    /// The pairs and triples of free rays that occur in corners, ascending.
    pub(super) pairs: Vec<[usize; 2]>,
    pub(super) triples: Vec<[usize; 3]>,
}

/// Terms of second order by pair, and of third by triple, of one corner.
type Higher = (Vec<(usize, Vector)>, Option<(usize, f64)>);

impl Directions {
    /// The corners of a star with this many free rays.
    pub(super) fn new(corners: Vec<[Ray; 3]>, n_free: usize) -> Self {
        let (mut pairs, mut triples) = (Vec::new(), Vec::new());
        for corner in &corners {
            let mut free: Vec<usize> =
                corner.iter().filter_map(|ray| if let Ray::Free(j) = *ray { Some(j) } else { None }).collect();
            free.sort_unstable();
            match free[..] {
                [a, b] => pairs.push([a, b]),
                [a, b, c] => {
                    pairs.extend([[a, b], [a, c], [b, c]]);
                    triples.push([a, b, c]);
                }
                _ => {}
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        triples.sort_unstable();
        triples.dedup();
        Self { corners, n_free, pairs, triples }
    }

    /// The three directions of a corner.
    pub(super) fn columns(&self, corner: usize, u: &[Vector]) -> [Vector; 3] {
        self.corners[corner].map(|ray| match ray {
            Ray::Fixed(d) => d,
            Ray::Free(j) => u[j],
        })
    }

    /// The worst corner at the directions `u`.
    pub(super) fn worst(&self, u: &[Vector]) -> f64 {
        (0..self.corners.len())
            .map(|i| {
                let [a, b, c] = self.columns(i, u);
                det(a, b, c)
            })
            .fold(f64::INFINITY, f64::min)
    }

    /// The terms of second and third order of a corner, each with the index of its pair or triple.
    pub(super) fn higher(&self, corner: usize, centres: &[Vector]) -> Higher {
        let rays = self.corners[corner];
        let columns = self.columns(corner, centres);
        let mut pairs = Vec::new();
        let mut free = Vec::with_capacity(3);
        for k in 0..3 {
            if let Ray::Free(j) = rays[k] {
                free.push(j);
                if let Ray::Free(l) = rays[(k + 1) % 3] {
                    let sign = if j < l { 1.0 } else { -1.0 };
                    pairs.push((self.pair(j.min(l), j.max(l)), scale(sign, columns[(k + 2) % 3])));
                }
            }
        }
        let triple = (free.len() == 3).then(|| {
            let [a, b, c] = [free[0], free[1], free[2]];
            // Even permutations of an ascending triple have one descent, cyclically.
            let descents = usize::from(a > b) + usize::from(b > c) + usize::from(c > a);
            let mut sorted = [a, b, c];
            sorted.sort_unstable();
            let at = self.triples.binary_search(&sorted).expect("listed");
            (at, if descents == 1 { 1.0 } else { -1.0 })
        });
        (pairs, triple)
    }

    fn pair(&self, j: usize, k: usize) -> usize {
        self.pairs.binary_search(&[j, k]).expect("listed")
    }
}
