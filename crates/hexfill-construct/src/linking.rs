//! Which loops of an embedded surface bound inside: linking numbers with loops pushed outside.
//!
//! By Alexander duality a loop of the boundary of a domain in R^3 is null-homologous in the domain iff its linking number
//! with every loop of the boundary, pushed outward, is 0 (mod 2 for Z/2-homology). So the matrix of linking numbers of
//! 2 g basis loops with their pushed copies tells the interior's homology without one tetrahedron.
//! The numbers come from Gauss's integral in closed form for straight segments (Klenin and Langowski 2000), rounded;
//! they are believed only if they are near whole numbers and the matrix has what theory demands: L - L^T, the
//! intersection form, is invertible over Z (checked modulo 2 and modulo an odd prime).

use crate::darts::{Darts, TreeCotree, tree_cotree};
use crate::vector::{Point, cross, dot, sub};
use hexfill_mesh::{Context, StopReason};

/// Basis loops and their linking numbers: `numbers[i][j]` is that of loop `i` with loop `j` pushed outward.
pub(crate) struct Linking {
    pub trees: TreeCotree,
    pub loops: Vec<Vec<u32>>,
    pub numbers: Vec<Vec<i64>>,
}

fn unit(a: Point) -> Option<Point> {
    let n = dot(a, a).sqrt();
    (n > 0.0 && n.is_finite()).then(|| a.map(|x| x / n))
}

/// Gauss's integral over two segments, in units of 4 pi: the signed area of the sphere they see each other in.
fn gauss(a: Point, b: Point, c: Point, d: Point) -> f64 {
    let (r13, r14, r23, r24) = (sub(c, a), sub(d, a), sub(c, b), sub(d, b));
    let n = [cross(r13, r14), cross(r14, r24), cross(r24, r23), cross(r23, r13)].map(unit);
    let [Some(n1), Some(n2), Some(n3), Some(n4)] = n else { return 0.0 };
    let asin = |x: f64| x.clamp(-1.0, 1.0).asin();
    let area = asin(dot(n1, n2)) + asin(dot(n2, n3)) + asin(dot(n3, n4)) + asin(dot(n4, n1));
    let sign = dot(cross(sub(d, c), sub(b, a)), r13);
    if sign == 0.0 { 0.0 } else { area * sign.signum() / (4.0 * std::f64::consts::PI) }
}

/// Why there are no linking numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) enum LinkingError {
    /// The positions do not tell.
    Undecided(&'static str),
    /// The work was told to stop.
    Stopped(StopReason),
}

use LinkingError::Undecided as failed;

/// Basis loops of the surface and their linking numbers.
///
/// # Errors
/// [`LinkingError`] if the positions do not tell (degenerate or self-intersecting surface), or told to stop.
pub(crate) fn linking(s: &Darts, points: &[Point], ctx: &Context<'_>) -> Result<Linking, LinkingError> {
    if points.len() < s.n_vertices || points.iter().flatten().any(|x| !x.is_finite()) {
        return Err(failed("the positions are missing or not finite"));
    }
    let trees = tree_cotree(s);
    let loops: Vec<Vec<u32>> = trees.left.iter().map(|&d| trees.fundamental_loop(s, d)).collect();
    let at = |v: u32| points[v as usize];
    let mut pushed: Vec<Vec<Point>> = Vec::new();
    for l in &loops {
        pushed.push(push(s, points, l).ok_or(failed("a face has no normal"))?);
    }
    let mut numbers = vec![vec![0i64; loops.len()]; loops.len()];
    for (i, l) in loops.iter().enumerate() {
        for (j, line) in pushed.iter().enumerate() {
            if let Some(reason) = ctx.stop() {
                return Err(LinkingError::Stopped(reason));
            }
            let mut sum = 0.0;
            for &d in l {
                let (a, b) = (at(s.origin[d as usize]), at(s.target(d)));
                for k in 0..line.len() {
                    sum += gauss(a, b, line[k], line[(k + 1) % line.len()]);
                }
            }
            if (sum - sum.round()).abs() > 0.05 {
                return Err(failed("linking numbers are not whole: the surface is degenerate or meets itself"));
            }
            numbers[i][j] = sum.round() as i64;
        }
    }
    let n = loops.len();
    let form: Vec<Vec<i64>> = (0..n).map(|i| (0..n).map(|j| numbers[i][j] - numbers[j][i]).collect()).collect();
    for p in [2, 1_000_003] {
        if rank(&form, p) != n {
            return Err(failed("linking numbers contradict the intersections of loops: the surface meets itself"));
        }
        if 2 * rank(&numbers, p) != n {
            return Err(failed("linking numbers contradict Alexander duality: the surface meets itself"));
        }
    }
    Ok(Linking { trees, loops, numbers })
}

