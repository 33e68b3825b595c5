//! Nodes own coordinates and know how to move along them.
//!
//! Integrators and Newton's method work with velocities and increments, which are plain vectors; only a node
//! knows that an orientation isn't one. `q ⊕ Δ` is [`NodeKind::retract`].

use crate::algebra::rotation::{cross, exp, log, then, vector_rate};
use crate::model::twist;

/// What a node carries.
///
/// ```
/// use ropewalk_core::NodeKind;
/// // a rigid body: position and unit quaternion, velocity and angular velocity
/// assert_eq!((NodeKind::Frame.coordinates(), NodeKind::Frame.velocities()), (7, 6));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum NodeKind {
    /// A position `r` (3 coordinates).
    Point,
    /// A position and a slope, `r` and `r' = dr/dx` (6 coordinates): the node of an ANCF cable.
    Slope,
    /// The same with a reference director `u`, a unit vector normal to the slope, and an angle `θ` (10 coordinates), and
    /// the velocity `(ṙ, ṙ', w)` with the spin `w` of the section about its tangent (7 velocities): the node of a cable
    /// that can be twisted. See [`twist`].
    Twist,
    /// A position and a unit quaternion `(w, x, y, z)` (7 coordinates), with the velocity `(ṙ, ω)`: `ω` in the
    /// body's own axes (6 velocities). The node of a rigid body.
    Frame,
    /// Plain numbers: a line's material coordinate at its end, the angle of a drum.
    Scalars(usize),
}

impl NodeKind {
    /// Number of coordinates.
    pub fn coordinates(self) -> usize {
        match self {
            NodeKind::Point => 3,
            NodeKind::Slope => 6,
            NodeKind::Twist => twist::COORDINATES,
            NodeKind::Frame => 7,
            NodeKind::Scalars(n) => n,
        }
    }

    /// Whether its first three coordinates are a position.
    pub fn has_position(self) -> bool {
        !matches!(self, NodeKind::Scalars(_))
    }

    /// Number of velocities, increments and equations.
    pub fn velocities(self) -> usize {
        match self {
            NodeKind::Frame => 6,
            NodeKind::Twist => twist::VELOCITIES,
            other => other.coordinates(),
        }
    }

    /// Whether it has a slope, behind its position: the node of a cable.
    pub fn has_slope(self) -> bool {
        matches!(self, NodeKind::Slope | NodeKind::Twist)
    }

    /// Whether it has an orientation, so that `q ⊕ d` isn't `q + d`.
    pub fn turns(self) -> bool {
        matches!(self, NodeKind::Frame | NodeKind::Twist)
    }

    /// `out = q ⊕ d`: moves along the increment `d`. For a frame the last three entries of `d` are a rotation
    /// vector in the body's own axes, applied by the exponential map, and the quaternion keeps its unit norm.
    pub fn retract(self, q: &[f64], d: &[f64], out: &mut [f64]) {
        if self == NodeKind::Frame {
            for i in 0..3 {
                out[i] = q[i] + d[i];
            }
            let p = then([q[3], q[4], q[5], q[6]], exp([d[3], d[4], d[5]]));
            let norm = p.iter().map(|x| x * x).sum::<f64>().sqrt();
            for i in 0..4 {
                out[3 + i] = p[i] / norm;
            }
        } else if self == NodeKind::Twist {
            twist::retract(q, d, out);
        } else {
            for i in 0..q.len() {
                out[i] = q[i] + d[i];
            }
        }
    }

    /// The velocity of the motion `q ⊕ d(t)` from `q`, whose increment changes at `rate`. For a frame the angular velocity is
    /// `θ̇ - (1-cos φ)/φ² θ×θ̇ + (φ-sin φ)/φ³ θ×(θ×θ̇)` (Iserles, Munthe-Kaas, Nørsett & Zanna 2000, "dexp").
    pub fn velocity(self, q: &[f64], d: &[f64], rate: &[f64], v: &mut [f64]) {
        v.copy_from_slice(rate);
        if self == NodeKind::Twist {
            twist::velocity(q, d, v);
        }
        if self == NodeKind::Frame {
            let theta = [d[3], d[4], d[5]];
            let once = cross(&theta, &[rate[3], rate[4], rate[5]]);
            let twice = cross(&theta, &once);
            let square = theta.iter().map(|x| x * x).sum::<f64>();
            let angle = square.sqrt();
            let (a, b) = if angle < 1e-2 {
                (
                    0.5 - square / 24.0 * (1.0 - square / 30.0),
                    1.0 / 6.0 - square / 120.0 * (1.0 - square / 42.0),
                )
            } else {
                (2.0 * (0.5 * angle).sin().powi(2) / square, (angle - angle.sin()) / (square * angle))
            };
            for i in 0..3 {
                v[3 + i] += b * twice[i] - a * once[i];
            }
        }
    }

