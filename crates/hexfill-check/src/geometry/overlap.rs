//! Does the mesh overlap itself? Asked for separately, because it costs more than all levels.
//!
//! If det J > 0 everywhere, the map of a connected mesh is a local homeomorphism inside, and if it is moreover injective on the
//! boundary it is injective: the number of preimages of a point off the boundary's image is its winding number, which for
//! disjoint embedded closed surfaces bounding a connected piece is 0 or 1. A single boundary quad is injective where det J > 0
//! (a bilinear patch is planar and convex, or a graph over a plane). So it is enough to show that two boundary quads meet only
//! in their common vertices.
//!
//! A bilinear patch lies in the convex hull of its four corners. Two quads are *separated* if a plane strictly separates the
//! hulls (quads without a common vertex; they are cut into quarters where needed), or a plane through the common vertex or edge
//! has the remaining corners strictly on different sides. The plane is sought by Gilbert's algorithm for the point of least
//! norm of a convex hull, and checked with an error bound. What is not separated is not proved to overlap.
//!
//! Source: ours; Gilbert 1966 for the plane between two hulls.

use super::bernstein::{UNIT, Vector, dot, norm};
use crate::parallel::tasks;
use crate::topology::boundary_quad::BoundaryQuad;
use hexfill_mesh::Context;
use serde::Serialize;

/// What the overlap test found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Overlap {
    /// Pairs of boundary quads whose bounding boxes meet.
    pub pairs: u64,
    /// Pairs that could not be shown to meet only in common vertices.
    pub not_separated: u64,
    /// The first of them, at most ten, as vertex cycles.
    pub first: Vec<[[u32; 4]; 2]>,
    /// Whether the map of the whole mesh is proved injective: det J > 0 everywhere, one part, all pairs separated.
    pub injective: bool,
}

const MAX_STEPS: usize = 200;
/// Separation tests for one pair of quads without a common vertex.
const MAX_TESTS: usize = 3000;

fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn scaled(a: Vector, s: f64) -> Vector {
    a.map(|x| x * s)
}

/// A direction n with `n . w > error |n|` for all w, found by stepping towards the point of least norm of their hull.
/// `error` bounds the rounding of the vectors and of the dot products; a shorter n would be rounding itself.
fn separates(w: &[Vector], error: f64) -> bool {
    let Some(&first) = w.first() else { return false };
    let mut n = first;
    for _ in 0..MAX_STEPS {
        let length = norm(n);
        if !length.is_normal() {
            return false;
        }
        let (mut least, mut at) = (f64::INFINITY, first);
        for &x in w {
            let d = dot(n, x);
            if d < least {
                (least, at) = (d, x);
            }
        }
        if least > error * length && length > error {
            return true;
        }
        // The nearest point to the origin on the segment from n to the extreme vector.
        let step = minus(at, n);
        let square = dot(step, step);
        let t = if square > 0.0 { (-dot(n, step) / square).clamp(0.0, 1.0) } else { 0.0 };
        if t == 0.0 {
            return false;
        }
        n = std::array::from_fn(|k| n[k] + t * step[k]);
    }
    false
}

fn unit(v: Vector) -> Vector {
    let n = norm(v);
    if n > 0.0 { scaled(v, 1.0 / n) } else { v }
}

type Patch = [Vector; 4];

/// Quads without a common vertex: hulls apart, after cutting into quarters where needed. `depth` of cuts made so far.
fn apart(p: &Patch, q: &Patch, depth: u32, size: f64, tests: &mut usize) -> bool {
    *tests += 1;
    // Corners of quarters are rounded by at most `2 depth u size`; differences and dot products by a few u more.
    let error = f64::from(16 + 8 * depth) * UNIT * size;
    let w: Vec<Vector> = p.iter().flat_map(|&a| q.iter().map(move |&b| minus(a, b))).collect();
    if separates(&w, error) {
        return true;
    }
    if depth >= 6 || *tests >= MAX_TESTS {
        return false;
    }
    let (ps, qs) = (quarters(p), quarters(q));
    ps.iter().all(|a| qs.iter().all(|b| apart(a, b, depth + 1, size, tests)))
}

/// The four quarters of a bilinear patch.
fn quarters(p: &Patch) -> [Patch; 4] {
    let middle = |a: Vector, b: Vector| std::array::from_fn(|k| 0.5 * (a[k] + b[k]));
    let sides: Patch = std::array::from_fn(|i| middle(p[i], p[(i + 1) % 4]));
    let centre = middle(sides[0], sides[2]);
    std::array::from_fn(|i| [p[i], sides[i], centre, sides[(i + 3) % 4]])
}

