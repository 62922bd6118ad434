//! Which loops of an embedded surface bound inside: linking numbers with loops pushed outside.
//!
//! By Alexander duality a loop of the boundary of a domain in R^3 is null-homologous in the domain iff its linking number
//! with every loop of the boundary, pushed outward, is 0 (mod 2 for Z/2-homology). So the matrix of linking numbers of
//! 2 g basis loops with their pushed copies tells the interior's homology without one tetrahedron.
//! The numbers come from Gauss's integral in closed form for straight segments (Klenin and Langowski 2000), rounded;
//! they are believed only if they are near whole numbers and the matrix has what theory demands: L - L^T, the
//! intersection form, is invertible over Z (checked modulo 2 and modulo an odd prime).
//!
//! Source: Klenin and Langowski 2000, method 1a (the integral), Hatcher 2002, theorem 3.44 (Alexander duality); the test of the matrix is ours.

use super::polygons::{DartId, Darts, TreeCotree, tree_cotree, tree_loop};
use crate::missing::MissingInterior;
use hexfill_geometry::{Vector, add, add_scaled, cross, dot, norm, sub, unit};
use hexfill_mesh::{Context, StopReason, VertexId};

/// Basis loops and their linking numbers: `numbers[i][j]` is that of loop `i` with loop `j` pushed outward.
pub(crate) struct Linking {
    pub(crate) trees: TreeCotree,
    pub(crate) loops: Vec<Vec<DartId>>,
    pub(crate) numbers: Vec<Vec<i64>>,
}

/// Gauss's integral over two segments, in units of 4 pi: the signed area of the sphere they see each other in.
fn gauss(a: Vector, b: Vector, c: Vector, d: Vector) -> f64 {
    let (r13, r14, r23, r24) = (sub(c, a), sub(d, a), sub(c, b), sub(d, b));
    let n = [cross(r13, r14), cross(r14, r24), cross(r24, r23), cross(r23, r13)].map(unit);
    // An end of one segment in line with the other: all four ends lie in a plane, and the segments see each other in
    // no area.
    let [Some(n1), Some(n2), Some(n3), Some(n4)] = n else { return 0.0 };
    let asin = |x: f64| x.clamp(-1.0, 1.0).asin();
    let area = asin(dot(n1, n2)) + asin(dot(n2, n3)) + asin(dot(n3, n4)) + asin(dot(n4, n1));
    let sign = dot(cross(sub(d, c), sub(b, a)), r13);
    if sign == 0.0 { 0.0 } else { area * sign.signum() / (4.0 * std::f64::consts::PI) }
}

/// Why there are no linking numbers.
#[derive(Clone, Debug)]
pub(crate) enum LinkingError {
    /// The positions do not tell.
    Undecided(MissingInterior),
    /// The work was told to stop.
    Stopped(StopReason),
}

use LinkingError::Undecided as failed;

/// Basis loops of the surface and their linking numbers.
///
/// # Errors
/// [`LinkingError`] if the positions do not tell (degenerate or self-intersecting surface), or told to stop.
pub(crate) fn linking(s: &Darts, points: &[Vector], ctx: &Context<'_>) -> Result<Linking, LinkingError> {
    if points.len() < s.n_vertices || points.iter().flatten().any(|x| !x.is_finite()) {
        return Err(failed(MissingInterior::PositionsMissing));
    }
    let trees = tree_cotree(s);
    let loops: Vec<Vec<DartId>> = trees.left.iter().map(|&d| tree_loop(s, &trees.parent, d)).collect();
    let at = |v: VertexId| points[v.index()];
    let mut pushed: Vec<Vec<Vector>> = Vec::new();
    for l in &loops {
        pushed.push(push(s, points, l).ok_or(failed(MissingInterior::FaceWithoutNormal))?);
    }
    let mut numbers = vec![vec![0i64; loops.len()]; loops.len()];
    for (i, l) in loops.iter().enumerate() {
        for (j, line) in pushed.iter().enumerate() {
            if let Some(reason) = ctx.stop() {
                return Err(LinkingError::Stopped(reason));
            }
            let mut sum = 0.0;
            for &d in l {
                let (a, b) = (at(s.origin[d]), at(s.target(d)));
                for k in 0..line.len() {
                    sum += gauss(a, b, line[k], line[(k + 1) % line.len()]);
                }
            }
            // Gauss's integral of two loops that stay apart is a whole number. Far from one, the loops touch or
            // nearly do: then nothing here may be believed, and that is said rather than guessed.
            if (sum - sum.round()).abs() > 0.05 {
                return Err(failed(MissingInterior::LinkingNotWhole));
            }
            numbers[i][j] = sum.round() as i64;
        }
    }
    let n = loops.len();
    let form: Vec<Vec<i64>> = (0..n).map(|i| (0..n).map(|j| numbers[i][j] - numbers[j][i]).collect()).collect();
    // Over the rationals a rank is at least that modulo a prime: two primes, one of which the answer is about, catch
    // what rounding may have spoilt.
    for p in [2, 1_000_003] {
        if rank(&form, p) != n {
            return Err(failed(MissingInterior::LinkingAgainstIntersections));
        }
        if 2 * rank(&numbers, p) != n {
            return Err(failed(MissingInterior::LinkingAgainstDuality));
        }
    }
    Ok(Linking { trees, loops, numbers })
}

