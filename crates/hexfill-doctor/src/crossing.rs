//! Faces that cross each other: a mesh that fills the surface overlaps itself there.
//!
//! A quad whose corners do not lie in a plane is no definite set of points. It is cut along one diagonal or the other, and two quads are said to cross
//! only if they do whichever way both are cut. Candidates come from a tree of boxes; every decision is made by exact predicates
//! (Shewchuk 1997) on triangles, by what they share: no vertex (they may not touch), one (they may not meet elsewhere), two
//! (they may not lie on each other).
//!
//! Beside a common edge no cut says what happens there: two quads fold over each other if, as the bilinear facets of hexes that they become, they pass
//! through each other along it. This is decided in floating point.
//!
//! Source: Shewchuk 1997, sections 4.3 and 4.4 (ORIENT2D, ORIENT3D); what counts as crossing is ours.

use crate::soup::Soup;
use hexfill_geometry::{add_scaled, dot, norm, quadratic_roots, scale, sub};
use rayon::prelude::*;
use robust::{Coord, Coord3D};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree, RTreeObject};

type Point = [f64; 3];
type Boxed = GeomWithData<Rectangle<Point>, u32>;

/// A triangle with names of its corners: points at the same place have the same name.
#[derive(Clone, Copy)]
struct Triangle {
    at: [Point; 3],
    name: [u32; 3],
}

/// The pairs of faces that cross or touch where they should not, ascending; at most `most` of them. Faces that are no triangles are cut into
/// triangles along diagonals. Faces over points that are not finite are passed over.
pub fn crossings(soup: &Soup, most: usize) -> Vec<[u32; 2]> {
    let Some(scaled) = scaled(&soup.points) else { return Vec::new() };
    let names = names(&scaled);
    let boxes: Vec<Boxed> = (0..soup.faces.len())
        .filter_map(|f| {
            let corners = soup.faces[f].iter().map(|&v| scaled.get(v as usize).copied());
            let corners: Vec<Point> = corners.collect::<Option<_>>()?;
            let is_finite = corners.len() > 2 && corners.iter().flatten().all(|x| x.is_finite());
            let bounds = is_finite.then(|| AABB::from_points(&corners))?;
            Some(GeomWithData::new(Rectangle::from_aabb(bounds), f as u32))
        })
        .collect();
    let tree = RTree::bulk_load(boxes.clone());
    let cuts = |f: u32| cuts(&soup.faces[f as usize], &scaled, &names);
    let fold = |f: u32, g: u32| fold(&soup.faces[f as usize], &soup.faces[g as usize], &scaled, &names);
    let mut pairs: Vec<[u32; 2]> = boxes
        .par_iter()
        .flat_map_iter(|one| {
            let near = tree.locate_in_envelope_intersecting(one.envelope());
            let later = near.map(|other| other.data).filter(|&other| other > one.data);
            later
                .filter(|&other| cross_however(&cuts(one.data), &cuts(other)) || fold(one.data, other))
                .map(|other| [one.data, other])
                .collect::<Vec<_>>()
        })
        .collect();
    pairs.sort_unstable();
    pairs.truncate(most);
    pairs
}

/// The points divided by a power of two, so that products neither overflow nor vanish; `None` if there is nothing to scale.
fn scaled(points: &[Point]) -> Option<Vec<Point>> {
    let finite = points.iter().filter(|p| p.iter().all(|x| x.is_finite()));
    let largest = finite.flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    // In two steps: neither factor leaves the range of numbers.
    let half = -(largest.log2() / 2.0).round();
    (largest > 0.0).then(|| points.iter().map(|p| p.map(|x| x * half.exp2() * half.exp2())).collect())
}

/// Per point the first one at the same place.
fn names(points: &[Point]) -> Vec<u32> {
    // Adding zero: -0 and 0 are the same place.
    let bits = |v: u32| points[v as usize].map(|x| (x + 0.0).to_bits());
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    order.sort_unstable_by_key(|&v| (bits(v), v));
    let mut names = vec![0; points.len()];
    let mut first = 0;
    for (i, &v) in order.iter().enumerate() {
        if i == 0 || bits(v) != bits(first) {
            first = v;
        }
        names[v as usize] = first;
    }
    names
}

/// The ways to cut a face into triangles: a quad along either diagonal, others as a fan.
fn cuts(face: &[u32], points: &[Point], names: &[u32]) -> Vec<Vec<Triangle>> {
    let triangle = |corners: [usize; 3]| Triangle {
        at: corners.map(|k| points[face[k] as usize]),
        name: corners.map(|k| names[face[k] as usize]),
    };
    let fan = |first: usize| {
        (1..face.len() - 1).map(|k| triangle([first, (first + k) % face.len(), (first + k + 1) % face.len()])).collect()
    };
    if face.len() == 4 { vec![fan(0), fan(1)] } else { vec![fan(0)] }
}

