//! To and fro.

use super::smooth::{step, step_second};
use ropewalk_core::error::{finite, positive};
use ropewalk_core::{BuildError, Motion, Moving, V3, reach};
use std::f64::consts::TAU;

/// `X = S(u) A sin(2π f (t - start) + phase)`, faded in by the quintic smooth step `S` of `u = (t - start) / ramp`.
///
/// Without ramp it is `A (sin(2π f t + phase) - sin(phase))` from the first moment on, and what it drives must start with
/// that velocity.
///
/// Use it for: heave and surge of a ship, shaking tests.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harmonic {
    amplitude: V3<f64>,
    frequency: f64,
    phase: f64,
    start: f64,
    ramp: f64,
}

impl Harmonic {
    /// An oscillation of `amplitude` [m] and `frequency` [Hz] with `phase` [rad] at `start` [s], in full from
    /// `start + ramp` on.
    ///
    /// # Errors
    /// A frequency that isn't above zero, a ramp below zero, a later start without ramp, numbers that aren't finite.
    pub fn new(
        amplitude: V3<f64>,
        frequency: f64,
        phase: f64,
        start: f64,
        ramp: f64,
    ) -> Result<Self, BuildError> {
        finite("amplitude", &amplitude)?;
        finite("phase", &[phase])?;
        finite("start", &[start])?;
        positive("frequency", frequency)?;
        if ramp != 0.0 || start != 0.0 {
            positive("ramp", ramp)?;
        }
        Ok(Harmonic { amplitude, frequency, phase, start, ramp })
    }
}

impl Motion for Harmonic {
    fn at(&self, t: f64) -> Moving {
        let (dt, w) = (t - self.start, TAU * self.frequency);
        let along = |f: f64| self.amplitude.map(|a| f * a);
        if self.ramp == 0.0 {
            let (sin, cos) = (w * t + self.phase).sin_cos();
            return Moving { x: along(sin - self.phase.sin()), v: along(w * cos), a: along(-w * w * sin) };
        }
        if dt <= 0.0 {
            return Moving::default();
        }
        let u = dt / self.ramp;
        let [_, s, s1] = step(u);
        let (s1, s2) = (s1 / self.ramp, step_second(u) / (self.ramp * self.ramp));
        let (sin, cos) = (w * dt + self.phase).sin_cos();
        Moving {
            x: along(s * sin),
            v: along(s1 * sin + s * w * cos),
            a: along(s2 * sin + 2.0 * s1 * w * cos - s * w * w * sin),
        }
    }
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        let swing = reach::period(self.period(t), h);
        if self.ramp == 0.0 {
            return Some(swing);
        }
        let rise = reach::rise(self.start, self.start + self.ramp, t, h);
        Some(reach::after(self.start, t, rise, swing))
    }
    fn period(&self, _t: f64) -> f64 {
        if self.amplitude == [0.0; 3] { f64::INFINITY } else { 1.0 / self.frequency }
    }
}
