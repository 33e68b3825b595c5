//! Slides along an axis.

use crate::axis::along_an_axis;
use ropewalk_core::{BuildError, Equation, Joint, Marker, Node};

/// The second marker slides along the third axis of the first and doesn't turn: five equations.
///
/// Use it for: sliders, telescopes, hydraulic cylinders.
///
/// # Errors
/// As for [`spherical`](crate::spherical); a marker that isn't on a rigid body or on the ground.
pub fn prismatic(name: impl Into<String>, nodes: &[Node], between: [Marker; 2]) -> Result<Joint, BuildError> {
    let mut equations = vec![Equation::in_plane(0), Equation::in_plane(1)];
    equations.extend([(0, 1), (1, 2), (2, 0)].map(|(a, b)| Equation::normal(a, b)));
    Joint::new(name, nodes, between, equations)
}

/// The second marker slides along the third axis of the first and turns about it: four equations.
///
/// Use it for: a ring on a rod, a piston.
///
/// # Errors
/// As for [`prismatic`].
pub fn cylindrical(
    name: impl Into<String>,
    nodes: &[Node],
    between: [Marker; 2],
) -> Result<Joint, BuildError> {
    let equations =
        vec![Equation::in_plane(0), Equation::in_plane(1), Equation::normal(2, 0), Equation::normal(2, 1)];
    Joint::new(name, nodes, between, equations)
}

/// The second marker stays on the line through the first along its third axis: two equations. Every rotation is free.
///
/// Use it for: a bead on a wire, an eye on a guide rail; the second marker may be on a cable.
///
/// # Errors
/// As for [`spherical`](crate::spherical); a first marker without axes.
pub fn point_on_line(
    name: impl Into<String>,
    nodes: &[Node],
    between: [Marker; 2],
) -> Result<Joint, BuildError> {
    Joint::new(name, nodes, between, vec![Equation::in_plane(0), Equation::in_plane(1)])
}

/// The second marker stays in the plane through the first that is normal to its third axis: one equation.
///
/// # Errors
/// As for [`point_on_line`].
pub fn point_on_plane(
    name: impl Into<String>,
    nodes: &[Node],
    between: [Marker; 2],
) -> Result<Joint, BuildError> {
    Joint::new(name, nodes, between, vec![Equation::in_plane(2)])
}

along_an_axis! {
    /// Lets a body slide along an axis of another part or of space. It can't turn.
    "prismatic" => PrismaticSpec, prismatic;
    "Direction of the axis in space at the start. The axis turns with the parts."

    /// Lets a body slide along an axis of another part or of space, and turn about it.
    "cylindrical" => CylindricalSpec, cylindrical;
    "Direction of the axis in space at the start. The axis turns with the parts."

    /// Keeps a point on a straight line that is fixed to another part or in space.
    "point_on_line" => PointOnLineSpec, point_on_line;
    "Direction of the line in space at the start. The line turns with `to`."

    /// Keeps a point in a plane that is fixed to another part or in space.
    "point_on_plane" => PointOnPlaneSpec, point_on_plane;
    "Normal of the plane in space at the start. The plane turns with `to`."
}
