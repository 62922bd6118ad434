//! Vertex-star upper bounds: what no placement of the interior vertices can beat.
//!
//! Keep a boundary vertex and the directions of its fixed edges, and let every other edge at it point anywhere. The best
//! possible worst corner there bounds the scaled Jacobian of the whole mesh. A corner with no free edge is a number;
//! corners with exactly one free edge u are linear in it, `u . n` with n the cross product of the two fixed unit edges, and
//! the maximum over unit u of the minimum over the corners round u is found in closed form
//! ([`hexfill_geometry::best_direction`]). Leaving corners out can only
//! raise a bound, so corners with two or three free edges may wait: [`refine`] takes them in by branch and bound
//! ([`crate::star_search`]) where that can lower the least bound of the mesh.
//!
//! A second bound counts angles. In a valid mesh of a surface that does not cross itself the corners at a boundary vertex tile its solid angle, and
//! those at a boundary edge its dihedral angle. So some corner has at most the mean of either: see [`angle_bound`].

use crate::problem::{FIXED, Problem};
use crate::star_search::{Directions, SETTLED};
use crate::vector::{Vector, cross, dot, sub, unit};
use hexfill_geometry::{Ray, best_direction, dihedral_angle};
use hexfill_mesh::cube::CORNER_NEIGHBOURS;
use hexfill_mesh::{Context, VertexId};
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;

/// Stars whose free edges are placed, at most; the others keep the bound of their corners with at most one free edge.
const MOST_STARS: usize = 1000;

/// Nodes of branch and bound a star gets.
const NODES: usize = 300;

/// Stars searched to the end, at most.
const MOST_SEARCHED: usize = 6;

/// An upper bound on the scaled Jacobian at one boundary vertex.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct StarBound {
    /// The vertex.
    #[serde(serialize_with = "serialize_vertex")]
    pub vertex: VertexId,
    /// No embedding with this boundary has a larger worst corner here (computed in floating point): the smaller of the bound by
    /// the directions of the edges and [`angle_bound`](Self::angle_bound).
    pub bound: f64,
    /// The bound by solid and dihedral angles, which holds if the surface does not cross itself; 1 if there is none. It is
    /// positive, so it never says that a placement is impossible.
    pub angle_bound: f64,
    /// Whether the bound by directions is the true optimum of the star, to 1e-6.
    pub tight: bool,
    /// Some directions of the star's free edges reach this worst corner; -1 if none were looked for.
    pub attained: f64,
}

pub(crate) fn serialize_vertex<S: serde::Serializer>(v: &VertexId, s: S) -> Result<S::Ok, S::Error> {
    s.serialize_u32(v.0)
}

/// The star of one fixed vertex.
#[derive(Clone, Debug)]
pub(crate) struct Star {
    pub(crate) bound: StarBound,
    /// The bound by the directions of the edges alone.
    pub(crate) by_direction: f64,
    /// Ends of the free edges, ascending.
    free: Vec<u32>,
    directions: Directions,
}

/// The bounds of all fixed vertices from their corners with at most one free edge, ascending by vertex; 1 where there are none.
pub(crate) fn bounds(problem: &Problem, points: &[Vector]) -> Vec<Star> {
    let is_fixed = |v: u32| problem.slot[v as usize] == FIXED;
    let mut stars: BTreeMap<u32, Vec<[u32; 3]>> = BTreeMap::new();
    for hex in &problem.hexes {
        for (corner, neighbours) in CORNER_NEIGHBOURS.iter().enumerate() {
            if is_fixed(hex[corner]) {
                stars.entry(hex[corner]).or_default().push(neighbours.map(|n| hex[n]));
            }
        }
    }
    stars.into_iter().map(|(v, corners)| star(problem, points, v, &corners)).collect()
}