/// Whether two boundary quads are shown to meet only in their common vertices.
fn separated(a: &[u32; 4], b: &[u32; 4], points: &[Vector]) -> bool {
    let at = |v: u32| points[v as usize];
    let common: Vec<u32> = a.iter().copied().filter(|v| b.contains(v)).collect();
    let rest = |quad: &[u32; 4]| quad.iter().copied().filter(|v| !common.contains(v)).collect::<Vec<_>>();
    let (p, q) = (a.map(at), b.map(at));
    match common[..] {
        [] => {
            // The error of a coordinate difference is relative to the coordinates and not to the difference.
            let size = p.iter().chain(&q).flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
            apart(&p, &q, 0, size, &mut 0)
        }
        [v] => {
            let up = rest(a).into_iter().map(|x| unit(minus(at(x), at(v))));
            let down = rest(b).into_iter().map(|x| unit(minus(at(v), at(x))));
            separates(&up.chain(down).collect::<Vec<_>>(), 32.0 * UNIT)
        }
        [u, v] => {
            // In the plane across the common edge; that plane's own rounding is covered by the error.
            let e = unit(minus(at(v), at(u)));
            let across = |d: Vector| {
                let along = dot(d, e);
                unit(std::array::from_fn(|k| d[k] - along * e[k]))
            };
            // Nearly parallel to the edge: the direction across is not known well enough.
            let flat = rest(a).iter().chain(&rest(b)).any(|&x| {
                let d = unit(minus(at(x), at(u)));
                let along = dot(d, e);
                1.0 - along * along < 1e-8
            });
            let up = rest(a).into_iter().map(|x| across(minus(at(x), at(u))));
            let down = rest(b).into_iter().map(|x| scaled(across(minus(at(x), at(u))), -1.0));
            !flat && separates(&up.chain(down).collect::<Vec<_>>(), 1e-10)
        }
        _ => false,
    }
}

/// Tests all pairs of boundary quads whose bounding boxes meet. `None` if it was stopped.
pub(crate) fn overlap(
    boundary: &[BoundaryQuad],
    points: &[Vector],
    valid_and_one_part: bool,
    ctx: &Context<'_>,
) -> Option<Overlap> {
    let mut boxes: Vec<([Vector; 2], u32)> = boundary
        .iter()
        .enumerate()
        .map(|(i, quad)| {
            let corners = quad.cycle.map(|v| points[v as usize]);
            let low = std::array::from_fn(|k| corners.iter().fold(f64::INFINITY, |m, c| m.min(c[k])));
            let high = std::array::from_fn(|k| corners.iter().fold(f64::NEG_INFINITY, |m, c| m.max(c[k])));
            ([low, high], i as u32)
        })
        .collect();
    // Sweep along x: only quads whose boxes begin before this one ends can meet it. Simple, and linear in practice
    // for surfaces, whose quads are small; a tree would only help where many quads stand one behind the other.
    boxes.sort_by(|a, b| a.0[0][0].total_cmp(&b.0[0][0]).then(a.1.cmp(&b.1)));
    let (mut pairs, mut bad) = (0, Vec::new());
    for first in (0..boxes.len()).step_by(4096) {
        if ctx.stop().is_some() {
            return None;
        }
        ctx.report("check overlap", first as u64, Some(boxes.len() as u64), String::new);
        let found: Vec<(u64, Vec<[u32; 2]>)> = tasks(4096.min(boxes.len() - first), |i| {
            let i = first + i;
            let ([low, high], one) = boxes[i];
            let (mut met, mut bad) = (0, Vec::new());
            for &([other_low, other_high], two) in boxes[i + 1..].iter().take_while(|b| b.0[0][0] <= high[0]) {
                if (1..3).all(|k| other_low[k] <= high[k] && low[k] <= other_high[k]) {
                    met += 1;
                    let (a, b) = (boundary[one as usize].cycle, boundary[two as usize].cycle);
                    if !separated(&a, &b, points) {
                        bad.push([one.min(two), one.max(two)]);
                    }
                }
            }
            (met, bad)
        });
        for (met, some) in found {
            pairs += met;
            bad.extend(some);
        }
    }
    bad.sort_unstable();
    let first = bad.iter().take(10).map(|pair| pair.map(|i| boundary[i as usize].cycle)).collect();
    Some(Overlap { pairs, not_separated: bad.len() as u64, first, injective: valid_and_one_part && bad.is_empty() })
}
