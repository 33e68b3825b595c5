//! Directions in which nothing holds an equilibrium and nothing drives it: the azimuth of a hinge, the spin of a round
//! body.
//!
//! Their eigenvalue is zero, so rounding decides about its sign. A finite push along one tells: it is held there, all
//! else finds its equilibrium, and the force that holds it says whether it would come back, stay or go on.

use super::naming::{describe, reshaped};
use super::outcome::{Neutral, StaticsError};
use super::problem::Statics;
use super::stability::MARGIN;
use crate::algebra::noise::Noise;
use crate::model::Model;
use crate::model::node::{difference, retract};
use crate::model::state::{Relaxation, Relaxed, State};
use crate::solve::linear::SolveError;
use nalgebra::{DMatrix, DVector};

/// How far a direction is pushed: displacements relative to the reference length, or angles.
const PUSH: f64 = 0.05;
/// Work of the push, relative to that of the load over the same way, from which on it comes from a stiffness.
const NOTHING: f64 = 1e-6;

/// What becomes of an equilibrium that is pushed a little.
pub(super) enum Leaning {
    Returns,
    Stays,
    Leaves,
    Unknown,
}

impl Neutral {
    pub(super) fn new(model: &Model, there: &State, shape: Vec<f64>) -> Self {
        let (what, line) = (describe(model, &there.q, &shape), reshaped(model, &there.q, &shape));
        Neutral { what, line, shape }
    }
}

/// An eigenvalue `(K, W)` below this with the other sign belongs to an unstable direction.
const UNSTABLE: f64 = 1e-9;

