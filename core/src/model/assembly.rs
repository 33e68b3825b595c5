//! Assembly: residual, iteration matrix and constraint equations of a model, from its terms and constraints.

use crate::model::Model;
use crate::model::node::{NodeKind, retract};
use crate::model::state::{At, State};
use crate::model::structure::Structure;
use crate::model::term::{Assembly, Leap, Weights};
use crate::model::twist;
use std::time::{Duration, Instant};

/// Calls and the time that they took.
pub type Spent = (u64, Duration);

/// Residual and iteration matrix of a model, with the scratch to assemble them.
#[derive(Debug, Default)]
pub struct System {
    /// Residual: the equations of motion, then those of the constraints.
    pub residual: Vec<f64>,
    /// Values of the matrix, where [`Structure::rows`] says.
    pub values: Vec<f64>,
    pub(super) jacobian: Vec<f64>,
    hessian: Vec<f64>,
    /// For what elements scatter.
    scratch: Vec<f64>,
    /// Whether a term was only approximated.
    pub(crate) approximate: bool,
    /// Calls and time of each term, then of the constraints; only filled where profiling was asked for.
    pub profile: Option<Vec<Spent>>,
}

impl Model {
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
    pub(crate) fn drive(&self, t: f64, internal: &[f64], q: &mut [f64], v: &mut [f64], a: &mut [f64]) {
        for &(c, at_q, at_v) in &self.driven {
            if self.holds(c, internal) {
                [q[at_q], v[at_v], a[at_v]] = self.constraints[c].prescribed(t);
            }
        }
    }

    /// Coordinate, velocity and acceleration that are prescribed at time `t` where the velocity has this place.
    pub(crate) fn prescribed(&self, at: usize, t: f64, internal: &[f64]) -> Option<[f64; 3]> {
        let own = self.driven.iter().find(|&&(c, _, v)| v == at && self.holds(c, internal));
        own.map(|&(c, ..)| self.constraints[c].prescribed(t))
    }

    /// Leaves out what a vector of velocities has of prescribed coordinates.
    pub(crate) fn without_driven(&self, internal: &[f64], x: &mut [f64]) {
        for &(c, _, at) in &self.driven {
            if self.holds(c, internal) {
                x[at] = 0.0;
            }
        }
    }

    /// The largest rotation of a body among these increments [rad].
    pub fn turn(&self, d: &[f64]) -> f64 {
        let bodies = self.nodes.iter().filter(|n| !self.flat && n.kind == NodeKind::Frame);
        bodies.map(|n| d[n.v + 3..n.v + 6].iter().map(|x| x * x).sum::<f64>()).fold(0.0, f64::max).sqrt()
    }

    /// The largest angle by which a motion turns something between two times [rad].
    pub(crate) fn turned(&self, from: f64, to: f64) -> f64 {
        self.constraints.iter().filter(|c| c.moves()).map(|c| c.turned(from, to)).fold(0.0, f64::max)
    }

