//! The direction of a cable held fast.

use crate::check::unit;

use ropewalk_core::error::{finite, need};
use ropewalk_core::rotation::{M3, around, cross};
use ropewalk_core::{BuildError, Equation, Joint, Marker, Node, NodeId, NodeKind, V3};
use ropewalk_scene::{Builder, ConstraintSpec, MarkerRef, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The slope `r'` of a cable node stays along the third axis of a marker, in space or on a rigid body: it is normal to
/// the first two, two equations.
///
/// The stretch `|r'|` stays free, as the tension there asks for it. The position is not held: add a
/// [`spherical`](crate::spherical). `r'` and `-r'` both satisfy the equations; the start decides which it is.
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
    let kind = nodes.get(node.0 as usize).map(|n| n.kind);
    need(kind == Some(NodeKind::Slope), || {
        format!("{name}: `direction` holds the slope of a cable node, which node {} doesn't have", node.0)
    })?;
    let equations = vec![Equation::normal(0, 0), Equation::normal(1, 0)];
    Joint::new(name, nodes, [to, Marker::node(node)], equations)
}

/// Holds the direction of a cable at a marker, in space or on a rigid body. Position and stretch stay free.
///
/// Use it for a guide that a cable slides through, or beside a constraint that drives the position. To hold the position
/// as well, use `clamp`. A cable with a curved stress-free shape can't twist there either.
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
}
register_spec!(Constraint, "direction", DirectionSpec);

impl DirectionSpec {
    /// Holds the direction that a cable has at the start.
    pub fn new(name: &str, marker: impl Into<MarkerRef>) -> Self {
        DirectionSpec { name: name.into(), marker: marker.into(), to: None, direction: None }
    }
}

/// The tangent of a cable at a marker, and what turns about it.
pub(crate) struct Tangent {
    /// Axes in space at the start, the third along the cable.
    pub axes: M3,
    /// The node that knows how the cable is turned about its axis, if one does.
    director: Option<NodeId>,
}

impl Tangent {
    /// The tangent that a cable has at the start, or the given one.
    pub(crate) fn new(b: &Builder, marker: &Marker, given: Option<V3<f64>>) -> Result<Self, BuildError> {
        let direction = given.unwrap_or(b.place(marker).axes[0]);
        finite("direction", &direction)?;
        let direction = unit("direction", direction)?;
        let parts = b.parts(&[])?;
        let director =
            marker.on().and_then(|node| parts.iter().find_map(|(_, part)| part.line()?.director(node)));
        let axes = match director.map(|d| b.place(&Marker::node(d)).x) {
            None => around(direction),
            Some(d) => {
                let across = unit("direction", cross(&direction, &d))?;
                [cross(&across, &direction), across, direction]
            }
        };
        Ok(Tangent { axes, director })
    }

    /// Keeps a cable with a curved stress-free shape from turning about its axis; `to` has the axes of the tangent.
    pub(crate) fn hold_twist(&self, b: &mut Builder, name: &str, to: Marker) -> Result<(), BuildError> {
        let Some(director) = self.director else { return Ok(()) };
        let equations = vec![Equation::normal(1, 0)];
        let held = Joint::new(format!("{name}.twist"), b.nodes(), [to, Marker::node(director)], equations)?;
        b.constraint(held)
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
        tangent.hold_twist(b, &self.name, to)?;
        b.constraint(direction(&self.name, b.nodes(), node, to)?)
    }
}
