//! An angle that grows steadily.

use super::smooth::{Rise, Shape};
use ropewalk_core::error::finite;
use ropewalk_core::{BuildError, Motion, Moving, reach};
use ropewalk_scene::{MotionSpec, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use std::sync::Arc;

/// An angle, the x component, whose rate rises smoothly to a steady one or has it from the first moment on.
///
/// Use it for: a crank, a winch's drum, a shaft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spin {
    /// Steady rate [rad/s].
    rate: f64,
    /// How the rate rises, if it does.
    rise: Option<Rise>,
}

impl Spin {
    /// A spin at `rate` [rad/s], reached at `start + ramp` [s]. Without ramp it turns from the first moment on, and what
    /// it drives must start with that velocity.
    ///
    /// # Errors
    /// A later start without ramp, a ramp below zero, numbers that aren't finite.
    pub fn new(rate: f64, start: f64, ramp: f64) -> Result<Self, BuildError> {
        if ramp == 0.0 && start == 0.0 {
            return finite("rate", &[rate]).map(|()| Spin { rate, rise: None });
        }
        Ok(Spin { rate, rise: Some(Rise::new(["start", "ramp"], rate, start, ramp)?) })
    }
}

impl Spin {
    /// The same with a rate that rises in another way.
    #[must_use]
    pub fn rising(mut self, shape: Shape) -> Self {
        if let Some(rise) = &mut self.rise {
            rise.shape = shape;
        }
        self
    }
}

impl Motion for Spin {
    fn at(&self, t: f64) -> Moving {
        let [x, v, a] = self.rise.map_or([self.rate * t, self.rate, 0.0], |rise| rise.at(t));
        Moving { x: [x, 0.0, 0.0], v: [v, 0.0, 0.0], a: [a, 0.0, 0.0] }
    }
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        let round = reach::period(TAU / self.rate, h);
        Some(self.rise.map_or(round, |rise| reach::after(rise.start, t, rise.reach(t, h), round)))
    }
}

fn ramp() -> f64 {
    1.0
}

/// An angle for the constraint `rotation`: at rest, then at a constant rate, which rises smoothly.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpinSpec {
    /// Name; constraints refer to it.
    pub name: String,
    /// Rate after the ramp [rad/s].
    #[serde(deserialize_with = "quantity::angular_velocity")]
    pub rate: f64,
    /// Start time [s].
    #[serde(default, deserialize_with = "quantity::time")]
    pub start: f64,
    /// Time in which the rate rises [s]; with 0 it turns from the first moment on and starts with that velocity.
    #[serde(default = "ramp", deserialize_with = "quantity::time")]
    pub ramp: f64,
    /// Shape of the rise.
    #[serde(default)]
    pub rise: Shape,
}
register_spec!(Motion, "spin", SpinSpec);

#[typetag::serde(name = "spin")]
impl MotionSpec for SpinSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn build(&self, _: &[Arc<dyn Motion>]) -> Result<Arc<dyn Motion>, BuildError> {
        Ok(Arc::new(Spin::new(self.rate, self.start, self.ramp)?.rising(self.rise)))
    }
}
