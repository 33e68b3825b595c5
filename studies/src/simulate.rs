//! A scene run in memory: for use from Rust, and for all studies of many runs.

use crate::error::Error;
use crate::run::{Counts, CriticalLoad, Ending, ProfileEntry, Recorder, Started, Status, Summary};
use ropewalk_core::integrator::Limit;
use ropewalk_core::{Audit, Model, Simulation, State, V3};
use ropewalk_models::scenes;
use ropewalk_report::{Elapsed, Progress, Stopwatch, Table, Watch};
use ropewalk_scene::{Analysis, Fault, Scene, SceneFile};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

/// Reads a scene: a bundled one by its name, or a `.toml` or `.json` file.
///
/// # Errors
/// There is no such scene, or anything is wrong with it.
pub fn read(scene: impl AsRef<Path>) -> Result<Scene, Error> {
    let scene = scene.as_ref().to_string_lossy();
    Ok(SceneFile::open(&scene, &[], scenes())?.into_scene())
}

/// What a run computed: the records over time, and where it ended.
pub struct History {
    /// The records over time, or over the load factor in statics, which is the first column.
    pub table: Table,
    /// The state at the end.
    pub state: State,
    /// The model at the end: another than at the start if it was remeshed.
    pub model: Arc<Model>,
    /// The balance of energy.
    pub audit: Audit,
    /// How much work it was.
    pub counts: Counts,
    /// How long building and running took.
    pub elapsed: Elapsed,
    /// Loads at which equilibria lost their stability, in the order of the path.
    pub critical: Vec<CriticalLoad>,
    /// What stopped the run before its end, if anything did.
    pub stopped_by: Option<String>,
    /// What one should know although the run went on.
    pub warnings: Vec<String>,
    /// How it ended.
    pub(crate) ending: Ending,
    /// How many steps were limited by what, in the order of [`Limit::ALL`].
    pub(crate) limits: [u64; Limit::ALL.len()],
    /// Where the time went, if that was asked for; it adds up to the CPU time.
    pub(crate) profile: Vec<ProfileEntry>,
    /// Positions of all nodes at some rows, if they were asked for …
    pub(crate) positions: Vec<Vec<V3<f64>>>,
    /// … and the length that they are measured by [m].
    pub(crate) length: f64,
}

impl History {
    /// The times, or load factors, of the rows.
    pub fn times(&self) -> &[f64] {
        self.table.columns.first().map_or(&[], |c| &c.values)
    }
    /// The values of a column such as `hose.end.x`.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        self.table.column(name).map(|c| c.values.as_slice())
    }
    /// How it ended.
    pub fn status(&self) -> Status {
        self.ending.status()
    }
    /// Why the solver gave up, if it did.
    pub fn error(&self) -> Option<&Error> {
        match &self.ending {
            Ending::Failed(error) => Some(error),
            _ => None,
        }
    }
    /// What `summary.json` would say of it.
    pub fn summary(&self) -> Summary {
        let mut summary = Summary {
            status: self.status(),
            message: self.ending.message(),
            warnings: self.warnings.clone(),
            critical: self.critical.clone(),
            rows: self.table.rows(),
            counts: self.counts,
            energy: (&self.audit).into(),
            cpu_s: self.elapsed.cpu_s,
            wall_s: self.elapsed.wall_s,
            ..Summary::default()
        };
        summary.set_finals(&self.table);
        summary.set_limits(&self.limits);
        summary
    }
    /// The last value of a column.
    pub fn last(&self, name: &str) -> Option<f64> {
        self.column(name)?.last().copied()
    }
}

/// Runs a scene and keeps its records in memory; nothing is written.
///
/// # Errors
/// The scene can't be built, or the solver gave up. [`simulate_with`] keeps what was computed until then.
pub fn simulate(scene: &Scene) -> Result<History, Error> {
    compute(scene, How::default())?.complete()
}

