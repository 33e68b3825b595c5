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
/// Steps after which memory is first measured: the start lies behind, and measuring costs little beside what was spent.
const FIRST: u64 = 1000;
/// How many times as many steps later it is measured again: where errors were forgotten; where they weren't; and where it
/// couldn't be measured.
const AGAIN: [u64; 3] = [4, 3, 32];
/// How many times shorter steps have become where the motion is another, as that of a hose that sank and is towed: what
/// was seen of errors that weren't forgotten is soon looked at anew.
const OTHER: f64 = 2.0;
const SOONER: u64 = 2;
/// Steps that a run has ahead at least in which measuring pays.
const WORTH: f64 = 1000.0;
/// Steps of a measurement, in parts of those ahead, and at most of those taken: how many are ahead may be far fewer than the
/// latest let one expect.
const SHARE: [f64; 2] = [1.0 / 40.0, 0.1];
/// From which part of the run on it is measured.
const EARLIEST: f64 = 0.02;
/// Steps over which their mean length tells how many are ahead.
const LATEST: u64 = 32;
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
    /// Mean length of the latest steps [s], now and when it was last measured.
    pace: [f64; 2],
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
        Memory { began, whole, rest: 0.0, forgets: None, next: FIRST, pace: [0.0; 2] }
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

    /// Takes note of a step: how long it was [s], its error in parts of what it may be, and which one it is.
    fn pass(&mut self, h: f64, error: f64, steps: u64) {
        if error < NOTHING {
            self.rest += h;
        }
        self.pace[0] += (h - self.pace[0]) / steps.clamp(1, LATEST) as f64;
    }

    /// Steps that a measurement may take now: none if it isn't worth one, as where most of the run lies behind.
    fn due(&self, t: f64, steps: u64) -> Option<u64> {
        let ahead = (self.end() - t) / self.pace[0];
        let begun = t - self.began >= EARLIEST * self.whole;
        let other = self.forgets.is_none() && OTHER * self.pace[0] < self.pace[1];
        let next = if other { self.next / SOONER } else { self.next };
        let due = steps >= next && begun && ahead >= WORTH.max(steps as f64);
        due.then_some((SHARE[0] * ahead).min(SHARE[1] * steps as f64) as u64)
    }

    /// Notes what was measured after so many steps.
    fn note(&mut self, found: Remembers, steps: u64) {
        self.pace[1] = self.pace[0];
        (self.forgets, self.next) = match found {
            Remembers::For(memory) => (Some(memory), AGAIN[0] * steps),
            // a look that was too short to see what was seen before says nothing against it
            Remembers::Longer(looked) => {
                let again = if looked > 0.0 { AGAIN[1] } else { AGAIN[2] };
                (self.forgets.filter(|memory| looked < SEEN * memory), again * steps)
            }
            Remembers::Always => (None, AGAIN[1] * steps),
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
        let steps = self.work.counts.steps;
        self.memory.pass(report.h, report.error, steps);
        if let Some(most) = self.memory.due(self.state.t, steps) {
            let found = self.measure_memory(most);
            self.memory.note(found, steps);
        }
        self.integrator.set_horizon(self.memory.horizon());
    }
}
