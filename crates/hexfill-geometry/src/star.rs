//! A vertex star with several free edges: directions that make its worst corner good.
//!
//! Every corner is the determinant of three directions. [`climb_star`] climbs the soft minimum `-log(sum exp(-b s)) / b` of the corners s with growing
//! b from some starts, then turns one free edge at a time to its best direction (each is a program with a closed form, see
//! [`best_direction`]). What is returned is attained; that nothing is better is not claimed.
//! (`hexfill-embed` has the branch and bound that proves it.)
//!
//! Source: ours; with one free edge a turn is Wolfe 1976.

use crate::direction::best_direction;
use crate::vector::{Vector, add, add_scaled, cross, det, dot, norm, scale, unit};
use hexfill_mesh::Random;

/// An edge of a star: of given unit direction, or free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ray {
    /// A given unit direction.
    Fixed(Vector),
    /// The free edge of this number.
    Free(usize),
}

/// Directions found for the free edges of a star.
#[derive(Clone, Debug, PartialEq)]
pub struct Reached {
    /// The worst corner at these directions: a scaled Jacobian. At most 1, also if there is no corner.
    pub value: f64,
    /// One unit vector a free edge.
    pub directions: Vec<Vector>,
}

/// Starts tried.
const STARTS: usize = 4;

/// What the corners with at most one free edge allow: no directions make the worst corner better. At most 1.
pub fn star_bound(corners: &[[Ray; 3]], n_free: usize) -> f64 {
    singles(&Star { corners, n_free }).0
}

/// [`star_bound`], and the directions that reach it, for free edges that are the only free one of some corner.
fn singles(star: &Star<'_>) -> (f64, Vec<Option<Vector>>) {
    let all_fixed = |corner: &&[Ray; 3]| corner.iter().all(|r| matches!(r, Ray::Fixed(_)));
    let mut least = star.corners.iter().filter(all_fixed).map(|corner| Star::corner(corner, &[])).fold(1.0, f64::min);
    let mut first = vec![None; star.n_free];
    for (j, slot) in first.iter_mut().enumerate() {
        let normals = star.normals_of_single(j);
        if !normals.is_empty() {
            let best = best_direction(&normals);
            least = least.min(best.value);
            *slot = Some(best.direction);
        }
    }
    (least, first)
}

/// Good directions for the `n_free` free edges of a star with these corners, right-handed triples of different rays. Exact if
/// no corner has two free edges; else a local optimum, the best of some starts, or the first that reaches `enough`. Deterministic.
pub fn climb_star(corners: &[[Ray; 3]], n_free: usize, enough: f64) -> Reached {
    let star = Star { corners, n_free };
    let (least, first) = singles(&star);
    let several = corners.iter().any(|c| c.iter().filter(|r| matches!(r, Ray::Free(_))).count() > 1);
    if !several {
        let directions = first.into_iter().map(|d| d.unwrap_or([0.0, 0.0, 1.0])).collect();
        return Reached { value: least, directions };
    }
    let first = star.relax(&first);
    // Two starts that are no guess (from the best directions of corners with one free edge, and from none), then
    // shaken copies of both.
    let none = star.relax(&vec![None; n_free]);
    let mut random = Random::new(17);
    let mut best = Reached { value: f64::NEG_INFINITY, directions: first.clone() };
    let mut values = vec![0.0; corners.len()];
    for start in 0..STARTS {
        let from = if start % 2 == 0 { &first } else { &none };
        let shake = if start < 2 { 0.0 } else { 0.6 };
        let mut u: Vec<Vector> = from
            .iter()
            .map(|&d| {
                let noise: Vector = std::array::from_fn(|_| 2.0 * random.unit() - 1.0);
                unit(add_scaled(d, shake, noise)).unwrap_or(d)
            })
            .collect();
        star.climb(&mut u, &mut values);
        let value = star.worst(&u);
        if value > best.value {
            best = Reached { value, directions: u };
        }
        // Corners with one free edge bound the star: there is nothing above.
        if best.value > least - 1e-3 || best.value >= enough {
            break;
        }
    }
    best
}

struct Star<'a> {
    corners: &'a [[Ray; 3]],
    n_free: usize,
}

