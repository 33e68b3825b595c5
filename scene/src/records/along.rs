//! Tension, strain, curvature and moment at a place of a cable.

use super::named;
use super::place::{Station, off, part};
use crate::register_spec;
use crate::spec::RecordSpec;
use ropewalk_core::{BuildError, Column, Model, Part, Quantity, Record, Sample};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Tension, strain, curvature or bending moment of a cable at one place: column `hose.end.tension`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AlongSpec {
    /// The cable.
    pub of: String,
    /// Recorded quantity: tension [N], strain, curvature [1/m] or moment [N m].
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
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>) {
        out.push(
            self.part
                .observe(self.what, self.place.now(self.part.as_ref(), &s.at), &s.at)
                .unwrap_or(f64::NAN),
        );
    }
}

#[typetag::serde(name = "along")]
impl RecordSpec for AlongSpec {
    fn build(&self, model: &Model) -> Result<Box<dyn Record>, BuildError> {
        let part = part(model, self.of.trim())?;
        let s = self.at.on(part.length());
        let state = model.state();
        if part.observe(self.what, s, &state.at()).is_none() {
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
        Ok(Box::new(Along { part, what: self.what, place: self.at, name, title }))
    }
}
