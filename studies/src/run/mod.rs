//! A run: a scene, computed into a folder of its own.

mod beside;
mod checkpoint;
mod forces;
mod kept;
mod leave;
mod manifest;
mod page;
mod pictures;
mod prepare;
mod ranges;
mod recorder;
mod report;
mod scenery;
mod shapes;
mod start;
mod statistics;
mod steps;
mod summary;
mod surfacing;
mod tables;
mod view;

pub use beside::compare;
pub use checkpoint::Every;
pub use leave::Leaves;
pub use manifest::Manifest;
pub(crate) use pictures::{PLANES, planes, view};
pub(crate) use prepare::{NewFolder, prepare};
pub(crate) use recorder::Recorder;
use recorder::Warnings;
pub(crate) use scenery::Scenery;
pub(crate) use shapes::{Shape, last as last_shape, read as read_shapes};
pub(crate) use start::{Started, steady, unseen_by};
pub(crate) use summary::Ending;
pub use summary::{Counts, CriticalLoad, EnergyTotals, Happened, ProfileEntry, Status, Summary};
pub use view::{page_of, report_of};

use crate::error::Error;
use checkpoint::{Saver, Wishes};
use prepare::locked;
use ropewalk_report::{
    Elapsed, FolderLock, Page, Progress, ProgressMode, RunFolder, Stopwatch, Table, TableWriter, Watch,
};
use ropewalk_scene::{Fault, SceneFile};
use std::path::PathBuf;
use std::time::Duration;

/// Options of [`run`].
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
    /// What may stop it; by default nothing, and the process keeps its signals.
    pub watch: Watch,
    /// Which files it leaves behind for the eye: by default a page for the browser and pictures.
    pub leaves: Leaves,
    /// A column of the history whose course the progress shows, such as `hose.end.z`.
    pub follow: Option<String>,
    /// Whether files that the scene names stay where they are; else they are copied into `inputs/` of the folder, so that it holds all
    /// that the run was made of.
    pub inputs_stay: bool,
}

/// How a run ended and where its results are.
#[derive(Debug)]
pub struct Outcome {
    /// The folder with all results.
    pub folder: RunFolder,
    /// What `summary.json` says.
    pub summary: Summary,
    /// What `history.csv` says.
    pub history: Table,
    /// Names of the pictures in `plots/`, without ending.
    pub pictures: Vec<String>,
    /// What is on `report.html`, if there is one.
    pub page: Option<Box<Page>>,
    /// A summary for people, several lines.
    pub report: String,
    /// Why the solver gave up, if it did.
    pub error: Option<Error>,
}

/// Runs a scene into a folder of its own. Warnings are given to `warn` at once.
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
    let (model, manifest) = prepare(file, &mut |text| warnings.say(text))?;
    let mut recorder = Recorder::new(scene, file.records(&model)?);
    if let Err(message) = tables::check(scene, &recorder.table) {
        return Err(file.document().fault_at("run.tables", message).into());
    }
    recorder.ranges = match ranges::all(scene, &model) {
        Ok(ranges) => ranges,
        Err(e) => {
            let path = e.field.as_deref().unwrap_or("run.ranges");
            return Err(file.document().fault_at(path, e.message).into());
        }
    };
    statistics::check(file, &recorder.table)?;
    if let Some(name) = &options.follow {
        recorder.follow(name)?;
    }
    let folder = NewFolder::create(options.out.clone(), file.name())?;
    let stopwatch = Stopwatch::start();
    let started = match Started::new(scene, model, options.watch) {
        Err(e) if e.is_input() => return Err(e.in_file(file)),
        other => other,
    };
    let (folder, lock) = folder.keep(file, &manifest, !options.inputs_stay)?;
    recorder.writer = Some(TableWriter::create(&folder.history_file(), &recorder.table)?);
    recorder.show(progress(scene.run.duration));
    let before = Elapsed::default();
    if let Ok(started) = &started {
        recorder.watch_steps(options.leaves, started);
        if options.leaves.field() {
            recorder.kept.want_field(&scene.run, started.scenery(file));
            recorder.kept.live_in(&folder);
        }
        started.warnings(scene).iter().for_each(|w| warnings.say(w));
        match (started, options.checkpoint) {
            (Started::Dynamics(s, flutter, _), Some(every)) => {
                let state = (*flutter, s.work.counts.steps);
                let clock = (before, stopwatch);
                let wishes = Wishes { every, leaves: options.leaves, profile: options.profile };
                let saver = Saver::new(&folder, file.name(), wishes, state, &warnings.all, clock)?;
                recorder.saver = Some(saver);
            }
            (_, Some(_)) => {
                warnings.say("no checkpoints are written: they are for runs in time of elements and bodies");
            }
            (_, None) => {}
        }
    }
    (recorder.warnings, recorder.watch) = (warnings, options.watch);
    let (is_resumed, notes, leaves) = (false, manifest.notes, options.leaves);
    let job = Job { file, folder, recorder, stopwatch, before, is_resumed, notes, leaves, _lock: lock };
    Ok(job.complete(started, options.profile))
}