fn star(problem: &Problem, points: &[Vector], v: u32, corners: &[[u32; 3]]) -> Star {
    let is_fixed = |v: u32| problem.slot[v as usize] == FIXED;
    let mut free: Vec<u32> = corners.iter().flatten().copied().filter(|&w| !is_fixed(w)).collect();
    free.sort_unstable();
    free.dedup();
    // A fixed edge of length zero makes every corner on it worthless.
    let direction = |w: u32| unit(sub(points[w as usize], points[v as usize])).unwrap_or([0.0; 3]);
    let mut least = f64::INFINITY;
    let mut normals: Vec<Vec<Vector>> = vec![Vec::new(); free.len()];
    let mut tight = true;
    for ends in corners {
        let n_free = ends.iter().filter(|&&w| !is_fixed(w)).count();
        if n_free > 1 {
            tight = false;
            continue;
        }
        // Rotate so that the free edge (or any) comes first: the frame stays right-handed.
        let first = ends.iter().position(|&w| !is_fixed(w)).unwrap_or(0);
        let normal = cross(direction(ends[(first + 1) % 3]), direction(ends[(first + 2) % 3]));
        if n_free == 1 {
            normals[free.binary_search(&ends[first]).expect("collected")].push(normal);
        } else {
            least = least.min(dot(direction(ends[first]), normal));
        }
    }
    let by_direction =
        normals.iter().filter(|n| !n.is_empty()).map(|n| best_direction(n).value).fold(least, f64::min).min(1.0);
    let angle_bound = angle_bound(corners, |w| is_fixed(w).then(|| direction(w)));
    let ray = |w: u32| match free.binary_search(&w) {
        Ok(j) => Ray::Free(j),
        Err(_) => Ray::Fixed(direction(w)),
    };
    let directions = Directions::new(corners.iter().map(|ends| ends.map(ray)).collect(), free.len());
    let attained = if tight { by_direction } else { -1.0 };
    let bound = by_direction.min(angle_bound);
    Star {
        bound: StarBound { vertex: VertexId(v), bound, angle_bound, tight, attained },
        by_direction,
        free,
        directions,
    }
}

/// What the angles at a vertex allow, if the corners (right-handed triples of edges, given by their other ends) form a disk in the
/// link; else 1. `direction` gives the unit directions of the fixed edges; those on the disk's rim must be.
///
/// Of n corners in the solid angle `W` one has at most `W / n`, and among spherical triangles of an area up to a quarter of the half-sphere
/// the equilateral one has the largest determinant (with a side and the area given, the third point lies on a circle, Lexell 1784, and is
/// farthest from the side's plane in the isosceles case). Of m corners in the dihedral angle `a` one has at most `a / m`, and a
/// determinant is at most the sine of its dihedral angle.
fn angle_bound(corners: &[[u32; 3]], direction: impl Fn(u32) -> Option<Vector>) -> f64 {
    use std::f64::consts::{FRAC_PI_2, PI};
    // Arcs a -> b of the link's triangles that no neighbour has as b -> a: the rim, with the disk on the left.
    let arcs: Vec<[u32; 2]> = corners.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    let mut back: Vec<[u32; 2]> = arcs.iter().map(|&[a, b]| [b, a]).collect();
    back.sort_unstable();
    let rim: BTreeMap<u32, u32> =
        arcs.iter().filter(|arc| back.binary_search(arc).is_err()).map(|&[a, b]| (a, b)).collect();
    let Some((&first, _)) = rim.first_key_value() else { return 1.0 };
    let (mut bound, mut sum, mut n_rim) = (1.0f64, 0.0, 0);
    let (mut before, mut at) = (first, rim[&first]);
    loop {
        let Some(&after) = rim.get(&at) else { return 1.0 };
        let (Some(e), Some(p), Some(q)) = (direction(at), direction(before), direction(after)) else { return 1.0 };
        let Some(angle) = dihedral_angle(e, q, p) else { return 1.0 };
        let share = angle / corners.iter().filter(|c| c.contains(&at)).count() as f64;
        if share < FRAC_PI_2 {
            bound = bound.min(share.sin());
        }
        (sum, n_rim) = (sum + angle, n_rim + 1);
        (before, at) = (at, after);
        if before == first || n_rim > rim.len() {
            break;
        }
    }
    if n_rim != rim.len() || n_rim < 3 {
        return 1.0;
    }
    let solid = sum - (n_rim as f64 - 2.0) * PI;
    let share = solid / corners.len() as f64;
    if solid > 1e-9 && share < FRAC_PI_2 {
        bound = bound.min(equilateral(share));
    }
    // Too small an angle to tell from nothing says nothing.
    if bound > 1e-9 { bound } else { 1.0 }
}

/// The determinant of three unit vectors with equal angles that span this solid angle.
pub(crate) fn equilateral(solid: f64) -> f64 {
    let cos_angle = ((solid + std::f64::consts::PI) / 3.0).cos();
    let c = cos_angle / (1.0 - cos_angle);
    (1.0 - c) * (1.0 + 2.0 * c).max(0.0).sqrt()
}

