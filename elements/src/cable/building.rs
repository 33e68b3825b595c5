//! How a cable is built: its nodes, elements and part.

use super::damping::{push_axial_damping, push_bending_damping};
use super::flow::Line;
use super::flow::push::{self, Piece};
use super::layout::Layout;
use super::loops::LoopLimit;
use super::model::{CableModel, Sink, legal, push_cable};
use super::part::CablePart;
use super::rest::{Rest, push_rest};
use super::section::Section;
use super::spec::{CableSpec, StressFree};
use super::{CableParams, CableStations};
use ropewalk_core::error::finite;
use ropewalk_core::{
    BuildError, Element, Feed, MovingBoundary, Node, NodeId, NodeKind, StationPool, Stations, dot,
};
use ropewalk_scene::{Builder, ElementSpec};
use std::sync::Arc;

/// Bending stiffness of the end elements of a cable that has none, in parts of their weight times the square of their length.
const TIP: f64 = 0.01;

/// Elements shorter than this part of those that are born at an end stay there; any other is swallowed before it is so
/// short.
const RIDES: f64 = 0.45;

/// Stretches that a cable may be laid with.
const STRETCHES: std::ops::RangeInclusive<f64> = 0.1..=10.0;

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
            let message = "between the elements of the mesh that are shorter than half of `element`, which stay at the ends \
                           where cable feeds, there must be two longer ones: grade it less, or take a smaller `element`";
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
        // sections that turn are damped in axes of their own
        if s.bending_retardation_time > 0.0 && s.ei.across > 0.0 && !twists {
            push_bending_damping(pools, model, params.l, s.bending_retardation_time * s.ei.across, on)
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
