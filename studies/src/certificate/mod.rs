//! The certificate of a run: it is run again with steps ten times tighter, and again on a mesh with a third of the
//! element length, which divides an error of second order by nine. What that changes is the error of the run.
//!
//! Error control bounds the error of each step, not what a motion makes of it: after a snap, or where a motion is chaotic,
//! small errors grow. Then the difference is far above the tolerance, and the run is called sensitive. What its error hangs
//! on is found by more runs ([`Cause`]).

mod accuracy;
mod cause;
mod compare;
pub(crate) mod statement;

pub use accuracy::{Chosen, choose};
pub use statement::{Cause, Certificate, Change};

use crate::error::Error;
use crate::simulate::simulate_with;
use crate::study::{Axes, Runs, Settings, Target, words};
use compare::{Refined, change, moved};
use ropewalk_report::{ProgressMode, SweepProgress, Table, Watch};
use ropewalk_scene::{Fault, SceneText};

/// How many times as many elements the finer mesh has.
const FINER: f64 = 3.0;
/// A change of more than this many tolerances makes a run sensitive.
const FAR: f64 = 10.0;
/// What a fixed step is held to, which promises nothing.
const OF_FIXED: f64 = 1e-3;

/// Certifies a scene in memory, for the record `of`, `NAME` or `NAME@TIME`, or else for all that have a size; none if it
/// was stopped.
///
/// # Errors
/// The scene or the record is wrong, the scene doesn't run to its end, or there is nothing in it to refine.
pub fn certify_scene(
    text: &SceneText,
    set: &[String],
    of: Option<&str>,
    watch: Watch,
) -> Result<Option<Certificate>, Error> {
    let axes = Axes::new(text, set)?;
    let records = match of {
        Some(of) => vec![Target::parse(of, axes.file())?],
        None => {
            let history = simulate_with(axes.file().scene(), watch).map_err(|e| e.in_file(axes.file()))?;
            if watch.is_interrupted() {
                return Ok(None);
            }
            sized(Target::all(axes.file())?, &history.table)
        }
    };
    if axes.is_empty() {
        let message =
            "there is nothing to refine: the scene has neither elements nor time steps of the solver";
        return Err(Fault::new(message).into());
    }
    let until = of.and_then(|_| records.first()?.t);
    let runs = Runs::in_memory(&axes, until, SweepProgress::new(0, ProgressMode::Quiet));
    let certificate = certify(&runs, &axes.base, &records, None, watch);
    runs.progress.finish();
    certificate
}

/// The records that have a size, and columns that belong to none of them.
pub fn sized(all: Vec<Target>, history: &Table) -> Vec<Target> {
    let mut kept: Vec<Target> = Vec::new();
    for target in all {
        let inside = kept.iter().any(|k| k.columns.contains(&target.columns.start));
        if !inside && target.size_in(history).is_ok() {
            kept.push(target);
        }
    }
    kept
}

/// Certifies settings of a scene for these records; none if it was stopped.
///
/// # Errors
/// A record that has no size.
pub fn certify(
    runs: &Runs<'_>,
    settings: &Settings,
    records: &[Target],
    accuracy: Option<f64>,
    watch: Watch,
) -> Result<Option<Certificate>, Error> {
    let tight = settings.stepping.map(|s| settings.stepped(Some(Axes::tighter(s))));
    let fine = settings.mesh.map(|m| settings.meshed(Some(FINER * m)));
    let spent = runs.spent();
    let Some(refined) = Refined::new(runs, [Some(*settings), tight, fine], watch)? else { return Ok(None) };
    let base = &refined.base;
    let elements =
        |s: Settings| runs.axes.elements(&s).iter().map(u64::to_string).collect::<Vec<_>>().join("+");
    let failed =
        refined.named().filter_map(|(words, run)| Some(format!("{words}: {}", run.failure.as_ref()?)));
    let mut certificate = Certificate {
        tolerance: accuracy.or(settings.tolerance()).unwrap_or(OF_FIXED),
        settings: runs.axes.words(settings),
        tighter: tight.and_then(|s| s.stepping).map(words::step),
        finer: fine.map(|s| format!("{} elements", elements(s))),
        positions: refined.tighter.as_ref().and_then(|tight| moved(base, tight)),
        failures: failed.collect(),
        ..Certificate::default()
    };
    for target in records {
        certificate.records.push(Change {
            record: target.text.clone(),
            size: target.size_in(&base.values)?,
            unit: target.unit.clone(),
            step: refined.tighter.as_ref().map(|other| change(target, base, other)).transpose()?,
            mesh: refined.finer.as_ref().map(|other| change(target, base, other)).transpose()?,
        });
    }
    let far = FAR * certificate.tolerance;
    let asked = accuracy.is_some() || records.len() == 1;
    let by_record =
        |c: &Change| c.step.is_some_and(|x| x > far) || accuracy.is_some() && c.mesh.is_some_and(|x| x > far);
    certificate.sensitive = certificate.positions.is_some_and(|x| !(x <= far))
        || asked && certificate.records.iter().any(by_record)
        || refined.tighter.is_some_and(|run| run.failure.is_some());
    if accuracy.is_none() && certificate.failures.is_empty() {
        certificate.cause = cause::find(runs, settings, records, &certificate, watch)?;
    }
    certificate.cpu_s = runs.spent() - spent;
    Ok(Some(certificate))
}
