//! A run: a scene, computed into a folder of its own.

mod checkpoint;
mod manifest;
mod pictures;
mod recorder;
mod report;
mod shapes;
mod start;
mod summary;
mod surfacing;
mod tables;

pub use checkpoint::Every;
pub use manifest::Manifest;
pub(crate) use pictures::{PLANES, planes, view};
pub(crate) use recorder::Recorder;
use recorder::Warnings;
pub(crate) use shapes::{Shape, last as last_shape, read as read_shapes};
pub(crate) use start::{Ending, Started};
pub use summary::{Counts, CriticalLoad, EnergyTotals, Happened, ProfileEntry, Summary};

use crate::error::Error;
use checkpoint::Saver;
use ropewalk_core::Audit;
use ropewalk_report::{Elapsed, Interrupt, Progress, ProgressMode, RunFolder, Stopwatch, Table, TableWriter};
use ropewalk_scene::{Fault, SceneFile};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;

/// What may be chosen about a run beside its scene.
#[derive(Clone, Debug, Default)]
pub struct RunOptions {
    /// The folder for the results, which must be new or empty; without it `runs/<scene>`, numbered.
    pub out: Option<PathBuf>,
    /// Whether to measure the time of every term.
    pub profile: bool,
    /// How to show the progress.
    pub progress: ProgressMode,
    /// When to write checkpoints, from which [`resume`] goes on; without it, none.
    pub checkpoint: Option<Every>,
}

/// How a run ended and where its results are.
#[derive(Debug)]
pub struct Outcome {
    /// The folder with all results.
    pub folder: RunFolder,
    /// What `summary.json` says. The status is `finished`, `stopped` (by an event), `interrupted` (by Ctrl-C) or
    /// `failed` (the solver gave up).
    pub summary: Summary,
    /// What `history.csv` says.
    pub history: Table,
    /// Names of the pictures in `plots/`, without ending.
    pub pictures: Vec<String>,
    /// A summary for people, several lines.
    pub report: String,
}

/// Runs a scene into a folder of its own. What one should know although the run goes on is said by `warn`, at once.
///
/// A run that fails or is interrupted is an `Ok` too: all that it computed until then is in the folder, and the
/// summary says how it ended.
///
/// # Errors
/// The run could not even begin: the scene is wrong, or the folder can't be used.
pub fn run(file: &SceneFile, options: &RunOptions, warn: &mut dyn FnMut(&str)) -> Result<Outcome, Error> {
    run_showing(file, options, &|t_end| Progress::new(0.0, t_end, options.progress), warn)
}

/// As [`run`], but with a progress of its own, which is asked for when the computing begins.
pub(crate) fn run_showing(
    file: &SceneFile,
    options: &RunOptions,
    progress: &dyn Fn(f64) -> Progress,
    warn: &mut dyn FnMut(&str),
) -> Result<Outcome, Error> {
    let mut warnings = Warnings { all: Vec::new(), tell: Some(warn) };
    let scene = file.scene();
    let model = file.build()?;
    let records = file.records(&model)?;
    let manifest = Manifest::new(file, &model)?;
    for name in file.document().unused_parameters() {
        warnings.say(&format!("parameter `{name}` is not used by the scene"));
    }

    let mut recorder = Recorder::new(scene, records);
    if let Err(message) = tables::check(scene, &recorder.table) {
        return Err(file.document().fault_at("run.tables", message).into());
    }

    let is_new = options.out.as_ref().is_none_or(|out| !out.exists());
    let folder = RunFolder::create(options.out.clone(), file.name())?;
    let stopwatch = Stopwatch::start();
    let started = match Started::new(scene, model) {
        Err(e) if e.is_input() => {
            if is_new {
                // best effort, and it only removes a folder that is empty
                let _ = std::fs::remove_dir(folder.path());
            }
            return Err(at_section(file, e));
        }
        other => other,
    };
    folder.write_scene(&file.document().to_toml())?;
    folder.write_manifest(&manifest)?;
    let notes = manifest.notes;
    recorder.writer = Some(TableWriter::create(&folder.history_file(), &recorder.table)?);
    recorder.progress = Some(progress(scene.run.duration));
    if let Ok(started) = &started {
        started.warnings(scene).iter().for_each(|w| warnings.say(w));
        match (started, options.checkpoint) {
            (Started::Statics(_) | Started::Process(..), Some(_)) => {
                warnings.say("no checkpoints are written: they are for runs in time of elements and bodies");
            }
            (_, Some(every)) => {
                let saver = Saver::new(
                    &folder,
                    file.name(),
                    every,
                    started,
                    &warnings.all,
                    Elapsed::default(),
                    stopwatch,
                );
                recorder.saver = Some(saver?);
            }
            (_, None) => {}
        }
    }
    let before = Elapsed::default();
    let course = Course { file, folder, recorder, stopwatch, before, resumed: false, notes };
    course.complete(started, options.profile, warnings)
}

