//! How long a cable is.

use super::named;
use super::place::part;
use crate::register_spec;
use crate::spec::RecordSpec;
use ropewalk_core::{BuildError, Column, Model, Part, Quantity, Record, Sample};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Unstretched length of a cable, including the payout of winches: column `hose.length` in m.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LengthSpec {
    /// The cable.
    pub of: String,
    /// Name in results. Default: that of the cable and `.length`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Title of its plots. Default: the quantity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
}
register_spec!(Record, "length", LengthSpec);

impl LengthSpec {
    /// The length of a cable, under its own name.
    pub fn new(of: &str) -> Self {
        LengthSpec { of: of.into(), name: None, title: None }
    }
}

struct Length {
    part: Arc<dyn Part>,
    name: String,
    title: String,
}

impl Record for Length {
    fn title(&self) -> String {
        self.title.clone()
    }
    fn name(&self) -> String {
        self.name.clone()
    }
    fn columns(&self) -> Vec<Column> {
        vec![Column::new(&self.name, "m")]
    }
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>) {
        out.push(self.part.length_now(&s.at));
    }
}

#[typetag::serde(name = "length")]
impl RecordSpec for LengthSpec {
    fn build(&self, model: &Model) -> Result<Box<dyn Record>, BuildError> {
        let part = part(model, self.of.trim())?;
        if part.observe(Quantity::Tension, 0.0, &model.state().at()).is_none() {
            let message = format!("`{}` is a {}, which has no length", part.name(), part.kind());
            return Err(BuildError::at("of", message));
        }
        let name = named(&self.name, || format!("{}.length", part.name()));
        let title = named(&self.title, || format!("Length of {}", part.name()));
        Ok(Box::new(Length { part, name, title }))
    }
}
