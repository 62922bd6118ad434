//! Normal coordinates: centred on the boundary and scaled by a power of two, so that sizes of 1e-300 and 1e300 are the same problem.
//!
//! Boundary vertices are returned with the bits they came with; scaling by a power of two loses none of the others' either, short of the smallest doubles.
//!
//! Source: ours.

use crate::error::EmbedError;
use crate::problem::Problem;
use hexfill_geometry::Vector;
use hexfill_mesh::{HexMesh, Offenders, VertexId};

/// The problem in normal coordinates, and the way back.
pub(crate) struct Normal {
    pub(crate) problem: Problem,
    /// Fixed points in normal coordinates; free ones at the origin.
    pub(crate) points: Vec<Vector>,
    /// What was given, per vertex; free vertices at the centre.
    given: Vec<Vector>,
    centre: Vector,
    /// A power of two.
    pub(crate) scale: f64,
}

impl Normal {
    /// The problem of a mesh whose boundary vertices stay at `boundary_points`; a `start` is checked, not taken.
    ///
    /// # Errors
    /// As [`embed`](crate::embed()).
    pub(crate) fn new(
        mesh: &HexMesh,
        boundary_points: &[Vector],
        start: Option<&[Vector]>,
    ) -> Result<Self, EmbedError> {
        if mesh.n_hexes() == 0 {
            return Err(EmbedError::NoHexes);
        }
        let fixed = mesh.boundary_vertices();
        let boundary: Vec<usize> = (0..fixed.len()).filter(|&v| fixed[v]).collect();
        check_positions(mesh, &fixed, &boundary, boundary_points, start)?;
        let (centre, scale) = centre_and_scale(&boundary, boundary_points)?;
        let mut given = vec![centre; mesh.n_vertices()];
        for &v in &boundary {
            given[v] = boundary_points[v];
        }
        let problem = Problem::new(mesh.n_vertices(), mesh.hexes_raw(), &fixed);
        let points = given.iter().map(|&p| normalise(p, centre, scale)).collect();
        Ok(Self { problem, points, given, centre, scale })
    }

    /// Points in normal coordinates.
    pub(crate) fn normalise(&self, points: &[Vector]) -> Vec<Vector> {
        points.iter().map(|&p| normalise(p, self.centre, self.scale)).collect()
    }

    /// Normal coordinates in which the free vertices are where `start` says.
    pub(crate) fn with_start(&self, start: &[Vector]) -> Vec<Vector> {
        let mut points = self.points.clone();
        for &v in &self.problem.free {
            points[v as usize] = normalise(start[v as usize], self.centre, self.scale);
        }
        points
    }

    /// Points in the coordinates of the caller; those that do not move with the bits they were given.
    pub(crate) fn restore(&self, points: &[Vector]) -> Vec<Vector> {
        let mut out = self.given.clone();
        for &v in &self.problem.free {
            let p = points[v as usize];
            out[v as usize] = std::array::from_fn(|k| self.centre[k] + self.scale * p[k]);
        }
        out
    }
}

/// Whether there are positions where they are needed, all finite.
fn check_positions(
    mesh: &HexMesh,
    fixed: &[bool],
    boundary: &[usize],
    boundary_points: &[Vector],
    start: Option<&[Vector]>,
) -> Result<(), EmbedError> {
    let Some(&last) = boundary.last() else { return Err(EmbedError::NoBoundary) };
    let missing: Offenders<VertexId> =
        boundary.iter().filter(|&&v| v >= boundary_points.len()).map(|&v| VertexId::new(v)).collect();
    if !missing.is_empty() {
        let given = boundary_points.len();
        return Err(EmbedError::MissingPositions { vertices: missing, given, limit: last });
    }
    let finite = |p: Vector| p.iter().all(|x| x.is_finite());
    let mut not_finite: Offenders<VertexId> =
        boundary.iter().filter(|&&v| !finite(boundary_points[v])).map(|&v| VertexId::new(v)).collect();
    if let Some(start) = start {
        if start.len() != mesh.n_vertices() {
            return Err(EmbedError::StartLength { given: start.len(), limit: mesh.n_vertices() });
        }
        (0..start.len()).filter(|&v| !fixed[v] && !finite(start[v])).for_each(|v| not_finite.push(VertexId::new(v)));
    }
    if not_finite.is_empty() { Ok(()) } else { Err(EmbedError::NotFinite { vertices: not_finite }) }
}

/// The middle of the boundary's bounding box, and a power of two of about half of its widest side.
fn centre_and_scale(boundary: &[usize], points: &[Vector]) -> Result<(Vector, f64), EmbedError> {
    const LEAST_EXTENT: f64 = 1e-305;
    // Halves, so that the span of the largest doubles does not overflow.
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for &v in boundary {
        for k in 0..3 {
            low[k] = low[k].min(0.5 * points[v][k]);
            high[k] = high[k].max(0.5 * points[v][k]);
        }
    }
    let half = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
    if 2.0 * half < LEAST_EXTENT {
        return Err(EmbedError::NoExtent { given: 2.0 * half, limit: LEAST_EXTENT });
    }
    let centre = std::array::from_fn(|k| low[k] + high[k]);
    Ok((centre, 2f64.powi(half.log2().round() as i32)))
}

fn normalise(p: Vector, centre: Vector, scale: f64) -> Vector {
    // Halves first: the difference of two large doubles may overflow.
    std::array::from_fn(|k| 2.0 * ((0.5 * p[k] - 0.5 * centre[k]) / scale))
}
