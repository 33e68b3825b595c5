//! What is watched while a run goes on: constraints that contradict each other, energy from nowhere, steps that are cut.

use super::{Observer, Simulation};
use crate::simulation::audit::Created;
use crate::solve::integrator::{Limit, Scheme, StepError, StepReport, Stepping};
use crate::solve::redundancy::stuck;

/// What may be left of constraints after a step, in parts of the model's length: ten times what Newton's method leaves.
const LEFT: f64 = 1e-9;
/// What a constraint that takes part in a contradiction is violated by, in parts of the most violated one.
const PART: f64 = 1e-3;
/// A step shorter than this, in parts of what it should be, was cut.
const CUT: f64 = 1.0 - 1e-6;
/// A step that still goes through something at this part of the longest one goes through it however short it is.
const SHORT: f64 = 1e-7;
/// What may come back against friction in a step, in parts of what positions may be off by: it goes on as fast as it came.
const BACK: f64 = 0.1;
/// Steps after which a run has begun, and part of its time.
const BEGUN: u64 = 50;
const BEGUN_TIME: f64 = 0.05;
/// So many steps are worth a word.
const MANY: u64 = 100_000;
/// What has moved by no more than this since the run began, in parts of its own length, has no energy to speak of.
const REST: f64 = 1e-7;

/// What rounding has done to velocities.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Rounded {
    /// The sum of `1/h²` over all steps [1/s²].
    square: f64,
    /// Their time [s].
    time: f64,
}

impl Simulation {
    /// Where constraints are solved as redundant they are met as well as they can be: checks that this is well enough.
    /// If not, the state is that before the step.
    pub(super) fn check_constraints(&mut self) -> Result<(), StepError> {
        if self.work.softening.is_none() {
            return Ok(());
        }
        let model = &self.model;
        let mut g = vec![0.0; model.multipliers()];
        model.violations(&self.state.at(), &mut self.work.system, &mut g);
        g.iter_mut().zip(model.row_scale()).for_each(|(g, s)| *g = g.abs() / s);
        // a NaN counts as the worst of all
        let worst = g.iter().fold(0.0, |worst, &g| if g <= worst { worst } else { g });
        if worst <= (LEFT * model.length()).max(100.0 * model.rounding()) {
            return Ok(());
        }
        let mut names = model.constraints_where(|r| !(g[r] <= PART * worst));
        if let ([one], Some(r)) = (names.as_slice(), model.redundancy()) {
            let one = *one;
            names.extend(r.constraints.iter().map(String::as_str).filter(|n| *n != one));
        }
        let mut constraints = names.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ");
        if let Some(driver) = self.driver_of(&names) {
            constraints += &format!(", to where `{driver}` drives them,");
        }
        let error = StepError::Contradiction { t: self.state.t, constraints, off: worst };
        self.state.clone_from(&self.previous);
        Err(error)
    }

    /// What drives the same parts as these constraints hold, if none of them does.
    fn driver_of(&self, names: &[&str]) -> Option<&str> {
        let all = || self.model.constraints().iter();
        let named = || all().filter(|c| names.contains(&c.name()));
        if named().any(|c| c.moves()) {
            return None;
        }
        let held: Vec<_> = named().flat_map(|c| c.nodes()).collect();
        let driver = all().find(|c| c.moves() && c.nodes().iter().any(|node| held.contains(&node)))?;
        Some(driver.name())
    }

    /// Goes back to the state before a step `h` in which something went where it can't, to repeat it half as long.
    pub(super) fn turn_back(&mut self, h: f64, why: String) -> Result<(), StepError> {
        let t = self.state.t;
        let next = self.state.control.h_next;
        self.state.clone_from(&self.previous);
        let half = 0.5 * h;
        if half < self.integrator.limits().least.max(SHORT * self.integrator.limits().most) {
            return Err(StepError::Passed { t, why });
        }
        self.work.counts.rejected += 1;
        let control = &mut self.state.control;
        control.h_cap = half;
        control.h_next = if next > 0.0 { half.min(next) } else { 0.0 };
        control.limit = Limit::Ahead;
        Ok(())
    }

    /// What slid and turned round within the last step, and came back by so much that what it has gained on the way tells in
    /// positions: its friction knew nothing of that.
    pub(super) fn overran(&self) -> Option<String> {
        let Stepping::Controlled { tolerance, .. } = self.integrator.options().stepping else { return None };
        let norms = &self.work.norms;
        let far = |v: usize, way: f64| !(way <= BACK * tolerance * norms.length_of(v));
        self.model.overran(&self.previous.at(), &self.state.at(), &far)
    }

    /// Names the constraints that may be to blame for a step that failed, since they contradict each other there, or leave no way on.
    pub(super) fn suspect(&self, error: StepError) -> StepError {
        let redundancy = self.model.redundancy();
        let stuck = redundancy.map_or_else(|| stuck(&self.model, &self.state.at()), |_| Vec::new());
        let names: Vec<&str> =
            redundancy.map_or(stuck, |r| r.constraints.iter().map(String::as_str).collect());
        if names.is_empty() {
            return error;
        }
        let drives =
            self.driver_of(&names).map_or(String::new(), |driver| format!("; `{driver}` drives them"));
        let who = match redundancy {
            Some(all) if all.dead_point => {
                format!(
                    "do {} start at a dead point, from which rounding chooses the way?{drives}",
                    all.names()
                )
            }
            Some(all) => format!("do the redundant constraints contradict each other here? {all}{drives}"),
            None => {
                let names = names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
                format!(
                    "are the constraints {names} at a dead point, or at the end of the way that they leave?{drives}"
                )
            }
        };
        match error {
            StepError::NoConvergence { t, h, why, equation } => {
                StepError::NoConvergence { t, h, why: format!("{why} ({who})"), equation }
            }
            StepError::Linear { t, source, unknown } => {
                StepError::Linear { t, source, unknown: format!("{unknown} ({who})") }
            }
            e => e,
        }
    }

