//! Surfaces of any size: engines multiply lengths, so one that is far larger or smaller than 1 is scaled by a power of two before any of them
//! sees it, and its meshes are scaled back. Surfaces of ordinary size are left alone, bit for bit.
//!
//! Source: ours.

use crate::fill::filled::Filled;
use crate::fill::options::{FillOptions, InteriorFrom};
use crate::problem::Problem;
use crate::problem::size::{at_ordinary_size, exponent, times};
use hexfill_geometry::Vector;

/// A problem of ordinary size in the place of another, with options that mean the same.
pub(crate) struct Scaled<'a> {
    pub(crate) problem: Problem,
    pub(crate) options: FillOptions,
    boundary: &'a [Vector],
    exponent: i32,
}

impl<'a> Scaled<'a> {
    /// `None` if the size is ordinary already, or tetrahedra of the interior come with positions of their own.
    pub(crate) fn of(problem: &'a Problem, options: &FillOptions) -> Option<Self> {
        let boundary = problem.points.as_deref()?;
        let exponent = exponent(boundary);
        if exponent == 0 || matches!(options.interior, InteriorFrom::Tets(_)) {
            return None;
        }
        let mut scaled = problem.clone();
        scaled.points = Some(at_ordinary_size(boundary).into_owned());
        let mut options = options.clone();
        if let Some(height) = options.layers.as_mut().and_then(|layers| layers.height.as_mut()) {
            *height = times(*height, -exponent);
        }
        Some(Self { problem: scaled, options, boundary, exponent })
    }

    /// The start positions of a filling, if any, at the size they belong to.
    pub(crate) fn restore(&self, filled: &mut Filled) {
        filled.coarse = None;
        if let Some(start) = &mut filled.start {
            self.restore_points(start);
        }
    }

    /// A length in the unit of the problem.
    pub(crate) fn restored(&self, length: f64) -> f64 {
        times(length, self.exponent)
    }

    /// Positions of all vertices, those of the surface bit for bit.
    pub(crate) fn restore_points(&self, points: &mut [Vector]) {
        let (surface, interior) = points.split_at_mut(self.boundary.len());
        // Powers of two are exact, but for numbers at the edge of the range: the boundary comes back from the
        // original and not by arithmetic.
        surface.copy_from_slice(self.boundary);
        interior.iter_mut().flatten().for_each(|x| *x = times(*x, self.exponent));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Context, PlaceOptions, fill, fill_placed};

    /// A ring of quads, which needs positions to tell its inside, times a number.
    fn torus(size: f64) -> Problem {
        let ring = |[x, y, _]: [usize; 3]| [x, y] != [1, 1];
        let (surface, points) = hexfill_mesh::generate::voxels([3, 3, 1], ring).unwrap();
        let mut problem = Problem::from_surface("torus", surface);
        problem.points = Some(points.into_iter().map(|p| p.map(|x| size * f64::from(x))).collect());
        problem
    }

    #[test]
    fn a_torus_of_any_size_is_filled_with_the_same_mesh() {
        let how = PlaceOptions::default();
        let mut meshes = Vec::new();
        for size in [1.0, 1e160, 1e-160, 1e-300, 1e300] {
            let problem = torus(size);
            let made = fill_placed(&problem, &FillOptions::default(), &how, &Context::default()).unwrap();
            let (filled, placed) = &made.meshes[0];
            let placed = placed.as_ref().unwrap();
            assert!(placed.is_certified(), "{size}");
            assert_eq!(placed.points[..problem.surface.n_vertices()], problem.points.unwrap());
            meshes.push(filled.mesh.hexes_raw());
        }
        assert!(meshes.iter().all(|hexes| *hexes == meshes[0]));
    }

    #[test]
    fn a_constructed_torus_keeps_its_points() {
        let problem = torus(1e-160);
        let options = FillOptions { strategy: crate::Strategy::Construct, ..FillOptions::default() };
        let made = fill(&problem, &options, &Context::default()).unwrap();
        let start = made.meshes[0].start.as_ref().unwrap();
        let boundary = problem.points.unwrap();
        assert_eq!(start[..boundary.len()], boundary);
        assert!(start.iter().flatten().all(|x| x.abs() < 1e-158));
    }
}
