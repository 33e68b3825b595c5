//! What a Radau step does once its stages are found: the estimate of its error, and its end.

use super::stages::Stages;
use super::tableau::{ERROR, GAMMA};
use crate::model::Model;
use crate::model::node::{difference, retract};
use crate::model::state::{At, State};
use crate::solve::integrator::consistent::way_back;
use crate::solve::integrator::workspace::{Which, Workspace};
use crate::solve::linear::SolveError;

impl Stages {
    /// Estimated errors of positions and velocities [1/s] relative to each part's length, of order 3 and without what the constraints and the
    /// damping of unresolved motion take away: the embedded formula, filtered with the real system.
    pub(super) fn errors(
        &mut self,
        model: &Model,
        state: &State,
        work: &mut Workspace,
        h: f64,
    ) -> Result<[f64; 2], SolveError> {
        let (nv, s, g) = (model.velocities(), model.structure(), h / GAMMA);
        for k in 0..nv {
            let (mut q, mut v) = (g * state.v[k], g * state.aux[k]);
            for i in 0..3 {
                q += ERROR[i] * self.z[i][k];
                v += ERROR[i] * (self.v[i][k] - state.v[k]);
            }
            (self.d[k], self.e[k]) = (q, q + g * v);
        }
        // [M + C/z + K/z², Gᵀ; G, 0] [dq; ·] = [M (eq + ev/z) + C eq/z; 0]
        self.real.fill(0.0);
        for (values, x, weight) in [(&self.mass, &self.e, 1.0), (&self.damping, &self.d, g)] {
            work.product(s, values, x);
            for (r, &p) in self.real[..nv].iter_mut().zip(&s.position) {
                *r += weight * work.y[p];
            }
        }
        work.solve(model, Which::Iteration, &mut self.real)?;
        for k in 0..nv {
            self.e[k] = (self.real[k] - self.d[k]) / g;
        }
        // with the whole mass matrix: a lumped one would weigh the rates of slopes too much
        Ok([&self.real[..nv], &self.e].map(|d| work.norm_with(s, &self.mass, d)))
    }

    /// The end of the step, left in the last stage: velocities on the constraints, and the accelerations that the
    /// equations of motion have there, smooth in `a` and as they are in `e`; multipliers in `bias`.
    pub(super) fn end(
        &mut self,
        model: &Model,
        state: &State,
        work: &mut Workspace,
        h: f64,
    ) -> Result<(), SolveError> {
        let (nv, m) = (model.velocities(), model.multipliers());
        let s = model.structure();
        self.has_mass = false;
        let at = At { a: &self.rest, ..self.at(state, h, 2) };
        work.assemble_mass(model, &at, &self.free, 0.0, true)?;
        self.mass.copy_from_slice(&work.mass.values);
        if model.is_mechanism() {
            self.onto_constraints(model, state, work, h)?;
        }
        let Stages { q, v, a, rest, free, real, d, e, rate, bias, mass, has_mass, .. } = self;
        let (q, v, a) = (&q[2], &mut v[2], &mut a[2]);
        // as a function: a closure would hold on to the first velocities
        fn place<'a>(state: &'a State, h: f64, [q, v, a]: [&'a [f64]; 3]) -> At<'a> {
            At { t: state.t + h, q, v, a, internal: &state.internal, relaxed: None }
        }
        model.rates(&place(state, h, [q, v, rest]), rate, bias);
        model.assemble(&place(state, h, [q, v, rest]), free, None, &mut work.system);
        e.copy_from_slice(&work.system.residual[..nv]);
        if m > 0 {
            // the nearest velocities that the constraints allow
            work.product(s, mass, v);
            real.fill(0.0);
            for k in 0..m {
                real[nv + k] = -work.y[s.position[nv + k]] - rate[k];
            }
            work.solve(model, Which::Mass, real)?;
            let largest = v.iter().fold(0.0f64, |m, v| m.max(v.abs()));
            let moved = real[..nv].iter().any(|d| !(d.abs() <= 1e-13 * largest));
            for (v, d) in v.iter_mut().zip(&*real) {
                *v += d;
            }
            if moved {
                model.assemble(&place(state, h, [q, v, rest]), free, None, &mut work.system);
                model.rates(&place(state, h, [q, v, rest]), rate, bias);
                e.copy_from_slice(&work.system.residual[..nv]);
            }
        }
        for (x, r) in real.iter_mut().zip(e.iter().chain(&*bias)) {
            *x = -r;
        }
        work.solve(model, Which::Mass, real)?;
        *has_mass = true;
        e.copy_from_slice(&real[..nv]);
        bias.copy_from_slice(&real[nv..]);
        // on fine meshes the accelerations of slopes are all round-off of forces. Those of the stage are smooth but of
        // lower order: what they lack is added through the filter of the iteration
        for ((d, e), a) in d.iter_mut().zip(&*e).zip(&*a) {
            *d = e - a;
        }
        work.product(s, mass, d);
        s.restore(&work.y, real);
        work.solve(model, Which::Iteration, real)?;
        for (a, d) in a.iter_mut().zip(&*real) {
            *a += d;
        }
        if v.iter().all(|v| v.is_finite()) { Ok(()) } else { Err(SolveError::NotFinite) }
    }

    /// Moves the last stage, whose mass matrix `work` holds, by the shortest way to where the constraints are met to
    /// rounding. Next to a singular position what the iteration leaves of them is a far larger way, which the next step
    /// would go in an instant.
    fn onto_constraints(
        &mut self,
        model: &Model,
        state: &State,
        work: &mut Workspace,
        h: f64,
    ) -> Result<(), SolveError> {
        let Some(mut way) = way_back(model, &self.at(state, h, 2), work) else { return Ok(()) };
        work.solve(model, Which::Mass, &mut way)?;
        for (z, d) in self.z[2].iter_mut().zip(&way) {
            *z += d;
        }
        retract(model.nodes(), &state.q, &self.z[2], &mut self.q[2]);
        Ok(())
    }

    /// Moves the state to the end of the step, and keeps its stages for the next.
    pub(super) fn accept(&mut self, model: &Model, state: &mut State, h: f64) {
        let nv = model.velocities();
        let c = &mut state.control;
        for (to, from) in c.stage_lambda.iter_mut().zip(&mut self.lambda) {
            to.resize(from.len(), 0.0);
            std::mem::swap(to, from);
        }
        for (i, d) in c.stages.iter_mut().enumerate() {
            d.resize(nv, 0.0);
            let from = if i == 0 { &state.q } else { &self.q[i - 1] };
            difference(model.nodes(), &self.q[2], from, d);
        }
        std::mem::swap(&mut state.q, &mut self.q[2]);
        std::mem::swap(&mut state.v, &mut self.v[2]);
        std::mem::swap(&mut state.a, &mut self.a[2]);
        std::mem::swap(&mut state.aux, &mut self.e);
        std::mem::swap(&mut state.lambda, &mut self.bias);
        state.t += h;
    }
}
