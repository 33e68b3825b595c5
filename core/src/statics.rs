//! Equilibria: at rest, along a load path, or relative to a frame that moves steadily.
//!
//! Newton's method with the remedies of [`Relaxed`]: geometric stiffness from the stress linearised at the iterate
//! before; a floor of tension where the tangent isn't positive; a cap of the stiff modulus at the first iterations.
//! An equilibrium is accepted if it is stable (by the inertia of the factors) and not folded.

use crate::build::{BuildError, positive};
use crate::lane::V3;
use crate::model::{Model, System};
use crate::motion::SteadyFrame;
use crate::node::{NodeKind, retract};
use crate::pattern::Structure;
use crate::solver::{Guard, LinearSolver, Profile, SolveError};
use crate::state::{At, Relaxation, Relaxed, State};
use crate::term::Weights;
use serde::{Deserialize, Serialize};

/// How equilibria are found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct StaticsOptions {
    /// Number of load steps from t = 0 to the end of the run.
    pub steps: usize,
    /// Most Newton iterations per equilibrium.
    pub max_iterations: u32,
    /// Refuse equilibria that are unstable or folded, and look for the true one.
    pub stable: bool,
    /// Tolerance of positions, relative to the reference length.
    pub tolerance: f64,
}

impl Default for StaticsOptions {
    fn default() -> Self {
        StaticsOptions { steps: 10, max_iterations: 60, stable: true, tolerance: 1e-9 }
    }
}

impl StaticsOptions {
    /// What is wrong with the numbers, if anything.
    pub fn check(&self) -> Result<(), BuildError> {
        let refused = |name: &str, message: String| Err(BuildError::at(format!("statics.{name}"), message));
        if self.steps == 0 || self.steps > 1_000_000 {
            return refused("steps", format!("`steps` must be between 1 and 1000000, not {}", self.steps));
        }
        if self.max_iterations == 0 {
            return refused("max_iterations", "`max_iterations` must be at least 1".into());
        }
        positive("tolerance", self.tolerance).map(drop).map_err(|e| e.of("statics.tolerance"))
    }
}

/// How an equilibrium was found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Found {
    /// Newton iterations, each one factorisation and one solution.
    pub iterations: u32,
    /// Iterations in which the tangent was not positive and tension was given a floor.
    pub floored: u32,
    /// How often an unstable equilibrium was left by a push along its softest direction.
    pub pushes: u32,
    /// Whether the search was begun again from straight cables, because the first guess led to a fold.
    pub straightened: bool,
    /// Largest residual force [N].
    pub residual: f64,
}

impl Found {
    /// Adds the work of another search; the residual is that of the later one.
    pub fn add(&mut self, later: &Found) {
        self.iterations += later.iterations;
        self.floored += later.floored;
        self.pushes += later.pushes;
        self.straightened |= later.straightened;
        self.residual = later.residual;
    }
}

/// Why no equilibrium was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "no equilibrium was found at t = {t}: {why} (after {iterations} iterations, largest residual {residual:.2e} in \
     {equation}). Try more load `steps`, a start closer to the solution, or a little bending stiffness"
)]
pub struct StaticsError {
    /// Time, or load factor.
    pub t: f64,
    /// What went wrong.
    pub why: String,
    /// Iterations spent.
    pub iterations: u32,
    /// Largest residual [N].
    pub residual: f64,
    /// Where.
    pub equation: String,
}

/// Searches equilibria of one model. Keeps its scratch between searches.
pub struct Statics<'a> {
    model: &'a Model,
    options: StaticsOptions,
    frame: Option<SteadyFrame>,
    structure: Structure,
    solver: Guard,
    system: System,
    damping: System,
    mass: System,
    v: Vec<f64>,
    a: Vec<f64>,
}

/// Cosine between neighbouring chords below which a cable counts as folded.
const FOLD: f64 = 0.5;

