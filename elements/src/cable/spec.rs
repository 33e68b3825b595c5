//! `type = "cable"`: what a scene says about a cable.

use super::lever::LeverSpec;
use super::mesh::{MeshSpec, counted, even, pinned};
use super::model::{Integration, LongitudinalModel, TransverseModel};
use super::route::Waypoint;
use super::section::{NameOrSection, Section, SectionAlong};
use crate::path::{Corner, Path};
use ropewalk_core::error::{finite, positive};
use ropewalk_core::{BuildError, V3};
use ropewalk_scene::{quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The sharpest corner that is no corner [rad]: at an angle θ the elements beside it are longer than their length by the
/// strain θ²/60, which is 1e-5 here.
const MOST_CORNER: f64 = 0.0245;

/// The shape in which a cable is free of stress.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum StressFree {
    /// Straight and unstretched.
    #[default]
    Straight,
    /// As laid: the initial stretch and curvature cause no stress. Sections then have an orientation and resist
    /// torsion.
    AsLaid,
}

/// A cable, hose or tether with large displacements, stretch and bending, and torsion if its section has a torsional
/// stiffness `gj`.
///
/// It is a chain of ANCF elements with 6 velocities per node, with torsion 7. Markers: `name.start`, `name.end`, `name@12.5m`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CableSpec {
    /// Name; the rest of the scene refers to the part by it.
    pub name: String,
    /// Points of the path along which it is laid, from start to end [m], joined by straight lines. At corners, give a
    /// `radius`: a sharp corner would strain the cable.
    #[serde(default, deserialize_with = "quantity::points")]
    pub points: Vec<V3<f64>>,
    /// Bend radius at the corners of `points` [m]. The arcs have elements of their own.
    #[serde(
        default,
        deserialize_with = "quantity::optional::length",
        skip_serializing_if = "Option::is_none"
    )]
    pub radius: Option<f64>,
    /// Points of a smooth path [m], instead of `points`: a cubic spline passes through them.
    #[serde(default, deserialize_with = "quantity::points")]
    pub curve: Vec<V3<f64>>,
    /// Direction of `curve` at its start. Default: follows from the first points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start_direction: Option<V3<f64>>,
    /// Direction of `curve` at its end. Default: follows from the last points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end_direction: Option<V3<f64>>,
    /// What it runs over and through, from end to end, instead of `points`:
    /// `[{ end = "drum" }, { over = "head" }, { under = "block" }, { end = "jib.anchor" }]`. Sheaves and rings are
    /// constraints of their own. The cable is then several spans, `name.1`, `name.2`, …, each with `elements` elements, and
    /// runs freely from one to the next; its shape at the start is the shortest taut line. A route without ends is that of a
    /// closed belt: `[{ round = "driver" }, { round = "driven" }]`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub route: Vec<Waypoint>,
    /// Speed with which a cable with a `route` runs along it at the start, from its start to its end [m/s].
    #[serde(default, deserialize_with = "quantity::speed", skip_serializing_if = "is_nought")]
    pub speed: f64,
    /// Unstretched length [m]. Default: the length of the path. Another length is strained uniformly to fit the path.
    #[serde(default, deserialize_with = "quantity::optional::length")]
    pub length: Option<f64>,
    /// Initial tension [N], instead of `length`: the path is longer than the cable by the strain `tension / ea`.
    #[serde(
        default,
        deserialize_with = "quantity::optional::force",
        skip_serializing_if = "Option::is_none"
    )]
    pub tension: Option<f64>,
    /// Number of elements of equal length. Give `elements` or `mesh`.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub elements: usize,
    /// Elements of different lengths instead of `elements`: `{ elements = 24, last = "1 mm" }` grades them towards
    /// the end, `first` towards the start, both towards both; or a list with the length of each, from start to end
    /// [m]. Where the direction is held, elements should be shorter than the bending layer `√(EI/T)`. A graded end
    /// stays graded while a winch pays out there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh: Option<MeshSpec>,
    /// Cross-section, `{ mass = …, ea = …, ei = … }`, with the fields that `ropewalk describe sections` tells; or the name of one
    /// of the scene's `sections`: `section = "chain"`. Give `section` or `sections`.
    #[serde(default, skip_serializing_if = "Section::is_missing")]
    #[schemars(with = "NameOrSection")]
    pub section: Section,
    /// Several sections one after the other, from start to end:
    /// `[{ to = "200 m", section = "chain" }, { section = "wire" }]`. Sections that stretch differently are spliced: their
    /// tangents agree, and where one of them has no bending stiffness it can turn freely. Weight, buoyancy, drag and contact
    /// are those of the section at each place.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sections: Vec<SectionAlong>,
    /// Longitudinal stiffness model: L1, L1n, L2, L3 or L4.
    #[serde(default)]
    pub longitudinal: LongitudinalModel,
    /// Transverse stiffness model: T1, T2 or T3; T2 and T3 go with L3 and L4 only.
    #[serde(default)]
    pub transverse: TransverseModel,
    /// Quadrature of the pointwise models.
    #[serde(default)]
    pub integration: Integration,
    /// Initial velocity of the whole cable [m/s].
    #[serde(default, deserialize_with = "quantity::vec3::speed")]
    pub velocity: V3<f64>,
    /// Stress-free shape.
    #[serde(default)]
    pub stress_free: StressFree,
    /// Stress-free strain, added to that of `stress_free` [1].
    #[serde(default, deserialize_with = "quantity::number")]
    pub strain: f64,
    /// Stress-free curvature, added to that of `stress_free` [1/m]. Of a cable with torsion it is about the `normal` of the
    /// section; without, it has no direction, and the cable can curl to any side.
    #[serde(default, deserialize_with = "quantity::curvature")]
    pub curvature: f64,
    /// Direction in space of the first director of the section, at the start of the cable: the axis about which the first of
    /// two bending stiffnesses and `curvature` are. Along the cable it is laid without twist. Default: where a curved cable
    /// bends most, at right angles to the plane in which it does; else it doesn't matter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normal: Option<V3<f64>>,
    /// Stress-free twist per length of a cable with torsion, added to that of `stress_free` [rad/m].
    #[serde(default, deserialize_with = "quantity::curvature", skip_serializing_if = "is_nought")]
    pub twist: f64,
    /// Twist per length with which a cable with torsion is laid [rad/m]. What is wound on a drum at the start keeps it, whatever
    /// equilibrium the run begins with.
    #[serde(default, deserialize_with = "quantity::curvature", skip_serializing_if = "is_nought")]
    pub laid_twist: f64,
    /// Points beside the axis of a cable with torsion, by name, that its sections carry along, such as the end of a crank:
    /// `levers.crank = { at = "end", offset = [0, 0, "10 cm"] }` gives a marker `name.crank`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub levers: BTreeMap<String, LeverSpec>,
}