/// Goes on with the run in the folder `options.out`, from its last checkpoint. What it recorded after that is computed
/// again. It leaves behind what was asked for when it began, and checkpoints go on as before unless the options say otherwise.
///
/// # Errors
/// There is no checkpoint, or it belongs to another scene or another version of the program; another run is at work there.
pub fn resume(options: &RunOptions, warn: &mut dyn FnMut(&str)) -> Result<Outcome, Error> {
    let folder = RunFolder::earlier(options.out.clone().unwrap_or_default());
    let lock = folder.path().is_dir().then(|| locked(folder.path())).transpose()?;
    let saved = checkpoint::read(&folder)?;
    let path = folder.scene_file();
    let file = SceneFile::open(&path.display().to_string(), &[], &[])?.named(&saved.name);
    let stopwatch = Stopwatch::start();
    let started = Started::restored(&file, saved.simulation.clone(), saved.flutter)?;
    let Started::Dynamics(simulation, ..) = &started else { unreachable!("only runs in time are resumed") };
    let mut recorder = Recorder::new(file.scene(), file.records(&simulation.model)?);
    let Wishes { leaves, profile, .. } = saved.wishes;
    recorder.watch_steps(leaves, &started);
    if leaves.field() {
        recorder.kept.want_field(&file.scene().run, started.scenery(&file));
        recorder.kept.live_in(&folder);
    }
    recorder.take_up(&saved).map_err(Fault::new)?;
    let before = Elapsed { cpu_s: saved.cpu_s, wall_s: saved.wall_s };
    let wishes = Wishes { every: options.checkpoint.unwrap_or(saved.wishes.every), ..saved.wishes };
    let state = (saved.flutter, simulation.work.counts.steps);
    let saver = Saver::new(&folder, &saved.name, wishes, state, &saved.warnings, (before, stopwatch))?;
    recorder.saver = Some(saver);
    recorder.writer = Some(TableWriter::resume(&folder.history_file(), &recorder.table)?);
    // what it says is of rows that are computed again
    let _ = std::fs::remove_file(folder.summary_file());
    let (t, end) = (saved.simulation.state.t, file.scene().run.duration);
    if let Some(name) = &options.follow {
        recorder.follow(name)?;
    }
    recorder.show(Progress::new(t, end, options.progress));
    recorder.warnings = Warnings { all: saved.warnings.to_vec(), tell: Some(warn) };
    recorder.watch = options.watch;
    let notes = manifest::notes(file.scene(), &simulation.model);
    let is_resumed = true;
    let job =
        Job { file: &file, folder, recorder, stopwatch, before, is_resumed, notes, leaves, _lock: lock };
    Ok(job.complete(Ok(started), profile || options.profile))
}

/// A run from where everything is ready for it to where everything is written.
struct Job<'a> {
    file: &'a SceneFile,
    folder: RunFolder,
    recorder: Recorder<'a>,
    stopwatch: Stopwatch,
    /// What was spent on it before it was resumed.
    before: Elapsed,
    is_resumed: bool,
    /// What its constraints have to say.
    notes: Vec<String>,
    leaves: Leaves,
    /// Kept until everything is written.
    _lock: Option<FolderLock>,
}

