//! What a scene says about contact.

use super::file::read;
use super::friction::{AtRest, Brake, Friction, Grip};
use super::law::{ContactLaw, Damping};
use super::mesh::Mesh;
use super::shape::Shape;
use super::term::{Contact, Stiffness};
use ropewalk_core::error::{finite, not_negative, positive};
use ropewalk_core::held::Held;
use ropewalk_core::rotation::{IDENTITY, M3, around, from_bryant, matrix};
use ropewalk_core::{At, BuildError, ContactPoint, ContactSpan, Marker, NodeKind, SpanLine, V3, dot};
use ropewalk_scene::{Builder, ForceSpec, MarkerRef, quantity, register_spec};
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
fn one() -> f64 {
    1.0
}

/// What to do with points that start deep in the shape.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Overlap {
    /// Refuses the scene if a point starts deeper than half of its radius.
    #[default]
    Refuse,
    /// Starts with the force of that depth.
    Allow,
}

/// Contact of cables and bodies with a shape, on the ground or on a rigid body. The body of the shape feels the
/// opposite force.
///
/// Cables, links and bodies with a hull are in contact anywhere along their length where the shape is nearer than
/// their radius. Point masses and single points are spheres of the given `radius`. A record of type `force` shows the
/// force.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactSpec {
    /// Name.
    pub name: String,
    /// Parts in contact with the shape: cables, bodies with a hull, point masses. Default, without `points`: all
    /// except the shape's own body.
    #[serde(default)]
    pub on: Vec<String>,
    /// Single points in contact, such as corners of bodies: markers, each a sphere of the `radius`.
    #[serde(default)]
    pub points: Vec<MarkerRef>,
    /// The shape.
    pub shape: ShapeSpec,
    /// Position of the shape: a point in space, or a marker on the rigid body that carries it. Default: the origin.
    #[serde(default = "origin")]
    pub marker: MarkerRef,
    /// Contact radius of the parts [m]. Default: half of the diameter of the cable or hull.
    #[serde(default, deserialize_with = "quantity::optional::length")]
    pub radius: Option<f64>,
    /// Contact stiffness of a point mass or point [N/m]; with an exponent `p` other than 1, at a depth of 1 m.
    #[serde(default, deserialize_with = "quantity::spring_stiffness")]
    pub stiffness: f64,
    /// Contact stiffness per length of cables and hulls [N/m²]; with an exponent other than 1, at a depth of 1 m.
    #[serde(default, deserialize_with = "quantity::stiffness_per_length")]
    pub stiffness_per_length: f64,
    /// Additional contact stiffness of the tips of cables and hulls [N/m]; with an exponent other than 1, at a depth
    /// of 1 m. Default: that of a piece as long as its diameter.
    #[serde(default, deserialize_with = "quantity::optional::spring_stiffness")]
    pub end_stiffness: Option<f64>,
    /// Exponent `p` of the elastic force `k d^p`.
    #[serde(default = "one", deserialize_with = "quantity::number")]
    pub exponent: f64,
    /// Damping law along the normal.
    #[serde(default)]
    pub damping: Damping,
    /// Dry friction: a coefficient, or `{ mu, across, elastic_slip, equilibrium }`. Equilibria are computed without it, since
    /// with friction they are not unique, unless `equilibrium` is `laid` or `pulled`.
    #[serde(default, deserialize_with = "dry")]
    #[schemars(with = "Option<Dry>")]
    pub friction: Option<Friction>,
    /// What to do with points that start deep in the shape.
    #[serde(default)]
    pub overlap: Overlap,
}
register_spec!(Force, "contact", ContactSpec);

/// How a scene may write friction.
#[derive(Deserialize, JsonSchema)]
#[serde(
    untagged,
    expecting = "friction is a coefficient, or `{ mu = 0.3, across = 0.2, elastic_slip = \"0.1 mm\" }`"
)]
pub(super) enum Dry {
    Coefficient(#[serde(deserialize_with = "quantity::number")] f64),
    Friction(Friction),
}

pub(super) fn dry<'de, D: serde::Deserializer<'de>>(d: D) -> Result<Option<Friction>, D::Error> {
    Ok(Some(match Dry::deserialize(d)? {
        Dry::Coefficient(mu) => Friction::new(mu),
        Dry::Friction(friction) => friction,
    }))
}

pub(super) fn origin() -> MarkerRef {
    MarkerRef::Point([0.0; 3])
}

impl ContactSpec {
    /// Contact of all that has a size with a shape at the origin, without damping and friction.
    pub fn new(name: &str, shape: ShapeSpec) -> Self {
        ContactSpec {
            name: name.into(),
            on: Vec::new(),
            points: Vec::new(),
            shape,
            marker: origin(),
            radius: None,
            stiffness: 0.0,
            stiffness_per_length: 0.0,
            end_stiffness: None,
            exponent: 1.0,
            damping: Damping::None,
            friction: None,
            overlap: Overlap::Refuse,
        }
    }

