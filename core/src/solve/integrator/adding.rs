//! How errors of steps add up to that of a run, where nothing takes them away again.
//!
//! A mechanism keeps what its velocities are off by: every step moves positions by that, so that errors that all lie one way
//! grow with the square of time. Those of a scheme come and go with the motion if all steps are alike. What steps are off by
//! with changing sizes doesn't, nor what iterations with kept factors leave: these always come from the same side.

use super::forces::larger;
use super::norm::Norms;
use crate::algebra::rotation::cross;
use crate::model::Model;
use crate::model::constraint::RowKind;
use crate::model::node::{Node, NodeKind};
use crate::model::state::Control;
use std::ops::Range;

/// What the iterations of a step may leave, in parts of the tolerance, and what those of all steps may add up to.
const LEFT: f64 = 1e-4;
const ADDED: f64 = 0.3;
/// Steps of a horizon above which that of each has to be less, and above which it adds up like dice.
const FEW: f64 = 10.0;
const MANY: f64 = 10_000.0;
/// How many times as much a single one may leave that rounding keeps from falling: it makes velocities wrong by a tenth of what the
/// error of the run may be.
const WANDERING: f64 = 100.0;

/// What the error of a body counts for, in a linkage and elsewhere, and how much more for every radian that it turns within the
/// horizon.
const BODY: [f64; 2] = [2.7, 2.4];
const TURNING: f64 = 0.1;
/// Over the sine of the angle between a rate of turning and its own rate: from here on an axis turns.
const PLANE: f64 = 100.0;
/// A body that turns for ever is no reason for steps without end.
const MOST_TURNING: f64 = 100.0;

/// Accelerations change by this much of themselves until the error of a step counts `1/e` of what it was. With ten times as
/// much a spinning pendulum was off by ten times more.
const FORGETTING: f64 = 1.0 / 0.03;
/// The same of the pace of a motion.
const LATELY: f64 = 20.0;

/// Share of the tolerance that iterations may leave of positions in a step that is this part of the horizon: `2 δ/h` of
/// velocities for the rest of it, step by step.
pub(super) fn left(step: f64) -> f64 {
    (ADDED * step * step).min(LEFT)
}

/// The same where latches, friction and material that runs cut steps and leave others: it adds up like dice.
pub(super) fn left_like_dice(step: f64) -> f64 {
    LEFT * (FEW * step).min(1.0) * (MANY * step).min(1.0).sqrt()
}

/// The same of one step alone.
pub(super) fn left_once(step: f64) -> f64 {
    WANDERING * left_like_dice(step)
}

/// Node by node, a body whose error adds up: what it is wrong by in its own axes turns with it. Waves along a cable come and
/// go, and the links of a chain are held by their neighbours.
#[derive(Clone, Debug)]
pub(crate) struct Body {
    dofs: Range<usize>,
    /// What its error counts for at least.
    least: f64,
    /// How its turning counts.
    turning: Turning,
}

/// How the turning of a body counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Turning {
    /// It doesn't: it is one of many, or its attitude is held where steps don't leave energy behind.
    Not,
    /// Where its axis turns.
    Axis,
    /// At all.
    Any,
}

impl Body {
    /// All of a model.
    pub fn all(model: &Model, norms: &Norms) -> Vec<Body> {
        let mut held = vec![false; model.nodes().len()];
        for c in model.constraints().iter().filter(|c| c.rows().contains(&RowKind::Direction)) {
            c.nodes().iter().for_each(|k| held[k.0 as usize] = true);
        }
        let least = BODY[usize::from(!model.is_linkage())];
        let body = |(n, held): (&Node, bool)| {
            let single = n.kind.has_position() && norms.groups[norms.of(n.v)].single;
            let turns = n.kind == NodeKind::Frame;
            let turning = match (turns && single, model.is_linkage(), held) {
                (false, ..) | (true, true, true) => Turning::Not,
                (true, true, false) => Turning::Axis,
                (true, false, _) => Turning::Any,
            };
            (turns || single).then(|| Body { dofs: n.dofs(), least, turning })
        };
        model.nodes().iter().zip(held).filter_map(body).collect()
    }

    /// What its error counts for at these velocities and accelerations. An axis that turns makes of errors a rate of turning
    /// that nothing brings back.
    pub fn counts(&self, v: &[f64], a: &[f64], weights: &[f64], horizon: f64) -> f64 {
        if self.turning == Turning::Not {
            return self.least;
        }
        let turning = self.dofs.clone().skip(3);
        // what has no inertia doesn't count
        let (square, sum) =
            turning.fold((0.0, 0.0), |(s, w), i| (s + weights[i] * v[i] * v[i], w + weights[i]));
        let rate = if sum > 0.0 { (square / sum).sqrt() } else { 0.0 };
        let three = |x: &[f64]| std::array::from_fn(|k| x[self.dofs.start + 3 + k]);
        let (w, dw): ([f64; 3], [f64; 3]) = (three(v), three(a));
        let norm = |x: [f64; 3]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let all = norm(w) * norm(dw);
        let share = match self.turning {
            Turning::Any => 1.0,
            // none in a plane but for rounding
            _ if all > 0.0 => (PLANE * norm(cross(&w, &dw)) / all).min(1.0),
            _ => 0.0,
        };
        self.least + (TURNING * horizon * rate * share).min(MOST_TURNING)
    }

    /// Multiplies its entries.
    pub fn weigh(&self, factor: f64, e: &mut [f64]) {
        self.dofs.clone().for_each(|i| e[i] *= factor);
    }
}

impl Control {
    /// Notes by how much accelerations changed in a step `h`, and how large they are, to tell the pace of the motion.
    pub(super) fn note_pace(&mut self, h: f64, change: f64, acceleration: f64) {
        let [changes, pulls] = self.pace;
        let kept = if pulls > 0.0 { (-h * changes / pulls / LATELY).exp() } else { 1.0 };
        self.pace = [kept * changes + change, kept * pulls + h * acceleration];
    }

    /// The error that the next step is made for, after one of size `h` with this error. The estimate passes through zero where
    /// errors don't, and steps that grew there and shrank again would leave something behind: it falls with the pace of the
    /// motion.
    pub(super) fn remembered(&self, h: f64, error: f64, most: f64) -> f64 {
        let ([changes, pulls], ratio) = (self.pace, h / self.h_last);
        let kept = if pulls > 0.0 { (-h * changes / pulls / FORGETTING).exp() } else { 0.0 };
        // a step that was cut says nothing of one so much longer
        if ratio <= most { larger(error, kept * self.error * ratio * ratio) } else { error }
    }
}
