//! The matrices of the linearised equations, their combinations `K + s C + s² M`, and solutions with them.

use super::krylov::dot;
use super::outcome::ModesError;
use crate::model::Model;
use crate::model::structure::Structure;
use crate::solve::linear::{Guard, SolveError};
use crate::solve::redundancy::Softening;
use crate::solve::statics::Linear;

/// Mass, damping and stiffness about an equilibrium, with the solver for shifted matrices. Vectors are in elimination
/// order, with zeros for the multipliers.
pub(super) struct Pencil {
    linear: Linear,
    softening: Option<Softening>,
    solver: Guard,
    /// The matrix that is factored.
    values: Vec<f64>,
    /// Whether stiffness and mass are symmetric, to rounding.
    pub symmetric: bool,
    /// Whether there are forces that depend on velocity: damping, or those of a frame that turns.
    pub damped: bool,
    /// Equations of constraints that hold.
    held: usize,
    /// Independent motions that they leave.
    pub motions: usize,
    /// Largest ratio of stiffness to mass: about the fastest that the mesh can resolve [1/s²]; 1 without stiffness.
    pub fastest: f64,
}

impl Pencil {
    pub fn new(model: &Model, internal: &[f64], mut linear: Linear) -> Result<Self, ModesError> {
        let s = &linear.structure;
        // the Jacobian stands in every matrix; here it belongs to the stiffness only
        for (r, columns, at) in s.rows() {
            for (k, p) in at.enumerate() {
                if s.is_multiplier[r] || s.is_multiplier[columns.get(k)] {
                    (linear.mass[p], linear.damping[p]) = (0.0, 0.0);
                }
            }
        }
        let all = [&linear.stiffness, &linear.damping, &linear.mass];
        if all.iter().any(|a| a.iter().any(|x| !x.is_finite())) {
            return Err(ModesError::Solver(SolveError::NotFinite));
        }
        let holding = (0..model.constraints().len()).filter(|&c| model.holds(c, internal));
        let held: usize = holding.map(|c| model.rows_of(c).len()).sum();
        let redundant = model.redundancy().map_or(0, |r| r.equations);
        let motions = model.velocities() - held.saturating_sub(redundant).min(model.velocities());
        let symmetric = s.symmetric || (is_symmetric(s, &linear.stiffness) && is_symmetric(s, &linear.mass));
        // below the diagonal of symmetric matrices nothing counts
        let damped = s.rows().any(|(_, _, at)| linear.damping[at].iter().any(|x| *x != 0.0));
        let solver = Guard::new(s).map_err(ModesError::Solver)?;
        let softening = model.redundancy().map(|_| Softening::new(model, s));
        let fastest = fastest(&linear);
        let mut pencil = Pencil {
            linear,
            softening,
            solver,
            values: Vec::new(),
            symmetric,
            damped,
            held,
            motions,
            fastest,
        };
        pencil.refuse_massless(model)?;
        Ok(pencil)
    }

    pub fn structure(&self) -> &Structure {
        &self.linear.structure
    }

    /// Number of unknowns, multipliers included.
    pub fn len(&self) -> usize {
        self.linear.structure.n
    }

    /// What moves without mass has no frequency.
    fn refuse_massless(&mut self, model: &Model) -> Result<(), ModesError> {
        let s = &self.linear.structure;
        let mass = |i: usize| self.linear.mass[s.diagonal[i] as usize];
        let Some(light) = (0..model.velocities()).find(|&i| !(mass(i) > 0.0)) else { return Ok(()) };
        self.values.clone_from(&self.linear.mass);
        for (r, columns, at) in s.rows() {
            for (k, p) in at.enumerate() {
                if s.is_multiplier[r] || s.is_multiplier[columns.get(k)] {
                    self.values[p] = self.linear.stiffness[p];
                }
            }
        }
        let unknown = |i: usize| Err(ModesError::Massless { unknown: model.unknown_name(i) });
        // it may be held by constraints: then it doesn't move
        let mut x = vec![1.0; s.n];
        let solved =
            self.solver.factor(s, &self.values).and_then(|()| self.solver.solve(s, &self.values, &mut x));
        if solved.is_ok() { Ok(()) } else { unknown(light) }
    }

    /// Brings a vector onto the constraints, with the matrix of the shift [`Pencil::fastest`], which prefers none of the
    /// motions that are left.
    pub fn restrict(&mut self, x: &mut [f64]) -> Result<(), SolveError> {
        zero_multipliers(&self.linear.structure, x);
        let mut y = vec![0.0; x.len()];
        self.mass(x, &mut y);
        self.solve(&mut y)?;
        x.iter_mut().zip(&y).for_each(|(x, y)| *x = y * self.fastest);
        Ok(())
    }

    /// Factors `K + c C + m M`.
    pub fn factor(&mut self, c: f64, m: f64) -> Result<(), SolveError> {
        let l = &self.linear;
        self.values.clear();
        let sum = |((k, d), a): ((&f64, &f64), &f64)| k + c * d + m * a;
        self.values.extend(l.braced.iter().zip(&l.damping).zip(&l.mass).map(sum));
        if let Some(softening) = &self.softening {
            softening.apply(&mut self.values);
        }
        self.solver.factor(&l.structure, &self.values)
    }

