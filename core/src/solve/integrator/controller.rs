//! The size of steps: from the error of the last one, from failures of Newton's method, and from where a step must end.

use super::options::{Limits, Stepping, fixed_step};
use crate::model::limit::Limit;
use crate::model::state::Control;

/// Factor by which a step may change, from its error, that of the step before, and the sizes of both.
pub(super) type Trend = fn(f64, f64, [f64; 2]) -> f64;

/// What a scheme's step sizes follow.
pub(super) struct StepLaw {
    /// Factor by which a step may change after an error over its tolerance and so many iterations.
    pub growth: fn(f64, u32) -> f64,
    /// The same if the error goes on growing as it did.
    pub trend: Option<Trend>,
    /// Largest factor after a step, and after one with rejected tries.
    pub most: [f64; 2],
    /// Factors from one up to this leave the step as it is: they aren't worth a new factorisation.
    pub worthless: f64,
    /// Growth per step of the cap that a failure of Newton's method sets.
    pub recovery: f64,
    /// Whether the last two steps of an interval share its rest; otherwise the last is cut.
    pub shares_rest: bool,
}

/// Smallest and, after a rejection, largest factor by which an error changes a step.
const REJECTED: [f64; 2] = [0.2, 0.9];
/// By how much a step shrinks after the first failure of Newton's method, and after each further one.
const FAILED: [f64; 2] = [0.7, 0.5];
/// The cap on the next steps after a failure, in parts of the step that failed.
const CAP: f64 = 0.7;

/// By how much longer a step is that leaps, and what its error may be then: it is one of many, and growth of the second
/// order alone makes it 2.6 times larger.
const LEAP: f64 = 1.6;
const LEAPT: f64 = 4.0;

/// The step-size controller of one step: its present size, and what was rejected before.
pub(super) struct StepController<'a> {
    law: &'a StepLaw,
    least: f64,
    /// Longest step that there is room for [s].
    room: f64,
    controlled: bool,
    /// Size of the try that a longer one stands for [s], and whether there was one.
    short: Option<f64>,
    leapt: bool,
    /// Size of the present try [s].
    pub h: f64,
    /// Size that the next step may have at least [s], where this one is cut and says nothing about it.
    kept: Option<f64>,
    /// What keeps the present try from being longer.
    pub limit: Limit,
    /// Tries that were rejected.
    pub rejected: u32,
    /// Size [s] and error of the first try whose error was too large, and the error of the last.
    pub first: Option<[f64; 2]>,
    last: f64,
    /// Tries that failed otherwise than by their error.
    pub failures: u32,
}

impl<'a> StepController<'a> {
    /// The first try of a step of at most `h_max` [s].
    pub fn new(law: &'a StepLaw, stepping: Stepping, limits: Limits, control: &Control, h_max: f64) -> Self {
        let cap = if control.h_cap > 0.0 { control.h_cap } else { f64::INFINITY };
        let next = if control.h_next > 0.0 { control.h_next } else { control.h_start };
        let (h, kept) = match stepping {
            Stepping::Fixed { h } if law.shares_rest => (fixed_step(h.min(cap), h_max), None),
            Stepping::Fixed { h } => (fixed_step(h, h_max).min(cap), None),
            Stepping::Controlled { .. } => {
                if law.shares_rest {
                    let wish = next.min(cap).min(limits.most);
                    let rest = if h_max < 2.0 * wish { 0.5 * h_max } else { wish };
                    let h = if h_max <= wish { h_max } else { rest };
                    (h, (h < wish).then_some(wish))
                } else {
                    let limit = h_max.min(limits.most);
                    let h = next.min(cap).min(limit);
                    (h, (h >= limit && control.h_next > limit).then_some(control.h_next))
                }
            }
        };
        let controlled = matches!(stepping, Stepping::Controlled { .. });
        let limit = match stepping {
            Stepping::Fixed { h: whole } if h >= cap && cap < whole => Limit::Newton,
            Stepping::Fixed { .. } => Limit::Fixed,
            Stepping::Controlled { .. } if h < next.min(cap).min(limits.most) || h >= h_max => Limit::Ahead,
            Stepping::Controlled { .. } if h >= limits.most => Limit::Longest,
            Stepping::Controlled { .. } if cap < next => Limit::Newton,
            Stepping::Controlled { .. } => control.limit,
        };
        let (least, room) = (limits.least, h_max.min(limits.most));
        StepController {
            law,
            least,
            room,
            controlled,
            short: None,
            leapt: false,
            h,
            kept,
            limit,
            rejected: 0,
            first: None,
            last: 0.0,
            failures: 0,
        }
    }

