//! Joints at the ends of cables with torsion mean what they mean on bodies.

use super::{last, place, run, scene};
use ropewalk::{ModesOptions, modes};
use std::f64::consts::TAU;

/// Rises from 0 to 1 over the load steps.
const SLOWLY: &str = "time = { table = { t = [0, 1], value = [0, 1] } }";

/// A rod along x, 1.6 m long, clamped at its start.
fn rod(elements: usize, ei: &str, more: &str) -> String {
    format!(
        r#"
        [run]
        analysis = "statics"
        [[elements]]
        type = "cable"
        name = "rod"
        points = [[0, 0, 0], [1.6, 0, 0]]
        elements = {elements}
        normal = [0, 0, 1]
        section = {{ mass = 1, ea = 1e4, ei = {ei}, gj = 0.8 }}
        [[constraints]]
        type = "clamp"
        name = "root"
        marker = "rod.start"
        {more}
        [[records]]
        type = "reaction"
        of = "root"
        [[records]]
        type = "position"
        of = "rod.end"
        [[records]]
        type = "orientation"
        of = "rod.end"
        [[records]]
        type = "along"
        of = "rod"
        what = "torque"
        at = "end"
        [[records]]
        type = "along"
        of = "rod"
        what = "tension"
        at = "end"
        [[records]]
        type = "along"
        of = "rod"
        what = "angle"
        at = "end"
        "#
    )
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[track_caller]
fn close(what: &str, found: f64, exact: f64, off: f64) {
    println!("{what}: {found}, exact {exact}");
    assert!((found - exact).abs() <= off, "{what}: {found} instead of {exact}");
}

/// A block on a rod, loaded by a force at an arm and a couple: what holds the rod at either end holds just that.
#[test]
fn a_welded_end_carries_force_and_moment() {
    let (force, couple) = ([-0.5, 0.8, 1.1], [0.6, -0.7, 0.4]);
    let more = format!(
        r#"
        [[elements]]
        type = "rigid_body"
        name = "block"
        position = [1.6, 0, 0]
        mass = 1
        inertia = [1, 1, 1]
        points = {{ hook = [0.1, 0.2, -0.3] }}
        [[constraints]]
        type = "weld"
        name = "grip"
        marker = "rod.end"
        to = "block"
        [[forces]]
        type = "point_force"
        marker = "block.hook"
        force = {force:?}
        {SLOWLY}
        [[forces]]
        type = "point_moment"
        marker = "block"
        moment = {couple:?}
        {SLOWLY}
        [[records]]
        type = "reaction"
        of = "grip"
        [[records]]
        type = "position"
        of = "block.hook"
        "#
    );
    for ei in ["1", "[1, 2.5]"] {
        let h = run(&rod(4, ei, &more), &[]);
        let (hook, end) = (place(&h, "block.hook"), place(&h, "rod.end"));
        let about = |x: [f64; 3]| {
            let lever = cross([0, 1, 2].map(|i| hook[i] - x[i]), force);
            [0, 1, 2].map(|i| couple[i] + lever[i])
        };
        let (at_root, at_grip) = (about([0.0; 3]), about(end));
        for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
            // the block pulls the rod, the ground holds it
            close("root", last(&h, &format!("root.f{axis}")), -force[i], 1e-8);
            close("root", last(&h, &format!("root.m{axis}")), -at_root[i], 1e-8);
            close("grip", last(&h, &format!("grip.f{axis}")), force[i], 1e-8);
            close("grip", last(&h, &format!("grip.m{axis}")), at_grip[i], 1e-8);
        }
        if ei == "1" {
            let [one, two] = ["rod.end.phi1", "rod.end.phi2"].map(|name| last(&h, name));
            let tangent = [two.sin(), -one.sin() * two.cos(), one.cos() * two.cos()];
            let along = |x: [f64; 3]| (0..3).map(|i| x[i] * tangent[i]).sum::<f64>();
            close("torque of the section", last(&h, "rod.end.torque"), along(at_grip), 1e-8);
        }
    }
}

