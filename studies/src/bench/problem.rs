//! The problem that is measured, and its two repeated pieces of work.

use crate::error::Error;
use ropewalk_constraints::SphericalSpec;
use ropewalk_core::integrator::{Alpha, Integrator, Options, StepError, Stepping, Workspace, prepare};
use ropewalk_core::{Model, Node, NodeKind, SolveError, State, V3, Weights, Width};
use ropewalk_elements::cable::{CableModel, Integration, LongitudinalModel, TransverseModel, legal};
use ropewalk_elements::{CableSpec, LinkSection, RigidChainSpec, Section};
use ropewalk_forces::{AddedMassSpec, BuoyancySpec, DragSpec, GravitySpec};
use ropewalk_scene::{Scene, Water};
use std::f64::consts::PI;

/// Step of the fixed-step measurements [s].
const STEP: f64 = 1e-3;

/// A flexible pendulum of 1 m, 0.5 kg/m, EA 5000 N, EI 0.1 N m², hinged at one end, in gravity; under water with
/// buoyancy, drag and added mass of a diameter of 20 mm too.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pendulum {
    /// Number of elements.
    pub elements: usize,
    /// Whether it hangs in water.
    pub water: bool,
    /// Whether its material resists rates of strain and curvature, with 1 ms.
    pub damped: bool,
    /// Whether it has torsion, laid with half a turn.
    pub twisted: bool,
    /// Its stiffness models.
    pub models: CableModel,
}

impl Pendulum {
    /// The pendulum in air, of the default models.
    pub fn new(elements: usize) -> Self {
        Pendulum { elements, ..Self::default() }
    }

    /// The same in water.
    #[must_use]
    pub fn in_water(self) -> Self {
        Pendulum { water: true, ..self }
    }

    /// The same with damping of the material.
    #[must_use]
    pub fn damped(self) -> Self {
        Pendulum { damped: true, ..self }
    }

    /// The same with torsion.
    #[must_use]
    pub fn twisted(self) -> Self {
        Pendulum { twisted: true, ..self }
    }

    /// The same of other models.
    #[must_use]
    pub fn with_models(self, models: CableModel) -> Self {
        Pendulum { models, ..self }
    }

    /// The scene as it is released: straight along x and at rest.
    pub fn scene(&self) -> Scene {
        self.laid(CableSpec::straight("cable", [0.0; 3], [1.0, 0.0, 0.0], self.elements, self.section()))
    }

    /// The scene laid along an arc of one radian, stretched a little.
    pub fn bent(&self) -> Scene {
        let arc =
            (0..=16).map(|k| f64::from(k) / 16.0).map(|s| [1.02 * s.sin(), 1.02 * (s.cos() - 1.0), 0.0]);
        let straight = CableSpec::straight("cable", [0.0; 3], [1.0, 0.0, 0.0], self.elements, self.section());
        self.laid(CableSpec { points: Vec::new(), curve: arc.collect(), ..straight }.unstretched(1.0))
    }

    fn section(&self) -> Section {
        let damping = if self.damped { 1e-3 } else { 0.0 };
        Section {
            diameter: if self.water { 0.02 } else { 0.0 },
            gj: self.twisted.then_some(0.08),
            rotary_inertia: self.twisted.then_some(2.5e-5),
            axial_retardation_time: damping,
            bending_retardation_time: damping,
            ..Section::new(0.5, 5000.0, 0.1)
        }
    }

    fn laid(&self, cable: CableSpec) -> Scene {
        let g: V3<f64> = [0.0, -9.81, 0.0];
        let m = self.models;
        let mut scene = Scene::new();
        let cable = CableSpec { laid_twist: if self.twisted { PI } else { 0.0 }, ..cable };
        scene
            .element(cable.models(m.longitudinal, m.transverse, m.integration))
            .constraint(SphericalSpec::pin("pin", "cable.start"))
            .set_gravity(g)
            .force(GravitySpec::default());
        if self.water {
            scene.water = Some(Water::default());
            scene.force(BuoyancySpec::default()).force(DragSpec::default()).force(AddedMassSpec::default());
        }
        scene
    }
}

/// A chain of rigid links of 0.5 m and 0.25 kg, pinned at one end and released horizontally in gravity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Links {
    /// Number of links.
    pub links: usize,
}

