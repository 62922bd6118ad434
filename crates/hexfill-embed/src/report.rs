//! What came of a request: [`Embedding`] and its [`EmbedReport`].

use crate::bounds::StarBound;
use crate::options::Objective;
use crate::serial::serialize_hex;
use hexfill_mesh::{HexId, StopReason};
use serde::Serialize;

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
