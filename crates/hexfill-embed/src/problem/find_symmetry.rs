//! The symmetries of a mesh with a fixed boundary.
//!
//! A symmetry here is an automorphism of the mesh whose action on the boundary vertices is that of an isometry of space (found
//! from three boundary points, checked on all). Together they form a group, as automorphisms and isometries do.
//!
//! Source: ours.

use super::free_vertices::{FIXED, Problem};
use super::symmetric_variables::{IDENTITY, Matrix, Orbit, Symmetry, apply};
use hexfill_geometry::{Vector, add_scaled, cross, det, dot, norm, scale, sub, unit};
use hexfill_mesh::{HexMesh, hex_automorphisms, hex_symmetry_order};

/// Meshes with more automorphisms (many equal parts) are taken as they are: isometries of a solid are few, and the list of
/// automorphisms long.
const MOST_AUTOMORPHISMS: u128 = 2000;

/// An automorphism of the mesh that is an isometry of the boundary: the images of vertices and hexes, and the isometry round the centre.
struct Member {
    vertices: Vec<u32>,
    hexes: Vec<u32>,
    isometry: Matrix,
}

/// The symmetries of a mesh with fixed boundary points, or `None` if there are none but the identity.
pub(crate) fn find_symmetry(mesh: &HexMesh, problem: &Problem, points: &[Vector]) -> Option<Symmetry> {
    let fixed: Vec<usize> = mesh
        .boundary_vertices()
        .iter()
        .enumerate()
        .filter(|&(v, &on)| on && problem.slot[v] == FIXED)
        .map(|(v, _)| v)
        .collect();
    let sum = fixed.iter().fold([0.0; 3], |s, &v| add_scaled(s, 1.0, points[v]));
    // Isometries that permute the fixed points leave their mean in place.
    let centre = scale(1.0 / fixed.len() as f64, sum);
    let group = group(mesh, &fixed, |v| sub(points[v], centre))?;
    if group.len() < 2 {
        return None;
    }
    let mut orbits: Vec<Orbit> = Vec::new();
    let mut place = vec![(usize::MAX, 0); problem.free.len()];
    let mut n_variables = 0;
    for slot in 0..problem.free.len() {
        if place[slot].0 != usize::MAX {
            continue;
        }
        let orbit = orbit(problem, &group, slot, n_variables);
        for (number, &(member, _)) in orbit.members.iter().enumerate() {
            place[member] = (orbits.len(), number);
        }
        n_variables += orbit.n_variables();
        orbits.push(orbit);
    }
    let is_first_hex =
        (0..problem.hexes.len()).map(|h| group.iter().all(|member| member.hexes[h] as usize >= h)).collect();
    Some(Symmetry { order: group.len(), orbits, n_variables, place, is_first_hex, centre })
}

/// The automorphisms that are isometries of the fixed points, `at(v)` relative to their mean; `None` if the points do not span space
/// or the automorphisms are too many.
fn group(mesh: &HexMesh, fixed: &[usize], at: impl Fn(usize) -> Vector) -> Option<Vec<Member>> {
    let frame = far_frame(fixed, &at)?;
    if hex_symmetry_order(mesh).ok()? > MOST_AUTOMORPHISMS {
        return None;
    }
    let members = hex_automorphisms(mesh).ok()?.into_iter().filter_map(|a| {
        let image = |v: usize| a.vertices[v].index();
        // A linear map is known from three independent vectors; whether it is this one on all points is then seen.
        let isometry = isometry(frame.map(&at), frame.map(|v| at(image(v))))?;
        let keeps = fixed.iter().all(|&v| norm(sub(apply(&isometry, at(v)), at(image(v)))) < 1e-9);
        keeps.then(|| Member {
            vertices: a.vertices.iter().map(|v| v.0).collect(),
            hexes: a.hexes.iter().map(|h| h.0).collect(),
            isometry,
        })
    });
    Some(members.collect())
}

/// The orbit of a free vertex, given by its slot; `first` is the number of its first variable.
fn orbit(problem: &Problem, group: &[Member], slot: usize, first: usize) -> Orbit {
    let v = problem.free[slot] as usize;
    let mut members: Vec<(usize, Matrix)> = vec![(slot, IDENTITY)];
    let mut mean = [[0.0; 3]; 3];
    let mut stabiliser = 0.0;
    for Member { vertices, isometry, .. } in group {
        let image = problem.slot[vertices[v] as usize] as usize;
        if image == slot {
            stabiliser += 1.0;
            for k in 0..3 {
                mean[k] = add_scaled(mean[k], 1.0, isometry[k]);
            }
        } else if members.iter().all(|m| m.0 != image) {
            members.push((image, *isometry));
        }
    }
    // The mean of a group of isometries projects on the space it fixes.
    let basis = image_of_projection(&mean.map(|row| scale(1.0 / stabiliser, row)));
    Orbit { first, basis, members }
}

