//! Requests: [`Options`] and [`Objective`].

use serde::Serialize;

/// What the coordinates should be good at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Objective {
    /// det J > 0 in every cell, no more.
    UntangleOnly,
    /// The largest worst scaled Jacobian.
    #[default]
    ScaledJacobian,
    /// The smallest worst condition number with a worst scaled Jacobian of at least 95 % of the optimum found.
    Balanced,
}

/// How to embed. Results depend on these and on [`hexfill_mesh::Context::seed`], not on the number of threads.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// What to strive for. Default: [`Objective::ScaledJacobian`].
    pub objective: Objective,
    /// Starts at most. Default: 0, which chooses by size: 8 up to 100 hexes, 4 up to 400, and beyond that as many as it takes to find
    /// one that is valid, up to 4 (above 5000 hexes 2, or only the one given). One, if the star bounds say that no placement is valid.
    pub starts: u32,
    /// Keep to positions with the symmetries of the boundary that are automorphisms of the mesh: fewer variables, a
    /// symmetric result. Without effect if there are none. The whole mesh is worked on at once, whatever the limits below. Default: false.
    pub symmetric: bool,
    /// Take a given start for a guess of the graph-Laplacian one: it is smoothed first. Default: false.
    pub smooth_start: bool,
    /// Worker threads. Default: 0, which uses the threads of the surrounding pool.
    pub threads: usize,
    /// Linear programs at most, a start. Default: 150.
    pub programs: usize,
    /// Meshes with more hexes than this are optimised patch by patch. Default: 400.
    pub whole_limit: usize,
    /// Meshes with more hexes than this are untangled patch by patch, too. Default: 20,000.
    pub local_limit: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            objective: Objective::default(),
            starts: 0,
            symmetric: false,
            smooth_start: false,
            threads: 0,
            programs: 150,
            whole_limit: 400,
            local_limit: 20_000,
        }
    }
}

impl Options {
    /// The defaults with this objective.
    pub fn new(objective: Objective) -> Self {
        Self { objective, ..Self::default() }
    }
}
