//! Cables that run over sheaves and through rings, with the settings that scenes have by default, against the references of
//! `tests/data/reeving`: closed forms, root finding, and a chain of 1600 masses with contact.

use crate::common::{data, number};
use ropewalk::scene::Format;
use ropewalk::{History, SceneFile, simulate};
use ropewalk_core::testing::check_tangent;
use ropewalk_core::{At, Width, retract};
use ropewalk_scene::Scene;

fn read(text: &str) -> Scene {
    SceneFile::parse(text, "scene", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}")).into_scene()
}

pub(super) fn run(text: &str) -> History {
    simulate(&read(text)).unwrap_or_else(|e| panic!("{e}"))
}

pub(super) fn refused(text: &str) -> String {
    SceneFile::parse(text, "scene", Format::Toml, &[])
        .map_err(|e| e.to_string())
        .and_then(|file| file.into_scene().build().map(drop).map_err(|e| e.to_string()))
        .expect_err("it builds")
}

pub(super) fn at(history: &History, column: &str, t: f64) -> f64 {
    let k = history.times().iter().position(|x| (x - t).abs() < 1e-6).unwrap_or_else(|| panic!("no {t} s"));
    history.column(column).unwrap_or_else(|| panic!("no {column}"))[k]
}

/// The reference of this name, and its values.
pub(super) fn reference(name: &str) -> serde_json::Value {
    data(&format!("reeving/{name}.json"))["reference"].clone()
}