struct Trial {
    /// Correction of velocities (as increments) and multipliers.
    d: Vec<f64>,
    negative: bool,
}

impl<'a> Statics<'a> {
    /// Prepares the search for equilibria at rest.
    ///
    /// # Errors
    /// Not enough memory for the factors.
    pub fn new(model: &'a Model, options: &StaticsOptions) -> Result<Self, SolveError> {
        Self::relative(model, options, None)
    }

    /// Prepares the search for equilibria relative to a frame that moves steadily, such as a tow at constant speed or
    /// in a steady turn: one solution instead of a long run. The frame's centre is a point in space at the time of
    /// the search.
    ///
    /// # Errors
    /// Not enough memory for the factors.
    pub fn relative(
        model: &'a Model,
        options: &StaticsOptions,
        frame: Option<SteadyFrame>,
    ) -> Result<Self, SolveError> {
        let turning = frame.is_some_and(|f| f.omega != [0.0; 3]);
        let structure = if turning { model.unsymmetric_structure() } else { model.structure().clone() };
        // the profile solver knows the signs of its pivots for unsymmetric matrices too
        let chain: Box<dyn LinearSolver> = Box::new(Profile::default());
        let solver = if Profile::size(&structure) < 20 * structure.entries() {
            Guard::with(&structure, chain)?
        } else {
            Guard::new(&structure)?
        };
        let zero = vec![0.0; model.velocities()];
        Ok(Statics {
            model,
            options: options.clone(),
            frame,
            structure,
            solver,
            system: System::default(),
            damping: System::default(),
            mass: System::default(),
            v: zero.clone(),
            a: zero,
        })
    }

    /// Moves `state` to the equilibrium at its time. `cold` says that no equilibrium nearby is known: the first of a
    /// path, or a guess.
    ///
    /// # Errors
    /// None was found; the state is as it was.
    pub fn find(&mut self, state: &mut State, cold: bool) -> Result<Found, StaticsError> {
        let before = state.clone();
        let mut first = self.search(state, cold, cold);
        if first.is_err() && !cold {
            // from a neighbouring equilibrium the bare iteration nearly always gets there, and faster
            state.clone_from(&before);
            first = self.search(state, false, true);
        }
        let suspicious = match &first {
            Ok(_) => cold && self.options.stable && self.folded(state) < FOLD,
            Err(_) => cold,
        };
        if !suspicious {
            if first.is_err() {
                *state = before;
            }
            return first;
        }
        // a guess can lead into a fold or nowhere; straight cables between their ends rarely do
        let mut other = before.clone();
        other.lambda.fill(0.0);
        for part in self.model.parts() {
            part.straighten(&mut other.q);
        }
        let second = self.search(&mut other, true, true);
        match (first, second) {
            (Ok(found), Ok(again)) => {
                if self.folded(&other) > self.folded(state) {
                    *state = other;
                    Ok(Found { straightened: true, ..again })
                } else {
                    Ok(found)
                }
            }
            (Err(_), Ok(again)) => {
                *state = other;
                Ok(Found { straightened: true, ..again })
            }
            (Ok(found), Err(_)) => Ok(found),
            (Err(e), Err(_)) => {
                *state = before;
                Err(e)
            }
        }
    }

    /// Moves the state from one equilibrium to that at time `t`, in one step if that converges, else in as many
    /// smaller ones as it needs. Returns the work of all of them.
    ///
    /// # Errors
    /// The path could not be followed; the state is the last equilibrium that was found.
    pub fn follow(&mut self, state: &mut State, t: f64) -> Result<Found, StaticsError> {
        let (mut h, mut sum) = (t - state.t, Found::default());
        let least = h.abs() / 256.0;
        while state.t != t {
            let from = state.t;
            state.t = if (t - from).abs() <= 1.001 * h.abs() { t } else { from + h };
            match self.find(state, false) {
                Ok(found) => {
                    sum.add(&found);
                    h *= 2.0;
                }
                Err(e) => {
                    state.t = from;
                    h *= 0.5;
                    if h.abs() < least {
                        return Err(e);
                    }
                }
            }
        }
        Ok(sum)
    }

