//! What a scene says about contact.

use super::file::read;
use super::law::{ContactLaw, Damping};
use super::mesh::Mesh;
use super::shape::Shape;
use super::term::Contact;
use ropewalk_core::build::{BuildError, Builder, finite, not_negative, positive};
use ropewalk_core::held::Held;
use ropewalk_core::rotation::{IDENTITY, M3, around, from_bryant, matrix};
use ropewalk_core::{
    At, ContactPoint, ForceSpec, Marker, MarkerRef, NodeKind, V3, dot, quantity, register_spec,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::sync::Arc;

/// A shape to touch, in the axes of the rigid body that it is on, or of space, with its middle at the marker.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ShapeSpec {
    /// All of one side of a plane through the marker: a floor, a wall.
    Plane {
        /// The side from which it is touched; left out, upwards (z).
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
        /// Length [m]; left out, without end.
        #[serde(default, deserialize_with = "quantity::optional::length")]
        length: Option<f64>,
    },
    /// A tube from inside: a round hole through a wall that has no outer side.
    Tube {
        /// Direction of its axis.
        axis: V3<f64>,
        /// Inner radius [m].
        #[serde(deserialize_with = "quantity::length")]
        radius: f64,
        /// Length [m]; left out, without end.
        #[serde(default, deserialize_with = "quantity::optional::length")]
        length: Option<f64>,
    },
    /// A cuboid: a deck, a wall of some thickness.
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
        /// An STL or OBJ file; a scene file names it from its own folder.
        file: PathBuf,
        /// Size of the file's unit of length [m]: 0.001 where it is in millimetres.
        #[serde(default = "one", deserialize_with = "quantity::length")]
        unit: f64,
        /// Turns about x, the new y and the new z [rad].
        #[serde(default, deserialize_with = "quantity::vec3::angle")]
        angles: V3<f64>,
        /// Whether it is a surface with borders, such as a sea floor, and no closed solid. It is touched from the side
        /// that the triangles' normals point to.
        #[serde(default)]
        open: bool,
    },
}

fn upwards() -> V3<f64> {
    [0.0, 0.0, 1.0]
}
fn one() -> f64 {
    1.0
}
fn two() -> usize {
    2
}
fn slip_speed() -> f64 {
    ContactLaw::default().slip_speed
}

/// What is done about points that start deep in the shape.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Overlap {
    /// The scene is refused if a point starts deeper than half of its radius.
    #[default]
    Refuse,
    /// The scene starts as it is, with the force that belongs to the depth.
    Allow,
}

/// Contact of cables and bodies with a shape on the ground or on a rigid body, which feels the opposite force.
///
/// Cables touch by balls of their diameter along them, bodies with a hull by a chain of such balls along it, point
/// masses and single points of bodies by one ball of the `radius` given. A record of type `force` shows the force.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactSpec {
    /// Name.
    pub name: String,
    /// What touches it: cables, bodies with a hull, point masses; left out and without `at`, all of them that are not
    /// the shape's own body.
    #[serde(default)]
    pub on: Vec<String>,
    /// Single points that touch it, such as corners of bodies, as balls of the `radius`.
    #[serde(default)]
    pub at: Vec<MarkerRef>,
    /// The shape.
    pub shape: ShapeSpec,
    /// Where the shape is: a point in space, or a marker on a rigid body that it is part of; left out, the origin.
    #[serde(default = "origin")]
    pub marker: MarkerRef,
    /// Radius of the balls [m]; left out, half of the diameter of the cable or hull.
    #[serde(default, deserialize_with = "quantity::optional::length")]
    pub radius: Option<f64>,
    /// Stiffness of a ball that stands for a whole point mass or point [N/m]; with an exponent `p` other than 1, that
    /// at a depth of 1 m.
    #[serde(default, deserialize_with = "quantity::spring_stiffness")]
    pub stiffness: f64,
    /// Stiffness per length of cables and hulls [N/m²]; with an exponent other than 1, that at a depth of 1 m.
    #[serde(default, deserialize_with = "quantity::stiffness_per_length")]
    pub stiffness_per_length: f64,
    /// Exponent `p` of the elastic force `k d^p`.
    #[serde(default = "one", deserialize_with = "quantity::number")]
    pub exponent: f64,
    /// What it loses along the normal.
    #[serde(default)]
    pub damping: Damping,
    /// Coefficient of friction.
    #[serde(default, deserialize_with = "quantity::number")]
    pub friction: f64,
    /// Speed of slip from which on friction is full [m/s]. What seems to stick creeps by less than that.
    #[serde(default = "slip_speed", deserialize_with = "quantity::speed")]
    pub slip_speed: f64,
    /// Balls on each element of a cable, counted without its end: 2, 3 or 4.
    #[serde(default = "two")]
    pub per_element: usize,
    /// What is done about points that start deep in the shape.
    #[serde(default)]
    pub overlap: Overlap,
}
register_spec!(Force, "contact", ContactSpec);

fn origin() -> MarkerRef {
    MarkerRef::Point([0.0; 3])
}

impl ContactSpec {
    /// Contact of all that has a size with a shape at the origin, without damping and friction.
    pub fn new(name: &str, shape: ShapeSpec) -> Self {
        ContactSpec {
            name: name.into(),
            on: Vec::new(),
            at: Vec::new(),
            shape,
            marker: origin(),
            radius: None,
            stiffness: 0.0,
            stiffness_per_length: 0.0,
            exponent: 1.0,
            damping: Damping::None,
            friction: 0.0,
            slip_speed: slip_speed(),
            per_element: two(),
            overlap: Overlap::Refuse,
        }
    }

