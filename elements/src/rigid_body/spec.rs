//! What a scene says about a rigid body.

use super::part::BodyPart;
use super::{Hull, Inertia, Shape, inertia};
use crate::point_mass::Ball;
use ropewalk_core::error::{finite, not_negative, positive};
use ropewalk_core::rotation::{cross, from_bryant, matrix, times, transposed_times};
use ropewalk_core::{BuildError, Marker, NodeId, NodeKind, StationPool, V3};
use ropewalk_scene::{Builder, ElementSpec, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::sync::Arc;

/// A rigid body with full inertia.
///
/// All its data are in the body's own frame, whose origin starts at `position`. Markers: `name` (that origin),
/// `name.com` (the centre of mass), and the `points` that the scene names.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigidBodySpec {
    /// Name; the rest of the scene refers to the part by it.
    pub name: String,
    /// Initial position of the origin of its frame [m].
    #[serde(deserialize_with = "quantity::vec3::length")]
    pub position: V3<f64>,
    /// Initial orientation as Bryant angles 1-2-3: turns about its x axis, its new y axis, its new z axis [rad].
    #[serde(default, deserialize_with = "quantity::vec3::angle")]
    pub angles: V3<f64>,
    /// Initial velocity of the origin [m/s].
    #[serde(default, deserialize_with = "quantity::vec3::speed")]
    pub velocity: V3<f64>,
    /// Initial angular velocity, in space [rad/s].
    #[serde(default, deserialize_with = "quantity::vec3::angular_velocity")]
    pub angular_velocity: V3<f64>,
    /// Mass [kg]. Default: from `shape` and `density`.
    #[serde(default, deserialize_with = "quantity::optional::mass")]
    pub mass: Option<f64>,
    /// Density of the `shape` [kg/m³].
    #[serde(default, deserialize_with = "quantity::optional::density")]
    pub density: Option<f64>,
    /// Homogeneous shape; the moments of inertia follow from it.
    #[serde(default)]
    pub shape: Option<Shape>,
    /// Moments of inertia `Jxx`, `Jyy`, `Jzz` about the centre of mass [kg m²], instead of a shape.
    #[serde(default, deserialize_with = "triple")]
    pub inertia: Option<V3<f64>>,
    /// Products of inertia `Jxy`, `Jxz`, `Jyz`: the off-diagonal entries of the inertia matrix [kg m²].
    #[serde(default, deserialize_with = "quantity::vec3::inertia")]
    pub products: V3<f64>,
    /// Centre of mass [m].
    #[serde(default, deserialize_with = "quantity::vec3::length")]
    pub centre: V3<f64>,
    /// Displaced volume, for buoyancy [m³].
    #[serde(default, deserialize_with = "quantity::volume")]
    pub volume: f64,
    /// Centre of buoyancy [m]. Default: the centre of mass. If the water has a `level`, the volume of a body with a
    /// hull is distributed along the hull.
    #[serde(default, deserialize_with = "place")]
    pub centre_of_volume: Option<V3<f64>>,
    /// Cylinder for drag and added mass. Default: none; then the body is a ball of its `volume`, on which `drag_area`, `added_mass` and
    /// the pressure of waves act.
    #[serde(default)]
    pub hull: Option<HullSpec>,
    /// Added mass in water of a body without hull, the same in all directions, at the centre of its volume [kg].
    #[serde(default, deserialize_with = "quantity::mass", skip_serializing_if = "is_nought")]
    pub added_mass: f64,
    /// Drag coefficient times area of a body without hull [m²].
    #[serde(default, deserialize_with = "quantity::area", skip_serializing_if = "is_nought")]
    pub drag_area: f64,
    /// Cylinder that stands for it in pictures, if it has neither `hull` nor `shape`; nothing acts on it.
    #[serde(default)]
    pub drawn: Option<HullSpec>,
    /// Named points of the body [m]; each is a marker.
    #[serde(default)]
    pub points: BTreeMap<String, Point>,
}
register_spec!(Element, "rigid_body", RigidBodySpec);

/// A point of a body [m].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Point(#[serde(deserialize_with = "quantity::vec3::length")] pub V3<f64>);

