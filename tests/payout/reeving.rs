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

#[test]
fn a_heavy_rope_runs_off_a_frictionless_sheave_as_cosh_says() {
    let exact = reference("rope_over_pulley");
    let scene = over("", 0.1, [0.0; 2], "elements = 2");
    let history = run(&format!("run = {{ duration = 1, output = 0.25 }}\n{scene}"));
    let start = at(&history, "rope.end.z", 0.0);
    for (k, t) in values(&exact["t"]).into_iter().enumerate() {
        let x = 0.05 + start - at(&history, "rope.end.z", t);
        let off = x - number(&exact["x"][k]);
        assert!(off.abs() < 2e-4, "{off} m at {t} s");
    }
}

#[test]
fn a_rope_slides_over_a_locked_cylinder() {
    let exact = reference("locked_cylinder");
    let scene = over("friction = 0.2\nlocked = true", 0.0, [2.0, 6.0], "elements = 1\nspeed = 0.5");
    let history = run(&format!("run = {{ duration = 0.8, output = 0.1 }}\n{scene}"));
    let start = at(&history, "rope.end.z", 0.0);
    for (k, t) in values(&exact["t"]).into_iter().enumerate() {
        let fallen = start - at(&history, "rope.end.z", t);
        let off = fallen - number(&exact["displacement"][k]);
        assert!(off.abs() < 2e-3, "{off} m at {t} s");
    }
}

/// A hook block on a rope between two points, in a vertical plane turned by 30 degrees.
fn hook_block(ea: f64) -> String {
    format!(
        r#"
        run = {{ analysis = "statics" }}
        [[elements]]
        type = "rigid_body"
        name = "block"
        position = [1.22, 0.7, -2.9]
        mass = {}
        inertia = [2, 2, 2]
        [[elements]]
        type = "cable"
        name = "rope"
        section = {{ mass = 1e-4, ea = {ea} }}
        length = 8
        route = [{{ end = [0, 0, 0] }}, {{ under = "wheel" }}, {{ end = [2.598076211353316, 1.5, 0.5] }}]
        [[constraints]]
        type = "spherical"
        name = "a"
        marker = "rope.start"
        [[constraints]]
        type = "spherical"
        name = "b"
        marker = "rope.end"
        [[constraints]]
        type = "sheave"
        name = "wheel"
        marker = "block"
        axis = [-0.5, 0.8660254037844387, 0]
        radius = 0.25
        {GRAVITY}
        [[records]]
        type = "position"
        of = "block"
        [[records]]
        type = "sheave"
        of = "wheel"
        "#,
        2000.0 / 9.81
    )
}

#[test]
fn a_hook_block_hangs_where_it_has_to() {
    let exact = reference("hook_block");
    let history = run(&hook_block(1e8));
    let last = |name: &str| history.last(name).unwrap_or_else(|| panic!("no {name}"));
    for (x, exact) in ["x", "y", "z"].iter().zip(values(&exact["centre"])) {
        let off = last(&format!("block.{x}")) - exact;
        assert!(off.abs() < 1e-4, "{x}: {off} m");
    }
    let tension = number(&exact["tension"]);
    for side in ["in", "out"] {
        let off = last(&format!("wheel.{side}.tension")) / tension - 1.0;
        assert!(off.abs() < 1e-4, "{side}: {off}");
    }
    let wrap = number(&exact["wrap_deg"]).to_radians();
    assert!((last("wheel.wrap") - wrap).abs() < 1e-4, "{}", last("wheel.wrap"));
}

#[test]
fn a_heavy_elastic_rope_hangs_over_a_sheave() {
    let exact = reference("drum_to_load");
    let scene = format!(
        r#"
        run = {{ analysis = "statics" }}
        [[elements]]
        type = "cable"
        name = "rope"
        section = {{ mass = 2, ea = "200 kN" }}
        length = 60
        elements = 2
        route = [{{ end = [-0.4, 0, -20] }}, {{ over = "wheel" }}, {{ end = [0.4, 0, -38.7] }}]
        [[elements]]
        type = "point_mass"
        name = "load"
        marker = "rope.end"
        mass = {}
        [[constraints]]
        type = "spherical"
        name = "fixed"
        marker = "rope.start"
        [[constraints]]
        type = "sheave"
        name = "wheel"
        marker = [0, 0, 0]
        axis = [0, 1, 0]
        radius = 0.4
        {GRAVITY}
        [[records]]
        type = "position"
        of = "rope.end"
        [[records]]
        type = "sheave"
        of = "wheel"
        "#,
        5000.0 / 9.81
    );
    let history = run(&scene);
    let last = |name: &str| history.last(name).unwrap_or_else(|| panic!("no {name}"));
    let depth = -last("rope.end.z") / number(&exact["depth_below_sheave_centre"]) - 1.0;
    assert!(depth.abs() < 1e-5, "{depth}");
    let tension = last("wheel.out.tension") / number(&exact["tension_at_sheave"]) - 1.0;
    assert!(tension.abs() < 1e-5, "{tension}");
    // frictionless: the same on both sides
    let ratio = last("wheel.in.tension") / last("wheel.out.tension") - 1.0;
    assert!(ratio.abs() < 1e-9, "{ratio}");
}
