//! The ledger of effects: what each effect of a scene costs and does, what its absence would change, and what effects
//! that the scene lacks would add.

mod books;
mod catalogue;
mod pictures;
mod report;
mod trial;
mod watched;

pub use books::Deed;

use crate::error::Error;
use crate::run::{Counts, Manifest, ProfileEntry, Started};
use crate::study::Target;
use books::Books;
use catalogue::{Candidate, absent, edited, present};
use ropewalk_core::integrator::Stepping;
use ropewalk_report::{Interrupt, ProgressMode, RunFolder, Stopwatch, SweepProgress};
use ropewalk_scene::{Analysis, Fault, Scene, SceneFile};
use std::path::PathBuf;
use trial::{Failure, How, Trial, Watch};
use watched::Watched;

/// What may be chosen about the ledger beside the scene and the record.
#[derive(Clone, Debug)]
pub struct EffectsOptions {
    /// The change of the record that doesn't matter, relative to its largest size in the run.
    pub accuracy: f64,
    /// The folder for the results, which must be new or empty; without it `runs/<scene>-effects`, numbered.
    pub out: Option<PathBuf>,
    /// How to show the progress.
    pub progress: ProgressMode,
}

impl Default for EffectsOptions {
    fn default() -> Self {
        EffectsOptions { accuracy: 1e-2, out: None, progress: ProgressMode::Quiet }
    }
}

/// What became of a run with an effect more or less.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// It ran.
    Ran {
        /// Largest change of the record, relative to its largest size in the run.
        change: f64,
        /// CPU time [s].
        cpu_s: f64,
        /// How much work it was.
        counts: Counts,
        /// What one should know about it, such as that an event ended it.
        note: String,
    },
    /// It did not run, for this reason.
    Failed(String),
}

impl Verdict {
    fn change(&self) -> Option<f64> {
        if let Verdict::Ran { change, .. } = self { Some(*change) } else { None }
    }
}

/// An effect that was tried.
#[derive(Clone, Debug, PartialEq)]
pub struct Tried {
    /// Its name, such as `drag` or `bending of hose`.
    pub name: String,
    /// What was assumed of an effect that the scene lacks.
    pub note: String,
    /// What became of the run.
    pub verdict: Verdict,
}

/// All effects that change the record by less than the accuracy, left out together.
#[derive(Clone, Debug, PartialEq)]
pub struct Advice {
    /// The effects.
    pub names: Vec<String>,
    /// What became of the run without them.
    pub verdict: Verdict,
}

/// The ledger of effects of a scene.
#[derive(Clone, Debug)]
pub struct Ledger {
    /// The record that was watched, as it was asked for.
    pub record: String,
    /// Its largest size in the run, in SI units.
    pub scale: f64,
    /// CPU time of the run without clocks inside [s].
    pub cpu_s: f64,
    /// How much work the run is.
    pub counts: Counts,
    /// Where the time of the run went: terms, constraints, solver, and the rest; these add up to that of a run with clocks.
    pub costs: Vec<ProfileEntry>,
    /// What the effects do, term by term.
    pub deeds: Vec<Deed>,
    /// How far the record changes with finer time steps: smaller changes can't be told from the error of the run. None in
    /// statics, and where that run did not end.
    pub own_error: Option<f64>,
    /// The scene without each of its effects.
    pub without: Vec<Tried>,
    /// The scene with each effect that it lacks and that could be tried.
    pub with: Vec<Tried>,
    /// Effects that can't be guessed from the scene, and what to write to try them.
    pub hints: Vec<(String, String)>,
    /// What can be left out at the accuracy; none if nothing can.
    pub advice: Option<Advice>,
    /// By how much the time of the same run has differed between beginning and end: smaller savings can't be told.
    pub noise: f64,
    /// Whether Ctrl-C ended it before all effects were tried.
    pub interrupted: bool,
}

impl Ledger {
    /// CPU time of the run with clocks, which its costs add up to [s].
    pub fn measured_s(&self) -> f64 {
        self.costs.iter().map(|c| c.seconds).sum()
    }
}

