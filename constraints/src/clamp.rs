//! An end built in: position and direction held.

use crate::direction::{Tangent, held};
use crate::pair::{aligned, kind, on_cable, pair, untwisted};
use crate::weld::weld;
use ropewalk_core::rotation::IDENTITY;
use ropewalk_core::{BuildError, Equation, Joint, NodeKind, V3};
use ropewalk_scene::{Builder, ConstraintSpec, MarkerRef, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Holds position and direction: a built-in end.
///
/// On a cable it holds the point and the tangent; the stretch stays free, as the tension there needs. A cable with torsion
/// can't twist there either, unless it is on a swivel (`twist = false`). On a rigid body or a link it holds all six degrees
/// of freedom, as `weld` does. To hold the direction only, use `direction`; to hold the position only, `spherical`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ClampSpec {
    /// Name; records refer to the reaction by it.
    pub name: String,
    /// The marker that is held, on a cable or a rigid body.
    pub marker: MarkerRef,
    /// What holds it: a marker on a rigid body or a point in space. Default: the point where the marker starts.
    #[serde(default)]
    pub to: Option<MarkerRef>,
    /// Direction of the cable at the start, in space. Default: the direction in which the cable is laid.
    #[serde(default)]
    pub direction: Option<V3<f64>>,
    /// Whether a cable with torsion (`section.gj`) is kept from turning about its own axis; `false` is a swivel. Default:
    /// it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub twist: Option<bool>,
}
register_spec!(Constraint, "clamp", ClampSpec);

impl ClampSpec {
    /// Holds a marker in space, where and as it stands at the start.
    pub fn new(name: &str, marker: impl Into<MarkerRef>) -> Self {
        ClampSpec { name: name.into(), marker: marker.into(), to: None, direction: None, twist: None }
    }
}

#[typetag::serde(name = "clamp")]
impl ConstraintSpec for ClampSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn markers(&self) -> Vec<&MarkerRef> {
        std::iter::once(&self.marker).chain(&self.to).collect()
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let markers = pair(b, &self.marker, self.to.as_ref())?;
        let twisted = (0..2).rev().find(|&k| kind(b, &markers[k]) == Some(NodeKind::Twist));
        if let Some(cable) = twisted.filter(|&k| !on_cable(b, &markers[1 - k])) {
            let tangent = Tangent::new(b, &markers[cable], self.direction)?;
            let mut markers = markers;
            markers[1 - cable] = markers[1 - cable].with_axes(b.nodes(), b.coordinates(), tangent.axes);
            let mut equations = Equation::coincide();
            equations.extend(held(cable, self.twist.unwrap_or(true)));
            return b.constraint(Joint::new(&self.name, b.nodes(), markers, equations)?);
        }
        untwisted(self.twist)?;
        let Some(cable) = (0..2).find(|&k| on_cable(b, &markers[k])) else {
            if self.direction.is_some() {
                let message = "a body is held as it stands at the start: leave `direction` out";
                return Err(BuildError::at("direction", message));
            }
            return b.constraint(weld(&self.name, b.nodes(), aligned(b, markers, IDENTITY))?);
        };
        let tangent = Tangent::new(b, &markers[cable], self.direction)?;
        b.constraint(weld(&self.name, b.nodes(), aligned(b, markers, tangent.axes))?)
    }
}
