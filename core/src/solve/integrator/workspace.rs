//! Scratch and caches of an integration. Dropping it changes cost, never what is accepted.

use super::adding::Body;
use super::forces::Forces;
use super::inertia::Inertia;
use super::norm::Norms;
use super::radau::stages::Stages;
use super::scales::Scaled;
use crate::model::Model;
use crate::model::assembly::System;
use crate::model::limit::Limit;
use crate::model::node::NodeKind;
use crate::model::rates::KeptRates;
use crate::model::state::{At, State};
use crate::model::structure::Structure;
use crate::model::term::Weights;
use crate::solve::linear::{Guard, SolveError};
use crate::solve::redundancy::Softening;
use crate::solve::times::{Clocks, Phase, Times};
use std::time::Duration;

/// What a run did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Counts {
    /// Accepted steps.
    pub steps: u64,
    /// Rejected tries.
    pub rejected: u64,
    /// Newton iterations, also of rejected tries.
    pub newton_iterations: u64,
    /// Evaluations of the iteration matrix.
    pub jacobians: u64,
    /// Factorisations.
    pub factorizations: u64,
    /// Factorisations without pivoting that were not good enough and were repeated with it.
    pub fallbacks: u64,
    /// Fixed steps that had to be cut, since they failed.
    #[cfg_attr(feature = "serde", serde(default))]
    pub cut: u64,
    /// Steps whose stopping test was never met, since rounding leaves more.
    pub unmet: u64,
    /// Accepted steps by what limited them, in the order of [`Limit::ALL`].
    #[cfg_attr(feature = "serde", serde(default))]
    pub limits: [u64; Limit::ALL.len()],
}

/// Scratch of an integration: system, factors, mass matrix.
pub struct Workspace {
    /// Residual and iteration matrix.
    pub system: System,
    /// Factors of the iteration matrix.
    pub(crate) solver: Guard,
    /// For which weights and constraints the kept factors were made.
    pub(crate) factored: Option<Weights>,
    /// The mass matrix and its factors with the constraints' Jacobian; made when first needed.
    pub(crate) mass: System,
    pub(crate) mass_solver: Guard,
    /// The matrix that `mass_solver` has factored.
    mass_factored: Vec<f64>,
    /// Of which inertia of another workspace `mass` and its factors are, if they are.
    taken: Option<u64>,
    /// What errors are estimated with.
    pub(crate) inertia: Inertia,
    /// Whether `mass.values` holds the mass matrix of the start, for norms.
    pub(crate) has_mass: bool,
    /// What counts as large, part by part; empty before the mass matrix is known.
    pub(crate) norms: Norms,
    /// The bodies whose errors add up.
    pub(crate) bodies: Vec<Body>,
    /// What forces are compared with.
    pub(crate) forces: Forces,
    /// Diagonal of the mass matrix of the start.
    pub(super) mass_diagonal: Vec<f64>,
    /// In elimination order.
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
    /// Counters.
    pub counts: Counts,
    /// What factorisations, solutions and the audit took.
    pub(crate) clocks: Clocks,
    /// What was spent on earlier meshes.
    earlier: Times,
    /// What makes the matrix regular although constraints are redundant; `None` where they aren't.
    pub(crate) softening: Option<Softening>,
    /// The iteration matrix without dimensions, where it is wished.
    pub(crate) scaled: Option<Scaled>,
    correction: Vec<f64>,
    /// What velocities that are moved onto the constraints are held against.
    pub(super) rates: KeptRates,
    pub(crate) trial: Trial,
    /// Scratch of Radau IIA; made when first needed.
    pub(crate) stages: Option<Box<Stages>>,
}

/// Vectors of a trial step.
#[derive(Default)]
pub(crate) struct Trial {
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    pub a: Vec<f64>,
    pub aux: Vec<f64>,
    pub aux_old: Vec<f64>,
    /// Velocities to start from, where they are not those of the state.
    pub v_old: Option<Vec<f64>>,
    /// What velocities have across the constraints, once the step has asked for it.
    pub across: Vec<f64>,
    pub lambda: Vec<f64>,
    pub d: Vec<f64>,
    /// What positions are moved by beside their motion, to meet the constraints: of the stabilised form.
    pub shift: Vec<f64>,
    /// Values of the constraints, and their rates.
    pub g: Vec<f64>,
    pub g_rate: Vec<f64>,
    pub rhs: Vec<f64>,
    /// Velocities of the iteration before, for terms with kinks.
    pub v_before: Vec<f64>,
    /// Whether the last step began by approximating forces at kinks.
    pub kinked: bool,
}