fn cross_however(a: &[Vec<Triangle>], b: &[Vec<Triangle>]) -> bool {
    a.iter().all(|p| b.iter().all(|q| p.iter().any(|s| q.iter().any(|t| cross(s, t)))))
}

/// Whether two quads with an edge in common fold over each other beside it. Seen along the edge their sides are two rays that turn from one end to the other,
/// each as a straight line between both does; where the rays meet and change sides, the quads pass through each other.
fn fold(f: &[u32], g: &[u32], points: &[Point], names: &[u32]) -> bool {
    let (&[_, _, _, _], &[_, _, _, _]) = (f, g) else { return false };
    let at = |face: &[u32], k: usize| points[face[k % 4] as usize];
    let edge = |face: &[u32], k: usize| [0, 1].map(|end| names[face[(k + end) % 4] as usize]);
    (0..4).any(|i| {
        let [from, to] = edge(f, i);
        let beside = (0..4).find_map(|j| match edge(g, j) {
            e if e == [to, from] => Some([at(g, j + 2), at(g, j + 3)]),
            e if e == [from, to] => Some([at(g, j + 3), at(g, j + 2)]),
            _ => None,
        });
        let ends = [at(f, i), at(f, i + 1)];
        let along = sub(ends[1], ends[0]);
        let across = |k: usize, to: Point| {
            let side = sub(to, ends[k]);
            add_scaled(side, -dot(side, along) / dot(along, along), along)
        };
        let sides = |[p, q]: [Point; 2]| [across(0, p), across(1, q)];
        beside.is_some_and(|other| rays_change_sides(sides([at(f, i + 3), at(f, i + 2)]), sides(other), along))
    })
}

/// Whether, on the way from 0 to 1, two vectors across an axis that each move along a straight line point the same way and change sides there.
fn rays_change_sides(left: [Point; 2], right: [Point; 2], axis: Point) -> bool {
    let turn = |l: Point, r: Point| dot(axis, hexfill_geometry::cross(l, r));
    // The sine is a quadratic polynomial in Bernstein form, up to a positive factor.
    let [c0, c1, c2] =
        [turn(left[0], right[0]), 0.5 * (turn(left[0], right[1]) + turn(left[1], right[0])), turn(left[1], right[1])];
    let size = norm(axis) * norm(left[0]).max(norm(left[1])) * norm(right[0]).max(norm(right[1]));
    let point_alike = |t: f64| {
        let at = |[p, q]: [Point; 2]| add_scaled(scale(1.0 - t, p), t, q);
        dot(at(left), at(right)) > 0.0
    };
    // A double root is a touch.
    if c1 * c1 - c0 * c2 <= (1e-9 * size).powi(2) {
        return false;
    }
    // c0 (1-t)^2 + 2 c1 t (1-t) + c2 t^2, with s = t / (1 - t).
    let roots = quadratic_roots([c0, c1, c2]).into_iter().flatten();
    let least = 1e-6;
    let mut inside = roots.filter(|s| *s > least && *s < 1.0 / least);
    inside.any(|s| point_alike(s / (1.0 + s)))
}

/// Whether two triangles meet where they should not.
fn cross(p: &Triangle, q: &Triangle) -> bool {
    // A triangle without area has no sides to be on; it is found for itself.
    if is_flat(p) || is_flat(q) {
        return false;
    }
    let shared: Vec<(usize, usize)> =
        (0..3).flat_map(|i| (0..3).map(move |j| (i, j))).filter(|&(i, j)| p.name[i] == q.name[j]).collect();
    let edge = |t: &Triangle, k: usize| [t.at[(k + 1) % 3], t.at[(k + 2) % 3]];
    // What they share they may share; only what meets beyond it counts. With two corners in common that is possible
    // in one plane alone, on one side of the edge.
    match shared[..] {
        [] => (0..3).any(|k| meets(edge(p, k), q) || meets(edge(q, k), p)),
        [(i, j)] => meets(edge(p, i), q) || meets(edge(q, j), p),
        [(i, j), (k, l)] => {
            // The third corners, on the same side of the common edge in one plane.
            let (c, d) = (p.at[3 - i - k], q.at[3 - j - l]);
            side(p.at[i], p.at[k], c, d) == 0.0 && {
                let drop = dropped(p);
                turn(p.at[i], p.at[k], c, drop) * turn(p.at[i], p.at[k], d, drop) > 0.0
            }
        }
        _ => false,
    }
}

