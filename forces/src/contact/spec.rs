//! What a scene says about contact.

use super::candidates::Candidates;
use super::friction::{AtRest, Friction};
use super::law::{ContactLaw, Damping};
use super::shape::Shape;
use super::shape_spec::ShapeSpec;
use super::stiffness::Stiffness;
use super::term::Contact;
use ropewalk_core::error::{not_negative, positive};
use ropewalk_core::{At, BuildError, ContactPoint, ContactSpan, Marker, NodeKind, dot};
use ropewalk_scene::{Builder, ForceSpec, MarkerRef, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub(super) fn one() -> f64 {
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
    /// except the shape's own body, and clumps and floats that sit on another part.
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

    pub(super) fn law(&self) -> ContactLaw {
        let friction = self.friction.filter(|f| f.mu != 0.0);
        ContactLaw { exponent: self.exponent, damping: self.damping, friction }
    }

    /// The smallest radius of what may touch [m].
    pub(super) fn thinnest(&self, b: &Builder) -> Result<f64, BuildError> {
        let all =
            self.candidates(b, None, &Stiffness { point: 1.0, per_length: 1.0, end: None, area: None })?;
        let radii = all.points.iter().map(|p| p.1.radius).chain(all.spans.iter().map(|s| s.1.radius));
        Ok(radii.fold(f64::INFINITY, f64::min))
    }

    /// Refuses what starts deep in the shape.
    fn check_overlap(&self, b: &Builder, contact: &Contact, all: &Candidates) -> Result<(), BuildError> {
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
        let touching = self.candidates(b, own, stiffness)?;
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
                let rests = friction.equilibrium != AtRest::None;
                let size = Contact::memory(points.len(), spans.len());
                let memory = b.memory(&format!("{}: friction", self.name), size + usize::from(rests));
                let down = b.gravity();
                let gravity = dot(&down, &down).sqrt();
                let up = (gravity > 0.0).then(|| down.map(|g| -g / gravity));
                let grips = self.grips(&friction, &touching, gravity, stiffness);
                let mut contact = contact.with_grips(&grips, memory);
                if friction.equilibrium == AtRest::Pulled {
                    let brakes = touching.brakes(&friction, &contact, b.coordinates(), down)?;
                    contact = contact.with_brakes(&brakes);
                }
                if rests { contact.with_rest(up, memory + size) } else { contact }
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