impl Workspace {
    /// Scratch for a model.
    pub fn new(model: &Model) -> Result<Self, SolveError> {
        let s = model.structure();
        let nv = model.velocities();
        let zero = || vec![0.0; nv];
        Ok(Workspace {
            system: System::default(),
            solver: Guard::new(s)?,
            factored: None,
            mass: System::default(),
            mass_solver: Guard::new(s)?,
            mass_factored: Vec::new(),
            taken: None,
            inertia: Inertia::default(),
            has_mass: false,
            norms: Norms::default(),
            bodies: Vec::new(),
            forces: Forces::default(),
            mass_diagonal: Vec::new(),
            x: vec![0.0; s.n],
            y: vec![0.0; s.n],
            counts: Counts::default(),
            clocks: Clocks::default(),
            earlier: Times::default(),
            softening: model.redundancy().map(|_| Softening::new(model, s)),
            scaled: None,
            correction: Vec::new(),
            rates: KeptRates::default(),
            trial: Trial {
                q: model.start.q.clone(),
                v: zero(),
                a: zero(),
                aux: zero(),
                aux_old: zero(),
                v_old: None,
                across: Vec::new(),
                lambda: vec![0.0; model.multipliers()],
                d: zero(),
                shift: zero(),
                g: vec![0.0; model.multipliers()],
                g_rate: vec![0.0; model.multipliers()],
                rhs: Vec::new(),
                v_before: zero(),
                kinked: false,
            },
            stages: None,
        })
    }

    /// Forgets kept factors and the mass matrix: after an event, or to make runs independent of history.
    pub fn forget(&mut self) {
        self.factored = None;
        self.has_mass = false;
        if let Some(stages) = &mut self.stages {
            stages.forget();
        }
    }

    /// Makes everything anew but the counters and the times that are measured: what comes next doesn't depend on what
    /// went before.
    ///
    /// # Errors
    /// Not enough memory for the factors.
    pub(crate) fn renew(&mut self, model: &Model) -> Result<(), SolveError> {
        let mut new = Workspace::new(model)?;
        (new.counts, new.clocks) = (self.counts, self.clocks);
        new.earlier = std::mem::take(&mut self.earlier);
        new.system.profile = self.system.profile.take();
        new.mass.profile = self.mass.profile.take();
        if self.softening.is_some() {
            new.soften(model);
        }
        *self = new;
        Ok(())
    }

    /// Makes everything anew for another mesh, but the counters and the times.
    ///
    /// # Errors
    /// Not enough memory for the factors.
    pub(crate) fn change_mesh(&mut self, old: &Model, new: &Model) -> Result<(), SolveError> {
        let mut work = Workspace::new(new)?;
        work.counts = self.counts;
        if self.system.profile.is_some() {
            work.profile();
            work.earlier = self.spent(old);
        }
        *self = work;
        Ok(())
    }

    /// From now on constraints are solved as if some were redundant.
    pub(crate) fn soften(&mut self, model: &Model) {
        self.softening = Some(Softening::new(model, model.structure()));
        self.forget();
    }

    /// Records the time of each term from now on.
    pub fn profile(&mut self) {
        self.system.profile = Some(Vec::new());
        self.mass.profile = Some(Vec::new());
        self.clocks = Clocks::running();
        self.earlier = Times::default();
    }

    /// No longer records times, and forgets those that were.
    pub fn unprofile(&mut self) {
        self.system.profile = None;
        self.mass.profile = None;
        self.clocks = Clocks::default();
        self.earlier = Times::default();
    }

    /// Calls and time of each term, of the constraints, of the solver and of the audit, by label; nothing without
    /// [`Workspace::profile`].
    pub fn times(&self, model: &Model) -> Vec<(String, u64, Duration)> {
        self.spent(model).list()
    }

    fn spent(&self, model: &Model) -> Times {
        self.earlier.clone().adding(model, [&self.system, &self.mass], &self.clocks)
    }

    /// Solves for a right-hand side (velocities, then multipliers), which the solution replaces.
    pub(crate) fn solve(&mut self, model: &Model, which: Which, rhs: &mut [f64]) -> Result<(), SolveError> {
        let s = model.structure();
        s.order(rhs, &mut self.x);
        self.solve_ordered(model, which)?;
        s.restore(&self.x, rhs);
        match self.softening.take() {
            Some(softening) => {
                let refined = self.refine(model, which, &softening, rhs);
                self.softening = Some(softening);
                refined
            }
            None => Ok(()),
        }
    }