/// Keeps the ledger of a scene in memory; nothing is written. `record` names a record or one of its columns, and with
/// `@TIME` behind it one instant of it.
///
/// # Errors
/// The scene can't be built or doesn't run to its end, has no such record, or has no effects at all.
pub fn effects(scene: &Scene, record: &str, options: &EffectsOptions) -> Result<Ledger, Error> {
    let accuracy = options.accuracy;
    if !(accuracy > 0.0 && accuracy.is_finite()) {
        let fault = Fault::new(format!("`--accuracy` must be positive, but is {accuracy}"));
        return Err(fault.with_help("a hundredth of the record's largest value is `1e-2`").into());
    }
    if let Some(process) = scene.processes.first() {
        let message = format!("`{}` is a process with equations of its own: it has no terms", process.name());
        return Err(Fault::new(message)
            .with_help("effects are asked of scenes of elements and bodies")
            .into());
    }
    let has = present(scene);
    let (lacks, hints) = absent(scene);
    // with and without clocks, books, finer steps, the scene again
    let total = has.len() + lacks.len() + 5;
    let progress = SweepProgress::new(total, options.progress);
    let watch = Watch { progress: &progress, interrupt: Interrupt::install().ok() };
    let kept = Keeper { scene, accuracy, watch: &watch }.keep(record, &has, &lacks, hints);
    progress.finish();
    kept
}

/// The ledger of effects in a folder of its own.
pub struct EffectsOutcome {
    /// The folder: `scene.toml`, `manifest.json`, `tables/*.csv` and `plots/*.svg`.
    pub folder: RunFolder,
    /// The ledger.
    pub ledger: Ledger,
    /// Tables and advice for people.
    pub report: String,
}

/// Keeps the ledger of a scene and writes it into a folder. What one should know is said by `warn`.
///
/// # Errors
/// As [`effects`]; the folder can't be used.
pub fn write_effects(
    file: &SceneFile,
    record: &str,
    options: &EffectsOptions,
    warn: &mut dyn FnMut(&str),
) -> Result<EffectsOutcome, Error> {
    let model = file.build()?;
    let manifest = Manifest::new(file, &model)?;
    drop(model);
    for name in file.document().unused_parameters() {
        warn(&format!("parameter `{name}` is not used by the scene"));
    }
    let is_new = options.out.as_ref().is_none_or(|out| !out.exists());
    let folder = RunFolder::create(options.out.clone(), &format!("{}-effects", file.name()))?;
    let stopwatch = Stopwatch::start();
    let ledger = effects(file.scene(), record, options).inspect_err(|_| {
        if is_new {
            // best effort, and it only removes a folder that is empty
            let _ = std::fs::remove_dir(folder.path());
        }
    })?;
    folder.write_scene(&file.document().to_toml())?;
    folder.write_manifest(&manifest)?;
    report::write(&folder, &ledger)?;
    let pictures = pictures::draw(&folder, file.title(), &ledger, options.accuracy, warn);
    let report = report::report(file, &ledger, options.accuracy, &folder, &pictures, stopwatch.elapsed());
    Ok(EffectsOutcome { folder, ledger, report })
}

/// A run with an effect more or less may take this many times that of the run itself, and a few seconds.
const PATIENCE: f64 = 20.0;

struct Keeper<'a> {
    scene: &'a Scene,
    accuracy: f64,
    watch: &'a Watch<'a>,
}

