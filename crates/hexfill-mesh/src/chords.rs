//! Chords: the closed curves of the dual of a quad surface, through opposite edges of quads.
//!
//! A curve enters quad `q` across the edge of dart `d` and goes on to `twin(opposite(d))`. That is a permutation of
//! the darts; each chord is two of its cycles, one for each direction, exchanged by `d -> opposite(d)`. No cycle is its own reverse:
//! in the middle of such a cycle a dart would be its own opposite or its own twin.
//! Through each quad run two chords, perhaps the same one twice.
//!
//! Source: Thurston 1993 and Mitchell 1996, who use these curves; the permutation of darts is ours.

use crate::ids::{Dart, QuadId};
use crate::surface::QuadSurface;

/// A closed curve through opposite edges of quads.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Chord {
    /// The darts across whose edges the curve enters a quad, in order of passage; the smallest dart is first.
    pub crossings: Vec<Dart>,
    /// The quads that the chord passes twice, ascending.
    pub self_crossings: Vec<QuadId>,
}

impl Chord {
    /// The quads in order of passage; a self-crossing quad appears twice.
    pub fn quads(&self) -> impl Iterator<Item = QuadId> + '_ {
        self.crossings.iter().map(|d| d.quad())
    }

    /// Number of distinct quads.
    #[allow(clippy::len_without_is_empty)]
    pub fn length(&self) -> usize {
        self.crossings.len() - self.self_crossings.len()
    }

    /// Builds the chord from its cycle of entering darts, in one of its two directions and from any start.
    pub(crate) fn from_cycle(mut cycle: Vec<Dart>) -> Self {
        let (forth, back) = (cycle.iter().min(), cycle.iter().map(|d| d.opposite()).min());
        if back < forth.copied() {
            // Backwards the curve enters where it left.
            cycle.reverse();
            cycle.iter_mut().for_each(|d| *d = d.opposite());
        }
        let first = cycle.iter().enumerate().min_by_key(|(_, d)| **d).map_or(0, |(i, _)| i);
        cycle.rotate_left(first);
        let mut quads: Vec<QuadId> = cycle.iter().map(|d| d.quad()).collect();
        quads.sort_unstable();
        let self_crossings = quads.windows(2).filter(|w| w[0] == w[1]).map(|w| w[0]).collect();
        Self { crossings: cycle, self_crossings }
    }
}

/// The chords of a surface, ordered by their smallest dart. Linear time.
///
/// # Example
/// A cube has three chords, each a ring of four quads.
/// ```
/// use hexfill_mesh::{QuadSurface, chords};
///
/// let quads = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
/// let lengths = chords(&QuadSurface::try_new(8, &quads)?).iter().map(|c| c.length()).collect::<Vec<_>>();
/// assert_eq!(lengths, [4, 4, 4]);
/// # Ok::<(), hexfill_mesh::SurfaceError>(())
/// ```
pub fn chords(surface: &QuadSurface) -> Vec<Chord> {
    let mut seen = vec![false; 4 * surface.n_quads()];
    let mut all = Vec::new();
    for start in surface.darts() {
        if seen[start.index()] {
            continue;
        }
        let mut cycle = Vec::new();
        let mut d = start;
        loop {
            seen[d.index()] = true;
            seen[d.opposite().index()] = true;
            cycle.push(d);
            d = surface.twin(d.opposite());
            if d == start {
                break;
            }
        }
        all.push(Chord::from_cycle(cycle));
    }
    all
}

/// Per quad, the chords through sides 0-2 and through sides 1-3, as indices into `chords` (those of the whole surface).
pub fn chords_by_quad(surface: &QuadSurface, chords: &[Chord]) -> Vec<[usize; 2]> {
    let mut of = vec![[usize::MAX; 2]; surface.n_quads()];
    for (i, chord) in chords.iter().enumerate() {
        for d in &chord.crossings {
            of[d.quad().index()][d.side() % 2] = i;
        }
    }
    of
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{all_spheres, cube_surface, torus};

    #[test]
    fn the_cube_has_three_belts() {
        let all = chords(&cube_surface());
        assert_eq!(all.len(), 3);
        assert!(all.iter().all(|c| c.length() == 4 && c.self_crossings.is_empty()));
    }

    #[test]
    fn a_square_torus_has_rows_and_columns() {
        let t = torus(4, 7, 0).unwrap();
        let mut lengths: Vec<usize> = chords(&t).iter().map(Chord::length).collect();
        lengths.sort_unstable();
        assert_eq!(lengths, [vec![4; 7], vec![7; 4]].concat());
    }

    #[test]
    fn chords_pass_each_quad_twice_and_follow_opposite_edges() {
        for s in (6..=12).flat_map(all_spheres) {
            let all = chords(&s);
            let by_quad = chords_by_quad(&s, &all);
            assert!(by_quad.iter().flatten().all(|&c| c < all.len()));
            let mut passes = vec![0; s.n_quads()];
            for chord in &all {
                let n = chord.crossings.len();
                for (i, &d) in chord.crossings.iter().enumerate() {
                    passes[d.quad().index()] += 1;
                    assert_eq!(chord.crossings[(i + 1) % n], s.twin(d.opposite()));
                }
                assert_eq!(chord.crossings.iter().min(), chord.crossings.first());
                let mut distinct: Vec<QuadId> = chord.quads().collect();
                distinct.sort_unstable();
                distinct.dedup();
                assert_eq!(distinct.len(), chord.length());
                // On a sphere two closed curves cross an even number of times.
                assert_eq!(chord.length() % 2, chord.self_crossings.len() % 2, "{n}");
            }
            assert!(passes.iter().all(|&p| p == 2));
            assert!(all.windows(2).all(|w| w[0].crossings[0] < w[1].crossings[0]));
        }
    }
}
