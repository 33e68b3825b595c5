//! The search itself: relaxed Newton iterations, and what is done about unstable equilibria.

use super::outcome::{Found, StaticsError};
use super::problem::Statics;
use crate::algebra::lane::V3;
use crate::algebra::noise::Noise;
use crate::model::Model;
use crate::model::node::retract;
use crate::model::state::{At, Relaxation, Relaxed, State};
use crate::solve::times::Phase;

/// Cosine between neighbouring chords below which a cable counts as folded.
pub(super) const FOLD: f64 = 0.5;

/// How often an equilibrium is found anew since other things are near each other there.
const RECOUPLED: u32 = 50;
/// How often a correction is halved that leads through something.
const HALVED: u32 = 30;

/// Corrections, in parts of their tolerance, that may be left where rounding allows no less.
const ROUNDED: f64 = 1e3;

/// Where a search stands.
struct Iterate {
    q: Vec<f64>,
    lambda: Vec<f64>,
    next: Vec<f64>,
    how: Relaxation,
    /// Least tension for the geometric stiffness where the tangent is no good without [N].
    floor: f64,
    /// The last correction, its size, and its ratio to the one before.
    last: Option<Vec<f64>>,
    size: Option<f64>,
    theta: f64,
    /// Whether tangents that aren't positive are no good.
    careful: bool,
}

impl Iterate {
    fn new(state: &State, cold: bool, careful: bool, load: f64) -> Self {
        let mut how = Relaxation::check(false, load);
        if cold {
            how.ramp = 1.0;
        }
        let (q, lambda, next) = (state.q.clone(), state.lambda.clone(), state.q.clone());
        Iterate { q, lambda, next, how, floor: 0.5 * load, last: None, size: None, theta: 1.0, careful }
    }

    /// Moves on without corrections from before.
    fn push(&mut self, model: &Model, d: &[f64]) {
        self.move_by(model, d);
        (self.last, self.size, self.theta) = (None, None, 1.0);
    }

    fn move_by(&mut self, model: &Model, d: &[f64]) {
        retract(model.nodes(), &self.q, d, &mut self.next);
        std::mem::swap(&mut self.q, &mut self.next);
    }
}

/// What is made of an iterate that may be the equilibrium.
enum Verdict {
    Found(Box<State>),
    /// It is unstable, and left in this direction.
    Leave(Vec<f64>),
    /// It isn't close enough yet.
    GoOn,
}

