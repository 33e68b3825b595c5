//! What an input is set to.

use super::{listed, named};
use crate::register_spec;
use crate::spec::RecordSpec;
use ropewalk_core::{BuildError, Column, Input, Model, Record, Sample};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Value of an input: one column of its name. At the instant at which it jumps, the value before.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InputRecordSpec {
    /// Name of the input.
    pub of: String,
    /// Name in results. Default: that of the input.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}
register_spec!(Record, "input", InputRecordSpec);

struct InputRecord {
    input: Arc<Input>,
    name: String,
}

impl Record for InputRecord {
    fn title(&self) -> String {
        format!("Input {}", self.input.name())
    }
    fn name(&self) -> String {
        self.name.clone()
    }
    fn columns(&self) -> Vec<Column> {
        let unit = if self.input.unit().is_empty() { "1" } else { self.input.unit() };
        vec![Column::new(&self.name, unit)]
    }
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>) {
        out.push(self.input.value(s.at.t));
    }
}

#[typetag::serde(name = "input")]
impl RecordSpec for InputRecordSpec {
    fn build(&self, model: &Model) -> Result<Box<dyn Record>, BuildError> {
        let of = self.of.trim();
        let Some(input) = model.input(of) else {
            let names = listed(model.inputs().iter().map(|i| i.name()), "none");
            return Err(BuildError::at("of", format!("there is no input `{of}`; the inputs are {names}")));
        };
        Ok(Box::new(InputRecord { input: input.clone(), name: named(&self.name, || of.to_string()) }))
    }
}
