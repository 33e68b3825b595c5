//! The schemes: the Newmark, HHT-α and generalized-α family as one parametrised scheme, and Radau IIA.

use crate::error::{BuildError, not_negative};

/// A scheme, by its customary name.
///
/// All but Radau IIA are of one family:
/// `q₊ = q + h v + h² [(½-β) a + β a₊]`, `v₊ = v + h [(1-γ) a + γ a₊]`,
/// `(1-αm) a₊ + αm a = (1-αf) v̇₊ + αf v̇`, with equilibrium and constraints in `(q₊, v₊, v̇₊, λ₊)`
/// (Chung & Hulbert 1993; Arnold & Brüls 2007).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case", deny_unknown_fields))]
pub enum Scheme {
    /// Second order, unconditionally stable, numerical damping by `rho_inf`: 0 damps unresolved motion at once, close
    /// to 1 hardly at all.
    GeneralizedAlpha {
        /// Spectral radius at infinite frequency, in [0, 1).
        rho_inf: f64,
    },
    /// Hilber, Hughes & Taylor: second order, damping by `alpha` in [-1/3, 0).
    Hht {
        /// Damping, in [-1/3, 0).
        alpha: f64,
    },
    /// Newmark β = 1/4, γ = 1/2: the trapezoidal rule. Doesn't damp; multipliers ring.
    AverageAcceleration,
    /// Newmark β = (1+a)²/4, γ = 1/2 + a: first order, damped.
    DampedAverageAcceleration {
        /// Damping, positive.
        a: f64,
    },
    /// Newmark β = 1/6, γ = 1/2: stable up to ω h = 3.46.
    LinearAcceleration,
    /// Newmark β = 1/12, γ = 1/2: fourth order in the period, stable up to ω h = 2.45.
    FoxGoodwin,
    /// Newmark β = 0, γ = 1/2: stable up to ω h = 2.
    CentralDifference,
    /// Newmark β = 0, γ = 0: first order, unstable.
    PurelyExplicit,
    /// Any β and γ of Newmark's family.
    Newmark {
        /// Weight of the new acceleration in the displacement.
        beta: f64,
        /// Weight of the new acceleration in the velocity.
        gamma: f64,
    },
    /// Radau IIA with three stages: of order 5, damps unresolved motion at once. A step costs several times that of
    /// the others and is that much larger: the choice for errors of a millionth and below, and for stiff models.
    #[cfg_attr(feature = "serde", serde(rename = "radau-iia-5"))]
    RadauIia5,
}

impl Default for Scheme {
    fn default() -> Self {
        Scheme::GeneralizedAlpha { rho_inf: 0.8 }
    }
}

/// The numbers of a scheme.
///
/// ```
/// use ropewalk_core::integrator::Scheme;
/// let c = Scheme::default().coefficients()?;
/// // generalized-alpha is of second order: its error grows with the third power of the step
/// assert!(c.error_constant().abs() > 0.0);
/// # Ok::<(), ropewalk_core::BuildError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients {
    /// αm, weight of the old auxiliary acceleration.
    pub alpha_m: f64,
    /// αf, weight of the old true acceleration.
    pub alpha_f: f64,
    /// Newmark's β.
    pub beta: f64,
    /// Newmark's γ.
    pub gamma: f64,
}

impl Coefficients {
    /// `∂v̇₊/∂a₊ = (1-αm)/(1-αf)`.
    pub fn mass(&self) -> f64 {
        (1.0 - self.alpha_m) / (1.0 - self.alpha_f)
    }
    /// By how much of a step the auxiliary acceleration leads the true one: `Δ = αm - αf`.
    pub fn lead(&self) -> f64 {
        self.alpha_m - self.alpha_f
    }
    /// Constant of the local error in q: `Cq h³ q‴`, `Cq = 1/6 - β - Δ/2`.
    pub fn error_constant(&self) -> f64 {
        1.0 / 6.0 - self.beta - 0.5 * self.lead()
    }
}

impl Scheme {
    /// Its numbers in the family of Newmark, or what is wrong with its parameter.
    pub fn coefficients(&self) -> Result<Coefficients, BuildError> {
        let newmark = |beta, gamma| Coefficients { alpha_m: 0.0, alpha_f: 0.0, beta, gamma };
        Ok(match *self {
            Scheme::GeneralizedAlpha { rho_inf } => {
                if !(0.0..=1.0).contains(&rho_inf) {
                    let message = format!("`rho_inf` must be between 0 and 1, not {rho_inf}");
                    return Err(BuildError::at("rho_inf", message));
                }
                let (alpha_m, alpha_f) = ((2.0 * rho_inf - 1.0) / (rho_inf + 1.0), rho_inf / (rho_inf + 1.0));
                let gamma = 0.5 + alpha_f - alpha_m;
                Coefficients { alpha_m, alpha_f, beta: (gamma + 0.5).powi(2) / 4.0, gamma }
            }
            Scheme::Hht { alpha } => {
                if !(-1.0 / 3.0 - 1e-12..=0.0).contains(&alpha) {
                    let message = format!("`alpha` must be between -1/3 and 0, not {alpha}");
                    return Err(BuildError::at("alpha", message));
                }
                Coefficients {
                    alpha_m: 0.0,
                    alpha_f: -alpha,
                    beta: (1.0 - alpha).powi(2) / 4.0,
                    gamma: 0.5 - alpha,
                }
            }
            Scheme::AverageAcceleration => newmark(0.25, 0.5),
            Scheme::DampedAverageAcceleration { a } => {
                not_negative("a", a)?;
                newmark((1.0 + a).powi(2) / 4.0, 0.5 + a)
            }
            Scheme::LinearAcceleration => newmark(1.0 / 6.0, 0.5),
            Scheme::FoxGoodwin => newmark(1.0 / 12.0, 0.5),
            Scheme::CentralDifference => newmark(0.0, 0.5),
            Scheme::PurelyExplicit => newmark(0.0, 0.0),
            Scheme::Newmark { beta, gamma } => {
                if !((0.0..=1.0).contains(&beta) && (0.0..=1.0).contains(&gamma)) {
                    let message =
                        format!("`beta` and `gamma` must be between 0 and 1, not {beta} and {gamma}");
                    return Err(BuildError::at("beta", message));
                }
                newmark(beta, gamma)
            }
            Scheme::RadauIia5 => {
                return Err(BuildError::at("scheme", "Radau IIA is not of the family of Newmark"));
            }
        })
    }

