//! A scene run in memory: its history, what it took, and where its time went.

use crate::error::Error;
use crate::run::{Counts, Ending, ProfileEntry, Recorder, Started};
use ropewalk_core::integrator::StepReport;
use ropewalk_core::{Model, Observer, Remeshed, Sample, State};
use ropewalk_report::{Interrupt, Stopwatch, SweepProgress, Table};
use ropewalk_scene::{Scene, SpecKind};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// What a run came to.
pub(super) struct Trial {
    pub table: Table,
    /// CPU time from building the model to the last sample [s].
    pub cpu_s: f64,
    pub counts: Counts,
    /// What stopped it before its end.
    pub stopped: Option<String>,
    /// Where the time went, if that was asked for: it adds up to `cpu_s`.
    pub clocks: Vec<ProfileEntry>,
}

/// Why there is no history.
pub(super) enum Failure {
    Interrupted,
    Failed(Error),
    /// It took more time than it was given [s].
    Slow(f64),
}

impl<E: Into<Error>> From<E> for Failure {
    fn from(e: E) -> Self {
        Failure::Failed(e.into())
    }
}

/// What runs have in common: where they show their progress, and whether Ctrl-C was pressed.
pub struct Watch<'a> {
    pub progress: &'a SweepProgress,
    pub interrupt: Option<Interrupt>,
}

impl Watch<'_> {
    pub fn interrupted(&self) -> bool {
        self.interrupt.is_some_and(Interrupt::requested)
    }
}

/// How a scene is run.
#[derive(Clone, Copy, Default)]
pub(super) struct How {
    /// Whether the clocks of terms and phases run.
    pub measure: bool,
    /// Most time on the clock [s].
    pub most: Option<f64>,
}

/// Sees what the recorder sees, and looks at the clock.
struct Eyes<'e, 's> {
    recorder: &'e mut Recorder<'s>,
    recording: Option<(u64, Duration)>,
    end: Option<Instant>,
    late: bool,
}

impl Observer for Eyes<'_, '_> {
    fn step(&mut self, model: &Model, state: &State, report: &StepReport) -> ControlFlow<()> {
        if self.end.is_some_and(|end| Instant::now() > end) {
            self.late = true;
            return ControlFlow::Break(());
        }
        self.recorder.step(model, state, report)
    }
    fn needs_forces(&self) -> bool {
        self.recorder.needs_forces()
    }
    fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()> {
        let Some(spent) = &mut self.recording else { return self.recorder.sample(sample) };
        let begin = Instant::now();
        let flow = self.recorder.sample(sample);
        *spent = (spent.0 + 1, spent.1 + begin.elapsed());
        flow
    }
    fn event(&mut self, name: &str, t: f64) {
        self.recorder.event(name, t);
    }
    fn remeshed(&mut self, report: &Remeshed) {
        self.recorder.remeshed(report);
    }
}

/// Runs a scene to its end. Records that can't be made of it are left out of it.
pub(super) fn run(scene: &Scene, name: &str, how: How, watch: &Watch<'_>) -> Result<Trial, Failure> {
    let mut scene = scene.clone();
    let stopwatch = Stopwatch::start();
    let (model, own) = loop {
        let model = scene.build()?;
        match scene.records(&model) {
            Ok(own) => break (model, own),
            Err(e) => match e.spec {
                Some((SpecKind::Record, k)) => drop(scene.records.remove(k)),
                _ => return Err(e.into()),
            },
        }
    };
    let built = stopwatch.elapsed();
    let mut recorder = Recorder::new(&scene, own);
    recorder.progress = Some(watch.progress.begin(name, scene.run.duration));
    recorder.interrupt = watch.interrupt;
    let mut started = Started::new(&scene, model)?;
    let begun = stopwatch.elapsed();
    if how.measure {
        started.profile();
    }
    let mut eyes = Eyes {
        recorder: &mut recorder,
        recording: how.measure.then_some((0, Duration::ZERO)),
        end: how.most.map(|s| Instant::now() + Duration::from_secs_f64(s)),
        late: false,
    };
    let end = started.drive(&scene, &mut eyes);
    let (recording, late) = (eyes.recording, eyes.late);
    let elapsed = stopwatch.elapsed();
    if let Some(progress) = recorder.progress.take() {
        progress.finish("");
    }
    match recorder.stop.take() {
        Some(Ending::Interrupted) => return Err(Failure::Interrupted),
        Some(Ending::Failed(e)) => return Err(Failure::Failed(e)),
        _ if late => return Err(Failure::Slow(how.most.unwrap_or_default())),
        _ => {}
    }
    let stopped = match end? {
        ropewalk_core::End::Done => None,
        ropewalk_core::End::Stopped { by } => Some(by),
    };
    let mut clocks = Vec::new();
    if let Some((calls, time)) = recording {
        let line =
            |label: &str, calls, seconds| ProfileEntry { label: label.into(), calls, seconds, share: 0.0 };
        clocks = started.times();
        clocks.push(line("recording", calls, time.as_secs_f64()));
        let known: f64 = clocks.iter().map(|c| c.seconds).sum();
        let rest = elapsed.wall_s - begun.wall_s - known;
        clocks.push(line("Newton's method and step control", 1, rest.max(0.0)));
        clocks.push(line("start", 1, begun.wall_s - built.wall_s));
        clocks.push(line("building the model", 1, built.wall_s));
        // clocks run on while others compute; every line is equally likely to wait
        let cpu = if elapsed.cpu_s.is_finite() { elapsed.cpu_s } else { elapsed.wall_s };
        for c in &mut clocks {
            c.share = c.seconds / elapsed.wall_s;
            c.seconds = c.share * cpu;
        }
    }
    let counts = started.done().counts;
    let cpu_s = if elapsed.cpu_s.is_finite() { elapsed.cpu_s } else { elapsed.wall_s };
    Ok(Trial { table: recorder.table, cpu_s, counts, stopped, clocks })
}

/// Runs a scene, a short one several times, and gives the fastest of the runs.
pub(super) fn fastest(scene: &Scene, name: &str, how: How, watch: &Watch<'_>) -> Result<Trial, Failure> {
    /// Runs are repeated until they have taken this together [s], and once more if they take less than this each.
    const ENOUGH: f64 = 1.0;
    const SHORT: f64 = 3.0;
    const MOST: usize = 7;
    let mut best = run(scene, name, how, watch)?;
    let mut spent = best.cpu_s;
    for k in 1..MOST {
        if spent > if k == 1 { SHORT } else { ENOUGH } {
            break;
        }
        let again = run(scene, name, how, watch)?;
        spent += again.cpu_s;
        if again.cpu_s < best.cpu_s {
            best = again;
        }
    }
    Ok(best)
}
