//! The builder: turns specs into a model and owns the names.

use crate::inputs::Inputs;
use crate::marker::{MarkerRef, split_marker};
use crate::motions::{Motions, no_motion};
use crate::reeving::{Guide, Passage, Winding};
use crate::scene::GRAVITY;
use crate::water::{Air, Water};
use ropewalk_core::error::finite;
use ropewalk_core::{
    At, BuildError, Constraint, Element, Event, Feed, FieldTerm, Law, Laws, Marker, Mesh, Model, Motion,
    MovingBoundary, Node, NodeId, NodeKind, Part, Place, Pool, Signal, Spot, Start, Stations, Switches, Term,
    V3, find_redundancy,
};
use ropewalk_quantity::{Kind, Setting};
use std::any::{Any, TypeId};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Arc;

/// Part and end of a marker at an end of a cable.
fn end_of(marker: &MarkerRef) -> Result<(&str, usize), BuildError> {
    let ends = "material flows through an end of a cable: name one, like `hose.start` or `hose.end`";
    let MarkerRef::Name(name) = marker else { return Err(BuildError::at("marker", ends)) };
    match split_marker(name).map_err(|e| BuildError::at("marker", format!("marker `{name}`: {e}")))? {
        (part, Spot::Named(end)) if end == "start" => Ok((part, 0)),
        (part, Spot::Named(end)) if end == "end" => Ok((part, 1)),
        // of a span of a cable with a route
        (_, Spot::Named(place)) if place.contains('.') => match name.rsplit_once('.') {
            Some((span, "start")) => Ok((span, 0)),
            Some((span, "end")) => Ok((span, 1)),
            _ => Err(BuildError::at("marker", format!("{marker}: {ends}"))),
        },
        _ => Err(BuildError::at("marker", format!("{marker}: {ends}"))),
    }
}

trait AnyPool: Term {
    fn as_any(&mut self) -> &mut dyn Any;
    fn into_term(self: Box<Self>) -> Box<dyn Term>;
}
impl<E: Element<Q, N>, const Q: usize, const N: usize> AnyPool for Pool<E, Q, N> {
    fn as_any(&mut self) -> &mut dyn Any {
        self
    }
    fn into_term(self: Box<Self>) -> Box<dyn Term> {
        self
    }
}

/// A part with its number in the scene.
pub type Numbered = (usize, Arc<dyn Part>);

/// Collects nodes, terms, constraints and parts, and makes a [`Model`] of them.
#[derive(Default)]
pub struct Builder {
    nodes: Vec<Node>,
    start: Start,
    /// The coordinates when the run began: others than at the start where a mesh has changed on the way.
    laid: Vec<f64>,
    pools: Vec<(TypeId, String, Box<dyn AnyPool>)>,
    terms: Vec<Box<dyn Term>>,
    constraints: Vec<Box<dyn Constraint>>,
    parts: Vec<Arc<dyn Part>>,
    /// What acts on the stations of a part, or on those that follow its material.
    laws: BTreeMap<(usize, bool), Laws>,
    motions: Motions,
    inputs: Inputs,
    /// Places at which a cable needs a node, by part.
    pins: HashMap<String, Vec<Spot>>,
    /// Meshes that replace those of the specs, by part.
    meshes: HashMap<String, Mesh>,
    /// What flows through the ends of parts, at the start and at the end, and the constraint that says so.
    feeds: HashMap<String, [Option<(Feed, String)>; 2]>,
    /// What cables can run over, by name.
    guides: BTreeMap<String, Guide>,
    /// Where they do.
    passages: Vec<Passage>,
    /// Ends of cables that are wound on drums.
    windings: Vec<Winding>,
    /// Cables with a route, whose spans are named `NAME.1`, `NAME.2`, …
    routes: HashSet<String>,
    /// The parts that have weight, all of them if one list is empty.
    weighs: Vec<Vec<String>>,
    water: Option<Water>,
    air: Option<Air>,
    /// What acts on which part already and may do so only once.
    acting: HashSet<(&'static str, usize)>,
    gravity: Option<V3<f64>>,
    statics: bool,
    switches: Switches,
    length: f64,
}

impl Builder {
    /// An empty builder.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a node that starts at `q` and moves with `v`.
    pub fn node(&mut self, kind: NodeKind, q: &[f64], v: &[f64]) -> Result<NodeId, BuildError> {
        if q.len() != kind.coordinates() || v.len() != kind.velocities() {
            return Err(BuildError::new(format!(
                "a {kind:?} node has {} coordinates and {} velocities, not {} and {}",
                kind.coordinates(),
                kind.velocities(),
                q.len(),
                v.len()
            )));
        }
        if q.iter().chain(v).any(|x| !x.is_finite()) {
            return Err(BuildError::new("a node has a coordinate or velocity that is not a finite number"));
        }
        let id = NodeId(self.nodes.len() as u32);
        self.nodes.push(Node { kind, q: self.start.q.len(), v: self.start.v.len(), shared: false });
        self.start.q.extend_from_slice(q);
        self.start.v.extend_from_slice(v);
        self.laid.extend_from_slice(q);
        Ok(id)
    }

