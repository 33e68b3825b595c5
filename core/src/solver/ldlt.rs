//! Sparse LDLᵀ without pivoting, by faer, in the elimination order of the structure.

use super::{LinearSolver, SolveError};
use crate::pattern::Structure;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LdltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side, Spec};

/// LDLᵀ without pivoting. Needs an order in which no pivot vanishes: that of [`Structure`], where the rows of
/// constraints follow the nodes that they touch.
#[derive(Default)]
pub struct Ldlt {
    symbolic: Option<SymbolicCholesky<usize>>,
    factors: Vec<f64>,
    memory: Option<MemBuffer>,
}

impl LinearSolver for Ldlt {
    fn name(&self) -> &'static str {
        "LDLᵀ (faer)"
    }

    fn analyse(&mut self, s: &Structure) -> Result<(), SolveError> {
        // with the identity ordering faer wants the upper triangle, whatever side it is told
        let symbolic = factorize_symbolic_cholesky(
            SymbolicSparseColMatRef::new_checked(s.n, s.n, &s.columns, None, &s.rows),
            Side::Upper,
            SymmetricOrdering::Identity,
            CholeskySymbolicParams {
                supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SIMPLICIAL,
                ..Default::default()
            },
        )
        .map_err(|_| SolveError::Memory)?;
        let need = symbolic
            .factorize_numeric_ldlt_scratch::<f64>(Par::Seq, Spec::default())
            .or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        self.memory = Some(MemBuffer::try_new(need).map_err(|_| SolveError::Memory)?);
        self.factors = vec![0.0; symbolic.len_val()];
        self.symbolic = Some(symbolic);
        Ok(())
    }

    fn factor(&mut self, s: &Structure, values: &[f64]) -> Result<(), SolveError> {
        let (Some(symbolic), Some(memory)) = (&self.symbolic, &mut self.memory) else {
            return Err(SolveError::Memory);
        };
        let structure = SymbolicSparseColMatRef::new_checked(s.n, s.n, &s.columns, None, &s.rows);
        let a = SparseColMatRef::new(structure, values);
        symbolic
            .factorize_numeric_ldlt(
                &mut self.factors,
                a,
                Side::Upper,
                Default::default(),
                Par::Seq,
                MemStack::new(memory),
                Spec::default(),
            )
            .map(|_| ())
            .map_err(|e| match e {
                faer::linalg::cholesky::ldlt::factor::LdltError::ZeroPivot { index } => {
                    SolveError::Singular(index)
                }
            })
    }

    fn solve(&mut self, x: &mut [f64]) {
        if let (Some(symbolic), Some(memory)) = (&self.symbolic, &mut self.memory) {
            let n = x.len();
            let x = MatMut::from_column_major_slice_mut(x, n, 1);
            LdltRef::new(symbolic, &self.factors).solve_in_place_with_conj(
                Conj::No,
                x,
                Par::Seq,
                MemStack::new(memory),
            );
        }
    }

    fn negative_pivots(&self) -> Option<usize> {
        match self.symbolic.as_ref()?.raw() {
            // D stands at the head of each column of L
            SymbolicCholeskyRaw::Simplicial(l) => {
                let heads = &l.col_ptr()[..l.col_ptr().len() - 1];
                Some(heads.iter().filter(|&&p| self.factors[p] < 0.0).count())
            }
            SymbolicCholeskyRaw::Supernodal(_) => None,
        }
    }
}
