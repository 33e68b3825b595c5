//! A run that is moved from outside: by a program, a controller or another simulation.

use crate::error::Error;
use crate::run::Counts;
use crate::simulate::start;
use ropewalk_core::integrator::StepReport;
use ropewalk_core::{Checkpoint, End, Input, Model, Observer, Record, Sample, Simulation, State, Unfit};
use ropewalk_report::{Column, Watch};
use ropewalk_scene::{Fault, Process, SceneFile};
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;
use std::sync::Arc;

/// A scene in motion, with its records by name.
pub struct Session {
    file: SceneFile,
    moving: Moving,
    columns: Vec<Column>,
    /// The records at the present instant, once they were asked for.
    row: Option<Vec<f64>>,
    stopped_by: Option<String>,
    warnings: Vec<String>,
}

/// What moves.
enum Moving {
    Model(Box<Modelled>),
    /// A process, and the time that it was asked to come to [s]: it may be off by rounding.
    Process(Box<dyn Process>, f64),
}

/// A model in motion with its records.
struct Modelled {
    simulation: Simulation,
    records: Vec<Box<dyn Record>>,
    /// The model that the records are bound to.
    bound: Arc<Model>,
}

/// The complete state of a [`Session`], from which it goes on to the last bit.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Snapshot {
    checkpoint: Checkpoint,
    stopped_by: Option<String>,
}

/// Asked after every step of the solver whether to go on.
type Ask<'a> = &'a mut dyn FnMut() -> ControlFlow<()>;

/// Looks at every step; takes no samples.
struct Steps<'a> {
    ask: Ask<'a>,
    warnings: &'a mut Vec<String>,
    asked_to_stop: bool,
}

impl Observer for Steps<'_> {
    fn wants_samples(&self) -> bool {
        false
    }
    fn step(&mut self, _: &Model, _: &State, _: &StepReport) -> ControlFlow<()> {
        let answer = (self.ask)();
        self.asked_to_stop = answer.is_break();
        answer
    }
    fn warn(&mut self, text: &str) {
        self.warnings.push(text.into());
    }
}

/// Evaluates the records.
struct Look<'a> {
    records: &'a [Box<dyn Record>],
    row: Vec<f64>,
}

impl Observer for Look<'_> {
    fn needs_forces(&self) -> bool {
        self.records.iter().any(|r| r.needs_forces())
    }
    fn needs_strains(&self) -> bool {
        self.records.iter().any(|r| r.needs_strains())
    }
    fn needs_energy(&self) -> bool {
        self.records.iter().any(|r| r.needs_energy())
    }
    fn sample(&mut self, s: &Sample<'_>) -> ControlFlow<()> {
        self.row.clear();
        self.records.iter().for_each(|r| r.sample(s, &mut self.row));
        ControlFlow::Continue(())
    }
}

impl Session {
    /// A scene at its start.
    ///
    /// # Errors
    /// The scene is wrong or is no run in time, or `watch` stopped the search for the equilibrium that it starts from.
    pub fn start(file: SceneFile, watch: Watch) -> Result<Self, Error> {
        let process = file.scene().start_process().map_err(|e| Error::from(e).in_file(&file))?;
        let (moving, columns, warnings) = match process {
            Some(process) => {
                let channels = file.scene().processes.iter().flat_map(|p| p.channels());
                let columns = channels.flat_map(|c| c.columns).map(plain).collect();
                let warnings = process.warnings();
                (Moving::Process(process, 0.0), columns, warnings)
            }
            None => {
                let (simulation, warnings) = start(file.scene(), watch).map_err(|e| e.in_file(&file))?;
                let records = file.records(&simulation.model)?;
                let (columns, bound) = (columns(&records), simulation.model.clone());
                (Moving::Model(Box::new(Modelled { simulation, records, bound })), columns, warnings)
            }
        };
        Ok(Session { file, moving, columns, row: None, stopped_by: None, warnings })
    }

