//! What is worth a word while a cable unwinds; the run goes on.

use crate::package::Package;
use ropewalk_core::{Action, Event, Model, MovingBoundary, Part, Quantity, State};
use ropewalk_scene::Builder;
use std::sync::Arc;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum What {
    /// Tension below `ρA V²` at the eyelet: there is no wave that could run against the cable.
    Critical,
    /// The cable touches the package.
    Contact,
    /// It is bent more than it may be.
    Bending,
    /// The tension at the lift-off point is negative.
    Slack,
}

/// Watches for one condition.
struct Condition {
    what: What,
    name: String,
    part: String,
    boundary: MovingBoundary,
    package: Arc<Package>,
}

/// Watches for all conditions of a cable that lifts off from a package at this boundary.
pub(super) fn watch(
    b: &mut Builder,
    name: &str,
    part: &str,
    boundary: MovingBoundary,
    package: &Arc<Package>,
) {
    for what in [What::Critical, What::Contact, What::Bending, What::Slack] {
        if what == What::Bending && package.spec().min_bend_radius.is_none_or(|limit| limit <= 0.0) {
            continue;
        }
        let (name, part, package) = (name.to_string(), part.to_string(), package.clone());
        b.event(Condition { what, name, part, boundary, package });
    }
}

impl Condition {
    /// Unstretched distance of the lift-off point from the start, and of the other end.
    fn ends(&self, length: f64) -> [f64; 2] {
        if self.boundary.sign > 0.0 { [length, 0.0] } else { [0.0, length] }
    }

    /// Above zero where the condition holds; of the order of one.
    fn level(&self, part: &dyn Part, state: &State) -> f64 {
        let at = state.at();
        let length = part.length_now(&at);
        let [off, eyelet] = self.ends(length);
        let observe = |what, s| part.observe(what, s, &at).unwrap_or(f64::NAN);
        match self.what {
            What::Critical => {
                let v = self.boundary.rate(&at);
                let (flow, tension) = (self.boundary.rho_a * v * v, observe(Quantity::Tension, eyelet));
                if flow == 0.0 { -1.0 } else { (flow - tension) / flow }
            }
            What::Slack => {
                let (here, there) = (observe(Quantity::Tension, off), observe(Quantity::Tension, eyelet));
                let size = here.abs() + there.abs();
                if size == 0.0 { -1.0 } else { -here / size }
            }
            What::Bending => {
                let limit = self.package.spec().min_bend_radius.unwrap_or(0.0);
                let points = (0..=32).map(|k| length * f64::from(k) / 32.0);
                points.map(|s| observe(Quantity::Curvature, s)).fold(0.0, f64::max) * limit - 1.0
            }
            What::Contact => {
                // what lies on the package touches it by its nature, to a hundredth of the diameter
                let spec = self.package.spec();
                let (_, depth) = self.deepest(part, state);
                ((depth - 0.01 * spec.diameter) / spec.radius).max(-1.0)
            }
        }
    }

    /// The point of the free cable that is deepest in the package: where it is along the cable, and how deep [m].
    fn deepest(&self, part: &dyn Part, state: &State) -> (f64, f64) {
        let at = state.at();
        let line = part.centre_line(&at);
        let off = if self.boundary.sign > 0.0 { line.last() } else { line.first() };
        let Some(off) = off else { return (0.0, f64::NEG_INFINITY) };
        let depths = line.iter().map(|x| self.package.depth(x, off));
        let deepest = depths.zip(part.arc_lengths(&at)).max_by(|(a, _), (b, _)| a.total_cmp(b));
        deepest.map_or((0.0, f64::NEG_INFINITY), |(depth, s)| (s, depth))
    }
}

impl Event for Condition {
    fn name(&self) -> String {
        let (part, name) = (&self.part, &self.name);
        match self.what {
            What::Critical => {
                format!("`{part}`: tension below rho A V^2 at the eyelet: no wave runs against the cable")
            }
            What::Contact => format!("`{part}` touches the package of `{name}`"),
            What::Bending => format!("`{part}` is bent more than `min_bend_radius` allows"),
            What::Slack => format!("`{part}`: negative tension where it lifts off from `{name}`"),
        }
    }
    fn report(&self, model: &Model, state: &State) -> String {
        match (self.what, model.part(&self.part)) {
            (What::Contact, Some(part)) => {
                let (s, depth) = self.deepest(part.as_ref(), state);
                format!("{}: {depth:.1e} m deep at s = {s:.4} m from its start", self.name())
            }
            _ => self.name(),
        }
    }
    fn value(&self, model: &Model, state: &State) -> f64 {
        model.part(&self.part).map_or(-1.0, |part| self.level(part.as_ref(), state))
    }
    fn direction(&self) -> i8 {
        1
    }
    fn act(&self, _: &Model, _: &mut State) -> Action {
        Action::Continue
    }
}
