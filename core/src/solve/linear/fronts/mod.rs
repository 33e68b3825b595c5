//! Block elimination along a tree, without pivoting: the multifrontal method (Duff & Reid 1983; Liu 1992).
//!
//! Cables that branch, nets, and bodies with many lines are eliminated leaf by leaf. A *front* is a small dense matrix:
//! the rows and columns of the unknowns that it eliminates, its own, and of those that they are coupled with by then.
//! With `U` upper and `L` unit lower triangular, of
//!
//! ```text
//! ⎡ F₁₁  F₁₂ ⎤   ⎡ L₁₁    ⎤ ⎡ U₁₁  U₁₂ ⎤
//! ⎣ F₂₁  F₂₂ ⎦ = ⎣ L₂₁  I ⎦ ⎣       C  ⎦ ,    C = F₂₂ - L₂₁ U₁₂
//! ```
//!
//! the rows of `U` and the columns of `L` are factors, and `C` is passed on to the front that eliminates the first of
//! its unknowns. All that depends on the structure alone is settled once, in the [`Plan`]; what then remains are sums
//! over rectangles and a product of dense matrices, in vector registers. A symmetric matrix needs the upper half of
//! each `C`, and its `L` is `U` with its rows divided by the pivots.
//!
//! The order of [`Structure`] keeps this stable (multipliers follow what they hold); the growth of the entries is
//! watched, and the [`Guard`](super::Guard) checks where it is large.

mod dense;
mod plan;

use super::growth::Growth;
use crate::algebra::lane::{LaneTask, Real, Width, run};
use crate::algebra::scalar::Scalar;
use crate::model::structure::Structure;
use crate::solve::linear::solver::{LinearSolver, SolveError};
use plan::Plan;

/// `L U` along a tree, symmetric or not.
#[derive(Default)]
pub struct Fronts<T = f64> {
    plan: Plan,
    /// Rows of `U` and columns of `L`, each as long as its front is wide.
    upper: Vec<T>,
    lower: Vec<T>,
    /// Reciprocal pivots, in the order in which fronts are eliminated.
    inverse: Vec<T>,
    /// What fronts pass on, and that waits for their parents: of those at even and at odd depths.
    passed: [Vec<T>; 2],
    /// The unknowns of one front.
    local: Vec<T>,
    negative: usize,
    growth: Growth,
}

impl<T: Scalar> LinearSolver<T> for Fronts<T> {
    fn name(&self) -> &'static str {
        "block elimination along the tree"
    }

    fn analyse(&mut self, s: &Structure) -> Result<(), SolveError> {
        self.plan = Plan::new(s).ok_or(SolveError::Memory)?;
        let plan = &self.plan;
        self.upper = vec![T::default(); plan.factors];
        self.lower = vec![T::default(); plan.factors];
        self.inverse = vec![T::default(); s.n];
        self.passed = plan.passed.map(|n| vec![T::default(); n]);
        self.local = vec![T::default(); plan.widest];
        self.growth = Growth::new(s);
        Ok(())
    }

    fn factor(&mut self, s: &Structure, values: &[T]) -> Result<(), SolveError> {
        let mut result = Ok(());
        run(Width::best(), Factor { fronts: self, values, result: &mut result });
        self.growth.finish(s, values);
        result
    }

    fn solve(&mut self, x: &mut [T]) {
        run(Width::best(), Solve { fronts: self, x });
    }

    fn negative_pivots(&self) -> Option<usize> {
        Some(self.negative)
    }

    fn growth(&self) -> f64 {
        self.growth.largest
    }
}

struct Factor<'a, T> {
    fronts: &'a mut Fronts<T>,
    values: &'a [T],
    result: &'a mut Result<(), SolveError>,
}

impl<T: Scalar> LaneTask for Factor<'_, T> {
    #[inline(always)]
    fn go<R: Real>(self) {
        *self.result = match (R::LANES > 1, self.fronts.plan.symmetric) {
            (true, true) => self.fronts.eliminate::<true, true>(self.values),
            (true, false) => self.fronts.eliminate::<true, false>(self.values),
            (false, true) => self.fronts.eliminate::<false, true>(self.values),
            (false, false) => self.fronts.eliminate::<false, false>(self.values),
        };
    }
}

struct Solve<'a, T> {
    fronts: &'a mut Fronts<T>,
    x: &'a mut [T],
}

impl<T: Scalar> LaneTask for Solve<'_, T> {
    #[inline(always)]
    fn go<R: Real>(self) {
        if R::LANES > 1 {
            self.fronts.substitute::<true>(self.x)
        } else {
            self.fronts.substitute::<false>(self.x)
        }
    }
}

