//! The direction of a cable held fast.

use crate::check::unit;
use crate::pair::{kind, slope, untwisted};
use ropewalk_core::error::{finite, need};
use ropewalk_core::model::twist;
use ropewalk_core::rotation::{M3, around, cross};
use ropewalk_core::{Arrow, BuildError, Equation, Joint, Marker, Node, NodeId, NodeKind, V3};
use ropewalk_scene::{Builder, ConstraintSpec, MarkerRef, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The slope `r'` of a cable node stays along the third axis of a marker, in space or on a rigid body: it is normal to
/// the first two, two equations.
///
/// The stretch `|r'|` stays free, as the tension there asks for it, and so does the spin of a cable with torsion. The
/// position is not held: add a [`spherical`](crate::spherical). `r'` and `-r'` both satisfy the equations; the start decides
/// which it is.
///
/// # Errors
/// A node without slope; a marker without axes.
pub fn direction(
    name: impl Into<String>,
    nodes: &[Node],
    node: NodeId,
    to: Marker,
) -> Result<Joint, BuildError> {
    let name = name.into();
    let slope = nodes.get(node.0 as usize).is_some_and(|n| n.kind.has_slope());
    need(slope, || {
        format!("{name}: `direction` holds the slope of a cable node, which node {} doesn't have", node.0)
    })?;
    Joint::new(name, nodes, [to, Marker::node(node)], held(1, false))
}

/// The slope of a cable, the second marker or the first, along the third axis of the other marker; with `twist` its first
/// director along the first.
pub(crate) fn held(cable: usize, twist: bool) -> Vec<Equation> {
    let mut equations = vec![Equation::beside(0, cable), Equation::beside(1, cable)];
    if twist {
        let (a, b) = (Arrow::Axis { of: 1 - cable, axis: 1 }, Arrow::Axis { of: cable, axis: 0 });
        equations.push(Equation::Dot { a, b, value: 0.0, motion: None });
    }
    equations
}

/// Holds the direction of a cable at a marker, in space or on a rigid body. Position and stretch stay free.
///
/// Use it for a guide that a cable slides through, or beside a constraint that drives the position. To hold the position
/// as well, use `clamp`. A cable with torsion can't twist there either, unless `twist` is `false`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DirectionSpec {
    /// Name; records of the reaction refer to it.
    pub name: String,
    /// The marker on the cable.
    pub marker: MarkerRef,
    /// The rigid body that holds the direction. Default: space.
    #[serde(default)]
    pub to: Option<MarkerRef>,
    /// The direction in space at the start. Default: the direction in which the cable is laid.
    #[serde(default)]
    pub direction: Option<V3<f64>>,
    /// Whether a cable with torsion (`section.gj`) is kept from turning about its own axis. Default: it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub twist: Option<bool>,
}
register_spec!(Constraint, "direction", DirectionSpec);

impl DirectionSpec {
    /// Holds the direction that a cable has at the start.
    pub fn new(name: &str, marker: impl Into<MarkerRef>) -> Self {
        DirectionSpec { name: name.into(), marker: marker.into(), to: None, direction: None, twist: None }
    }
}

/// The tangent of a cable at a marker.
pub(crate) struct Tangent {
    /// Axes in space at the start, the third along the cable; of one with torsion those of its section.
    pub axes: M3,
}

impl Tangent {
    /// The tangent that a cable has at the start, or the given one.
    pub(crate) fn new(b: &Builder, marker: &Marker, given: Option<V3<f64>>) -> Result<Self, BuildError> {
        let Some(laid) = slope(b, marker) else {
            return Err(BuildError::at("marker", "a direction can only be held on a cable"));
        };
        let direction = given.unwrap_or(laid);
        finite("direction", &direction)?;
        let direction = unit("direction", direction)?;
        if kind(b, marker) != Some(NodeKind::Twist) {
            return Ok(Tangent { axes: around(direction) });
        }
        let [d, _, t] = b.place(marker).axes;
        let cosine: f64 = (0..3).map(|i| t[i] * direction[i]).sum();
        if cosine < -0.9 {
            let message = "it is turned round against the cable as it is laid: lay it the other way";
            return Err(BuildError::at("direction", message));
        }
        let d = twist::across(&twist::carried(&d, &t, &direction), &direction);
        Ok(Tangent { axes: [d, cross(&direction, &d), direction] })
    }
}

#[typetag::serde(name = "direction")]
impl ConstraintSpec for DirectionSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn markers(&self) -> Vec<&MarkerRef> {
        std::iter::once(&self.marker).chain(&self.to).collect()
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let marker = b.marker("marker", &self.marker)?;
        let Some(node) = marker.on() else {
            return Err(BuildError::at("marker", "`direction` holds a cable, not a point in space"));
        };
        let tangent = Tangent::new(b, &marker, self.direction)?;
        let to = match &self.to {
            Some(to) => b.marker("to", to)?,
            None => Marker::ground([0.0; 3]),
        };
        let to = to.with_axes(b.nodes(), b.coordinates(), tangent.axes);
        if kind(b, &marker) == Some(NodeKind::Twist) && self.twist.unwrap_or(true) {
            return b.constraint(Joint::new(&self.name, b.nodes(), [to, marker], held(1, true))?);
        }
        if kind(b, &marker) != Some(NodeKind::Twist) {
            untwisted(self.twist)?;
        }
        b.constraint(direction(&self.name, b.nodes(), node, to)?)
    }
}
