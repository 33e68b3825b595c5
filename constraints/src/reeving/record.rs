//! What a record shows of a sheave.

use super::arc::Grip;
use super::sheave::Sheave;
use super::torsion;
use ropewalk_core::{At, BuildError, Column, Model, Record, Sample, Shows, Solid};
use ropewalk_scene::records::named;
use ropewalk_scene::{RecordSpec, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Columns of records of a sheave.
const COLUMNS: [(&str, &str); 7] = [
    ("wrap", "rad"),
    ("length", "m"),
    ("in.tension", "N"),
    ("out.tension", "N"),
    ("speed", "m/s"),
    ("slip", "m/s"),
    ("axle_force", "N"),
];

impl Shows for Sheave {
    fn columns(&self) -> Vec<Column> {
        let prefix = |k: usize| if self.grooves.len() == 1 { String::new() } else { format!("{}.", k + 1) };
        let of = |k: usize| COLUMNS.map(|(name, unit)| Column::new(format!("{}{name}", prefix(k)), unit));
        let mut columns: Vec<Column> = (0..self.grooves.len()).flat_map(of).collect();
        if self.angle.is_some() {
            columns.push(Column::new("angle", "rad"));
            columns.push(Column::new("spin", "rad/s"));
        }
        columns
    }
    fn observe(&self, at: &At<'_>, out: &mut Vec<f64>) {
        for (k, groove) in self.grooves.iter().enumerate() {
            let x = self.instant(k, at);
            let speed = 0.5 * (x.speed[0] + x.speed[1]);
            let slip = match groove.arc.grip {
                Grip::Slides(_) => speed - self.rim(groove, at),
                Grip::Turns(_) => 0.0,
            };
            let aside = self.aside(groove, at, &x);
            let axle = (0..3).map(|i| (x.axle[i] + aside[i]).powi(2)).sum::<f64>().sqrt();
            out.extend([x.wrap, x.length, x.beside[0], x.beside[1], speed, slip, axle]);
        }
        if let Some(angle) = &self.angle {
            out.extend([at.q[angle.place.0], at.v[angle.place.1]]);
        }
    }
    fn solids(&self) -> Vec<Solid> {
        vec![self.solid.clone()]
    }
}

/// The cable on a sheave: columns `wheel.wrap` in rad, `.length`, the unstretched length that lies on it in m,
/// `.in.tension` and `.out.tension` where the cable comes and goes in N, `.speed` along the groove and `.slip` against it in
/// m/s, and `.axle_force` in N. Of a cable with torsion also `.twist` per length in rad/m and `.torque` in N m, and where the flank
/// rolls it (`fleet_twist`) `.in.roll` and `.out.roll`, the torques on it where it comes and goes in N m. Of a wheel
/// with an angle of its own also `.angle` in rad and `.spin` in rad/s. Where several cables run over the wheel, `.1.wrap`,
/// `.2.wrap` and so on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SheaveRecordSpec {
    /// Name of the sheave; of several on one axle `NAME.1`.
    pub of: String,
    /// Name in results. Default: that of the sheave.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}
register_spec!(Record, "sheave", SheaveRecordSpec);

struct SheaveRecord {
    /// The wheel, and the torsion of what lies on it.
    terms: Vec<usize>,
    name: String,
    of: String,
    columns: Vec<Column>,
}

impl Record for SheaveRecord {
    fn title(&self) -> String {
        format!("Sheave {}", self.of)
    }
    fn name(&self) -> String {
        self.name.clone()
    }
    fn columns(&self) -> Vec<Column> {
        self.columns.clone()
    }
    fn needs_forces(&self) -> bool {
        true
    }
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>) {
        for term in self.terms.iter().filter_map(|&k| s.model.terms()[k].shows()) {
            term.observe(&s.at, out);
        }
    }
}

#[typetag::serde(name = "sheave")]
impl RecordSpec for SheaveRecordSpec {
    fn build(&self, model: &Model) -> Result<Box<dyn Record>, BuildError> {
        let of = self.of.trim();
        let is_wheel = |columns: &[Column]| columns.iter().any(|c| c.name.ends_with("axle_force"));
        let all: Vec<(usize, String, Vec<Column>)> = model
            .terms()
            .iter()
            .enumerate()
            .filter_map(|(k, t)| Some((k, t.label(), t.shows()?.columns())))
            .filter(|(.., columns)| is_wheel(columns))
            .collect();
        let Some((term, _, columns)) = all.iter().find(|(_, label, _)| label == of) else {
            let names: Vec<String> = all.iter().map(|(_, label, _)| format!("`{label}`")).collect();
            let names = if names.is_empty() { "none".into() } else { names.join(", ") };
            let message = format!("there is no sheave `{of}`; those of the scene are {names}");
            return Err(BuildError::at("of", message));
        };
        let name = named(&self.name, || of.to_string());
        let torsion = torsion::shown(of);
        let more = model.terms().iter().enumerate().filter(|(_, t)| torsion.contains(&t.label()));
        let (mut terms, mut columns) = (vec![*term], columns.clone());
        for (k, own) in more.filter_map(|(k, t)| Some((k, t.shows()?.columns()))) {
            terms.push(k);
            columns.extend(own);
        }
        let columns = columns.iter().map(|c| Column::new(format!("{name}.{}", c.name), &c.unit)).collect();
        Ok(Box::new(SheaveRecord { terms, name, of: of.to_string(), columns }))
    }
}
