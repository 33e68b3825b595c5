//! Where a twisted cable is about to form a loop: it is too slack for its torque.

use ropewalk_core::{Action, At, Event, Model, Part, Quantity, State};

/// Most places along a cable that are looked at.
const PLACES: usize = 32;

/// Tells when and where the torque `M` of a cable is more than its tension `T` keeps straight: `M²/4EI > max(T, 0) + π² EI/L²`.
///
/// A long straight cable under tension buckles into a helix at `T = M²/4EI` and goes on to a loop (Greenhill 1883; Coyne, IEEE JOE
/// 15, 1990); of one with the length `L` between ends that can turn the bending stiffness carries some of the torque. Without
/// tension torque has to do it alone: what is pressed together is no case of this. The run goes on.
#[derive(Clone, Debug)]
pub(super) struct LoopLimit {
    /// Name of the cable.
    pub part: String,
}

/// Where a cable is nearest to its limit.
struct Nearest {
    /// Arc length from its start [m].
    s: f64,
    /// Tension there, and that below which its torque forms a loop [N].
    tension: f64,
    limit: f64,
    /// Above zero beyond the limit; between -1 and 1.
    level: f64,
}

impl LoopLimit {
    fn nearest(part: &dyn Part, at: &At<'_>) -> Option<Nearest> {
        let line = part.line()?;
        let (ei, mesh) = (line.slender().ei, line.mesh_now(at));
        let length = mesh[mesh.len() - 1];
        if !(ei > 0.0) {
            return None;
        }
        let whole = std::f64::consts::PI.powi(2) * ei / (length * length);
        let every = (mesh.len() - 1).div_ceil(PLACES);
        let there = |k: usize| {
            let s = 0.5 * (mesh[k] + mesh[k + 1]);
            let [torque, tension] =
                [Quantity::Torque, Quantity::Tension].map(|what| part.observe(what, s, at));
            let (torque, tension) = (torque?, tension?);
            let limit = torque * torque / (4.0 * ei);
            let straightens = tension.max(0.0) + whole;
            Some(Nearest { s, tension, limit, level: (limit - straightens) / (limit + straightens) })
        };
        (0..mesh.len() - 1).step_by(every).filter_map(there).max_by(|a, b| a.level.total_cmp(&b.level))
    }
}

/// With two digits after the first.
fn round(x: f64) -> String {
    let size = if x == 0.0 { 0.0 } else { x.abs().log10().floor() };
    format!("{:.*}", (2.0 - size).clamp(0.0, 12.0) as usize, x)
}

impl Event for LoopLimit {
    fn name(&self) -> String {
        format!("`{}` may form a loop: too little tension for its torque", self.part)
    }
    fn value(&self, model: &Model, state: &State) -> f64 {
        let nearest = model.part(&self.part).and_then(|part| Self::nearest(part.as_ref(), &state.at()));
        nearest.map_or(-1.0, |nearest| nearest.level)
    }
    fn direction(&self) -> i8 {
        1
    }
    fn report(&self, model: &Model, state: &State) -> String {
        match model.part(&self.part).and_then(|part| Self::nearest(part.as_ref(), &state.at())) {
            Some(Nearest { s, tension, limit, .. }) => format!(
                "{} (at s = {} m {} N, and M^2/4EI = {} N)",
                self.name(),
                round(s),
                round(tension),
                round(limit)
            ),
            None => self.name(),
        }
    }
    fn only_tells(&self) -> bool {
        true
    }
    fn act(&self, _: &Model, _: &mut State) -> Action {
        Action::Continue
    }
}