impl Job<'_> {
    fn complete(mut self, started: Result<Started, Error>, profile: bool) -> Outcome {
        let mut summary = Summary { notes: std::mem::take(&mut self.notes), ..Summary::default() };
        let ending = match started {
            Ok(started) => self.compute(started, profile, &mut summary),
            Err(e) => {
                self.recorder.progress = None;
                e.into()
            }
        };
        (summary.status, summary.message) = (ending.status(), ending.message());
        let elapsed = self.stopwatch.elapsed();
        (summary.cpu_s, summary.wall_s) =
            (self.before.cpu_s + elapsed.cpu_s, self.before.wall_s + elapsed.wall_s);
        let error = if let Ending::Failed(error) = ending { Some(error) } else { None };
        Outcome { error, ..self.write(summary) }
    }

    /// Moves the analysis to its end.
    fn compute(&mut self, mut started: Started, profile: bool, summary: &mut Summary) -> Ending {
        let recorder = &mut self.recorder;
        if profile {
            started.profile();
            recorder.spent = Some((0, Duration::ZERO));
        }
        let clock = Stopwatch::start();
        let ending = started.go(recorder, self.is_resumed);
        if profile {
            let wall_s = clock.elapsed().wall_s;
            let mut entries = started.times(recorder.spent, wall_s);
            entries.iter_mut().for_each(|e| e.share = if wall_s > 0.0 { e.seconds / wall_s } else { 0.0 });
            summary.profile = Some(entries);
        }
        if let Some(e) = recorder.saver.as_mut().and_then(|s| s.trouble.take()) {
            recorder.warnings.say(&format!("the last checkpoint is older than it should be: {e}"));
        }
        let limits = started.limits();
        summary.set_limits(&limits);
        recorder.steps = recorder.course.as_ref().and_then(|course| course.steps(&limits));
        let done = started.done();
        recorder.last_shape(&done.model, &done.state);
        summary.critical = done.critical_loads();
        (summary.counts, summary.energy) = (done.counts, (&done.audit).into());
        ending
    }

    /// Writes everything that is left to be written; what can't be is told.
    fn write(self, mut summary: Summary) -> Outcome {
        let Job { file, folder, mut recorder, leaves, .. } = self;
        let mut warnings = std::mem::take(&mut recorder.warnings);
        if let Some(writer) = recorder.writer.take() {
            writer.finish().unwrap_or_else(|e| warnings.say(&e.to_string()));
        }
        recorder.finals(&mut summary);
        let mut warn = |text: &str| warnings.say(text);
        let mut pictures = Vec::new();
        if leaves.plots {
            pictures = pictures::draw(&folder, file.title(), &recorder, &summary.critical, &mut warn);
        }
        shapes::write(&folder, &recorder.table.columns[0], &recorder.kept.shapes)
            .unwrap_or_else(|e| warn(&e.to_string()));
        let mut tables = tables::write(&folder, &recorder, &mut warn);
        let (ranges, drawn) = ranges::write(&folder, &recorder.ranges, leaves.plots, &mut warn);
        tables.extend(ranges);
        pictures.extend(drawn);
        let told = {
            let sets = statistics::sets(file.scene(), &recorder.table);
            let (written, drawn) = statistics::write(&folder, &sets, leaves.plots, &mut warn);
            tables.extend(written);
            pictures.extend(drawn);
            statistics::Told::of_folder(&folder, file, &recorder.table)
        };
        let statistics = statistics::text(&told.listings);
        let field = recorder.kept.field();
        if let Some(field) = &field {
            leave::write_field(&folder, leaves, field, &mut warn);
        }
        if let Some(steps) = &recorder.steps {
            steps.write(&folder.steps_file()).unwrap_or_else(|e| warn(&e.to_string()));
        }
        summary.notes.extend(recorder.kept.thinned.take());
        summary.warnings.clone_from(&warnings.all);
        let mut page = None;
        if leaves.report {
            let (field, warn) = (field.unwrap_or_default(), &mut |text: &str| warnings.say(text));
            page =
                leave::write_page(&folder, file, &summary, &mut recorder, (field, told), warn).map(Box::new);
        }
        summary.warnings = warnings.all;
        if summary.status.is_complete() && recorder.saver.is_some() {
            // there is nothing left to go on with
            let _ = std::fs::remove_file(folder.checkpoint_file());
        }
        // last of all: who finds a summary finds everything
        if let Err(e) = folder.write_summary(&summary) {
            (summary.status, summary.message) = (Status::Failed, Some(e.to_string()));
        }
        let pages: Vec<&str> =
            page.iter().map(|_| "report.html").chain(leaves.vtk.then_some("vtk.pvd")).collect();
        let files = report::Files { pictures: &pictures, tables: &tables, pages: &pages };
        let report = report::report(file, &summary, &recorder, &folder, files) + &statistics;
        Outcome { folder, summary, history: recorder.table, pictures, page, report, error: None }
    }
}
