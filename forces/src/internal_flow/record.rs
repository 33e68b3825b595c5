//! The tension of the wall and the pressure inside, along a hose.

use super::pressure::{PRESSURE, WALL};
use ropewalk_core::{At, BuildError, Column, Model, Part, Quantity, Record, Sample, Term};
use ropewalk_scene::records::{RecordPlace, check_places, named, part};
use ropewalk_scene::{RecordSpec, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

fn ends() -> Vec<RecordPlace> {
    [0.0, 0.5, 1.0].map(RecordPlace::Share).to_vec()
}

/// What the wall of a hose with an `internal_flow` carries, and the pressure in it: columns
/// `hose.wall_tension@50%` in N and `hose.pressure@50%` in Pa.
///
/// The tension of a cable is the effective one; that of the wall is larger by inner pressure times the bore's area, less
/// outer pressure times the outer one. Pressures are those above the air's. They come from the outlet, with the fluid's weight,
/// acceleration and friction; water presses from outside where it has a `level`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WallTensionSpec {
    /// The cable.
    pub of: String,
    /// Where: as for `along`. Default: at both ends and in the middle.
    #[serde(default = "ends")]
    pub at: Vec<RecordPlace>,
    /// Name in results. Default: that of the cable.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Title of its plots. Default: the quantity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
}
register_spec!(Record, "wall_tension", WallTensionSpec);

struct WallTension {
    part: Arc<dyn Part>,
    /// The flow.
    term: usize,
    at: Vec<RecordPlace>,
    name: String,
    title: String,
}

fn local(term: &dyn Term, quantity: &str, part: &str, s: f64, at: &At<'_>) -> Option<f64> {
    term.shows()?.local(quantity, part, s, at)
}

impl Record for WallTension {
    fn title(&self) -> String {
        self.title.clone()
    }
    fn name(&self) -> String {
        self.name.clone()
    }
    fn columns(&self) -> Vec<Column> {
        let of = |what: &str, unit: &str| {
            let column = |at: &RecordPlace| Column::new(format!("{}.{what}{at}", self.name), unit);
            self.at.iter().map(column).collect::<Vec<_>>()
        };
        [of("wall_tension", "N"), of("pressure", "Pa")].concat()
    }
    fn needs_forces(&self) -> bool {
        true
    }
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>) {
        let term = s.model.terms()[self.term].as_ref();
        let part = self.part.as_ref();
        let places = || self.at.iter().map(|place| place.now(part, &s.at));
        let what =
            |quantity: &str, at: f64| local(term, quantity, part.name(), at, &s.at).unwrap_or(f64::NAN);
        out.extend(places().map(|at| {
            let effective = part.observe(Quantity::Tension, at, &s.at).unwrap_or(f64::NAN);
            effective + what(WALL, at)
        }));
        out.extend(places().map(|at| what(PRESSURE, at)));
    }
}

#[typetag::serde(name = "wall_tension")]
impl RecordSpec for WallTensionSpec {
    fn build(&self, model: &Model) -> Result<Box<dyn Record>, BuildError> {
        let part = part(model, self.of.trim())?;
        let state = model.state();
        let knows = |t: &dyn Term| local(t, PRESSURE, part.name(), 0.0, &state.at()).is_some();
        let term = model.terms().iter().position(|t| knows(t.as_ref())).ok_or_else(|| {
            let message =
                format!("nothing flows through `{}`: add a force of type `internal_flow`", part.name());
            BuildError::at("of", message)
        })?;
        check_places(part.as_ref(), &self.at)?;
        let name = named(&self.name, || part.name().to_string());
        let title = named(&self.title, || format!("Wall of {}", part.name()));
        Ok(Box::new(WallTension { part, term, at: self.at.clone(), name, title }))
    }
}
