//! What may happen at a drum: it is empty, or full, or the cable comes too far from the side.

use super::shaft::Shaft;
use ropewalk_core::{Action, Event, Model, State};
use std::sync::Arc;

/// What is watched for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum What {
    /// Only the dead turns are left, of this angle [rad].
    Empty(f64),
    /// Cable lies in all layers, up to this angle [rad].
    Full(f64),
    /// The fleet angle exceeds this one [rad].
    Fleet(f64),
}

/// Watches a drum.
pub(super) struct Watch {
    pub what: What,
    pub drum: Arc<Shaft>,
}

impl Event for Watch {
    fn name(&self) -> String {
        let name = &self.drum.name;
        match self.what {
            What::Empty(left) => {
                let turns = left / std::f64::consts::TAU;
                format!("`{name}` is empty: the last {turns:.0} turns of cable stay on it")
            }
            What::Full(_) => format!("`{name}` is full: cable lies in all its layers"),
            What::Fleet(most) => {
                let degrees = most.to_degrees();
                format!(
                    "the cable arrives at `{name}` by more than {degrees:.3} degrees from the side: it winds badly"
                )
            }
        }
    }
    fn value(&self, _: &Model, state: &State) -> f64 {
        let at = state.at();
        match self.what {
            What::Empty(left) => left - self.drum.angle(&at),
            What::Full(most) => self.drum.angle(&at) - most,
            What::Fleet(most) => self.drum.fleet(&at).abs() - most,
        }
    }
    fn direction(&self) -> i8 {
        1
    }
    fn act(&self, _: &Model, _: &mut State) -> Action {
        match self.what {
            What::Fleet(_) => Action::Continue,
            What::Empty(_) | What::Full(_) => Action::Stop,
        }
    }
}
