//! What a scene says about constraints.

use crate::{Clamp, Coordinate, Distance, Driving, Spherical};
use ropewalk_core::build::{BuildError, Builder, finite};
use ropewalk_core::{ConstraintSpec, Marker, MarkerRef, V3, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Holds two points together: of two parts, or of a part and space. Leaves every rotation free.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SphericalSpec {
    /// Name, by which records ask for its reaction.
    pub name: String,
    /// The marker that is held.
    pub marker: MarkerRef,
    /// What holds it: another marker or a point in space; left out, the point where the marker starts.
    #[serde(default)]
    pub to: Option<MarkerRef>,
}
register_spec!(Constraint, "spherical", SphericalSpec);

impl SphericalSpec {
    /// Holds a marker to another or to a point in space.
    pub fn new(name: &str, marker: impl Into<MarkerRef>, to: impl Into<MarkerRef>) -> Self {
        SphericalSpec { name: name.into(), marker: marker.into(), to: Some(to.into()) }
    }
    /// Holds a marker where it starts.
    pub fn pin(name: &str, marker: impl Into<MarkerRef>) -> Self {
        SphericalSpec { name: name.into(), marker: marker.into(), to: None }
    }
}

#[typetag::serde(name = "spherical")]
impl ConstraintSpec for SphericalSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn markers(&self) -> Vec<&MarkerRef> {
        std::iter::once(&self.marker).chain(&self.to).collect()
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let marker = b.marker("marker", &self.marker)?;
        let to = match &self.to {
            Some(to) => b.marker("to", to)?,
            None => Marker::ground(b.place(&marker).x),
        };
        let joint = Spherical::joint(&self.name, b.nodes(), [marker, to])?;
        b.constraint(joint)
    }
}

/// Keeps two points at a constant distance: a rod without mass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DistanceSpec {
    /// Name, by which records ask for its reaction.
    pub name: String,
    /// One marker.
    pub marker: MarkerRef,
    /// The other marker, or a point in space.
    pub to: MarkerRef,
    /// Distance [m]; left out, that at the start.
    #[serde(default, deserialize_with = "quantity::optional::length")]
    pub length: Option<f64>,
}
register_spec!(Constraint, "distance", DistanceSpec);

#[typetag::serde(name = "distance")]
impl ConstraintSpec for DistanceSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn markers(&self) -> Vec<&MarkerRef> {
        vec![&self.marker, &self.to]
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let (marker, to) = (b.marker("marker", &self.marker)?, b.marker("to", &self.to)?);
        let (a, c) = (b.place(&marker).x, b.place(&to).x);
        let start = (0..3).map(|i| (c[i] - a[i]).powi(2)).sum::<f64>().sqrt();
        let joint = Distance::joint(&self.name, b.nodes(), [marker, to], self.length.unwrap_or(start))?;
        b.constraint(joint)
    }
}

/// Holds the direction of a cable at a marker; its stretch stays free. With `spherical` a clamp.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ClampSpec {
    /// Name, by which records ask for its reaction.
    pub name: String,
    /// The marker on a cable.
    pub marker: MarkerRef,
    /// The direction; left out, that at the start.
    #[serde(default)]
    pub direction: Option<V3<f64>>,
}
register_spec!(Constraint, "clamp", ClampSpec);

impl ClampSpec {
    /// Holds the direction that a cable has at the start.
    pub fn new(name: &str, marker: impl Into<MarkerRef>) -> Self {
        ClampSpec { name: name.into(), marker: marker.into(), direction: None }
    }
}

#[typetag::serde(name = "clamp")]
impl ConstraintSpec for ClampSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn markers(&self) -> Vec<&MarkerRef> {
        vec![&self.marker]
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let marker = b.marker("marker", &self.marker)?;
        let Some(node) = marker.on() else {
            return Err(BuildError::at("marker", "a clamp holds a cable, not a point in space"));
        };
        let direction = self.direction.unwrap_or(b.place(&marker).direction);
        finite("direction", &direction)?;
        let joint = Clamp::joint(&self.name, b.nodes(), node, direction)?;
        b.constraint(joint)
    }
}

/// Makes a marker follow a prescribed motion from where it starts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DrivingSpec {
    /// Name, by which records ask for its reaction.
    pub name: String,
    /// The marker that is driven.
    pub marker: MarkerRef,
    /// Name of the motion.
    pub motion: String,
}
register_spec!(Constraint, "driving", DrivingSpec);

impl DrivingSpec {
    /// Makes a marker follow a motion.
    pub fn new(name: &str, marker: impl Into<MarkerRef>, motion: &str) -> Self {
        DrivingSpec { name: name.into(), marker: marker.into(), motion: motion.into() }
    }
}

#[typetag::serde(name = "driving")]
impl ConstraintSpec for DrivingSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn markers(&self) -> Vec<&MarkerRef> {
        vec![&self.marker]
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let marker = b.marker("marker", &self.marker)?;
        let (start, motion) = (b.place(&marker).x, b.motion(&self.motion)?);
        let joint = Driving::joint(&self.name, b.nodes(), marker, start, motion)?;
        b.constraint(joint)
    }
}

/// Holds or drives one coordinate of a marker, along a direction, and leaves the other two free.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CoordinateSpec {
    /// Name, by which records ask for its reaction.
    pub name: String,
    /// The marker.
    pub marker: MarkerRef,
    /// The direction of the coordinate.
    pub direction: V3<f64>,
    /// Name of a motion, of which the part along the direction is followed; left out, the coordinate stays.
    #[serde(default)]
    pub motion: Option<String>,
}
register_spec!(Constraint, "coordinate", CoordinateSpec);

#[typetag::serde(name = "coordinate")]
impl ConstraintSpec for CoordinateSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn markers(&self) -> Vec<&MarkerRef> {
        vec![&self.marker]
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let marker = b.marker("marker", &self.marker)?;
        let start = b.place(&marker).x;
        let motion = self.motion.as_deref().map(|m| b.motion(m)).transpose()?;
        let joint = Coordinate::joint(&self.name, b.nodes(), marker, self.direction, start, motion)?;
        b.constraint(joint)
    }
}
