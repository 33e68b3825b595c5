//! Newmark's method: the cable's motion from instant to instant.

use super::bordered::{Bordered, Singular};
use super::problem::{Rule, Unwinding};
use super::state::{Column, Now, Rates, State, identity, plus};
use ropewalk_core::BuildError;
use ropewalk_core::error::{not_negative, positive};

/// How time is stepped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stepping {
    /// Step [s]; halved where Newton's method fails.
    pub h: f64,
    /// Numerical damping `δ`: `γ = 1/2 + δ`, `β = (1/2 + γ)²/4`. At 0 the method is the average acceleration, of second
    /// order and without damping; above, of first order.
    pub numerical_damping: f64,
    /// Smallest step over `h` before the run gives up.
    pub least: f64,
    /// Whether steps are shortened to what the mesh allows; else a longer `h` is refused.
    pub follows: bool,
}

impl Stepping {
    /// Steps of `h` [s] without numerical damping.
    pub fn new(h: f64) -> Self {
        Stepping { h, numerical_damping: 0.0, least: 1e-4, follows: true }
    }
    pub(super) fn check(&self) -> Result<(), BuildError> {
        positive("h", self.h)?;
        not_negative("numerical_damping", self.numerical_damping)?;
        positive("least", self.least).map(drop)
    }
}

/// Why the motion can't go on.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Stopped {
    /// All cable has been peeled.
    #[error("the package is empty at t = {t:.6} s: all {wound} m have been unwound")]
    Empty {
        /// Time [s].
        t: f64,
        /// Length that was wound [m].
        wound: f64,
    },
    /// The free cable has become too short for its grid, or has gone.
    #[error(
        "no free cable is left at t = {t:.6} s: more is drawn than lifts off. Is the tension at the eyelet too high?"
    )]
    Taut {
        /// Time [s].
        t: f64,
    },
    /// The step is longer than the mesh allows.
    #[error(
        "at t = {t:.6} s the step of {h:e} s is too long for {segments} segments: with bending stiffness and a given \
         tension the lift-off point trembles once waves run over more than two segments in a step, and the tension is \
         wrong. Here {longest:.1e} s would do, and less as the cable gets faster: leave the step out to have it chosen, or take \
         fewer segments"
    )]
    TooLong {
        /// Time [s].
        t: f64,
        /// The step [s].
        h: f64,
        /// Number of segments.
        segments: usize,
        /// The longest step there [s].
        longest: f64,
    },
    /// Newton's method failed.
    #[error(
        "at t = {t:.6} s the step did not converge, even with h = {h:.1e} s: {why} in the {equation} at s = {s:.4} m. \
         Try a shorter step, more segments, numerical damping, or a higher tension"
    )]
    NoConvergence {
        /// Time at which the step started [s].
        t: f64,
        /// Smallest step tried [s].
        h: f64,
        /// What went wrong.
        why: &'static str,
        /// Which equation changed most at the end.
        equation: &'static str,
        /// Where along the cable, from the eyelet [m].
        s: f64,
    },
}

/// One try's failure.
enum Failed {
    Empty,
    Newton { why: &'static str, row: usize },
}

/// Steps a state on.
pub(super) struct Newmark {
    stepping: Stepping,
    system: Bordered,
    pub y: State,
    pub now: Now,
    /// Free length less peeled plus drawn length: never changes.
    offset: f64,
    /// Steps so far, Newton iterations, and halvings.
    pub steps: u64,
    pub iterations: u64,
    pub halvings: u64,
}

const MOST_ITERATIONS: usize = 12;
/// Newton's method ends when no node moves farther than this part of the free length.
const CLOSE: f64 = 1e-11;
/// Decay of constraint errors per full step: `ω h` of Baumgarte's terms. A halved step keeps `ω`: to take the error of a
/// longer step off in a shorter one would shake the tension.
const PACE: f64 = 1.0;

impl Newmark {
    pub fn new(problem: &Unwinding, stepping: Stepping, y: State, now: Now) -> Self {
        let offset = y.length[0] - y.peeled[0] + problem.feed.at(y.t).x[0];
        let system = problem.system(problem.scalar());
        Newmark { stepping, system, y, now, offset, steps: 0, iterations: 0, halvings: 0 }
    }

