//! Over which time errors add up.
//!
//! Error control lets the errors of steps add up to the tolerance over a horizon: the length of the run, unless it is given.
//! Time in which steps err by next to nothing doesn't count: what moves for ten seconds after an hour at rest has the
//! tolerance for these ten seconds. And a motion that forgets its errors, such as that of a line which drag damps, adds them
//! up no longer than it remembers them: how long is [measured](super::look) in runs long enough to gain by it.

use super::Simulation;
use crate::solve::integrator::{StepReport, Stepping};

/// A step whose error is less than this part of what it may be errs by next to nothing.
const NOTHING: f64 = 1e-2;
/// Least part of the run that errors are taken to add up over.
const LEAST: f64 = 1e-3;
/// Steps after which memory is first measured: the start lies behind.
const FIRST: u64 = 64;
/// How many times as many steps later it is measured again, where errors were forgotten and where they were not.
const AGAIN: [u64; 2] = [4, 32];
/// Steps that a run takes at least in which measuring pays.
const WORTH: f64 = 1000.0;
/// Steps of a measurement, in parts of those of the run.
const SHARE: f64 = 1.0 / 40.0;
/// Between which parts of the run it is measured.
const BETWEEN: [f64; 2] = [0.02, 0.5];
/// Over how many times the time that the motion remembers errors are taken to add up.
const SAFE: f64 = 3.0;

/// In how many times the time that a motion remembers errors they are seen to be forgotten.
const SEEN: f64 = 6.0;

/// The time over which errors add up.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Memory {
    /// When the run began [s].
    began: f64,
    /// How long the run is to be [s].
    pub whole: f64,
    /// Time in which steps erred by next to nothing [s].
    rest: f64,
    /// How long the motion remembers an error, if it was seen to forget [s].
    forgets: Option<f64>,
    /// Steps of the run at which that is measured next.
    next: u64,
}

/// How a motion treats an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Remembers {
    /// It forgets: what is left of an error adds up to the error itself times this [s].
    For(f64),
    /// Not forgotten as long as it was looked at [s].
    Longer(f64),
    /// It doesn't fade at all.
    Always,
}

impl Memory {
    /// Of a run of this length from time `began` [s].
    pub fn new(began: f64, whole: f64) -> Self {
        Memory { began, whole, rest: 0.0, forgets: None, next: FIRST }
    }

    /// The horizon of error control [s].
    pub fn horizon(&self) -> f64 {
        let moving = (self.whole - self.rest).max(LEAST * self.whole);
        self.forgets.map_or(moving, |memory| moving.min(SAFE * memory))
    }

    /// Whether errors that are remembered for so long [s] would add up over less than the run.
    pub fn would_help(&self, memory: f64) -> bool {
        SAFE * memory < self.whole
    }

    /// When the run is to end [s].
    pub fn end(&self) -> f64 {
        self.began + self.whole
    }

    /// Whether the motion was seen to forget errors.
    pub fn forgets(&self) -> bool {
        self.forgets.is_some()
    }

    /// Steps that a measurement may take now: none if it isn't worth one.
    fn due(&self, t: f64, steps: u64) -> Option<u64> {
        let past = t - self.began;
        let expected = steps as f64 * self.whole / past;
        let midst = past >= BETWEEN[0] * self.whole && past <= BETWEEN[1] * self.whole;
        let due = steps >= self.next && expected >= WORTH && midst;
        due.then_some((SHARE * expected) as u64)
    }

    /// Notes what was measured after so many steps.
    fn note(&mut self, found: Remembers, steps: u64) {
        (self.forgets, self.next) = match found {
            Remembers::For(memory) => (Some(memory), AGAIN[0] * steps),
            // a look that was too short to see what was seen before says nothing against it
            Remembers::Longer(looked) => {
                (self.forgets.filter(|memory| looked < SEEN * memory), AGAIN[1] * steps)
            }
            Remembers::Always => (None, u64::MAX),
        };
    }
}

impl Simulation {
    /// Takes note of a step, and tells the integrator over which time errors add up.
    pub(super) fn remember(&mut self, report: &StepReport) {
        let options = self.integrator.options();
        let chosen = options.horizon == 0.0 && matches!(options.stepping, Stepping::Controlled { .. });
        if !chosen {
            return;
        }
        if report.error < NOTHING {
            self.memory.rest += report.h;
        }
        let steps = self.work.counts.steps;
        if let Some(most) = self.memory.due(self.state.t, steps) {
            let found = self.measure_memory(most);
            self.memory.note(found, steps);
        }
        self.integrator.set_horizon(self.memory.horizon());
    }
}
