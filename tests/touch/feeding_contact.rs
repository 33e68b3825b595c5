//! Cables that feed and touch: material runs over a bar while a winch pays it out.

use ropewalk::scene::Format;
use ropewalk::{History, SceneFile, simulate};
use ropewalk_core::Width;
use ropewalk_core::testing::check_tangent;
use std::f64::consts::PI;

const G: f64 = 9.81;
const RADIUS: f64 = 0.3;
const LOAD: f64 = 10.0;
const MASS: f64 = 0.5;
const EA: f64 = 1e5;

/// A rope from a winch over a smooth drum to a load.
fn scene(speed: f64, more: &str, contact: &str) -> String {
    let (r, side) = (RADIUS, 1.0);
    let mut points: Vec<[f64; 3]> =
        (0..20).map(|k| side * f64::from(k) / 20.0).map(|s| [-r, 0.0, s - side]).collect();
    points.extend((0..=40).map(|k| PI * f64::from(k) / 40.0).map(|a| [-r * a.cos(), 0.0, r * a.sin()]));
    points.extend((1..=20).map(|k| side * f64::from(k) / 20.0).map(|s| [r, 0.0, -s]));
    format!(
        r#"
        [run]
        duration = 3
        output = 0.1
        [[elements]]
        type = "cable"
        name = "rope"
        curve = {points:?}
        elements = 60
        tension = {tension}
        section = {{ mass = {MASS}, ea = {EA}, diameter = 0.01, axial_retardation_time = 2e-2 }}
        [[elements]]
        type = "point_mass"
        name = "load"
        marker = "rope.end"
        mass = {LOAD}
        [[constraints]]
        type = "spherical"
        name = "foot"
        marker = "rope.start"
        [[constraints]]
        type = "winch"
        name = "winch"
        marker = "rope.start"
        speed = {speed}
        start = 0.2
        ramp = 0.5
        {more}
        [[forces]]
        type = "gravity"
        [[forces]]
        type = "contact"
        name = "drum"
        on = ["rope"]
        shape = {{ cylinder = {{ axis = [0, 1, 0], radius = {inner} }} }}
        {contact}
        [[records]]
        type = "position"
        of = "load"
        [[records]]
        type = "along"
        of = "rope"
        what = "tension"
        at = "start"
        [[records]]
        type = "force"
        of = "drum"
        "#,
        tension = LOAD * G,
        inner = r - 0.005,
    )
}

const SMOOTH: &str = "stiffness_per_length = 1e6\ndamping = { kelvin_voigt = { retardation_time = 1e-3 } }";

fn file(text: &str) -> SceneFile {
    SceneFile::parse(text, "feeding", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"))
}

fn run(text: &str) -> History {
    simulate(file(text).scene()).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn what_a_winch_pays_out_runs_over_a_smooth_drum() {
    for (speed, more) in [(0.3, ""), (-0.3, ""), (0.3, "element_length = 0.05")] {
        let h = run(&scene(speed, more, SMOOTH));
        let (t, z) = (h.times(), h.column("load.z").unwrap());
        let at = |time: f64| z[t.iter().position(|t| (t - time).abs() < 1e-9).unwrap()];
        // what is fed goes down with the load, stretched by it
        let fallen = at(2.0) - at(3.0);
        println!("{speed} {more}: {fallen}");
        let right = speed * (1.0 + LOAD * G / EA);
        assert!((fallen / right - 1.0).abs() < 5e-4, "{speed} {more}: {fallen}");
        // without friction the tension differs by weight alone
        let tension = h.last("rope.start.tension").unwrap();
        let right = LOAD * G + MASS * G * (-1.0 - h.last("load.z").unwrap());
        println!("{tension} {right}");
        assert!((tension / right - 1.0).abs() < 2e-3, "{speed} {more}: {tension} instead of {right}");
        // the drum carries both, with what hangs down to the winch, and what lies on it
        let carried = 2.0 * (right + MASS * G) + MASS * G * PI * RADIUS;
        let held = h.last("drum.fz").unwrap();
        assert!((held / carried - 1.0).abs() < 3e-3, "{held} instead of {carried}");
        let audit = &h.audit;
        println!("{:e} of {:e}", audit.imbalance(), audit.supplied);
        assert!(audit.imbalance().abs() < 2e-3 * audit.supplied.abs().max(1.0), "{audit:?}");
    }
}

#[test]
fn tangents_of_what_runs_are_those_of_its_force() {
    let turning = "marker = \"wheel\"\nstiffness_per_length = 1e4\ndamping = { hunt_crossley = 2.0 }";
    let wheel = "[[elements]]\ntype = \"rigid_body\"\nname = \"wheel\"\nposition = [0, 0, 0]\nmass = 3\ninertia = [1, 1, 1]\n";
    let ground = turning.replace("marker = \"wheel\"", "");
    for (more, contact) in
        [("", ground.as_str()), ("element_length = 0.05\n", ground.as_str()), (wheel, turning)]
    {
        // 3 mm deep
        let text = scene(0.3, more, contact).replace("radius = 0.295", "radius = 0.298");
        let text = text.replace("name = \"drum\"", "name = \"drum\"\n        overlap = \"allow\"");
        let model = file(&text).build().unwrap_or_else(|e| panic!("{e}"));
        let mut state = model.state();
        // nothing in a special place, and all in motion
        for (k, q) in state.q.iter_mut().enumerate() {
            *q += 2e-4 * (1.7 * k as f64).sin();
        }
        for (k, v) in state.v.iter_mut().enumerate() {
            *v = 0.05 * (0.9 * k as f64).cos();
        }
        for node in model.nodes().iter().filter(|n| n.kind == ropewalk_core::NodeKind::Frame) {
            let q = &mut state.q[node.q + 3..node.q + 7];
            let size = q.iter().map(|q| q * q).sum::<f64>().sqrt();
            q.iter_mut().for_each(|q| *q /= size);
        }
        let drum = model.terms().iter().find(|t| t.label() == "drum").unwrap();
        let error = check_tangent(drum.as_ref(), model.nodes(), &state.at(), Width::One);
        println!("{more}: {error:e}");
        assert!(error < 1e-3, "{more}: {error}");
    }
}

#[test]
fn friction_on_what_feeds_is_refused() {
    let rough = format!("{SMOOTH}\nfriction = 0.2");
    let message = file(&scene(0.3, "", &rough)).build().err().expect("refused").to_string();
    assert!(message.contains("`rope` feeds") && message.contains("leave the cable out by `on`"), "{message}");
}
