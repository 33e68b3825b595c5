//! A process whose inputs are set while it goes on: by the controllers of its scene, or from outside.

use super::{Channel, Process};
use ropewalk_core::integrator::{Counts, StepError};
use ropewalk_core::{
    At, Audit, Column, Controller, Energy, Input, InputError, Model, Record, Sample, Solid, Start, V3,
};
use std::sync::{Arc, PoisonError, RwLock};

/// Instants that are nearer to each other than this part of a controller's interval are the same.
const SAME: f64 = 1e-9;

/// A process with inputs. Between two instants of its controllers it goes on by itself.
pub(crate) struct Steered {
    process: Box<dyn Process>,
    /// Nothing that moves: the inputs, and what sets them.
    model: Model,
    /// What controllers see of the process.
    seen: Arc<RwLock<Vec<f64>>>,
    /// Of each controller the number of its next instant, and what it remembers.
    controlling: Vec<(u64, Vec<f64>)>,
}

/// The columns of a process as a record, which shows the last row that was taken.
struct Shown {
    name: String,
    columns: Vec<Column>,
    row: Arc<RwLock<Vec<f64>>>,
}

impl Record for Shown {
    fn title(&self) -> String {
        self.name.clone()
    }
    fn name(&self) -> String {
        self.name.clone()
    }
    fn columns(&self) -> Vec<Column> {
        self.columns.clone()
    }
    fn sample(&self, _: &Sample<'_>, out: &mut Vec<f64>) {
        out.extend_from_slice(&self.row.read().unwrap_or_else(PoisonError::into_inner));
    }
}

impl Steered {
    /// A process of this name, whose channels `controls` may look at in a model that has the inputs and nothing else.
    ///
    /// # Errors
    /// What `controls` says.
    pub fn new<E>(
        process: Box<dyn Process>,
        (name, channels): (&str, Vec<Channel>),
        inputs: Vec<Arc<Input>>,
        controls: impl FnOnce(&Model, Vec<Box<dyn Record>>) -> Result<Vec<Arc<dyn Controller>>, E>,
    ) -> Result<Self, E> {
        let none = Model::new(Vec::new(), Vec::new(), Vec::new(), Vec::new(), Start::default(), 1.0);
        let (model, seen) = (none.with_inputs(inputs), Arc::default());
        let columns = channels.into_iter().flat_map(|c| c.columns).collect();
        let shown = Shown { name: name.into(), columns, row: Arc::clone(&seen) };
        let controls = controls(&model, vec![Box::new(shown)])?;
        let controlling = controls.iter().map(|c| (0, vec![0.0; c.memory()])).collect();
        Ok(Steered { process, model: model.with_controls(controls), seen, controlling })
    }

    /// Lets controllers act whose instants have come at time `t` [s]; when the next one does, infinite without.
    fn control(&mut self, t: f64) -> Result<f64, String> {
        let due = |c: &dyn Controller, next: u64| next as f64 * c.every() <= t + SAME * c.every();
        let controls = self.model.controls();
        if controls.iter().zip(&self.controlling).any(|(c, (next, _))| due(c.as_ref(), *next)) {
            let mut row = Vec::new();
            self.process.sample(&mut row);
            *self.seen.write().unwrap_or_else(PoisonError::into_inner) = row;
        }
        let audit = Audit::start(Energy::default());
        let at = At { t, q: &[], v: &[], a: &[], internal: &[], relaxed: None };
        for (c, (next, memory)) in controls.iter().zip(&mut self.controlling) {
            if !due(c.as_ref(), *next) {
                continue;
            }
            let input = &self.model.inputs()[c.input()];
            let value = c.act(&Sample { model: &self.model, at, lambda: &[], audit: &audit }, memory);
            if value.is_nan() {
                let (controller, input) = (c.name().into(), input.name().into());
                return Err(StepError::Control { t, controller, input }.to_string());
            }
            *next = (*next).max((t / c.every() * (1.0 + 1e-12)).floor() as u64) + 1;
            let [least, most] = input.limits();
            input.set(t, value.clamp(least, most));
            input.depart(t, *next as f64 * c.every());
        }
        let instants = controls.iter().zip(&self.controlling).map(|(c, (next, _))| *next as f64 * c.every());
        Ok(instants.fold(f64::INFINITY, f64::min))
    }
}

impl Process for Steered {
    fn t(&self) -> f64 {
        self.process.t()
    }
    fn advance(&mut self, t: f64) -> Result<Option<String>, String> {
        self.depart(t);
        let mut now = self.process.t();
        loop {
            let next = self.control(now)?;
            now = t.min(next);
            if let Some(by) = self.process.advance(now)? {
                return Ok(Some(by));
            }
            if t <= next {
                return Ok(None);
            }
        }
    }
    fn sample(&self, row: &mut Vec<f64>) {
        self.process.sample(row);
    }
    fn line(&self) -> Vec<V3<f64>> {
        self.process.line()
    }
    fn tensions(&self) -> Vec<f64> {
        self.process.tensions()
    }
    fn curvatures(&self) -> Vec<f64> {
        self.process.curvatures()
    }
    fn solids(&self) -> Vec<Solid> {
        self.process.solids()
    }
    fn counts(&self) -> Counts {
        self.process.counts()
    }
    fn warnings(&self) -> Vec<String> {
        self.process.warnings()
    }
    fn inputs(&self) -> &[Arc<Input>] {
        self.model.inputs()
    }
    fn depart(&mut self, end: f64) {
        for input in self.model.inputs() {
            input.depart(self.process.t(), end);
        }
    }
    fn set_input(&mut self, name: &str, value: f64) -> Result<(), InputError> {
        for (k, value) in self.model.inputs_to_set(&[(name, value)])? {
            self.model.inputs()[k].set(self.process.t(), value);
        }
        Ok(())
    }
}
