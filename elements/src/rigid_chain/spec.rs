//! `type = "rigid_chain"`: what a scene says about a chain of rigid links.

use super::bends::{Bend, Bends};
use super::lay::{filling, joints};
use super::part::ChainPart;
use crate::cable::StressFree;
use crate::path::Path;
use crate::rigid_body::{Hull, Inertia};
use ropewalk_core::error::{finite, not_negative, positive};
use ropewalk_core::rotation::{around, exp, from_matrix, matrix, then, transposed_times};
use ropewalk_core::{BuildError, Equation, Joint, Marker, NodeKind, StationPool, V3, dot};
use ropewalk_scene::{Builder, ElementSpec, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// What the links of a chain are made of, per length. Every number stands for itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LinkSection {
    /// Structural mass per length [kg/m]; gravity acts on it.
    #[serde(deserialize_with = "quantity::mass_per_length")]
    pub mass: f64,
    /// Mass of the water inside [kg/m]. It moves with the part and has no weight in water.
    #[serde(default, deserialize_with = "quantity::mass_per_length")]
    pub flooded: f64,
    /// Hydrodynamic diameter, for drag and added mass [m]; without one, neither acts.
    #[serde(default, deserialize_with = "quantity::length")]
    pub diameter: f64,
    /// Displaced volume per length, for buoyancy [m²]. Default: `π/4 diameter²`.
    #[serde(default, deserialize_with = "quantity::optional::area")]
    pub displaced: Option<f64>,
    /// Radius of gyration about a link's axis [m]. Default: that of a solid cylinder, 0.354 times the diameter.
    #[serde(default, deserialize_with = "quantity::optional::length")]
    pub gyration: Option<f64>,
    /// Bending stiffness EI [N m²], as springs at the joints of moment `EI/l sin θ` about every axis: linear for small angles, 16 %
    /// less at a radian, and links fold where a moment exceeds `EI/l`.
    #[serde(default, deserialize_with = "quantity::bending_stiffness")]
    pub ei: f64,
    /// Damping of the joints about every axis [N m s/rad].
    #[serde(default, deserialize_with = "quantity::rotational_damping")]
    pub joint_damping: f64,
}

impl LinkSection {
    /// A section with mass [kg/m] and diameter [m] only.
    pub fn new(mass: f64, diameter: f64) -> Self {
        LinkSection {
            mass,
            flooded: 0.0,
            diameter,
            displaced: None,
            gyration: None,
            ei: 0.0,
            joint_damping: 0.0,
        }
    }
    /// Displaced volume per length [m²].
    pub fn displaced_area(&self) -> f64 {
        self.displaced.unwrap_or(PI * self.diameter * self.diameter / 4.0)
    }
    fn check(&self) -> Result<(), BuildError> {
        positive("mass", self.mass)?;
        for (name, x) in [
            ("flooded", self.flooded),
            ("diameter", self.diameter),
            ("displaced", self.displaced.unwrap_or(0.0)),
            ("ei", self.ei),
            ("joint_damping", self.joint_damping),
        ] {
            not_negative(name, x)?;
        }
        match self.gyration {
            Some(k) => positive("gyration", k).map(drop),
            None if self.diameter > 0.0 => Ok(()),
            None => {
                let message =
                    "a link without `diameter` needs `gyration`: it resists turning about its own axis too";
                Err(BuildError::at("gyration", message))
            }
        }
    }
    /// Inertia of a link of this length [m]; its axis is x.
    fn inertia(&self, length: f64) -> Inertia {
        let mass = (self.mass + self.flooded) * length;
        let square = self.gyration.map_or(self.diameter * self.diameter / 8.0, |k| k * k);
        let (along, across) = (mass * square, mass * (length * length / 12.0 + 0.5 * square));
        Inertia { mass, inertia: [[along, 0.0, 0.0], [0.0, across, 0.0], [0.0, 0.0, across]] }
    }
}

/// Turns on a spool, on which a chain goes on from the last of its `points`: their distance from the axis is the radius.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpoolSpec {
    /// A point on the axis [m].
    #[serde(deserialize_with = "quantity::vec3::length")]
    pub centre: V3<f64>,
    /// Direction of the axis. The turns follow it, right-handed about it.
    pub axis: V3<f64>,
    /// Distance from turn to turn along the axis [m]; negative for turns that are left-handed about it.
    #[serde(deserialize_with = "quantity::length")]
    pub pitch: f64,
    /// Number of turns. Default: as many as the `length` of the chain needs.
    #[serde(default, deserialize_with = "quantity::optional::number")]
    pub turns: Option<f64>,
}

