//! [`Verdict`]: which of two embeddings of a mesh is better.
//!
//! Source: ours.

use super::worst_cells::{bad_cells, worst_value};
use crate::problem::Problem;
use hexfill_geometry::Vector;
use std::cmp::Ordering;

/// What an embedding is worth. The greater is the better: validity first, that is fewer cells that are not positive, then the larger worst
/// scaled Jacobian.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Verdict {
    /// Cells that are not positive.
    pub(crate) n_bad: usize,
    /// The worst scaled Jacobian over whole cells.
    pub(crate) worst: f64,
}

impl Verdict {
    /// Judges the cells at `points`.
    pub(crate) fn of(problem: &Problem, points: &[Vector]) -> Self {
        Self::with_bad(problem, points, bad_cells(problem, points).len())
    }

    /// The same, where it is known how many cells are bad.
    pub(crate) fn with_bad(problem: &Problem, points: &[Vector], n_bad: usize) -> Self {
        Self { n_bad, worst: worst_value(problem, points) }
    }

    /// Whether all cells are positive.
    pub(crate) fn is_valid(self) -> bool {
        self.n_bad == 0
    }
}

impl Ord for Verdict {
    fn cmp(&self, other: &Self) -> Ordering {
        other.n_bad.cmp(&self.n_bad).then(self.worst.total_cmp(&other.worst))
    }
}

impl PartialOrd for Verdict {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Verdict {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Verdict {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_comes_first_then_the_worst_cell() {
        let verdict = |n_bad, worst| Verdict { n_bad, worst };
        assert!(verdict(0, 0.01) > verdict(1, 0.0) && verdict(1, -0.9) > verdict(2, -0.1));
        assert!(verdict(0, 0.2) > verdict(0, 0.1) && verdict(3, 0.1) == verdict(3, 0.1));
    }
}
