//! A run: a scene, computed into a folder of its own.

mod manifest;
mod pictures;
mod recorder;
mod report;
mod start;
mod tables;

pub use manifest::Manifest;
pub(crate) use recorder::{Recorder, records};
pub(crate) use start::{Ending, Started};

use crate::error::Error;
use crate::output::{
    EnergyTotals, Interrupt, OutputError, ProfileEntry, Progress, ProgressMode, RunFolder, Stopwatch,
    Summary, Table, TableWriter,
};
use crate::read::SceneFile;
use crate::scene::Fault;
use ropewalk_core::{Analysis, Audit};
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

/// More rows than this are surely a mistake, and fill the disk.
const MOST_ROWS: f64 = 1e7;

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
    let mut warnings = Vec::new();
    let warn = &mut |text: &str| {
        warnings.push(text.to_string());
        warn(text);
    };
    let scene = file.scene();
    let model = file.build()?;
    let records = file.records(&model)?;
    let manifest = Manifest::new(file, &model)?;
    let rows = scene.run.duration / scene.run.interval();
    if scene.run.analysis == Analysis::Dynamics && rows > MOST_ROWS {
        let message = format!("a history of {rows:.0e} rows is too long: make `output` longer");
        return Err(file.document().fault_at("run.output", message).into());
    }
    for name in file.document().unused_parameters() {
        warn(&format!("parameter `{name}` is not used by the scene"));
    }

    let mut recorder = Recorder::new(scene, records);
    if let Err(message) = tables::check(scene, &recorder.table) {
        return Err(file.document().fault_at("run.tables", message).into());
    }

    let is_new = options.out.as_ref().is_none_or(|out| !out.exists());
    let folder = RunFolder::create(options.out.clone(), file.name())?;
    let stopwatch = Stopwatch::start();
    let mut started = match Started::new(scene, model) {
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
    match Interrupt::install() {
        Ok(interrupt) => recorder.interrupt = Some(interrupt),
        Err(e) => warn(&e.to_string()),
    }

    let mut profile = None;
    let ending = match &mut started {
        Err(_) => None,
        Ok(started) => {
            started.warnings(scene).iter().for_each(|w| warn(w));
            if options.profile {
                started.profile();
            }
            let clock = std::time::Instant::now();
            let ending = started.go(scene, &mut recorder);
            started.afterthought().iter().for_each(|w| warn(w));
            if options.profile {
                profile = Some(shares(started.times(), clock.elapsed().as_secs_f64()));
            }
            Some(ending)
        }
    };
    let elapsed = match recorder.progress.take() {
        Some(progress) => {
            progress.finish("");
            stopwatch.elapsed()
        }
        None => stopwatch.elapsed(),
    };

    let mut summary =
        Summary { notes, cpu_s: elapsed.cpu_s, wall_s: elapsed.wall_s, profile, ..Summary::default() };
    let ending = match (started, ending) {
        (Ok(started), ending) => {
            let done = started.done();
            recorder.last_shape(&done.model, &done.state);
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
        Ending::Interrupted => Some("stopped by Ctrl-C".into()),
        Ending::Failed(error) => Some(error.to_string().trim_start_matches("error: ").to_string()),
    };
    if let Some(writer) = recorder.writer.take() {
        writer.finish().unwrap_or_else(|e| warn(&e.to_string()));
    }
    recorder.finals(&mut summary);
    let pictures = pictures::draw(&folder, file.title(), &recorder, warn);
    let tables = tables::write(&folder, &recorder, warn);
    summary.warnings = warnings;
    // last of all: who finds a summary finds everything
    folder.write_summary(&summary)?;
    let report = report::report(file, &summary, &recorder, &folder, &pictures, &tables);
    Ok(Outcome { folder, summary, history: recorder.table, pictures, report })
}

/// A start that is refused is the fault of a section of the scene: point there.
fn at_section(file: &SceneFile, e: Error) -> Error {
    match e {
        Error::Step(e) => Error::File(file.at_solver(e.to_string())),
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

/// Adds what is not in any term or phase: Newton's method, the audit, recording.
fn shares(mut entries: Vec<ProfileEntry>, total: f64) -> Vec<ProfileEntry> {
    let known: f64 = entries.iter().map(|e| e.seconds).sum();
    let label = "integrator, audit and output".to_string();
    entries.push(ProfileEntry { label, calls: 1, seconds: (total - known).max(0.0), share: 0.0 });
    for e in &mut entries {
        e.share = if total > 0.0 { e.seconds / total } else { 0.0 };
    }
    entries
}

impl From<OutputError> for Fault {
    fn from(e: OutputError) -> Self {
        Fault::new(e.to_string())
    }
}