impl Star<'_> {
    fn columns(corner: &[Ray; 3], u: &[Vector]) -> [Vector; 3] {
        corner.map(|ray| match ray {
            Ray::Fixed(d) => d,
            Ray::Free(j) => u[j],
        })
    }

    fn corner(corner: &[Ray; 3], u: &[Vector]) -> f64 {
        let [a, b, c] = Self::columns(corner, u);
        det(a, b, c)
    }

    fn worst(&self, u: &[Vector]) -> f64 {
        self.corners.iter().map(|corner| Self::corner(corner, u)).fold(1.0, f64::min)
    }

    /// Normals of the corners in which the free edge `j` is the only one.
    fn normals_of_single(&self, j: usize) -> Vec<Vector> {
        self.corners
            .iter()
            .filter_map(|corner| {
                let at = corner.iter().position(|&r| r == Ray::Free(j))?;
                match (corner[(at + 1) % 3], corner[(at + 2) % 3]) {
                    (Ray::Fixed(a), Ray::Fixed(b)) => Some(cross(a, b)),
                    _ => None,
                }
            })
            .collect()
    }

    /// The given directions; the others at the mean of the edges they share corners with.
    fn relax(&self, given: &[Option<Vector>]) -> Vec<Vector> {
        let mut u: Vec<Vector> = given.iter().map(|d| d.unwrap_or([0.0; 3])).collect();
        for _ in 0..20 {
            let mut sums = vec![[0.0; 3]; self.n_free];
            for corner in self.corners {
                let columns = Self::columns(corner, &u);
                for (k, ray) in corner.iter().enumerate() {
                    if let Ray::Free(j) = *ray {
                        sums[j] = add(sums[j], add(columns[(k + 1) % 3], columns[(k + 2) % 3]));
                        // Where the fixed edges lie in a plane, their normal leads inside.
                        sums[j] = add(sums[j], cross(columns[(k + 1) % 3], columns[(k + 2) % 3]));
                    }
                }
            }
            for (j, sum) in sums.into_iter().enumerate() {
                if given[j].is_none() {
                    u[j] = unit(sum).unwrap_or([0.0, 0.0, 1.0]);
                }
            }
        }
        u
    }

    /// The soft minimum and, if asked for, its gradient; `values` takes the corners.
    fn soft(&self, u: &[Vector], b: f64, values: &mut [f64], gradient: Option<&mut [Vector]>) -> f64 {
        for (value, corner) in values.iter_mut().zip(self.corners) {
            *value = Self::corner(corner, u);
        }
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let sum: f64 = values.iter().map(|s| (-b * (s - least)).exp()).sum();
        if let Some(gradient) = gradient {
            gradient.fill([0.0; 3]);
            for (corner, s) in self.corners.iter().zip(values.iter()) {
                let weight = (-b * (s - least)).exp() / sum;
                if weight < 1e-9 {
                    continue;
                }
                let columns = Self::columns(corner, u);
                for (k, ray) in corner.iter().enumerate() {
                    if let Ray::Free(j) = *ray {
                        let normal = cross(columns[(k + 1) % 3], columns[(k + 2) % 3]);
                        gradient[j] = add_scaled(gradient[j], weight, normal);
                    }
                }
            }
        }
        least - sum.ln() / b
    }

    fn climb(&self, u: &mut Vec<Vector>, values: &mut [f64]) {
        let mut gradient = vec![[0.0; 3]; self.n_free];
        // The soft minimum is smooth and at most log(n) / b below the true one: small b first, to get past kinks,
        // then more and more exact.
        let mut b = 6.0;
        let mut step: f64 = 0.5;
        while b < 3000.0 {
            let mut value = self.soft(u, b, values, None);
            for _ in 0..15 {
                self.soft(u, b, values, Some(&mut gradient));
                for (g, &d) in gradient.iter_mut().zip(u.iter()) {
                    // Directions stay on the sphere, so only the part of the gradient along it counts.
                    *g = add_scaled(*g, -dot(*g, d), d);
                }
                let size = gradient.iter().map(|&g| norm(g)).fold(0.0, f64::max);
                if size < 1e-9 {
                    break;
                }
                let moved: Vec<Vector> =
                    u.iter().zip(&gradient).map(|(&d, &g)| unit(add(d, scale(step / size, g))).unwrap_or(d)).collect();
                let reached = self.soft(&moved, b, values, None);
                if reached > value {
                    (*u, value) = (moved, reached);
                    step = (1.4 * step).min(0.7);
                } else {
                    step *= 0.4;
                    if step < 1e-7 {
                        break;
                    }
                }
            }
            b *= 3.0;
            step = step.max(0.3 / b);
        }
        // One edge at a time has a closed form: this takes off what the soft minimum left.
        for _ in 0..3 {
            for j in 0..self.n_free {
                let normals: Vec<Vector> = self
                    .corners
                    .iter()
                    .filter_map(|corner| {
                        let at = corner.iter().position(|&r| r == Ray::Free(j))?;
                        let columns = Self::columns(corner, u);
                        Some(cross(columns[(at + 1) % 3], columns[(at + 2) % 3]))
                    })
                    .collect();
                if !normals.is_empty() {
                    let before = (self.worst(u), u[j]);
                    u[j] = best_direction(&normals).direction;
                    if self.worst(u) < before.0 {
                        u[j] = before.1;
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_free_edges_in_the_quarter_space_under_a_roof() {
        // The octant cut by one free edge: three equal corners, 1 / sqrt 3.
        let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Ray::Fixed);
        let one = climb_star(&[[x, y, Ray::Free(0)], [y, z, Ray::Free(0)], [z, x, Ray::Free(0)]], 1, 1.0);
        assert!((one.value - 1.0 / 3f64.sqrt()).abs() < 1e-12);
        // Two octants side by side, with a free edge where they meet and one free edge inside: nothing is lost by freeing z.
        let m = Ray::Fixed([-1.0, 0.0, 0.0]);
        let two = climb_star(&[[x, y, Ray::Free(0)], [y, m, Ray::Free(0)]], 1, 1.0);
        assert!((two.value - 1.0).abs() < 1e-12);
        let free = climb_star(
            &[[x, y, Ray::Free(0)], [y, Ray::Free(1), Ray::Free(0)], [Ray::Free(1), x, Ray::Free(0)]],
            2,
            1.0,
        );
        // Angles of 90, 135 and 135 degrees round an upright edge.
        assert!((free.value - 0.5f64.sqrt()).abs() < 1e-6, "{}", free.value);
        let worst = det([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], free.directions[0]);
        assert!(free.value <= worst + 1e-12);
    }
}
