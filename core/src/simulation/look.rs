//! Looks ahead: how long the motion from here remembers an error.
//!
//! Two copies of the simulation go on from the present state with longer steps than its own. One of them takes its first
//! steps as two halves each: what the two then differ by is the error of a few steps, of just the kind that adds up. It is
//! blown up to stand out of what iterations leave. From there on both take the same steps, and the difference fades as fast
//! as the motion forgets. What it makes of tensions meanwhile tells how far positions have to be better than their own
//! tolerance for forces to be within theirs.

use super::Simulation;
use super::difference::Difference;
use super::memory::Remembers;
use super::tensions::{Rung, Summed};
use super::uneven::Uneven;
use super::watch::Rounded;
use crate::model::event::Depends;
use crate::model::node::difference;
use crate::model::state::State;
use crate::simulation::audit::Audit;
use crate::solve::integrator::{Options, StepError, Stepping, Workspace};
use std::sync::Arc;

/// Errors of a look ahead, in parts of those of the run: its steps are as much longer as the root of this.
const LOOSE: f64 = 30.0;
/// The same of a copy whose steps are given, and how much stricter its iterations are than error control would have them.
const GIVEN: [f64; 2] = [1e5, 10.0];
/// What the difference is blown up to, relative to the length of the part where it is largest.
const BLOWN: f64 = 1e-5;
/// By how much at most.
const MOST: f64 = 1e3;
/// Steps whose errors make the difference: those of a few swing and fade, what adds up takes more of them to stand out.
const KICK: u64 = 16;
/// Steps after these that are looked at in any case.
const FEWEST: u64 = 8;
/// What a third of a look adds at least, in parts of the third before, where it is seen how what fades slowly fades.
const SLOW: f64 = 0.3;
/// What is left of a forgotten difference …
const FORGOTTEN: f64 = 0.02;
/// … or what the second half of a look adds to its sum.
const ADDS: f64 = 0.05;
/// Most steps of a copy, in parts of those that a measurement is allowed: where they shrink it isn't worth them.
const DEAR: u64 = 4;
/// Iterations of both copies, in parts of those of as many steps of the run as a measurement is allowed.
const DEAREST: f64 = 3.0;
/// What is left of one that won't be, after half of all steps and no fewer than these.
const LASTING: f64 = 0.5;
const LAST: u64 = 2 * FEWEST;
/// A difference below this is the noise of the iteration [1].
const NOISE: f64 = 1e-7;
/// A part whose difference is below this share of the largest doesn't count.
const SMALL: f64 = 1e-3;
/// The same of the difference of tension, in parts of its tolerance.
const SMALL_TENSION: f64 = 0.1;
/// Share of what the relation of tensions to positions asks for beside what positions ask for: it is measured, not guessed.
const FORCES: f64 = 0.5;
/// What the difference of tension is blown up to at most, relative to the forces at work.
const BLOWN_TENSION: f64 = 0.1;

/// What became of the difference in one part.
#[derive(Clone, Default)]
struct Fading {
    /// The largest so far.
    most: f64,
    /// The last.
    last: f64,
    /// Its integral over time [s], and how that grew: time and integral after each step.
    sum: f64,
    grew: Vec<[f64; 2]>,
    /// When it was last worth speaking of [s].
    alive: f64,
}

impl Fading {
    fn note(&mut self, off: f64, t: f64, h: f64) {
        self.most = self.most.max(off);
        self.sum += 0.5 * h * (self.last + off);
        self.last = off;
        self.grew.push([t, self.sum]);
        // a NaN is alive
        if !(off < FORGOTTEN * self.most) {
            self.alive = t;
        }
    }

    /// Whether it is gone, and has been for as long as it was there; or whether what was left of it in the second half of the
    /// time adds next to nothing.
    fn is_forgotten(&self, t: f64) -> bool {
        t > 2.0 * self.alive || self.sum - self.until(0.5 * t) < ADDS * self.sum
    }

    /// Whether it is seen to fade, slowly, so that what is to come adds no more than what was.
    fn is_fading(&self, t: f64) -> bool {
        self.fades(t) > SLOW && self.rest(t) <= self.sum
    }

    /// The integral until a time.
    fn until(&self, t: f64) -> f64 {
        let known = self.grew.partition_point(|[then, _]| *then < t);
        self.grew.get(known).map_or(0.0, |[_, sum]| *sum)
    }

