//! Shapes to touch, as a scene names them.

use super::file::read;
use super::mesh::Mesh;
use super::shape::Shape;
use super::spec::one;
use ropewalk_core::error::{finite, positive};
use ropewalk_core::rotation::{IDENTITY, M3, around, from_bryant, matrix};
use ropewalk_core::{BuildError, V3, dot};
use ropewalk_scene::quantity;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::sync::Arc;

/// A shape to touch, in the axes of the rigid body that it is on, or of space, with its middle at the marker.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ShapeSpec {
    /// A half-space below a plane through the marker: a floor, a wall.
    Plane {
        /// Outward normal. Default: upwards (z).
        #[serde(default = "upwards")]
        normal: V3<f64>,
    },
    /// A ball.
    Sphere {
        /// Radius [m].
        #[serde(deserialize_with = "quantity::length")]
        radius: f64,
    },
    /// A cylinder with flat ends: a drum, a sheave, a pile.
    Cylinder {
        /// Direction of its axis.
        axis: V3<f64>,
        /// Radius [m].
        #[serde(deserialize_with = "quantity::length")]
        radius: f64,
        /// Length [m]. Default: infinite.
        #[serde(default, deserialize_with = "quantity::optional::length")]
        length: Option<f64>,
    },
    /// The inside of a tube: a round hole through a wall without outer side.
    Tube {
        /// Direction of its axis.
        axis: V3<f64>,
        /// Inner radius [m].
        #[serde(deserialize_with = "quantity::length")]
        radius: f64,
        /// Length [m]. Default: infinite.
        #[serde(default, deserialize_with = "quantity::optional::length")]
        length: Option<f64>,
    },
    /// A cuboid: a deck, a thick wall.
    Cuboid {
        /// Lengths of the edges [m].
        #[serde(deserialize_with = "quantity::vec3::length")]
        edges: V3<f64>,
        /// Turns about x, the new y and the new z [rad].
        #[serde(default, deserialize_with = "quantity::vec3::angle")]
        angles: V3<f64>,
    },
    /// The convex hull of points.
    Hull {
        /// The points from the marker [m].
        #[serde(deserialize_with = "quantity::points")]
        points: Vec<V3<f64>>,
    },
    /// Triangles from a file.
    Mesh {
        /// An STL or OBJ file; its path is relative to the scene file.
        file: PathBuf,
        /// Size of the file's unit of length [m]: 0.001 where it is in millimetres.
        #[serde(default = "one", deserialize_with = "quantity::length")]
        unit: f64,
        /// Turns about x, the new y and the new z [rad].
        #[serde(default, deserialize_with = "quantity::vec3::angle")]
        angles: V3<f64>,
        /// Whether it is an open surface, such as a sea floor, instead of a closed solid. Contact is on the side of
        /// the triangles' normals.
        #[serde(default)]
        open: bool,
    },
}

fn upwards() -> V3<f64> {
    [0.0, 0.0, 1.0]
}
/// A direction that isn't zero.
fn direction(field: &str, d: &V3<f64>) -> Result<M3, BuildError> {
    finite(field, d)?;
    if dot(d, d) == 0.0 {
        return Err(BuildError::at(field, format!("`{field}` must not be zero: it is a direction")));
    }
    Ok(around(*d))
}

impl ShapeSpec {
    /// The shape, and its axes in those of its body.
    ///
    /// # Errors
    /// Sizes that aren't positive, directions of no length, a file that can't be used.
    pub fn shape(&self) -> Result<(Shape, M3), BuildError> {
        let half = |length: &Option<f64>| match length {
            Some(l) => positive("length", *l).map(|l| 0.5 * l),
            None => Ok(f64::INFINITY),
        };
        // rows of a matrix that turns into the body are columns of the axes
        let axes = |angles: &V3<f64>| -> Result<M3, BuildError> {
            finite("angles", angles)?;
            let r = matrix(&from_bryant(*angles));
            Ok(std::array::from_fn(|i| std::array::from_fn(|j| r[j][i])))
        };
        Ok(match self {
            ShapeSpec::Plane { normal } => (Shape::Plane, direction("normal", normal)?),
            ShapeSpec::Sphere { radius } => (Shape::Ball { radius: positive("radius", *radius)? }, IDENTITY),
            ShapeSpec::Cylinder { axis, radius, length } => {
                let radius = positive("radius", *radius)?;
                (Shape::Cylinder { radius, half: half(length)? }, direction("axis", axis)?)
            }
            ShapeSpec::Tube { axis, radius, length } => {
                let radius = positive("radius", *radius)?;
                (Shape::Tube { radius, half: half(length)? }, direction("axis", axis)?)
            }
            ShapeSpec::Cuboid { edges, angles } => {
                for e in edges {
                    positive("edges", *e)?;
                }
                (Shape::Cuboid { half: edges.map(|e| 0.5 * e) }, axes(angles)?)
            }
            ShapeSpec::Hull { points } => {
                for p in points {
                    finite("points", p)?;
                }
                (Shape::Mesh(Arc::new(Mesh::hull(points)?)), IDENTITY)
            }
            ShapeSpec::Mesh { file, unit, angles, open } => {
                positive("unit", *unit)?;
                let wrong = |why: String| BuildError::new(format!("mesh `{}`: {why}", file.display()));
                let soup = read(file).map_err(wrong)?.placed(*unit, &IDENTITY);
                let mesh = Mesh::new(soup, *open).map_err(|e| wrong(e.message))?;
                (Shape::Mesh(Arc::new(mesh)), axes(angles)?)
            }
        })
    }
}
