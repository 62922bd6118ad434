//! Welding: points that lie in one spot become one, as at the seams that exporters of OBJ, STEP and multi-patch meshes leave.
//!
//! Source: ours.

use crate::data::MeshData;
use rustc_hash::{FxHashMap, FxHashSet};

/// What [`weld`] did.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Weld {
    /// Per point of the input: its number now.
    pub number: Vec<u32>,
    /// How many points are gone.
    pub merged: usize,
    /// Faces and cells two of whose corners have become one: the tolerance is too large for these.
    pub collapsed: usize,
}

/// Merges points whose distance is at most `tolerance`, in the unit of the coordinates; with 0 those whose coordinates are equal.
/// Chains of such points become one point. The first of each keeps its position bit for bit, its tag and its data; points keep their order,
/// faces and cells theirs. Without coordinates nothing happens.
///
/// # Example
/// A seam: two quads that share an edge in space, and no vertex.
/// ```
/// use hexfill_io::{MeshData, weld};
///
/// let points = [[0, 0], [1, 0], [1, 1], [0, 1], [1, 0], [2, 0], [2, 1], [1, 1]];
/// let points = points.map(|[x, y]| [f64::from(x), f64::from(y), 0.0]).to_vec();
/// let mut data = MeshData::from_quads(points, vec![[0, 1, 2, 3], [4, 5, 6, 7]]);
/// assert_eq!(weld(&mut data, 1e-9).merged, 2);
/// assert_eq!(data.quads, [[0, 1, 2, 3], [1, 4, 5, 2]]);
/// ```
pub fn weld(data: &mut MeshData, tolerance: f64) -> Weld {
    let root = merged(&data.points, tolerance);
    let mut number = vec![0u32; root.len()];
    let mut next = 0;
    for v in 0..root.len() {
        if root[v] as usize == v {
            number[v] = next;
            next += 1;
        } else {
            number[v] = number[root[v] as usize];
        }
    }
    let merged = number.len() - next as usize;
    if merged > 0 {
        data.renumber(&number);
        data.middles = Vec::new();
    }
    Weld { number, merged, collapsed: if merged > 0 { collapsed(data) } else { 0 } }
}

/// Per point the first point it is merged with (itself, if none is earlier).
fn merged(points: &[[f64; 3]], tolerance: f64) -> Vec<u32> {
    let mut root: Vec<u32> = (0..points.len() as u32).collect();
    if tolerance.is_nan() || tolerance <= 0.0 {
        let mut first = FxHashMap::default();
        for (v, p) in points.iter().enumerate() {
            // The sum makes one zero of the two.
            root[v] = *first.entry(p.map(|x| (x + 0.0).to_bits())).or_insert(v as u32);
        }
        return root;
    }
    // Buckets as wide as the tolerance: partners are in one of the 27 around.
    let bucket = |p: &[f64; 3]| p.map(|x| (x / tolerance).floor() as i64);
    let mut buckets: FxHashMap<[i64; 3], Vec<u32>> = FxHashMap::default();
    for (v, p) in points.iter().enumerate() {
        let centre = bucket(p);
        for i in 0..27i64 {
            let step = [i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1];
            let near = [0, 1, 2].map(|k| centre[k].saturating_add(step[k]));
            for &w in buckets.get(&near).map_or(&[][..], Vec::as_slice) {
                if distance(p, &points[w as usize]) <= tolerance {
                    let (a, b) = (find(&mut root, v as u32), find(&mut root, w));
                    root[a.max(b) as usize] = a.min(b);
                }
            }
        }
        buckets.entry(centre).or_default().push(v as u32);
    }
    (0..points.len() as u32).map(|v| find(&mut root, v)).collect()
}

fn find(root: &mut [u32], mut v: u32) -> u32 {
    while root[v as usize] != v {
        root[v as usize] = root[root[v as usize] as usize];
        v = root[v as usize];
    }
    v
}

