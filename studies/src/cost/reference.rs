//! The reference that errors are taken against: steps tightened until they make no difference any more and another
//! integrator agrees, meshes doubled until they hardly do, and the rest extrapolated.

use crate::error::Error;
use crate::study::{Run, Runs, Settings, Target, When, difference, words};
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use ropewalk_core::integrator::{Scheme, Stepping};
use ropewalk_report::{Table, Watch, rough};
use ropewalk_scene::Fault;
use std::sync::Arc;
use std::time::Instant;

/// The first and the last level of steps that are tried.
const LEVELS: std::ops::RangeInclusive<i32> = 2..=7;
/// Steps are tried on a mesh this many times as fine as the coarsest.
const EIGHTFOLD: f64 = 8.0;
/// Most doublings of the mesh.
const DOUBLINGS: i32 = 6;
/// A rate of convergence below this is none.
const LEAST_RATE: f64 = 1.5;
/// More than this is not expected of steps that are ten times tighter.
const MOST_TENFOLD: f64 = 10.0;
/// A rate above this is an accident.
const MOST_RATE: f64 = 64.0;

/// What is taken for exact, and how sure that is. All errors are relative to the size of the record.
pub(super) struct Reference {
    /// Time and what is looked at.
    pub values: Table,
    /// Largest magnitude of the record.
    pub size: f64,
    /// What is left of the error of time steps.
    pub step: f64,
    /// What is left of the error of the mesh.
    pub mesh: f64,
    /// How it was found, for people.
    pub notes: Vec<String>,
}

impl Reference {
    /// How far it may be from the truth.
    pub(super) fn uncertainty(&self) -> f64 {
        self.step + self.mesh
    }

    /// Finds it, to within `wanted`, or as near as can be got until the time is up; none if that isn't near at all.
    /// Steps have until `half` of that time.
    pub(super) fn find(
        runs: &Runs<'_>,
        target: &Target,
        wanted: f64,
        half: Option<Instant>,
        watch: Watch,
    ) -> Result<Option<Self>, Error> {
        let Some(steps) = steps(runs, target, 0.5 * wanted, watch.until(half))? else { return Ok(None) };
        let Steps { run, size, left, mut notes, .. } = steps;
        let whole = Reference { values: run.values.clone(), size, step: left, mesh: 0.0, notes: Vec::new() };
        let Some(first) = runs.axes.base.mesh else { return Ok(Some(Reference { notes, ..whole })) };
        let meshes = Meshes { runs, target, settings: run.settings, watch };
        let Some(found) = meshes.limit(first, 0.5 * wanted * size)? else { return Ok(None) };
        notes.push(found.said);
        let mut step = left;
        // finer meshes move faster than the one on which steps were tried
        if let Some(looser) = steps.looser
            && let Some(loose) = runs.get(&found.finest.settings.stepped(looser), watch)?
        {
            let change = loose.difference(&found.finest, target) / size / (steps.rate - 1.0);
            notes.push(format!("steps on that mesh leave {}", rough(change)));
            step = if change.is_nan() { f64::INFINITY } else { step.max(change) };
        }
        Ok(Some(Reference { values: found.values, step, mesh: found.left / size, notes, ..whole }))
    }
}

/// A run with tight enough steps on a mesh of middling fineness.
struct Steps {
    run: Arc<Run>,
    /// The size of the record.
    size: f64,
    /// What is left of the error, relative to that.
    left: f64,
    /// By how much a tenth of the tolerance divides the error.
    rate: f64,
    /// The tolerance or step before, ten times looser.
    looser: Option<Option<Stepping>>,
    notes: Vec<String>,
}

