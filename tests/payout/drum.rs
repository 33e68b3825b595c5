//! Drums at ends of routes, with the settings that scenes have by default: against the references of `tests/data/reeving`,
//! closed forms, and the balance of energy.

use crate::common::{data, number};
use ropewalk::scene::Format;
use ropewalk::{History, SceneFile, simulate};
use ropewalk_core::testing::check_tangent;
use ropewalk_core::{At, Width, retract};
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

fn last(history: &History, column: &str) -> f64 {
    history.last(column).unwrap_or_else(|| panic!("no {column}"))
}

fn reference(name: &str) -> serde_json::Value {
    data(&format!("reeving/{name}.json"))["reference"].clone()
}

fn values(of: &serde_json::Value) -> Vec<f64> {
    of.as_array().expect("a list").iter().map(number).collect()
}

/// A load on a light rope from a drum about an axis, at a place in space.
fn hanging(run: &str, drum: &str, axis: &str, tension: f64, from: [f64; 3], mass: f64) -> String {
    let [x, y, z] = from;
    format!(
        r#"
        run = {{ {run} }}
        [[elements]]
        type = "cable"
        name = "rope"
        section = {{ mass = 2e-3, ea = "1 MN", axial_retardation_time = "5 ms" }}
        tension = {tension}
        route = [{{ wound = "drum" }}, {{ end = [{x}, {y}, {z}] }}]
        [[elements]]
        type = "point_mass"
        name = "load"
        marker = "rope.end"
        mass = {mass}
        [[constraints]]
        type = "drum"
        name = "drum"
        marker = [0, 0, 0]
        axis = {axis}
        radius = 0.3
        {drum}
        [[forces]]
        type = "gravity"
        [[records]]
        type = "position"
        of = "rope.end"
        [[records]]
        type = "drum"
        of = "drum"
        [[records]]
        type = "energy"
        "#
    )
}

#[test]
fn a_load_swings_below_a_drum_that_pays_out() {
    let exact = reference("pendulum_payout");
    // about +y with the load on the right, and the mirror image
    for (axis, side) in [("[0, 1, 0]", 1.0), ("[0, -1, 0]", -1.0)] {
        let from = [side * 0.9071760127408794, 0.0, -1.3752933075920788];
        let drum = "speed = 0.5\nramp = 0.5";
        let history = run(&hanging("duration = 3, output = 0.25", drum, axis, 45.18, from, 5.0));
        for (k, t) in values(&exact["t"]).into_iter().enumerate() {
            let off = side * at(&history, "rope.end.x", t) - number(&exact["x"][k]);
            assert!(off.abs() <= 1e-3, "x is off by {off} m at {t} s");
            let off = at(&history, "rope.end.z", t) - number(&exact["z"][k]);
            assert!(off.abs() <= 1e-3, "z is off by {off} m at {t} s");
            let off = at(&history, "drum.torque", t) / 0.3 / number(&exact["tension"][k]) - 1.0;
            assert!(off.abs() <= 2e-3, "tension is off by {off} at {t} s");
            // what swings winds and unwinds
            let fed = at(&history, "drum.angle", t) * 0.3 + 0.3 * (number(&exact["angle"][k]) - 0.4);
            let off = at(&history, "drum.payout", t) - fed;
            assert!(off.abs() <= 1e-3, "payout is off by {off} m at {t} s");
        }
        let off = last(&history, "energy.imbalance").abs() / last(&history, "energy.supplied").abs();
        assert!(off <= 1e-3, "{off} of the work is unaccounted for");
    }
}

#[test]
fn a_heavy_elastic_rope_hangs_from_a_drum_over_a_sheave() {
    let exact = reference("drum_to_load");
    // at either end of the rope
    for back in [false, true] {
        let drum = "{ wound = \"drum\" }";
        let load = "{ end = [0.4, 0, -38.7] }";
        let (ends, way, axis) =
            if back { ([load, drum], "start", "[0, -1, 0]") } else { ([drum, load], "end", "[0, -1, 0]") };
        let scene = format!(
            r#"
            run = {{ analysis = "statics" }}
            [[elements]]
            type = "cable"
            name = "rope"
            section = {{ mass = 2, ea = "200 kN" }}
            length = 60
            elements = 2
            route = [{}, {{ over = "wheel" }}, {}]
            [[elements]]
            type = "point_mass"
            name = "load"
            marker = "rope.{way}"
            mass = {}
            [[constraints]]
            type = "sheave"
            name = "wheel"
            marker = [0, 0, 0]
            axis = [0, 1, 0]
            radius = 0.4
            [[constraints]]
            type = "drum"
            name = "drum"
            marker = [-0.9, 0, -20]
            axis = {axis}
            radius = 0.5
            speed = 0
            [[forces]]
            type = "gravity"
            [[records]]
            type = "position"
            of = "rope.{way}"
            [[records]]
            type = "drum"
            of = "drum"
            "#,
            ends[0],
            ends[1],
            5000.0 / 9.81
        );
        let history = run(&scene);
        let depth =
            -last(&history, &format!("rope.{way}.z")) / number(&exact["depth_below_sheave_centre"]) - 1.0;
        assert!(depth.abs() <= 1e-5, "{depth}");
        let tension = last(&history, "drum.torque") / 0.5 / number(&exact["tension_at_drum"]) - 1.0;
        assert!(tension.abs() <= 1e-5, "{tension}");
    }
}

