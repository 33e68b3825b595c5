//! Vibration modes of a scene: its equilibrium, the modes about it, and a folder with tables and pictures of them.

mod page;
mod pictures;
mod report;

use crate::error::Error;
use crate::run::{NewFolder, prepare, steady, unseen_by};
use ropewalk_core::modes::{self as core, Critical, Mode, ModesError, OnLook};
use ropewalk_core::statics::{Found, Statics, StaticsError};
use ropewalk_core::{Model, SolveError, State};
use ropewalk_report::{ProgressMode, RunFolder, Stopwatch, Table, Watch, new_bar};
use ropewalk_scene::{Analysis, Fault, Scene, SceneFile};
use std::path::PathBuf;

/// The modes of a scene, and what they are about.
pub struct Modal {
    /// The model.
    pub model: Model,
    /// The equilibrium.
    pub state: State,
    /// How it was found; `None` if the scene was in balance as laid.
    pub search: Option<Found>,
    /// The modes, lowest first. Of an unstable equilibrium only those that grow: nothing vibrates about it.
    pub modes: Vec<Mode>,
    /// Whether the equilibrium is unstable.
    pub unstable: bool,
    /// How far the loads may grow until it tips over; `None` without loads.
    pub critical: Option<Critical>,
    /// What one should know about them.
    pub warnings: Vec<String>,
}

/// Options of [`modes`].
#[derive(Clone, Debug)]
pub struct ModesOptions {
    /// How many modes; those with the lowest frequencies.
    pub count: usize,
    /// The time at which loads and motions are taken [s]; left out, the start of a run in time and the end of a load
    /// path.
    pub time: Option<f64>,
    /// The folder for the results, which must be new or empty; without it `runs/<scene>-modes`, numbered.
    pub out: Option<PathBuf>,
    /// How to show the progress.
    pub progress: ProgressMode,
    /// What may stop it; by default nothing, and the process keeps its signals.
    pub watch: Watch,
}

impl Default for ModesOptions {
    fn default() -> Self {
        let (progress, watch) = (ProgressMode::Quiet, Watch::default());
        ModesOptions { count: 20, time: None, out: None, progress, watch }
    }
}

/// The vibration modes about the equilibrium of a scene, in memory; nothing is written.
///
/// A scene that is in balance as it is laid vibrates about that. Else its equilibrium is searched: of a run in time the
/// one at its start, of a statics scene the end of its load path, in the frame that it names. What changes with time, such
/// as the speed of a flow inside a hose, stays as it is then.
///
/// # Errors
/// The scene can't be built, has no equilibrium, moves, or has something without mass.
pub fn modes(scene: &Scene, options: &ModesOptions) -> Result<Modal, Error> {
    let model = scene.build()?;
    find(scene, model, options, &mut |_, _, _| options.watch.check())
}

impl Modal {
    /// The modes as a table: number, frequency, damping and shares of each.
    pub fn table(&self) -> Table {
        report::table(self)
    }
}

/// Modes in a folder of their own.
pub struct ModesOutcome {
    /// The folder: `scene.toml`, `manifest.json`, `tables/modes.csv`, `plots/mode-N.svg`, and `report.html` where they swing.
    pub folder: RunFolder,
    /// The modes.
    pub modal: Modal,
    /// A table for people.
    pub report: String,
}

/// Computes the modes of a scene into a folder. Warnings are given to `warn`.
///
/// # Errors
/// As [`modes`]; the folder can't be used.
pub fn write_modes(
    file: &SceneFile,
    options: &ModesOptions,
    warn: &mut dyn FnMut(&str),
) -> Result<ModesOutcome, Error> {
    let (model, manifest) = prepare(file, warn)?;
    let folder = NewFolder::create(options.out.clone(), &format!("{}-modes", file.name()))?;
    let stopwatch = Stopwatch::start();
    let bar = match options.progress {
        ProgressMode::Quiet => None,
        _ => Some(new_bar(options.count as u64)),
    };
    let watch = options.watch;
    let mut look = |good: usize, _: usize, vectors: usize| {
        if let Some(bar) = &bar {
            bar.set_position(good as u64);
            bar.set_message(format!("modes, {vectors} vectors"));
        }
        watch.check()
    };
    let found = find(file.scene(), model, options, &mut look);
    if let Some(bar) = &bar {
        bar.finish_and_clear();
    }
    let modal = found?;
    modal.warnings.iter().for_each(|w| warn(w));
    let (folder, _lock) = folder.keep(file, &manifest, true)?;
    modal.table().write(&folder.table_file("modes")?)?;
    let pictures = pictures::draw(&folder, &modal, warn);
    page::page(file, &modal).write(&folder.report_file()).unwrap_or_else(|e| warn(&e.to_string()));
    let report = report::report(file, &modal, &folder, pictures, stopwatch.elapsed());
    Ok(ModesOutcome { folder, modal, report })
}