    /// Removes what the small diagonal has changed of a solution.
    fn refine(
        &mut self,
        model: &Model,
        which: Which,
        softening: &Softening,
        solution: &mut [f64],
    ) -> Result<(), SolveError> {
        let (s, nv) = (model.structure(), model.velocities());
        let mut d = std::mem::take(&mut self.correction);
        d.clear();
        d.extend_from_slice(solution);
        for _ in 0..2 {
            d[..nv].fill(0.0);
            let values = match which {
                Which::Iteration => &self.system.values,
                Which::Mass => &self.mass.values,
            };
            softening.times(values, &mut d[nv..]);
            d.iter_mut().for_each(|d| *d = -*d);
            s.order(&d, &mut self.x);
            self.solve_ordered(model, which)?;
            s.restore(&self.x, &mut d);
            solution.iter_mut().zip(&d).for_each(|(x, d)| *x += d);
        }
        self.correction = d;
        Ok(())
    }

    /// Replaces `x`, a right-hand side in elimination order, by the solution.
    pub(crate) fn solve_ordered(&mut self, model: &Model, which: Which) -> Result<(), SolveError> {
        let (s, begin) = (model.structure(), self.clocks.start());
        match (which, &self.scaled) {
            (Which::Iteration, Some(scaled)) => {
                scaled.enter(&mut self.x);
                self.solver.solve(s, &scaled.values, &mut self.x)?;
                scaled.leave(&mut self.x);
            }
            (Which::Iteration, None) => self.solver.solve(s, &self.system.values, &mut self.x)?,
            (Which::Mass, _) => self.mass_solver.solve(s, &self.mass.values, &mut self.x)?,
        }
        self.clocks.stop(Phase::Solution, begin);
        Ok(())
    }

    /// Factors the iteration matrix that was assembled into `system` with these weights.
    ///
    /// # Errors
    /// The matrix is singular or not finite.
    pub fn factor(&mut self, model: &Model, weights: Weights) -> Result<(), SolveError> {
        self.factored = None;
        if let Some(softening) = &self.softening {
            softening.apply(&mut self.system.values);
        }
        let begin = self.clocks.start();
        let values = match &mut self.scaled {
            Some(scaled) => {
                scaled.take(&self.system.values);
                &scaled.values
            }
            None => &self.system.values,
        };
        self.solver.factor(model.structure(), values)?;
        self.clocks.stop(Phase::Factorisation, begin);
        self.factored = Some(weights);
        self.counts.jacobians += 1;
        self.counts.factorizations += 1;
        self.counts.fallbacks = self.solver.fallbacks + self.mass_solver.fallbacks;
        Ok(())
    }

    /// Notes what rounding leaves of forces, from the iteration matrix that was assembled into `system` with these weights.
    pub(crate) fn round_forces(&mut self, model: &Model, weights: Weights) {
        if !(weights.q > 0.0) {
            return;
        }
        let (diagonal, values, mass) =
            (&model.structure().diagonal, &self.system.values, &self.mass_diagonal);
        self.forces.round(&self.norms, |i| (values[diagonal[i] as usize] - weights.a * mass[i]) / weights.q);
    }

    /// Replaces a right-hand side (velocities, then multipliers) by the solution with the factors of the iteration
    /// matrix. Where entries have grown, the first solution after [`Workspace::factor`] is checked.
    ///
    /// # Errors
    /// The solution is not good enough, even with pivoting.
    pub fn solve_iteration(&mut self, model: &Model, rhs: &mut [f64]) -> Result<(), SolveError> {
        self.solve(model, Which::Iteration, rhs)
    }

    /// Assembles the mass matrix `[M + stiff K, Gᵀ; G, 0]` and the values of the constraints at a state; with `factor` its
    /// factors too.
    pub(crate) fn assemble_mass(
        &mut self,
        model: &Model,
        at: &At<'_>,
        lambda: &[f64],
        stiff: f64,
        factor: bool,
    ) -> Result<(), SolveError> {
        self.taken = None;
        model.assemble_matrix(at, lambda, Weights { q: stiff, v: 0.0, a: 1.0 }, &mut self.mass);
        self.has_mass = stiff == 0.0;
        if let (true, Some(softening)) = (factor, &self.softening) {
            softening.apply(&mut self.mass.values);
        }
        if factor { self.factor_mass(model) } else { Ok(()) }
    }

    /// Factors the mass matrix as it stands, if it isn't the last that was factored: without added mass and with constraints
    /// that are linear it never changes.
    fn factor_mass(&mut self, model: &Model) -> Result<(), SolveError> {
        if self.mass_factored == self.mass.values {
            return Ok(());
        }
        self.mass_factored.clear();
        let begin = self.clocks.start();
        self.mass_solver.factor(model.structure(), &self.mass.values)?;
        self.clocks.stop(Phase::Factorisation, begin);
        self.counts.factorizations += 1;
        self.mass_factored.extend_from_slice(&self.mass.values);
        Ok(())
    }