/// Takes corners with several free edges in, as far as that can lower the least bound: a star in which some directions reach the
/// least bound known is left alone. `hint` has positions of all vertices from which the directions start. Deterministic; returns
/// early, with bounds that hold, if the context says so.
pub(crate) fn refine(stars: &mut [Star], hint: &[Vector], context: &Context<'_>) {
    let mut least = stars.iter().map(|s| s.bound.bound).fold(1.0, f64::min);
    let mut open: Vec<&mut Star> = stars.iter_mut().filter(|s| !s.bound.tight).take(MOST_STARS).collect();
    open.par_iter_mut().for_each(|star| {
        if context.stop().is_some() {
            return;
        }
        let at = hint[star.bound.vertex.index()];
        let start: Vec<Vector> =
            star.free.iter().map(|&w| unit(sub(hint[w as usize], at)).unwrap_or([0.0, 0.0, 1.0])).collect();
        star.bound.attained = star.directions.climb(&start, least).0.min(star.by_direction);
    });
    open.sort_by(|a, b| a.bound.attained.total_cmp(&b.bound.attained).then(a.bound.vertex.cmp(&b.bound.vertex)));
    for star in open.into_iter().take(MOST_SEARCHED) {
        if context.stop().is_some() || star.bound.attained >= least {
            break;
        }
        let found = star.directions.search(star.bound.attained, least, NODES);
        star.bound.attained = found.attained;
        star.by_direction = star.by_direction.min(found.bound);
        star.bound.bound = star.bound.bound.min(found.bound);
        star.bound.tight = star.by_direction - found.attained <= 1.5 * SETTLED;
        least = least.min(star.bound.bound);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hexfill_mesh::Random;

    #[test]
    fn no_triangle_of_an_area_beats_the_equilateral_one() {
        assert!((equilateral(std::f64::consts::FRAC_PI_2) - 1.0).abs() < 1e-12);
        let mut random = Random::of_task(22, 0);
        let (mut seen, mut near) = (0, 0.0f64);
        for _ in 0..200_000 {
            let size = 0.2 + random.unit();
            let mut direction = || unit([1.0, size * random.signed(), size * random.signed()]).unwrap();
            let (a, b, c) = (direction(), direction(), direction());
            let d = dot(a, cross(b, c));
            let solid = 2.0 * d.atan2(1.0 + dot(a, b) + dot(b, c) + dot(c, a));
            if solid > 1e-3 && solid < std::f64::consts::FRAC_PI_2 {
                seen += 1;
                near = near.max(d / equilateral(solid));
                assert!(d <= equilateral(solid) + 1e-12, "{d} {solid}");
            }
        }
        assert!(seen > 10_000 && near > 0.99, "{seen} {near}");
    }

    #[test]
    fn angles_of_a_cube_corner_cut_in_three() {
        // The octant in three equal corners: the true optimum is that of the ray in the middle.
        let rays = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let corners = [[0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let bound = angle_bound(&corners, |w| rays.get(w as usize).copied());
        // Each of the three edges has 90 degrees for two corners; the solid angle is pi / 2 for three.
        let by_solid = equilateral(std::f64::consts::FRAC_PI_2 / 3.0);
        assert!((bound - by_solid.min(0.5f64.sqrt())).abs() < 1e-12);
        let normals: Vec<Vector> = [[0, 1], [1, 2], [2, 0]].iter().map(|&[i, j]| cross(rays[i], rays[j])).collect();
        assert!(best_direction(&normals).value <= bound + 1e-12);
        // Seen from the other side the angles are those outside; a rim with a free edge says nothing.
        let outside = [[1, 0, 3], [2, 1, 3], [0, 2, 3]];
        assert_eq!(angle_bound(&outside, |w| rays.get(w as usize).copied()), 1.0);
        let apart = [[0, 1, 2], [0, 2, 3]];
        assert_eq!(angle_bound(&apart, |w| rays.get(w as usize).copied()), 1.0);
    }

    #[test]
    fn the_corner_of_a_cube_is_bounded_by_its_own_angle() {
        let mut points: Vec<Vector> = hexfill_mesh::cube::POSITIONS.map(|p| p.map(f64::from)).to_vec();
        points[6] = [0.5, 0.5, 1.0];
        let mut fixed = vec![true; 8];
        fixed[6] = false;
        let problem = Problem::new(8, vec![[0, 1, 2, 3, 4, 5, 6, 7]], &fixed);
        let all: Vec<StarBound> = bounds(&problem, &points).iter().map(|s| s.bound).collect();
        assert_eq!(all.len(), 7);
        assert!(all.iter().all(|b| (b.bound - 1.0).abs() < 1e-12 && b.tight));
        points[1] = [1.0, 1.0, 0.0];
        let at_0 = bounds(&problem, &points)[0].bound;
        assert!((at_0.bound - 0.5f64.sqrt()).abs() < 1e-12);
    }
}
