//! Paths of equilibria by their arc length: round bends that no step of the load gets round, up to limit points and
//! bifurcations, where the path is left for a stable one.
//!
//! Positions, multipliers and time are unknown together; the step along the path is prescribed. Tangents of neighbouring
//! points may differ by [`BEND`] at most, else a limit point would be jumped over. Where the count of unstable directions
//! changes or the load turns round, the critical load is located by bisection; the model is then pushed along the
//! direction that has become free and creeps on to where it is stable ([`super::creep`]).
//!
//! Riks (1979), Int. J. Solids Struct. 15, 529; Crisfield (1981), Comput. Struct. 13, 55.

use super::neutral::describe;
use super::stability::MARGIN;
use super::{Critical, CriticalKind, Found, Statics, StaticsError};
use crate::node::{Node, NodeKind, difference, retract};
use crate::solver::SolveError;
use crate::state::{At, Relaxation, Relaxed, State};

/// First step, in parts of the reference length and of the whole load.
const FIRST: f64 = 0.01;
/// Longest step, and shortest.
const LONGEST: f64 = 0.1;
const SHORTEST: f64 = 1e-8;
/// Least cosine between neighbouring tangents.
const BEND: f64 = 0.98;
/// Most iterations of a step.
const ITERATIONS: u32 = 10;
/// Most steps of a path.
const STEPS: u32 = 5000;
/// Mean move of a step of the load from which on its tangents are compared, relative to the reference length; and the part
/// of it that they may leave unexplained.
const FAR: f64 = 0.05;
const UNEXPLAINED: f64 = 0.5;
/// How often an interval of the load is halved to locate where eigenvalues cross.
const HALVINGS: u32 = 20;
/// How far behind a critical load the stable path is taken up, in parts of what is left of the way.
const BEHIND: f64 = 0.02;

/// A point of the path.
#[derive(Clone)]
struct Point {
    state: State,
    /// Change of positions and multipliers, and of time, along the path.
    slope: Vec<f64>,
    rate: f64,
    /// Directions that it is unstable in.
    unstable: usize,
}

/// The way that is to be gone.
#[derive(Clone, Copy)]
struct Way {
    end: f64,
    /// Scale of time, and its sign on the way.
    span: f64,
    sign: f64,
}

