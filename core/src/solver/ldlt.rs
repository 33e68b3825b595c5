//! Sparse LDLᵀ without pivoting, by faer, in the elimination order of the structure.

use super::{LinearSolver, SolveError};
use crate::structure::Structure;
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
    columns: Vec<usize>,
    rows: Vec<usize>,
    /// For each entry, where the structure stores it.
    source: Vec<u32>,
    values: Vec<f64>,
    factors: Vec<f64>,
    memory: Option<MemBuffer>,
}

impl LinearSolver for Ldlt {
    fn name(&self) -> &'static str {
        "LDLᵀ (faer)"
    }

    fn analyse(&mut self, s: &Structure) -> Result<(), SolveError> {
        // with the identity ordering faer wants the upper triangle column by column, whatever side it is told
        let mut upper: Vec<(usize, usize, u32)> = Vec::with_capacity(s.entries());
        for (r, columns, at) in s.rows() {
            upper.extend(at.enumerate().map(|(k, p)| (columns.get(k), r, p as u32)));
        }
        upper.sort_unstable();
        self.columns = vec![0; s.n + 1];
        for &(c, _, _) in &upper {
            self.columns[c + 1] += 1;
        }
        for c in 0..s.n {
            self.columns[c + 1] += self.columns[c];
        }
        self.rows = upper.iter().map(|e| e.1).collect();
        self.source = upper.iter().map(|e| e.2).collect();
        self.values = vec![0.0; upper.len()];
        let symbolic = factorize_symbolic_cholesky(
            SymbolicSparseColMatRef::new_checked(s.n, s.n, &self.columns, None, &self.rows),
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
        for (v, &p) in self.values.iter_mut().zip(&self.source) {
            *v = values[p as usize];
        }
        let structure = SymbolicSparseColMatRef::new_checked(s.n, s.n, &self.columns, None, &self.rows);
        let a = SparseColMatRef::new(structure, &self.values);
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
