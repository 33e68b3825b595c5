//! A hinge.

use crate::axis::along_an_axis;
use ropewalk_core::{BuildError, Equation, Joint, Marker, Node, NodeKind};

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

along_an_axis! {
    /// A hinge: holds two points together; only the rotation about an axis is free. The end of a cable swings in the
    /// plane normal to the axis.
    "revolute" => RevoluteSpec, revolute;
    "Direction of the axis in space at the start. The axis turns with the parts."
}
