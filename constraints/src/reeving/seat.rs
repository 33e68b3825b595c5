//! Where a wheel is, and what carries it.

use super::inline::{each, three};
use ropewalk_core::rotation::{cross, matrix, times};
use ropewalk_core::{At, BuildError, Jet, Marker, Node, NodeKind, V3};

/// The rotation of a body whose coordinates begin at `q`, after a small turn in its own axes: to first order, all that a first
/// derivative needs.
#[inline(always)]
pub(super) fn turned<S: Jet>(at: &At<'_>, q: usize, small: &V3<S>) -> [V3<S>; 3] {
    let still = matrix(&[at.q[q + 3], at.q[q + 4], at.q[q + 5], at.q[q + 6]]);
    three!(|i| {
        let row = each!(still[i], |x| S::from(x));
        let more = cross(&row, small);
        three!(|j| row[j] + more[j])
    })
}

/// What carries a wheel: a point and an axis of space, of a point, or of a rigid body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Seat {
    /// First coordinate and velocity of what carries it, and whether that has an orientation.
    pub on: Option<(usize, usize, bool)>,
    /// Place of the centre and axis, in the axes of what carries it.
    pub point: V3<f64>,
    pub axis: V3<f64>,
}

impl Seat {
    /// Of a marker whose third axis is that of the wheel.
    pub fn new(nodes: &[Node], marker: &Marker) -> Result<Self, BuildError> {
        match marker {
            Marker::Ground { point, axes } => Ok(Seat { on: None, point: *point, axis: axes[2] }),
            Marker::Node { node, point, axes } => {
                let n = &nodes[node.0 as usize];
                let turns = match n.kind {
                    NodeKind::Frame => true,
                    NodeKind::Point => false,
                    _ => {
                        let message = "a sheave is on a rigid body, or at a point in space";
                        return Err(BuildError::at("marker", message));
                    }
                };
                let point = if turns { *point } else { [0.0; 3] };
                Ok(Seat { on: Some((n.q, n.v, turns)), point, axis: axes[2] })
            }
        }
    }

    /// Number of velocities of what carries it.
    pub fn size(&self) -> usize {
        self.on.map_or(0, |(_, _, turns)| if turns { 6 } else { 3 })
    }

    /// A vector in the axes of what carries it, in space.
    fn turned(&self, at: &At<'_>, x: &V3<f64>) -> V3<f64> {
        match self.on {
            Some((q, _, true)) => times(&matrix(&[at.q[q + 3], at.q[q + 4], at.q[q + 5], at.q[q + 6]]), x),
            _ => *x,
        }
    }

    /// Its axis in space.
    pub fn axis_now(&self, at: &At<'_>) -> V3<f64> {
        self.turned(at, &self.axis)
    }

    /// Its centre in space.
    pub fn centre_now(&self, at: &At<'_>) -> V3<f64> {
        let out = self.turned(at, &self.point);
        self.on.map_or(out, |(q, _, _)| std::array::from_fn(|i| at.q[q + i] + out[i]))
    }

    /// Velocity of what carries it at a place in space [m/s].
    pub fn velocity(&self, at: &At<'_>, place: &V3<f64>) -> V3<f64> {
        let Some((q, v, turns)) = self.on else { return [0.0; 3] };
        let mut velocity: V3<f64> = std::array::from_fn(|i| at.v[v + i]);
        if turns {
            let spin = self.turned(at, &std::array::from_fn(|i| at.v[v + 3 + i]));
            let swing = cross(&spin, &std::array::from_fn(|i| place[i] - at.q[q + i]));
            (0..3).for_each(|i| velocity[i] += swing[i]);
        }
        velocity
    }
}
