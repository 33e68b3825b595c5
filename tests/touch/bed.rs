//! The sea floor: lines of catenaries that come to lie on it, with the friction that a pull has used up or that the ground takes
//! hold with; heights on a grid; where lines touch down.

use super::friction::near;
use ropewalk::scene::{Format, SceneFile};
use ropewalk::{History, simulate};
use serde_json::Value;
use std::fmt::Write;

fn run(text: &str) -> History {
    let file = SceneFile::parse(text, "bed", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}\n{text}"));
    simulate(&file.into_scene()).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn last(h: &History, name: &str) -> f64 {
    h.last(name).unwrap_or_else(|| panic!("no column {name}"))
}

fn number(v: &Value) -> f64 {
    v.as_f64().expect("number")
}

fn reference(text: &str) -> Vec<Value> {
    let all: Value = serde_json::from_str(text).expect("JSON");
    all["cases"].as_array().expect("cases").clone()
}

const G: f64 = 9.81;
/// Diameter of what lies [m].
const D: f64 = 0.1;

/// A line of sections between its two ends, begun as a straight line, in statics; the bed lies so that its axis does where it sinks in.
fn line(case: &Value, elements: usize, stiffness: f64, equilibrium: &str) -> String {
    let (mut sections, mut loads) = (String::new(), String::new());
    let mut s = 0.0;
    let all = case["sections"].as_array().expect("sections");
    let load = |k: usize| case["load_after_section"].get(k).map_or(0.0, number);
    for (k, q) in all.iter().enumerate() {
        let [length, weight, ea] = ["L", "w", "EA"].map(|f| number(&q[f]));
        // what floats displaces more water than it weighs
        let displaced = if weight < 0.0 { -2.0 * weight / (G * 1000.0) } else { 0.0 };
        let _ = writeln!(
            sections,
            "{{ to = {}, elements = {elements}, hinged = {}, section = {{ mass = {:e}, ea = {ea:e}, diameter = {D}, displaced = {displaced:e} }} }},",
            s + length,
            k > 0 && load(k - 1) != 0.0,
            weight.abs() / G,
        );
        s += length;
        if load(k) != 0.0 {
            let _ = writeln!(loads, "[[forces]]\ntype = \"point_force\"\nmarker = \"line@{s}\"\nforce = [0, 0, {}]", -load(k));
        }
    }
    let slope = number(&case["bed_slope_deg"]).to_radians();
    let sinks = number(&all[0]["w"]) * slope.cos() / (stiffness * D);
    let down = 0.5 * D - sinks;
    let point = [slope.sin() * down, 0.0, -slope.cos() * down];
    let [x, z] = [0, 1].map(|i| number(&case["fairlead"][i]));
    format!(
        r#"
        run = {{ analysis = "statics" }}
        statics = {{ steps = 1 }}
        water = {{ density = 1000 }}
        [[elements]]
        type = "cable"
        name = "line"
        points = [[0, 0, 0], [{x}, 0, {z}]]
        sections = [
        {sections}]
        [[constraints]]
        type = "spherical"
        name = "anchor"
        marker = "line.start"
        [[constraints]]
        type = "spherical"
        name = "fairlead"
        marker = "line.end"
        [[forces]]
        type = "gravity"
        [[forces]]
        type = "buoyancy"
        [[forces]]
        type = "bed"
        point = {point:?}
        slope = {slope}
        stiffness = {stiffness:e}
        friction = {{ mu = {}, equilibrium = "{equilibrium}" }}
        [[records]]
        type = "reaction"
        of = "anchor"
        what = "magnitude"
        [[records]]
        type = "reaction"
        of = "fairlead"
        what = "magnitude"
        [[records]]
        type = "touchdown"
        of = "line"
        on = "bed"
        {loads}"#,
        number(&case["mu"]),
    )
}

#[test]
fn lines_come_to_lie_as_their_catenaries_from_two_end_points() {
    for case in reference(include_str!("../data/sea/catenaries.json")) {
        let result = &case["result"];
        let h = run(&line(&case, 60, 3e8, "pulled"));
        let [fairlead, anchor] = ["fairlead.magnitude", "anchor.magnitude"].map(|n| last(&h, n));
        let grounded = last(&h, "line.touchdown.grounded");
        let right = ["tension_fairlead", "anchor_tension", "grounded_length"].map(|n| number(&result[n]));
        println!(
            "{}: fairlead {fairlead:.0} ({:.1e}), anchor {anchor:.0} (off {:.1e} of the fairlead's), grounded {grounded:.2} instead of {:.2}",
            case["name"],
            fairlead / right[0] - 1.0,
            (anchor - right[1]) / right[0],
            right[2],
        );
        assert!((fairlead / right[0] - 1.0).abs() < 1e-3, "{}", case["name"]);
        assert!((anchor - right[1]).abs() < 5e-3 * right[0], "{}", case["name"]);
    }
}