register_spec!(Element, "cable", CableSpec);

fn is_zero(x: &usize) -> bool {
    *x == 0
}

fn is_nought(x: &f64) -> bool {
    *x == 0.0
}

impl CableSpec {
    /// A cable laid straight between two points, with the default models.
    pub fn straight(name: &str, from: V3<f64>, to: V3<f64>, elements: usize, section: Section) -> Self {
        CableSpec {
            name: name.into(),
            points: vec![from, to],
            radius: None,
            curve: Vec::new(),
            route: Vec::new(),
            speed: 0.0,
            start_direction: None,
            end_direction: None,
            length: None,
            tension: None,
            elements,
            mesh: None,
            section,
            sections: Vec::new(),
            longitudinal: LongitudinalModel::default(),
            transverse: TransverseModel::default(),
            integration: Integration::default(),
            velocity: [0.0; 3],
            stress_free: StressFree::default(),
            strain: 0.0,
            curvature: 0.0,
            normal: None,
            twist: 0.0,
            laid_twist: 0.0,
            levers: BTreeMap::new(),
        }
    }
    /// With other stiffness models.
    #[must_use]
    pub fn models(mut self, l: LongitudinalModel, t: TransverseModel, integration: Integration) -> Self {
        (self.longitudinal, self.transverse, self.integration) = (l, t, integration);
        self
    }
    /// With another unstretched length [m].
    #[must_use]
    pub fn unstretched(mut self, length: f64) -> Self {
        self.length = Some(length);
        self
    }

