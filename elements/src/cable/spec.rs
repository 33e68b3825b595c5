//! `type = "cable"`: what a scene says about a cable.

use super::damping::{push_axial_damping, push_bending_damping};
use super::flow::Line;
use super::flow::push::{self, Piece};
use super::layout::Layout;
use super::lever::LeverSpec;
use super::loops::LoopLimit;
use super::mesh::{MeshSpec, counted, even, pinned};
use super::model::{CableModel, Integration, LongitudinalModel, Sink, TransverseModel, legal, push_cable};
use super::part::CablePart;
use super::rest::{Rest, push_rest};
use super::route::Waypoint;
use super::section::{NameOrSection, Section, SectionAlong};
use super::{CableParams, CableStations};
use crate::path::{Corner, Path};
use ropewalk_core::error::{finite, positive};
use ropewalk_core::{
    BuildError, Element, Feed, MovingBoundary, Node, NodeId, NodeKind, StationPool, Stations, V3, dot,
};
use ropewalk_scene::{Builder, ElementSpec, quantity, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Bending stiffness of the end elements of a cable that has none, in parts of their weight times the square of their length.
const TIP: f64 = 0.01;

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

    fn path(&self) -> Result<Path, BuildError> {
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

impl CableSpec {
    /// The boundaries at the ends that feed, and how the mesh follows them.
    fn line(
        &self,
        b: &mut Builder,
        model: CableModel,
        length: f64,
        mesh: &[f64],
        nodes: &[NodeId],
        feeding: [Option<Feed>; 2],
        rates: [f64; 2],
        layout: &Layout,
    ) -> Result<Line, BuildError> {
        push::check(model)?;
        if self.stress_free == StressFree::AsLaid || self.strain != 0.0 || self.curvature != 0.0 {
            let message = "what a winch feeds must be free of stress when straight and unstretched: leave out \
                           `stress_free`, `strain` and `curvature`";
            return Err(BuildError::at("stress_free", message));
        }
        let mut boundaries = Vec::new();
        for (end, _) in feeding.iter().enumerate().filter(|(_, f)| f.is_some()) {
            let at = if end == 0 { 0 } else { mesh.len() - 1 };
            let made_of = layout.section(if end == 0 { 0 } else { mesh.len() - 2 });
            let node = b.node(NodeKind::Scalars(1), &[mesh[at]], &[rates[end]])?;
            b.share(node);
            let (own, there) = (b.nodes()[node.0 as usize], b.nodes()[nodes[at].0 as usize]);
            boundaries.push((
                end,
                MovingBoundary {
                    node,
                    q: own.q,
                    v: own.v,
                    sign: if end == 0 { -1.0 } else { 1.0 },
                    home: if end == 0 { 0.0 } else { length },
                    end: nodes[at],
                    end_q: there.q,
                    end_v: there.v,
                    rho_a: made_of.mass + made_of.flooded,
                },
            ));
        }
        let ends = |is: fn(&Feed) -> bool| feeding.map(|f| f.as_ref().is_some_and(is));
        let zones = ends(|f| f.element.is_some());
        let line = Line::new(mesh, boundaries, zones, self.rides(mesh, feeding)?, layout.holds());
        let twist = feeding.map(|f| f.map_or(0.0, |f| f.twist));
        let grip = feeding.map(|f| f.map_or(0.0, |f| f.grip));
        Ok(Line { unstrained: ends(|f| f.unstrained), wound: ends(|f| f.wound), twist, grip, ..line })
    }

    /// Refuses what of a section a winch at this end can't feed.
    fn feeds_section(&self, end: usize, layout: &Layout) -> Result<(), BuildError> {
        let along = if end == 0 { self.sections.first() } else { self.sections.last() };
        if along.is_some_and(|along| along.end_section.is_some()) {
            let message = "what a winch feeds is the same all along its section: leave `end_section` out, or put a section \
                           between it and the winch";
            return Err(BuildError::at("sections", message));
        }
        let k = if end == 0 { 0 } else { layout.elements().last().unwrap_or(0) };
        if layout.elastic(k, 1.0, CableModel::default()).is_some() {
            let message =
                "what a winch feeds has constant stiffness: give its section `ea` and `ei`, and no tables";
            return Err(BuildError::at(if along.is_some() { "sections" } else { "section" }, message));
        }
        Ok(())
    }

    /// Whether it asks for torsion.
    fn twists(&self) -> bool {
        self.section.gj.is_some() || self.sections.iter().any(|along| along.section.gj.is_some())
    }

    /// How many elements of a graded mesh ride with each end where others are born: those that are shorter than what is
    /// swallowed there.
    fn rides(&self, mesh: &[f64], feeding: [Option<Feed>; 2]) -> Result<[usize; 2], BuildError> {
        if self.mesh.is_none() {
            return Ok([0; 2]);
        }
        let elements = mesh.len() - 1;
        let short = |end: usize| {
            let Some(element) = feeding[end].as_ref().and_then(|f| f.element) else { return 0 };
            let length = |k: &usize| {
                let k = if end == 0 { *k } else { elements - 1 - k };
                mesh[k + 1] - mesh[k]
            };
            (0..elements).take_while(|k| length(k) < RIDES * element).count()
        };
        let rides = [short(0), short(1)];
        if rides[0] + rides[1] + 2 > elements {
            let message = "between the elements of the mesh that are shorter than half of `element`, which stay at the ends                            where cable feeds, there must be two longer ones: grade it less, or take a smaller `element`";
            return Err(BuildError::at("mesh", message));
        }
        Ok(rides)
    }

    /// Damping and a stress-free shape of one element, where the scene asks for them.
    fn extras(
        &self,
        pools: &mut Pools<'_>,
        model: CableModel,
        params: CableParams,
        on: &[NodeId],
        shape: &[f64; 12],
        s: &Section,
        twists: bool,
    ) -> Result<(), BuildError> {
        // with torsion a curvature has a direction
        let kappa0 = if twists { 0.0 } else { self.curvature };
        if self.stress_free == StressFree::AsLaid {
            push_rest(pools, model, params, Rest::Stretched(*shape), on).map_err(BuildError::new)?;
        }
        if self.strain != 0.0 || kappa0 != 0.0 {
            let rest = Rest::Uniform { eps0: self.strain, kappa0 };
            push_rest(pools, model, params, rest, on).map_err(BuildError::new)?;
        }
        if s.axial_retardation_time > 0.0 {
            push_axial_damping(pools, model, params.l, s.axial_retardation_time * s.ea, on)
                .map_err(BuildError::new)?;
        }
        if s.bending_retardation_time > 0.0 && s.ei.across > 0.0 {
            push_bending_damping(pools, model, params.l, s.bending_retardation_time * s.ei.mean(), on)
                .map_err(BuildError::new)?;
        }
        Ok(())
    }
}

/// The stations of a cable that is at rest on its material.
fn stations(
    all: &[Node],
    mesh: &[f64],
    nodes: &[NodeId],
    layout: &Layout,
) -> Result<Arc<dyn Stations>, BuildError> {
    let mut stations = StationPool::<CableStations, 12, 12, 4>::new();
    for k in layout.elements() {
        let (l, s0, s) = (mesh[k + 1] - mesh[k], mesh[k], layout.section(k));
        let element = CableStations { l, s0, diameter: s.diameter, area: s.displaced_area() };
        if !stations.push(all, element, &[nodes[k], nodes[k + 1]]) {
            return Err(BuildError::new("the stations of the cable don't fit its nodes"));
        }
    }
    Ok(Arc::new(stations))
}

/// The nodes at which the force in the cable may jump or bend: its ends, where something holds on to it, and where one
/// section follows another.
fn breaks(mesh: &[f64], held: &[f64], layout: &Layout) -> Vec<usize> {
    let (last, near) = (mesh.len() - 1, 1e-9 * (mesh[mesh.len() - 1] - mesh[0]));
    let inner =
        (1..last).filter(|&k| layout.changes_at(k) || held.iter().any(|s| (s - mesh[k]).abs() <= near));
    std::iter::once(0).chain(inner).chain([last]).collect()
}

/// The sharpest corner that is no corner [rad]: at an angle θ the elements beside it are longer than their length by the
/// strain θ²/60, which is 1e-5 here.
const MOST_CORNER: f64 = 0.0245;

/// Elements shorter than this part of those that are born at an end stay there; any other is swallowed before it is so
/// short.
const RIDES: f64 = 0.45;

/// Stretches that a cable may be laid with.
const STRETCHES: std::ops::RangeInclusive<f64> = 0.1..=10.0;

struct Pools<'a> {
    builder: &'a mut Builder,
    result: Result<(), BuildError>,
}
impl Sink for Pools<'_> {
    fn push<E: Element<12, 12>>(&mut self, element: E, nodes: &[NodeId]) {
        if self.result.is_ok() {
            self.result = self.builder.element(element, nodes);
        }
    }
}

