//! Motions whose speed is set while a run goes on.

use crate::check::unit;
use ropewalk_core::{BuildError, Hold, Input, Motion, Moving, Signal, V3};
use ropewalk_scene::quantity::{Setting, kind};
use ropewalk_scene::{Inputs, MotionSpec, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A run along a straight line with the speed of an input; the way is its integral.
#[derive(Clone, Debug)]
pub struct SpeedInput {
    direction: V3<f64>,
    speed: Arc<Input>,
}

impl SpeedInput {
    /// A run along `direction` (of any length) with the speed that an input is set to [m/s].
    ///
    /// # Errors
    /// An input that jumps, since nothing can follow a jump of the velocity; a direction without length.
    pub fn new(direction: V3<f64>, speed: Arc<Input>) -> Result<Self, BuildError> {
        if speed.join() == Hold::Hold {
            let message = format!(
                "a speed that is prescribed can't jump, with infinite forces, as the input `{}` does: give it \
                 `join = \"linear\"`",
                speed.name()
            );
            return Err(BuildError::at("speed", message));
        }
        Ok(SpeedInput { direction: unit("direction", direction)?, speed })
    }
}

impl Motion for SpeedInput {
    fn at(&self, t: f64) -> Moving {
        let now = self.speed.at(t);
        let along = |s: f64| self.direction.map(|d| s * d);
        Moving { x: along(now.integral), v: along(now.value), a: along(now.rate) }
    }
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        Some(self.speed.reach(t, h))
    }
}

fn ahead() -> V3<f64> {
    [1.0, 0.0, 0.0]
}

/// Straight ahead with a speed that is set while the run goes on: by a controller, or by the program that runs it.
///
/// The distance is the integral of the speed. Speeds can't jump, so the input needs `join = "linear"`. `sum` puts several
/// directions together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InputMotionSpec {
    /// Name; constraints refer to it.
    pub name: String,
    /// The input that the speed is read from, in m/s; of angles in rad/s.
    pub speed: String,
    /// Direction of travel.
    #[serde(default = "ahead")]
    pub direction: V3<f64>,
}
register_spec!(Motion, "input", InputMotionSpec);

#[typetag::serde(name = "input")]
impl MotionSpec for InputMotionSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn build(&self, of: &[Arc<dyn Motion>]) -> Result<Arc<dyn Motion>, BuildError> {
        self.build_with(of, &Inputs::default())
    }
    fn build_with(&self, _: &[Arc<dyn Motion>], inputs: &Inputs) -> Result<Arc<dyn Motion>, BuildError> {
        let setting = Setting::Input(self.speed.clone());
        // constraints that turn take the x component as an angle
        let signal = inputs
            .signal("speed", &setting, &kind::SPEED)
            .or_else(|e| inputs.signal("speed", &setting, &kind::ANGULAR_VELOCITY).map_err(|_| e))?;
        let Signal::Input(speed) = signal else { unreachable!("it was asked for an input") };
        Ok(Arc::new(SpeedInput::new(self.direction, speed)?))
    }
}
