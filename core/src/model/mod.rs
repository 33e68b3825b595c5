//! The model: nodes, terms, constraints and the structure of their equations. Immutable between events.

pub mod column;
pub mod constraint;
pub mod dead;
pub mod event;
pub mod feed;
pub mod held;
pub mod marker;
pub mod motion;
pub mod node;
pub(crate) mod order;
pub mod part;
pub mod pattern;
pub mod pool;
pub mod reach;
pub mod redundancy;
pub mod remesh;
pub mod span;
pub mod state;
pub mod station;
pub mod structure;
pub mod term;

use crate::algebra::lane::Width;
use crate::error::BuildError;
use crate::model::constraint::{Constraint, MOST_ROWS, RowKind};
use crate::model::event::Event;
use crate::model::node::{Node, NodeId, NodeKind, retract};
use crate::model::order::Rows;
use crate::model::part::Part;
use crate::model::pattern::Pattern;
use crate::model::redundancy::Redundancy;
use crate::model::remesh::Plan;
use crate::model::state::{At, Control, State};
use crate::model::structure::Structure;
use crate::model::term::{Assembly, Energy, Leap, Power, Term, Weights};
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Nodes, terms and constraints, shared by reference. Remeshing makes a new one.
pub struct Model {
    pub(crate) nodes: Vec<Node>,
    pub(crate) terms: Vec<Box<dyn Term>>,
    pub(crate) constraints: Vec<Box<dyn Constraint>>,
    pub(crate) parts: Vec<Arc<dyn Part>>,
    pub(crate) start: Start,
    /// What can happen during a run, and which constraints end by it.
    pub(crate) switches: Switches,
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
    width: Width,
    /// Whether no node has an orientation, so that `q ⊕ d` is `q + d`.
    flat: bool,
    /// Most elements along one part.
    finest: usize,
    /// The terms that see something ahead.
    watchful: Vec<usize>,
    /// The terms that depend on time otherwise than through the state.
    timed: Vec<usize>,
    /// The constraints that change with time.
    moving: Vec<usize>,
    /// The constraints that prescribe a coordinate, and its places.
    driven: Vec<(usize, usize, usize)>,
    /// Whether a term has a kink in velocities.
    kinked: bool,
    /// Terms that remember something.
    remembering: Vec<usize>,
}

/// Calls and the time that they took.
pub type Spent = (u64, Duration);

/// Builds a model of the same scene on other meshes.
pub type Recipe = dyn Fn(&Plan) -> Result<Model, BuildError> + Send + Sync;

/// Where a run starts: configuration and velocities as the scene gives them.
#[derive(Clone, Debug, Default)]
pub struct Start {
    /// Configuration.
    pub q: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// Modes.
    pub modes: Vec<f64>,
}

/// What changes by events: things that happen, and constraints that let go.
#[derive(Clone, Default)]
pub struct Switches {
    /// The events that the scene brings along.
    pub events: Vec<Arc<dyn Event>>,
    /// Names of the modes, in the order of [`State::modes`].
    pub modes: Vec<String>,
    /// For some constraints, by number: the mode that isn't zero once the constraint has let go.
    pub released: BTreeMap<usize, usize>,
}

