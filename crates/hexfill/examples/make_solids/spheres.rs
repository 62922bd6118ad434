//! Spheres from triangulations: the convex hull of points on the unit sphere is their Delaunay triangulation there.

use crate::solid::Point;
use hexfill_mesh::Random;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// A quad surface with positions.
pub(crate) type Surface = (Vec<Point>, Vec<[u32; 4]>);

/// Random points of the unit sphere, uniform.
pub(crate) fn random_points(n: usize, seed: u64) -> Vec<Point> {
    let mut random = Random::new(seed);
    let mut point = || -> Point {
        let z: f64 = 2.0 * random.unit() - 1.0;
        let angle = 2.0 * PI * random.unit();
        let r = (1.0 - z * z).sqrt();
        [r * angle.cos(), r * angle.sin(), z]
    };
    (0..n).map(|_| point()).collect()
}

/// Points of the unit sphere spread evenly along a spiral.
pub(crate) fn even_points(n: usize) -> Vec<Point> {
    let golden = PI * (3.0 - 5f64.sqrt());
    let point = |i: usize| {
        let z: f64 = 1.0 - (2 * i + 1) as f64 / n as f64;
        let (r, angle): (f64, f64) = ((1.0 - z * z).sqrt(), golden * i as f64);
        [r * angle.cos(), r * angle.sin(), z]
    };
    (0..n).map(point).collect()
}

/// Positive if `d` lies on the side of triangle `abc` its vertices turn clockwise to (below it).
fn side([a, b, c]: [Point; 3], d: Point) -> f64 {
    let [u, v, w] = [b, c, d].map(|p| [p[0] - a[0], p[1] - a[1], p[2] - a[2]]);
    let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    -(normal[0] * w[0] + normal[1] * w[1] + normal[2] * w[2])
}

/// The triangles of the convex hull, seen from outside counter-clockwise: one point after the other replaces what it sees.
/// For points in general position on a sphere; quadratic time.
pub(crate) fn hull(points: &[Point]) -> Vec<[u32; 3]> {
    let at = |t: [u32; 3]| t.map(|v| points[v as usize]);
    let first = if side(at([0, 1, 2]), points[3]) > 0.0 { [0, 1, 2] } else { [0, 2, 1] };
    let [a, b, c] = first;
    let mut triangles = vec![first, [a, c, 3], [c, b, 3], [b, a, 3]];
    for v in 4..points.len() as u32 {
        let sees = |&t: &[u32; 3]| side(at(t), points[v as usize]) < 0.0;
        let (seen, kept): (Vec<_>, Vec<_>) = triangles.into_iter().partition(sees);
        let edges = seen.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let all: Vec<[u32; 2]> = edges.collect();
        triangles = kept;
        // The rim of what is seen: edges whose other side is not seen.
        triangles.extend(all.iter().filter(|&&[a, b]| !all.contains(&[b, a])).map(|&[a, b]| [a, b, v]));
    }
    triangles
}

fn to_sphere(p: Point) -> Point {
    let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
    p.map(|x| x / length)
}

fn middle(points: &[Point], of: &[u32]) -> Point {
    to_sphere([0, 1, 2].map(|k| of.iter().map(|&v| points[v as usize][k]).sum()))
}

/// Every triangle cut into three quads at its centre and the middles of its edges. Its chords are simple.
pub(crate) fn cut_triangles(points: &[Point]) -> Surface {
    let mut out = points.to_vec();
    let mut middles = BTreeMap::new();
    let mut quads = Vec::new();
    for t in hull(points) {
        let centre = out.len() as u32;
        out.push(middle(points, &t));
        let m = [0, 1, 2].map(|i| {
            let (a, b) = (t[i], t[(i + 1) % 3]);
            *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                out.push(middle(points, &[a, b]));
                out.len() as u32 - 1
            })
        });
        quads.extend([0, 1, 2].map(|i| [t[i], m[i], centre, m[(i + 2) % 3]]));
    }
    (out, quads)
}

/// The radial graph: vertices and triangles of a triangulation as vertices, one quad an edge. Its chords cross themselves
/// heavily, and it is 3-connected.
pub(crate) fn radial(points: &[Point]) -> Surface {
    let triangles = hull(points);
    let mut out = points.to_vec();
    out.extend(triangles.iter().map(|t| middle(points, t)));
    let mut left = BTreeMap::new();
    for (i, &[a, b, c]) in triangles.iter().enumerate() {
        for edge in [[a, b], [b, c], [c, a]] {
            left.insert(edge, (points.len() + i) as u32);
        }
    }
    let quads = left.iter().filter(|&(&[a, b], _)| a < b).map(|(&[a, b], &t)| [a, left[&[b, a]], b, t]);
    let quads = quads.collect();
    (out, quads)
}