/// A taut rope from a drum or over a sheave to a point, and the exact tangent point in the plane of the wheel, which is the
/// same for all points beside that plane.
fn taut(beside: f64, wheel: &str) -> (History, Vec<f64>, f64) {
    let file = data("reeving/fleet_angle.json");
    let point = values(&file["parameters"]["point"]);
    let exact = values(&file["reference"]["tangent_point"]);
    let flat = (point[0] - exact[0]).hypot(point[2] - exact[2]);
    let (from, held, own) = match wheel {
        "drum" => ("{ wound = \"wheel\" }", "", "speed = 0"),
        _ => (
            "{ end = [-3, 0, -1] }, { over = \"wheel\" }",
            "[[constraints]]\ntype = \"spherical\"\nname = \"behind\"\nmarker = \"rope.start\"\n",
            "",
        ),
    };
    let span = if wheel == "drum" { "rope" } else { "rope.2" };
    let scene = format!(
        r#"
        run = {{ analysis = "statics" }}
        [[elements]]
        type = "cable"
        name = "rope"
        section = {{ mass = 1e-6, ea = "1 MN" }}
        tension = 100
        route = [{from}, {{ end = [{}, {beside}, {}] }}]
        [[constraints]]
        type = "spherical"
        name = "held"
        marker = "rope.end"
        {held}
        [[constraints]]
        type = "{wheel}"
        name = "wheel"
        marker = [0, 0, 0]
        axis = [0, 1, 0]
        radius = 0.5
        {own}
        [[records]]
        type = "position"
        of = "{span}.start"
        name = "foot"
        [[records]]
        type = "{wheel}"
        of = "wheel"
        "#,
        point[0], point[2]
    );
    (run(&scene), exact, (beside / flat).atan())
}

#[test]
fn the_fleet_angle_is_that_of_a_taut_rope_to_its_end() {
    let file = reference("fleet_angle");
    for beside in [0.006, 0.6] {
        for wheel in ["drum", "sheave"] {
            let (history, exact, fleet) = taut(beside, wheel);
            for (k, x) in exact.iter().enumerate() {
                let off = last(&history, &format!("foot.{}", ["x", "y", "z"][k])) - x;
                assert!(off.abs() <= 1e-6, "{wheel}, {beside} m beside: {off} m");
            }
            if wheel == "drum" {
                let off = last(&history, "wheel.fleet") - fleet;
                assert!(off.abs() <= 1e-6, "{off} rad");
            }
            if beside == 0.6 {
                assert!((fleet.to_degrees() - number(&file["fleet_angle_deg"])).abs() <= 1e-12);
            }
        }
    }
}

