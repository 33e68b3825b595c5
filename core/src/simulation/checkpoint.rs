//! Checkpoints: all that a simulation needs to go on as if nothing had happened.

use super::Simulation;
use super::inputs::Controlling;
use super::memory::Memory;
use super::tensions::{Rung, Summed};
use super::uneven::Uneven;
use super::watch::Rounded;
use crate::model::Model;
use crate::model::input::Course;
use crate::model::remesh::Plan;
use crate::model::state::State;
use crate::model::term::Power;
use crate::simulation::audit::Audit;
use crate::solve::integrator::{Correction, Counts, Options, StepError, Workspace};
use crate::solve::linear::SolveError;
use std::sync::Arc;

/// A simulation between two steps, as plain data.
///
/// What can be computed again from it isn't in it: factors, scratch, powers. A simulation that a checkpoint was taken of
/// has dropped the same, so both go on to the last bit alike, with the same program on the same machine. To be read
/// back exactly it has to be written in a format that keeps every bit of a number.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Checkpoint {
    /// Time, configuration, velocities, multipliers, internal variables and the memory of the integrator.
    pub state: State,
    /// The balance of energy.
    pub audit: Audit,
    /// What the run did so far.
    pub counts: Counts,
    /// What the start had to be corrected by.
    pub correction: Correction,
    /// Meshes that have changed, from which the model is built again.
    pub meshes: Plan,
    /// Names of the constraints and numbers of unknowns of the model, by which another one is told.
    model: Vec<(String, usize)>,
    /// Values of the events.
    events: Vec<f64>,
    ringing: f64,
    change: Vec<f64>,
    created: Option<f64>,
    #[cfg_attr(feature = "serde", serde(default))]
    rung: Rung,
    #[cfg_attr(feature = "serde", serde(default))]
    summed: Summed,
    #[cfg_attr(feature = "serde", serde(default))]
    rounded: Rounded,
    #[cfg_attr(feature = "serde", serde(default))]
    uneven: Uneven,
    keep_audit: bool,
    /// The powers that the balance goes on with.
    power: Power,
    /// Whether constraints had to be solved as if some were redundant.
    softened: bool,
    sampled: (f64, u64),
    memory: Memory,
    inputs: Vec<Course>,
    jumped: bool,
    controlling: Vec<Controlling>,
}

/// Why a checkpoint can't be gone on from with a model.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Unfit {
    /// The model is another one.
    #[error("the checkpoint belongs to another model: {0}")]
    Other(String),
    /// The solver refuses the model.
    #[error("{0}")]
    Step(#[from] StepError),
}

/// What tells models apart.
fn traits(model: &Model) -> Vec<(String, usize)> {
    let mut all = vec![
        ("coordinates".into(), model.start.q.len()),
        ("velocities".into(), model.velocities()),
        ("internal variables".into(), model.internal_variables().len()),
    ];
    all.extend(model.terms().iter().map(|t| (t.label(), 1)));
    all.extend(model.constraints().iter().map(|c| (c.name().to_string(), c.rows().len())));
    all.extend(model.inputs().iter().map(|i| (i.name().to_string(), 1)));
    all.extend(model.controls().iter().map(|c| (c.name().to_string(), c.memory())));
    all
}

pub(super) fn no_memory(t: f64, source: SolveError) -> StepError {
    StepError::Linear { t, source, unknown: "the structure of the equations".into() }
}

impl Simulation {
    /// Takes a checkpoint, and drops factors and scratch so that going on here and going on from the checkpoint is the
    /// same. Of an advance it has to be taken between two steps, as [`Observer`](super::Observer) is asked.
    ///
    /// # Errors
    /// Not enough memory for new scratch.
    pub fn checkpoint(&mut self) -> Result<Checkpoint, StepError> {
        self.recouple(true)?;
        self.work.renew(&self.model).map_err(|e| no_memory(self.state.t, e))?;
        (self.aside, self.mended) = (None, None);
        Ok(Checkpoint {
            state: self.state.clone(),
            audit: self.audit,
            counts: self.work.counts,
            correction: self.correction,
            meshes: self.model.plan.clone(),
            model: traits(&self.model),
            events: self.events.iter().map(|e| e.1).collect(),
            ringing: self.ringing,
            change: self.change.clone(),
            created: self.created,
            rung: self.rung,
            summed: self.summed.clone(),
            rounded: self.rounded,
            uneven: self.uneven.clone(),
            keep_audit: self.keep_audit,
            power: self.power,
            softened: self.work.softening.is_some(),
            sampled: self.sampled,
            memory: self.memory.clone(),
            inputs: self.model.inputs().iter().map(|i| i.course()).collect(),
            jumped: self.jumped,
            controlling: self.controlling.clone(),
        })
    }

    /// A simulation as it was when the checkpoint was taken, to [`go_on`](Simulation::go_on) with. The model, the options
    /// and the duration have to be those of that run; events of its own are added after this and start anew.
    ///
    /// # Errors
    /// The model is another one, or the integrator refuses it.
    pub fn restore(
        model: Model,
        options: &Options,
        duration: f64,
        checkpoint: Checkpoint,
    ) -> Result<Self, Unfit> {
        let c = checkpoint;
        let mine = traits(&model);
        if let Some((a, b)) = mine.iter().zip(&c.model).find(|(a, b)| a != b) {
            return Err(Unfit::Other(format!("`{}` ({}) instead of `{}` ({})", a.0, a.1, b.0, b.1)));
        }
        if mine.len() != c.model.len() || c.events.len() != model.events().len() {
            return Err(Unfit::Other("it has other terms, constraints or events".into()));
        }
        model.check(&c.state).map_err(Unfit::Other)?;
        for (input, course) in model.inputs().iter().zip(c.inputs) {
            input.follow(course);
        }
        let mut integrator = options.integrator(&model, duration)?;
        integrator.set_horizon(c.memory.horizon());
        let model = model.renewed(&c.state.at(), true).unwrap_or(model);
        let mut work = Workspace::new(&model).map_err(|e| no_memory(c.state.t, e))?;
        if c.softened && work.softening.is_none() {
            work.soften(&model);
        }
        work.counts = c.counts;
        let events = model.events().iter().cloned().zip(c.events).collect();
        let (previous, scratch) = (c.state.clone(), c.state.clone());
        Ok(Simulation {
            model: Arc::new(model),
            state: c.state,
            work,
            integrator,
            correction: c.correction,
            audit: c.audit,
            ringing: c.ringing,
            change: c.change,
            created: c.created,
            rung: c.rung,
            summed: c.summed,
            rounded: c.rounded,
            uneven: c.uneven.clone(),
            keep_audit: c.keep_audit,
            power: c.power,
            accounted: (c.audit, c.power),
            shown: c.audit,
            events,
            previous,
            scratch,
            aside: None,
            aside_of: 0,
            mended: None,
            sampled: c.sampled,
            memory: c.memory,
            jumped: c.jumped,
            controlling: c.controlling,
        })
    }
}
