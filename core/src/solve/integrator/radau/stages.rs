//! The stages of a Radau step: their unknowns, what follows from them, and the matrices of the iteration.

use super::tableau::{ALPHA, C, GAMMA, INVERSE, continuation};
use crate::model::Model;
use crate::model::node::{retract, velocity};
use crate::model::state::{At, State};
use crate::model::structure::Structure;
use crate::model::term::Weights;
use crate::solve::integrator::workspace::Workspace;
use crate::solve::linear::{Guard, SolveError};
use crate::solve::times::Phase;
use faer::c64;

/// One vector for each stage.
pub(super) type Three = [Vec<f64>; 3];

/// Scratch of Radau IIA, kept between steps for its factors.
pub(crate) struct Stages {
    /// Increments from the start of the step: the unknowns, with the multipliers.
    pub(super) z: Three,
    pub(super) lambda: Three,
    pub(super) q: Three,
    pub(super) v: Three,
    pub(super) a: Three,
    /// Residuals of the equations of motion, then those of the constraints.
    pub(super) residual: Three,
    /// Whether the residual of the middle stage is known already, from the last evaluation of the matrices.
    pub(super) known: bool,
    /// Right-hand sides and solutions of the two systems.
    pub(super) real: Vec<f64>,
    pub(super) imaginary: Vec<c64>,
    /// The complex system: matrix, factors, and scratch in elimination order.
    values: Vec<c64>,
    solver: Guard<c64>,
    x: Vec<c64>,
    /// Parts of the matrices. Constraints stand in all of them.
    stiffness: Vec<f64>,
    pub(super) damping: Vec<f64>,
    pub(super) mass: Vec<f64>,
    /// Whether `mass` is that of the start of the step.
    pub(super) has_mass: bool,
    /// Where the Jacobian of the constraints is stored.
    coupling: Vec<u32>,
    /// Step size that the factors were made for; 0 if there are none.
    factored: f64,
    /// Whether some nodes turn, so that increments and velocities are not the same kind of vector.
    turning: bool,
    pub(super) d: Vec<f64>,
    pub(super) e: Vec<f64>,
    pub(super) rate: Vec<f64>,
    pub(super) bias: Vec<f64>,
    /// Zeros, one for each velocity.
    pub(super) rest: Vec<f64>,
    /// Zeros, one for each multiplier.
    pub(super) free: Vec<f64>,
}

impl Stages {
    pub fn new(model: &Model) -> Result<Self, SolveError> {
        let s = model.structure();
        let three = |n: usize| -> Three { std::array::from_fn(|_| vec![0.0; n]) };
        let (nv, m) = (model.velocities(), model.multipliers());
        Ok(Stages {
            z: three(nv),
            lambda: three(m),
            q: three(model.start.q.len()),
            v: three(nv),
            a: three(nv),
            residual: three(s.n),
            known: false,
            real: vec![0.0; s.n],
            imaginary: vec![c64::default(); s.n],
            values: vec![c64::default(); s.entries()],
            solver: Guard::complex(s)?,
            x: vec![c64::default(); s.n],
            stiffness: vec![0.0; s.entries()],
            damping: vec![0.0; s.entries()],
            mass: vec![0.0; s.entries()],
            has_mass: false,
            coupling: coupling(s),
            factored: 0.0,
            turning: model.nodes().iter().any(|n| n.kind.turns()),
            d: vec![0.0; nv],
            e: vec![0.0; nv],
            rate: vec![0.0; m],
            bias: vec![0.0; m],
            rest: vec![0.0; nv],
            free: vec![0.0; m],
        })
    }

    /// Forgets factors and matrices.
    pub fn forget(&mut self) {
        self.factored = 0.0;
        self.has_mass = false;
    }

    pub(super) fn factored_for(&self, h: f64) -> bool {
        self.factored == h
    }

    /// Stage `i` of a step from `state`, as a place of evaluation.
    pub(super) fn at<'a>(&'a self, state: &'a State, h: f64, i: usize) -> At<'a> {
        At {
            t: state.t + C[i] * h,
            q: &self.q[i],
            v: &self.v[i],
            a: &self.a[i],
            internal: &state.internal,
            relaxed: None,
        }
    }

    /// Continues the polynomials of the last step, or the motion with constant acceleration at a start. With `redundant`
    /// constraints multipliers start from the last ones: nothing would correct what a polynomial makes of their rounding
    /// where forces can be shared out in many ways.
    pub(super) fn predict(&mut self, state: &State, h: f64, redundant: bool) {
        let c = &state.control;
        let ratio = h / c.h_last;
        // a step that is so much larger has nothing to continue
        if c.stages[0].is_empty() || !(ratio < 100.0) {
            for i in 0..3 {
                let x = C[i] * h;
                for (z, (v, a)) in self.z[i].iter_mut().zip(state.v.iter().zip(&state.a)) {
                    *z = x * (v + 0.5 * x * a);
                }
                self.lambda[i].copy_from_slice(&state.lambda);
            }
            return;
        }
        for i in 0..3 {
            let x = 1.0 + C[i] * ratio;
            let [w0, w1, w2, _] = continuation([0.0, C[0], C[1], C[2]], x);
            let [p, q, r] = &c.stages;
            for (k, z) in self.z[i].iter_mut().enumerate() {
                *z = w0 * p[k] + w1 * q[k] + w2 * r[k];
            }
            let [w0, w1, w2] = if redundant { [0.0, 0.0, 1.0] } else { continuation(C, x) };
            let [p, q, r] = &c.stage_lambda;
            for (k, l) in self.lambda[i].iter_mut().enumerate() {
                *l = w0 * p[k] + w1 * q[k] + w2 * r[k];
            }
        }
    }

