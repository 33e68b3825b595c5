//! `type = "latch"`: what a scene says about points held at their seats.

use super::{Floor, Latch, Release, Seat};
use ropewalk_core::error::{finite, need, not_negative, positive};
use ropewalk_core::held::Held;
use ropewalk_core::rotation::transposed_times;
use ropewalk_core::{BuildError, Marker, NodeKind, V3, dot, rotation};
use ropewalk_scene::{Builder, ForceSpec, MarkerRef, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

fn fade() -> f64 {
    1e-3
}

/// Holds points at their initial positions, each by a spring and damper, until the force on one reaches a limit: that
/// point is then released permanently. Each release is located in time and reported.
///
/// Use it for a hose on its spool, a cable tied with tape, a load that is dropped. The record `released` counts the
/// releases.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LatchSpec {
    /// Name; the reports of releases use it.
    pub name: String,
    /// What it holds: parts (every node or link of them) and single markers. A cable puts a node where a marker is.
    #[schemars(with = "Vec<String>")]
    pub on: Vec<MarkerRef>,
    /// Marker on the rigid body that carries the seats. Default: fixed in space.
    #[serde(default)]
    pub to: Option<MarkerRef>,
    /// Stiffness of a seat [N/m].
    #[serde(deserialize_with = "quantity::spring_stiffness")]
    pub stiffness: f64,
    /// Damping of a seat [N s/m].
    #[serde(default, deserialize_with = "quantity::damping")]
    pub damping: f64,
    /// Force of a seat at which the point is released [N].
    #[serde(deserialize_with = "quantity::force")]
    pub force: f64,
    /// Direction in space; only the component along it counts. Default: the magnitude of the force.
    #[serde(default)]
    pub direction: Option<V3<f64>>,
    /// Fade time of the force after a release [s].
    #[serde(default = "fade", deserialize_with = "quantity::time")]
    pub fade: f64,
    /// A plane fixed in space that pushes released points back.
    #[serde(default)]
    pub floor: Option<FloorSpec>,
    /// Whether the run ends when the last point is released.
    #[serde(default)]
    pub stop: bool,
}
register_spec!(Force, "latch", LatchSpec);

/// A plane that pushes back released points, in proportion to their depth. For other shapes there is contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FloorSpec {
    /// A point of the plane [m].
    #[serde(deserialize_with = "quantity::vec3::length")]
    pub point: V3<f64>,
    /// Its normal, on the side where points may be.
    pub normal: V3<f64>,
    /// Contact stiffness [N/m].
    #[serde(deserialize_with = "quantity::spring_stiffness")]
    pub stiffness: f64,
}

impl LatchSpec {
    /// Holds all of these parts, in space, with a stiffness [N/m], a damping [N s/m] and a limit [N].
    pub fn new(name: &str, on: &[&str], stiffness: f64, damping: f64, force: f64) -> Self {
        LatchSpec {
            name: name.into(),
            on: on.iter().map(|&name| name.into()).collect(),
            to: None,
            stiffness,
            damping,
            force,
            direction: None,
            fade: fade(),
            floor: None,
            stop: false,
        }
    }

    /// The points that are held.
    fn points(&self, b: &Builder) -> Result<Vec<Held>, BuildError> {
        let mut points = Vec::new();
        for name in &self.on {
            // a part as a whole, or else a marker
            if let MarkerRef::Name(name) = name
                && let Ok(found) = b.parts(std::slice::from_ref(name))
                && let Some((_, part)) = found.first()
                && !part.seats().is_empty()
            {
                points.extend(part.seats().into_iter().map(|(q, v)| Held::Moves { q, v }));
                continue;
            }
            let marker = b.marker("on", name)?;
            points.push(Held::new(b.nodes(), &marker, &self.name)?);
        }
        Ok(points)
    }

    /// The seat of a point that starts at `x`.
    fn seat(&self, b: &Builder, on: Option<Marker>, x: V3<f64>) -> Held {
        let Some(Marker::Node { node, .. }) = on else { return Held::Ground(x) };
        let (n, own) = (b.nodes()[node.0 as usize], b.place(&Marker::node(node)));
        let out: V3<f64> = std::array::from_fn(|i| x[i] - own.x[i]);
        let q = &b.coordinates()[n.q..];
        let arm = transposed_times(&rotation::matrix(&[q[3], q[4], q[5], q[6]]), &out);
        Held::Beside { q: n.q, v: n.v, arm }
    }
}

fn unit(field: &str, d: V3<f64>) -> Result<V3<f64>, BuildError> {
    finite(field, &d)?;
    let size = dot(&d, &d).sqrt();
    if size > 0.0 {
        Ok(d.map(|x| x / size))
    } else {
        Err(BuildError::at(field, format!("`{field}` must have a length")))
    }
}

#[typetag::serde(name = "latch")]
impl ForceSpec for LatchSpec {
    fn markers(&self) -> Vec<&MarkerRef> {
        self.to.iter().chain(&self.on).collect()
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        positive("stiffness", self.stiffness)?;
        not_negative("damping", self.damping)?;
        positive("force", self.force)?;
        positive("fade", self.fade)?;
        need(!self.name.contains('/'), || {
            format!("`{}` can't be the name of a latch: it holds `/`", self.name)
        })?;
        let direction = self.direction.map(|d| unit("direction", d)).transpose()?;
        let floor = match self.floor {
            Some(f) => {
                positive("stiffness", f.stiffness).map_err(|e| e.of("floor"))?;
                finite("point", &f.point).map_err(|e| e.of("floor"))?;
                let normal = unit("normal", f.normal).map_err(|e| e.of("floor"))?;
                Some(Floor { point: f.point, normal, stiffness: f.stiffness })
            }
            None => None,
        };
        let on = self.to.as_ref().map(|to| b.marker("to", to)).transpose()?;
        if let Some(node) = on.and_then(|m| m.on())
            && b.nodes()[node.0 as usize].kind != NodeKind::Frame
        {
            return Err(BuildError::at("to", "seats can only be on a rigid body or fixed in space"));
        }
        let points = self.points(b)?;
        if points.is_empty() {
            return Err(BuildError::at("on", "`on` names nothing to hold: give parts or markers"));
        }
        let mut seats: Vec<Seat> = Vec::with_capacity(points.len());
        let q = b.coordinates().to_vec();
        let at = ropewalk_core::At { t: 0.0, q: &q, v: &[], a: &[], internal: &[], relaxed: None };
        for (k, point) in points.into_iter().enumerate() {
            if seats.iter().any(|s| s.ends[1] == point) {
                return Err(BuildError::at("on", "the same point is named twice"));
            }
            if point.size() == 0 {
                return Err(BuildError::at("on", "a point that is fixed in space needs no latch"));
            }
            let seat = self.seat(b, on, point.x(&at));
            if let (Held::Beside { v: body, .. }, Some(own)) = (seat, point.dofs().next())
                && body == own
            {
                return Err(BuildError::at("to", "a body can't be held at a seat on itself"));
            }
            let variable = b.internal_variable(format!("{}/{}", self.name, k + 1));
            seats.push(Seat { ends: [seat, point], variable });
        }
        let latch = Latch {
            label: self.name.clone(),
            stiffness: self.stiffness,
            damping: self.damping,
            hold: self.force,
            direction,
            fade: self.fade,
            floor,
            seats,
        };
        b.term(Box::new(latch.clone()));
        b.event(Release { latch, stop: self.stop });
        Ok(())
    }
}
