//! Radau IIA with three stages, of order 5, on the index-3 equations, with fixed or error-controlled steps
//! (Hairer & Wanner 1996, Solving Ordinary Differential Equations II, sections IV.8 and VII.7).
//!
//! Each stage meets the equations of motion and the constraints at the level of positions. At the end of the step
//! velocities are projected onto the constraints; accelerations and multipliers come from the equations of motion
//! there, which gives multipliers the order of the positions.

mod finish;
mod newton;
pub(super) mod stages;
mod tableau;

use super::forces::larger;
use super::options::{Limits, Options, Stepping, fixed_step};
use super::step::{Integrator, StepError, StepReport, linear};
use super::workspace::Workspace;
use crate::model::Model;
use crate::model::state::State;
use crate::solve::integrator::workspace::Which;
use crate::solve::linear::SolveError;
use newton::{Converged, Failure, Newton};
use stages::Stages;
use tableau::GAMMA;

/// Integrator Radau IIA of order 5.
pub struct Radau {
    options: Options,
    limits: Limits,
    horizon: f64,
}

/// Growth per step of the cap on the step size after a failure of Newton's method: where it limits the steps for
/// long, faster growth fails more often and gains nothing.
const RECOVERY: f64 = 1.03;
/// Safety factor of the step-size controller.
const SAFETY: f64 = 0.9;
/// Most iterations of a step: more are dearer than a smaller step.
const MOST_ITERATIONS: u32 = 10;
/// Weight of velocities in the error beside positions, in parts of the horizon.
const VELOCITY: f64 = 0.1;
/// What the iteration may leave, in parts of the tolerance. It adds up over the steps: 0.03 left loops of stiff joints off
/// by hundreds of times the tolerance.
const ITERATION: f64 = 0.003;
/// The tolerance whose iteration error fixed steps are given.
const FIXED: f64 = 1e-7;

impl Radau {
    /// Checks the options. `duration` is the length of the run, over which errors add up unless the options say
    /// otherwise.
    ///
    /// # Errors
    /// The options are wrong.
    pub fn new(options: &Options, duration: f64) -> Result<Self, StepError> {
        options.check().map_err(StepError::Scheme)?;
        let (limits, horizon) = (options.limits(duration), options.horizon_in(duration));
        Ok(Radau { options: options.clone(), limits, horizon })
    }

    /// Size of the first try, and the size that the controller would like.
    fn first(&self, state: &State, h_max: f64) -> (f64, f64) {
        let c = &state.control;
        let cap = if c.h_cap > 0.0 { c.h_cap } else { f64::INFINITY };
        match self.options.stepping {
            Stepping::Fixed { h } => {
                let h = h.min(cap);
                (fixed_step(h, h_max), h)
            }
            Stepping::Controlled { .. } => {
                let wish = if c.h_next > 0.0 { c.h_next } else { state.control.h_start };
                let wish = wish.min(cap).min(self.limits.most);
                let rest = if h_max < 2.0 * wish { 0.5 * h_max } else { wish };
                (if h_max <= wish { h_max } else { rest }, wish)
            }
        }
    }

    /// By which factor the step may change after an error and so many iterations.
    fn growth(&self, error: f64, iterations: u32) -> f64 {
        let most = 2.0 * f64::from(MOST_ITERATIONS);
        SAFETY * (most + 1.0) / (most + f64::from(iterations)) * error.max(1e-10).powf(-0.25)
    }

    /// Size of the step after an accepted one.
    fn next(&self, state: &State, h: f64, error: f64, iterations: u32, rejected: bool) -> f64 {
        let c = &state.control;
        let mut growth = self.growth(error, iterations);
        if c.error > 0.0 {
            // as the error grew in the last step, it will grow in the next (Gustafsson 1994)
            let trend = (c.error.max(1e-2) / error.max(1e-10).powi(2)).powf(0.25);
            growth = growth.min(SAFETY * h / c.h_last * trend);
        }
        let growth = growth.clamp(0.2, if rejected { 1.0 } else { 5.0 });
        // small changes aren't worth a new factorisation
        if (1.0..1.2).contains(&growth) { h } else { h * growth }
    }

