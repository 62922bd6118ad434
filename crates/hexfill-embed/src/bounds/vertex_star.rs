//! Vertex-star upper bounds: what no placement of the interior vertices can beat.
//!
//! Keep a boundary vertex and the directions of its fixed edges, and let every other edge at it point anywhere. The best
//! possible worst corner there bounds the scaled Jacobian of the whole mesh. A corner with no free edge is a number;
//! corners with exactly one free edge u are linear in it, `u . n` with n the cross product of the two fixed unit edges, and
//! the maximum over unit u of the minimum over the corners round u is found in closed form
//! ([`hexfill_geometry::best_direction`]). Leaving corners out can only
//! raise a bound, so corners with two or three free edges may wait: [`refine_stars`] takes them in by branch and bound
//! ([`super::star_search`]) where that can lower the least bound of the mesh.
//!
//! A second bound counts angles: see [`super::angle_bound`].
//!
//! Source: ours; the closed form is Wolfe 1976 (see `hexfill_geometry::best_direction`).

use super::angle_bound::angle_bound;
use super::star_climb::climb;
use super::star_directions::Directions;
use super::star_search::{SETTLED, search};
use crate::problem::{FIXED, Problem};
use crate::serial::serialize_vertex;
use hexfill_geometry::{Ray, Vector, best_direction, cross, dot, sub, unit};
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
pub(crate) fn star_bounds_of(problem: &Problem, points: &[Vector]) -> Vec<Star> {
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
        // Left out, which can only raise the bound: it still holds, but is no longer known to be attained.
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
        // Free edges are placed each for itself, as if no corner had two of them: the least of the maxima bounds the
        // maximum of the least.
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

/// Takes corners with several free edges in, as far as that can lower the least bound: a star in which some directions reach the
/// least bound known is left alone. `hint` has positions of all vertices from which the directions start. Deterministic; returns
/// early, with bounds that hold, if the context says so.
pub(crate) fn refine_stars(stars: &mut [Star], hint: &[Vector], context: &Context<'_>) {
    let mut least = least_bound(stars);
    let mut open: Vec<&mut Star> = stars.iter_mut().filter(|s| !s.bound.tight).take(MOST_STARS).collect();
    open.par_iter_mut().for_each(|star| {
        if context.stop().is_some() {
            return;
        }
        let at = hint[star.bound.vertex.index()];
        let start: Vec<Vector> =
            star.free.iter().map(|&w| unit(sub(hint[w as usize], at)).unwrap_or([0.0, 0.0, 1.0])).collect();
        star.bound.attained = climb(&star.directions, &start, least).0.min(star.by_direction);
    });
    open.sort_by(|a, b| a.bound.attained.total_cmp(&b.bound.attained).then(a.bound.vertex.cmp(&b.bound.vertex)));
    for star in open.into_iter().take(MOST_SEARCHED) {
        // Directions that reach the least bound of the mesh are known: whatever this star's own bound is, it does not
        // decide.
        if context.stop().is_some() || star.bound.attained >= least {
            break;
        }
        let found = search(&star.directions, star.bound.attained, least, NODES);
        star.bound.attained = found.attained;
        star.by_direction = star.by_direction.min(found.bound);
        star.bound.bound = star.bound.bound.min(found.bound);
        star.bound.tight = star.by_direction - found.attained <= 1.5 * SETTLED;
        least = least.min(star.bound.bound);
    }
}

/// The least bound of any star, at most 1.
pub(crate) fn least_bound(stars: &[Star]) -> f64 {
    stars.iter().map(|s| s.bound.bound).fold(1.0, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_corner_of_a_cube_is_bounded_by_its_own_angle() {
        let mut points: Vec<Vector> = hexfill_mesh::cube::POSITIONS.map(|p| p.map(f64::from)).to_vec();
        points[6] = [0.5, 0.5, 1.0];
        let mut fixed = vec![true; 8];
        fixed[6] = false;
        let problem = Problem::new(8, vec![[0, 1, 2, 3, 4, 5, 6, 7]], &fixed);
        let all: Vec<StarBound> = star_bounds_of(&problem, &points).iter().map(|s| s.bound).collect();
        assert_eq!(all.len(), 7);
        assert!(all.iter().all(|b| (b.bound - 1.0).abs() < 1e-12 && b.tight));
        points[1] = [1.0, 1.0, 0.0];
        let at_0 = star_bounds_of(&problem, &points)[0].bound;
        assert!((at_0.bound - 0.5f64.sqrt()).abs() < 1e-12);
    }
}
