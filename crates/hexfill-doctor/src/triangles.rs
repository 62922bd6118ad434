//! Triangles merged in pairs into quads: a matching of largest size (Edmonds 1965), and of those one whose worst quad is best.
//!
//! Source: Edmonds 1965; raising the worst quad by bisection of the threshold is ours.

use crate::sines::least_sine;
use crate::soup::Soup;
use petgraph::algo::maximum_matching;
use petgraph::graph::UnGraph;
use std::collections::BTreeMap;

/// Two triangles and the quad they make.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub struct MergedPair {
    /// The triangles.
    pub faces: [u32; 2],
    /// The quad.
    pub quad: [u32; 4],
}

/// Triangles of one closed surface are merged if there are at most so many: matching takes longer than linear time.
const MOST: usize = 50_000;

/// Pairs of neighbouring triangles, as many as possible, ascending; and the triangles left alone. Quads with a corner that is not convex are not made where
/// there are positions.
pub fn merged_triangles(soup: &Soup) -> (Vec<MergedPair>, Vec<u32>) {
    let triangles: Vec<u32> = (0..soup.faces.len() as u32).filter(|&f| soup.faces[f as usize].len() == 3).collect();
    if triangles.is_empty() || triangles.len() > MOST {
        return (Vec::new(), triangles);
    }
    let mut sides: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
    for &t in &triangles {
        let face = &soup.faces[t as usize];
        for k in 0..3 {
            let (a, b) = (face[k], face[(k + 1) % 3]);
            sides.entry([a.min(b), a.max(b)]).or_default().push(t);
        }
    }
    let mut pairs: Vec<(f64, MergedPair)> = sides
        .iter()
        .filter_map(|(edge, at)| {
            let &[p, q] = &at[..] else { return None };
            let pair =
                MergedPair { faces: [p, q], quad: quad_of(&soup.faces[p as usize], &soup.faces[q as usize], *edge)? };
            let quality = quality(soup, pair.quad);
            (quality > 0.0).then_some((quality, pair))
        })
        .collect();
    pairs.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.faces.cmp(&b.1.faces)));
    // The fewest of the best pairs that give as many quads as all of them.
    let most = matching(&triangles, &pairs).len();
    let (mut few, mut enough) = (0, pairs.len());
    while few < enough {
        let middle = usize::midpoint(few, enough);
        if matching(&triangles, &pairs[..middle]).len() == most { enough = middle } else { few = middle + 1 }
    }
    let mut merged = matching(&triangles, &pairs[..enough]);
    merged.sort_unstable_by_key(|pair| pair.faces);
    let mut alone = triangles;
    let mut taken: Vec<u32> = merged.iter().flat_map(|pair| pair.faces).collect();
    taken.sort_unstable();
    alone.retain(|t| taken.binary_search(t).is_err());
    (merged, alone)
}

/// As many of the pairs as possible that share no triangle.
fn matching(triangles: &[u32], pairs: &[(f64, MergedPair)]) -> Vec<MergedPair> {
    let index = |t: u32| triangles.binary_search(&t).expect("a triangle") as u32;
    let mut graph: UnGraph<(), MergedPair> = UnGraph::with_capacity(triangles.len(), pairs.len());
    triangles.iter().for_each(|_| {
        graph.add_node(());
    });
    for (_, pair) in pairs {
        let [p, q] = pair.faces.map(index);
        graph.update_edge(p.into(), q.into(), *pair);
    }
    let found = maximum_matching(&graph);
    found.edges().filter_map(|(p, q)| graph.find_edge(p, q).map(|e| graph[e])).collect()
}

/// The quad of two triangles at an edge, in the sense of the first; `None` if they have the same corners.
fn quad_of(p: &[u32], q: &[u32], edge: [u32; 2]) -> Option<[u32; 4]> {
    let k = (0..3).find(|&k| !edge.contains(&p[k]))?;
    let apex = *q.iter().find(|v| !edge.contains(v))?;
    (apex != p[k]).then(|| [p[k], p[(k + 1) % 3], apex, p[(k + 2) % 3]])
}

/// The least sine of its corners; 1 without positions.
fn quality(soup: &Soup, quad: [u32; 4]) -> f64 {
    if soup.points.is_empty() { 1.0 } else { least_sine(&[quad.map(|v| soup.points[v as usize])]) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The cube, every side cut along one of its diagonals.
    fn cut_cube(diagonals: u32) -> Soup {
        let points = (0..8u32).map(|v| [0, 1, 2].map(|k| f64::from(v >> k & 1))).collect();
        let sides: [[u32; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let faces = sides.iter().enumerate().flat_map(|(i, &[a, b, c, d])| {
            if diagonals >> i & 1 == 0 { [vec![a, b, c], vec![a, c, d]] } else { [vec![a, b, d], vec![b, c, d]] }
        });
        Soup { points, faces: faces.collect() }
    }

    #[test]
    fn every_cube_of_triangles_becomes_the_cube_again() {
        for diagonals in 0..64 {
            let (merged, alone) = merged_triangles(&cut_cube(diagonals));
            assert!(alone.is_empty() && merged.len() == 6);
            // Flat quads are better than bent ones.
            assert!(merged.iter().all(|pair| pair.faces[0] + 1 == pair.faces[1]), "{diagonals}: {merged:?}");
        }
    }

    #[test]
    fn triangles_far_apart_stay_alone() {
        let mut soup = cut_cube(0);
        soup.faces = soup.faces.into_iter().step_by(2).take(1).collect();
        soup.faces.push(vec![1, 3, 7, 5]);
        assert_eq!(merged_triangles(&soup), (vec![], vec![0]));
    }
}