fn distance(p: &[f64; 3], q: &[f64; 3]) -> f64 {
    let [x, y, z] = [0, 1, 2].map(|k| p[k] - q[k]);
    x.hypot(y).hypot(z)
}

/// Faces and cells with a corner twice.
fn collapsed(data: &MeshData) -> usize {
    let twice = |nodes: &[u32]| (1..nodes.len()).any(|i| nodes[..i].contains(&nodes[i]));
    let cells = [
        data.hexes.iter().filter(|c| twice(&c[..])).count(),
        data.tets.iter().filter(|c| twice(&c[..])).count(),
        data.wedges.iter().filter(|c| twice(&c[..])).count(),
        data.pyramids.iter().filter(|c| twice(&c[..])).count(),
    ];
    data.faces().filter(|face| twice(face)).count() + cells.iter().sum::<usize>()
}

/// Most points at open edges that are looked at.
const MOST_OPEN: usize = 50_000;

/// The least tolerance, rounded up to two digits, at which welding closes the faces to a surface without collapsing any; `None` if they are
/// closed as they are, or no tolerance does. It is looked for among the gaps between points at open edges.
pub fn closing_tolerance(data: &MeshData) -> Option<f64> {
    let faces: Vec<&[u32]> = data.faces().collect();
    let mut open: Vec<u32> = open_edges(&faces, |v| v).into_iter().flatten().collect();
    open.sort_unstable();
    open.dedup();
    if open.is_empty() || !data.has_coordinates || open.len() > MOST_OPEN {
        return None;
    }
    let mut gaps: Vec<f64> = gaps(data, &faces, &open).into_iter().map(round_up).collect();
    gaps.sort_by(f64::total_cmp);
    gaps.dedup();
    // What one tolerance closes a larger one closes, too, until faces collapse.
    let points: Vec<[f64; 3]> = open.iter().map(|&v| data.points[v as usize]).collect();
    let at = |tolerance: f64| {
        let root = merged(&points, tolerance);
        let number = |v: u32| open.binary_search(&v).map_or(v, |i| open[root[i] as usize]);
        let whole = |face: &&[u32]| (1..face.len()).all(|i| (0..i).all(|j| number(face[i]) != number(face[j])));
        (open_edges(&faces, number).is_empty(), faces.iter().all(whole))
    };
    let first = gaps.partition_point(|&gap| matches!(at(gap), (false, true)));
    let best = *gaps.get(first)?;
    // All points take part in welding, also those that are at no open edge.
    let mut welded = MeshData { notes: Vec::new(), ..data.clone() };
    let made = weld(&mut welded, best);
    let faces: Vec<&[u32]> = welded.faces().collect();
    (at(best) == (true, true) && made.collapsed == 0 && open_edges(&faces, |v| v).is_empty()).then_some(best)
}

/// Edges with one face, under other names of the vertices.
fn open_edges(faces: &[&[u32]], number: impl Fn(u32) -> u32) -> Vec<[u32; 2]> {
    let mut edges: Vec<[u32; 2]> = faces
        .iter()
        .flat_map(|face| (0..face.len()).map(|k| (face[k], face[(k + 1) % face.len()])))
        .map(|(a, b)| (number(a), number(b)))
        .map(|(a, b)| [a.min(b), a.max(b)])
        .collect();
    edges.sort_unstable();
    edges.chunk_by(|a, b| a == b).filter(|run| run.len() == 1).map(|run| run[0]).collect()
}

