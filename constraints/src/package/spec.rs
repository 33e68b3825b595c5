//! What a scene says about a package.

use super::Package;
use crate::check::unit;
use ropewalk_core::error::{finite, not_negative, positive};
use ropewalk_core::{BuildError, V3, dot};
use ropewalk_scene::quantity;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// From which side of its package a cable lifts off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// From the inside, towards the axis: every layer is wider than the one before.
    #[default]
    Inner,
    /// From the outside, like thread from a bobbin: every layer is narrower than the one before.
    Outer,
}

/// Which way the lift-off point runs round the axis while the cable unwinds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Hand {
    /// Round the axis as the fingers of the right hand, with the thumb along the axis.
    #[default]
    Right,
    /// The other way round.
    Left,
}

/// Which way along the axis the first layer unwinds; the next one goes back, and so on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Traverse {
    /// Along the axis.
    #[default]
    Forward,
    /// Against the axis.
    Backward,
}

fn up() -> V3<f64> {
    [0.0, 0.0, 1.0]
}
fn one() -> usize {
    1
}

/// More layers than any package has.
const MOST_LAYERS: usize = 10_000;

/// A package of cable, wound in layers: inside a hollow cylinder, as in the dispenser of a vehicle, or on a spool.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PackageSpec {
    /// Origin of its axis: the centre of one end [m].
    #[serde(default, deserialize_with = "quantity::vec3::length")]
    pub origin: V3<f64>,
    /// Direction of its axis, from the origin to the other end.
    #[serde(default = "up")]
    pub axis: V3<f64>,
    /// Direction from the axis to the first lift-off point. Default: x, or y if the axis is along x.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference: Option<V3<f64>>,
    /// Side of the package from which the cable lifts off.
    #[serde(default)]
    pub side: Side,
    /// Radius of the first layer to unwind, to the middle of the cable [m].
    #[serde(deserialize_with = "quantity::length")]
    pub radius: f64,
    /// Distance along the axis per turn [m]. Default: the diameter of the cable, turns side by side.
    #[serde(default, deserialize_with = "quantity::optional::length")]
    pub pitch: Option<f64>,
    /// Wound length along the axis, the same for all layers [m].
    #[serde(deserialize_with = "quantity::length")]
    pub length: f64,
    /// Number of layers.
    #[serde(default = "one")]
    pub layers: usize,
    /// Diameter of the cable [m]; the radius changes by it from layer to layer.
    #[serde(deserialize_with = "quantity::length")]
    pub diameter: f64,
    /// Sense in which the lift-off point runs round the axis.
    #[serde(default)]
    pub hand: Hand,
    /// Direction along the axis in which the first layer unwinds.
    #[serde(default)]
    pub traverse: Traverse,
    /// Position of the first lift-off point along the axis, from its origin [m]. Default: the end where a full first
    /// layer begins.
    #[serde(default, deserialize_with = "quantity::optional::length")]
    pub first: Option<f64>,
    /// Minimum bend radius of the cable [m]; below it the run reports an event. Default: no limit.
    #[serde(default, deserialize_with = "quantity::optional::length")]
    pub min_bend_radius: Option<f64>,
}

impl PackageSpec {
    /// One full layer in the usual directions: inside, axis up from the origin, right hand, forward.
    pub fn new(radius: f64, length: f64, diameter: f64) -> Self {
        PackageSpec {
            origin: [0.0; 3],
            axis: up(),
            reference: None,
            side: Side::Inner,
            radius,
            pitch: None,
            length,
            layers: 1,
            diameter,
            hand: Hand::Right,
            traverse: Traverse::Forward,
            first: None,
            min_bend_radius: None,
        }
    }

    /// Makes the package.
    ///
    /// # Errors
    /// See [`PackageSpec::check`].
    pub fn build(&self) -> Result<Package, BuildError> {
        Package::new(self)
    }

    /// Way along the axis per turn [m].
    pub fn pitch(&self) -> f64 {
        self.pitch.unwrap_or(self.diameter)
    }

    /// Where along the axis the first lift-off point lies [m].
    pub fn first(&self) -> f64 {
        let start = if self.traverse == Traverse::Forward { 0.0 } else { self.length };
        self.first.unwrap_or(start)
    }

    /// How far the radius of every layer is from that of the layer before [m].
    pub fn growth(&self) -> f64 {
        if self.side == Side::Inner { self.diameter } else { -self.diameter }
    }

    /// Radius of the narrowest layer [m].
    pub fn narrowest(&self) -> f64 {
        self.radius + (self.growth() * (self.layers.max(1) - 1) as f64).min(0.0)
    }

    /// Whether cable can be wound like this.
    ///
    /// # Errors
    /// A length that isn't above zero, no layer, a pitch below the diameter, less than a turn per layer, a layer that
    /// is narrower than the bend limit or closes up, a first lift-off point outside of the package or where the first
    /// layer ends, directions without length.
    pub fn check(&self) -> Result<(), BuildError> {
        finite("origin", &self.origin)?;
        let axis = unit("axis", self.axis)?;
        if let Some(reference) = self.reference {
            let along = dot(&unit("reference", reference)?, &axis);
            if !(along.abs() < 1.0 - 1e-9) {
                let message = "`reference` points along the axis; give a direction across it";
                return Err(BuildError::at("reference", message));
            }
        }
        for (field, x) in [("radius", self.radius), ("diameter", self.diameter), ("length", self.length)] {
            positive(field, x)?;
        }
        let (d, pitch) = (self.diameter, positive("pitch", self.pitch())?);
        if pitch < d * (1.0 - 1e-12) {
            let message =
                format!("a `pitch` of {pitch} m is below the diameter of the cable: give {d} m at least");
            return Err(BuildError::at("pitch", message));
        }
        if self.length < pitch {
            let message = format!("a `length` of {} m is less than one turn of {pitch} m", self.length);
            return Err(BuildError::at("length", message));
        }
        if self.layers == 0 {
            return Err(BuildError::at("layers", "a package without layers holds no cable: give 1 at least"));
        }
        if self.layers > MOST_LAYERS {
            let message = format!("a package has at most {MOST_LAYERS} layers, not {}", self.layers);
            return Err(BuildError::at("layers", message));
        }
        self.check_radii()?;
        let (first, length) = (self.first(), self.length);
        if !(first >= 0.0 && first <= length) {
            let message = format!("`first` must be within the package, from 0 to {length} m, but is {first}");
            return Err(BuildError::at("first", message));
        }
        let way = if self.traverse == Traverse::Forward { length - first } else { first };
        if !(way >= 0.5 * pitch) {
            let message = "`first` leaves less than half a turn in the first layer: turn `traverse` round, or \
                           start with the next layer";
            return Err(BuildError::at("first", message));
        }
        Ok(())
    }

    fn check_radii(&self) -> Result<(), BuildError> {
        let narrowest = self.narrowest();
        let where_ = if self.layers > 1 && self.side == Side::Outer {
            format!("the innermost of {} layers has a radius of {narrowest} m", self.layers)
        } else {
            format!("the first layer has a radius of {narrowest} m")
        };
        if narrowest < 0.5 * self.diameter {
            let message = format!("{where_}, less than that of the cable: give fewer `layers`");
            return Err(BuildError::at(if self.layers > 1 { "layers" } else { "radius" }, message));
        }
        match self.min_bend_radius {
            Some(limit) if not_negative("min_bend_radius", limit)? > narrowest => {
                let message = format!("{where_}, but the cable may not be bent below {limit} m");
                Err(BuildError::at("radius", message))
            }
            _ => Ok(()),
        }
    }
}
