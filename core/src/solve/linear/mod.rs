//! Linear solvers behind one trait, and the guard that uses them: factor without pivoting, check the backward error
//! where entries have grown, refine once, and fall back to LU with pivoting.

mod chain;
mod check;
mod dense;
mod fronts;
mod growth;
mod lu;
mod solver;

pub use chain::Chain;
pub use dense::Dense;
pub use fronts::Fronts;
pub use lu::Lu;
pub use solver::{LinearSolver, SolveError};

use crate::algebra::scalar::Scalar;
use crate::model::structure::Structure;
use check::Check;
use faer::c64;

/// Solves systems of one structure and never returns a bad solution unnoticed.
pub struct Guard<T: Scalar = f64> {
    primary: Box<dyn LinearSolver<T>>,
    fallback: Lu<T>,
    fallback_ready: bool,
    use_fallback: bool,
    unchecked: bool,
    b: Vec<T>,
    check: Check<T>,
    /// Factorisations so far.
    pub factorizations: u64,
    /// How often LU with pivoting had to step in.
    pub fallbacks: u64,
}

/// Growth of the entries up to which a factorisation without pivoting needs no check: a backward error of some 1e-13.
const HARMLESS: f64 = 100.0;
/// Backward error that a factorisation without pivoting is allowed before it is refined [componentwise].
const REFINE: f64 = 1e-12;
/// Backward error after refinement from which on LU with pivoting takes over.
const GIVE_UP: f64 = 1e-9;

impl Guard {
    /// The solver that suits a structure: block elimination along the chain, or along the tree where there are branches
    /// and rings.
    pub fn new(s: &Structure) -> Result<Self, SolveError> {
        Self::suiting(s)
    }
}

impl Guard<c64> {
    /// As [`Guard::new`], for complex matrices.
    pub fn complex(s: &Structure) -> Result<Self, SolveError> {
        Self::suiting(s)
    }
}

impl<T: Scalar> Guard<T> {
    fn suiting(s: &Structure) -> Result<Self, SolveError> {
        if s.chain {
            Self::with(s, Box::new(Chain::default()))
        } else {
            Self::with(s, Box::new(Fronts::default()))
        }
    }

    /// A guard around a solver of one's own choice.
    pub fn with(s: &Structure, mut primary: Box<dyn LinearSolver<T>>) -> Result<Self, SolveError> {
        primary.analyse(s)?;
        Ok(Guard {
            primary,
            fallback: Lu::default(),
            fallback_ready: false,
            use_fallback: false,
            unchecked: true,
            b: vec![T::default(); s.n],
            check: Check::new(s.n),
            factorizations: 0,
            fallbacks: 0,
        })
    }

    /// Name of the solver in use.
    pub fn name(&self) -> &'static str {
        self.primary.name()
    }

    /// Whether the next solution leaves the factors as they are: it needs no check, or the one before had it.
    pub(crate) fn is_settled(&self) -> bool {
        !self.unchecked
    }

    /// Factors the matrix.
    pub fn factor(&mut self, s: &Structure, values: &[T]) -> Result<(), SolveError> {
        self.factor_as_it_is(s, values).or_else(|_| self.fall_back(s, values))
    }

    /// Factors the matrix without pivoting, for whom it is no use where that fails.
    pub(crate) fn factor_as_it_is(&mut self, s: &Structure, values: &[T]) -> Result<(), SolveError> {
        self.factorizations += 1;
        self.unchecked = true;
        self.use_fallback = false;
        self.primary.factor(s, values)?;
        // a NaN is no small growth
        self.unchecked = !(self.primary.growth() <= HARMLESS);
        Ok(())
    }

    fn fall_back(&mut self, s: &Structure, values: &[T]) -> Result<(), SolveError> {
        self.fallbacks += 1;
        if !self.fallback_ready {
            self.fallback.analyse(s)?;
            self.fallback_ready = true;
        }
        self.fallback.factor(s, values)?;
        self.use_fallback = true;
        Ok(())
    }

    fn raw_solve(&mut self, x: &mut [T]) {
        if self.use_fallback { self.fallback.solve(x) } else { self.primary.solve(x) }
    }

    /// Replaces `x`, holding the right-hand side, by the solution. Where entries have grown, the first solution with each
    /// factorisation is checked, refined once if need be, and taken from LU with pivoting, refined as well, if that
    /// doesn't help.
    pub fn solve(&mut self, s: &Structure, values: &[T], x: &mut [T]) -> Result<(), SolveError> {
        if !self.unchecked {
            self.raw_solve(x);
            // without branches, for all of them to be looked at side by side
            let finite = x.iter().fold(true, |finite, v| finite & Scalar::is_finite(*v));
            return if finite { Ok(()) } else { Err(SolveError::NotFinite) };
        }
        self.b.copy_from_slice(x);
        self.raw_solve(x);
        let mut error = self.check.error(s, values, x, &self.b, REFINE);
        if !(error <= REFINE) && error.is_finite() {
            error = self.refine(s, values, x);
        }
        if !(error <= GIVE_UP) && !self.use_fallback {
            self.fall_back(s, values)?;
            x.copy_from_slice(&self.b);
            self.raw_solve(x);
            error = self.check.error(s, values, x, &self.b, GIVE_UP);
            // pivoting alone leaves small numbers to the rounding of the large ones
            if !(error <= GIVE_UP) && error.is_finite() {
                error = self.refine(s, values, x);
            }
        }
        self.unchecked = false;
        if error <= 1e-4 { Ok(()) } else { Err(SolveError::NotFinite) }
    }

    /// Corrects a solution by what its last check has left, and checks it again.
    fn refine(&mut self, s: &Structure, values: &[T], x: &mut [T]) -> f64 {
        let mut dx = std::mem::take(&mut self.check.residual);
        self.raw_solve(&mut dx);
        for (x, d) in x.iter_mut().zip(&dx) {
            *x -= *d;
        }
        self.check.residual = dx;
        self.check.error(s, values, x, &self.b, GIVE_UP)
    }

    /// Number of negative pivots, where the solver in use knows it.
    pub fn negative_pivots(&self) -> Option<usize> {
        if self.use_fallback { None } else { self.primary.negative_pivots() }
    }
}

#[cfg(test)]
mod samples;
#[cfg(test)]
mod tests;
