//! The positions an engine works with.
//!
//! Source: ours.

use crate::problem::Problem;
use hexfill_embed::canonical_polyhedron;

impl Problem {
    /// The positions of the vertices: its own, or those of the canonical polyhedron of a sphere without any.
    ///
    /// ```
    /// let fig = hexfill::Problem::named("carbonera-fig10")?;
    /// assert!(fig.points().is_none() && fig.positions().is_some());
    /// # Ok::<(), hexfill::ProblemError>(())
    /// ```
    pub fn positions(&self) -> Option<Vec<[f64; 3]>> {
        match &self.points {
            Some(points) => Some(points.clone()),
            None if self.surface.is_sphere() => canonical_polyhedron(&self.surface).ok(),
            None => None,
        }
    }
}
