//! Tension, strain, curvature and moment at a place of a cable.

use super::named;
use super::place::{Station, off, part};
use crate::register_spec;
use crate::spec::RecordSpec;
use ropewalk_core::{BuildError, Column, Model, Part, Quantity, Record, Sample};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Tension, strain, curvature or bending moment of a cable at one place: column `hose.end.tension`. Of a cable with torsion
/// (`section.gj`) its twist, torque, angle and spin too, and curvature and moment about either director of its section. Of a
/// chain of rigid links its tension: what its joints carry, and between two joints what lies between.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AlongSpec {
    /// The cable, or the chain.
    pub of: String,
    /// Recorded quantity: tension [N], strain, curvature [1/m] or moment [N m]; of a cable with torsion twist [rad/m], torque
    /// [N m], angle from the start [rad] or spin [rad/s], and `curvature_normal`, `curvature_across`, `moment_normal` and
    /// `moment_across`, about the first director of the section and about the second.
    pub what: Quantity,
    /// Where: `start`, `end`, an unstretched arc length from the start as it is now [m], or a share of the length like
    /// `50 %`.
    pub at: Station,
    /// Name in results. Default: cable, place and quantity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Title of its plots. Default: the quantity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
}

impl AlongSpec {
    /// Something at a place along a part, under its own name.
    pub fn new(of: &str, what: Quantity, at: Station) -> Self {
        AlongSpec { of: of.into(), what, at, name: None, title: None }
    }
}

register_spec!(Record, "along", AlongSpec);

fn word(what: Quantity) -> &'static str {
    match what {
        Quantity::Tension => "tension",
        Quantity::Strain => "strain",
        Quantity::Curvature => "curvature",
        Quantity::Moment => "moment",
        Quantity::CurvatureNormal => "curvature_normal",
        Quantity::CurvatureAcross => "curvature_across",
        Quantity::MomentNormal => "moment_normal",
        Quantity::MomentAcross => "moment_across",
        Quantity::Twist => "twist",
        Quantity::Torque => "torque",
        Quantity::Angle => "angle",
        Quantity::Spin => "spin",
    }
}

struct Along {
    part: Arc<dyn Part>,
    what: Quantity,
    place: Station,
    name: String,
    title: String,
}

impl Record for Along {
    fn title(&self) -> String {
        self.title.clone()
    }
    fn name(&self) -> String {
        self.name.clone()
    }
    fn columns(&self) -> Vec<Column> {
        vec![Column::new(&self.name, self.what.unit())]
    }
    fn needs_strains(&self) -> bool {
        self.what.is_of_strain()
    }
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>) {
        out.push(
            self.part
                .observe(self.what, self.place.now(self.part.as_ref(), &s.at), &s.at)
                .unwrap_or(f64::NAN),
        );
    }
}

/// The tension of a chain.
struct ChainTension(Along);

impl Record for ChainTension {
    fn title(&self) -> String {
        self.0.title()
    }
    fn name(&self) -> String {
        self.0.name()
    }
    fn columns(&self) -> Vec<Column> {
        self.0.columns()
    }
    fn needs_forces(&self) -> bool {
        true
    }
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>) {
        let (part, place) = (self.0.part.as_ref(), &self.0.place);
        let links = part.links().len();
        let at = place.now(part, &s.at) / part.length() * links as f64;
        let k = (at.max(0.0) as usize).min(links - 1);
        let share = (at - k as f64).clamp(0.0, 1.0);
        let forces = s.model.axial_forces(part, &s.at, s.lambda, k..=k + 1);
        out.push(match share {
            0.0 => forces[k],
            1.0 => forces[k + 1],
            _ => forces[k] + share * (forces[k + 1] - forces[k]),
        });
    }
}

#[typetag::serde(name = "along")]
impl RecordSpec for AlongSpec {
    fn build(&self, model: &Model) -> Result<Box<dyn Record>, BuildError> {
        let part = part(model, self.of.trim())?;
        let s = self.at.on(part.length());
        let state = model.state();
        let chained = !part.links().is_empty() && self.what == Quantity::Tension;
        if chained && part.point(s, &state.at()).is_none() {
            return Err(off(part.as_ref(), "at", s));
        }
        if !chained && part.observe(self.what, s, &state.at()).is_none() {
            // a part that is nowhere to be observed is no cable
            return Err(match part.observe(self.what, 0.0, &state.at()) {
                Some(_) => off(part.as_ref(), "at", s),
                None => BuildError::at(
                    "what",
                    format!("`{}` is a {}, which has no {}", part.name(), part.kind(), word(self.what)),
                ),
            });
        }
        let place = format!("{}{}", part.name(), self.at);
        let name = named(&self.name, || format!("{place}.{}", word(self.what)));
        let title = named(&self.title, || {
            let word = word(self.what);
            format!("{}{} of {place}", word[..1].to_uppercase(), &word[1..])
        });
        let along = Along { part, what: self.what, place: self.at, name, title };
        Ok(if chained { Box::new(ChainTension(along)) } else { Box::new(along) })
    }
}