    /// The scene that it was started from.
    pub fn file(&self) -> &SceneFile {
        &self.file
    }
    /// Model, state, counters and balance of energy; a process has none.
    pub fn simulation(&self) -> Option<&Simulation> {
        match &self.moving {
            Moving::Model(m) => Some(&m.simulation),
            Moving::Process(..) => None,
        }
    }
    /// How much work it was so far.
    pub fn counts(&self) -> Counts {
        match &self.moving {
            Moving::Model(m) => m.simulation.work.counts.into(),
            Moving::Process(process, _) => process.counts().into(),
        }
    }
    /// The inputs of the scene, in its order.
    pub fn inputs(&self) -> &[Arc<Input>] {
        match &self.moving {
            Moving::Model(m) => m.simulation.inputs(),
            Moving::Process(process, _) => process.inputs(),
        }
    }
    /// Present time [s].
    pub fn t(&self) -> f64 {
        match &self.moving {
            Moving::Model(m) => m.simulation.state.t,
            Moving::Process(_, t) => *t,
        }
    }
    /// Length of the run [s], which [`advance`](Self::advance) may exceed.
    pub fn duration(&self) -> f64 {
        self.file.scene().run.duration
    }
    /// The event that ended the motion, if one did. Then nothing moves any more.
    pub fn stopped_by(&self) -> Option<&str> {
        self.stopped_by.as_deref()
    }
    /// Warnings so far.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }
    /// Names and units of the records' columns, without values.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Sets an input of the scene from here on, in the SI unit that it is read in.
    ///
    /// # Errors
    /// There is no such input, a controller sets it, or the value is outside of its limits or no number.
    pub fn set_input(&mut self, name: &str, value: f64) -> Result<(), Error> {
        let set = match &mut self.moving {
            Moving::Model(m) => m.simulation.set_input(name, value),
            Moving::Process(process, _) => process.set_input(name, value),
        };
        set.map_err(|e| Fault::new(e.to_string()))?;
        self.row = None;
        Ok(())
    }

    /// Moves on to the time `to` [s]. A time that has passed changes nothing.
    ///
    /// # Errors
    /// A time that is not finite, or a step that doesn't converge. Then the state is that of the last step.
    pub fn advance(&mut self, to: f64) -> Result<(), Error> {
        self.advance_while(to, &mut || ControlFlow::Continue(()))
    }

    /// As [`advance`](Self::advance), until `ask`, which is called after every step of the solver, breaks; of a process after
    /// every interval of the output.
    ///
    /// # Errors
    /// As [`advance`](Self::advance).
    pub fn advance_while(&mut self, to: f64, ask: Ask<'_>) -> Result<(), Error> {
        if !to.is_finite() {
            return Err(Fault::new(format!("a run can't be moved to t = {to} s")).into());
        }
        let span = to - self.t();
        if self.stopped_by.is_some() || span <= 0.0 {
            return Ok(());
        }
        self.row = None;
        let simulation = match &mut self.moving {
            Moving::Process(process, t) => {
                let interval = self.file.scene().run.interval();
                let done = in_pieces(process.as_mut(), t, to, interval, ask);
                self.warnings = process.warnings();
                self.stopped_by = done?;
                return Ok(());
            }
            Moving::Model(m) => &mut m.simulation,
        };
        let mut steps = Steps { ask, warnings: &mut self.warnings, asked_to_stop: false };
        let end = simulation.advance(to, span, &mut steps)?;
        let asked = steps.asked_to_stop;
        if let End::Stopped { by } = end
            && !asked
        {
            self.stopped_by = Some(by);
        }
        Ok(())
    }

    /// The records at the present instant, one number for each of the [`columns`](Self::columns).
    ///
    /// # Errors
    /// The forces that a record needs can't be found.
    pub fn values(&mut self) -> Result<&[f64], Error> {
        if self.row.is_none() {
            self.row = Some(match &mut self.moving {
                Moving::Model(m) => m.look(&self.file)?,
                Moving::Process(process, _) => {
                    let mut row = Vec::new();
                    process.sample(&mut row);
                    row
                }
            });
        }
        Ok(self.row.as_deref().unwrap_or_default())
    }

