//! An angle that goes to and fro.

use super::Harmonic;
use ropewalk_core::{BuildError, Motion};
use ropewalk_scene::{MotionSpec, quantity, register_spec};
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
    /// Amplitude [rad].
    #[serde(deserialize_with = "quantity::angle")]
    pub amplitude: f64,
    /// Frequency [Hz].
    #[serde(deserialize_with = "quantity::frequency")]
    pub frequency: f64,
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
    fn build(&self, _: &[Arc<dyn Motion>]) -> Result<Arc<dyn Motion>, BuildError> {
        let amplitude = [self.amplitude, 0.0, 0.0];
        Ok(Arc::new(Harmonic::new(amplitude, self.frequency, self.phase, self.start, self.ramp)?))
    }
}
