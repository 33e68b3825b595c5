//! A scene: what the user wrote, as specs and options. Scene files and Rust code make the same thing.

use crate::builder::Builder;
use crate::controllers;
use crate::inputs::{InputSpec, Inputs};
use crate::motions::build_all;
use crate::process::{Process, ProcessSpec, Steered, Surroundings};
use crate::run::{Analysis, Run};
use crate::spec::{ConstraintSpec, ControllerSpec, ElementSpec, ForceSpec, MotionSpec, RecordSpec, SpecKind};
use crate::water::{Air, Water};
use ropewalk_core::integrator::Options;
use ropewalk_core::statics::StaticsOptions;
use ropewalk_core::{BuildError, Model, Plan, Recipe, Record, Start, V3};
use std::collections::HashSet;
use std::sync::Arc;

/// Standard gravity, rounded as most of the field does [m/s²].
pub const GRAVITY: V3<f64> = [0.0, 0.0, -9.81];

/// A scene: lists of specs, and options. Build a [`Model`] of it, or run it with `ropewalk::simulate`. A clone shares the
/// specs.
#[derive(Clone, Debug)]
pub struct Scene {
    /// One line that says what it shows.
    pub title: String,
    /// More about it.
    pub description: String,
    /// Acceleration of gravity [m/s²], for weight, buoyancy and all else that asks; by default [`GRAVITY`]. What feels it
    /// is the choice of the scene's forces.
    pub gravity: V3<f64>,
    /// The water, if there is any.
    pub water: Option<Water>,
    /// The air above it, if it counts.
    pub air: Option<Air>,
    /// Cables, bodies, masses.
    pub elements: Vec<Arc<dyn ElementSpec>>,
    /// What holds them.
    pub constraints: Vec<Arc<dyn ConstraintSpec>>,
    /// What acts on them.
    pub forces: Vec<Arc<dyn ForceSpec>>,
    /// Prescribed motions, by name.
    pub motions: Vec<Arc<dyn MotionSpec>>,
    /// Channels that are set while a run goes on.
    pub inputs: Vec<InputSpec>,
    /// What sets them by what records show.
    pub controllers: Vec<Arc<dyn ControllerSpec>>,
    /// Outputs.
    pub records: Vec<Arc<dyn RecordSpec>>,
    /// A problem with equations of its own; then it is the only one, and there are no elements.
    pub processes: Vec<Arc<dyn ProcessSpec>>,
    /// Analysis, duration and output.
    pub run: Run,
    /// How it is integrated.
    pub solver: Options,
    /// How equilibria are found.
    pub statics: StaticsOptions,
}

impl Default for Scene {
    fn default() -> Self {
        Scene {
            title: String::new(),
            description: String::new(),
            gravity: GRAVITY,
            water: None,
            air: None,
            elements: Vec::new(),
            constraints: Vec::new(),
            forces: Vec::new(),
            motions: Vec::new(),
            inputs: Vec::new(),
            controllers: Vec::new(),
            records: Vec::new(),
            processes: Vec::new(),
            run: Run::default(),
            solver: Options::default(),
            statics: StaticsOptions::default(),
        }
    }
}

/// An error and the spec that it belongs to, as kind and index.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{error}")]
pub struct SceneError {
    /// The spec, if the error belongs to one.
    pub spec: Option<(SpecKind, usize)>,
    /// What is wrong.
    pub error: BuildError,
}

impl Scene {
    /// An empty scene.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the acceleration of gravity [m/s²]; what feels it says a force, such as that of weight.
    pub fn set_gravity(&mut self, gravity: V3<f64>) -> &mut Self {
        self.gravity = gravity;
        self
    }

    /// Adds an element.
    pub fn element(&mut self, spec: impl ElementSpec + 'static) -> &mut Self {
        self.elements.push(Arc::new(spec));
        self
    }
    /// Adds a constraint.
    pub fn constraint(&mut self, spec: impl ConstraintSpec + 'static) -> &mut Self {
        self.constraints.push(Arc::new(spec));
        self
    }
    /// Adds a force.
    pub fn force(&mut self, spec: impl ForceSpec + 'static) -> &mut Self {
        self.forces.push(Arc::new(spec));
        self
    }
    /// Adds a motion.
    pub fn motion(&mut self, spec: impl MotionSpec + 'static) -> &mut Self {
        self.motions.push(Arc::new(spec));
        self
    }
    /// Adds an input.
    pub fn input(&mut self, spec: InputSpec) -> &mut Self {
        self.inputs.push(spec);
        self
    }
    /// Adds a controller.
    pub fn controller(&mut self, spec: impl ControllerSpec + 'static) -> &mut Self {
        self.controllers.push(Arc::new(spec));
        self
    }
    /// Adds a record.
    pub fn record(&mut self, spec: impl RecordSpec + 'static) -> &mut Self {
        self.records.push(Arc::new(spec));
        self
    }

    /// Sets a process up.
    pub fn process(&mut self, spec: impl ProcessSpec + 'static) -> &mut Self {
        self.processes.push(Arc::new(spec));
        self
    }

