//! Settings that reach an accuracy: from coarse to fine, what the error hangs on more is refined, until the certificate
//! says that it is reached.

use super::{Certificate, FINER, Trials, certify};
use crate::error::Error;
use crate::study::{Measured, Settings, Target, difference, on_all_cores};
use ropewalk_core::integrator::Scheme;
use std::sync::Arc;

/// Below this error the scheme of higher order is cheaper.
const OF_HIGH_ORDER: f64 = 1e-5;
/// Tightest level of steps.
const LAST_LEVEL: i32 = 7;
/// Most elements, as a multiple of the coarsest mesh.
const FINEST: f64 = 512.0;

/// Settings, and how far they can be trusted.
pub struct Chosen {
    pub settings: Settings,
    pub certificate: Certificate,
    /// Whether the accuracy is reached.
    pub reached: bool,
}

/// Looks for settings that know a record to an accuracy, relative to its size. Those that come nearest are given if none
/// reach it while there is time; none if even that isn't known.
///
/// # Errors
/// A record that has no size, or a scene that doesn't run at all.
pub fn choose(trials: &Trials<'_>, target: &Target, accuracy: f64) -> Result<Option<Chosen>, Error> {
    let axes = trials.axes;
    let own = axes.base;
    let scheme = match own.scheme {
        Some(Scheme::GeneralizedAlpha { .. }) if accuracy <= OF_HIGH_ORDER => Some(Scheme::RadauIia5),
        own => own,
    };
    // the error of a step is about its tolerance
    let mut level = ((1e-3 / accuracy).log10().floor() as i32).clamp(0, LAST_LEVEL - 1);
    let coarsest = axes.coarsest();
    let mut mesh = coarsest.map(|c| 2.0 * c);
    let mut best: Option<(f64, Settings)> = None;
    let mut complaint = String::new();
    loop {
        let here = Settings { mesh, scheme, stepping: axes.level(level), ..own };
        let tighter = here.stepping.map(|_| here.stepped(axes.level(level + 1)));
        let finer = here.mesh.map(|m| here.meshed(Some(2.0 * m)));
        let all: Vec<Settings> = [Some(here), tighter, finer].into_iter().flatten().collect();
        let Some(mut done) = on_all_cores(|| trials.get(&all))?.into_iter().collect::<Option<Vec<_>>>()
        else {
            break;
        };
        let base = done.remove(0);
        let apart = |other: Arc<Measured>| -> Result<f64, Error> {
            if let Some(message) = base.failure.as_ref().or(other.failure.as_ref()) {
                return Err(ropewalk_scene::Fault::new(message).into());
            }
            let (a, b) = (target.of(&base.history), target.of(&other.history));
            let change = difference(&a, &b, target.t.is_some()) / target.size_in(&base.history)?;
            Ok(if change.is_nan() { f64::INFINITY } else { change })
        };
        let failed = base.failure.is_some() || done.iter().any(|r| r.failure.is_some());
        let (mut step, mut grid) = (0.0, 0.0);
        if failed {
            complaint =
                base.failure.clone().or(done.iter().find_map(|r| r.failure.clone())).unwrap_or_default();
            (step, grid) = (f64::INFINITY, f64::INFINITY);
        } else {
            if tighter.is_some() {
                step = apart(done.remove(0))?;
            }
            if let (Some(m), true) = (here.mesh, finer.is_some()) {
                // of second order, a doubling shows three quarters of the error
                grid = apart(done.remove(0))? * 4.0 / 3.0;
                if step + grid <= accuracy {
                    let Some(fine) = trials.get(&[here.meshed(Some(FINER * m))]).pop().flatten() else {
                        break;
                    };
                    grid = apart(fine)?;
                }
            }
        }
        let error = step + grid;
        if best.is_none_or(|(least, _)| error < least) && !failed {
            best = Some((error, here));
        }
        if error <= accuracy {
            break;
        }
        let refine_steps = tighter.is_some() && (step >= 0.5 * accuracy || step > grid);
        let refine_mesh = finer.is_some() && (grid >= 0.5 * accuracy || grid > step);
        if refine_steps {
            level += if step.is_finite() && step > 20.0 * accuracy { 2 } else { 1 };
        }
        if refine_mesh {
            mesh = mesh.map(|m| 2.0 * m);
        }
        let finest = mesh.zip(coarsest).is_some_and(|(m, c)| m > FINEST * c);
        if level > LAST_LEVEL || finest || trials.watch.is_over() {
            break;
        }
    }
    let Some((error, settings)) = best else {
        if trials.watch.is_over() || complaint.is_empty() {
            return Ok(None);
        }
        let fault = ropewalk_scene::Fault::new(format!("the scene doesn't run: {complaint}"));
        return Err(fault.with_help("try it without `--accuracy` first").into());
    };
    // that is known already, but for what was interrupted
    let certificate = certify(trials, &settings, std::slice::from_ref(target), Some(accuracy))?;
    let Some(mut certificate) = certificate else { return Ok(None) };
    certificate.cpu_s = trials.spent();
    Ok(Some(Chosen { settings, reached: error <= accuracy && certificate.holds(), certificate }))
}
