//! The force with which a constraint holds.

use super::{listed, named};
use crate::register_spec;
use crate::spec::RecordSpec;
use ropewalk_core::model::marker::frame;
use ropewalk_core::model::twist;
use ropewalk_core::rotation::{cross, times};
use ropewalk_core::{BuildError, Column, Marker, Model, NodeId, Record, RowKind, Sample};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What is recorded of a reaction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ReactionPart {
    /// Everything there is.
    #[default]
    All,
    /// The components of the force [N].
    Force,
    /// The magnitude of the force [N].
    Magnitude,
    /// The components of the moment [N m].
    Moment,
}

/// Force of a constraint on what it holds, its `marker`: columns `anchor.fx`, `.fy`, `.fz` and `.magnitude` in N. Where
/// it holds the direction of a rigid body or of a cable with torsion too, its moment about the marker as well: `.mx`, `.my`, `.mz` in N m.
///
/// A rope that hangs from its anchor is pulled upwards, so `fz` is its weight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ReactionSpec {
    /// Name of the constraint.
    pub of: String,
    /// What is recorded: `all`, `force`, `magnitude` or `moment`.
    #[serde(default)]
    pub what: ReactionPart,
    /// Name in results. Default: that of the constraint and `.reaction`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Title of its plots. Default: the quantity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
}

register_spec!(Record, "reaction", ReactionSpec);

struct Reaction {
    constraint: usize,
    node: NodeId,
    name: String,
    stem: String,
    title: String,
    what: ReactionPart,
    /// The marker on a rigid body, or on a cable with torsion, whose direction is held.
    body: Option<Marker>,
}

impl Record for Reaction {
    fn title(&self) -> String {
        self.title.clone()
    }
    fn name(&self) -> String {
        self.name.clone()
    }
    fn columns(&self) -> Vec<Column> {
        let column = |i: &str, unit| Column::new(format!("{}.{i}", self.stem), unit);
        let force = ["fx", "fy", "fz", "magnitude"].map(|i| column(i, "N")).to_vec();
        let moment = || ["mx", "my", "mz"].map(|i| column(i, "N m")).to_vec();
        match self.what {
            ReactionPart::All if self.body.is_some() => [force, moment()].concat(),
            ReactionPart::All => force,
            ReactionPart::Force => force[..3].to_vec(),
            ReactionPart::Magnitude => force[3..].to_vec(),
            ReactionPart::Moment => moment(),
        }
    }
    fn needs_forces(&self) -> bool {
        true
    }
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>) {
        let force = s.model.reaction(self.constraint, self.node, &s.at, s.lambda);
        let [x, y, z] = [0, 1, 2].map(|i| force.get(i).copied().unwrap_or(0.0));
        let all = [x, y, z, (x * x + y * y + z * z).sqrt()];
        match self.what {
            ReactionPart::All => out.extend(all),
            ReactionPart::Force => out.extend(&all[..3]),
            ReactionPart::Magnitude => out.push(all[3]),
            ReactionPart::Moment => {}
        }
        if !matches!(self.what, ReactionPart::All | ReactionPart::Moment) {
            return;
        }
        if let Some(marker) = &self.body {
            let q = &s.at.q[s.model.node(self.node).coords()];
            let (own, held) = ([q[0], q[1], q[2]], marker.now(s.model.nodes(), &s.at).x);
            let own_axes = [force[3], force[4], force[5]];
            let turning = match force.get(6) {
                Some(spin) => twist::moment(q, &own_axes, *spin),
                None => times(&frame(q), &own_axes),
            };
            let lever = cross(&[held[0] - own[0], held[1] - own[1], held[2] - own[2]], &[x, y, z]);
            out.extend((0..3).map(|i| turning[i] - lever[i]));
        }
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
        if let Some(other) = all[constraint].told_by() {
            let message = format!("`{of}` has no reaction of its own: its force is the {other}");
            return Err(BuildError::at("of", message));
        }
        let held = all[constraint].markers().iter().rev().find_map(|m| m.on().map(|n| (n, *m)));
        let Some((node, marker)) = held else {
            return Err(BuildError::at("of", format!("constraint `{of}` holds nothing that moves")));
        };
        let stem = named(&self.name, || of.to_string());
        let name = named(&self.name, || format!("{of}.reaction"));
        let directed = all[constraint].rows().contains(&RowKind::Direction);
        let body = (directed && model.node(node).kind.turns()).then_some(marker);
        if self.what == ReactionPart::Moment && body.is_none() {
            let message = format!(
                "constraint `{of}` holds no direction of a rigid body or of a cable with torsion: it has no moment"
            );
            return Err(BuildError::at("what", message));
        }
        let title = named(&self.title, || format!("Reaction of {of}"));
        Ok(Box::new(Reaction { constraint, node, name, stem, title, what: self.what, body }))
    }
}
