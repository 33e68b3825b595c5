//! Sparse LU with partial pivoting, by faer: what steps in where elimination without pivoting isn't good enough.

use super::solver::{LinearSolver, SolveError};
use crate::algebra::scalar::Scalar;
use crate::model::structure::Structure;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::lu::{LuRef, LuSymbolicParams, NumericLu, SymbolicLu, factorize_symbolic_lu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Spec};

/// LU with partial pivoting. Takes symmetric storage too, which it expands.
pub struct Lu<T = f64> {
    symbolic: Option<SymbolicLu<usize>>,
    numeric: Option<NumericLu<usize, T>>,
    memory: Option<MemBuffer>,
    columns: Vec<usize>,
    rows: Vec<usize>,
    /// For each full entry, the stored entry that it comes from.
    source: Vec<usize>,
    values: Vec<T>,
}

impl<T> Default for Lu<T> {
    fn default() -> Self {
        Lu {
            symbolic: None,
            numeric: None,
            memory: None,
            columns: Vec::new(),
            rows: Vec::new(),
            source: Vec::new(),
            values: Vec::new(),
        }
    }
}

impl<T: Scalar> LinearSolver<T> for Lu<T> {
    fn name(&self) -> &'static str {
        "LU with pivoting (faer)"
    }

    fn analyse(&mut self, s: &Structure) -> Result<(), SolveError> {
        let mut full: Vec<(usize, usize, usize)> = Vec::new();
        for (r, columns, at) in s.rows() {
            for (k, p) in at.enumerate() {
                let c = columns.get(k);
                full.push((c, r, p));
                if s.symmetric && r != c {
                    full.push((r, c, p));
                }
            }
        }
        full.sort_unstable();
        self.columns = vec![0; s.n + 1];
        for &(c, _, _) in &full {
            self.columns[c + 1] += 1;
        }
        for c in 0..s.n {
            self.columns[c + 1] += self.columns[c];
        }
        self.rows = full.iter().map(|e| e.1).collect();
        self.source = full.iter().map(|e| e.2).collect();
        self.values = vec![T::default(); full.len()];
        let symbolic = factorize_symbolic_lu(
            SymbolicSparseColMatRef::new_checked(s.n, s.n, &self.columns, None, &self.rows),
            LuSymbolicParams {
                // the supernodal variant allocates at every refactorisation
                supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SIMPLICIAL,
                ..Default::default()
            },
        )
        .map_err(|_| SolveError::Memory)?;
        let need = symbolic
            .factorize_numeric_lu_scratch::<T>(Par::Seq, Spec::default())
            .or(symbolic.solve_in_place_scratch::<T>(1, Par::Seq));
        self.memory = Some(MemBuffer::try_new(need).map_err(|_| SolveError::Memory)?);
        self.numeric = Some(NumericLu::new());
        self.symbolic = Some(symbolic);
        Ok(())
    }

    fn factor(&mut self, s: &Structure, values: &[T]) -> Result<(), SolveError> {
        let (Some(symbolic), Some(numeric), Some(memory)) =
            (&self.symbolic, &mut self.numeric, &mut self.memory)
        else {
            return Err(SolveError::Memory);
        };
        // faer would return NaN factors without a word
        if values.iter().any(|v| !Scalar::is_finite(*v)) {
            return Err(SolveError::NotFinite);
        }
        for (v, &p) in self.values.iter_mut().zip(&self.source) {
            *v = values[p];
        }
        let structure = SymbolicSparseColMatRef::new_checked(s.n, s.n, &self.columns, None, &self.rows);
        let a = SparseColMatRef::new(structure, &self.values);
        symbolic
            .factorize_numeric_lu(numeric, a, Par::Seq, MemStack::new(memory), Spec::default())
            .map(|_| ())
            .map_err(|e| match e {
                faer::sparse::linalg::LuError::SymbolicSingular { index } => SolveError::Singular(index),
                faer::sparse::linalg::LuError::Generic(_) => SolveError::Memory,
            })
    }

    fn solve(&mut self, x: &mut [T]) {
        if let (Some(symbolic), Some(numeric), Some(memory)) =
            (&self.symbolic, &self.numeric, &mut self.memory)
        {
            let n = x.len();
            let x = MatMut::from_column_major_slice_mut(x, n, 1);
            let lu = LuRef::new_unchecked(symbolic, numeric);
            lu.solve_in_place_with_conj(Conj::No, x, Par::Seq, MemStack::new(memory));
        }
    }
}