/// A shaft of two cables: the second goes on from 1.6 m to 2.6 m and is driven at its end by a torque.
fn shaft(joint: &str) -> String {
    rod(
        4,
        "1",
        &format!(
            r#"
            [[elements]]
            type = "cable"
            name = "on"
            points = [[1.6, 0, 0], [2.6, 0, 0]]
            elements = 3
            section = {{ mass = 1, ea = 3e4, ei = 2, gj = 0.3 }}
            {joint}
            [[constraints]]
            type = "coordinate"
            name = "y"
            marker = "on.end"
            direction = [0, 1, 0]
            [[constraints]]
            type = "coordinate"
            name = "z"
            marker = "on.end"
            direction = [0, 0, 1]
            [[forces]]
            type = "point_force"
            marker = "on.end"
            force = [9, 0, 0]
            {SLOWLY}
            [[records]]
            type = "along"
            of = "on"
            what = "angle"
            at = "end"
            [[records]]
            type = "along"
            of = "on"
            what = "torque"
            at = "start"
            "#
        ),
    )
}

const DRIVE: &str = r#"
    [[constraints]]
    type = "direction"
    name = "bearing"
    marker = "on.end"
    twist = false
    [[forces]]
    type = "point_moment"
    marker = "on.end"
    torque = 0.5
    time = { table = { t = [0, 1], value = [0, 1] } }
"#;

#[test]
fn welds_and_universal_joints_between_cables_pass_the_torque_on() {
    let weld = "[[constraints]]\ntype = \"weld\"\nname = \"joint\"\nmarker = \"on.start\"\nto = \"rod.end\"";
    let universal = "[[constraints]]\ntype = \"universal\"\nname = \"joint\"\nmarker = \"on.start\"\nto = \"rod.end\"\naxis = [0, 1, 0]\naxis_to = [0, 0, 1]";
    for joint in [weld, universal] {
        let h = run(&shaft(&format!("{joint}\n{DRIVE}")), &[]);
        close("torque", last(&h, "rod.end.torque"), 0.5, 1e-9);
        close("torque", last(&h, "on.start.torque"), 0.5, 1e-9);
        close("angle", last(&h, "rod.end.angle"), 0.5 * 1.6 / 0.8, 1e-9);
        close("angle", last(&h, "on.end.angle"), 0.5 * 1.0 / 0.3, 1e-9);
        close("root", last(&h, "root.mx"), -0.5, 1e-9);
    }
}

/// The end is turned by one radian, and a joint in between lets the second cable turn.
#[test]
fn swivels_and_hinges_about_the_tangent_pass_no_torque_on() {
    let turned = r#"
        [[motions]]
        type = "table"
        name = "turn"
        t = [0, 1]
        angle = [0, 1]
        [[constraints]]
        type = "direction"
        name = "bearing"
        marker = "on.end"
        twist = false
        [[constraints]]
        type = "rotation"
        name = "drive"
        marker = "on.end"
        axis = [1, 0, 0]
        motion = "turn"
    "#;
    let hinge = "[[constraints]]\ntype = \"revolute\"\nname = \"joint\"\nmarker = \"on.start\"\nto = \"rod.end\"\naxis = [1, 0, 0]";
    let h = run(&shaft(&format!("{hinge}\n{turned}")), &[]);
    for name in ["rod.end.torque", "on.start.torque", "rod.end.angle", "on.end.angle"] {
        close(name, last(&h, name), 0.0, 1e-10);
    }
    // a spring about the tangent beside it: three in series
    let spring = format!(
        "{hinge}\n{turned}\n[[forces]]\ntype = \"rotational_spring\"\nname = \"spring\"\nmarker = \"on.start\"\nto = \"rod.end\"\naxis = [1, 0, 0]\nstiffness = 0.7"
    );
    let h = run(&shaft(&spring), &[]);
    let torque = 1.0 / (1.6 / 0.8 + 1.0 / 0.7 + 1.0 / 0.3);
    close("torque", last(&h, "rod.end.torque"), torque, 1e-9);
    close("torque", last(&h, "on.start.torque"), torque, 1e-9);
    close("angle", last(&h, "rod.end.angle"), torque * 1.6 / 0.8, 1e-9);
}

