//! The force with which a constraint holds.

use super::{listed, named};
use crate::build::BuildError;
use crate::marker::Marker;
use crate::model::Model;
use crate::node::NodeId;
use crate::record::{Column, Record, Sample};
use crate::register_spec;
use crate::spec::RecordSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Force of a constraint on the first of its markers that can move: columns `anchor.fx`, `.fy`, `.fz` and
/// `.magnitude` in N.
///
/// A rope that hangs from its anchor is pulled upwards, so `fz` is its weight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ReactionSpec {
    /// Name of the constraint.
    pub of: String,
    /// Name in results; left out, that of the constraint and `.reaction`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}

register_spec!(Record, "reaction", ReactionSpec);

struct Reaction {
    constraint: usize,
    node: NodeId,
    name: String,
    stem: String,
    of: String,
}

impl Record for Reaction {
    fn title(&self) -> String {
        format!("Reaction of {}", self.of)
    }
    fn name(&self) -> String {
        self.name.clone()
    }
    fn columns(&self) -> Vec<Column> {
        ["fx", "fy", "fz", "magnitude"].map(|i| Column::new(format!("{}.{i}", self.stem), "N")).to_vec()
    }
    fn needs_forces(&self) -> bool {
        true
    }
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>) {
        let force = s.model.reaction(self.constraint, self.node, &s.at, s.lambda);
        let [x, y, z] = [0, 1, 2].map(|i| force.get(i).copied().unwrap_or(0.0));
        out.extend([x, y, z, (x * x + y * y + z * z).sqrt()]);
    }
}

#[typetag::serde(name = "reaction")]
impl RecordSpec for ReactionSpec {
    fn build(&self, model: &Model) -> Result<Box<dyn Record>, BuildError> {
        let of = self.of.trim();
        let all = model.constraints();
        let Some(constraint) = all.iter().position(|c| c.name() == of) else {
            let names = listed(all.iter().map(|c| c.name()), "none");
            let message = format!("there is no constraint `{of}`; the constraints are {names}");
            return Err(BuildError::at("of", message));
        };
        let Some(node) = all[constraint].markers().iter().find_map(Marker::on) else {
            return Err(BuildError::at("of", format!("constraint `{of}` holds nothing that moves")));
        };
        let stem = named(&self.name, || of.to_string());
        let name = named(&self.name, || format!("{of}.reaction"));
        Ok(Box::new(Reaction { constraint, node, name, stem, of: of.to_string() }))
    }
}
