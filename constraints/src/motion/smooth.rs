//! Speeds that rise smoothly.

use ropewalk_core::build::{BuildError, finite, positive};

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
        Ok(Rise { top, start, ramp })
    }
    /// What has passed, the rate, and its derivative.
    pub fn at(&self, t: f64) -> [f64; 3] {
        let [sum, rate, rise] = step((t - self.start) / self.ramp);
        [self.top * self.ramp * sum, self.top * rate, self.top / self.ramp * rise]
    }
    /// When it is constant.
    pub fn end(&self) -> f64 {
        self.start + self.ramp
    }
}
