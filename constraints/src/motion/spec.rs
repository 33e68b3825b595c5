//! What a scene says about motions.

use super::driven::Oscillation;
use super::{Circle, Harmonic, Manoeuvre, Rest, Side, Straight, Turn};
use ropewalk_core::{BuildError, Motion, V3};
use ropewalk_scene::quantity::{Setting, kind};
use ropewalk_scene::{Inputs, MotionSpec, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

fn ramp() -> f64 {
    5.0
}
fn ahead() -> V3<f64> {
    [1.0, 0.0, 0.0]
}

/// At rest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RestSpec {
    /// Name; constraints refer to it.
    pub name: String,
}
register_spec!(Motion, "rest", RestSpec);

#[typetag::serde(name = "rest")]
impl MotionSpec for RestSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn build(&self, _: &[Arc<dyn Motion>]) -> Result<Arc<dyn Motion>, BuildError> {
        Ok(Arc::new(Rest))
    }
}

/// At rest, then straight ahead; the speed rises smoothly.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StraightSpec {
    /// Name; constraints refer to it.
    pub name: String,
    /// Speed after the ramp [m/s].
    #[serde(deserialize_with = "quantity::speed")]
    pub speed: f64,
    /// Direction of travel.
    #[serde(default = "ahead")]
    pub direction: V3<f64>,
    /// Start time [s].
    #[serde(default, deserialize_with = "quantity::time")]
    pub start: f64,
    /// Time in which the speed rises [s].
    #[serde(default = "ramp", deserialize_with = "quantity::time")]
    pub ramp: f64,
}
register_spec!(Motion, "straight", StraightSpec);

#[typetag::serde(name = "straight")]
impl MotionSpec for StraightSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn build(&self, _: &[Arc<dyn Motion>]) -> Result<Arc<dyn Motion>, BuildError> {
        Ok(Arc::new(Straight::new(self.direction, self.speed, self.start, self.ramp)?))
    }
}

/// Which way a turn goes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Towards {
    /// To the left, seen from above.
    #[default]
    Port,
    /// To the right, seen from above.
    Starboard,
}

impl From<Towards> for Side {
    fn from(t: Towards) -> Side {
        match t {
            Towards::Port => Side::Left,
            Towards::Starboard => Side::Right,
        }
    }
}

/// At rest, then on a circle from the first moment; the speed rises smoothly.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CircleSpec {
    /// Name; constraints refer to it.
    pub name: String,
    /// Speed after the ramp [m/s].
    #[serde(deserialize_with = "quantity::speed")]
    pub speed: f64,
    /// Radius of the circle [m].
    #[serde(deserialize_with = "quantity::length")]
    pub radius: f64,
    /// Direction of travel at the start, horizontal.
    #[serde(default = "ahead")]
    pub heading: V3<f64>,
    /// Side to which it turns.
    #[serde(default)]
    pub towards: Towards,
    /// Start time [s].
    #[serde(default, deserialize_with = "quantity::time")]
    pub start: f64,
    /// Time in which the speed rises [s].
    #[serde(default = "ramp", deserialize_with = "quantity::time")]
    pub ramp: f64,
}
register_spec!(Motion, "circle", CircleSpec);

#[typetag::serde(name = "circle")]
impl MotionSpec for CircleSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn build(&self, _: &[Arc<dyn Motion>]) -> Result<Arc<dyn Motion>, BuildError> {
        let side = self.towards.into();
        Ok(Arc::new(Circle::new(self.heading, side, self.radius, self.speed, self.start, self.ramp)?))
    }
}

/// Straight ahead, then a turn: the speed and, later, the yaw rate rise smoothly.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TurnSpec {
    /// Name; constraints refer to it.
    pub name: String,
    /// Speed after the ramp [m/s].
    #[serde(deserialize_with = "quantity::speed")]
    pub speed: f64,
    /// Radius of the final circle [m].
    #[serde(deserialize_with = "quantity::length")]
    pub radius: f64,
    /// Direction of travel at the start, horizontal.
    #[serde(default = "ahead")]
    pub heading: V3<f64>,
    /// Side to which it turns.
    #[serde(default)]
    pub towards: Towards,
    /// Start time [s].
    #[serde(default, deserialize_with = "quantity::time")]
    pub start: f64,
    /// Time in which the speed rises [s].
    #[serde(default = "ramp", deserialize_with = "quantity::time")]
    pub ramp: f64,
    /// Time at which the turn starts [s]. Default: `start`.
    #[serde(default, deserialize_with = "quantity::optional::time")]
    pub turn_start: Option<f64>,
    /// Time in which the yaw rate rises from 0 to speed over radius [s].
    #[serde(default = "ramp", deserialize_with = "quantity::time")]
    pub turn_ramp: f64,
}
register_spec!(Motion, "turn", TurnSpec);

#[typetag::serde(name = "turn")]
impl MotionSpec for TurnSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn build(&self, _: &[Arc<dyn Motion>]) -> Result<Arc<dyn Motion>, BuildError> {
        Ok(Arc::new(Turn::new(Manoeuvre {
            heading: self.heading,
            side: self.towards.into(),
            speed: self.speed,
            start: self.start,
            ramp: self.ramp,
            radius: self.radius,
            turn_start: self.turn_start.unwrap_or(self.start),
            turn_ramp: self.turn_ramp,
        })?))
    }
}

/// Oscillates harmonically.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HarmonicSpec {
    /// Name; constraints refer to it.
    pub name: String,
    /// Amplitude [m]. Inputs that it reads need `join = "smooth"`: where an amplitude jumps or bends, the velocity jumps.
    #[serde(deserialize_with = "quantity::setting::vec3::length")]
    pub amplitude: [Setting; 3],
    /// Frequency [Hz]. The phase goes on where an input changes it, which needs `join = "linear"` or `"smooth"`, and counts
    /// from t = 0.
    #[serde(deserialize_with = "quantity::setting::frequency")]
    pub frequency: Setting,
    /// Phase [rad].
    #[serde(default, deserialize_with = "quantity::angle")]
    pub phase: f64,
    /// Start time [s].
    #[serde(default, deserialize_with = "quantity::time")]
    pub start: f64,
    /// Time in which the amplitude rises [s]; with 0 it oscillates from the first moment on and starts with that
    /// velocity.
    #[serde(default = "ramp", deserialize_with = "quantity::time")]
    pub ramp: f64,
}
register_spec!(Motion, "harmonic", HarmonicSpec);

#[typetag::serde(name = "harmonic")]
impl MotionSpec for HarmonicSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn build(&self, of: &[Arc<dyn Motion>]) -> Result<Arc<dyn Motion>, BuildError> {
        self.build_with(of, &Inputs::default())
    }
    fn build_with(&self, _: &[Arc<dyn Motion>], inputs: &Inputs) -> Result<Arc<dyn Motion>, BuildError> {
        let (phase, start, ramp) = (self.phase, self.start, self.ramp);
        let (amplitude, frequency) = (&self.amplitude, &self.frequency);
        let o = Oscillation { amplitude, kind: &kind::LENGTH, frequency, phase, start, ramp };
        Ok(match o.numbers() {
            Some((amplitude, frequency)) => {
                Arc::new(Harmonic::new(amplitude, frequency, phase, start, ramp)?)
            }
            None => Arc::new(o.by(inputs)?),
        })
    }
}
