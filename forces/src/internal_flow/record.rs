//! The tension of the wall and the pressure inside, along a hose.

use crate::wall::Wall;
use ropewalk_core::{BuildError, Column, Model, Record, Sample};
use ropewalk_scene::records::{RecordPlace, check_places, named, part};
use ropewalk_scene::{RecordSpec, register_spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

fn ends() -> Vec<RecordPlace> {
    [0.0, 0.5, 1.0].map(RecordPlace::Share).to_vec()
}

/// What the wall of a cable carries: columns `hose.wall_tension@50%` in N, and `hose.pressure@50%` in Pa if there is an
/// `internal_flow`.
///
/// The tension of a cable is the effective one; that of the wall is larger by inner pressure times the bore's area, less
/// outer pressure times the outer one. Pressures are those above the air's. Inner ones come from the outlet, with the fluid's weight,
/// acceleration and friction; water with a `level` presses from outside by its depth at rest, where `buoyancy` acts on the cable.
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
    wall: Wall,
    at: Vec<RecordPlace>,
    name: String,
    title: String,
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
        let pressure = if self.wall.flows() { of("pressure", "Pa") } else { Vec::new() };
        [of("wall_tension", "N"), pressure].concat()
    }
    fn needs_forces(&self) -> bool {
        true
    }
    fn sample(&self, s: &Sample<'_>, out: &mut Vec<f64>) {
        let places = || self.at.iter().map(|place| place.now(self.wall.part.as_ref(), &s.at));
        out.extend(places().map(|at| self.wall.tension(at, s.model, &s.at)));
        if self.wall.flows() {
            out.extend(places().map(|at| self.wall.pressure(at, s.model, &s.at)));
        }
    }
}

#[typetag::serde(name = "wall_tension")]
impl RecordSpec for WallTensionSpec {
    fn build(&self, model: &Model) -> Result<Box<dyn Record>, BuildError> {
        let part = part(model, self.of.trim())?;
        let wall = Wall::new(model, part.clone());
        if wall.is_bare() {
            let message = format!(
                "nothing presses on the wall of `{}`: add a force of type `internal_flow`, or of type `buoyancy` in water with a `level`",
                part.name()
            );
            return Err(BuildError::at("of", message));
        }
        check_places(part.as_ref(), &self.at)?;
        let name = named(&self.name, || part.name().to_string());
        let title = named(&self.title, || format!("Wall of {}", part.name()));
        Ok(Box::new(WallTension { wall, at: self.at.clone(), name, title }))
    }
}
