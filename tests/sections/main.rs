//! Sections along a cable, lumps on it, and stiffness that isn't constant, against closed forms.

mod fed;
mod laws;
mod lumps;
mod splice;
mod statics;

use ropewalk::{History, Scene, simulate};
use ropewalk_scene::{Format, SceneFile};
use serde_json::Value;

/// A scene of this text.
fn scene(text: &str) -> Scene {
    SceneFile::parse(text, "scene", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}")).into_scene()
}

fn run(text: &str) -> History {
    simulate(&scene(text)).unwrap_or_else(|e| panic!("{e}"))
}

fn number(v: &Value) -> f64 {
    v.as_f64().unwrap_or_else(|| panic!("{v} is no number"))
}

fn last(h: &History, name: &str) -> f64 {
    h.last(name).unwrap_or_else(|| panic!("{name}"))
}
