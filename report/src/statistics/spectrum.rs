//! Spectra of records by Welch's method: the mean of the spectra of overlapping pieces.

use std::f64::consts::{PI, TAU};

/// A one-sided spectrum: its integral over the frequency is the variance.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// Frequencies [Hz], from 0 in equal steps.
    pub frequencies: Vec<f64>,
    /// Density there, in squares of the record's unit per hertz.
    pub densities: Vec<f64>,
}

impl Spectrum {
    /// Of a record with values at intervals `dt` [s], from pieces of `length` values, a power of two: without their means, under
    /// Hann's window, each over half of the one before (Welch, 1967). `None` of a record shorter than that.
    pub fn welch(record: &[f64], dt: f64, length: usize) -> Option<Self> {
        if length < 4 || !length.is_power_of_two() || record.len() < length {
            return None;
        }
        let window: Vec<f64> =
            (0..length).map(|k| 0.5 * (1.0 - (TAU * k as f64 / length as f64).cos())).collect();
        let power: f64 = window.iter().map(|w| w * w).sum();
        let mut densities = vec![0.0; length / 2 + 1];
        let mut pieces = 0.0;
        for from in (0..=record.len() - length).step_by(length / 2) {
            let piece = &record[from..from + length];
            let mean = piece.iter().sum::<f64>() / length as f64;
            let mut x: Vec<[f64; 2]> =
                piece.iter().zip(&window).map(|(x, w)| [w * (x - mean), 0.0]).collect();
            transform(&mut x);
            for (sum, [re, im]) in densities.iter_mut().zip(&x) {
                *sum += re * re + im * im;
            }
            pieces += 1.0;
        }
        let last = length / 2;
        for (k, d) in densities.iter_mut().enumerate() {
            // both sides in one, but for those frequencies that are their own other side
            let sides = if k == 0 || k == last { 1.0 } else { 2.0 };
            *d *= sides * dt / (power * pieces);
        }
        let frequencies = (0..=last).map(|k| k as f64 / (length as f64 * dt)).collect();
        Some(Spectrum { frequencies, densities })
    }

    /// A length of the pieces for a record of so many values: about eight of them, a power of two.
    pub fn length_for(values: usize) -> usize {
        let eighth = (values / 4).max(4);
        if eighth.is_power_of_two() { eighth } else { eighth.next_power_of_two() / 2 }
    }

    /// The moment `∫ (2π f)^k S df`: `m0` is the variance.
    pub fn moment(&self, k: i32) -> f64 {
        let step = self.frequencies.get(1).copied().unwrap_or(0.0);
        let each = self.frequencies.iter().zip(&self.densities);
        each.map(|(f, s)| (TAU * f).powi(k) * s * step).sum()
    }

    /// The frequency of its peak [Hz].
    pub fn peak(&self) -> f64 {
        let best = (0..self.densities.len()).max_by(|&a, &b| self.densities[a].total_cmp(&self.densities[b]));
        best.map_or(0.0, |k| self.frequencies[k])
    }
}

/// The discrete Fourier transform of complex numbers in place, of a number that is a power of two (Cooley & Tukey, 1965).
fn transform(x: &mut [[f64; 2]]) {
    let n = x.len();
    let bits = n.trailing_zeros();
    for k in 0..n {
        let reversed = k.reverse_bits() >> (usize::BITS - bits);
        if k < reversed {
            x.swap(k, reversed);
        }
    }
    let mut half = 1;
    while half < n {
        for j in 0..half {
            let (sin, cos) = (-PI * j as f64 / half as f64).sin_cos();
            for k in (j..n).step_by(2 * half) {
                let ([a, b], [c, d]) = (x[k], x[k + half]);
                let (re, im) = (cos * c - sin * d, cos * d + sin * c);
                (x[k], x[k + half]) = ([a + re, b + im], [a - re, b - im]);
            }
        }
        half *= 2;
    }
}
