//! What surrounds a scene: water, with a surface or without end, and the air above it.

use crate::current::Current;
use crate::inputs::Inputs;
use crate::sea::Sea;
use crate::waves::WavesSpec;
use ropewalk_core::error::{finite, not_negative, positive};
use ropewalk_core::{BuildError, Hold, Real, Signal, V3};
use ropewalk_quantity::{Kind, Setting, kind};
use ropewalk_sea::Waves;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The water around a scene. Drag, buoyancy and added mass need it.
///
/// ```
/// use ropewalk_scene::Water;
/// let fresh = Water { density: 1000.0, ..Water::default() };
/// assert!(fresh.check().is_ok());
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Water {
    /// Density [kg/m³].
    #[serde(deserialize_with = "ropewalk_quantity::density")]
    pub density: f64,
    /// Dynamic viscosity [Pa s].
    #[serde(deserialize_with = "ropewalk_quantity::viscosity")]
    pub viscosity: f64,
    /// Height of its surface, which is flat [m]. Default: water everywhere.
    #[serde(deserialize_with = "ropewalk_quantity::optional::length")]
    pub level: Option<f64>,
    /// Uniform velocity of the water [m/s]; inputs that it reads need `join = "hold"`.
    #[serde(deserialize_with = "ropewalk_quantity::setting::vec3::speed")]
    pub current: [Setting; 3],
    /// Current profile over height, instead of `current`: piecewise linear, constant beyond the ends.
    pub profile: Vec<Level>,
    /// Factor of the profile; an input that it reads needs `join = "hold"`.
    #[serde(deserialize_with = "ropewalk_quantity::setting::number")]
    pub profile_factor: Setting,
    /// Waves on the water, whose `level` is then the surface when it is still. Default: still water.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub waves: Option<WavesSpec>,
    /// What `current` reads, in a model that is being built.
    #[serde(skip)]
    #[doc(hidden)]
    pub bound: Option<[Signal; 3]>,
    /// What `profile_factor` reads.
    #[serde(skip)]
    #[doc(hidden)]
    pub factor: Option<Signal>,
    /// The waves, in a model that is being built.
    #[serde(skip)]
    #[doc(hidden)]
    pub sea: Option<Arc<Sea>>,
}

/// Velocity of the water, or the air, at one height.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Level {
    /// Height [m].
    #[serde(deserialize_with = "ropewalk_quantity::length")]
    pub z: f64,
    /// Velocity there [m/s].
    #[serde(deserialize_with = "ropewalk_quantity::vec3::speed")]
    pub velocity: [f64; 3],
}

impl Default for Water {
    fn default() -> Self {
        Water {
            density: 1025.0,
            viscosity: 1.08e-3,
            level: None,
            current: [0.0; 3].map(Setting::from),
            profile: Vec::new(),
            profile_factor: 1.0.into(),
            waves: None,
            bound: None,
            factor: None,
            sea: None,
        }
    }
}