/// As [`modes`], until it is stopped.
pub(crate) fn modes_watched(scene: &Scene, count: usize, watch: Watch) -> Result<Modal, Error> {
    let options = ModesOptions { count, watch, ..ModesOptions::default() };
    find(scene, scene.build()?, &options, &mut |_, _, _| watch.check())
}

fn find(scene: &Scene, model: Model, options: &ModesOptions, look: &mut OnLook<'_>) -> Result<Modal, Error> {
    if model.velocities() == 0 {
        return Err(ModesError::Held.into());
    }
    let run = &scene.run;
    let end = if run.analysis == Analysis::Statics { run.duration } else { 0.0 };
    let time = options.time.unwrap_or(end);
    if !(0.0..=run.duration).contains(&time) {
        let message = format!(
            "`--at` must be between 0 and {} s, the `duration` of the scene, not {time}",
            run.duration
        );
        return Err(Fault::new(message).into());
    }
    let model = steady(scene)?.unwrap_or(model);
    let start = State { t: time, ..model.state() };
    core::check_at_rest(&model, &start, &scene.statics, run.frame)?;
    let Balance { state, search, remarks: mut warnings } = balance(scene, &model, time, options.watch)?;
    let found = core::modes(&model, &state, &scene.statics, run.frame, options.count, look)?;
    if let Some(of) = found.of.filter(|of| *of < options.count) {
        let plural = if of == 1 { "one mode" } else { &format!("{of} modes") };
        warnings.push(format!("the scene has only {plural}, fewer than the {} asked for", options.count));
    }
    if let Some(n) = found.missing.filter(|n| *n > 0) {
        warnings.push(format!(
            "by Sylvester's law of inertia the number of modes below the last one is off by {n}: the stiffness is too \
             close to rounding, or modes lie too close together"
        ));
    }
    let (mut modes, critical) = (found.modes, found.critical);
    let growing = modes.iter().filter(|m| m.is_unstable()).count();
    let unstable = growing > 0 || found.hidden.is_some();
    if unstable {
        modes.retain(Mode::is_unstable);
        let how = match (found.hidden, growing) {
            (Some(rate), _) => format!(
                "a small disturbance grows by {rate:.3e} per second, in none of the {count} lowest modes: ask for more \
                 with `--count`",
                count = options.count
            ),
            (None, 1) => "a small disturbance grows in one mode".into(),
            (None, n) => format!("a small disturbance grows in {n} modes"),
        };
        warnings.push(format!(
            "the equilibrium is unstable: {how}. Nothing vibrates about it, so no frequencies are given"
        ));
    }
    if let Some(bad) = modes.iter().map(|m| m.residual).filter(|r| !(*r <= 1e-6)).reduce(f64::max) {
        warnings.push(format!("the equations of a mode are met only to {bad:.0e} of its size"));
    }
    Ok(Modal { model, state, search, modes, unstable, critical, warnings })
}

/// An equilibrium of a scene.
pub(crate) struct Balance {
    pub state: State,
    /// How it was found; `None` if the scene was in balance as laid.
    pub search: Option<Found>,
    /// What one should know of the way there.
    pub remarks: Vec<String>,
}

/// The equilibrium at a time, as laid if that is one, and else as it was found: of statics scenes along the load path.
pub(crate) fn balance(scene: &Scene, model: &Model, time: f64, watch: Watch) -> Result<Balance, Error> {
    let in_balance = |state: &mut State| core::in_balance(model, state, &scene.statics, scene.run.frame);
    let mut state = model.state();
    state.v.fill(0.0);
    state.t = time;
    if in_balance(&mut state)? {
        return Ok(Balance { state, search: None, remarks: Vec::new() });
    }
    let no_memory = |e: SolveError| Error::Modes(ModesError::Solver(e));
    let mut search = Statics::relative(model, &scene.statics, scene.run.frame).map_err(no_memory)?;
    search.stop_if(move || watch.is_over());
    if scene.run.analysis == Analysis::Dynamics || time == 0.0 {
        let found = search.find(&mut state, true)?;
        return Ok(Balance { state, search: Some(found), remarks: Vec::new() });
    }
    let steps = scene.statics.steps.max(1);
    state.t = 0.0;
    let mut sum = Found::default();
    let mut unloaded = state.clone();
    if in_balance(&mut unloaded)? {
        state = unloaded;
    } else {
        sum = search.find(&mut state, true)?;
    }
    for k in 1..=steps {
        let found: Result<Found, StaticsError> = search.follow(&mut state, time * k as f64 / steps as f64);
        sum.add(&found?);
    }
    Ok(Balance { state, search: Some(sum), remarks: unseen_by(&search) })
}
