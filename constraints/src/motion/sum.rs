//! Several motions at once.

use ropewalk_core::{BuildError, Motion, Moving, SteadyFrame};
use ropewalk_scene::{MotionSpec, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The sum of motions: their displacements, velocities and accelerations add.
///
/// It is defined for the time for which all of them are. Use it for: a ship that heaves while it runs, small swings about
/// a slow turn.
#[derive(Clone, Debug)]
pub struct Sum {
    of: Vec<Arc<dyn Motion>>,
}

impl Sum {
    /// The sum of these.
    pub fn new(of: Vec<Arc<dyn Motion>>) -> Self {
        Sum { of }
    }
}

impl Motion for Sum {
    fn at(&self, t: f64) -> Moving {
        self.of.iter().fold(Moving::default(), |mut sum, motion| {
            let m = motion.at(t);
            for i in 0..3 {
                sum.x[i] += m.x[i];
                sum.v[i] += m.v[i];
                sum.a[i] += m.a[i];
            }
            sum
        })
    }
    fn range(&self) -> (f64, f64) {
        let all = (f64::NEG_INFINITY, f64::INFINITY);
        self.of.iter().map(|m| m.range()).fold(all, |a, b| (a.0.max(b.0), a.1.min(b.1)))
    }
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        self.of.iter().try_fold(h, |h, m| m.reach(t, h))
    }
    fn period(&self, t: f64) -> f64 {
        self.of.iter().fold(f64::INFINITY, |least, m| least.min(m.period(t)))
    }
    /// Straight runs add up; what turns is steady beside what rests.
    fn steady(&self, t: f64) -> Option<SteadyFrame> {
        let frames: Option<Vec<SteadyFrame>> = self.of.iter().map(|m| m.steady(t)).collect();
        let mut moving = frames?.into_iter().filter(|f| f.velocity != [0.0; 3] || f.omega != [0.0; 3]);
        let Some(first) = moving.next() else { return Some(SteadyFrame::default()) };
        moving.try_fold(first, |sum, f| {
            let straight = sum.omega == [0.0; 3] && f.omega == [0.0; 3];
            let velocity = std::array::from_fn(|i| sum.velocity[i] + f.velocity[i]);
            straight.then_some(SteadyFrame { velocity, ..sum })
        })
    }
}

/// The sum of motions: displacements, velocities and accelerations add. The motions may be of any type, also sums.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SumSpec {
    /// Name; constraints refer to it.
    pub name: String,
    /// Names of the motions to add: `motions = ["surge", "heave"]`.
    pub motions: Vec<String>,
}
register_spec!(Motion, "sum", SumSpec);

#[typetag::serde(name = "sum")]
impl MotionSpec for SumSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn of(&self) -> &[String] {
        &self.motions
    }
    fn build(&self, of: &[Arc<dyn Motion>]) -> Result<Arc<dyn Motion>, BuildError> {
        if of.is_empty() {
            return Err(BuildError::at(
                "motions",
                "name the motions to add, as in `motions = [\"surge\", \"heave\"]`",
            ));
        }
        Ok(Arc::new(Sum::new(of.to_vec())))
    }
}
