//! Sea states as sums of regular waves.

use crate::error::{SeaError, finite};
use crate::random::SplitMix64;
use crate::spectrum::Spectrum;
use crate::waves::Regular;
use std::f64::consts::{PI, TAU};

/// How frequencies are chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sampling {
    /// At the median energy of bins of equal energy: all amplitudes are equal, and nothing repeats. The last bin is wide;
    /// where the tail of the spectrum matters, take more waves or `Jitter`.
    #[default]
    EqualEnergy,
    /// Anywhere in bins of equal width.
    Jitter,
}

/// How directions spread about the mean: `cos^{2s}((β - β₀)/2)` (Longuet-Higgins, Cartwright and Smith, 1963).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spreading {
    /// Exponent `s`: the larger, the narrower.
    pub s: f64,
    /// Directions, of equal energy each.
    pub directions: usize,
}

/// Intervals of the sum of the spectrum's energy.
const INTERVALS: usize = 40_000;

/// `count` regular waves that have the spectrum's energy, `hs²/16` exactly, with random phases. The same seed gives the
/// same sea on every machine. `direction` is that of the mean [rad].
///
/// # Errors
/// A spectrum that makes no sense, no waves, more directions than waves.
pub fn sample(
    spectrum: &Spectrum,
    count: usize,
    seed: u64,
    sampling: Sampling,
    direction: f64,
    spreading: Option<Spreading>,
) -> Result<Vec<Regular>, SeaError> {
    spectrum.check()?;
    finite("direction", direction)?;
    if count == 0 {
        return Err(SeaError::new("components", "a sea needs at least one component"));
    }
    let directions = match spreading {
        None => vec![direction],
        Some(spreading) => spreading.directions(direction, count)?,
    };
    let mut random = SplitMix64::new(seed);
    let [low, high] = spectrum.band();
    let mut waves: Vec<Regular> = match sampling {
        Sampling::Jitter => {
            let width = (high - low) / count as f64;
            (0..count)
                .map(|i| {
                    let omega = low + (i as f64 + random.unit()) * width;
                    let phase = TAU * random.unit();
                    let amplitude = (2.0 * spectrum.density(omega) * width).sqrt();
                    Regular { amplitude, omega, phase, direction }
                })
                .collect()
        }
        Sampling::EqualEnergy => {
            let medians = medians(spectrum, count);
            let wave = |omega| Regular { amplitude: 1.0, omega, phase: TAU * random.unit(), direction };
            medians.into_iter().map(wave).collect()
        }
    };
    // neighbouring frequencies go to different directions, each of which has the whole band; in random order, as else the
    // highest ones, which make most of the accelerations, always go to the same side
    let mut order = directions;
    for neighbours in waves.rchunks_mut(order.len()) {
        random.shuffle(&mut order);
        neighbours.iter_mut().zip(&order).for_each(|(wave, direction)| wave.direction = *direction);
    }
    let hs = spectrum.significant_height();
    let energy: f64 = waves.iter().map(|w| 0.5 * w.amplitude * w.amplitude).sum();
    let scale = (hs * hs / 16.0 / energy).sqrt();
    waves.iter_mut().for_each(|w| w.amplitude *= scale);
    Ok(waves)
}

/// The frequencies that halve the energy of `count` bins of equal energy.
fn medians(spectrum: &Spectrum, count: usize) -> Vec<f64> {
    let [low, high] = spectrum.band();
    let omega = |k: usize| low + (high - low) * k as f64 / INTERVALS as f64;
    let width = (high - low) / INTERVALS as f64;
    let mut sums = vec![0.0; INTERVALS + 1];
    let mut before = spectrum.density(omega(0));
    for k in 1..=INTERVALS {
        let now = spectrum.density(omega(k));
        sums[k] = sums[k - 1] + 0.5 * (before + now) * width;
        before = now;
    }
    let mut k = 0;
    let median = |i: usize| {
        let wanted = (i as f64 + 0.5) / count as f64 * sums[INTERVALS];
        while k + 1 < INTERVALS && sums[k + 1] < wanted {
            k += 1;
        }
        omega(k) + (wanted - sums[k]) / (sums[k + 1] - sums[k]) * width
    };
    (0..count).map(median).collect()
}

impl Spreading {
    /// The directions at the median energy of bins of equal energy.
    fn directions(&self, mean: f64, count: usize) -> Result<Vec<f64>, SeaError> {
        if !(self.s.is_finite() && self.s > 0.0) {
            return Err(SeaError::new("s", format!("`s` must be above 0, not {}", self.s)));
        }
        if !(1..=count).contains(&self.directions) {
            let message = format!("`directions` must be between 1 and the number of components, {count}");
            return Err(SeaError::new("directions", message));
        }
        let density = |k: usize| (0.5 * (-PI + TAU * k as f64 / INTERVALS as f64)).cos().powf(2.0 * self.s);
        let mut sums = vec![0.0; INTERVALS + 1];
        for k in 1..=INTERVALS {
            sums[k] = sums[k - 1] + 0.5 * (density(k - 1) + density(k));
        }
        let direction = |i: usize| {
            let wanted = (i as f64 + 0.5) / self.directions as f64 * sums[INTERVALS];
            let k = sums.partition_point(|s| *s < wanted).clamp(1, INTERVALS) - 1;
            let inside = (wanted - sums[k]) / (sums[k + 1] - sums[k]);
            mean - PI + TAU * (k as f64 + inside) / INTERVALS as f64
        };
        Ok((0..self.directions).map(direction).collect())
    }
}
