//! What may happen at a wheel: the cable leaves it, meets itself, goes slack, is flung off, or its blocks meet.

use super::sheave::Sheave;
use ropewalk_core::{Action, Event, Model, State};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Wrap at which a cable leaves its wheel [rad].
const LEAVES: f64 = 0.01;

/// How near to a whole turn a wrap may come [rad].
const WHOLE: f64 = 0.01;

/// What is watched for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum What {
    /// The cable leaves the wheel.
    Leaves,
    /// The wrap reaches a whole turn.
    Whole,
    /// The cable is slack on the wheel.
    Slack,
    /// Its speed lifts it out of the groove.
    Flung,
}

/// Watches one groove of a wheel.
pub(super) struct Watch {
    pub what: What,
    pub sheave: Arc<Sheave>,
    pub groove: usize,
}

impl Event for Watch {
    fn name(&self) -> String {
        let name = &self.sheave.name;
        match self.what {
            What::Leaves => format!("the cable leaves `{name}`: its wrap has fallen to {LEAVES} rad"),
            What::Whole => format!("the cable has wrapped all round `{name}` and would cross itself"),
            What::Slack => format!("the cable is slack on `{name}`; it is kept in its groove"),
            What::Flung => {
                format!("the cable runs so fast that it lifts off from `{name}`; it is kept in its groove")
            }
        }
    }
    fn value(&self, _: &Model, state: &State) -> f64 {
        let at = state.at();
        let x = self.sheave.instant(self.groove, &at);
        let ea = self.sheave.grooves[self.groove].arc.strand.ea;
        match self.what {
            What::Leaves => {
                // a wrap just below none is one just below a whole turn
                let wrap = if x.wrap > TAU - 0.5 * WHOLE { x.wrap - TAU } else { x.wrap };
                LEAVES - wrap
            }
            What::Whole => x.wrap - (TAU - WHOLE),
            What::Slack => -x.tension / ea - 1e-12,
            What::Flung => {
                let lift = x.lift[0].max(x.lift[1]);
                if x.tension <= 0.0 { -1e-12 } else { (lift - x.tension) / ea }
            }
        }
    }
    fn direction(&self) -> i8 {
        1
    }
    fn act(&self, _: &Model, _: &mut State) -> Action {
        match self.what {
            What::Slack | What::Flung => Action::Continue,
            What::Leaves => Action::Fail(
                "a cable that leaves a sheave and comes back isn't known: shorten the run, or leave the sheave out"
                    .into(),
            ),
            What::Whole => Action::Fail("several turns on a sheave aren't known".into()),
        }
    }
}

/// Ends the run where a span between wheels or rings is used up.
pub(super) struct Short {
    /// The span.
    pub span: String,
    /// The shortest that it may become [m].
    pub length: f64,
}

impl Event for Short {
    fn name(&self) -> String {
        format!("`{}` is used up: what is at its ends meets", self.span)
    }
    fn value(&self, model: &Model, state: &State) -> f64 {
        model.part(&self.span).map_or(-1.0, |part| 1.0 - part.length_now(&state.at()) / self.length)
    }
    fn direction(&self) -> i8 {
        1
    }
    fn act(&self, _: &Model, _: &mut State) -> Action {
        Action::Stop
    }
}
