//! Inputs that are set between steps, from outside or by the controllers of the scene.

use super::Simulation;
use crate::error::BuildError;
use crate::model::Model;
use crate::model::input::{Input, InputError};
use crate::model::term::Energy;
use crate::simulation::record::Sample;
use crate::solve::integrator::{Limit, StepError, restart};
use std::sync::Arc;

/// What a controller remembers.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Controlling {
    /// The number of its next instant.
    next: u64,
    memory: Vec<f64>,
}

impl Model {
    /// The number of the input of this name.
    ///
    /// # Errors
    /// There is none.
    pub fn input_number(&self, name: &str) -> Result<usize, InputError> {
        let inputs = self.inputs();
        inputs.iter().position(|i| i.name() == name).ok_or_else(|| {
            let known: Vec<String> = inputs.iter().map(|i| format!("`{}`", i.name())).collect();
            let known = if known.is_empty() { "none".into() } else { known.join(", ") };
            InputError::Unknown { name: name.into(), known }
        })
    }

    /// The numbers of inputs that are to be set from outside, with their values [SI].
    ///
    /// # Errors
    /// As [`Simulation::set_input`].
    pub fn inputs_to_set(&self, values: &[(&str, f64)]) -> Result<Vec<(usize, f64)>, InputError> {
        let one = |&(name, value): &(&str, f64)| {
            let k = self.input_number(name)?;
            self.inputs()[k].check(value)?;
            match self.controls().iter().find(|c| c.input() == k) {
                None => Ok((k, value)),
                Some(c) => Err(InputError::Controlled { name: name.into(), controller: c.name().into() }),
            }
        };
        values.iter().map(one).collect()
    }
}

impl Simulation {
    /// The inputs of the scene, in its order.
    pub fn inputs(&self) -> &[Arc<Input>] {
        self.model.inputs()
    }

    /// The value of an input at the present [SI].
    ///
    /// # Errors
    /// There is none of this name.
    pub fn input(&self, name: &str) -> Result<f64, InputError> {
        Ok(self.model.inputs()[self.model.input_number(name)?].value(self.state.t))
    }

    /// Sets an input from here on, in SI units: one that holds jumps now, one that is joined by lines reaches the value at
    /// the end of the next advance. Nothing else changes until then.
    ///
    /// ```no_run
    /// # fn winch(simulation: &mut ropewalk_core::Simulation) -> Result<(), Box<dyn std::error::Error>> {
    /// while simulation.state.t < 10.0 {
    ///     simulation.set_input("winch", 0.5 * simulation.state.t.sin())?;
    ///     let end = simulation.state.t + 0.1;
    ///     simulation.advance(end, 0.1, &mut ())?;
    /// }
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// There is no such input, the value is outside of its limits or no number, or a controller of the scene sets it: then
    /// nothing is changed.
    pub fn set_input(&mut self, name: &str, value: f64) -> Result<(), InputError> {
        self.set_inputs(&[(name, value)])
    }

    /// Sets several inputs, or none of them if one is refused.
    ///
    /// # Errors
    /// As [`Simulation::set_input`].
    pub fn set_inputs(&mut self, values: &[(&str, f64)]) -> Result<(), InputError> {
        let numbers = self.model.inputs_to_set(values)?;
        self.put(&numbers);
        Ok(())
    }

    /// Sets inputs by their numbers. What a jump changes of potential energies is work done from outside.
    fn put(&mut self, values: &[(usize, f64)]) {
        let sum = |e: Energy| e.kinetic + e.potential;
        let before = self.keep_audit.then(|| sum(self.model.energy(&self.state.at())));
        let mut jumped = false;
        for &(k, value) in values {
            jumped |= self.model.inputs()[k].set(self.state.t, value);
        }
        if !jumped {
            return;
        }
        self.jumped = true;
        if let Some(before) = before {
            let energy = self.model.energy(&self.state.at());
            self.audit.supplied += sum(energy) - before;
            (self.audit.kinetic, self.audit.potential) = (energy.kinetic, energy.potential);
        }
    }

    /// Lets inputs that are joined by lines set out for where they are to be at time `end`.
    pub(super) fn depart(&mut self, end: f64) {
        for input in self.model.inputs() {
            input.depart(self.state.t, end);
        }
    }