/// Near the surface, on its outside.
struct Outside<'a> {
    s: &'a Darts,
    points: &'a [Vector],
}

impl Outside<'_> {
    fn at(&self, v: VertexId) -> Vector {
        self.points[v.index()]
    }

    fn ends(&self, d: DartId) -> (Vector, Vector) {
        (self.at(self.s.origin[d]), self.at(self.s.target(d)))
    }

    /// Both sides of the corner of a polygon at the origin of a dart.
    fn sides(&self, d: DartId) -> (Vector, Vector) {
        let mut last = d;
        while self.s.next(last) != d {
            last = self.s.next(last);
        }
        let (here, there) = self.ends(d);
        (sub(there, here), sub(self.at(self.s.origin[last]), here))
    }

    /// Of the whole polygon: a corner may be straight.
    fn normal(&self, d: DartId) -> Option<Vector> {
        let corner = |e: DartId| {
            let (a, b) = self.sides(e);
            cross(a, b)
        };
        unit(self.s.sides(self.s.gon(d)).map(corner).fold([0.0; 3], add))
    }

    /// Over the corner of a polygon at the origin of `d`.
    fn over_corner(&self, d: DartId) -> Option<Vector> {
        let (a, b) = self.sides(d);
        let scale = 1e-2 * norm(a).min(norm(b));
        let n = self.normal(d)?;
        // Left of the side that leaves and of the side that comes; right at straight and at reflex corners as well.
        let inward = unit(add(cross(n, unit(a)?), cross(unit(b)?, n)))?;
        Some(add_scaled(add_scaled(self.at(self.s.origin[d]), scale, inward), 1e-2 * scale, n))
    }

    /// Over the edge of `d`, near its origin.
    fn over_edge(&self, d: DartId) -> Option<Vector> {
        let (a, b) = self.ends(d);
        let up = unit(add(self.normal(d)?, self.normal(self.s.twin[d])?))?;
        let along = sub(b, a);
        Some(add_scaled(add_scaled(a, 1e-2, along), 1e-4 * norm(along), up))
    }
}

/// The loop pushed outward: over the polygons on its left, and over the edges between them round its vertices. Vertex normals
/// would not do: at a saddle they may lie in the surface.
fn push(s: &Darts, points: &[Vector], path: &[DartId]) -> Option<Vec<Vector>> {
    let outside = Outside { s, points };
    let mut line = Vec::new();
    for (k, &d) in path.iter().enumerate() {
        let out = path[(k + 1) % path.len()];
        // Round the target of `d`, through the polygons on the left.
        let mut at = s.next(d);
        line.push(outside.over_corner(at)?);
        while at != out {
            line.push(outside.over_edge(at)?);
            at = s.next(s.twin[at]);
            line.push(outside.over_corner(at)?);
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

/// `base` to the `exponent` modulo `p`.
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
        let number = |b: [Vector; 4]| -> f64 {
            (0..4)
                .flat_map(|i| (0..4).map(move |j| (i, j)))
                .map(|(i, j)| gauss(a[i], a[(i + 1) % 4], b[j], b[(j + 1) % 4]))
                .sum()
        };
        assert!((number(b(1.0)).abs() - 1.0).abs() < 1e-12);
        assert!(number(b(5.0)).abs() < 1e-12);
    }
}
