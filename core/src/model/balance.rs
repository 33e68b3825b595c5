//! What a model balances: forces of single terms and constraints, energy and power.

use crate::algebra::lane::{V3, dot};
use crate::model::Model;
use crate::model::constraint::{MOST_ROWS, RowKind};
use crate::model::marker::frame;
use crate::model::node::NodeId;
use crate::model::part::Part;
use crate::model::state::At;
use crate::model::term::{Assembly, Energy, Power, Term, Weights};
use std::collections::BTreeMap;
use std::ops::RangeInclusive;

impl Model {
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
        let mut p = self.supplied(at, lambda);
        for t in &self.terms {
            p += t.power(at);
        }
        p
    }

    /// Both of these, as every step of a run needs them.
    pub fn balance(&self, at: &At<'_>, lambda: &[f64]) -> (Energy, Power) {
        let (mut e, mut p) = (Energy::default(), self.supplied(at, lambda));
        for t in &self.terms {
            let (energy, power) = t.balance(at);
            e += energy;
            p += power;
        }
        (e, p)
    }

    /// What constraints that move with time bring in.
    fn supplied(&self, at: &At<'_>, lambda: &[f64]) -> Power {
        let mut p = Power::default();
        let holding = self.constraints.iter().enumerate().filter(|(c, _)| self.holds(*c, at.internal));
        for (c, constraint) in holding.filter(|(_, constraint)| !constraint.is_steady()) {
            let (mut rate, mut bias) = ([0.0; MOST_ROWS], [0.0; MOST_ROWS]);
            constraint.rates(&self.nodes, at, &mut rate, &mut bias);
            p.supplied += rate.iter().zip(&lambda[self.rows_of(c)]).map(|(r, l)| r * l).sum::<f64>();
        }
        p
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

    /// Axial forces at the ends of the links of a chain [N], one more than there are links: those that its joints carry
    /// along the mean of both links, and at either end that of what holds it there. A free end has what the two joints next
    /// to it continue to: loads are taken to be even there. NaN where nothing is known, and where it isn't `wanted`. None
    /// for any other part.
    pub fn axial_forces(
        &self,
        part: &dyn Part,
        at: &At<'_>,
        lambda: &[f64],
        wanted: RangeInclusive<usize>,
    ) -> Vec<f64> {
        let links = part.links();
        let Some(last) = links.len().checked_sub(1) else { return Vec::new() };
        // an end may be told by the two joints next to it
        let (first, end) = (*wanted.start(), *wanted.end());
        let asked = |k: usize| {
            wanted.contains(&k) || (first == 0 && k <= 2) || (end > last && k + 1 >= last && k <= last)
        };
        let place: BTreeMap<u32, usize> = links.iter().enumerate().map(|(k, node)| (node.0, k)).collect();
        let ahead = |k: usize| {
            let r = frame(&at.q[self.node(links[k]).coords()]);
            [r[0][0], r[1][0], r[2][0]]
        };
        let along = |f: &[f64], d: &V3<f64>| {
            let size = dot(d, d).sqrt();
            (0..3).map(|i| f[i] * d[i] / size).sum::<f64>()
        };
        let mut forces = vec![f64::NAN; links.len() + 1];
        for (c, constraint) in self.constraints.iter().enumerate() {
            if !constraint.rows().contains(&RowKind::Position) || !self.holds(c, at.internal) {
                continue;
            }
            let on = |node: &NodeId| place.get(&node.0).copied();
            let own: Vec<usize> = constraint.nodes().iter().filter_map(on).collect();
            let pull = |k: usize, d: &V3<f64>| along(&self.reaction(c, links[k], at, lambda), d);
            match *own.as_slice() {
                // the joint pulls the second of them back
                [a, b] if a.abs_diff(b) == 1 && asked(a.max(b)) => {
                    let k = a.max(b);
                    let (d, e) = (ahead(k - 1), ahead(k));
                    forces[k] = -pull(k, &std::array::from_fn(|i| d[i] + e[i]));
                }
                [0] if last > 0 && asked(0) => forces[0] = or_zero(forces[0]) - pull(0, &ahead(0)),
                [k] if k == last && last > 0 && asked(k + 1) => {
                    forces[k + 1] = or_zero(forces[k + 1]) + pull(k, &ahead(k))
                }
                _ => {}
            }
        }
        if last > 1 {
            for (end, one, two) in [(0, 1, 2), (last + 1, last, last - 1)] {
                if forces[end].is_nan() && asked(end) {
                    forces[end] = 2.0 * forces[one] - forces[two];
                }
            }
        }
        forces
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
}

/// The number, or zero where none is known yet.
fn or_zero(x: f64) -> f64 {
    if x.is_nan() { 0.0 } else { x }
}
