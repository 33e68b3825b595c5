//! The balance of energy of a run.

use crate::model::term::{Energy, Power};

/// The balance of energy since the start of a run.
///
/// ```
/// use ropewalk_core::{Audit, Energy, Power};
/// let mut audit = Audit::start(Energy { kinetic: 0.0, potential: 10.0 });
/// // in two seconds a force brings in 3 W
/// let power = Power { supplied: 3.0, ..Power::zero() };
/// audit.add(2.0, Energy { kinetic: 6.0, potential: 10.0 }, power, power);
/// assert!(audit.imbalance().abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Audit {
    /// Kinetic energy [J].
    pub kinetic: f64,
    /// Potential energy [J].
    pub potential: f64,
    /// Work done on the model by loads and motions since the start [J].
    pub supplied: f64,
    /// Energy carried in by material since the start [J].
    pub carried: f64,
    /// Energy dissipated since the start [J].
    pub dissipated: f64,
    /// Energy that changes of the mesh have added since the start [J].
    #[cfg_attr(feature = "serde", serde(default))]
    pub remeshed: f64,
    /// Energy at the start [J].
    pub initial: f64,
    /// Largest energy or work that occurred, to compare the imbalance with [J].
    pub scale: f64,
    /// Largest sum of kinetic and potential energy without their signs: what rounding is relative to [J].
    #[cfg_attr(feature = "serde", serde(default))]
    pub size: f64,
    /// What the trapezoidal rule may have missed of all work so far [J].
    #[cfg_attr(feature = "serde", serde(default))]
    pub unsure: f64,
    /// Rate at which the power of all loads together changed in the last step [W/s].
    #[cfg_attr(feature = "serde", serde(default))]
    pub slope: f64,
}

/// Share of the second difference of power that the trapezoidal rule may miss: a twelfth where power is smooth, more where
/// its slope jumps.
const UNSURE: f64 = 0.25;
/// Imbalance, in parts of the largest energy or work so far, that is no error of an integration any more.
const CREATED: f64 = 0.1;
/// The same that makes most of what there is: from here on energy breeds energy.
const RUNAWAY: f64 = 0.5;
/// The same in parts of energies as they are, not of their changes: nothing at rest is taken for it.
const NOTHING: f64 = 1e-9;

/// Energy that has appeared from nowhere, beside all energy and work of a run so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Created {
    /// No more than an integration may be wrong by.
    None,
    /// More than that: what follows is doubtful.
    Some,
    /// Most of what there is: what follows means nothing.
    Most,
}

impl Audit {
    /// Starts at an energy.
    pub fn start(e: Energy) -> Self {
        let initial = e.kinetic + e.potential;
        Audit { kinetic: e.kinetic, potential: e.potential, initial, ..Audit::default() }
    }
    /// Goes on over a step `h` by the trapezoidal rule.
    pub fn add(&mut self, h: f64, e: Energy, before: Power, after: Power) {
        self.add_all(h, e, before, after, Power::zero());
    }
    /// The same with what the rule misses [J].
    pub(crate) fn add_all(&mut self, h: f64, e: Energy, before: Power, after: Power, missed: Power) {
        self.kinetic = e.kinetic;
        self.potential = e.potential;
        self.supplied += 0.5 * h * (before.supplied + after.supplied) + missed.supplied;
        self.carried += 0.5 * h * (before.carried + after.carried) + missed.carried;
        self.dissipated += 0.5 * h * (before.dissipated + after.dissipated) + missed.dissipated;
        let net = |p: &Power| p.supplied + p.carried - p.dissipated;
        let slope = if h > 0.0 { (net(&after) - net(&before)) / h } else { self.slope };
        self.unsure += UNSURE * h * h * (slope - self.slope).abs();
        self.slope = slope;
        self.scale = self.scale_with(e);
        for x in [self.supplied, self.dissipated, self.carried] {
            self.scale = self.scale.max(x.abs());
        }
        self.size = self.size.max(e.kinetic.abs() + e.potential.abs());
    }
    /// The largest energy or work so far, and of these energies.
    pub(crate) fn scale_with(&self, e: Energy) -> f64 {
        self.scale.max(e.kinetic.abs()).max((e.potential + e.kinetic - self.initial).abs())
    }
    /// How much energy has appeared from nowhere, beyond what may be called an error of the integration. `noise` is energy
    /// that doesn't count [J].
    pub fn created(&self, noise: f64) -> Created {
        let imbalance = self.imbalance() - self.unsure;
        // a NaN is no balance either
        match imbalance {
            x if x <= CREATED * self.scale || x <= NOTHING * self.size + noise => Created::None,
            x if x <= RUNAWAY * self.scale => Created::Some,
            _ => Created::Most,
        }
    }
    /// Whether the balance is off by so much that only the coarseness of its own integration may explain it: then it tells
    /// nothing. `noise` is energy that doesn't count [J].
    pub fn is_blind(&self, noise: f64) -> bool {
        let off = self.imbalance();
        off > RUNAWAY * self.scale
            && off > NOTHING * self.size + noise
            && self.created(noise) == Created::None
    }
    /// What the balance misses: energy gained beyond what was supplied and not dissipated [J]. Numerical damping
    /// makes it negative.
    pub fn imbalance(&self) -> f64 {
        self.kinetic + self.potential - self.initial - self.supplied - self.carried - self.remeshed
            + self.dissipated
    }
}
