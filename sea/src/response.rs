//! How a vessel answers to waves: response amplitudes by direction and frequency.

use crate::error::SeaError;
use crate::waves::Waves;
use std::f64::consts::{PI, TAU};

/// The six motions: surge, sway, heave along the vessel's axes (x ahead, y to port, z up), roll, pitch, yaw about them.
pub const MOTIONS: usize = 6;

/// Response amplitude operators (RAOs): motions per metre of wave amplitude, by the direction that waves travel relative to the
/// heading (0 from astern, π/2 towards port, π head sea) and by frequency.
///
/// A wave `a cos θ` makes the motion `a A cos(θ + lag)`, with `θ = k x' - ω t + φ` at the vessel's mean place. `θ` falls with time, so
/// that a positive lag is later than the crest. On long waves, in these axes: surge lags by π/2 in waves from astern, heave by 0,
/// pitch (bow down) by -π/2, roll (port up) by π/2 in waves towards port.
#[derive(Clone, Debug, PartialEq)]
pub struct Responses {
    headings: Vec<f64>,
    omegas: Vec<f64>,
    /// Amplitude and lag of each motion by heading and frequency.
    table: Vec<Vec<[[f64; 2]; MOTIONS]>>,
}

impl Responses {
    /// A table at ascending directions, from 0 up to but without 2π, and ascending frequencies [rad/s]: `amplitude` and `lag` of
    /// each direction and frequency [m/m or rad/m, and rad].
    ///
    /// # Errors
    /// Lists that don't ascend or fit, numbers that aren't finite, no entry.
    pub fn new(
        headings: Vec<f64>,
        omegas: Vec<f64>,
        amplitude: &[Vec<[f64; MOTIONS]>],
        lag: &[Vec<[f64; MOTIONS]>],
    ) -> Result<Self, SeaError> {
        let ascends = |x: &[f64]| !x.is_empty() && x.windows(2).all(|x| x[0] < x[1]);
        if !ascends(&headings) || !(headings[0] >= 0.0) || !(headings[headings.len() - 1] < TAU) {
            let message = "`headings` must ascend, from 0 to less than 360 degrees";
            return Err(SeaError::new("headings", message));
        }
        if !ascends(&omegas) || !(omegas[0] > 0.0) {
            return Err(SeaError::new("omegas", "`omegas` must be above 0 and ascend"));
        }
        for (field, rows) in [("amplitude", amplitude), ("lag", lag)] {
            let fits = rows.len() == headings.len() && rows.iter().all(|row| row.len() == omegas.len());
            if !fits {
                let message = format!(
                    "`{field}` needs a row for each of {} headings with six numbers for each of {} omegas",
                    headings.len(),
                    omegas.len()
                );
                return Err(SeaError::new(field, message));
            }
            if rows.iter().flatten().flatten().any(|x| !x.is_finite()) {
                return Err(SeaError::new(field, format!("`{field}` must be finite numbers")));
            }
        }
        let both = |a: &[f64; MOTIONS], lag: &[f64; MOTIONS]| std::array::from_fn(|j| [a[j], lag[j]]);
        let row = |(a, lag): (&Vec<_>, &Vec<_>)| a.iter().zip(lag).map(|(a, lag)| both(a, lag)).collect();
        let table = amplitude.iter().zip(lag).map(row).collect();
        Ok(Responses { headings, omegas, table })
    }

    /// Amplitude and lag of each motion in waves of a direction relative to the heading [rad] and a frequency [rad/s]: linear in
    /// both, the lag along the shorter way round; beyond the ends of the frequencies as at the ends.
    pub fn at(&self, relative: f64, omega: f64) -> [[f64; 2]; MOTIONS] {
        let (relative, n) = (relative.rem_euclid(TAU), self.headings.len());
        let after = self.headings.partition_point(|h| *h <= relative);
        let (i, j) = ((after + n - 1) % n, after % n);
        let width = (self.headings[j] - self.headings[i]).rem_euclid(TAU);
        let turned = if width > 0.0 { (relative - self.headings[i]).rem_euclid(TAU) / width } else { 0.0 };
        between(&self.of_heading(i, omega), &self.of_heading(j, omega), turned)
    }

    fn of_heading(&self, i: usize, omega: f64) -> [[f64; 2]; MOTIONS] {
        let (row, last) = (&self.table[i], self.omegas.len() - 1);
        let k = self.omegas.partition_point(|w| *w <= omega);
        match k {
            0 => row[0],
            k if k > last => row[last],
            k => {
                let (low, high) = (self.omegas[k - 1], self.omegas[k]);
                between(&row[k - 1], &row[k], (omega - low) / (high - low))
            }
        }
    }

    /// First and last frequency [rad/s].
    pub fn band(&self) -> [f64; 2] {
        [self.omegas[0], self.omegas[self.omegas.len() - 1]]
    }
}

fn between(a: &[[f64; 2]; MOTIONS], b: &[[f64; 2]; MOTIONS], x: f64) -> [[f64; 2]; MOTIONS] {
    std::array::from_fn(|j| {
        let ([a, mut lag], [b, mut other]) = (a[j], b[j]);
        // what doesn't move has no lag of its own
        match [a == 0.0, b == 0.0] {
            [true, false] => lag = other,
            [false, true] => other = lag,
            _ => {}
        }
        let turn = (other - lag + PI).rem_euclid(TAU) - PI;
        [a + x * (b - a), lag + x * turn]
    })
}

/// The motions of a vessel in waves: a sum over all of them.
#[derive(Clone, Debug)]
pub struct VesselResponse {
    /// Frequency, and the parts of each motion that go with the cosine and the sine of `ω t`.
    parts: Vec<(f64, [[f64; 2]; MOTIONS])>,
    ramp: f64,
}

impl VesselResponse {
    /// Of a vessel whose mean place is `[x, y]` [m], with this heading from x to y [rad].
    pub fn new(waves: &Waves, responses: &Responses, place: [f64; 2], heading: f64) -> Self {
        let part = |c: &crate::waves::Component| {
            let direction = c.way[1].atan2(c.way[0]);
            let there = c.angle(place[0], place[1], 0.0);
            let motions = responses.at(direction - heading, c.omega).map(|[amplitude, lag]| {
                let (sin, cos) = (there + lag).sin_cos();
                [c.a * amplitude * cos, c.a * amplitude * sin]
            });
            (c.omega, motions)
        };
        VesselResponse { parts: waves.all.iter().map(part).collect(), ramp: waves.ramp() }
    }

    /// Each motion at a time [s], with its first and second derivative by time.
    pub fn at(&self, t: f64) -> [[f64; 3]; MOTIONS] {
        let mut all = [[0.0; 3]; MOTIONS];
        for (omega, motions) in &self.parts {
            let (sin, cos) = (omega * t).sin_cos();
            for (x, [c, s]) in all.iter_mut().zip(motions) {
                let value = c * cos + s * sin;
                x[0] += value;
                x[1] += omega * (s * cos - c * sin);
                x[2] -= omega * omega * value;
            }
        }
        let [r, dr, ddr] = if t >= self.ramp {
            [1.0, 0.0, 0.0]
        } else if t <= 0.0 {
            // the second derivative that it begins with
            [0.0, 0.0, 0.5 * (PI / self.ramp).powi(2)]
        } else {
            let (w, (sin, cos)) = (PI / self.ramp, (PI * t / self.ramp).sin_cos());
            [0.5 * (1.0 - cos), 0.5 * w * sin, 0.5 * w * w * cos]
        };
        all.map(|[x, v, a]| [r * x, r * v + dr * x, r * a + 2.0 * dr * v + ddr * x])
    }
}
