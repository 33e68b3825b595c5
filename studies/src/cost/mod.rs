//! What accuracy costs: a scene run over mesh, stiffness models, quadrature, scheme and step or tolerance, the errors of
//! a record against a reference that is computed as well, and which settings are the cheapest for an accuracy.

mod front;
mod reference;
mod report;
mod runs;
mod walk;

pub use report::CostAdvice;

use crate::error::Error;
use crate::study::{Axes, Study, StudyFolder, Target, Watch, measure, on_all_cores};
use front::distrust;
use reference::Reference;
use report::Report;
use ropewalk_models::Bundled;
use ropewalk_report::{
    Interrupt, OutputError, Progress, ProgressMode, RunFolder, SweepProgress, plain, rough, write_json,
};
use ropewalk_scene::{Fault, SceneText};
use runs::Runs;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::time::{Duration, Instant};
use walk::Walk;

/// The accuracies that advice is given for, relative to the size of the record.
const GOALS: [f64; 5] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6];

/// Longer than this nothing is checked beforehand.
const LONGEST_CHECK: Duration = Duration::from_secs(2);

/// What may be chosen about a study of cost.
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
    /// Time on the clock after which no more is tried; half of it may go into the reference.
    pub budget: Duration,
    /// How to show the progress.
    pub progress: ProgressMode,
}

/// What a study of cost found.
#[derive(Debug)]
pub struct CostOutcome {
    /// Whether Ctrl-C ended it.
    pub interrupted: bool,
    /// The cheapest settings for each accuracy.
    pub advice: Vec<CostAdvice>,
    /// How far the reference may be from the truth, relative to the size of the record; NaN without reference.
    pub doubt: f64,
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
    let watch = Watch { deadline: Instant::now().checked_add(LONGEST_CHECK), ..Watch::default() };
    let file = axes.with(&coarse, target.t)?;
    let run = measure(&file, false, watch, Progress::new(0.0, 1.0, ProgressMode::Quiet));
    // a coarse run may well fail, and one that takes too long is no reason to stop
    if run.failure.is_none() && !run.stopped {
        target.size_in(&run.history)?;
    }
    Ok(())
}

/// Finds out what the accuracy of a record costs in a scene, given by its bundled name or path.
///
/// # Errors
/// The scene, the record or the folder is wrong, or the scene doesn't run at all.
pub fn cost(scene: &str, bundled: &[Bundled], options: &CostOptions) -> Result<CostOutcome, Error> {
    let text = SceneText::open(scene, bundled)?;
    let axes = Axes::new(&text, &options.set)?;
    let target = Target::parse(&options.of, axes.file())?;
    if axes.is_empty() {
        return Err(Fault::new(
            "there is nothing to vary: the scene has neither elements nor time steps of the solver",
        )
        .with_help("vary its own parameters with `ropewalk sweep`")
        .into());
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
    let mut watch = Watch::default();
    match Interrupt::install() {
        Ok(interrupt) => watch.interrupt = Some(interrupt),
        Err(e) => progress.say(&format!("warning: {e}")),
    }
    let start = Instant::now();
    let until = |share: f64| start.checked_add(options.budget.mul_f64(share));
    let quiet = options.progress == ProgressMode::Quiet;
    let runs = Runs::new(&axes, &target, &folder, progress, quiet);
    let earlier = runs.len();
    let find =
        || Reference::find(&runs, GOALS[4] / 3.0, until(0.25), Watch { deadline: until(0.5), ..watch });
    let reference = on_all_cores(find)??;
    let path = folder.path().to_path_buf();
    let Some(reference) = reference else {
        let interrupted = watch.is_interrupted();
        let report = match interrupted {
            true => String::new(),
            false => {
                "no reference was found in half of the time given: raise --budget; what was computed is kept"
                    .into()
            }
        };
        return Ok(CostOutcome { interrupted, advice: Vec::new(), doubt: f64::NAN, folder: path, report });
    };
    runs.say(&format!(
        "reference sure to {}, {} s",
        rough(reference.doubt()),
        rough(start.elapsed().as_secs_f64())
    ));
    let goal = GOALS[4].max(reference.doubt()) - reference.doubt().min(0.5 * GOALS[4]);
    let walk =
        Walk { runs: &runs, reference: &reference, goal, watch: Watch { deadline: until(1.0), ..watch } };
    // one after the other, so that each has the machine to itself
    on_all_cores(|| walk.go())??;
    let mut points = walk.points();
    distrust(&mut points);
    points.sort_by(|a, b| a.run.cpu_s.total_cmp(&b.run.cpu_s));
    let report = Report { axes: &axes, target: &target, reference: &reference, points };
    report.write_table(&folder)?;
    report.write_scenes(&folder)?;
    let advice = report.advice();
    let found = Found {
        of: &target.text,
        size: reference.size,
        unit: &target.unit,
        doubt_of_steps: reference.step,
        doubt_of_mesh: reference.mesh,
        reference: &reference.notes,
        advice: &advice,
    };
    write_json(&RunFolder::earlier(path.clone()).path().join("advice.json"), &found)?;
    match folder.plot_file("cost").and_then(|file| report.plot(&text.name).write(&file)) {
        Ok(()) | Err(OutputError::EmptyPlot { .. }) => {}
        Err(e) => runs.progress.say(&format!("warning: {e}")),
    }
    let mut said = report.text();
    let interrupted = watch.is_interrupted();
    if walk.watch.is_over() && !interrupted {
        said += "\n  the time given is up: the same command with a larger --budget goes on\n";
    }
    said += &format!(
        "\n  runs      {}, {} of them from before\n  time      {} s on the clock, {} s of CPU\n  folder    {}\n  results   table.csv, advice.json, advice/*.toml (scenes with these settings), plots/cost.svg, runs/\n",
        runs.len(),
        earlier,
        rough(start.elapsed().as_secs_f64()),
        rough(runs.spent()),
        path.display()
    );
    runs.progress.finish();
    Ok(CostOutcome { interrupted, advice, doubt: reference.doubt(), folder: path, report: said })
}
