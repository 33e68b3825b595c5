//! The scene reader as a whole: what is accepted, and what is said about everything else.

mod documents;
mod hostile;
mod messages;
mod migrate;
mod parameters;

use super::{Document, Fault, Format, Span};
use ropewalk_quantity as quantity;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

#[typetag::serde]
trait Part: std::fmt::Debug {}

#[typetag::serde]
trait Motion: std::fmt::Debug {}

#[derive(Debug, Serialize, Deserialize)]
struct Section {
    #[serde(deserialize_with = "quantity::axial_stiffness")]
    ea: f64,
    #[serde(deserialize_with = "quantity::bending_stiffness")]
    ei: f64,
    #[serde(default)]
    shape: Shape,
}

#[derive(Debug, Default, Serialize, Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
enum Shape {
    #[default]
    Solid,
    Tube {
        bore: f64,
    },
    Power(f64),
}

#[derive(Debug, Serialize, Deserialize)]
struct Cable {
    name: String,
    #[serde(deserialize_with = "quantity::vec3::length")]
    from: [f64; 3],
    section: Section,
    #[serde(default)]
    elements: Option<u32>,
    #[serde(default)]
    motion: Option<Box<dyn Motion>>,
    #[serde(default)]
    tags: HashMap<String, f64>,
}
#[typetag::serde(name = "cable")]
impl Part for Cable {}

#[derive(Debug, Serialize, Deserialize)]
struct Weight {
    #[serde(deserialize_with = "positive")]
    mass: f64,
}
#[typetag::serde(name = "weight")]
impl Part for Weight {}

#[derive(Debug, Serialize, Deserialize)]
struct Gravity;
#[typetag::serde(name = "gravity")]
impl Part for Gravity {}

fn positive<'de, D: serde::Deserializer<'de>>(d: D) -> Result<f64, D::Error> {
    let mass = quantity::mass(d)?;
    if mass > 0.0 { Ok(mass) } else { Err(serde::de::Error::custom("a mass has to be positive")) }
}

#[derive(Debug, Serialize, Deserialize)]
struct Sine {
    #[serde(deserialize_with = "quantity::length")]
    amplitude: f64,
}
#[typetag::serde(name = "sine")]
impl Motion for Sine {}

#[derive(Debug, Serialize, Deserialize)]
struct Ramp {
    #[serde(deserialize_with = "quantity::list::time")]
    times: Vec<f64>,
}
#[typetag::serde(name = "ramp")]
impl Motion for Ramp {}

#[derive(Debug, Serialize, Deserialize)]
struct Solver {
    #[serde(deserialize_with = "quantity::time")]
    step: f64,
    #[serde(default)]
    quiet: bool,
}

/// A scene in which everything is right.
const GOOD: &str = r#"title = "tow"

[parameters]
speed = { default = "25 kn", description = "towing speed" }
ends = ["0 m", "$depth", 2]
depth = "30 m"

[solver]
step = "20 ms"

[[elements]]
type = "cable"
name = "line"
from = [0.0, "20 cm", 0]

[elements.section]
ea = "1.2 MN"
ei = 0.01

[[elements]]
type = "cable"
name = "second"
from = "$ends"
elements = 20
motion = { type = "sine", amplitude = "$depth" }
section = { ea = 1e4, ei = "2 N m^2", shape = { type = "tube", bore = 0.01 } }
tags = { a = 1, "b c" = 2.5 }

[[elements]]
type = "weight"
mass = "2 t"
"#;

#[derive(Debug)]
struct Scene {
    elements: Vec<(Box<dyn Part>, Span)>,
    solver: Option<Solver>,
}

fn scene(document: &mut Document) -> Result<Scene, Fault> {
    let elements = document.take_list("elements")?;
    let solver = document.take("solver")?;
    let _: Option<String> = document.take("title")?;
    document.finish()?;
    Ok(Scene { elements, solver })
}

fn toml(text: &str) -> Result<Scene, Fault> {
    scene(&mut Document::parse(text, "scene.toml", Format::Toml, &[])?)
}

fn json(text: &str) -> Result<Scene, Fault> {
    scene(&mut Document::parse(text, "scene.json", Format::Json, &[])?)
}

/// The fault of a good scene in which one text is replaced by another.
fn spoilt(good: &str, bad: &str) -> Fault {
    assert!(GOOD.contains(good), "{good}");
    toml(&GOOD.replacen(good, bad, 1)).expect_err(bad)
}