    /// Largest error over the tolerance with which the present try is accepted, if it is `by` positions or forces.
    pub fn allowed(&self, by: Limit) -> f64 {
        if self.short.is_some() && by == Limit::Position { LEAPT } else { 1.0 }
    }

    /// A longer step instead of one that failed, once: next to a singular position, where constraints hardly determine a
    /// direction, every shorter one ends nearer to it. `false` if there is no room for it.
    #[must_use]
    pub fn leap(&mut self) -> bool {
        let fits = LEAP * self.h <= self.room;
        if self.leapt || !fits || !self.controlled {
            return false;
        }
        self.rejected += 1;
        (self.leapt, self.short) = (true, Some(self.h));
        self.h *= LEAP;
        true
    }

    /// A smaller step after one whose error was too large, which `by` says was that of positions or forces; `false` if none
    /// is left.
    #[must_use]
    pub fn too_large(&mut self, error: f64, iterations: u32, by: Limit) -> bool {
        self.rejected += 1;
        self.limit = by;
        self.first.get_or_insert([self.h, error]);
        self.last = error;
        self.h = match self.short.take() {
            Some(short) => FAILED[0] * short,
            None => self.h * (self.law.growth)(error, iterations).clamp(REJECTED[0], REJECTED[1]),
        };
        !(self.h < self.least)
    }

    /// Whether errors didn't fall although steps did: they are rounding.
    pub fn is_rounding(&self) -> bool {
        self.rejected > 2 && self.first.is_some_and(|[_, first]| self.last >= first)
    }

    /// A smaller step after one that failed, which also caps the next steps; `false` if none is left.
    #[must_use]
    pub fn failed(&mut self, control: &mut Control) -> bool {
        self.rejected += 1;
        self.failures += 1;
        self.limit = Limit::Newton;
        let h = self.short.take().unwrap_or(self.h);
        let smaller = h * if self.failures == 1 { FAILED[0] } else { FAILED[1] };
        if smaller < self.least {
            return false;
        }
        control.h_cap = CAP * h;
        self.h = smaller;
        true
    }

    /// Caps the next steps below the present one, which was accepted although it was too long for the scheme.
    pub fn cap(&self, control: &mut Control) {
        control.h_cap = CAP * self.h;
    }

    /// Notes an accepted step, and the size of the next. `by` says whether its error was that of positions or forces.
    pub fn accepted(&self, control: &mut Control, error: f64, iterations: u32, by: Limit) {
        if self.controlled {
            let (next, limit) = self.next(control, error, iterations, by);
            match self.kept {
                // what limited it before does so still
                Some(kept) if self.rejected == 0 && kept > next => control.h_next = kept,
                _ => (control.h_next, control.limit) = (next, limit),
            }
        }
        control.error = error;
        control.h_cap = if control.h_cap > 0.0 { control.h_cap * self.law.recovery } else { 0.0 };
        control.h_last = self.h;
    }

    fn next(&self, control: &Control, error: f64, iterations: u32, by: Limit) -> (f64, Limit) {
        let (law, h) = (self.law, self.h);
        let mut growth = (law.growth)(error, iterations);
        if let Some(trend) = law.trend
            && control.error > 0.0
        {
            growth = growth.min(trend(error, control.error, [h, control.h_last]));
        }
        let most = law.most[usize::from(self.rejected > 0)];
        let limit = if growth > most { Limit::Growth } else { by };
        let growth = growth.clamp(REJECTED[0], most);
        (if (1.0..law.worthless).contains(&growth) { h } else { h * growth }, limit)
    }
}
