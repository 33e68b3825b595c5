//! The mass matrix that errors of steps are estimated with.
//!
//! Where cable flows, bodies turn or water comes along it changes, and an old one makes a wrong estimate. To assemble it at
//! every step would cost as much as an iteration: it is made anew as often as it changes. Nothing but steps does so: looking
//! at a run between them doesn't change the estimate.

use super::workspace::Workspace;
use crate::model::Model;
use crate::model::state::At;
use crate::solve::linear::SolveError;

/// For how many steps a matrix serves at first, and at most.
const SERVES: [u32; 2] = [8, 512];
/// What a new matrix makes of the estimate, in parts of it, for the next to serve twice as long, and half as long.
const CHANGED: [f64; 2] = [0.02, 0.1];

/// A mass matrix, in the order of [`Structure`](crate::model::structure::Structure).
pub(crate) struct Inertia {
    values: Vec<f64>,
    /// The how manieth it is.
    made: u64,
    /// Steps that it has served, and that it is to serve.
    served: u32,
    serves: u32,
}

impl Default for Inertia {
    fn default() -> Self {
        Inertia { values: Vec::new(), made: 0, served: 0, serves: SERVES[0] }
    }
}

impl Inertia {
    /// Takes a matrix that was just assembled.
    pub fn take(&mut self, values: &[f64]) {
        self.values.clear();
        self.values.extend_from_slice(values);
        self.made += 1;
        self.served = 0;
    }

    /// Its entries; none before the first step.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Which one it is of those that this workspace has had.
    pub fn made(&self) -> u64 {
        self.made
    }

    /// Lets the next step make it anew.
    pub fn outdate(&mut self) {
        self.served = self.serves;
    }

    /// How long the next serves, after one that changed the estimate by this part of it.
    fn changed(&mut self, by: f64) {
        self.serves = match by {
            by if by <= CHANGED[0] => (2 * self.serves).min(SERVES[1]),
            // a NaN too
            by if !(by < CHANGED[1]) => (self.serves / 2).max(1),
            _ => self.serves,
        };
    }
}

impl Workspace {
    /// `M d` in the order of velocities, with a mass matrix that is nearly that of now.
    pub(crate) fn times_inertia(
        &mut self,
        model: &Model,
        at: &At<'_>,
        lambda: &[f64],
        d: &[f64],
        out: &mut [f64],
    ) -> Result<(), SolveError> {
        self.multiply_inertia(model, d, out);
        self.inertia.served += 1;
        if self.inertia.served < self.inertia.serves {
            return Ok(());
        }
        let before = out.to_vec();
        self.assemble_mass(model, at, lambda, 0.0, false)?;
        self.inertia.take(&self.mass.values);
        self.multiply_inertia(model, d, out);
        let (mut off, mut all) = (Vec::new(), Vec::new());
        let mass = &self.mass_diagonal;
        let per = |x: f64, i: usize| if mass[i] > 0.0 { x * x / mass[i] } else { 0.0 };
        self.norms.sums(|i| per(out[i] - before[i], i), &mut off);
        self.norms.sums(|i| per(out[i], i), &mut all);
        let parts = off.iter().zip(&all).filter(|(off, _)| **off != 0.0);
        let by = parts.map(|(off, all)| (off / all).sqrt()).fold(0.0, |m: f64, x| if x <= m { m } else { x });
        self.inertia.changed(by);
        Ok(())
    }

    fn multiply_inertia(&mut self, model: &Model, d: &[f64], out: &mut [f64]) {
        let s = model.structure();
        self.x.fill(0.0);
        s.order(d, &mut self.x);
        s.multiply(&self.inertia.values, &self.x, &mut self.y);
        s.restore(&self.y, out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Start;
    use crate::model::node::{Node, NodeKind};
    use crate::model::pattern::Pattern;
    use crate::model::term::{Assembly, Term};
    use crate::solve::integrator::Which;

    struct Mass;

    impl Term for Mass {
        fn label(&self) -> String {
            "mass".into()
        }
        fn pattern(&self, p: &mut Pattern) {
            p.clique(0..3);
        }
        fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
            (0..3).for_each(|i| out.add(i, 2.0 * at.a[i]));
            let a = out.weights().a;
            out.add_block(0, 3, |r, c| if r == c { 2.0 * a } else { 0.0 });
        }
    }

    /// Factors that were taken serve until the matrix is made anew, and no longer.
    #[test]
    fn a_matrix_is_taken_again_once_it_is_another() {
        let nodes = vec![Node { kind: NodeKind::Point, q: 0, v: 0, shared: false }];
        let start = Start { q: vec![0.0; 3], v: vec![0.0; 3], internal: vec![] };
        let model = Model::new(nodes, vec![Box::new(Mass)], vec![], vec![], start, 1.0);
        let [mut work, mut aside] = [(); 2].map(|()| Workspace::new(&model).expect("scratch"));
        let state = model.state();
        work.ensure_mass(&model, &state.at(), &state.lambda).expect("a mass");
        let mut accelerate = |work: &Workspace| {
            assert!(aside.take_inertia(&model, work).expect("factors"));
            let mut force = [2.0; 3];
            aside.solve(&model, Which::Mass, &mut force).expect("a solution");
            (force[0], aside.counts.factorizations)
        };
        assert_eq!([accelerate(&work), accelerate(&work)], [(1.0, 1); 2]);
        let heavier: Vec<f64> = work.inertia.values().iter().map(|m| 2.0 * m).collect();
        work.inertia.take(&heavier);
        assert_eq!(accelerate(&work), (0.5, 2));
    }
}