    fn law(&self) -> ContactLaw {
        let friction = self.friction.filter(|f| f.mu != 0.0);
        ContactLaw { exponent: self.exponent, damping: self.damping, friction }
    }

    /// What touches, each with what it is called in messages.
    fn touching(
        &self,
        b: &Builder,
        own_seat: Option<(usize, usize)>,
        stiffness: &Stiffness,
    ) -> Result<Touching, BuildError> {
        let mut all = Touching::default();
        if !self.on.is_empty() || self.points.is_empty() {
            for (_, part) in b.parts(&self.on)? {
                let own = own_seat.is_some_and(|seat| part.seats() == [seat]);
                let before = all.len();
                if !own {
                    let (mass, length) = (part.mass(), part.length());
                    let ea = part.slender().map_or(0.0, |s| s.ea);
                    let whole = format!("`{}`", part.name());
                    let points = part.contact_points();
                    all.weights.extend(points.iter().map(|_| Weight {
                        mass,
                        length: 0.0,
                        ea: 0.0,
                        whole: 0.0,
                    }));
                    all.points.extend(points.into_iter().map(|p| (whole.clone(), p)));
                    let carries = |s: &ContactSpan| match s.line {
                        SpanLine::Straight { q, v, .. } => own_seat == Some((q, v)),
                        SpanLine::Cubic { .. } => false,
                    };
                    let spans = part.contact_spans().into_iter().filter(|s| !carries(s));
                    for s in spans {
                        let mass = mass * if length > 0.0 { (s.length / length).min(1.0) } else { 1.0 };
                        all.span_weights.push(Weight { mass, length: s.length, ea, whole: length });
                        all.spans.push((part.name().to_string(), s));
                    }
                }
                if all.len() == before && !self.on.is_empty() {
                    let message = if own {
                        format!("`{}` carries the shape itself: leave it out of `on`", part.name())
                    } else {
                        format!(
                            "`{}` has nothing to touch with: give it a `hull`, or name points of it in `points`",
                            part.name()
                        )
                    };
                    return Err(BuildError::at("on", message));
                }
            }
        }
        for name in &self.points {
            let marker = b.marker("points", name)?;
            let Some(node) = marker.on() else {
                return Err(BuildError::at(
                    "points",
                    format!("{name} doesn't move: name a marker on a part"),
                ));
            };
            let n = b.nodes()[node.0 as usize];
            let held = match (Held::new(b.nodes(), &marker, &self.name)?, n.kind) {
                (Held::Moves { q, v }, NodeKind::Frame) => Held::Beside { q, v, arm: [0.0; 3] },
                (held, _) => held,
            };
            all.points.push((format!("{name}"), ContactPoint { held, radius: 0.0 }));
            let carrier = b.parts(&[])?.into_iter().find(|(_, part)| part.place_of(node).is_some());
            let mass = carrier.map_or(0.0, |(_, part)| part.mass());
            all.weights.push(Weight { mass, length: 0.0, ea: 0.0, whole: 0.0 });
        }
        all.part_flowing();
        if let Some((name, _)) = all.spans.iter().find(|(_, s)| s.flow.is_some())
            && self.law().friction.is_some()
        {
            return Err(BuildError::new(format!(
                "`{name}` feeds, and friction on material that runs through isn't known here: leave the cable out by `on`, or \
                 `friction`"
            )));
        }
        if all.len() == 0 {
            return Err(BuildError::new("there is nothing in the scene that could touch this shape"));
        }
        for (name, p) in &mut all.points {
            self.give_size(name, &mut p.radius)?;
            needs(name, "by a single point", "stiffness", stiffness.of_point(p.radius))?;
        }
        for (name, s) in &mut all.spans {
            let name = format!("`{name}`");
            self.give_size(&name, &mut s.radius)?;
            needs(&name, "along its length", "stiffness_per_length", stiffness.of_length(s.radius))?;
        }
        Ok(all)
    }

