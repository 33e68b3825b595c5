//! Fatigue from spectra: what cycles a Gaussian process has, without a record of it.

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
