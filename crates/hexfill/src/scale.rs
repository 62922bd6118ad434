//! Surfaces of any size: engines multiply lengths, so one that is far larger or smaller than 1 is scaled by a power of two before any of them
//! sees it, and its meshes are scaled back. Surfaces of ordinary size are left alone, bit for bit.

use crate::fill::{FillOptions, Filled, InteriorFrom};
use crate::geometry::Placed;
use crate::problem::Problem;
use hexfill_geometry::Vector;
use std::borrow::Cow;

/// Sizes up to two to this power, and down to its inverse, are ordinary: products of a dozen lengths are far from the ends of the range.
const ORDINARY: i32 = 64;

/// The power of two next to the largest coordinate; 0 if that is an ordinary size, or 0.
fn exponent(points: &[Vector]) -> i32 {
    let largest = points.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    let exponent = largest.log2().round();
    if exponent.is_finite() && exponent.abs() > f64::from(ORDINARY) { exponent as i32 } else { 0 }
}

/// `x` times a power of two, in two steps: neither factor leaves the range of doubles.
fn times(x: f64, exponent: i32) -> f64 {
    let half = exponent / 2;
    x * 2f64.powi(half) * 2f64.powi(exponent - half)
}

/// The same shape with an ordinary size.
pub(crate) fn at_ordinary_size(points: &[Vector]) -> Cow<'_, [Vector]> {
    match exponent(points) {
        0 => Cow::Borrowed(points),
        e => Cow::Owned(points.iter().map(|p| p.map(|x| times(x, -e))).collect()),
    }
}

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
        let points = Some(at_ordinary_size(boundary).into_owned());
        let mut options = options.clone();
        if let Some(height) = options.layers.as_mut().and_then(|layers| layers.height.as_mut()) {
            *height = times(*height, -exponent);
        }
        Some(Self { problem: Problem { points, ..problem.clone() }, options, boundary, exponent })
    }

    /// The start positions of a filling, if any, at the size they belong to.
    pub(crate) fn restore(&self, filled: &mut Filled) {
        filled.coarse = None;
        if let Some(start) = &mut filled.start {
            self.restore_points(start);
        }
    }

    /// A filling with its positions, judged where they are now.
    pub(crate) fn restore_placed(&self, filled: &mut Filled, placed: &mut Placed) {
        self.restore(filled);
        self.restore_points(&mut placed.points);
        if let Some(embedding) = &mut placed.embedding {
            embedding.shortest_edge = times(embedding.shortest_edge, self.exponent);
        }
        placed.judge_again(filled);
    }

    fn restore_points(&self, points: &mut [Vector]) {
        let (surface, interior) = points.split_at_mut(self.boundary.len());
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
