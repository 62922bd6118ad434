//! Requests and what came of them: [`Options`], [`Embedding`], [`EmbedReport`].

use crate::star::StarBound;
use hexfill_mesh::{HexId, StopReason};
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
    /// What to strive for.
    pub objective: Objective,
    /// Starts at most; 0 chooses by size: 8 up to 100 hexes, 4 up to 400, and beyond that as many as it takes to find
    /// one that is valid, up to 4 (above 5000 hexes 2, or only the one given). One, if the star bounds say that no placement is valid.
    pub starts: u32,
    /// Keep to positions with the symmetries of the boundary that are automorphisms of the mesh: fewer variables, a
    /// symmetric result. Without effect if there are none. The whole mesh is worked on at once, whatever the limits below.
    pub symmetric: bool,
    /// Take a given start for a guess of the graph-Laplacian one: it is smoothed first.
    pub smooth_start: bool,
    /// Worker threads; 0 uses the threads of the surrounding pool.
    pub threads: usize,
    /// Linear programs at most, a start.
    pub programs: usize,
    /// Meshes with more hexes than this are optimised patch by patch.
    pub whole_limit: usize,
    /// Meshes with more hexes than this are untangled patch by patch, too.
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

/// Coordinates and their report.
#[derive(Clone, Debug, PartialEq)]
pub struct Embedding {
    /// One point per vertex; boundary vertices have the bits they were given.
    pub points: Vec<[f64; 3]>,
    /// What was found and how.
    pub report: EmbedReport,
}

/// A cell and its worst scaled Jacobian.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CellQuality {
    /// The cell.
    #[serde(serialize_with = "serialize_hex")]
    pub hex: HexId,
    /// The smallest scaled Jacobian seen in it; not positive for a cell that is not valid.
    pub scaled_jacobian: f64,
}

fn serialize_hex<S: serde::Serializer>(h: &HexId, s: S) -> Result<S::Ok, S::Error> {
    s.serialize_u32(h.0)
}

fn serialize_stop<S: serde::Serializer>(stop: &StopReason, s: S) -> Result<S::Ok, S::Error> {
    s.serialize_str(match stop {
        StopReason::Finished => "finished",
        StopReason::Cancelled => "cancelled",
        StopReason::TimeLimit => "time-limit",
        StopReason::MemoryLimit => "memory-limit",
    })
}

/// What embedding found. Everything here was computed in floating point; certificates are made by `hexfill-check`.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct EmbedReport {
    /// What was asked for.
    pub objective: Objective,
    /// Whether det J > 0 in every cell, judged in floating point over whole cells at the points returned.
    pub valid_in_floating_point: bool,
    /// Number of cells that are not valid.
    pub n_invalid: usize,
    /// How many symmetries the positions were made to share; 1 unless asked for.
    pub symmetries: usize,
    /// Starts made.
    pub starts: u32,
    /// Starts that came out valid.
    pub valid_starts: u32,
    /// The start the result came from (0 is the given or the unit-weight one; the last one of a small mesh with symmetries
    /// starts from symmetric positions).
    pub best_start: u32,
    /// The worst scaled Jacobian: no smaller value was seen in any cell; not positive if a cell is not valid.
    pub scaled_jacobian: f64,
    /// A lower bound on the worst scaled Jacobian over whole cells (Bernstein form, up to rounding); -1 if none is known.
    pub scaled_jacobian_bound: f64,
    /// The largest condition number at a corner (Verdict's); infinite if a corner is not positive.
    pub condition: f64,
    /// The shortest edge, in the unit of the input.
    pub shortest_edge: f64,
    /// The ten worst cells, worst first.
    pub worst_cells: Vec<CellQuality>,
    /// The smallest bound by the star of a vertex: no placement of the interior vertices has a larger worst scaled Jacobian (if the
    /// surface does not cross itself, see [`StarBound::angle_bound`]). Stars inside count by their numbers of hexes.
    pub upper_bound: f64,
    /// The worst scaled Jacobian strived for: the upper bound, of which meshes of more than 2000 hexes are spared the last 0.5 %.
    pub target: f64,
    /// The ten smallest vertex-star bounds on the boundary, smallest first.
    pub star_bounds: Vec<StarBound>,
    /// Why the work ended.
    #[serde(serialize_with = "serialize_stop")]
    pub stop: StopReason,
}

impl EmbedReport {
    /// Whether the boundary itself rules out any valid embedding: some vertex star has a bound below zero by more than
    /// rounding error. The only case in which "no embedding exists with this boundary" may be said.
    pub fn is_impossible(&self) -> bool {
        is_impossible(self.upper_bound)
    }
}

pub(crate) fn is_impossible(upper_bound: f64) -> bool {
    upper_bound < -1e-12
}