impl Keeper<'_> {
    fn keep(
        &self,
        record: &str,
        has: &[Candidate],
        lacks: &[Candidate],
        hints: Vec<(String, String)>,
    ) -> Result<Ledger, Error> {
        let (scene, watch) = (self.scene, self.watch);
        let name = "the scene as it is";
        // an unknown record should not have to wait for the run
        let model = scene.build()?;
        let blank = crate::run::Recorder::new(scene, scene.records(&model)?);
        let watched =
            Watched::of(&Target::find(record, &Target::recorded(&blank), &scene.run)?, &blank.table);
        let rounding = if watched.unit(&blank.table) == "m" { model.rounding() } else { 0.0 };
        drop((model, blank));

        let base = trial::fastest(scene, name, How::default(), watch).map_err(whole)?;
        watch.progress.done(false);
        let scale = watched.scale(&base.table);
        if !(scale > rounding) {
            let message =
                format!("`{record}` is 0 throughout the run, but for rounding: changes of it can't be told");
            return Err(Fault::new(message).with_help("choose another record with `--of`").into());
        }
        if watched.change(&base.table, &base.table).is_none() {
            let by = base.stopped.as_deref().unwrap_or("an event");
            let message = format!("the run is stopped by {by} before the time in `{record}`");
            return Err(Fault::new(message).with_help("choose an earlier time").into());
        }
        let measured =
            trial::fastest(scene, name, How { measure: true, most: None }, watch).map_err(whole)?;
        watch.progress.done(false);
        let deeds = self.deeds()?;
        watch.progress.done(false);
        let mut ledger = Ledger {
            record: watched.text.clone(),
            scale,
            cpu_s: base.cpu_s,
            counts: base.counts,
            costs: measured.clocks,
            deeds,
            own_error: None,
            without: Vec::new(),
            with: Vec::new(),
            hints,
            advice: None,
            noise: 0.0,
            interrupted: false,
        };
        let most = Some(PATIENCE * base.cpu_s + 5.0);
        let judge = Judge { base: &base, watched: &watched, scale, how: How { measure: false, most }, watch };
        self.compare(&judge, has, lacks, &mut ledger);
        Ok(ledger)
    }

    /// Tries everything that is to be compared with the run, until Ctrl-C is pressed.
    fn compare(&self, judge: &Judge<'_>, has: &[Candidate], lacks: &[Candidate], ledger: &mut Ledger) {
        let done = |tried: Option<Verdict>| {
            self.watch.progress.done(false);
            tried
        };
        if let Some(finer) = finer(self.scene) {
            match done(judge.of(Ok(finer), "finer steps")) {
                Some(verdict) => ledger.own_error = verdict.change(),
                None => return ledger.interrupted = true,
            }
        }
        for c in has {
            let Some(verdict) = done(judge.of(edited(self.scene, &c.edits), &format!("without {}", c.name)))
            else {
                return ledger.interrupted = true;
            };
            ledger.without.push(Tried { name: c.name.clone(), note: c.note.clone(), verdict });
        }
        for c in lacks {
            let scene = edited(self.scene, &c.edits);
            // what can't be built says what it needs
            if let Some(Err(e)) = scene.as_ref().ok().map(Scene::build) {
                ledger.hints.push((c.name.clone(), e.error.message));
                continue;
            }
            let Some(verdict) = done(judge.of(scene, &format!("with {}", c.name))) else {
                return ledger.interrupted = true;
            };
            ledger.with.push(Tried { name: c.name.clone(), note: c.note.clone(), verdict });
        }
        match self.advise(judge, has, ledger) {
            Some(advice) => ledger.advice = advice,
            None => return ledger.interrupted = true,
        }
        if let Some(Verdict::Ran { cpu_s, .. }) = done(judge.of(Ok(self.scene.clone()), "the scene again")) {
            ledger.noise = (cpu_s / ledger.cpu_s).max(ledger.cpu_s / cpu_s) - 1.0;
            ledger.cpu_s = ledger.cpu_s.min(cpu_s);
        }
    }

    /// What the effects do.
    fn deeds(&self) -> Result<Vec<Deed>, Error> {
        let mut started = Started::new(self.scene, self.scene.build()?)?;
        let mut books = Books::new(self.scene.run.analysis, self.watch.interrupt);
        started.drive(self.scene, &mut books)?;
        // half of the work would look like the whole
        Ok(if self.watch.interrupted() { Vec::new() } else { books.deeds })
    }

    /// Leaves out together what matters little one by one; of what then matters too much the largest stays.
    fn advise(&self, judge: &Judge<'_>, has: &[Candidate], ledger: &Ledger) -> Option<Option<Advice>> {
        let mut small: Vec<(&Candidate, f64, &Verdict)> = has
            .iter()
            .zip(&ledger.without)
            .filter_map(|(c, t)| Some((c, t.verdict.change()?, &t.verdict)))
            .filter(|(_, change, _)| *change <= self.accuracy)
            .collect();
        small.sort_by(|a, b| a.1.total_cmp(&b.1));
        while !small.is_empty() {
            let names = small.iter().map(|(c, ..)| c.name.clone()).collect();
            let verdict = match small.as_slice() {
                [(_, _, alone)] => (*alone).clone(),
                _ => {
                    let edits: Vec<_> = small.iter().flat_map(|(c, ..)| c.edits.clone()).collect();
                    judge.of(edited(self.scene, &edits), "without all of them")?
                }
            };
            if verdict.change().is_some_and(|change| change <= self.accuracy) {
                return Some(Some(Advice { names, verdict }));
            }
            small.pop();
        }
        Some(None)
    }
}

