//! A sea as it was measured: the regular waves that a record of the elevation is made of.

use crate::error::{SeaError, finite, positive};
use crate::waves::Regular;
use std::f64::consts::TAU;

/// What may be left out of a record, in parts of its energy: the weakest waves.
const LEFT_OUT: f64 = 1e-4;
/// More waves than this make no sea that can be computed with.
const MOST: usize = 5000;

/// The waves of a record of the elevation [m] at the origin, at intervals `dt` [s] from `t = 0`, that travel in one direction
/// [rad]. Waves shorter than `shortest` [s] are left out, with the mean and with the weakest ones that hold a ten-thousandth of
/// the energy. Their sum is the record, and repeats after its length.
///
/// # Errors
/// Fewer than four values, values that aren't finite, no waves above the shortest period.
pub fn measured(elevation: &[f64], dt: f64, shortest: f64, direction: f64) -> Result<Vec<Regular>, SeaError> {
    positive("dt", dt)?;
    positive("shortest", shortest)?;
    finite("direction", direction)?;
    let n = elevation.len();
    if n < 4 || elevation.iter().any(|x| !x.is_finite()) {
        return Err(SeaError::new(
            "file",
            "a record needs four elevations or more, all of them finite numbers",
        ));
    }
    let mean = elevation.iter().sum::<f64>() / n as f64;
    let length = dt * n as f64;
    // of frequencies above half of that of the values nothing is known
    let highest = ((length / shortest).floor() as usize).min((n - 1) / 2);
    let one = |k: usize| {
        // Goertzel's recurrence (1958) sums without a sine for each value
        let step = TAU * k as f64 / n as f64;
        let (sin, cos) = step.sin_cos();
        let (mut s1, mut s2) = (0.0, 0.0);
        for x in elevation {
            (s1, s2) = (x - mean + 2.0 * cos * s1 - s2, s1);
        }
        // Σ x exp(i step (n - 1 - j)), whose phase is that of the wave at the last value
        let (re, im) = (s1 - cos * s2, sin * s2);
        let amplitude = 2.0 * re.hypot(im) / n as f64;
        let phase = (step * (n - 1) as f64 - im.atan2(re)).rem_euclid(TAU);
        Regular { amplitude, omega: TAU * k as f64 / length, phase, direction }
    };
    let mut waves: Vec<Regular> = (1..=highest).map(one).collect();
    let energy = |waves: &[Regular]| waves.iter().map(|w| w.amplitude * w.amplitude).sum::<f64>();
    let all = energy(&waves);
    if !(all > 0.0) {
        let message = format!("the record holds no waves of {shortest} s or longer");
        return Err(SeaError::new("shortest", message));
    }
    waves.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
    let mut left = LEFT_OUT * all;
    while let Some(weakest) = waves.last().map(|w| w.amplitude * w.amplitude).filter(|e| *e <= left) {
        left -= weakest;
        waves.pop();
    }
    if waves.len() > MOST {
        let message =
            format!("the record is made of {} waves, more than {MOST}: take a shorter one", waves.len());
        return Err(SeaError::new("file", message));
    }
    waves.sort_by(|a, b| a.omega.total_cmp(&b.omega));
    Ok(waves)
}
