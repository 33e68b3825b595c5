//! Block elimination along a chain, without pivoting between blocks or inside of them.
//!
//! Each block is eliminated in a small dense front: its own rows `[D E]` and those of the next block that it is coupled
//! with, `[F 0]`. What is left in the corner is carried on to the next block. Shared unknowns go along as a border of
//! every front, and come last. The usual front, two nodes of a cable
//! with six unknowns each, is unrolled and runs in vector registers; a symmetric matrix needs half of it. The order of
//! [`Structure`] keeps this stable (multipliers follow their nodes); the [`Guard`](super::Guard) checks.

use super::growth::{Growth, Share};
use super::solver::{LinearSolver, SolveError};
use crate::algebra::lane::{LaneTask, Real, Width, run};
use crate::algebra::scalar::Scalar;
use crate::model::structure::{Block, LARGEST, Structure};

/// `L U` of a chain, symmetric or not.
#[derive(Default)]
pub struct Chain<T = f64> {
    steps: Vec<Step>,
    symmetric: bool,
    /// Rows of `U`, zero up to the diagonal, each as long as its front is wide.
    upper: Vec<T>,
    /// Columns of `L`, stored like the rows of `U`; empty for symmetric matrices, where they are those rows times the
    /// reciprocal pivot.
    lower: Vec<T>,
    /// Reciprocal pivots.
    inverse: Vec<T>,
    negative: usize,
    growth: Growth,
    /// Position of the first shared unknown, and storage of the entries between shared unknowns.
    first_shared: usize,
    corner: Vec<u32>,
}

/// The elimination of one block.
#[derive(Clone, Copy, Debug, Default)]
struct Step {
    /// Position of its first row.
    first: usize,
    /// Its rows, those of the next block, and those of shared unknowns.
    size: usize,
    next: usize,
    border: usize,
    /// Storage of its diagonal block and of its coupling with shared unknowns, and the length of its rows.
    at: usize,
    at_border: usize,
    stride: usize,
    /// The same for what the next block and the shared unknowns have in its columns, where that isn't symmetric.
    at_next: usize,
    stride_next: usize,
    at_shared: usize,
    stride_shared: usize,
    /// Width of its front, and where its factors are stored.
    width: Front,
    factors: usize,
}

/// Width of a front: two nodes of a cable, of one with torsion, two rigid bodies with a spherical joint each, and the largest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Front {
    #[default]
    Cable = 12,
    Twisted = 16,
    Middle = 20,
    Large = 32,
}

/// What the elimination of a block leaves for the next.
type Carried<T> = [[T; LARGEST]; LARGEST];

/// Runs for a step with the width of its front as a constant `W`, and with its sizes as constants (`KNOWN`) where they are
/// common, for the compiler to unroll.
macro_rules! unrolled {
    ($step:expr, |$s:ident, $W:ident, $KNOWN:ident| $run:expr) => {{
        let step: Step = $step;
        macro_rules! with {
            ($width:literal, $known:literal, $sized:expr) => {{
                const $W: usize = $width;
                const $KNOWN: bool = $known;
                let $s: Step = $sized;
                $run
            }};
        }
        match (step.width, step.size, step.next, step.border) {
            (Front::Cable, 6, 6, 0) => with!(12, true, Step { size: 6, next: 6, border: 0, ..step }),
            (Front::Cable, 6, 0, 0) => with!(12, true, Step { size: 6, next: 0, border: 0, ..step }),
            (Front::Twisted, 7, 7, 0) => with!(16, true, Step { size: 7, next: 7, border: 0, ..step }),
            (Front::Cable, ..) => with!(12, false, step),
            (Front::Twisted, ..) => with!(16, false, step),
            (Front::Middle, ..) => with!(20, false, step),
            (Front::Large, ..) => with!(32, false, step),
        }
    }};
}