    /// Spectral radius at infinite frequency: how much of an unresolved oscillation is left after a step, or how
    /// fast a multiplier rings. Infinite for β = 0.
    ///
    /// ```
    /// use ropewalk_core::integrator::Scheme;
    /// // what is too fast to be followed dies out
    /// assert!(Scheme::default().radius_at_infinity()? < 1.0);
    /// # Ok::<(), ropewalk_core::BuildError>(())
    /// ```
    pub fn radius_at_infinity(&self) -> Result<f64, BuildError> {
        if *self == Scheme::RadauIia5 {
            return Ok(0.0);
        }
        let c = self.coefficients()?;
        if c.beta == 0.0 {
            return Ok(f64::INFINITY);
        }
        // one root from the filter αf/(1-αf), two from Newmark's polynomial in the auxiliary acceleration
        let filter = (c.alpha_f / (1.0 - c.alpha_f)).abs();
        let (p, q) = ((0.5 + c.gamma - 2.0 * c.beta) / c.beta, (0.5 - c.gamma + c.beta) / c.beta);
        let disc = p * p - 4.0 * q;
        let newmark = if disc >= 0.0 { ((p.abs() + disc.sqrt()) / 2.0).abs() } else { q.abs().sqrt() };
        Ok(newmark.max(filter))
    }

    /// Why constraints at position level make this member unstable, or `None` if they don't.
    pub fn unstable_with_constraints(&self) -> Result<Option<String>, BuildError> {
        let radius = self.radius_at_infinity()?;
        Ok(if radius == f64::INFINITY {
            Some(
                "with beta = 0 the new acceleration cannot enforce the constraints at the new positions"
                    .into(),
            )
        } else if radius > 1.0 + 1e-9 {
            Some(format!("multipliers and accelerations grow by a factor of {radius:.2} at every step"))
        } else if radius > 1.0 - 1e-9 {
            Some("nothing damps the multipliers and accelerations: they ring with a factor of -1 at every step and grow linearly".into())
        } else {
            None
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn radii_at_infinity_are_the_known_ones() {
        let radius = |s: Scheme| s.radius_at_infinity().unwrap();
        for rho in [0.0, 0.3, 0.8, 0.99] {
            assert_relative_eq!(radius(Scheme::GeneralizedAlpha { rho_inf: rho }), rho, epsilon = 2e-8);
        }
        assert_relative_eq!(radius(Scheme::Hht { alpha: -0.1 }), 0.9 / 1.1, epsilon = 1e-7);
        assert_relative_eq!(radius(Scheme::AverageAcceleration), 1.0, epsilon = 1e-7);
        assert_relative_eq!(radius(Scheme::LinearAcceleration), 2.0 + 3f64.sqrt(), epsilon = 1e-9);
        assert_relative_eq!(radius(Scheme::FoxGoodwin), 5.0 + 2.0 * 6f64.sqrt(), epsilon = 1e-9);
        assert_relative_eq!(radius(Scheme::DampedAverageAcceleration { a: 0.1 }), 0.9 / 1.1, epsilon = 1e-7);
        assert!(Scheme::GeneralizedAlpha { rho_inf: 0.8 }.unstable_with_constraints().unwrap().is_none());
        assert!(Scheme::RadauIia5.unstable_with_constraints().unwrap().is_none());
        assert!(Scheme::AverageAcceleration.unstable_with_constraints().unwrap().is_some());
        assert!(Scheme::CentralDifference.unstable_with_constraints().unwrap().is_some());
    }

    #[test]
    fn error_constant_of_the_default_is_that_of_the_theory_page() {
        let c = Scheme::default().coefficients().unwrap();
        assert_relative_eq!(c.error_constant(), -0.086_420, epsilon = 1e-6);
        assert_relative_eq!(c.lead(), -1.0 / 9.0, epsilon = 1e-12);
    }

    #[test]
    fn bad_parameters_are_refused() {
        assert!(Scheme::GeneralizedAlpha { rho_inf: 1.5 }.coefficients().is_err());
        assert!(Scheme::GeneralizedAlpha { rho_inf: f64::NAN }.coefficients().is_err());
        assert!(Scheme::Hht { alpha: 0.2 }.coefficients().is_err());
    }
}
