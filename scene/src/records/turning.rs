//! Angular velocity and orientation of a rigid body.

use super::named;
use super::place::{SpaceAxis, all_axes, body, check_axes};
use crate::register_spec;
use crate::spec::RecordSpec;
use ropewalk_core::model::twist;
use ropewalk_core::rotation::{bryant, from_matrix, matrix, times, transposed_times};
use ropewalk_core::{BuildError, Column, Model, Node, NodeId, NodeKind, Record, Sample};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The axes that a vector is given in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SeenFrom {
    /// Those of space.
    #[default]
    Space,
    /// Those of the body itself.
    Body,
    /// Those of the body that it is relative to.
    To,
}

/// Angular velocity of a rigid body, or of the section of a cable with torsion: columns `crank.wx`, `.wy` and `.wz` in rad/s.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AngularVelocitySpec {
    /// The body, or a marker on it, such as `hose.link3`.
    pub of: String,
    /// The other body. Default: space. The relative angular velocity of a joint's two bodies is the speed of the
    /// joint.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<String>,
    /// Axes of the components: of `space`, of the `body`, or of the other body, `to`.
    #[serde(default)]
    pub frame: SeenFrom,
    /// Recorded components. Default: all three.
    #[serde(default = "all_axes")]
    pub axes: Vec<SpaceAxis>,
    /// Name in results. Default: that of the body and `.angular_velocity`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Title of its plots. Default: the quantity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
}

/// Orientation of a rigid body, or of the section of a cable with torsion (its two directors and its tangent), as Bryant angles 1-2-3, turns about its x axis, its new y axis, its new z axis: columns
/// `crank.phi1`, `.phi2` and `.phi3` in rad. The first and the third jump from π to -π.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OrientationSpec {
    /// The body, or a marker on it.
    pub of: String,
    /// Whether the angles are in degrees.
    #[serde(default)]
    pub degrees: bool,
    /// Name in results. Default: that of the body and `.orientation`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Title of its plots. Default: the quantity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
}

register_spec!(Record, "angular_velocity", AngularVelocitySpec);
register_spec!(Record, "orientation", OrientationSpec);

struct Turning {
    node: NodeId,
    to: Option<NodeId>,
    frame: SeenFrom,
    axes: Vec<SpaceAxis>,
    name: String,
    stem: String,
    title: String,
}

pub(super) fn quaternion(s: &Sample<'_>, node: NodeId) -> [f64; 4] {
    let Node { kind, q, .. } = *s.model.node(node);
    if kind == NodeKind::Twist {
        return from_matrix(&twist::section(&s.at.q[q..]));
    }
    [s.at.q[q + 3], s.at.q[q + 4], s.at.q[q + 5], s.at.q[q + 6]]
}

/// In space [rad/s].
fn angular_velocity(s: &Sample<'_>, node: NodeId) -> [f64; 3] {
    let Node { kind, q, v, .. } = *s.model.node(node);
    if kind == NodeKind::Twist {
        return twist::angular_velocity(&s.at.q[q..], &s.at.v[v..]);
    }
    times(&matrix(&quaternion(s, node)), &[s.at.v[v + 3], s.at.v[v + 4], s.at.v[v + 5]])
}

impl Record for Turning {
    fn title(&self) -> String {
        self.title.clone()
    }
    fn name(&self) -> String {
        self.name.clone()
    }
    fn columns(&self) -> Vec<Column> {
        let column = |a: &SpaceAxis| Column::new(format!("{}.w{}", self.stem, a.letter()), "rad/s");
        self.axes.iter().map(column).collect()
    }
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>) {
        let mut w = angular_velocity(s, self.node);
        if let Some(to) = self.to {
            let other = angular_velocity(s, to);
            w = std::array::from_fn(|i| w[i] - other[i]);
        }
        let seen_from = match self.frame {
            SeenFrom::Space => None,
            SeenFrom::Body => Some(self.node),
            SeenFrom::To => self.to,
        };
        if let Some(node) = seen_from {
            w = transposed_times(&matrix(&quaternion(s, node)), &w);
        }
        out.extend(self.axes.iter().map(|a| w[*a as usize]));
    }
}

#[typetag::serde(name = "angular_velocity")]
impl RecordSpec for AngularVelocitySpec {
    fn build(&self, model: &Model) -> Result<Box<dyn Record>, BuildError> {
        let (node, of) = body(model, "of", &self.of)?;
        check_axes(&self.axes)?;
        if self.frame == SeenFrom::To && self.to.is_none() {
            return Err(BuildError::at("frame", "`frame = \"to\"` needs the body `to` which it is relative"));
        }
        let to = self.to.as_deref().map(|to| body(model, "to", to)).transpose()?;
        let stem = named(&self.name, || of.clone());
        let name = named(&self.name, || format!("{of}.angular_velocity"));
        let title = named(&self.title, || match &to {
            Some((_, to)) => format!("Angular velocity of {of} relative to {to}"),
            None => format!("Angular velocity of {of}"),
        });
        Ok(Box::new(Turning {
            node,
            to: to.map(|t| t.0),
            frame: self.frame,
            axes: self.axes.clone(),
            name,
            stem,
            title,
        }))
    }
}

struct Orientation {
    node: NodeId,
    degrees: bool,
    name: String,
    stem: String,
    title: String,
}

impl Record for Orientation {
    fn title(&self) -> String {
        self.title.clone()
    }
    fn name(&self) -> String {
        self.name.clone()
    }
    fn columns(&self) -> Vec<Column> {
        let unit = if self.degrees { "deg" } else { "rad" };
        ["phi1", "phi2", "phi3"].map(|i| Column::new(format!("{}.{i}", self.stem), unit)).to_vec()
    }
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>) {
        let angles = bryant(&quaternion(s, self.node));
        out.extend(angles.map(|a| if self.degrees { a.to_degrees() } else { a }));
    }
}

#[typetag::serde(name = "orientation")]
impl RecordSpec for OrientationSpec {
    fn build(&self, model: &Model) -> Result<Box<dyn Record>, BuildError> {
        let (node, of) = body(model, "of", &self.of)?;
        let stem = named(&self.name, || of.clone());
        let name = named(&self.name, || format!("{of}.orientation"));
        let title = named(&self.title, || format!("Orientation of {of}: Bryant angles 1-2-3"));
        Ok(Box::new(Orientation { node, degrees: self.degrees, name, stem, title }))
    }
}
