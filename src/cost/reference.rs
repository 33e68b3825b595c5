//! The reference that errors are taken against: steps tightened until they make no difference any more and another
//! integrator agrees, meshes doubled until they hardly do, and the rest extrapolated.

use super::runs::{Run, Runs};
use crate::error::Error;
use crate::output::{Table, rough};
use crate::scene::Fault;
use crate::study::{Settings, Watch, words};
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use ropewalk_core::integrator::Scheme;
use std::sync::Arc;

/// The first and the last level of steps that are tried.
const LEVELS: std::ops::RangeInclusive<i32> = 2..=7;
/// Most doublings of the mesh.
const DOUBLINGS: usize = 6;
/// A rate of convergence below this is none.
const LEAST_RATE: f64 = 1.5;
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
    pub(super) fn doubt(&self) -> f64 {
        self.step + self.mesh
    }

    /// Finds it, to within `wanted`, or as near as can be got until the time is up; none if that isn't near at all.
    pub(super) fn find(runs: &Runs<'_>, wanted: f64, watch: Watch) -> Result<Option<Self>, Error> {
        let Some((base, size, step, mut notes)) = steps(runs, 0.5 * wanted, watch)? else { return Ok(None) };
        let whole = Reference { values: base.values.clone(), size, step, mesh: 0.0, notes: Vec::new() };
        let Some(first) = base.settings.mesh else { return Ok(Some(Reference { notes, ..whole })) };
        let meshes = meshes(runs, &base, first, 0.5 * wanted * size, watch)?;
        let (values, doubt, said) = meshes;
        notes.push(said);
        if doubt.is_nan() {
            return Ok(None);
        }
        Ok(Some(Reference { values, mesh: doubt / size, notes, ..whole }))
    }
}

/// A run with tight enough steps on the mesh of the scene, the size of the record, what is left of the error, and words.
type Steps = (Arc<Run>, f64, f64, Vec<String>);

/// Tightens the steps of both schemes until one changes no more than wanted and the other agrees.
fn steps(runs: &Runs<'_>, wanted: f64, watch: Watch) -> Result<Option<Steps>, Error> {
    let base = runs.axes.base;
    // the one of higher order leads
    let mut schemes: Vec<Option<Scheme>> = runs.axes.schemes().into_iter().map(Some).collect();
    schemes.sort_by_key(|s| *s != Some(Scheme::RadauIia5));
    if schemes.is_empty() {
        let Some(run) = runs.get(&base, false, watch)? else { return Ok(None) };
        let size = usable(runs, &run)?;
        return Ok(Some((run, size, 0.0, Vec::new())));
    }
    let mut levels: Vec<Vec<Arc<Run>>> = vec![Vec::new(); schemes.len()];
    let mut found: Option<Steps> = None;
    let mut complaint = None;
    for k in LEVELS {
        // schemes that fail are left out
        let all: Vec<usize> =
            (0..schemes.len()).filter(|s| levels[*s].iter().all(|r| r.failure.is_none())).collect();
        let settings = |s: &usize| Settings { scheme: schemes[*s], stepping: runs.axes.level(k), ..base };
        let done: Vec<Result<Option<Arc<Run>>, Error>> =
            all.par_iter().map(|s| runs.get(&settings(s), false, watch)).collect();
        for (s, run) in all.iter().zip(done) {
            if let Some(run) = run? {
                complaint = run.failure.clone().or(complaint);
                levels[*s].push(run);
            }
        }
        let sound =
            |s: usize| levels[s].iter().rev().filter(|r| r.failure.is_none()).take(2).collect::<Vec<_>>();
        let Some(lead) = (0..schemes.len()).find(|s| sound(*s).len() == 2) else {
            if watch.is_over() {
                break;
            }
            continue;
        };
        let size = usable(runs, sound(lead)[0])?;
        let change = |s: usize| match sound(s).as_slice() {
            [tight, loose] => runs.between(tight, loose) / size,
            _ => f64::INFINITY,
        };
        let (own, run) = (change(lead), sound(lead)[0].clone());
        let who = format!(
            "{} at {}",
            name(schemes[lead]),
            run.settings.stepping.map(words::step).unwrap_or_default()
        );
        let mut notes = vec![format!("{who}: a tenth of it changes the record by {}", rough(own))];
        let mut left = own;
        let other = (0..schemes.len()).find(|s| *s != lead && !sound(*s).is_empty());
        match other.map(|s| (s, runs.between(sound(s)[0], &run) / size)) {
            Some((s, apart)) => {
                let theirs = change(s);
                let agrees = apart <= 2.0 * theirs.min(1.0) + own;
                notes.push(format!(
                    "{} at {} is {} from it and changes by {} itself: they {}",
                    name(schemes[s]),
                    sound(s)[0].settings.stepping.map(words::step).unwrap_or_default(),
                    rough(apart),
                    rough(theirs),
                    if agrees { "agree" } else { "don't agree" }
                ));
                if !agrees {
                    left = apart.max(own);
                }
            }
            None => notes.push("no other integrator runs this scene, so that none could confirm it".into()),
        }
        if left.is_finite() && found.as_ref().is_none_or(|f| left <= f.2 || f.2.is_nan()) {
            found = Some((run, size, left, notes));
        }
        if found.as_ref().is_some_and(|f| f.2 <= wanted) || watch.is_over() {
            break;
        }
    }
    match (found, complaint) {
        (None, Some(message)) if !watch.is_over() => {
            Err(Fault::new(format!("the scene doesn't run: {message}"))
                .with_help("try it with `ropewalk run` first")
                .into())
        }
        (found, _) => Ok(found),
    }
}