    /// Counts a fixed step that was cut since it failed.
    pub(super) fn count_cut(&mut self, h: f64, left: f64) {
        if let Stepping::Fixed { h: whole } = self.integrator.options().stepping
            && h < CUT * whole.min(left)
        {
            self.work.counts.cut += 1;
        }
    }

    /// Warns once of a run that takes very many steps: something that isn't asked for may drive them.
    pub(super) fn watch_steps(&self, end: f64, observer: &mut dyn Observer) {
        if self.work.counts.steps != MANY
            || !matches!(self.integrator.options().stepping, Stepping::Controlled { .. })
        {
            return;
        }
        let (t, h) = (self.state.t, self.state.control.h_last);
        let limits = &self.work.counts.limits;
        let most = (0..limits.len()).max_by_key(|&k| limits[k]).unwrap_or_default();
        let (cause, share) = (Limit::ALL[most], 100 * limits[most] / limits.iter().sum::<u64>().max(1));
        let mut fewer = match cause {
            Limit::Position => vec![
                "a looser `tolerance`".to_string(),
                format!(
                    "a `horizon` shorter than the {:.3} s over which errors may add up",
                    self.integrator.horizon()
                ),
            ],
            Limit::Force | Limit::Period => vec!["a looser `force_tolerance`".into()],
            Limit::Longest => vec!["a longer `h_max`".into()],
            _ => vec!["a looser `tolerance`".into()],
        };
        if self.integrator.options().scheme != Scheme::RadauIia5 {
            fewer.push("Radau IIA".into());
        }
        let need = if fewer.len() == 1 { "needs" } else { "need" };
        let last = fewer.pop().unwrap_or_default();
        let fewer = if fewer.is_empty() { last } else { format!("{} or {last}", fewer.join(", ")) };
        let slender = self.model.parts().iter().any(|part| part.slender().is_some());
        let damping = if slender {
            "a little `axial_retardation_time` or `bending_retardation_time`"
        } else {
            "a little damping"
        };
        observer.warn(&format!(
            "{MANY} steps so far, at t = {t:.4} s of {end} s, the last of {h:.1e} s, {share} % limited by {}: {fewer} {need} \
             fewer, and {damping} where fast motion that nothing damps asks for them",
            cause.word()
        ));
    }

    /// Warns at the end of a run whose steps were so short that rounding has moved it by more than the tolerance. Constraints fix
    /// positions to rounding `ε`, which makes `ε/h` of velocity; over a time `T` these add up like dice to `ε T √(Σ 1/h²)`.
    pub(super) fn watch_rounding(&mut self, report: &StepReport, end: f64, observer: &mut dyn Observer) {
        let Stepping::Controlled { tolerance } = self.integrator.options().stepping else { return };
        if self.model.multipliers() == 0 {
            return;
        }
        self.rounded.square += report.h.recip().powi(2);
        self.rounded.time += report.h;
        let Rounded { square, time } = self.rounded;
        let over = time.min(self.integrator.horizon());
        let off = self.work.norms.rounding() * over * (square * over / time).sqrt();
        if self.state.t < end || off <= tolerance {
            return;
        }
        observer.warn(&format!(
            "{} steps are so many that rounding moves positions by {off:.0e} of the size of a part, about, which is more than \
             the `tolerance` of {tolerance:e}. Take a larger one, or Radau IIA, which needs fewer steps",
            self.work.counts.steps
        ));
        // who advances bit by bit hears of it once
        self.rounded = Rounded::default();
    }

    /// Looks for energy that has appeared from nowhere: warns the first time that it is too much for an error of the
    /// integration, and gives up where fixed steps have made most of what there is.
    ///
    /// # Errors
    /// The run had better end.
    pub(super) fn watch_energy(&mut self, end: f64, observer: &mut dyn Observer) -> Result<(), StepError> {
        // what has hardly begun has no energy yet that another could be compared with
        if !self.keep_audit || self.work.counts.steps < BEGUN {
            return Ok(());
        }
        let still = |length: f64, mass: f64| mass * (REST * length / self.state.t).powi(2);
        let noise = self.work.norms.groups.iter().map(|g| still(g.length, g.mass)).sum();
        let (t, gained, all) = (self.state.t, self.audit.imbalance(), self.audit.scale);
        let fixed = matches!(self.integrator.options().stepping, Stepping::Fixed { .. });
        let remedy = match fixed {
            true => "Radau IIA, `rho_inf` of 0.5 and below, error control or a smaller `h`",
            false => "a smaller `tolerance` or Radau IIA",
        };
        match self.audit.created(noise) {
            // error control holds motions, and may leave the power of what dies out within a step to the trapezoidal rule
            Created::Most if fixed => return Err(StepError::Energy { t, gained, all, remedy }),
            Created::Some | Created::Most if self.created.is_none() && t >= BEGUN_TIME * end => {
                self.created = Some(t);
                observer.warn(&format!(
                    "at t = {t:.6} s energy has appeared from nowhere: {gained:.1e} J more than loads and motions brought \
                     in, of {all:.1e} J that came up in all. What follows can't be trusted; take {remedy}"
                ));
            }
            _ if t >= end && self.created.is_none() && self.audit.is_blind(noise) => {
                observer.warn(&format!(
                    "the balance of energy is off by {gained:.1e} J of {all:.1e} J: from step to step the power of loads, \
                     motions and damping changes too much for it to tell whether energy appeared from nowhere. Take {remedy}, \
                     and a finer mesh or some damping where something snaps or rings"
                ));
            }
            _ => {}
        }
        Ok(())
    }
}