    /// Takes the mass matrix by which another workspace estimates errors, nearly that of now, and its factors; whether there is
    /// one that holds the constraints as they are now.
    pub(crate) fn take_inertia(&mut self, model: &Model, of: &Workspace) -> Result<bool, SolveError> {
        let values = of.inertia.values();
        if values.is_empty() || self.softening.is_some() || !model.keeps_constraints() {
            return Ok(false);
        }
        if self.taken != Some(of.inertia.made()) {
            self.taken = None;
            self.mass.values.clear();
            self.mass.values.extend_from_slice(values);
            self.factor_mass(model)?;
            self.taken = Some(of.inertia.made());
        }
        Ok(true)
    }

    /// Sets `y` to the product of a matrix and a vector of velocities, in elimination order.
    pub(crate) fn product(&mut self, s: &Structure, values: &[f64], d: &[f64]) {
        self.x.fill(0.0);
        s.order(d, &mut self.x);
        s.multiply(values, &self.x, &mut self.y);
    }

    /// Size of an increment relative to the part that it moves most, by `dᵀ M d` with this mass matrix.
    pub(crate) fn norm_with(&mut self, s: &Structure, mass: &[f64], d: &[f64]) -> f64 {
        self.product(s, mass, d);
        // a NaN stays a NaN; rounding may make a tiny sum negative
        self.norms.relative_with(d, |i| self.y[s.position[i]])
    }

    /// The equation with the largest residual of the last evaluation.
    pub(crate) fn worst_equation(&self, model: &Model) -> String {
        let mut worst = (0, 0.0);
        for (i, r) in self.system.residual.iter().enumerate() {
            if !r.is_finite() {
                return model.unknown_name(i);
            }
            if r.abs() > worst.1 {
                worst = (i, r.abs());
            }
        }
        model.unknown_name(worst.0)
    }

    /// `M d` in the order of velocities, with the mass matrix last assembled.
    pub(crate) fn times_mass(&mut self, model: &Model, d: &[f64], out: &mut [f64]) {
        self.times_matrix(model, Which::Mass, d, out);
    }

    /// The same with either matrix as it was assembled last.
    pub(crate) fn times_matrix(&mut self, model: &Model, which: Which, d: &[f64], out: &mut [f64]) {
        let s = model.structure();
        let values = match which {
            Which::Mass => &self.mass.values,
            Which::Iteration => &self.system.values,
        };
        self.x.fill(0.0);
        s.order(d, &mut self.x);
        s.multiply(values, &self.x, &mut self.y);
        s.restore(&self.y, out);
    }

    /// Momentum of the whole model [kg m/s]; NaN where the mass matrix can't be had.
    pub(crate) fn momentum(&mut self, model: &Model, state: &State) -> [f64; 3] {
        if self.assemble_mass(model, &state.at(), &state.lambda, 0.0, false).is_err() {
            return [f64::NAN; 3];
        }
        let mut all = vec![0.0; model.structure().n];
        self.times_mass(model, &state.v, &mut all);
        // the equations of positions are those that a displacement of everything does work on
        let moving = model.nodes().iter().filter(|n| !matches!(n.kind, NodeKind::Scalars(_)));
        moving.fold([0.0; 3], |sum, n| std::array::from_fn(|i| sum[i] + all[n.v + i]))
    }

    /// Makes sure that norms have a mass matrix: assembled once, at the first state seen.
    pub(crate) fn ensure_mass(
        &mut self,
        model: &Model,
        at: &At<'_>,
        lambda: &[f64],
    ) -> Result<(), SolveError> {
        if self.has_mass && !self.norms.groups.is_empty() {
            return Ok(());
        }
        self.assemble_mass(model, at, lambda, 0.0, false)?;
        self.inertia.take(&self.mass.values);
        // translations weigh what they move, everything else its diagonal entry
        let diagonal = model.structure().diagonal.iter();
        self.mass_diagonal =
            diagonal.take(model.velocities()).map(|&p| self.mass.values[p as usize]).collect();
        let mut mass = self.mass_diagonal.clone();
        let mut unit = vec![0.0; model.velocities()];
        let mut out = vec![0.0; model.velocities()];
        let mut total = 0.0;
        for direction in 0..3 {
            unit.fill(0.0);
            for n in model.nodes().iter().filter(|n| n.kind.has_position()) {
                unit[n.v + direction] = 1.0;
            }
            self.times_mass(model, &unit, &mut out);
            for i in 0..out.len() {
                mass[i] = mass[i].max(unit[i] * out[i]);
                total += unit[i] * out[i];
            }
        }
        self.norms = Norms::new(model, &mass);
        self.norms.order(model.structure());
        self.bodies = Body::all(model, &self.norms);
        self.forces = Forces::new(model, &self.norms);
        if total > 0.0 { Ok(()) } else { Err(SolveError::Singular(0)) }
    }
}

/// Which matrix to solve with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Which {
    Iteration,
    Mass,
}