/// Tightens the steps of both schemes until one changes no more than wanted and the other agrees.
fn steps(runs: &Runs<'_>, target: &Target, wanted: f64, watch: Watch) -> Result<Option<Steps>, Error> {
    let own = runs.axes.base;
    let coarse = runs.axes.coarsest().map(|c| EIGHTFOLD * c).zip(own.mesh).map(|(c, own)| c.min(own));
    let base = own.meshed(coarse);
    // the one of higher order leads
    let mut schemes: Vec<Scheme> = runs.axes.schemes();
    schemes.sort_by_key(|s| *s != Scheme::RadauIia5);
    if schemes.is_empty() {
        let Some(run) = runs.get(&base, watch)? else { return Ok(None) };
        let size = usable(target, &run)?;
        return Ok(Some(Steps { run, size, left: 0.0, rate: MOST_TENFOLD, looser: None, notes: Vec::new() }));
    }
    let mut levels: Vec<Vec<Arc<Run>>> = vec![Vec::new(); schemes.len()];
    let mut found: Option<Steps> = None;
    for k in LEVELS {
        // the one that follows is of lower order, and a level behind; schemes that fail are left out
        let next: Vec<(usize, Settings)> = (0..schemes.len())
            .filter(|s| sound(&levels[*s]))
            .map(|s| {
                (s, Settings { scheme: Some(schemes[s]), stepping: runs.axes.level(k - (s as i32)), ..base })
            })
            .collect();
        let done: Vec<_> = next.par_iter().map(|(s, settings)| (*s, runs.get(settings, watch))).collect();
        for (s, run) in done {
            levels[s].extend(run?);
        }
        let lead = levels.iter().position(|all| all.len() >= 2 && sound(all));
        let Some(lead) = lead else {
            if watch.is_over() {
                break;
            }
            continue;
        };
        let run = &levels[lead][levels[lead].len() - 1];
        let size = usable(target, run)?;
        // what a tenfold tightening changed the last time, and the time before
        let changes = |s: usize| {
            let pairs = levels[s].windows(2).map(|w| w[0].difference(&w[1], target) / size);
            let all: Vec<f64> = pairs.collect();
            (all.last().copied(), all.len().checked_sub(2).map(|n| all[n]))
        };
        let (Some(change), before) = changes(lead) else { continue };
        let rate = before.map_or(LEAST_RATE, |b| b / change).min(MOST_TENFOLD);
        let (mut left, rate) = if rate > LEAST_RATE { (change / (rate - 1.0), rate) } else { (change, 2.0) };
        let mut notes =
            vec![format!("{}: steps ten times looser change the record by {}", told(run), rough(change))];
        let other = (0..schemes.len()).find(|s| *s != lead && sound(&levels[*s]) && !levels[*s].is_empty());
        match other.and_then(|s| Some((s, levels[s].last()?))) {
            Some((s, theirs)) => {
                let (apart, change) = (theirs.difference(run, target) / size, changes(s).0.unwrap_or(1.0));
                let agrees = apart <= 2.0 * change.min(1.0) + left;
                let words = if agrees { "they agree" } else { "they don't agree" };
                let (apart_, change) = (rough(apart), rough(change));
                notes.push(format!(
                    "{} is {apart_} from it and changes by {change} itself: {words}",
                    told(theirs)
                ));
                if !agrees {
                    left = apart.max(left);
                }
            }
            None => notes.push("no other integrator runs this scene, so that none could confirm it".into()),
        }
        if left.is_finite() && found.as_ref().is_none_or(|f| left <= f.left) {
            let looser = Some(runs.axes.level(k - 1 - lead as i32));
            found = Some(Steps { run: run.clone(), size, left, rate, looser, notes });
        }
        if found.as_ref().is_some_and(|f| f.left <= wanted) || watch.is_over() {
            break;
        }
    }
    match levels.iter().flatten().find_map(|r| r.failure.clone()) {
        Some(message) if found.is_none() && !watch.is_over() => Err(broken(&message)),
        _ => Ok(found),
    }
}

/// Whether none of the runs failed.
fn sound(runs: &[Arc<Run>]) -> bool {
    runs.iter().all(|r| r.failure.is_none())
}

/// The scheme of a run, and its step.
fn told(run: &Run) -> String {
    let s = &run.settings;
    format!(
        "{} at {}",
        s.scheme.map(words::scheme).unwrap_or_default(),
        s.stepping.map(words::step).unwrap_or_default()
    )
}

fn broken(message: &str) -> Error {
    Fault::new(format!("the scene doesn't run: {message}"))
        .with_help("try it with `ropewalk run` first")
        .into()
}

/// The size of the record in a run that can be a reference.
fn usable(target: &Target, run: &Run) -> Result<f64, Error> {
    if let Some(message) = &run.failure {
        return Err(broken(message));
    }
    let end = run.values.columns.first().and_then(|c| c.values.last()).copied().unwrap_or(f64::NAN);
    if let Some(t) = target.t.filter(|t| (t - end).abs() > 1e-9 * t.abs()) {
        let fault =
            Fault::new(format!("an event ends the run at {end:.6}, before the {t} of `{}`", target.text));
        return Err(fault.with_help("choose an earlier time").into());
    }
    Ok(target.size(&run.values)?)
}

