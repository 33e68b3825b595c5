//! Samples between the ends of steps.
//!
//! Positions between steps are interpolated. Forces aren't always: a stiff cable makes `EA/l` of force of every metre that
//! an interpolation is off. Where the interpolated state doesn't balance, the sample is the end of a step of its own.

use super::Simulation;
use crate::dense::Dense;
use crate::integrator::{Stepping, Workspace};

/// What an interpolated state may leave of the equations of motion, in parts of the tolerance of forces.
const BALANCED: f64 = 0.1;
/// A sample of its own that takes more steps than this is given up.
const MOST_STEPS: usize = 20;

impl Simulation {
    /// Sets the scratch state to that at time `t` inside the last step; with `forces` to one whose forces are right.
    pub(super) fn between(&mut self, t: f64, forces: bool) {
        Dense::new(&self.model, &self.previous, &self.state).at(t, &mut self.scratch);
        if forces && !self.balances() {
            // a step that fails leaves the interpolation
            let _ = self.step_to(t);
        }
    }

    /// Whether the scratch state meets the equations of motion well enough for its forces to be those of the motion.
    fn balances(&mut self) -> bool {
        let (state, work) = (&self.scratch, &mut self.work);
        self.model.assemble(&state.at(), &state.lambda, None, &mut work.system);
        let tolerance = BALANCED * self.integrator.options().force_tolerance;
        let residual = &work.system.residual;
        work.forces.ratio(&work.norms, residual, &state.a, &state.lambda, tolerance) <= 1.0
    }

    /// Sets the scratch state to the end of steps of its own from the start of the last one. They have a workspace of
    /// their own: what is looked at doesn't change the run.
    fn step_to(&mut self, t: f64) -> Option<()> {
        let mut work = match self.aside.take() {
            Some(work) => work,
            None => Box::new(Workspace::new(&self.model).ok()?),
        };
        work.softening = self.work.softening.clone();
        let mut state = self.previous.clone();
        let mut taken = 0;
        let near = 1e-9 * (self.state.t - self.previous.t);
        if let Stepping::Controlled { .. } = self.integrator.options().stepping {
            state.control.h_next = t - state.t;
        }
        while t - state.t > near && taken < MOST_STEPS {
            let left = t - state.t;
            if self.integrator.step(&self.model, &mut state, &mut work, left).is_err() {
                break;
            }
            taken += 1;
        }
        let done = t - state.t <= near;
        if done {
            state.t = t;
            self.scratch = state;
        }
        self.aside = Some(work);
        done.then_some(())
    }
}
