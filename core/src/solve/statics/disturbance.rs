//! What becomes of a small disturbance where loads have no potential: the linearised equations of motion are integrated
//! from it, in the frame of the equilibrium. It sees fast growth at any frequency; slow growth at low frequencies is left
//! to [`super::stability`].

use super::outcome::Judgement;
use super::problem::Statics;
use crate::model::state::{Relaxed, State};
use crate::solve::integrator::{Coefficients, Scheme};
use crate::solve::linear::{Guard, SolveError};
use crate::solve::times::Phase;

/// What becomes of a small disturbance of an equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct Disturbance {
    /// Rate at which it grows in the end [1/s]; negative if it dies out.
    pub rate: f64,
    /// Whether it goes one way only (divergence), instead of to and fro (flutter).
    pub one_way: bool,
    /// Its shape in the end, as an increment.
    pub shape: Vec<f64>,
    /// Whether it grew enough to call the equilibrium unstable.
    pub unstable: bool,
}

/// Steps of the integration, and their number per characteristic time.
const STEPS: usize = 800;
const PER_TIME: f64 = 20.0;
/// Growth over the second half of the steps from which on the equilibrium is unstable.
const GROWTH: f64 = 3.0;
/// What grows by less than this in a characteristic time doesn't count: by a fifth of [`GROWTH`] over the second half of the steps.
const SLOW: f64 = 0.01;
/// How often a swing that the steps resolve changes its sign over the second half of them.
const MOST_TURNS: usize = STEPS / 8;
/// How often the steps are made smaller to resolve a fast growth.
const REFINEMENTS: u32 = 12;

