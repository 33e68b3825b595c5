//! Looks ahead: how long the motion from here remembers an error.
//!
//! Two copies of the simulation go on from the present state with longer steps than its own. One of them takes its first
//! steps as two halves each: what the two then differ by is the error of a few steps, of just the kind that adds up. It is
//! blown up to stand out of what iterations leave. From there on both take the same steps, and the difference fades as fast
//! as the motion forgets. What it makes of tensions meanwhile tells how far positions have to be better than their own
//! tolerance for forces to be within theirs.

use super::Simulation;
use super::memory::Remembers;
use super::watch::Rung;
use crate::model::node::{difference, retract};
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
/// Steps whose errors make the difference.
const KICK: u64 = 4;
/// What is left of a forgotten difference.
const FORGOTTEN: f64 = 0.02;
/// Most steps of a copy, in parts of those that a measurement is allowed: where they shrink it isn't worth them.
const DEAR: u64 = 4;
/// What is left of one that won't be, after half of all steps.
const LASTING: f64 = 0.5;
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
#[derive(Clone, Copy, Default)]
struct Fading {
    /// The largest so far.
    most: f64,
    /// The last.
    last: f64,
    /// Its integral over time [s].
    sum: f64,
    /// When it was last worth speaking of [s].
    alive: f64,
}

impl Fading {
    fn note(&mut self, off: f64, t: f64, h: f64) {
        self.most = self.most.max(off);
        self.sum += 0.5 * h * (self.last + off);
        self.last = off;
        // a NaN is alive
        if !(off < FORGOTTEN * self.most) {
            self.alive = t;
        }
    }
}

impl Simulation {
    /// Measures how long the motion from here remembers an error, with at most so many steps.
    pub(super) fn measure_memory(&self, most: u64) -> Remembers {
        // what is steered from outside can't be looked ahead of
        if !self.model.inputs().is_empty() || !self.model.controls().is_empty() {
            return Remembers::Always;
        }
        self.watch_fading(most).unwrap_or(Remembers::Longer)
    }

    fn watch_fading(&self, most: u64) -> Result<Remembers, StepError> {
        let (mut plain, mut halved) = (self.copy(LOOSE, 1.0)?, self.copy(GIVEN[0], GIVEN[1])?);
        let end = self.memory.end();
        let mut parts = vec![Fading::default(); self.work.norms.groups.len()];
        let mut tension = Fading::default();
        let (mut begun, mut first, mut off) = (self.state.t, 0.0, Vec::new());
        let least = SMALL_TENSION * self.integrator.options().force_tolerance;
        for k in 0..most {
            let t = plain.state.t;
            plain.step(end)?;
            let now = plain.state.t;
            let dear = DEAR * most;
            let there = (k >= KICK || halved.go_to(0.5 * (t + now), dear)?) && halved.go_to(now, dear)?;
            if !there || plain.tries() > dear {
                return Ok(Remembers::Longer);
            }
            if k + 1 == KICK {
                begun = now;
                self.blow_up(&plain.state, &mut halved.state);
            }
            if k + 1 < KICK {
                continue;
            }
            let strained = self.apart(&plain.state, &halved.state, &mut off);
            let h = if k + 1 == KICK { 0.0 } else { now - t };
            parts.iter_mut().zip(&off).for_each(|(part, &off)| part.note(off, now - begun, h));
            tension.note(strained, now - begun, h);
            let all = parts.iter().fold(0.0f64, |m, p| m.max(p.most));
            if k + 1 == KICK {
                first = all;
            }
            if !(all > NOISE) {
                return Ok(Remembers::Longer);
            }
            let pulls = (!(tension.most < least)).then_some(&tension);
            let counts = || parts.iter().filter(|p| !(p.most < SMALL * all)).chain(pulls);
            // gone, and gone for as long as it was there
            if counts().all(|p| now - begun > 2.0 * p.alive) && k > 3 * KICK {
                let positions = counts().fold(0.0, |m: f64, p| m.max(p.sum / p.most));
                let forces = FORCES * self.tolerated() * tension.sum / first;
                return Ok(Remembers::For(positions.max(forces)));
            }
            if k == most / 2 && counts().any(|p| !(p.last < LASTING * p.most)) {
                return Ok(Remembers::Always);
            }
            if now >= end {
                break;
            }
        }
        Ok(Remembers::Longer)
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

    /// Moves a state away from another along what they differ by.
    fn blow_up(&self, from: &State, state: &mut State) {
        let nodes = self.model.nodes();
        let mut d = vec![0.0; self.model.velocities()];
        difference(nodes, &from.q, &state.q, &mut d);
        let off = [self.work.norms.relative(&d) / BLOWN, self.strained(from, &d) / BLOWN_TENSION];
        let factor = (1.0 / off[0].max(off[1])).clamp(1.0, MOST);
        d.iter_mut().for_each(|d| *d *= factor);
        retract(nodes, &from.q, &d, &mut state.q);
        let pairs = [(&from.v, &mut state.v), (&from.a, &mut state.a), (&from.aux, &mut state.aux)];
        for (from, to) in pairs {
            to.iter_mut().zip(from).for_each(|(to, from)| *to = from + factor * (*to - from));
        }
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
        self.work.forces.strained(&state.q, d, 1.0)
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
            created: None,
            keep_audit: false,
            power: self.power,
            events: Vec::new(),
            aside: None,
            sampled: (0.0, 0),
            memory: self.memory.clone(),
            jumped: false,
            controlling: Vec::new(),
        })
    }
}
