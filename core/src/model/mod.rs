//! The model: nodes, terms, constraints and the structure of their equations. Immutable between events.

pub mod assembly;
mod balance;
pub mod broken;
pub mod capability;
mod carry;
pub mod column;
pub mod constraint;
pub mod controller;
pub mod dead;
pub mod event;
pub mod feed;
pub mod held;
pub mod input;
pub mod joint;
mod lever;
pub mod limit;
pub mod line;
pub mod marker;
pub mod motion;
pub mod node;
pub(crate) mod order;
pub mod part;
pub mod pattern;
pub mod pool;
pub(crate) mod rates;
pub mod reach;
pub mod redundancy;
pub mod relation;
pub mod remesh;
mod renewal;
mod room;
pub mod solid;
pub mod span;
pub mod state;
pub mod station;
pub mod structure;
pub mod term;
pub mod twist;

use crate::algebra::lane::Width;
use crate::error::BuildError;
use crate::model::capability::{Foresees, Remembers, Timed};
use crate::model::constraint::{Constraint, RowKind};
use crate::model::controller::Controller;
use crate::model::event::Event;
use crate::model::input::Input;
use crate::model::node::{Node, NodeId, NodeKind};
use crate::model::order::Rows;
use crate::model::part::Part;
use crate::model::pattern::Pattern;
use crate::model::redundancy::Redundancy;
use crate::model::remesh::Plan;
use crate::model::state::{At, Control, State};
use crate::model::structure::Structure;
use crate::model::term::{Power, Term};
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// Nodes, terms and constraints, shared by reference. Remeshing makes a new one.
pub struct Model {
    pub(crate) nodes: Vec<Node>,
    pub(crate) terms: Vec<Arc<dyn Term>>,
    pub(crate) constraints: Vec<Arc<dyn Constraint>>,
    pub(crate) parts: Vec<Arc<dyn Part>>,
    pub(crate) start: Start,
    /// What can happen during a run, and which constraints end by it.
    pub(crate) switches: Switches,
    /// What is set from outside.
    inputs: Vec<Arc<Input>>,
    /// What sets inputs by what it sees.
    controls: Vec<Arc<dyn Controller>>,
    /// Constraints that say what others have said.
    pub(crate) redundancy: Option<Redundancy>,
    /// How it is built, if its mesh changes while it runs.
    recipe: Option<Arc<Recipe>>,
    /// The meshes that it was built on instead of those of the scene.
    pub(crate) plan: Plan,
    structure: Structure,
    pattern: Pattern,
    touched: Vec<Rows>,
    velocities: usize,
    /// First multiplier of each constraint, and one past the last.
    rows: Vec<usize>,
    /// Cliques of each term, then of each constraint.
    cliques: Vec<Range<usize>>,
    length: f64,
    rounding: f64,
    /// Whether some constraints are not linear.
    mechanism: bool,
    /// Whether that is so of constraints that always hold, of parts that no material enters or leaves.
    linkage: bool,
    width: Width,
    /// Whether no node has an orientation, so that `q ⊕ d` is `q + d`.
    flat: bool,
    /// First coordinate and first velocity of each node of each line that can be twisted, in their order along it.
    twisted: Vec<(Vec<usize>, Vec<usize>)>,
    /// Most elements along one part.
    finest: usize,
    /// The terms that see something ahead.
    watchful: Vec<usize>,
    /// The terms that depend on time otherwise than through the state.
    timed: Vec<usize>,
    /// The constraints that change with time.
    moving: Vec<usize>,
    /// Whether some of them lead more than a coordinate that they prescribe.
    led: bool,
    /// The constraints that prescribe a coordinate, and its places.
    driven: Vec<(usize, usize, usize)>,
    /// Whether a term has a kink in velocities.
    kinked: bool,
    /// Terms that remember something.
    remembering: Vec<usize>,
    /// Terms that couple what comes near, and what the model became in a search for equilibria by that.
    coupling: Vec<usize>,
    next: OnceLock<Box<Model>>,
}

/// Builds a model of the same scene on other meshes.
pub type Recipe = dyn Fn(&Plan) -> Result<Model, BuildError> + Send + Sync;

/// Where a run starts: configuration and velocities as the scene gives them.
#[derive(Clone, Debug, Default)]
pub struct Start {
    /// Configuration.
    pub q: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// Internal variables.
    pub internal: Vec<f64>,
}

