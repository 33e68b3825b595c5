//! A scene compared with what it is without some effects, and with others.

use super::catalogue::{Candidate, edited};
use super::ledger::{Advice, EffectTrial, Ledger, Verdict};
use super::work::{EffectWork, WorkObserver};
use crate::error::Error;
use crate::run::{Ending, Recorder, Started};
use crate::simulate::{History, How, compute};
use crate::study::{Target, When, difference};
use ropewalk_core::integrator::Stepping;
use ropewalk_report::{SweepProgress, Table, Watch};
use ropewalk_scene::{Analysis, Fault, Scene, SpecKind};
use std::time::{Duration, Instant};

/// A run with an effect more or less may take this many times that of the run itself, and a few seconds.
const PATIENCE: f64 = 20.0;

/// What runs are compared with.
pub(super) struct Comparison<'a> {
    scene: &'a Scene,
    target: Target,
    /// The largest size of the record in the run.
    scale: f64,
    base: History,
    /// Most time that another run may take [s].
    most: f64,
    watch: Watch,
    progress: &'a SweepProgress,
}

impl<'a> Comparison<'a> {
    /// Runs the scene as it is.
    pub(super) fn new(
        scene: &'a Scene,
        record: &str,
        watch: Watch,
        progress: &'a SweepProgress,
    ) -> Result<Self, Error> {
        // an unknown record should not have to wait for the run
        let model = scene.build()?;
        let all = Target::recorded(&Recorder::new(scene, scene.records(&model)?));
        let target = Target::find(record, &all, &scene.run)?;
        let rounding = if target.unit == "m" { model.rounding() } else { 0.0 };
        drop(model);
        let base = whole(fastest(scene, AS_IT_IS, false, (watch, None), progress)?)?;
        progress.done(false);
        let scale = target.magnitude(&target.of(&base.table));
        if !(scale > rounding) {
            let message =
                format!("`{record}` is 0 throughout the run, but for rounding: changes of it can't be told");
            return Err(Fault::new(message).with_help("choose another record with `--of`").into());
        }
        if change(&target, &base.table, &base.table).is_none() {
            let by = base.stopped_by.as_deref().unwrap_or("an event");
            let message = format!("the run is stopped by {by} before the time in `{record}`");
            return Err(Fault::new(message).with_help("choose an earlier time").into());
        }
        let most = PATIENCE * base.elapsed.cpu_or_wall_s() + 5.0;
        Ok(Comparison { scene, target, scale, base, most, watch, progress })
    }

    /// The whole ledger: costs and work of what is there, then all that is to be compared.
    pub(super) fn ledger(
        &self,
        has: &[Candidate],
        lacks: &[Candidate],
        hints: Vec<(String, String)>,
        accuracy: f64,
    ) -> Result<Ledger, Error> {
        let measured = whole(fastest(self.scene, AS_IT_IS, true, (self.watch, None), self.progress)?)?;
        self.progress.done(false);
        let work = self.work()?;
        self.progress.done(false);
        let mut ledger = Ledger {
            record: self.target.text.clone(),
            scale: self.scale,
            cpu_s: self.base.elapsed.cpu_or_wall_s(),
            counts: self.base.counts,
            costs: measured.profile,
            work,
            own_error: None,
            without: Vec::new(),
            with: Vec::new(),
            hints,
            advice: None,
            noise: 0.0,
            interrupted: false,
        };
        ledger.interrupted = self.compare(has, lacks, accuracy, &mut ledger).is_none();
        Ok(ledger)
    }

