//! Shapes of bodies and of what stands on the ground.

use ropewalk_core::rotation::{around, cross, from_matrix, matrix, times};
use serde::{Deserialize, Serialize};

use super::Mesh;

/// Where something is and how it is turned.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Its origin [m].
    pub position: [f64; 3],
    /// Unit quaternion, real part first, that turns its axes into those of the ground.
    pub orientation: [f64; 4],
}

impl Default for Pose {
    fn default() -> Self {
        Self { position: [0.0; 3], orientation: [1.0, 0.0, 0.0, 0.0] }
    }
}

impl Pose {
    /// At this place, not turned [m].
    pub fn at(position: [f64; 3]) -> Self {
        Self { position, ..Self::default() }
    }

    /// A point given in its axes, in those of the ground [m].
    pub fn apply(&self, x: &[f64; 3]) -> [f64; 3] {
        let turned = times(&matrix(&self.orientation), x);
        [0, 1, 2].map(|i| self.position[i] + turned[i])
    }
}

/// The surface of something solid, in its own axes.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum Solid {
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
    Box {
        /// Halves of its edges [m].
        half: [f64; 3],
    },
    /// A closed surface of triangles.
    #[serde(skip)]
    Mesh(Mesh),
}

/// A solid somewhere: on the ground, or on a body in its axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Its name in the scene; may be empty.
    pub name: String,
    /// What it is.
    pub solid: Solid,
    /// Where it is.
    pub pose: Pose,
}

impl Shape {
    /// A solid of this name at this place.
    pub fn new(name: impl Into<String>, solid: Solid, pose: Pose) -> Self {
        Self { name: name.into(), solid, pose }
    }

    /// A cylinder between the ends of its axis, such as the hull of a body [m].
    pub fn between(name: impl Into<String>, from: [f64; 3], to: [f64; 3], diameter: f64) -> Self {
        let axis = [0, 1, 2].map(|i| to[i] - from[i]);
        let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
        let middle = [0, 1, 2].map(|i| 0.5 * (from[i] + to[i]));
        let orientation = if length > 0.0 { onto(axis) } else { Pose::default().orientation };
        let solid = Solid::Cylinder { radius: 0.5 * diameter, half: 0.5 * length };
        Self::new(name, solid, Pose { position: middle, orientation })
    }

    /// Its surface as triangles; what has no end is cut off at `reach` from its origin [m].
    pub fn triangles(&self, reach: f64) -> Mesh {
        let mut mesh = self.solid.triangles(reach);
        mesh.points.iter_mut().for_each(|x| *x = self.pose.apply(x));
        mesh
    }
}

/// The turn that takes z onto a direction.
fn onto(direction: [f64; 3]) -> [f64; 4] {
    let [a, _, c] = around(direction);
    let b = cross(&c, &a);
    // the columns are where the axes go
    from_matrix(&[0, 1, 2].map(|i| [a[i], b[i], c[i]]))
}

impl Solid {
    /// Its surface as triangles in its own axes; what has no end is cut off at `reach` [m].
    pub fn triangles(&self, reach: f64) -> Mesh {
        match self {
            Self::Plane => {
                let r = reach;
                let points = vec![[-r, -r, 0.0], [r, -r, 0.0], [r, r, 0.0], [-r, r, 0.0]];
                Mesh { points, triangles: vec![[0, 1, 2], [0, 2, 3]] }
            }
            Self::Ball { radius } => Mesh::ball(*radius),
            Self::Cylinder { radius, half } => Mesh::cylinder(*radius, half.min(reach), true),
            Self::Tube { radius, half } => Mesh::cylinder(*radius, half.min(reach), false),
            Self::Box { half } => Mesh::cuboid(*half),
            Self::Mesh(mesh) => mesh.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cylinder_stands_between_its_ends() {
        for (from, to) in
            [([1.0, 2.0, 3.0], [4.0, -2.0, 5.0]), ([0.0; 3], [0.0, 0.0, -2.0]), ([0.0; 3], [3.0, 0.0, 0.0])]
        {
            let shape = Shape::between("hull", from, to, 0.2);
            let Solid::Cylinder { half, radius } = shape.solid else { panic!() };
            assert_eq!(radius, 0.1);
            for (z, end) in [(-half, from), (half, to)] {
                let x = shape.pose.apply(&[0.0, 0.0, z]);
                assert!((0..3).all(|i| (x[i] - end[i]).abs() < 1e-14), "{x:?} {end:?}");
            }
        }
    }
}
