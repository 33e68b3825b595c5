//! Two points held together.

use crate::pair::pair;
use ropewalk_core::{BuildError, Equation, Joint, Marker, Node};
use ropewalk_scene::{Builder, ConstraintSpec, MarkerRef, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Two markers are at the same point: `x_1 - x_0 = 0`, three equations. Directions stay free.
///
/// Use it for: pinning a cable's end to the ground or to a body, the links of a chain.
///
/// # Errors
/// Both on the ground or on the same node; a node without position.
pub fn spherical(name: impl Into<String>, nodes: &[Node], between: [Marker; 2]) -> Result<Joint, BuildError> {
    Joint::new(name, nodes, between, Equation::coincide())
}

/// Holds two points together, of two parts or of a part and space. All rotations are free.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SphericalSpec {
    /// Name; records of the reaction refer to it.
    pub name: String,
    /// The marker that is held.
    pub marker: MarkerRef,
    /// The other marker, or a point in space. Default: the point where `marker` starts.
    #[serde(default)]
    pub to: Option<MarkerRef>,
}
register_spec!(Constraint, "spherical", SphericalSpec);

impl SphericalSpec {
    /// Holds a marker to another or to a point in space.
    pub fn new(name: &str, marker: impl Into<MarkerRef>, to: impl Into<MarkerRef>) -> Self {
        SphericalSpec { name: name.into(), marker: marker.into(), to: Some(to.into()) }
    }
    /// Holds a marker where it starts.
    pub fn pin(name: &str, marker: impl Into<MarkerRef>) -> Self {
        SphericalSpec { name: name.into(), marker: marker.into(), to: None }
    }
}

#[typetag::serde(name = "spherical")]
impl ConstraintSpec for SphericalSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn markers(&self) -> Vec<&MarkerRef> {
        std::iter::once(&self.marker).chain(&self.to).collect()
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let markers = pair(b, &self.marker, self.to.as_ref())?;
        b.constraint(spherical(&self.name, b.nodes(), markers)?)
    }
}
