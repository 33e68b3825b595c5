//! How many of a group of things have let go.

use super::{listed, named};
use crate::register_spec;
use crate::spec::RecordSpec;
use ropewalk_core::{BuildError, Column, Model, Record, Sample};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Number of released points of a `latch`, or whether a constraint with a `break` is broken: column `reel.released`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ReleasedSpec {
    /// Name of the latch or break.
    pub of: String,
    /// Name in results. Default: that of the latch and `.released`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Title of its plots. Default: the quantity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
}
register_spec!(Record, "released", ReleasedSpec);

struct Released {
    variables: Vec<usize>,
    name: String,
    title: String,
}

impl Record for Released {
    fn title(&self) -> String {
        self.title.clone()
    }
    fn name(&self) -> String {
        self.name.clone()
    }
    fn columns(&self) -> Vec<Column> {
        vec![Column::new(&self.name, "1")]
    }
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>) {
        out.push(self.variables.iter().filter(|&&m| s.at.internal[m] != 0.0).count() as f64);
    }
}

#[typetag::serde(name = "released")]
impl RecordSpec for ReleasedSpec {
    fn build(&self, model: &Model) -> Result<Box<dyn Record>, BuildError> {
        let of = self.of.trim();
        // the internal variables of one latch are called `reel/1`, `reel/2`, …
        let own = |name: &str| name.rsplit_once('/').map_or(name, |(group, _)| group).to_string();
        let all = model.internal_variables();
        let variables: Vec<usize> = (0..all.len()).filter(|&m| all[m] == of || own(&all[m]) == of).collect();
        if variables.is_empty() {
            let mut names: Vec<String> = all.iter().map(|m| own(m)).collect();
            names.dedup();
            let names = listed(names.iter().map(String::as_str), "none");
            let message = format!("nothing named `{of}` lets go; what does is {names}");
            return Err(BuildError::at("of", message));
        }
        let name = named(&self.name, || format!("{of}.released"));
        let title = named(&self.title, || format!("Number of {of} that have let go"));
        Ok(Box::new(Released { variables, name, title }))
    }
}