/// What changes by events: things that happen, and constraints that let go.
#[derive(Clone, Default)]
pub struct Switches {
    /// The events that the scene brings along.
    pub events: Vec<Arc<dyn Event>>,
    /// Names of the internal variables, in the order of [`State::internal`].
    pub internal: Vec<String>,
    /// For some constraints, by number: the internal variable that isn't zero once the constraint has let go.
    pub released: BTreeMap<usize, usize>,
}

impl Model {
    /// Puts a model together. `length` is the reference length of tolerances: that of the longest cable, or the size of a
    /// mechanism.
    pub fn new(
        nodes: Vec<Node>,
        terms: Vec<Box<dyn Term>>,
        constraints: Vec<Box<dyn Constraint>>,
        parts: Vec<Arc<dyn Part>>,
        start: Start,
        length: f64,
    ) -> Self {
        let velocities = nodes.iter().map(|n| n.kind.velocities()).sum();
        let mut pattern = Pattern::default();
        let mut cliques = Vec::new();
        for term in &terms {
            let first = pattern.len();
            term.pattern(&mut pattern);
            cliques.push(first..pattern.len());
        }
        let mut rows = vec![0];
        let mut touched = Vec::new();
        let zero = vec![0.0; velocities];
        let begin = At { t: 0.0, q: &start.q, v: &zero, a: &zero, internal: &start.internal, relaxed: None };
        for c in &constraints {
            let (first, count) = (rows[rows.len() - 1], c.rows().len());
            let dofs = c.nodes().iter().flat_map(|k| nodes[k.0 as usize].dofs());
            let mut jacobian = vec![0.0; count * dofs.clone().count()];
            c.jacobian(&nodes, &begin, &mut vec![0.0; count], &mut jacobian);
            let at = pattern.len();
            pattern.clique(dofs.chain((first..first + count).map(|r| velocities + r)));
            cliques.push(at..at + 1);
            rows.push(first + count);
            let behind = c.behind().to_vec();
            touched.push(Rows { count, nodes: c.nodes().to_vec(), jacobian, behind });
        }
        // the forces of a constraint on a body turn it, and rotations one after the other don't commute
        let turns = |c: &dyn Constraint| {
            !c.linear() && c.nodes().iter().any(|k| nodes[k.0 as usize].kind == NodeKind::Frame)
        };
        let symmetric = terms.iter().all(|t| t.symmetric()) && !constraints.iter().any(|c| turns(c.as_ref()));
        let flat = nodes.iter().all(|n| !n.kind.turns());
        let pieces = parts.iter().filter_map(|p| p.line()).flat_map(|line| line.twisted());
        let twisted = pieces.map(|piece| piece.into_iter().unzip()).collect();
        let positions = nodes.iter().filter(|n| n.kind.has_position()).flat_map(|n| &start.q[n.q..n.q + 3]);
        let farthest = positions.fold(length, |m, x| m.max(x.abs()));
        let finest = parts.iter().map(|p| p.mesh().len().saturating_sub(1)).max().unwrap_or(0);
        let watchful = (0..terms.len()).filter(|&k| terms[k].foresees().is_some()).collect();
        let timed = (0..terms.len()).filter(|&k| terms[k].timed().is_some()).collect();
        let moving = (0..constraints.len()).filter(|&c| constraints[c].moves()).collect();
        let remembering = (0..terms.len()).filter(|&k| terms[k].remembers().is_some()).collect();
        let coupling = (0..terms.len()).filter(|&k| terms[k].couples().is_some()).collect();
        let kinked = terms.iter().any(|t| t.kinked());
        let structure = Structure::new(&nodes, &touched, &pattern, symmetric);
        let led = constraints.iter().any(|c| c.moves() && c.prescribes().is_none());
        let driven = constraints.iter().enumerate();
        let driven = driven.filter_map(|(c, own)| own.prescribes().map(|(q, v)| (c, q, v))).collect();
        let mechanism = constraints.iter().any(|c| !c.linear());
        let feeds = parts.iter().any(|part| part.boundary(0).is_some() || part.boundary(1).is_some());
        let linkage = mechanism && !feeds && start.internal.is_empty();
        Model {
            nodes,
            terms: terms.into_iter().map(Arc::from).collect(),
            constraints: constraints.into_iter().map(Arc::from).collect(),
            parts,
            start,
            switches: Switches::default(),
            inputs: Vec::new(),
            controls: Vec::new(),
            redundancy: None,
            recipe: None,
            plan: Plan::new(),
            structure,
            pattern,
            touched,
            velocities,
            rows,
            cliques,
            length,
            mechanism,
            linkage,
            rounding: 0.5 * f64::EPSILON * farthest,
            width: Width::best(),
            flat,
            twisted,
            finest,
            watchful,
            timed,
            moving,
            led,
            driven,
            kinked,
            remembering,
            coupling,
            next: OnceLock::new(),
        }
    }

