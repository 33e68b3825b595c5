//! `type = "eyelet"`: a point that a cable runs through.

use super::WinchSpec;
use crate::driving::driving;
use crate::pair::pair;
use crate::spherical::spherical;
use ropewalk_core::{BuildError, Feed, Model};
use ropewalk_scene::quantity::Setting;
use ropewalk_scene::{Builder, ConstraintSpec, MarkerRef, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

fn ramp() -> f64 {
    1.0
}
fn is_nought(x: &f64) -> bool {
    *x == 0.0
}
fn fade() -> f64 {
    0.1
}

/// An eyelet through which an end of a cable runs: a fixed or moving point, and what draws the cable there.
///
/// It combines a `spherical` or `driving` constraint with a `winch`. The point stays where the end starts, moves with
/// `to`, or along `path`. Give one of `speed`, `motion` and `tension`; the others are results. The constraint of the
/// point has the name of the eyelet; the winch is called `name.feed`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EyeletSpec {
    /// Name; records and events refer to it.
    pub name: String,
    /// The end of the cable: `fibre.start` or `fibre.end`.
    pub marker: MarkerRef,
    /// The marker that carries the eyelet, or a point in space. Default: the point where the end starts.
    #[serde(default)]
    pub to: Option<MarkerRef>,
    /// Name of a motion of the eyelet, starting where the end starts, instead of `to`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub path: Option<String>,
    /// Speed at which cable enters through the eyelet after the ramp [m/s]; negative draws it out of the free cable.
    #[serde(
        default,
        deserialize_with = "quantity::setting::optional::speed",
        skip_serializing_if = "Option::is_none"
    )]
    pub speed: Option<Setting>,
    /// Time at which the speed begins to rise [s].
    #[serde(default, deserialize_with = "quantity::time")]
    pub start: f64,
    /// Time in which the speed rises, and falls again at the stop [s].
    #[serde(default = "ramp", deserialize_with = "quantity::time")]
    pub ramp: f64,
    /// Time at which the speed begins to fall again [s]. Default: never.
    #[serde(default, deserialize_with = "quantity::optional::time", skip_serializing_if = "Option::is_none")]
    pub stop: Option<f64>,
    /// Name of a motion whose x component is the length that has entered, instead of `speed`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<String>,
    /// Tension with which the cable is drawn [N], instead of a speed.
    #[serde(
        default,
        deserialize_with = "quantity::setting::optional::force",
        skip_serializing_if = "Option::is_none"
    )]
    pub tension: Option<Setting>,
    /// Tension per speed squared, added to `tension` [kg/m].
    #[serde(default, deserialize_with = "quantity::setting::mass_per_length")]
    pub per_speed2: Setting,
    /// Name of a motion whose speed along x `per_speed2` refers to. Default: the speed of the cable here, which can
    /// be unstable.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference_speed: Option<String>,
    /// Linear damping, added to `tension` [N s/m].
    #[serde(default, deserialize_with = "quantity::setting::damping")]
    pub damping: Setting,
    /// What keeps a cable with torsion from turning about its own axis in the eyelet: torque over the spin of its material
    /// [N m s]. With much of it, it takes its twist along when it leaves.
    #[serde(default, deserialize_with = "quantity::rotational_damping", skip_serializing_if = "is_nought")]
    pub grip: f64,
    /// Shortest length of the free cable [m]; the run ends there. Default: as for `winch`.
    #[serde(
        default,
        deserialize_with = "quantity::optional::length",
        skip_serializing_if = "Option::is_none"
    )]
    pub shortest: Option<f64>,
    /// Length of the elements that are added and removed at the eyelet [m]. Default: all elements grow and shrink
    /// together.
    #[serde(
        default,
        deserialize_with = "quantity::optional::length",
        skip_serializing_if = "Option::is_none"
    )]
    pub element_length: Option<f64>,
    /// Fade time [s] of the strain that keeps the tension continuous when an element is added or removed.
    #[serde(default = "fade", deserialize_with = "quantity::time")]
    pub fade: f64,
}
register_spec!(Constraint, "eyelet", EyeletSpec);