    /// Says where a node was when the run began, if it isn't where it starts now: of a mesh that is changed on the way.
    pub fn was_laid(&mut self, node: NodeId, q: &[f64]) {
        self.laid[self.nodes[node.0 as usize].coords()].copy_from_slice(q);
    }

    /// The nodes so far.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The coordinates when the run began, of the nodes so far.
    pub fn coordinates(&self) -> &[f64] {
        &self.laid
    }

    /// Marks a node as shared by many elements, so that it is eliminated last.
    pub fn share(&mut self, node: NodeId) {
        self.nodes[node.0 as usize].shared = true;
    }

    /// Adds an element to the pool of its type.
    pub fn element<E: Element<Q, N>, const Q: usize, const N: usize>(
        &mut self,
        element: E,
        on: &[NodeId],
    ) -> Result<(), BuildError> {
        let (id, label) = (TypeId::of::<Pool<E, Q, N>>(), element.label());
        let at = match self.pools.iter().position(|(t, l, _)| *t == id && *l == label) {
            Some(at) => at,
            None => {
                self.pools.push((id, label.clone(), Box::new(Pool::<E, Q, N>::new())));
                self.pools.len() - 1
            }
        };
        let fits = match self.pools[at].2.as_any().downcast_mut::<Pool<E, Q, N>>() {
            Some(pool) => pool.push(&self.nodes, element, on),
            None => false,
        };
        if fits { Ok(()) } else { Err(BuildError::new(format!("element `{label}` doesn't fit its nodes"))) }
    }

    /// Adds a term.
    pub fn term(&mut self, term: Box<dyn Term>) {
        self.terms.push(term);
    }

    /// Adds a constraint.
    pub fn constraint(&mut self, constraint: impl Constraint + 'static) -> Result<(), BuildError> {
        if constraint.nodes().is_empty() {
            return Err(BuildError::new(format!(
                "constraint `{}` holds only points fixed in space: there is nothing to constrain",
                constraint.name()
            )));
        }
        if self.constraints.iter().any(|c| c.name() == constraint.name()) {
            return Err(BuildError::at(
                "name",
                format!("there are two constraints named `{}`", constraint.name()),
            ));
        }
        self.constraints.push(Box::new(constraint));
        Ok(())
    }

    /// Adds an internal variable: a number of the state that events change, at first 0. Returns its place in
    /// [`State::internal`](ropewalk_core::State::internal).
    pub fn internal_variable(&mut self, name: impl Into<String>) -> usize {
        self.switches.internal.push(name.into());
        self.start.internal.push(0.0);
        self.start.internal.len() - 1
    }

    /// Adds internal variables for what a term remembers, at first all 0. Returns the place of the first in
    /// [`State::internal`](ropewalk_core::State::internal).
    pub fn memory(&mut self, name: &str, size: usize) -> usize {
        let first = self.start.internal.len();
        self.switches.internal.extend(std::iter::repeat_n(name.to_string(), size));
        self.start.internal.resize(first + size, 0.0);
        first
    }

    /// Adds an event that every run of the model watches for.
    pub fn event(&mut self, event: impl Event + 'static) {
        self.switches.events.push(Arc::new(event));
    }

    /// Makes a constraint let go once an internal variable isn't zero. Returns the number of the constraint.
    ///
    /// # Errors
    /// There is no constraint of this name before, or it can let go already.
    pub fn release(&mut self, constraint: &str, variable: usize) -> Result<usize, BuildError> {
        let Some(c) = self.constraints.iter().position(|c| c.name() == constraint) else {
            let names: Vec<String> = self.constraints.iter().map(|c| format!("`{}`", c.name())).collect();
            let names = if names.is_empty() { "none".into() } else { names.join(", ") };
            let message = format!("there is no constraint `{constraint}` above; those above are {names}");
            return Err(BuildError::at("constraint", message));
        };
        if self.switches.released.insert(c, variable).is_some() {
            return Err(BuildError::at(
                "constraint",
                format!("constraint `{constraint}` is to break in two ways"),
            ));
        }
        Ok(c)
    }