    /// One of them by the name of its column.
    ///
    /// # Errors
    /// There is no such column; or as [`values`](Self::values).
    pub fn value(&mut self, name: &str) -> Result<f64, Error> {
        let Some(k) = self.columns.iter().position(|c| c.name == name) else {
            let names: Vec<&str> = self.columns.iter().map(|c| c.name.as_str()).collect();
            let fault = Fault::new(format!("there is no record {}", ropewalk_scene::quoted(name)));
            return Err(fault.with_note(format!("there are {}", names.join(", "))).into());
        };
        Ok(self.values()?.get(k).copied().unwrap_or(f64::NAN))
    }

    /// The complete state. Kept factors are dropped, as restoring does, so that both go on alike.
    ///
    /// # Errors
    /// The state can't be made consistent.
    pub fn snapshot(&mut self) -> Result<Snapshot, Error> {
        let checkpoint = self.model()?.simulation.checkpoint()?;
        Ok(Snapshot { checkpoint, stopped_by: self.stopped_by.clone() })
    }

    /// Goes back, or on, to a state.
    ///
    /// # Errors
    /// The state is that of another scene.
    pub fn restore(&mut self, snapshot: Snapshot) -> Result<(), Error> {
        let Snapshot { checkpoint, stopped_by } = snapshot;
        self.model()?;
        let scene = self.file.scene();
        let model = match checkpoint.meshes.is_empty() {
            true => self.file.build()?,
            false => scene.build_on(&checkpoint.meshes)?,
        };
        let restored = Simulation::restore(model, &scene.solver, scene.run.duration, checkpoint);
        let mut simulation = restored.map_err(|e| match e {
            Unfit::Step(e) => Error::from(e),
            e => Fault::new(e.to_string()).into(),
        })?;
        simulation.keep_audit(scene.run.audit);
        if let Moving::Model(m) = &mut self.moving {
            m.simulation = simulation;
            m.bind(&self.file)?;
        }
        self.stopped_by = stopped_by;
        self.row = None;
        Ok(())
    }

    fn model(&mut self) -> Result<&mut Modelled, Error> {
        match &mut self.moving {
            Moving::Model(m) => Ok(m),
            Moving::Process(..) => {
                let fault = Fault::new("a process keeps no state that one could go back to");
                Err(fault.with_help("start it again, and advance it to where it was").into())
            }
        }
    }
}

impl Modelled {
    /// The records at the present instant.
    fn look(&mut self, file: &SceneFile) -> Result<Vec<f64>, Error> {
        self.bind(file)?;
        let mut look = Look { records: &self.records, row: Vec::new() };
        // an advance that goes nowhere takes one sample
        self.simulation.advance(self.simulation.state.t, 1.0, &mut look)?;
        Ok(look.row)
    }

    /// Binds the records to the model: another one if the mesh has changed.
    fn bind(&mut self, file: &SceneFile) -> Result<(), Error> {
        if !Arc::ptr_eq(&self.bound, &self.simulation.model) {
            self.records = file.records(&self.simulation.model)?;
            self.bound = self.simulation.model.clone();
        }
        Ok(())
    }
}

/// Moves a process on from `t` to another time [s], until `ask` breaks after a piece of it; by what it ended before, if it
/// did.
fn in_pieces(
    process: &mut dyn Process,
    t: &mut f64,
    to: f64,
    piece: f64,
    ask: Ask<'_>,
) -> Result<Option<String>, Error> {
    process.depart(to);
    loop {
        let end = to.min(*t + piece);
        let done = process.advance(end);
        // what it has come to counts, also where it gave up
        *t = if matches!(done, Ok(None)) { end } else { process.t() };
        let stopped_by = done.map_err(Error::Process)?;
        if stopped_by.is_some() || end >= to || ask().is_break() {
            return Ok(stopped_by);
        }
    }
}

/// Names and units of the columns of records.
pub(crate) fn columns(records: &[Box<dyn Record>]) -> Vec<Column> {
    records.iter().flat_map(|r| r.columns()).map(plain).collect()
}

/// A column without values; a plain number has no unit.
fn plain(column: ropewalk_core::Column) -> Column {
    Column::new(column.name, if column.unit == "1" { String::new() } else { column.unit })
}
