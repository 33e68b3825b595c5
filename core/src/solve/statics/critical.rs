//! Loads at which a path of equilibria loses its stability: they are located, and left for the stable path behind them.

use super::naming::describe;
use super::outcome::{Critical, CriticalKind, Found, Judgement, Point, StaticsError};
use super::path::{ACROSS, Way};
use super::problem::Statics;
use crate::model::node::{difference, retract};
use crate::model::state::State;

/// How often an interval of the load is halved to locate where eigenvalues cross.
const HALVINGS: u32 = 20;
/// How many of these leave what crosses clear of rounding.
const CLEAR: u32 = 10;
/// Cosine between the path and the direction that has become free from which on they are one: at a limit of the load.
pub(super) const ALONG: f64 = 0.7;
/// What the load does along a direction, in parts of what it could, and how far the path goes that way, from which on it is
/// driven there.
const DRIVEN: f64 = 1e-2;
/// What is left of the way between two equilibria once their loads are the same to rounding, if they are of different paths.
const LEAP: f64 = 0.1;
/// How far behind a critical load the stable path is taken up, in parts of what is left of the way.
const BEHIND: f64 = 0.02;

/// What lies between a stable equilibrium and an unstable one.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Crossing {
    /// A critical load.
    Here,
    /// Nothing: they are of different paths, between which the iteration has leapt.
    Leapt,
    /// A critical load before, from which on it flutters.
    Swung,
}