    /// Positions, velocities and accelerations of the stages from their increments.
    pub(super) fn kinematics(&mut self, model: &Model, state: &State, h: f64) {
        let Stages { z, q, v, a, d, .. } = self;
        for i in 0..3 {
            let [x, y, w] = INVERSE[i].map(|w| w / h);
            for (k, v) in v[i].iter_mut().enumerate() {
                *v = x * z[0][k] + y * z[1][k] + w * z[2][k];
            }
            if self.turning {
                d.copy_from_slice(&v[i]);
                velocity(model.nodes(), &state.q, &z[i], d, &mut v[i]);
            }
            retract(model.nodes(), &state.q, &z[i], &mut q[i]);
        }
        self.known = false;
        for i in 0..3 {
            let [x, y, w] = INVERSE[i].map(|w| w / h);
            for (k, a) in a[i].iter_mut().enumerate() {
                let old = state.v[k];
                *a = x * (v[0][k] - old) + y * (v[1][k] - old) + w * (v[2][k] - old);
            }
        }
    }

    /// Evaluates stiffness, damping and mass at the middle stage, where they suit all three best, and factors
    /// `[M + C/z + K/z², Gᵀ; G, 0]` for the real and the complex eigenvalue `z`.
    pub(super) fn differentiate(
        &mut self,
        model: &Model,
        work: &mut Workspace,
        state: &State,
        h: f64,
    ) -> Result<(), SolveError> {
        self.factored = 0.0;
        let s = model.structure();
        let none = Weights::default();
        let (t, internal) = (state.t + C[1] * h, &state.internal);
        let at = At { t, q: &self.q[1], v: &self.v[1], a: &self.a[1], internal, relaxed: None };
        for (values, weights, wanted) in [
            (&mut self.stiffness, Weights { q: 1.0, ..none }, true),
            (&mut self.damping, Weights { v: 1.0, ..none }, true),
            (&mut self.mass, Weights { a: 1.0, ..none }, !self.has_mass),
        ] {
            if wanted {
                model.assemble(&at, &self.lambda[1], Some(weights), &mut work.system);
                values.copy_from_slice(&work.system.values);
            }
        }
        self.residual[1].copy_from_slice(&work.system.residual);
        self.known = true;
        let g = h / GAMMA;
        let inverse = ALPHA.inv() * h;
        let square = inverse * inverse;
        for (i, value) in work.system.values.iter_mut().enumerate() {
            let (k, c, m) = (self.stiffness[i], self.damping[i], self.mass[i]);
            *value = m + g * (c + g * k);
            self.values[i] =
                c64 { re: m + inverse.re * c + square.re * k, im: inverse.im * c + square.im * k };
        }
        for &i in &self.coupling {
            let i = i as usize;
            work.system.values[i] = self.stiffness[i];
            self.values[i] = self.stiffness[i].into();
        }
        if let Some(softening) = &work.softening {
            softening.apply(&mut self.values);
        }
        let weights = Weights { q: g * g, v: g, a: 1.0 };
        work.round_forces(model, weights);
        work.factor(model, weights)?;
        let begin = work.clocks.start();
        self.solver.factor(s, &self.values)?;
        work.clocks.stop(Phase::Factorisation, begin);
        work.counts.factorizations += 1;
        work.counts.fallbacks += self.solver.fallbacks;
        self.factored = h;
        Ok(())
    }

    /// Solves the complex system for the right-hand side in `imaginary`, which the solution replaces.
    pub(super) fn solve_complex(&mut self, model: &Model, work: &mut Workspace) -> Result<(), SolveError> {
        let (s, begin) = (model.structure(), work.clocks.start());
        s.order(&self.imaginary, &mut self.x);
        self.solver.solve(s, &self.values, &mut self.x)?;
        s.restore(&self.x, &mut self.imaginary);
        work.clocks.stop(Phase::Solution, begin);
        Ok(())
    }
}

/// Where the entries between velocities and multipliers are stored.
fn coupling(s: &Structure) -> Vec<u32> {
    let mut all = Vec::new();
    for (row, columns, at) in s.rows() {
        let between = |&(k, _): &(usize, usize)| s.is_multiplier[row] != s.is_multiplier[columns.get(k)];
        all.extend(at.enumerate().filter(between).map(|(_, p)| p as u32));
    }
    all
}