impl Statics<'_> {
    /// The `k` vectors of smallest eigenvalues `(K, W)` with the factored tangent `K + m W`, by subspace iteration; in
    /// elimination order.
    pub(super) fn lowest(&mut self, w: &[f64], k: usize) -> Result<Vec<Vec<f64>>, SolveError> {
        self.lowest_by(w, k, k + 2, |x| x.abs())
    }

    /// The same, those with unstable directions first.
    pub(super) fn unstable_first(&mut self, w: &[f64], k: usize) -> Result<Vec<Vec<f64>>, SolveError> {
        // beside as many as a body may be free in
        self.lowest_by(w, k, k + 8, |x| if x < -UNSTABLE { -1.0 / x.abs() } else { x.abs() })
    }

    fn lowest_by(
        &mut self,
        w: &[f64],
        k: usize,
        dimension: usize,
        rank: impl Fn(f64) -> f64,
    ) -> Result<Vec<Vec<f64>>, SolveError> {
        let (s, mut noise) = (&self.structure, Noise::default());
        let zeroed = |x: &mut Vec<f64>| {
            x.iter_mut().zip(&s.is_multiplier).filter(|(_, m)| **m).for_each(|(x, _)| *x = 0.0);
        };
        let inner =
            |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).zip(w).map(|((a, b), w)| a * b * w).sum() };
        let mut space: Vec<Vec<f64>> = Vec::new();
        for _ in 0..dimension.min(self.model.velocities().saturating_sub(self.model.multipliers()).max(k)) {
            space.push((0..s.n).map(|_| noise.draw()).collect());
        }
        for _ in 0..5 {
            for k in 0..space.len() {
                let mut x: Vec<f64> = space[k].iter().zip(w).map(|(x, w)| x * w).collect();
                zeroed(&mut x);
                self.solver.solve(s, &self.system.values, &mut x)?;
                zeroed(&mut x);
                for _ in 0..2 {
                    for b in &space[..k] {
                        let along = inner(b, &x);
                        x.iter_mut().zip(b).for_each(|(x, b)| *x -= along * b);
                    }
                }
                let size = inner(&x, &x).sqrt();
                if !(size > 0.0 && size.is_finite()) {
                    return Err(SolveError::NotFinite);
                }
                x.iter_mut().for_each(|x| *x /= size);
                space[k] = x;
            }
        }
        let n = space.len();
        let mut y = vec![0.0; s.n];
        let products: Vec<Vec<f64>> = space
            .iter()
            .map(|x| {
                s.multiply(&self.system.values, x, &mut y);
                y.clone()
            })
            .collect();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let h = DMatrix::from_fn(n, n, |i, j| {
            0.5 * (dot(&space[i], &products[j]) + dot(&space[j], &products[i]))
        });
        let eigen = h.symmetric_eigen();
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|&a, &b| rank(eigen.eigenvalues[a]).total_cmp(&rank(eigen.eigenvalues[b])));
        let vector = |&c: &usize| -> Vec<f64> {
            let mut x = vec![0.0; s.n];
            for (i, v) in space.iter().enumerate() {
                x.iter_mut().zip(v).for_each(|(x, v)| *x += eigen.eigenvectors[(i, c)] * v);
            }
            x
        };
        Ok(order.iter().take(k).map(vector).collect())
    }

    /// A direction in elimination order with its weights: what a force along it does work on.
    pub(super) fn weighed(&self, w: &[f64], x: &[f64]) -> Vec<f64> {
        x.iter().zip(w).map(|(x, w)| x * w).collect()
    }

    /// A vector in elimination order as an increment of the size of a push.
    pub(super) fn increment(&self, x: &[f64]) -> Vec<f64> {
        let position = &self.structure.position[..self.model.velocities()];
        self.small(position.iter().map(|&p| x[p]).collect())
    }

    /// Pushes the equilibrium in `there` along `shape`, the free direction number `k`, and holds it there.
    pub(super) fn lean(&mut self, there: &State, shape: &[f64], k: usize, load: f64) -> Leaning {
        let (model, nv) = (self.model, self.model.velocities());
        let (mut q, mut lambda) = (there.q.clone(), there.lambda.clone());
        let mut next = q.clone();
        retract(model.nodes(), &there.q, shape, &mut q);
        let mut last = shape.to_vec();
        let along = |c: &[f64], d: &[f64], s: &Self| -> f64 {
            (0..nv).map(|i| c[s.structure.position[i]] * d[i]).sum()
        };
        let target = along(&self.free[k], shape, self);
        let (mut before, mut moved) = (f64::INFINITY, vec![0.0; nv]);
        for _ in 0..25 {
            let how = Relaxation::check(true, load);
            self.assemble(there, &q, &lambda, Some(Relaxed { last: Some(&last), how }), false);
            self.prepare();
            let w = self.weights();
            self.shift(&w, MARGIN);
            if self.factor().is_err() {
                return Leaning::Unknown;
            }
            difference(model.nodes(), &there.q, &q, &mut moved);
            let ask: Vec<f64> = (0..self.free.len())
                .map(|j| if j == k { target } else { 0.0 } - along(&self.free[j], &moved, self))
                .collect();
            let Ok((d, hold)) = self.solve_held(&ask) else { return Leaning::Unknown };
            let (step, multipliers) = d.split_at(nv);
            let size = self.size(step);
            if !size.is_finite() {
                return Leaning::Unknown;
            }
            retract(model.nodes(), &q, step, &mut next);
            std::mem::swap(&mut q, &mut next);
            lambda.iter_mut().zip(multipliers).for_each(|(l, m)| *l += m);
            last = step.to_vec();
            // work of the push, against that of the load over its way
            let work = -0.5 * hold[k] * target;
            let noise = 10.0 * (work - before).abs();
            if size <= 1e-3 * self.options.tolerance.max(1e-9) || (size <= 1e-7 && noise <= work.abs()) {
                let nothing = NOTHING * load * model.length() * PUSH * PUSH;
                return match () {
                    () if work.abs() <= nothing.max(noise) => Leaning::Stays,
                    () if work > 0.0 => Leaning::Returns,
                    () if work < 0.0 => Leaning::Leaves,
                    () => Leaning::Unknown,
                };
            }
            before = work;
        }
        Leaning::Unknown
    }

    /// Newton's correction with the factored tangent, which moves along each free direction by what is asked; and the
    /// forces that this takes.
    pub(super) fn solve_held(&mut self, ask: &[f64]) -> Result<(Vec<f64>, Vec<f64>), SolveError> {
        let residual: Vec<f64> = self.system.residual.iter().map(|r| -r).collect();
        let mut y = vec![0.0; self.structure.n];
        self.structure.order(&residual, &mut y);
        self.solver.solve(&self.structure, &self.system.values, &mut y)?;
        let forces = self.hold(&mut y, ask)?;
        Ok((self.structure.position.iter().map(|&p| y[p]).collect(), forces))
    }

    /// Changes a solution with the factored tangent so that it moves along each free direction by what is asked; says
    /// which forces hold it there.
    pub(super) fn hold(&mut self, y: &mut [f64], ask: &[f64]) -> Result<Vec<f64>, SolveError> {
        let (s, k) = (&self.structure, self.free.len());
        if k == 0 {
            return Ok(Vec::new());
        }
        let mut by_force = self.free.clone();
        for z in &mut by_force {
            self.solver.solve(s, &self.system.values, z)?;
        }
        let columns = |all: &[Vec<f64>]| DMatrix::from_fn(s.n, k, |i, j| all[j][i]);
        let across = columns(&self.free).transpose();
        let m = &across * columns(&by_force);
        let off = across * DVector::from_column_slice(y) - DVector::from_column_slice(ask);
        let forces = m.lu().solve(&off).ok_or(SolveError::NotFinite)?;
        for (z, f) in by_force.iter().zip(forces.iter()) {
            y.iter_mut().zip(z).for_each(|(y, z)| *y -= f * z);
        }
        Ok(forces.iter().copied().collect())
    }

    /// Looks for directions that nothing holds where a search begins, so that its steps leave them alone. False if
    /// there are none.
    pub(super) fn set_free(&mut self, state: &State) -> bool {
        self.free.clear();
        self.assemble(state, &state.q, &state.lambda, None, false);
        self.prepare();
        let (w, held) = (self.weights(), self.held(state));
        let mut counts = [0; 2];
        for (k, m) in [-MARGIN, 2.0 * MARGIN].into_iter().enumerate() {
            self.shift(&w, m);
            let (Ok(()), Some(n)) = (self.factor(), self.solver.negative_pivots()) else { return false };
            counts[k] = n.saturating_sub(held);
        }
        let near = counts[0].saturating_sub(counts[1]);
        let Ok(lowest) = self.lowest(&w, near) else { return false };
        self.free = lowest.iter().map(|x| self.weighed(&w, x)).collect();
        near > 0
    }

    /// What can be said about a search that failed because something is free to move.
    pub(super) fn explain(&mut self, state: &State, e: StaticsError) -> StaticsError {
        if !self.set_free(state) {
            return e;
        }
        let x = self.free[0].clone();
        let w = self.weights();
        let shape: Vec<f64> = x.iter().zip(&w).map(|(x, w)| x / w).collect();
        let shape = self.increment(&shape);
        let what = describe(self.model, &state.q, &shape);
        StaticsError { why: format!("nothing holds it: {what}. {}", e.why), ..e }
    }
}
