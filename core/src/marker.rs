//! Markers: named points and directions of bodies, which constraints, point loads and records hold on to.

use crate::lane::V3;
use crate::node::{Node, NodeId, NodeKind};
use crate::state::At;
use num_dual::DualNum;

/// A number that carries derivatives along: what relations and markers are evaluated with.
pub trait Jet: DualNum<Primitive = f64> + Copy {}
impl<T: DualNum<Primitive = f64> + Copy> Jet for T {}

/// A point that a constraint or load can hold: of a node, or fixed in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Marker {
    /// Fixed in space. `direction` is what a slope or axis is compared with.
    Ground {
        /// Position [m].
        point: V3<f64>,
        /// A direction, such as the axis of a clamp.
        direction: V3<f64>,
    },
    /// On a node. For a frame, `point` and `direction` are in the body's axes; else they are unused.
    Node {
        /// The node.
        node: NodeId,
        /// Place on the body [m].
        point: V3<f64>,
        /// Direction on the body.
        direction: V3<f64>,
    },
}

/// Where a marker is, over any carrier: position and direction (the slope `r'` of a cable, not normalised).
#[derive(Clone, Copy, Debug)]
pub struct Place<S> {
    /// Position [m].
    pub x: V3<S>,
    /// Direction.
    pub direction: V3<S>,
}

impl Marker {
    /// A point fixed in space.
    pub fn ground(point: V3<f64>) -> Self {
        Marker::Ground { point, direction: [1.0, 0.0, 0.0] }
    }
    /// A node's own point.
    pub fn node(node: NodeId) -> Self {
        Marker::Node { node, point: [0.0; 3], direction: [1.0, 0.0, 0.0] }
    }
    /// Its node, if it has one.
    pub fn on(&self) -> Option<NodeId> {
        match self {
            Marker::Ground { .. } => None,
            Marker::Node { node, .. } => Some(*node),
        }
    }

    /// Where the marker is after its node has moved by the increment `d(0), d(1), …` from its coordinates `q`.
    /// Exact to second order in `d`, so first and second derivatives at `d = 0` are exact.
    pub fn place<S: Jet>(&self, nodes: &[Node], q: &[f64], d: impl Fn(usize) -> S) -> Place<S> {
        let (node, point, direction) = match *self {
            Marker::Ground { point, direction } => {
                return Place { x: point.map(S::from), direction: direction.map(S::from) };
            }
            Marker::Node { node, point, direction } => (&nodes[node.0 as usize], point, direction),
        };
        let q = &q[node.coords()];
        let moved = |i: usize| d(i) + q[i];
        let x = [moved(0), moved(1), moved(2)];
        match node.kind {
            NodeKind::Point | NodeKind::Scalars(_) => Place { x, direction: direction.map(S::from) },
            NodeKind::Slope => Place { x, direction: [moved(3), moved(4), moved(5)] },
            NodeKind::Frame => {
                let turn = [d(3), d(4), d(5)];
                let at = rotate(q, turned(turn, point));
                Place {
                    x: std::array::from_fn(|i| x[i] + at[i]),
                    direction: rotate(q, turned(turn, direction)),
                }
            }
        }
    }

    /// Its position and direction now.
    pub fn now(&self, nodes: &[Node], at: &At<'_>) -> Place<f64> {
        self.place(nodes, at.q, |_| 0.0_f64)
    }

    /// Its velocity now [m/s].
    pub fn velocity(&self, nodes: &[Node], at: &At<'_>) -> V3<f64> {
        self.path(nodes, at, None, |p| p.v1)
    }

    /// Its acceleration now [m/s²].
    pub fn acceleration(&self, nodes: &[Node], at: &At<'_>) -> V3<f64> {
        self.path(nodes, at, Some(at.a), |p| p.v2)
    }

    fn path(
        &self,
        nodes: &[Node],
        at: &At<'_>,
        a: Option<&[f64]>,
        pick: impl Fn(num_dual::Dual2_64) -> f64,
    ) -> V3<f64> {
        let Some(node) = self.on() else { return [0.0; 3] };
        let first = nodes[node.0 as usize].v;
        let place = self.place(nodes, at.q, |i| {
            num_dual::Dual2_64::new(0.0, at.v[first + i], a.map_or(0.0, |a| a[first + i]))
        });
        place.x.map(pick)
    }
}

/// `(I + [θ] + ½ [θ]²) u`: the rotation by a small vector, to second order.
fn turned<S: Jet>(theta: V3<S>, u: V3<f64>) -> V3<S> {
    let u = u.map(S::from);
    let once = cross(theta, u);
    let twice = cross(theta, once);
    std::array::from_fn(|i| u[i] + once[i] + twice[i] * 0.5)
}

fn cross<S: Jet>(a: V3<S>, b: V3<S>) -> V3<S> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Turns a vector of the body into space by the quaternion in `q[3..7]`.
fn rotate<S: Jet>(q: &[f64], u: V3<S>) -> V3<S> {
    let (w, x, y, z) = (q[3], q[4], q[5], q[6]);
    let r = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ];
    std::array::from_fn(|i| u[0] * r[i][0] + u[1] * r[i][1] + u[2] * r[i][2])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn point_on_a_turning_body_moves_on_a_circle() {
        let nodes = [Node { kind: NodeKind::Frame, q: 0, v: 0, shared: false }];
        let marker = Marker::Node { node: NodeId(0), point: [2.0, 0.0, 0.0], direction: [1.0, 0.0, 0.0] };
        let q = [1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0];
        let v = [0.5, 0.0, 0.0, 0.0, 0.0, 3.0];
        let at = At { t: 0.0, q: &q, v: &v, a: &[0.0; 6], modes: &[], relaxed: None };
        assert_eq!(marker.now(&nodes, &at).x, [3.0, 1.0, 1.0]);
        assert_eq!(marker.velocity(&nodes, &at), [0.5, 6.0, 0.0]);
        assert_eq!(marker.acceleration(&nodes, &at), [-18.0, 0.0, 0.0]);
    }
}
