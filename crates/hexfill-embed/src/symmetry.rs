//! Symmetric variables: positions that share the symmetries of the boundary.
//!
//! A symmetry here is an automorphism of the mesh whose action on the boundary vertices is that of an isometry of space (found
//! from three boundary points, checked on all). Together they form a group. A free vertex is held in the subspace its stabiliser fixes,
//! the other vertices of its orbit are its images: so there are fewer variables, and every result is symmetric up to rounding.
//! Invariant: the first member of an orbit is its smallest vertex, with the identity.

use crate::problem::{FIXED, Problem};
use crate::vector::{Vector, add_scaled, cross, det, dot, norm, scale, sub, unit};
use hexfill_mesh::{HexMesh, hex_automorphisms, hex_symmetry_order};

/// A 3 x 3 matrix by rows.
type Matrix = [Vector; 3];

/// Meshes with more automorphisms (many equal parts) are taken as they are: isometries of a solid are few, and the list of
/// automorphisms long.
const MOST_AUTOMORPHISMS: u128 = 2000;

const IDENTITY: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The free vertices that symmetries carry into each other.
#[derive(Clone, Debug)]
pub(crate) struct Orbit {
    /// Number of the first variable.
    pub(crate) first: usize,
    /// Orthonormal directions in which the first member may move: one variable each.
    basis: Vec<Vector>,
    /// Slots, and the isometry from the first member.
    members: Vec<(usize, Matrix)>,
}

/// The symmetries of a problem, ready for use.
#[derive(Clone, Debug)]
pub(crate) struct Symmetry {
    /// Order of the group.
    pub(crate) order: usize,
    pub(crate) orbits: Vec<Orbit>,
    pub(crate) n_variables: usize,
    /// Per slot: its orbit and its number in it.
    place: Vec<(usize, usize)>,
    /// Per hex: whether it is the first of its orbit.
    pub(crate) is_first_hex: Vec<bool>,
    /// The point all isometries leave in place.
    centre: Vector,
}

fn apply(m: &Matrix, v: Vector) -> Vector {
    [dot(m[0], v), dot(m[1], v), dot(m[2], v)]
}

fn apply_transposed(m: &Matrix, v: Vector) -> Vector {
    add_scaled(add_scaled(scale(v[0], m[0]), v[1], m[1]), v[2], m[2])
}