/// What runs are compared with.
struct Judge<'a> {
    base: &'a Trial,
    watched: &'a Watched,
    scale: f64,
    how: How,
    watch: &'a Watch<'a>,
}

impl Judge<'_> {
    /// What becomes of a scene; nothing if Ctrl-C was pressed.
    fn of(&self, scene: Result<Scene, String>, name: &str) -> Option<Verdict> {
        if self.watch.interrupted() {
            return None;
        }
        let scene = match scene {
            Ok(scene) => scene,
            Err(message) => return Some(Verdict::Failed(message)),
        };
        let trial = match trial::fastest(&scene, name, self.how, self.watch) {
            Ok(trial) => trial,
            Err(Failure::Interrupted) => return None,
            Err(Failure::Slow(most)) => {
                let message =
                    format!("given up after {most:.0} s, {PATIENCE:.0} times what the scene itself takes");
                return Some(Verdict::Failed(message));
            }
            Err(Failure::Failed(e)) => return Some(Verdict::Failed(e.to_string())),
        };
        let Some(change) = self.watched.change(&self.base.table, &trial.table) else {
            let message = match &trial.stopped {
                Some(by) => format!("stopped by {by} before there was a record"),
                None => "the record can't be made without it".to_string(),
            };
            return Some(Verdict::Failed(message));
        };
        let last = |t: &Trial| t.table.columns.first().and_then(|c| c.values.last()).copied();
        let note = match (&trial.stopped, last(&trial), last(self.base)) {
            (by, Some(t), Some(base)) if (t - base).abs() > 1e-9 * base.abs() => {
                let by = by.as_ref().map_or(String::new(), |by| format!(" by {by}"));
                match self.base.table.columns.first() {
                    Some(first) if first.name != "t" => format!("ends at {} {t:.4}{by}", first.name),
                    _ => format!("ends at t = {t:.4} s{by}"),
                }
            }
            _ => String::new(),
        };
        Some(Verdict::Ran { change: change / self.scale, cpu_s: trial.cpu_s, counts: trial.counts, note })
    }
}

/// The same with finer time steps; nothing in statics, which has none.
fn finer(scene: &Scene) -> Option<Scene> {
    if scene.run.analysis == Analysis::Statics {
        return None;
    }
    let mut scene = scene.clone();
    match &mut scene.solver.stepping {
        Stepping::Fixed { h } => *h *= 0.5,
        Stepping::Controlled { tolerance, .. } => *tolerance *= 0.1,
    }
    Some(scene)
}

/// A failure of the scene itself.
fn whole(failure: Failure) -> Error {
    match failure {
        Failure::Failed(e) => e,
        Failure::Interrupted => Error::Interrupted,
        Failure::Slow(_) => unreachable!("the scene itself is given all the time that it takes"),
    }
}
