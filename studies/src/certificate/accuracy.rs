//! Settings that reach an accuracy: from coarse to fine, of steps and mesh what the error depends on more is refined, until
//! the certificate says that it is reached.

use super::compare::{Refined, all, change};
use super::statement::Certificate;
use super::{FINER, certify};
use crate::error::Error;
use crate::study::{Axes, Runs, Settings, Target};
use ropewalk_core::integrator::Scheme;
use ropewalk_report::Watch;
use ropewalk_scene::Fault;

/// Below this error the scheme of higher order is cheaper.
const OF_HIGH_ORDER: f64 = 1e-5;
/// Tightest level of steps.
const LAST_LEVEL: i32 = 7;
/// Most elements, as a multiple of the coarsest mesh.
const FINEST: f64 = 512.0;

/// Settings, and how far they can be trusted.
pub struct Chosen {
    /// The settings.
    pub settings: Settings,
    /// How far they can be trusted.
    pub certificate: Certificate,
    /// Whether the accuracy is reached.
    pub reached: bool,
}

/// Looks for settings that know a record to an accuracy, relative to its size. Those that come nearest are given if none
/// reach it while there is time; none if even that isn't known.
///
/// # Errors
/// A record that has no size, or a scene that doesn't run at all.
pub fn choose(
    runs: &Runs<'_>,
    target: &Target,
    accuracy: f64,
    watch: Watch,
) -> Result<Option<Chosen>, Error> {
    let mut place = Place::coarse(runs.axes, accuracy);
    let mut best: Option<(f64, Settings)> = None;
    let mut complaint = None;
    loop {
        let here = place.settings(runs.axes);
        let errors = match errors(runs, &place, target, accuracy, watch)? {
            Found::Stopped => break,
            Found::Failed(message) => {
                complaint = Some(message);
                [f64::INFINITY; 2]
            }
            Found::Errors(errors) => {
                let error = errors[0] + errors[1];
                if best.is_none_or(|(least, _)| error < least) {
                    best = Some((error, here));
                }
                errors
            }
        };
        if errors[0] + errors[1] <= accuracy || !place.refine(errors, accuracy) || watch.is_over() {
            break;
        }
    }
    let Some((error, settings)) = best else {
        let Some(message) = complaint.filter(|_| !watch.is_over()) else { return Ok(None) };
        let fault = Fault::new(format!("the scene doesn't run: {message}"));
        return Err(fault.with_help("try it without `--accuracy` first").into());
    };
    // that is known already, but for what was interrupted
    let certificate = certify(runs, &settings, std::slice::from_ref(target), Some(accuracy), watch)?;
    let Some(mut certificate) = certificate else { return Ok(None) };
    certificate.cpu_s = runs.spent();
    Ok(Some(Chosen { settings, reached: error <= accuracy && certificate.holds(), certificate }))
}

/// How fine steps and mesh are.
struct Place {
    base: Settings,
    level: i32,
    mesh: Option<f64>,
    finest: f64,
}

impl Place {
    /// Where the search begins: the error of a step is about its tolerance.
    fn coarse(axes: &Axes<'_>, accuracy: f64) -> Self {
        let scheme = match axes.base.scheme {
            Some(Scheme::GeneralizedAlpha { .. }) if accuracy <= OF_HIGH_ORDER => Some(Scheme::RadauIia5),
            own => own,
        };
        let coarsest = axes.coarsest();
        Place {
            base: Settings { scheme, ..axes.base },
            level: ((1e-3 / accuracy).log10().floor() as i32).clamp(0, LAST_LEVEL - 1),
            mesh: coarsest.map(|c| 2.0 * c),
            finest: coarsest.map_or(f64::INFINITY, |c| FINEST * c),
        }
    }

    fn settings(&self, axes: &Axes<'_>) -> Settings {
        self.base.meshed(self.mesh).stepped(axes.level(self.level))
    }

    /// Refines what the error of steps and mesh depends on; whether there was anything left to refine.
    fn refine(&mut self, [step, mesh]: [f64; 2], accuracy: f64) -> bool {
        if self.base.stepping.is_some() && (step >= 0.5 * accuracy || step > mesh) {
            self.level += if step.is_finite() && step > 20.0 * accuracy { 2 } else { 1 };
        }
        if mesh >= 0.5 * accuracy || mesh > step {
            self.mesh = self.mesh.map(|m| 2.0 * m);
        }
        self.level <= LAST_LEVEL && self.mesh.is_none_or(|m| m <= self.finest)
    }
}

enum Found {
    Stopped,
    /// One of the runs failed.
    Failed(String),
    /// Errors of steps and mesh.
    Errors([f64; 2]),
}

/// What tighter steps and a finer mesh change in the record.
fn errors(
    runs: &Runs<'_>,
    place: &Place,
    target: &Target,
    accuracy: f64,
    watch: Watch,
) -> Result<Found, Error> {
    let here = place.settings(runs.axes);
    let tighter = here.stepping.map(|_| here.stepped(runs.axes.level(place.level + 1)));
    let finer = here.mesh.map(|m| here.meshed(Some(2.0 * m)));
    let Some(refined) = Refined::new(runs, [Some(here), tighter, finer], watch)? else {
        return Ok(Found::Stopped);
    };
    if let Some(message) = refined.named().find_map(|(_, run)| run.failure.clone()) {
        return Ok(Found::Failed(message));
    }
    let base = &refined.base;
    let step = refined.tighter.as_ref().map_or(Ok(0.0), |run| change(target, base, run))?;
    // of second order, a doubling shows three quarters of the error
    let mut mesh = refined.finer.as_ref().map_or(Ok(0.0), |run| change(target, base, run))? * 4.0 / 3.0;
    if let Some(m) = here.mesh.filter(|_| step + mesh <= accuracy) {
        let Some(fine) = all(runs, &[here.meshed(Some(FINER * m))], watch)? else {
            return Ok(Found::Stopped);
        };
        mesh = change(target, base, &fine[0])?;
    }
    Ok(Found::Errors([step, mesh]))
}