/// Three of the vertices whose points span space well; `None` if all lie in a plane through the centre.
fn far_frame(fixed: &[usize], at: impl Fn(usize) -> Vector) -> Option<[usize; 3]> {
    let best = |value: &dyn Fn(usize) -> f64| {
        fixed.iter().copied().fold(fixed[0], |a, b| if value(b) > value(a) + 1e-9 { b } else { a })
    };
    let a = best(&|v| norm(at(v)));
    let b = best(&|v| norm(cross(at(a), at(v))));
    let c = best(&|v| det(at(a), at(b), at(v)).abs());
    (det(at(a), at(b), at(c)).abs() > 1e-9).then_some([a, b, c])
}

/// The orthogonal matrix that takes three vectors to three others, if there is one.
fn isometry(from: [Vector; 3], to: [Vector; 3]) -> Option<Matrix> {
    let d = det(from[0], from[1], from[2]);
    // Rows of the inverse of the matrix with columns `from`.
    let inverse: Matrix = std::array::from_fn(|k| scale(1.0 / d, cross(from[(k + 1) % 3], from[(k + 2) % 3])));
    let mut m: Matrix = std::array::from_fn(|row| {
        let mut sum = [0.0; 3];
        for k in 0..3 {
            sum = add_scaled(sum, to[k][row], inverse[k]);
        }
        sum
    });
    let orthogonal = (0..3).all(|i| (0..3).all(|j| (dot(m[i], m[j]) - IDENTITY[i][j]).abs() < 1e-8));
    if !orthogonal {
        return None;
    }
    // Rounding off the rows.
    m[0] = unit(m[0])?;
    m[1] = unit(add_scaled(m[1], -dot(m[1], m[0]), m[0]))?;
    let third = cross(m[0], m[1]);
    m[2] = if dot(third, m[2]) > 0.0 { third } else { scale(-1.0, third) };
    Some(m)
}

/// An orthonormal basis of the image of an orthogonal projection.
fn image_of_projection(p: &Matrix) -> Vec<Vector> {
    let rank = (p[0][0] + p[1][1] + p[2][2]).round() as usize;
    let mut basis: Vec<Vector> = Vec::with_capacity(rank);
    while basis.len() < rank {
        let rest = |k: usize| basis.iter().fold(apply(p, IDENTITY[k]), |v, &b| add_scaled(v, -dot(v, b), b));
        let longest = (0..3).fold(0, |a, b| if norm(rest(b)) > norm(rest(a)) + 1e-9 { b } else { a });
        match unit(rest(longest)) {
            Some(b) => basis.push(b),
            None => break,
        }
    }
    basis
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::samples::grid;

    #[test]
    fn the_cube_cut_in_27_has_one_free_number() {
        let mesh = grid(3);
        let problem = Problem::new(64, mesh.hexes_raw(), &mesh.boundary_vertices());
        let points: Vec<Vector> = (0..64).map(|v| [v % 4, v / 4 % 4, v / 16].map(f64::from)).collect();
        let symmetry = find_symmetry(&mesh, &problem, &points).unwrap();
        assert_eq!((symmetry.order, symmetry.orbits.len(), symmetry.n_variables), (48, 1, 1));
        // Corners, edges, facets and the inside of the cube of hexes.
        assert_eq!(symmetry.is_first_hex.iter().filter(|&&first| first).count(), 4);
        let x = symmetry.gather(&problem.free, &points);
        let mut back = points.clone();
        symmetry.scatter(&problem.free, &x, &mut back);
        assert!(back.iter().zip(&points).all(|(a, b)| norm(sub(*a, *b)) < 1e-12));
        // A box has the symmetries of a box only; a boundary without symmetry none.
        let box_points: Vec<Vector> = points.iter().map(|p| [p[0], 2.0 * p[1], 3.0 * p[2]]).collect();
        assert_eq!(find_symmetry(&mesh, &problem, &box_points).unwrap().order, 8);
        let mut skew = points.clone();
        skew[1] = [1.1, 0.05, 0.0];
        skew[7] = [3.0, 1.2, 0.3];
        assert!(find_symmetry(&mesh, &problem, &skew).is_none());
    }
}