#[test]
fn what_is_wound_under_tension_comes_off_as_it_was_wound() {
    // elastic rope, straight down: reeled in under a load that doubles on the way, and paid out again under that; below lies
    // rope without tension
    let (radius, ea, weight) = (0.3, 2000.0, 5.0 * 9.81);
    let turn = "turn = \"way\"\nwound_tension = 0";
    let motion = "[[motions]]\ntype = \"table\"\nname = \"way\"\nt = [0, 1, 9, 10, 11, 21, 22]\n\
                  angle = [0, -0.5, -8.5, -9, -8.5, 1.5, 2]\njoin = \"cubic\"\nends = \"at-rest\"\n\
                  [[forces]]\ntype = \"point_force\"\nmarker = \"rope.end\"\nforce = [0, 0, -49.05]\n\
                  time = { ramp = { from = 0, to = 1, t0 = 2, t1 = 8 } }\n";
    let scene = hanging("duration = 22, output = 0.5", turn, "[0, 1, 0]", weight, [0.3, 0.0, -6.0], 5.0)
        .replace(
            "ea = \"1 MN\", axial_retardation_time = \"5 ms\"",
            "ea = 2000, axial_retardation_time = \"50 ms\"",
        );
    let history = run(&format!("{scene}{motion}"));
    let rows = |name: &str| history.column(name).unwrap_or_else(|| panic!("no {name}")).to_vec();
    let (angle, payout, torque) = (rows("drum.angle"), rows("drum.payout"), rows("drum.torque"));
    let k = |t: f64| (t / 0.5).round() as usize;
    // at first it takes the stretch of the load, in the end that of both
    let [from, to] = [k(0.5), k(1.5)];
    let stretch = radius * (angle[to] - angle[from]) / (payout[to] - payout[from]);
    assert!((stretch - 1.0 - weight / ea).abs() <= 1e-3, "{stretch}");
    let [from, to] = [k(8.5), k(9.5)];
    let stretch = radius * (angle[to] - angle[from]) / (payout[to] - payout[from]);
    assert!((stretch - 1.0 - 2.0 * weight / ea).abs() <= 1e-3, "{stretch}");
    // the same length by the same angle on the way back
    for t in [11.0, 14.0, 17.0, 19.0] {
        let (now, there) = (angle[k(t)], payout[k(t)]);
        let j = (1..k(10.0)).find(|&j| angle[j] <= now).expect("wound to there");
        let share = (now - angle[j]) / (angle[j - 1] - angle[j]);
        let then = payout[j] + share * (payout[j - 1] - payout[j]);
        assert!((there - then).abs() <= 2e-3, "{there} m for {then} m at {t} s");
    }
    // and below what was wound without tension
    let [from, to] = [k(20.5), k(21.5)];
    let stretch = radius * (angle[to] - angle[from]) / (payout[to] - payout[from]);
    assert!((stretch - 1.0).abs() <= 1e-4, "{stretch}");
    // the moment is that of the load but for its inertia, whatever the stretch of what comes off
    for (t, loads) in [(5.0, 1.5), (15.0, 2.0), (20.0, 2.0)] {
        let pull = loads * weight;
        let off = torque[k(t)] / radius / pull - 1.0;
        assert!(off.abs() <= 5e-3, "{off} at {t} s");
    }
    let lost = last(&history, "energy.imbalance").abs() / (2.0 * weight * radius * 9.0);
    assert!(lost <= 2e-3, "{lost} of the work is unaccounted for");
}

#[test]
fn a_load_that_swings_across_its_drum_accounts_for_its_energy() {
    let history =
        run(&hanging("duration = 3, output = 0.1", "speed = 0", "[0, 1, 0]", 45.18, [0.9, 0.3, -1.37], 5.0));
    let fleet = history.column("drum.fleet").expect("fleet");
    assert!(fleet.iter().any(|x| *x > 0.15) && fleet.iter().any(|x| *x < -0.15), "{fleet:?}");
    let most = history.column("energy.kinetic").expect("energy").iter().fold(0.0, |m: f64, x| m.max(*x));
    let lost = last(&history, "energy.imbalance").abs() / most;
    assert!(lost <= 1e-3, "{lost} of the kinetic energy is unaccounted for");
}

#[test]
fn a_load_turns_a_drum_with_inertia() {
    // straight down from the side of the drum: a = g m / (m + J/R^2), and the rope that is wound counts
    let (mass, inertia, stock) = (5.0, 0.4, 50.0);
    let drum = format!("inertia = {inertia}\nwound = {stock}");
    let scene = hanging("duration = 1, output = 0.25", &drum, "[0, 1, 0]", 30.0, [0.3, 0.0, -2.0], mass);
    let history = run(&scene.replace("mass = 2e-3", "mass = 0.02"));
    // by energy: v^2 (m + rho l + J/R^2 + rho w) / 2 = g (m x + rho l x + rho x^2 / 2), with l + w constant
    let (rho, radius, l) = (0.02, 0.3_f64, 2.0);
    let moved = mass + inertia / radius.powi(2) + rho * (stock + l);
    let mut x = 0.0_f64;
    let (mut v, h) = (0.0_f64, 1e-5);
    for _ in 0..100_000 {
        let a = 9.81 * (mass + rho * (l + x)) / moved;
        x += h * (v + 0.5 * h * a);
        v += h * a;
    }
    let off = last(&history, "drum.payout") / x - 1.0;
    assert!(off.abs() <= 2e-4, "{off}");
    let off = last(&history, "drum.spin") * radius / v - 1.0;
    assert!(off.abs() <= 2e-4, "{off}");
    let size = mass * 9.81 * x;
    let off = last(&history, "energy.imbalance").abs() / size;
    assert!(off <= 1e-4, "{off} of the work is unaccounted for");
}

