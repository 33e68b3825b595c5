//! Lumps at regular places along a cable: clump weights, floats, sinkers.

use crate::point_mass::PointMassSpec;
use ropewalk_core::error::{not_negative, positive};
use ropewalk_core::{BuildError, V3};
use ropewalk_scene::{Builder, ElementSpec, MarkerRef, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// More lumps than any line carries.
const MOST: usize = 100_000;

/// Clump weights, floats or other compact bodies on a cable, one or many at a regular spacing. The cable has a node at each.
///
/// Each is a `point_mass` of the name of the whole with a number: `floats1`, `floats2`, …
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AttachmentsSpec {
    /// Name; the rest of the scene refers to each by it and its number, from 1.
    pub name: String,
    /// The cable that carries them, which must stand above in the scene.
    pub on: String,
    /// Unstretched length from the start of the cable to the first of them [m].
    #[serde(deserialize_with = "quantity::length")]
    pub at: f64,
    /// Unstretched length from each to the next [m].
    #[serde(default, deserialize_with = "quantity::length", skip_serializing_if = "is_nought")]
    pub spacing: f64,
    /// How many there are.
    #[serde(default = "one")]
    pub count: usize,
    /// Mass of each [kg].
    #[serde(deserialize_with = "quantity::mass")]
    pub mass: f64,
    /// Displaced volume of each, for buoyancy [m³].
    #[serde(default, deserialize_with = "quantity::volume")]
    pub volume: f64,
    /// Added mass of each in water, the same in all directions [kg].
    #[serde(default, deserialize_with = "quantity::mass")]
    pub added_mass: f64,
    /// Drag coefficient times area of each [m²].
    #[serde(default, deserialize_with = "quantity::area")]
    pub drag_area: f64,
}
register_spec!(Element, "attachments", AttachmentsSpec);

fn one() -> usize {
    1
}

fn is_nought(x: &f64) -> bool {
    *x == 0.0
}

impl AttachmentsSpec {
    /// Where they are: unstretched lengths from the start of the cable [m].
    fn places(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.count.min(MOST)).map(|k| self.at + k as f64 * self.spacing)
    }

    fn marker(&self, s: f64) -> MarkerRef {
        MarkerRef::Name(format!("{}@{s}", self.on))
    }

    fn check(&self, b: &Builder) -> Result<(), BuildError> {
        if !(1..=MOST).contains(&self.count) {
            let message = format!("`count` must be between 1 and {MOST}, not {}", self.count);
            return Err(BuildError::at("count", message));
        }
        not_negative("at", self.at)?;
        if self.count > 1 {
            positive("spacing", self.spacing)?;
        }
        let parts = b.parts(std::slice::from_ref(&self.on))?;
        let Some((_, cable)) = parts.first().filter(|(_, part)| part.line().is_some()) else {
            let message = format!("`{}` is no cable, along which there could be places", self.on);
            return Err(BuildError::at("on", message));
        };
        let (last, length) = (self.at + (self.count - 1) as f64 * self.spacing, cable.length());
        if last > length * (1.0 + 1e-9) {
            let message = format!(
                "the last of them would be at {last} m of `{}`, which is {length} m long: take fewer, or a smaller spacing",
                self.on
            );
            return Err(BuildError::at(if self.count > 1 { "count" } else { "at" }, message));
        }
        Ok(())
    }
}

#[typetag::serde(name = "attachments")]
impl ElementSpec for AttachmentsSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn pins(&self) -> Vec<MarkerRef> {
        self.places().map(|s| self.marker(s)).collect()
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        self.check(b)?;
        for (k, s) in self.places().enumerate() {
            let one = PointMassSpec {
                name: format!("{}{}", self.name, k + 1),
                marker: self.marker(s),
                mass: self.mass,
                volume: self.volume,
                added_mass: self.added_mass,
                drag_area: self.drag_area,
                velocity: V3::default(),
            };
            one.build(b).map_err(|e| match e.field.as_deref() {
                Some("marker") => e.of("at"),
                _ => e,
            })?;
        }
        Ok(())
    }
}
