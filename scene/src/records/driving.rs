//! How well a driven marker follows the motion that is imposed on it.

use super::place::{SpaceAxis, all_axes, check_axes};
use super::{listed, named};
use crate::register_spec;
use crate::spec::RecordSpec;
use ropewalk_core::{BuildError, Column, Marker, Model, Record, Sample};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A driving constraint compared with its motion: columns `ship.imposed_x` and `ship.actual_x` in m, the same of
/// velocities, `ship.imposed_vx` and `ship.actual_vx` in m/s, and `ship.difference`, the distance between where the
/// marker is and where it should be, in m.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DrivingCheckSpec {
    /// Name of the driving constraint.
    pub of: String,
    /// Recorded axes of space. Default: all three.
    #[serde(default = "all_axes")]
    pub axes: Vec<SpaceAxis>,
    /// Name in results. Default: that of the constraint and `.check`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Title of its plots. Default: the quantity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
}
register_spec!(Record, "driving_check", DrivingCheckSpec);

struct Check {
    constraint: usize,
    markers: [Marker; 2],
    axes: Vec<SpaceAxis>,
    name: String,
    stem: String,
    title: String,
}

impl Record for Check {
    fn title(&self) -> String {
        self.title.clone()
    }
    fn name(&self) -> String {
        self.name.clone()
    }
    fn columns(&self) -> Vec<Column> {
        let mut columns = Vec::new();
        let mut add = |name: &str, unit| columns.push(Column::new(format!("{}.{name}", self.stem), unit));
        for (prefix, unit) in [("", "m"), ("v", "m/s")] {
            for axis in &self.axes {
                let letter = axis.letter();
                add(&format!("imposed_{prefix}{letter}"), unit);
                add(&format!("actual_{prefix}{letter}"), unit);
            }
        }
        add("difference", "m");
        columns
    }
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>) {
        let [from, held] = self.markers.map(|m| m.now(s.model.nodes(), &s.at).x);
        let [v_from, v_held] = self.markers.map(|m| m.velocity(s.model.nodes(), &s.at));
        let moving =
            s.model.constraints()[self.constraint].imposes().map(|m| m.at(s.at.t)).unwrap_or_default();
        for &axis in &self.axes {
            let i = axis as usize;
            out.extend([from[i] + moving.x[i], held[i]]);
        }
        for &axis in &self.axes {
            let i = axis as usize;
            out.extend([v_from[i] + moving.v[i], v_held[i]]);
        }
        out.push((0..3).map(|i| (held[i] - from[i] - moving.x[i]).powi(2)).sum::<f64>().sqrt());
    }
}

#[typetag::serde(name = "driving_check")]
impl RecordSpec for DrivingCheckSpec {
    fn build(&self, model: &Model) -> Result<Box<dyn Record>, BuildError> {
        let of = self.of.trim();
        let driven = |c: &dyn ropewalk_core::Constraint| c.imposes().is_some() && c.markers().len() == 2;
        let constraints = model.constraints();
        let found = constraints.iter().position(|c| c.name() == of && driven(c.as_ref()));
        let Some(constraint) = found else {
            let names = listed(
                constraints.iter().filter(|c| driven(c.as_ref())).map(|c| c.name()),
                "none: add one of `type = \"driving\"`",
            );
            let message = format!("there is no driving constraint `{of}`; the driving ones are {names}");
            return Err(BuildError::at("of", message));
        };
        check_axes(&self.axes)?;
        let held = constraints[constraint].markers();
        let name = named(&self.name, || format!("{of}.check"));
        let title = named(&self.title, || format!("Driving constraint {of} against the imposed motion"));
        Ok(Box::new(Check {
            constraint,
            markers: [held[0], held[1]],
            axes: self.axes.clone(),
            stem: named(&self.name, || of.to_string()),
            name,
            title,
        }))
    }
}