#[test]
fn a_brake_stops_a_drum_and_a_motor_hoists() {
    let weight = 5.0 * 9.81;
    // the motor pulls with 1.5 times the weight: a = 0.5 g m / (m + J/R^2)
    let (inertia, radius) = (0.4, 0.3_f64);
    let drum = format!("inertia = {inertia}\ntorque = {}", -1.5 * weight * radius);
    let history =
        run(&hanging("duration = 0.5, output = 0.1", &drum, "[0, 1, 0]", 60.0, [0.3, 0.0, -2.0], 5.0));
    let a = -0.5 * weight / (5.0 + inertia / radius.powi(2));
    let off = last(&history, "drum.payout") - 0.5 * a * 0.25;
    assert!(off.abs() <= 1e-3, "{off} m");
    let off = last(&history, "energy.imbalance").abs() / last(&history, "energy.supplied").abs();
    assert!(off <= 1e-3, "{off} of the work is unaccounted for");
    // a brake of twice the weight holds it, but for its creep
    let drum = format!("inertia = {inertia}\nbrake = {}", 2.0 * weight * radius);
    let history =
        run(&hanging("duration = 0.5, output = 0.1", &drum, "[0, 1, 0]", weight, [0.3, 0.0, -2.0], 5.0));
    let creep = 1e-3 / 3.0_f64.sqrt() * 0.5;
    let off = last(&history, "drum.payout") - creep;
    assert!(off.abs() <= 0.1 * creep, "{off} m");
}

#[test]
fn a_rope_climbs_to_the_next_layer_and_energy_is_kept() {
    // 5 turns a layer: the third begins at 10 turns
    let drum = "speed = -2\nramp = 0.5\nwidth = 0.1\npitch = 0.02\nwound = 15\nlayers = 4";
    let scene = hanging("duration = 4, output = 0.5", drum, "[0, 1, 0]", 49.0, [0.32, -0.03, -20.0], 5.0);
    let history = run(&scene);
    assert!(last(&history, "drum.layer") > at(&history, "drum.layer", 0.0), "no new layer");
    let off = last(&history, "energy.imbalance").abs() / last(&history, "energy.supplied").abs();
    assert!(off <= 1e-3, "{off} of the work is unaccounted for");
    // what left the free rope is on the drum
    let whole = |t: f64| at(&history, "drum.wound", t) + at(&history, "drum.payout", t);
    assert!((whole(4.0) - whole(0.0)).abs() <= 1e-9);
}

#[test]
fn a_drum_stops_when_it_is_empty_or_full() {
    let scene = |speed: f64, wound: f64| {
        let drum =
            format!("speed = {speed}\nramp = 0.5\nwidth = 0.1\npitch = 0.02\nwound = {wound}\nlayers = 2");
        hanging("duration = 10, output = 0.5", &drum, "[0, 1, 0]", 49.0, [0.32, -0.03, -20.0], 5.0)
    };
    let tau = std::f64::consts::TAU;
    let empty = run(&scene(2.0, 10.0));
    assert!((last(&empty, "drum.wound") - 3.0 * tau * 0.3).abs() <= 1e-2, "{}", last(&empty, "drum.wound"));
    let full = run(&scene(-2.0, 10.0));
    let rise = 0.75_f64.sqrt() * 0.02;
    let most = tau * 10.0 * 0.3 + tau * 5.0 * rise + tau / 2.0 * rise;
    assert!((last(&full, "drum.wound") - most).abs() <= 2e-2, "{} not {most}", last(&full, "drum.wound"));
}

#[test]
fn what_cannot_be_wound_is_refused_with_its_reason() {
    let scene = |drum: &str| hanging("duration = 1", drum, "[0, 1, 0]", 45.0, [0.9, 0.0, -1.4], 5.0);
    let good = scene("speed = 0.5");
    let cases = [
        (scene(""), "a drum needs `speed` or `turn`"),
        (scene("speed = 1\ninertia = 1"), "its moment is a result"),
        (scene("speed = 1\nwidth = 0.5"), "give the `pitch`"),
        (scene("speed = 1\nwidth = 0.5\npitch = 0.02"), "give `wound`"),
        (scene("speed = 1\nwound = 2"), "turns stay on an empty drum"),
        (scene("speed = 1\nlayers = 2"), "give the `width`"),
        (scene("torque = 1\nstop = 2"), "this drum has none"),
        (
            good.replace("{ wound = \"drum\" }", "{ over = \"drum\" }"),
            "begins and ends with `end` or `wound`",
        ),
        (good.replace("{ wound = \"drum\" }", "{ wound = \"drun\" }"), "`drun`"),
        (
            good.replace("{ wound = \"drum\" }, ", "{ end = [0, 0, 0] }, { over = \"drum\" }, "),
            "`drum` is a drum",
        ),
        (good.replace("{ wound = \"drum\" }, ", "{ end = [0, 0, 0] }, "), "begins and ends"),
        (good.replace("radius = 0.3", "radius = -0.3"), "radius"),
        (good.replace("radius = 0.3", "radius = 3"), "lies within the wheel"),
        (
            good.replace("mass = 2e-3", "gj = 1, rotary_inertia = 1e-4, torque_tension = 5, mass = 2e-3"),
            "can't be wound on a drum yet",
        ),
    ];
    for (text, reason) in cases {
        let message = refused(&text);
        assert!(message.contains(reason), "{message}\nbut not: {reason}");
    }
}

