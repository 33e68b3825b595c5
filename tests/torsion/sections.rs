//! Torsion of cables of several sections.

use super::{apart, last, place, run, scene};
use ropewalk::{ModesOptions, modes};
use ropewalk_scene::{Format, SceneFile};

const TWO: &str = "[{ to = 1.6, section = { mass = 1, ea = 1e4, ei = 1, gj = 0.8, rotary_inertia = 0.02 } }, \
                   { section = { mass = 2, ea = 3e4, ei = 2, gj = 0.3, rotary_inertia = 0.05 } }]";

/// A cable along x, 2.6 m long, clamped at its start; what acts on it. Whether it is stable under a torque that follows it
/// takes long to find out and isn't asked here.
fn cable(sections: &str, elements: usize, more: &str) -> String {
    format!(
        r#"
        [run]
        analysis = "statics"
        [statics]
        stable = false
        [[elements]]
        type = "cable"
        name = "rod"
        points = [[0, 0, 0], [2.6, 0, 0]]
        elements = {elements}
        sections = {sections}
        [[constraints]]
        type = "clamp"
        name = "root"
        marker = "rod.start"
        {more}
        [[records]]
        type = "position"
        of = "rod.end"
        [[records]]
        type = "along"
        of = "rod"
        what = "angle"
        at = "end"
        [[records]]
        type = "along"
        of = "rod"
        what = "angle"
        at = 1.6
        [[records]]
        type = "along"
        of = "rod"
        what = "torque"
        at = "start"
        "#
    )
}

const TORQUE: &str = r#"
    [[forces]]
    type = "point_moment"
    marker = "rod.end"
    torque = 0.5
    time = { table = { t = [0, 1], value = [0, 1] } }
"#;

#[test]
fn sections_twist_by_what_each_resists() {
    // with a splice between them, and where they share a node
    for sections in [TWO.to_string(), TWO.replace("3e4", "1e4")] {
        let h = run(&cable(&sections, 13, TORQUE), &[]);
        let [middle, end] = [0.5 * 1.6 / 0.8, 0.5 * (1.6 / 0.8 + 1.0 / 0.3)];
        assert!((last(&h, "rod.end.angle") - end).abs() < 1e-9, "{}", last(&h, "rod.end.angle"));
        assert!((last(&h, "rod@1.6m.angle") - middle).abs() < 1e-9);
        assert!((last(&h, "rod.start.torque") - 0.5).abs() < 1e-9);
    }
}

#[test]
fn a_section_that_changes_linearly_twists_by_the_integral() {
    let sections = "[{ section = { mass = 1, ea = 1e4, ei = 1, gj = 0.8 }, end_section = { mass = 1, ea = 1e4, ei = 2, gj = 2.4 } }]";
    let h = run(&cable(sections, 4, TORQUE), &[]);
    let exact = 0.5 * 2.6 * 3.0_f64.ln() / 1.6;
    assert!((last(&h, "rod.end.angle") - exact).abs() < 1e-9, "{} {exact}", last(&h, "rod.end.angle"));
}

/// A splice holds as a weld between two cables does, bent and twisted in space: of round bars, of bars that bend with a
/// direction, of ropes that turn when they are pulled, of what is bent when free of stress.
#[test]
fn a_splice_is_a_weld() {
    let round = [1.0, 2.0].map(|ei| format!("ei = {ei}"));
    let flat = ["ei = [1, 3]", "ei = [2, 0.7]"].map(String::from);
    let ropes = ["ei = 1, torque_tension = 8", "ei = 2, torque_tension = -5"].map(String::from);
    let upright = "normal = [0, 0.6, 0.8]";
    let bent = format!("curvature = 0.3\n{upright}");
    for (sections, more) in [
        (round.clone(), ""),
        (flat.clone(), upright),
        (ropes.clone(), ""),
        ([flat[0].clone(), ropes[1].clone()], upright),
        ([ropes[0].clone(), flat[1].clone()], upright),
        (round, &bent),
        (flat, &bent),
    ] {
        // with a splice, and where both stretch alike, which may share a node
        for ea in ["3e4", "1e4"] {
            weld(&sections, more, ea);
        }
    }
}

