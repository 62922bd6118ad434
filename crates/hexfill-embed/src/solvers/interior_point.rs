//! A linear or convex quadratic program in inequality form, handed to the interior-point solver.
//!
//! The solver runs on one thread with fixed settings, so the same program gives the same answer every time.
//!
//! Source: Goulart, Chen 2024 (the solver, Clarabel).

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus};

/// Minimise `x' P x / 2 + cost . x` subject to rows `a . x <= bound`.
#[derive(Clone, Debug, Default)]
pub(crate) struct Program {
    cost: Vec<f64>,
    quadratic: [Vec<usize>; 2],
    quadratic_values: Vec<f64>,
    rows: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
    bounds: Vec<f64>,
}

/// The solution of a [`Program`]: the point and the multipliers of the rows.
#[derive(Clone, Debug)]
pub(crate) struct Solution {
    pub(crate) point: Vec<f64>,
    pub(crate) multipliers: Vec<f64>,
}

impl Program {
    /// A program with this linear cost and no rows.
    pub(crate) fn new(cost: Vec<f64>) -> Self {
        Self { cost, ..Self::default() }
    }

    /// Adds the row `sum of coefficients <= bound`; coefficients are (variable, value), each variable at most once.
    pub(crate) fn row(&mut self, coefficients: impl IntoIterator<Item = (usize, f64)>, bound: f64) {
        let row = self.bounds.len();
        for (column, value) in coefficients {
            self.rows.push(row);
            self.columns.push(column);
            self.values.push(value);
        }
        self.bounds.push(bound);
    }

    /// Adds `value` to entry (i, j) of P, given once for i <= j (the other half is understood).
    pub(crate) fn curvature(&mut self, i: usize, j: usize, value: f64) {
        self.quadratic[0].push(i.min(j));
        self.quadratic[1].push(i.max(j));
        self.quadratic_values.push(value);
    }

    /// Number of rows so far.
    pub(crate) fn n_rows(&self) -> usize {
        self.bounds.len()
    }

    /// Solves; `None` if the solver gives up.
    pub(crate) fn solve(self) -> Option<Solution> {
        let n = self.cost.len();
        let m = self.bounds.len();
        let [i, j] = self.quadratic;
        let p = CscMatrix::new_from_triplets(n, n, i, j, self.quadratic_values);
        let a = CscMatrix::new_from_triplets(m, n, self.rows, self.columns, self.values);
        let settings = DefaultSettings {
            verbose: false,
            max_iter: 60,
            tol_gap_abs: 1e-10,
            tol_gap_rel: 1e-10,
            tol_feas: 1e-10,
            presolve_enable: false,
            max_threads: 1,
            ..DefaultSettings::default()
        };
        let mut solver = DefaultSolver::new(&p, &self.cost, &a, &self.bounds, &[NonnegativeConeT(m)], settings).ok()?;
        solver.solve();
        let usable = matches!(
            solver.solution.status,
            SolverStatus::Solved | SolverStatus::AlmostSolved | SolverStatus::InsufficientProgress
        );
        let point = solver.solution.x;
        (usable && point.iter().all(|x| x.is_finite())).then_some(Solution { point, multipliers: solver.solution.z })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_linear_and_a_small_quadratic_program() {
        // max x + 2 y, x + y <= 1, x, y >= 0.
        let mut lp = Program::new(vec![-1.0, -2.0]);
        lp.row([(0, 1.0), (1, 1.0)], 1.0);
        lp.row([(0, -1.0)], 0.0);
        lp.row([(1, -1.0)], 0.0);
        let s = lp.clone().solve().unwrap();
        assert!(s.point[0].abs() < 1e-8 && (s.point[1] - 1.0).abs() < 1e-8);
        assert!((s.multipliers[0] - 2.0).abs() < 1e-7);
        // + x^2/2 + y^2: unconstrained minimum (1, 1) cut to x + y <= 1.
        lp.curvature(0, 0, 1.0);
        lp.curvature(1, 1, 2.0);
        let s = lp.solve().unwrap();
        assert!((s.point[0] - 1.0 / 3.0).abs() < 1e-7 && (s.point[1] - 2.0 / 3.0).abs() < 1e-7, "{:?}", s.point);
    }
}