    /// How stiff the friction of each point and slender piece is: so that it gives way by the elastic slip under its
    /// weight, no softer than the contact itself, and so stiff that slip along a cable begins where it should.
    fn grips(&self, friction: &Friction, all: &Touching, gravity: f64, how: &Stiffness) -> Vec<Grip> {
        let points = all.points.iter().map(|p| (p.1.radius, how.of_point(p.1.radius))).zip(&all.weights);
        let spans = all.spans.iter().map(|(_, s)| (s.radius, how.of_length(s.radius) * s.length));
        let grip = |((radius, k), w): ((f64, f64), &Weight)| {
            let slip = friction.elastic_slip.unwrap_or(SLIP * 2.0 * radius);
            let held = friction.mu * w.mass * gravity / slip;
            let stiffness = match friction.elastic_slip {
                Some(_) if held > 0.0 => held,
                _ => {
                    let along =
                        if w.whole > 0.0 { w.ea * w.length / (SMEARED * w.whole).powi(2) } else { 0.0 };
                    held.max(along).max(if self.exponent == 1.0 { k } else { 0.0 })
                }
            };
            let stiffness = if stiffness > 0.0 { stiffness } else { k * slip.powf(self.exponent - 1.0) };
            Grip { stiffness, damping: 2.0 * RATIO * (stiffness * w.mass).sqrt(), brake: None }
        };
        points.chain(spans.zip(&all.span_weights)).map(grip).collect()
    }

    /// The smallest radius of what touches [m].
    pub(super) fn thinnest(&self, b: &Builder) -> Result<f64, BuildError> {
        let all =
            self.touching(b, None, &Stiffness { point: 1.0, per_length: 1.0, end: None, area: None })?;
        let radii = all.points.iter().map(|p| p.1.radius).chain(all.spans.iter().map(|s| s.1.radius));
        Ok(radii.fold(f64::INFINITY, f64::min))
    }

    fn give_size(&self, name: &str, radius: &mut f64) -> Result<(), BuildError> {
        *radius = self.radius.unwrap_or(*radius);
        if *radius > 0.0 {
            return Ok(());
        }
        let message = format!(
            "{name} has no size to touch with: give the contact a `radius`, or the cable's section a `diameter`"
        );
        Err(BuildError::at("radius", message))
    }

