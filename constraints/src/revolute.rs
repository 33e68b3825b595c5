//! A hinge.

use crate::pair::{aligned, along, pair};
use ropewalk_core::{BuildError, Equation, Joint, Marker, Node, NodeKind, V3};
use ropewalk_scene::{Builder, ConstraintSpec, MarkerRef, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Two markers are at the same point and share their third axis: a hinge, five equations. At a cable's end, which has
/// no twist, the slope stays normal to the axis: 3 + 1 equations.
///
/// Use it for: cranks, doors, the hinge of a connection part.
///
/// # Errors
/// As for [`spherical`](crate::spherical); a marker without axes.
pub fn revolute(name: impl Into<String>, nodes: &[Node], between: [Marker; 2]) -> Result<Joint, BuildError> {
    let mut equations = Equation::coincide();
    let on_cable =
        |m: &Marker| m.on().is_some_and(|n| nodes.get(n.0 as usize).map(|n| n.kind) == Some(NodeKind::Slope));
    equations.extend(match [on_cable(&between[0]), on_cable(&between[1])] {
        [true, _] => vec![Equation::normal(0, 2)],
        [_, true] => vec![Equation::normal(2, 0)],
        _ => vec![Equation::normal(2, 0), Equation::normal(2, 1)],
    });
    Joint::new(name, nodes, between, equations)
}

/// A hinge: holds two points together; only the rotation about an axis is free. The end of a cable swings in the
/// plane normal to the axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RevoluteSpec {
    /// Name; records of the reaction refer to it.
    pub name: String,
    /// The marker that is held.
    pub marker: MarkerRef,
    /// The other marker, or a point in space. Default: the point where `marker` starts.
    #[serde(default)]
    pub to: Option<MarkerRef>,
    /// Direction of the axis in space at the start. The axis turns with the parts.
    pub axis: V3<f64>,
}
register_spec!(Constraint, "revolute", RevoluteSpec);

#[typetag::serde(name = "revolute")]
impl ConstraintSpec for RevoluteSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn markers(&self) -> Vec<&MarkerRef> {
        std::iter::once(&self.marker).chain(&self.to).collect()
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let markers = pair(b, &self.marker, self.to.as_ref())?;
        let markers = aligned(b, markers, along("axis", self.axis)?);
        b.constraint(revolute(&self.name, b.nodes(), markers)?)
    }
}