/// The limit of finer and finer meshes.
struct Limit {
    values: Table,
    /// What is left of its error.
    left: f64,
    said: String,
    finest: Arc<Run>,
}

/// A scene on finer and finer meshes, with steps that are tight enough.
struct Meshes<'a> {
    runs: &'a Runs<'a>,
    target: &'a Target,
    settings: Settings,
    watch: Watch,
}

impl Meshes<'_> {
    /// Doubles the mesh until the extrapolated result is known as well as wanted; none if two meshes were too many.
    fn limit(&self, first: f64, wanted: f64) -> Result<Option<Limit>, Error> {
        let mut all: Vec<Arc<Run>> = Vec::new();
        let mut best: Option<Limit> = None;
        // half the mesh of the scene is a test as well
        let coarse = if self.runs.axes.coarsest().is_some_and(|c| c < first) { 0.5 * first } else { first };
        for next in (0..=DOUBLINGS).step_by(2) {
            let two: Vec<f64> = (next..next + 2).map(|k| coarse * 2.0_f64.powi(k)).collect();
            let run = |mesh: &f64| self.runs.get(&self.settings.meshed(Some(*mesh)), self.watch);
            let done: Vec<Result<Option<Arc<Run>>, Error>> = two.par_iter().map(run).collect();
            for run in done {
                let Some(run) = run? else { break };
                if run.failure.is_some() {
                    all.clear();
                    continue;
                }
                all.push(run);
                if let Some(found) = self.extrapolated(&all)
                    && best.as_ref().is_none_or(|b| found.left <= b.left)
                {
                    best = Some(found);
                }
            }
            if best.as_ref().is_some_and(|b| b.left <= wanted) || self.watch.is_over() {
                break;
            }
        }
        Ok(best)
    }

    /// The limit of the last meshes, if what is left of its error can be told.
    fn extrapolated(&self, all: &[Arc<Run>]) -> Option<Limit> {
        let n = all.len();
        let change = |k: usize| all[k].difference(&all[k - 1], self.target);
        let rate = |k: usize| change(k - 1) / change(k);
        let finest = all.last()?;
        let what = self.runs.axes.words(&finest.settings);
        let (values, left, said) = match n {
            1 => return None,
            2 => {
                let left = change(1);
                let said = format!("{what}: half the elements change the record by {left:.1e}");
                (finest.values.clone(), left, said)
            }
            _ if rate(n - 1) > LEAST_RATE => {
                let steady = rate(n - 1).min(MOST_RATE);
                let values = limit(&finest.values, &all[n - 2].values, steady)?;
                let mut left = change(n - 1) / (steady - 1.0);
                if n > 3 && rate(n - 2) > LEAST_RATE {
                    // the limit that was found without the finest mesh
                    let before = limit(&all[n - 2].values, &all[n - 3].values, rate(n - 2).min(MOST_RATE))?;
                    let when = if self.target.t.is_some() { When::End } else { When::Whole };
                    left = left.min(difference(&values, &before, when));
                }
                let said = format!(
                    "extrapolated from {what}, where twice the elements divide the error by {steady:.1}"
                );
                (values, left, said)
            }
            _ => {
                let said =
                    format!("{what}: doubling the elements changes the record hardly less than before");
                (finest.values.clone(), change(n - 1).max(change(n - 2)), said)
            }
        };
        left.is_finite().then(|| Limit { values, left, said, finest: finest.clone() })
    }
}

/// Where the fine and the coarse result lead if each doubling divides the error by `rate` (Richardson).
fn limit(fine: &Table, coarse: &Table, rate: f64) -> Option<Table> {
    let mut limit = fine.clone();
    let (t, there) = (&fine.columns.first()?.values, &coarse.columns.first()?.values);
    let mut j = 0;
    for (i, now) in t.iter().enumerate() {
        while j + 1 < there.len() && there[j] < now - 1e-9 * now.abs() {
            j += 1;
        }
        // a row that only one of them has can't be extrapolated
        if !there.get(j).is_some_and(|t| (t - now).abs() <= 1e-9 * now.abs()) {
            continue;
        }
        for (c, column) in limit.columns.iter_mut().enumerate().skip(1) {
            column.values[i] += (column.values[i] - coarse.columns[c].values[j]) / (rate - 1.0);
        }
    }
    Some(limit)
}
