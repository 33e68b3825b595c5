//! Block elimination along a chain, without pivoting between blocks or inside of them.
//!
//! Each block is eliminated in a small dense front: its own rows `[D E]` and those of the next block that it is coupled
//! with, `[F 0]`. What is left in the corner is carried on to the next block. The usual front, two nodes of a cable
//! with six unknowns each, is unrolled and runs in vector registers; a symmetric matrix needs half of it. The order of
//! [`Structure`] keeps this stable (multipliers follow their nodes); the [`Guard`](super::Guard) checks.

use super::{LinearSolver, Scalar, SolveError};
use crate::lane::{LaneTask, Real, Width, run};
use crate::structure::{LARGEST, Structure};

/// `L U` of a chain, symmetric or not.
#[derive(Default)]
pub struct Chain<T = f64> {
    steps: Vec<Step>,
    symmetric: bool,
    /// Rows of `U`, each as long as its front is wide.
    upper: Vec<T>,
    /// Columns of `L`, stored like the rows of `U`; empty for symmetric matrices, where they are those rows times the
    /// reciprocal pivot.
    lower: Vec<T>,
    /// Reciprocal pivots.
    inverse: Vec<T>,
    negative: usize,
}

/// The elimination of one block.
#[derive(Clone, Copy, Debug)]
struct Step {
    /// Position of its first row.
    first: usize,
    /// Its rows, and those of the next block.
    size: usize,
    next: usize,
    /// Storage of its diagonal block and of the next block's rows, and the lengths of these rows.
    at: usize,
    stride: usize,
    at_next: usize,
    stride_next: usize,
    /// Width of its front, and where its factors are stored.
    width: Front,
    factors: usize,
}

/// Width of a front: two nodes of a cable, two rigid bodies with a spherical joint each, and the largest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Front {
    Cable = 12,
    Middle = 20,
    Large = 32,
}

/// What the elimination of a block leaves for the next.
type Carried<T> = [[T; LARGEST]; LARGEST];

impl<T: Scalar> LinearSolver<T> for Chain<T> {
    fn name(&self) -> &'static str {
        "block elimination along the chain"
    }

    fn analyse(&mut self, s: &Structure) -> Result<(), SolveError> {
        if !s.chain {
            return Err(SolveError::NotAChain);
        }
        self.symmetric = s.symmetric;
        self.steps.clear();
        let mut factors = 0;
        for (k, b) in s.blocks.iter().enumerate() {
            let next = s.blocks.get(k + 1);
            let columns = b.size + next.map_or(0, |n| n.size);
            let before = b.width() - columns;
            let width = match columns {
                ..=12 => Front::Cable,
                13..=20 => Front::Middle,
                _ => Front::Large,
            };
            self.steps.push(Step {
                first: b.first,
                size: b.size,
                next: columns - b.size,
                at: b.base + before,
                stride: b.width(),
                at_next: next.map_or(0, |n| n.base),
                stride_next: next.map_or(0, |n| n.width()),
                width,
                factors,
            });
            factors += b.size * width as usize;
        }
        self.upper = vec![T::default(); factors];
        self.lower = vec![T::default(); if s.symmetric { 0 } else { factors }];
        self.inverse = vec![T::default(); s.n];
        Ok(())
    }

    fn factor(&mut self, _: &Structure, values: &[T]) -> Result<(), SolveError> {
        let mut result = Ok(());
        run(Width::best(), Factor { chain: self, values, result: &mut result });
        result
    }

    fn solve(&mut self, x: &mut [T]) {
        run(Width::best(), Solve { chain: self, x });
    }

    fn negative_pivots(&self) -> Option<usize> {
        Some(self.negative)
    }
}

struct Factor<'a, T> {
    chain: &'a mut Chain<T>,
    values: &'a [T],
    result: &'a mut Result<(), SolveError>,
}

impl<T: Scalar> LaneTask for Factor<'_, T> {
    #[inline(always)]
    fn go<R: Real>(self) {
        *self.result = if R::LANES > 1 {
            self.chain.eliminate::<true>(self.values)
        } else {
            self.chain.eliminate::<false>(self.values)
        };
    }
}

struct Solve<'a, T> {
    chain: &'a Chain<T>,
    x: &'a mut [T],
}

impl<T: Scalar> LaneTask for Solve<'_, T> {
    #[inline(always)]
    fn go<R: Real>(self) {
        if R::LANES > 1 {
            self.chain.substitute::<true>(self.x)
        } else {
            self.chain.substitute::<false>(self.x)
        }
    }
}