    /// What is wrong with gravity, water and air, if anything.
    fn check_world(&self) -> Result<(), BuildError> {
        ropewalk_core::error::finite("gravity", &self.gravity)?;
        self.water.as_ref().map_or(Ok(()), Water::check)?;
        self.check_rest()?;
        self.air.as_ref().map_or(Ok(()), |air| air.check(self.water.as_ref()))
    }

    /// Waves have no equilibrium: what is in one begins in still water.
    fn check_rest(&self) -> Result<(), BuildError> {
        let Some(waves) = self.water.as_ref().and_then(|water| water.waves.as_ref()) else { return Ok(()) };
        if self.run.analysis == Analysis::Statics {
            let message = "there is no equilibrium in waves: leave [water.waves] out, or run in time";
            return Err(BuildError::at("water.waves", message));
        }
        if self.run.from_equilibrium && !(waves.ramp > 0.0) {
            let message =
                "an equilibrium is in still water: let the waves rise from it, such as `ramp = \"60 s\"`";
            return Err(BuildError::at("water.waves", message));
        }
        Ok(())
    }

    /// The process of the scene at its start, if it is one of a process.
    ///
    /// # Errors
    /// The first thing that is wrong, with the spec that it belongs to; a process beside elements or another one.
    pub fn start_process(&self) -> Result<Option<Box<dyn Process>>, SceneError> {
        let of = |kind, k| move |error| SceneError { spec: Some((kind, k)), error };
        let whole = |error: BuildError| SceneError { spec: None, error };
        let Some(spec) = self.processes.first() else { return Ok(None) };
        let message = "a process is a problem of its own: a scene holds one, and no elements, constraints, forces or \
                       records beside it";
        let others = [
            (SpecKind::Process, self.processes.len() - 1, 1),
            (SpecKind::Element, self.elements.len(), 0),
            (SpecKind::Constraint, self.constraints.len(), 0),
            (SpecKind::Force, self.forces.len(), 0),
            (SpecKind::Record, self.records.len(), 0),
        ];
        if let Some((kind, _, k)) = others.into_iter().find(|(_, count, _)| *count > 0) {
            return Err(of(kind, k)(BuildError::new(message)));
        }
        if self.run.analysis != Analysis::Dynamics || self.run.from_equilibrium {
            let message = "a process runs in time from the start that it is given itself";
            return Err(whole(BuildError::at("run", message)));
        }
        self.check_world().map_err(whole)?;
        self.run.check().map_err(whole)?;
        let inputs = Inputs::build(&self.inputs).map_err(|(k, e)| of(SpecKind::Input, k)(e))?;
        let duration = self.run.duration;
        let motions =
            build_all(&self.motions, &inputs, duration).map_err(|(k, e)| of(SpecKind::Motion, k)(e))?;
        let (gravity, mut water, all) = (self.gravity, self.water.clone(), inputs.all().to_vec());
        if water.as_ref().is_some_and(|water| water.waves.is_some()) {
            let message = "a process has water without waves: leave [water.waves] out";
            return Err(whole(BuildError::at("water.waves", message)));
        }
        water.as_mut().map_or(Ok(()), |water| water.bind(&inputs, gravity)).map_err(whole)?;
        let around = Surroundings { gravity, water, motions, inputs, duration };
        let process = spec.build(&around).map_err(of(SpecKind::Process, 0))?;
        if all.is_empty() && self.controllers.is_empty() {
            return Ok(Some(process));
        }
        let steered = Steered::new(process, (spec.name(), spec.channels()), all, |model, records| {
            controllers::build_all(&self.controllers, model, records, duration)
        });
        let steered = steered.map_err(|(k, e)| of(SpecKind::Controller, k)(e))?;
        Ok(Some(Box::new(steered)))
    }

    /// Builds the model.
    ///
    /// # Errors
    /// The first thing that is wrong, with the spec that it belongs to.
    pub fn build(&self) -> Result<Model, SceneError> {
        self.build_on(&Plan::new())
    }

    /// Builds the model with other meshes for some parts: what remeshing while running does. Markers and records
    /// bind by name, so they hold on to the same material. [`Model::carry`] brings the state over.
    ///
    /// # Errors
    /// As [`Scene::build`].
    pub fn build_on(&self, plan: &Plan) -> Result<Model, SceneError> {
        self.build_as(plan, self.run.analysis == Analysis::Statics)
    }

    /// Builds the model in which a run in time looks for the equilibrium that it starts from: what changes with time is there
    /// as if it stayed as it is. States fit both models.
    ///
    /// # Errors
    /// As [`Scene::build`].
    pub fn build_at_rest(&self) -> Result<Model, SceneError> {
        self.build_as(&Plan::new(), true)
    }

