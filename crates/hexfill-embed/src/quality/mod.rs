//! How good positions are: all cells of a mesh judged, and two embeddings compared.
//!
//! Source: ours.

mod verdict;
mod worst_cells;

pub(crate) use verdict::Verdict;
pub(crate) use worst_cells::{
    Cells, Precision, WORKING_BOXES, WorstOfCell, bad_cells, corner_points, judge, judge_near_worst, judge_within,
    log_condition_of, worst_log_condition, worst_value,
};
