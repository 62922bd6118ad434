//! [`check_mesh`]: the judge on any mesh, ours or not.
//!
//! Source: ours.

use crate::problem::Problem;
use hexfill_check::{Judged, Options, Report, judge};
use hexfill_io::MeshData;
use hexfill_mesh::Context;

/// Judges the hexes of file data: rules L1 to L3 on connectivity (with `surface` also that it is the boundary), L4 and L5 on positions where there
/// are any. `surface` must have the first vertex ids of the mesh, as every mesh made here has. Nothing is assumed of the data and nothing is an error: what is
/// wrong is in the report, with hexes, quads and vertices counted from 0.
///
/// ```
/// use hexfill::io::MeshData;
/// use hexfill::{CheckOptions, Context, Level, check_mesh};
///
/// let points: Vec<[f64; 3]> =
///     [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]].map(|p| p.map(f64::from)).into();
/// let mut mesh = MeshData { points, has_coordinates: true, hexes: vec![[0, 1, 2, 3, 4, 5, 6, 7]], ..MeshData::default() };
/// assert!(check_mesh(&mesh, None, &CheckOptions::default(), &Context::default()).passed(Level::L5));
/// mesh.points[6] = [0.1, 0.1, 0.1];
/// let report = check_mesh(&mesh, None, &CheckOptions::default(), &Context::default());
/// assert!(report.passed(Level::L4) && !report.passed(Level::L5));
/// ```
pub fn check_mesh(data: &MeshData, surface: Option<&Problem>, options: &Options, ctx: &Context<'_>) -> Report {
    with_judged(data, surface, |judged| judge(judged, options, ctx))
}

/// File data, and the surface its hexes should have, as the judge takes them; for the verbs of [`crate::unstable::check`].
pub fn with_judged<T>(data: &MeshData, surface: Option<&Problem>, work: impl FnOnce(&Judged<'_>) -> T) -> T {
    let quads = surface.map(|problem| problem.surface().quads_raw());
    work(&Judged {
        surface: quads.as_deref(),
        points: data.has_coordinates.then_some(data.points.as_slice()),
        surface_points: surface.and_then(Problem::points),
        ..Judged::connectivity(data.vertex_count(), &data.hexes)
    })
}