    /// The unstretched length of a cable that is laid along a path of this length.
    pub(super) fn unstretched_length(&self, path: f64) -> Result<f64, BuildError> {
        match (self.length_of_sections()?, self.tension) {
            (Some(_), Some(_)) => {
                let message = "give `length` or `tension`, not both: one follows from the other";
                Err(BuildError::at("tension", message))
            }
            (length, None) => positive("length", length.unwrap_or(path)),
            (None, Some(tension)) => {
                finite("tension", &[tension])?;
                let stretch = 1.0 + tension / self.section.ea;
                if stretch > 0.0 {
                    return Ok(path / stretch);
                }
                let message = format!("a tension of {tension} N would press the cable to nothing");
                Err(BuildError::at("tension", message))
            }
        }
    }

    /// Arc lengths of the nodes of a cable of this length, with one at each of these places.
    pub(super) fn divided(&self, length: f64, pins: &[f64]) -> Result<Vec<f64>, BuildError> {
        match (&self.mesh, self.elements) {
            (Some(_), n) if n > 0 => {
                let message = "give `elements` or `mesh`, not both: a mesh has its own number of elements";
                Err(BuildError::at("mesh", message))
            }
            (Some(mesh), _) => Ok(pinned(&mesh.nodes(length)?, pins)),
            (None, n) => Ok(even(length, counted("elements", n)?, pins)),
        }
    }

    pub(super) fn path(&self) -> Result<Path, BuildError> {
        let directions = [self.start_direction, self.end_direction];
        for (field, direction) in ["start_direction", "end_direction"].into_iter().zip(directions) {
            let Some(direction) = direction else { continue };
            finite(field, &direction)?;
            let message = if direction == [0.0; 3] {
                "a direction must have a length, like [1, 0, 0]"
            } else if !self.points.is_empty() {
                "straight lines between `points` have their own directions: lay it along a `curve`"
            } else {
                continue;
            };
            return Err(BuildError::at(field, message));
        }
        match (self.points.is_empty(), self.curve.is_empty()) {
            (false, true) => {
                let Some(radius) = self.radius else { return self.sharp() };
                let radius = positive("radius", radius)?;
                // what is wrong with the points themselves
                Path::polyline(&self.points).map_err(|e| BuildError::at("points", e))?;
                Path::rounded(&self.points, radius).map_err(|e| BuildError::at("radius", e))
            }
            (true, false) if self.radius.is_some() => {
                Err(BuildError::at("radius", "a `curve` has no corners to round: leave `radius` out"))
            }
            (true, false) => Path::spline(&self.curve, directions).map_err(|e| BuildError::at("curve", e)),
            (true, true) => Err(BuildError::new("a cable needs `points` or `curve`: where is it laid?")),
            (false, false) => Err(BuildError::at("curve", "give `points` or `curve`, not both")),
        }
    }

    /// Straight lines whose corners aren't rounded: only what is free of stress as it is laid may have any.
    fn sharp(&self) -> Result<Path, BuildError> {
        let path = Path::polyline(&self.points).map_err(|e| BuildError::at("points", e))?;
        let strained = |c: &&Corner| self.stress_free == StressFree::Straight && c.angle > MOST_CORNER;
        let Some(corner) = path.corners().iter().find(strained) else { return Ok(path) };
        let round = |x: f64| (1e4 * x).round() / 1e4;
        let [x, y, z] = corner.at.map(round);
        let message = format!(
            "the cable turns by {} degrees at the point ({x}, {y}, {z}) m, {} m along it, and would be strained there from \
             the start: give the bend radius of its corners, `radius`, or lay it along a smooth `curve`, or let it be free \
             of stress as it is laid, `stress_free = \"as-laid\"`",
            round(corner.angle.to_degrees()),
            round(corner.s)
        );
        Err(BuildError::at("points", message))
    }
}
