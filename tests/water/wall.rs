//! What the wall of a cable carries in water, and stress round its section.

use ropewalk::scene::Format;
use ropewalk::{History, SceneFile, simulate};
use std::f64::consts::PI;

fn run(text: &str) -> History {
    let file = SceneFile::parse(text, "wall", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
    simulate(file.scene()).unwrap_or_else(|e| panic!("{e}"))
}

/// A pipe that hangs in water with its closed end free: its wall carries its weight below less the pressure at its foot times the area,
/// `m g (L - s) - ρ g (depth of the foot) A`.
#[test]
fn the_wall_of_a_hanging_pipe_carries_its_weight_less_the_pressure_at_its_foot() {
    let (mass, density, diameter, length, top) = (40.0, 1025.0, 0.2, 60.0, 30.0);
    let h = run(&format!(
        r#"
        run = {{ analysis = "statics" }}
        [water]
        density = {density}
        level = {top}
        [[elements]]
        type = "cable"
        name = "pipe"
        points = [[0, 0, 0], [0, 0, -{length}]]
        elements = 12
        section = {{ mass = {mass}, ea = 1e9, ei = 1e5, diameter = {diameter} }}
        [[constraints]]
        type = "spherical"
        name = "hook"
        marker = "pipe.start"
        [[forces]]
        type = "gravity"
        [[forces]]
        type = "buoyancy"
        [[records]]
        type = "wall_tension"
        of = "pipe"
        at = ["start", "50 %", "end"]
        [[records]]
        type = "stress"
        of = "pipe"
        diameter = {diameter}
        inner_diameter = 0.18
        points = 4
        at = ["50 %"]
        "#
    ));
    let area = PI / 4.0 * diameter * diameter;
    let foot = density * 9.81 * (top + length) * area;
    for (name, s) in [("start", 0.0), ("@50%", 0.5), ("end", 1.0)] {
        let name = if name.starts_with('@') {
            format!("pipe.wall_tension{name}")
        } else {
            format!("pipe.wall_tension.{name}")
        };
        let wanted = mass * 9.81 * length * (1.0 - s) - foot;
        let found = h.last(&name).unwrap_or_else(|| panic!("no {name}"));
        assert!((found - wanted).abs() <= 2e-5 * foot, "{name}: {found} {wanted}");
    }
    let wall = PI / 4.0 * (diameter * diameter - 0.18 * 0.18);
    let wanted = (mass * 9.81 * length * 0.5 - foot) / wall;
    for angle in [0, 90, 180, 270] {
        let found = h.last(&format!("pipe.stress@50%.{angle}deg")).expect("stress");
        assert!((found - wanted).abs() <= 2e-5 * wanted.abs(), "{angle}: {found} {wanted}");
    }
}

/// A cantilever under a load at its tip, aslant: at each angle `-M c/I` times the direction towards the centre of curvature. Without
/// torsion angles count from z at the start, with torsion from the section's director.
#[test]
fn stress_round_a_cantilever_is_that_of_the_beam() {
    let (ei, length, diameter, load) = (800.0, 2.0, 0.02, [-3.0, 4.0]);
    for torsion in ["", ", gj = 500"] {
        let h = run(&format!(
            r#"
            run = {{ analysis = "statics" }}
            [[elements]]
            type = "cable"
            name = "beam"
            points = [[0, 0, 0], [{length}, 0, 0]]
            elements = 8
            section = {{ mass = 1, ea = 1e7, ei = {ei}, diameter = {diameter}{torsion} }}
            [[constraints]]
            type = "clamp"
            name = "wall"
            marker = "beam.start"
            [[forces]]
            type = "point_force"
            marker = "beam.end"
            force = [0, {}, {}]
            [[records]]
            type = "stress"
            of = "beam"
            diameter = {diameter}
            points = 8
            at = ["25 %"]
            [[records]]
            type = "along"
            of = "beam"
            what = "moment"
            at = "25 %"
            "#,
            load[0], load[1]
        ));
        let moment = 5.0 * length * 0.75;
        let inertia = PI / 64.0 * f64::powi(diameter, 4);
        let largest = moment * 0.5 * diameter / inertia;
        let values: Vec<f64> =
            (0..8).map(|k| h.last(&format!("beam.stress@25%.{}deg", 45 * k)).expect("stress")).collect();
        // pulled away from where the load pushes: the sum over a harmonic has the whole amplitude
        let part = |f: fn(f64) -> f64| -> f64 {
            values.iter().enumerate().map(|(k, x)| 0.25 * x * f(PI / 4.0 * k as f64)).sum()
        };
        let (a, b) = (part(f64::cos), part(f64::sin));
        assert!((a.hypot(b) - largest).abs() <= 2e-3 * largest, "{torsion}: {} {largest}", a.hypot(b));
        if torsion.is_empty() {
            // 0 deg is z, 90 deg is t × z = -y; the load bends it towards +z and -y
            assert!((a + 0.8 * largest).abs() <= 4e-3 * largest, "{a} {largest}");
            assert!((b + 0.6 * largest).abs() <= 4e-3 * largest, "{b} {largest}");
        }
    }
}