impl Water {
    /// Binds the current to the inputs of a scene, and raises the waves under its gravity.
    pub(crate) fn bind(&mut self, inputs: &Inputs, gravity: V3<f64>) -> Result<(), BuildError> {
        self.sea = self.raised(gravity)?;
        self.bound = bound("current", &self.current, inputs).map_err(|e| e.of("water.current"))?;
        let factor = held("profile_factor", &self.profile_factor, inputs, &kind::NUMBER);
        self.factor = Some(factor.map_err(|e| e.of("water.profile_factor"))?);
        Ok(())
    }
    /// Its velocity as a function of height.
    ///
    /// # Errors
    /// Both `current` and `profile` are given, or the levels don't ascend.
    pub fn current(&self) -> Result<Current, BuildError> {
        velocity(
            (&self.current, &self.bound),
            (&self.profile, &self.profile_factor, &self.factor),
            "[water] has both `current` and `profile`: give one of them",
        )
    }
    /// Its waves under the gravity of a scene [m/s²], if it has some.
    ///
    /// # Errors
    /// No surface, gravity that isn't across it; what is wrong with the waves.
    pub fn raised(&self, gravity: V3<f64>) -> Result<Option<Arc<Sea>>, BuildError> {
        let Some(waves) = &self.waves else { return Ok(None) };
        let at = |field: &str, message: String| Err(BuildError::at(field, message));
        let Some(level) = self.level else {
            let message = "waves need a surface: give the water its `level`, such as `level = 0`";
            return at("water.waves", message.into());
        };
        let [x, y, g] = gravity;
        if x != 0.0 || y != 0.0 || !(g < 0.0) {
            let message =
                format!("waves need gravity that points down, along -z, and it is {gravity:?} m/s²");
            return at("gravity", message);
        }
        if waves.doppler && self.current.iter().any(|u| u.number().is_none()) {
            let message = "waves can't feel a current that an input sets: leave `doppler` out";
            return at("water.waves.doppler", message.into());
        }
        let (drift, _) = self.current()?.at(level);
        Sea::new(waves, level, -g, drift).map(|sea| Some(Arc::new(sea)))
    }
    /// Its waves under the gravity of a scene [m/s²], without a table for them.
    pub fn swell(&self, [.., g]: V3<f64>) -> Option<Waves> {
        let (drift, _) = self.current().ok()?.at(self.level?);
        self.waves.as_ref()?.waves(-g, drift).ok()
    }
    /// What one should know of its waves under the gravity of a scene [m/s²]: that they are higher than waves can be.
    pub fn steep(&self, gravity: V3<f64>) -> Option<String> {
        let waves = self.swell(gravity)?;
        let (height, most) = (waves.height(), waves.breaking_height());
        (height > most).then(|| {
            format!(
                "waves of their length break when they are {most:.3} m high (Miche), and these are {height:.3} m: linear theory \
                 says little of them"
            )
        })
    }
    /// What one should know of a run that lasts longer than its waves were measured [s]: they repeat.
    pub fn repeats(&self, duration: f64) -> Option<String> {
        let waves = self.waves.as_ref()?;
        let lasts = waves.measured.as_ref()?.lasts()?;
        (duration > lasts).then(|| {
            format!(
                "the waves were measured for {lasts} s, and the run lasts {duration} s: from then on they repeat \
                 themselves"
            )
        })
    }
    /// What is wrong with the numbers, if anything.
    pub fn check(&self) -> Result<(), BuildError> {
        positive("density", self.density).map_err(|e| e.of("water.density"))?;
        not_negative("viscosity", self.viscosity).map_err(|e| e.of("water.viscosity"))?;
        finite("level", self.level.as_slice()).map_err(|e| e.of("water.level"))?;
        finite("current", &numbers(&self.current)).map_err(|e| e.of("water.current"))?;
        self.current().map(drop).map_err(|e| e.of("water.profile"))
    }
}

/// The air above the water, or around a scene without water: only drag looks at it. Default: vacuum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Air {
    /// Density [kg/m³].
    #[serde(deserialize_with = "ropewalk_quantity::density")]
    pub density: f64,
    /// Dynamic viscosity [Pa s].
    #[serde(deserialize_with = "ropewalk_quantity::viscosity")]
    pub viscosity: f64,
    /// Velocity of the air, the same everywhere [m/s]; inputs that it reads need `join = "hold"`.
    #[serde(deserialize_with = "ropewalk_quantity::setting::vec3::speed")]
    pub wind: [Setting; 3],
    /// Velocity of the air by height, instead of `wind`: piecewise linear between the levels, constant beyond.
    pub profile: Vec<Level>,
    /// Factor of the profile; an input that it reads needs `join = "hold"`.
    #[serde(deserialize_with = "ropewalk_quantity::setting::number")]
    pub profile_factor: Setting,
    /// What `wind` reads, in a model that is being built.
    #[serde(skip)]
    #[doc(hidden)]
    pub bound: Option<[Signal; 3]>,
    /// What `profile_factor` reads.
    #[serde(skip)]
    #[doc(hidden)]
    pub factor: Option<Signal>,
}

impl Default for Air {
    /// At 15 °C and sea level, of the international standard atmosphere (ISO 2533).
    fn default() -> Self {
        Air {
            density: 1.225,
            viscosity: 1.79e-5,
            wind: [0.0; 3].map(Setting::from),
            profile: Vec::new(),
            profile_factor: 1.0.into(),
            bound: None,
            factor: None,
        }
    }
}

