//! Speeds that rise smoothly.

use ropewalk_core::error::{finite, positive};
use ropewalk_core::{BuildError, reach};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// How a rate rises.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
    /// The quintic smooth step: the acceleration rises smoothly as well.
    #[default]
    Quintic,
    /// The cycloid, whose acceleration is `1 - cos`: the spin-up of Kane, Ryan & Banerjee (1987).
    Cycloidal,
}

/// The quintic smooth step `S = 10u³ - 15u⁴ + 6u⁵` with its integral and its derivative: `[∫S, S, S']`. It has two
/// continuous derivatives; before 0 it is 0, after 1 it is 1.
pub(crate) fn step(u: f64) -> [f64; 3] {
    if u <= 0.0 {
        [0.0; 3]
    } else if u < 1.0 {
        let cube = u * u * u;
        [
            cube * u * (2.5 + u * (u - 3.0)),
            cube * (10.0 + u * (6.0 * u - 15.0)),
            30.0 * u * u * (1.0 - u) * (1.0 - u),
        ]
    } else {
        [u - 0.5, 1.0, 0.0]
    }
}

/// The cycloidal step `S = u - sin(2πu)/2π`, as [`step`]; its own derivative is continuous, the second isn't.
pub(crate) fn cycloid(u: f64) -> [f64; 3] {
    if u <= 0.0 {
        [0.0; 3]
    } else if u < 1.0 {
        let (sin, cos) = (TAU * u).sin_cos();
        [0.5 * u * u + (cos - 1.0) / (TAU * TAU), u - sin / TAU, 1.0 - cos]
    } else {
        [u - 0.5, 1.0, 0.0]
    }
}

/// Second derivative of the smooth step.
pub(crate) fn step_second(u: f64) -> f64 {
    if u > 0.0 && u < 1.0 { 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u) } else { 0.0 }
}

/// A rate that rises from zero to `top` between `start` and `start + ramp`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rise {
    pub top: f64,
    pub start: f64,
    pub ramp: f64,
    pub shape: Shape,
}

impl Rise {
    /// Refuses a step, which no finite force can follow. The fields name `start` and `ramp` in messages.
    pub fn new(fields: [&str; 2], top: f64, start: f64, ramp: f64) -> Result<Self, BuildError> {
        finite("speed", &[top])?;
        finite(fields[0], &[start])?;
        if ramp == 0.0 {
            let message = "a ramp of 0 s would be a jump of velocity, with infinite forces; try 1 s";
            return Err(BuildError::at(fields[1], message));
        }
        positive(fields[1], ramp)?;
        Ok(Rise { top, start, ramp, shape: Shape::default() })
    }
    /// What has passed, the rate, and its derivative.
    pub fn at(&self, t: f64) -> [f64; 3] {
        let u = (t - self.start) / self.ramp;
        let [sum, rate, rise] = match self.shape {
            Shape::Quintic => step(u),
            Shape::Cycloidal => cycloid(u),
        };
        [self.top * self.ramp * sum, self.top * rate, self.top / self.ramp * rise]
    }
    /// How much of a step `h` from `t` doesn't leap over it.
    pub fn reach(&self, t: f64, h: f64) -> f64 {
        reach::rise(self.start, self.end(), t, h)
    }
    /// When it is constant.
    pub fn end(&self) -> f64 {
        self.start + self.ramp
    }
}
