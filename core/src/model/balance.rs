//! What a model balances: forces of single terms and constraints, energy and power.

use crate::model::Model;
use crate::model::constraint::MOST_ROWS;
use crate::model::node::NodeId;
use crate::model::state::At;
use crate::model::term::{Assembly, Energy, Power, Term, Weights};

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
        let mut p = Power::default();
        for t in &self.terms {
            p += t.power(at);
        }
        let holding = self.constraints.iter().enumerate().filter(|(c, _)| self.holds(*c, at.internal));
        for (c, constraint) in holding {
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