fn weld([a, b]: &[String; 2], more: &str, ea: &str) {
    let loads = r#"
        [[forces]]
        type = "point_force"
        marker = "END"
        force = [0.5, 0.8, 1.1]
        time = { table = { t = [0, 1], value = [0, 1] } }
        [[forces]]
        type = "point_moment"
        marker = "END"
        moment = [0.6, -0.7, 0.4]
        time = { table = { t = [0, 1], value = [0, 1] } }
    "#;
    let [one, other] = [
        format!("{{ mass = 1, ea = 1e4, {a}, gj = 0.8, rotary_inertia = 0.02 }}"),
        format!("{{ mass = 2, ea = {ea}, {b}, gj = 0.3, rotary_inertia = 0.05 }}"),
    ];
    let sections = format!("[{{ to = 1.6, section = {one} }}, {{ section = {other} }}]\n{more}");
    let whole = run(&cable(&sections, 13, &loads.replace("END", "rod.end")), &[]);
    let two = format!(
        r#"
        [run]
        analysis = "statics"
        [statics]
        stable = false
        [[elements]]
        type = "cable"
        name = "rod"
        points = [[0, 0, 0], [1.6, 0, 0]]
        elements = 8
        section = {one}
        {more}
        [[elements]]
        type = "cable"
        name = "on"
        points = [[1.6, 0, 0], [2.6, 0, 0]]
        elements = 5
        section = {other}
        {more}
        [[constraints]]
        type = "clamp"
        name = "root"
        marker = "rod.start"
        [[constraints]]
        type = "weld"
        name = "joint"
        marker = "on.start"
        to = "rod.end"
        {}
        [[records]]
        type = "position"
        of = "on.end"
        [[records]]
        type = "along"
        of = "rod"
        what = "torque"
        at = "start"
        "#,
        loads.replace("END", "on.end")
    );
    let two = run(&two, &[]);
    let off = apart(place(&whole, "rod.end"), place(&two, "on.end"));
    let torque = last(&whole, "rod.start.torque") - last(&two, "rod.start.torque");
    println!("{a}, {b}, {more}, {ea}: {off:e} m, {torque:e} N m");
    assert!(off <= SAME && torque.abs() <= SAME, "{a}, {b}, {more}, {ea}: {off} m, {torque} N m");
}

/// What Newton's method leaves.
const SAME: f64 = 1e-9;

/// A stepped bar turns to and fro at the frequencies of `GJ₁ k₁ cot k₁ l₁ = GJ₂ k₂ tan k₂ l₂`.
#[test]
fn a_stepped_bar_has_its_frequencies() {
    let [a, b]: [f64; 2] = [0.02 / 0.8, 0.05 / 0.3];
    let f = |omega: f64| {
        let (k1, k2) = (omega * a.sqrt(), omega * b.sqrt());
        0.8 * k1 * (1.6 * k1).cos() * k2.cos() - 0.3 * k2 * k2.sin() * (1.6 * k1).sin()
    };
    let (mut low, mut high) = (0.5, 4.0);
    assert!(f(low) > 0.0 && f(high) < 0.0);
    while high - low > 1e-12 {
        let middle = 0.5 * (low + high);
        if f(middle) > 0.0 { low = middle } else { high = middle }
    }
    let mut errors = Vec::new();
    for n in [13, 26] {
        let options = ModesOptions { count: 40, ..ModesOptions::default() };
        let found = modes(&scene(&cable(TWO, n, ""), &[]), &options).unwrap_or_else(|e| panic!("{e}"));
        let turns = found.modes.iter().filter(|m| m.directions[3] > 0.99);
        errors.push(turns.map(|m| (m.omega / low - 1.0).abs()).fold(f64::INFINITY, f64::min));
    }
    println!("{low}: {errors:?}");
    assert!(errors[1] < 2e-4 && errors[0] / errors[1] > 3.5, "{errors:?}");
}

#[test]
fn sections_that_disagree_on_torsion_are_refused() {
    let refused = |from: &str, to: &str, says: &str| {
        let text = cable(&TWO.replace(from, to), 4, "");
        let text = if to.starts_with("curvature") { text.replace("name = \"rod\"", to) } else { text };
        let upright = "name = \"rod\"\nnormal = [0, 0, 1]";
        let text = if says == "torque and tension" { text.replace("name = \"rod\"", upright) } else { text };
        let built = SceneFile::parse(&text, "scene", Format::Toml, &[])
            .map_err(|e| e.to_string())
            .and_then(|f| f.scene().build().map(|_| ()).map_err(|e| e.to_string()))
            .expect_err("refused");
        assert!(built.contains(says), "{built}");
    };
    refused("gj = 0.3, rotary_inertia = 0.05", "diameter = 0", "other sections");
    refused("gj = 0.3, ", "", "`gj`");
    refused("ei = 2,", "ei = [2, 3],", "which way does the section look");
    refused("ei = 2,", "ei = [2, 3], torque_tension = 1,", "torque and tension");
    refused(
        "rotary_inertia = 0.05 }",
        "rotary_inertia = 0.05, torque_tension = 1 }, end_section = { mass = 1, ea = 1e4, ei = 2, gj = 0.3 }",
        "several sections",
    );
    refused("none", "curvature = 0.1\nname = \"rod\"", "which way does the section look");
}
