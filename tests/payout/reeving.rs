//! Cables that run over sheaves and through rings, with the settings that scenes have by default, against the references of
//! `tests/data/reeving`: closed forms, root finding, and a chain of 1600 masses with contact.

use crate::common::{data, number};
use ropewalk::{Format, History, SceneFile, simulate};
use ropewalk_scene::Scene;

fn read(text: &str) -> Scene {
    SceneFile::parse(text, "scene", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}")).into_scene()
}

fn run(text: &str) -> History {
    simulate(&read(text)).unwrap_or_else(|e| panic!("{e}"))
}

fn refused(text: &str) -> String {
    SceneFile::parse(text, "scene", Format::Toml, &[])
        .map_err(|e| e.to_string())
        .and_then(|file| file.into_scene().build().map(drop).map_err(|e| e.to_string()))
        .expect_err("it builds")
}

fn at(history: &History, column: &str, t: f64) -> f64 {
    let k = history.times().iter().position(|x| (x - t).abs() < 1e-6).unwrap_or_else(|| panic!("no {t} s"));
    history.column(column).unwrap_or_else(|| panic!("no {column}"))[k]
}

/// The reference of this name, and its values.
fn reference(name: &str) -> serde_json::Value {
    data(&format!("reeving/{name}.json"))["reference"].clone()
}

fn values(of: &serde_json::Value) -> Vec<f64> {
    of.as_array().expect("a list").iter().map(number).collect()
}

const GRAVITY: &str = "[[forces]]\ntype = \"gravity\"\n";

/// A rope of 4 m and 1 kg/m over a wheel of 10 cm, its right end this much deeper than the left.
fn over(wheel: &str, deeper: f64, masses: [f64; 2], more: &str) -> String {
    let half = (4.0 - 0.1 * std::f64::consts::PI) / 2.0;
    let (left, right) = (half - deeper / 2.0, half + deeper / 2.0);
    let mass = |name: &str, end: &str, mass: f64| {
        if mass == 0.0 {
            return String::new();
        }
        format!("[[elements]]\ntype = \"point_mass\"\nname = \"{name}\"\nmarker = \"rope.{end}\"\nmass = {mass}\n")
    };
    format!(
        r#"
        [[elements]]
        type = "cable"
        name = "rope"
        section = {{ mass = 1, ea = "1 MN" }}
        length = 4
        route = [{{ end = [-0.1, 0, -{left}] }}, {{ over = "wheel" }}, {{ end = [0.1, 0, -{right}] }}]
        {more}
        {}{}
        [[constraints]]
        type = "sheave"
        name = "wheel"
        marker = [0, 0, 0]
        axis = [0, 1, 0]
        radius = 0.1
        {wheel}
        {GRAVITY}
        [[records]]
        type = "position"
        of = "rope.end"
        [[records]]
        type = "sheave"
        of = "wheel"
        [[records]]
        type = "energy"
        "#,
        mass("left", "start", masses[0]),
        mass("right", "end", masses[1])
    )
}

#[test]
fn a_wheel_that_grips_turns_with_its_rope() {
    let exact = reference("atwood_wheel");
    for grip in ["inertia = 0.05", "inertia = 0.05\nfriction = 0.5"] {
        let scene = over(grip, 0.1, [3.0, 4.0], "elements = 1");
        let history = run(&format!("run = {{ duration = 0.8, output = 0.1 }}\n{scene}"));
        let start = at(&history, "rope.end.z", 0.0);
        for (k, t) in values(&exact["t"]).into_iter().enumerate() {
            let fallen = start - at(&history, "rope.end.z", t);
            let off = fallen - number(&exact["displacement"][k]);
            assert!(off.abs() < 3e-4, "{grip}: {off} m at {t} s");
            if grip.contains("friction") {
                let off = at(&history, "wheel.angle", t) - number(&exact["wheel_angle"][k]);
                assert!(off.abs() < 3e-3, "{off} rad at {t} s");
            }
        }
    }
}
