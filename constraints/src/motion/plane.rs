//! Courses in the horizontal plane.

use crate::check::unit;
use ropewalk_core::{BuildError, V3};

/// To which side a vehicle turns, as seen from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// To port: against the clock, seen from above.
    Left,
    /// To starboard.
    Right,
}

/// A heading and its surroundings; `z` is up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Course {
    /// Ahead.
    pub ahead: V3<f64>,
    /// Towards the centre of the turn.
    pub inward: V3<f64>,
    /// Sign of the yaw about `z`.
    pub sign: f64,
}

impl Course {
    /// The course of this horizontal heading, of any length.
    pub fn new(heading: V3<f64>, side: Side) -> Result<Self, BuildError> {
        let ahead = unit("heading", heading)?;
        if ahead[2] != 0.0 {
            let message = format!("`heading` must be horizontal (no z), not {heading:?}");
            return Err(BuildError::at("heading", message));
        }
        let sign = if side == Side::Left { 1.0 } else { -1.0 };
        Ok(Course { ahead, inward: [-sign * ahead[1], sign * ahead[0], 0.0], sign })
    }
    /// `a` ahead and `b` inward.
    pub fn vector(&self, a: f64, b: f64) -> V3<f64> {
        std::array::from_fn(|i| a * self.ahead[i] + b * self.inward[i])
    }
}