impl Front {
    fn of(columns: usize) -> Self {
        match columns {
            ..=12 => Front::Cable,
            13..=16 => Front::Twisted,
            17..=20 => Front::Middle,
            _ => Front::Large,
        }
    }
}

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
        self.first_shared = s.n - s.border;
        let own: Vec<&Block> = s.blocks.iter().filter(|b| b.first < self.first_shared).collect();
        let behind = s.blocks.get(own.len());
        let mut factors = 0;
        for (k, b) in own.iter().enumerate() {
            let next = own.get(k + 1);
            let following = next.map_or(0, |n| n.size);
            // of unsymmetric matrices, the block before stands in front
            let before = b.width() - b.size - following - s.border;
            let all = b.size + following + s.border;
            let width = Front::of(all);
            self.steps.push(Step {
                first: b.first,
                size: b.size,
                next: following,
                border: s.border,
                at: b.base + before,
                at_border: b.base + b.width() - s.border,
                stride: b.width(),
                at_next: next.map_or(0, |n| n.base),
                stride_next: next.map_or(0, |n| n.width()),
                at_shared: behind.map_or(0, |n| n.base + b.first),
                stride_shared: s.n,
                width,
                factors,
            });
            factors += b.size * width as usize;
        }
        let shared: Vec<usize> = (self.first_shared..s.n).collect();
        self.corner = shared.iter().flat_map(|&r| shared.iter().map(move |&c| s.slot(r, c) as u32)).collect();
        if s.border > 0 {
            let width = Front::of(s.border);
            let last = Step { first: self.first_shared, size: s.border, width, factors, ..Step::default() };
            self.steps.push(last);
            factors += s.border * width as usize;
        }
        self.upper = vec![T::default(); factors];
        self.lower = vec![T::default(); if s.symmetric { 0 } else { factors }];
        self.inverse = vec![T::default(); s.n];
        self.growth = Growth::new(s);
        Ok(())
    }

    fn factor(&mut self, s: &Structure, values: &[T]) -> Result<(), SolveError> {
        let mut result = Ok(());
        run(Width::best(), Factor { chain: self, values, result: &mut result });
        self.growth.finish(s, values);
        result
    }

    fn solve(&mut self, x: &mut [T]) {
        run(Width::best(), Solve { chain: self, x });
    }

    fn negative_pivots(&self) -> Option<usize> {
        Some(self.negative)
    }

    fn growth(&self) -> f64 {
        self.growth.largest
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
        self.growth.start();
        for k in 0..self.steps.len() {
            let step = self.steps[k];
            unrolled!(step, |s, W, _KNOWN| self.front::<W, FUSED>(&s, values, &mut carried)?);
        }
        Ok(())
    }

    /// Fills the front of a block: its own rows, those of the next block in its columns, and what was carried on.
    #[inline(always)]
    fn gather<const W: usize>(&self, s: &Step, values: &[T], carried: &Carried<T>, front: &mut [[T; W]; W]) {
        let (size, ahead) = (s.size, s.size + s.next);
        let all = ahead + s.border;
        if s.first < self.first_shared {
            for i in 0..size {
                let row = &values[s.at + i * s.stride..][..ahead];
                front[i][..ahead].copy_from_slice(row);
                let row = &values[s.at_border + i * s.stride..][..s.border];
                front[i][ahead..all].copy_from_slice(row);
            }
        } else {
            for i in 0..size {
                for j in 0..size {
                    front[i][j] = values[self.corner[i * size + j] as usize];
                }
            }
        }
        if !self.symmetric {
            for i in 0..s.next {
                let row = &values[s.at_next + i * s.stride_next..][..size];
                front[size + i][..size].copy_from_slice(row);
            }
            for i in 0..s.border {
                let row = &values[s.at_shared + i * s.stride_shared..][..size];
                front[ahead + i][..size].copy_from_slice(row);
            }
        }
        // shared unknowns are carried on behind those of this block
        let place = |i: usize| if i < size { i } else { i + s.next };
        for i in 0..size + s.border {
            for j in 0..size + s.border {
                front[place(i)][place(j)] += carried[i][j];
            }
        }
    }

    /// Eliminates one block.
    #[inline(always)]
    fn front<const W: usize, const FUSED: bool>(
        &mut self,
        s: &Step,
        values: &[T],
        carried: &mut Carried<T>,
    ) -> Result<(), SolveError> {
        let (size, ahead) = (s.size, s.size + s.next);
        let all = ahead + s.border;
        let mut front = [[T::default(); W]; W];
        self.gather(s, values, carried, &mut front);
        let mut grown = [0.0; W];
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
            // both are zero up to the diagonal
            let share = Share::of(pivot, inverse);
            grown[p] += share.pivot;
            // loops, which are inlined here: iterators are not, and go without the instructions of this place
            if self.symmetric {
                for j in 0..W {
                    grown[j] += share.of_one(upper[j]);
                }
            } else {
                let lower = &self.lower[s.factors + p * W..][..W];
                for j in 0..W {
                    grown[j] += share.of_pair(lower[j], upper[j]);
                }
            }
        }
        let (own, shared) = grown[..all].split_at(ahead);
        self.growth.add_run(s.first, own);
        self.growth.add_run(self.first_shared, shared);
        for i in 0..s.next + s.border {
            for j in 0..s.next + s.border {
                carried[i][j] = front[size + i][size + j];
            }
        }
        Ok(())
    }

    #[inline(always)]
    fn substitute<const FUSED: bool>(&self, x: &mut [T]) {
        for step in &self.steps {
            unrolled!(*step, |s, W, _KNOWN| self.forward::<W, FUSED>(&s, x));
        }
        for step in self.steps.iter().rev() {
            unrolled!(*step, |s, W, KNOWN| if KNOWN {
                self.backward_unrolled::<W>(&s, x);
            } else {
                self.backward::<W>(&s, x);
            });
        }
    }

    #[inline(always)]
    fn forward<const W: usize, const FUSED: bool>(&self, s: &Step, x: &mut [T]) {
        let ahead = s.size + s.next;
        let all = ahead + s.border;
        let mut y = [T::default(); W];
        y[..ahead].copy_from_slice(&x[s.first..][..ahead]);
        y[ahead..all].copy_from_slice(&x[self.first_shared..][..s.border]);
        let lower = if self.symmetric { &self.upper } else { &self.lower };
        let (rows, inverse) = (&lower[s.factors..][..s.size * W], &self.inverse[s.first..][..s.size]);
        for p in 0..s.size {
            let row = &rows[p * W..][..W];
            let c = if self.symmetric { y[p] * inverse[p] } else { y[p] };
            // zero up to the diagonal, so that whole rows may be subtracted
            for j in 0..W {
                y[j] = y[j].minus::<FUSED>(c, row[j]);
            }
        }
        x[s.first..][..ahead].copy_from_slice(&y[..ahead]);
        x[self.first_shared..][..s.border].copy_from_slice(&y[ahead..all]);
    }

    #[inline(always)]
    fn backward<const W: usize>(&self, s: &Step, x: &mut [T]) {
        let (size, ahead) = (s.size, s.size + s.next);
        let (rows, inverse) = (&self.upper[s.factors..][..size * W], &self.inverse[s.first..][..size]);
        let (before, shared) = x.split_at_mut(self.first_shared.max(s.first + ahead));
        let (own, next) = before[s.first..][..ahead].split_at_mut(size);
        for p in (0..size).rev() {
            let row = &rows[p * W..][..W];
            // the shares of others first: they don't wait for this block's solution
            let others = add(T::default(), &row[size..ahead], next);
            let others = add(others, &row[ahead..], &shared[..s.border]);
            own[p] = (own[p] - others - add(T::default(), &row[p + 1..], &own[p + 1..])) * inverse[p];
        }
    }

    /// [`Chain::backward`] with sizes that the compiler knows, and without shared unknowns. Nothing is fused: what cancels,
    /// as across a straight column, has to vanish.
    #[inline(always)]
    fn backward_unrolled<const W: usize>(&self, s: &Step, x: &mut [T]) {
        let (size, ahead) = (s.size, s.size + s.next);
        let (rows, inverse) = (&self.upper[s.factors..][..size * W], &self.inverse[s.first..][..size]);
        let x = &mut x[s.first..][..ahead];
        for p in 0..size {
            x[p] -= add(T::default(), &rows[p * W..][size..ahead], &x[size..]);
        }
        for p in (0..size).rev() {
            // those that are known longest first
            for j in (p + 1..size).rev() {
                x[p] -= rows[p * W + j] * x[j];
            }
            x[p] *= inverse[p];
        }
    }
}

/// `sum + Σ aⱼ bⱼ` over all of `b`, in order.
#[inline(always)]
fn add<T: Scalar>(mut sum: T, a: &[T], b: &[T]) -> T {
    let a = &a[..b.len()];
    for j in 0..b.len() {
        sum += a[j] * b[j];
    }
    sum
}
