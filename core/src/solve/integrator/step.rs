//! One step of a scheme: what it offers, what it costs and why it may fail.

use super::controller::StepController;
use super::forces::Strained;
use super::options::{Limits, Options};
use super::workspace::Workspace;
use crate::error::BuildError;
use crate::model::Model;
use crate::model::broken::Broken;
use crate::model::limit::Limit;
use crate::model::state::State;
use crate::solve::linear::SolveError;

/// What an accepted step cost and how good it is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepReport {
    /// Its size [s].
    pub h: f64,
    /// Newton iterations of the accepted try.
    pub iterations: u32,
    /// Tries that were rejected before it, for their error or because Newton's method failed.
    pub rejected: u32,
    /// Estimated error over tolerance; 0 without error control.
    pub error: f64,
    /// What kept it from being longer. A scheme calls whatever is left to go [`Limit::Ahead`]; a
    /// [`Simulation`](crate::Simulation) knows what is there.
    pub limit: Limit,
    /// The number of the part whose tension swings to and fro from step to step, if one does.
    pub rings: Option<usize>,
    /// What its error makes of tensions, where that is estimated.
    pub strained: Option<Strained>,
}

/// Why a step could not be taken. The state is as it was before.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StepError {
    /// Newton's method didn't converge, even with the smallest step.
    #[error(
        "at t = {t:.6} s the step did not converge, even with h = {h:.1e} s: {why}; largest residual in {equation}. \
         Try a smaller `h` or `h_min`, a looser `tolerance`, more elements, or damping"
    )]
    NoConvergence {
        /// Time at which the step started [s].
        t: f64,
        /// Smallest step tried [s].
        h: f64,
        /// What went wrong.
        why: String,
        /// The equation with the largest residual.
        equation: String,
    },
    /// The linear system could not be solved.
    #[error(
        "at t = {t:.6} s: {source}, in {unknown}. Is a part left without mass or free to move without stiffness?"
    )]
    Linear {
        /// Time [s].
        t: f64,
        /// What the solver said.
        source: SolveError,
        /// The unknown at the pivot.
        unknown: String,
    },
    /// Constraints that take part in a redundancy ask for different things.
    #[error(
        "at t = {t:.6} s the constraints {constraints} contradict each other: they can't all be met, and the nearest \
         that the model can come leaves {off:.1e} m (or rad). Remove one of them or correct it"
    )]
    Contradiction {
        /// Time to which the step was to lead [s].
        t: f64,
        /// Their names.
        constraints: String,
        /// By how much the most violated one is off [m, directions times the model's length].
        off: f64,
    },
    /// Most of the energy that there is has appeared from nowhere.
    #[error(
        "at t = {t:.6} s energy has appeared from nowhere: {gained:.1e} J more than loads and motions brought in, of \
         {all:.1e} J that came up in all. The run ends here, since what follows would mean nothing. Take {remedy}. (A term \
         of your own whose energy and power aren't told looks like this too: `audit = false` in [run] doesn't ask.)"
    )]
    Energy {
        /// When it was seen [s].
        t: f64,
        /// How much [J].
        gained: f64,
        /// The largest energy or work so far [J].
        all: f64,
        /// What to change.
        remedy: &'static str,
    },
    /// Something has gone where it can't, however short the steps.
    #[error("at t = {t:.6} s {why}")]
    Passed {
        /// Time [s].
        t: f64,
        /// What has gone where, and what to do.
        why: String,
    },
    /// An event can't do what it should.
    #[error("at t = {t:.6} s, {event}: {why}")]
    Event {
        /// Time [s].
        t: f64,
        /// Which event.
        event: String,
        /// Why not.
        why: String,
    },
    /// A controller wants what is no number.
    #[error(
        "at t = {t:.6} s the controller `{controller}` sets `{input}` to what is no number: look for a division by zero or \
         the root of a negative number in it"
    )]
    Control {
        /// Time [s].
        t: f64,
        /// The controller.
        controller: String,
        /// Its input.
        input: String,
    },
    /// A function of the scene failed that was written elsewhere, or gave no number.
    #[error("{0}")]
    Function(Broken),
    /// The start is not on the constraints and is too far away to be corrected without asking.
    #[error("{0}")]
    Inconsistent(String),
    /// An option is wrong, or the scheme doesn't suit the model.
    #[error(transparent)]
    Options(#[from] BuildError),
    /// The state is that of another model.
    #[error("the state belongs to another model: {0}")]
    Foreign(String),
}

/// An implicit scheme at work. Its memory between steps is in the [`State`].
pub trait Integrator: Send {
    /// The options that it was made with.
    fn options(&self) -> &Options;

    /// Bounds of its steps.
    fn limits(&self) -> Limits;

    /// Time over which the errors of steps may add up [s].
    fn horizon(&self) -> f64;

    /// Sets that time [s].
    fn set_horizon(&mut self, horizon: f64);

    /// Steps that each period of what swings takes, so that the tensions which answer to it are right to the tolerance of forces.
    fn per_period(&self) -> f64;

    /// What the user should know although the run goes on.
    fn warning(&self) -> Option<&str> {
        None
    }

    /// Weight of the stiffness beside the mass that filters the accelerations of a start with step `h` [s²].
    fn filter(&self, h: f64) -> f64;

    /// Fills the scheme's memory at a start with step `h`, from consistent positions and velocities and from
    /// accelerations filtered with `stiff`, whose factors `work` still holds.
    ///
    /// # Errors
    /// The accelerations can't be solved for.
    fn settle(
        &self,
        model: &Model,
        state: &mut State,
        work: &mut Workspace,
        h: f64,
        stiff: f64,
    ) -> Result<(), SolveError>;

    /// One step. On error the state is left as it was.
    ///
    /// It takes at most `h_max` [s], less where error control or convergence ask for it.
    fn step(
        &mut self,
        model: &Model,
        state: &mut State,
        work: &mut Workspace,
        h_max: f64,
    ) -> Result<StepReport, StepError>;
}

pub(super) fn linear(model: &Model, t: f64, source: SolveError) -> StepError {
    let unknown = match source {
        SolveError::Singular(p) => model
            .structure()
            .position
            .iter()
            .position(|&q| q == p)
            .map_or_else(|| "the mass matrix".to_string(), |i| model.unknown_name(i)),
        _ => "the solution".to_string(),
    };
    StepError::Linear { t, source, unknown }
}

/// The error of a step would have to be smaller than the smallest step makes it.
pub(super) fn too_strict(model: &Model, t: f64, steps: &StepController<'_>, work: &Workspace) -> StepError {
    let why = if steps.is_rounding() {
        "rounding leaves more of an error than the tolerance allows, however short the step"
    } else {
        "the tolerance asks for a smaller step than `h_min`"
    };
    StepError::NoConvergence { t, h: steps.h, why: why.into(), equation: work.worst_equation(model) }
}
