//! What a run reports as it arises, and goes on.

use super::problem::Unwinding;
use super::state::{Now, State, length};
use std::fmt;

/// A condition under which the model, the cable or the package is in trouble.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// The tension falls to `m V²` or below: transverse waves can't run up the cable any more.
    Subcritical,
    /// The free cable touches the wound one.
    Contact,
    /// The cable is bent more than it bears.
    Bent,
    /// The tension at the lift-off point is negative.
    Slack,
    /// The lift-off point moves back on to the package.
    Relaid,
}

/// A condition that held for a while.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition {
    /// Which.
    pub kind: Kind,
    /// When it began [s].
    pub from: f64,
    /// When it ended [s]; nothing if it held to the end.
    pub to: Option<f64>,
    /// The worst value: tension less `m V²` [N], depth [m], curvature [1/m], tension [N], speed of peeling [m/s].
    pub worst: f64,
    /// Where along the free cable, from the eyelet, that was [m].
    pub s: f64,
}

impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Condition { from, worst, s, .. } = self;
        match self.kind {
            Kind::Subcritical => {
                write!(
                    f,
                    "from t = {from:.4} s the tension is below m V², by {:.3e} N at s = {s:.4} m",
                    -worst
                )
            }
            Kind::Contact => {
                write!(
                    f,
                    "from t = {from:.4} s the cable touches the package, {worst:.3e} m deep at s = {s:.4} m"
                )
            }
            Kind::Bent => {
                write!(
                    f,
                    "from t = {from:.4} s the cable is bent too much, to {worst:.3e} 1/m at s = {s:.4} m"
                )
            }
            Kind::Slack => {
                write!(f, "from t = {from:.4} s the tension at the lift-off point is negative, {worst:.3e} N")
            }
            Kind::Relaid => {
                write!(f, "from t = {from:.4} s the lift-off point moves back, at {worst:.3e} m/s")
            }
        }?;
        match self.to {
            Some(to) => write!(f, ", until t = {to:.4} s"),
            None => write!(f, ", to the end"),
        }
    }
}

/// Follows the conditions of a run.
#[derive(Debug, Default)]
pub(super) struct Watch {
    pub all: Vec<Condition>,
    /// Which of `all` holds now, by kind.
    open: [Option<usize>; 5],
}

impl Watch {
    pub fn see(&mut self, problem: &Unwinding, y: &State, now: &Now, tension: &[f64], lift: f64) {
        let n = y.segments();
        let ell = y.length[0] / n as f64;
        let critical = problem.cable.mass * now.speed[0] * now.speed[0];
        let lowest = (0..n).fold(0, |k, j| if tension[j] < tension[k] { j } else { k });
        self.holds(Kind::Subcritical, y.t, tension[lowest] - critical, 0.0, (lowest as f64 + 0.5) * ell);

        let depth = |j: usize| problem.path.depth(&y.x[j], &y.x[n]);
        // the lift-off point itself lies on the package; a hundredth of the diameter is none to speak of
        let deepest = (1..n).fold(1, |k, j| if depth(j) > depth(k) { j } else { k });
        let allowed = 0.01 * problem.cable.diameter;
        self.holds(Kind::Contact, y.t, depth(deepest), allowed, deepest as f64 * ell);

        let bend = |j: usize| length(&problem.curvature(y, now, j));
        let sharpest = (0..=n).fold(0, |k, j| if bend(j) > bend(k) { j } else { k });
        self.holds(Kind::Bent, y.t, bend(sharpest), problem.cable.curvature_limit, sharpest as f64 * ell);

        self.holds(Kind::Slack, y.t, lift, 0.0, y.length[0]);
        self.holds(Kind::Relaid, y.t, y.peeled[1], -1e-9, y.length[0]);
    }

    fn holds(&mut self, kind: Kind, t: f64, value: f64, limit: f64, s: f64) {
        let low = matches!(kind, Kind::Subcritical | Kind::Slack | Kind::Relaid);
        // tension equal to m V² is trouble too, but a cable at rest without tension is not
        let bad = if low { value < limit } else { value > limit };
        let open = &mut self.open[kind as usize];
        match (bad, *open) {
            (true, None) => {
                *open = Some(self.all.len());
                self.all.push(Condition { kind, from: t, to: None, worst: value, s });
            }
            (true, Some(k)) => {
                let c = &mut self.all[k];
                if (low && value < c.worst) || (!low && value > c.worst) {
                    (c.worst, c.s) = (value, s);
                }
            }
            (false, Some(k)) => {
                self.all[k].to = Some(t);
                *open = None;
            }
            (false, None) => {}
        }
    }
}