    /// Adds a named part.
    pub fn part(&mut self, part: Arc<dyn Part>) -> Result<(), BuildError> {
        let name = part.name();
        let span = name.rsplit_once('.').filter(|(route, _)| self.routes.contains(*route));
        if name.is_empty() || span.map_or(name, |(_, number)| number).contains(['.', '@']) {
            return Err(BuildError::at(
                "name",
                format!("`{name}` can't be a name: it is empty or holds `.` or `@`"),
            ));
        }
        if self.parts.iter().any(|p| p.name() == name) {
            return Err(BuildError::at("name", format!("there are two parts named `{name}`")));
        }
        self.length = self.length.max(part.length());
        self.parts.push(part);
        Ok(())
    }

    /// The parts so far, or those of these names, each with its number.
    pub fn parts(&self, names: &[String]) -> Result<Vec<Numbered>, BuildError> {
        if names.is_empty() {
            return Ok(self.parts.iter().cloned().enumerate().collect());
        }
        let mut all = Vec::new();
        for name in names {
            let (k, part) = self.find(name, "on")?;
            for span in part.spans() {
                all.push(self.find(span.name(), "on")?);
            }
            // what lies on wheels is no place for a load
            if part.spans().is_empty() {
                all.push((k, part));
            }
        }
        Ok(all)
    }

    fn find(&self, name: &str, field: &'static str) -> Result<(usize, Arc<dyn Part>), BuildError> {
        match self.parts.iter().position(|p| p.name() == name) {
            Some(k) => Ok((k, self.parts[k].clone())),
            None => Err(BuildError::at(
                field,
                format!("there is no part `{name}`; the parts are {}", self.part_names()),
            )),
        }
    }

    fn part_names(&self) -> String {
        let names: Vec<String> = self.parts.iter().map(|p| format!("`{}`", p.name())).collect();
        if names.is_empty() { "none".into() } else { names.join(", ") }
    }

    /// Finds a marker.
    pub fn marker(&self, field: &'static str, marker: &MarkerRef) -> Result<Marker, BuildError> {
        let name = match marker {
            MarkerRef::Point(p) => {
                finite(field, p)?;
                return Ok(Marker::ground(*p));
            }
            MarkerRef::Name(name) => name,
        };
        let (part, spot) =
            split_marker(name).map_err(|e| BuildError::at(field, format!("marker `{name}`: {e}")))?;
        let (_, part) = self.find(part, field)?;
        part.marker(&spot).map_err(|e| BuildError::at(field, format!("marker `{name}`: {e}")))
    }

    /// Where a marker was when the run began; what holds on to that place does so over all changes of the mesh.
    pub fn place(&self, marker: &Marker) -> Place<f64> {
        marker.place(&self.nodes, &self.laid, |_| 0.0)
    }

    /// Notes the markers that constraints and forces hold, so that cables put nodes there.
    pub(crate) fn pin(&mut self, markers: &[&MarkerRef]) {
        for m in markers {
            if let MarkerRef::Name(name) = m
                && let Ok((part, spot @ (Spot::Along(_) | Spot::Share(_)))) = split_marker(name)
            {
                self.pins.entry(part.to_string()).or_default().push(spot);
            }
        }
    }

    /// Arc lengths at which a part of this length needs nodes, ascending.
    pub fn pins(&self, part: &str, length: f64) -> Vec<f64> {
        let place = |spot: &Spot| match spot {
            Spot::Along(s) => Some(*s),
            Spot::Share(share) => Some(share * length),
            Spot::Named(_) => None,
        };
        let mut pins: Vec<f64> = self.pins.get(part).into_iter().flatten().filter_map(place).collect();
        pins.sort_by(f64::total_cmp);
        pins.dedup();
        pins
    }

