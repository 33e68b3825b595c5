//! Runs, and what they give.

use super::conditions::{Condition, Watch};
use super::newmark::{Newmark, Stepping, Stopped};
use super::problem::Unwinding;
use super::state::{Now, State, length, minus, plus};
use ropewalk_core::error::positive;
use ropewalk_core::{BuildError, V3, dot};
use ropewalk_forces::{NormalLaw, choo_casarella_cn};

/// What is known of one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Time [s].
    pub t: f64,
    /// Speed of the cable through the eyelet [m/s].
    pub speed: f64,
    /// Tension at the eyelet [N].
    pub tension: f64,
    /// Tension at the lift-off point [N].
    pub lift_tension: f64,
    /// Free length [m].
    pub length: f64,
    /// Length peeled since the package was full [m], and the speed of peeling [m/s].
    pub peeled: f64,
    /// See `peeled`.
    pub peel_speed: f64,
    /// Lift-off point [m].
    pub lift_off: V3<f64>,
    /// Curvature at the lift-off point [1/m].
    pub lift_curvature: f64,
    /// Position, velocity and acceleration of the centre node; those of the node, not of the material.
    pub centre: [V3<f64>; 3],
    /// Acceleration of the material at the centre node [m/s²].
    pub centre_material: V3<f64>,
    /// Largest distance of the cable from the axis [m].
    pub radius: f64,
    /// Drag coefficient across the cable at a quarter, half and three quarters of the length.
    pub drag: [f64; 3],
    /// Largest difference of the tensions from those found by marching the tangential equation [N].
    pub marching: f64,
}

/// The cable at an instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Time [s].
    pub t: f64,
    /// Free length [m].
    pub length: f64,
    /// Nodes at equal distances along it, from the eyelet to the lift-off point [m].
    pub x: Vec<V3<f64>>,
    /// Tension at the middle of each segment [N].
    pub tension: Vec<f64>,
    /// Curvature at each node [1/m]; without bending stiffness nothing tells it at the ends, where it is NaN.
    pub curvature: Vec<f64>,
}

/// What a run computed.
#[derive(Clone, Debug)]
pub struct History {
    /// One row per instant.
    pub rows: Vec<Row>,
    /// Shapes at the times asked for.
    pub shapes: Vec<Shape>,
    /// What was the matter on the way.
    pub conditions: Vec<Condition>,
    /// The state at the end.
    pub state: State,
    /// Why it ended before its time, if it did.
    pub stopped: Option<Stopped>,
    /// Newton iterations, and how often a step was halved.
    pub iterations: u64,
    /// See `iterations`.
    pub halvings: u64,
}

/// What is kept of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// End [s].
    pub t_end: f64,
    /// Time between rows [s].
    pub every: f64,
    /// Times at which the shape is kept [s], ascending.
    pub shapes: Vec<f64>,
}

impl History {
    /// One quantity over time.
    pub fn column(&self, of: impl Fn(&Row) -> f64) -> Vec<f64> {
        self.rows.iter().map(of).collect()
    }
}

/// A run that is moved on piece by piece.
pub struct Running {
    problem: Unwinding,
    newmark: Newmark,
    watch: Watch,
}

impl Running {
    /// A run from a state, which may go on to `t_end` [s].
    ///
    /// # Errors
    /// Data, steps or times that make no sense.
    pub fn new(
        problem: Unwinding,
        mut start: State,
        stepping: Stepping,
        t_end: f64,
    ) -> Result<Self, BuildError> {
        problem.check()?;
        stepping.check()?;
        let (from, to) = problem.feed.range();
        if start.t < from || t_end > to {
            let message = format!("the motion that draws the cable is defined from {from} to {to} s only");
            return Err(BuildError::at("feed", message));
        }
        let Some(now) = problem.now(start.t, start.peeled[0]) else {
            return Err(BuildError::at("peeled", "the package is empty at the start"));
        };
        if problem.cable.ei > 0.0 {
            problem.accelerate(&mut start, &now, stepping.h)?;
        }
        let newmark = Newmark::new(&problem, stepping, start, now);
        Ok(Running { problem, newmark, watch: Watch::default() })
    }

    /// Goes on to a time [s].
    ///
    /// # Errors
    /// Why it can't; the state is that of the last step that could be taken.
    pub fn advance(&mut self, t: f64) -> Result<(), Stopped> {
        let Running { problem, newmark, watch } = self;
        newmark.advance(problem, t, |y, now| {
            watch.see(problem, y, now, &problem.tension(y, now), problem.tensions(y, now)[1]);
        })
    }

