//! Fatigue: how many cycles something endures, and what cycles a Gaussian process has, without a record of it.

use super::rainflow::Cycle;
use std::f64::consts::{PI, SQRT_2};

/// Expected sum of the ranges' `m`-th powers per second of a narrow-banded process with this deviation, that crosses its mean
/// upwards `rate` times a second.
pub fn narrow_band(deviation: f64, rate: f64, m: f64) -> f64 {
    rate * (2.0 * SQRT_2 * deviation).powf(m) * libm::tgamma(1.0 + 0.5 * m)
}

/// The same of a process of any bandwidth, whose spectrum has the moments `m0`, `m1`, `m2`, `m4` by angular frequency
/// (Dirlik, 1985).
pub fn dirlik([m0, m1, m2, m4]: [f64; 4], m: f64) -> f64 {
    let peaks = (m4 / m2).sqrt() / (2.0 * PI);
    let mean = m1 / m0 * (m2 / m4).sqrt();
    let regularity = m2 / (m0 * m4).sqrt();
    let d1 = 2.0 * (mean - regularity * regularity) / (1.0 + regularity * regularity);
    let rest = 1.0 - regularity - d1 + d1 * d1;
    let r = (regularity - mean - d1 * d1) / rest;
    let d2 = rest / (1.0 - r);
    let d3 = 1.0 - d1 - d2;
    let q = 1.25 * (regularity - d3 - d2 * r) / d1;
    let gamma = libm::tgamma;
    let sum =
        d1 * q.powf(m) * gamma(1.0 + m) + SQRT_2.powf(m) * gamma(1.0 + 0.5 * m) * (d2 * r.abs().powf(m) + d3);
    peaks * (2.0 * m0.sqrt()).powf(m) * sum
}

/// How many cycles something endures: `N = K (range/strength)^-m`.
///
/// Of a mooring line (T-N) the strength is its breaking load and ranges are those of tension; of a steel section (S-N), ranges are
/// stresses and the strength is 1 Pa, or whatever `K` was measured with.
///
/// ```
/// use ropewalk_report::statistics::{Cycle, Life};
/// let chain = Life { strength: 5000.0, k: 316.0, m: 3.0, beyond: None, mean_load: false };
/// assert!((chain.cycles(&Cycle { range: 500.0, mean: 1000.0, count: 1.0 }) / 316e3 - 1.0).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Life {
    /// What ranges are divided by, in their unit.
    pub strength: f64,
    /// Number of cycles `K` of a range as large as the strength.
    pub k: f64,
    /// Slope `m`.
    pub m: f64,
    /// Number of cycles beyond which the slope is another: a second branch of the curve, joined to the first one.
    pub beyond: Option<(f64, f64)>,
    /// Whether the mean counts, by Goodman: a range about the mean `M` does what `range/(1 - M/strength)` does about zero.
    pub mean_load: bool,
}

impl Life {
    /// The number of such cycles that it endures; 0 where the mean alone breaks it, infinite of no range.
    pub fn cycles(&self, cycle: &Cycle) -> f64 {
        let rest = if self.mean_load { 1.0 - cycle.mean / self.strength } else { 1.0 };
        if !(rest > 0.0) {
            return 0.0;
        }
        let ratio = cycle.range / (rest * self.strength);
        let first = self.k * ratio.powf(-self.m);
        match self.beyond {
            // both branches meet at that number of cycles
            Some((knee, m)) if first > knee => knee * (first / knee).powf(m / self.m),
            _ => first,
        }
    }
}
