//! The equations of a scene linearised about a state: in memory, and as files that other programs read.

mod files;

use crate::error::Error;
use crate::modes::balance;
use crate::run::{NewFolder, Started, prepare, steady};
use ropewalk_core::{Linearised, Model, State, linearise as about};
use ropewalk_report::{RunFolder, Watch};
use ropewalk_scene::{Analysis, Fault, Scene, SceneFile};
use std::path::PathBuf;

/// The state that equations are linearised about.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum About {
    /// The equilibrium: of a run in time that at its start, of a statics scene the end of its load path. A flow inside a hose
    /// stays as fast as it is there.
    #[default]
    Equilibrium,
    /// The start, made consistent.
    Start,
    /// Where the run is at this time [s]; of a statics scene the equilibrium at this load factor.
    Time(f64),
}

/// Options of [`linearise`].
#[derive(Clone, Debug, Default)]
pub struct LineariseOptions {
    /// The state.
    pub about: About,
    /// The folder for the results, which must be new or empty; without it `runs/<scene>-linearised`, numbered.
    pub out: Option<PathBuf>,
    /// What may stop it; by default nothing, and the process keeps its signals.
    pub watch: Watch,
}

/// Linearises a scene in memory; nothing is written.
///
/// # Errors
/// The scene can't be built, has no equilibrium, or its run doesn't come to that time.
pub fn linearise(scene: &Scene, options: &LineariseOptions) -> Result<Linearised, Error> {
    find(scene, scene.build()?, options, &mut |_| {})
}

/// What [`write_linearised`] leaves behind.
pub struct LineariseOutcome {
    /// The folder: `scene.toml`, `manifest.json`, `linearised.json` with all names, and a Matrix Market file for each
    /// matrix.
    pub folder: RunFolder,
    /// The equations.
    pub linearised: Linearised,
    /// What there is, for people.
    pub report: String,
}

/// Linearises a scene into a folder. Warnings are given to `warn`.
///
/// # Errors
/// As [`linearise`]; the folder can't be used.
pub fn write_linearised(
    file: &SceneFile,
    options: &LineariseOptions,
    warn: &mut dyn FnMut(&str),
) -> Result<LineariseOutcome, Error> {
    let (model, manifest) = prepare(file, warn)?;
    let folder = NewFolder::create(options.out.clone(), &format!("{}-linearised", file.name()))?;
    let linearised = find(file.scene(), model, options, warn).map_err(|e| e.in_file(file))?;
    let (folder, _lock) = folder.keep(file, &manifest, true)?;
    let report = files::write(&folder, file.title(), &linearised, warn)?;
    Ok(LineariseOutcome { folder, linearised, report })
}

fn find(
    scene: &Scene,
    model: Model,
    options: &LineariseOptions,
    warn: &mut dyn FnMut(&str),
) -> Result<Linearised, Error> {
    if model.velocities() == 0 {
        return Err(Fault::new("there is nothing in this scene whose equations could be linearised").into());
    }
    let run = &scene.run;
    let statics = run.analysis == Analysis::Statics;
    let end = if statics { run.duration } else { 0.0 };
    let time = match options.about {
        About::Time(t) if !(0.0..=run.duration).contains(&t) => {
            let message = format!(
                "the time must be between 0 and {} s, the `duration` of the scene, not {t}",
                run.duration
            );
            return Err(Fault::new(message).into());
        }
        About::Time(t) => Some(t),
        About::Equilibrium => None,
        About::Start => Some(0.0),
    };
    let frame = run.frame.map(|frame| (frame, &scene.statics));
    let at = |model: &Model, state: &State| -> Result<Linearised, Error> {
        Ok(about(model, state, &scene.records(model)?, frame)?)
    };
    match time {
        Some(t) if !statics => {
            let mut started = Started::new(scene, model, options.watch)?;
            if let (Started::Dynamics(s, ..), true) = (&mut started, t > 0.0) {
                s.advance(t, t, &mut Stop(options.watch))?;
                if options.watch.is_over() {
                    return Err(Error::Interrupted);
                }
                if s.state.t < t {
                    let message = format!("the run ends at t = {} s, before {t} s", s.state.t);
                    return Err(Fault::new(message).into());
                }
            }
            let done = started.done();
            at(&done.model, &done.state)
        }
        time => {
            let model = steady(scene)?.unwrap_or(model);
            let found = balance(scene, &model, time.unwrap_or(end), options.watch)?;
            found.remarks.iter().for_each(|remark| warn(remark));
            at(&model, &found.state)
        }
    }
}

/// Looks for the end of a run that nobody looks at otherwise.
struct Stop(Watch);

impl ropewalk_core::Observer for Stop {
    fn step(
        &mut self,
        _: &Model,
        _: &State,
        _: &ropewalk_core::integrator::StepReport,
    ) -> std::ops::ControlFlow<()> {
        self.0.check()
    }
}