impl<T: Scalar> Chain<T> {
    #[inline(always)]
    fn eliminate<const FUSED: bool>(&mut self, values: &[T]) -> Result<(), SolveError> {
        let mut carried: Carried<T> = [[T::default(); LARGEST]; LARGEST];
        self.negative = 0;
        for k in 0..self.steps.len() {
            let s = self.steps[k];
            match (s.width, s.size, s.next) {
                // the sizes as constants, for the compiler to unroll
                (Front::Cable, 6, 6) => {
                    self.front::<12, FUSED>(&Step { size: 6, next: 6, ..s }, values, &mut carried)?;
                }
                (Front::Cable, ..) => self.front::<12, FUSED>(&s, values, &mut carried)?,
                (Front::Middle, ..) => self.front::<20, FUSED>(&s, values, &mut carried)?,
                (Front::Large, ..) => self.front::<32, FUSED>(&s, values, &mut carried)?,
            }
        }
        Ok(())
    }

    /// Eliminates one block.
    #[inline(always)]
    fn front<const W: usize, const FUSED: bool>(
        &mut self,
        s: &Step,
        values: &[T],
        carried: &mut Carried<T>,
    ) -> Result<(), SolveError> {
        let (size, all) = (s.size, s.size + s.next);
        let mut front = [[T::default(); W]; W];
        for i in 0..size {
            let row = &values[s.at + i * s.stride..][..all];
            front[i][..all].copy_from_slice(row);
            for j in 0..size {
                front[i][j] += carried[i][j];
            }
        }
        if !self.symmetric {
            for i in 0..s.next {
                let row = &values[s.at_next + i * s.stride_next..][..size];
                front[size + i][..size].copy_from_slice(row);
            }
        }
        for p in 0..size {
            let pivot = front[p][p];
            if pivot.size() == 0.0 || !pivot.is_finite() {
                return Err(SolveError::Singular(s.first + p));
            }
            self.negative += usize::from(pivot.real() < 0.0);
            let inverse = pivot.inverse();
            self.inverse[s.first + p] = inverse;
            let row = front[p];
            if self.symmetric {
                for r in p + 1..all {
                    let l = row[r] * inverse;
                    for j in 0..W {
                        front[r][j] = front[r][j].minus::<FUSED>(l, row[j]);
                    }
                }
            } else {
                let lower = &mut self.lower[s.factors + p * W..][..W];
                for r in p + 1..all {
                    let l = front[r][p] * inverse;
                    lower[r] = l;
                    for j in 0..W {
                        front[r][j] = front[r][j].minus::<FUSED>(l, row[j]);
                    }
                }
            }
            let upper = &mut self.upper[s.factors + p * W..][..W];
            upper[p + 1..].copy_from_slice(&row[p + 1..]);
        }
        for i in 0..s.next {
            for j in 0..s.next {
                carried[i][j] = front[size + i][size + j];
            }
        }
        Ok(())
    }

    #[inline(always)]
    fn substitute<const FUSED: bool>(&self, x: &mut [T]) {
        for s in &self.steps {
            match (s.width, s.size, s.next) {
                (Front::Cable, 6, 6) => self.forward::<12, FUSED>(&Step { size: 6, next: 6, ..*s }, x),
                (Front::Cable, ..) => self.forward::<12, FUSED>(s, x),
                (Front::Middle, ..) => self.forward::<20, FUSED>(s, x),
                (Front::Large, ..) => self.forward::<32, FUSED>(s, x),
            }
        }
        for s in self.steps.iter().rev() {
            match (s.width, s.size, s.next) {
                (Front::Cable, 6, 6) => self.backward::<12>(&Step { size: 6, next: 6, ..*s }, x),
                (Front::Cable, ..) => self.backward::<12>(s, x),
                (Front::Middle, ..) => self.backward::<20>(s, x),
                (Front::Large, ..) => self.backward::<32>(s, x),
            }
        }
    }

    #[inline(always)]
    fn forward<const W: usize, const FUSED: bool>(&self, s: &Step, x: &mut [T]) {
        let all = s.size + s.next;
        let x = &mut x[s.first..s.first + all];
        let mut y = [T::default(); W];
        y[..all].copy_from_slice(x);
        for p in 0..s.size {
            let (row, scale) = if self.symmetric {
                (&self.upper[s.factors + p * W..][..W], self.inverse[s.first + p])
            } else {
                (&self.lower[s.factors + p * W..][..W], T::from(1.0))
            };
            // zero up to the diagonal, so that whole rows may be subtracted
            let c = y[p] * scale;
            for j in 0..W {
                y[j] = y[j].minus::<FUSED>(c, row[j]);
            }
        }
        x.copy_from_slice(&y[..all]);
    }

    #[inline(always)]
    fn backward<const W: usize>(&self, s: &Step, x: &mut [T]) {
        let all = s.size + s.next;
        let x = &mut x[s.first..s.first + all];
        for p in (0..s.size).rev() {
            let row = &self.upper[s.factors + p * W..][..W];
            // the next block's share first: it doesn't wait for this block's solution
            let ahead: T = row[s.size..all].iter().zip(&x[s.size..]).map(|(u, x)| *u * *x).sum();
            let own: T = row[p + 1..s.size].iter().zip(&x[p + 1..s.size]).map(|(u, x)| *u * *x).sum();
            x[p] = (x[p] - ahead - own) * self.inverse[s.first + p];
        }
    }
}
