//! An angle that goes to and fro.

use super::Harmonic;
use super::driven::Oscillation;
use ropewalk_core::{BuildError, Motion};
use ropewalk_scene::quantity::{Setting, kind};
use ropewalk_scene::{Inputs, MotionSpec, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

fn ramp() -> f64 {
    5.0
}

/// An oscillating angle for the constraint `rotation`; the amplitude rises smoothly.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SwingSpec {
    /// Name; constraints refer to it.
    pub name: String,
    /// Amplitude [rad]. An input that it reads needs `join = "smooth"`: where an amplitude jumps or bends, the velocity
    /// jumps.
    #[serde(deserialize_with = "quantity::setting::angle")]
    pub amplitude: Setting,
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
register_spec!(Motion, "swing", SwingSpec);

#[typetag::serde(name = "swing")]
impl MotionSpec for SwingSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn build(&self, of: &[Arc<dyn Motion>]) -> Result<Arc<dyn Motion>, BuildError> {
        self.build_with(of, &Inputs::default())
    }
    fn build_with(&self, _: &[Arc<dyn Motion>], inputs: &Inputs) -> Result<Arc<dyn Motion>, BuildError> {
        let (phase, start, ramp) = (self.phase, self.start, self.ramp);
        let (amplitude, frequency) = (&[self.amplitude.clone(), 0.0.into(), 0.0.into()], &self.frequency);
        let o = Oscillation { amplitude, kind: &kind::ANGLE, frequency, phase, start, ramp };
        Ok(match o.numbers() {
            Some((amplitude, frequency)) => {
                Arc::new(Harmonic::new(amplitude, frequency, phase, start, ramp)?)
            }
            None => Arc::new(o.by(inputs)?),
        })
    }
}