    /// Notes that material flows through an end of a part, by a constraint of this name.
    ///
    /// # Errors
    /// The marker is no end of a part, or something else pays out there.
    pub fn feed(&mut self, name: &str, marker: &MarkerRef, feed: Feed) -> Result<(), BuildError> {
        let (part, end) = end_of(marker)?;
        match self.feeds.entry(part.to_string()).or_default()[end].replace((feed, name.to_string())) {
            None => Ok(()),
            Some((_, other)) => {
                let message =
                    format!("two constraints pay out at {marker}, `{other}` and `{name}`: leave out one");
                Err(BuildError::at("marker", message))
            }
        }
    }

    /// What flows through the start and the end of a part.
    pub fn feeding(&self, part: &str) -> [Option<Feed>; 2] {
        let ends = self.feeds.get(part);
        ends.map_or([None; 2], |ends| ends.each_ref().map(|end| end.as_ref().map(|(feed, _)| *feed)))
    }

    /// The boundary at an end of a part that feeds; `remedy` says what to add where nothing does.
    ///
    /// # Errors
    /// The marker isn't an end of a part that material flows through.
    pub fn boundary(&self, marker: &MarkerRef, remedy: &str) -> Result<MovingBoundary, BuildError> {
        let (name, end) = end_of(marker)?;
        let part = self.end_part(name, end)?;
        part.boundary(end).ok_or_else(|| {
            let message = match part.slender() {
                Some(_) => format!("nothing feeds at {marker}: {remedy}"),
                None => {
                    let kind = part.kind();
                    format!("material can flow through the ends of a cable, but `{name}` is a {kind}")
                }
            };
            BuildError::at("marker", message)
        })
    }

    /// The part at an end of which material flows.
    ///
    /// # Errors
    /// As for [`Builder::boundary`].
    pub fn feeding_part(&self, marker: &MarkerRef) -> Result<Arc<dyn Part>, BuildError> {
        let (name, end) = end_of(marker)?;
        self.end_part(name, end)
    }

    /// The part at an end of a part: of a cable with a route, its first or last span.
    fn end_part(&self, name: &str, end: usize) -> Result<Arc<dyn Part>, BuildError> {
        let (_, part) = self.find(name, "marker")?;
        let span = if end == 0 { part.spans().first() } else { part.spans().last() };
        Ok(span.cloned().unwrap_or(part))
    }

    /// Starts the run with an end of a cable feeding at this rate of its material coordinate [m/s].
    pub fn start_feeding(&mut self, marker: &MarkerRef, rate: f64) -> Result<(), BuildError> {
        let (name, end) = end_of(marker)?;
        let part = self.end_part(name, end)?;
        if let Some(line) = part.line() {
            line.start_feeding(end, rate, &self.start.q, &mut self.start.v);
        }
        Ok(())
    }

    /// Replaces the mesh of a part.
    pub(crate) fn remesh(&mut self, part: &str, mesh: Mesh) {
        self.meshes.insert(part.to_string(), mesh);
    }

    /// The mesh that replaces that of a part's spec, if there is one.
    pub fn mesh(&self, part: &str) -> Option<&Mesh> {
        self.meshes.get(part)
    }

    /// Whether meshes change while the model runs.
    pub(crate) fn changes(&self) -> bool {
        self.feeds.values().flatten().flatten().any(|(feed, _)| feed.element.is_some())
    }

    /// Makes a law act on the stations of parts; all parts that have stations if none is named.
    pub fn load<L: Law + Clone>(&mut self, on: &[String], law: L) -> Result<(), BuildError> {
        self.load_by(on, |_| law.clone())
    }

    /// The same with a law for each part.
    pub fn load_by<L: Law>(
        &mut self,
        on: &[String],
        law_of: impl Fn(&dyn Part) -> L,
    ) -> Result<(), BuildError> {
        let mut any = false;
        for (k, part) in self.parts(on)? {
            if let Some(stations) = part.stations().filter(|s| !s.is_empty()) {
                let law = law_of(part.as_ref());
                if law.gives().couple && !stations.couples() {
                    let message = format!(
                        "{} has a force conjugate to the slope, which `{}` can't carry",
                        law.label(),
                        part.name()
                    );
                    return Err(BuildError::at("on", message));
                }
                if L::NEEDS_DIAMETER && self.least_diameter(stations.as_ref()) == 0.0 {
                    let message = format!(
                        "{} needs a diameter, and `{}` has none: give its section a `diameter`, or name in `on` what \
                         it is to act on",
                        law.label(),
                        part.name()
                    );
                    return Err(BuildError::at("on", message));
                }
                let material = law.follows_material() && (0..2).any(|end| part.boundary(end).is_some());
                self.laws.entry((k, material)).or_default().push(law);
                any = true;
            } else if !on.is_empty() {
                return Err(BuildError::at("on", format!("`{}` carries no distributed load", part.name())));
            }
        }
        if any {
            Ok(())
        } else {
            Err(BuildError::new(
                "cables, chains and hulls carry this load, and the scene has none of them. Leave it out; a point mass has \
                 `drag_area`, `added_mass` and `volume` of its own",
            ))
        }
    }

