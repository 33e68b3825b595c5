//! A run in time: steps, outputs, events, the audit of energy.

mod ahead;
pub mod audit;
mod checkpoint;
mod dense;
mod difference;
mod events;
mod forces;
mod inputs;
pub mod layers;
mod led;
mod look;
mod memory;
pub mod record;
pub mod shock;
mod stepping;
mod tensions;
mod uneven;
mod watch;

pub use checkpoint::{Checkpoint, Unfit};

use crate::error::BuildError;
use crate::model::Model;
use crate::model::broken;
use crate::model::event::Event;
use crate::model::remesh::Remeshed;
use crate::model::state::State;
use crate::model::term::Power;
use crate::simulation::audit::Audit;
use crate::simulation::dense::Dense;
use crate::simulation::record::Sample;
use crate::solve::integrator::{
    Correction, Integrator, Limit, Options, StepError, StepReport, Stepping, Workspace, prepare,
};
use crate::solve::times::Phase;
use difference::Difference;
use events::at_start;
use inputs::Controlling;
use memory::Memory;
use std::ops::ControlFlow;
use std::sync::Arc;
use tensions::{Rung, Summed};
use uneven::Uneven;
use watch::Rounded;

/// Sees every accepted step and every sample, read-only: recorders, progress bars.
pub trait Observer {
    /// A step was accepted. To break ends the advance behind it, with its samples, its events and, if one is wanted, a
    /// checkpoint.
    fn step(&mut self, _model: &Model, _state: &State, _report: &StepReport) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
    /// Whether samples need consistent accelerations and multipliers, at the price of a factorisation each.
    fn needs_forces(&self) -> bool {
        false
    }
    /// Whether samples need the strains of the motion: between steps those of interpolated positions aren't. Who needs
    /// forces gets them too.
    fn needs_strains(&self) -> bool {
        false
    }
    /// Whether samples tell of the balance of energy: between steps that is drawn up anew.
    fn needs_energy(&self) -> bool {
        false
    }
    /// Whether it wants to look at the strains of the motion behind the sample at time `t` [s], whatever that showed: what
    /// is recorded is the same with and without a look.
    fn wants_look(&self, _t: f64) -> bool {
        false
    }
    /// The look that was wanted.
    fn look(&mut self, _sample: &Sample<'_>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
    /// Whether it wants samples at all.
    fn wants_samples(&self) -> bool {
        true
    }
    /// A sample at an instant of the output interval.
    fn sample(&mut self, _sample: &Sample<'_>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
    /// Something that the user should know at once although the run goes on.
    fn warn(&mut self, _text: &str) {}
    /// An event was located.
    fn event(&mut self, _name: &str, _t: f64) {}
    /// The mesh has changed.
    fn remeshed(&mut self, _report: &Remeshed) {}
    /// Whether a checkpoint is wanted after this step. Taking one drops kept factors, as going on from it does.
    fn wants_checkpoint(&mut self) -> bool {
        false
    }
    /// A checkpoint that was wanted.
    fn checkpoint(&mut self, _checkpoint: Checkpoint) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// An observer that looks away.
impl Observer for () {}

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// It reached its end.
    Done,
    /// An observer or an event stopped it.
    Stopped {
        /// Who stopped it.
        by: String,
    },
}

/// More samples than these are surely a mistake.
const MOST_SAMPLES: f64 = 1e10;

/// A result, or the function of the scene that failed meanwhile: then that is why.
fn told<T>(result: Result<T, StepError>) -> Result<T, StepError> {
    let broken = if result.is_ok() { broken::take_failed() } else { broken::take() };
    broken.map_or(result, |broken| Err(StepError::Function(broken)))
}

/// A model in motion.
///
/// Holds the model, its state, the integrator and its scratch. `advance` takes it to a time.
pub struct Simulation {
    /// The model.
    pub model: Arc<Model>,
    /// The state.
    pub state: State,
    /// Scratch and counters.
    pub work: Workspace,
    /// The integrator.
    pub integrator: Box<dyn Integrator>,
    /// What the start had to be corrected by.
    pub correction: Correction,
    /// The balance of energy.
    pub audit: Audit,
    /// How far the multipliers swung to and fro from step to step, in parts of their size: the largest so far. Only
    /// measured with a scheme that had to be allowed.
    pub ringing: f64,
    change: Vec<f64>,
    rung: Rung,
    summed: Summed,
    rounded: Rounded,
    uneven: Uneven,
    /// When energy was first seen to have appeared from nowhere [s].
    created: Option<f64>,
    keep_audit: bool,
    power: Power,
    /// The balance before the last step with the power then, and the balance as it is shown.
    accounted: (Audit, Power),
    shown: Audit,
    events: Vec<(Arc<dyn Event>, f64)>,
    previous: State,
    scratch: State,
    /// Scratch of samples that take more than a look; made when first needed.
    aside: Option<Box<Workspace>>,
    /// The step, counted, that it has a matrix of.
    aside_of: u64,
    /// What an interpolation in a step, counted, was off by at a time, and that time.
    mended: Option<(u64, f64, Difference)>,
    /// Time at which the present advance began, and the number of its next sample.
    sampled: (f64, u64),
    /// Over which time errors add up.
    memory: Memory,
    /// Whether an input has jumped since the last step.
    jumped: bool,
    /// What each controller remembers.
    controlling: Vec<Controlling>,
}

impl Simulation {
    /// Starts a model from where its scene puts it. `duration` is the length of the run [s].
    ///
    /// # Errors
    /// As [`Simulation::from`].
    pub fn new(model: Model, options: &Options, duration: f64) -> Result<Self, StepError> {
        let state = model.state();
        Self::from(model, state, options, duration)
    }

    /// Starts a model from a state, which is made consistent.
    ///
    /// # Errors
    /// The state is that of another model, the scheme is refused, the start is too far from the constraints, or a linear
    /// system can't be solved.
    pub fn from(model: Model, mut state: State, options: &Options, duration: f64) -> Result<Self, StepError> {
        model.check(&state).map_err(StepError::Foreign)?;
        inputs::check(&model)?;
        let integrator = options.integrator(&model, duration)?;
        let model = model.renewed(&state.at(), true).unwrap_or(model);
        let mut work = Workspace::new(&model).map_err(|source| StepError::Linear {
            t: state.t,
            source,
            unknown: "the structure of the equations".into(),
        })?;
        let _ = broken::take();
        let prepared = prepare(&model, &mut state, &mut work, integrator.as_ref());
        let correction = told(prepared)?;
        let audit = Audit::start(model.energy(&state.at()));
        let power = model.power(&state.at(), &state.lambda);
        let (previous, scratch) = (state.clone(), state.clone());
        let memory = Memory::new(state.t, integrator.horizon());
        let events =
            model.events().iter().map(|e| (e.clone(), at_start(e.as_ref(), &model, &state))).collect();
        let controlling = inputs::at_start(&model);
        Ok(Simulation {
            model: Arc::new(model),
            state,
            work,
            integrator,
            correction,
            audit,
            ringing: 0.0,
            change: Vec::new(),
            rung: Rung::default(),
            summed: Summed::default(),
            rounded: Rounded::default(),
            uneven: Uneven::default(),
            created: None,
            keep_audit: true,
            power,
            accounted: (audit, power),
            shown: audit,
            events,
            previous,
            scratch,
            aside: None,
            aside_of: 0,
            mended: None,
            sampled: (0.0, 0),
            memory,
            jumped: false,
            controlling,
        })
    }

    /// Switches the audit of energy, which costs an evaluation of all energies and powers per step.
    pub fn keep_audit(&mut self, on: bool) {
        self.keep_audit = on;
    }

    /// Adds an event.
    pub fn add_event(&mut self, event: impl Event + 'static) {
        let value = at_start(&event, &self.model, &self.state);
        self.events.push((Arc::new(event), value));
    }

    /// Goes on to time `end`, with a sample now and every `interval` seconds.
    ///
    /// # Errors
    /// A step that couldn't be taken; everything up to there has been sampled, and the state is the last good one. A state
    /// of another model, since anybody may set it. An interval that isn't above zero, or so short that the samples would
    /// never end.
    pub fn advance(
        &mut self,
        end: f64,
        interval: f64,
        observer: &mut dyn Observer,
    ) -> Result<End, StepError> {
        self.check_state()?;
        let _ = broken::take();
        self.sampled = (self.state.t, 0);
        if told(self.sample(observer, None))?.is_break() {
            return Ok(End::Stopped { by: "observer".into() });
        }
        self.sampled.1 = 1;
        self.set_out(end);
        told(self.move_on(end, interval, observer))
    }

    /// As [`Simulation::advance`], but goes on with an advance that a checkpoint was taken of: with the same `end` and
    /// `interval`.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn go_on(&mut self, end: f64, interval: f64, observer: &mut dyn Observer) -> Result<End, StepError> {
        self.check_state()?;
        told(self.move_on(end, interval, observer))
    }

    fn move_on(&mut self, end: f64, interval: f64, observer: &mut dyn Observer) -> Result<End, StepError> {
        self.check_times(end, interval)?;
        let start = self.sampled.0;
        self.depart(end);
        // times that differ by less than this are the same: no step of the size of rounding. To call them so mustn't move
        // what is driven
        let short = match self.integrator.options().stepping {
            Stepping::Fixed { h } => interval.min(end - start).min(1e5 * h),
            Stepping::Controlled { .. } => interval.min(end - start),
        };
        let same = |a: f64, b: f64| (a - b).abs() <= 1e-9 * short + 4.0 * f64::EPSILON * b.abs();
        while self.state.t < end && !same(self.state.t, end) {
            self.recouple(false)?;
            self.control(same)?;
            self.take_jumps()?;
            let target = end.min(self.next_control());
            let whole = target - self.state.t;
            let (left, bound) = match self.integrator.options().stepping {
                Stepping::Controlled { .. } => {
                    self.leap()?;
                    self.limit(whole)
                }
                // a step that differs by rounding would need factors of its own
                Stepping::Fixed { h } if (whole - h).abs() <= 8.0 * f64::EPSILON * target.abs() => {
                    (h, Limit::Instant)
                }
                Stepping::Fixed { .. } => (whole, Limit::Instant),
            };
            self.model.relabel(&mut self.state);
            self.previous.clone_from(&self.state);
            let report = self.integrator.step(&self.model, &mut self.state, &mut self.work, left);
            let mut report = report.map_err(|e| self.suspect(e))?;
            self.check_constraints()?;
            let now = self.state.at();
            let wrong = self.model.passes(&self.previous.at(), &now).or_else(|| self.model.lost(&now));
            let wrong = wrong.or_else(|| self.overran());
            if let Some(why) = wrong {
                self.turn_back(report.h, why)?;
                continue;
            }
            self.count_cut(report.h, left);
            if same(self.state.t, target) {
                self.state.t = target;
            }
            let fired = self.locate(observer);
            report.limit = match report.limit {
                _ if fired.is_some() => Limit::Event,
                Limit::Ahead => bound,
                other => other,
            };
            self.work.counts.limits[report.limit as usize] += 1;
            self.account();
            broken::take_failed().map_or(Ok(()), |b| Err(StepError::Function(b)))?;
            let energy = self.watch_energy(end, observer);
            self.watch_steps(end, observer);
            self.watch_ringing(&report, end, observer);
            self.watch_summed(&report, end, observer);
            self.watch_rounding(&report, end, observer);
            self.watch_ends(end, observer);
            self.measure_ringing();
            self.remember(&report);
            // whoever wants to stop gets what this step has brought first
            let stop = observer.step(&self.model, &self.state, &report).is_break();
            if self.sample_step(end, interval, same, observer)?.is_break() {
                return Ok(End::Stopped { by: "observer".into() });
            }
            energy?;
            if let Some(fired) = fired
                && let Some(end) = self.fire(fired, observer)?
            {
                return Ok(end);
            }
            if observer.wants_checkpoint() {
                let checkpoint = self.checkpoint()?;
                if observer.checkpoint(checkpoint).is_break() {
                    return Ok(End::Stopped { by: "observer".into() });
                }
            }
            if stop {
                return Ok(End::Stopped { by: "interrupt".into() });
            }
        }
        let last = start + interval * (self.sampled.1 - 1) as f64;
        if !same(last, end) && self.sample(observer, None)?.is_break() {
            return Ok(End::Stopped { by: "observer".into() });
        }
        Ok(End::Done)
    }

    /// Refuses times at which nothing or too much would be sampled, and those that are over.
    fn check_times(&self, end: f64, interval: f64) -> Result<(), BuildError> {
        let span = end - self.sampled.0;
        if !(interval > 0.0 && span / interval <= MOST_SAMPLES) {
            let message =
                format!("samples every {interval:e} s of {span:e} s never end: take a longer interval");
            return Err(BuildError::new(message));
        }
        if end < self.state.t {
            let message = format!(
                "a run goes on in time: it is at t = {} s and can't be advanced to {end} s. A state or a checkpoint from \
                 before leads back",
                self.state.t
            );
            return Err(BuildError::new(message));
        }
        Ok(())
    }

    fn account(&mut self) {
        if self.keep_audit {
            let begin = self.work.clocks.start();
            let (energy, power) = self.balance_at_end();
            let h = self.state.t - self.previous.t;
            self.accounted = (self.audit, self.power);
            let missed = self.missed([self.previous.t, self.state.t], [self.power, power], energy);
            let missed = missed.unwrap_or_else(|| self.model.missed(&self.previous.at(), &self.state.at()));
            self.audit.add_all(h, energy, self.power, power, missed);
            self.power = power;
            self.work.clocks.stop(Phase::Audit, begin);
        }
    }

    /// Measures by how much the last two changes of the multipliers undid each other.
    fn measure_ringing(&mut self) {
        if self.integrator.warning().is_none() {
            return;
        }
        self.change.resize(self.state.lambda.len(), 0.0);
        let (mut undone, mut size) = (0.0f64, 0.0f64);
        for ((c, new), old) in self.change.iter_mut().zip(&self.state.lambda).zip(&self.previous.lambda) {
            let change = new - old;
            if change * *c < 0.0 {
                undone = undone.max(change.abs().min(c.abs()));
            }
            size = size.max(new.abs());
            *c = change;
        }
        if size > 0.0 {
            self.ringing = self.ringing.max(0.5 * undone / size);
        }
    }

    /// Samples at the instants of the output that the last step has come to.
    fn sample_step(
        &mut self,
        end: f64,
        interval: f64,
        same: impl Fn(f64, f64) -> bool,
        observer: &mut dyn Observer,
    ) -> Result<ControlFlow<()>, StepError> {
        let (start, mut next) = self.sampled;
        while next as f64 * interval <= (end - start) * (1.0 + 1e-12) {
            let t = start + interval * next as f64;
            if t > self.state.t && !same(t, self.state.t) {
                break;
            }
            if self.sample(observer, Some(t))?.is_break() {
                return Ok(ControlFlow::Break(()));
            }
            next += 1;
        }
        self.sampled.1 = next;
        Ok(ControlFlow::Continue(()))
    }

    /// Samples at time `t` inside the last step, or at the present state.
    fn sample(&mut self, observer: &mut dyn Observer, t: Option<f64>) -> Result<ControlFlow<()>, StepError> {
        if !observer.wants_samples() {
            return Ok(ControlFlow::Continue(()));
        }
        match t {
            Some(t) if t < self.state.t => {
                Dense::new(&self.model, &self.previous, &self.state).at(t, &mut self.scratch);
            }
            _ => {
                self.scratch.clone_from(&self.state);
                self.scratch.t = t.unwrap_or(self.state.t);
            }
        }
        let (t, forces, strains) = (self.scratch.t, observer.needs_forces(), observer.needs_strains());
        let found = self.lead_with(forces);
        let found = found.and_then(|()| if strains && !forces { self.find_strains() } else { Ok(()) });
        let failed = |source| StepError::Linear { t, source, unknown: "the accelerations for output".into() };
        found.map_err(failed)?;
        self.show_balance(observer.needs_energy());
        let seen = observer.sample(&self.seen());
        if seen.is_break() || !observer.wants_look(t) {
            return Ok(seen);
        }
        if !forces && !strains {
            self.find_strains().map_err(failed)?;
        }
        Ok(observer.look(&self.seen()))
    }

    /// Draws up the balance of energy as it is shown: at a time inside the last step if that is `asked`.
    fn show_balance(&mut self, asked: bool) {
        self.shown = self.audit;
        let [begin, now, end] = [self.previous.t, self.scratch.t, self.state.t];
        if asked && self.keep_audit && begin < now && now < end {
            let (before, power) = self.accounted;
            let energy = self.model.energy(&self.scratch.at());
            let led = self.led_inside([begin, now], power, energy);
            let fading = self.model.missed(&self.previous.at(), &self.scratch.at());
            let (then, missed) = match led {
                Some((then, missed)) => (then, missed.unwrap_or(fading)),
                None if fading == Power::zero() => {
                    (Power::between(power, self.power, (now - begin) / (end - begin)), fading)
                }
                None => (self.model.power(&self.scratch.at(), &self.scratch.lambda), fading),
            };
            self.shown = before;
            self.shown.add_all(now - begin, energy, power, then, missed);
        }
    }

    /// The scratch state as it is shown to others.
    fn seen(&self) -> Sample<'_> {
        let (model, audit) = (&*self.model, &self.shown);
        Sample { model, at: self.scratch.at(), lambda: &self.scratch.lambda, audit }
    }
}
