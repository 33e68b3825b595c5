//! Paths of equilibria by their arc length: round bends that no step of the load gets round, up to limit points and
//! bifurcations, where the path is left for a stable one.
//!
//! Positions, multipliers and time are unknown together; the step along the path is prescribed. Tangents of neighbouring
//! points may differ by [`BEND`] at most, else a limit point would be jumped over. Where the count of unstable directions
//! changes or the load turns round, the critical load is located by bisection; the model is then pushed along the
//! direction that has become free and creeps on to where it is stable ([`super::creep`]).
//!
//! Riks (1979), Int. J. Solids Struct. 15, 529; Crisfield (1981), Comput. Struct. 13, 55.

use super::critical::ALONG;
use super::leap::UNEXPLAINED;
use super::outcome::{Critical, Found, Point, StaticsError};
use super::problem::Statics;
use super::stability::MARGIN;
use crate::model::node::{Node, NodeKind, difference, retract};
use crate::model::state::{At, Relaxation, Relaxed, State};
use crate::solve::linear::SolveError;

/// First step, in parts of the reference length and of the whole load.
const FIRST: f64 = 0.01;
/// Longest step, and shortest.
pub(super) const LONGEST: f64 = 0.1;
const SHORTEST: f64 = 1e-8;
/// Step below which any path is straight to rounding, and may bend by any angle.
const STRAIGHT: f64 = 1e-6;
/// Step from which on the tangent is one that the path was come by.
const STEADY: f64 = 1e-3;
/// Step below which paths that it leads between are one.
const MEET: f64 = 1e-7;
/// Least cosine between neighbouring tangents.
const BEND: f64 = 0.98;
/// Most iterations of a step.
const ITERATIONS: u32 = 10;
/// Most steps of a path.
const STEPS: u32 = 5000;

/// Step from which on another path may be what bends this one; most directions in which others may branch off at once.
const BRANCHES: f64 = 1e-5;
const MOST_BRANCHES: usize = 3;
/// What the load may do along such a direction, in parts of what it could.
pub(super) const ACROSS: f64 = 1e-3;
/// The same before a path branches off that is straight but for rounding.
const NO_WORK: f64 = 1e-8;
/// Least share of a turn, squared, that a direction has in which the path turns.
const TURN: f64 = 1e-2;
/// Loads that are the same, where a path branches off and turns round, in parts of the whole.
const SAME: f64 = 1e-4;

/// Directions in which other paths branch off, as they are held: behind those that were held before.
struct Branches {
    before: usize,
    held: usize,
}

/// The way that is to be gone.
#[derive(Clone, Copy)]
pub(super) struct Way {
    pub end: f64,
    /// Scale of time, and its sign on the way.
    pub span: f64,
    pub sign: f64,
}

