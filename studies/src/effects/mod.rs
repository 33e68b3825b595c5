//! The ledger of effects: what each effect of a scene costs and does, what its absence would change, and what effects
//! that the scene lacks would add.

mod catalogue;
mod compare;
mod ledger;
mod pictures;
mod report;
mod work;

pub use ledger::{Advice, EffectTrial, Ledger, Verdict};
pub use work::EffectWork;

use crate::error::Error;
use crate::run::{NewFolder, prepare};
use catalogue::{absent, present};
use compare::Comparison;
use ropewalk_report::{ProgressMode, RunFolder, Stopwatch, SweepProgress, Watch};
use ropewalk_scene::{Fault, Scene, SceneFile};
use std::path::PathBuf;

/// Options of [`effects`].
#[derive(Clone, Debug)]
pub struct EffectsOptions {
    /// The change of the record that doesn't matter, relative to its largest size in the run.
    pub accuracy: f64,
    /// The folder for the results, which must be new or empty; without it `runs/<scene>-effects`, numbered.
    pub out: Option<PathBuf>,
    /// How to show the progress.
    pub progress: ProgressMode,
    /// What may stop it; by default nothing, and the process keeps its signals.
    pub watch: Watch,
}

impl Default for EffectsOptions {
    fn default() -> Self {
        EffectsOptions { accuracy: 1e-2, out: None, progress: ProgressMode::Quiet, watch: Watch::default() }
    }
}

/// Makes the ledger of a scene in memory; nothing is written. `record` names a record or one of its columns, and with
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
    // with and without clocks, work, finer steps, the scene again
    let total = has.len() + lacks.len() + 5;
    let progress = SweepProgress::new(total, options.progress);
    let ledger = Comparison::new(scene, record, options.watch, &progress)
        .and_then(|comparison| comparison.ledger(&has, &lacks, hints, accuracy));
    progress.finish();
    ledger
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

/// Makes the ledger of a scene in a folder. Warnings are given to `warn`.
///
/// # Errors
/// As [`effects`]; the folder can't be used.
pub fn write_effects(
    file: &SceneFile,
    record: &str,
    options: &EffectsOptions,
    warn: &mut dyn FnMut(&str),
) -> Result<EffectsOutcome, Error> {
    let (_, manifest) = prepare(file, warn)?;
    let folder = NewFolder::create(options.out.clone(), &format!("{}-effects", file.name()))?;
    let stopwatch = Stopwatch::start();
    let ledger = effects(file.scene(), record, options)?;
    let (folder, _lock) = folder.keep(file, &manifest, true)?;
    report::write(&folder, &ledger)?;
    let pictures = pictures::draw(&folder, file.title(), &ledger, options.accuracy, warn);
    let report = report::report(file, &ledger, options.accuracy, &folder, &pictures, stopwatch.elapsed());
    Ok(EffectsOutcome { folder, ledger, report })
}
