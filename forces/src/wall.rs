//! What the wall of a cable carries beside the effective tension.

use crate::buoyancy::{AREA, LEVEL, SPECIFIC_WEIGHT};
use crate::internal_flow::{PRESSURE, WALL};
use ropewalk_core::{At, Model, Part, Quantity, Term};
use std::sync::Arc;

/// The wall of a cable, between the fluid in it and the water around: `T_w = T_e + p_i A_i - p_o A_o`.
#[derive(Clone)]
pub struct Wall {
    /// The cable.
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

    fn of(&self, term: usize, quantity: &str, s: f64, model: &Model, at: &At<'_>) -> f64 {
        local(model.terms()[term].as_ref(), quantity, self.part.name(), s, at).unwrap_or(f64::NAN)
    }

    /// Pressure of what flows in it at an arc length [Pa]; NaN if nothing does.
    pub fn pressure(&self, s: f64, model: &Model, at: &At<'_>) -> f64 {
        self.flow.map_or(f64::NAN, |term| self.of(term, PRESSURE, s, model, at))
    }

    /// Its tension at an arc length [N].
    pub fn tension(&self, s: f64, model: &Model, at: &At<'_>) -> f64 {
        let above = match self.flow {
            Some(term) => self.of(term, WALL, s, model, at),
            None => self.outside(s, model, at).map_or(0.0, |outside| self.pressed(&outside, s, at)),
        };
        self.part.observe(Quantity::Tension, s, at).unwrap_or(f64::NAN) + above
    }

    /// The water around at an arc length, which stays as it is; `None` if there is none that is known of.
    pub fn outside(&self, s: f64, model: &Model, at: &At<'_>) -> Option<Outside> {
        let term = self.water?;
        let of = |quantity: &str| self.of(term, quantity, s, model, at);
        Some(Outside { specific_weight: of(SPECIFIC_WEIGHT), level: of(LEVEL), area: of(AREA) })
    }

    /// What the pressure of the water around adds to the effective tension at an arc length [N].
    pub fn pressed(&self, outside: &Outside, s: f64, at: &At<'_>) -> f64 {
        let z = self.part.point(s, at).map_or(f64::NAN, |(x, _)| x[2]);
        let strain = self.part.observe(Quantity::Strain, s, at).unwrap_or(f64::NAN);
        -outside.specific_weight * (outside.level - z).max(0.0) * outside.area / (1.0 + strain)
    }
}

/// The water around a place of a cable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outside {
    /// Weight per volume [N/m³].
    pub specific_weight: f64,
    /// Height of its surface [m].
    pub level: f64,
    /// Area of the cable's section, unstretched [m²].
    pub area: f64,
}
