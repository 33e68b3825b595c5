//! Twist that runs over wheels and swings there.

use super::{last, observed};
use crate::reeving::run;
use ropewalk::scene::Format;
use ropewalk::{ModesOptions, SceneFile, Simulation, modes};
use std::f64::consts::PI;

/// Bodies at both ends of a rope over a wheel, which runs to the heavier one.
fn running(inertia: f64) -> String {
    let body = |name: &str, end: &str, x: f64, z: f64, mass: f64| {
        format!(
            r#"
            [[elements]]
            type = "rigid_body"
            name = "{name}"
            position = [{x}, 0, {z}]
            mass = {mass}
            inertia = [{inertia}, {inertia}, {inertia}]
            [[constraints]]
            type = "weld"
            name = "{name}.tie"
            marker = "rope.{end}"
            to = "{name}"
            "#
        )
    };
    format!(
        r#"
        run = {{ duration = 1, output = 0.05 }}
        [[elements]]
        type = "cable"
        name = "rope"
        section = {{ mass = 1, ea = 1e6, gj = 5, rotary_inertia = 1e-3 }}
        tension = 330
        laid_twist = 2
        elements = 2
        route = [{{ end = [-0.3, 0, -3] }}, {{ over = "wheel" }}, {{ end = [0.3, 0, -2] }}]
        [[constraints]]
        type = "sheave"
        name = "wheel"
        marker = [0, 0, 0]
        axis = [0, 1, 0]
        radius = 0.3
        inertia = 0.05
        {}
        {}
        {}
        [[forces]]
        type = "gravity"
        [[records]]
        type = "position"
        of = "right"
        [[records]]
        type = "energy"
        "#,
        body("left", "start", -0.3, -3.0, 30.0),
        body("right", "end", 0.3, -2.0, 40.0),
        observed(2, &["wheel"]).0,
    )
}

#[test]
fn twist_runs_over_a_wheel_with_the_rope() {
    // nothing at the ends turns
    let history = run(&running(1e9));
    assert!(last(&history, "right.z") < -2.4);
    for column in &observed(2, &["wheel"]).1 {
        let off =
            history.column(column).expect("a column").iter().fold(0.0_f64, |m, x| m.max((x - 2.0).abs()));
        assert!(off < 1e-6, "{column}: {off}");
    }
}

#[test]
fn bodies_that_swing_about_a_running_rope_keep_their_energy() {
    let imbalance = |tolerance: f64| {
        let text = running(0.05)
            + &format!("[solver]\nstepping = {{ controlled = {{ tolerance = {tolerance} }} }}\n");
        let history = run(&text);
        let twist = history.column("wheel.twist").expect("a twist");
        assert!(twist.iter().any(|k| *k < 0.0), "it swings: {twist:?}");
        // 60 J of twist at the start
        history.column("energy.imbalance").expect("energy").iter().fold(0.0_f64, |m, x| m.max(x.abs()))
    };
    let off = [1e-4, 1e-6].map(imbalance);
    assert!(off[1] < 1e-3 && off[0] < 0.1, "{off:?}");
}

#[test]
fn a_hook_block_is_turned_by_a_rope_that_unlays() {
    let (radius, height, weight, coupling, gj, ea) = (0.3, 10.0, 2000.0, 2500.0, 20.0, 1e6);
    let mut text = format!(
        r#"
        run = {{ analysis = "statics", duration = 1 }}
        statics = {{ steps = 20 }}
        [[elements]]
        type = "rigid_body"
        name = "block"
        position = [0, 0, -10.5]
        points = {{ axle = [0, 0, 0.5], mark = [1, 0, 0.5] }}
        mass = {}
        inertia = [2, 2, 2]
        [[elements]]
        type = "cable"
        name = "rope"
        section = {{ mass = 1e-4, ea = {ea}, gj = {gj}, rotary_inertia = 1e-3, torque_tension = {coupling} }}
        tension = 1000
        elements = 1
        route = [{{ end = [-{radius}, 0, 0] }}, {{ under = "wheel" }}, {{ end = [{radius}, 0, 0] }}]
        [[constraints]]
        type = "sheave"
        name = "wheel"
        marker = "block.axle"
        axis = [0, 1, 0]
        radius = {radius}
        [[forces]]
        type = "gravity"
        [[records]]
        type = "position"
        of = "block.mark"
        [[records]]
        type = "position"
        of = "block.axle"
        [[records]]
        type = "sheave"
        of = "wheel"
        "#,
        weight / 9.81
    );
    for end in ["start", "end"] {
        text += &format!(
            "[[constraints]]\ntype = \"universal\"\nname = \"{end}\"\nmarker = \"rope.{end}\"\naxis = [0, 1, 0]\naxis_to = [1, 0, 0]\n"
        );
    }
    let history = run(&text);
    let length = (2.0 * height + PI * radius) / (1.0 + 1000.0 / ea);
    // two falls turn the block by their moment, less by what unlays; hung apart, their tension turns it back
    let left = |angle: f64| {
        let fall = -last(&history, "block.axle.z");
        let lean = 2.0 * radius * (0.5 * angle).sin() / fall;
        let (tension, twist) = (0.5 * weight * (1.0 + lean * lean).sqrt(), -2.0 * angle / length);
        let moment = coupling * (tension - coupling * twist) / ea + gj * twist;
        2.0 * moment - weight * radius * radius * angle.sin() / fall
    };
    let (mut low, mut high) = (0.0, 1.5);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if left(middle) > 0.0 { low = middle } else { high = middle }
    }
    let found = (last(&history, "block.mark.y") / 1.0).asin().abs();
    println!("{found} {low}, torque {}", last(&history, "wheel.torque"));
    let tension = 0.5 * weight * (1.0 + (radius * found / height).powi(2)).sqrt();
    let shown = last(&history, "wheel.in.tension");
    assert!((shown / tension - 1.0).abs() < 1e-3, "{shown} {tension}");
    assert!((found / low - 1.0).abs() < 3e-3, "{found} {low}");
}