impl Statics<'_> {
    /// Newton's method from `state`. Unstable equilibria are left by a push if `leave` says so, else found as they are:
    /// then [`Statics::unstable`] isn't zero.
    pub(super) fn search(
        &mut self,
        state: &mut State,
        cold: bool,
        careful: bool,
        leave: bool,
    ) -> Result<Found, StaticsError> {
        let mut sum = self.search_once(state, cold, careful, leave)?;
        for _ in 0..RECOUPLED {
            let more = self.cover(&state.at()).map_err(|e| self.fail(state, &e.to_string(), 0))?;
            if !more {
                return Ok(sum);
            }
            sum.add(&self.search_once(state, false, careful, leave)?);
        }
        Err(self.fail(state, "what touches what changes again and again", sum.iterations))
    }

    fn search_once(
        &mut self,
        state: &mut State,
        cold: bool,
        careful: bool,
        leave: bool,
    ) -> Result<Found, StaticsError> {
        let load = self.load(state);
        let mut found = Found::default();
        let mut it = Iterate::new(state, cold, careful, load);
        self.unstable = 0;
        self.neutral.clear();
        self.doubt = None;
        while found.iterations < self.options.max_iterations {
            if self.is_over() {
                return Err(self.fail(state, "it was stopped", found.iterations));
            }
            found.iterations += 1;
            let there = At { q: &it.q, ..state.at() };
            self.cover(&there).map_err(|e| self.fail(state, &e.to_string(), found.iterations))?;
            let verdict = match self.correct(state, &mut it, &mut found) {
                Ok(true) => self.examine(state, &it, &mut found, load, [cold, leave]),
                Ok(false) => Ok(Verdict::GoOn),
                Err(why) => Err(why),
            };
            match verdict {
                Ok(Verdict::Found(there)) => {
                    *state = *there;
                    return Ok(found);
                }
                Ok(Verdict::Leave(_)) if found.pushes >= 3 => {
                    return Err(self.fail(state, "only unstable equilibria were met", found.iterations));
                }
                Ok(Verdict::Leave(push)) => {
                    found.pushes += 1;
                    it.careful = true;
                    it.push(self.model, &push);
                }
                Ok(Verdict::GoOn) => {}
                Err(why) => return Err(self.fail(state, &why, found.iterations)),
            }
        }
        Err(self.fail(state, "the iterations did not converge", found.iterations))
    }

    /// One correction; whether it may be the last. The error says why there is none.
    fn correct(&mut self, state: &State, it: &mut Iterate, found: &mut Found) -> Result<bool, String> {
        it.how.smooth = it.last.is_some();
        let mut relaxed = Relaxed { last: it.last.as_deref(), how: it.how };
        let bare = if it.careful && self.options.stable {
            self.newton_if_positive(state, &it.q, &it.lambda, relaxed)
        } else {
            self.newton(state, &it.q, &it.lambda, relaxed).ok()
        };
        let far = |d: &Vec<f64>| self.position_size(d) > 2.0 * self.model.length();
        let bare = bare.filter(|d| !far(d));
        let bad = bare.is_none();
        let mut d = match bare {
            Some(d) => d,
            None => {
                found.floored += 1;
                relaxed.how.floor = Some(it.floor);
                it.floor *= 0.8;
                self.newton(state, &it.q, &it.lambda, relaxed).map_err(|e| e.to_string())?
            }
        };
        let multipliers = d.split_off(self.model.velocities());
        let size = self.size(&d);
        if !size.is_finite() {
            return Err("the iteration left the finite numbers".into());
        }
        for _ in 0..HALVED {
            if self.model.flips(&it.q, &d).is_none() {
                break;
            }
            d.iter_mut().for_each(|d| *d *= 0.5);
        }
        let cut = self.stop_short(state, &it.q, &mut d);
        it.move_by(self.model, &d);
        for (l, m) in it.lambda.iter_mut().zip(&multipliers) {
            *l += m;
        }
        if let Some(before) = it.size {
            it.theta = if before > 0.0 { f64::min(size / before, 1.0) } else { 0.0 };
        }
        let ramping = it.how.ramp.is_finite() && self.ramp_binds(state, &it.q, &it.lambda, it.how);
        it.how.ramp_before = it.how.ramp;
        it.how.ramp = if ramping { it.how.ramp * 100.0 } else { f64::INFINITY };
        it.size = Some(size);
        let tolerance = self.options.tolerance;
        let falls = !bad && found.iterations >= 2 && size * it.theta <= tolerance;
        let done = size <= tolerance || falls || !bad && self.wanders(found.iterations, size, it.theta);
        it.last = Some(d);
        Ok(done && !ramping && !cut)
    }

    /// Shortens a correction that would carry something through what it only couples with where they are near; whether it
    /// did.
    fn stop_short(&self, state: &State, from: &[f64], d: &mut [f64]) -> bool {
        if !self.model.recouples() {
            return false;
        }
        let mut to = from.to_vec();
        let mut cut = false;
        for _ in 0..HALVED {
            retract(self.model.nodes(), from, d, &mut to);
            let at = state.at();
            if self.model.coupled_passes(&At { q: from, ..at }, &At { q: &to, ..at }).is_none() {
                break;
            }
            cut = true;
            d.iter_mut().for_each(|d| *d *= 0.5);
        }
        cut
    }

    /// Whether no more than rounding is left of an iteration, by its correction.
    pub(super) fn is_there(&self, correction: &[f64]) -> bool {
        self.size(&correction[..self.model.velocities()]) <= ROUNDED * self.options.tolerance
    }

    /// What is accepted is checked at the point itself: its residual, and whether it is stable.
    fn examine(
        &mut self,
        state: &State,
        it: &Iterate,
        found: &mut Found,
        load: f64,
        [cold, leave]: [bool; 2],
    ) -> Result<Verdict, String> {
        let mut there = state.clone();
        (there.q, there.lambda) = (it.q.clone(), it.lambda.clone());
        let begin = self.clocks.start();
        // what is folded isn't an answer whether it is stable or not, and is unfolded by who asked to leave what is unstable
        let folded = self.options.stable && leave && self.unfolded(&mut there.q.clone()).is_some();
        let judged = if self.options.stable && !folded {
            self.judge(&there, it.last.as_deref(), load, found.pushes + 1)
        } else {
            self.check(&there, it.last.as_deref(), load)
        };
        self.clocks.stop(Phase::Stability, begin);
        let mut judged = judged.map_err(|e| e.to_string())?;
        if folded {
            judged.potential = self.judged.potential;
        }
        if let Some(what) = &judged.driven {
            return Err(format!("the load drives what nothing holds: {what}"));
        }
        found.residual = judged.residual;
        if leave && judged.unstable > 0 {
            let out = judged.way_out.take();
            return Ok(out.map_or(Verdict::GoOn, |d| Verdict::Leave(self.small(d))));
        }
        if !self.is_there(&judged.correction) {
            return Ok(Verdict::GoOn);
        }
        self.follow_frame(&it.q);
        there.v.clone_from(&self.v);
        there.a.clone_from(&self.a);
        there.aux.clone_from(&self.a);
        found.flutter = judged.flutter;
        if cold
            && !folded
            && let Some(d) = self.grows(&there, &judged, load).map_err(|e| e.to_string())?
        {
            // about a least potential it is velocities that feed it, and no other equilibrium is that way
            if d.one_way && !judged.is_least() {
                return Ok(Verdict::Leave(self.small(d.shape)));
            }
            found.flutter = found.flutter.max(d.rate);
        }
        self.unstable = judged.unstable;
        self.neutral = std::mem::take(&mut judged.neutral);
        self.doubt = judged.doubt.take();
        judged.of = Some((there.t, there.q.clone()));
        self.judged = judged;
        Ok(Verdict::Found(Box::new(there)))
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
        let mut noise = Noise::new(seed);
        let mut x: Vec<f64> = (0..s.n).map(|_| noise.draw()).collect();
        x.iter_mut().zip(&s.is_multiplier).filter(|(_, m)| **m).for_each(|(x, _)| *x = 0.0);
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
            let Some(line) = part.line() else { continue };
            let mesh = line.mesh_now(&state.at());
            let points: Vec<V3<f64>> =
                mesh.iter().filter_map(|&s| part.point(s, &state.at()).map(|p| p.0)).collect();
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