    /// Tries everything that is to be compared with the run; nothing if Ctrl-C was pressed.
    fn compare(
        &self,
        has: &[Candidate],
        lacks: &[Candidate],
        accuracy: f64,
        ledger: &mut Ledger,
    ) -> Option<()> {
        let tried = |scene: Result<Scene, String>, name: &str| {
            let verdict = self.verdict(scene, name);
            self.progress.done(false);
            verdict
        };
        let trial =
            |c: &Candidate, verdict| EffectTrial { name: c.name.clone(), note: c.note.clone(), verdict };
        if let Some(finer) = finer(self.scene) {
            ledger.own_error = tried(Ok(finer), "finer steps")?.change();
        }
        for c in has {
            let verdict = tried(edited(self.scene, &c.edits), &format!("without {}", c.name))?;
            ledger.without.push(trial(c, verdict));
        }
        for c in lacks {
            let scene = edited(self.scene, &c.edits);
            // what can't be built says what it needs
            if let Some(Err(e)) = scene.as_ref().ok().map(Scene::build) {
                ledger.hints.push((c.name.clone(), e.error.message));
                continue;
            }
            let verdict = tried(scene, &format!("with {}", c.name))?;
            ledger.with.push(trial(c, verdict));
        }
        ledger.advice = self.advise(has, accuracy, ledger)?;
        if let Some(Verdict::Ran { cpu_s, .. }) = tried(Ok(self.scene.clone()), "the scene again") {
            ledger.noise = (cpu_s / ledger.cpu_s).max(ledger.cpu_s / cpu_s) - 1.0;
            ledger.cpu_s = ledger.cpu_s.min(cpu_s);
        }
        Some(())
    }

    /// The work of all effects.
    fn work(&self) -> Result<Vec<EffectWork>, Error> {
        let mut started = Started::new(self.scene, self.scene.build()?, self.watch)?;
        let mut observer = WorkObserver::new(self.scene.run.analysis, self.watch);
        started.drive(self.scene, &mut observer)?;
        // half of the work would look like the whole
        Ok(if self.watch.is_interrupted() { Vec::new() } else { observer.all })
    }

    /// Leaves out together what matters little one by one; of what then matters too much the largest stays. Nothing if
    /// Ctrl-C was pressed, and no advice if nothing can be left out.
    fn advise(&self, has: &[Candidate], accuracy: f64, ledger: &Ledger) -> Option<Option<Advice>> {
        let mut small: Vec<(&Candidate, f64, &Verdict)> = has
            .iter()
            .zip(&ledger.without)
            .filter_map(|(c, t)| Some((c, t.verdict.change()?, &t.verdict)))
            .filter(|(_, change, _)| *change <= accuracy)
            .collect();
        small.sort_by(|a, b| a.1.total_cmp(&b.1));
        while !small.is_empty() {
            let names = small.iter().map(|(c, ..)| c.name.clone()).collect();
            let verdict = match small.as_slice() {
                [(_, _, alone)] => (*alone).clone(),
                _ => {
                    let edits: Vec<_> = small.iter().flat_map(|(c, ..)| c.edits.clone()).collect();
                    self.verdict(edited(self.scene, &edits), "without all of them")?
                }
            };
            if verdict.change().is_some_and(|change| change <= accuracy) {
                return Some(Some(Advice { names, verdict }));
            }
            small.pop();
        }
        Some(None)
    }

    /// What becomes of a scene; nothing if Ctrl-C was pressed.
    fn verdict(&self, scene: Result<Scene, String>, name: &str) -> Option<Verdict> {
        if self.watch.is_interrupted() {
            return None;
        }
        let limits = (self.watch, Some(self.most));
        let run = scene.map_err(Fault::new).map_err(Error::from);
        let run = match run.and_then(|scene| fastest(&scene, name, false, limits, self.progress)) {
            Ok(run) => run,
            Err(e) => return Some(Verdict::Failed(e.to_string())),
        };
        match &run.ending {
            Ending::Interrupted if self.watch.is_interrupted() => return None,
            Ending::Interrupted => {
                let most = self.most;
                let message =
                    format!("given up after {most:.0} s, {PATIENCE:.0} times what the scene itself takes");
                return Some(Verdict::Failed(message));
            }
            Ending::Failed(e) => return Some(Verdict::Failed(e.to_string())),
            Ending::Finished | Ending::Stopped(_) => {}
        }
        let Some(change) = change(&self.target, &self.base.table, &run.table) else {
            let message = match &run.stopped_by {
                Some(by) => format!("stopped by {by} before there was a record"),
                None => "the record can't be made without it".to_string(),
            };
            return Some(Verdict::Failed(message));
        };
        Some(Verdict::Ran {
            change: change / self.scale,
            cpu_s: run.elapsed.cpu_or_wall_s(),
            counts: run.counts,
            note: self.note(&run),
        })
    }

