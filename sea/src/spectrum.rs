//! Spectra of sea states: energy by frequency.

use crate::error::{SeaError, positive};
use std::f64::consts::TAU;

/// The one-sided spectral density of the elevation by angular frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spectrum {
    /// JONSWAP (Hasselmann et al., 1973); with `gamma` 1 that of Pierson and Moskowitz.
    Jonswap {
        /// Significant height [m].
        hs: f64,
        /// Peak period [s].
        tp: f64,
        /// Peakedness, 1 to 7.
        gamma: f64,
    },
    /// The same energy at all frequencies of a band.
    White {
        /// Significant height [m].
        hs: f64,
        /// Lowest angular frequency [rad/s].
        from: f64,
        /// Highest angular frequency [rad/s].
        to: f64,
    },
}

impl Spectrum {
    /// Whether its numbers make sense.
    ///
    /// # Errors
    /// The first that doesn't.
    pub fn check(&self) -> Result<(), SeaError> {
        match *self {
            Spectrum::Jonswap { hs, tp, gamma } => {
                positive("hs", hs)?;
                positive("tp", tp)?;
                if !(1.0..=20.0).contains(&gamma) {
                    return Err(SeaError::new(
                        "gamma",
                        format!("`gamma` must be between 1 and 20, not {gamma}"),
                    ));
                }
            }
            Spectrum::White { hs, from, to } => {
                positive("hs", hs)?;
                positive("from", from)?;
                if !(to.is_finite() && to > from) {
                    return Err(SeaError::new(
                        "to",
                        format!("`to` must be above `from`: {to} isn't above {from}"),
                    ));
                }
            }
        }
        Ok(())
    }

    /// Density at an angular frequency [m² s/rad].
    ///
    /// Of JONSWAP with the factor `1 - 0.287 ln γ`, which keeps the significant height to within 1 %.
    pub fn density(&self, omega: f64) -> f64 {
        match *self {
            Spectrum::Jonswap { hs, tp, gamma } => {
                if !(omega > 0.0) {
                    return 0.0;
                }
                let peak = TAU / tp;
                let width = if omega <= peak { 0.07 } else { 0.09 };
                let off = (omega / peak - 1.0) / width;
                let shape = (-1.25 * (peak / omega).powi(4)).exp() * gamma.powf((-0.5 * off * off).exp());
                (1.0 - 0.287 * gamma.ln()) * 0.3125 * hs * hs * peak.powi(4) * omega.powi(-5) * shape
            }
            Spectrum::White { hs, from, to } => {
                if omega < from || omega > to {
                    0.0
                } else {
                    hs * hs / 16.0 / (to - from)
                }
            }
        }
    }

    /// Significant height [m], four times the standard deviation of the elevation.
    pub fn significant_height(&self) -> f64 {
        match *self {
            Spectrum::Jonswap { hs, .. } | Spectrum::White { hs, .. } => hs,
        }
    }

    /// The band of angular frequencies that stands for it [rad/s]: half to four times the peak.
    pub fn band(&self) -> [f64; 2] {
        match *self {
            Spectrum::Jonswap { tp, .. } => [0.5 * TAU / tp, 4.0 * TAU / tp],
            Spectrum::White { from, to, .. } => [from, to],
        }
    }
}
