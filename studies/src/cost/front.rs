//! The errors of the runs, and which of them are worth their time.

use super::reference::Reference;
use crate::study::{Run, Target};
use std::sync::Arc;

/// A run and its error, relative to the size of the record.
#[derive(Clone)]
pub(super) struct Point {
    pub run: Arc<Run>,
    /// Its error; NaN if it has none.
    pub error: f64,
    /// The same, or a larger one that a finer run has: then this one is small by coincidence.
    pub sure: f64,
}

impl Point {
    pub(super) fn new(run: Arc<Run>, target: &Target, reference: &Reference) -> Self {
        let exact = Run { values: reference.values.clone(), failure: None, ..(*run).clone() };
        let error = run.difference(&exact, target) / reference.size;
        Point { run, error, sure: error }
    }
}

/// Raises errors that finer runs of the same kind exceed.
pub(super) fn distrust(points: &mut [Point]) {
    let of = |p: &Point| (p.run.settings.models, p.run.settings.scheme);
    let finer = |p: &Point, than: &Point| {
        let (a, b) = (&p.run.settings, &than.run.settings);
        a.mesh >= b.mesh && a.tightness() <= b.tightness()
    };
    let sure: Vec<f64> = points
        .iter()
        .map(|p| {
            points
                .iter()
                .filter(|q| of(q) == of(p) && finer(q, p))
                .map(|q| q.error)
                .filter(|e| !e.is_nan())
                .fold(p.error, f64::max)
        })
        .collect();
    for (p, sure) in points.iter_mut().zip(sure) {
        p.sure = if p.error.is_nan() { f64::NAN } else { sure };
    }
}

/// The runs that no other one beats in both time and error, the cheapest first.
pub(super) fn front(points: &[Point]) -> Vec<Point> {
    let mut all: Vec<Point> =
        points.iter().filter(|p| p.sure.is_finite() && p.run.cpu_s.is_finite()).cloned().collect();
    all.sort_by(|a, b| a.run.cpu_s.total_cmp(&b.run.cpu_s));
    let mut least = f64::INFINITY;
    all.retain(|p| {
        let better = p.sure < least;
        least = least.min(p.sure);
        better
    });
    all
}

/// The cheapest run whose error is at most this.
pub(super) fn cheapest(points: &[Point], error: f64) -> Option<&Point> {
    let good = points.iter().filter(|p| p.sure <= error && p.run.cpu_s.is_finite());
    good.min_by(|a, b| a.run.cpu_s.total_cmp(&b.run.cpu_s))
}
