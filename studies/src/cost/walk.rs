//! Which settings are tried: for both schemes a walk from coarse to fine that refines what the error depends on, mesh or
//! step; then, along the best of these, the other stiffness models and quadratures, each until it has fallen behind.

use super::front::{Point, front};
use super::reference::Reference;
use crate::error::Error;
use crate::study::{Run, Runs, Settings, Target};
use ropewalk_core::integrator::Scheme;
use ropewalk_elements::cable::CableModel;
use ropewalk_report::Watch;
use std::sync::Arc;
use std::time::Duration;

/// Tightest level of steps.
const LAST_LEVEL: i32 = 7;
/// Refinements in vain after which a walk ends.
const PATIENCE: usize = 3;
/// How much dearer a run on twice the elements is, or one with steps ten times tighter.
const DEARER: f64 = 3.0;
/// How many times as long as the run before one may take until it is given up.
const TOO_DEAR: f64 = 20.0;
/// As good as for ever [s].
const LONGEST: f64 = 1e7;

/// A walk against a reference.
pub(super) struct Walk<'a> {
    pub runs: &'a Runs<'a>,
    pub target: &'a Target,
    pub reference: &'a Reference,
    /// The smallest error that is of interest.
    pub goal: f64,
    pub watch: Watch,
}

impl Walk<'_> {
    /// Tries everything that is worth it while there is time.
    pub(super) fn go(&self) -> Result<(), Error> {
        let base = self.runs.axes.base;
        let schemes: Vec<Option<Scheme>> = match self.runs.axes.schemes() {
            none if none.is_empty() => vec![None],
            some => some.into_iter().map(Some).collect(),
        };
        for scheme in schemes {
            self.refine(Settings { scheme, ..base })?;
        }
        for models in self.runs.axes.models().into_iter().skip(1) {
            self.follow(models)?;
        }
        Ok(())
    }

    /// The runs so far, with their errors.
    pub(super) fn points(&self) -> Vec<Point> {
        self.runs.timed().into_iter().map(|run| Point::new(run, self.target, self.reference)).collect()
    }

    /// A run with its error; none if there is no time for it.
    fn take(&self, settings: &Settings, like: Option<&Run>) -> Result<Option<(Arc<Run>, f64)>, Error> {
        let dear = like.map_or(0.0, |run| DEARER * run.cpu_s).clamp(0.0, LONGEST);
        if self.watch.left() < dear {
            return Ok(None);
        }
        let worth =
            Duration::from_secs_f64(like.map_or(LONGEST, |run| (TOO_DEAR * run.cpu_s).clamp(1.0, LONGEST)));
        let run = self.runs.timed_for(settings, worth, self.watch)?;
        Ok(run.map(|run| {
            let error = Point::new(run.clone(), self.target, self.reference).error;
            // one that failed is of no use
            (run, if error.is_nan() { f64::INFINITY } else { error })
        }))
    }

    /// From coarse to fine: of twice the elements and tenfold tighter steps, what helps more.
    fn refine(&self, start: Settings) -> Result<(), Error> {
        let (axes, mut level, mut in_vain) = (self.runs.axes, 0, 0);
        let mut here = start.meshed(axes.coarsest()).stepped(axes.level(0));
        let Some((mut run, mut error)) = self.take(&here, None)? else { return Ok(()) };
        while error > self.goal && in_vain < PATIENCE && level <= LAST_LEVEL {
            let finer = here.meshed(here.mesh.map(|m| 2.0 * m));
            let tighter = here.stepped(axes.level(level + 1));
            let both = finer.stepped(tighter.stepping);
            let mut steps = Vec::new();
            if here.mesh.is_some() {
                steps.push((finer, level));
            }
            if here.stepping.is_some() {
                steps.push((tighter, level + 1));
            }
            let mut tried = Vec::new();
            for (settings, level) in steps.iter().copied() {
                if let Some((run, error)) = self.take(&settings, Some(&run))? {
                    tried.push((settings, level, run, error));
                }
            }
            tried.sort_by(|a, b| a.3.total_cmp(&b.3));
            let helps = tried.first().is_some_and(|t| t.3 < 0.7 * error);
            let next = match tried.into_iter().next() {
                Some(best) if helps || steps.len() < 2 => best,
                Some(_) => match self.take(&both, Some(&run))? {
                    Some((run, error)) => (both, level + 1, run, error),
                    None => break,
                },
                None => break,
            };
            in_vain = if next.3 < 0.7 * error { 0 } else { in_vain + 1 };
            (here, level, run, error) = next;
        }
        Ok(())
    }

    /// Other models at the settings of the best runs so far, while they keep up.
    fn follow(&self, models: CableModel) -> Result<(), Error> {
        let own = self.runs.axes.base.models;
        let points: Vec<Point> = self.points().into_iter().filter(|p| p.run.settings.models == own).collect();
        let (mut behind, mut before) = (0, f64::INFINITY);
        for best in front(&points) {
            let settings = Settings { models: Some(models), ..best.run.settings };
            let Some((run, error)) = self.take(&settings, Some(&best.run))? else {
                break;
            };
            if run.failure.is_some() && run.counts.steps == 0 && run.cpu_s.is_infinite() {
                // refused as it is, whatever the mesh
                break;
            }
            // the same with half the elements may do as well
            if error < best.error
                && let Some(mesh) = settings.mesh.filter(|m| Some(0.5 * m) >= self.runs.axes.coarsest())
            {
                self.take(&settings.meshed(Some(0.5 * mesh)), Some(&best.run))?;
            }
            let beaten = points.iter().any(|p| p.error <= error && p.run.cpu_s <= run.cpu_s);
            behind = match (&run.failure, beaten) {
                (Some(_), _) => behind + 2,
                (None, true) => behind + 1,
                (None, false) => 0,
            };
            let stuck = error.is_finite() && error > 0.7 * before;
            if behind >= 3 || stuck && beaten {
                break;
            }
            before = error;
        }
        Ok(())
    }
}
