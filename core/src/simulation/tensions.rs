//! What is said of tensions at the end of a run that steps can't be held to: waves that they don't resolve, and errors that add
//! up as nothing damps them.

use super::{Observer, Simulation};
use crate::simulation::audit::Audit;
use crate::solve::integrator::{StepReport, Stepping, Strained};

/// Steps in which tension rings that are worth a word, and their share of the time.
const RUNG: u64 = 8;
const RUNG_SHARE: f64 = 0.1;
/// What errors of steps may add up to in a tension, in parts of its tolerance: what they do to a wave has either sign.
const SUMMED: f64 = 5.0;

/// Steps in which the tension of a cable swung to and fro from one to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Rung {
    steps: u64,
    /// Their time [s], and when the first of them was [s].
    time: f64,
    first: f64,
    /// The last cable in which it did.
    part: usize,
}

/// What the errors of steps add up to in the tensions of each part.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Summed {
    parts: Vec<Sum>,
}

/// The same in one part [N].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Sum {
    sum: f64,
    /// The largest force at work, and the largest wave.
    force: f64,
    wave: f64,
}

impl Sum {
    /// By how much of the largest force tensions may be off: a wave of which nothing is right by twice its size. Nothing where
    /// nothing was looked at.
    fn off(&self) -> f64 {
        if self.force == 0.0 { 0.0 } else { self.sum.min(2.0 * self.wave) / self.force }
    }
}

impl Summed {
    fn add(&mut self, Strained { part, off, at_work, wave, .. }: Strained) {
        if self.parts.len() <= part {
            self.parts.resize(part + 1, Sum::default());
        }
        let Sum { sum, force, wave: largest } = &mut self.parts[part];
        (*sum, *force, *largest) = (*sum + off, force.max(at_work), largest.max(wave));
    }

    /// The part in which they come to most, and how much.
    fn most(&self) -> Option<(usize, f64)> {
        // a NaN counts as the most
        self.parts.iter().map(Sum::off).enumerate().max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

impl Simulation {
    /// Warns at the end of a run in which tension has swung to and fro from step to step: the record shows the steps, not the
    /// motion.
    pub(super) fn watch_ringing(&mut self, report: &StepReport, end: f64, observer: &mut dyn Observer) {
        let t = self.state.t;
        if let Some(part) = report.rings {
            let rung = &mut self.rung;
            rung.first = if rung.steps == 0 { t } else { rung.first };
            *rung = Rung { steps: rung.steps + 1, time: rung.time + report.h, part, ..*rung };
        }
        let Rung { steps, time, first, part } = self.rung;
        if t < end || steps < RUNG || time < RUNG_SHARE * t {
            return;
        }
        let remedy = match self.integrator.options().stepping {
            Stepping::Fixed { .. } => "a smaller `h`",
            Stepping::Controlled { .. } => "a smaller `tolerance`",
        };
        let name = self.model.parts().get(part).map_or("a cable", |p| p.name());
        observer.warn(&format!(
            "for {:.0} % of the time, first at t = {first:.4} s, the tension of `{name}` swings to and fro from step to step: waves \
             along or across it that the steps don't resolve and the scheme hardly damps. Tensions between them mean little. Take {remedy}, \
             `rho_inf = 0.5`, Radau IIA, or a little `axial_retardation_time` or `bending_retardation_time`",
            100.0 * time / t
        ));
        // who advances bit by bit hears of it once
        self.rung = Rung::default();
    }

    /// Warns at the end of a run in which errors of tensions have added up: where nothing takes energy out of a motion that is
    /// left to itself, waves along a cable keep what every step does wrong to them.
    pub(super) fn watch_summed(&mut self, report: &StepReport, end: f64, observer: &mut dyn Observer) {
        let Some(strained) = report.strained else { return };
        self.summed.add(strained);
        let Audit { dissipated, supplied, carried, .. } = self.audit;
        let left_alone = self.keep_audit && [dissipated, supplied, carried] == [0.0; 3];
        if self.state.t < end || !left_alone {
            return;
        }
        let tolerance = self.integrator.options().force_tolerance;
        let Some((part, most)) = std::mem::take(&mut self.summed).most() else { return };
        if most <= SUMMED * tolerance {
            return;
        }
        let name = self.model.parts().get(part).map_or("a cable", |p| p.name());
        let most =
            if most < 1.0 { format!("{:.1} % of the largest", 100.0 * most) } else { "all of it".into() };
        observer.warn(&format!(
            "nothing damps the waves along `{name}`: what single steps do wrong to its tension adds up to {most}, and tensions may be \
             off by that, where `force_tolerance` asks for {} %. Take a smaller `tolerance`, Radau IIA 5 or a little \
             `axial_retardation_time`; `run --certify` measures what it comes to",
            100.0 * tolerance
        ));
    }
}