    /// Where a run ended, if the scene itself ends elsewhere.
    fn note(&self, run: &History) -> String {
        let (Some(t), Some(base)) = (run.times().last(), self.base.times().last()) else {
            return String::new();
        };
        if (t - base).abs() <= 1e-9 * base.abs() {
            return String::new();
        }
        let by = run.stopped_by.as_ref().map_or(String::new(), |by| format!(" by {by}"));
        match self.base.table.columns.first() {
            Some(first) if first.name != "t" => format!("ends at {} {t:.4}{by}", first.name),
            _ => format!("ends at t = {t:.4} s{by}"),
        }
    }
}

const AS_IT_IS: &str = "the scene as it is";

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

/// A run of the scene itself, which has to come to an end.
fn whole(run: History) -> Result<History, Error> {
    match run.ending {
        Ending::Interrupted => Err(Error::Interrupted),
        _ => run.complete(),
    }
}

/// The largest change of a record between two runs, in its unit; infinite where one has a value and the other none, and
/// nothing if the other run has no such record or didn't come to the time.
fn change(target: &Target, base: &Table, other: &Table) -> Option<f64> {
    let (a, b) = (target.find_in(base)?, target.find_in(other)?);
    let ends =
        |table: &Table, t: f64| table.columns[0].values.last().is_some_and(|end| t - end <= 1e-9 * t.abs());
    let from = target.t.unwrap_or(f64::NEG_INFINITY);
    if !(ends(&a, from) && ends(&b, from)) {
        return None;
    }
    let change = difference(&a, &b, target.t.map_or(When::Common, When::At));
    Some(if change.is_nan() { f64::INFINITY } else { change })
}

/// The scene without records that can't be made of it.
fn with_possible_records(scene: &Scene) -> Result<Scene, Error> {
    let mut scene = scene.clone();
    loop {
        let model = scene.build()?;
        match scene.records(&model) {
            Ok(_) => return Ok(scene),
            Err(e) => match e.spec {
                Some((SpecKind::Record, k)) => drop(scene.records.remove(k)),
                _ => return Err(e.into()),
            },
        }
    }
}

/// Runs a scene, a short one several times, and gives the fastest of the runs, or the one that didn't come to its end.
fn fastest(
    scene: &Scene,
    name: &str,
    profile: bool,
    (watch, most): (Watch, Option<f64>),
    progress: &SweepProgress,
) -> Result<History, Error> {
    /// Runs are repeated until they have taken this together [s], and once more if they take less than this each.
    const ENOUGH: f64 = 1.0;
    const SHORT: f64 = 3.0;
    const MOST: usize = 7;
    let scene = with_possible_records(scene)?;
    let (mut best, mut spent): (Option<History>, f64) = (None, 0.0);
    for k in 0..MOST {
        let limit = most.and_then(|most| Duration::try_from_secs_f64(most).ok());
        let watch = watch.until(limit.and_then(|limit| Instant::now().checked_add(limit)));
        let progress = Some(progress.begin(name, scene.run.duration));
        let run = compute(&scene, How { watch, progress, profile, positions: false })?;
        let cpu_s = run.elapsed.cpu_or_wall_s();
        spent += cpu_s;
        let is_whole = matches!(run.ending, Ending::Finished | Ending::Stopped(_));
        if !is_whole || best.as_ref().is_none_or(|best| cpu_s < best.elapsed.cpu_or_wall_s()) {
            best = Some(run);
        }
        if !is_whole || spent > if k == 0 { SHORT } else { ENOUGH } {
            break;
        }
    }
    best.ok_or(Error::Interrupted)
}
