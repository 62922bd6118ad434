//! Symmetric variables: the numbers that positions with given symmetries have left.
//!
//! Under a finite group of isometries a free vertex is held in the subspace its stabiliser fixes, and the other vertices of its orbit are
//! its images: so there are fewer variables, and every result is symmetric up to rounding. (That a smooth symmetric function is stationary
//! where it is stationary among symmetric positions: R. Palais 1979, the principle of symmetric criticality.)
//! Invariant: the first member of an orbit is its smallest vertex, with the identity.
//!
//! Source: Palais 1979.

use hexfill_geometry::{Vector, add_scaled, dot, scale, sub};

/// A 3 x 3 matrix by rows.
pub(super) type Matrix = [Vector; 3];

pub(super) const IDENTITY: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The free vertices that symmetries carry into each other.
#[derive(Clone, Debug)]
pub(crate) struct Orbit {
    /// Number of the first variable.
    pub(crate) first: usize,
    /// Orthonormal directions in which the first member may move: one variable each.
    pub(super) basis: Vec<Vector>,
    /// Slots, and the isometry from the first member.
    pub(super) members: Vec<(usize, Matrix)>,
}

/// The symmetries of a problem, ready for use.
#[derive(Clone, Debug)]
pub(crate) struct Symmetry {
    /// Order of the group.
    pub(crate) order: usize,
    pub(crate) orbits: Vec<Orbit>,
    pub(crate) n_variables: usize,
    /// Per slot: its orbit and its number in it.
    pub(super) place: Vec<(usize, usize)>,
    /// Per hex: whether it is the first of its orbit.
    pub(crate) is_first_hex: Vec<bool>,
    /// The point all isometries leave in place.
    pub(super) centre: Vector,
}

pub(super) fn apply(m: &Matrix, v: Vector) -> Vector {
    [dot(m[0], v), dot(m[1], v), dot(m[2], v)]
}

fn apply_transposed(m: &Matrix, v: Vector) -> Vector {
    add_scaled(add_scaled(scale(v[0], m[0]), v[1], m[1]), v[2], m[2])
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