    /// Computes over another number of lanes; results differ by rounding only.
    #[must_use]
    pub fn with_width(mut self, width: Width) -> Self {
        self.width = width;
        self
    }

    /// Adds what changes by events.
    #[must_use]
    pub fn with_switches(mut self, switches: Switches) -> Self {
        self.switches = switches;
        self
    }

    /// Adds what is set from outside.
    #[must_use]
    pub fn with_inputs(mut self, inputs: Vec<Arc<Input>>) -> Self {
        self.inputs = inputs;
        self
    }

    /// Adds what sets inputs by what it sees.
    #[must_use]
    pub fn with_controls(mut self, controls: Vec<Arc<dyn Controller>>) -> Self {
        self.controls = controls;
        self
    }

    /// Adds what is known of constraints that say what others have said.
    #[must_use]
    pub fn with_redundancy(mut self, redundancy: Option<Redundancy>) -> Self {
        self.redundancy = redundancy;
        self
    }

    /// Notes the meshes that it was built on, and how it is built on others if its mesh changes while it runs.
    #[must_use]
    pub fn with_plan(mut self, plan: Plan, recipe: Option<Arc<Recipe>>) -> Self {
        (self.plan, self.recipe) = (plan, recipe);
        self
    }

    /// The inputs, in the order of the scene.
    pub fn inputs(&self) -> &[Arc<Input>] {
        &self.inputs
    }
    /// The input of this name.
    pub fn input(&self, name: &str) -> Option<&Arc<Input>> {
        self.inputs.iter().find(|i| i.name() == name)
    }
    /// What sets inputs by what it sees.
    pub fn controls(&self) -> &[Arc<dyn Controller>] {
        &self.controls
    }
    /// The events that the scene brings along.
    pub fn events(&self) -> &[Arc<dyn Event>] {
        &self.switches.events
    }
    /// Constraints that say what others have said where the model starts, if there are any.
    pub fn redundancy(&self) -> Option<&Redundancy> {
        self.redundancy.as_ref()
    }
    /// Names of the internal variables, in the order of [`State::internal`].
    pub fn internal_variables(&self) -> &[String] {
        &self.switches.internal
    }
    /// The number of an internal variable in [`State::internal`].
    pub fn internal_variable(&self, name: &str) -> Option<usize> {
        self.switches.internal.iter().position(|m| m == name)
    }
    /// Whether a constraint still holds: it hasn't broken.
    pub fn holds(&self, constraint: usize, internal: &[f64]) -> bool {
        self.switches.released.is_empty()
            || self.switches.released.get(&constraint).is_none_or(|&m| internal[m] == 0.0)
    }

    /// Whether the Jacobian of the constraints is the same at all times: all are linear, and none can break.
    pub(crate) fn keeps_constraints(&self) -> bool {
        !self.mechanism && self.switches.released.is_empty()
    }

    /// The state in which the scene starts: as given, not yet consistent.
    pub fn state(&self) -> State {
        State {
            t: 0.0,
            q: self.start.q.clone(),
            v: self.start.v.clone(),
            a: vec![0.0; self.velocities],
            aux: vec![0.0; self.velocities],
            lambda: vec![0.0; self.multipliers()],
            internal: self.start.internal.clone(),
            control: Control::default(),
        }
    }

    /// Whether a state can be one of this model.
    ///
    /// # Errors
    /// What of it is of another size, in a few words.
    pub fn check(&self, state: &State) -> Result<(), String> {
        let own = [
            ("coordinates", state.q.len(), self.start.q.len()),
            ("velocities", state.v.len(), self.velocities),
            ("accelerations", state.a.len(), self.velocities),
            ("auxiliary accelerations", state.aux.len(), self.velocities),
            ("multipliers", state.lambda.len(), self.multipliers()),
            ("internal variables", state.internal.len(), self.start.internal.len()),
        ];
        match own.into_iter().find(|(_, has, wants)| has != wants) {
            Some((what, has, wants)) => Err(format!("it has {has} {what}, the model {wants}")),
            None => Ok(()),
        }
    }