/// Goes on with the run in the folder `options.out`, from its last checkpoint. What it recorded after that is computed
/// again. Checkpoints go on as before unless the options say otherwise.
///
/// # Errors
/// There is no checkpoint, or it belongs to another scene or another version of the program.
pub fn resume(options: &RunOptions, warn: &mut dyn FnMut(&str)) -> Result<Outcome, Error> {
    let folder = RunFolder::earlier(options.out.clone().unwrap_or_default());
    let saved = checkpoint::read(&folder)?;
    let path = folder.scene_file();
    let file = SceneFile::open(&path.display().to_string(), &[], &[])?.named(&saved.name);
    let stopwatch = Stopwatch::start();
    let started = Started::resumed(&file, &saved)?;
    let Started::Dynamics(simulation, ..) = &started else { unreachable!("only runs in time are resumed") };
    let mut recorder = Recorder::new(file.scene(), file.records(&simulation.model)?);
    recorder.take_up(&saved).map_err(Fault::new)?;
    let warnings = Warnings { all: saved.warnings.to_vec(), tell: Some(warn) };
    let before = Elapsed { cpu_s: saved.cpu_s, wall_s: saved.wall_s };
    let every = options.checkpoint.unwrap_or(saved.every);
    recorder.saver =
        Some(Saver::new(&folder, &saved.name, every, &started, &warnings.all, before, stopwatch)?);
    recorder.writer = Some(TableWriter::resume(&folder.history_file(), &recorder.table)?);
    // what it says is of rows that are computed again
    let _ = std::fs::remove_file(folder.summary_file());
    let (t, end) = (saved.simulation.state.t, file.scene().run.duration);
    recorder.progress = Some(Progress::new(t, end, options.progress));
    let notes = manifest::notes(file.scene(), &simulation.model);
    let course = Course { file: &file, folder, recorder, stopwatch, before, resumed: true, notes };
    course.complete(Ok(started), options.profile, warnings)
}

/// A run from where everything is ready for it to where everything is written.
struct Course<'a> {
    file: &'a SceneFile,
    folder: RunFolder,
    recorder: Recorder<'a>,
    stopwatch: Stopwatch,
    /// What was spent on it before it was resumed.
    before: Elapsed,
    resumed: bool,
    /// What its constraints have to say.
    notes: Vec<String>,
}

