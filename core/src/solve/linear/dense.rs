//! Dense LU with full pivoting, by nalgebra: the oracle that the sparse solvers are tested against.

use super::solver::{LinearSolver, SolveError};
use crate::model::structure::Structure;
use nalgebra::{DMatrix, DVectorViewMut, Dyn, FullPivLU};

/// Dense LU with full pivoting. Slow and trustworthy; for tests and small systems.
#[derive(Default)]
pub struct Dense {
    lu: Option<FullPivLU<f64, Dyn, Dyn>>,
}

impl LinearSolver for Dense {
    fn name(&self) -> &'static str {
        "dense LU with full pivoting (nalgebra)"
    }
    fn analyse(&mut self, _: &Structure) -> Result<(), SolveError> {
        Ok(())
    }
    fn factor(&mut self, s: &Structure, values: &[f64]) -> Result<(), SolveError> {
        let mut a = DMatrix::zeros(s.n, s.n);
        for (r, columns, at) in s.rows() {
            for (k, &v) in values[at].iter().enumerate() {
                a[(r, columns.get(k))] = v;
                if s.symmetric {
                    a[(columns.get(k), r)] = v;
                }
            }
        }
        let lu = a.full_piv_lu();
        let fine = lu.is_invertible();
        self.lu = Some(lu);
        if fine { Ok(()) } else { Err(SolveError::Singular(s.n)) }
    }
    fn solve(&mut self, x: &mut [f64]) {
        if let Some(lu) = &self.lu {
            let n = x.len();
            lu.solve_mut(&mut DVectorViewMut::from_slice(x, n));
        }
    }
}