    /// Its nodes.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }
    /// One node.
    pub fn node(&self, id: NodeId) -> &Node {
        &self.nodes[id.0 as usize]
    }
    /// Its terms.
    pub fn terms(&self) -> &[Arc<dyn Term>] {
        &self.terms
    }
    /// Its constraints.
    pub fn constraints(&self) -> &[Arc<dyn Constraint>] {
        &self.constraints
    }
    /// Its named parts.
    pub fn parts(&self) -> &[Arc<dyn Part>] {
        &self.parts
    }
    /// The part of this name.
    pub fn part(&self, name: &str) -> Option<&Arc<dyn Part>> {
        self.parts.iter().find(|p| p.name() == name)
    }
    /// Number of velocities.
    pub fn velocities(&self) -> usize {
        self.velocities
    }
    /// Number of multipliers.
    pub fn multipliers(&self) -> usize {
        self.rows[self.rows.len() - 1]
    }
    /// The multipliers of one constraint.
    pub fn rows_of(&self, constraint: usize) -> Range<usize> {
        self.rows[constraint]..self.rows[constraint + 1]
    }
    /// Structure of the iteration matrix.
    pub fn structure(&self) -> &Structure {
        &self.structure
    }
    /// The reference length of tolerances [m].
    pub fn length(&self) -> f64 {
        self.length
    }

    /// What rounding makes of positions [m]: their unit in the last place, where the model starts.
    pub fn rounding(&self) -> f64 {
        self.rounding
    }

    /// Whether some constraints are not linear: then one iteration doesn't meet them.
    pub fn is_mechanism(&self) -> bool {
        self.mechanism
    }

    /// Whether that is so of constraints that always hold, of parts that no material enters or leaves: then what happens is
    /// smooth, but for forces.
    pub(crate) fn is_linkage(&self) -> bool {
        self.linkage
    }

    /// Whether that goes on without kinks: then what iterations leave has always the same sign.
    pub(crate) fn turns_smoothly(&self) -> bool {
        self.linkage && !self.kinked
    }

    /// Number of elements of the part that is divided most finely.
    pub fn finest(&self) -> usize {
        self.finest
    }

    /// Whether a term has a kink in velocities.
    pub(crate) fn kinked(&self) -> bool {
        self.kinked
    }

