//! Two points at a fixed distance.

use ropewalk_core::error::positive;
use ropewalk_core::{BuildError, Equation, Joint, Marker, Node};
use ropewalk_scene::{Builder, ConstraintSpec, MarkerRef, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Two markers stay at a distance: `|x_1 - x_0| - L = 0`, one equation; a massless rod with a ball at each end.
///
/// The points must start at about that distance: where they coincide the rod has no direction.
///
/// # Errors
/// A length that isn't above zero (hold the points together by [`spherical`](crate::spherical) instead); markers as
/// for that one.
pub fn distance(
    name: impl Into<String>,
    nodes: &[Node],
    between: [Marker; 2],
    length: f64,
) -> Result<Joint, BuildError> {
    positive("length", length)?;
    Joint::new(name, nodes, between, vec![Equation::Distance { length }])
}

/// Keeps two points at a constant distance: a massless rod.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DistanceSpec {
    /// Name; records of the reaction refer to it.
    pub name: String,
    /// One marker.
    pub marker: MarkerRef,
    /// The other marker, or a point in space.
    pub to: MarkerRef,
    /// Distance [m]. Default: the initial distance.
    #[serde(default, deserialize_with = "quantity::optional::length")]
    pub length: Option<f64>,
}
register_spec!(Constraint, "distance", DistanceSpec);

#[typetag::serde(name = "distance")]
impl ConstraintSpec for DistanceSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn markers(&self) -> Vec<&MarkerRef> {
        vec![&self.marker, &self.to]
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let markers = [b.marker("to", &self.to)?, b.marker("marker", &self.marker)?];
        let [x, y] = markers.map(|m| b.place(&m).x);
        let start = (0..3).map(|i| (y[i] - x[i]).powi(2)).sum::<f64>().sqrt();
        b.reaches(start);
        let joint = distance(&self.name, b.nodes(), markers, self.length.unwrap_or(start))?;
        b.constraint(joint)
    }
}
