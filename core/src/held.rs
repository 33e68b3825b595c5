//! The points that terms act on, with what they need of them.

use crate::build::{BuildError, need};
use crate::lane::V3;
use crate::marker::Marker;
use crate::node::{Node, NodeId, NodeKind};
use crate::state::At;

/// A marker whose position is three coordinates of its node, or fixed in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Held {
    /// Fixed in space at this point.
    Ground(V3<f64>),
    /// Position at coordinate `q` and following, velocity at `v` and following.
    Moves {
        /// Index of its first coordinate.
        q: usize,
        /// Index of its first velocity.
        v: usize,
    },
}

impl Held {
    /// Finds a marker's coordinates; `what` names the force in messages.
    pub fn new(nodes: &[Node], marker: &Marker, what: &str) -> Result<Self, BuildError> {
        match *marker {
            Marker::Ground { point, .. } => Ok(Held::Ground(point)),
            Marker::Node { node, point, .. } => {
                let n = find(nodes, node, what)?;
                match n.kind {
                    NodeKind::Point | NodeKind::Slope => {}
                    NodeKind::Frame => need(point == [0.0; 3], || {
                        format!(
                            "{what}: on a rigid body only its own point can be held as yet, not {point:?} on it"
                        )
                    })?,
                    NodeKind::Scalars(_) => {
                        return Err(BuildError::new(format!("{what}: node {} has no position", node.0)));
                    }
                }
                Ok(Held::Moves { q: n.q, v: n.v })
            }
        }
    }
    /// Its position [m].
    pub fn x(&self, at: &At<'_>) -> V3<f64> {
        match *self {
            Held::Ground(x) => x,
            Held::Moves { q, .. } => three(at.q, q),
        }
    }
    /// Its velocity [m/s].
    pub fn velocity(&self, at: &At<'_>) -> V3<f64> {
        self.dof().map_or([0.0; 3], |v| three(at.v, v))
    }
    /// Index of its first velocity, if it can move.
    pub fn dof(&self) -> Option<usize> {
        match *self {
            Held::Ground(_) => None,
            Held::Moves { v, .. } => Some(v),
        }
    }
}

/// The node of that index.
pub fn find<'a>(nodes: &'a [Node], node: NodeId, what: &str) -> Result<&'a Node, BuildError> {
    nodes.get(node.0 as usize).ok_or_else(|| BuildError::new(format!("{what}: there is no node {}", node.0)))
}

/// Three numbers from an index on.
pub fn three(x: &[f64], from: usize) -> V3<f64> {
    [x[from], x[from + 1], x[from + 2]]
}

/// Vector product.
pub fn cross(a: &V3<f64>, b: &V3<f64>) -> V3<f64> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// 1 on the diagonal, else 0.
pub fn delta(i: usize, j: usize) -> f64 {
    if i == j { 1.0 } else { 0.0 }
}
