//! Over which time errors add up.
//!
//! Error control lets the errors of steps add up to the tolerance over a horizon: the length of the run, unless it is given.
//! Time in which steps err by next to nothing doesn't count: what moves for ten seconds after an hour at rest has the
//! tolerance for these ten seconds.

use super::Simulation;
use crate::solve::integrator::{StepReport, Stepping};

/// A step whose error is less than this part of what it may be errs by next to nothing.
const NOTHING: f64 = 1e-2;
/// Least part of the run that errors are taken to add up over.
const LEAST: f64 = 1e-3;

/// The time over which errors add up.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Memory {
    /// How long the run is to be [s].
    whole: f64,
    /// Time in which steps erred by next to nothing [s].
    rest: f64,
}

impl Memory {
    /// Of a run of this length [s].
    pub fn new(whole: f64) -> Self {
        Memory { whole, rest: 0.0 }
    }

    /// The horizon of error control [s].
    pub fn horizon(&self) -> f64 {
        (self.whole - self.rest).max(LEAST * self.whole)
    }
}

impl Simulation {
    /// Takes note of a step, and tells the integrator over which time errors add up.
    pub(super) fn remember(&mut self, report: &StepReport) {
        let options = self.integrator.options();
        let chosen = options.horizon == 0.0 && matches!(options.stepping, Stepping::Controlled { .. });
        if chosen && report.error < NOTHING {
            self.memory.rest += report.h;
            self.integrator.set_horizon(self.memory.horizon());
        }
    }
}