    /// What the last third of the time adds to the integral, in parts of the second.
    fn fades(&self, t: f64) -> f64 {
        let [first, second] = [1.0, 2.0].map(|k| self.until(k * t / 3.0));
        (self.sum - second) / (second - first)
    }

    /// What time to come adds to the integral if it goes on to fade as it does; without end where it doesn't.
    fn rest(&self, t: f64) -> f64 {
        let (rate, last) = (self.fades(t), self.sum - self.until(2.0 * t / 3.0));
        if rate < 1.0 { last * rate / (1.0 - rate) } else { f64::INFINITY }
    }

    /// The integral over all time; of what is forgotten noise is left that doesn't fade, and doesn't count.
    fn total(&self, t: f64) -> f64 {
        let rest = self.rest(t);
        if rest.is_finite() { self.sum + rest } else { self.sum }
    }
}

impl Simulation {
    /// Measures how long the motion from here remembers an error, with at most so many steps.
    pub(super) fn measure_memory(&self, most: u64) -> Remembers {
        // what is steered from outside can't be looked ahead of
        if !self.model.inputs().is_empty() || !self.model.controls().is_empty() {
            return Remembers::Always;
        }
        // what lets go at a load does so earlier or later by any error, and isn't taken back
        if self.events.iter().any(|(event, _)| event.depends() != Depends::OnMotion) {
            return Remembers::Always;
        }
        // where nothing takes energy away, what is seen to fade comes back: volumes of phase space stay (Liouville)
        let power = self.model.power(&self.state.at(), &self.state.lambda);
        if power.dissipated == 0.0 && power.carried == 0.0 {
            return Remembers::Always;
        }
        self.watch_fading(most).unwrap_or(Remembers::Longer(0.0))
    }

    fn watch_fading(&self, most: u64) -> Result<Remembers, StepError> {
        let (mut plain, mut halved) = (self.copy(LOOSE, 1.0)?, self.copy(GIVEN[0], GIVEN[1])?);
        let (end, nodes) = (self.memory.end(), self.model.nodes());
        let mut parts = vec![Fading::default(); self.work.norms.groups.len()];
        let mut tension = Fading::default();
        let (mut begun, mut off) = (self.state.t, Vec::new());
        let counts = &self.work.counts;
        let each = counts.newton_iterations as f64 / counts.steps as f64;
        let dearest = (DEAREST * each * most as f64) as u64;
        let least = SMALL_TENSION * self.integrator.options().force_tolerance;
        for k in 0..most {
            let (t, steps, dear) = (plain.state.t, halved.work.counts.steps, DEAR * most);
            let before = Difference::between(nodes, &plain.state, &halved.state);
            plain.step(end)?;
            let now = plain.state.t;
            let iterations = [&plain, &halved].map(|copy| copy.work.counts.newton_iterations);
            if iterations[0] + iterations[1] > dearest {
                break;
            }
            let there = (k >= KICK || halved.go_to(0.5 * (t + now), dear)?) && halved.go_to(now, dear)?;
            if !there || plain.tries() > dear {
                break;
            }
            if k + 1 < KICK {
                continue;
            }
            if k + 1 == KICK {
                begun = now;
                let off = Difference::between(nodes, &plain.state, &halved.state);
                off.put(nodes, self.blown_up(&plain.state, &off), &plain.state, &mut halved.state);
            } else if halved.work.counts.steps > steps + 1 {
                // other steps err by something else: only what they differed by before is looked at
                before.put(nodes, 1.0, &plain.state, &mut halved.state);
            }
            let strained = self.apart(&plain.state, &halved.state, &mut off);
            let h = if k + 1 == KICK { 0.0 } else { now - t };
            parts.iter_mut().zip(&off).for_each(|(part, &off)| part.note(off, now - begun, h));
            tension.note(strained, now - begun, h);
            let all = parts.iter().fold(0.0f64, |m, p| m.max(p.most));
            if !(all > NOISE) {
                break;
            }
            let pulls = (!(tension.most < least)).then_some(&tension);
            let moved = || parts.iter().filter(|p| !(p.most < SMALL * all));
            let counts = || moved().chain(pulls);
            let t = now - begun;
            // what swings has faded by then, and no longer hides what fades slowly
            let long = k >= (most / 4).max(8 * KICK);
            if k > KICK + FEWEST && counts().all(|p| p.is_forgotten(t) || long && p.is_fading(t)) {
                let positions = counts().fold(0.0, |m: f64, p| m.max(p.total(t) / p.most));
                let forces = FORCES * self.tolerated() * tension.total(t) / all;
                return Ok(Remembers::For(positions.max(forces)));
            }
            // what will have been remembered for so long makes no difference to the run
            if moved().any(|p| !self.memory.would_help(p.sum / p.most)) {
                break;
            }
            if k == (most / 2).max(KICK + LAST) && counts().any(|p| !(p.last < LASTING * p.most)) {
                return Ok(Remembers::Always);
            }
            if now >= end {
                break;
            }
        }
        Ok(Remembers::Longer(plain.state.t - begun))
    }

