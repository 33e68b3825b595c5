//! Shapes that points touch: distance, normal and curvature in closed form; meshes by their triangles.

use super::heights::Heights;
use super::mesh::Mesh;
use super::round::Sextic;
use super::search::Cubic;
use ropewalk_core::rotation::{around, cross};
use ropewalk_core::{Surface, V3, dot};
use std::sync::Arc;

/// A shape in axes of its own, with its middle at the origin.
#[derive(Clone, Debug)]
pub enum Shape {
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
    /// A round hole along z, through a wall without end.
    Tube {
        /// Inner radius [m].
        radius: f64,
        /// Half of its length [m]; may be infinite.
        half: f64,
    },
    /// A cuboid.
    Cuboid {
        /// Half of its edges [m].
        half: V3<f64>,
    },
    /// A surface of triangles.
    Mesh(Arc<Mesh>),
    /// All below heights on a grid.
    Heights(Arc<Heights>),
}

/// How far a point is from a surface, and how the surface lies there.
#[derive(Clone, Copy, Debug)]
pub struct Gap {
    /// Distance, negative inside [m].
    pub distance: f64,
    /// Its gradient: a unit vector, outwards.
    pub normal: V3<f64>,
    /// The derivative of the normal: curvatures [1/m], each along a unit vector normal to it.
    pub bends: [(f64, V3<f64>); 2],
}

const FLAT: (f64, V3<f64>) = (0.0, [0.0; 3]);

impl Gap {
    /// A flat surface.
    pub(crate) fn flat(distance: f64, normal: V3<f64>) -> Self {
        Gap { distance, normal, bends: [FLAT; 2] }
    }
    /// Around a corner: all points of the same distance are a ball.
    pub(crate) fn round(distance: f64, normal: V3<f64>, curvature: f64) -> Self {
        let [a, b, _] = around(normal);
        Gap { distance, normal, bends: [(curvature, a), (curvature, b)] }
    }
    /// `H w`: how the normal turns when the point moves by `w`.
    #[inline]
    pub fn turn(&self, w: &V3<f64>) -> V3<f64> {
        let [(a, x), (b, y)] = &self.bends;
        let (a, b) = (a * dot(x, w), b * dot(y, w));
        std::array::from_fn(|i| a * x[i] + b * y[i])
    }
    /// All directions turned.
    pub(crate) fn turned(self, by: impl Fn(&V3<f64>) -> V3<f64>) -> Self {
        let turned = |(k, x): &(f64, V3<f64>)| if *k == 0.0 { FLAT } else { (*k, by(x)) };
        Gap {
            distance: self.distance,
            normal: by(&self.normal),
            bends: [turned(&self.bends[0]), turned(&self.bends[1])],
        }
    }
}

impl Shape {
    /// The surface as seen from a point, if it is nearer than `reach` [m].
    #[inline]
    pub fn gap(&self, x: &V3<f64>, reach: f64) -> Option<Gap> {
        match self {
            Shape::Plane => (x[2] < reach).then(|| Gap::flat(x[2], [0.0, 0.0, 1.0])),
            Shape::Ball { radius } => {
                let square = dot(x, x);
                if square >= (radius + reach) * (radius + reach) {
                    return None;
                }
                let length = square.sqrt();
                // at the centre any direction leads out
                if length == 0.0 {
                    return Some(Gap::flat(-radius, [0.0, 0.0, 1.0]));
                }
                Some(Gap::round(length - radius, x.map(|x| x / length), 1.0 / length))
            }
            Shape::Cylinder { radius, half } => {
                let far = radius + reach;
                if x[2].abs() - half >= reach || x[0] * x[0] + x[1] * x[1] >= far * far {
                    return None;
                }
                revolved(x, *radius, *half, 1.0, reach)
            }
            Shape::Tube { radius, half } => {
                let near = radius - reach;
                if x[2].abs() - half >= reach || near > 0.0 && x[0] * x[0] + x[1] * x[1] <= near * near {
                    return None;
                }
                revolved(x, *radius, *half, -1.0, reach)
            }
            Shape::Cuboid { half } => cuboid(x, half, reach),
            Shape::Mesh(mesh) => mesh.gap(x, reach),
            Shape::Heights(heights) => heights.gap(x, reach),
        }
    }

