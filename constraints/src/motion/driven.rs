//! To and fro, by inputs.

use super::smooth::{step, step_second};
use ropewalk_core::error::{finite, need};
use ropewalk_core::{BuildError, Hold, Motion, Moving, Signal, V3, reach};
use ropewalk_scene::Inputs;
use ropewalk_scene::quantity::{Kind, Setting, kind};
use std::f64::consts::TAU;

/// An oscillation `X = S(u) A sin(φ)` whose amplitude and frequency are set while a run goes on, faded in by the smooth step
/// `S` of `u = (t - start) / ramp`.
///
/// The phase is `2π` times the integral of the frequency since t = 0, so that it goes on where the frequency changes; a
/// constant frequency counts from `start` as in [`Harmonic`](super::Harmonic). Without ramp the displacement starts at zero.
#[derive(Clone, Debug)]
pub struct DrivenHarmonic {
    amplitude: [Signal; 3],
    frequency: Signal,
    phase: f64,
    start: f64,
    ramp: f64,
    /// Displacement at the start without a ramp.
    offset: V3<f64>,
}

/// Amplitude, frequency, and how an oscillation begins, as a scene gives them.
pub(super) struct Oscillation<'a> {
    pub amplitude: &'a [Setting; 3],
    /// What the amplitude is.
    pub kind: &'a Kind,
    pub frequency: &'a Setting,
    pub phase: f64,
    pub start: f64,
    pub ramp: f64,
}

impl Oscillation<'_> {
    /// Amplitude and frequency, if they are numbers.
    pub fn numbers(&self) -> Option<(V3<f64>, f64)> {
        let [x, y, z] = self.amplitude.each_ref().map(Setting::number);
        Some(([x?, y?, z?], self.frequency.number()?))
    }

    /// The oscillation by the inputs of a scene.
    ///
    /// # Errors
    /// There is no such input, it is of another kind, or it jumps where nothing can follow.
    pub fn by(&self, inputs: &Inputs) -> Result<DrivenHarmonic, BuildError> {
        let [x, y, z] = self.amplitude.each_ref().map(|a| inputs.signal("amplitude", a, self.kind));
        let frequency = inputs.signal("frequency", self.frequency, &kind::FREQUENCY)?;
        DrivenHarmonic::new([x?, y?, z?], frequency, self.phase, self.start, self.ramp)
    }
}

impl DrivenHarmonic {
    /// An oscillation of `amplitude` [m] and `frequency` [Hz] with `phase` [rad] at its start, in full from
    /// `start + ramp` on [s].
    ///
    /// # Errors
    /// An amplitude that isn't joined smoothly or a frequency that jumps, since the velocity would; a later start without
    /// ramp, numbers that aren't finite.
    pub fn new(
        amplitude: [Signal; 3],
        frequency: Signal,
        phase: f64,
        start: f64,
        ramp: f64,
    ) -> Result<Self, BuildError> {
        finite("phase", &[phase])?;
        finite("start", &[start])?;
        need(ramp > 0.0 && ramp.is_finite() || ramp == 0.0 && start == 0.0, || {
            format!("`ramp` must be positive, but is {ramp}; it may be 0 with a `start` at 0")
        })
        .map_err(|e| e.of("ramp"))?;
        for (field, signal, needs) in amplitude
            .iter()
            .map(|a| ("amplitude", a, &[Hold::Smooth][..]))
            .chain([("frequency", &frequency, &[Hold::Smooth, Hold::Linear][..])])
        {
            match signal {
                Signal::Constant(x) => finite(field, &[*x])?,
                Signal::Input(input) if !needs.contains(&input.join()) => {
                    let what = if field == "amplitude" { "jumps or bends" } else { "jumps" };
                    let join = if field == "amplitude" { "smooth" } else { "linear" };
                    let message = format!(
                        "where the {field} {what} the velocity jumps, with infinite forces, as by the input `{}`: give it \
                         `join = \"{join}\"`",
                        input.name()
                    );
                    return Err(BuildError::at(field, message));
                }
                Signal::Input(_) => {}
            }
        }
        let offset =
            if ramp == 0.0 { amplitude.each_ref().map(|a| a.at(0.0) * phase.sin()) } else { [0.0; 3] };
        Ok(DrivenHarmonic { amplitude, frequency, phase, start, ramp, offset })
    }
}

impl Motion for DrivenHarmonic {
    fn at(&self, t: f64) -> Moving {
        let dt = t - self.start;
        // how far it has faded in, with two derivatives
        let [s0, s1, s2] = if self.ramp == 0.0 {
            [1.0, 0.0, 0.0]
        } else {
            let u = dt / self.ramp;
            let [_, s, slope] = step(u);
            [s, slope / self.ramp, step_second(u) / (self.ramp * self.ramp)]
        };
        let f = self.frequency.course(t);
        let turns = if self.frequency.is_constant() { f.value * dt } else { f.integral };
        let (w, dw) = (TAU * f.value, TAU * f.rate);
        let (sin, cos) = (TAU * turns + self.phase).sin_cos();
        let g = [
            s0 * sin,
            s1 * sin + s0 * cos * w,
            s2 * sin + 2.0 * s1 * cos * w + s0 * (cos * dw - sin * w * w),
        ];
        let mut moving = Moving::default();
        for i in 0..3 {
            let a = self.amplitude[i].course(t);
            moving.x[i] = a.value * g[0] - self.offset[i];
            moving.v[i] = a.rate * g[0] + a.value * g[1];
            moving.a[i] = a.second * g[0] + 2.0 * a.rate * g[1] + a.value * g[2];
        }
        moving
    }
    fn reach(&self, t: f64, h: f64) -> Option<f64> {
        let h = self.amplitude.iter().chain([&self.frequency]).fold(h, |h, s| s.reach(t, h));
        let f = self.frequency.at(t);
        let swing = if f == 0.0 { h } else { reach::period(1.0 / f, h) };
        if self.ramp == 0.0 {
            return Some(swing);
        }
        let rise = reach::rise(self.start, self.start + self.ramp, t, h);
        Some(reach::after(self.start, t, rise, swing))
    }
    fn period(&self, t: f64) -> f64 {
        1.0 / self.frequency.at(t).abs()
    }
}