    fn build_as(&self, plan: &Plan, statics: bool) -> Result<Model, SceneError> {
        if !self.processes.is_empty() {
            // what there is to build is in the process
            self.start_process()?;
            return Ok(Model::new(Vec::new(), Vec::new(), Vec::new(), Vec::new(), Start::default(), 1.0));
        }
        // what failed before has been told, or was of no account
        let _ = ropewalk_core::broken::take();
        let mut b = Builder::new();
        let of = |kind, k| move |error| SceneError { spec: Some((kind, k)), error };
        let whole = |error: BuildError| {
            let named = self.constraints.iter().position(|c| Some(c.name()) == error.field.as_deref());
            SceneError { spec: named.map(|k| (SpecKind::Constraint, k)), error }
        };
        self.check_world().map_err(whole)?;
        let inputs = Inputs::build(&self.inputs).map_err(|(k, e)| of(SpecKind::Input, k)(e))?;
        let (mut water, mut air) = (self.water.clone(), self.air.clone());
        water.as_mut().map_or(Ok(()), |water| water.bind(&inputs, self.gravity)).map_err(whole)?;
        air.as_mut().map_or(Ok(()), |air| air.bind(&inputs)).map_err(whole)?;
        b.set_world(self.gravity, water, air);
        b.set_statics(statics);
        for (part, mesh) in plan {
            b.remesh(part, mesh.clone());
        }
        b.set_motions(
            build_all(&self.motions, &inputs, self.run.duration)
                .map_err(|(k, e)| of(SpecKind::Motion, k)(e))?,
        );
        b.set_inputs(inputs);
        for e in &self.elements {
            b.pin(&e.pins().iter().collect::<Vec<_>>());
        }
        for c in &self.constraints {
            b.pin(&c.markers());
        }
        for f in &self.forces {
            b.pin(&f.markers());
        }
        for (k, c) in self.constraints.iter().enumerate() {
            if let Some((marker, feed)) = c.feeds() {
                b.feed(c.name(), marker, feed).map_err(of(SpecKind::Constraint, k))?;
            }
        }
        for (k, c) in self.constraints.iter().enumerate() {
            b.guides(c.guides()).map_err(of(SpecKind::Constraint, k))?;
        }
        for on in self.forces.iter().filter_map(|f| f.weighs()) {
            b.weigh(on);
        }
        for (k, e) in self.elements.iter().enumerate() {
            e.build(&mut b).map_err(of(SpecKind::Element, k))?;
        }
        for (k, c) in self.constraints.iter().enumerate() {
            c.build(&mut b).map_err(of(SpecKind::Constraint, k))?;
        }
        for (k, f) in self.forces.iter().enumerate() {
            f.build(&mut b).map_err(of(SpecKind::Force, k))?;
        }
        self.run.check().map_err(whole)?;
        self.statics.check().map_err(whole)?;
        self.solver.check().map_err(|e| whole(e.of("solver")))?;
        let changes = b.changes();
        let model = b.finish().map_err(whole)?;
        let recipe = changes.then(|| {
            let scene = self.clone();
            Arc::new(move |plan: &Plan| scene.build_on(plan).map_err(|e| e.error)) as Arc<Recipe>
        });
        let model = model.with_plan(plan.clone(), recipe);
        for c in model.constraints() {
            let ((first, last), name) = (c.range(), c.name());
            if first > 0.0 {
                let message = format!(
                    "the motion of `{name}` is defined from t = {first} s on, but the run begins at 0 s: begin its \
                     table there"
                );
                return Err(whole(BuildError::at(name, message)));
            }
            if last < self.run.duration {
                let message = format!(
                    "the motion of `{name}` is defined up to t = {last} s, but the run goes on to {} s: extend its \
                     table or shorten `duration`",
                    self.run.duration
                );
                return Err(whole(BuildError::at(name, message)));
            }
        }
        if self.controllers.is_empty() {
            return Ok(model);
        }
        let records = self.records(&model)?;
        let controls = controllers::build_all(&self.controllers, &model, records, self.run.duration);
        Ok(model.with_controls(controls.map_err(|(k, e)| of(SpecKind::Controller, k)(e))?))
    }

    /// The records of the scene for its model, each with a name of its own.
    ///
    /// # Errors
    /// The first record that can't be made; two records or columns of one name.
    pub fn records(&self, model: &Model) -> Result<Vec<Box<dyn Record>>, SceneError> {
        let of = |k| move |error| SceneError { spec: Some((SpecKind::Record, k)), error };
        let twice = |what: &str, name: &str| {
            let message = format!("there are two {what} named `{name}`: give one of them a `name`");
            BuildError::at("name", message)
        };
        let (mut names, mut columns) = (HashSet::new(), HashSet::new());
        let mut all = Vec::with_capacity(self.records.len());
        for (k, spec) in self.records.iter().enumerate() {
            let record = spec.build(model).map_err(of(k))?;
            if !names.insert(record.name()) {
                return Err(of(k)(twice("records", &record.name())));
            }
            if let Some(column) = record.columns().into_iter().find(|c| !columns.insert(c.name.clone())) {
                return Err(of(k)(twice("columns", &column.name)));
            }
            all.push(record);
        }
        Ok(all)
    }
}