    /// Starts anew where an input has jumped: history doesn't reach across it.
    pub(super) fn take_jumps(&mut self) -> Result<(), StepError> {
        if !std::mem::take(&mut self.jumped) {
            return Ok(());
        }
        let h = self.state.control.h_last;
        let internal = self.state.internal.clone();
        restart(&self.model, &mut self.state, &mut self.work, self.integrator.as_ref())?;
        self.state.internal = internal;
        (self.state.control.h_next, self.state.control.limit) = (0.1 * h, Limit::Event);
        self.resume(usize::MAX, false);
        Ok(())
    }

    /// The next instant of a controller; infinite without.
    pub(super) fn next_control(&self) -> f64 {
        let next =
            self.model.controls().iter().zip(&self.controlling).map(|(c, own)| own.next as f64 * c.every());
        next.fold(f64::INFINITY, f64::min)
    }

    /// Makes controllers wait for their next instant from here on.
    pub(super) fn restart_controllers(&mut self) {
        let t = self.state.t;
        for (c, own) in self.model.controls().iter().zip(&mut self.controlling) {
            own.next = (t / c.every() * (1.0 - 1e-12)).ceil().max(0.0) as u64;
        }
    }

    /// Lets controllers act whose instants have come; `same` says which times are the same.
    ///
    /// # Errors
    /// A controller wants what is no number, or what it looks at can't be solved for.
    pub(super) fn control(&mut self, same: impl Fn(f64, f64) -> bool) -> Result<(), StepError> {
        let t = self.state.t;
        if !(self.next_control() <= t || same(self.next_control(), t)) {
            return Ok(());
        }
        let model = self.model.clone();
        let due = |k: usize, own: &Controlling| {
            let at = own.next as f64 * model.controls()[k].every();
            at <= t || same(at, t)
        };
        let due: Vec<usize> = (0..self.controlling.len()).filter(|&k| due(k, &self.controlling[k])).collect();
        self.scratch.clone_from(&self.state);
        if due.iter().any(|&k| model.controls()[k].needs_forces()) {
            let unknown = "the accelerations for a controller".to_string();
            self.find_forces().map_err(|source| StepError::Linear { t, source, unknown })?;
        }
        let mut wanted = Vec::with_capacity(due.len());
        for k in due {
            let (control, own) = (&model.controls()[k], &mut self.controlling[k]);
            let sample = Sample {
                model: &model,
                at: self.scratch.at(),
                lambda: &self.scratch.lambda,
                audit: &self.audit,
            };
            let value = control.act(&sample, &mut own.memory);
            let input = &model.inputs()[control.input()];
            if value.is_nan() {
                let (controller, input) = (control.name().into(), input.name().into());
                return Err(StepError::Control { t, controller, input });
            }
            // a run that was late, since its state was set from outside, doesn't catch up
            own.next = own.next.max((t / control.every() * (1.0 + 1e-12)).floor() as u64) + 1;
            let [least, most] = input.limits();
            wanted.push((control.input(), value.clamp(least, most), own.next as f64 * control.every()));
        }
        let values: Vec<(usize, f64)> = wanted.iter().map(|&(k, value, _)| (k, value)).collect();
        self.put(&values);
        self.work.inertia.outdate();
        for (k, _, until) in wanted {
            model.inputs()[k].depart(t, until);
        }
        Ok(())
    }
}

/// Whether the controllers of a model act at instants that pass, on inputs that there are.
pub(super) fn check(model: &Model) -> Result<(), StepError> {
    let fits = |every: f64, input: usize| every > 0.0 && every.is_finite() && input < model.inputs().len();
    match model.controls().iter().find(|c| !fits(c.every(), c.input())) {
        None => Ok(()),
        Some(c) => Err(BuildError::new(format!(
            "the controller `{}` acts every {} s on input number {}, of {}: there is no such interval or input",
            c.name(),
            c.every(),
            c.input(),
            model.inputs().len()
        )).into()),
    }
}

/// What the controllers of a model remember at the start.
pub(super) fn at_start(model: &Model) -> Vec<Controlling> {
    model.controls().iter().map(|c| Controlling { next: 0, memory: vec![0.0; c.memory()] }).collect()
}
