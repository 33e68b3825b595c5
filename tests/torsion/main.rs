//! Cables with torsion against closed forms and geometrically exact rods of independent programs.

mod births;
mod closed;
mod damping;
mod dynamics;
mod feeding;
#[cfg(feature = "contact")]
mod hockle;
mod joints;
mod levers;
mod models;
mod rope;
mod sections;
mod statics;

use ropewalk::{History, Scene, simulate};
use ropewalk_scene::{Format, SceneFile};
use serde_json::Value;

/// A scene of this folder with values of its parameters.
fn scene(text: &str, set: &[String]) -> Scene {
    SceneFile::parse(text, "scene", Format::Toml, set).unwrap_or_else(|e| panic!("{e}")).into_scene()
}

fn run(text: &str, set: &[String]) -> History {
    simulate(&scene(text, set)).unwrap_or_else(|e| panic!("{e}"))
}

/// A case of the reference data.
fn case(name: &str) -> Value {
    let all: Value = serde_json::from_str(include_str!("../data/torsion.json")).expect("torsion.json");
    let found = all["cases"].as_array().expect("cases").iter().find(|c| c["name"] == name);
    found.unwrap_or_else(|| panic!("{name}")).clone()
}

fn number(v: &Value) -> f64 {
    v.as_f64().unwrap_or_else(|| panic!("{v} is no number"))
}

fn three(v: &Value) -> [f64; 3] {
    [0, 1, 2].map(|i| number(&v[i]))
}

fn last(h: &History, name: &str) -> f64 {
    h.last(name).unwrap_or_else(|| panic!("{name}"))
}

fn place(h: &History, of: &str) -> [f64; 3] {
    ["x", "y", "z"].map(|i| last(h, &format!("{of}.{i}")))
}

fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}