/// As [`simulate`], until `watch` stops it. A run that was stopped or that the solver gave up is a history too, as far as
/// it was computed: [`History::status`] tells.
///
/// # Errors
/// The run could not begin: the scene is wrong, or there is no equilibrium for it to start from.
pub fn simulate_with(scene: &Scene, watch: Watch) -> Result<History, Error> {
    compute(scene, How { watch, ..How::default() })
}

/// A scene at its start, to be moved step by step, and what one should know about it. Scenes whose analysis isn't a run in
/// time have no steps.
///
/// # Errors
/// The scene can't be built, is no run in time, or `watch` stopped the search for the equilibrium that it starts from.
pub fn start(scene: &Scene, watch: Watch) -> Result<(Simulation, Vec<String>), Error> {
    in_time(scene)?;
    let started = Started::new(scene, scene.build()?, watch)?;
    let warnings = started.warnings(scene);
    match started {
        Started::Dynamics(simulation, ..) => Ok((*simulation, warnings)),
        Started::Statics(_) | Started::Process(..) => unreachable!("only runs in time come so far"),
    }
}

/// Whether a scene is a run in time of elements and bodies, which steps can be taken of.
///
/// # Errors
/// It isn't.
pub(crate) fn in_time(scene: &Scene) -> Result<(), Error> {
    if scene.run.analysis == Analysis::Dynamics && scene.processes.is_empty() {
        return Ok(());
    }
    let fault = Fault::new("this scene is no run in time, so there are no steps to be taken");
    Err(fault.with_help("run it as a whole").into())
}

/// How a scene is computed in memory.
#[derive(Default)]
pub(crate) struct How {
    /// What may stop it.
    pub watch: Watch,
    /// Where it shows its progress.
    pub progress: Option<Progress>,
    /// Whether to measure where the time goes.
    pub profile: bool,
    /// Whether to keep positions of all nodes.
    pub positions: bool,
}

/// Computes a scene in memory: all studies of many runs stand on this. A run that fails or is stopped is a history too, as
/// far as it was computed.
///
/// # Errors
/// The run could not begin.
pub(crate) fn compute(scene: &Scene, how: How) -> Result<History, Error> {
    let stopwatch = Stopwatch::start();
    let model = scene.build()?;
    let length = model.length();
    let records = scene.records(&model)?;
    let built = stopwatch.elapsed().wall_s;
    let mut recorder = Recorder::new(scene, records);
    (recorder.watch, recorder.progress) = (how.watch, how.progress);
    recorder.track = how.positions.then(Vec::new);
    let mut started = Started::new(scene, model, how.watch)?;
    recorder.warnings.all = started.warnings(scene);
    let begun = stopwatch.elapsed().wall_s;
    if how.profile {
        started.profile();
        recorder.spent = Some((0, Duration::ZERO));
    }
    let ending = started.go(&mut recorder, false);
    let elapsed = stopwatch.elapsed();
    let mut profile = Vec::new();
    if how.profile {
        profile = started.times(recorder.spent, elapsed.wall_s - begun);
        profile.push(ProfileEntry::new("start", 1, begun - built));
        profile.push(ProfileEntry::new("building the model", 1, built));
        // clocks run on while others compute; every line is equally likely to wait
        for entry in &mut profile {
            entry.share = entry.seconds / elapsed.wall_s;
            entry.seconds = entry.share * elapsed.cpu_or_wall_s();
        }
    }
    let limits = started.limits();
    let done = started.done();
    Ok(History {
        table: recorder.table,
        critical: done.critical_loads(),
        state: done.state,
        model: done.model,
        audit: done.audit,
        counts: done.counts,
        elapsed,
        stopped_by: ending.stopped_by(),
        warnings: recorder.warnings.all,
        ending,
        limits,
        profile,
        positions: recorder.track.unwrap_or_default(),
        length,
    })
}

impl History {
    /// The same, or the error that ended it.
    pub(crate) fn complete(self) -> Result<Self, Error> {
        match self.ending {
            Ending::Failed(error) => Err(error),
            _ => Ok(self),
        }
    }
}