impl Links {
    /// The scene as it is released.
    pub fn scene(&self) -> Scene {
        let end = [0.5 * self.links as f64, 0.0, 0.0];
        let chain =
            RigidChainSpec::new("chain", vec![[0.0; 3], end], self.links, LinkSection::new(0.5, 0.02));
        let mut scene = Scene::new();
        scene
            .element(chain)
            .constraint(SphericalSpec::pin("pin", "chain.start"))
            .set_gravity([0.0, -9.81, 0.0])
            .force(GravitySpec::default());
        scene
    }
}

/// Every legal pair of stiffness models with each quadrature, the default first. Closed forms come once: quadrature
/// makes no difference to them.
pub fn models() -> Vec<CableModel> {
    use LongitudinalModel::{L1, L1n, L2, L3, L4};
    use TransverseModel::{T1, T2, T3};
    let mut all = Vec::new();
    for longitudinal in [L4, L3, L2, L1, L1n] {
        for transverse in [T3, T2, T1].into_iter().filter(|t| legal(longitudinal, *t).is_ok()) {
            for integration in [Integration::LockingFree, Integration::Full] {
                let closed = matches!(longitudinal, L1 | L1n | L2);
                if !(closed && integration == Integration::Full) {
                    all.push(CableModel { longitudinal, transverse, integration });
                }
            }
        }
    }
    all
}

/// A full Newton iteration of a bent and turning cable: force, exact tangent, assembly, factors, solution.
pub struct FullIteration {
    /// The model.
    pub model: Model,
    /// Scratch, with the times of the phases after [`Workspace::profile`].
    pub work: Workspace,
    state: State,
    weights: Weights,
    x: Vec<f64>,
}

impl FullIteration {
    /// The pendulum along an arc.
    ///
    /// # Errors
    /// A scene that can't be built, such as one without elements.
    pub fn new(problem: &Pendulum, width: Width) -> Result<Self, Error> {
        Self::of(problem.bent().build()?.with_width(width))
    }

    /// Any model of cables and points as it is laid, turning about the origin; weights are those of a step of 1 ms.
    ///
    /// # Errors
    /// Not enough memory for the structure of its equations.
    pub fn of(model: Model) -> Result<Self, Error> {
        const TURN: V3<f64> = [0.0, 0.0, -3.0];
        let mut state = model.state();
        // positions and slopes turn alike; sections don't spin
        let turn = |x: &[f64], of: &dyn Fn(&Node) -> usize, out: &mut [f64]| {
            for node in model.nodes() {
                let plain = if node.kind == NodeKind::Twist { 6 } else { node.dofs().len() };
                for i in (0..plain).step_by(3) {
                    let at = of(node) + i;
                    out[node.v + i..node.v + i + 3]
                        .copy_from_slice(&cross(TURN, [x[at], x[at + 1], x[at + 2]]));
                }
            }
        };
        let State { q, v, a, .. } = &mut state;
        turn(q, &|n| n.q, v);
        turn(v, &|n| n.v, a);
        state.lambda.fill(1.0);
        Self::at(model, state)
    }

    /// Any model in any state; weights are those of a step of 1 ms.
    ///
    /// # Errors
    /// Not enough memory for the structure of its equations.
    pub fn at(model: Model, state: State) -> Result<Self, Error> {
        let c = Options::default().scheme.coefficients().map_err(StepError::Options)?;
        let weights = Weights { q: c.beta * STEP * STEP, v: c.gamma * STEP, a: c.mass() };
        let work = Workspace::new(&model).map_err(unsolved)?;
        Ok(FullIteration { model, work, state, weights, x: Vec::new() })
    }

    /// One iteration.
    ///
    /// # Errors
    /// The matrix can't be factored.
    pub fn run(&mut self) -> Result<(), Error> {
        self.assemble();
        self.factor()?;
        self.solve()
    }

    /// The residual alone.
    pub fn residual(&mut self) {
        self.model.assemble(&self.state.at(), &self.state.lambda, None, &mut self.work.system);
    }

    /// Residual and matrix.
    pub fn assemble(&mut self) {
        let (at, lambda) = (self.state.at(), &self.state.lambda);
        self.model.assemble(&at, lambda, Some(self.weights), &mut self.work.system);
    }