/// From each point at open edges to the nearest other one that it shares no face with.
fn gaps(data: &MeshData, faces: &[&[u32]], open: &[u32]) -> Vec<f64> {
    let mut together: FxHashSet<[u32; 2]> = FxHashSet::default();
    for face in faces {
        for &a in *face {
            together.extend(face.iter().map(|&b| [a, b]));
        }
    }
    let at = |v: u32| data.points[v as usize];
    let extent = |k: usize| {
        let (low, high) = open.iter().fold((f64::MAX, f64::MIN), |(l, h), &v| (l.min(at(v)[k]), h.max(at(v)[k])));
        high - low
    };
    let axis = (0..3).max_by(|&a, &b| extent(a).total_cmp(&extent(b))).unwrap_or(0);
    let mut sorted = open.to_vec();
    sorted.sort_by(|&a, &b| at(a)[axis].total_cmp(&at(b)[axis]));
    let nearest = |i: usize| {
        let mut best = f64::INFINITY;
        let mut look = |w: u32| {
            if at(w)[axis] - at(sorted[i])[axis] > best || at(sorted[i])[axis] - at(w)[axis] > best {
                return false;
            }
            if !together.contains(&[sorted[i], w]) {
                best = best.min(distance(&at(sorted[i]), &at(w)));
            }
            true
        };
        // Either way until the axis alone is farther than the nearest.
        let _ = sorted[i + 1..].iter().all(|&w| look(w));
        let _ = sorted[..i].iter().rev().all(|&w| look(w));
        best
    };
    (0..sorted.len()).map(nearest).filter(|gap| gap.is_finite()).collect()
}

/// The next number of two digits that is not smaller.
fn round_up(gap: f64) -> f64 {
    if gap == 0.0 {
        return 0.0;
    }
    let short: f64 = format!("{gap:.1e}").parse().unwrap_or(gap);
    if short >= gap {
        return short;
    }
    let exponent = gap.log10().floor() as i32 - 1;
    let next: f64 = format!("{:.1e}", short + 10f64.powi(exponent)).parse().unwrap_or(gap);
    next.max(gap)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A unit cube with points of its own for each quad, each off by up to `off` in x.
    fn loose(off: f64) -> MeshData {
        let mut data = MeshData::default();
        for (q, facet) in hexfill_mesh::cube::FACETS.iter().enumerate() {
            data.quads.push([0, 1, 2, 3].map(|k| 4 * q as u32 + k));
            let shift = off * (q as f64 / 5.0);
            data.points.extend(facet.map(|c| {
                let p = hexfill_mesh::cube::POSITIONS[c].map(f64::from);
                [p[0] + shift, p[1], p[2]]
            }));
        }
        data.point_tags = Some((0..24).collect());
        data
    }

    #[test]
    fn a_loose_cube_closes_at_its_gaps_and_no_sooner() {
        for off in [0.0, 1e-9, 0.03] {
            let data = loose(off);
            let tolerance = closing_tolerance(&data).unwrap();
            assert!(tolerance <= 1.1 * off && (off == 0.0) == (tolerance == 0.0), "{off}: {tolerance}");
            let mut welded = data.clone();
            let made = weld(&mut welded, tolerance);
            assert_eq!((made.merged, made.collapsed, welded.points.len()), (16, 0, 8));
            assert_eq!(welded.quad_surface().unwrap().genus(), 0);
            assert_eq!(welded.point_tags.as_ref().unwrap()[..5], [0, 1, 2, 3, 4]);
            assert!(welded.points.iter().all(|p| data.points.contains(p)));
            for (old, &new) in made.number.iter().enumerate() {
                assert!(distance(&data.points[old], &welded.points[new as usize]) <= off);
            }
            let mut less = data.clone();
            assert!(off == 0.0 || weld(&mut less, 0.19 * off).merged < 16);
            assert!(closing_tolerance(&welded).is_none());
        }
    }

    #[test]
    fn holes_are_no_seams() {
        let mut data = loose(0.0);
        data.quads.pop();
        assert_eq!(closing_tolerance(&data), None);
        let made = weld(&mut data, 2.0);
        assert_eq!((data.points.len(), made.collapsed), (1, 5));
    }

    #[test]
    fn rounding_goes_up() {
        for gap in [1.0, 1.04, 9.96e-7, 3.3333e-12, 123.0, 5e-324, 1e300] {
            let up = round_up(gap);
            assert!(up >= gap && up <= 1.2 * gap, "{gap} {up}");
        }
    }
}
