//! What steps must not leap over: what terms see ahead in the state, and what changes with time of its own accord.

use super::Simulation;
use super::checkpoint::no_memory;
use crate::model::Model;
use crate::model::constraint::Constraint;
use crate::model::reach::{SAME, shown};
use crate::model::state::At;
use crate::model::term::Term;
use crate::solve::integrator::{Limit, StepError, restart};
use std::sync::Arc;

/// After how many whole steps the rest of a way may end for all of it to be shared out evenly: long and short steps in turn, as
/// between the rows of a table, make generalized-alpha swing ever wilder, and tensions that are read after a short one ring.
const SHARED: u32 = 3;
/// How much of a motion or a load is looked through for what fixed steps don't follow.
const MOST_PIECES: usize = 100_000;

impl Simulation {
    /// The longest step from here that leaps over nothing and follows what swings, where `whole` is left; and what bounds it.
    pub(super) fn limit(&self, whole: f64) -> (f64, Limit) {
        let swing = self.model.period(&self.state.at()) / self.integrator.per_period();
        let left = self.leaps_nothing(whole, swing.min(self.integrator.limits().most));
        match left {
            _ if swing < left => (swing, Limit::Period),
            _ if left >= whole => (left, Limit::Instant),
            _ => (left, Limit::Ahead),
        }
    }

    /// The longest step that leaps over nothing, where steps are at most so long. The way to what it must not leap over is
    /// shared out evenly.
    fn leaps_nothing(&self, whole: f64, most: f64) -> f64 {
        let (model, at, control) = (&self.model, self.state.at(), &self.state.control);
        let wish = if control.h_next > 0.0 { control.h_next } else { control.h_start };
        let wish = wish.min(most);
        let left = shared(whole, wish).min(model.step_limit(&at));
        if !model.is_timed() {
            return left;
        }
        // steps end just before a jump
        let left = left.min(model.jump(at.t) * (1.0 - 0.5 * SAME) - at.t);
        let wish = wish.min(left);
        let reach = model.reach(&at, wish);
        if reach < wish {
            return reach;
        }
        let kink = (1..=SHARED).map(f64::from).find_map(|steps| {
            let rest = model.told(&At { t: at.t + steps * wish, ..at }, wish);
            (rest < wish).then_some(steps * wish + rest)
        });
        kink.filter(|kink| *kink < left).map_or(left, |kink| shared(kink, wish))
    }

    /// Couples what is near here, where what is coupled may soon not be all; `anyhow` without asking. The integrator goes on
    /// as if nothing had happened.
    pub(super) fn recouple(&mut self, anyhow: bool) -> Result<(), StepError> {
        let Some(renewed) = self.model.renewed(&self.state.at(), anyhow) else { return Ok(()) };
        if !self.model.couples_as(&renewed) {
            self.work.renew(&renewed).map_err(|e| no_memory(self.state.t, e))?;
            self.aside = None;
        }
        self.model = Arc::new(renewed);
        Ok(())
    }

    /// Starts anew where a force jumps, if it does so here.
    pub(super) fn leap(&mut self) -> Result<(), StepError> {
        if !self.model.is_timed() {
            return Ok(());
        }
        let jump = self.model.jump(self.state.t);
        if jump - self.state.t <= SAME * self.state.t.abs() {
            let h = self.state.control.h_last;
            self.state.t = jump;
            restart(&self.model, &mut self.state, &mut self.work, self.integrator.as_ref())?;
            (self.state.control.h_next, self.state.control.limit) = (0.1 * h, Limit::Ahead);
            self.power = self.model.power(&self.state.at(), &self.state.lambda);
        }
        Ok(())
    }

    /// The names of loads and constraints that change faster than fixed steps `h` follow until `end`, with the time at
    /// which they first do: what they do between two steps isn't seen.
    pub fn faster_than(&self, h: f64, end: f64) -> Vec<(String, f64)> {
        let (model, from) = (&self.model, self.state.t);
        let terms = model.timed_terms().map(|(term, timed)| {
            let missed = missed(|t, h| timed.reach(t, h), h, from, end);
            missed.map(|t| (term.label(), t))
        });
        let constraints = model.moving_constraints().map(|(_, c)| {
            let missed = missed(|t, h| c.reach(t, h), h, from, end);
            missed.map(|t| (c.name().to_string(), t))
        });
        terms.chain(constraints).flatten().collect()
    }
}

/// The length of the next step on a way that is gone in steps of at most `wish`.
fn shared(way: f64, wish: f64) -> f64 {
    // but for rounding
    let steps = (way / wish * (1.0 - 1e-9)).ceil();
    if steps <= f64::from(SHARED + 1) { way / steps } else { way }
}