fn is_nought(x: &f64) -> bool {
    *x == 0.0
}
fn triple<'de, D: serde::Deserializer<'de>>(d: D) -> Result<Option<V3<f64>>, D::Error> {
    quantity::vec3::inertia(d).map(Some)
}
fn place<'de, D: serde::Deserializer<'de>>(d: D) -> Result<Option<V3<f64>>, D::Error> {
    quantity::vec3::length(d).map(Some)
}

/// A straight cylinder on a body, for drag and added mass. Water acts at four places along it, in waves at as many more as they
/// and the surface ask for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HullSpec {
    /// One end of its axis [m].
    #[serde(deserialize_with = "quantity::vec3::length")]
    pub from: V3<f64>,
    /// The other end [m].
    #[serde(deserialize_with = "quantity::vec3::length")]
    pub to: V3<f64>,
    /// Diameter [m].
    #[serde(deserialize_with = "quantity::length")]
    pub diameter: f64,
}

impl HullSpec {
    /// Whether there is such a cylinder.
    fn check(&self) -> Result<(), BuildError> {
        let axis = from(self.from, self.to);
        positive("diameter", self.diameter)?;
        positive("length", axis.iter().map(|x| x * x).sum::<f64>().sqrt()).map(|_| ())
    }
}

impl RigidBodySpec {
    /// A body at rest with its frame's origin at its centre of mass, of given mass [kg] and moments of inertia [kg m²].
    pub fn new(name: &str, position: V3<f64>, mass: f64, inertia: V3<f64>) -> Self {
        RigidBodySpec {
            name: name.into(),
            position,
            angles: [0.0; 3],
            velocity: [0.0; 3],
            angular_velocity: [0.0; 3],
            mass: Some(mass),
            density: None,
            shape: None,
            inertia: Some(inertia),
            products: [0.0; 3],
            centre: [0.0; 3],
            volume: 0.0,
            centre_of_volume: None,
            hull: None,
            added_mass: 0.0,
            drag_area: 0.0,
            drawn: None,
            points: BTreeMap::new(),
        }
    }
    /// The same with another point to hold it by [m].
    #[must_use]
    pub fn with_point(mut self, name: &str, at: V3<f64>) -> Self {
        self.points.insert(name.into(), Point(at));
        self
    }

    /// Across a surface the buoyancy of a hull is that of its cylinder.
    fn check_floating(&self, b: &Builder, hull: &HullSpec, length: f64) -> Result<(), BuildError> {
        let has_surface = b.water().is_ok_and(|water| water.level.is_some());
        let Some(centre) = self.centre_of_volume.filter(|_| has_surface) else { return Ok(()) };
        let off: f64 = (0..3).map(|i| (centre[i] - 0.5 * (hull.from[i] + hull.to[i])).powi(2)).sum();
        if off.sqrt() <= 1e-6 * length {
            return Ok(());
        }
        let message = "the water has a `level`, and then buoyancy is that of the hull: leave `centre_of_volume` out, or put \
                       it in the middle of the hull";
        Err(BuildError::at("centre_of_volume", message))
    }

    /// The water around a body without hull, as around a ball that moves with the middle of its volume.
    fn add_ball(&self, b: &mut Builder, node: NodeId) -> Result<(), BuildError> {
        for (field, x) in [("added_mass", self.added_mass), ("drag_area", self.drag_area)] {
            not_negative(field, x)?;
            if x > 0.0 && self.hull.is_some() {
                let message = format!(
                    "the hull has drag and added mass of its own: leave out `{field}`, or the `hull`"
                );
                return Err(BuildError::at(field, message));
            }
        }
        let middle = self.centre_of_volume.map_or([0.0; 3], |c| from(self.centre, c));
        let ball = Ball { volume: self.volume, added_mass: self.added_mass, drag_area: self.drag_area };
        if self.hull.is_none()
            && let Some(water) =
                ball.in_water(b, format!("{}: water", self.name), &Marker::beside(node, middle), 0.0)?
        {
            b.term(Box::new(water));
        }
        Ok(())
    }

