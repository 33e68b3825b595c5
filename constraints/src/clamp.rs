//! The direction of a cable held fast.

use crate::check::unit;
use ropewalk_core::error::{finite, need};
use ropewalk_core::rotation::{around, cross};
use ropewalk_core::{BuildError, Equation, Joint, Marker, Node, NodeId, NodeKind, V3};
use ropewalk_scene::{Builder, ConstraintSpec, MarkerRef, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The slope `r'` of a cable node stays along the third axis of a marker, in space or on a rigid body: it is normal to
/// the first two, two equations.
///
/// The stretch `|r'|` stays free, as the tension there asks for it. The position is not held: add a
/// [`spherical`](crate::spherical). `r'` and `-r'` both satisfy the equations; the start decides which it is.
///
/// # Errors
/// A node without slope; a marker without axes.
pub fn clamp(name: impl Into<String>, nodes: &[Node], node: NodeId, to: Marker) -> Result<Joint, BuildError> {
    let name = name.into();
    let kind = nodes.get(node.0 as usize).map(|n| n.kind);
    need(kind == Some(NodeKind::Slope), || {
        format!("{name}: a clamp holds the slope of a cable node, which node {} doesn't have", node.0)
    })?;
    let equations = vec![Equation::normal(0, 0), Equation::normal(1, 0)];
    Joint::new(name, nodes, [to, Marker::node(node)], equations)
}

/// Holds the direction of a cable at a marker, in space or on a rigid body; its stretch stays free. With `spherical` a
/// built-in end. A cable that is bent when free of stress can't twist there either.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ClampSpec {
    /// Name, by which records ask for its reaction.
    pub name: String,
    /// The marker on a cable.
    pub marker: MarkerRef,
    /// The rigid body that holds the direction; left out, it is held in space.
    #[serde(default)]
    pub to: Option<MarkerRef>,
    /// The direction in space at the start; left out, that which the cable has there.
    #[serde(default)]
    pub direction: Option<V3<f64>>,
}
register_spec!(Constraint, "clamp", ClampSpec);

impl ClampSpec {
    /// Holds the direction that a cable has at the start.
    pub fn new(name: &str, marker: impl Into<MarkerRef>) -> Self {
        ClampSpec { name: name.into(), marker: marker.into(), to: None, direction: None }
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
        let marker = b.marker("marker", &self.marker)?;
        let Some(node) = marker.on() else {
            return Err(BuildError::at("marker", "a clamp holds a cable, not a point in space"));
        };
        let direction = self.direction.unwrap_or(b.place(&marker).axes[0]);
        finite("direction", &direction)?;
        let direction = unit("direction", direction)?;
        let director = b.parts(&[])?.iter().find_map(|(_, part)| part.line()?.director(node));
        let axes = match director.map(|d| b.place(&Marker::node(d)).x) {
            None => around(direction),
            Some(d) => {
                let across = unit("direction", cross(&direction, &d))?;
                [cross(&across, &direction), across, direction]
            }
        };
        let to = match &self.to {
            Some(to) => b.marker("to", to)?,
            None => Marker::ground([0.0; 3]),
        };
        let to = to.with_axes(b.nodes(), b.coordinates(), axes);
        if let Some(director) = director {
            let name = format!("{}.twist", self.name);
            let held =
                Joint::new(name, b.nodes(), [to, Marker::node(director)], vec![Equation::normal(1, 0)])?;
            b.constraint(held)?;
        }
        b.constraint(clamp(&self.name, b.nodes(), node, to)?)
    }
}