#[test]
fn torsion_swings_over_a_wheel_as_in_a_straight_rope() {
    let scene = |radius: f64| {
        format!(
            r#"
            run = {{ duration = 1 }}
            [[elements]]
            type = "cable"
            name = "rope"
            section = {{ mass = 1, ea = 1e6, gj = 5, rotary_inertia = 1e-3 }}
            tension = 1000
            elements = 8
            route = [{{ end = [-{radius}, 0, -2] }}, {{ over = "wheel" }}, {{ end = [{radius}, 0, -1.5] }}]
            [[constraints]]
            type = "sheave"
            name = "wheel"
            marker = [0, 0, 0]
            axis = [0, 1, 0]
            radius = {radius}
            [[constraints]]
            type = "clamp"
            name = "a"
            marker = "rope.start"
            [[constraints]]
            type = "clamp"
            name = "b"
            marker = "rope.end"
            "#
        )
    };
    // what lies on the wheel is one element: the error goes by its size squared, about (π A/L)²/12 of its share in the middle
    for (radius, most) in [(0.3, 8e-3), (0.1, 4e-4)] {
        let length = (3.5 + radius * PI) / 1.001;
        let file =
            SceneFile::parse(&scene(radius), "scene", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
        let options = ModesOptions { count: 60, ..ModesOptions::default() };
        let found = modes(&file.into_scene(), &options).unwrap_or_else(|e| panic!("{e}"));
        let exact = PI / length * (5.0_f64 / 1e-3).sqrt();
        let off = found.modes.iter().map(|m| (m.omega / exact - 1.0).abs()).fold(f64::INFINITY, f64::min);
        println!("radius {radius}: {off:e}");
        assert!(off < most, "radius {radius}: {off}");
    }
}

#[test]
fn a_twisted_rope_lifts_off_and_comes_back() {
    // its end is led over the wheel and to the other side, and back
    let (records, columns) = observed(2, &["wheel"]);
    let scene = format!(
        r#"
        run = {{ duration = 6, output = 0.1 }}
        [[elements]]
        type = "rigid_body"
        name = "load"
        position = [-0.1, 0, -1.8]
        mass = 30
        inertia = [1e9, 1e9, 1e9]
        [[elements]]
        type = "cable"
        name = "rope"
        section = {{ mass = 0.1, ea = 1e5, gj = 0.5, rotary_inertia = 1e-2, torsional_retardation_time = 0.1 }}
        tension = 300
        laid_twist = 1
        elements = 1
        route = [{{ end = "load" }}, {{ over = "wheel" }}, {{ end = [0.1, 0, -1.8] }}]
        [[constraints]]
        type = "direction"
        name = "a"
        marker = "rope.start"
        to = "load"
        [[constraints]]
        type = "sheave"
        name = "wheel"
        marker = [0, 0, 0]
        axis = [0, 1, 0]
        radius = 0.1
        [[constraints]]
        type = "driving"
        name = "led"
        marker = "rope.end"
        motion = "way"
        [[constraints]]
        type = "perpendicular"
        name = "b"
        marker = "rope.end"
        axis = [1, 0, 0]
        axis_to = [0, 1, 0]
        [[motions]]
        type = "table"
        name = "way"
        t = [0, 2, 4, 6]
        x = [0, 1.9, 1.3, -0.4]
        z = [0, 1.84, 3.24, 3.84]
        ends = "at-rest"
        [[forces]]
        type = "gravity"
        [[records]]
        type = "energy"
        {records}
        "#
    );
    let history = run(&scene);
    assert_eq!(last(&history, "wheel.wrap"), 0.0);
    // all of it moves in a plane, and neither end turns: the twist is what it was
    for column in &columns {
        let off =
            history.column(column).expect("a column").iter().fold(0.0_f64, |m, x| m.max((x - 1.0).abs()));
        println!("{column}: {off:e}");
        assert!(off < 1e-3, "{column}: {off}");
    }
    let imbalance =
        history.column("energy.imbalance").expect("energy").iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    println!("{imbalance}");
    assert!(imbalance < 0.01, "{imbalance} J");
}

#[test]
fn torsion_over_wheels_goes_through_checkpoints_to_the_last_bit() {
    let file = SceneFile::parse(&running(0.05), "scene", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
    let scene = file.into_scene();
    let model = || scene.build().unwrap_or_else(|e| panic!("{e}"));
    let mut whole = Simulation::new(model(), &scene.solver, scene.run.duration).expect("a start");
    whole.advance(0.4, 0.4, &mut ()).expect("run");
    let checkpoint = whole.checkpoint().expect("checkpoint");
    whole.advance(0.8, 0.2, &mut ()).expect("run");
    let mut again =
        Simulation::restore(model(), &scene.solver, scene.run.duration, checkpoint).expect("fits");
    again.advance(0.8, 0.2, &mut ()).expect("run");
    assert_eq!((again.state, again.audit), (whole.state, whole.audit));
}