    fn properties(&self) -> Result<Inertia, BuildError> {
        let (mass, j) = match (&self.shape, self.inertia) {
            (Some(shape), None) => {
                let (volume, per_mass) = shape.properties().map_err(|e| e.of("shape"))?;
                let mass = match (self.mass, self.density) {
                    (Some(mass), None) => positive("mass", mass)?,
                    (None, Some(density)) => positive("density", density)? * volume,
                    _ => {
                        let message = "give a body with a `shape` either a `mass` or a `density`";
                        return Err(BuildError::at("shape", message));
                    }
                };
                (mass, inertia(per_mass.map(|x| mass * x), self.products)?)
            }
            (None, Some(moments)) => {
                let Some(mass) = self.mass else {
                    return Err(BuildError::at("mass", "`mass` is missing: a body without it can't move"));
                };
                (positive("mass", mass)?, inertia(moments, self.products)?)
            }
            _ => {
                let message =
                    "give either `inertia` (about the centre of mass) or a `shape` to work it out from";
                return Err(BuildError::at("inertia", message));
            }
        };
        Ok(Inertia { mass, inertia: j })
    }
}

fn from(a: V3<f64>, b: V3<f64>) -> V3<f64> {
    [b[0] - a[0], b[1] - a[1], b[2] - a[2]]
}

#[typetag::serde(name = "rigid_body")]
impl ElementSpec for RigidBodySpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        for (name, x) in [
            ("position", &self.position),
            ("angles", &self.angles),
            ("velocity", &self.velocity),
            ("angular_velocity", &self.angular_velocity),
            ("centre", &self.centre),
        ] {
            finite(name, x)?;
        }
        not_negative("volume", self.volume)?;
        let inertia = self.properties()?;
        let quaternion = from_bryant(self.angles);
        let r = matrix(&quaternion);
        let omega = transposed_times(&r, &self.angular_velocity);
        // the node stands at the centre of mass
        let (arm, swing) = (times(&r, &self.centre), times(&r, &cross(&omega, &self.centre)));
        let (mut q, mut v) = (Vec::with_capacity(7), Vec::with_capacity(6));
        q.extend((0..3).map(|i| self.position[i] + arm[i]));
        q.extend(quaternion);
        v.extend((0..3).map(|i| self.velocity[i] + swing[i]));
        v.extend(omega);
        let node = b.node(NodeKind::Frame, &q, &v)?;
        b.element(inertia, &[node])?;

        self.add_ball(b, node)?;
        let mut stations = StationPool::<Hull, 7, 6, 4>::new();
        self.drawn.as_ref().map_or(Ok(()), HullSpec::check).map_err(|e| e.of("drawn"))?;
        if let Some(hull) = &self.hull {
            finite("from", &hull.from)?;
            finite("to", &hull.to)?;
            positive("diameter", hull.diameter).map_err(|e| e.of("hull"))?;
            let axis = from(hull.from, hull.to);
            let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
            positive("length of the hull", length).map_err(|e| e.of("hull"))?;
            self.check_floating(b, hull, length)?;
            let area = if self.volume > 0.0 {
                self.volume / length
            } else {
                PI / 4.0 * hull.diameter * hull.diameter
            };
            let hull = Hull {
                from: from(self.centre, hull.from),
                axis,
                length,
                s0: 0.0,
                diameter: hull.diameter,
                area,
            };
            for part in hull.parts(length, b.water().ok()) {
                let fits = stations.push(b.nodes(), part, &[node]);
                debug_assert!(fits, "a hull sits on one frame");
            }
        }
        let mut points: BTreeMap<String, V3<f64>> = BTreeMap::new();
        for (name, point) in &self.points {
            finite("points", &point.0)?;
            points.insert(name.clone(), from(self.centre, point.0));
        }
        let n = b.nodes()[node.0 as usize];
        b.part(Arc::new(BodyPart {
            name: self.name.clone(),
            node,
            q: n.q,
            v: n.v,
            mass: inertia.mass,
            volume: self.volume,
            origin: self.centre.map(|x| -x),
            centre_of_volume: self.centre_of_volume.map_or([0.0; 3], |c| from(self.centre, c)),
            points,
            hull: self.hull.map(|h| [from(self.centre, h.from), from(self.centre, h.to)]),
            diameter: self.hull.map_or(0.0, |h| h.diameter),
            drawn: self.drawn.map(|d| ([from(self.centre, d.from), from(self.centre, d.to)], d.diameter)),
            shape: self.shape.clone(),
            stations: self.hull.is_some().then(|| Arc::new(stations) as _),
        }))
    }
}
