//! What the wall of a cable carries beside the effective tension.

use crate::buoyancy::{AREA, LEVEL, SPECIFIC_WEIGHT};
use crate::internal_flow::{PRESSURE, WALL};
use ropewalk_core::{At, Model, Part, Quantity, Sample, Term};
use std::sync::Arc;

/// The wall of a cable, between the fluid in it and the water around: `T_w = T_e + p_i A_i - p_o A_o`.
pub(crate) struct Wall {
    pub part: Arc<dyn Part>,
    /// The term of the flow in it, which knows all, or of the water around.
    flow: Option<usize>,
    water: Option<usize>,
}

fn local(term: &dyn Term, quantity: &str, part: &str, s: f64, at: &At<'_>) -> Option<f64> {
    term.shows()?.local(quantity, part, s, at)
}

impl Wall {
    /// That of a part, and what presses on it.
    pub fn new(model: &Model, part: Arc<dyn Part>) -> Self {
        let state = model.state();
        let knows = |quantity: &str| {
            let finds =
                |t: &Arc<dyn Term>| local(t.as_ref(), quantity, part.name(), 0.0, &state.at()).is_some();
            model.terms().iter().position(finds)
        };
        let (flow, water) = (knows(PRESSURE), knows(SPECIFIC_WEIGHT));
        Wall { part, flow, water }
    }

    /// Whether a fluid flows in it.
    pub fn flows(&self) -> bool {
        self.flow.is_some()
    }

    /// Whether nothing presses on it that is known of.
    pub fn is_bare(&self) -> bool {
        self.flow.is_none() && self.water.is_none()
    }

    fn of(&self, term: usize, quantity: &str, s: f64, sample: &Sample<'_>) -> f64 {
        local(sample.model.terms()[term].as_ref(), quantity, self.part.name(), s, &sample.at)
            .unwrap_or(f64::NAN)
    }

    /// Pressure of what flows in it at an arc length [Pa]; NaN if nothing does.
    pub fn pressure(&self, s: f64, sample: &Sample<'_>) -> f64 {
        self.flow.map_or(f64::NAN, |term| self.of(term, PRESSURE, s, sample))
    }

    /// Its tension at an arc length [N].
    pub fn tension(&self, s: f64, sample: &Sample<'_>) -> f64 {
        let observe = |what| self.part.observe(what, s, &sample.at).unwrap_or(f64::NAN);
        let above = match (self.flow, self.water) {
            (Some(term), _) => self.of(term, WALL, s, sample),
            (None, Some(term)) => {
                let z = self.part.point(s, &sample.at).map_or(f64::NAN, |(x, _)| x[2]);
                let depth = (self.of(term, LEVEL, s, sample) - z).max(0.0);
                let area = self.of(term, AREA, s, sample) / (1.0 + observe(Quantity::Strain));
                -self.of(term, SPECIFIC_WEIGHT, s, sample) * depth * area
            }
            (None, None) => 0.0,
        };
        observe(Quantity::Tension) + above
    }
}