/// Whether a closed segment meets a closed triangle.
fn meets([s, t]: [Point; 2], triangle: &Triangle) -> bool {
    let [a, b, c] = triangle.at;
    let (from, to) = (side(a, b, c, s), side(a, b, c, t));
    if from * to > 0.0 {
        return false;
    }
    if from == 0.0 && to == 0.0 {
        return meets_in_plane([s, t], triangle);
    }
    let turns = [side(s, t, a, b), side(s, t, b, c), side(s, t, c, a)];
    turns.iter().all(|&x| x >= 0.0) || turns.iter().all(|&x| x <= 0.0)
}

fn meets_in_plane([s, t]: [Point; 2], triangle: &Triangle) -> bool {
    let drop = dropped(triangle);
    let [a, b, c] = triangle.at;
    let inside = |x: Point| {
        let turns = [turn(a, b, x, drop), turn(b, c, x, drop), turn(c, a, x, drop)];
        turns.iter().all(|&x| x >= 0.0) || turns.iter().all(|&x| x <= 0.0)
    };
    let crosses = |u: Point, v: Point| {
        let (p, q) = (turn(s, t, u, drop), turn(s, t, v, drop));
        let (r, w) = (turn(u, v, s, drop), turn(u, v, t, drop));
        // On one line they meet only if an end lies inside, which is asked for too.
        p * q <= 0.0 && r * w <= 0.0 && !(p == 0.0 && q == 0.0)
    };
    inside(s) || inside(t) || crosses(a, b) || crosses(b, c) || crosses(c, a)
}

/// The coordinate to leave out, so that the triangle keeps most of its area.
fn dropped(triangle: &Triangle) -> usize {
    let [a, b, c] = triangle.at;
    let n = hexfill_geometry::cross(sub(b, a), sub(c, a)).map(f64::abs);
    if n[0] >= n[1] && n[0] >= n[2] {
        0
    } else if n[1] >= n[2] {
        1
    } else {
        2
    }
}

/// Whether its corners lie on a line.
fn is_flat(triangle: &Triangle) -> bool {
    let [a, b, c] = triangle.at;
    (0..3).all(|drop| turn(a, b, c, drop) == 0.0)
}

/// The side of the plane a, b, c on which d lies: exact in sign.
fn side(a: Point, b: Point, c: Point, d: Point) -> f64 {
    let at = |[x, y, z]: Point| Coord3D { x, y, z };
    sign(robust::orient3d(at(a), at(b), at(c), at(d)))
}

/// The turn at b from a to c, without one coordinate: exact in sign.
fn turn(a: Point, b: Point, c: Point, drop: usize) -> f64 {
    let at = |p: Point| Coord { x: p[(drop + 1) % 3], y: p[(drop + 2) % 3] };
    sign(robust::orient2d(at(a), at(b), at(c)))
}