    /// Refuses what starts deep in the shape.
    fn check_overlap(&self, b: &Builder, contact: &Contact, all: &Touching) -> Result<(), BuildError> {
        let q = b.coordinates();
        // no velocity is needed to see how deep they are
        let still = vec![0.0; q.len()];
        let at = At { t: 0.0, q, v: &still, a: &still, internal: &[], relaxed: None };
        let points = all.points.iter().map(|(name, p)| (name.clone(), p.radius));
        let spans = all.spans.iter().map(|(name, s)| {
            let place = format!("`{name}` between {:.4} m and {:.4} m", s.s, s.s + s.length);
            (place, s.radius)
        });
        let depths = contact.depths(&at).zip(points.chain(spans));
        let deep = depths.filter_map(|(depth, (name, radius))| depth.map(|d| (d / radius, d, name)));
        let Some((share, depth, name)) = deep.max_by(|a, b| a.0.total_cmp(&b.0)) else { return Ok(()) };
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

/// What touches, with names for messages.
#[derive(Default)]
struct Touching {
    points: Vec<(String, ContactPoint)>,
    spans: Vec<(String, ContactSpan)>,
    /// What the friction of each has to hold.
    weights: Vec<Weight>,
    span_weights: Vec<Weight>,
}

/// What friction has to hold, as far as the part tells.
struct Weight {
    /// Mass, of the piece that touches [kg].
    mass: f64,
    /// Length of the piece, and of the whole part [m].
    length: f64,
    whole: f64,
    /// Axial stiffness [N].
    ea: f64,
}

/// Slip along a cable is smeared out over no more than this part of its length.
const SMEARED: f64 = 0.05;
/// Elastic slip, in parts of the thickness.
const SLIP: f64 = 0.01;
/// Damping ratio of bristles that hold.
const RATIO: f64 = 0.5;

impl Touching {
    /// Puts what material flows through behind the rest, as the term keeps it.
    fn part_flowing(&mut self) {
        let spans = std::mem::take(&mut self.spans).into_iter().zip(std::mem::take(&mut self.span_weights));
        let (flowing, fixed): (Vec<_>, Vec<_>) = spans.partition(|((_, s), _)| s.flow.is_some());
        (self.spans, self.span_weights) = fixed.into_iter().chain(flowing).unzip();
    }
    fn len(&self) -> usize {
        self.points.len() + self.spans.len()
    }

    /// How the friction of each point and slender piece is used up at equilibria: by the pull on that end of its cable which is
    /// farther away from the shape at the start.
    fn brakes(
        &self,
        friction: &Friction,
        contact: &Contact,
        q: &[f64],
        down: V3<f64>,
    ) -> Result<Vec<Option<Brake>>, BuildError> {
        let gravity = dot(&down, &down).sqrt();
        let still = vec![0.0; q.len()];
        let at = At { t: 0.0, q, v: &still, a: &still, internal: &[], relaxed: None };
        let mut all = vec![None; self.points.len()];
        for ((name, span), w) in self.spans.iter().zip(&self.span_weights) {
            let away = |s: f64| contact.clearance(name, s, &at);
            let (Some(start), Some(end), SpanLine::Cubic { .. }) = (away(0.0), away(w.whole), span.line)
            else {
                let message = format!(
                    "`{name}` is no cable of which both ends can touch: friction that a pull uses up is known of cables alone. \
                     Leave it out by `on`, or take `equilibrium = \"laid\"`"
                );
                return Err(BuildError::at("friction", message));
            };
            // as much as friction takes up on one element
            let strain = 2.0 * friction.mu * w.mass * gravity / w.ea;
            let way = if end >= start { 1.0 } else { -1.0 };
            all.push((strain > 0.0 && strain.is_finite()).then_some(Brake {
                way,
                strain,
                up: down.map(|g| -g / gravity),
            }));
        }
        Ok(all)
    }
}

fn needs(name: &str, what: &str, field: &str, k: f64) -> Result<(), BuildError> {
    if k != 0.0 {
        return Ok(());
    }
    let message = format!("{name} touches {what}, which needs a `{field}` above zero");
    Err(BuildError::at(field, message))
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
        std::iter::once(&self.marker).chain(&self.points).collect()
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        not_negative("stiffness", self.stiffness)?;
        not_negative("stiffness_per_length", self.stiffness_per_length)?;
        if let Some(k) = self.end_stiffness {
            not_negative("end_stiffness", k)?;
        }
        if let Some(radius) = self.radius {
            positive("radius", radius)?;
        }
        let (shape, axes) = self.shape.shape().map_err(|e| e.of("shape"))?;
        let marker = match b.marker("marker", &self.marker)? {
            Marker::Ground { point, .. } => Marker::Ground { point, axes },
            Marker::Node { node, point, .. } => Marker::Node { node, point, axes },
        };
        let stiffness = Stiffness {
            point: self.stiffness,
            per_length: self.stiffness_per_length,
            end: self.end_stiffness,
            area: None,
        };
        self.place(b, shape, &marker, &stiffness)
    }
}

impl ContactSpec {
    /// Puts the contact with a shape in its place.
    pub(super) fn place(
        &self,
        b: &mut Builder,
        shape: Shape,
        marker: &Marker,
        stiffness: &Stiffness,
    ) -> Result<(), BuildError> {
        let carrier = marker.on().map(|n| b.nodes()[n.0 as usize]);
        if carrier.is_some_and(|n| n.kind != NodeKind::Frame) {
            return Err(BuildError::at("marker", "a shape can only be on the ground or on a rigid body"));
        }
        let own = carrier.map(|n| (n.q, n.v));
        let touching = self.touching(b, own, stiffness)?;
        let points: Vec<ContactPoint> = touching.points.iter().map(|p| p.1).collect();
        let spans: Vec<ContactSpan> = touching.spans.iter().map(|s| s.1).collect();
        let all = (&points[..], &spans[..]);
        let contact = Contact::new(&self.name, b.nodes(), shape, marker, all, *stiffness, self.law())?;
        let parts: Vec<String> = touching.spans.iter().map(|s| s.0.clone()).collect();
        let contact = contact.with_places(&parts, &spans);
        if self.overlap == Overlap::Refuse {
            self.check_overlap(b, &contact, &touching)?;
        }
        let contact = match self.law().friction {
            Some(friction) => {
                let pulled = friction.equilibrium == AtRest::Pulled;
                let size = Contact::memory(points.len(), spans.len());
                let memory = b.memory(&format!("{}: friction", self.name), size + usize::from(pulled));
                let down = b.gravity();
                let gravity = dot(&down, &down).sqrt();
                let grips = self.grips(&friction, &touching, gravity, stiffness);
                let contact = contact.with_grips(&grips, memory);
                match pulled {
                    true => {
                        let brakes = touching.brakes(&friction, &contact, b.coordinates(), down)?;
                        contact.with_brakes(&brakes, memory + size)
                    }
                    false => contact,
                }
            }
            None => contact,
        };
        if let Some(node) = marker.on()
            && touching.len() > 2
        {
            b.share(node);
        }
        b.term(Box::new(contact));
        Ok(())
    }
}
