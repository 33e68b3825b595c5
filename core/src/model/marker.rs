//! Markers: named points and axes of bodies, which constraints, point loads and records hold on to.

use crate::algebra::jet::Jet;
use crate::algebra::lane::V3;
use crate::algebra::rotation::{IDENTITY, M3, cross, matrix, times, transposed_times};
use crate::model::node::{Node, NodeId, NodeKind};
use crate::model::state::At;
use crate::model::twist;

/// A point that a constraint or load can hold, with axes: of a node, or fixed in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Marker {
    /// Fixed in space.
    Ground {
        /// Position [m].
        point: V3<f64>,
        /// Three unit vectors at right angles, one after the other.
        axes: M3,
    },
    /// On a node. For a frame, `point` and `axes` are in the body's own axes; for a cable with torsion in those of its
    /// section, the two directors and the tangent. Else they are unused: another cable has only its slope.
    Node {
        /// The node.
        node: NodeId,
        /// Place on the body [m].
        point: V3<f64>,
        /// Three unit vectors at right angles, one after the other.
        axes: M3,
    },
}

/// Where a marker is, over any carrier.
#[derive(Clone, Copy, Debug)]
pub struct Place<S> {
    /// Position [m].
    pub x: V3<S>,
    /// Its axes, one after the other. Of a cable without torsion the first is the slope `r'`, not normalised, and the
    /// others are zero.
    pub axes: [V3<S>; 3],
}

impl Marker {
    /// A point fixed in space, with the axes of space.
    pub fn ground(point: V3<f64>) -> Self {
        Marker::Ground { point, axes: IDENTITY }
    }
    /// A node's own point, with its own axes.
    pub fn node(node: NodeId) -> Self {
        Marker::beside(node, [0.0; 3])
    }
    /// A point of a body, in its axes [m].
    pub fn beside(node: NodeId, point: V3<f64>) -> Self {
        Marker::Node { node, point, axes: IDENTITY }
    }
    /// The same point with axes that are these in space while the model has the coordinates `q`.
    #[must_use]
    pub fn with_axes(self, nodes: &[Node], q: &[f64], in_space: M3) -> Self {
        match self {
            Marker::Ground { point, .. } => Marker::Ground { point, axes: in_space },
            Marker::Node { node, point, .. } => {
                let n = &nodes[node.0 as usize];
                let axes = match n.kind {
                    NodeKind::Frame => {
                        let r = frame(&q[n.coords()]);
                        in_space.map(|a| transposed_times(&r, &a))
                    }
                    NodeKind::Twist => {
                        let r = twist::section(&q[n.coords()]);
                        in_space.map(|a| transposed_times(&r, &a))
                    }
                    _ => in_space,
                };
                Marker::Node { node, point, axes }
            }
        }
    }
    /// The slope `r'` of its node while the model has the coordinates `q`, if that is on a cable.
    pub fn slope(&self, nodes: &[Node], q: &[f64]) -> Option<V3<f64>> {
        let n = &nodes[self.on()?.0 as usize];
        n.kind.has_slope().then(|| [q[n.q + 3], q[n.q + 4], q[n.q + 5]])
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
        let (node, point, axes) = match *self {
            Marker::Ground { point, axes } => {
                return Place { x: point.map(S::from), axes: axes.map(|a| a.map(S::from)) };
            }
            Marker::Node { node, point, axes } => (&nodes[node.0 as usize], point, axes),
        };
        let q = &q[node.coords()];
        let moved = |i: usize| d(i) + q[i];
        // of plain numbers there may be less than three
        let x = std::array::from_fn(|i| if i < q.len() { moved(i) } else { S::zero() });
        match node.kind {
            NodeKind::Point | NodeKind::Scalars(_) => Place { x, axes: axes.map(|a| a.map(S::from)) },
            NodeKind::Slope => {
                let nothing = [S::zero(); 3];
                Place { x, axes: [[moved(3), moved(4), moved(5)], nothing, nothing] }
            }
            NodeKind::Twist => {
                let r = twist::section(q);
                let turned = |a: V3<f64>| slid([d(3), d(4), d(5)], d(6), &q[3..6], times(&r, &a));
                let at = turned(point);
                Place { x: std::array::from_fn(|i| x[i] + at[i]), axes: axes.map(turned) }
            }
            NodeKind::Frame => {
                let (turn, r) = ([d(3), d(4), d(5)], frame(q));
                let at = rotate(&r, turned(turn, point));
                Place {
                    x: std::array::from_fn(|i| x[i] + at[i]),
                    axes: axes.map(|a| rotate(&r, turned(turn, a))),
                }
            }
        }
    }

    /// Its position and axes now.
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
    let once = cross(&theta, &u);
    let twice = cross(&theta, &once);
    std::array::from_fn(|i| u[i] + once[i] + twice[i] * 0.5)
}

/// A vector of a cable's section after the slope `p` has moved by `h` and the section has spun by `sigma`: the smallest
/// rotation of the tangent and that about it, one after the other, to second order.
fn slid<S: Jet>(h: V3<S>, sigma: S, p: &[f64], a: V3<f64>) -> V3<S> {
    let inverse = 1.0 / (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt();
    let t = [p[0] * inverse, p[1] * inverse, p[2] * inverse];
    let along = (h[0] * t[0] + h[1] * t[1] + h[2] * t[2]) * inverse;
    let side = cross(&t.map(S::from), &h);
    let omega: V3<S> = std::array::from_fn(|i| side[i] * inverse - side[i] * along * inverse);
    let spin = t.map(|t| sigma * t);
    let a = a.map(S::from);
    let (once, spun) = (cross(&omega, &a), cross(&spin, &a));
    let (twice, both, again) = (cross(&omega, &once), cross(&omega, &spun), cross(&spin, &spun));
    std::array::from_fn(|i| a[i] + once[i] + spun[i] + both[i] + (twice[i] + again[i]) * 0.5)
}

/// The rotation matrix of a frame with coordinates `q`.
pub fn frame(q: &[f64]) -> M3 {
    matrix(&[q[3], q[4], q[5], q[6]])
}

/// Turns a vector of the body into space.
fn rotate<S: Jet>(r: &M3, u: V3<S>) -> V3<S> {
    std::array::from_fn(|i| u[0] * r[i][0] + u[1] * r[i][1] + u[2] * r[i][2])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn point_on_a_turning_body_moves_on_a_circle() {
        let nodes = [Node { kind: NodeKind::Frame, q: 0, v: 0, shared: false }];
        let marker = Marker::beside(NodeId(0), [2.0, 0.0, 0.0]);
        let q = [1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0];
        let v = [0.5, 0.0, 0.0, 0.0, 0.0, 3.0];
        let at = At { t: 0.0, q: &q, v: &v, a: &[0.0; 6], internal: &[], relaxed: None };
        assert_eq!(marker.now(&nodes, &at).x, [3.0, 1.0, 1.0]);
        assert_eq!(marker.velocity(&nodes, &at), [0.5, 6.0, 0.0]);
        assert_eq!(marker.acceleration(&nodes, &at), [-18.0, 0.0, 0.0]);
    }
}
