//! The drag coefficient along a cable.

use crate::drag::COEFFICIENT;
use ropewalk_core::{At, BuildError, Column, Model, Part, Record, Sample, Term};
use ropewalk_scene::records::{RecordPlace, check_places, named, part};
use ropewalk_scene::{RecordSpec, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

fn quarters() -> Vec<RecordPlace> {
    [0.25, 0.5, 0.75].map(RecordPlace::Share).to_vec()
}

/// Drag coefficient `Cn` of the flow across a cable at some places: columns `hose.cn@25%`, `hose.cn@50%`, `hose.cn@75%`.
///
/// It is that of the `drag` which acts on the cable, taken between its stations on either side of the place; empty where
/// hardly any water flows across, at Reynolds numbers below 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DragCoefficientSpec {
    /// The cable.
    pub of: String,
    /// Where: as for `along`. Default: at a quarter, half and three quarters of the length.
    #[serde(default = "quarters")]
    pub at: Vec<RecordPlace>,
    /// Name in results. Default: that of the cable and `.cn`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Title of its plots. Default: the quantity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
}
register_spec!(Record, "drag_coefficient", DragCoefficientSpec);

impl DragCoefficientSpec {
    /// The coefficient at the quarters of a cable, under its own name.
    pub fn new(of: &str) -> Self {
        DragCoefficientSpec { of: of.into(), at: quarters(), name: None, title: None }
    }
}

struct DragCoefficient {
    part: Arc<dyn Part>,
    /// The term that knows it.
    term: usize,
    at: Vec<RecordPlace>,
    name: String,
    title: String,
}

impl Record for DragCoefficient {
    fn title(&self) -> String {
        self.title.clone()
    }
    fn name(&self) -> String {
        self.name.clone()
    }
    fn columns(&self) -> Vec<Column> {
        self.at.iter().map(|at| Column::new(format!("{}{at}", self.name), "1")).collect()
    }
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>) {
        let term = &s.model.terms()[self.term];
        out.extend(self.at.iter().map(|place| {
            // stations count along the material, which runs through a start that feeds
            let start = self.part.boundary(0).map_or(0.0, |boundary| s.at.q[boundary.q]);
            let along = start + place.now(self.part.as_ref(), &s.at);
            let cn = coefficient(term.as_ref(), self.part.name(), along, &s.at);
            cn.filter(|cn| cn.is_finite()).unwrap_or(f64::NAN)
        }));
    }
}

fn coefficient(term: &dyn Term, part: &str, s: f64, at: &At<'_>) -> Option<f64> {
    term.shows()?.local(COEFFICIENT, part, s, at)
}

#[typetag::serde(name = "drag_coefficient")]
impl RecordSpec for DragCoefficientSpec {
    fn build(&self, model: &Model) -> Result<Box<dyn Record>, BuildError> {
        let part = part(model, self.of.trim())?;
        let state = model.state();
        let at = state.at();
        let knows = |t: &dyn Term| coefficient(t, part.name(), 0.0, &at).is_some();
        let term = model.terms().iter().position(|t| knows(t.as_ref())).ok_or_else(|| {
            BuildError::at("of", format!("no drag acts on `{}`: add a force of type `drag`", part.name()))
        })?;
        check_places(part.as_ref(), &self.at)?;
        let name = named(&self.name, || format!("{}.cn", part.name()));
        let title = named(&self.title, || format!("Drag coefficient across {}", part.name()));
        Ok(Box::new(DragCoefficient { part, term, at: self.at.clone(), name, title }))
    }
}
