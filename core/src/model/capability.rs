//! What some terms can do besides adding forces. A term that can says so once ([`Term::timed`] and the
//! like); of all others nothing is asked, and they cost nothing.

use crate::model::column::Column;
use crate::model::solid::Solid;
use crate::model::state::At;
use crate::model::term::{Power, Term};
use std::sync::Arc;

/// Depends on time otherwise than through the state.
pub trait Timed {
    /// How much of a step `h` from `t` may be taken that leaps over nothing of what time does to it [s], as the functions
    /// of [`reach`](crate::model::reach) tell for rises, periods and knots. `None` if it doesn't know: error control then
    /// looks at its force at the quarter points of every step, between which a short pulse may hide.
    fn reach(&self, _t: f64, _h: f64) -> Option<f64> {
        None
    }
    /// The period with which time makes it go to and fro [s], infinite if it doesn't, as [`Motion::period`](crate::Motion::period).
    fn period(&self, _t: f64) -> f64 {
        f64::INFINITY
    }
    /// When its force jumps next after `t` [s]; infinite if it never does. Error control ends a step just before and
    /// starts anew there.
    fn jump(&self, _t: f64) -> f64 {
        f64::INFINITY
    }
}

/// Has something ahead in the state that a long step could miss.
pub trait Foresees {
    /// The longest step from here that is sure not to leap over what it has ahead, such as a shape that a point flies
    /// towards [s]. Error control takes no longer one; fixed steps are left alone.
    fn step_limit(&self, at: &At<'_>) -> f64;
    /// What has gone where it can't have gone in a step between two states, such as through a wall; nothing if all is
    /// well. The step is then repeated smaller, and if that doesn't help the run ends with these words.
    fn passes(&self, _before: &At<'_>, _after: &At<'_>) -> Option<String> {
        None
    }
    /// What energy the trapezoidal rule misses of its power between two states [J]: of what fades or sets in within a step of
    /// its own accord, as it itself knows it.
    fn missed(&self, _before: &At<'_>, _after: &At<'_>) -> Power {
        Power::zero()
    }
}

/// Remembers something in [`State::internal`](crate::State::internal), such as where dry friction took hold.
pub trait Remembers {
    /// Brings what it remembers up to date at a state that was accepted: `memory` is all of the internal variables, as they
    /// were at the start of the step, and `at` has none.
    fn remember(&self, at: &At<'_>, memory: &mut [f64]);
    /// Whether it takes part in equilibria. If not, they are found as if it weren't there, and it begins to remember with time.
    fn rests(&self) -> bool {
        false
    }
    /// Whether it takes hold of the first equilibrium, which is one without any of it.
    fn takes_hold(&self) -> bool {
        false
    }
    /// Forgets all that held, since an equilibrium is looked for from a guess.
    fn let_go(&self, _memory: &mut [f64]) {}
    /// Which way what it resists goes at equilibria, if it takes part in those so: a word such as `hoisting`.
    fn sliding(&self) -> Option<&'static str> {
        None
    }
    /// Brings what it remembers up to date at an equilibrium, if it takes part in those; whether the equilibrium is another one
    /// now and has to be found anew.
    fn settle(&self, _at: &At<'_>, _memory: &mut [f64]) -> bool {
        false
    }
    /// Why it can't tell what has become of what it remembers at a state that was found from the last one, if it can't: that is too
    /// far away. The step is then repeated smaller.
    fn lost(&self, _at: &At<'_>) -> Option<String> {
        None
    }
    /// What can't tell how it was stretched after an accepted step, since it went to and fro within it, if there is such: a step
    /// of error control is then repeated smaller. `far` says whether a way back [m] is too long for what has this velocity.
    fn overran(
        &self,
        _before: &At<'_>,
        _after: &At<'_>,
        _far: &dyn Fn(usize, f64) -> bool,
    ) -> Option<String> {
        None
    }
    /// The internal variable that counts on with an angle by which sections are labelled [rad], and that angle: where labels
    /// change and sections stay, their sum does.
    fn labels(&self, _q: &[f64]) -> Option<(usize, f64)> {
        None
    }
}

/// Couples unknowns that depend on the state, such as those of lines that come near each other: all that it may couple
/// around the state that it was made for. [`Foresees`] keeps steps within that.
pub trait Couples {
    /// The same term as it couples around this state, where what it couples may soon not cover it; with `anyhow` in any
    /// case. It has to follow from the state alone, so that a run that is resumed goes on alike.
    fn renewed(&self, at: &At<'_>, anyhow: bool) -> Option<Arc<dyn Term>>;
}

/// Shows more of itself than forces and energy.
pub trait Shows {
    /// What a record of type `force` shows of it; names are put behind that of the record.
    fn columns(&self) -> Vec<Column> {
        Vec::new()
    }
    /// Appends the values of [`Shows::columns`].
    fn observe(&self, _at: &At<'_>, _out: &mut Vec<f64>) {}
    /// A quantity of its own at an arc length of the material of a part [m]; `None` if it has none of this name, or doesn't
    /// act there.
    fn local(&self, _quantity: &str, _part: &str, _s: f64, _at: &At<'_>) -> Option<f64> {
        None
    }
    /// What there is to be seen of it, such as a shape that others touch.
    fn solids(&self) -> Vec<Solid> {
        Vec::new()
    }
    /// What one should know of it at the end of a run, in a sentence: such as that a mesh is too coarse for it.
    fn remark(&self, _at: &At<'_>) -> Option<String> {
        None
    }
}