/// The size of the record in a run that can be a reference.
fn usable(runs: &Runs<'_>, run: &Run) -> Result<f64, Error> {
    if let Some(message) = &run.failure {
        let fault = Fault::new(format!("the scene doesn't run: {message}"));
        return Err(fault.with_help("try it with `ropewalk run` first").into());
    }
    let end = run.values.columns.first().and_then(|c| c.values.last()).copied().unwrap_or(f64::NAN);
    if let Some(t) = runs.target.t.filter(|t| (t - end).abs() > 1e-9 * t.abs()) {
        let fault = Fault::new(format!(
            "an event ends the run at {end:.6}, before the {t} of `{}`",
            runs.target.text
        ));
        return Err(fault.with_help("choose an earlier time").into());
    }
    Ok(runs.target.size(&run.values)?)
}

/// Doubles the mesh until the extrapolated result changes no more than wanted. Gives it, what is left of its error, and
/// words.
fn meshes(
    runs: &Runs<'_>,
    base: &Run,
    first: f64,
    wanted: f64,
    watch: Watch,
) -> Result<(Table, f64, String), Error> {
    let mut all: Vec<Arc<Run>> = Vec::new();
    let mut best = (base.values.clone(), f64::NAN, String::new());
    // half the mesh of the scene is a test as well, and the two are computed together
    let coarse = if runs.axes.coarsest().is_some_and(|c| c < first) { 0.5 * first } else { first };
    let mut next = 0;
    while next <= DOUBLINGS {
        let two: Vec<f64> = (next..next + 2).map(|k| coarse * 2.0_f64.powi(k as i32)).collect();
        let run = |mesh: &f64| runs.get(&base.settings.meshed(Some(*mesh)), false, watch);
        let done: Vec<Result<Option<Arc<Run>>, Error>> = two.par_iter().map(run).collect();
        for run in done {
            match run? {
                Some(run) => {
                    if run.failure.is_some() {
                        all.clear();
                    } else {
                        all.push(run);
                    }
                }
                None => break,
            }
            if let Some(found) = extrapolated(runs, &all)
                && !(found.1 > best.1)
            {
                best = found;
            }
        }
        if best.1 <= wanted || watch.is_over() {
            break;
        }
        next += 2;
    }
    Ok(best)
}

/// The limit of the last meshes, what is left of its error, and words.
fn extrapolated(runs: &Runs<'_>, all: &[Arc<Run>]) -> Option<(Table, f64, String)> {
    let n = all.len();
    let change = |k: usize| runs.between(&all[k], &all[k - 1]);
    let rate = |k: usize| change(k - 1) / change(k);
    let finest = &all[n.checked_sub(1)?];
    let what = runs.axes.words(&finest.settings);
    match n {
        1 => None,
        2 => Some((
            finest.values.clone(),
            change(1),
            format!("{what}: twice the elements change the record by {}", rough(change(1))),
        )),
        _ => {
            let found = rate(n - 1);
            if !(found >= LEAST_RATE) {
                let said = format!("{what}: twice the elements change the record hardly less than before");
                return Some((finest.values.clone(), change(n - 1).max(change(n - 2)), said));
            }
            let steady = found.min(MOST_RATE);
            let limit = limit(&finest.values, &all[n - 2].values, steady)?;
            let mut left = change(n - 1) / (steady - 1.0);
            if n > 3 && rate(n - 2) >= LEAST_RATE {
                // the limit that was found without the finest mesh
                let before = self::limit(&all[n - 2].values, &all[n - 3].values, rate(n - 2).min(MOST_RATE))?;
                left = left.min(difference_of(runs, &limit, &before));
            }
            Some((
                limit,
                left,
                format!(
                    "extrapolated from {what}, where twice the elements divide the error by {}",
                    rough(found)
                ),
            ))
        }
    }
}

fn difference_of(runs: &Runs<'_>, a: &Table, b: &Table) -> f64 {
    let d = crate::study::difference(a, b, runs.target.t.is_some());
    if d.is_nan() { f64::INFINITY } else { d }
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

fn name(scheme: Option<Scheme>) -> String {
    scheme.map(words::scheme).unwrap_or_default()
}