#[test]
fn a_scene_that_is_turned_runs_the_same() {
    let drum = "torque = -20\ninertia = 0.2\ndamping = 3\nwidth = 0.1\npitch = 0.02\nwound = 20";
    let from = [0.5, 0.1, -2.0];
    let (sin, cos) = 0.7_f64.sin_cos();
    let turned = [cos * from[0] - sin * from[1], sin * from[0] + cos * from[1], from[2]];
    let one = run(&hanging("duration = 1, output = 0.25", drum, "[0, 1, 0]", 49.0, from, 5.0));
    let axis = format!("[{}, {cos}, 0]", -sin);
    let other = run(&hanging("duration = 1, output = 0.25", drum, &axis, 49.0, turned, 5.0));
    for column in ["drum.angle", "drum.payout", "drum.fleet", "drum.torque", "rope.end.z"] {
        let (a, b) = (last(&one, column), last(&other, column));
        assert!((a - b).abs() <= 1e-6 * (1.0 + a.abs()), "{column}: {a} and {b}");
    }
    let x = cos * last(&one, "rope.end.x") - sin * last(&one, "rope.end.y");
    assert!((x - last(&other, "rope.end.x")).abs() <= 1e-6);
}

/// A drum on a body that swings, itself turned by a motor and braked.
const CARRIED: &str = r#"
    run = { duration = 1, output = 0.25 }
    [[elements]]
    type = "rigid_body"
    name = "jib"
    position = [1, 0, 0]
    mass = 50
    inertia = [2, 9, 9]
    points = { foot = [-1, 0, 0], head = [0.5, 0, 0] }
    [[elements]]
    type = "cable"
    name = "rope"
    section = { mass = 0.2, ea = "1 MN", axial_retardation_time = "5 ms" }
    tension = 49
    route = [{ wound = "drum" }, { end = [1.9, 0.05, -2] }]
    [[elements]]
    type = "point_mass"
    name = "load"
    marker = "rope.end"
    mass = 5
    [[constraints]]
    type = "spherical"
    name = "hinge"
    marker = "jib.foot"
    [[constraints]]
    type = "drum"
    name = "drum"
    marker = "jib.head"
    axis = [0, 1, 0.1]
    radius = 0.3
    torque = -10
    damping = 2
    inertia = 0.5
    wound = 30
    wound_tension = 49
    [[forces]]
    type = "gravity"
    [[records]]
    type = "drum"
    of = "drum"
    [[records]]
    type = "energy"
"#;

#[test]
fn a_drum_on_a_body_that_swings_keeps_energy() {
    let history = run(CARRIED);
    let size = last(&history, "energy.kinetic");
    let off = last(&history, "energy.imbalance").abs();
    assert!(size > 10.0 && off <= 2e-3 * size, "{off} of {size} J");
    assert!(last(&history, "drum.spin").abs() > 0.1);
}

#[test]
fn the_tangent_of_a_drum_is_the_derivative_of_its_forces() {
    let model = read(CARRIED).build().unwrap_or_else(|e| panic!("{e}"));
    let state = model.state();
    let some = |size: f64, k: f64| -> Vec<f64> {
        (0..state.v.len()).map(|i| size * (k * (i as f64 + 1.0)).sin()).collect()
    };
    let (v, a) = (some(1.0, 1.3), some(5.0, 2.7));
    let mut q = state.q.clone();
    retract(model.nodes(), &state.q, &some(0.01, 0.9), &mut q);
    let at = At { t: 0.0, q: &q, v: &v, a: &a, internal: &[], relaxed: None };
    for label in ["drum", "drum: fleet", "drum: stretch"] {
        let term = model.terms().iter().find(|t| t.label() == label).expect("the term");
        let off = check_tangent(term.as_ref(), model.nodes(), &at, Width::One);
        assert!(off <= 1e-6, "{label}: {off}");
    }
}
