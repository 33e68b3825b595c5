//! Two parts joined rigidly.

use crate::pair::{aligned, on_cable, pair, slope};
use ropewalk_core::rotation::{IDENTITY, around};
use ropewalk_core::{BuildError, Equation, Joint, Marker, Node, NodeKind};
use ropewalk_scene::{Builder, ConstraintSpec, MarkerRef, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Two markers are at the same point with the same axes: six equations. Of a cable's end the slope is held along the
/// third axis of the other marker, its stretch stays free, and there is no twist to hold: 3 + 2 equations. The end of a
/// cable with torsion is held like a body, its stretch apart: two such ends may be welded to each other.
///
/// Use it for: a sensor on a vehicle, a hose built into a flange.
///
/// # Errors
/// As for [`spherical`](crate::spherical); a marker without axes; cables without torsion at both markers.
pub fn weld(name: impl Into<String>, nodes: &[Node], between: [Marker; 2]) -> Result<Joint, BuildError> {
    let mut equations = Equation::coincide();
    let on_cable =
        |m: &Marker| m.on().is_some_and(|n| nodes.get(n.0 as usize).map(|n| n.kind) == Some(NodeKind::Slope));
    let normals = match [on_cable(&between[0]), on_cable(&between[1])] {
        [true, true] => {
            return Err(BuildError::new(
                "two cables without torsion can't be welded, since nothing says how they are turned: give their sections a \
                 torsional stiffness, `gj`, make them one cable, or join them by a body",
            ));
        }
        [true, _] => [(0, 0), (0, 1)].as_slice(),
        [_, true] => &[(0, 0), (1, 0)],
        // each axis with the next one, so that the equations are independent where the axes agree
        _ => &[(0, 1), (1, 2), (2, 0)],
    };
    equations.extend(normals.iter().map(|&(a, b)| Equation::normal(a, b)));
    Joint::new(name, nodes, between, equations)
}

/// Joins two parts rigidly, as they stand at the start. Of a cable, point and tangent are held, and of one with torsion
/// (`section.gj`) the twist; the stretch stays free.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WeldSpec {
    /// Name; records of the reaction refer to it.
    pub name: String,
    /// The marker that is held.
    pub marker: MarkerRef,
    /// The other marker, or a point in space. Default: the point where `marker` starts.
    #[serde(default)]
    pub to: Option<MarkerRef>,
}
register_spec!(Constraint, "weld", WeldSpec);

#[typetag::serde(name = "weld")]
impl ConstraintSpec for WeldSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn markers(&self) -> Vec<&MarkerRef> {
        std::iter::once(&self.marker).chain(&self.to).collect()
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let markers = pair(b, &self.marker, self.to.as_ref())?;
        let cable = markers.iter().filter(|m| on_cable(b, m)).find_map(|m| slope(b, m));
        let axes = cable.map_or(IDENTITY, around);
        b.constraint(weld(&self.name, b.nodes(), aligned(b, markers, axes))?)
    }
}