impl Way {
    pub fn to(end: f64, from: f64, span: f64) -> Self {
        Way { end, span: span.max(f64::MIN_POSITIVE), sign: (end - from).signum() }
    }
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
        let span = self.span.max((end - state.t).abs());
        self.trace_by(state, Way::to(end, state.t, span), LONGEST, found)
    }

    /// The same by steps of this size at most.
    pub(super) fn trace_by(
        &mut self,
        state: &mut State,
        way: Way,
        longest: f64,
        found: &mut Found,
    ) -> Result<(), StaticsError> {
        let end = way.end;
        let lost = |s: &mut Self, state: &State, why: &str| s.fail(state, why, found.iterations);
        let mut here = match self.point(state.clone(), None, way) {
            Ok(p) => p,
            Err(e) => return Err(lost(self, state, &e.to_string())),
        };
        let mut ds = FIRST.min(longest).min((end - state.t).abs() / way.span);
        let mut branches = Branches { before: self.free.len(), held: 0 };
        let (mut come, mut passed) = (here.clone(), Vec::<Critical>::new());
        for _ in 0..STEPS {
            if self.is_over() {
                break;
            }
            self.model.relabel(&mut here.state);
            // beyond the end loads may be others
            let reach = (end - here.state.t) / here.rate;
            if reach > 0.0 && ds >= reach {
                if let Some(at_end) = self.arrive(&here, reach, end, found) {
                    *state = at_end;
                    self.critical.append(&mut passed);
                    return Ok(());
                }
                ds = 0.5 * reach;
            }
            let Some((next, iterations)) = self.step(&here, ds, way) else {
                ds *= 0.5;
                if ds < BRANCHES && self.hold_branches(&mut here, &mut branches, way) {
                    ds = FIRST * BRANCHES.sqrt();
                }
                if ds < SHORTEST {
                    *state = here.state;
                    let why = "the path of equilibria can't be followed any further";
                    return Err(self.fail(state, why, found.iterations));
                }
                continue;
            };
            found.iterations += iterations;
            if next.unstable > 0 || next.rate * way.sign <= 0.0 {
                let critical = match self.locate(&mut here, (&next, ds), &come, way, found) {
                    Some(critical) => critical,
                    // the step had leapt from one path to another, unless these meet here
                    None if ds > MEET => {
                        ds *= 0.25;
                        continue;
                    }
                    None => self.critical_between(&here, &next, &come, way),
                };
                *state = here.state;
                // a path that branched off may turn round at once
                if passed.last().is_none_or(|last| (last.t - critical.t).abs() > SAME * way.span) {
                    passed.push(critical.clone());
                }
                self.critical.append(&mut passed);
                return self.leave(state, &here.slope, &critical, way, found);
            }
            if (next.state.t - end) * way.sign >= 0.0 {
                if let Some(at_end) = self.end_between(&here, &next, end, found) {
                    *state = at_end;
                    self.critical.append(&mut passed);
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
            let turned = ds >= STRAIGHT && self.cosine(&here, &come, way) < BEND;
            if turned && self.has_branched(&here, &come, way) {
                passed.push(self.critical_between(&here, &here, &come, way));
            }
            // little by little a path would turn unseen
            if turned || ds >= STEADY {
                come.clone_from(&here);
            }
            ds = match iterations {
                0..=3 => (1.5 * ds).min(longest),
                4..=5 => ds,
                _ => 0.6 * ds,
            };
        }
        *state = here.state;
        Err(self.fail(state, "the path of equilibria goes on for ever", found.iterations))
    }

    /// Whether a path that has turned since a point has gone over to one that branches off: the way that was come by would go
    /// on, unstable.
    fn has_branched(&mut self, here: &Point, come: &Point, way: Way) -> bool {
        let Some(soft) = self.soft(&come.state, MOST_BRANCHES) else { return false };
        let cosine = self.cosine(here, come, way);
        let turn: Vec<f64> = here.slope.iter().zip(&come.slope).map(|(h, c)| h - cosine * c).collect();
        let mut into = vec![0.0; self.model.velocities()];
        for x in &soft {
            // what moves nothing that has a place takes no part
            let square = self.inner(x, x).max(f64::MIN_POSITIVE);
            let part = self.inner(&turn, x) / square;
            // what the path hardly turns to only lends the load's work to what it does
            if part * part * square > TURN * self.inner(&turn, &turn) {
                into.iter_mut().zip(x).for_each(|(into, x)| *into += part * x);
            }
        }
        self.inner(&into, &into).sqrt() > ALONG * (1.0 - cosine * cosine).max(0.0).sqrt()
            && self.work_along(&into, &come.state, way).is_some_and(|work| work <= NO_WORK)
            && self.would_go_on(come, &into, here, way)
    }

    /// Whether a path would go on, unstable, if it were kept from a direction in which it turned before it came here.
    fn would_go_on(&mut self, come: &Point, into: &[f64], here: &Point, way: Way) -> bool {
        let step =
            self.distance(&come.state.q, &here.state.q).hypot((here.state.t - come.state.t) / way.span);
        let kept = self.free.len();
        let w = self.weights();
        let mut held = vec![0.0; self.structure.n];
        into.iter().zip(&self.structure.position).for_each(|(x, &p)| held[p] = w[p] * x);
        self.free.push(held);
        let on = [FIRST, 2.0 * step].map(|ds| self.step(come, ds, way));
        self.free.truncate(kept);
        on.into_iter().flatten().any(|(on, _)| self.point(on.state, None, way).is_ok_and(|p| p.unstable > 0))
    }

    /// Cosine between the tangents of two points.
    fn cosine(&self, a: &Point, b: &Point, way: Way) -> f64 {
        self.inner(&a.slope, &b.slope) + a.rate * b.rate / way.span.powi(2)
    }

    /// Next to a bifurcation rounding bends the path towards the one that branches off. Holds the softest direction, or one
    /// more, if the load does nothing along it, and takes the tangent anew; `false` if it is no bifurcation.
    fn hold_branches(&mut self, here: &mut Point, branches: &mut Branches, way: Way) -> bool {
        let rate = self.assemble_with_rate(&here.state, None, way);
        let w = self.weights();
        self.shift(&w, MARGIN);
        let more = branches.held + 1;
        if more > MOST_BRANCHES || self.factor().is_err() {
            return false;
        }
        let Ok(lowest) = self.lowest(&w, more) else { return false };
        let across = |x: &Vec<f64>| self.share_of_work(&self.increment(x), &rate) <= ACROSS;
        if !lowest.iter().all(across) {
            return false;
        }
        branches.held = more;
        self.free.truncate(branches.before);
        self.free.extend(lowest.iter().map(|x| self.weighed(&w, x)).collect::<Vec<_>>());
        match self.point(here.state.clone(), None, way) {
            Ok(point) => *here = point,
            Err(_) => return false,
        }
        true
    }

    /// The stable equilibrium at the end of the load, a step `ds` ahead, if it is where the tangent leads.
    fn arrive(&mut self, here: &Point, ds: f64, end: f64, found: &mut Found) -> Option<State> {
        let nv = self.model.velocities();
        let mut there = here.state.clone();
        let move_on: Vec<f64> = here.slope[..nv].iter().map(|x| ds * x).collect();
        retract(self.model.nodes(), &here.state.q, &move_on, &mut there.q);
        there.lambda.iter_mut().zip(&here.slope[nv..]).for_each(|(l, s)| *l += ds * s);
        there.t = end;
        let guess = there.q.clone();
        let more = self.search(&mut there, false, false, false).ok()?;
        found.add(&more);
        let near = self.distance(&guess, &there.q) <= 0.1 * self.inner(&move_on, &move_on).sqrt() + 1e-6;
        let arrived = self.unstable == 0 && near && self.unexplained(&here.state, &there) <= UNEXPLAINED;
        arrived.then_some(there)
    }

    /// The stable equilibrium at the end of the load, which lies between two points of the path: half a step that Newton's
    /// method is sure to close.
    fn end_between(&mut self, here: &Point, next: &Point, end: f64, found: &mut Found) -> Option<State> {
        let part = (end - here.state.t) / (next.state.t - here.state.t);
        let mut at_end = self.between(&here.state, &next.state, part);
        let guess = at_end.q.clone();
        at_end.t = end;
        let more = self.search(&mut at_end, false, false, false).ok()?;
        let near =
            self.distance(&guess, &at_end.q) <= 0.5 * self.distance(&here.state.q, &next.state.q) + 1e-6;
        if self.unstable != 0 || !near {
            return None;
        }
        found.add(&more);
        Some(at_end)
    }

    /// The tangent of the path at an equilibrium, in the direction of `before`, or else of the way.
    pub(super) fn point(
        &mut self,
        state: State,
        before: Option<&Point>,
        way: Way,
    ) -> Result<Point, SolveError> {
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
    pub(super) fn step(&mut self, here: &Point, ds: f64, way: Way) -> Option<(Point, u32)> {
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
            let tolerance = self.options.tolerance;
            if size <= tolerance
                || k > 1 && size * theta.min(1.0) <= tolerance
                || self.wanders(k, size, theta)
            {
                difference(model.nodes(), &here.state.q, &there.q, &mut moved);
                let went =
                    (self.inner(&moved, &moved) + ((there.t - here.state.t) / way.span).powi(2)).sqrt();
                let next = self.point(there, Some(here), way).ok()?;
                let cosine = self.cosine(here, &next, way);
                let [first, last] =
                    [here, &next].map(|p| p.slope.iter().map(|s| went * s).collect::<Vec<_>>());
                let smooth = || cosine >= BEND && self.doubt_of(&moved, [&first, &last]) <= UNEXPLAINED;
                return (went <= 2.5 * ds && (ds < STRAIGHT || smooth())).then_some((next, k));
            }
            before = size;
        }
        None
    }

    /// Residual and tangent at an equilibrium or on the way to one, ready for factorisation; returns how the residual
    /// changes with time.
    pub(super) fn assemble_with_rate(&mut self, state: &State, last: Option<&[f64]>, way: Way) -> Vec<f64> {
        let how = Relaxation::check(last.is_some(), 0.0);
        let relaxed = last.map(|_| Relaxed { last, how });
        self.assemble(state, &state.q, &state.lambda, relaxed, false);
        let dt = 1e-5 * way.span * way.sign;
        let at = At {
            t: state.t + dt,
            q: &state.q,
            v: &self.v,
            a: &self.a,
            internal: &state.internal,
            relaxed: relaxed.map(|r| Relaxed { last: r.last, how: r.how }),
        };
        let mut ahead = std::mem::take(&mut self.ahead);
        self.model.assemble_in(&self.structure, &at, &state.lambda, None, &mut ahead);
        // braced alike: the same Jacobian with the same weight
        ahead.values.clone_from(&self.system.values);
        self.model.add_brace(&self.structure, self.stiffest(), &mut ahead);
        self.prepare();
        let rate = ahead.residual.iter().zip(&self.system.residual).map(|(b, a)| (b - a) / dt).collect();
        self.ahead = ahead;
        rate
    }

    /// Nodes that have a place.
    pub(super) fn places(&self) -> impl Iterator<Item = &Node> {
        self.model.nodes().iter().filter(|n| !matches!(n.kind, NodeKind::Scalars(_)))
    }

    /// Inner product of increments: mean over the nodes, in parts of the reference length; multipliers don't count.
    pub(super) fn inner(&self, a: &[f64], b: &[f64]) -> f64 {
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

    pub(super) fn distance(&self, a: &[f64], b: &[f64]) -> f64 {
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
