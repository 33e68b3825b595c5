//! Lines of several sections at rest.

use crate::{last, number, run};
use serde_json::Value;
use std::fmt::Write;

/// The cases of `lines.json`: closed forms of lines whose sections are elastic catenaries, one after the other.
pub fn cases() -> Vec<Value> {
    let all: Value = serde_json::from_str(include_str!("../data/lines.json")).expect("lines.json");
    all["cases"].as_array().expect("cases").clone()
}

/// A line of a case, hung up, with records of all that the case knows.
fn hung(case: &Value, per_section: usize) -> String {
    let (mut sections, mut lumps, mut records) = (String::new(), String::new(), String::new());
    let mut s = 0.0;
    for (k, section) in case["sections"].as_array().expect("sections").iter().enumerate() {
        let [length, weight, ea] = [0, 1, 2].map(|i| number(&section[i]));
        s += length;
        let mass = weight / 9.81;
        // a line has a corner where something hangs
        let corner = k > 0 && number(&case["loads"][k - 1]) != 0.0;
        let _ = writeln!(
            sections,
            "  {{ to = {s}, section = {{ mass = {mass:e}, ea = {ea:e} }}, elements = {per_section}, hinged = {corner} }},"
        );
        let load = number(&case["loads"][k]);
        if load != 0.0 {
            let _ = writeln!(
                lumps,
                "[[forces]]\ntype = \"point_force\"\nmarker = \"line@{s}\"\nforce = [0, 0, {}]",
                -load
            );
        }
        let _ = writeln!(records, "[[records]]\ntype = \"position\"\nof = \"line@{s}\"\nname = \"end{k}\"");
    }
    for (k, row) in case["rows"].as_array().expect("rows").iter().enumerate() {
        let s = number(&row[0]);
        let _ = writeln!(records, "[[records]]\ntype = \"position\"\nof = \"line@{s}\"\nname = \"at{k}\"");
        let _ = writeln!(
            records,
            "[[records]]\ntype = \"along\"\nof = \"line\"\nwhat = \"tension\"\nat = {s}\nname = \"t{k}\""
        );
    }
    let [x, z] = [0, 1].map(|i| number(&case["end"][i]));
    format!(
        r#"
        run = {{ analysis = "statics" }}
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
        [[records]]
        type = "reaction"
        of = "anchor"
        [[records]]
        type = "reaction"
        of = "fairlead"
        {lumps}{records}"#
    )
}

#[test]
fn lines_of_several_sections_hang_as_the_closed_form() {
    for case in cases() {
        let length: f64 = case["sections"].as_array().expect("sections").iter().map(|s| number(&s[0])).sum();
        for (n, limit) in [(20, 1e-5), (80, 2e-8)] {
            let h = run(&hung(&case, n));
            let (t0, t1) = (number(&case["T0"]), number(&case["T1"]));
            let pull = [last(&h, "anchor.magnitude") / t0 - 1.0, last(&h, "fairlead.magnitude") / t1 - 1.0];
            let (mut shape, mut tension) = (0.0f64, 0.0f64);
            for (k, row) in case["rows"].as_array().expect("rows").iter().enumerate() {
                let [_, x, z, t] = [0, 1, 2, 3].map(|i| number(&row[i]));
                let off =
                    (last(&h, &format!("at{k}.x")) - x).hypot(last(&h, &format!("at{k}.z")) - z) / length;
                shape = shape.max(off);
                tension = tension.max((last(&h, &format!("t{k}")) / t - 1.0).abs());
            }
            println!(
                "{} n {n}: shape {shape:.1e}, pull {:.1e} {:.1e}, tension {tension:.1e}",
                case["name"], pull[0], pull[1]
            );
            assert!(shape < limit && pull.iter().all(|p| p.abs() < limit), "{}", case["name"]);
        }
    }
}