    /// Goes to a time in one step if it can be done; whether it came there with so many steps in all.
    fn go_to(&mut self, t: f64, most: u64) -> Result<bool, StepError> {
        while self.state.t < t && self.tries() <= most {
            self.state.control.h_next = t - self.state.t;
            self.step(t)?;
        }
        Ok(self.state.t >= t)
    }

    /// Steps taken and rejected.
    fn tries(&self) -> u64 {
        self.work.counts.steps + self.work.counts.rejected
    }

    /// By how much a difference is blown up.
    fn blown_up(&self, from: &State, off: &Difference) -> f64 {
        let off = [self.work.norms.relative(&off.q) / BLOWN, self.strained(from, &off.q) / BLOWN_TENSION];
        (1.0 / off[0].max(off[1])).clamp(1.0, MOST)
    }

    /// How far two states are apart, part by part, relative to the length of each; and what that makes of tensions,
    /// relative to the forces at work.
    fn apart(&self, a: &State, b: &State, off: &mut Vec<f64>) -> f64 {
        let norms = &self.work.norms;
        let mut d = vec![0.0; self.model.velocities()];
        difference(self.model.nodes(), &a.q, &b.q, &mut d);
        norms.sums(|i| norms.weights()[i] * d[i] * d[i], off);
        off.iter_mut().for_each(|square| *square = square.sqrt());
        self.strained(a, &d)
    }

    /// The tolerance of positions in parts of that of forces: what errs by the one in positions may err by the other in
    /// forces.
    fn tolerated(&self) -> f64 {
        let options = self.integrator.options();
        match options.stepping {
            Stepping::Controlled { tolerance } => tolerance / options.force_tolerance,
            Stepping::Fixed { .. } => 0.0,
        }
    }

    fn strained(&self, state: &State, d: &[f64]) -> f64 {
        self.work.forces.strained(&state.q, d, 1.0).ratio
    }

    /// A copy that goes on from here by itself, with so many times the errors: nothing watches it, and it fires no events.
    fn copy(&self, looser: f64, given: f64) -> Result<Simulation, StepError> {
        let model = Arc::clone(&self.model);
        let horizon = self.integrator.horizon() / looser;
        let mine = self.integrator.options();
        let options = Options {
            horizon,
            force_tolerance: given * mine.force_tolerance,
            newton_tolerance: mine.newton_tolerance / (10.0 * given),
            ..mine.clone()
        };
        let integrator = options.integrator(&model, self.memory.whole)?;
        let mut work =
            Workspace::new(&model).map_err(|source| super::checkpoint::no_memory(self.state.t, source))?;
        work.softening = self.work.softening.clone();
        Ok(Simulation {
            state: self.state.clone(),
            previous: self.state.clone(),
            scratch: self.state.clone(),
            model,
            work,
            integrator,
            correction: self.correction,
            audit: Audit::default(),
            ringing: 0.0,
            change: Vec::new(),
            rung: Rung::default(),
            summed: Summed::default(),
            rounded: Rounded::default(),
            uneven: Uneven::default(),
            created: None,
            keep_audit: false,
            power: self.power,
            accounted: (Audit::default(), self.power),
            shown: Audit::default(),
            events: Vec::new(),
            aside: None,
            aside_of: 0,
            mended: None,
            sampled: (0.0, 0),
            memory: self.memory.clone(),
            jumped: false,
            controlling: Vec::new(),
        })
    }
}
