//! Cables with torsion that run over sheaves, through rings and onto drums.

mod drums;
mod moving;
mod refused;
mod wheels;

use ropewalk::scene::Format;
use ropewalk::{History, SceneFile};
use ropewalk_core::rotation::{exp, matrix, times};
use ropewalk_core::{Model, Term};

pub(super) fn build(text: &str) -> Model {
    let file = SceneFile::parse(text, "scene", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
    file.into_scene().build().unwrap_or_else(|e| panic!("{e}"))
}

pub(super) fn term<'a>(model: &'a Model, label: &str) -> &'a dyn Term {
    model.terms().iter().find(|t| t.label() == label).unwrap_or_else(|| panic!("no {label}")).as_ref()
}

/// Numbers between -1 and 1, always the same.
pub(super) fn random(seed: f64) -> impl FnMut() -> f64 {
    let mut seed = seed;
    move || {
        seed = (seed * 16_807.0) % 2_147_483_647.0;
        seed / 1_073_741_823.5 - 1.0
    }
}

/// A rope over a wheel on a body, with all that torsion has.
pub(super) const BLOCK: &str = r#"
    run = { duration = 1 }
    [[elements]]
    type = "rigid_body"
    name = "block"
    position = [1.22, 0.7, -3.4]
    angles = [0.2, -0.3, 0.4]
    points = { axle = [0.1, -0.05, 0.5] }
    mass = 200
    inertia = [2, 3, 4]
    [[elements]]
    type = "cable"
    name = "rope"
    section = { mass = 1.5, ea = 1e5, gj = 30, rotary_inertia = 0.02, torsional_retardation_time = 0.1, torque_tension = 200 }
    twist = 0.3
    laid_twist = 1.5
    length = 8
    route = [{ end = [0, 0, 0] }, { under = "wheel" }, { end = [2.6, 1.5, 0.5] }]
    [[constraints]]
    type = "sheave"
    name = "wheel"
    marker = "block.axle"
    axis = [-0.5, 0.8660254037844387, 0]
    radius = 0.25
"#;

/// A rotation about a skew axis.
pub(super) fn turned(by: f64, x: [f64; 3]) -> [f64; 3] {
    times(&matrix(&exp([0.3 * by, -0.5 * by, 0.8 * by])), &x)
}

pub(super) fn list(x: [f64; 3]) -> String {
    format!("[{:?}, {:?}, {:?}]", x[0], x[1], x[2])
}

/// Both ends of a rope held, and the end turned about its own axis by a motion.
pub(super) fn wrung(along: [f64; 3], angle: f64) -> String {
    format!(
        r#"
        [[motions]]
        type = "table"
        name = "turn"
        t = [0, 1]
        angle = [0, {angle}]
        [[constraints]]
        type = "clamp"
        name = "a"
        marker = "rope.start"
        [[constraints]]
        type = "clamp"
        name = "b"
        marker = "rope.end"
        twist = false
        [[constraints]]
        type = "rotation"
        name = "drive"
        marker = "rope.end"
        axis = {}
        motion = "turn"
        "#,
        list(along)
    )
}

/// Twist at both ends of each span, and on a wheel.
pub(super) fn observed(spans: usize, wheels: &[&str]) -> (String, Vec<String>) {
    let (mut text, mut columns) = (String::new(), Vec::new());
    for k in 1..=spans {
        for place in ["start", "end"] {
            text += &format!(
                "[[records]]\ntype = \"along\"\nof = \"rope.{k}\"\nwhat = \"twist\"\nat = \"{place}\"\n"
            );
            columns.push(format!("rope.{k}.{place}.twist"));
        }
    }
    for wheel in wheels {
        text += &format!("[[records]]\ntype = \"sheave\"\nof = \"{wheel}\"\n");
        columns.push(format!("{wheel}.twist"));
    }
    (text, columns)
}

pub(super) fn last(history: &History, column: &str) -> f64 {
    history.last(column).unwrap_or_else(|| panic!("no {column}"))
}

/// With a ring behind its wheel, and the bending stiffness that it needs there.
pub(super) fn ringed(scene: &str, place: &str) -> String {
    scene
        .replace("{ under = \"wheel\" }", "{ under = \"wheel\" }, { through = \"ring\" }")
        .replace("mass = 1.5,", "mass = 1.5, ei = 2,")
        + &format!("[[constraints]]\ntype = \"ring\"\nname = \"ring\"\nmarker = {place}\n")
}
