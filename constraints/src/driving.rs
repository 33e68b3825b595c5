//! Points, lengths and angles that follow a prescribed motion.

use crate::pair::{aligned, along, pair};
use ropewalk_core::rotation::IDENTITY;
use ropewalk_core::{Arrow, BuildError, Equation, Joint, Marker, Motion, Node, V3};
use ropewalk_scene::{Builder, ConstraintSpec, MarkerRef, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A marker follows a motion in space, from where another one is: `x_1 - x_0 - X(t) = 0`, three equations, defined for
/// as long as the motion.
///
/// Use it for: the end of a hose on a moving ship, a vehicle's path. The reaction is what it takes to drive it.
///
/// # Errors
/// As for [`spherical`](crate::spherical).
pub fn driving(
    name: impl Into<String>,
    nodes: &[Node],
    between: [Marker; 2],
    motion: Arc<dyn Motion>,
) -> Result<Joint, BuildError> {
    let equations = IDENTITY.map(|d| Equation::coordinate(d, Some(motion.clone()))).to_vec();
    Joint::new(name, nodes, between, equations)
}

/// The second marker lies ahead of the first, along the first one's third axis, by `c + X(t)`: one equation.
///
/// `X` is the motion's first component [m]. Use it for: a hydraulic cylinder, a winch's carriage. With a
/// [`prismatic`](crate::prismatic) joint nothing is left free.
///
/// # Errors
/// As for [`spherical`](crate::spherical); a first marker without axes.
pub fn slide(
    name: impl Into<String>,
    nodes: &[Node],
    between: [Marker; 2],
    start: f64,
    motion: Arc<dyn Motion>,
) -> Result<Joint, BuildError> {
    let a = Arrow::Axis { of: 0, axis: 2 };
    let equation = Equation::Dot { a, b: Arrow::Between, value: start, motion: Some(motion) };
    Joint::new(name, nodes, between, vec![equation])
}

/// The second marker is turned against the first, about their common third axis, by the angle `φ(t)`: one equation,
/// regular at every angle.
///
/// `φ` is the motion's first component [rad]. It is meant beside a [`revolute`](crate::revolute) joint; the
/// multiplier is the driving torque.
///
/// # Errors
/// As for [`spherical`](crate::spherical); markers without axes.
pub fn rotation(
    name: impl Into<String>,
    nodes: &[Node],
    between: [Marker; 2],
    angle: Arc<dyn Motion>,
) -> Result<Joint, BuildError> {
    let (a, b) = (Arrow::Turned { of: 0, angle }, Arrow::Axis { of: 1, axis: 0 });
    Joint::new(name, nodes, between, vec![Equation::Dot { a, b, value: 0.0, motion: None }])
}

/// Moves a marker along a prescribed motion, starting at its initial position.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DrivingSpec {
    /// Name; records of the reaction refer to it.
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
        let (markers, motion) = (pair(b, &self.marker, None)?, b.motion(&self.motion)?);
        b.constraint(driving(&self.name, b.nodes(), markers, motion)?)
    }
}

/// Drives the displacement of a marker along an axis of another.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SlideSpec {
    /// Name; records of the reaction refer to it.
    pub name: String,
    /// The marker that is driven.
    pub marker: MarkerRef,
    /// The other marker. Default: the point where `marker` starts.
    #[serde(default)]
    pub to: Option<MarkerRef>,
    /// Direction of the axis in space at the start. The axis turns with `to`.
    pub axis: V3<f64>,
    /// Name of the motion, whose x component is the displacement along the axis.
    pub motion: String,
}
register_spec!(Constraint, "slide", SlideSpec);

#[typetag::serde(name = "slide")]
impl ConstraintSpec for SlideSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn markers(&self) -> Vec<&MarkerRef> {
        std::iter::once(&self.marker).chain(&self.to).collect()
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let (markers, motion) = (pair(b, &self.marker, self.to.as_ref())?, b.motion(&self.motion)?);
        let axes = along("axis", self.axis)?;
        let [x, y] = markers.map(|m| b.place(&m).x);
        let start = (0..3).map(|i| axes[2][i] * (y[i] - x[i])).sum();
        let markers = aligned(b, markers, axes);
        b.constraint(slide(&self.name, b.nodes(), markers, start, motion)?)
    }
}

/// Drives the angle between two parts about a common axis. Use it together with a `revolute` joint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RotationSpec {
    /// Name; records of the reaction refer to it.
    pub name: String,
    /// The marker that is driven, on a rigid body or a cable.
    pub marker: MarkerRef,
    /// The other marker, on a rigid body. Default: space.
    #[serde(default)]
    pub to: Option<MarkerRef>,
    /// Direction of the axis in space at the start.
    pub axis: V3<f64>,
    /// Name of the motion, whose x component is the angle [rad].
    pub motion: String,
}
register_spec!(Constraint, "rotation", RotationSpec);

#[typetag::serde(name = "rotation")]
impl ConstraintSpec for RotationSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn markers(&self) -> Vec<&MarkerRef> {
        std::iter::once(&self.marker).chain(&self.to).collect()
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let (markers, motion) = (pair(b, &self.marker, self.to.as_ref())?, b.motion(&self.motion)?);
        let markers = aligned(b, markers, turned_axes(b, &markers[1], self.axis)?);
        b.constraint(rotation(&self.name, b.nodes(), markers, motion)?)
    }
}

/// Axes about a direction; the first is the slope of a cable, so that a cable can be turned.
fn turned_axes(b: &Builder, driven: &Marker, axis: V3<f64>) -> Result<[V3<f64>; 3], BuildError> {
    let axes = along("axis", axis)?;
    let Some(slope) = crate::pair::slope(b, driven).filter(|_| crate::pair::on_cable(b, driven)) else {
        return Ok(axes);
    };
    let along_axis: f64 = (0..3).map(|i| slope[i] * axes[2][i]).sum();
    let across: V3<f64> = std::array::from_fn(|i| slope[i] - along_axis * axes[2][i]);
    let first = crate::check::unit("axis", across).map_err(|_| {
        BuildError::at(
            "axis",
            "the cable lies along the axis and can't be turned about it: it has no torsion, `section.gj`",
        )
    })?;
    Ok([first, ropewalk_core::rotation::cross(&axes[2], &first), axes[2]])
}
