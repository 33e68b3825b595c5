//! What accuracy costs: a scene run over mesh, stiffness models, quadrature, scheme and step or tolerance, the errors of
//! a record against a reference that is computed as well, and which settings are the cheapest for an accuracy.

mod front;
mod page;
mod reference;
mod report;
mod walk;

pub use report::CostAdvice;

use crate::error::{Error, caught};
use crate::run::Ending;
use crate::simulate::{How, compute};
use crate::study::{Axes, Runs, Study, StudyFolder, Target, on_all_cores};
use front::distrust;
use reference::Reference;
use report::{GOALS, Report};
use ropewalk_models::Bundled;
use ropewalk_report::{
    ProgressMode, Sheet, Stopwatch, SweepProgress, Watch, plain, rough, write_atomic, write_json,
};
use ropewalk_scene::{Fault, SceneText};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::time::{Duration, Instant};
use walk::Walk;

/// Longer than this nothing is checked beforehand.
const LONGEST_CHECK: Duration = Duration::from_secs(2);

/// Options of [`cost`].
#[derive(Clone, Debug)]
pub struct CostOptions {
    /// The record, or one of its columns, over the whole run or at a time: `NAME` or `NAME@TIME`.
    pub of: String,
    /// Parameters of the scene, each `name=value`.
    pub set: Vec<String>,
    /// The folder: new, empty, or that of the same study. Without it `runs/<scene>-cost`, numbered.
    pub out: Option<PathBuf>,
    /// Whether to delete what an earlier study left in the folder.
    pub fresh: bool,
    /// Wall time after which no more is tried; half of it may go into the reference.
    pub budget: Duration,
    /// How to show the progress.
    pub progress: ProgressMode,
    /// What may stop it; by default nothing, and the process keeps its signals.
    pub watch: Watch,
}

/// What a study of cost found.
#[derive(Debug)]
pub struct CostOutcome {
    /// Whether Ctrl-C ended it.
    pub interrupted: bool,
    /// The cheapest settings for each accuracy.
    pub advice: Vec<CostAdvice>,
    /// How far the reference may be from the truth, relative to the size of the record; NaN without reference.
    pub uncertainty: f64,
    /// The folder.
    pub folder: PathBuf,
    /// Table, front and advice for people.
    pub report: String,
}

/// What makes a study the same as another.
#[derive(Serialize, Deserialize)]
struct Manifest {
    ropewalk: String,
    name: String,
    /// The scene, its parameters resolved.
    scene: String,
    of: String,
}

impl Study for Manifest {
    const KIND: &'static str = "cost";
    fn name(&self) -> String {
        plain(&self.name)
    }
    fn difference(&self, there: &Self) -> Option<String> {
        if self.name != there.name {
            Some(format!("of {}", there.name))
        } else if self.of != there.of {
            Some(format!("of the record {}", there.of))
        } else if self.scene != there.scene {
            Some(format!("of {} with other parameters, or before it was changed", there.name))
        } else {
            (self.ropewalk != there.ropewalk).then(|| format!("by version {}", there.ropewalk))
        }
    }
}

/// What `cost.json` says in the end, beside the manifest.
#[derive(Serialize)]
struct Found<'a> {
    of: &'a str,
    size: f64,
    unit: &'a str,
    doubt_of_steps: f64,
    doubt_of_mesh: f64,
    reference: &'a [String],
    advice: &'a [CostAdvice],
}

/// A cheap run, before anything is begun: is there something of which an error can be a part?
fn check(axes: &Axes<'_>, target: &Target) -> Result<(), Error> {
    let coarse = axes.base.meshed(axes.coarsest()).stepped(axes.level(0));
    let watch = Watch::default().until(Instant::now().checked_add(LONGEST_CHECK));
    let file = axes.with(&coarse, target.t)?;
    // a coarse run may well fail, and one that takes too long is no reason to stop
    if let Ok(run) = caught(|| compute(file.scene(), How { watch, ..How::default() }))
        && matches!(run.ending, Ending::Finished | Ending::Stopped(_))
    {
        target.size_in(&run.table)?;
    }
    Ok(())
}

/// Finds out what the accuracy of a record costs in a scene, given by its bundled name or path.
///
/// # Errors
/// The scene, the record or the folder is wrong, or the scene doesn't run at all.
pub fn cost(scene: &str, bundled: &[Bundled], options: &CostOptions) -> Result<CostOutcome, Error> {
    cost_of(&SceneText::open(scene, bundled)?, options)
}