/// The symmetries of a mesh with fixed boundary points, or `None` if there are none but the identity.
pub(crate) fn find(mesh: &HexMesh, problem: &Problem, points: &[Vector]) -> Option<Symmetry> {
    let fixed: Vec<usize> = mesh
        .boundary_vertices()
        .iter()
        .enumerate()
        .filter(|&(v, &on)| on && problem.slot[v] == FIXED)
        .map(|(v, _)| v)
        .collect();
    let sum = fixed.iter().fold([0.0; 3], |s, &v| add_scaled(s, 1.0, points[v]));
    let centre = scale(1.0 / fixed.len() as f64, sum);
    let at = |v: usize| sub(points[v], centre);
    let frame = far_frame(&fixed, at)?;
    if hex_symmetry_order(mesh).ok()? > MOST_AUTOMORPHISMS {
        return None;
    }
    let group: Vec<(Vec<u32>, Vec<u32>, Matrix)> = hex_automorphisms(mesh)
        .ok()?
        .into_iter()
        .filter_map(|a| {
            let image = |v: usize| a.vertices[v].index();
            let isometry = isometry(frame.map(at), frame.map(|v| at(image(v))))?;
            let keeps = fixed.iter().all(|&v| norm(sub(apply(&isometry, at(v)), at(image(v)))) < 1e-9);
            keeps.then(|| (a.vertices.iter().map(|v| v.0).collect(), a.hexes.iter().map(|h| h.0).collect(), isometry))
        })
        .collect();
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
        let v = problem.free[slot] as usize;
        let mut members: Vec<(usize, Matrix)> = vec![(slot, IDENTITY)];
        let mut mean = [[0.0; 3]; 3];
        let mut stabiliser = 0.0;
        for (vertices, _, isometry) in &group {
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
        for (number, &(member, _)) in members.iter().enumerate() {
            place[member] = (orbits.len(), number);
        }
        let basis = image_of_projection(&mean.map(|row| scale(1.0 / stabiliser, row)));
        let first = n_variables;
        n_variables += basis.len();
        orbits.push(Orbit { first, basis, members });
    }
    let is_first_hex =
        (0..problem.hexes.len()).map(|h| group.iter().all(|(_, hexes, _)| hexes[h] as usize >= h)).collect();
    Some(Symmetry { order: group.len(), orbits, n_variables, place, is_first_hex, centre })
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

impl Symmetry {
    /// Writes the positions of the variables `x`.
    pub(crate) fn scatter(&self, free: &[u32], x: &[f64], points: &mut [Vector]) {
        for orbit in &self.orbits {
            let moved = orbit.vector(x);
            for (slot, m) in &orbit.members {
                let image = apply(m, moved);
                points[free[*slot] as usize] = std::array::from_fn(|k| self.centre[k] + image[k]);
            }
        }
    }

    /// The variables nearest to `points`.
    pub(crate) fn gather(&self, free: &[u32], points: &[Vector]) -> Vec<f64> {
        let vectors: Vec<f64> = free.iter().flat_map(|&v| sub(points[v as usize], self.centre)).collect();
        let mut out = vec![0.0; self.n_variables];
        self.pull_back(&vectors, &mut out);
        for orbit in &self.orbits {
            let n = orbit.members.len() as f64;
            out[orbit.first..orbit.first + orbit.basis.len()].iter_mut().for_each(|x| *x /= n);
        }
        out
    }

    /// Sums vectors at slots (three numbers each) as they act on the variables.
    pub(crate) fn pull_back(&self, at_slots: &[f64], out: &mut [f64]) {
        for orbit in &self.orbits {
            let mut sum = [0.0; 3];
            for (slot, m) in &orbit.members {
                let v: Vector = std::array::from_fn(|k| at_slots[3 * slot + k]);
                sum = add_scaled(sum, 1.0, apply_transposed(m, v));
            }
            for (i, &b) in orbit.basis.iter().enumerate() {
                out[orbit.first + i] = dot(b, sum);
            }
        }
    }

    /// Coordinate `k` of a slot as a combination of variables.
    pub(crate) fn expand(&self, slot: usize, k: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let (orbit, number) = self.place[slot];
        let orbit = &self.orbits[orbit];
        let row = orbit.members[number].1[k];
        orbit.basis.iter().enumerate().map(move |(i, &b)| (orbit.first + i, dot(row, b)))
    }

    /// The slots of an orbit.
    pub(crate) fn slots(orbit: &Orbit) -> impl Iterator<Item = usize> + '_ {
        orbit.members.iter().map(|m| m.0)
    }
}

impl Orbit {
    pub(crate) fn n_variables(&self) -> usize {
        self.basis.len()
    }

    fn vector(&self, x: &[f64]) -> Vector {
        self.basis.iter().enumerate().fold([0.0; 3], |v, (i, &b)| add_scaled(v, x[self.first + i], b))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::grid;

    #[test]
    fn the_cube_cut_in_27_has_one_free_number() {
        let mesh = grid(3);
        let problem = Problem::new(64, mesh.hexes_raw(), &mesh.boundary_vertices());
        let points: Vec<Vector> = (0..64).map(|v| [v % 4, v / 4 % 4, v / 16].map(f64::from)).collect();
        let symmetry = find(&mesh, &problem, &points).unwrap();
        assert_eq!((symmetry.order, symmetry.orbits.len(), symmetry.n_variables), (48, 1, 1));
        // Corners, edges, facets and the inside of the cube of hexes.
        assert_eq!(symmetry.is_first_hex.iter().filter(|&&first| first).count(), 4);
        let x = symmetry.gather(&problem.free, &points);
        let mut back = points.clone();
        symmetry.scatter(&problem.free, &x, &mut back);
        assert!(back.iter().zip(&points).all(|(a, b)| norm(sub(*a, *b)) < 1e-12));
        // A box has the symmetries of a box only; a boundary without symmetry none.
        let box_points: Vec<Vector> = points.iter().map(|p| [p[0], 2.0 * p[1], 3.0 * p[2]]).collect();
        assert_eq!(find(&mesh, &problem, &box_points).unwrap().order, 8);
        let mut skew = points.clone();
        skew[1] = [1.1, 0.05, 0.0];
        skew[7] = [3.0, 1.2, 0.3];
        assert!(find(&mesh, &problem, &skew).is_none());
    }
}
