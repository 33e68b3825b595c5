//! Events: what happens at an instant that the state decides.

use crate::model::Model;
use crate::model::state::State;

/// What an event does once its time is located.
pub enum Action {
    /// Nothing that forces feel at once. If it changed an internal variable, what it started sets in smoothly: the step ends there, and
    /// the integrator goes on with its memory. If it changed none, it was only of interest, and the step stays as it is.
    Continue,
    /// The state (an internal variable, a velocity) was changed: the integrator starts anew from it.
    Restart,
    /// As [`Action::Restart`], but other equations hold from here on: what energy this takes or gives, such as by an impact, is
    /// told and counts as that of a change of mesh.
    Switch,
    /// The mesh changes: the simulation goes on with another model.
    Remesh(Box<Model>),
    /// The run is over.
    Stop,
    /// What should have happened can't, for this reason: the run ends with an error.
    Fail(String),
}

/// What of a state the function of an event depends on.
///
/// Where it is strains or forces, the function is a load over what is allowed, less one: they cost a search each time, and
/// are searched for from half of the allowed load on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depends {
    /// Positions and velocities, as they are interpolated inside a step.
    OnMotion,
    /// How far something stiff is strained, and how fast. Interpolated positions are off by a share of that: those are
    /// meant that are in balance, with velocities on the constraints.
    OnStrains,
    /// Accelerations and multipliers. Inside a step they don't follow from interpolated positions, and at its end multipliers
    /// swing about them: they are those of the equations of motion.
    OnForces,
}

/// A scalar function of the state whose change of sign is located in time, and what happens there.
pub trait Event: Send + Sync {
    /// Its name in reports.
    fn name(&self) -> String;
    /// The function.
    fn value(&self, model: &Model, state: &State) -> f64;
    /// Which way the sign has to change: +1 upwards, -1 downwards, 0 either.
    fn direction(&self) -> i8 {
        0
    }
    /// What of the state it depends on.
    fn depends(&self) -> Depends {
        Depends::OnMotion
    }
    /// What happens there.
    fn act(&self, model: &Model, state: &mut State) -> Action;
    /// What is reported once it is located: its name, and what of the state belongs to it.
    fn report(&self, _model: &Model, _state: &State) -> String {
        self.name()
    }
    /// Whether it only tells and changes nothing: then it is told of equilibria along a path of loads too.
    fn only_tells(&self) -> bool {
        false
    }
    /// The part whose mesh it changes, and at which end, for the report.
    fn remeshes(&self) -> Option<(&str, usize)> {
        None
    }
}
