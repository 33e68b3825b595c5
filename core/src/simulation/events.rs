//! Events inside a step: when they come, in which order, and what they change.

use super::{Dense, End, Observer, Simulation};
use crate::model::Model;
use crate::model::event::{Action, Depends, Event};
use crate::model::line::Quantity;
use crate::model::remesh::Remeshed;
use crate::model::state::State;
use crate::model::term::Energy;
use crate::solve::integrator::{Limit, StepError, restart};
use std::sync::Arc;

/// From which value on a load is searched for at the end of a step, of strains and of forces: the former are off by what
/// velocities are, the latter by what multipliers swing. What is missed there comes up in the next step.
const NEAR: [f64; 2] = [-0.1, -0.5];
/// By how much an allowed load may be exceeded when it is found to be reached.
const OVER: f64 = 1e-6;

/// An event that has changed something.
pub(super) struct Fired {
    event: usize,
    action: Action,
    /// The state as it left it.
    after: State,
    /// Whether it changed an internal variable.
    changed: bool,
}

/// The value of an event at the start. What has come to pass already happens at once.
pub(super) fn at_start(event: &dyn Event, model: &Model, state: &State) -> f64 {
    let value = event.value(model, state);
    match event.direction() {
        1 if value >= 0.0 => -f64::MIN_POSITIVE,
        -1 if value <= 0.0 => f64::MIN_POSITIVE,
        _ => value,
    }
}

impl Simulation {
    /// The first event inside the last step after a time, and the state in which it comes; what all of them are at the end
    /// of the step goes into `ends`.
    fn next_event(&mut self, from: f64, ends: &mut Vec<f64>) -> Option<(usize, State)> {
        let mut first: Option<(usize, State)> = None;
        ends.clear();
        for k in 0..self.events.len() {
            let (event, before) = (self.events[k].0.clone(), self.events[k].1);
            let after = self.value_at_end(event.as_ref());
            ends.push(after);
            let crossed = match event.direction() {
                1 => before < 0.0 && after >= 0.0,
                -1 => before > 0.0 && after <= 0.0,
                _ => before * after < 0.0 || (after == 0.0 && before != 0.0),
            };
            if !crossed {
                continue;
            }
            let there = self.crossing(event.as_ref(), [from, self.state.t], [before, after]);
            if first.as_ref().is_none_or(|(_, first)| there.t < first.t) {
                first = Some((k, there));
            }
        }
        first
    }

    /// The value of an event at the end of the last step.
    fn value_at_end(&mut self, event: &dyn Event) -> f64 {
        let value = event.value(&self.model, &self.state);
        let depends = event.depends();
        let near = match depends {
            Depends::OnMotion => return value,
            Depends::OnStrains => NEAR[0],
            Depends::OnForces => NEAR[1],
        };
        if value < near {
            return value;
        }
        self.look_inside(self.state.t, depends);
        event.value(&self.model, &self.scratch)
    }

    /// The state in which an event's function has just changed its sign, between two times with these values: found by
    /// halves, or, where every look costs a search, by false position with the Illinois rule.
    fn crossing(
        &mut self,
        event: &dyn Event,
        [mut low, mut high]: [f64; 2],
        [before, after]: [f64; 2],
    ) -> State {
        let depends = event.depends();
        let searches = depends != Depends::OnMotion;
        let (fine, over) = if searches { (1e-9, OVER) } else { (1e-12, 0.0) };
        let tolerance = 4.0 * f64::EPSILON * high.abs() + fine * (high - low);
        let (mut below, mut above, mut last) = (before, after, None);
        let mut found: Option<State> = None;
        while high - low > tolerance {
            // a load is aimed at that is just enough
            let share = (below - 0.5 * over.copysign(after)) / (below - above);
            let share = if searches { share.clamp(1e-3, 0.999) } else { 0.5 };
            let mid = low + share * (high - low);
            if mid <= low || mid >= high {
                break;
            }
            self.look_inside(mid, depends);
            let value = event.value(&self.model, &self.scratch);
            let early = (value > 0.0) == (before > 0.0) && value != 0.0;
            if early {
                (low, below) = (mid, value);
            } else {
                (high, above) = (mid, value);
                found = searches.then(|| self.scratch.clone());
                if value.abs() <= over {
                    break;
                }
            }
            if last == Some(early) {
                *(if early { &mut above } else { &mut below }) *= 0.5;
            }
            last = Some(early);
        }
        found.unwrap_or_else(|| {
            self.look_inside(high, depends);
            self.scratch.clone()
        })
    }

    /// Sets the scratch state to a time inside the last step or at its end, with what is asked for of the motion there.
    fn look_inside(&mut self, t: f64, asked: Depends) {
        Dense::new(&self.model, &self.previous, &self.state).at(t, &mut self.scratch);
        let found = match asked {
            Depends::OnMotion => Ok(()),
            Depends::OnStrains => self.find_strains_with_rates(),
            Depends::OnForces => self.find_forces(),
        };
        // where none are found, the interpolated ones have to do
        if found.is_err() {
            Dense::new(&self.model, &self.previous, &self.state).at(t, &mut self.scratch);
        }
    }

