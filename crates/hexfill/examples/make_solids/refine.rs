//! Surfaces of mixed polygons and their refinement into quads: what artists' control meshes become.

use crate::solid::Point;
use crate::spheres::{Surface, hull};
use hexfill_mesh::Random;
use std::collections::BTreeMap;

fn mean<'a>(points: impl Iterator<Item = &'a Point>) -> Point {
    let mut sum = [0.0; 3];
    let mut n = 0.0;
    for p in points {
        (0..3).for_each(|k| sum[k] += p[k]);
        n += 1.0;
    }
    sum.map(|x| x / n)
}

/// One step of Catmull and Clark ("Recursively generated B-spline surfaces on arbitrary topological meshes", 1978): a closed
/// surface of polygons becomes one quad per corner, the old vertices keeping their numbers.
pub(crate) fn catmull_clark(points: &[Point], polygons: &[Vec<u32>]) -> Surface {
    let n = points.len();
    let edges_of = |p: &[u32]| (0..p.len()).map(|i| (p[i], p[(i + 1) % p.len()])).collect::<Vec<_>>();
    let centres: Vec<Point> = polygons.iter().map(|p| mean(p.iter().map(|&v| &points[v as usize]))).collect();
    let mut faces_at: BTreeMap<(u32, u32), Vec<usize>> = BTreeMap::new();
    for (f, polygon) in polygons.iter().enumerate() {
        for (a, b) in edges_of(polygon) {
            faces_at.entry((a.min(b), a.max(b))).or_default().push(f);
        }
    }
    let mut out = points.to_vec();
    let mut middle = BTreeMap::new();
    // Per vertex: the middles of its edges and the centres of its polygons.
    let mut near = vec![(Vec::new(), Vec::new()); n];
    for (&(a, b), faces) in &faces_at {
        let ends = [points[a as usize], points[b as usize]];
        middle.insert((a, b), out.len() as u32);
        out.push(mean(ends.iter().chain(faces.iter().map(|&f| &centres[f]))));
        for v in [a, b] {
            near[v as usize].0.push(mean(ends.iter()));
        }
    }
    let first_centre = out.len() as u32;
    out.extend(&centres);
    let mut quads = Vec::new();
    for (f, polygon) in polygons.iter().enumerate() {
        let sides = edges_of(polygon).into_iter().map(|(a, b)| middle[&(a.min(b), a.max(b))]).collect::<Vec<_>>();
        for (i, &v) in polygon.iter().enumerate() {
            near[v as usize].1.push(centres[f]);
            quads.push([v, sides[i], first_centre + f as u32, sides[(i + sides.len() - 1) % sides.len()]]);
        }
    }
    for (v, (edges, faces)) in near.iter().enumerate() {
        let degree = edges.len() as f64;
        let (r, f) = (mean(edges.iter()), mean(faces.iter()));
        out[v] = std::array::from_fn(|k| (f[k] + 2.0 * r[k] + (degree - 3.0) * points[v][k]) / degree);
    }
    (out, quads)
}

/// The same for quads.
pub(crate) fn catmull_clark_quads((points, quads): &Surface) -> Surface {
    catmull_clark(points, &quads.iter().map(|q| q.to_vec()).collect::<Vec<_>>())
}

/// A sphere of mostly quads, with some triangles and pentagons, as polygons: neighbouring triangles of the hull of the points
/// joined at random. Every vertex keeps three edges. Refined, its chords cross themselves, as artists' surfaces' do.
pub(crate) fn mixed(points: &[Point], seed: u64) -> Vec<Vec<u32>> {
    let mut polygons: Vec<Vec<u32>> = hull(points).into_iter().map(|t| t.to_vec()).collect();
    let mut random = Random::new(seed);
    let mut degree = vec![0u32; points.len()];
    polygons.iter().flatten().for_each(|&v| degree[v as usize] += 1);
    let mut edges: Vec<(u32, u32)> =
        polygons.iter().flat_map(|t| (0..3).map(|i| (t[i], t[(i + 1) % 3]))).filter(|(a, b)| a < b).collect();
    random.shuffle(&mut edges);
    // Two triangles at most at first; a pentagon now and then.
    for (i, &(a, b)) in edges.iter().enumerate() {
        let holds = |p: &Vec<u32>, a, b| (0..p.len()).any(|i| p[i] == a && p[(i + 1) % p.len()] == b);
        let of = |a, b| polygons.iter().position(|p| holds(p, a, b)).expect("every edge has two sides");
        let (left, right) = (of(a, b), of(b, a));
        let most = if i % 12 == 0 { 7 } else { 6 };
        if polygons[left].len() + polygons[right].len() > most || degree[a as usize] == 3 || degree[b as usize] == 3 {
            continue;
        }
        degree[a as usize] -= 1;
        degree[b as usize] -= 1;
        // From b round the left polygon to a, then round the right one back to b.
        let from = |p: &[u32], v: u32| {
            let at = p.iter().position(|&x| x == v).expect("the edge's end");
            p[at..].iter().chain(&p[..at]).copied().collect::<Vec<_>>()
        };
        let mut joined = from(&polygons[left], b);
        joined.extend(&from(&polygons[right], a)[1..polygons[right].len() - 1]);
        polygons[left] = joined;
        polygons.swap_remove(right);
    }
    polygons
}