impl<'a> Course<'a> {
    fn complete(
        self,
        mut started: Result<Started, Error>,
        measure: bool,
        mut warnings: Warnings<'a>,
    ) -> Result<Outcome, Error> {
        let Course { file, folder, mut recorder, stopwatch, before, resumed, notes } = self;
        match Interrupt::install() {
            Ok(interrupt) => recorder.interrupt = Some(interrupt),
            Err(e) => warnings.say(&e.to_string()),
        }
        let mut profile = None;
        let ending = match &mut started {
            Err(_) => None,
            Ok(started) => {
                if measure {
                    started.profile();
                }
                let clock = std::time::Instant::now();
                recorder.warnings = warnings;
                // a defect must not take what was computed with it
                let go = || started.go(file.scene(), &mut recorder, resumed);
                let ending = catch_unwind(AssertUnwindSafe(go)).unwrap_or_else(|_| {
                    Ending::Failed(Error::Process("an internal error, see above: please report it".into()))
                });
                warnings = std::mem::take(&mut recorder.warnings);
                started.afterthought().iter().for_each(|w| warnings.say(w));
                recorder.afterthought().iter().for_each(|w| warnings.say(w));
                if measure {
                    profile = Some(shares(started.times(), clock.elapsed().as_secs_f64()));
                }
                Some(ending)
            }
        };
        if let Some(progress) = recorder.progress.take() {
            progress.finish("");
        }
        let elapsed = stopwatch.elapsed();
        if let Some(e) = recorder.saver.as_mut().and_then(|s| s.trouble.take()) {
            warnings.say(&format!("the last checkpoint is older than it should be: {e}"));
        }
        let mut summary = Summary {
            cpu_s: before.cpu_s + elapsed.cpu_s,
            wall_s: before.wall_s + elapsed.wall_s,
            profile,
            notes,
            ..Summary::default()
        };
        let ending = match (started, ending) {
            (Ok(started), ending) => {
                let done = started.done();
                recorder.last_shape(&done.model, &done.state);
                summary.critical = done.critical_loads();
                (summary.counts, summary.energy) = (done.counts, energy(&done.audit));
                ending.unwrap_or(Ending::Finished)
            }
            (Err(e), _) => Ending::Failed(e),
        };
        let word = match &ending {
            Ending::Finished => "finished",
            Ending::Stopped(_) => "stopped",
            Ending::Interrupted => "interrupted",
            Ending::Failed(_) => "failed",
        };
        summary.status = word.into();
        summary.message = match &ending {
            Ending::Finished => None,
            Ending::Stopped(by) => Some(format!("stopped by {by}")),
            Ending::Interrupted => Some(format!("stopped by {}", Interrupt::cause())),
            Ending::Failed(error) => Some(error.to_string()),
        };
        if let Some(writer) = recorder.writer.take() {
            writer.finish().unwrap_or_else(|e| warnings.say(&e.to_string()));
        }
        recorder.finals(&mut summary);
        let pictures =
            pictures::draw(&folder, file.title(), &recorder, &summary.critical, &mut |w| warnings.say(w));
        shapes::write(&folder, &recorder.table.columns[0], &recorder.shapes)
            .unwrap_or_else(|e| warnings.say(&e.to_string()));
        let tables = tables::write(&folder, &recorder, &mut |w| warnings.say(w));
        summary.warnings = warnings.all;
        if matches!(ending, Ending::Finished | Ending::Stopped(_)) && recorder.saver.is_some() {
            // there is nothing left to go on with
            let _ = std::fs::remove_file(folder.checkpoint_file());
        }
        // last of all: who finds a summary finds everything
        if let Err(e) = folder.write_summary(&summary) {
            (summary.status, summary.message) = ("failed".into(), Some(e.to_string()));
        }
        let report = report::report(file, &summary, &recorder, &folder, &pictures, &tables);
        Ok(Outcome { folder, summary, history: recorder.table, pictures, report })
    }
}

/// A start that is refused is the fault of a section of the scene: point there.
fn at_section(file: &SceneFile, e: Error) -> Error {
    match e {
        Error::Step(e) => Error::File(file.at_solver(e.to_string())),
        Error::Scene(e) => Error::File(file.fault(&e)),
        e => e,
    }
}

fn energy(a: &Audit) -> EnergyTotals {
    EnergyTotals {
        kinetic: a.kinetic,
        potential: a.potential,
        supplied: a.supplied,
        carried: a.carried,
        dissipated: a.dissipated,
        initial: a.initial,
        imbalance: a.imbalance(),
    }
}

/// Adds what is not in any term or phase: Newton's method, recording.
fn shares(mut entries: Vec<ProfileEntry>, total: f64) -> Vec<ProfileEntry> {
    let known: f64 = entries.iter().map(|e| e.seconds).sum();
    let label = "integrator and output".to_string();
    entries.push(ProfileEntry { label, calls: 1, seconds: (total - known).max(0.0), share: 0.0 });
    for e in &mut entries {
        e.share = if total > 0.0 { e.seconds / total } else { 0.0 };
    }
    entries
}
