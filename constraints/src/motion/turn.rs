//! A straight run that goes over into a circle.

use super::plane::{Course, Side};
use super::smooth::Rise;
use ropewalk_core::error::positive;
use ropewalk_core::{BuildError, Motion, Moving, SteadyFrame, V3, reach};
use std::f64::consts::TAU;

/// The numbers of a [`Turn`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Manoeuvre {
    /// Course of the straight run; horizontal, of any length.
    pub heading: V3<f64>,
    /// To which side it turns.
    pub side: Side,
    /// Steady speed `U` [m/s].
    pub speed: f64,
    /// When it begins to move [s].
    pub start: f64,
    /// How long the speed rises [s].
    pub ramp: f64,
    /// Radius of the circle `R` [m].
    pub radius: f64,
    /// When it begins to turn, at `start` or later [s].
    pub turn_start: f64,
    /// How long the yaw rate rises [s].
    pub turn_ramp: f64,
}

/// From rest through a straight run into a circle, as a ship turns: the speed rises smoothly as in
/// [`Straight`](super::Straight), and so does, later or at the same time, the yaw rate, from 0 to `U/R`. Once both
/// have risen the path is exactly a circle.
///
/// In between, the position is an integral without closed form: it is summed by Gauss's quadrature (12 points on
/// short pieces), to rounding error.
#[derive(Clone, Debug, PartialEq)]
pub struct Turn {
    course: Course,
    radius: f64,
    speed: Rise,
    yaw: Rise,
    /// Ends of the pieces of the transition, and how far ahead and inward it is there.
    pieces: Vec<(f64, [f64; 2])>,
    /// The centre of the final circle, ahead and inward.
    centre: [f64; 2],
    rule: Vec<(f64, f64)>,
}

impl Turn {
    /// A turn with these numbers.
    ///
    /// # Errors
    /// A heading that isn't horizontal or has no length; a radius, speed or duration that isn't above zero; a turn that
    /// begins before the run; numbers that aren't finite.
    pub fn new(m: Manoeuvre) -> Result<Self, BuildError> {
        let course = Course::new(m.heading, m.side)?;
        positive("radius", m.radius)?;
        positive("speed", m.speed)?;
        let speed = Rise::new(["start", "ramp"], m.speed, m.start, m.ramp)?;
        let yaw = Rise::new(["turn_start", "turn_ramp"], m.speed / m.radius, m.turn_start, m.turn_ramp)?;
        if m.turn_start < m.start {
            let message = format!(
                "the turn must begin at {} s or later, when the run starts, not at {} s",
                m.start, m.turn_start
            );
            return Err(BuildError::at("turn_start", message));
        }
        // the way is summed piece by piece
        let angle = yaw.at(speed.end().max(yaw.end()))[0];
        if angle.is_nan() || angle > 1e4 {
            let message = format!(
                "the vehicle would turn through {angle:.0e} rad before speed and yaw rate are steady: check `speed`, \
                 `radius` and the ramps"
            );
            return Err(BuildError::new(message));
        }
        let rule = gauss(12);
        let mut turn =
            Turn { course, radius: m.radius, speed, yaw, pieces: Vec::new(), centre: [0.0; 2], rule };
        turn.lay_out();
        Ok(turn)
    }

    /// When the circle begins [s].
    pub fn circle_from(&self) -> f64 {
        self.speed.end().max(self.yaw.end())
    }

    fn lay_out(&mut self) {
        let (from, to) = (self.yaw.start, self.circle_from());
        // the integrand is analytic between these
        let mut ends = vec![from, self.yaw.end(), self.speed.end().max(from), to];
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        let mut at = [self.speed.at(from)[0], 0.0];
        self.pieces.push((from, at));
        for w in ends.windows(2) {
            let angle = (self.yaw.at(w[1])[0] - self.yaw.at(w[0])[0]).abs();
            let count = 8 + (2.0 * angle) as usize;
            for k in 0..count {
                let t = |k: usize| w[0] + (w[1] - w[0]) * k as f64 / count as f64;
                let step = self.integral(t(k), t(k + 1));
                at = [at[0] + step[0], at[1] + step[1]];
                self.pieces.push((if k + 1 == count { w[1] } else { t(k + 1) }, at));
            }
        }
        let (sin, cos) = self.yaw.at(to)[0].sin_cos();
        self.centre = [at[0] - self.radius * sin, at[1] + self.radius * cos];
    }

    /// The way ahead and inward between two times of one piece.
    fn integral(&self, from: f64, to: f64) -> [f64; 2] {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let mut sum = [0.0; 2];
        for &(x, w) in &self.rule {
            let t = middle + half * x;
            let (sin, cos) = self.yaw.at(t)[0].sin_cos();
            let v = w * half * self.speed.at(t)[1];
            sum = [sum[0] + v * cos, sum[1] + v * sin];
        }
        sum
    }
}

impl Motion for Turn {
    fn at(&self, t: f64) -> Moving {
        let [way, speed, thrust] = self.speed.at(t);
        let [angle, rate, _] = self.yaw.at(t);
        let (sin, cos) = angle.sin_cos();
        let x = if t <= self.yaw.start {
            [way, 0.0]
        } else if t >= self.circle_from() {
            [self.centre[0] + self.radius * sin, self.centre[1] - self.radius * cos]
        } else {
            let k = self.pieces.partition_point(|p| p.0 <= t).saturating_sub(1);
            let (from, x) = self.pieces[k];
            let more = self.integral(from, t);
            [x[0] + more[0], x[1] + more[1]]
        };
        let c = speed * rate;
        Moving {
            x: self.course.vector(x[0], x[1]),
            v: self.course.vector(speed * cos, speed * sin),
            a: self.course.vector(thrust * cos - c * sin, thrust * sin + c * cos),
        }
    }
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        let round = reach::period(TAU / self.yaw.top, h);
        Some(reach::after(self.yaw.start, t, self.yaw.reach(t, self.speed.reach(t, h)), round))
    }
    fn steady(&self, t: f64) -> Option<SteadyFrame> {
        (t >= self.circle_from()).then(|| SteadyFrame {
            velocity: [0.0; 3],
            omega: [0.0, 0.0, self.course.sign * self.yaw.top],
            centre: self.course.vector(self.centre[0], self.centre[1]),
        })
    }
}

/// Points and weights of Gauss's quadrature on [-1, 1], by Newton's method on Legendre's polynomial.
fn gauss(n: usize) -> Vec<(f64, f64)> {
    let root = |i: usize| {
        let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..10 {
            let (mut p, mut before) = (x, 1.0);
            for k in 2..=n {
                let k = k as f64;
                (p, before) = (((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k, p);
            }
            slope = n as f64 * (x * p - before) / (x * x - 1.0);
            x -= p / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(root).collect()
}
