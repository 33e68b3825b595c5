//! Rates of the constraints: what they say of velocities.

use super::Model;
use super::assembly::System;
use super::constraint::MOST_ROWS;
use super::state::At;

/// What the constraints say of velocities at one place, `G v + ∂g/∂t`, kept for as many velocities as are tried there.
#[derive(Debug, Default)]
pub(crate) struct KeptRates {
    jacobian: Vec<f64>,
    given: Vec<f64>,
}

impl Model {
    /// Rates of the constraints, `G v + ∂g/∂t`.
    pub fn constraint_rates(&self, at: &At<'_>, sys: &mut System, rate: &mut [f64]) {
        for c in 0..self.constraints.len() {
            self.constraint_rate(c, at, sys, &mut rate[self.rows_of(c)]);
        }
    }

    /// The same of one constraint.
    pub(crate) fn constraint_rate(&self, c: usize, at: &At<'_>, sys: &mut System, rate: &mut [f64]) {
        sys.jacobian.resize(self.freedoms_of(c) * rate.len(), 0.0);
        self.relate(c, at, &mut sys.jacobian, rate, &mut [0.0; MOST_ROWS]);
        self.add_rate(c, &sys.jacobian, at.v, rate);
    }

    /// What accelerations of a state are off one constraint by, `G v̇` and its bias.
    pub(crate) fn constraint_drift(&self, c: usize, at: &At<'_>, sys: &mut System, drift: &mut [f64]) {
        sys.jacobian.resize(self.freedoms_of(c) * drift.len(), 0.0);
        self.relate(c, at, &mut sys.jacobian, &mut [0.0; MOST_ROWS], drift);
        self.add_rate(c, &sys.jacobian, at.a, drift);
    }

    /// Keeps what the constraints say of velocities at the place of a state.
    pub(crate) fn keep_rates(&self, at: &At<'_>, kept: &mut KeptRates) {
        let entries = (0..self.constraints.len()).map(|c| self.freedoms_of(c) * self.rows_of(c).len());
        kept.jacobian.resize(entries.sum(), 0.0);
        kept.given.resize(self.multipliers(), 0.0);
        let (mut jacobian, mut given) = (&mut kept.jacobian[..], &mut kept.given[..]);
        for c in 0..self.constraints.len() {
            let m = self.rows_of(c).len();
            let (own, own_given);
            (own, jacobian) = jacobian.split_at_mut(m * self.freedoms_of(c));
            (own_given, given) = given.split_at_mut(m);
            self.relate(c, at, own, own_given, &mut [0.0; MOST_ROWS]);
        }
    }

    /// Rates of the constraints with these velocities, by what was kept.
    pub(crate) fn kept_rates(&self, kept: &KeptRates, v: &[f64], rate: &mut [f64]) {
        rate.copy_from_slice(&kept.given);
        let mut jacobian = &kept.jacobian[..];
        for c in 0..self.constraints.len() {
            let (rows, own);
            rows = self.rows_of(c);
            (own, jacobian) = jacobian.split_at(rows.len() * self.freedoms_of(c));
            self.add_rate(c, own, v, &mut rate[rows]);
        }
    }

    /// What a constraint relates the velocities and accelerations of its nodes by: its Jacobian, `∂g/∂t` and the bias; zero
    /// where it has let go.
    fn relate(&self, c: usize, at: &At<'_>, jacobian: &mut [f64], given: &mut [f64], bias: &mut [f64]) {
        let (mut g, m) = ([0.0; MOST_ROWS], self.rows_of(c).len());
        let (given, bias) = (&mut given[..m], &mut bias[..m]);
        if self.holds(c, at.internal) {
            self.constraints[c].jacobian(&self.nodes, at, &mut g[..m], jacobian);
            self.constraints[c].rates(&self.nodes, at, given, bias);
        } else {
            jacobian.fill(0.0);
            given.fill(0.0);
            bias.fill(0.0);
        }
    }

    /// Adds `G v` of one constraint.
    fn add_rate(&self, c: usize, jacobian: &[f64], v: &[f64], rate: &mut [f64]) {
        let n = self.freedoms_of(c);
        for (rate, row) in rate.iter_mut().zip(jacobian.chunks_exact(n)) {
            let mut row = row;
            for &k in self.constraints[c].nodes() {
                let (own, rest) = row.split_at(self.node(k).dofs().len());
                *rate += own.iter().zip(&v[self.node(k).dofs()]).map(|(g, v)| g * v).sum::<f64>();
                row = rest;
            }
        }
    }

    /// Velocities of the nodes that a constraint acts on.
    pub(super) fn freedoms_of(&self, c: usize) -> usize {
        self.constraints[c].nodes().iter().map(|&k| self.node(k).kind.velocities()).sum()
    }

    /// `∂g/∂t` and the bias of the acceleration equations, for all rows.
    pub fn rates(&self, at: &At<'_>, rate: &mut [f64], bias: &mut [f64]) {
        for (c, constraint) in self.constraints.iter().enumerate() {
            let rows = self.rows_of(c);
            if self.holds(c, at.internal) {
                constraint.rates(&self.nodes, at, &mut rate[rows.clone()], &mut bias[rows]);
            } else {
                rate[rows.clone()].fill(0.0);
                bias[rows].fill(0.0);
            }
        }
    }
}
