//! What may happen at a wheel: the cable lifts off and comes back, meets itself, goes slack, is flung off, or its blocks meet.

use super::hold::{LEAST_WRAP, Mode};
use super::sheave::Sheave;
use ropewalk_core::{Action, Event, Model, State};
use std::f64::consts::TAU;
use std::sync::Arc;

/// How near to a whole turn a wrap may come [rad].
const WHOLE: f64 = 0.01;

/// How far beside its groove a cable may come down and still be led into it, in parts of the radius.
const BESIDE: f64 = 0.2;

/// What is watched for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum What {
    /// The wrap has become so small that the cable touches the wheel at a point.
    Touches,
    /// The cable wraps it again.
    Wraps,
    /// The cable lifts off.
    Lifts,
    /// It comes down again.
    Lands,
    /// The wrap reaches a whole turn.
    Whole,
    /// The cable is slack on the wheel.
    Slack,
    /// Its speed lifts it out of the groove.
    Flung,
}

impl What {
    /// All of it.
    pub const ALL: [What; 7] =
        [What::Touches, What::Wraps, What::Lifts, What::Lands, What::Whole, What::Slack, What::Flung];

    /// How the cable has to be held for it, if that matters.
    fn held(self) -> Option<Mode> {
        match self {
            What::Touches | What::Whole | What::Flung => Some(Mode::Wraps),
            What::Wraps | What::Lifts => Some(Mode::Touches),
            What::Lands => Some(Mode::Off),
            What::Slack => None,
        }
    }
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
            What::Touches => format!("the cable hardly wraps `{name}` any more and touches it at a point"),
            What::Wraps => format!("the cable wraps `{name}` again"),
            What::Lifts => format!("the cable lifts off from `{name}`"),
            What::Lands => format!("the cable comes down on `{name}`"),
            What::Whole => format!("the cable has wrapped all round `{name}` and would cross itself"),
            What::Slack => format!("the cable is slack on `{name}`; it is kept in its groove"),
            What::Flung => {
                format!("the cable is so fast that nothing presses it on `{name}`; it is kept in its groove")
            }
        }
    }
    fn value(&self, _: &Model, state: &State) -> f64 {
        let (at, groove) = (state.at(), &self.sheave.grooves[self.groove]);
        let mode = Mode::of(at.internal, groove.mode);
        if self.what.held().is_some_and(|held| held != mode) {
            return -1.0;
        }
        let kink = || groove.kink(&self.sheave.seat.axis_now(&at), &at);
        let (ea, radius) = (groove.arc.strand.ea, groove.arc.radius);
        match self.what {
            What::Wraps => return kink() - LEAST_WRAP,
            What::Lifts => return -kink(),
            What::Lands => {
                return (0.5 * LEAST_WRAP).cos() - self.sheave.middle(groove, &at)[1] / radius;
            }
            _ => {}
        }
        if mode != Mode::Wraps {
            return -self.sheave.instant(self.groove, &at).tension / ea - 1e-12;
        }
        let (x, wheel) = self.sheave.lay(self.groove, &at);
        let tension = x.tension + groove.pull(&at);
        match self.what {
            What::Touches => {
                // a wrap just below none is one just below a whole turn
                let wrap = if x.wrap > TAU - 0.5 * WHOLE { x.wrap - TAU } else { x.wrap };
                LEAST_WRAP - wrap
            }
            What::Whole => x.wrap - (TAU - WHOLE),
            What::Flung if tension <= 0.0 => -1e-12,
            What::Flung => {
                let [before, behind] = groove.arc.lift(&x, &wheel);
                (before.max(behind) - tension) / ea
            }
            _ => -tension / ea - 1e-12,
        }
    }
    fn direction(&self) -> i8 {
        1
    }
    fn act(&self, _: &Model, state: &mut State) -> Action {
        let groove = &self.sheave.grooves[self.groove];
        let mode = match self.what {
            What::Slack | What::Flung => return Action::Continue,
            What::Whole => return Action::Fail("several turns on a sheave aren't known".into()),
            What::Wraps => Mode::Wraps,
            What::Touches => Mode::Touches,
            What::Lifts => Mode::Off,
            What::Lands => {
                let [beside, _] = self.sheave.middle(groove, &state.at());
                if !(beside.abs() <= BESIDE * groove.arc.radius) {
                    return Action::Fail(format!(
                        "it comes down {:.3} m beside its groove and would miss it: shorten the run, or leave the sheave out",
                        beside.abs()
                    ));
                }
                Mode::Touches
            }
        };
        state.internal[groove.mode] = mode.value();
        Action::Switch
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
        format!("`{}` is down to {:.3} m: what is at its ends meets (two-blocking)", self.span, self.length)
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