    /// Lets the events inside the last step act, one after the other, up to the first that changes something: the state
    /// moves to just before it.
    pub(super) fn locate(&mut self, observer: &mut dyn Observer) -> Option<Fired> {
        let (mut from, mut ends) = (self.previous.t, Vec::new());
        while let Some((event, there)) = self.next_event(from, &mut ends) {
            let t = there.t;
            self.scratch = there;
            self.scratch.control.clone_from(&self.state.control);
            self.model.remember(&mut self.scratch);
            for (k, (other, value)) in self.events.iter_mut().enumerate() {
                let (before, now) = (*value, other.value(&self.model, &self.scratch));
                // what came at the same instant is still due
                let due = k != event && now * before < 0.0;
                *value = if due { before.signum() * f64::MIN_POSITIVE } else { now };
            }
            let mut after = self.scratch.clone();
            let action = self.events[event].0.act(&self.model, &mut after);
            let changed = after.internal != self.scratch.internal;
            if !changed && matches!(action, Action::Continue) {
                let report = self.events[event].0.report(&self.model, &self.scratch);
                observer.event(&report, t);
                from = t;
                continue;
            }
            std::mem::swap(&mut self.state, &mut self.scratch);
            // a shorter step has another interpolation
            self.mended = None;
            return Some(Fired { event, action, after, changed });
        }
        self.model.remember(&mut self.state);
        for ((event, value), end) in self.events.iter_mut().zip(&ends) {
            // what is searched for isn't searched for twice
            *value = match event.depends() {
                Depends::OnMotion => event.value(&self.model, &self.state),
                Depends::OnStrains | Depends::OnForces => *end,
            };
        }
        None
    }

    pub(super) fn fire(
        &mut self,
        fired: Fired,
        observer: &mut dyn Observer,
    ) -> Result<Option<End>, StepError> {
        let Fired { event: k, action, after, changed } = fired;
        observer.event(&self.events[k].0.name(), self.state.t);
        let h = self.state.control.h_last;
        let switches = matches!(action, Action::Switch);
        let event = self.events[k].0.clone();
        let before = switches.then(|| self.measure(event.as_ref()));
        self.state = after;
        match action {
            Action::Continue => {
                // the step has become shorter, and what was predicted from it doesn't fit any more
                let control = &mut self.state.control;
                control.h_last = self.state.t - self.previous.t;
                (control.backs, control.order) = (0, 0);
                control.stages[0].clear();
                let short = if h > 0.0 { control.h_last / h } else { 1.0 };
                for (aux, a) in self.state.aux.iter_mut().zip(&self.state.a) {
                    *aux = a + short * (*aux - a);
                }
                self.resume(k, changed);
                return Ok(None);
            }
            Action::Stop => {
                // the moment that ends the run is worth a sample
                let _ = self.sample(observer, None)?;
                return Ok(Some(End::Stopped { by: self.events[k].0.name() }));
            }
            Action::Fail(why) => {
                return Err(StepError::Event { t: self.state.t, event: self.events[k].0.name(), why });
            }
            Action::Restart | Action::Switch => {}
            Action::Remesh(model) => {
                let before = self.measure(event.as_ref());
                self.state = model.carry(&self.model, &self.state);
                self.aside = None;
                self.work.change_mesh(&self.model, &model).map_err(|source| StepError::Linear {
                    t: self.state.t,
                    source,
                    unknown: "the structure of the new mesh".into(),
                })?;
                // events of the scene belong to its model; those that were added stay
                let own = self.model.events().len();
                let new = model.events().iter().map(|e| (e.clone(), 0.0)).collect::<Vec<_>>();
                self.events.splice(..own, new);
                self.model = Arc::from(model);
                self.report(event.as_ref(), before, observer);
            }
        }
        // history doesn't reach across an event
        let now = self.state.internal.clone();
        restart(&self.model, &mut self.state, &mut self.work, self.integrator.as_ref())?;
        self.state.internal = now;
        if let Some(before) = before {
            self.report(event.as_ref(), before, observer);
        }
        (self.state.control.h_next, self.state.control.limit) = (0.1 * h, Limit::Event);
        self.resume(k, changed);
        Ok(None)
    }

    /// Energy, momentum, and the tension where an event changes the mesh.
    fn measure(&mut self, event: &dyn Event) -> (Energy, [f64; 3], f64) {
        let (model, at) = (&self.model, self.state.at());
        let tension = event.remeshes().and_then(|(name, end)| {
            let part = model.part(name)?;
            part.observe(Quantity::Tension, if end == 0 { 0.0 } else { part.length_now(&at) }, &at)
        });
        (model.energy(&at), self.work.momentum(model, &self.state), tension.unwrap_or(f64::NAN))
    }

    fn report(&mut self, event: &dyn Event, before: (Energy, [f64; 3], f64), observer: &mut dyn Observer) {
        let after = self.measure(event);
        let report = Remeshed {
            name: event.name(),
            t: self.state.t,
            kinetic: after.0.kinetic - before.0.kinetic,
            potential: after.0.potential - before.0.potential,
            momentum: std::array::from_fn(|i| after.1[i] - before.1[i]),
            tension: [before.2, after.2],
        };
        self.audit.remeshed += report.kinetic + report.potential;
        observer.remeshed(&report);
    }

    /// Goes on from a state that event `k` has seen; `changed` says that it has changed an internal variable.
    pub(super) fn resume(&mut self, k: usize, changed: bool) {
        self.previous.clone_from(&self.state);
        self.scratch.clone_from(&self.state);
        self.power = self.model.power(&self.state.at(), &self.state.lambda);
        for (j, (event, value)) in self.events.iter_mut().enumerate() {
            let (before, now) = (*value, event.value(&self.model, &self.state));
            *value = match (j == k, changed) {
                // the next of many that one event stands for may be due at once
                (true, true) => at_start(event.as_ref(), &self.model, &self.state),
                // meeting the constraints again may have moved the state back by a hair: it mustn't pass twice
                (true, false) if now * before < 0.0 => before,
                // what this has set off happens in the next step
                (false, _) if now * before < 0.0 => before.signum() * f64::MIN_POSITIVE,
                _ => now,
            };
        }
    }
}
