//! [`Quadrangulation`]: a polygon cut into quads, as a fan or as a grid.
//!
//! Source: ours.

use rustc_hash::FxHashMap;

/// Grids are tried for polygons of up to this many sides; their number grows with the square of it.
const LARGEST_GRID: usize = 32;

/// A polygon cut into quads: corners `0..k` are those of the polygon, further ones lie inside.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Quadrangulation {
    /// Corners of the polygon.
    pub n_corners: usize,
    /// Vertices inside it.
    pub n_inner: usize,
    /// The quads, counter-clockwise as the polygon.
    pub quads: Vec<[usize; 4]>,
}

impl Quadrangulation {
    /// The k-gon as (k - 2) / 2 quads round corner `apex`.
    fn fan(k: usize, apex: usize) -> Self {
        let at = |i: usize| (apex + i) % k;
        let quads = (0..(k - 2) / 2).map(|m| [at(0), at(2 * m + 1), at(2 * m + 2), at(2 * m + 3)]).collect();
        Self { n_corners: k, n_inner: 0, quads }
    }

    /// The k-gon as a grid of `a` by `k / 2 - a` quads that starts at corner `first`; 1 <= a < k / 2.
    fn grid(k: usize, a: usize, first: usize) -> Self {
        let b = k / 2 - a;
        let at = |i: usize, j: usize| {
            let round = match (i, j) {
                (i, 0) => i,
                (i, j) if i == a => a + j,
                (i, j) if j == b => a + b + a - i,
                (0, j) => 2 * a + b + b - j,
                (i, j) => return k + (j - 1) * (a - 1) + i - 1,
            };
            (first + round) % k
        };
        let cells = (0..b).flat_map(|j| (0..a).map(move |i| (i, j)));
        let quads = cells.map(|(i, j)| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]).collect();
        Self { n_corners: k, n_inner: (a - 1) * (b - 1), quads }
    }

    /// All that are tried for a k-gon.
    pub(crate) fn all(k: usize) -> Vec<Self> {
        // A fan needs no inner vertex and is as small as can be; a grid has more hexes, but joins opposite strands
        // straight across.
        let mut all: Vec<Self> = if k == 4 { vec![Self::fan(4, 0)] } else { (0..k).map(|i| Self::fan(k, i)).collect() };
        if k <= LARGEST_GRID {
            all.extend(Self::grids(k).filter(|g| g.quads.len() > 1));
        }
        all
    }

    /// The k-gon (k even) as grids, each once.
    pub fn grids(k: usize) -> impl Iterator<Item = Self> {
        // From the opposite corner, and with a and b exchanged from the next one, it is the same grid.
        (1..k / 2).flat_map(move |a| (0..k / 2).map(move |i| Self::grid(k, a, i)))
    }

    /// Per quad, the chords across its sides 0 and 2 and across 1 and 3; per side of the polygon, its chord. Chords of the polygon are
    /// numbered from 0; each starts and ends at the rim.
    pub(crate) fn chords(&self) -> (Vec<[usize; 2]>, Vec<usize>) {
        let mut sides: FxHashMap<(usize, usize), Vec<usize>> = FxHashMap::default();
        let edge = |s: usize| {
            let (a, b) = (self.quads[s / 4][s % 4], self.quads[s / 4][(s + 1) % 4]);
            (a.min(b), a.max(b))
        };
        for s in 0..4 * self.quads.len() {
            sides.entry(edge(s)).or_default().push(s);
        }
        let mut of_quad = vec![[usize::MAX; 2]; self.quads.len()];
        let mut of_side = vec![usize::MAX; self.n_corners];
        let mut n = 0;
        for i in 0..self.n_corners {
            if of_side[i] != usize::MAX {
                continue;
            }
            let j = (i + 1) % self.n_corners;
            // Straight through quad after quad from the rim to the rim; a disk has no other curve ends, so two sides
            // of the polygon are named at a time.
            let mut s = sides[&(i.min(j), i.max(j))][0];
            loop {
                of_quad[s / 4][s % 2] = n;
                let across = s ^ 2;
                match sides[&edge(across)].iter().find(|&&t| t != across) {
                    Some(&t) => s = t,
                    None => {
                        let (a, b) = (self.quads[across / 4][across % 4], self.quads[across / 4][(across + 1) % 4]);
                        of_side[i] = n;
                        of_side[if (a + 1) % self.n_corners == b { a } else { b }] = n;
                        break;
                    }
                }
            }
            n += 1;
        }
        (of_quad, of_side)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quadrangulations_are_disks() {
        for k in [4, 6, 8, 10, 16] {
            for cut in Quadrangulation::all(k) {
                let edges: std::collections::BTreeSet<_> = cut
                    .quads
                    .iter()
                    .flat_map(|q| (0..4).map(move |i| (q[i].min(q[(i + 1) % 4]), q[i].max(q[(i + 1) % 4]))))
                    .collect();
                assert_eq!((k + cut.n_inner + cut.quads.len()) as i64 - edges.len() as i64, 1);
                assert_eq!(4 * cut.quads.len() + k, 2 * edges.len());
                let (of_quad, of_side) = cut.chords();
                assert!(of_quad.iter().flatten().chain(&of_side).all(|&c| c < k / 2));
                for c in 0..k / 2 {
                    assert_eq!(of_side.iter().filter(|&&s| s == c).count(), 2);
                }
            }
        }
    }
}
