//! The direction of a cable's end held fast.

use crate::check::unit;
use ropewalk_core::build::{BuildError, need};
use ropewalk_core::{Jet, Joint, Marker, Node, NodeId, NodeKind, Place, Relation, RowKind, V3};

/// The slope `r'` of a cable node stays along a direction fixed in space: `n_1·r' = 0`, `n_2·r' = 0`.
///
/// The stretch `|r'|` stays free, as the tension there asks for it. The position is not held: add a
/// [`Spherical`](crate::Spherical). `r'` and `-r'` both satisfy the equations; the start decides which it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clamp {
    /// Two unit vectors normal to the direction and to each other.
    pub normals: [V3<f64>; 2],
}

impl Clamp {
    /// Holds the slope of `node` along `direction` (of any length).
    ///
    /// # Errors
    /// A node without slope; a direction without length.
    pub fn joint(
        name: impl Into<String>,
        nodes: &[Node],
        node: NodeId,
        direction: V3<f64>,
    ) -> Result<Joint<Self>, BuildError> {
        let name = name.into();
        has_slope(&name, nodes, node)?;
        let normals = normals(unit("direction", direction)?);
        Ok(Joint::new(name, Clamp { normals }, vec![Marker::node(node)]))
    }
}

impl Relation for Clamp {
    fn rows(&self) -> Vec<RowKind> {
        vec![RowKind::Direction; 2]
    }
    fn linear(&self) -> bool {
        true
    }
    fn g<S: Jet>(&self, _: S, at: &[Place<S>], g: &mut [S]) {
        let p = at[0].direction;
        for (g, n) in g.iter_mut().zip(&self.normals) {
            *g = p[0] * n[0] + p[1] * n[1] + p[2] * n[2];
        }
    }
}

/// The slope `r'` of a cable node stays along a direction that is fixed to a rigid body; otherwise as [`Clamp`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BodyClamp;

impl BodyClamp {
    /// Holds the slope of `node` along `direction` of `body`, in the body's axes.
    ///
    /// # Errors
    /// A node without slope; a body that isn't a frame; a direction without length.
    pub fn joint(
        name: impl Into<String>,
        nodes: &[Node],
        node: NodeId,
        body: NodeId,
        direction: V3<f64>,
    ) -> Result<Joint<Self>, BuildError> {
        let name = name.into();
        has_slope(&name, nodes, node)?;
        let is_body = nodes.get(body.0 as usize).is_some_and(|n| n.kind == NodeKind::Frame);
        need(is_body, || format!("{name}: node {} isn't a rigid body", body.0))?;
        let normals = normals(unit("direction", direction)?);
        let on_body = |direction| Marker::Node { node: body, point: [0.0; 3], direction };
        Ok(Joint::new(name, BodyClamp, vec![Marker::node(node), on_body(normals[0]), on_body(normals[1])]))
    }
}

impl Relation for BodyClamp {
    fn rows(&self) -> Vec<RowKind> {
        vec![RowKind::Direction; 2]
    }
    fn g<S: Jet>(&self, _: S, at: &[Place<S>], g: &mut [S]) {
        let p = at[0].direction;
        for (g, normal) in g.iter_mut().zip(&at[1..]) {
            let n = normal.direction;
            *g = p[0] * n[0] + p[1] * n[1] + p[2] * n[2];
        }
    }
}

fn has_slope(name: &str, nodes: &[Node], node: NodeId) -> Result<(), BuildError> {
    let kind = nodes.get(node.0 as usize).map(|n| n.kind);
    need(kind == Some(NodeKind::Slope), || {
        format!("{name}: a clamp holds the slope of a cable node, which node {} doesn't have", node.0)
    })
}

/// Two unit vectors normal to the unit vector `d` and to each other.
fn normals(d: V3<f64>) -> [V3<f64>; 2] {
    let cross = |a: V3<f64>, b: V3<f64>| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    // the axis that is farthest from d
    let least = (0..3).min_by(|&i, &j| d[i].abs().total_cmp(&d[j].abs())).unwrap_or(0);
    let axis: V3<f64> = std::array::from_fn(|i| if i == least { 1.0 } else { 0.0 });
    let n = cross(d, axis);
    let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
    let n = n.map(|x| x / length);
    [n, cross(d, n)]
}
