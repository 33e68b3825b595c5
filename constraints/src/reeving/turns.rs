//! Several turns of a cable about a wheel.

use super::sheave::Sheave;
use ropewalk_core::{Action, Event, Model, State};
use std::sync::Arc;

/// Wrap at which a cable with turns has come off its wheel [rad].
const OFF: f64 = 0.01;

/// Ends the run where all turns have come off.
pub(super) struct Unwound {
    pub sheave: Arc<Sheave>,
    pub groove: usize,
}

impl Event for Unwound {
    fn name(&self) -> String {
        format!("all turns of the cable have come off `{}`", self.sheave.name)
    }
    fn value(&self, _: &Model, state: &State) -> f64 {
        OFF - self.sheave.instant(self.groove, &state.at()).wrap
    }
    fn direction(&self) -> i8 {
        1
    }
    fn act(&self, _: &Model, _: &mut State) -> Action {
        Action::Fail("a cable that leaves its wheel isn't known there: shorten the run".into())
    }
}