    /// Factors of the assembled matrix.
    ///
    /// # Errors
    /// It is singular.
    pub fn factor(&mut self) -> Result<(), Error> {
        self.work.factor(&self.model, self.weights).map_err(unsolved)
    }

    /// The increment that makes the residual vanish; checked where the factors are new.
    ///
    /// # Errors
    /// There are no good factors.
    pub fn solve(&mut self) -> Result<(), Error> {
        self.x.clear();
        self.x.extend(self.work.system.residual.iter().map(|r| -r));
        self.work.solve_iteration(&self.model, &mut self.x).map_err(unsolved)
    }

    /// What the last iteration found: increments of accelerations and multipliers.
    pub fn increment(&self) -> &[f64] {
        &self.x
    }
}

/// Steps of 1 ms of the pendulum from its release, with the default scheme and policy of Newton's method.
pub struct Steps {
    model: Model,
    integrator: Alpha,
    start: State,
    state: State,
    /// Scratch and counters.
    pub work: Workspace,
}

impl Steps {
    /// Makes the start of a chain of links consistent.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn links(problem: &Links, width: Width) -> Result<Self, Error> {
        let options = Options { stepping: Stepping::Fixed { h: STEP }, ..Options::default() };
        Self::of(problem.scene().build()?.with_width(width), &options)
    }

    /// Makes the start consistent.
    ///
    /// # Errors
    /// A scene that can't be built, or a start that is not solvable.
    pub fn new(problem: &Pendulum, width: Width) -> Result<Self, Error> {
        let options = Options { stepping: Stepping::Fixed { h: STEP }, ..Options::default() };
        Self::of(problem.scene().build()?.with_width(width), &options)
    }

    /// The same of any model, with other options.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn of(model: Model, options: &Options) -> Result<Self, Error> {
        let integrator = Alpha::new(options, &model, 1.0)?;
        let mut work = Workspace::new(&model).map_err(unsolved)?;
        let mut start = model.state();
        prepare(&model, &mut start, &mut work, &integrator)?;
        Ok(Steps { model, integrator, state: start.clone(), start, work })
    }

    /// Goes back to the start; the counters begin anew.
    pub fn rewind(&mut self) {
        self.state.clone_from(&self.start);
        self.work.forget();
        self.work.counts = Default::default();
    }

    /// Takes this many steps.
    ///
    /// # Errors
    /// A step that doesn't converge.
    pub fn run(&mut self, count: usize) -> Result<(), Error> {
        for _ in 0..count {
            self.integrator.step(&self.model, &mut self.state, &mut self.work, STEP)?;
        }
        Ok(())
    }

    /// Where it has come to.
    pub fn state(&self) -> &State {
        &self.state
    }
}

fn cross(a: V3<f64>, b: V3<f64>) -> V3<f64> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unsolved(source: SolveError) -> Error {
    Error::Step(StepError::Linear { t: 0.0, source, unknown: "the iteration that is measured".into() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_legal_model_comes_once_and_the_default_first() {
        let all = models();
        assert_eq!((all.len(), all[0]), (15, CableModel::default()));
        assert!(all.iter().enumerate().all(|(k, m)| !all[..k].contains(m)));
        assert!(all.iter().all(|m| legal(m.longitudinal, m.transverse).is_ok()));
    }

    #[test]
    fn an_iteration_solves_its_system_at_every_width() {
        for problem in [Pendulum::new(5), Pendulum::new(5).in_water()] {
            let solved = [Width::One, Width::Four, Width::Eight].map(|width| {
                let mut iteration = FullIteration::new(&problem, width).expect("model");
                iteration.run().expect("solution");
                iteration.increment().to_vec()
            });
            let largest = solved[0].iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            assert!(largest.is_finite() && largest > 0.0);
            for other in &solved[1..] {
                assert!(other.iter().zip(&solved[0]).all(|(a, b)| (a - b).abs() < 1e-9 * largest));
            }
        }
    }

    #[test]
    fn steps_can_be_taken_again() {
        let mut steps = Steps::new(&Pendulum::new(4), Width::best()).expect("start");
        let mut once = || {
            steps.rewind();
            steps.run(20).expect("steps");
            (steps.state().q.clone(), steps.work.counts)
        };
        let (first, second) = (once(), once());
        assert!(first == second && first.1.steps == 20 && first.1.newton_iterations >= 20);
    }
}
