//! What two states of a model differ by.

use crate::model::node::{Node, difference, retract};
use crate::model::state::State;

/// What two states differ by.
pub(super) struct Difference {
    pub q: Vec<f64>,
    /// Of velocities, accelerations, what the scheme keeps beside them, and multipliers.
    rates: [Vec<f64>; 4],
}

impl Difference {
    pub fn between(nodes: &[Node], a: &State, b: &State) -> Self {
        let mut q = vec![0.0; a.v.len()];
        difference(nodes, &a.q, &b.q, &mut q);
        let less = |a: &[f64], b: &[f64]| b.iter().zip(a).map(|(b, a)| b - a).collect();
        let rates = [less(&a.v, &b.v), less(&a.a, &b.a), less(&a.aux, &b.aux), less(&a.lambda, &b.lambda)];
        Difference { q, rates }
    }

    /// Makes the second state differ from the first by so many times this.
    pub fn put(&self, nodes: &[Node], factor: f64, a: &State, b: &mut State) {
        let scaled: Vec<f64> = self.q.iter().map(|d| factor * d).collect();
        retract(nodes, &a.q, &scaled, &mut b.q);
        let pairs = [(&a.v, &mut b.v), (&a.a, &mut b.a), (&a.aux, &mut b.aux), (&a.lambda, &mut b.lambda)];
        for ((a, b), d) in pairs.into_iter().zip(&self.rates) {
            b.iter_mut().zip(a).zip(d).for_each(|((b, a), d)| *b = a + factor * d);
        }
    }
}
