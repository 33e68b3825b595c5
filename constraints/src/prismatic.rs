//! Slides along an axis.

use crate::pair::{aligned, along, pair};
use ropewalk_core::{BuildError, Equation, Joint, Marker, Node, V3};
use ropewalk_scene::{Builder, ConstraintSpec, MarkerRef, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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

/// The spec of a joint whose axis the scene gives: `"name" => Spec, joint; what the axis is`.
macro_rules! along_an_axis {
    ($($(#[$what:meta])+ $name:literal => $spec:ident, $joint:ident; $axis:literal)+) => {$(
        $(#[$what])+
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields)]
        pub struct $spec {
            /// Name; records of the reaction refer to it.
            pub name: String,
            /// The marker that is held.
            pub marker: MarkerRef,
            /// The other marker, or a point in space. Default: the point where `marker` starts.
            #[serde(default)]
            pub to: Option<MarkerRef>,
            #[doc = $axis]
            pub axis: V3<f64>,
        }
        register_spec!(Constraint, $name, $spec);

        #[typetag::serde(name = $name)]
        impl ConstraintSpec for $spec {
            fn name(&self) -> &str {
                &self.name
            }
            fn markers(&self) -> Vec<&MarkerRef> {
                std::iter::once(&self.marker).chain(&self.to).collect()
            }
            fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
                let markers = pair(b, &self.marker, self.to.as_ref())?;
                let markers = aligned(b, markers, along("axis", self.axis)?);
                b.constraint($joint(&self.name, b.nodes(), markers)?)
            }
        }
    )+};
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