impl EyeletSpec {
    /// An eyelet through which cable comes in at a speed [m/s]; a negative one draws it out.
    pub fn speed(name: &str, marker: impl Into<MarkerRef>, speed: f64) -> Self {
        EyeletSpec { speed: Some(speed.into()), ..Self::new(name, marker) }
    }
    /// An eyelet through which cable comes by a motion.
    pub fn motion(name: &str, marker: impl Into<MarkerRef>, motion: &str) -> Self {
        EyeletSpec { motion: Some(motion.into()), ..Self::new(name, marker) }
    }
    /// An eyelet at which the cable has a tension [N].
    pub fn tension(name: &str, marker: impl Into<MarkerRef>, tension: f64) -> Self {
        EyeletSpec { tension: Some(tension.into()), ..Self::new(name, marker) }
    }
    fn new(name: &str, marker: impl Into<MarkerRef>) -> Self {
        EyeletSpec {
            name: name.into(),
            marker: marker.into(),
            to: None,
            path: None,
            speed: None,
            start: 0.0,
            ramp: ramp(),
            stop: None,
            motion: None,
            tension: None,
            per_speed2: 0.0.into(),
            reference_speed: None,
            damping: 0.0.into(),
            grip: 0.0,
            shortest: None,
            element_length: None,
            fade: fade(),
        }
    }

    /// The winch that draws.
    fn winch(&self) -> WinchSpec {
        WinchSpec {
            speed: self.speed.clone(),
            start: self.start,
            ramp: self.ramp,
            stop: self.stop,
            motion: self.motion.clone(),
            tension: self.tension.clone(),
            per_speed2: self.per_speed2.clone(),
            reference_speed: self.reference_speed.clone(),
            damping: self.damping.clone(),
            grip: self.grip,
            shortest: self.shortest,
            element_length: self.element_length,
            fade: self.fade,
            ..WinchSpec::new(&format!("{}.feed", self.name), self.marker.clone())
        }
    }

    fn check(&self) -> Result<(), BuildError> {
        let given = [("speed", self.speed.is_some()), ("motion", self.motion.is_some())];
        let given: Vec<_> = given.iter().filter(|(_, is)| *is).map(|(field, _)| *field).collect();
        match (given.as_slice(), &self.tension) {
            ([], None) => {
                Err(BuildError::at("name", "an eyelet needs one of `speed`, `motion` and `tension`"))
            }
            ([_, second, ..], _) => Err(BuildError::at(*second, "give `speed` or `motion`, not both")),
            ([first], Some(_)) => Err(BuildError::at(
                "tension",
                format!(
                    "`{first}` is given, so the tension at this eyelet is a result: give one of them. With a \
                     `lift_off` at the other end, both can be given: the tension here, the speed by a `winch` there"
                ),
            )),
            ([first], None) if !self.per_speed2.is(0.0) || !self.damping.is(0.0) => Err(BuildError::at(
                if !self.damping.is(0.0) { "damping" } else { "per_speed2" },
                format!("it goes with `tension`; with `{first}` the tension is a result"),
            )),
            _ if self.to.is_some() && self.path.is_some() => Err(BuildError::at(
                "path",
                "give `to` or `path`, not both: the eyelet is on something, or moves by itself",
            )),
            _ => Ok(()),
        }
    }
}

#[typetag::serde(name = "eyelet")]
impl ConstraintSpec for EyeletSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn markers(&self) -> Vec<&MarkerRef> {
        std::iter::once(&self.marker).chain(&self.to).collect()
    }
    fn feeds(&self) -> Option<(&MarkerRef, Feed)> {
        let feed = self.winch().feeds()?.1;
        Some((&self.marker, feed))
    }
    fn notes(&self, model: &Model) -> Vec<String> {
        self.winch().notes(model)
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        self.check()?;
        let between = pair(b, &self.marker, self.to.as_ref())?;
        b.constraint(match &self.path {
            Some(path) => {
                let motion = b.motion(path).map_err(|e| e.of("path"))?;
                driving(&self.name, b.nodes(), between, motion)?
            }
            None => spherical(&self.name, b.nodes(), between)?,
        })?;
        self.winch().build(b)
    }
}