    /// The time [s].
    pub fn t(&self) -> f64 {
        self.newmark.y.t
    }
    /// What is known of the instant.
    pub fn row(&self) -> Row {
        self.problem.row(&self.newmark.y, &self.newmark.now)
    }
    /// The cable.
    pub fn shape(&self) -> Shape {
        self.problem.shape(&self.newmark.y, &self.newmark.now)
    }
    /// Tension at each node [N]: between those of the two segments that meet there.
    pub fn tensions(&self) -> Vec<f64> {
        let ends = self.problem.tensions(&self.newmark.y, &self.newmark.now);
        let within = self.problem.tension(&self.newmark.y, &self.newmark.now);
        let between = within.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
        std::iter::once(ends[0]).chain(between).chain([ends[1]]).collect()
    }
    /// Curvature at each node [1/m]; without bending stiffness nothing tells it at the ends, where it is NaN.
    pub fn curvatures(&self) -> Vec<f64> {
        let (y, now) = (&self.newmark.y, &self.newmark.now);
        let n = y.segments();
        let known = |j: usize| self.problem.cable.ei > 0.0 || (1..n).contains(&j);
        let at = |j: usize| if known(j) { length(&self.problem.curvature(y, now, j)) } else { f64::NAN };
        (0..=n).map(at).collect()
    }
    /// What was the matter so far.
    pub fn conditions(&self) -> &[Condition] {
        &self.watch.all
    }
    /// Steps, Newton iterations and halvings so far.
    pub fn work(&self) -> [u64; 3] {
        [self.newmark.steps, self.newmark.iterations, self.newmark.halvings]
    }
}

impl Unwinding {
    /// Runs from a state. What stops it before its time is told in the history, with all that was computed until then.
    ///
    /// # Errors
    /// Data, steps or times that make no sense.
    pub fn run(&self, start: State, stepping: Stepping, plan: &Plan) -> Result<History, BuildError> {
        positive("every", plan.every)?;
        let begin = start.t;
        let mut running = Running::new(self.clone(), start, stepping, plan.t_end)?;
        let mut rows = vec![running.row()];
        let mut shapes = Vec::new();
        let mut waiting = plan.shapes.iter().copied().peekable();
        let mut stopped = None;
        let count = ((plan.t_end - begin) / plan.every * (1.0 - 1e-12)).ceil().max(0.0) as usize;
        for k in 1..=count {
            let next = (begin + k as f64 * plan.every).min(plan.t_end);
            while let Some(at) = waiting.next_if(|at| *at <= next) {
                stopped = running.advance(at).err();
                if stopped.is_some() {
                    break;
                }
                shapes.push(running.shape());
            }
            if stopped.is_none() {
                stopped = running.advance(next).err();
            }
            if stopped.is_some() {
                shapes.push(running.shape());
                break;
            }
            rows.push(running.row());
        }
        let Newmark { y: state, iterations, halvings, .. } = running.newmark;
        Ok(History { rows, shapes, conditions: running.watch.all, state, stopped, iterations, halvings })
    }

    /// The cable of a state.
    pub(super) fn shape(&self, y: &State, now: &Now) -> Shape {
        Shape {
            t: y.t,
            length: y.length[0],
            x: y.x.clone(),
            tension: self.tension(y, now),
            curvature: (0..y.x.len()).map(|j| length(&self.curvature(y, now, j))).collect(),
        }
    }

    fn row(&self, y: &State, now: &Now) -> Row {
        let n = y.segments();
        let [tension, lift_tension] = self.tensions(y, now);
        let c = y.at(0.5);
        let tensions = self.tension(y, now);
        let marched = self.marched(y, now);
        // a NaN shows
        let marching = tensions.iter().zip(&marched).fold(0.0_f64, |m, (a, b)| {
            let off = (a - b).abs();
            if off <= m { m } else { off }
        });
        Row {
            t: y.t,
            speed: now.speed[0],
            tension,
            lift_tension,
            length: y.length[0],
            peeled: y.peeled[0],
            peel_speed: y.peeled[1],
            lift_off: y.x[n],
            lift_curvature: length(&self.curvature(y, now, n)),
            centre: [y.x[c], y.v[c], y.a[c]],
            centre_material: self.stencil(y, now, c).a,
            radius: y.x.iter().fold(0.0, |m, x| m.max(self.path.cylindrical(x)[0])),
            drag: [0.25, 0.5, 0.75].map(|zeta| self.drag_coefficient(y, now, y.at(zeta))),
            marching,
        }
    }

    /// Drag coefficient across the cable at an inner node; 0 without drag.
    fn drag_coefficient(&self, y: &State, now: &Now, j: usize) -> f64 {
        let Some(drag) = &self.drag else { return 0.0 };
        match drag.normal {
            NormalLaw::Constant(c) => c,
            NormalLaw::ChooCasarella => {
                let s = self.stencil(y, now, j);
                let (u, _) = drag.current.at(y.x[j][2]);
                let v = minus(&s.v(y, j), &u);
                let t = s.d1x.map(|d| d / length(&s.d1x));
                let across = length(&plus(&v, -dot(&v, &t), &t));
                choo_casarella_cn(drag.density * self.cable.diameter * across / drag.viscosity)
            }
        }
    }
}
