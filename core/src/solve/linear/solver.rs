//! What a direct solver of linear systems offers, and why it may fail.

use crate::algebra::scalar::Scalar;
use crate::model::structure::Structure;

/// Why a linear system could not be solved.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SolveError {
    /// A pivot is zero: the matrix is singular.
    #[error("the matrix is singular at unknown {0} of the elimination order")]
    Singular(usize),
    /// The matrix or the solution holds a NaN or an infinity.
    #[error("the matrix or the solution is not finite")]
    NotFinite,
    /// The solver wants a chain.
    #[error("the equations are not coupled like a chain")]
    NotAChain,
    /// Not enough memory for the factors.
    #[error("not enough memory for the factors")]
    Memory,
}

/// A direct solver of `A x = b` for matrices of one [`Structure`].
///
/// `analyse` fixes everything that depends on the structure alone; `factor` and `solve` don't allocate after their
/// first call. Vectors are in elimination order.
pub trait LinearSolver<T: Scalar = f64>: Send {
    /// Name in manifests.
    fn name(&self) -> &'static str;
    /// Prepares for a structure.
    fn analyse(&mut self, s: &Structure) -> Result<(), SolveError>;
    /// Factors the matrix with these values, stored as `Structure::rows` says.
    fn factor(&mut self, s: &Structure, values: &[T]) -> Result<(), SolveError>;
    /// Replaces `x`, holding the right-hand side, by the solution.
    fn solve(&mut self, x: &mut [T]);
    /// Number of negative pivots, for solvers that know: by Sylvester's law the number of negative eigenvalues of a
    /// symmetric matrix.
    fn negative_pivots(&self) -> Option<usize> {
        None
    }
    /// How much entries grew in the last factorisation, relative to what they belong to: solutions are right to rounding
    /// times this number. Infinite where the solver doesn't watch it.
    fn growth(&self) -> f64 {
        f64::INFINITY
    }
}
