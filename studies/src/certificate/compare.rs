//! A run beside others that differ from it in one setting: how far they are from each other.

use crate::error::Error;
use crate::study::{Run, Runs, Settings, Target, on_all_cores};
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use ropewalk_core::V3;
use ropewalk_report::Watch;
use std::sync::Arc;

/// Runs these settings on all cores; none if it was stopped.
pub(super) fn all(
    runs: &Runs<'_>,
    wanted: &[Settings],
    watch: Watch,
) -> Result<Option<Vec<Arc<Run>>>, Error> {
    let get = |settings: &Settings| runs.get(settings, watch);
    let done = on_all_cores(|| wanted.par_iter().map(get).collect::<Vec<_>>())?;
    done.into_iter().collect()
}

/// A run, and the same with tighter steps and on a finer mesh.
pub(super) struct Refined {
    pub base: Arc<Run>,
    pub tighter: Option<Arc<Run>>,
    pub finer: Option<Arc<Run>>,
}

impl Refined {
    /// Runs them; none if that was stopped.
    pub(super) fn new(
        runs: &Runs<'_>,
        [base, tighter, finer]: [Option<Settings>; 3],
        watch: Watch,
    ) -> Result<Option<Self>, Error> {
        let wanted: Vec<Settings> = [base, tighter, finer].into_iter().flatten().collect();
        let Some(done) = all(runs, &wanted, watch)? else { return Ok(None) };
        let mut done = done.into_iter();
        let Some(base) = done.next() else { return Ok(None) };
        let tighter = tighter.and_then(|_| done.next());
        Ok(Some(Refined { base, tighter, finer: done.next() }))
    }

    /// The runs with what they are called.
    pub(super) fn named(&self) -> impl Iterator<Item = (&'static str, &Run)> {
        let others = [("tighter steps", &self.tighter), ("finer mesh", &self.finer)];
        let others = others.into_iter().filter_map(|(words, run)| Some((words, run.as_deref()?)));
        std::iter::once(("as it is", self.base.as_ref())).chain(others)
    }
}

/// The largest difference of two runs in a record, relative to its size in the first; infinite if they don't agree in
/// anything, since one failed or ended at quite another time.
///
/// # Errors
/// A record that has no size.
pub(super) fn change(target: &Target, a: &Run, b: &Run) -> Result<f64, Error> {
    let change = a.difference(b, target) / target.size_in(&a.values)?;
    Ok(if change.is_nan() { f64::INFINITY } else { change })
}

/// The largest distance of two runs on the same mesh over time, as root mean square over all nodes, relative to the length
/// of the model; infinite if one of them ended early. Moments at which the meshes differ after all are left out.
pub(super) fn moved(a: &Run, b: &Run) -> Option<f64> {
    let apart = |p: &[V3<f64>], q: &[V3<f64>]| {
        let squares = p.iter().zip(q).map(|(p, q)| (0..3).map(|i| (p[i] - q[i]).powi(2)).sum::<f64>());
        (squares.sum::<f64>() / p.len() as f64).sqrt()
    };
    let (p, q) = (&a.positions, &b.positions);
    // an event may end one of them a little earlier
    if p.len().abs_diff(q.len()) > 1 + p.len() / 50 {
        return Some(f64::INFINITY);
    }
    let same = p.iter().zip(q).filter(|(p, q)| p.len() == q.len() && !p.is_empty());
    let all = same.map(|(p, q)| apart(p, q) / a.length);
    all.reduce(|m, x| if x.is_nan() || m.is_nan() { f64::INFINITY } else { m.max(x) })
}