    /// First and second time derivatives of the increment in a motion `q ⊕ d(t)` with these velocities and accelerations:
    /// undoes [`NodeKind::velocity`] and its derivative. For rotations by less than a whole turn.
    pub fn rates(self, q: &[f64], d: &[f64], v: &[f64], a: &[f64], first: &mut [f64], second: &mut [f64]) {
        first.copy_from_slice(v);
        second.copy_from_slice(a);
        if self == NodeKind::Twist {
            twist::rates(q, d, first, second);
        }
        if self == NodeKind::Frame {
            let [d, v, a] = [d, v, a].map(|x| [x[3], x[4], x[5]]);
            let square = d.iter().map(|x| x * x).sum::<f64>();
            let angle = square.sqrt();
            // ω = ḋ - A d×ḋ + B d×(d×ḋ), and Ȧ and Ḃ per d·ḋ
            let [b, a_dot, b_dot] = if angle < 1e-2 {
                [1.0 / 6.0 - square / 120.0, -1.0 / 12.0 + square / 180.0, -1.0 / 60.0 + square / 1260.0]
            } else {
                let (sin, cos) = angle.sin_cos();
                [
                    (angle - sin) / (square * angle),
                    (angle * sin - 2.0 * (1.0 - cos)) / (square * square),
                    (3.0 * sin - angle * (2.0 + cos)) / (square * square * angle),
                ]
            };
            let rate = vector_rate(&d, &v);
            let along: f64 = (0..3).map(|i| d[i] * rate[i]).sum();
            let once = cross(&d, &rate);
            let (twice, mixed) = (cross(&d, &once), cross(&rate, &once));
            let bent = |i: usize| along * (b_dot * twice[i] - a_dot * once[i]) + b * mixed[i];
            first[3..6].copy_from_slice(&rate);
            second[3..6].copy_from_slice(&vector_rate(&d, &std::array::from_fn(|i| a[i] - bent(i))));
        }
    }

    /// The increment `d` that leads from `from` to `to`: `to = from ⊕ d`.
    pub fn difference(self, from: &[f64], to: &[f64], d: &mut [f64]) {
        if self == NodeKind::Twist {
            return twist::difference(from, to, d);
        }
        let plain = if self == NodeKind::Frame { 3 } else { from.len() };
        for i in 0..plain {
            d[i] = to[i] - from[i];
        }
        if self == NodeKind::Frame {
            let back = [from[3], -from[4], -from[5], -from[6]];
            d[3..6].copy_from_slice(&log(then(back, [to[3], to[4], to[5], to[6]])));
        }
    }
}

/// Index of a node in its model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct NodeId(pub u32);

/// A node in a model: its kind, and where its numbers stand in the vectors of the whole model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Node {
    /// What it carries.
    pub kind: NodeKind,
    /// Index of its first coordinate in `q`.
    pub q: usize,
    /// Index of its first velocity in `v` (and increment, and equation).
    pub v: usize,
    /// Shared by many elements (a drum, the end coordinate of a line): eliminated last.
    pub shared: bool,
}

impl Node {
    /// The indices of its velocities.
    pub fn dofs(&self) -> std::ops::Range<usize> {
        self.v..self.v + self.kind.velocities()
    }
    /// The indices of its coordinates.
    pub fn coords(&self) -> std::ops::Range<usize> {
        self.q..self.q + self.kind.coordinates()
    }
}

/// Moves every node: `out = q ⊕ d`.
///
/// ```
/// use ropewalk_core::{Node, NodeKind, difference, retract};
/// let nodes = [Node { kind: NodeKind::Frame, q: 0, v: 0, shared: false }];
/// let (q, d) = ([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0], [1.0, 2.0, 3.0, 0.1, 0.2, 0.3]);
/// let (mut moved, mut back) = ([0.0; 7], [0.0; 6]);
/// retract(&nodes, &q, &d, &mut moved);
/// difference(&nodes, &q, &moved, &mut back);
/// assert!(back.iter().zip(d).all(|(a, b)| (a - b).abs() < 1e-15));
/// ```
pub fn retract(nodes: &[Node], q: &[f64], d: &[f64], out: &mut [f64]) {
    for n in nodes {
        n.kind.retract(&q[n.coords()], &d[n.dofs()], &mut out[n.coords()]);
    }
}

