//! What a force says of itself.

use super::{listed, named};
use crate::register_spec;
use crate::spec::RecordSpec;
use ropewalk_core::{BuildError, Column, Model, Record, Sample, Term};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Output of a force. Of a contact: columns `drum.fx`, `.fy` and `.fz`, the force of the shape on all that touches it
/// in N, `.normal`, the sum of what presses in N, `.depth`, the deepest point in m, and `.points`, how many touch. Of
/// a spring: `mooring.tension` in N. Of a bushing: `mount.fx`, `.fy`, `.fz` and `.mx`, `.my`, `.mz`, the force in N and the
/// moment in N m on its `marker`, in the axes of the stiffnesses. Of a rotational spring: `closer.angle` from the initial position
/// in rad, whole turns included, and `.moment`, that on its `marker` in N m.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ForceRecordSpec {
    /// Name of the force.
    pub of: String,
    /// Name in results. Default: that of the force.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}

register_spec!(Record, "force", ForceRecordSpec);

struct Force {
    term: usize,
    columns: Vec<Column>,
    name: String,
    of: String,
}

impl Record for Force {
    fn title(&self) -> String {
        format!("Force of {}", self.of)
    }
    fn name(&self) -> String {
        self.name.clone()
    }
    fn columns(&self) -> Vec<Column> {
        self.columns.clone()
    }
    fn needs_strains(&self) -> bool {
        true
    }
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>) {
        if let Some(term) = s.model.terms()[self.term].shows() {
            term.observe(&s.at, out);
        }
    }
}

#[typetag::serde(name = "force")]
impl RecordSpec for ForceRecordSpec {
    fn build(&self, model: &Model) -> Result<Box<dyn Record>, BuildError> {
        let of = self.of.trim();
        let columns = |t: &dyn Term| t.shows().map(|t| t.columns()).unwrap_or_default();
        let shown = || model.terms().iter().enumerate().filter(|(_, t)| !columns(t.as_ref()).is_empty());
        let mut found = shown().filter(|(_, t)| t.label() == of);
        let Some((term, t)) = found.next() else {
            let labels: Vec<String> = shown().map(|(_, t)| t.label()).collect();
            let names = listed(labels.iter().map(String::as_str), "none");
            let message =
                format!("there is no force `{of}` with something to show; those that have it are {names}");
            return Err(BuildError::at("of", message));
        };
        if found.next().is_some() {
            return Err(BuildError::at(
                "of",
                format!("two forces are named `{of}`: give each a name of its own"),
            ));
        }
        let name = named(&self.name, || of.to_string());
        let columns = columns(t.as_ref())
            .into_iter()
            .map(|c| Column::new(format!("{name}.{}", c.name), c.unit))
            .collect();
        Ok(Box::new(Force { term, columns, name, of: of.to_string() }))
    }
}
