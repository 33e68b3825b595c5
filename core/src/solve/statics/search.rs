//! The search itself: relaxed Newton iterations, and what is done about unstable equilibria.

use super::outcome::{Found, StaticsError};
use super::problem::Statics;
use super::tangent::Trial;
use crate::algebra::lane::V3;
use crate::model::node::retract;
use crate::model::state::{Relaxation, State};
use crate::solve::times::Phase;

/// Cosine between neighbouring chords below which a cable counts as folded.
pub(super) const FOLD: f64 = 0.5;

/// Corrections, in parts of their tolerance, that may be left where rounding allows no less.
const ROUNDED: f64 = 1e3;

impl Statics<'_> {
    /// Newton's method from `state`. Unstable equilibria are left by a push if `leave` says so, else found as they are:
    /// then [`Statics::unstable`] isn't zero.
    pub(super) fn search(
        &mut self,
        state: &mut State,
        cold: bool,
        mut careful: bool,
        leave: bool,
    ) -> Result<Found, StaticsError> {
        let (model, nv) = (self.model, self.model.velocities());
        let length = model.length();
        let load = self.load(state);
        let mut found = Found::default();
        let mut how = Relaxation::check(false, load);
        if cold {
            how.ramp = 1.0;
        }
        let mut floor = 0.5 * load;
        let mut last: Option<Vec<f64>> = None;
        let (mut size_before, mut theta) = (None, 1.0);
        self.unstable = 0;
        self.neutral.clear();
        self.doubt = None;
        let fail = |s: &Self, why: &str, found: &Found| Err(s.fail(state, why, found.iterations));
        let mut q = state.q.clone();
        let mut lambda = state.lambda.clone();
        let mut next = q.clone();
        while found.iterations < self.options.max_iterations {
            if self.is_over() {
                return fail(self, "it was stopped", &found);
            }
            found.iterations += 1;
            how.smooth = last.is_some();
            let mut trial = self.newton(state, &q, &lambda, last.as_deref(), how);
            let far = |t: &Trial| self.position_size(&t.d) > 2.0 * length;
            let wrong = |t: &Trial| careful && t.negative && self.options.stable;
            let bad = trial.as_ref().map_or(true, |t| wrong(t) || far(t));
            if bad {
                found.floored += 1;
                trial = self.newton(
                    state,
                    &q,
                    &lambda,
                    last.as_deref(),
                    Relaxation { floor: Some(floor), ..how },
                );
                floor *= 0.8;
            }
            let trial = match trial {
                Ok(t) => t,
                Err(e) => return fail(self, &e.to_string(), &found),
            };
            let mut d = trial.d;
            let multipliers = d.split_off(nv);
            let size = self.size(&d);
            if !size.is_finite() {
                return fail(self, "the iteration left the finite numbers", &found);
            }
            retract(model.nodes(), &q, &d, &mut next);
            std::mem::swap(&mut q, &mut next);
            for (l, m) in lambda.iter_mut().zip(&multipliers) {
                *l += m;
            }
            if let Some(before) = size_before {
                theta = if before > 0.0 { f64::min(size / before, 1.0) } else { 0.0 };
            }
            let ramping = how.ramp.is_finite() && self.ramp_binds(state, &q, &lambda, how);
            how.ramp_before = how.ramp;
            how.ramp = if ramping { how.ramp * 100.0 } else { f64::INFINITY };
            size_before = Some(size);
            let tolerance = self.options.tolerance;
            let falls = !bad && found.iterations >= 2 && size * theta <= tolerance;
            let done = size <= tolerance || falls || !bad && self.wanders(found.iterations, size, theta);
            last = Some(d);
            if ramping || !done {
                continue;
            }
            // what is accepted is checked at the point itself
            let mut there = state.clone();
            (there.q, there.lambda) = (q.clone(), lambda.clone());
            let begin = self.clocks.start();
            let judged = if self.options.stable {
                self.judge(&there, last.as_deref(), load, found.pushes + 1)
            } else {
                self.check(&there, last.as_deref(), load)
            };
            self.clocks.stop(Phase::Stability, begin);
            let mut judged = match judged {
                Ok(judged) => judged,
                Err(e) => return fail(self, &e.to_string(), &found),
            };
            if let Some(what) = &judged.driven {
                return fail(self, &format!("the load drives what nothing holds: {what}"), &found);
            }
            found.residual = judged.residual;
            let mut push = None;
            if leave && judged.unstable > 0 {
                push = judged.way_out.take().map(|d| self.small(d));
            } else if self.size(&judged.correction[..nv]) <= ROUNDED * tolerance {
                self.follow_frame(&q);
                there.v.clone_from(&self.v);
                there.a.clone_from(&self.a);
                there.aux.clone_from(&self.a);
                found.flutter = judged.flutter;
                if cold && self.options.stable && !self.structure.symmetric {
                    match self.disturb(&there) {
                        Ok(d) if d.unstable && d.one_way => push = Some(self.small(d.shape)),
                        Ok(d) if d.unstable => found.flutter = found.flutter.max(d.rate),
                        Ok(_) => {}
                        Err(e) => return fail(self, &e.to_string(), &found),
                    }
                }
                if push.is_none() {
                    self.unstable = judged.unstable;
                    self.neutral = std::mem::take(&mut judged.neutral);
                    self.doubt = judged.doubt.take();
                    self.judged = judged;
                    *state = there;
                    return Ok(found);
                }
            }
            if let Some(push) = push {
                if found.pushes >= 3 {
                    return fail(self, "only unstable equilibria were met", &found);
                }
                found.pushes += 1;
                careful = true;
                retract(model.nodes(), &q, &push, &mut next);
                std::mem::swap(&mut q, &mut next);
                (last, size_before, theta) = (None, None, 1.0);
            }
        }
        fail(self, "the iterations did not converge", &found)
    }

    /// Whether corrections no longer fall, since rounding of stiff forces moves what is soft: next to a critical load.
    pub(super) fn wanders(&self, iterations: u32, size: f64, theta: f64) -> bool {
        iterations > 3 && size <= ROUNDED * self.options.tolerance && theta > 0.25
    }

    /// Why a search gives up, with the equation that is met least.
    pub(super) fn fail(&self, state: &State, why: &str, iterations: u32) -> StaticsError {
        let (k, residual) = self.worst();
        let equation = self.model.unknown_name(k);
        let on_path = self.span > 0.0;
        let interrupted = self.is_over();
        StaticsError { t: state.t, on_path, why: why.into(), iterations, residual, equation, interrupted }
    }

    /// Largest position and slope of an increment, relative to the reference length.
    pub(super) fn size(&self, d: &[f64]) -> f64 {
        let length = self.model.length();
        let mut worst = 0.0;
        for n in self.model.nodes() {
            for (k, x) in d[n.dofs()].iter().enumerate() {
                let x = if k < 3 && n.kind.has_position() { x / length } else { *x };
                // max() would swallow a NaN
                if !x.is_finite() {
                    return f64::INFINITY;
                }
                worst = f64::max(worst, x.abs());
            }
        }
        worst
    }

    pub(super) fn position_size(&self, d: &[f64]) -> f64 {
        let nodes = self.model.nodes().iter();
        nodes
            .filter(|n| n.kind.has_position())
            .flat_map(|n| d[n.v..n.v + n.kind.velocities().min(3)].iter())
            .fold(0.0, |m: f64, x| m.max(x.abs()))
    }

    pub(super) fn worst(&self) -> (usize, f64) {
        let mut worst = (0, 0.0);
        for (i, r) in self.system.residual.iter().enumerate() {
            if !r.is_finite() || r.abs() > worst.1 {
                worst = (i, r.abs());
            }
        }
        worst
    }

    /// The direction in which the last factored tangent resists least, by inverse iteration, as a small increment.
    pub(super) fn softest(&mut self, seed: u32) -> Vec<f64> {
        let (nv, s) = (self.model.velocities(), &self.structure);
        let mut random = 0x2545_F491_4F6C_DD1Du64.wrapping_mul(u64::from(seed) | 1);
        let mut x: Vec<f64> = (0..s.n)
            .map(|p| {
                random ^= random << 13;
                random ^= random >> 7;
                random ^= random << 17;
                if s.is_multiplier[p] { 0.0 } else { (random >> 11) as f64 / (1u64 << 53) as f64 - 0.5 }
            })
            .collect();
        for _ in 0..4 {
            let solved = self.solver.solve(&self.structure, &self.system.values, &mut x);
            if solved.is_err() || self.hold(&mut x, &vec![0.0; self.free.len()]).is_err() {
                break;
            }
            let s = &self.structure;
            let mut largest = 0.0;
            for p in 0..s.n {
                if s.is_multiplier[p] {
                    x[p] = 0.0;
                }
                largest = f64::max(largest, x[p].abs());
            }
            x.iter_mut().for_each(|x| *x /= largest.max(f64::MIN_POSITIVE));
        }
        self.small((0..nv).map(|i| x[self.structure.position[i]]).collect())
    }

    /// A push in a direction: large enough to leave an equilibrium, small enough to stay near.
    pub(super) fn small(&self, mut d: Vec<f64>) -> Vec<f64> {
        let size = self.size(&d).max(f64::MIN_POSITIVE);
        d.iter_mut().for_each(|d| *d *= 0.05 / size);
        d
    }

    /// Smallest cosine between neighbouring chords of any part; 1 if nothing has chords.
    pub(super) fn folded(&self, state: &State) -> f64 {
        let mut least = 1.0;
        for part in self.model.parts() {
            let points: Vec<V3<f64>> =
                part.mesh().iter().filter_map(|&s| part.point(s, &state.at()).map(|p| p.0)).collect();
            for w in points.windows(3) {
                let a: V3<f64> = std::array::from_fn(|i| w[1][i] - w[0][i]);
                let b: V3<f64> = std::array::from_fn(|i| w[2][i] - w[1][i]);
                let dot = |a: V3<f64>, b: V3<f64>| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
                let cosine = dot(a, b) / (dot(a, a) * dot(b, b)).sqrt();
                if !(cosine >= least) {
                    least = if cosine.is_nan() { -1.0 } else { cosine };
                }
            }
        }
        least
    }
}
