//! Quads that meet improperly: two quads of a surface may share nothing, one vertex, or one edge of both.
//!
//! Rule R2 of a hex mesh (two hexes share nothing, a vertex, an edge of both or a quad of both) passes to its
//! boundary, so a surface with an improper pair has no proper hex mesh. Two quads that share more than one
//! edge share both ends of a diagonal of one of them (any three corners of a quad hold a diagonal, and two
//! vertices are joined by at most one edge of a [`QuadSurface`]). So it is enough to look at vertex pairs that are
//! a diagonal: such a pair must be the diagonal of one quad only and no edge.
//! On a sphere that is exactly 3-connectedness (Brinkmann, Greenberg, Greenhill, McKay, Thomas, Wollan 2005).
//!
//! Source: Brinkmann et al. 2005 (3-connected); the reduction to diagonals is ours.

use crate::ids::{Edge, Offenders, QuadId};
use crate::surface::QuadSurface;
use std::fmt;

/// Two quads and two vertices of both that are the ends of a diagonal of at least one of them.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct ImproperPair {
    /// The quads, smaller id first.
    pub quads: [QuadId; 2],
    /// The vertex pair.
    pub vertices: Edge,
}

impl fmt::Display for ImproperPair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { quads: [p, q], vertices: Edge(a, b) } = self;
        write!(f, "{p} and {q} share the diagonal {a}-{b}")
    }
}

/// The improper pairs of a surface, ordered by vertex pair; `count` counts (quad, quad, vertex pair) triples.
/// Any closed quad surface, of any genus and number of components. Linear time up to sorting round each vertex.
///
/// # Example
/// Two quads back to back are a closed surface, but no two hexes may meet as they do.
/// ```
/// use hexfill_mesh::{QuadSurface, improper_pairs, is_proper};
///
/// let pillow = QuadSurface::try_new(4, &[[0, 1, 2, 3], [3, 2, 1, 0]])?;
/// assert!(!is_proper(&pillow));
/// assert_eq!(improper_pairs(&pillow).count, 2);
/// # Ok::<(), hexfill_mesh::SurfaceError>(())
/// ```
pub fn improper_pairs(surface: &QuadSurface) -> Offenders<ImproperPair> {
    let quads = surface.quads();
    // Items: (other vertex, is edge, quad), in buckets by the smaller vertex of the pair.
    let items = |q: usize| {
        let [a, b, c, d] = quads[q];
        [(a, c, false), (b, d, false), (a, b, true), (b, c, true), (c, d, true), (d, a, true)]
    };
    let mut start = vec![0usize; surface.n_vertices() + 1];
    for q in 0..quads.len() {
        for (a, b, _) in items(q) {
            start[a.min(b).index() + 1] += 1;
        }
    }
    for v in 0..surface.n_vertices() {
        start[v + 1] += start[v];
    }
    let mut cursor = start.clone();
    let mut sorted = vec![(0u32, false, 0u32); 6 * quads.len()];
    for q in 0..quads.len() {
        for (a, b, is_edge) in items(q) {
            let slot = &mut cursor[a.min(b).index()];
            sorted[*slot] = (a.max(b).0, is_edge, q as u32);
            *slot += 1;
        }
    }
    let mut pairs = Offenders::default();
    for v in 0..surface.n_vertices() {
        let bucket = &mut sorted[start[v]..start[v + 1]];
        bucket.sort_unstable();
        for run in bucket.chunk_by(|x, y| x.0 == y.0) {
            // Diagonals come first in the run (false < true), then the two quads of the edge if there is one.
            let diagonals = run.iter().take_while(|item| !item.1).count();
            if diagonals == 0 || run.len() == 1 {
                continue;
            }
            // The number by arithmetic: one vertex pair may be the diagonal of many quads.
            let new = diagonals * (diagonals - 1) / 2 + diagonals * (run.len() - diagonals);
            'keep: for i in 0..diagonals {
                for other in &run[i + 1..] {
                    if pairs.first.len() == Offenders::<ImproperPair>::SHOWN {
                        break 'keep;
                    }
                    let (p, q) = (run[i].2.min(other.2), run[i].2.max(other.2));
                    let vertices = Edge::new((v as u32).into(), run[i].0.into());
                    pairs.first.push(ImproperPair { quads: [QuadId(p), QuadId(q)], vertices });
                }
            }
            pairs.count += new;
        }
    }
    pairs
}

/// Whether any two quads share nothing, a vertex or an edge. Any closed quad surface; time as [`improper_pairs`].
pub fn is_proper(surface: &QuadSurface) -> bool {
    improper_pairs(surface).is_empty()
}

