//! Quads that cross each other.
//!
//! Source: ours.

use crate::problem::Problem;
use hexfill_doctor::{Soup, crossings};
use hexfill_mesh::QuadId;

/// The pairs of quads that cross each other or touch where they should not, ascending: a mesh of the surface overlaps itself there. Empty without
/// positions.
///
/// ```
/// let cube = hexfill::Problem::named("cube")?;
/// assert!(hexfill::crossing_quads(&cube).is_empty());
/// # Ok::<(), hexfill::ProblemError>(())
/// ```
pub fn crossing_quads(problem: &Problem) -> Vec<[QuadId; 2]> {
    let Some(points) = &problem.points else { return Vec::new() };
    let faces = problem.surface.quads().iter().map(|q| q.map(|v| v.0).to_vec()).collect();
    let pairs = crossings(&Soup { points: points.clone(), faces }, usize::MAX);
    pairs.into_iter().map(|pair| pair.map(QuadId)).collect()
}