    fn least_diameter(&self, stations: &dyn Stations) -> f64 {
        let (q, v) = (&self.start.q, &self.start.v);
        let at = At { t: 0.0, q, v, a: v, internal: &[], relaxed: None };
        let mut least = f64::INFINITY;
        stations.each(&at, &mut |s| least = least.min(s.diameter));
        least
    }

    /// Notes what cables can run over.
    ///
    /// # Errors
    /// Two of one name.
    pub(crate) fn guides(&mut self, guides: Vec<Guide>) -> Result<(), BuildError> {
        for guide in guides {
            let name = guide.name.clone();
            if self.guides.insert(name.clone(), guide).is_some() {
                return Err(BuildError::at("name", format!("two guides of cables are named `{name}`")));
            }
        }
        Ok(())
    }

    /// What a route runs over or through.
    ///
    /// # Errors
    /// There is nothing of this name.
    pub fn guide(&self, name: &str) -> Result<Guide, BuildError> {
        self.guides.get(name).cloned().ok_or_else(|| {
            let names: Vec<String> = self.guides.keys().map(|n| format!("`{n}`")).collect();
            let names = if names.is_empty() { "none".into() } else { names.join(", ") };
            let message =
                format!("there is no sheave, ring or drum `{name}`; those of the scene are {names}");
            BuildError::at("route", message)
        })
    }

    /// Notes that a cable has a route, so that its spans can be named after it; material flows through all of their inner
    /// ends, which all are those of one that is `closed`.
    ///
    /// # Errors
    /// Something else feeds at an end of a span.
    pub fn route(&mut self, name: &str, spans: &[String], closed: bool) -> Result<(), BuildError> {
        if let Some(span) = spans.iter().find(|span| self.feeds.contains_key(*span)) {
            let message = format!(
                "`{span}` feeds at wheels and rings by itself: put a winch at `{name}.start` or `{name}.end`"
            );
            return Err(BuildError::at("route", message));
        }
        self.routes.insert(name.to_string());
        let outer = self.feeds.get(name).cloned().unwrap_or_default();
        let passing = Some((Feed { unstrained: true, passes: true, ..Feed::default() }, name.to_string()));
        for (k, span) in spans.iter().enumerate() {
            let first = if k == 0 && !closed { outer[0].clone() } else { passing.clone() };
            let last = if k + 1 == spans.len() && !closed { outer[1].clone() } else { passing.clone() };
            self.feeds.insert(span.clone(), [first, last]);
        }
        Ok(())
    }

    /// Notes that a cable passes a guide.
    pub fn passage(&mut self, passage: Passage) {
        self.passages.push(passage);
    }

    /// Where cables pass a guide.
    pub fn passages(&self, guide: &str) -> Vec<Passage> {
        self.passages.iter().filter(|p| p.guide == guide).cloned().collect()
    }

    /// Notes that an end of a cable is wound on a drum.
    pub fn winding(&mut self, winding: Winding) {
        self.windings.push(winding);
    }

    /// The ends of cables that are wound on a drum.
    pub fn windings(&self, guide: &str) -> Vec<Winding> {
        self.windings.iter().filter(|w| w.guide == guide).cloned().collect()
    }

    pub(crate) fn weigh(&mut self, on: &[String]) {
        self.weighs.push(on.to_vec());
    }

    /// Whether a force gives a part its weight.
    pub fn weighs(&self, part: &str) -> bool {
        self.weighs.iter().any(|on| on.is_empty() || on.iter().any(|name| name == part))
    }

    /// Notes that a force of this type acts on a part.
    ///
    /// # Errors
    /// Another one does already: their effects would add up.
    pub fn acts_once(&mut self, kind: &'static str, part: &Numbered) -> Result<(), BuildError> {
        if self.acting.insert((kind, part.0)) {
            return Ok(());
        }
        let message = format!(
            "`{kind}` acts on `{}` twice, and would count twice: name in `on` what each of them is for",
            part.1.name()
        );
        Err(BuildError::at("on", message))
    }