impl Statics<'_> {
    /// Follows a small disturbance of the equilibrium in `state` for a few tens of its characteristic time
    /// `√(m L / F)`, with `M ẍ + (C + 2 M W) ẋ + (K + C W + M W²) x + Gᵀλ = 0`, `G x = 0` in the frame of the
    /// search. An unstable equilibrium isn't wrong, but it will not be seen: a limp hose whose tension is below
    /// `m U²` flutters behind its ship.
    ///
    /// # Errors
    /// The matrices can't be factored.
    pub fn disturb(&mut self, state: &State) -> Result<Disturbance, SolveError> {
        let load = self.load(state);
        self.disturb_under(state, load)
    }

    fn disturb_under(&mut self, state: &State, load: f64) -> Result<Disturbance, SolveError> {
        let model = self.model;
        if load <= f64::MIN_POSITIVE {
            // nothing pulls, so nothing can tip over; there is no characteristic time either
            let shape = vec![0.0; model.velocities()];
            return Ok(Disturbance { rate: 0.0, one_way: false, shape, unstable: false });
        }
        self.assemble(state, &state.q, &state.lambda, Some(Relaxed::to_judge()), true);
        let time = self.time(load);
        let mut h = time / PER_TIME;
        let begin = self.clocks.start();
        let (mut found, mut turns) = self.integrate(h, time)?;
        for _ in 0..REFINEMENTS {
            // a growth that the steps don't resolve changes sign at each of them, and looks slow where it is very fast
            if !found.unstable || turns <= MOST_TURNS && found.rate * h < 0.3 {
                break;
            }
            h *= 0.25;
            (found, turns) = self.integrate(h, time)?;
        }
        self.clocks.stop(Phase::Stability, begin);
        Ok(found)
    }

    /// A characteristic time `√(m L / F)` [s], with the assembled mass.
    fn time(&self, load: f64) -> f64 {
        let s = &self.structure;
        let (mut x, mut y) = (vec![0.0; s.n], vec![0.0; s.n]);
        for node in self.model.nodes().iter().filter(|n| n.kind.has_position()) {
            x[s.position[node.v]] = 1.0;
        }
        s.multiply(&self.mass.values, &x, &mut y);
        let mass: f64 = x.iter().zip(&y).map(|(x, y)| x * y).sum();
        (mass * self.model.length() / load).sqrt()
    }

    /// The growth of a small disturbance about an equilibrium that was judged, where it can grow: forces may have no potential
    /// there, or come with velocities. `None` if it doesn't. `load` is that where the search began: springs take it up.
    pub(super) fn grows(
        &mut self,
        there: &State,
        judged: &Judgement,
        load: f64,
    ) -> Result<Option<Disturbance>, SolveError> {
        if !self.options.stable || self.structure.symmetric {
            return Ok(None);
        }
        let load = self.load(there).max(load);
        if judged.is_least() && self.brings_no_energy(there, load) {
            return Ok(None);
        }
        let d = self.disturb_under(there, load)?;
        Ok(d.unstable.then_some(d))
    }

    /// Whether the forces of velocities bring no energy that counts, as damping and a frame that turns: then nothing grows about
    /// an equilibrium whose potential is least there, since `ẋᵀM ẋ + xᵀK x` doesn't (Thomson and Tait, Chetaev).
    fn brings_no_energy(&mut self, state: &State, load: f64) -> bool {
        if load <= f64::MIN_POSITIVE {
            return true;
        }
        self.assemble(state, &state.q, &state.lambda, None, true);
        let slow = SLOW / self.time(load);
        let s = &self.structure;
        let (damping, mass) = (&self.damping.values, &self.mass.values);
        let mut values = self.system.values.clone();
        for (r, columns, at) in s.rows().filter(|(r, ..)| !s.is_multiplier[*r]) {
            for (k, p) in at.enumerate().filter(|(k, _)| !s.is_multiplier[columns.get(*k)]) {
                values[p] = 0.5 * (damping[p] + s.entry(damping, columns.get(k), r)) + slow * mass[p];
            }
        }
        let factored = self.solver.factor(s, &values).is_ok();
        factored && self.solver.negative_pivots() == Some(self.held(state))
    }

    /// `(1-αm)/(1-αf) M + γ h C + β h² K`, with the constraints as they are.
    fn iteration_matrix(&self, c: &Coefficients, h: f64) -> Vec<f64> {
        let mut values = vec![0.0; self.structure.entries()];
        for (r, columns, at) in self.structure.rows() {
            for (i, p) in at.enumerate() {
                let (k, d, m) = (self.system.values[p], self.damping.values[p], self.mass.values[p]);
                let constrains =
                    self.structure.is_multiplier[r] || self.structure.is_multiplier[columns.get(i)];
                values[p] = if constrains { k } else { c.beta * h * h * k + c.gamma * h * d + c.mass() * m };
            }
        }
        if let Some(softening) = &self.softening {
            softening.apply(&mut values);
        }
        values
    }

    /// `K`, `C` and `M` for vectors without multipliers; constraints, which stand in all three, hold for positions, as corrections
    /// of accelerations.
    fn matrices(&self, c: &Coefficients, h: f64) -> [Vec<f64>; 3] {
        let s = &self.structure;
        let mut all = [&self.system, &self.damping, &self.mass].map(|m| m.values.clone());
        for (r, columns, at) in s.rows() {
            let constrains = |k: usize| s.is_multiplier[r] || s.is_multiplier[columns.get(k)];
            for (_, p) in at.enumerate().filter(|(k, _)| constrains(*k)) {
                all[0][p] /= c.beta * h * h;
                all[1][p] = 0.0;
                all[2][p] = 0.0;
            }
        }
        all
    }

    /// Velocities of a disturbance that holds everything, and respects the constraints.
    fn push(&self, solver: &mut Guard, values: &[f64]) -> Result<Vec<f64>, SolveError> {
        let s = &self.structure;
        let v: Vec<f64> = (0..s.n).map(|p| if s.is_multiplier[p] { 0.0 } else { noise(p) }).collect();
        let mut y = vec![0.0; s.n];
        s.multiply(&self.mass.values, &v, &mut y);
        zero_rows(s, &mut y);
        solver.solve(s, values, &mut y)?;
        zero_rows(s, &mut y);
        Ok(y)
    }

    /// Integrates with `STEPS` steps of `h`; `time` weighs velocities against positions. Tells too how often it changed its sign
    /// over the second half of them.
    fn integrate(&self, h: f64, time: f64) -> Result<(Disturbance, usize), SolveError> {
        let (n, nv) = (self.structure.n, self.model.velocities());
        let c = Scheme::GeneralizedAlpha { rho_inf: 0.9 }.coefficients().unwrap_or_else(|_| unreachable!());
        let values = self.iteration_matrix(&c, h);
        let mut solver = Guard::new(&self.structure)?;
        solver.factor(&self.structure, &values)?;
        let mut v = self.push(&mut solver, &values)?;

        let (mut x, mut a, mut vd) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        let [stiffness, damping, mass] = self.matrices(&c, h);
        let (mut p, mut pv, mut pa, mut r) = (vec![0.0; n], vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        let size = |x: &[f64], v: &[f64]| {
            x.iter().zip(v).map(|(x, v)| x * x + time * time * v * v).sum::<f64>().sqrt()
        };
        let (mut middle, mut turns, mut scaled) = (0.0, 0, 0.0);
        let mut before = x.clone();
        for step in 0..STEPS {
            for i in 0..n {
                p[i] = x[i] + h * v[i] + h * h * (0.5 - c.beta) * a[i];
                pv[i] = v[i] + h * (1.0 - c.gamma) * a[i];
                pa[i] = (c.alpha_m * a[i] - c.alpha_f * vd[i]) / (1.0 - c.alpha_f);
            }
            r.fill(0.0);
            for (matrix, x) in [(&stiffness, &p), (&damping, &pv), (&mass, &pa)] {
                self.structure.add_product(matrix, x, &mut r);
            }
            r.iter_mut().for_each(|r| *r = -*r);
            solver.solve(&self.structure, &values, &mut r)?;
            zero_rows(&self.structure, &mut r);
            for i in 0..n {
                x[i] = p[i] + h * h * c.beta * r[i];
                v[i] = pv[i] + h * c.gamma * r[i];
                vd[i] = pa[i] + c.mass() * r[i];
            }
            std::mem::swap(&mut a, &mut r);
            let now = size(&x, &v);
            if now > 1e6 {
                // linear: only the shape and the logarithm of the size matter
                for y in [&mut x, &mut v, &mut a, &mut vd, &mut before] {
                    y.iter_mut().for_each(|y| *y /= now);
                }
                scaled += now.ln();
            }
            if step + 1 == STEPS / 2 {
                middle = size(&x, &v).ln() + scaled;
                before.copy_from_slice(&x);
            } else if step > STEPS / 2 && x.iter().zip(&before).map(|(x, b)| x * b).sum::<f64>() < 0.0 {
                turns += 1;
                before.copy_from_slice(&x);
            }
        }
        let growth = size(&x, &v).ln() + scaled - middle;
        let shape = (0..nv).map(|i| x[self.structure.position[i]]).collect();
        let rate = growth / (h * (STEPS / 2) as f64);
        Ok((Disturbance { rate, one_way: turns == 0, shape, unstable: growth > GROWTH.ln() }, turns))
    }
}

fn zero_rows(s: &crate::model::structure::Structure, x: &mut [f64]) {
    for (x, &multiplier) in x.iter_mut().zip(&s.is_multiplier) {
        if multiplier {
            *x = 0.0;
        }
    }
}

/// Numbers between -1 and 1 without a pattern.
fn noise(k: usize) -> f64 {
    let x = (k as f64 * 12.9898).sin() * 43_758.545;
    2.0 * (x - x.floor()) - 1.0
}
