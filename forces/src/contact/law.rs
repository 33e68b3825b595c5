//! How hard a shape pushes back, and how it brakes what slides on it.

use super::friction::Friction;
use ropewalk_core::BuildError;
use ropewalk_core::error::{not_negative, positive};
use ropewalk_scene::quantity;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What happens to the damped force when a point leaves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Leaving {
    /// The contact ends where the force has fallen to zero: a shape never pulls.
    #[default]
    Force,
    /// The contact ends where the depth has fallen to zero; just before, the damper pulls.
    Depth,
}

/// What a contact loses along its normal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Damping {
    /// Nothing.
    #[default]
    None,
    /// `F = F_e (1 + 3/2 α ḋ)` with the elastic force `F_e` and the rate of the depth `ḋ` (Hunt & Crossley 1975): the
    /// force begins and ends at zero, and for slow impacts the restitution is `1 - α v`.
    HuntCrossley(
        /// `α` [s/m].
        #[serde(deserialize_with = "quantity::time_per_length")]
        f64,
    ),
    /// `F = F_e + k τ ḋ`: a linear damper (Kelvin & Voigt). The force jumps at first contact.
    KelvinVoigt {
        /// Retardation time `τ`, the damping over the stiffness [s].
        #[serde(deserialize_with = "quantity::time")]
        retardation_time: f64,
        /// Condition that ends the contact.
        #[serde(default)]
        until: Leaving,
    },
    /// `F = F_e + k τ ḋ` while it goes in, `F_e` while it comes out: soil that is pressed away and doesn't pull. The damper
    /// takes hold over a depth, so that the force doesn't jump.
    Approach {
        /// Retardation time `τ`, the damping over the stiffness [s].
        #[serde(deserialize_with = "quantity::time")]
        retardation_time: f64,
        /// Depth from which on it damps in full [m].
        #[serde(deserialize_with = "quantity::length")]
        over: f64,
    },
}

/// The numbers of a contact, for all of its points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactLaw {
    /// Exponent `p` of the elastic force `k d^p` of the depth `d` in metres: 1, or 1.5 as between balls (Hertz).
    pub exponent: f64,
    /// Damping law along the normal.
    pub damping: Damping,
    /// Dry friction, if there is any.
    pub friction: Option<Friction>,
}

impl Default for ContactLaw {
    fn default() -> Self {
        ContactLaw { exponent: 1.0, damping: Damping::None, friction: None }
    }
}

/// The force along the normal, with its derivatives.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Normal {
    /// The force [N].
    pub force: f64,
    /// `∂F/∂d` [N/m]
    pub by_depth: f64,
    /// `∂F/∂ḋ` [N s/m]
    pub by_rate: f64,
    /// Its elastic part [N].
    pub elastic: f64,
}

impl ContactLaw {
    /// Checks its numbers.
    ///
    /// # Errors
    /// Negative or infinite numbers, an exponent below 1 (whose stiffness has no bound), a slip speed of zero.
    pub fn check(&self) -> Result<(), BuildError> {
        if !(1.0..=4.0).contains(&self.exponent) {
            let message = format!("`exponent` must be from 1 to 4, but is {}", self.exponent);
            return Err(BuildError::at("exponent", message));
        }
        match self.damping {
            Damping::None => {}
            Damping::HuntCrossley(x) | Damping::KelvinVoigt { retardation_time: x, .. } => {
                not_negative("damping", x)?;
            }
            Damping::Approach { retardation_time, over } => {
                not_negative("damping", retardation_time)?;
                positive("damping", over)?;
            }
        }
        self.friction.map_or(Ok(()), |f| f.check())
    }

    /// Whether it is the gradient of an energy: no friction, no damping.
    pub(crate) fn conservative(&self) -> bool {
        self.damping == Damping::None && self.friction.is_none()
    }

    /// `d^p` and `d^(p-1)`
    fn powers(&self, depth: f64) -> (f64, f64) {
        let less = if self.exponent == 1.0 {
            1.0
        } else if self.exponent == 1.5 {
            depth.sqrt()
        } else {
            depth.powf(self.exponent - 1.0)
        };
        (less * depth, less)
    }

    /// The force along the normal at a positive depth [m] that grows at `rate` [m/s].
    #[inline]
    pub(crate) fn normal(&self, k: f64, depth: f64, rate: f64) -> Normal {
        let (whole, less) = self.powers(depth);
        let (elastic, stiff) = (k * whole, self.exponent * k * less);
        let released = Normal { elastic, ..Normal::default() };
        match self.damping {
            Damping::None => Normal { force: elastic, by_depth: stiff, by_rate: 0.0, elastic },
            Damping::HuntCrossley(alpha) => {
                let factor = 1.0 + 1.5 * alpha * rate;
                if factor <= 0.0 {
                    return released;
                }
                let by_rate = 1.5 * alpha * elastic;
                Normal { force: elastic * factor, by_depth: stiff * factor, by_rate, elastic }
            }
            Damping::KelvinVoigt { retardation_time: time, until } => {
                let force = elastic + k * time * rate;
                if force <= 0.0 && until == Leaving::Force {
                    return released;
                }
                Normal { force, by_depth: stiff, by_rate: k * time, elastic }
            }
            Damping::Approach { retardation_time: time, over } => {
                if !(rate > 0.0) {
                    return Normal { force: elastic, by_depth: stiff, by_rate: 0.0, elastic };
                }
                // rises as a parabola to its top
                let u = (depth / over).min(1.0);
                let (share, slope) = (u * (2.0 - u), 2.0 * (1.0 - u) / over);
                let c = k * time;
                let force = elastic + c * share * rate;
                Normal { force, by_depth: stiff + c * slope * rate, by_rate: c * share, elastic }
            }
        }
    }

    /// The energy stored at a positive depth [J].
    pub(crate) fn stored(&self, k: f64, depth: f64) -> f64 {
        k * self.powers(depth).0 * depth / (self.exponent + 1.0)
    }
}