/// The same for the text of a scene.
///
/// # Errors
/// As [`cost`].
pub fn cost_of(text: &SceneText, options: &CostOptions) -> Result<CostOutcome, Error> {
    let axes = Axes::new(text, &options.set)?;
    let target = Target::parse(&options.of, axes.file())?;
    if axes.is_empty() {
        let message = "there is nothing to vary: the scene has neither elements nor time steps of the solver";
        return Err(Fault::new(message).with_help("vary its own parameters with `ropewalk sweep`").into());
    }
    check(&axes, &target)?;
    let manifest = Manifest {
        ropewalk: env!("CARGO_PKG_VERSION").into(),
        name: text.name.clone(),
        scene: axes.file().document().to_toml(),
        of: target.text.clone(),
    };
    let folder = StudyFolder::open(options.out.clone(), options.fresh, &manifest)?;
    let progress = SweepProgress::new(0, options.progress);
    let signals = options.watch;
    let stopwatch = Stopwatch::start();
    let start = Instant::now();
    let until = |share: f64| start.checked_add(options.budget.mul_f64(share));
    let runs = Runs::in_folder(&axes, &target, &folder, progress);
    let earlier = runs.len();
    let path = folder.path().to_path_buf();
    let find = || Reference::find(&runs, &target, GOALS[4] / 3.0, until(0.25), signals.until(until(0.5)));
    let Some(reference) = on_all_cores(find)?? else {
        let interrupted = signals.is_interrupted();
        let why =
            "no reference was found in half of the time given: raise --budget; what was computed is kept";
        let report = if interrupted { String::new() } else { why.into() };
        let (advice, uncertainty) = (Vec::new(), f64::NAN);
        return Ok(CostOutcome { interrupted, advice, uncertainty, folder: path, report });
    };
    let uncertainty = reference.uncertainty();
    if options.progress != ProgressMode::Quiet {
        let spent = rough(stopwatch.elapsed().wall_s);
        runs.progress.say(&format!("reference: uncertainty {}, wall time {spent} s", rough(uncertainty)));
    }
    let goal = GOALS[4].max(uncertainty) - uncertainty.min(0.5 * GOALS[4]);
    let watch = signals.until(until(1.0));
    let walk = Walk { runs: &runs, target: &target, reference: &reference, goal, watch };
    // one after the other, so that each has the machine to itself
    on_all_cores(|| walk.go())??;
    let mut points = walk.points();
    distrust(&mut points);
    points.sort_by(|a, b| a.run.cpu_s.total_cmp(&b.run.cpu_s));
    let report = Report { axes: &axes, target: &target, reference: &reference, points };
    let advice = write(&report, &folder, &text.name, &runs.progress)?;

    let interrupted = signals.is_interrupted();
    let mut sheet = Sheet::new(report.text());
    if watch.is_over() && !interrupted {
        sheet.line("  the time given is up: the same command with a larger --budget goes on\n");
    }
    sheet.entry("runs", format!("{}, {earlier} of them from before", runs.len()));
    let (wall, cpu) = (rough(stopwatch.elapsed().wall_s), rough(runs.spent()));
    sheet.entry("time", format!("wall time {wall} s, CPU time {cpu} s"));
    sheet.entry("folder", path.display());
    sheet.entry(
        "results",
        "index.html, table.csv, advice.json, advice/*.toml (scenes with these settings), plots/cost.svg, runs/",
    );
    runs.progress.finish();
    Ok(CostOutcome { interrupted, advice, uncertainty, folder: path, report: sheet.to_string() })
}

/// Writes table, advice and picture.
fn write(
    report: &Report<'_>,
    folder: &StudyFolder,
    scene: &str,
    progress: &SweepProgress,
) -> Result<Vec<CostAdvice>, Error> {
    report.write_table(folder)?;
    report.write_scenes(folder)?;
    let advice = report.advice();
    let found = Found {
        of: &report.target.text,
        size: report.reference.size,
        unit: &report.target.unit,
        doubt_of_steps: report.reference.step,
        doubt_of_mesh: report.reference.mesh,
        reference: &report.reference.notes,
        advice: &advice,
    };
    write_json(&folder.path().join("advice.json"), &found)?;
    let warn = &mut |text: &str| progress.say(&format!("warning: {text}"));
    folder.files().draw("cost", |path| report.plot(scene).write(path), warn);
    write_atomic(&folder.path().join("index.html"), &page::page(report, scene))?;
    Ok(advice)
}
