//! The flank of a groove that a cable comes to from the side.

use super::arc::direction;
use ropewalk_core::Jet;

/// What rolls a cable that runs into its groove by a fleet angle: friction on the flank, down which it goes to the bottom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Flank {
    /// Share of pure rolling, above 0.
    pub share: f64,
    /// Radius at which it acts, half a diameter of the cable [m].
    pub radius: f64,
    /// Coefficient of friction.
    pub friction: f64,
    /// Speed of sliding below which friction fades [m/s].
    pub slip_speed: f64,
}

impl Flank {
    /// Share by which a cable that comes at this speed rolls: all where it comes, nothing where it leaves and is lifted off.
    #[inline(always)]
    pub fn enters<S: Jet>(&self, speed: S) -> S {
        let square = self.slip_speed.powi(2);
        if speed.re() < 0.0 { S::from(square) / (speed * speed + square) } else { S::one() }
    }

    /// Torque on the cable, at most `most`, whose section on the wheel falls behind rolling by a spin.
    ///
    /// As on the stretch of a belt that arrives, friction acts on what arrives before it slides: that spins faster by `flow` times
    /// the torque than what is on the wheel, by the step of its twist. The speed `y` of sliding with `y + flow r M σ(y) = gap r`,
    /// whose left side rises and is concave: Newton's method from below comes near from one side.
    #[inline(always)]
    pub fn torque<S: Jet>(&self, gap: S, most: S, flow: S) -> S {
        let slip = gap * self.radius;
        let by = if flow.re() > 0.0 { flow * most * self.radius } else { S::zero() };
        let (x, c, s) = (slip.re().abs(), by.re(), self.slip_speed);
        let mut y = if c > 0.0 { (x - c).max(0.0) } else { x };
        let mut slope = 1.0;
        for _ in 0..60 {
            let square = y * y + s * s;
            slope = 1.0 + c * s * s / (square * square.sqrt());
            let step = (x - y - c * direction(y, s)) / slope;
            y += step;
            if step.abs() <= 1e-15 * x.max(s) {
                break;
            }
        }
        // one more step, which brings the derivatives
        let at = S::from(y.copysign(slip.re()));
        let y = at - (at + by * direction(at, s) - slip) / slope;
        direction(y, s) * most
    }
}