    /// Advances to `t_end` with equal steps of at most `h`, halved where they must be. `seen` is called after each.
    pub fn advance(
        &mut self,
        problem: &Unwinding,
        t_end: f64,
        mut seen: impl FnMut(&State, &Now),
    ) -> Result<(), Stopped> {
        let mut h = self.stepping.h;
        while self.y.t < t_end - 1e-9 * self.stepping.h {
            let left = t_end - self.y.t;
            let longest = problem.longest_step(&self.y, &self.now);
            if h.min(left) > longest * (1.0 + 1e-9) {
                if !self.stepping.follows {
                    let (t, h, segments) = (self.y.t, self.stepping.h, problem.elements);
                    return Err(Stopped::TooLong { t, h, segments, longest });
                }
                h = longest;
            }
            let count = (left / h * (1.0 - 1e-9)).ceil().max(1.0);
            let try_h = left / count;
            match self.attempt(problem, try_h) {
                Ok(()) => {
                    self.steps += 1;
                    seen(&self.y, &self.now);
                    h = (2.0 * h).min(self.stepping.h);
                }
                Err(failed) if 0.5 * try_h >= self.stepping.least * self.stepping.h => {
                    let _ = failed;
                    self.halvings += 1;
                    h = 0.5 * try_h;
                }
                Err(Failed::Empty) => {
                    let (t, wound) = (self.y.t, problem.path.wound());
                    return Err(Stopped::Empty { t, wound });
                }
                Err(Failed::Newton { why, row }) => return Err(self.blame(problem, try_h, why, row)),
            }
        }
        Ok(())
    }

    fn blame(&self, problem: &Unwinding, h: f64, why: &'static str, row: usize) -> Stopped {
        let (n, t, len) = (problem.elements, self.y.t, self.y.length[0]);
        let ell = len / n as f64;
        if !(len > 0.1 * ell) {
            return Stopped::Taut { t };
        }
        let (equation, s) = match row {
            row if row == 4 * n - 3 => ("equation of the lift-off point", len),
            row if row % 4 == 0 => ("length of the segment", (row / 4) as f64 * ell + 0.5 * ell),
            row => ("equation of motion", (row / 4 + 1) as f64 * ell),
        };
        Stopped::NoConvergence { t, h, why, equation, s }
    }

    /// One step of `h`; on failure the state is as before.
    fn attempt(&mut self, problem: &Unwinding, h: f64) -> Result<(), Failed> {
        let gamma = 0.5 + self.stepping.numerical_damping;
        let beta = 0.25 * (0.5 + gamma) * (0.5 + gamma);
        let (g1, g2) = (gamma / (beta * h), 1.0 / (beta * h * h));
        let old = &self.y;
        let n = old.segments();
        let t = old.t + h;
        let fed = problem.feed.at(t);
        let scalar = problem.scalar();
        let mut y = old.clone();
        y.t = t;
        // constant acceleration over the step, which fits Newmark's formulas
        for j in 1..n {
            y.x[j] = plus(&plus(&old.x[j], h, &old.v[j]), 0.5 * h * h, &old.a[j]);
            y.v[j] = plus(&old.v[j], h, &old.a[j]);
        }
        let [s0, s1, s2] = old.peeled;
        y.peeled = if scalar {
            [s0 + h * s1 + 0.5 * h * h * s2, s1 + h * s2, s2]
        } else {
            [self.y.length[0] - self.offset + fed.x[0], fed.v[0], fed.a[0]]
        };
        let w = PACE / self.stepping.h;
        let form = [w * w, 2.0 * w, 1.0];
        let rates = Rates { x: 1.0, v: identity(g1), a: identity(g2) };
        let mut last = f64::INFINITY;
        let mut worst = 0;
        for iteration in 0..MOST_ITERATIONS {
            self.iterations += 1;
            let Some(now) = problem.now(t, y.peeled[0]) else { return Err(Failed::Empty) };
            now.hold(&mut y);
            y.length = [self.offset + y.peeled[0] - fed.x[0], y.peeled[1] - fed.v[0], y.peeled[2] - fed.a[0]];
            if !(y.length[0] > 0.0) {
                return Err(Failed::Newton { why: "no length is left", row: 0 });
            }
            let column = if scalar { now.by_peeled(&y, 1.0, g1, g2) } else { Column::default() };
            problem.assemble(&y, &now, &rates, scalar.then_some(&column), form, &mut self.system);
            if scalar {
                problem.find(&y, &now, &rates, &column, &mut self.system);
            }
            if let Err(Singular(row)) = self.system.solve() {
                return Err(Failed::Newton { why: "there is no pivot", row });
            }
            let d = &self.system.rhs;
            let mut moved = 0.0_f64;
            for j in 1..n {
                for i in 0..3 {
                    let (k, step) = (4 * (j - 1) + 1 + i, d[4 * (j - 1) + 1 + i]);
                    y.x[j][i] += step;
                    y.v[j][i] += g1 * step;
                    y.a[j][i] += g2 * step;
                    if !(step.abs() <= moved) {
                        (moved, worst) = (step.abs(), k);
                    }
                }
            }
            for j in 0..n {
                y.lambda[j] += d[4 * j];
            }
            if scalar {
                let step = d[4 * n - 3];
                y.peeled[0] += step;
                y.peeled[2] = g2 * (y.peeled[0] - s0 - h * s1 - h * h * (0.5 - beta) * s2);
                y.peeled[1] = s1 + h * ((1.0 - gamma) * s2 + gamma * y.peeled[2]);
                if !(step.abs() <= moved) {
                    (moved, worst) = (step.abs(), 4 * n - 3);
                }
            }
            let close = CLOSE * y.length[0];
            if !(moved < 10.0 * y.length[0]) {
                return Err(Failed::Newton { why: "Newton's method runs away", row: worst });
            }
            // a last step from within the square root of the tolerance is exact to rounding
            if moved <= close || (iteration > 1 && moved <= 1e-7 * y.length[0] && moved < 1e-3 * last) {
                return self.accept(problem, y, fed);
            }
            last = moved;
        }
        Err(Failed::Newton { why: "Newton's method still moves it", row: worst })
    }