impl Statics<'_> {
    /// Locates the critical point between `here` and the point a step further; `here` becomes the last one before it. It was
    /// come by from a point whose tangent counts, since the last ones may be bent by a path that branches off.
    /// `None` if there is none: these are points of different paths.
    pub(super) fn locate(
        &mut self,
        here: &mut Point,
        (beyond, ds): (&Point, f64),
        come: &Point,
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
        Some(self.critical_between(here, &after, come, way))
    }

    /// The critical point between two points of a path that are as good as one.
    pub(super) fn critical_between(
        &mut self,
        here: &Point,
        after: &Point,
        come: &Point,
        way: Way,
    ) -> Critical {
        let directions = after.unstable.max(1);
        let mut shapes = self.soft(&here.state, directions).unwrap_or_default();
        // a path that branches off may turn the load round too, but the load does nothing in its direction
        let limit = after.rate * way.sign <= 0.0
            && shapes.first().is_none_or(|soft| self.is_driven_along(soft, &here.state, come, way));
        let directions = if limit { 1 } else { directions };
        shapes.truncate(directions);
        let shape = match (limit, shapes.is_empty()) {
            (true, _) | (_, true) => self.small(here.slope[..self.model.velocities()].to_vec()),
            (false, false) => self.choose(&shapes),
        };
        Critical {
            t: 0.5 * (here.state.t + after.state.t),
            kind: if limit { CriticalKind::Limit } else { CriticalKind::Bifurcation },
            directions,
            what: describe(self.model, &here.state.q, &shape),
            shape,
            state: self.riding(&here.state),
        }
    }

    /// Whether the load, as it grows, drives the model along a direction. Of what is led by motions the way that was come by
    /// tells.
    fn is_driven_along(&mut self, soft: &[f64], state: &State, come: &Point, way: Way) -> bool {
        let along = self.inner(&come.slope, soft).abs() / self.inner(soft, soft).sqrt();
        match self.work_along(soft, state, way) {
            // what has branched off a little way has some work done along it, but wasn't the way that was come by
            Some(share) => {
                let motion = self.inner(&come.slope, &come.slope).sqrt();
                share > ACROSS && (share > DRIVEN || along > DRIVEN * motion)
            }
            None => along > ALONG,
        }
    }

    /// What the load, as it grows, does along a direction, in parts of what it could; `None` where motions lead the model.
    pub(super) fn work_along(&mut self, soft: &[f64], state: &State, way: Way) -> Option<f64> {
        let rate = self.assemble_with_rate(state, None, way);
        let (loads, motions) = rate.split_at(self.model.velocities());
        if motions.iter().any(|x| *x != 0.0) {
            return None;
        }
        Some(self.share_of_work(soft, loads))
    }

    /// The work of forces along a direction, in parts of what they could do.
    pub(super) fn share_of_work(&self, direction: &[f64], forces: &[f64]) -> f64 {
        let (mut work, mut squares) = (0.0, [0.0; 2]);
        for n in self.model.nodes() {
            for i in n.dofs() {
                // slopes and rotations have no length
                let unit = if i < n.v + 3 && n.kind.has_position() { self.model.length() } else { 1.0 };
                let (d, f) = (direction[i] / unit, forces[i] * unit);
                work += d * f;
                squares = [squares[0] + d * d, squares[1] + f * f];
            }
        }
        work.abs() / (squares[0] * squares[1]).sqrt().max(f64::MIN_POSITIVE)
    }

    /// Locates where eigenvalues cross between two equilibria under loads without potential, by bisection of the load.
    /// What is known of `to` stays as it is.
    pub(super) fn locate_by_load(&mut self, from: &State, to: &State, found: &mut Found) -> Crossing {
        let kept = (self.unstable, self.neutral.clone(), self.doubt.clone(), self.judged.clone());
        let crossing = self.bisect_load(from, to, found);
        (self.unstable, self.neutral, self.doubt, self.judged) = kept;
        crossing
    }

    fn bisect_load(&mut self, from: &State, to: &State, found: &mut Found) -> Crossing {
        let (mut low, mut high, mut judged) = (from.clone(), to.clone(), self.judged.clone());
        let diverges = self.unstable > 0;
        let swings = |j: &Judgement| j.flutter > 0.0 && j.unstable == 0;
        let mut below: Option<Judgement> = self.swung.then(Judgement::default);
        for k in 0..HALVINGS {
            let mut middle = low.clone();
            middle.t = 0.5 * (low.t + high.t);
            let Ok(more) = self.search(&mut middle, false, false, false) else { break };
            found.add(&more);
            // what goes one way is looked for apart from what swings
            if self.unstable > 0 || !diverges && self.judged.flutter > 0.0 {
                high = middle;
                // right beside the crossing rounding chooses what the eigenvalues look like
                if k < CLEAR {
                    judged = self.judged.clone();
                }
            } else {
                below = swings(&self.judged).then(|| self.judged.clone());
                low = middle;
            }
        }
        let (whole, left) = (self.distance(&from.q, &to.q), self.distance(&low.q, &high.q));
        if left > LEAP * whole && left > self.options.tolerance {
            return Crossing::Leapt;
        }
        if let Some(judged) = below.filter(|_| diverges) {
            // a pair that swings ever wider becomes two that go one way: nothing branches off there, and it was lost before
            if !self.swung {
                (self.unstable, self.judged) = (0, judged);
                let _ = self.bisect_load(from, &low, found);
            }
            return Crossing::Swung;
        }
        let (kind, shape) = match judged.way_out {
            Some(shape) => (CriticalKind::Bifurcation, shape),
            None => (CriticalKind::Flutter, judged.swing),
        };
        let shape = self.small(shape);
        let state = self.riding(&low);
        self.critical.push(Critical {
            t: 0.5 * (low.t + high.t),
            kind,
            directions: judged.unstable.max(1),
            what: describe(self.model, &low.q, &shape),
            shape,
            state,
        });
        Crossing::Here
    }

    /// Leaves a critical point for the stable path behind it.
    pub(super) fn leave(
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
            match self.creep(&mut there, found, false) {
                Ok(()) => {
                    *state = there;
                    return Ok(());
                }
                Err(e) => error = error.or(Some(e)),
            }
        }
        let t = critical.t;
        let e = error.unwrap_or_else(|| self.fail(state, "", found.iterations));
        Err(StaticsError { why: format!("behind {} at load factor {t}, {}", critical.kind, e.why), ..e })
    }

    /// The stable equilibrium at the load of an unstable one that the iteration leapt to from a stable path, on the same side.
    pub(super) fn leave_leapt(&mut self, from: &State, to: &State, found: &mut Found) -> Option<State> {
        let (nv, nodes) = (self.model.velocities(), self.model.nodes());
        let shape = self.judged.way_out.clone()?;
        let mut back = vec![0.0; nv];
        difference(nodes, &to.q, &from.q, &mut back);
        let sign = if self.inner(&back, &shape) < 0.0 { -1.0 } else { 1.0 };
        let push: Vec<f64> = self.small(shape).iter().map(|x| sign * x).collect();
        let mut there = to.clone();
        retract(nodes, &to.q, &push, &mut there.q);
        self.creep(&mut there, found, false).ok()?;
        Some(there)
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

    /// The softest directions of an equilibrium, as increments of the size of a push.
    pub(super) fn soft(&mut self, state: &State, count: usize) -> Option<Vec<Vec<f64>>> {
        let load = self.load(state);
        self.count(state, None, load)?;
        let w = self.weights();
        let lowest = self.unstable_first(&w, count).ok()?;
        Some(lowest.iter().map(|x| self.increment(x)).collect())
    }

    /// Of several directions that all go, one along an axis of space, the first that shows.
    pub(super) fn choose(&self, shapes: &[Vec<f64>]) -> Vec<f64> {
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
}
