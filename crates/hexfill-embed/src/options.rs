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
///
/// | option | default |
/// |---|---|
/// | objective | [`Objective::ScaledJacobian`] |
/// | starts | 0: by size |
/// | symmetric, smooth start | no |
/// | threads | 0: those of the surrounding pool |
/// | programs | 150 |
/// | whole limit, local limit | 400, 20,000 hexes |
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    pub(crate) objective: Objective,
    pub(crate) starts: u32,
    pub(crate) symmetric: bool,
    pub(crate) smooth_start: bool,
    pub(crate) threads: usize,
    pub(crate) programs: usize,
    pub(crate) whole_limit: usize,
    pub(crate) local_limit: usize,
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

    /// Starts at most. 0 chooses by size: 8 up to 100 hexes, 4 up to 400, and beyond that as many as it takes to find
    /// one that is valid, up to 4 (above 5000 hexes 2, or only the one given). One, if the star bounds say that no placement is valid.
    #[must_use]
    pub fn with_starts(self, starts: u32) -> Self {
        Self { starts, ..self }
    }

    /// Keep to positions with the symmetries of the boundary that are automorphisms of the mesh: fewer variables, a
    /// symmetric result. Without effect if there are none. The whole mesh is worked on at once, whatever the limits below.
    #[must_use]
    pub fn with_symmetric(self, symmetric: bool) -> Self {
        Self { symmetric, ..self }
    }

    /// Take a given start for a guess of the graph-Laplacian one: it is smoothed first.
    #[must_use]
    pub fn with_smooth_start(self, smooth_start: bool) -> Self {
        Self { smooth_start, ..self }
    }

    /// Worker threads. 0 uses the threads of the surrounding pool.
    #[must_use]
    pub fn with_threads(self, threads: usize) -> Self {
        Self { threads, ..self }
    }

    /// Linear programs at most, a start.
    #[must_use]
    pub fn with_programs(self, programs: usize) -> Self {
        Self { programs, ..self }
    }

    /// Meshes with more hexes than this are optimised patch by patch.
    #[must_use]
    pub fn with_whole_limit(self, whole_limit: usize) -> Self {
        Self { whole_limit, ..self }
    }

    /// Meshes with more hexes than this are untangled patch by patch, too.
    #[must_use]
    pub fn with_local_limit(self, local_limit: usize) -> Self {
        Self { local_limit, ..self }
    }

    /// Starts at most; 0: by size.
    pub fn starts(&self) -> u32 {
        self.starts
    }

    /// Linear programs at most, a start.
    pub fn programs(&self) -> usize {
        self.programs
    }
}