    fn accept(
        &mut self,
        problem: &Unwinding,
        mut y: State,
        fed: ropewalk_core::Moving,
    ) -> Result<(), Failed> {
        let Some(now) = problem.now(y.t, y.peeled[0]) else { return Err(Failed::Empty) };
        now.hold(&mut y);
        y.length = [self.offset + y.peeled[0] - fed.x[0], y.peeled[1] - fed.v[0], y.peeled[2] - fed.a[0]];
        (self.y, self.now) = (y, now);
        Ok(())
    }
}

/// Over how many segments a wave may run in a step.
const REACH: f64 = 2.0;

impl Unwinding {
    /// The longest step that the mesh allows [s]. Where a given tension finds the lift-off point of a cable with bending
    /// stiffness, waves may run over two segments in a step: beyond about five the lift-off point trembles instead of
    /// moving, and the tension there means nothing. Other problems are stable with any step.
    pub(super) fn longest_step(&self, y: &State, now: &Now) -> f64 {
        let Rule::Tension(pull) = &self.rule else { return f64::INFINITY };
        if self.cable.ei == 0.0 {
            return f64::INFINITY;
        }
        let tension = pull.at(now.t, now.speed[0]).max(0.0);
        let waves = (tension / self.cable.mass).sqrt() + now.speed[0].abs();
        REACH * y.length[0] / self.elements as f64 / waves
    }

    /// Solves for the accelerations and tensions of a state whose positions and velocities are consistent.
    ///
    /// With a step `h` they are those of a cable that gives way over about this time. The shape at the start is hardly
    /// ever in balance on the grid to the fourth differences, and without that the accelerations of a stiff cable
    /// would begin with the shortest waves of the grid, which Newmark's method doesn't damp.
    pub(super) fn accelerate(&self, y: &mut State, now: &Now, h: f64) -> Result<(), BuildError> {
        // a peel law and a tangent lift-off say nothing about accelerations: peel at the drawing speed
        let scalar = matches!(self.rule, Rule::Tension(_)) && self.lift_off == super::LiftOff::Free;
        let rates = Rates { x: 0.25 * h * h, v: identity(0.5 * h), a: identity(1.0) };
        let n = self.elements;
        y.a.fill([0.0; 3]);
        y.lambda.fill(0.0);
        let mut system = self.system(scalar);
        y.peeled[2] = now.speed[1];
        y.length[2] = 0.0;
        now.hold(y);
        let column = now.by_peeled(y, 0.0, 0.0, 1.0);
        self.assemble(y, now, &rates, scalar.then_some(&column), [0.0, 0.0, 1.0], &mut system);
        if scalar {
            self.find(y, now, &rates, &column, &mut system);
        }
        let solved = system.solve();
        let d = &system.rhs;
        if solved.is_err() || d.iter().any(|x| !x.is_finite()) {
            let message = "the accelerations at the start can't be found: give another shape at the start";
            return Err(BuildError::at("points", message));
        }
        for j in 1..n {
            y.a[j] = [0, 1, 2].map(|i| d[4 * (j - 1) + 1 + i]);
        }
        (0..n).for_each(|j| y.lambda[j] = d[4 * j]);
        if scalar {
            y.peeled[2] += d[4 * n - 3];
            y.length[2] = y.peeled[2] - now.speed[1];
        }
        now.hold(y);
        Ok(())
    }
}