    /// Stages, error and end of a step, left in `s`; the end only of a step that is good enough.
    fn attempt(
        &self,
        model: &Model,
        state: &State,
        work: &mut Workspace,
        s: &mut Stages,
        h: f64,
    ) -> Result<(Converged, f64), Failure> {
        let tolerance = match self.options.stepping {
            Stepping::Fixed { .. } => FIXED,
            Stepping::Controlled { tolerance } => tolerance.min(1e-3),
        };
        let time = VELOCITY * self.horizon;
        // velocities are increments over the step: their tolerance asks for a tighter one in shorter steps
        let newton = Newton {
            model,
            state,
            h,
            policy: self.options.newton,
            max_iterations: self.options.max_iterations.min(MOST_ITERATIONS),
            tolerance: self.options.newton_tolerance * ITERATION * tolerance * (h / time).min(1.0),
            force_tolerance: self.options.newton_tolerance * self.options.newton_force_tolerance(),
            linear_constraints: !model.is_mechanism(),
        };
        let converged = newton.solve(work, s)?;
        let mut error = 0.0;
        if let Stepping::Controlled { .. } = self.options.stepping {
            let [q, v] = s.errors(model, state, work, h)?;
            error = larger(q, time * v) / tolerance;
            // a body that is driven has no error, but a larger turn may end on another branch of its joint
            let turn = model.turn(&s.z[2]);
            if turn > 1.0 {
                error += turn.powi(4);
            }
            if !error.is_finite() {
                return Err(Failure::Newton("the error estimate is not finite".into()));
            }
        }
        if error <= 1.0 {
            s.end(model, state, work, h)?;
        }
        Ok((converged, error))
    }

    fn advance(
        &self,
        model: &Model,
        state: &mut State,
        work: &mut Workspace,
        s: &mut Stages,
        h_max: f64,
    ) -> Result<StepReport, StepError> {
        let (mut h, wish) = self.first(state, h_max);
        // a step that only fills the rest of an interval says nothing about the next
        let cut = h < wish;
        let mut report = StepReport::default();
        let mut failures = 0;
        loop {
            let failure = match self.attempt(model, state, work, s, h) {
                Ok((done, error)) if error <= 1.0 => {
                    (report.h, report.iterations, report.error) = (h, done.iterations, error);
                    let next = self.next(state, h, error, done.iterations, report.rejected > 0);
                    s.accept(model, state, h);
                    work.forces.keep(&mut state.control.forces);
                    let c = &mut state.control;
                    c.h_next = if cut && report.rejected == 0 { next.max(wish) } else { next };
                    (c.h_last, c.eta, c.theta, c.error) = (h, done.eta, done.theta, error);
                    c.h_cap = if c.h_cap > 0.0 { c.h_cap * RECOVERY } else { 0.0 };
                    work.counts.steps += 1;
                    return Ok(report);
                }
                Ok((done, error)) => {
                    report.rejected += 1;
                    work.counts.rejected += 1;
                    h *= self.growth(error, done.iterations).clamp(0.2, 0.9);
                    if h < self.limits.least {
                        return Err(StepError::NoConvergence {
                            t: state.t,
                            h,
                            why: "the tolerance asks for a smaller step than `h_min`".into(),
                            equation: work.worst_equation(model),
                        });
                    }
                    continue;
                }
                Err(failure) => failure,
            };
            let equation = work.worst_equation(model);
            report.rejected += 1;
            work.counts.rejected += 1;
            failures += 1;
            let smaller = h * if failures == 1 { 0.7 } else { 0.5 };
            if smaller < self.limits.least {
                return Err(match failure {
                    Failure::Newton(why) => StepError::NoConvergence { t: state.t, h, why, equation },
                    Failure::Linear(source) => linear(model, state.t, source),
                });
            }
            state.control.h_cap = 0.7 * h;
            h = smaller;
        }
    }
}

impl Integrator for Radau {
    fn options(&self) -> &Options {
        &self.options
    }

    fn limits(&self) -> Limits {
        self.limits
    }

    fn horizon(&self) -> f64 {
        self.horizon
    }

    fn set_horizon(&mut self, horizon: f64) {
        self.horizon = horizon;
    }

    fn filter(&self, h: f64) -> f64 {
        (h / GAMMA).powi(2)
    }

    /// A second pass through the filter leaves slow motion its acceleration to fourth order: the error estimate of the
    /// first step builds on it.
    fn settle(
        &self,
        model: &Model,
        state: &mut State,
        work: &mut Workspace,
        _: f64,
        stiff: f64,
    ) -> Result<(), SolveError> {
        if stiff > 0.0 {
            model.assemble(&state.at(), &state.lambda, None, &mut work.system);
            let nv = model.velocities();
            let mut rest: Vec<f64> = work.system.residual.iter().map(|r| -r).collect();
            rest[nv..].fill(0.0);
            work.solve(model, Which::Mass, &mut rest)?;
            for (x, d) in state.a.iter_mut().chain(&mut state.lambda).zip(&rest) {
                *x += d;
            }
        }
        state.aux.copy_from_slice(&state.a);
        Ok(())
    }

    fn step(
        &mut self,
        model: &Model,
        state: &mut State,
        work: &mut Workspace,
        h_max: f64,
    ) -> Result<StepReport, StepError> {
        let failed = |source| linear(model, state.t, source);
        work.ensure_mass(model, &state.at(), &state.lambda).map_err(failed)?;
        let mut stages = match work.stages.take() {
            Some(stages) => stages,
            None => Box::new(Stages::new(model).map_err(failed)?),
        };
        let report = self.advance(model, state, work, &mut stages, h_max);
        work.stages = Some(stages);
        report
    }
}

#[cfg(test)]
mod tests;