/// When two changes first come within a step `h`.
fn missed(reach: impl Fn(f64, f64) -> Option<f64>, h: f64, from: f64, end: f64) -> Option<f64> {
    let (mut t, mut before) = (from, f64::INFINITY);
    for _ in 0..MOST_PIECES {
        let piece = reach(t, end - t)?;
        let ends = t + piece >= end;
        if before + piece < h && !ends {
            return Some(t - before);
        }
        if ends || !(piece > 0.0) {
            break;
        }
        (t, before) = (t + piece, piece);
    }
    None
}

impl Model {
    /// The part of a step `h` from a state that leaps over nothing that time does.
    fn reach(&self, at: &At<'_>, h: f64) -> f64 {
        let h = self.told(at, h);
        let terms = self.timed_terms().filter(|(_, timed)| timed.reach(at.t, h).is_none());
        let h = terms.fold(h, |h, (term, _)| self.shown_by(term, at, h));
        let holding = self.moving_constraints().filter(|(c, _)| self.holds(*c, at.internal));
        let silent = holding.filter(|(_, c)| c.reach(at.t, h).is_none());
        silent.fold(h, |h, (_, constraint)| self.shown_in(constraint, at, h))
    }

    /// The part of it that leaps over nothing that is told.
    fn told(&self, at: &At<'_>, h: f64) -> f64 {
        // a kink that the last step ended at is passed
        let part = |told: f64, h: f64| if told > SAME * at.t.abs() { told.min(h) } else { h };
        let told = |h: f64, told: Option<f64>| told.map_or(h, |told| part(told, h));
        let h = self.timed_terms().fold(h, |h, (_, timed)| told(h, timed.reach(at.t, h)));
        let holding = self.moving_constraints().filter(|(c, _)| self.holds(*c, at.internal));
        holding.fold(h, |h, (_, constraint)| told(h, constraint.reach(at.t, h)))
    }

    /// The shortest period with which time makes anything go to and fro [s].
    fn period(&self, at: &At<'_>) -> f64 {
        let terms = self.timed_terms().map(|(_, timed)| timed.period(at.t));
        let holding = self.moving_constraints().filter(|(c, _)| self.holds(*c, at.internal));
        terms.chain(holding.map(|(_, c)| c.period(at.t))).fold(f64::INFINITY, f64::min)
    }

    /// When a force jumps next.
    fn jump(&self, t: f64) -> f64 {
        self.timed_terms()
            .map(|(_, timed)| timed.jump(t))
            .filter(|&jump| jump > t)
            .fold(f64::INFINITY, f64::min)
    }

    /// The part of a step within which the force of a term looks smooth while everything stays where it is.
    fn shown_by(&self, term: &dyn Term, at: &At<'_>, h: f64) -> f64 {
        let now = self.share_of(term, at);
        shown(h, |step| {
            let later = |x: f64| self.share_of(term, &At { t: at.t + x * step, ..*at });
            let end = later(1.0);
            let (mut off, mut size) = (0.0, 0.0);
            for x in [0.25, 0.5, 0.75] {
                for ((f, a), b) in later(x).iter().zip(&now).zip(&end) {
                    off = largest(off, f - (a + x * (b - a)));
                    size = largest(largest(size, *f), largest(*a, *b));
                }
            }
            if off <= 1e-9 * size { 0.0 } else { off / size }
        })
    }

    /// The part of a step within which a constraint follows the cubic through the ends while everything stays where it is.
    fn shown_in(&self, constraint: &dyn Constraint, at: &At<'_>, h: f64) -> f64 {
        let n: usize = constraint.nodes().iter().map(|&k| self.node(k).kind.velocities()).sum();
        let m = constraint.rows().len();
        let mut room = vec![0.0; m * n];
        let mut value = |t: f64| {
            let mut g = vec![0.0; m];
            constraint.violation(self.nodes(), &At { t, ..*at }, &mut g, &mut room);
            g
        };
        let slope_at = |t: f64| {
            let (mut rate, mut bias) = (vec![0.0; m], vec![0.0; m]);
            constraint.rates(self.nodes(), &At { t, ..*at }, &mut rate, &mut bias);
            rate
        };
        let (now, slope) = (value(at.t), slope_at(at.t));
        shown(h, |step| {
            let (end, end_slope) = (value(at.t + step), slope_at(at.t + step));
            let (mut off, mut size) = (0.0, 0.0);
            for x in [0.25, 0.5, 0.75_f64] {
                let (y, g) = (1.0 - x, value(at.t + x * step));
                for r in 0..m {
                    let cubic = y * y * (1.0 + 2.0 * x) * now[r]
                        + x * x * (1.0 + 2.0 * y) * end[r]
                        + step * x * y * (y * slope[r] - x * end_slope[r]);
                    off = largest(off, g[r] - cubic);
                    size = largest(largest(size, g[r] - now[r]), end[r] - now[r]);
                }
            }
            if off <= 1e-9 * self.length() { 0.0 } else { off / size }
        })
    }
}

/// The larger of two sizes; a NaN stays a NaN.
fn largest(size: f64, x: f64) -> f64 {
    if x.abs() <= size { size } else { x.abs() }
}
