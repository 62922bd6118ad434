//! What shelling tries.
//!
//! Source: ours.

/// What to try.
///
/// | option | default |
/// |---|---|
/// | restarts, seeds | 64, 4 |
/// | pillows | 0 and 1 |
/// | meshes that need no sweep, sweeps | yes |
/// | candidates | 3 |
/// | largest residual | any |
#[derive(Clone, Debug)]
pub struct ShellOptions {
    pub(crate) restarts: u64,
    pub(crate) seeds: u64,
    pub(crate) pillows: Vec<u32>,
    pub(crate) is_direct: bool,
    pub(crate) is_swept: bool,
    pub(crate) candidates: usize,
    pub(crate) largest_residual: usize,
}

impl Default for ShellOptions {
    fn default() -> Self {
        Self {
            restarts: 64,
            seeds: 4,
            pillows: vec![0, 1],
            is_direct: true,
            is_swept: true,
            candidates: 3,
            largest_residual: usize::MAX,
        }
    }
}

impl ShellOptions {
    /// Restarts of the solver by layers, for each number of pillows.
    #[must_use]
    pub fn with_restarts(self, restarts: u64) -> Self {
        Self { restarts, ..self }
    }

    /// Seeds of the sweep by flips, for each number of pillows.
    #[must_use]
    pub fn with_seeds(self, seeds: u64) -> Self {
        Self { seeds, ..self }
    }

    /// Numbers of pillows to try, one after the other.
    #[must_use]
    pub fn with_pillows(self, pillows: Vec<u32>) -> Self {
        Self { pillows, ..self }
    }

    /// Whether the grid, sections and columns between components, which need no sweep, are asked first.
    #[must_use]
    pub fn with_direct(self, is_direct: bool) -> Self {
        Self { is_direct, ..self }
    }

    /// Whether the surface is swept.
    #[must_use]
    pub fn with_sweeps(self, is_swept: bool) -> Self {
        Self { is_swept, ..self }
    }

    /// Most meshes returned for each number of pillows.
    #[must_use]
    pub fn with_candidates(self, candidates: usize) -> Self {
        Self { candidates, ..self }
    }

    /// Most quads of a residual that is filled; where every sweep leaves more there is no mesh, and none is waited for.
    #[must_use]
    pub fn with_largest_residual(self, largest_residual: usize) -> Self {
        Self { largest_residual, ..self }
    }

    /// Restarts of the solver by layers.
    pub fn restarts(&self) -> u64 {
        self.restarts
    }

    /// Seeds of the sweep by flips.
    pub fn seeds(&self) -> u64 {
        self.seeds
    }

    /// Whether the surface is swept.
    pub fn is_swept(&self) -> bool {
        self.is_swept
    }

    /// Most meshes for each number of pillows.
    pub fn candidates(&self) -> usize {
        self.candidates
    }
}
