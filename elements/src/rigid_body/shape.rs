//! Mass and moments of inertia: given, or of a simple shape.

use ropewalk_core::error::{finite, positive};
use ropewalk_core::rotation::{IDENTITY, M3};
use ropewalk_core::{BuildError, Surface, V3};
use ropewalk_scene::quantity;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A homogeneous shape with its centre of mass in the middle. Axes are those of the body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Shape {
    /// A cylinder, or with an inner radius a tube, along the body's x axis.
    Cylinder {
        /// Length [m].
        #[serde(deserialize_with = "quantity::length")]
        length: f64,
        /// Outer radius [m].
        #[serde(deserialize_with = "quantity::length")]
        radius: f64,
        /// Inner radius [m].
        #[serde(default, deserialize_with = "quantity::length")]
        inner: f64,
    },
    /// A ball.
    Sphere {
        /// Radius [m].
        #[serde(deserialize_with = "quantity::length")]
        radius: f64,
    },
    /// A cuboid with edges along the body's axes.
    Cuboid {
        /// Lengths of the edges [m].
        #[serde(deserialize_with = "quantity::vec3::length")]
        edges: V3<f64>,
    },
}

impl Shape {
    /// What it looks like, and its axes in those of the body.
    pub(crate) fn surface(&self) -> (Surface, M3) {
        let [x, y, z] = IDENTITY;
        match *self {
            Shape::Cylinder { length, radius, .. } => {
                (Surface::Cylinder { radius, half: 0.5 * length }, [y, z, x])
            }
            Shape::Sphere { radius } => (Surface::Ball { radius }, IDENTITY),
            Shape::Cuboid { edges } => (Surface::Cuboid { half: edges.map(|e| 0.5 * e) }, IDENTITY),
        }
    }

    /// Volume [m³] and moments of inertia per mass [m²].
    ///
    /// # Errors
    /// A size that isn't positive; a tube whose inner radius isn't less than its outer one.
    pub fn properties(&self) -> Result<(f64, V3<f64>), BuildError> {
        match *self {
            Shape::Cylinder { length, radius, inner } => {
                positive("length", length)?;
                positive("radius", radius)?;
                if !(0.0..radius).contains(&inner) {
                    let message =
                        format!("`inner` must be from 0 to less than the radius {radius}, but is {inner}");
                    return Err(BuildError::at("inner", message));
                }
                let squares = radius * radius + inner * inner;
                let across = squares / 4.0 + length * length / 12.0;
                let area = PI * (radius * radius - inner * inner);
                Ok((area * length, [squares / 2.0, across, across]))
            }
            Shape::Sphere { radius } => {
                positive("radius", radius)?;
                Ok((4.0 / 3.0 * PI * radius.powi(3), [0.4 * radius * radius; 3]))
            }
            Shape::Cuboid { edges } => {
                for edge in edges {
                    positive("edges", edge)?;
                }
                let [a, b, c] = edges.map(|e| e * e / 12.0);
                Ok((edges.iter().product(), [b + c, a + c, a + b]))
            }
        }
    }
}

/// Checks that these can be the moments [kg m²] and products of inertia about a centre of mass, and makes their matrix.
/// `products` are `J_xy`, `J_xz`, `J_yz`, the entries of the matrix.
///
/// # Errors
/// Numbers that aren't finite, a principal moment that isn't positive or is larger than the sum of the other two.
pub fn inertia(moments: V3<f64>, products: V3<f64>) -> Result<M3, BuildError> {
    finite("inertia", &moments)?;
    finite("products", &products)?;
    let ([x, y, z], [xy, xz, yz]) = (moments, products);
    let j = [[x, xy, xz], [xy, y, yz], [xz, yz, z]];
    let mut principal: Vec<f64> = nalgebra::SymmetricEigen::new(nalgebra::Matrix3::from_fn(|i, k| j[i][k]))
        .eigenvalues
        .iter()
        .copied()
        .collect();
    principal.sort_by(f64::total_cmp);
    let [least, middle, most] = [principal[0], principal[1], principal[2]];
    if !(least > 0.0) {
        let message = format!(
            "the principal moments of inertia must be positive, but the least is {least:.3e} kg m²; a rod resists \
             turning about its own axis too, by m r²/2"
        );
        return Err(BuildError::at("inertia", message));
    }
    if most > (least + middle) * (1.0 + 1e-9) {
        let message = format!(
            "no body has these moments of inertia: the largest principal one, {most:.6e}, exceeds the sum of the other \
             two, {:.6e} kg m²",
            least + middle
        );
        return Err(BuildError::at("inertia", message));
    }
    Ok(j)
}