    /// What it looks like.
    pub(crate) fn surface(&self) -> Surface {
        match *self {
            Shape::Plane => Surface::Plane,
            Shape::Ball { radius } => Surface::Ball { radius },
            Shape::Cylinder { radius, half } => Surface::Cylinder { radius, half },
            Shape::Tube { radius, half } => Surface::Tube { radius, half },
            Shape::Cuboid { half } => Surface::Cuboid { half },
            Shape::Mesh(ref mesh) => {
                let (corners, triangles) = mesh.surface();
                Surface::Triangles { corners, triangles }
            }
            Shape::Heights(ref heights) => {
                let (corners, triangles) = heights.surface();
                Surface::Triangles { corners, triangles }
            }
        }
    }

    /// A distance that the surface is at least away, as cheap as can be: the true one, but of a mesh that is far away.
    pub(crate) fn at_least(&self, x: &V3<f64>) -> Option<Gap> {
        match self {
            Shape::Mesh(mesh) => mesh.at_least(x),
            Shape::Heights(heights) => heights.at_least(x),
            shape => shape.gap(x, f64::INFINITY),
        }
    }

    /// How hollow the distance is around the shape within `way` of a point: the largest curvature with which level
    /// surfaces bend towards whoever is outside, where they are nearer than `reach` [1/m]. Zero around a convex solid,
    /// infinite where there may be a valley.
    pub(crate) fn hollow(&self, x: &V3<f64>, way: f64, reach: f64) -> f64 {
        match self {
            Shape::Plane | Shape::Ball { .. } | Shape::Cylinder { .. } | Shape::Cuboid { .. } => 0.0,
            Shape::Tube { .. } => 1.0 / (x[0].hypot(x[1]) - way).max(0.0),
            Shape::Mesh(mesh) => mesh.hollow(x, way, reach),
            Shape::Heights(heights) => heights.hollow(x, way, reach),
        }
    }

    /// Whether it is round or flat all over but for edges, so that curvature tells how its distance changes.
    pub(crate) fn is_round(&self) -> bool {
        matches!(self, Shape::Plane | Shape::Ball { .. } | Shape::Cylinder { .. } | Shape::Tube { .. })
    }

    /// The largest curvature of its level surfaces within `way` of a point [1/m], if all that is seen from there is one and the
    /// same ball, flank or plane.
    pub(crate) fn roundest(&self, x: &V3<f64>, way: f64) -> Option<f64> {
        let within = |rho: f64| (rho > way).then(|| 1.0 / (rho - way));
        match self {
            Shape::Plane => Some(0.0),
            Shape::Ball { .. } => within(dot(x, x).sqrt()),
            Shape::Cylinder { radius, half } | Shape::Tube { radius, half } => {
                let rho = (x[0] * x[0] + x[1] * x[1]).sqrt();
                let beyond = x[2].abs() - half + way;
                let out = if let Shape::Tube { .. } = self { radius - rho } else { rho - radius };
                // nowhere beyond the ends, nor nearer to one of them than to the flank
                if beyond < (out - way).min(0.0) { within(rho) } else { None }
            }
            Shape::Cuboid { .. } | Shape::Mesh(_) | Shape::Heights(_) => None,
        }
    }

    /// A polynomial that is above zero where a curve of this radius touches, if all of the curve is beside a ball or a flank.
    pub(crate) fn nearness(&self, curve: &Cubic, radius: f64) -> Option<Sextic> {
        let controls = curve.controls();
        let beside = |half: f64| controls.iter().all(|p| p[2].abs() <= half);
        match *self {
            Shape::Ball { radius: r } => Some(Sextic::square(&controls, 3).less((r + radius).powi(2), -1.0)),
            Shape::Cylinder { radius: r, half } if beside(half) => {
                Some(Sextic::square(&controls, 2).less((r + radius).powi(2), -1.0))
            }
            // what is thicker than the hole touches everywhere
            Shape::Tube { radius: r, half } if r > radius && beside(half) => {
                Some(Sextic::square(&controls, 2).less((r - radius).powi(2), 1.0))
            }
            _ => None,
        }
    }