    fn search(&mut self, state: &mut State, cold: bool, mut careful: bool) -> Result<Found, StaticsError> {
        let (model, nv) = (self.model, self.model.velocities());
        let length = model.length();
        let load = self.load(state);
        let mut found = Found::default();
        let mut how = Relaxation {
            smooth: false,
            ramp: if cold { 1.0 } else { f64::INFINITY },
            ramp_before: f64::INFINITY,
            load,
            floor: None,
        };
        let mut floor = 0.5 * load;
        let mut last: Option<Vec<f64>> = None;
        let (mut size_before, mut theta) = (None, 1.0);
        let fail = |s: &Self, why: &str, found: &Found| {
            let (k, r) = s.worst();
            Err(StaticsError {
                t: state.t,
                why: why.to_string(),
                iterations: found.iterations,
                residual: r,
                equation: model.unknown_name(k),
            })
        };
        let mut q = state.q.clone();
        let mut lambda = state.lambda.clone();
        let mut next = q.clone();
        while found.iterations < self.options.max_iterations {
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
            let done = size <= tolerance || (!bad && found.iterations >= 2 && size * theta <= tolerance);
            last = Some(d);
            if ramping || !done {
                continue;
            }
            // what is accepted is checked at the point itself; with a stiff EA even now only the smooth stress is
            // good enough to tell stable from unstable
            let how = Relaxation {
                smooth: true,
                ramp: f64::INFINITY,
                ramp_before: f64::INFINITY,
                load,
                floor: None,
            };
            let check = self.newton(state, &q, &lambda, last.as_deref(), how);
            found.residual = self.worst().1;
            match check {
                Ok(t) if self.options.stable && self.unstable(&t) => {
                    if found.pushes >= 3 {
                        return fail(self, "only unstable equilibria were met", &found);
                    }
                    found.pushes += 1;
                    careful = true;
                    let push = self.softest(found.pushes);
                    retract(model.nodes(), &q, &push, &mut next);
                    std::mem::swap(&mut q, &mut next);
                    (last, size_before, theta) = (None, None, 1.0);
                }
                Ok(t) if self.size(&t.d[..nv]) <= 1e3 * tolerance => {
                    state.q = q;
                    state.lambda = lambda;
                    let (v, a) = (self.v.clone(), self.a.clone());
                    state.v = v;
                    state.a = a;
                    state.aux.clone_from(&state.a);
                    return Ok(found);
                }
                Ok(_) => {}
                Err(e) => return fail(self, &e.to_string(), &found),
            }
        }
        fail(self, "the iterations did not converge", &found)
    }

    fn newton(
        &mut self,
        state: &State,
        q: &[f64],
        lambda: &[f64],
        last: Option<&[f64]>,
        how: Relaxation,
    ) -> Result<Trial, SolveError> {
        self.solve_at(state, q, lambda, Some(Relaxed { last, how }))
    }

    /// Assembles, factors and solves once.
    fn solve_at(
        &mut self,
        state: &State,
        q: &[f64],
        lambda: &[f64],
        relaxed: Option<Relaxed<'_>>,
    ) -> Result<Trial, SolveError> {
        self.follow_frame(q);
        let at = At { t: state.t, q, v: &self.v, a: &self.a, modes: &state.modes, relaxed };
        let one = |q, v, a| Some(Weights { q, v, a });
        self.model.assemble_in(&self.structure, &at, lambda, one(1.0, 0.0, 0.0), &mut self.system);
        if let Some(frame) = self.frame.filter(|f| f.omega != [0.0; 3]) {
            self.model.assemble_in(&self.structure, &at, lambda, one(0.0, 1.0, 0.0), &mut self.damping);
            self.model.assemble_in(&self.structure, &at, lambda, one(0.0, 0.0, 1.0), &mut self.mass);
            self.turn_columns(frame.omega);
        }
        self.brace();
        self.solver.factor(&self.structure, &self.system.values)?;
        let negative = self.solver.negative_pivots().is_none_or(|n| n != self.model.multipliers());
        let s = &self.structure;
        let mut x = vec![0.0; s.n];
        for (i, &p) in s.position.iter().enumerate() {
            x[p] = -self.system.residual[i];
        }
        self.solver.solve(s, &self.system.values, &mut x)?;
        let d: Vec<f64> = s.position.iter().map(|&p| x[p]).collect();
        Ok(Trial { d, negative })
    }