/// The loop pushed outward: over the faces on its left, and over the edges between them round its vertices. Vertex normals
/// would not do: at a saddle they may lie in the surface.
fn push(s: &Darts, points: &[Point], path: &[u32]) -> Option<Vec<Point>> {
    let at = |v: u32| points[v as usize];
    let ends = |d: u32| (at(s.origin[d as usize]), at(s.target(d)));
    // Corner of a face at the origin of a dart: both its sides, and the normal (of the whole face where the corner is straight).
    let sides = |d: u32| {
        let mut last = d;
        while s.next(last) != d {
            last = s.next(last);
        }
        let (here, there) = ends(d);
        (sub(there, here), sub(at(s.origin[last as usize]), here))
    };
    let normal = |d: u32| {
        let (first, mut e, mut sum) = (s.face(d) * s.k, s.face(d) * s.k, [0.0; 3]);
        while e < first + s.k {
            let (a, b) = sides(e);
            let n = cross(a, b);
            sum = [sum[0] + n[0], sum[1] + n[1], sum[2] + n[2]];
            e += 1;
        }
        unit(sum)
    };
    let along = |p: Point, parts: [(f64, Point); 2]| -> Point {
        std::array::from_fn(|c| p[c] + parts[0].0 * parts[0].1[c] + parts[1].0 * parts[1].1[c])
    };
    let length = |a: Point| dot(a, a).sqrt();
    // Over the corner of a face at the origin of `d`.
    let over_corner = |d: u32| {
        let (a, b) = sides(d);
        let scale = 1e-2 * length(a).min(length(b));
        let n = normal(d)?;
        // Left of the side that leaves and of the side that comes; right at straight and at reflex corners as well.
        let (u, w) = (cross(n, unit(a)?), cross(unit(b)?, n));
        let inward = unit([u[0] + w[0], u[1] + w[1], u[2] + w[2]])?;
        Some(along(at(s.origin[d as usize]), [(scale, inward), (1e-2 * scale, n)]))
    };
    // Over the edge of `d`, near its origin.
    let over_edge = |d: u32| {
        let (a, b) = ends(d);
        let (m, n) = (normal(d)?, normal(s.twin[d as usize])?);
        let up = unit([m[0] + n[0], m[1] + n[1], m[2] + n[2]])?;
        Some(along(a, [(1e-2, sub(b, a)), (1e-4 * length(sub(b, a)), up)]))
    };
    let mut line = Vec::new();
    for (k, &d) in path.iter().enumerate() {
        let out = path[(k + 1) % path.len()];
        // Round the target of `d`, through the faces on the left.
        let mut at = s.next(d);
        line.push(over_corner(at)?);
        while at != out {
            line.push(over_edge(at)?);
            at = s.next(s.twin[at as usize]);
            line.push(over_corner(at)?);
        }
    }
    Some(line)
}

/// Rank modulo a prime.
fn rank(matrix: &[Vec<i64>], p: i64) -> usize {
    let mut m: Vec<Vec<i64>> = matrix.iter().map(|r| r.iter().map(|x| x.rem_euclid(p)).collect()).collect();
    let columns = matrix.first().map_or(0, Vec::len);
    let mut rank = 0;
    for c in 0..columns {
        let Some(pivot) = (rank..m.len()).find(|&r| m[r][c] != 0) else { continue };
        m.swap(rank, pivot);
        let inverse = power(m[rank][c], p - 2, p);
        let row: Vec<i64> = m[rank].iter().map(|x| x * inverse % p).collect();
        for other in m.iter_mut().skip(rank + 1) {
            let factor = other[c];
            for (x, y) in other.iter_mut().zip(&row) {
                *x = (*x - factor * y).rem_euclid(p);
            }
        }
        m[rank] = row;
        rank += 1;
    }
    rank
}

fn power(mut base: i64, mut exponent: i64, p: i64) -> i64 {
    let mut result = 1;
    while exponent > 0 {
        if exponent & 1 == 1 {
            result = result * base % p;
        }
        base = base * base % p;
        exponent >>= 1;
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linked_squares_have_linking_number_one() {
        let a = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]];
        let b = |x: f64| [[x, 1.0, -1.0], [x + 2.0, 1.0, -1.0], [x + 2.0, 1.0, 1.0], [x, 1.0, 1.0]];
        let number = |b: [Point; 4]| -> f64 {
            (0..4)
                .flat_map(|i| (0..4).map(move |j| (i, j)))
                .map(|(i, j)| gauss(a[i], a[(i + 1) % 4], b[j], b[(j + 1) % 4]))
                .sum()
        };
        assert!((number(b(1.0)).abs() - 1.0).abs() < 1e-12);
        assert!(number(b(5.0)).abs() < 1e-12);
    }
}
