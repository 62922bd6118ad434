//! [`FillReport`]: numbers about a filling.

use crate::fill::attempt::Attempt;
use crate::fill::filled::{Filled, Route};
use crate::fill::maker::Maker;
use crate::problem::Problem;
use hexfill_mesh::{hex_signature, sheets};
use serde::Serialize;

/// Numbers about a filling, for people and for JSON.
///
/// ```
/// use hexfill::{Context, FillOptions, FillReport, Problem, Route, fill};
/// let geode = Problem::named("geode")?;
/// let result = fill(&geode, &FillOptions::default(), &Context::default())?;
/// let report = FillReport::new(&geode, &result.meshes[0], &result.tried);
/// assert!(report.hexes == 34 && report.route == Route::Atlas);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct FillReport {
    /// What the user called the surface.
    pub surface: String,
    /// Its quads.
    pub quads: usize,
    /// Hexes of the mesh.
    pub hexes: usize,
    /// Hexes per quad.
    pub hexes_per_quad: f64,
    /// Vertices that are not on the surface.
    pub interior_vertices: usize,
    /// Sheets of the mesh, counted up to a million hexes.
    pub sheets: Option<usize>,
    /// How it was found.
    pub route: Route,
    /// What made how many of the hexes.
    pub stages: Vec<(Maker, usize)>,
    /// Canonical signature of the mesh, for meshes of at most 10,000 hexes.
    pub signature: Option<String>,
    /// What was tried.
    pub tried: Vec<Attempt>,
}

impl FillReport {
    /// The report of one mesh of a result.
    pub fn new(problem: &Problem, filled: &Filled, tried: &[Attempt]) -> Self {
        let (quads, hexes) = (problem.surface.n_quads(), filled.mesh.n_hexes());
        Self {
            surface: problem.name.clone(),
            quads,
            hexes,
            hexes_per_quad: hexes as f64 / quads as f64,
            interior_vertices: filled.mesh.n_interior_vertices(),
            sheets: (hexes <= 1_000_000).then(|| sheets(&filled.mesh).len()),
            route: filled.route,
            stages: filled.stages(),
            signature: (hexes <= 10_000).then(|| hex_signature(&filled.mesh).ok()).flatten(),
            tried: tried.to_vec(),
        }
    }
}