    /// Adds `ρ GᵀG` to the stiffness and `ρ Gᵀ g` to the residual. The solution is the same, and no node is left
    /// without stiffness before its constraint is reached in the elimination.
    fn brace(&mut self) {
        if self.model.multipliers() == 0 {
            return;
        }
        let s = &self.structure;
        let nv = self.model.velocities();
        let scale = (0..nv).map(|i| self.system.values[s.diagonal[i] as usize].abs()).fold(0.0, f64::max);
        self.model.add_brace(s, scale.max(f64::MIN_POSITIVE), &mut self.system);
    }

    /// Velocities and accelerations of the frame at a configuration.
    fn follow_frame(&mut self, q: &[f64]) {
        let Some(f) = self.frame else { return };
        let cross = |a: V3<f64>, b: V3<f64>| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        for n in self.model.nodes() {
            let x = &q[n.coords()];
            let blocks = match n.kind {
                NodeKind::Point | NodeKind::Frame => 1,
                NodeKind::Slope => 2,
                NodeKind::Scalars(_) => 0,
            };
            for b in 0..blocks {
                let origin = if b == 0 { f.centre } else { [0.0; 3] };
                let arm: V3<f64> = std::array::from_fn(|i| x[3 * b + i] - origin[i]);
                let turn = cross(f.omega, arm);
                let pull = cross(f.omega, turn);
                for i in 0..3 {
                    self.v[n.v + 3 * b + i] = turn[i] + if b == 0 { f.velocity[i] } else { 0.0 };
                    self.a[n.v + 3 * b + i] = pull[i];
                }
            }
            if n.kind == NodeKind::Frame {
                // the spin of the body itself, in its own axes, is left to the bodies
                self.v[n.v + 3..n.v + 6].fill(0.0);
            }
        }
    }

