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

use super::controller::{StepController, StepLaw};
use super::convergence::{Failure, Rate};
use super::forces::larger;
use super::options::{Limits, Options, Stepping};
use super::step::{Integrator, StepError, StepReport, linear, too_strict};
use super::workspace::Workspace;
use crate::model::Model;
use crate::model::limit::Limit;
use crate::model::node::{NodeId, NodeKind};
use crate::model::state::State;
use crate::solve::integrator::workspace::Which;
use crate::solve::linear::SolveError;
use newton::Newton;
use stages::Stages;
use tableau::GAMMA;

/// Integrator Radau IIA of order 5.
pub struct Radau {
    options: Options,
    limits: Limits,
    horizon: f64,
}

/// Safety factor of the step-size controller.
const SAFETY: f64 = 0.9;
/// Most iterations of a step: more are dearer than a smaller step.
const MOST_ITERATIONS: u32 = 10;
/// Weight of velocities in the error beside positions, in parts of the horizon.
const VELOCITY: f64 = 0.1;
/// What the iteration may leave, in parts of the tolerance. It adds up over the steps: 0.03 left loops of stiff joints off
/// by hundreds of times the tolerance.
const ITERATION: f64 = 0.003;
/// The same in a mechanism, in parts of the step in the horizon: what iterations leave of velocities adds up with the square
/// of time. With 0.003 a spinning pendulum was off by 40 times the tolerance.
const HELD: f64 = 0.06;
/// The same where a body turns freely: what an iteration leaves of its spin adds up over the run.
const SPINNING: f64 = 1e-7;
/// The tolerance whose iteration error fixed steps are given.
const FIXED: f64 = 1e-7;

/// Its steps grow by the fourth root of their error, less after many iterations.
const LAW: StepLaw = StepLaw {
    growth,
    trend: Some(trend),
    most: [5.0, 1.0],
    worthless: 1.2,
    // where the cap limits the steps for long, faster growth fails more often and gains nothing
    recovery: 1.03,
    shares_rest: true,
};

fn growth(error: f64, iterations: u32) -> f64 {
    let most = 2.0 * f64::from(MOST_ITERATIONS);
    SAFETY * (most + 1.0) / (most + f64::from(iterations)) * error.max(1e-10).powf(-0.25)
}

/// As the error grew in the last step, it will grow in the next (Gustafsson 1994).
fn trend(error: f64, before: f64, [h, h_before]: [f64; 2]) -> f64 {
    SAFETY * h / h_before * (before.max(1e-2) / error.max(1e-10).powi(2)).powf(0.25)
}

impl Radau {
    /// Checks the options. `duration` is the length of the run, over which errors add up unless the options say
    /// otherwise.
    ///
    /// # Errors
    /// The options are wrong.
    pub fn new(options: &Options, duration: f64) -> Result<Self, StepError> {
        options.check()?;
        let (limits, horizon) = (options.limits(duration), options.horizon_in(duration));
        Ok(Radau { options: options.clone(), limits, horizon })
    }

    /// Stages, error and end of a step, left in `s`; the end only of a step that is good enough.
    fn attempt(
        &self,
        model: &Model,
        state: &State,
        work: &mut Workspace,
        s: &mut Stages,
        h: f64,
    ) -> Result<(Rate, f64), Failure> {
        let tolerance = match self.options.stepping {
            Stepping::Fixed { .. } => FIXED,
            Stepping::Controlled { tolerance } => tolerance.min(1e-3),
        };
        let time = VELOCITY * self.horizon;
        let controlled = matches!(self.options.stepping, Stepping::Controlled { .. });
        let left = match model.turns_smoothly() {
            _ if controlled && self.spins(model, state) => SPINNING,
            true if controlled => (HELD * h / self.horizon).clamp(SPINNING, ITERATION),
            _ => ITERATION,
        };
        // velocities are increments over the step: their tolerance asks for a tighter one in shorter steps
        let asked = self.options.newton_tolerance * tolerance * (h / time).min(1.0);
        let newton = Newton {
            model,
            state,
            h,
            policy: self.options.newton,
            max_iterations: self.options.max_iterations.min(MOST_ITERATIONS),
            tolerance: asked * left,
            wandering: asked * if model.turns_smoothly() { left.max(ITERATION) } else { left },
            force_tolerance: self.options.newton_tolerance * self.options.newton_force_tolerance(),
            linear_constraints: !model.is_mechanism(),
        };
        let converged = newton.solve(work, s)?;
        if let Some(why) = model.flips(&state.q, &s.z[2]) {
            return Err(Failure::newton(why));
        }
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
                return Err(Failure::newton("the error estimate is not finite"));
            }
        }
        if error <= 1.0 {
            s.end(model, state, work, h)?;
        }
        Ok((converged, error))
    }

    /// Whether a body that nothing holds turns by more than a radian within the horizon.
    fn spins(&self, model: &Model, state: &State) -> bool {
        let held = |id: NodeId| model.constraints().iter().any(|c| c.nodes().contains(&id));
        model.nodes().iter().enumerate().filter(|(_, n)| n.kind == NodeKind::Frame).any(|(k, n)| {
            let square: f64 = n.dofs().skip(3).map(|i| state.v[i] * state.v[i]).sum();
            square * self.horizon * self.horizon > 1.0 && !held(NodeId(k as u32))
        })
    }

    fn advance(
        &self,
        model: &Model,
        state: &mut State,
        work: &mut Workspace,
        s: &mut Stages,
        h_max: f64,
    ) -> Result<StepReport, StepError> {
        let mut steps = StepController::new(&LAW, self.options.stepping, self.limits, &state.control, h_max);
        loop {
            let h = steps.h;
            match self.attempt(model, state, work, s, h) {
                Ok((rate, error)) if error <= 1.0 => {
                    s.accept(model, state, h);
                    let c = &mut state.control;
                    work.forces.keep(&mut c.forces);
                    steps.accepted(c, error, rate.iterations, Limit::Position);
                    (c.eta, c.theta) = (rate.eta, rate.theta.unwrap_or(c.theta));
                    work.counts.steps += 1;
                    let (iterations, rejected, limit) = (rate.iterations, steps.rejected, steps.limit);
                    return Ok(StepReport {
                        h,
                        iterations,
                        rejected,
                        error,
                        limit,
                        rings: None,
                        strained: None,
                    });
                }
                Ok((rate, error)) => {
                    work.counts.rejected += 1;
                    if !steps.too_large(error, rate.iterations, Limit::Position) {
                        return Err(too_strict(model, state.t, &steps, work));
                    }
                }
                Err(failure) => {
                    let equation = work.worst_equation(model);
                    work.counts.rejected += 1;
                    if !steps.failed(&mut state.control) {
                        return Err(match failure {
                            Failure::Newton(why) => StepError::NoConvergence { t: state.t, h, why, equation },
                            Failure::Linear(source) => linear(model, state.t, source),
                        });
                    }
                }
            }
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

    fn per_period(&self) -> f64 {
        // what it errs by in a step of the longest that motions allow is far below any tolerance of forces
        0.0
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
