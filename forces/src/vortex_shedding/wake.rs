//! The wake behind a cylinder as an oscillator.

use std::f64::consts::TAU;

/// Van der Pol's oscillator for the lift of a vortex street, driven by the acceleration of the cylinder (Facchinetti, de Langre and
/// Biolley, *J. Fluids and Structures* 19, 2004): with `Ω = 2π St U/D`,
///
/// ```text
/// q̈ + ε Ω (q² - 1) q̇ + Ω² q = (A/D) ÿ         lift  ½ ρ D U² C_L0 q/2
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WakeOscillator {
    /// Strouhal number `St`.
    pub strouhal: f64,
    /// Strength `ε` of the wake's own damping.
    pub epsilon: f64,
    /// How strongly the cylinder drives it, `A`.
    pub coupling: f64,
    /// Amplitude of the lift coefficient behind a cylinder at rest, `C_L0`.
    pub lift: f64,
}

/// The calibration of the paper: `St = 0.2`, `ε = 0.3`, `A = 12`, `C_L0 = 0.3`.
impl Default for WakeOscillator {
    fn default() -> Self {
        WakeOscillator { strouhal: 0.2, epsilon: 0.3, coupling: 12.0, lift: 0.3 }
    }
}

/// Most that the phase turns in a step of Runge and Kutta's method.
const TURN: f64 = 0.1;
/// More steps than any step of a run is worth.
const MOST: f64 = 1e4;

impl WakeOscillator {
    /// Angular frequency of shedding at a speed across [rad/s].
    pub fn omega(&self, speed: f64, diameter: f64) -> f64 {
        TAU * self.strouhal * speed / diameter
    }

    /// `q` and its rate after `dt` [s], from `[q, q̇]`, at a frequency [rad/s], where the cylinder's acceleration over its diameter is
    /// `drive[0] + drive[1] τ` after `τ` [1/s²]: in so many steps of Runge and Kutta's method as the phase needs.
    pub fn after(&self, dt: f64, start: [f64; 2], omega: f64, drive: [f64; 2]) -> [f64; 2] {
        let steps = (omega * dt.abs() / TURN).ceil().clamp(1.0, MOST);
        let h = dt / steps;
        let rate = |tau: f64, [q, dq]: [f64; 2]| {
            let driven = self.coupling * (drive[0] + drive[1] * tau);
            [dq, driven - self.epsilon * omega * (q * q - 1.0) * dq - omega * omega * q]
        };
        let along = |x: [f64; 2], h: f64, k: [f64; 2]| [x[0] + h * k[0], x[1] + h * k[1]];
        let mut x = start;
        for n in 0..steps as usize {
            let tau = h * n as f64;
            let a = rate(tau, x);
            let b = rate(tau + 0.5 * h, along(x, 0.5 * h, a));
            let c = rate(tau + 0.5 * h, along(x, 0.5 * h, b));
            let d = rate(tau + h, along(x, h, c));
            x = std::array::from_fn(|i| x[i] + h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]));
        }
        x
    }
}