impl<T: Scalar> Fronts<T> {
    #[inline(always)]
    fn eliminate<const FUSED: bool, const SYMMETRIC: bool>(
        &mut self,
        values: &[T],
    ) -> Result<(), SolveError> {
        self.negative = 0;
        self.growth.start();
        for k in 0..self.plan.fronts.len() {
            let f = self.plan.fronts[k];
            self.assemble::<SYMMETRIC>(k, values);
            let Fronts { upper, lower, inverse, .. } = self;
            let (upper, lower) = (&mut upper[f.factors()], &mut lower[f.factors()]);
            let inverse = &mut inverse[f.first..f.first + f.own];
            let done = match (f.own, f.stride) {
                // two nodes of a cable: the sizes as constants, for the compiler to unroll
                (6, 14) => dense::triangles::<T, FUSED, SYMMETRIC>(6, 14, upper, lower, inverse),
                (own, stride) => dense::triangles::<T, FUSED, SYMMETRIC>(own, stride, upper, lower, inverse),
            };
            let unknowns = &self.plan.unknowns[f.unknowns()];
            done.map_err(|p| SolveError::Singular(unknowns[p] as usize))?;
            self.negative += inverse.iter().filter(|p| p.real() < 0.0).count();
            self.growth.add(unknowns, f.stride, upper, lower, inverse);
            let c = &mut self.passed[f.depth % 2][f.passed()];
            match (f.own, f.wide) {
                (6, 8) => dense::subtract_product::<T, FUSED, SYMMETRIC>(6, 8, lower, upper, c),
                (own, wide) => dense::subtract_product::<T, FUSED, SYMMETRIC>(own, wide, lower, upper, c),
            }
        }
        Ok(())
    }

    /// Sums up a front: entries of the matrix, and what its children have passed on.
    #[inline(always)]
    fn assemble<const SYMMETRIC: bool>(&mut self, k: usize, values: &[T]) {
        let (plan, f) = (&self.plan, self.plan.fronts[k]);
        let (upper, lower) = (&mut self.upper[f.factors()], &mut self.lower[f.factors()]);
        upper.fill(T::default());
        if !SYMMETRIC {
            lower.fill(T::default());
        }
        for p in &plan.rows[f.rows.0..f.rows.1] {
            for i in 0..p.rows as usize {
                let from = &values[p.at as usize + i * p.stride as usize..][..p.columns as usize];
                upper[p.to as usize + i * f.stride..][..from.len()].copy_from_slice(from);
            }
        }
        for p in &plan.columns[f.columns.0..f.columns.1] {
            for i in 0..p.rows as usize {
                let from = &values[p.at as usize + i * p.stride as usize..][..p.columns as usize];
                for (j, v) in from.iter().enumerate() {
                    lower[p.to as usize + i + j * f.stride] = *v;
                }
            }
        }
        let [even, odd] = &mut self.passed;
        let (own, below) = if f.depth % 2 == 0 { (even, odd) } else { (odd, even) };
        let c = &mut own[f.passed()];
        c.fill(T::default());
        for child in plan.children[f.children.0..f.children.1].iter().map(|&k| plan.fronts[k as usize]) {
            let moves = &plan.moves[child.moves.0..child.moves.1];
            let b = &below[child.passed()];
            for (k, rows) in moves.iter().enumerate() {
                for i in 0..rows.count as usize {
                    let (row, to) = (&b[(rows.from as usize + i) * child.wide..], rows.to as usize + i);
                    let columns = if SYMMETRIC { &moves[k..] } else { moves };
                    for m in columns {
                        let from = &row[m.from as usize..][..m.count as usize];
                        let column = m.to as usize;
                        if to < f.own {
                            add(&mut upper[to * f.stride + column..], from);
                        } else if column >= f.own {
                            add(&mut c[(to - f.own) * f.wide + column - f.own..], from);
                        } else {
                            for (j, v) in from.iter().enumerate() {
                                lower[(column + j) * f.stride + to] += *v;
                            }
                        }
                    }
                }
            }
        }
    }

    #[inline(always)]
    fn substitute<const FUSED: bool>(&mut self, x: &mut [T]) {
        let Fronts { plan, upper, lower, inverse, local, .. } = self;
        for f in &plan.fronts {
            let unknowns = &plan.unknowns[f.unknowns()];
            let y = &mut local[..unknowns.len()];
            y.iter_mut().zip(unknowns).for_each(|(y, &i)| *y = x[i as usize]);
            for (p, column) in lower[f.factors()].chunks_exact(f.stride).enumerate() {
                let c = y[p];
                for (y, l) in y[p + 1..].iter_mut().zip(&column[p + 1..]) {
                    *y = y.minus::<FUSED>(c, *l);
                }
            }
            y.iter().zip(unknowns).for_each(|(y, &i)| x[i as usize] = *y);
        }
        for f in plan.fronts.iter().rev() {
            let unknowns = &plan.unknowns[f.unknowns()];
            let y = &mut local[..unknowns.len()];
            y.iter_mut().zip(unknowns).for_each(|(y, &i)| *y = x[i as usize]);
            let inverse = &inverse[f.first..f.first + f.own];
            for (p, row) in upper[f.factors()].chunks_exact(f.stride).enumerate().rev() {
                y[p] = (y[p] - dense::dot(&row[p + 1..], &y[p + 1..])) * inverse[p];
            }
            y[..f.own].iter().zip(unknowns).for_each(|(y, &i)| x[i as usize] = *y);
        }
    }
}

#[inline(always)]
fn add<T: Scalar>(to: &mut [T], from: &[T]) {
    to.iter_mut().zip(from).for_each(|(to, v)| *to += *v);
}

#[cfg(test)]
mod tests;