/// -1, 0 or 1: products of signs do not vanish.
fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::Random;

    fn triangles(all: &[[[f64; 3]; 3]]) -> Soup {
        let points: Vec<Point> = all.iter().flatten().copied().collect();
        let faces = (0..all.len() as u32).map(|t| vec![3 * t, 3 * t + 1, 3 * t + 2]).collect();
        Soup { points, faces }
    }

    fn cross_as(p: [[f64; 3]; 3], q: [[f64; 3]; 3]) -> bool {
        !crossings(&triangles(&[p, q]), 10).is_empty()
    }

    #[test]
    fn triangles_by_what_they_share() {
        let base = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
        // Through the middle, beside it, touching with a corner, above it.
        assert!(cross_as(base, [[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [9.0, 9.0, 1.0]]));
        assert!(!cross_as(base, [[3.0, 3.0, -1.0], [3.0, 3.0, 1.0], [9.0, 9.0, 1.0]]));
        assert!(cross_as(base, [[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [9.0, 9.0, 1.0]]));
        assert!(!cross_as(base, [[1.0, 1.0, 1e-12], [1.0, 1.0, 1.0], [9.0, 9.0, 1.0]]));
        // One corner in common: away, and back through it; in its plane, and over it.
        assert!(!cross_as(base, [[0.0, 0.0, 0.0], [-1.0, -1.0, 0.0], [-1.0, -1.0, 1.0]]));
        assert!(cross_as(base, [[0.0, 0.0, 0.0], [2.0, 2.0, -1.0], [2.0, 2.0, 3.0]]));
        assert!(cross_as(base, [[0.0, 0.0, 0.0], [1.0, 0.5, 0.0], [0.5, 1.0, 0.0]]));
        // An edge in common: a fold onto it, a sharp edge, a flat one.
        assert!(cross_as(base, [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [1.0, 1.0, 0.0]]));
        assert!(!cross_as(base, [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [1.0, 1.0, 1e-9]]));
        assert!(!cross_as(base, [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [1.0, -1.0, 0.0]]));
        // Two in one plane.
        assert!(cross_as(base, [[1.0, -1.0, 0.0], [1.0, 9.0, 0.0], [2.0, 9.0, 0.0]]));
        assert!(!cross_as(base, [[5.0, -1.0, 0.0], [5.0, 9.0, 0.0], [6.0, 9.0, 0.0]]));
    }

    #[test]
    fn neither_order_nor_scale_nor_turns_matter() {
        let mut random = Random::new(7);
        let mut coordinate = || random.below(5) as f64;
        for _ in 0..2000 {
            let mut corner = || [coordinate(), coordinate(), coordinate()];
            let (p, q) = ([corner(), corner(), corner()], [corner(), corner(), corner()]);
            let found = cross_as(p, q);
            assert_eq!(cross_as(q, p), found, "{p:?} {q:?}");
            assert_eq!(cross_as([p[1], p[2], p[0]], [q[2], q[1], q[0]]), found, "{p:?} {q:?}");
            let turned = |t: [Point; 3]| t.map(|[x, y, z]| [-y, z, x].map(|x| x * 2f64.powi(530)));
            assert_eq!(cross_as(turned(p), turned(q)), found, "{p:?} {q:?}");
            let tiny = |t: [Point; 3]| t.map(|p| p.map(|x| x * 2f64.powi(-1000)));
            assert_eq!(cross_as(tiny(p), tiny(q)), found, "{p:?} {q:?}");
        }
    }

    #[test]
    fn quads_that_turn_about_their_edge_through_each_other_fold() {
        // Along the edge from the origin to z = 1, each with a side at the bottom and one at the top, at these angles.
        let folds = |[a, b]: [f64; 2], [c, d]: [f64; 2]| {
            let at = |degrees: f64, z: f64| {
                let (y, x) = degrees.to_radians().sin_cos();
                [x, y, z]
            };
            let points = vec![[0.0; 3], [0.0, 0.0, 1.0], at(b, 1.0), at(a, 0.0), at(c, 0.0), at(d, 1.0)];
            // Wherever the second begins, whichever way round, and whichever comes first.
            let mut counts = Vec::new();
            for k in 0..4 {
                for mut second in [vec![1, 0, 4, 5], vec![5, 4, 0, 1]] {
                    second.rotate_left(k);
                    for faces in [vec![vec![0, 1, 2, 3], second.clone()], vec![second, vec![0, 1, 2, 3]]] {
                        counts.push(crossings(&Soup { points: points.clone(), faces }, 9).len());
                    }
                }
            }
            assert!(counts.iter().all(|&n| n == counts[0]), "{counts:?}");
            counts[0] > 0
        };
        assert!(folds([10.0, 80.0], [40.0, 50.0]));
        assert!(folds([-20.0, 30.0], [20.0, -30.0]));
        assert!(!folds([10.0, 30.0], [40.0, 50.0]), "a wedge");
        assert!(!folds([10.0, 80.0], [190.0, 230.0]), "they pass 180 degrees, where the surface is flat");
        assert!(!folds([0.0, 40.0], [0.0, 80.0]), "they meet at an end, and only there");
        assert!(!folds([100.0, 170.0], [-100.0, -10.0]));
    }

    #[test]
    fn a_bent_quad_crosses_only_what_it_crosses_however_cut() {
        // The diagonals pass at heights 0 and 1 over the middle.
        let points = vec![[0.0, 0.0, 0.0], [2.0, 0.0, 1.0], [2.0, 2.0, 0.0], [0.0, 2.0, 1.0]];
        let needle = |low: f64, high: f64| {
            let mut points = points.clone();
            points.extend([[1.0, 1.0, low], [1.0, 1.0, high], [1.5, 1.0, 10.0 * high - 9.0 * low]]);
            let soup = Soup { points, faces: vec![vec![0, 1, 2, 3], vec![4, 5, 6]] };
            crossings(&soup, 10)
        };
        assert_eq!(needle(-1.0, 2.0), [[0, 1]]);
        assert_eq!(needle(0.9, 2.0), Vec::<[u32; 2]>::new());
        assert_eq!(needle(0.5, 0.6), Vec::<[u32; 2]>::new());
    }
}