    /// Adds `C W + M W²` to the stiffness, where `W` turns each three components of a node by `ω ×`.
    fn turn_columns(&mut self, omega: V3<f64>) {
        let [x, y, z] = omega;
        let w = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
        let w2: [[f64; 3]; 3] =
            std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| w[i][k] * w[k][j]).sum()));
        let s = &self.structure;
        for n in self.model.nodes() {
            for block in 0..n.kind.velocities() / 3 {
                let columns: [usize; 3] = std::array::from_fn(|i| s.position[n.v + 3 * block + i]);
                let count = s.columns[columns[0] + 1] - s.columns[columns[0]];
                for k in 0..count {
                    let at = columns.map(|c| s.columns[c] + k);
                    if s.is_multiplier[s.rows[at[0]]] {
                        continue;
                    }
                    let (c, m) = (at.map(|p| self.damping.values[p]), at.map(|p| self.mass.values[p]));
                    for j in 0..3 {
                        self.system.values[at[j]] +=
                            (0..3).map(|i| c[i] * w[i][j] + m[i] * w2[i][j]).sum::<f64>();
                    }
                }
            }
        }
    }

    /// Whether the last factors show an instability: Sylvester's law where the tangent is symmetric; where it isn't,
    /// a negative determinant, which means a real eigenvalue on the wrong side.
    fn unstable(&self, trial: &Trial) -> bool {
        if self.structure.symmetric {
            return trial.negative;
        }
        let negative = self.solver.negative_pivots().map(|n| n + self.model.multipliers());
        negative.is_some_and(|n| n % 2 == 1)
    }

    /// Size of the load: the residual with every stiff modulus switched off.
    fn load(&mut self, state: &State) -> f64 {
        self.follow_frame(&state.q);
        let how = Relaxation { ramp: 0.0, ramp_before: 0.0, ..Relaxation::default() };
        let at = At {
            t: state.t,
            q: &state.q,
            v: &self.v,
            a: &self.a,
            modes: &state.modes,
            relaxed: Some(Relaxed { last: None, how }),
        };
        let none = vec![0.0; self.model.multipliers()];
        self.model.assemble_in(&self.structure, &at, &none, None, &mut self.system);
        let mut sum = 0.0;
        for n in self.model.nodes().iter().filter(|n| n.kind.velocities() >= 3) {
            let r = &self.system.residual[n.v..n.v + 3];
            sum += r.iter().map(|x| x * x).sum::<f64>().sqrt();
        }
        sum
    }

    /// Whether the cap on stiffness still changes the forces.
    fn ramp_binds(&mut self, state: &State, q: &[f64], lambda: &[f64], how: Relaxation) -> bool {
        self.follow_frame(q);
        // both by the same path through the elements, so that equal means equal to the last bit
        let mut at = At { t: state.t, q, v: &self.v, a: &self.a, modes: &state.modes, relaxed: None };
        at.relaxed = Some(Relaxed { last: None, how: Relaxation { ramp: f64::INFINITY, ..how } });
        self.model.assemble_in(&self.structure, &at, lambda, None, &mut self.system);
        let free = self.system.residual.clone();
        at.relaxed = Some(Relaxed { last: None, how });
        self.model.assemble_in(&self.structure, &at, lambda, None, &mut self.system);
        free != self.system.residual
    }

    /// Largest position and slope of an increment, relative to the reference length.
    fn size(&self, d: &[f64]) -> f64 {
        let length = self.model.length();
        let mut worst = 0.0;
        for n in self.model.nodes() {
            for (k, x) in d[n.dofs()].iter().enumerate() {
                let x = if k < 3 { x / length } else { *x };
                // max() would swallow a NaN
                if !x.is_finite() {
                    return f64::INFINITY;
                }
                worst = f64::max(worst, x.abs());
            }
        }
        worst
    }

    fn position_size(&self, d: &[f64]) -> f64 {
        let nodes = self.model.nodes().iter();
        nodes
            .flat_map(|n| d[n.v..n.v + n.kind.velocities().min(3)].iter())
            .fold(0.0, |m: f64, x| m.max(x.abs()))
    }

    fn worst(&self) -> (usize, f64) {
        let mut worst = (0, 0.0);
        for (i, r) in self.system.residual.iter().enumerate() {
            if !r.is_finite() || r.abs() > worst.1 {
                worst = (i, r.abs());
            }
        }
        worst
    }

    /// The direction in which the last factored tangent resists least, by inverse iteration, as a small increment.
    fn softest(&mut self, seed: u32) -> Vec<f64> {
        let s = &self.structure;
        let nv = self.model.velocities();
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
            if self.solver.solve(s, &self.system.values, &mut x).is_err() {
                break;
            }
            let mut largest = 0.0;
            for p in 0..s.n {
                if s.is_multiplier[p] {
                    x[p] = 0.0;
                }
                largest = f64::max(largest, x[p].abs());
            }
            x.iter_mut().for_each(|x| *x /= largest.max(f64::MIN_POSITIVE));
        }
        let mut d: Vec<f64> = (0..nv).map(|i| x[s.position[i]]).collect();
        let size = self.size(&d).max(f64::MIN_POSITIVE);
        d.iter_mut().for_each(|d| *d *= 0.05 / size);
        d
    }

    /// Smallest cosine between neighbouring chords of any part; 1 if nothing has chords.
    fn folded(&self, state: &State) -> f64 {
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
