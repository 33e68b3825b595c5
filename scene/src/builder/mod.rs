//! The builder: turns specs into a model and owns the names.

mod feeding;
mod loads;
mod parts;
mod routes;
mod world;

use crate::inputs::Inputs;
use crate::motions::Motions;
use crate::reeving::{Guide, Passage, Winding};
use crate::water::{Air, Water};
use ropewalk_core::{
    BuildError, Constraint, Element, Event, Feed, FieldTerm, Laws, Marker, Mesh, Model, Node, NodeId,
    NodeKind, Part, Pool, Spot, Start, Switches, Term, V3, find_redundancy,
};
use std::any::{Any, TypeId};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Arc;

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
    reach: f64,
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

    /// Whether a constraint holds a marker; those of the scene are there before its forces.
    pub fn is_held(&self, marker: &Marker) -> bool {
        self.constraints.iter().flat_map(|c| c.markers()).any(|m| match (m, marker) {
            (Marker::Node { node, point, .. }, Marker::Node { node: other, point: there, .. }) => {
                *node == *other && *point == *there
            }
            _ => false,
        })
    }

    /// Says that what is joined to nodes reaches so far [m]: of point masses nothing else has a length.
    pub fn reaches(&mut self, length: f64) {
        self.reach = self.reach.max(length);
    }

    /// The longest part so far, or the size of the mechanism that rigid bodies make; of point masses alone how far apart they are, and
    /// what reaches from them elsewhere [m].
    pub fn size(&self) -> f64 {
        let bodies = self.nodes.iter().any(|n| n.kind == NodeKind::Frame);
        let lone = !(bodies || self.length > 0.0);
        let mut length = if lone { self.reach } else { self.length };
        if lone || bodies {
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
