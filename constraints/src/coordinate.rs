//! One coordinate of a point, held or driven.

use crate::check::unit;
use crate::pair::pair;
use ropewalk_core::{BuildError, Equation, Joint, Marker, Motion, Node, V3};
use ropewalk_scene::{Builder, ConstraintSpec, MarkerRef, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A marker stays in a plane of space through another, or in a plane that moves: `d·(x_1 - x_0 - X(t)) = 0`, one
/// equation.
///
/// Use it for: symmetry planes, a slider (two of them), a ship that holds a depth but not a course.
///
/// # Errors
/// A direction without length; markers as for [`spherical`](crate::spherical).
pub fn coordinate(
    name: impl Into<String>,
    nodes: &[Node],
    between: [Marker; 2],
    direction: V3<f64>,
    motion: Option<Arc<dyn Motion>>,
) -> Result<Joint, BuildError> {
    let direction = unit("direction", direction)?;
    Joint::new(name, nodes, between, vec![Equation::coordinate(direction, motion)])
}

/// Holds or drives one coordinate of a marker along a direction. The other two are free.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CoordinateSpec {
    /// Name; records of the reaction refer to it.
    pub name: String,
    /// The marker.
    pub marker: MarkerRef,
    /// Direction of the coordinate, in space.
    pub direction: V3<f64>,
    /// Name of a motion; its component along the direction drives the coordinate. Default: the coordinate is held.
    #[serde(default)]
    pub motion: Option<String>,
}
register_spec!(Constraint, "coordinate", CoordinateSpec);

#[typetag::serde(name = "coordinate")]
impl ConstraintSpec for CoordinateSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn markers(&self) -> Vec<&MarkerRef> {
        vec![&self.marker]
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let markers = pair(b, &self.marker, None)?;
        let motion = self.motion.as_deref().map(|m| b.motion(m)).transpose()?;
        b.constraint(coordinate(&self.name, b.nodes(), markers, self.direction, motion)?)
    }
}
