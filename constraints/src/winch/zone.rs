//! Elements that are added and removed at an end that pays out.

use ropewalk_core::{Action, Change, Event, Model, Plan, State};

/// Splits the element at an end once it has grown, and merges it with its neighbour once it has shrunk.
#[derive(Clone, Debug)]
pub struct Zone {
    /// Name of the winch.
    pub winch: String,
    /// The cable.
    pub part: String,
    /// Its end: 0 the start, 1 the end.
    pub end: usize,
    /// Target length of elements [m].
    pub element: f64,
    /// Time in which the strain fades that keeps the tension from jumping [s].
    pub fade: f64,
    /// Whether it watches for growth, or for shrinking.
    pub grows: bool,
}

/// Length of an element that is split, and of one that is merged, in parts of the target length. After a split 0.6 are
/// left and after a merge there are 1.5: each is well away from where the other happens.
pub(super) const SPLIT: f64 = 1.6;
pub(super) const MERGE: f64 = 0.5;

impl Zone {
    /// Length of the element at the end [m].
    fn length(&self, model: &Model, state: &State) -> f64 {
        model
            .part(&self.part)
            .and_then(|p| p.line()?.end_element(self.end, &state.at()))
            .unwrap_or(self.element)
    }
}

impl Event for Zone {
    fn name(&self) -> String {
        let what = if self.grows { "an element is born" } else { "an element is swallowed" };
        format!("`{}`: {what} at the {} of `{}`", self.winch, ["start", "end"][self.end], self.part)
    }
    fn value(&self, model: &Model, state: &State) -> f64 {
        let length = self.length(model, state) / self.element;
        if self.grows { length - SPLIT } else { MERGE - length }
    }
    fn direction(&self) -> i8 {
        1
    }
    fn act(&self, model: &Model, state: &mut State) -> Action {
        let change = match self.grows {
            true => Change::Split { end: self.end, keep: self.element, fade: self.fade },
            false => Change::Merge { end: self.end, fade: self.fade },
        };
        let mut plan = Plan::new();
        for part in model.parts() {
            let own = if part.name() == self.part { change } else { Change::None };
            match part.line().map_or(Ok(None), |line| line.remesh(own, &state.at())) {
                Ok(Some(mesh)) => drop(plan.insert(part.name().to_string(), mesh)),
                Ok(None) => {}
                Err(message) => return Action::Fail(message),
            }
        }
        match model.remesh(&plan) {
            Ok(model) => Action::Remesh(Box::new(model)),
            Err(e) => Action::Fail(e.to_string()),
        }
    }
    fn remeshes(&self) -> Option<(&str, usize)> {
        Some((&self.part, self.end))
    }
}
