//! A straight run.

use super::smooth::Rise;
use crate::check::unit;
use ropewalk_core::{BuildError, Motion, Moving, SteadyFrame, V3};

/// From rest to a steady speed on a straight line.
///
/// With `u = (t - start) / ramp`, the speed is `speed (10u³ - 15u⁴ + 6u⁵)` while `u < 1` and then constant; the way is
/// `speed ramp (u⁶ - 3u⁵ + 2.5u⁴)`. Use it for: towing, launching a vehicle, paying out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Straight {
    direction: V3<f64>,
    rise: Rise,
}

impl Straight {
    /// A run along `direction` (of any length) at `speed` [m/s], which it reaches at `start + ramp` [s].
    ///
    /// # Errors
    /// A direction without length, a ramp that isn't above zero, numbers that aren't finite.
    pub fn new(direction: V3<f64>, speed: f64, start: f64, ramp: f64) -> Result<Self, BuildError> {
        let direction = unit("direction", direction)?;
        Ok(Straight { direction, rise: Rise::new(["start", "ramp"], speed, start, ramp)? })
    }
}

impl Motion for Straight {
    fn at(&self, t: f64) -> Moving {
        let [x, v, a] = self.rise.at(t).map(|s| self.direction.map(|d| s * d));
        Moving { x, v, a }
    }
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        Some(self.rise.reach(t, h))
    }
    fn steady(&self, t: f64) -> Option<SteadyFrame> {
        (t >= self.rise.end()).then(|| SteadyFrame {
            velocity: self.direction.map(|d| self.rise.top * d),
            ..SteadyFrame::default()
        })
    }
}