/// An end on a swivel that a torsion spring holds against space, twisted by its root.
#[test]
fn a_torsion_spring_holds_the_end_of_a_cable_on_a_swivel() {
    let more = format!(
        r#"
        [[constraints]]
        type = "clamp"
        name = "swivel"
        marker = "rod.end"
        twist = false
        [[forces]]
        type = "rotational_spring"
        name = "spring"
        marker = "rod.end"
        axis = [1, 0, 0]
        stiffness = 0.7
        [[forces]]
        type = "point_moment"
        marker = "rod.end"
        torque = 0.6
        {SLOWLY}
        "#
    );
    let h = run(&rod(4, "1", &more), &[]);
    // side by side they turn alike
    let angle = 0.6 / (0.8 / 1.6 + 0.7);
    close("angle", last(&h, "rod.end.angle"), angle, 1e-9);
    close("torque", last(&h, "rod.end.torque"), 0.8 * angle / 1.6, 1e-9);
}

/// A door on two cables turns like a pendulum: by its weight, by the bending of taut cables whose ends are built in, which
/// has the closed form below, and by their torsion.
#[test]
fn a_door_hangs_on_two_cables() {
    let (a, h, mass, inertia, ei, gj) = (0.4, 1.5, 3.0, 0.35, 0.05, 0.04);
    let tension = 0.5 * mass * 9.81;
    let k = f64::sqrt(tension / ei);
    let sideways = tension * k / (k * h - 2.0 * (0.5 * k * h).tanh());
    let exact = (2.0 * (a * a * sideways + gj / h) / inertia).sqrt();
    let cable = |name: &str, x: f64, n: usize| {
        format!(
            r#"
            [[elements]]
            type = "cable"
            name = "{name}"
            points = [[{x}, 0, {h}], [{x}, 0, 0]]
            tension = {tension}
            elements = {n}
            section = {{ mass = 1e-6, ea = 1e7, ei = {ei}, gj = {gj}, rotary_inertia = 1e-9 }}
            [[constraints]]
            type = "clamp"
            name = "{name}-top"
            marker = "{name}.start"
            [[constraints]]
            type = "weld"
            name = "{name}-grip"
            marker = "{name}.end"
            to = "door.{name}"
            "#
        )
    };
    let mut errors = Vec::new();
    for n in [16, 32] {
        let text = format!(
            r#"
            gravity = [0, 0, -9.81]
            {}
            {}
            [[elements]]
            type = "rigid_body"
            name = "door"
            position = [0, 0, -0.7]
            mass = {mass}
            inertia = [0.5, 0.6, {inertia}]
            points = {{ left = [-{a}, 0, 0.7], right = [{a}, 0, 0.7] }}
            [[forces]]
            type = "gravity"
            "#,
            cable("left", -a, n),
            cable("right", a, n)
        );
        let options = ModesOptions { count: 4, ..ModesOptions::default() };
        let found = modes(&scene(&text, &[]), &options).unwrap_or_else(|e| panic!("{e}"));
        let off = |omega: f64| (omega / exact - 1.0).abs();
        errors.push(found.modes.iter().map(|m| off(m.omega)).fold(f64::INFINITY, f64::min));
    }
    println!("{errors:?}");
    assert!(errors[1] < 4e-5 && errors[0] / errors[1] > 8.0, "{errors:?}");
}

/// A disc on a wire, turned by two radians and let go.
#[test]
fn a_disc_on_a_wire_turns_to_and_fro_in_time() {
    let text = format!(
        "{}\n[run]\nduration = 10\n[solver]\nstepping = {{ controlled = {{ tolerance = 1e-7 }} }}\n\
         [[records]]\ntype = \"orientation\"\nof = \"disc\"\n[[records]]\ntype = \"energy\"\n",
        include_str!("pendulum.toml")
            .replace("[0,0,0]]\nelements", "[0,0,0]]\nlaid_twist = 1\nelements")
            .replace("rotary_inertia = 1e-5", "rotary_inertia = 1e-9")
    );
    let h = run(&text, &[]);
    // from the disc at rest, which the twist of the wire leaves where two radians unwind
    let omega = f64::sqrt(0.05 / 2.0 / 0.02);
    let angles = h.column("disc.phi3").expect("an angle");
    for (t, angle) in h.times().iter().zip(angles) {
        let exact = 2.0 * (1.0 - (omega * t).cos());
        let off = (angle.abs() - exact).rem_euclid(TAU);
        let other = (angle.abs() + exact).rem_euclid(TAU);
        let off = [off, TAU - off, other, TAU - other].into_iter().fold(f64::INFINITY, f64::min);
        assert!(off < 1e-4, "{t}: {angle} {exact}");
    }
    assert!(last(&h, "energy.imbalance").abs() < 1e-6);
}
