//! A simulation that is moved by hand: single steps, and states that are set.

use super::{End, Observer, Simulation};
use crate::model::Model;
use crate::model::state::State;
use crate::solve::integrator::{Correction, StepError, StepReport, restart};
use std::ops::ControlFlow;

/// Stops after one step.
struct Once;

impl Observer for Once {
    fn wants_samples(&self) -> bool {
        false
    }
    fn step(&mut self, _: &Model, _: &State, _: &StepReport) -> ControlFlow<()> {
        ControlFlow::Break(())
    }
}

impl Simulation {
    /// Takes one step of the integrator, no further than to time `end`; nothing if that is now. The step is that of an
    /// advance to `end`, events included.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn step(&mut self, end: f64) -> Result<End, StepError> {
        let span = end - self.state.t;
        let interval = if span > 0.0 { span } else { 1.0 };
        match self.advance(end, interval, &mut Once)? {
            End::Stopped { by } if by == "interrupt" => Ok(End::Done),
            other => Ok(other),
        }
    }

    /// Goes on from another state of the same model: its positions and velocities are moved onto the constraints, and
    /// accelerations, multipliers and the memory of the integrator made anew. Inputs and the balance of energy stay as they
    /// are; controllers act at their next instant. (A [`Checkpoint`](super::Checkpoint) is all of a simulation.)
    ///
    /// # Errors
    /// A state of another model, or with numbers that aren't finite: then nothing is changed. One that can't be made
    /// consistent.
    pub fn set_state(&mut self, state: State) -> Result<Correction, StepError> {
        fits(&self.model, &state)?;
        self.state = state;
        self.recouple(true)?;
        let internal = self.state.internal.clone();
        let correction = restart(&self.model, &mut self.state, &mut self.work, self.integrator.as_ref())?;
        self.state.internal = internal;
        self.resume(usize::MAX, false);
        self.restart_controllers();
        Ok(correction)
    }

    pub(super) fn check_state(&self) -> Result<(), StepError> {
        fits(&self.model, &self.state)
    }
}

fn fits(model: &Model, state: &State) -> Result<(), StepError> {
    model.check(state).map_err(StepError::Foreign)?;
    if state.is_finite() {
        return Ok(());
    }
    Err(StepError::Foreign("it holds numbers that aren't finite".into()))
}