impl Air {
    /// Binds the wind to the inputs of a scene.
    pub(crate) fn bind(&mut self, inputs: &Inputs) -> Result<(), BuildError> {
        self.bound = bound("wind", &self.wind, inputs).map_err(|e| e.of("air.wind"))?;
        let factor = held("profile_factor", &self.profile_factor, inputs, &kind::NUMBER);
        self.factor = Some(factor.map_err(|e| e.of("air.profile_factor"))?);
        Ok(())
    }
    /// Its velocity as a function of height.
    ///
    /// # Errors
    /// Both `wind` and `profile` are given, or the levels don't ascend.
    pub fn wind(&self) -> Result<Current, BuildError> {
        velocity(
            (&self.wind, &self.bound),
            (&self.profile, &self.profile_factor, &self.factor),
            "[air] has both `wind` and `profile`: give one of them",
        )
    }
    /// What is wrong with the numbers, if anything; or with air where there is water everywhere.
    pub fn check(&self, water: Option<&Water>) -> Result<(), BuildError> {
        positive("density", self.density).map_err(|e| e.of("air.density"))?;
        not_negative("viscosity", self.viscosity).map_err(|e| e.of("air.viscosity"))?;
        finite("wind", &numbers(&self.wind)).map_err(|e| e.of("air.wind"))?;
        self.wind().map(drop).map_err(|e| e.of("air.profile"))?;
        if water.is_some_and(|w| w.level.is_none()) {
            let message =
                "there is water everywhere, and so no air: give the surface of the water its `level`";
            return Err(BuildError::at("water", message));
        }
        Ok(())
    }
}

fn numbers(velocity: &[Setting; 3]) -> [f64; 3] {
    velocity.each_ref().map(|u| u.number().unwrap_or(0.0))
}

/// What a velocity reads; nothing if it is constant.
fn bound(field: &str, u: &[Setting; 3], inputs: &Inputs) -> Result<Option<[Signal; 3]>, BuildError> {
    if u.iter().all(|u| u.number().is_some()) {
        return Ok(None);
    }
    let mut all = [0.0; 3].map(Signal::from);
    for (to, u) in all.iter_mut().zip(u) {
        *to = held(field, u, inputs, &kind::SPEED)?;
    }
    Ok(Some(all))
}

/// What a number reads, which only changes between steps.
fn held(field: &str, u: &Setting, inputs: &Inputs, kind: &Kind) -> Result<Signal, BuildError> {
    let signal = inputs.signal(field, u, kind)?;
    match &signal {
        Signal::Input(input) if input.join() != Hold::Hold => {
            let message = format!(
                "water and air change between steps: give the input `{}` `join = \"hold\"`",
                input.name()
            );
            Err(BuildError::at(field, message))
        }
        _ => Ok(signal),
    }
}

fn velocity(
    (settings, bound): (&[Setting; 3], &Option<[Signal; 3]>),
    (profile, given, factor): (&[Level], &Setting, &Option<Signal>),
    both: &str,
) -> Result<Current, BuildError> {
    let driven = settings.iter().any(|u| u.number().is_none());
    let uniform = &numbers(settings);
    if profile.is_empty() && !given.is(1.0) {
        return Err(BuildError::new("`profile_factor` is the factor of a `profile`, and there is none"));
    }
    if profile.is_empty() && driven {
        // before a model is built there is nothing to read
        return Ok(bound.clone().map_or(Current::Still, |signals| Current::Driven(Box::new(signals))));
    }
    if profile.is_empty() {
        let still = *uniform == [0.0; 3];
        return Ok(if still { Current::Still } else { Current::Uniform(*uniform) });
    }
    if driven || *uniform != [0.0; 3] {
        return Err(BuildError::new(both));
    }
    let (z, velocity) = profile.iter().map(|l| (l.z, l.velocity)).unzip();
    // before a model is built there is nothing to read
    let factor = factor.clone().unwrap_or(given.number().unwrap_or(0.0).into());
    let current = Current::Profile { z, velocity, factor };
    current.check().map(|()| current)
}

/// Share of a ball's volume that lies below a level, `½ + ¾ u - ¼ u³` at the depth `u` radii of its middle, and what it changes
/// by with the height `z` of that [1/m].
///
/// ```
/// use ropewalk_scene::ball_below;
/// // a ball whose middle is at the surface is half under water
/// assert_eq!(ball_below(0.0, 0.0_f64, 1.0).0, 0.5);
/// ```
#[inline(always)]
pub fn ball_below<R: Real>(level: f64, z: R, radius: f64) -> (R, R) {
    let (one, u) = (R::of(1.0), (R::of(level) - z) * R::of(1.0 / radius));
    let u = u.if_gt(one, one, u.if_gt(-one, u, -one));
    let share = u.fma(u * u * R::of(-0.25), u.fma(R::of(0.75), R::of(0.5)));
    (share, (u * u - one) * R::of(0.75 / radius))
}
