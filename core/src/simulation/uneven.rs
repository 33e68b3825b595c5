//! Where errors are larger than the mean over a part tells: at ends that whip.
//!
//! What steps do wrong along the motion is a delay `δt`, by which a point is off by `v δt`: where time drives nothing,
//! velocities solve the equations of small errors. Error control knows the root mean square over a part; a point that gets
//! `k` times as fast as its part is off by `k` times as much.

use super::{Observer, Simulation};
use crate::model::node::NodeId;
use crate::solve::integrator::{Group, Speeds, Stepping};

/// Times the speed of its part from which on the speed of a point is worth a word: the end of a rod that swings has 1.7.
const FAST: f64 = 3.0;
/// Steps after which a run has begun.
const BEGUN: u64 = 20;

/// How fast each part got, and its fastest point.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Uneven {
    parts: Vec<Fastest>,
    told: bool,
    #[cfg_attr(feature = "serde", serde(skip))]
    now: Vec<Speeds>,
}

/// The largest speeds in a part so far [m/s].
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Fastest {
    /// Root mean square over its length.
    mean: f64,
    /// That of its fastest point, which that was, and when [s].
    most: f64,
    node: u32,
    t: f64,
}

impl Simulation {
    /// Warns at the end of a run in which a point got much faster than its part, where errors may add up.
    pub(super) fn watch_ends(&mut self, end: f64, observer: &mut dyn Observer) {
        let (t, steps) = (self.state.t, self.work.counts.steps);
        let Stepping::Controlled { tolerance, .. } = self.integrator.options().stepping else { return };
        let Uneven { parts, told, now } = &mut self.uneven;
        self.work.norms.speeds(self.model.nodes(), &self.state.v, now);
        parts.resize(now.len(), Fastest::default());
        for (part, now) in parts.iter_mut().zip(&*now) {
            part.mean = part.mean.max(now.mean);
            if now.most > part.most {
                (part.most, part.node, part.t) = (now.most, now.node as u32, t);
            }
        }
        // who advances bit by bit hears of it once
        if t < end || *told || steps < BEGUN || self.memory.forgets() {
            return;
        }
        // what has no mass has no mean; who doesn't get further than the tolerance can't be off by more
        let far = |(part, group): &(&Fastest, &Group)| part.most * t > tolerance * group.length;
        let uneven = |(part, _): &(&Fastest, &Group)| part.mean > 0.0 && part.most > FAST * part.mean;
        for (part, _) in parts.iter().zip(&self.work.norms.groups).filter(far).filter(uneven) {
            let Fastest { mean, most, node, t } = part;
            *told = true;
            observer.warn(&format!(
                "{} got {:.1} times as fast as the line as a whole, at t = {t:.4} s: its position may be off by as many times \
                 the tolerance, which holds for the mean over the line. `--certify` measures by how much; take a smaller \
                 `tolerance` if it matters",
                self.model.place_name(NodeId(*node)),
                most / mean
            ));
        }
    }
}