pub(super) fn values(of: &serde_json::Value) -> Vec<f64> {
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
        format!(
            "[[elements]]\ntype = \"point_mass\"\nname = \"{name}\"\nmarker = \"rope.{end}\"\nmass = {mass}\n"
        )
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
        position = [1.22, 0.7, -3.4]
        points = {{ axle = [0, 0, 0.5] }}
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
        marker = "block.axle"
        axis = [-0.5, 0.8660254037844387, 0]
        radius = 0.25
        {GRAVITY}
        [[records]]
        type = "position"
        of = "block.axle"
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
    let ea = 1e7;
    let history = run(&hook_block(ea));
    let last = |name: &str| history.last(name).unwrap_or_else(|| panic!("no {name}"));
    let tension = number(&exact["tension"]);
    // the reference doesn't stretch: two falls share what the rope is longer
    let sinks = 0.5 * 8.0 * tension / ea / number(&exact["alpha_deg"]).to_radians().cos();
    for ((x, exact), sinks) in ["x", "y", "z"].iter().zip(values(&exact["centre"])).zip([0.0, 0.0, sinks]) {
        let off = last(&format!("block.axle.{x}")) - (exact - sinks);
        assert!(off.abs() < 1e-4, "{x}: {off} m");
    }
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

#[test]
fn a_cable_robot_finds_its_place() {
    let exact = reference("cable_robot");
    // the rope of each side comes straight up from a point 1 cm below the outer side of its sheave
    let cable = |name: &str, x: f64, length: f64| {
        let (low, wheel) = (length + 0.01, format!("w{name}"));
        let out = if x < 6.0 { x - 0.2 } else { x + 0.2 };
        format!(
            r#"
            [[elements]]
            type = "cable"
            name = "{name}"
            section = {{ mass = 0.5, ea = "100 kN" }}
            length = {low}
            elements = 4
            route = [{{ end = [{out}, 0, 7.99] }}, {{ over = "{wheel}" }}, {{ end = [6.35, 0, 2.3] }}]
            [[constraints]]
            type = "spherical"
            name = "{name} below"
            marker = "{name}.start"
            [[constraints]]
            type = "sheave"
            name = "{wheel}"
            marker = [{x}, 0, 8]
            axis = [0, 1, 0]
            radius = 0.2
            [[records]]
            type = "sheave"
            of = "{wheel}"
            "#
        )
    };
    let scene = format!(
        r#"
        run = {{ analysis = "statics" }}
        {}{}
        [[elements]]
        type = "point_mass"
        name = "platform"
        marker = "a.end"
        mass = 40
        [[constraints]]
        type = "spherical"
        name = "join"
        marker = "b.end"
        to = "a.end"
        {GRAVITY}
        [[records]]
        type = "position"
        of = "a.end"
        "#,
        cable("a", 0.0, 9.0),
        cable("b", 12.0, 8.5)
    );
    let history = run(&scene);
    let last = |name: &str| history.last(name).unwrap_or_else(|| panic!("no {name}"));
    for (x, exact) in ["x", "z"].iter().zip(values(&exact["platform"])) {
        let off = last(&format!("a.end.{x}")) - exact;
        assert!(off.abs() < 2e-4, "{x}: {off} m");
    }
    for (wheel, exact) in ["wa", "wb"].iter().zip(values(&exact["tension_at_sheaves"])) {
        let off = last(&format!("{wheel}.out.tension")) / exact - 1.0;
        assert!(off.abs() < 2e-3, "{wheel}: {off}");
    }
}

/// A load of 5 kg on a light rope that leaves a sheave on its right, let go at a place; more of the scene, and its reference.
fn swinging(from: [f64; 2], tension: f64, more: &str, name: &str) {
    let exact = reference(name);
    let scene = format!(
        r#"
        run = {{ duration = 3, output = 0.25 }}
        [[elements]]
        type = "cable"
        name = "rope"
        section = {{ mass = 2e-3, ea = "1 MN", axial_retardation_time = "5 ms" }}
        tension = {tension}
        route = [{{ end = [-2, 0, 0.3] }}, {{ over = "wheel" }}, {{ end = [{}, 0, {}] }}]
        [[elements]]
        type = "point_mass"
        name = "load"
        marker = "rope.end"
        mass = 5
        [[constraints]]
        type = "spherical"
        name = "fixed"
        marker = "rope.start"
        {more}
        [[constraints]]
        type = "sheave"
        name = "wheel"
        marker = [0, 0, 0]
        axis = [0, 1, 0]
        radius = 0.3
        {GRAVITY}
        [[records]]
        type = "position"
        of = "rope.end"
        [[records]]
        type = "sheave"
        of = "wheel"
        "#,
        from[0], from[1]
    );
    let history = run(&scene);
    for (k, t) in values(&exact["t"]).into_iter().enumerate() {
        for x in ["x", "z"] {
            let off = at(&history, &format!("rope.end.{x}"), t) - number(&exact[x][k]);
            assert!(off.abs() < 1e-3, "{name}: {x} is off by {off} m at {t} s");
        }
        let tension = at(&history, "wheel.out.tension", t) / number(&exact["tension"][k]) - 1.0;
        assert!(tension.abs() < 3e-3, "{name}: tension is off by {tension} at {t} s");
    }
}

#[test]
fn a_load_swings_below_a_sheave() {
    swinging([1.2940396765661482, -1.7429748464830406], 43.05, "", "pendulum_sheave");
}

#[test]
fn a_load_swings_while_a_winch_lets_it_down_over_a_sheave() {
    let winch = "[[constraints]]\ntype = \"winch\"\nname = \"drum\"\nmarker = \"rope.start\"\nspeed = 0.5\nramp = 0.5\n";
    swinging([0.9071760127408794, -1.3752933075920788], 45.18, winch, "pendulum_payout");
}

/// A tackle of four falls whose sheaves have an efficiency, drawn slowly by a winch.
fn tackle(speed: f64) -> String {
    let efficiency = (-0.05_f64).exp();
    let head = |name: &str, y: f64| {
        format!(
            "[[constraints]]\ntype = \"sheave\"\nname = \"{name}\"\nmarker = [0, {y}, 10]\naxis = [0, 1, 0]\n\
             radius = 0.1\nefficiency = {efficiency}\n"
        )
    };
    // blocks hang on a rail, so that they can't turn
    format!(
        r#"
        run = {{ duration = 3, output = 0.5 }}
        [[elements]]
        type = "rigid_body"
        name = "block"
        position = [0, 0, 4]
        mass = {}
        inertia = [1, 1, 1]
        [[elements]]
        type = "cable"
        name = "hoist"
        section = {{ mass = 1e-3, ea = "20 MN", axial_retardation_time = "20 ms" }}
        tension = 2500
        route = [
            {{ end = [-0.1, 0, 4] }}, {{ over = "h1" }}, {{ under = "b.1" }}, {{ over = "h2" }},
            {{ under = "b.2" }}, {{ end = [-0.1, 0, 10] }},
        ]
        [[constraints]]
        type = "prismatic"
        name = "rail"
        marker = "block"
        to = [0, 0, 0]
        axis = [0, 0, 1]
        [[constraints]]
        type = "spherical"
        name = "start"
        marker = "hoist.start"
        [[constraints]]
        type = "spherical"
        name = "dead end"
        marker = "hoist.end"
        [[constraints]]
        type = "winch"
        name = "drum"
        marker = "hoist.start"
        speed = {speed}
        ramp = 1
        {}{}
        [[constraints]]
        type = "sheave"
        name = "b"
        marker = "block"
        axis = [0, 1, 0]
        radius = 0.1
        count = 2
        efficiency = {efficiency}
        {GRAVITY}
        [[records]]
        type = "sheave"
        of = "h1"
        [[records]]
        type = "sheave"
        of = "h2"
        [[records]]
        type = "sheave"
        of = "b.2"
        [[records]]
        type = "energy"
        "#,
        10_000.0 / 9.81,
        head("h1", 0.0),
        head("h2", 0.0)
    )
}

#[test]
fn the_falls_of_a_tackle_share_the_load_by_the_efficiency_of_its_sheaves() {
    let exact = reference("tackle_4");
    for (speed, way) in [(-0.5, "hoisting"), (0.5, "lowering")] {
        let history = run(&tackle(speed));
        let last = |name: &str| history.last(name).unwrap_or_else(|| panic!("no {name}"));
        let off = |got: f64, exact: f64| {
            assert!((got / exact - 1.0).abs() < 1e-3, "{way}: {got} N, not {exact} N");
        };
        off(last("h1.in.tension"), number(&exact[format!("lead_{way}")]));
        // from the dead end, or from the lead
        let falls = values(&exact[format!("falls_{way}")]);
        let dead = if way == "hoisting" { falls[0].min(falls[3]) } else { falls[0].max(falls[3]) };
        off(last("b.2.out.tension"), dead);
        let power = last("energy.imbalance").abs() / last("energy.supplied").abs();
        assert!(power < 1e-3, "{way}: {power} of the work is unaccounted for");
    }
}

#[test]
fn rings_hold_their_tension_and_share_it_by_the_angle() {
    // a rope over two rings, a load at each end, the heavier sinks: with friction the tensions differ by exp(mu theta)
    let scene = |friction: f64, speed: f64| {
        format!(
            r#"
            run = {{ duration = 0.4, output = 0.1 }}
            [[elements]]
            type = "cable"
            name = "rope"
            section = {{ mass = 1e-3, ea = "1 MN", axial_retardation_time = "5 ms" }}
            tension = 30
            speed = {speed}
            route = [{{ end = [0, 0, -2] }}, {{ through = "ring" }}, {{ end = [1, 0, -1] }}]
            [[elements]]
            type = "point_mass"
            name = "load"
            marker = "rope.start"
            mass = 3
            [[constraints]]
            type = "winch"
            name = "drum"
            marker = "rope.end"
            speed = {}
            ramp = 0.1
            [[constraints]]
            type = "spherical"
            name = "fixed"
            marker = "rope.end"
            [[constraints]]
            type = "ring"
            name = "ring"
            marker = [0, 0, 0]
            friction = {friction}
            {GRAVITY}
            [[records]]
            type = "force"
            of = "ring"
            [[records]]
            type = "energy"
            "#,
            -0.5
        )
    };
    let angle = 0.75 * std::f64::consts::PI;
    for friction in [0.0, 0.3] {
        let history = run(&scene(friction, 0.0));
        let last = |name: &str| history.last(name).unwrap_or_else(|| panic!("no {name}"));
        assert!((last("ring.angle") - angle).abs() < 1e-3, "{}", last("ring.angle"));
        let ratio = last("ring.out.tension") / last("ring.in.tension") / (friction * angle).exp() - 1.0;
        assert!(ratio.abs() < 1e-4, "friction {friction}: {ratio}");
        let off = last("energy.imbalance").abs() / last("energy.supplied").abs();
        assert!(off < 1e-3, "friction {friction}: {off} of the work is unaccounted for");
    }
}

#[test]
fn a_heavy_chain_runs_through_a_ring_as_energy_says() {
    // it slides off a ring: the same cosh as over a pulley of no radius, and momentum turns without loss
    let scene = format!(
        r#"
        run = {{ duration = 1, output = 0.25 }}
        [[elements]]
        type = "cable"
        name = "rope"
        section = {{ mass = 1, ea = "1 MN" }}
        length = 4
        elements = 2
        route = [{{ end = [0, 0, -1.95] }}, {{ through = "ring" }}, {{ end = [0, 0.0, -2.05] }}]
        [[constraints]]
        type = "ring"
        name = "ring"
        marker = [0, 0, 0]
        {GRAVITY}
        [[records]]
        type = "position"
        of = "rope.end"
        [[records]]
        type = "energy"
        "#
    );
    let history = run(&scene);
    let start = at(&history, "rope.end.z", 0.0);
    for t in [0.25, 0.5, 0.75, 1.0_f64] {
        let x = 0.05 + start - at(&history, "rope.end.z", t);
        let exact = 0.05 * ((2.0_f64 * 9.81 / 4.0).sqrt() * t).cosh();
        assert!((x - exact).abs() < 2e-4, "{} m at {t} s", x - exact);
    }
}

#[test]
fn a_wheel_on_two_ropes_keeps_its_angle_in_an_equilibrium() {
    // friction needs the angle of the wheel; at rest nothing turns it
    let scene =
        over("friction = 0.3\ninertia = 0.05", 0.1, [0.0, 3.0], "tension = 30").replace("length = 4\n", "");
    let held = "[[constraints]]\ntype = \"spherical\"\nname = \"held\"\nmarker = \"rope.start\"\n";
    let history = run(&format!("run = {{ analysis = \"statics\" }}\n{scene}{held}"));
    let last = |name: &str| history.last(name).unwrap_or_else(|| panic!("no {name}"));
    assert!(last("wheel.angle").abs() < 1e-9);
    assert!((last("wheel.in.tension") / last("wheel.out.tension") - 1.0).abs() < 1e-6);
}

#[test]
fn what_cannot_be_reeved_is_refused_with_its_reason() {
    let scene = over("", 0.1, [0.0; 2], "elements = 1");
    let cases = [
        (
            scene.replace("{ over = \"wheel\" }", "{ over = \"whee\" }"),
            "there is no sheave, ring or drum `whee`",
        ),
        (
            scene.replace("{ over = \"wheel\" }", "{ under = \"wheel\" }"),
            "can't run as its route says at `wheel`",
        ),
        (scene.replace("{ over = \"wheel\" }", "{ through = \"wheel\" }"), "`wheel` is a sheave"),
        (scene.replace("axis = [0, 1, 0]", "axis = [0, 0, 1]"), "nearly vertical"),
        (scene.replace("axis = [0, 1, 0]", "axis = [0, 1, 0]\nfriction = 0.2"), "`locked = true`"),
        (scene.replace("axis = [0, 1, 0]", "axis = [0, 1, 0]\nefficiency = 0.9\ninertia = 1"), "all losses"),
        (
            scene.replace("section = { mass = 1,", "section = { gj = 1, ei = [1, 2], mass = 1,"),
            "give one stiffness",
        ),
        (scene.replace("length = 4", "points = [[0, 0, 0], [1, 0, 0]]"), "the route says where"),
        (
            scene.replace(
                ", { end = [0.1, 0, -",
                ", { over = \"wheel\" }, { over = \"wheel\" }, { end = [0.1, 0, -",
            ),
            "within the wheel",
        ),
    ];
    for (text, reason) in cases {
        let message = refused(&format!("run = {{ duration = 1 }}\n{text}"));
        assert!(message.contains(reason), "{message}\nbut not: {reason}");
    }
}

#[test]
fn a_rope_that_is_led_off_its_sheave_hangs_free() {
    // its end is led over the wheel and to the other side
    let scene = over("", 0.0, [3.0, 0.0], "elements = 1\ntension = 30").replace("length = 4\n", "");
    let led = "[[constraints]]\ntype = \"driving\"\nname = \"led\"\nmarker = \"rope.end\"\nmotion = \"way\"\n\
               [[motions]]\ntype = \"table\"\nname = \"way\"\nt = [0, 2, 4, 6]\n\
               x = [0, 1.9, 1.3, -0.4]\nz = [0, 1.84, 3.24, 3.84]\nends = \"at-rest\"\n";
    let history = run(&format!("run = {{ duration = 6, output = 0.1 }}\n{scene}{led}"));
    let last = |name: &str| history.last(name).unwrap_or_else(|| panic!("no {name}"));
    assert_eq!(last("wheel.wrap"), 0.0);
    // below it hang 3 kg and about 2 m of rope
    let tension = last("wheel.in.tension");
    assert!((tension - 48.0).abs() < 15.0, "{tension} N");
    let imbalance =
        history.column("energy.imbalance").expect("energy").iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    assert!(imbalance < 0.01, "{imbalance} J");
}

#[test]
fn tangents_are_the_derivatives_of_the_forces() {
    for sort in [
        "friction = 0.3\ninertia = 0.4\nbearing = { friction = 0.1, radius = 0.05, torque = 3, damping = 0.2 }",
        "inertia = 0.4\nbearing = { friction = 0.1, radius = 0.05, torque = 3, damping = 0.2 }",
        "efficiency = 0.9",
        "efficiency = 0.9\nequilibrium = \"to_end\"",
        "inertia = 0.4\nfriction = 0.3\nbearing = { friction = 0.1, radius = 0.05 }\nequilibrium = \"to_start\"",
    ] {
        let scene =
            hook_block(1e5).replace("mass = 1e-4", "mass = 1.5, ei = 2, axial_retardation_time = 0.01");
        let scene =
            read(&scene.replace("radius = 0.25", &format!("radius = 0.25\nslip_speed = 0.5\n{sort}")));
        let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
        let wheel = model.terms().iter().find(|t| t.label() == "wheel").expect("the wheel");
        let state = model.state();
        let mut seed = 1.0_f64;
        let mut random = |size: f64| {
            seed = (seed * 16_807.0) % 2_147_483_647.0;
            size * (seed / 1_073_741_823.5 - 1.0)
        };
        let d: Vec<f64> = state.v.iter().map(|_| random(0.01)).collect();
        let v: Vec<f64> = state.v.iter().map(|_| random(1.0)).collect();
        let a: Vec<f64> = state.v.iter().map(|_| random(5.0)).collect();
        let mut q = state.q.clone();
        retract(model.nodes(), &state.q, &d, &mut q);
        // where it says so, friction acts in full
        let internal = vec![1.0; state.internal.len()];
        let at = At { t: 0.0, q: &q, v: &v, a: &a, internal: &internal, relaxed: None };
        let off = check_tangent(wheel.as_ref(), model.nodes(), &at, Width::One);
        assert!(off < 1e-6, "{sort}: {off}");
        for end in ["wheel.in: fleet", "wheel.out: fleet"] {
            let fleet = model.terms().iter().find(|t| t.label() == end).expect("the end");
            let off = check_tangent(fleet.as_ref(), model.nodes(), &at, Width::One);
            assert!(off < 1e-6, "{sort}, {end}: {off}");
        }
    }
}