/// Residual and iteration matrix of a model, with the scratch to assemble them.
#[derive(Debug, Default)]
pub struct System {
    /// Residual: the equations of motion, then those of the constraints.
    pub residual: Vec<f64>,
    /// Values of the matrix, where [`Structure::rows`] says.
    pub values: Vec<f64>,
    jacobian: Vec<f64>,
    hessian: Vec<f64>,
    /// For what elements scatter.
    scratch: Vec<f64>,
    /// Whether a term was only approximated.
    pub(crate) approximate: bool,
    /// Calls and time of each term, then of the constraints; only filled where profiling was asked for.
    pub profile: Option<Vec<Spent>>,
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
        let begin = At { t: 0.0, q: &start.q, v: &zero, a: &zero, modes: &start.modes, relaxed: None };
        for c in &constraints {
            let (first, count) = (rows[rows.len() - 1], c.rows().len());
            let dofs = c.nodes().iter().flat_map(|k| nodes[k.0 as usize].dofs());
            let mut jacobian = vec![0.0; count * dofs.clone().count()];
            c.jacobian(&nodes, &begin, &mut vec![0.0; count], &mut jacobian);
            let at = pattern.len();
            pattern.clique(dofs.chain((first..first + count).map(|r| velocities + r)));
            cliques.push(at..at + 1);
            rows.push(first + count);
            touched.push(Rows { count, nodes: c.nodes().to_vec(), jacobian });
        }
        // the forces of a constraint on a body turn it, and rotations one after the other don't commute
        let turns = |c: &dyn Constraint| {
            !c.linear() && c.nodes().iter().any(|k| nodes[k.0 as usize].kind == NodeKind::Frame)
        };
        let symmetric = terms.iter().all(|t| t.symmetric()) && !constraints.iter().any(|c| turns(c.as_ref()));
        let flat = nodes.iter().all(|n| n.kind != NodeKind::Frame);
        let positions = nodes.iter().filter(|n| n.kind.has_position()).flat_map(|n| &start.q[n.q..n.q + 3]);
        let farthest = positions.fold(length, |m, x| m.max(x.abs()));
        let finest = parts.iter().map(|p| p.mesh().len().saturating_sub(1)).max().unwrap_or(0);
        let watchful = (0..terms.len()).filter(|&k| terms[k].foresees()).collect();
        let timed = (0..terms.len()).filter(|&k| terms[k].timed()).collect();
        let moving = (0..constraints.len()).filter(|&c| constraints[c].moves()).collect();
        let remembering = (0..terms.len()).filter(|&k| terms[k].remembers()).collect();
        let kinked = terms.iter().any(|t| t.kinked());
        let structure = Structure::new(&nodes, &touched, &pattern, symmetric);
        let driven = constraints.iter().enumerate();
        let driven = driven.filter_map(|(c, own)| own.prescribes().map(|(q, v)| (c, q, v))).collect();
        let mechanism = constraints.iter().any(|c| !c.linear());
        Model {
            nodes,
            terms,
            constraints,
            parts,
            start,
            switches: Switches::default(),
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
            rounding: 0.5 * f64::EPSILON * farthest,
            width: Width::best(),
            flat,
            finest,
            watchful,
            timed,
            moving,
            driven,
            kinked,
            remembering,
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

    /// The events that the scene brings along.
    pub fn events(&self) -> &[Arc<dyn Event>] {
        &self.switches.events
    }
    /// Constraints that say what others have said where the model starts, if there are any.
    pub fn redundancy(&self) -> Option<&Redundancy> {
        self.redundancy.as_ref()
    }
    /// Names of the modes, in the order of [`State::modes`].
    pub fn modes(&self) -> &[String] {
        &self.switches.modes
    }
    /// The number of a mode in [`State::modes`].
    pub fn mode(&self, name: &str) -> Option<usize> {
        self.switches.modes.iter().position(|m| m == name)
    }
    /// Whether a constraint still holds: it hasn't broken.
    pub fn holds(&self, constraint: usize, modes: &[f64]) -> bool {
        self.switches.released.is_empty()
            || self.switches.released.get(&constraint).is_none_or(|&m| modes[m] == 0.0)
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
            modes: self.start.modes.clone(),
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
            ("modes", state.modes.len(), self.start.modes.len()),
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
    pub fn terms(&self) -> &[Box<dyn Term>] {
        &self.terms
    }
    /// Its constraints.
    pub fn constraints(&self) -> &[Box<dyn Constraint>] {
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

    /// Number of elements of the part that is divided most finely.
    pub fn finest(&self) -> usize {
        self.finest
    }

    /// Moves every node: `out = q ⊕ d`.
    pub fn retract(&self, q: &[f64], d: &[f64], out: &mut [f64]) {
        if self.flat {
            for ((out, q), d) in out.iter_mut().zip(q).zip(d) {
                *out = q + d;
            }
        } else {
            retract(&self.nodes, q, d, out);
        }
    }

    /// Sets the coordinates that motions prescribe, with their velocities and accelerations at time `t`.
    pub(crate) fn drive(&self, t: f64, modes: &[f64], q: &mut [f64], v: &mut [f64], a: &mut [f64]) {
        for &(c, at_q, at_v) in &self.driven {
            if self.holds(c, modes) {
                [q[at_q], v[at_v], a[at_v]] = self.constraints[c].prescribed(t);
            }
        }
    }

    /// Coordinate, velocity and acceleration that are prescribed at time `t` where the velocity has this place.
    pub(crate) fn prescribed(&self, at: usize, t: f64, modes: &[f64]) -> Option<[f64; 3]> {
        let own = self.driven.iter().find(|&&(c, _, v)| v == at && self.holds(c, modes));
        own.map(|&(c, ..)| self.constraints[c].prescribed(t))
    }

    /// Leaves out what a vector of velocities has of prescribed coordinates.
    pub(crate) fn without_driven(&self, modes: &[f64], x: &mut [f64]) {
        for &(c, _, at) in &self.driven {
            if self.holds(c, modes) {
                x[at] = 0.0;
            }
        }
    }

    /// The largest rotation of a body among these increments [rad].
    pub fn turn(&self, d: &[f64]) -> f64 {
        let bodies = self.nodes.iter().filter(|n| !self.flat && n.kind == NodeKind::Frame);
        bodies.map(|n| d[n.v + 3..n.v + 6].iter().map(|x| x * x).sum::<f64>()).fold(0.0, f64::max).sqrt()
    }

    /// Evaluates the residual `[r + Gᵀλ; g]` into `sys` and, with weights, the iteration matrix
    /// `[w.q (∂r/∂q + ∂(Gᵀλ)/∂q) + w.v ∂r/∂v + w.a ∂r/∂v̇, Gᵀ; G, 0]`.
    pub fn assemble(&self, at: &At<'_>, lambda: &[f64], weights: Option<Weights>, sys: &mut System) {
        self.assemble_in(&self.structure, at, lambda, weights, sys);
    }

    /// Whether a term has a kink in velocities.
    pub(crate) fn kinked(&self) -> bool {
        self.kinked
    }

    /// As [`Model::assemble`], for an iteration that comes from these velocities.
    pub(crate) fn assemble_from(
        &self,
        leap: Option<Leap<'_>>,
        at: &At<'_>,
        lambda: &[f64],
        weights: Option<Weights>,
        sys: &mut System,
    ) {
        self.assemble_all(&self.structure, leap, at, lambda, weights, sys);
    }

    /// The structure with both triangles stored, for analyses whose matrix is unsymmetric though no term is.
    pub fn unsymmetric_structure(&self) -> Structure {
        Structure::new(&self.nodes, &self.touched, &self.pattern, false)
    }

    /// As [`Model::assemble`], into a matrix of another structure of this model.
    pub fn assemble_in(
        &self,
        structure: &Structure,
        at: &At<'_>,
        lambda: &[f64],
        weights: Option<Weights>,
        sys: &mut System,
    ) {
        self.assemble_all(structure, None, at, lambda, weights, sys);
    }

    /// Residual and tangent of the loads alone, without constraints.
    pub(crate) fn assemble_loads(
        &self,
        structure: &Structure,
        at: &At<'_>,
        weights: Weights,
        sys: &mut System,
    ) {
        self.clear(structure, true, sys);
        for k in (0..self.terms.len()).filter(|&k| self.terms[k].is_load()) {
            self.add_term(structure, k, None, at, Some(weights), sys);
        }
    }

    fn clear(&self, structure: &Structure, tangent: bool, sys: &mut System) {
        sys.approximate = false;
        sys.residual.resize(self.structure.n, 0.0);
        sys.residual.fill(0.0);
        if tangent {
            sys.values.resize(structure.entries(), 0.0);
            sys.values.fill(0.0);
        }
    }

    fn add_term(
        &self,
        structure: &Structure,
        k: usize,
        leap: Option<Leap<'_>>,
        at: &At<'_>,
        weights: Option<Weights>,
        sys: &mut System,
    ) {
        let mut out = Assembly {
            residual: &mut sys.residual[..self.velocities],
            values: weights.map(|_| sys.values.as_mut_slice()),
            weights: weights.unwrap_or_default(),
            width: self.width,
            structure,
            clique: self.cliques[k].start,
            scratch: &mut sys.scratch,
            leap,
            approximate: &mut sys.approximate,
        };
        self.terms[k].add(at, &mut out);
    }

    fn assemble_all(
        &self,
        structure: &Structure,
        leap: Option<Leap<'_>>,
        at: &At<'_>,
        lambda: &[f64],
        weights: Option<Weights>,
        sys: &mut System,
    ) {
        self.clear(structure, weights.is_some(), sys);
        if let Some(p) = &mut sys.profile {
            p.resize(self.terms.len() + 1, (0, Duration::ZERO));
        }
        for k in 0..self.terms.len() {
            let begin = sys.profile.as_ref().map(|_| Instant::now());
            self.add_term(structure, k, leap, at, weights, sys);
            if let (Some(p), Some(begin)) = (&mut sys.profile, begin) {
                p[k].0 += 1;
                p[k].1 += begin.elapsed();
            }
        }
        let begin = sys.profile.as_ref().map(|_| Instant::now());
        for c in 0..self.constraints.len() {
            self.add_constraint(structure, c, at, lambda, weights, sys);
        }
        if let (Some(p), Some(begin)) = (&mut sys.profile, begin) {
            p[self.terms.len()].0 += 1;
            p[self.terms.len()].1 += begin.elapsed();
        }
    }

    fn add_constraint(
        &self,
        structure: &Structure,
        c: usize,
        at: &At<'_>,
        lambda: &[f64],
        weights: Option<Weights>,
        sys: &mut System,
    ) {
        let (constraint, rows) = (&self.constraints[c], self.rows_of(c));
        let m = rows.len();
        let n: usize = constraint.nodes().iter().map(|&k| self.node(k).kind.velocities()).sum();
        let multipliers = &lambda[rows.clone()];
        if !self.holds(c, at.modes) {
            // what is left are equations for its multipliers, which are zero since it let go
            for row in rows {
                let p = structure.position[self.velocities + row];
                if weights.is_some() {
                    sys.values[structure.slot(p, p)] += 1.0;
                }
            }
            return;
        }
        sys.jacobian.resize(n * m, 0.0);
        let (motion, relation) = sys.residual.split_at_mut(self.velocities);
        constraint.jacobian(&self.nodes, at, &mut relation[rows], &mut sys.jacobian);
        for (row, &l) in sys.jacobian.chunks_exact(n).zip(multipliers) {
            let mut row = row;
            for &k in constraint.nodes() {
                let dofs = self.node(k).dofs();
                let (own, rest) = row.split_at(dofs.len());
                motion[dofs].iter_mut().zip(own).for_each(|(f, g)| *f += l * g);
                row = rest;
            }
        }
        let Some(w) = weights else { return };
        let curved = !constraint.linear() && w.q != 0.0;
        if curved {
            sys.hessian.resize(n * n, 0.0);
            constraint.geometric(&self.nodes, at, multipliers, &mut sys.hessian);
            sys.hessian[..n * n].iter_mut().for_each(|h| *h *= w.q);
        }
        let hessian = curved.then_some(&sys.hessian[..]);
        let clique = self.cliques[self.terms.len() + c].start;
        structure.add_constraint(clique, [n, m], hessian, &sys.jacobian, &mut sys.values);
    }

    /// Adds `ρ GᵀG` to an assembled matrix and `ρ Gᵀg` to its residual. For each row `ρ = scale / |G row|²`.
    pub(crate) fn add_brace(&self, structure: &Structure, scale: f64, sys: &mut System) {
        for (c, constraint) in self.constraints.iter().enumerate() {
            let rows = self.rows_of(c);
            let (m, dofs): (usize, Vec<usize>) =
                (rows.len(), constraint.nodes().iter().flat_map(|&k| self.node(k).dofs()).collect());
            let n = dofs.len();
            // the Jacobian stands in the matrix already
            let place = |i: usize| structure.position[i];
            let row_of = |k: usize| place(self.velocities + rows.start + k / n);
            let jac: Vec<f64> =
                (0..m * n).map(|k| sys.values[structure.slot(row_of(k), place(dofs[k % n]))]).collect();
            for (r, row) in rows.clone().enumerate() {
                let g = &jac[r * n..(r + 1) * n];
                let square: f64 = g.iter().map(|x| x * x).sum();
                if square == 0.0 {
                    continue;
                }
                let rho = scale / square;
                let value = sys.residual[self.velocities + row];
                for i in 0..n {
                    sys.residual[dofs[i]] += rho * g[i] * value;
                    for j in 0..if structure.symmetric { i + 1 } else { n } {
                        sys.values[structure.slot(place(dofs[i]), place(dofs[j]))] += rho * g[i] * g[j];
                    }
                }
            }
        }
    }

    /// Values of the constraints alone.
    pub fn violations(&self, at: &At<'_>, sys: &mut System, g: &mut [f64]) {
        for (c, constraint) in self.constraints.iter().enumerate() {
            if !self.holds(c, at.modes) {
                g[self.rows_of(c)].fill(0.0);
                continue;
            }
            let n: usize = constraint.nodes().iter().map(|&k| self.node(k).kind.velocities()).sum();
            sys.jacobian.resize(n * constraint.rows().len(), 0.0);
            constraint.jacobian(&self.nodes, at, &mut g[self.rows_of(c)], &mut sys.jacobian);
        }
    }

    /// Rates of the constraints, `G v + ∂g/∂t`.
    pub fn constraint_rates(&self, at: &At<'_>, sys: &mut System, rate: &mut [f64]) {
        let (mut g, mut bias) = ([0.0; MOST_ROWS], [0.0; MOST_ROWS]);
        for (c, constraint) in self.constraints.iter().enumerate() {
            let rows = self.rows_of(c);
            if !self.holds(c, at.modes) {
                rate[rows].fill(0.0);
                continue;
            }
            let n: usize = constraint.nodes().iter().map(|&k| self.node(k).kind.velocities()).sum();
            sys.jacobian.resize(n * rows.len(), 0.0);
            constraint.jacobian(&self.nodes, at, &mut g[..rows.len()], &mut sys.jacobian);
            constraint.rates(&self.nodes, at, &mut rate[rows.clone()], &mut bias[..rows.len()]);
            let dofs = constraint.nodes().iter().flat_map(|&k| self.node(k).dofs());
            for (j, dof) in dofs.enumerate() {
                for (r, rate) in rate[rows.clone()].iter_mut().enumerate() {
                    *rate += sys.jacobian[r * n + j] * at.v[dof];
                }
            }
        }
    }

    /// `∂g/∂t` and the bias of the acceleration equations, for all rows.
    pub fn rates(&self, at: &At<'_>, rate: &mut [f64], bias: &mut [f64]) {
        for (c, constraint) in self.constraints.iter().enumerate() {
            let rows = self.rows_of(c);
            if self.holds(c, at.modes) {
                constraint.rates(&self.nodes, at, &mut rate[rows.clone()], &mut bias[rows]);
            } else {
                rate[rows.clone()].fill(0.0);
                bias[rows].fill(0.0);
            }
        }
    }

    /// Generalised force of one constraint on one node: `-Gᵀλ`. Its first three entries are the force [N].
    pub fn reaction(&self, constraint: usize, node: NodeId, at: &At<'_>, lambda: &[f64]) -> Vec<f64> {
        let (c, rows) = (&self.constraints[constraint], self.rows_of(constraint));
        let n: usize = c.nodes().iter().map(|&k| self.node(k).kind.velocities()).sum();
        let (mut g, mut jac) = (vec![0.0; rows.len()], vec![0.0; rows.len() * n]);
        c.jacobian(&self.nodes, at, &mut g, &mut jac);
        let before: usize =
            c.nodes().iter().take_while(|&&k| k != node).map(|&k| self.node(k).kind.velocities()).sum();
        (before..before + self.node(node).kind.velocities())
            .map(|j| -rows.clone().enumerate().map(|(r, row)| jac[r * n + j] * lambda[row]).sum::<f64>())
            .collect()
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
            n => format!("coordinate {n}"),
        };
        let id = NodeId(k as u32);
        match self.parts.iter().find_map(|p| p.place_of(id).map(|place| format!("`{}` {place}", p.name()))) {
            Some(part) => format!("{part}, {what}"),
            None => format!("node {k}, {what}"),
        }
    }

    /// Lets terms remember what a state that was accepted has changed.
    pub(crate) fn remember(&self, state: &mut State) {
        if self.remembering.is_empty() {
            return;
        }
        let mut memory = std::mem::take(&mut state.modes);
        for &k in &self.remembering {
            self.terms[k].remember(&state.at(), &mut memory);
        }
        state.modes = memory;
    }

    /// What has gone where it can't have gone in a step.
    pub(crate) fn passes(&self, before: &At<'_>, after: &At<'_>) -> Option<String> {
        self.watchful.iter().find_map(|&k| self.terms[k].passes(before, after))
    }

    /// What one should know of its terms at the end of a run.
    pub fn remarks(&self, at: &At<'_>) -> Vec<String> {
        self.terms.iter().filter_map(|t| t.remark(at)).collect()
    }

    /// The longest step from here that leaps over nothing that a term has ahead [s].
    pub fn horizon(&self, at: &At<'_>) -> f64 {
        self.watchful.iter().map(|&k| self.terms[k].horizon(at)).fold(f64::INFINITY, f64::min)
    }

    /// Whether something changes with time of its own accord.
    pub(crate) fn is_timed(&self) -> bool {
        !(self.timed.is_empty() && self.moving.is_empty())
    }

    /// The terms that depend on time otherwise than through the state.
    pub(crate) fn timed_terms(&self) -> impl Iterator<Item = &dyn Term> {
        self.timed.iter().map(|&k| self.terms[k].as_ref())
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

    /// The residual of one term alone, one entry for each velocity: minus the forces that it exerts. The term is one of
    /// this model, or of the [`Term::effects`] of one.
    pub fn share_of(&self, term: &dyn Term, at: &At<'_>) -> Vec<f64> {
        let mut residual = vec![0.0; self.velocities];
        let mut out = Assembly {
            residual: &mut residual,
            values: None,
            weights: Weights::default(),
            width: self.width,
            structure: &self.structure,
            clique: 0,
            scratch: &mut Vec::new(),
            leap: None,
            approximate: &mut false,
        };
        term.add(at, &mut out);
        residual
    }

    /// Kinetic and potential energy of all terms.
    pub fn energy(&self, at: &At<'_>) -> Energy {
        let mut e = Energy::default();
        for t in &self.terms {
            e += t.energy(at);
        }
        e
    }

    /// Power of all terms, and of the constraints that move with time: `λ · ∂g/∂t`.
    pub fn power(&self, at: &At<'_>, lambda: &[f64]) -> Power {
        let mut p = Power::default();
        for t in &self.terms {
            p += t.power(at);
        }
        let holding = self.constraints.iter().enumerate().filter(|(c, _)| self.holds(*c, at.modes));
        for (c, constraint) in holding {
            let (mut rate, mut bias) = ([0.0; MOST_ROWS], [0.0; MOST_ROWS]);
            constraint.rates(&self.nodes, at, &mut rate, &mut bias);
            p.supplied += rate.iter().zip(&lambda[self.rows_of(c)]).map(|(r, l)| r * l).sum::<f64>();
        }
        p
    }

    /// The same scene on other meshes.
    ///
    /// # Errors
    /// The mesh of this model never changes, or the new one can't be built.
    pub fn remesh(&self, plan: &Plan) -> Result<Model, BuildError> {
        let none =
            || BuildError::new("this model can't be built anew: its mesh doesn't change while it runs");
        let recipe = self.recipe.as_ref().ok_or_else(none)?;
        Ok(recipe(plan)?.with_width(self.width))
    }

    /// A state of another model of the same scene brought over to this one: each part interpolates its own. The
    /// result still has to be made consistent.
    pub fn carry(&self, old: &Model, state: &State) -> State {
        let mut new = self.state();
        new.t = state.t;
        new.modes.clone_from(&state.modes);
        for part in &self.parts {
            if let Some(other) = old.part(part.name()) {
                part.carry(&self.nodes, other.as_ref(), &state.at(), &mut new.q, &mut new.v);
            }
        }
        new
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