impl Statics<'_> {
    /// Follows the path from the stable equilibrium in `state` to time `end`, or to the stable path behind the first
    /// critical load.
    ///
    /// # Errors
    /// The path ends where Newton's method does; the state is the last point that was found.
    pub(super) fn trace(
        &mut self,
        state: &mut State,
        end: f64,
        found: &mut Found,
    ) -> Result<(), StaticsError> {
        let way = Way {
            end,
            span: self.span.max((end - state.t).abs()).max(f64::MIN_POSITIVE),
            sign: (end - state.t).signum(),
        };
        let lost = |s: &mut Self, state: &State, why: &str| s.fail(state, why, found.iterations);
        let mut here = match self.point(state.clone(), None, way) {
            Ok(p) => p,
            Err(e) => return Err(lost(self, state, &e.to_string())),
        };
        let mut ds = FIRST.min((end - state.t).abs() / way.span);
        for _ in 0..STEPS {
            let Some((next, iterations)) = self.step(&here, ds, way) else {
                ds *= 0.5;
                if ds < SHORTEST {
                    *state = here.state;
                    let why = "the path of equilibria can't be followed any further";
                    return Err(self.fail(state, why, found.iterations));
                }
                continue;
            };
            found.iterations += iterations;
            if next.unstable > 0 || next.rate * way.sign <= 0.0 {
                let Some(critical) = self.locate(&mut here, &next, ds, way, found) else {
                    // the step had leapt from one path to another
                    ds *= 0.25;
                    if ds < SHORTEST {
                        *state = here.state;
                        return Err(self.fail(state, "paths of equilibria come too close", found.iterations));
                    }
                    continue;
                };
                *state = here.state;
                self.critical.push(critical.clone());
                return self.leave(state, &here.slope, &critical, way, found);
            }
            if (next.state.t - end) * way.sign >= 0.0 {
                // the end lies between: half a step that Newton's method is sure to close
                let part = (end - here.state.t) / (next.state.t - here.state.t);
                let mut at_end = self.between(&here.state, &next.state, part);
                let guess = at_end.clone();
                at_end.t = end;
                let reached = self.search(&mut at_end, false, false, false);
                let apart = self.distance(&guess.q, &at_end.q);
                if let Ok(more) = reached
                    && self.unstable == 0
                    && apart <= 0.5 * self.distance(&here.state.q, &next.state.q) + 1e-6
                {
                    found.add(&more);
                    *state = at_end;
                    return Ok(());
                }
                ds *= 0.25;
                if ds < SHORTEST {
                    *state = here.state;
                    return Err(self.fail(state, "the path of equilibria ends here", found.iterations));
                }
                continue;
            }
            here = next;
            ds = match iterations {
                0..=3 => (1.5 * ds).min(LONGEST),
                4..=5 => ds,
                _ => 0.6 * ds,
            };
        }
        *state = here.state;
        Err(self.fail(state, "the path of equilibria goes on for ever", found.iterations))
    }

    /// Whether a step of the load may have leapt from one path to another: the tangents at both ends don't explain it.
    pub(super) fn leapt(&mut self, from: &State, to: &State) -> bool {
        let nv = self.model.velocities();
        let mut moved = vec![0.0; nv];
        difference(self.model.nodes(), &from.q, &to.q, &mut moved);
        let size = self.inner(&moved, &moved).sqrt();
        if !(self.options.stable && self.judged.potential && size > FAR) {
            return false;
        }
        let dt = to.t - from.t;
        let way = Way { end: to.t, span: self.span.max(dt.abs()), sign: dt.signum() };
        for state in [from, to] {
            let Ok(p) = self.point(state.clone(), None, way) else { return true };
            // half of the trapezoidal rule
            moved.iter_mut().zip(&p.slope).for_each(|(m, s)| *m -= 0.5 * dt * s / p.rate);
        }
        let left = self.inner(&moved, &moved).sqrt();
        !(left <= UNEXPLAINED * size)
    }

    /// Goes the way that a step of the load may have leapt over; where the arc can't be followed the step stands.
    pub(super) fn go_round(
        &mut self,
        from: &State,
        state: &mut State,
        found: &mut Found,
    ) -> Result<(), StaticsError> {
        let (known, mut there) = (self.critical.len(), from.clone());
        let (unstable, neutral, doubt) = (self.unstable, self.neutral.clone(), self.doubt.clone());
        let (judged, free) = (self.judged.clone(), self.free.clone());
        match self.trace(&mut there, state.t, found) {
            Ok(()) => *state = there,
            Err(e) if self.critical.len() > known => return Err(e),
            Err(_) => {
                (self.unstable, self.neutral, self.doubt) = (unstable, neutral, doubt);
                (self.judged, self.free) = (judged, free);
            }
        }
        Ok(())
    }

    /// Locates where eigenvalues cross between two equilibria under loads without potential, by bisection of the load.
    pub(super) fn locate_by_load(&mut self, from: &State, to: &State, found: &mut Found) {
        let kept = (self.unstable, self.neutral.clone(), self.doubt.clone(), self.judged.clone());
        let (mut low, mut high, mut judged) = (from.clone(), to.t, self.judged.clone());
        for _ in 0..HALVINGS {
            let mut middle = low.clone();
            middle.t = 0.5 * (low.t + high);
            let t = middle.t;
            let Ok(more) = self.search(&mut middle, false, false, false) else { break };
            found.add(&more);
            if self.unstable > 0 || self.judged.flutter > 0.0 {
                (high, judged) = (t, self.judged.clone());
            } else {
                low = middle;
            }
        }
        let (kind, shape) = match judged.way_out {
            Some(shape) => (CriticalKind::Bifurcation, shape),
            None => (CriticalKind::Flutter, judged.swing),
        };
        let shape = self.small(shape);
        let state = self.riding(&low);
        self.critical.push(Critical {
            t: 0.5 * (low.t + high),
            kind,
            directions: judged.unstable.max(1),
            what: describe(self.model, &low.q, &shape),
            shape,
            state,
        });
        (self.unstable, self.neutral, self.doubt, self.judged) = kept;
    }

    /// Leaves the last critical point for the stable path behind it.
    pub(super) fn leave_last(
        &mut self,
        state: &mut State,
        end: f64,
        found: &mut Found,
    ) -> Result<(), StaticsError> {
        let Some(critical) = self.critical.last().cloned() else { return Ok(()) };
        *state = critical.state.clone();
        let way = Way { end, span: self.span, sign: (end - state.t).signum() };
        let nowhere = vec![0.0; self.model.velocities()];
        self.leave(state, &nowhere, &critical, way, found)
    }

    /// The tangent of the path at an equilibrium, in the direction of `before`, or else of the way.
    fn point(&mut self, state: State, before: Option<&Point>, way: Way) -> Result<Point, SolveError> {
        let rate = self.assemble_with_rate(&state, None, way);
        let symmetric = self.structure.symmetric || self.is_mirrored();
        let w = self.weights();
        self.shift(&w, MARGIN);
        self.factor()?;
        let held = self.held(&state);
        let negative = self.solver.negative_pivots().map_or(0, |n| n.saturating_sub(held));
        // without a potential pivots tell of an odd number of real eigenvalues at most
        let unstable = if symmetric { negative } else { negative % 2 };
        let rhs: Vec<f64> = rate.iter().map(|r| -r).collect();
        let mut slope = self.solve(&rhs)?;
        let mut rate = 1.0;
        let size = (self.inner(&slope, &slope) + (rate / way.span).powi(2)).sqrt();
        let forward = match before {
            Some(p) => self.inner(&slope, &p.slope) + rate * p.rate / way.span.powi(2),
            None => way.sign,
        };
        let scale = forward.signum() / size;
        slope.iter_mut().for_each(|x| *x *= scale);
        rate *= scale;
        if !(rate.is_finite() && size.is_finite()) {
            return Err(SolveError::NotFinite);
        }
        Ok(Point { state, slope, rate, unstable })
    }

    /// One step along the path: the next point and the iterations that it took; `None` if there is none within reach.
    fn step(&mut self, here: &Point, ds: f64, way: Way) -> Option<(Point, u32)> {
        let (model, nv) = (self.model, self.model.velocities());
        let mut there = here.state.clone();
        let mut last: Vec<f64> = here.slope[..nv].iter().map(|x| ds * x).collect();
        retract(model.nodes(), &here.state.q, &last, &mut there.q);
        there.lambda.iter_mut().zip(&here.slope[nv..]).for_each(|(l, s)| *l += ds * s);
        there.t += ds * here.rate;
        let (mut moved, mut q) = (vec![0.0; nv], there.q.clone());
        let mut before = f64::INFINITY;
        for k in 1..=ITERATIONS {
            let rate = self.assemble_with_rate(&there, Some(&last), way);
            let w = self.weights();
            self.shift(&w, MARGIN);
            self.factor().ok()?;
            let u = self.correction().ok()?;
            let rhs: Vec<f64> = rate.iter().map(|r| -r).collect();
            let b = self.solve(&rhs).ok()?;
            difference(model.nodes(), &here.state.q, &there.q, &mut moved);
            let square = way.span.powi(2);
            let off = self.inner(&here.slope, &moved) + here.rate * (there.t - here.state.t) / square - ds;
            let dt =
                -(off + self.inner(&here.slope, &u)) / (self.inner(&here.slope, &b) + here.rate / square);
            let d: Vec<f64> = u.iter().zip(&b).map(|(u, b)| u + dt * b).collect();
            retract(model.nodes(), &there.q, &d[..nv], &mut q);
            std::mem::swap(&mut there.q, &mut q);
            there.lambda.iter_mut().zip(&d[nv..]).for_each(|(l, d)| *l += d);
            there.t += dt;
            let size = self.size(&d[..nv]).max((dt / way.span).abs());
            if !size.is_finite() || size > 1.0 || (k > 3 && size > 2.0 * before && size > 1e-6) {
                return None;
            }
            let theta = size / before;
            last = d[..nv].to_vec();
            if size <= self.options.tolerance || (k > 1 && size * theta.min(1.0) <= self.options.tolerance) {
                difference(model.nodes(), &here.state.q, &there.q, &mut moved);
                let went =
                    (self.inner(&moved, &moved) + ((there.t - here.state.t) / way.span).powi(2)).sqrt();
                let next = self.point(there, Some(here), way).ok()?;
                let cosine = self.inner(&here.slope, &next.slope) + here.rate * next.rate / way.span.powi(2);
                // what is shorter than this is straight to rounding
                return (went <= 2.5 * ds && (cosine >= BEND || ds < 1e-6)).then_some((next, k));
            }
            before = size;
        }
        None
    }

    /// Locates the critical point between `here` and the point a step further; `here` becomes the last one before it.
    /// `None` if there is none: these are points of different paths.
    fn locate(
        &mut self,
        here: &mut Point,
        beyond: &Point,
        ds: f64,
        way: Way,
        found: &mut Found,
    ) -> Option<Critical> {
        let (mut low, mut high, mut after) = (0.0, ds, beyond.clone());
        let start = here.clone();
        for _ in 0..40 {
            if (after.state.t - here.state.t).abs() <= 1e-10 * way.span && high - low <= 1e-6 * ds.max(1e-3) {
                break;
            }
            let middle = 0.5 * (low + high);
            let (next, iterations) = self.step(&start, middle, way)?;
            found.iterations += iterations;
            if next.unstable > 0 || next.rate * way.sign <= 0.0 {
                (high, after) = (middle, next);
            } else {
                low = middle;
                *here = next;
            }
        }
        if self.distance(&here.state.q, &after.state.q) > 1e-2 * ds {
            return None;
        }
        let limit = after.rate * way.sign <= 0.0;
        let directions = if limit { 1 } else { after.unstable.max(1) };
        let shapes = self.soft(&here.state, directions).unwrap_or_default();
        let shape = match (limit, shapes.is_empty()) {
            (true, _) | (_, true) => self.small(here.slope[..self.model.velocities()].to_vec()),
            (false, false) => self.choose(&shapes),
        };
        Some(Critical {
            t: 0.5 * (here.state.t + after.state.t),
            kind: if limit { CriticalKind::Limit } else { CriticalKind::Bifurcation },
            directions,
            what: describe(self.model, &here.state.q, &shape),
            shape,
            state: self.riding(&here.state),
        })
    }

    /// The softest directions of an equilibrium, as increments of the size of a push.
    fn soft(&mut self, state: &State, count: usize) -> Option<Vec<Vec<f64>>> {
        let load = self.load(state);
        self.count(state, None, load)?;
        let w = self.weights();
        let lowest = self.lowest(&w, count).ok()?;
        Some(lowest.iter().map(|x| self.increment(x)).collect())
    }

    /// Of several directions that all go, one along an axis of space, the first that shows.
    fn choose(&self, shapes: &[Vec<f64>]) -> Vec<f64> {
        if shapes.len() == 1 {
            return shapes[0].clone();
        }
        let parts = |axis: usize| -> Vec<f64> {
            shapes.iter().map(|s| self.places().map(|n| s[n.v + axis]).sum()).collect()
        };
        let size = |p: &Vec<f64>| p.iter().map(|x| x * x).sum::<f64>();
        let all = [parts(0), parts(1), parts(2)];
        let largest = all.iter().map(size).fold(0.0, f64::max);
        let along = all.iter().find(|p| size(p) >= 0.5 * largest).unwrap_or(&all[0]);
        if !(largest > 0.0) {
            return shapes[0].clone();
        }
        let sum = |i: usize| shapes.iter().zip(along).map(|(s, p)| s[i] * p).sum::<f64>();
        self.small((0..self.model.velocities()).map(sum).collect())
    }

    /// Leaves a critical point for the stable path behind it.
    fn leave(
        &mut self,
        state: &mut State,
        slope: &[f64],
        critical: &Critical,
        way: Way,
        found: &mut Found,
    ) -> Result<(), StaticsError> {
        let nv = self.model.velocities();
        let forward = (0..nv).map(|i| slope[i] * critical.shape[i]).sum::<f64>();
        let sign = if critical.kind == CriticalKind::Limit && forward < 0.0 { -1.0 } else { 1.0 };
        let left = way.end - state.t;
        let mut error = None;
        for (part, sign) in [(BEHIND, sign), (1.0, sign), (BEHIND, -sign), (1.0, -sign)] {
            let mut there = state.clone();
            there.t = if part == 1.0 { way.end } else { state.t + part * left };
            let push: Vec<f64> = critical.shape.iter().map(|x| sign * x).collect();
            let before = there.q.clone();
            retract(self.model.nodes(), &before, &push, &mut there.q);
            self.free.clear();
            match self.creep(&mut there, found) {
                Ok(()) => {
                    *state = there;
                    return Ok(());
                }
                Err(e) => error = error.or(Some(e)),
            }
        }
        let t = critical.t;
        let e = error.unwrap_or_else(|| self.fail(state, "", found.iterations));
        Err(StaticsError { why: format!("behind {} at t = {t}, {}", critical.kind, e.why), ..e })
    }

    /// Residual and tangent at an equilibrium or on the way to one, ready for factorisation; returns how the residual
    /// changes with time.
    fn assemble_with_rate(&mut self, state: &State, last: Option<&[f64]>, way: Way) -> Vec<f64> {
        let how = Relaxation {
            smooth: last.is_some(),
            ramp: f64::INFINITY,
            ramp_before: f64::INFINITY,
            load: 0.0,
            floor: None,
        };
        let relaxed = last.map(|_| Relaxed { last, how });
        self.assemble(state, &state.q, &state.lambda, relaxed, false);
        let dt = 1e-5 * way.span * way.sign;
        let at = At {
            t: state.t + dt,
            q: &state.q,
            v: &self.v,
            a: &self.a,
            modes: &state.modes,
            relaxed: relaxed.map(|r| Relaxed { last: r.last, how: r.how }),
        };
        let mut ahead = std::mem::take(&mut self.ahead);
        self.model.assemble_in(&self.structure, &at, &state.lambda, None, &mut ahead);
        // braced alike: the same Jacobian with the same weight
        ahead.values.clone_from(&self.system.values);
        let scale = self.brace_scale();
        self.model.add_brace(&self.structure, scale, &mut ahead);
        self.prepare();
        let rate = ahead.residual.iter().zip(&self.system.residual).map(|(b, a)| (b - a) / dt).collect();
        self.ahead = ahead;
        rate
    }

    /// Nodes that have a place.
    fn places(&self) -> impl Iterator<Item = &Node> {
        self.model.nodes().iter().filter(|n| !matches!(n.kind, NodeKind::Scalars(_)))
    }

    /// Inner product of increments: mean over the nodes, in parts of the reference length; multipliers don't count.
    fn inner(&self, a: &[f64], b: &[f64]) -> f64 {
        let (mut sum, mut count) = (0.0, 0);
        let square = self.model.length().powi(2);
        for n in self.places() {
            count += 1;
            for i in n.v..n.v + 3 {
                sum += a[i] * b[i] / square;
            }
            if n.kind == NodeKind::Frame {
                sum += (n.v + 3..n.v + 6).map(|i| a[i] * b[i]).sum::<f64>();
            }
        }
        sum / f64::from(count.max(1))
    }

    fn distance(&self, a: &[f64], b: &[f64]) -> f64 {
        let mut d = vec![0.0; self.model.velocities()];
        difference(self.model.nodes(), a, b, &mut d);
        self.inner(&d, &d).sqrt()
    }

    /// A state between two.
    fn between(&self, a: &State, b: &State, part: f64) -> State {
        let mut d = vec![0.0; self.model.velocities()];
        difference(self.model.nodes(), &a.q, &b.q, &mut d);
        d.iter_mut().for_each(|d| *d *= part);
        let mut out = a.clone();
        retract(self.model.nodes(), &a.q, &d, &mut out.q);
        out.lambda.iter_mut().zip(&b.lambda).for_each(|(l, b)| *l += part * (b - *l));
        out.t = a.t + part * (b.t - a.t);
        out
    }
}