#[typetag::serde(name = "cable")]
impl ElementSpec for CableSpec {
    fn name(&self) -> &str {
        &self.name
    }

    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        self.check_sections()?;
        if !self.route.is_empty() {
            return self.build_route(b);
        }
        if self.speed != 0.0 {
            let message = "a cable runs with a `speed` along a `route`; give `velocity`";
            return Err(BuildError::at("speed", message));
        }
        finite("velocity", &self.velocity)?;
        finite("strain", &[self.strain])?;
        if !STRETCHES.contains(&(1.0 + self.strain)) {
            let message =
                format!("a strain at rest of {} is no cable's: give one between -0.9 and 9", self.strain);
            return Err(BuildError::at("strain", message));
        }
        finite("curvature", &[self.curvature])?;
        finite("twist", &[self.twist])?;
        finite("laid_twist", &[self.laid_twist])?;
        legal(self.longitudinal, self.transverse).map_err(|e| BuildError::at("transverse", e))?;
        let path = self.path()?;
        let length = self.unstretched_length(path.length())?;
        let stretch = path.length() / length;
        if !STRETCHES.contains(&stretch) {
            let field = if self.tension.is_some() { "tension" } else { "length" };
            let message = format!(
                "a cable of {length:e} m on a path of {} m would be stretched to {stretch:.1e} times its length",
                path.length()
            );
            return Err(BuildError::at(field, message));
        }
        let mut pins = b.pins(&self.name, length);
        pins.extend(self.pins_of_levers(length)?);
        let concentrated = pins.clone();
        pins.extend(path.stops().map(|s| s / stretch));
        pins.sort_by(f64::total_cmp);
        let (mut mesh, mut layout) = self.laid_out(length, &pins)?;
        let given = b.mesh(&self.name).cloned();
        let feeding = b.feeding(&self.name);
        let feeds = feeding.iter().any(Option::is_some);
        // a wheel holds the direction of an end
        let goes_on = feeding.map(|feed| feed.is_some_and(|feed| feed.passes));
        for end in (0..2).filter(|&end| feeding[end].is_some()) {
            self.feeds_section(end, &layout)?;
        }
        if let Some(given) = &given {
            layout.refit(&mesh, &given.nodes);
            mesh.clone_from(&given.nodes);
        }
        if mesh.len() < 2 || (mesh[0] != 0.0 && !feeds) || layout.elements().any(|k| !(mesh[k + 1] > mesh[k]))
        {
            return Err(BuildError::new("a mesh must start at 0 and ascend"));
        }

