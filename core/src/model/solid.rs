//! Solids: what bodies, and the things that parts touch, look like from outside.

use crate::algebra::lane::V3;
use crate::algebra::rotation::{around, from_matrix};
use crate::model::node::{Node, NodeKind};
use crate::model::state::At;

/// The surface of something solid, in its own axes.
#[derive(Clone, Debug, PartialEq)]
pub enum Surface {
    /// All below z = 0.
    Plane,
    /// A ball.
    Ball {
        /// Radius [m].
        radius: f64,
    },
    /// A cylinder along z.
    Cylinder {
        /// Radius [m].
        radius: f64,
        /// Half of its length [m]; may be infinite.
        half: f64,
    },
    /// A round hole along z.
    Tube {
        /// Inner radius [m].
        radius: f64,
        /// Half of its length [m]; may be infinite.
        half: f64,
    },
    /// A cuboid.
    Cuboid {
        /// Halves of its edges [m].
        half: V3<f64>,
    },
    /// Triangles over shared corners, anticlockwise from outside.
    Triangles {
        /// The corners [m].
        corners: Vec<V3<f64>>,
        /// Numbers of the corners of each triangle.
        triangles: Vec<[u32; 3]>,
    },
}

/// A solid on the ground or on a rigid body.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    /// Its name in the scene; that of its body for a hull.
    pub name: String,
    /// What it is.
    pub surface: Surface,
    /// First coordinate of the node of the body that carries it; `None` on the ground.
    pub carrier: Option<usize>,
    /// Where it is: from that node and in its axes, or in space.
    pub seat: Attitude,
}

/// Where something is and how it is turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attitude {
    /// Its origin [m].
    pub x: V3<f64>,
    /// Unit quaternion, real part first, that turns its axes into those of space.
    pub turn: [f64; 4],
}

impl Attitude {
    /// At a place, turned such that its axes are these, one after the other.
    pub fn new(x: V3<f64>, axes: &[V3<f64>; 3]) -> Self {
        // the columns of the matrix are where the axes go
        let columns = [0, 1, 2].map(|i| [axes[0][i], axes[1][i], axes[2][i]]);
        Attitude { x, turn: from_matrix(&columns) }
    }

    /// Of a node now; one without an orientation isn't turned. `None` for a node without position.
    pub fn of(node: &Node, at: &At<'_>) -> Option<Self> {
        let q = &at.q[node.coords()];
        let x = node.kind.has_position().then(|| [q[0], q[1], q[2]])?;
        let turn = if node.kind == NodeKind::Frame { [q[3], q[4], q[5], q[6]] } else { [1.0, 0.0, 0.0, 0.0] };
        Some(Attitude { x, turn })
    }
}

impl Solid {
    /// A cylinder between the ends of its axis [m].
    pub fn between(name: &str, carrier: Option<usize>, ends: [V3<f64>; 2], diameter: f64) -> Self {
        let along: V3<f64> = std::array::from_fn(|i| ends[1][i] - ends[0][i]);
        let length = along.iter().map(|x| x * x).sum::<f64>().sqrt();
        let middle = std::array::from_fn(|i| 0.5 * (ends[0][i] + ends[1][i]));
        let surface = Surface::Cylinder { radius: 0.5 * diameter, half: 0.5 * length };
        Solid { name: name.into(), surface, carrier, seat: Attitude::new(middle, &around(along)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::rotation::{IDENTITY, matrix, times};

    #[test]
    fn a_cylinder_lies_between_its_ends() {
        let ends = [[1.0, 2.0, 3.0], [4.0, -2.0, 5.0]];
        let solid = Solid::between("", Some(7), ends, 0.2);
        let (seat, Surface::Cylinder { half, .. }) = (solid.seat, solid.surface) else { panic!() };
        for (z, end) in [(-half, ends[0]), (half, ends[1])] {
            let arm = times(&matrix(&seat.turn), &[0.0, 0.0, z]);
            assert!((0..3).all(|i| (seat.x[i] + arm[i] - end[i]).abs() < 1e-14));
        }
    }

    #[test]
    fn axes_turn_as_they_say() {
        let axes = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]];
        let turn = Attitude::new([0.0; 3], &axes).turn;
        for (e, axis) in IDENTITY.iter().zip(axes) {
            let there = times(&matrix(&turn), e);
            assert!((0..3).all(|i| (there[i] - axis[i]).abs() < 1e-15), "{there:?}");
        }
    }
}