/// The velocities of every node in the motion `q ⊕ d(t)` from `q`, whose increments change at `rate`.
pub fn velocity(nodes: &[Node], q: &[f64], d: &[f64], rate: &[f64], v: &mut [f64]) {
    for n in nodes {
        n.kind.velocity(&q[n.coords()], &d[n.dofs()], &rate[n.dofs()], &mut v[n.dofs()]);
    }
}

/// The increments of every node: `to = from ⊕ d`.
pub fn difference(nodes: &[Node], from: &[f64], to: &[f64], d: &mut [f64]) {
    for n in nodes {
        n.kind.difference(&from[n.coords()], &to[n.coords()], &mut d[n.dofs()]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frame_turns_about_a_fixed_axis_and_keeps_its_norm() {
        let mut q = vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
        let steps = 100_000;
        let d = [1e-5, 0.0, 0.0, 0.0, 0.0, std::f64::consts::PI / steps as f64];
        for _ in 0..steps {
            let mut next = vec![0.0; 7];
            NodeKind::Frame.retract(&q, &d, &mut next);
            q = next;
        }
        approx::assert_relative_eq!(q[0], 1.0, max_relative = 1e-9);
        approx::assert_abs_diff_eq!(q[3], 0.0, epsilon = 1e-9);
        approx::assert_relative_eq!(q[6], 1.0, max_relative = 1e-12);
        let norm: f64 = q[3..].iter().map(|x| x * x).sum();
        approx::assert_relative_eq!(norm, 1.0, max_relative = 1e-12);
    }

    #[test]
    fn difference_undoes_retract() {
        let q = [1.0, 2.0, 3.0, 0.5, -0.5, 0.5, 0.5];
        let d = [0.3, -0.2, 0.1, 1.2, -0.4, 0.9];
        let (mut to, mut back) = ([0.0; 7], [0.0; 6]);
        NodeKind::Frame.retract(&q, &d, &mut to);
        NodeKind::Frame.difference(&q, &to, &mut back);
        for i in 0..6 {
            approx::assert_relative_eq!(back[i], d[i], max_relative = 1e-12);
        }
    }

    #[test]
    fn velocity_is_the_derivative_of_the_motion() {
        let q = [1.0, 2.0, 3.0, 0.5, -0.5, 0.5, 0.5];
        let (d, rate) = ([0.3, -0.2, 0.1, 1.2, -0.4, 0.9], [1.0, 2.0, 3.0, -0.7, 0.8, 1.5]);
        for size in [1.0, 1e-3, 0.0] {
            let d = d.map(|x| size * x);
            let place = |t: f64| {
                let moved: [f64; 6] = std::array::from_fn(|i| d[i] + t * rate[i]);
                let mut to = [0.0; 7];
                NodeKind::Frame.retract(&q, &moved, &mut to);
                to
            };
            let mut exact = [0.0; 6];
            NodeKind::Frame.velocity(&q, &d, &rate, &mut exact);
            let now = place(0.0);
            let v = crate::testing::difference(|t| {
                let mut v = vec![0.0; 6];
                NodeKind::Frame.difference(&now, &place(t), &mut v);
                v
            });
            for i in 0..6 {
                approx::assert_abs_diff_eq!(v[i], exact[i], epsilon = 1e-10);
            }
        }
    }

    #[test]
    fn rates_undo_the_velocity_and_its_derivative() {
        let (d, rate, bend) = ([0.3, -0.2, 0.1, 1.2, -0.4, 0.9], [1.0, 2.0, 3.0, -0.7, 0.8, 1.5], [0.4; 6]);
        for size in [1.0, 1e-3, 0.0] {
            let velocity = |t: f64| {
                let d: [f64; 6] = std::array::from_fn(|i| size * d[i] + t * rate[i] + 0.5 * t * t * bend[i]);
                let mut v = vec![0.0; 6];
                NodeKind::Frame.velocity(
                    &[],
                    &d,
                    &std::array::from_fn::<_, 6, _>(|i| rate[i] + t * bend[i]),
                    &mut v,
                );
                v
            };
            let (v, a) = (velocity(0.0), crate::testing::difference(velocity));
            let (mut first, mut second) = ([0.0; 6], [0.0; 6]);
            NodeKind::Frame.rates(&[], &d.map(|x| size * x), &v, &a, &mut first, &mut second);
            for i in 0..6 {
                approx::assert_abs_diff_eq!(first[i], rate[i], epsilon = 1e-12);
                approx::assert_abs_diff_eq!(second[i], bend[i], epsilon = 1e-9);
            }
        }
    }

    #[test]
    fn vectors_move_by_addition() {
        let mut out = [0.0; 6];
        NodeKind::Slope.retract(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], &[0.5; 6], &mut out);
        assert_eq!(out, [1.5, 2.5, 3.5, 4.5, 5.5, 6.5]);
    }
}