    fn law(&self) -> ContactLaw {
        let (exponent, damping, friction) = (self.exponent, self.damping, self.friction);
        ContactLaw { exponent, damping, friction, slip_speed: self.slip_speed }
    }

    /// The points that touch, each with the part and what it is called in messages.
    fn points(
        &self,
        b: &Builder,
        own: Option<(usize, usize)>,
    ) -> Result<Vec<(String, ContactPoint)>, BuildError> {
        let mut all = Vec::new();
        if !self.on.is_empty() || self.at.is_empty() {
            for (_, part) in b.parts(&self.on)? {
                let own = own.is_some_and(|seat| part.seats() == [seat]);
                let points = if own { Vec::new() } else { part.contact_points(self.per_element) };
                if points.is_empty() && !self.on.is_empty() {
                    let message = if own {
                        format!("`{}` carries the shape itself: leave it out of `on`", part.name())
                    } else {
                        format!(
                            "`{}` has nothing to touch with: give it a `hull`, or name points of it in `at`",
                            part.name()
                        )
                    };
                    return Err(BuildError::at("on", message));
                }
                let name = |s: f64| match part.length() > 0.0 {
                    true => format!("`{}` at {s:.4} m", part.name()),
                    false => format!("`{}`", part.name()),
                };
                all.extend(points.into_iter().map(|p| (name(p.s), p)));
            }
        }
        for name in &self.at {
            let marker = b.marker("at", name)?;
            let Some(node) = marker.on() else {
                return Err(BuildError::at("at", format!("{name} doesn't move: name a marker on a part")));
            };
            let n = b.nodes()[node.0 as usize];
            let held = match (Held::new(b.nodes(), &marker, &self.name)?, n.kind) {
                (Held::Moves { q, v }, NodeKind::Frame) => Held::Beside { q, v, arm: [0.0; 3] },
                (held, _) => held,
            };
            all.push((format!("{name}"), ContactPoint { held, radius: 0.0, length: 0.0, s: 0.0 }));
        }
        if all.is_empty() {
            return Err(BuildError::new("there is nothing in the scene that could touch this shape"));
        }
        for (name, p) in &mut all {
            if let Some(radius) = self.radius {
                p.radius = radius;
            }
            if !(p.radius > 0.0) {
                let message = format!(
                    "{name} has no size to touch with: give the contact a `radius`, or the cable's section a `diameter`"
                );
                return Err(BuildError::at("radius", message));
            }
            let (field, k) = match p.length > 0.0 {
                true => ("stiffness_per_length", self.stiffness_per_length),
                false => ("stiffness", self.stiffness),
            };
            if k == 0.0 {
                let what = if p.length > 0.0 { "along its length" } else { "by a single point" };
                let message = format!("{name} touches {what}, which needs a `{field}` above zero");
                return Err(BuildError::at(field, message));
            }
        }
        Ok(all)
    }

    /// Refuses points that start deep in the shape.
    fn check_overlap(
        &self,
        b: &Builder,
        contact: &Contact,
        points: &[(String, ContactPoint)],
    ) -> Result<(), BuildError> {
        let q = b.coordinates();
        // no velocity is needed to see how deep they are
        let still = vec![0.0; q.len()];
        let at = At { t: 0.0, q, v: &still, a: &still, modes: &[], relaxed: None };
        let deep =
            contact.depths(&at).zip(points).filter_map(|(depth, p)| depth.map(|d| (d / p.1.radius, d, p)));
        let Some((share, depth, (name, _))) = deep.max_by(|a, b| a.0.total_cmp(&b.0)) else { return Ok(()) };
        if share <= 0.5 {
            return Ok(());
        }
        let message = format!(
            "{name} starts {depth:.3e} m deep in the shape, more than half of its radius of {:.3e} m: move it out by \
             that much (the centre line of what lies on a surface is half a diameter above it), or set \
             `overlap = \"allow\"` if it is to be thrown out",
            depth / share
        );
        Err(BuildError::at("overlap", message))
    }
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

#[typetag::serde(name = "contact")]
impl ForceSpec for ContactSpec {
    fn markers(&self) -> Vec<&MarkerRef> {
        std::iter::once(&self.marker).chain(&self.at).collect()
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        not_negative("stiffness", self.stiffness)?;
        not_negative("stiffness_per_length", self.stiffness_per_length)?;
        if let Some(radius) = self.radius {
            positive("radius", radius)?;
        }
        if !(2..=4).contains(&self.per_element) {
            let message = format!("`per_element` must be 2, 3 or 4, but is {}", self.per_element);
            return Err(BuildError::at("per_element", message));
        }
        let (shape, axes) = self.shape.shape().map_err(|e| e.of("shape"))?;
        let marker = match b.marker("marker", &self.marker)? {
            Marker::Ground { point, .. } => Marker::Ground { point, axes },
            Marker::Node { node, point, .. } => Marker::Node { node, point, axes },
        };
        let carrier = marker.on().map(|n| b.nodes()[n.0 as usize]);
        if carrier.is_some_and(|n| n.kind != NodeKind::Frame) {
            return Err(BuildError::at("marker", "a shape can only be on the ground or on a rigid body"));
        }
        let own = carrier.map(|n| (n.q, n.v));
        let points = self.points(b, own)?;
        let balls: Vec<ContactPoint> = points.iter().map(|p| p.1).collect();
        let stiffness = [self.stiffness, self.stiffness_per_length];
        let contact = Contact::new(&self.name, b.nodes(), shape, &marker, &balls, stiffness, self.law())?;
        if self.overlap == Overlap::Refuse {
            self.check_overlap(b, &contact, &points)?;
        }
        if let Some(node) = marker.on()
            && balls.len() > 2
        {
            b.share(node);
        }
        b.term(Box::new(contact));
        Ok(())
    }
}
