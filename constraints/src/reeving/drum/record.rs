//! What a record shows of a drum.

use super::shaft::COLUMNS;
use ropewalk_core::{BuildError, Column, Model, Record, Sample};
use ropewalk_scene::records::named;
use ropewalk_scene::{RecordSpec, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A drum and the cable on it: columns `drum.angle` in rad and `.spin` in rad/s, positive where it pays out; `.payout`, the
/// length fed out, and `.wound`, that on the drum, in m of unstretched cable; `.layer` and `.radius` where the cable arrives;
/// `.fleet`, its angle against the plane of the drum there, in rad; `.torque`, the moment of the cable about the axis in
/// N m, positive where it would pay out. `.wound` counts from 0 if the drum has no `wound`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DrumRecordSpec {
    /// Name of the drum.
    pub of: String,
    /// Name in results. Default: that of the drum.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}
register_spec!(Record, "drum", DrumRecordSpec);

struct DrumRecord {
    term: usize,
    /// First multiplier of its equations.
    row: usize,
    name: String,
    of: String,
}

/// The last columns of a drum, which only the moment needs.
const SHOWN: usize = COLUMNS.len() - 2;

impl Record for DrumRecord {
    fn title(&self) -> String {
        format!("Drum {}", self.of)
    }
    fn name(&self) -> String {
        self.name.clone()
    }
    fn columns(&self) -> Vec<Column> {
        let all = COLUMNS[..SHOWN].iter().copied().chain([("torque", "N m")]);
        all.map(|(what, unit)| Column::new(format!("{}.{what}", self.name), unit)).collect()
    }
    fn needs_forces(&self) -> bool {
        true
    }
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>) {
        let Some(term) = s.model.terms()[self.term].shows() else { return };
        let first = out.len();
        term.observe(&s.at, out);
        let [radius, travel, climb] = [5, SHOWN, SHOWN + 1].map(|k| out[first + k]);
        let pull = &s.lambda[self.row..self.row + 4];
        out.truncate(first + SHOWN);
        // all equations in which the angle is: by virtual work
        out.push(pull[3] * radius - pull[0] * travel - pull[1] * climb);
    }
}

#[typetag::serde(name = "drum")]
impl RecordSpec for DrumRecordSpec {
    fn build(&self, model: &Model) -> Result<Box<dyn Record>, BuildError> {
        let of = self.of.trim();
        let is_drum = |columns: &[Column]| columns.iter().any(|c| c.name == "fleet");
        let all: Vec<(usize, String)> = model
            .terms()
            .iter()
            .enumerate()
            .filter(|(_, t)| t.shows().is_some_and(|s| is_drum(&s.columns())))
            .map(|(k, t)| (k, t.label()))
            .collect();
        let constraints = model.constraints();
        let row = constraints.iter().position(|c| c.name() == super::spec::rope(of));
        let (Some((term, _)), Some(row)) = (all.iter().find(|(_, label)| label == of), row) else {
            let names: Vec<String> = all.iter().map(|(_, label)| format!("`{label}`")).collect();
            let names = if names.is_empty() { "none".into() } else { names.join(", ") };
            let message = format!("there is no drum `{of}`; those of the scene are {names}");
            return Err(BuildError::at("of", message));
        };
        let row = model.rows_of(row).start;
        Ok(Box::new(DrumRecord { term: *term, row, name: named(&self.name, || of.into()), of: of.into() }))
    }
}