        let places: Vec<[f64; 6]> = (0..mesh.len())
            .map(|k| {
                // a cable that has fed since it was laid gets its true shape from the state before
                let (x, t) = match k {
                    // an end has stayed one while material went through it
                    0 => path.at(0.0),
                    k if k + 1 == mesh.len() => path.at(path.length()),
                    // sections keep the way they look
                    k if feeds && self.twists() => {
                        path.at((mesh[k] - mesh[0]) / (mesh[mesh.len() - 1] - mesh[0]) * path.length())
                    }
                    _ => path.at((mesh[k] * stretch).clamp(0.0, path.length())),
                };
                [x[0], x[1], x[2], t[0] * stretch, t[1] * stretch, t[2] * stretch]
            })
            .collect();
        let (mut twisted, laid) = self.twisted(&mesh, &places, &layout, length, feeds)?.unzip();
        let mut nodes = Vec::with_capacity(mesh.len());
        let mut seats = Vec::with_capacity(mesh.len());
        let state = given.as_ref().and_then(|m| m.state.as_ref());
        for (k, q) in places.iter().enumerate() {
            let v = [self.velocity[0], self.velocity[1], self.velocity[2], 0.0, 0.0, 0.0, 0.0];
            let node = match (state, &laid) {
                (Some(state), Some(laid)) => {
                    let node = b.node(NodeKind::Twist, &state.q[k], &state.v[k])?;
                    b.was_laid(node, &laid[k]);
                    node
                }
                (Some(state), None) => {
                    let node = b.node(NodeKind::Slope, &state.q[k], &state.v[k])?;
                    b.was_laid(node, q);
                    node
                }
                (None, Some(laid)) => b.node(NodeKind::Twist, &laid[k], &v)?,
                (None, None) => b.node(NodeKind::Slope, q, &v[..6])?,
            };
            nodes.push(node);
            let n = &b.nodes()[node.0 as usize];
            seats.push((n.q, n.v));
        }
        let model = CableModel {
            longitudinal: self.longitudinal,
            transverse: self.transverse,
            integration: self.integration,
        };
        let rates = state.map_or([0.0; 2], |s| s.boundaries);
        if twisted.is_none() && feeding.iter().flatten().any(|feed| feed.grip != 0.0) {
            let message = "this cable doesn't know whether it turns about its own axis: give its section a torsional stiffness, `gj`, \
                           or leave `grip` out where it feeds";
            return Err(BuildError::at("section.gj", message));
        }
        if twisted.is_none() && feeding.iter().flatten().any(|feed| feed.twist != 0.0) {
            let message = "cable comes off a coil with twist, which this one doesn't feel: give its section a torsional \
                           stiffness, `gj`, or leave `wrap` of its winch out";
            return Err(BuildError::at("section.gj", message));
        }
        let levers =
            self.markers_of_levers(&nodes, &mesh, laid.as_deref(), feeding.map(|feed| feed.is_some()))?;
        let line = if feeds {
            Some(self.line(b, model, length, &mesh, &nodes, feeding, rates, &layout)?)
        } else {
            None
        };
        let flows = |k: usize| line.as_ref().filter(|line| line.flows(k));
        let all = b.coordinates();
        let dofs = |k: usize| -> [f64; 12] {
            let (a, c): (usize, usize) = (seats[k].0, seats[k + 1].0);
            std::array::from_fn(|i| if i < 6 { all[a + i] } else { all[c + i - 6] })
        };
        let shapes: Vec<[f64; 12]> = (0..mesh.len() - 1).map(dofs).collect();
        let gravity = dot(&b.gravity(), &b.gravity()).sqrt();
        let params = |k: usize| {
            let (l, s) = (mesh[k + 1] - mesh[k], layout.section(k));
            // without tension a limp tip points anywhere: a little of the weight that hangs there straightens it
            let held = (k == 0 && goes_on[0]) || (k + 2 == mesh.len() && goes_on[1]);
            let tip = s.ei.largest() == 0.0 && layout.is_tip(k) && !held;
            let [ea, ei] = layout.stiffness(k);
            let ei = if tip { TIP * (s.mass * gravity) * l.powi(3) } else { ei };
            CableParams { l, ea, ei, rho_a: s.mass + s.flooded }
        };
        for k in 0..mesh.len() - 1 {
            let Some(line) = flows(k) else { continue };
            params(k).check().map_err(BuildError::new)?;
            push::push(
                b,
                model,
                params(k),
                layout.section(k),
                &Piece { line, k, on: [nodes[k], nodes[k + 1]] },
            )?;
        }
        let mut pools = Pools { builder: b, result: Ok(()) };
        for k in layout.elements().filter(|&k| flows(k).is_none()) {
            let (on, params, s) = ([nodes[k], nodes[k + 1]], params(k), layout.section(k));
            push_cable(&mut pools, model, params, &on).map_err(BuildError::new)?;
            if let Some(elastic) = layout.elastic(k, params.l, model) {
                elastic.push(&mut pools, &on);
            }
            self.extras(&mut pools, model, params, &on, &shapes[k], s, twisted.is_some())?;
        }
        pools.result?;
        for splice in layout.splices() {
            let name = format!("{}: splice at {} m", self.name, mesh[splice.node]);
            let [_, _, _, x, y, z] = places[splice.node];
            splice.join(b, name, &nodes, [x, y, z], twisted.is_some())?;
        }
        let stations = match &line {
            Some(line) => push::stations(b.nodes(), line, &nodes, &layout, false)?,
            None => stations(b.nodes(), &mesh, &nodes, &layout)?,
        };
        if let Some(twisted) = &mut twisted {
            twisted.inner = state.map(|state| state.inner.clone()).unwrap_or_default();
            twisted.push(b, &mesh, &nodes, &layout, line.as_ref())?;
        }
        let prestrain = given.as_ref().map_or_else(Vec::new, |m| m.prestrain.clone());
        if let Some(line) = &line {
            for strain in &prestrain {
                let k = strain.element;
                let piece = Piece { line, k, on: [nodes[k], nodes[k + 1]] };
                push::fading(b, model, strain, layout.section(k), &self.name, &piece)?;
            }
        }
        if twisted.is_some() {
            b.event(LoopLimit { part: self.name.clone() });
        }
        b.part(Arc::new(CablePart {
            breaks: breaks(&mesh, &concentrated, &layout),
            laid: length,
            carried: state.is_some(),
            prestrain,
            name: self.name.clone(),
            nodes,
            seats,
            mesh: layout.once(&mesh),
            along: mesh,
            layout,
            stations,
            all: if line.is_some() { b.nodes().to_vec() } else { Vec::new() },
            line,
            model,
            rest: (self.stress_free == StressFree::AsLaid).then_some(shapes),
            twisted,
            levers,
            offset: (self.strain, self.curvature),
        }))
    }
}