    /// Tolerance of each constraint row relative to that of lengths: positions in metres, directions as they are.
    pub fn row_scale(&self) -> impl Iterator<Item = f64> + '_ {
        self.lengthlike().map(|length| if length { 1.0 } else { 1.0 / self.length })
    }

    /// Whether each constraint row is a length, rather than a number without dimension.
    pub(crate) fn lengthlike(&self) -> impl Iterator<Item = bool> + '_ {
        self.constraints.iter().flat_map(|c| c.rows().iter()).map(|k| *k == RowKind::Position)
    }

    /// What an unknown is called in messages: its part or node, or the constraint's row.
    pub fn unknown_name(&self, index: usize) -> String {
        if index >= self.velocities {
            let row = index - self.velocities;
            let c = self.rows.partition_point(|&r| r <= row).saturating_sub(1);
            return match self.constraints.get(c) {
                Some(c_) => format!("constraint `{}`, equation {}", c_.name(), row - self.rows[c] + 1),
                None => format!("multiplier {row}"),
            };
        }
        let k = self.nodes.partition_point(|n| n.v <= index).saturating_sub(1);
        let component = index - self.nodes[k].v;
        let what = match component {
            0..=2 => format!("position {}", ["x", "y", "z"][component]),
            3..=5 => format!("slope or rotation {}", ["x", "y", "z"][component - 3]),
            6 if self.nodes[k].kind == NodeKind::Twist => "twist".to_string(),
            n => format!("coordinate {n}"),
        };
        format!("{}, {what}", self.place_name(NodeId(k as u32)))
    }

    /// Where a node is, in words.
    pub(crate) fn place_name(&self, node: NodeId) -> String {
        let name = |p: &Arc<dyn Part>| {
            p.place_of(node).map(|place| format!("`{}` {place}", p.name()).trim_end().to_string())
        };
        self.parts.iter().find_map(name).unwrap_or_else(|| format!("node {}", node.0))
    }

    /// Lets terms remember what a state that was accepted has changed.
    pub(crate) fn remember(&self, state: &mut State) {
        self.let_remember(state, |term, at, memory| {
            term.remember(at, memory);
            false
        });
    }

    /// The same of an equilibrium; whether it is another one now.
    pub(crate) fn settle(&self, state: &mut State) -> bool {
        self.let_remember(state, |term, at, memory| term.settle(at, memory))
    }

    /// Lets terms forget what held, before an equilibrium is looked for from a guess.
    pub(crate) fn let_go(&self, state: &mut State) {
        self.remembering().for_each(|term| term.let_go(&mut state.internal));
    }

    /// Why a term can't tell what has become of what it remembers, if one can't.
    pub(crate) fn lost(&self, at: &At<'_>) -> Option<String> {
        self.remembering().find_map(|term| term.lost(at))
    }

    /// What went to and fro within a step, so that a term can't tell what has become of what it remembers.
    pub(crate) fn overran(
        &self,
        before: &At<'_>,
        after: &At<'_>,
        far: &dyn Fn(usize, f64) -> bool,
    ) -> Option<String> {
        self.remembering().find_map(|term| term.overran(before, after, far))
    }

    /// What terms remember that counts on with labels of sections, and the angle of those.
    pub(crate) fn labels(&self, q: &[f64]) -> Vec<(usize, f64)> {
        self.remembering().filter_map(|term| term.labels(q)).collect()
    }

    fn remembering(&self) -> impl Iterator<Item = &dyn Remembers> {
        self.remembering.iter().filter_map(|&k| self.terms[k].remembers())
    }

    fn let_remember(
        &self,
        state: &mut State,
        mut how: impl FnMut(&dyn Remembers, &At<'_>, &mut [f64]) -> bool,
    ) -> bool {
        if self.remembering.is_empty() {
            return false;
        }
        let mut memory = std::mem::take(&mut state.internal);
        let mut any = false;
        for term in self.remembering() {
            any |= how(term, &state.at(), &mut memory);
        }
        state.internal = memory;
        any
    }

    /// What has gone where it can't have gone in a step.
    pub(crate) fn passes(&self, before: &At<'_>, after: &At<'_>) -> Option<String> {
        self.watchful().find_map(|term| term.passes(before, after))
    }

    /// What one should know of its terms at the end of a run.
    pub fn remarks(&self, at: &At<'_>) -> Vec<String> {
        self.terms.iter().filter_map(|t| t.shows()?.remark(at)).collect()
    }

    /// What one should know of its lines at an equilibrium.
    pub fn remarks_at_rest(&self, at: &At<'_>) -> Vec<String> {
        self.parts.iter().filter_map(|part| part.line()?.remark(at)).collect()
    }

    /// The longest step from here that leaps over nothing that a term has ahead [s].
    pub fn step_limit(&self, at: &At<'_>) -> f64 {
        self.watchful().map(|term| term.step_limit(at)).fold(f64::INFINITY, f64::min)
    }

    /// What the trapezoidal rule misses of the power of what fades or sets in between two states [J].
    pub(crate) fn missed(&self, before: &At<'_>, after: &At<'_>) -> Power {
        self.watchful().fold(Power::zero(), |mut sum, term| {
            sum += term.missed(before, after);
            sum
        })
    }

    /// Whether something changes with time of its own accord.
    pub(crate) fn is_timed(&self) -> bool {
        !(self.timed.is_empty() && self.moving.is_empty())
    }

    /// Whether motions lead something without prescribing its coordinates.
    pub(crate) fn is_led(&self) -> bool {
        self.led
    }

    fn watchful(&self) -> impl Iterator<Item = &dyn Foresees> {
        self.watchful.iter().filter_map(|&k| self.terms[k].foresees())
    }

    /// The terms that depend on time otherwise than through the state, with what time does to them.
    pub(crate) fn timed_terms(&self) -> impl Iterator<Item = (&dyn Term, &dyn Timed)> {
        let terms = self.timed.iter().map(|&k| self.terms[k].as_ref());
        terms.filter_map(|term| term.timed().map(|timed| (term, timed)))
    }

    /// The constraints that change with time, with their numbers.
    pub(crate) fn moving_constraints(&self) -> impl Iterator<Item = (usize, &dyn Constraint)> {
        self.moving.iter().map(|&c| (c, self.constraints[c].as_ref()))
    }

    /// Whether a row of the constraints is linear in the increments of its nodes.
    pub(crate) fn linear_row(&self, row: usize) -> bool {
        let c = self.rows.partition_point(|&r| r <= row) - 1;
        self.constraints[c].linear_row(row - self.rows[c])
    }

    /// Names of the constraints some of whose rows are so.
    pub(crate) fn constraints_where(&self, row: impl Fn(usize) -> bool) -> Vec<&str> {
        let all = self.constraints.iter().enumerate();
        all.filter(|(c, _)| self.rows_of(*c).any(&row)).map(|(_, c)| c.name()).collect()
    }

    /// First and last time for which every motion is defined.
    pub fn range(&self) -> (f64, f64, String) {
        let mut all = (f64::NEG_INFINITY, f64::INFINITY, String::new());
        for c in &self.constraints {
            let (a, b) = c.range();
            if b < all.1 {
                all.2 = c.name().to_string();
            }
            all = (a.max(all.0), b.min(all.1), all.2);
        }
        all
    }
}