    /// The acceleration of gravity [m/s²].
    pub fn gravity(&self) -> V3<f64> {
        self.gravity.unwrap_or(GRAVITY)
    }

    /// Notes that the scene is a sequence of equilibria.
    pub(crate) fn set_statics(&mut self, statics: bool) {
        self.statics = statics;
    }

    /// Whether the scene is a sequence of equilibria, where time is a load factor: what changes with it changes slowly.
    pub fn is_statics(&self) -> bool {
        self.statics
    }

    /// Whether a constraint holds a marker; those of the scene are there before its forces.
    pub fn is_held(&self, marker: &Marker) -> bool {
        self.constraints.iter().flat_map(|c| c.markers()).any(|m| match (m, marker) {
            (Marker::Node { node, point, .. }, Marker::Node { node: other, point: there, .. }) => {
                *node == *other && *point == *there
            }
            _ => false,
        })
    }

    /// The water, which the scene must have for what acts in it.
    pub fn water(&self) -> Result<&Water, BuildError> {
        self.water.as_ref().ok_or_else(|| {
            BuildError::new("this needs water: add a [water] section, such as `density = \"1025 kg/m^3\"`")
        })
    }

    /// The air, if the scene has some.
    pub fn air(&self) -> Option<&Air> {
        self.air.as_ref()
    }

    pub(crate) fn set_world(&mut self, gravity: V3<f64>, water: Option<Water>, air: Option<Air>) {
        (self.gravity, self.water, self.air) = (Some(gravity), water, air);
    }

    pub(crate) fn set_motions(&mut self, motions: Motions) {
        self.motions = motions;
    }

    pub(crate) fn set_inputs(&mut self, inputs: Inputs) {
        self.inputs = inputs;
    }

    /// The inputs of the scene.
    pub fn inputs(&self) -> &Inputs {
        &self.inputs
    }

    /// What a `field` of a spec reads, a number or an input of this kind.
    ///
    /// # Errors
    /// There is no such input, or it has another unit.
    pub fn signal(&self, field: &str, setting: &Setting, kind: &Kind) -> Result<Signal, BuildError> {
        self.inputs.signal(field, setting, kind)
    }

    /// The motion of this name.
    pub fn motion(&self, name: &str) -> Result<Arc<dyn Motion>, BuildError> {
        let there = self.motions.keys().map(String::as_str);
        let missing = || BuildError::at("motion", no_motion(name, there));
        self.motions.get(name).cloned().ok_or_else(missing)
    }

    /// The longest part so far, or the size of the mechanism that rigid bodies make [m].
    pub fn size(&self) -> f64 {
        let mut length = self.length;
        if self.nodes.iter().any(|n| n.kind == NodeKind::Frame) {
            let place = |n: &Node, i: usize| self.start.q[n.q + i];
            let points = || self.nodes.iter().filter(|n| n.kind.has_position());
            let square: f64 = (0..3)
                .map(|i| {
                    let most = points().map(|n| place(n, i)).fold(f64::NEG_INFINITY, f64::max);
                    let least = points().map(|n| place(n, i)).fold(f64::INFINITY, f64::min);
                    (most - least).powi(2)
                })
                .sum();
            length = length.max(square.sqrt());
        }
        if length > 0.0 { length } else { 1.0 }
    }

    /// Makes the model.
    pub fn finish(mut self) -> Result<Model, BuildError> {
        if self.nodes.is_empty() {
            return Err(BuildError::new("the scene is empty: add at least one element"));
        }
        let length = self.size();
        let mut terms: Vec<Box<dyn Term>> = self.pools.into_iter().map(|(.., p)| p.into_term()).collect();
        terms.append(&mut self.terms);
        for ((k, material), laws) in self.laws {
            let part = &self.parts[k];
            if let Some(stations) = if material { part.material_stations() } else { part.stations() } {
                terms.push(Box::new(FieldTerm { part: part.name().to_string(), stations, laws }));
            }
        }
        let model = Model::new(self.nodes, terms, self.constraints, self.parts, self.start, length)
            .with_switches(self.switches)
            .with_inputs(self.inputs.all().to_vec());
        let redundancy = find_redundancy(&model)?;
        Ok(model.with_redundancy(redundancy))
    }
}