/// Whether the surface is one sphere whose graph is 3-connected; `false` for any other surface (there ask [`is_proper`]).
pub fn is_three_connected(surface: &QuadSurface) -> bool {
    surface.is_sphere() && is_proper(surface)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::cube_surface;

    /// The cube with one quad replaced by two quads round a new vertex of degree 2.
    pub(crate) fn two_valent() -> QuadSurface {
        let mut quads: Vec<[u32; 4]> = cube_surface().quads_raw();
        let [a, b, c, d] = quads.pop().unwrap();
        quads.extend([[a, b, c, 8], [a, 8, c, d]]);
        QuadSurface::try_new(9, &quads).unwrap()
    }

    #[test]
    fn the_cube_is_proper_and_a_two_valent_vertex_is_not() {
        assert!(is_three_connected(&cube_surface()));
        let bad = two_valent();
        let pairs = improper_pairs(&bad);
        let [a, _, c, _] = bad.quads()[5];
        assert_eq!(pairs.count, 1);
        assert_eq!(pairs.first, [ImproperPair { quads: [QuadId(5), QuadId(6)], vertices: Edge::new(a, c) }]);
        assert_eq!(pairs.first[0].to_string(), format!("q5 and q6 share the diagonal {}-{}", a.min(c), a.max(c)));
        assert!(!is_three_connected(&bad));
    }

    #[test]
    fn a_pillow_shares_both_diagonals() {
        let pillow = QuadSurface::try_new(4, &[[0, 1, 2, 3], [0, 3, 2, 1]]).unwrap();
        assert_eq!(improper_pairs(&pillow).count, 2);
    }

    #[test]
    fn many_quads_on_one_diagonal_are_counted_without_being_listed() {
        // n lunes between two poles, each split by a middle vertex pair: all quads share the poles.
        let n = 1000u32;
        let quads: Vec<[u32; 4]> = (0..n).map(|i| [0, 2 + i, 1, 2 + (i + 1) % n]).collect();
        let s = QuadSurface::try_new(n as usize + 2, &quads).unwrap();
        let pairs = improper_pairs(&s);
        assert_eq!((pairs.count, pairs.first.len()), (1000 * 999 / 2, 10));
    }

    #[test]
    fn improper_pairs_agree_with_the_definition() {
        for n in [6, 8, 9, 10, 11, 12] {
            for s in crate::generate::all_spheres(n) {
                assert!(is_three_connected(&s));
            }
        }
        for (n, m, shift) in [(3, 3, 0), (3, 4, 1), (2, 5, 1), (2, 6, 1), (2, 7, 3), (1, 8, 3), (1, 10, 4), (1, 13, 5)]
        {
            let Ok(s) = crate::generate::torus(n, m, shift) else { continue };
            let mut expected = false;
            for (i, p) in s.quads().iter().enumerate() {
                for q in &s.quads()[..i] {
                    let shared: Vec<usize> = (0..4).filter(|&k| q.contains(&p[k])).collect();
                    let bad = shared.len() > 2
                        || shared.len() == 2 && {
                            let other = shared.clone().into_iter().map(|k| q.iter().position(|v| *v == p[k]).unwrap());
                            let other: Vec<usize> = other.collect();
                            (shared[1] - shared[0]) == 2 || other[0].abs_diff(other[1]) == 2
                        };
                    expected |= bad;
                }
            }
            assert_eq!(!is_proper(&s), expected, "torus {n} {m} {shift}");
        }
    }

    /// Whether the graph stays connected when any two vertices are taken out: the definition, tried on all pairs.
    fn stays_connected(s: &QuadSurface) -> bool {
        let n = s.n_vertices();
        let mut neighbours = vec![Vec::new(); n];
        for d in s.darts() {
            neighbours[s.origin(d).index()].push(s.target(d).index());
        }
        (0..n).all(|a| {
            (0..a).all(|b| {
                let mut seen = vec![false; n];
                (seen[a], seen[b]) = (true, true);
                let start = (0..n).find(|&v| !seen[v]).unwrap();
                seen[start] = true;
                let mut stack = vec![start];
                while let Some(v) = stack.pop() {
                    for &w in &neighbours[v] {
                        if !std::mem::replace(&mut seen[w], true) {
                            stack.push(w);
                        }
                    }
                }
                seen.iter().all(|&s| s)
            })
        })
    }

    #[test]
    fn proper_spheres_are_the_three_connected_ones() {
        use crate::generate::Random;
        let mut counts = [0, 0];
        for seed in 0..400 {
            // A random simple quadrangulation: two-valent vertices are put into quads, then edges slide to the next long diagonal of their hexagon.
            let mut random = Random::new(seed);
            let mut quads = crate::cube::FACETS.map(|f| f.map(|v| v as u32)).to_vec();
            let n = 8 + random.below(7) as u32;
            for v in 8..n {
                let i = random.below(quads.len());
                let mut q = quads[i];
                q.rotate_left(random.below(2));
                let [a, b, c, d] = q;
                quads[i] = [a, b, c, v];
                quads.push([a, v, c, d]);
            }
            for _ in 0..60 {
                let (i, j) = (random.below(quads.len()), random.below(quads.len()));
                let (mut p, mut q) = (quads[i], quads[j]);
                p.rotate_left(random.below(4));
                q.rotate_left(random.below(4));
                if i != j && p[0] == q[1] && p[1] == q[0] {
                    let ([a, d, e, f], [_, _, b, c]) = (p, q);
                    let mut slid = quads.clone();
                    (slid[i], slid[j]) = ([a, b, e, f], [b, c, d, e]);
                    if QuadSurface::try_new(n as usize, &slid).is_ok_and(|s| s.is_sphere() && s.reversed().is_empty()) {
                        quads = slid;
                    }
                }
            }
            let s = QuadSurface::try_new(n as usize, &quads).unwrap();
            assert_eq!(is_three_connected(&s), stays_connected(&s), "{quads:?}");
            counts[usize::from(is_three_connected(&s))] += 1;
        }
        for s in (6..=11).flat_map(crate::generate::all_spheres) {
            assert!(stays_connected(&s));
        }
        assert!(counts.iter().all(|&c| c >= 5), "both kinds are met: {counts:?}");
    }
}
