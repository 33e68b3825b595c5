//! A circle from its first moment on.

use super::plane::{Course, Side};
use super::smooth::Rise;
use ropewalk_core::error::positive;
use ropewalk_core::{BuildError, Motion, Moving, SteadyFrame, V3, reach};
use std::f64::consts::TAU;

/// From rest to a steady speed on a circle: `R sin φ` ahead and `R (1 - cos φ)` to the side, with `dφ/dt = U(t)/R` and
/// the smooth rise of the speed `U` of [`Straight`](super::Straight).
///
/// The curvature begins at once, while still at rest; [`Turn`](super::Turn) goes straight first. Use it for: evasive
/// manoeuvres, whirling tows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    course: Course,
    radius: f64,
    rise: Rise,
}

impl Circle {
    /// A circle of `radius` [m] that starts with a horizontal `heading` and bends to `side`, at `speed` [m/s], which it
    /// reaches at `start + ramp` [s].
    ///
    /// # Errors
    /// A heading that isn't horizontal or has no length, a radius or ramp that isn't above zero, numbers that aren't
    /// finite.
    pub fn new(
        heading: V3<f64>,
        side: Side,
        radius: f64,
        speed: f64,
        start: f64,
        ramp: f64,
    ) -> Result<Self, BuildError> {
        let course = Course::new(heading, side)?;
        positive("radius", radius)?;
        Ok(Circle { course, radius, rise: Rise::new(["start", "ramp"], speed, start, ramp)? })
    }
}

impl Motion for Circle {
    fn at(&self, t: f64) -> Moving {
        let [way, speed, thrust] = self.rise.at(t);
        let r = self.radius;
        let (sin, cos) = (way / r).sin_cos();
        let half = (0.5 * way / r).sin();
        let c = speed * speed / r;
        Moving {
            x: self.course.vector(r * sin, 2.0 * r * half * half),
            v: self.course.vector(speed * cos, speed * sin),
            a: self.course.vector(thrust * cos - c * sin, thrust * sin + c * cos),
        }
    }
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        let round = reach::period(TAU * self.radius / self.rise.top, h);
        Some(reach::after(self.rise.start, t, self.rise.reach(t, h), round))
    }
    fn steady(&self, t: f64) -> Option<SteadyFrame> {
        (t >= self.rise.end()).then(|| SteadyFrame {
            velocity: [0.0; 3],
            omega: [0.0, 0.0, self.course.sign * self.rise.top / self.radius],
            centre: self.course.vector(0.0, self.radius),
        })
    }
}
