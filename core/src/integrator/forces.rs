//! The forces at work in each part, by which Newton's method judges what is left of the equations of motion.
//!
//! A residual is small if it is small beside the tension, the reactions and the inertia of the part that it is left in:
//! positions alone don't tell, since a stiff cable makes `EA/l` of force of every metre that they are off.

use super::norm::Norms;
use crate::constraint::RowKind;
use crate::model::Model;
use crate::part::Quantity;
use crate::state::State;

/// What forces are compared with, group by group.
#[derive(Clone, Debug, Default)]
pub(crate) struct Forces {
    /// Tension at the start of the step, or most of what forces were before [N].
    present: Vec<f64>,
    /// What rounding leaves of forces with the present matrix [N].
    rounding: Vec<f64>,
    /// For every multiplier what turns it into a force, and the groups that it acts on.
    rows: Vec<(f64, Vec<usize>)>,
    /// The cables, by number of part: tension is looked at in these places.
    cables: Vec<(usize, Vec<f64>)>,
    /// Sums over the groups: of squares of the residual, of those of inertia; and the largest multipliers.
    residual: Vec<f64>,
    inertia: Vec<f64>,
    reaction: Vec<f64>,
}

/// In how many places tension is looked at.
const PLACES: usize = 9;
/// What is kept of the largest force from one step to the next: forces that pass through zero are no reason to iterate.
const MEMORY: f64 = 0.9;
/// Residuals below so many units of rounding wander instead of falling.
const NOISE: f64 = 30.0;

impl Forces {
    pub fn new(model: &Model, norms: &Norms) -> Self {
        let mut rows = Vec::new();
        for c in model.constraints() {
            let mut on: Vec<usize> = c.nodes().iter().map(|&k| norms.of(model.node(k).v)).collect();
            on.sort_unstable();
            on.dedup();
            // the multiplier of a direction is a moment
            let arm = on.iter().map(|&g| norms.groups[g].size).fold(0.0, f64::max);
            rows.extend(c.rows().iter().map(|kind| match kind {
                RowKind::Position => (1.0, on.clone()),
                RowKind::Direction => (1.0 / arm, on.clone()),
            }));
        }
        let cables = model.parts().iter().enumerate().filter(|(_, p)| p.slender().is_some());
        let cables = cables.map(|(k, p)| {
            let (mesh, last) = (p.mesh(), (p.mesh().len() - 1) as f64);
            let place = |i: usize| mesh[(last * i as f64 / (PLACES - 1) as f64).round() as usize];
            let mut places: Vec<f64> = (0..PLACES).map(place).collect();
            places.dedup();
            (k, places)
        });
        let none = vec![0.0; norms.groups.len()];
        Forces {
            present: none.clone(),
            rounding: none.clone(),
            rows,
            cables: cables.collect(),
            residual: none.clone(),
            inertia: none.clone(),
            reaction: none,
        }
    }

    /// Looks at the forces at the start of a step.
    pub fn look(&mut self, model: &Model, state: &State) {
        self.present.fill(0.0);
        for (p, m) in self.present.iter_mut().zip(&state.control.forces) {
            *p = MEMORY * m;
        }
        for (k, places) in &self.cables {
            for &s in places {
                let tension = model.parts()[*k].observe(Quantity::Tension, s, &state.at()).unwrap_or(0.0);
                self.present[*k] = self.present[*k].max(tension.abs());
            }
        }
    }

    /// Notes what rounding of positions makes of forces, with the diagonal of an iteration matrix over `β h²`.
    pub fn round(&mut self, norms: &Norms, stiffness: impl Fn(usize) -> f64) {
        let u = 0.5 * f64::EPSILON;
        norms.sums(
            |i| {
                let group = &norms.groups[norms.of(i)];
                // slopes and rotations are of the size of one, and act by an arm
                let off = if norms.arm[i] == 1.0 { group.rounding * group.length } else { u * norms.arm[i] };
                (stiffness(i).max(0.0) * off).powi(2)
            },
            &mut self.rounding,
        );
        self.rounding.iter_mut().for_each(|r| *r = NOISE * r.sqrt());
    }

    /// The residual over `tolerance` times the forces at work, in the part where that is largest; at accelerations `a` and
    /// multipliers `lambda`. Below one it is small enough.
    pub fn ratio(
        &mut self,
        norms: &Norms,
        residual: &[f64],
        a: &[f64],
        lambda: &[f64],
        tolerance: f64,
    ) -> f64 {
        norms.sums(|i| (norms.arm[i] * residual[i]).powi(2), &mut self.residual);
        norms.sums(|i| (norms.mass[i] * a[i]).powi(2), &mut self.inertia);
        self.reaction.fill(0.0);
        for ((scale, on), l) in self.rows.iter().zip(lambda) {
            for &g in on {
                self.reaction[g] = self.reaction[g].max((scale * l).abs());
            }
        }
        let mut worst = 0.0;
        for g in 0..self.residual.len() {
            let limit = tolerance * self.at_work(g) + self.rounding[g];
            let ratio = self.residual[g].sqrt() / limit.max(f64::MIN_POSITIVE);
            // max() would swallow a NaN
            if !(ratio <= worst) {
                worst = ratio;
            }
        }
        worst
    }

    /// The largest force in a group as of the last [`Forces::ratio`] [N].
    fn at_work(&self, g: usize) -> f64 {
        self.present[g].max(self.inertia[g].sqrt()).max(self.reaction[g])
    }

    /// Remembers the forces of an accepted step.
    pub fn keep(&self, memory: &mut Vec<f64>) {
        memory.clear();
        memory.extend((0..self.present.len()).map(|g| self.at_work(g)));
    }
}
