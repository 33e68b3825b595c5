//! A scene run in memory, for use from Rust.

use crate::error::Error;
use crate::run::{Counts, CriticalLoad, Ending, Recorder, Started};
use ropewalk_core::{Audit, Model, State};
use ropewalk_models::bundled;
use ropewalk_report::{Interrupt, Progress, Table};
use ropewalk_scene::{Scene, SceneFile};
use std::path::Path;
use std::sync::Arc;

/// Reads a scene: a bundled one by its name, or a `.toml` or `.json` file.
///
/// # Errors
/// There is no such scene, or anything is wrong with it.
pub fn read(scene: impl AsRef<Path>) -> Result<Scene, Error> {
    let scene = scene.as_ref().to_string_lossy();
    Ok(SceneFile::open(&scene, &[], bundled())?.into_scene())
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
    /// Loads at which equilibria lost their stability, in the order of the path.
    pub critical: Vec<CriticalLoad>,
    /// What stopped the run before its end, if anything did.
    pub stopped_by: Option<String>,
    /// What one should know although the run went on.
    pub warnings: Vec<String>,
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
    /// The last value of a column.
    pub fn last(&self, name: &str) -> Option<f64> {
        self.column(name)?.last().copied()
    }
}

/// Runs a scene and keeps its records in memory; nothing is written.
///
/// # Errors
/// The scene can't be built, or the solver gave up. To keep what was computed until then, drive a
/// [`Simulation`](crate::Simulation) with an observer, or [`run`](crate::run) the scene into a folder.
pub fn simulate(scene: &Scene) -> Result<History, Error> {
    simulate_showing(scene, None, None)
}

/// As [`simulate`], with a progress bar, and stopped by Ctrl-C.
pub(crate) fn simulate_showing(
    scene: &Scene,
    progress: Option<Progress>,
    interrupt: Option<Interrupt>,
) -> Result<History, Error> {
    let model = scene.build()?;
    let mut recorder = Recorder::new(scene, scene.records(&model)?);
    (recorder.progress, recorder.interrupt) = (progress, interrupt);
    let mut started = Started::new(scene, model)?;
    recorder.warnings.all = started.warnings(scene);
    let ending = started.go(scene, &mut recorder, false);
    let mut warnings = std::mem::take(&mut recorder.warnings.all);
    if let Some(progress) = recorder.progress.take() {
        progress.finish("");
    }
    warnings.extend(started.afterthought());
    warnings.extend(recorder.afterthought());
    let stopped_by = match ending {
        Ending::Finished => None,
        Ending::Stopped(by) => Some(by),
        Ending::Interrupted => Some(Interrupt::cause().into()),
        Ending::Failed(error) => return Err(error),
    };
    let (table, done) = (recorder.table, started.done());
    let critical = done.critical_loads();
    let (state, model, audit, counts) = (done.state, done.model, done.audit, done.counts);
    Ok(History { table, state, model, audit, counts, critical, stopped_by, warnings })
}
