//! Inside or outside: solid angles, winding numbers, and which of several closed surfaces lies in which.
//!
//! Source: van Oosterom, Strackee 1983 (the solid angle of a triangle).

use crate::vector::{Vector, det, dot, norm, sub};
use std::f64::consts::TAU;

/// The solid angle of a triangle seen from the origin, in (-2 pi, 2 pi]: positive where the origin lies behind the triangle, which runs
/// counter-clockwise seen from its front. (Van Oosterom, Strackee 1983.)
pub fn solid_angle([a, b, c]: [Vector; 3]) -> f64 {
    let [la, lb, lc] = [a, b, c].map(norm);
    let below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    2.0 * det(a, b, c).atan2(below)
}

/// The winding number of a closed surface of triangles round `p`: 1 inside of one that faces outward, 0 outside. Linear time.
///
/// # Example
/// ```
/// use hexfill_geometry::{halves, winding_number};
///
/// let quads = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
/// let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
/// let at = |v: usize| corners[v].map(f64::from);
/// let triangles: Vec<_> = quads.iter().flat_map(|quad| halves(quad.map(at))).collect();
/// assert!((winding_number(triangles.iter().copied(), [0.5; 3]) - 1.0).abs() < 1e-9); // once round what is inside
/// assert!(winding_number(triangles.iter().copied(), [2.0; 3]).abs() < 1e-9);
/// ```
pub fn winding_number(triangles: impl IntoIterator<Item = [Vector; 3]>, p: Vector) -> f64 {
    let angles = triangles.into_iter().map(|t| solid_angle(t.map(|x| sub(x, p))));
    angles.sum::<f64>() / (2.0 * TAU)
}

/// For each of several closed surfaces of triangles, of any finite size, which others it lies in: an even number for the outside of a
/// solid, an odd one for a cavity. Exact for disjoint surfaces. Of two that cross, one lies in the other only if its box does and its first
/// point.
///
/// # Panics
/// If a surface has no triangles.
pub fn holders(surfaces: &[Vec<[Vector; 3]>]) -> Vec<Vec<usize>> {
    let largest = surfaces.iter().flatten().flatten().flatten().fold(1e-300f64, |m, x| m.max(x.abs()));
    let small = |p: Vector| p.map(|x| x / largest);
    let winds = |surface: &[[Vector; 3]], p| winding_number(surface.iter().map(|t| t.map(small)), p).abs() > 0.5;
    let boxes: Vec<[Vector; 2]> = surfaces.iter().map(|s| enclosing_box(s)).collect();
    let is_in = |i: usize, o: usize| {
        let ([low, high], [least, most]) = (boxes[i], boxes[o]);
        (0..3).all(|c| least[c] <= low[c] && high[c] <= most[c]) && winds(&surfaces[o], small(surfaces[i][0][0]))
    };
    let others = |i: usize| (0..surfaces.len()).filter(move |&other| other != i);
    (0..surfaces.len()).map(|i| others(i).filter(|&o| is_in(i, o)).collect()).collect()
}

/// The least and the largest coordinates.
fn enclosing_box(triangles: &[[Vector; 3]]) -> [Vector; 2] {
    let fold = |start: f64, choose: fn(f64, f64) -> f64| {
        triangles.iter().flatten().fold([start; 3], |m, p| [0, 1, 2].map(|c| choose(m[c], p[c])))
    };
    [fold(f64::INFINITY, f64::min), fold(f64::NEG_INFINITY, f64::max)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::halves;
    use hexfill_mesh::cube::{FACETS, POSITIONS};

    /// A cube of half side `r` round a point.
    fn cube(centre: Vector, r: f64) -> Vec<[Vector; 3]> {
        let corner = |k: usize| [0, 1, 2].map(|c| centre[c] + r * (2.0 * f64::from(POSITIONS[k][c]) - 1.0));
        FACETS.iter().flat_map(|f| halves(f.map(corner))).collect()
    }

    #[test]
    fn a_cube_winds_once_round_its_inside() {
        let cube = cube([1.0, 2.0, 3.0], 1.0);
        assert!((winding_number(cube.iter().copied(), [1.5, 2.9, 2.1]) - 1.0).abs() < 1e-12);
        assert!(winding_number(cube.iter().copied(), [1.5, 3.1, 2.1]).abs() < 1e-12);
        let inward = cube.iter().map(|&[a, b, c]| [a, c, b]);
        assert!((winding_number(inward, [1.5, 2.9, 2.1]) + 1.0).abs() < 1e-12);
    }

    #[test]
    fn cubes_in_cubes_of_any_size() {
        for s in [1.0, 1e-280, 1e300] {
            let cubes = [([0.0; 3], 4.0), ([0.0; 3], 5.0), ([0.5 * s, 0.0, 0.0], 2.0), ([20.0 * s, 0.0, 0.0], 1.0)];
            let cubes: Vec<_> = cubes.into_iter().map(|(centre, r)| cube(centre, r * s)).collect();
            assert_eq!(holders(&cubes), [vec![1], vec![], vec![0, 1], vec![]]);
        }
    }

    #[test]
    fn cubes_that_cross_lie_apart_though_a_corner_of_each_is_in_the_other() {
        let cubes = [cube([0.0; 3], 1.0), cube([1.2, 1.1, 0.9], 1.0)];
        assert!(winding_number(cubes[0].iter().copied(), cubes[1][0][0]).abs() > 0.5);
        assert_eq!(holders(&cubes), [vec![], vec![]]);
    }
}