/// A chain of rigid links of equal length with spherical joints: a hose, a tether, a chain.
///
/// It starts at rest with the ends of all links on its path. Markers: `name.start`, `name.end`, `name@12.5m` (a point
/// of a link), `name.link3` (the centre of the third). The joint between the third and the fourth link is the
/// constraint `name/3`, so its reaction is the tension there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigidChainSpec {
    /// Name; the rest of the scene refers to the part by it.
    pub name: String,
    /// Number of links.
    pub links: usize,
    /// Length of the chain [m]. Default: the chain fills its path. A shorter chain ends on the path.
    #[serde(default, deserialize_with = "quantity::optional::length")]
    pub length: Option<f64>,
    /// Points of the path along which it is laid, from start to end [m], joined by straight lines.
    #[serde(default, deserialize_with = "quantity::points")]
    pub points: Vec<V3<f64>>,
    /// Points of a smooth path [m], instead of `points`.
    #[serde(default, deserialize_with = "quantity::points")]
    pub curve: Vec<V3<f64>>,
    /// Spool that carries the rest of the chain, after the last of the points.
    #[serde(default)]
    pub spool: Option<SpoolSpec>,
    /// Cross-section.
    pub section: LinkSection,
    /// Shape in which its joints have no bending moment.
    #[serde(default)]
    pub stress_free: StressFree,
    /// Initial velocity of the whole chain [m/s].
    #[serde(default, deserialize_with = "quantity::vec3::speed")]
    pub velocity: V3<f64>,
}
register_spec!(Element, "rigid_chain", RigidChainSpec);

impl RigidChainSpec {
    /// A chain laid along straight lines between points, which it fills.
    pub fn new(name: &str, points: Vec<V3<f64>>, links: usize, section: LinkSection) -> Self {
        RigidChainSpec {
            name: name.into(),
            links,
            length: None,
            points,
            curve: Vec::new(),
            spool: None,
            section,
            stress_free: StressFree::default(),
            velocity: [0.0; 3],
        }
    }

    fn path(&self) -> Result<Path, BuildError> {
        let path = match (self.points.is_empty(), self.curve.is_empty()) {
            (false, true) => Path::polyline(&self.points).map_err(|e| BuildError::at("points", e)),
            (true, false) => Path::spline(&self.curve, [None; 2]).map_err(|e| BuildError::at("curve", e)),
            (true, true) => Err(BuildError::new("a chain needs `points` or `curve`: where is it laid?")),
            (false, false) => Err(BuildError::at("curve", "give `points` or `curve`, not both")),
        }?;
        let Some(spool) = &self.spool else { return Ok(path) };
        let at_spool = |e| BuildError::at("spool", e);
        let turns = match (spool.turns, self.length) {
            (Some(turns), _) => turns,
            (None, Some(length)) => self.turns(spool, &path, length).map_err(at_spool)?,
            (None, None) => {
                return Err(at_spool(
                    "say how much is on the spool: give its `turns` or the chain's `length`".into(),
                ));
            }
        };
        path.wind(spool.centre, spool.axis, spool.pitch, turns).map_err(at_spool)
    }

    /// Turns that surely hold the chain.
    fn turns(&self, spool: &SpoolSpec, path: &Path, length: f64) -> Result<f64, String> {
        let arm: V3<f64> = {
            let end = path.at(path.length()).0;
            std::array::from_fn(|i| end[i] - spool.centre[i])
        };
        let size = dot(&spool.axis, &spool.axis);
        let radius = (dot(&arm, &arm) - dot(&arm, &spool.axis).powi(2) / size).max(0.0).sqrt();
        let link = length / self.links as f64;
        if !(link < 1.9 * radius) {
            return Err(format!(
                "links of {link} m are too long for a spool of radius {radius:.3} m: take more links or a larger spool"
            ));
        }
        // chords are shorter than their arcs
        let arc = 2.0 * radius * (0.5 * link / radius).asin() * self.links as f64;
        Ok(arc / (TAU * radius) + 1.0)
    }

    fn laid(&self) -> Result<(Vec<V3<f64>>, f64), BuildError> {
        let path = self.path()?;
        let link = match self.length {
            Some(length) => positive("length", length)? / self.links as f64,
            None => filling(&path, self.links).map_err(|e| BuildError::at("links", e))?,
        };
        if link < 1e-9 * path.length() {
            let message = format!(
                "links of {link:e} m are lost in the rounding of a path of {:.6} m: give a larger `length` or fewer `links`",
                path.length()
            );
            return Err(BuildError::at("length", message));
        }
        let joints = joints(&path, self.links, link).map_err(|fit| {
            let message = format!(
                "the path, {:.6} m long, ends after {fit} of {} links of {link:.6} m: lengthen it or shorten the chain",
                path.length(),
                self.links
            );
            BuildError::at("length", message)
        })?;
        Ok((joints, link))
    }
}

