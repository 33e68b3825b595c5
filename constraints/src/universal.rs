//! Axes at right angles, and the universal joint that they make.

use crate::pair::{direction, pair};
use ropewalk_core::rotation::around;
use ropewalk_core::{BuildError, Equation, Joint, Marker, Node, V3};
use ropewalk_scene::{Builder, ConstraintSpec, MarkerRef, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The third axes of two markers stay at right angles: `u·w = 0` ("dot-1"), one equation. Points stay free.
///
/// Use it for: building joints of one's own.
///
/// # Errors
/// As for [`spherical`](crate::spherical); a marker without axes.
pub fn perpendicular(
    name: impl Into<String>,
    nodes: &[Node],
    between: [Marker; 2],
) -> Result<Joint, BuildError> {
    Joint::new(name, nodes, between, vec![Equation::normal(2, 2)])
}

/// Two markers are at the same point and their third axes, the arms of the cross, stay at right angles: a universal
/// (Cardan, Hooke) joint, four equations.
///
/// Use it for: shafts that meet at an angle, the end of a hose that may bend but not twist.
///
/// # Errors
/// As for [`perpendicular`].
pub fn universal(name: impl Into<String>, nodes: &[Node], between: [Marker; 2]) -> Result<Joint, BuildError> {
    let mut equations = Equation::coincide();
    equations.push(Equation::normal(2, 2));
    Joint::new(name, nodes, between, equations)
}

/// Refuses axes that are closer to parallel than to a right angle: where they are parallel the equation is singular.
fn crossed(what: &str, a: V3<f64>, b: V3<f64>) -> Result<(), BuildError> {
    let dot = |a: &V3<f64>, b: &V3<f64>| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
    let cosine = dot(&a, &b) / (dot(&a, &a) * dot(&b, &b)).sqrt();
    if cosine.abs() < std::f64::consts::FRAC_1_SQRT_2 {
        return Ok(());
    }
    let message = format!(
        "the axes of a {what} must start at 90°, but are at {:.1}°: correct `axis` or `axis_to`",
        cosine.clamp(-1.0, 1.0).acos().to_degrees()
    );
    Err(BuildError::new(message))
}

/// The spec of a joint between two axes: `"name" => Spec, joint, what a message calls it`.
macro_rules! between_two_axes {
    ($($(#[$what:meta])+ $name:literal => $spec:ident, $joint:ident, $called:literal;)+) => {$(
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
            /// Axis of `to` in space at the start; it turns with `to`. Leave it out on a cable: there the axis is the
            /// tangent.
            #[serde(default)]
            pub axis_to: Option<V3<f64>>,
            /// Axis of `marker` in space at the start; it turns with `marker`. Leave it out on a cable.
            #[serde(default)]
            pub axis: Option<V3<f64>>,
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
                let on = direction(b, "axis_to", &markers[0], self.axis_to)?;
                let held = direction(b, "axis", &markers[1], self.axis)?;
                let markers = [
                    markers[0].with_axes(b.nodes(), b.coordinates(), around(on)),
                    markers[1].with_axes(b.nodes(), b.coordinates(), around(held)),
                ];
                crossed($called, on, held)?;
                b.constraint($joint(&self.name, b.nodes(), markers)?)
            }
        }
    )+};
}

between_two_axes! {
    /// Keeps an axis of one part at right angles to an axis of another part or of space.
    "perpendicular" => PerpendicularSpec, perpendicular, "right angle";

    /// A universal joint: holds two points together, and keeps an axis of one part at right angles to an axis of the
    /// other.
    "universal" => UniversalSpec, universal, "universal joint";
}