    /// Why a cable can't be followed by these increments, if it can't: they turn a section so far that its director doesn't
    /// know where to go, or bend an element so far that its twist can't be told.
    pub(crate) fn flips(&self, q: &[f64], d: &[f64]) -> Option<&'static str> {
        let mut nodes = self.nodes.iter().filter(|n| !self.twisted.is_empty() && n.kind == NodeKind::Twist);
        if nodes.any(|n| twist::flips(&q[n.coords()], &d[n.dofs()])) {
            return Some("the direction of a cable with torsion turns round in one step");
        }
        self.twisted.iter().find_map(|(coordinates, dofs)| {
            let (q, d) = (|k: usize| &q[coordinates[k]..], |k: usize| &d[dofs[k]..]);
            (1..dofs.len()).find_map(|k| twist::loses_count([q(k - 1), q(k)], [d(k - 1), d(k)]))
        })
    }

    /// Lays the reference directors of twisted lines anew where neighbours are far apart; the sections stay. To be called
    /// between steps, with no state from before in use.
    pub(crate) fn relabel(&self, state: &mut State) {
        if self.twisted.is_empty() {
            return;
        }
        let before = self.labels(&state.q);
        for (line, _) in &self.twisted {
            twist::relabel(&mut state.q, line);
        }
        self.count_on(&before, state);
    }

    /// Lets what counts on with labels of sections go on where it was, after these have changed and the sections haven't.
    pub(crate) fn count_on(&self, before: &[(usize, f64)], state: &mut State) {
        let after = self.labels(&state.q);
        for (place, was) in before {
            let now = after.iter().find(|(other, _)| other == place);
            if let (Some((_, now)), Some(x)) = (now, state.internal.get_mut(*place)) {
                *x += was - now;
            }
        }
    }

    /// Evaluates the residual `[r + Gᵀλ; g]` into `sys` and, with weights, the iteration matrix
    /// `[w.q (∂r/∂q + ∂(Gᵀλ)/∂q) + w.v ∂r/∂v + w.a ∂r/∂v̇, Gᵀ; G, 0]`.
    pub fn assemble(&self, at: &At<'_>, lambda: &[f64], weights: Option<Weights>, sys: &mut System) {
        self.assemble_in(&self.structure, at, lambda, weights, sys);
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
        self.assemble_all(&self.structure, leap, at, lambda, weights, sys, false);
    }

    /// The iteration matrix with these weights, and the values of the constraints, without what is left of the equations of
    /// motion: terms that the matrix has nothing of aren't evaluated.
    pub(crate) fn assemble_matrix(&self, at: &At<'_>, lambda: &[f64], weights: Weights, sys: &mut System) {
        self.assemble_all(&self.structure, None, at, lambda, Some(weights), sys, true);
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
        self.assemble_all(structure, None, at, lambda, weights, sys, false);
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

    /// Evaluates all terms and the constraints; for a matrix `alone` only terms that it has a share of.
    #[expect(clippy::too_many_arguments, reason = "all that an assembly depends on")]
    fn assemble_all(
        &self,
        structure: &Structure,
        leap: Option<Leap<'_>>,
        at: &At<'_>,
        lambda: &[f64],
        weights: Option<Weights>,
        sys: &mut System,
        alone: bool,
    ) {
        self.clear(structure, weights.is_some(), sys);
        if let Some(p) = &mut sys.profile {
            p.resize(self.terms.len() + 1, (0, Duration::ZERO));
        }
        let w = weights.unwrap_or_default();
        for k in (0..self.terms.len()).filter(|&k| !alone || self.terms[k].has_tangent(&w)) {
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
        let n = self.freedoms_of(c);
        let multipliers = &lambda[rows.clone()];
        if !self.holds(c, at.internal) {
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

    /// Adds `ρ GᵀG` to an assembled matrix and `ρ Gᵀg` to its residual. For each row `1/ρ = Σ G²/k`, with this stiffness `k` of positions
    /// and of what has no length: so `ρ` has the unit that its row asks for.
    pub(crate) fn add_brace(&self, structure: &Structure, stiffness: [f64; 2], sys: &mut System) {
        let mut soft = vec![1.0 / stiffness[1]; self.velocities];
        for n in self.nodes.iter().filter(|n| n.kind.has_position()) {
            soft[n.v..n.v + 3].fill(1.0 / stiffness[0]);
        }
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
                let compliance: f64 = g.iter().zip(&dofs).map(|(x, &dof)| x * x * soft[dof]).sum();
                if compliance == 0.0 {
                    continue;
                }
                let rho = 1.0 / compliance;
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
            if !self.holds(c, at.internal) {
                g[self.rows_of(c)].fill(0.0);
                continue;
            }
            sys.jacobian.resize(self.freedoms_of(c) * constraint.rows().len(), 0.0);
            constraint.violation(&self.nodes, at, &mut g[self.rows_of(c)], &mut sys.jacobian);
        }
    }
}