/// Orientations of links along these directions, each turned from the one before by the shortest way.
pub fn orientations(directions: &[V3<f64>]) -> Vec<[f64; 4]> {
    let [n, m, d] = around(directions[0]);
    // columns are the axes of the first link: along, and two across
    let mut q = from_matrix(&std::array::from_fn(|i| [d[i], n[i], m[i]]));
    let mut all = vec![q];
    for w in directions.windows(2) {
        let r = matrix(&q);
        let to = transposed_times(&r, &w[1]);
        let across = [0.0, -to[2], to[1]];
        let sine = to[1].hypot(to[2]);
        let angle = sine.atan2(to[0]);
        // straight back there is no shortest way: about any axis across
        let turn = if sine > 1e-12 {
            across.map(|x| x * angle / sine)
        } else {
            [0.0, 0.0, if to[0] < 0.0 { PI } else { 0.0 }]
        };
        q = then(q, exp(turn));
        let size = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        q = q.map(|x| x / size);
        all.push(q);
    }
    all
}

#[typetag::serde(name = "rigid_chain")]
impl ElementSpec for RigidChainSpec {
    fn name(&self) -> &str {
        &self.name
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let s = &self.section;
        s.check()?;
        finite("velocity", &self.velocity)?;
        if self.links == 0 || self.links > 100_000 {
            let message = format!("`links` must be between 1 and 100000, not {}", self.links);
            return Err(BuildError::at("links", message));
        }
        let (joints, link) = self.laid()?;
        let directions: Vec<V3<f64>> =
            joints.windows(2).map(|w| std::array::from_fn(|i| (w[1][i] - w[0][i]) / link)).collect();
        let inertia = s.inertia(link);
        let hull = Hull {
            from: [-0.5 * link, 0.0, 0.0],
            axis: [link, 0.0, 0.0],
            length: link,
            s0: 0.0,
            diameter: s.diameter,
            area: s.displaced_area(),
        };
        let mut stations = StationPool::<Hull, 7, 6, 4>::new();
        let (mut nodes, mut seats) = (Vec::new(), Vec::new());
        for (k, quaternion) in orientations(&directions).into_iter().enumerate() {
            let mut q: Vec<f64> = (0..3).map(|i| 0.5 * (joints[k][i] + joints[k + 1][i])).collect();
            q.extend(quaternion);
            let v = [self.velocity[0], self.velocity[1], self.velocity[2], 0.0, 0.0, 0.0];
            let node = b.node(NodeKind::Frame, &q, &v)?;
            b.element(inertia, &[node])?;
            for part in (Hull { s0: k as f64 * link, ..hull }).parts(self.links as f64 * link, b.water().ok())
            {
                let fits = stations.push(b.nodes(), part, &[node]);
                debug_assert!(fits, "a hull sits on one frame");
            }
            let seat = b.nodes()[node.0 as usize];
            nodes.push(node);
            seats.push((seat.q, seat.v));
        }
        let half = 0.5 * link;
        for (k, w) in nodes.windows(2).enumerate() {
            let between = [Marker::beside(w[0], [half, 0.0, 0.0]), Marker::beside(w[1], [-half, 0.0, 0.0])];
            let name = format!("{}/{}", self.name, k + 1);
            b.constraint(Joint::new(name, b.nodes(), between, Equation::coincide())?)?;
        }
        if s.ei > 0.0 || s.joint_damping > 0.0 {
            let all = b.coordinates();
            let rest = |k: usize| match self.stress_free {
                StressFree::Straight => [1.0, 0.0, 0.0],
                StressFree::AsLaid => {
                    let q = seats[k].0;
                    let r = matrix(&[all[q + 3], all[q + 4], all[q + 5], all[q + 6]]);
                    transposed_times(&r, &directions[k + 1])
                }
            };
            let bends = (0..self.links - 1).map(|k| Bend {
                q: [seats[k].0, seats[k + 1].0],
                v: [seats[k].1, seats[k + 1].1],
                rest: rest(k),
            });
            let (label, stiffness) = (format!("{}: joints", self.name), s.ei / link);
            let joints = bends.collect();
            b.term(Box::new(Bends { label, stiffness, damping: s.joint_damping, joints }));
        }
        b.part(Arc::new(ChainPart {
            name: self.name.clone(),
            nodes,
            seats,
            link,
            diameter: s.diameter,
            mass: s.mass * link,
            volume: s.displaced_area() * link,
            stations: (s.diameter > 0.0).then(|| Arc::new(stations) as _),
        }))
    }
}