    /// Solves with the factored matrix; multipliers are dropped.
    pub fn solve(&mut self, x: &mut [f64]) -> Result<(), SolveError> {
        let s = &self.linear.structure;
        self.solver.solve(s, &self.values, x)?;
        zero_multipliers(s, x);
        Ok(())
    }

    /// Newton's correction of the equilibrium with the factored matrix, multipliers included.
    pub fn correction(&mut self) -> Result<Vec<f64>, SolveError> {
        let residual = std::mem::take(&mut self.linear.braced_residual);
        let found = self.answer(&residual);
        self.linear.braced_residual = residual;
        found
    }

    /// Displacements and multipliers by which the equations take up a residual, with the factored matrix.
    pub fn answer(&mut self, residual: &[f64]) -> Result<Vec<f64>, SolveError> {
        let (l, mut x) = (&self.linear, vec![0.0; self.len()]);
        for (residual, &p) in residual.iter().zip(&l.structure.position) {
            x[p] = -residual;
        }
        self.solver.solve(&l.structure, &self.values, &mut x)?;
        Ok(l.structure.position.iter().map(|&p| x[p]).collect())
    }

    /// The direction in which a residual pushes, with the factored matrix, in elimination order.
    pub fn towards(&mut self, residual: &[f64]) -> Result<Vec<f64>, SolveError> {
        let mut x = vec![0.0; self.len()];
        for (residual, &p) in residual.iter().zip(&self.linear.structure.position) {
            x[p] = *residual;
        }
        self.solve(&mut x)?;
        Ok(x)
    }

    /// Number of eigenvalues `ω²` below `-m` where the factored matrix is `K + m M`, by Sylvester's law of inertia;
    /// `None` where the solver doesn't know.
    pub fn below(&self) -> Option<usize> {
        if !self.symmetric {
            return None;
        }
        self.solver.negative_pivots().map(|n| n.saturating_sub(self.held))
    }

    /// Leaves of the two sides of the equations only the forces.
    pub fn load(&self, y: &mut [f64]) {
        zero_multipliers(&self.linear.structure, y);
    }

    pub fn mass(&self, x: &[f64], y: &mut [f64]) {
        self.linear.structure.multiply(&self.linear.mass, x, y);
    }
    pub fn damping(&self, x: &[f64], y: &mut [f64]) {
        self.linear.structure.multiply(&self.linear.damping, x, y);
    }
    pub fn stiffness(&self, x: &[f64], y: &mut [f64]) {
        self.linear.structure.multiply(&self.linear.stiffness, x, y);
        zero_multipliers(&self.linear.structure, y);
    }

    /// `xᵀ K x` of a vector of unit mass, and what rounding makes of it: of the entries of `K`, and of those of `x`,
    /// where a stiff direction is mixed in.
    pub fn energy(&self, x: &[f64]) -> (f64, f64) {
        let s = &self.linear.structure;
        let mut y = vec![0.0; s.n];
        self.stiffness(x, &mut y);
        let mut size = 0.0;
        for (r, columns, at) in s.rows() {
            for (k, p) in at.enumerate() {
                let c = columns.get(k);
                let twice = if s.symmetric && c != r { 2.0 } else { 1.0 };
                size += twice * (self.linear.stiffness[p] * x[r] * x[c]).abs();
            }
        }
        (dot(x, &y), f64::EPSILON * (size + f64::EPSILON * self.fastest))
    }
}

fn fastest(l: &Linear) -> f64 {
    let s = &l.structure;
    let mass = |p: usize| l.mass[s.diagonal_at[p] as usize].max(0.0);
    let mut most = 0.0_f64;
    for (r, columns, at) in s.rows().filter(|(r, ..)| !s.is_multiplier[*r]) {
        for (k, p) in at.enumerate() {
            let both = (mass(r) * mass(columns.get(k))).sqrt();
            if both > 0.0 {
                most = most.max(l.stiffness[p].abs() / both);
            }
        }
    }
    // the very rate of what falls over and does nothing else would as a shift make the matrix singular
    let diagonal = s.diagonal_at.iter().map(|&p| (l.stiffness[p as usize], l.mass[p as usize]));
    let falls = diagonal.filter(|(_, m)| *m > 0.0).any(|(k, m)| -k / m > 0.9 * most);
    match most > 0.0 {
        true if falls => 2.0 * most,
        true => most,
        false => 1.0,
    }
}

fn zero_multipliers(s: &Structure, x: &mut [f64]) {
    for (x, _) in x.iter_mut().zip(&s.is_multiplier).filter(|(_, multiplier)| **multiplier) {
        *x = 0.0;
    }
}

/// Whether an unsymmetrically stored matrix is symmetric: up to a small part of the largest entry of row or column.
fn is_symmetric(s: &Structure, values: &[f64]) -> bool {
    let largest: Vec<f64> = {
        let mut all = vec![0.0; s.n];
        for (r, _, at) in s.rows() {
            all[r] = values[at].iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        }
        all
    };
    s.rows().all(|(r, columns, at)| {
        at.enumerate().all(|(k, p)| {
            let c = columns.get(k);
            c <= r || (values[p] - s.entry(values, c, r)).abs() <= 1e-8 * largest[r].max(largest[c])
        })
    })
}
