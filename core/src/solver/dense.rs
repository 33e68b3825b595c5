//! Dense LU with full pivoting, by nalgebra: the oracle that the sparse solvers are tested against.

use super::{LinearSolver, SolveError};
use crate::pattern::Structure;
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
        for c in 0..s.n {
            for p in s.columns[c]..s.columns[c + 1] {
                a[(s.rows[p], c)] = values[p];
                if s.symmetric {
                    a[(c, s.rows[p])] = values[p];
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