    /// Whether it is solid and without hollows: any plane that touches it has all of it on one side.
    pub(crate) fn convex(&self) -> bool {
        !self.concave() && !matches!(self, Shape::Tube { .. })
    }

    /// Points of the Gauss rule that integrates the contact with a piece of this length to what Newton's method and
    /// the balance of energy can tell: four are exact on a plane where the force is linear, more are for curved ones.
    pub(crate) fn points(&self, length: f64, linear: bool) -> usize {
        match self {
            Shape::Plane if linear => 4,
            Shape::Plane | Shape::Heights(_) => 6,
            Shape::Ball { radius } | Shape::Cylinder { radius, .. } | Shape::Tube { radius, .. } => {
                if length > *radius { 8 } else { 6 }
            }
            Shape::Cuboid { .. } | Shape::Mesh(_) => 8,
        }
    }

    /// Whether another part of the surface can come nearer than the nearest one now by going along it.
    pub(crate) fn concave(&self) -> bool {
        match self {
            Shape::Mesh(mesh) => !mesh.convex(),
            Shape::Heights(_) => true,
            _ => false,
        }
    }
}

/// A solid of revolution about z: within the radius (`side` 1) or beyond it (`side` -1), as long as twice `half`.
#[inline]
fn revolved(x: &V3<f64>, radius: f64, half: f64, side: f64, reach: f64) -> Option<Gap> {
    let rho = (x[0] * x[0] + x[1] * x[1]).sqrt();
    let (out, beyond) = (side * (rho - radius), x[2].abs() - half);
    // on the axis any direction leads out
    let inverse = if rho > 0.0 { 1.0 / rho } else { 0.0 };
    let radial = if rho > 0.0 { [x[0] * inverse, x[1] * inverse, 0.0] } else { [1.0, 0.0, 0.0] };
    let round = [-radial[1], radial[0], 0.0];
    let end = x[2].signum();
    if out > 0.0 && beyond > 0.0 {
        let distance = (out * out + beyond * beyond).sqrt();
        if distance >= reach {
            return None;
        }
        let (a, b) = (side * out / distance, end * beyond / distance);
        let normal = [a * radial[0], a * radial[1], b];
        // along the profile, and around the axis
        let profile = [-b * radial[0], -b * radial[1], a];
        return Some(Gap { distance, normal, bends: [(1.0 / distance, profile), (a * inverse, round)] });
    }
    if out >= beyond {
        let normal = [side * radial[0], side * radial[1], 0.0];
        Some(Gap { distance: out, normal, bends: [(side * inverse, round), FLAT] })
    } else {
        Some(Gap::flat(beyond, [0.0, 0.0, end]))
    }
    .filter(|g| g.distance < reach)
}

fn cuboid(x: &V3<f64>, half: &V3<f64>, reach: f64) -> Option<Gap> {
    let over: V3<f64> = std::array::from_fn(|i| x[i].abs() - half[i]);
    if over.iter().any(|o| *o >= reach) {
        return None;
    }
    let side: V3<f64> = x.map(f64::signum);
    let beyond: V3<f64> = over.map(|o| o.max(0.0));
    let outside = beyond.iter().filter(|b| **b > 0.0).count();
    if outside <= 1 {
        let i = (0..3).fold(0, |m, i| if over[i] > over[m] { i } else { m });
        let mut normal = [0.0; 3];
        normal[i] = side[i];
        return Some(Gap::flat(over[i], normal));
    }
    let distance = dot(&beyond, &beyond).sqrt();
    if distance >= reach {
        return None;
    }
    let normal = std::array::from_fn(|i| side[i] * beyond[i] / distance);
    if outside == 3 {
        return Some(Gap::round(distance, normal, 1.0 / distance));
    }
    // along the edge, where it isn't beyond
    let edge = beyond.map(|b| if b > 0.0 { 0.0 } else { 1.0 });
    Some(Gap { distance, normal, bends: [(1.0 / distance, cross(&edge, &normal)), FLAT] })
}
