//! What default settings promise: positions and forces right to their tolerances, whatever else is in the scene, in
//! whatever units it is written.

use ropewalk::scene::Format;
use ropewalk::{History, SceneFile, simulate};

/// Runs a scene.
#[track_caller]
fn run(text: &str) -> History {
    let file = SceneFile::parse(text, "accuracy", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
    simulate(file.scene()).unwrap_or_else(|e| panic!("{e}"))
}

/// The largest distance of two runs in these columns.
fn apart(a: &History, b: &History, columns: &[&str]) -> f64 {
    let mut worst = 0.0;
    for name in columns {
        let [a, b] = [a, b].map(|h| h.column(name).unwrap_or_else(|| panic!("no column {name}")));
        assert_eq!(a.len(), b.len());
        for (a, b) in a.iter().zip(b) {
            let off = (a - b).abs();
            // a NaN counts as the largest
            if !(off <= worst) {
                worst = off;
            }
        }
    }
    worst
}

const SWING: [&str; 3] = ["rod.end.x", "rod.end.y", "rod.end.z"];

/// A rigid pendulum of 1 m with something beside it that it isn't coupled with.
fn pendulum(beside: &str, solver: &str) -> String {
    format!(
        r#"
        [run]
        duration = "2 s"
        output = "0.05 s"
        [solver]
        {solver}
        [[elements]]
        type = "rigid_body"
        name = "rod"
        position = [0, 0, 0]
        mass = 1
        inertia = [1e-3, 0.08333, 0.08333]
        centre = [0.5, 0, 0]
        points = {{ end = [1, 0, 0] }}
        [[constraints]]
        type = "revolute"
        name = "hinge"
        marker = "rod"
        to = [0, 0, 0]
        axis = [0, 1, 0]
        [[forces]]
        type = "gravity"
        [[records]]
        type = "position"
        of = "rod.end"
        {beside}
        "#
    )
}

fn tether(length: f64) -> String {
    format!(
        r#"
        [[elements]]
        type = "cable"
        name = "tether"
        points = [[10, 0, 0], [10, 0, -{length}]]
        elements = 8
        section = {{ mass = 1.0, ea = 1e6, ei = 1.0 }}
        [[constraints]]
        type = "spherical"
        name = "top"
        marker = "tether.start"
        "#
    )
}

fn body(mass: f64) -> String {
    format!(
        r#"
        [[elements]]
        type = "rigid_body"
        name = "barge"
        position = [0, 5, 0]
        mass = {mass}
        inertia = [{mass}, {mass}, {mass}]
        "#
    )
}

const TIGHT: &str = "scheme = \"radau-iia-5\"\nstepping = { controlled = { tolerance = 1e-9 } }";

#[test]
fn what_a_part_is_not_coupled_with_does_not_change_its_error() {
    let exact = run(&pendulum("", TIGHT));
    let alone = apart(&run(&pendulum("", "")), &exact, &SWING);
    println!("alone {alone:.2e} m");
    assert!(alone < 3e-4, "{alone:e}");
    for beside in [tether(10.0), tether(1000.0), tether(10_000.0), body(1e3), body(1e7)] {
        for scheme in ["", "scheme = \"radau-iia-5\""] {
            let own = apart(&run(&pendulum("", scheme)), &exact, &SWING);
            let off = apart(&run(&pendulum(&beside, scheme)), &exact, &SWING);
            println!("{scheme} {own:.2e} {off:.2e}");
            // where both are about the tolerance of 1e-4 or below, other steps are luck
            assert!(off <= (1.1 * own).max(1.5e-4), "{beside}: {off:e} instead of {own:e}");
        }
    }
}

/// Pendulums from the size of a watch to that of a crane: the same share of their own length.
#[test]
fn accuracy_is_relative_to_a_part_s_own_length() {
    for (length, tolerance) in [(0.01, 1e-4), (1.0, 1e-4), (10.0, 1e-3)] {
        let scene = |solver: &str| {
            format!(
                r#"
                [run]
                duration = "{} s"
                output = "{} s"
                [solver]
                {solver}
                [[elements]]
                type = "point_mass"
                name = "bob"
                marker = [{length}, 0, 0]
                mass = 1
                [[constraints]]
                type = "distance"
                name = "rod"
                marker = "bob"
                to = [0, 0, 0]
                length = {length}
                [[forces]]
                type = "gravity"
                [[records]]
                type = "position"
                of = "bob"
                "#,
                5.0 * f64::sqrt(length),
                0.1 * f64::sqrt(length),
            )
        };
        let columns = ["bob.x", "bob.z"];
        let exact = run(&scene(TIGHT));
        let asked = run(&scene(&format!("stepping = {{ controlled = {{ tolerance = {tolerance} }} }}")));
        let ratio = apart(&asked, &exact, &columns) / length / tolerance;
        println!("{length} m: {ratio:.2} of the tolerance");
        assert!((0.01..=3.0).contains(&ratio), "{length} m: {ratio}");
    }
}

/// A load that hangs on a ship which is fixed in place: the ship's mass says nothing of the line.
#[test]
fn a_heavy_ship_that_stands_still_dilutes_no_error() {
    let scene = |ship: &str, top: &str, solver: &str| {
        format!(
            r#"
            [run]
            duration = "4 s"
            output = "0.1 s"
            [solver]
            {solver}
            [[elements]]
            type = "cable"
            name = "line"
            points = [[0, 0, 0], [30, 0, -40]]
            elements = 8
            section = {{ mass = 1.0, ea = 1e6, ei = 1.0, diameter = "0.02 m", axial_retardation_time = 0.01 }}
            [[elements]]
            type = "point_mass"
            name = "load"
            marker = "line.end"
            mass = 20
            [[forces]]
            type = "gravity"
            on = ["line", "load"]
            [[forces]]
            type = "drag"
            [water]
            {ship}
            [[constraints]]
            type = "spherical"
            name = "top"
            marker = "line.start"
            {top}
            [[records]]
            type = "along"
            of = "line"
            what = "tension"
            at = "start"
            "#
        )
    };
    let ship = |mass: f64| {
        format!(
            r#"
            [[elements]]
            type = "rigid_body"
            name = "ship"
            position = [0, 0, 0]
            mass = {mass}
            inertia = [{mass}, {mass}, {mass}]
            points = {{ sheave = [0, 0, 0] }}
            [[constraints]]
            type = "weld"
            name = "fix"
            marker = "ship"
            "#
        )
    };
    let columns = ["line.start.tension"];
    for scheme in ["", "scheme = \"radau-iia-5\""] {
        let exact = run(&scene("", "", TIGHT));
        let own = apart(&run(&scene("", "", scheme)), &exact, &columns);
        for mass in [2e4, 2e8] {
            let off = apart(&run(&scene(&ship(mass), "to = \"ship.sheave\"", scheme)), &exact, &columns);
            println!("{scheme} {mass:e} kg: {off:.3} N, without {own:.3} N");
            assert!(off <= 1.1 * own + 1e-3, "{mass:e} kg: {off} N instead of {own} N");
        }
    }
}

/// A hose towed in a circle, steady at last.
fn tow(ea: f64, elements: usize, duration: f64, solver: &str) -> String {
    format!(
        r#"
        [run]
        duration = "{duration} s"
        output = "0.25 s"
        from_equilibrium = true
        [solver]
        {solver}
        [water]
        [[elements]]
        type = "cable"
        name = "hose"
        points = [[25, 0, 0], [25, 0, -30]]
        elements = {elements}
        section = {{ mass = 0.5, flooded = 0.361, ea = {ea}, ei = 0.1, diameter = 0.023, displaced = 6.305e-5, axial_retardation_time = 0.01 }}
        [[motions]]
        type = "circle"
        name = "circle"
        speed = "5 kn"
        radius = 25
        heading = [0, 1, 0]
        ramp = "5 s"
        [[constraints]]
        type = "driving"
        name = "ship"
        marker = "hose.start"
        motion = "circle"
        [[forces]]
        type = "gravity"
        [[forces]]
        type = "buoyancy"
        [[forces]]
        type = "drag"
        [[forces]]
        type = "added_mass"
        [[records]]
        type = "along"
        of = "hose"
        what = "tension"
        at = "start"
        [[records]]
        type = "reaction"
        of = "ship"
        "#
    )
}

/// A hose towed steadily: the force at the ship is a constant, and that of the hose.
#[test]
fn forces_of_a_steady_tow_are_steady_and_those_of_the_hose() {
    let fixed = "stepping = { fixed = { h = 0.05 } }";
    for (ea, solver) in [
        (1e6, ""),
        (1e6, "constraints = \"ggl\""),
        (1e6, "scheme = \"radau-iia-5\""),
        (1e6, fixed),
        // where an interpolated state would pull with twice the force
        (1e8, ""),
        (1e8, fixed),
    ] {
        let h = run(&tow(ea, 20, 60.0, solver));
        let column = |name: &str| {
            let all = h.column(name).unwrap_or_else(|| panic!("no {name}"));
            all[all.len() - 41..].to_vec()
        };
        let (tension, force) = (column("hose.start.tension"), column("ship.magnitude"));
        let range = |x: &[f64]| {
            let most = x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let least = x.iter().copied().fold(f64::INFINITY, f64::min);
            (most - least) / most
        };
        let apart = tension.iter().zip(&force).fold(0.0, |m: f64, (t, f)| m.max((t / f - 1.0).abs()));
        println!("{ea:e} `{solver}`: {:.2} N ± {:.1e}, apart {apart:.1e}", force[0], range(&force));
        // of the stiffer hose to the tolerance of forces, to either side
        assert!(range(&force) < if ea > 1e7 { 2e-2 } else { 1e-2 }, "{ea:e} `{solver}`: {force:?}");
        // what is left between the two is the shear force of bending; twenty elements don't resolve how a stiffer hose bends
        // at the ship
        assert!(ea > 1e7 || apart < 5e-3 && range(&tension) < 1e-2, "{ea:e} `{solver}`: {apart:e}");
    }
}

/// What is left of an iteration is no noise in the estimate of the next step's error: a hundred times stiffer hose, where
/// steps were once cut to a thousandth.
#[test]
fn stiffness_along_a_hose_does_not_cut_steps() {
    let h = run(&tow(1e8, 80, 30.0, ""));
    println!("{:?}", h.counts);
    assert!(h.counts.steps < 1500 && h.counts.rejected < 150, "{:?}", h.counts);
}

/// True errors over the tolerance: mechanisms of bodies, where nothing forgets an error.
#[test]
fn errors_of_mechanisms_are_within_three_times_the_tolerance() {
    let rod = |name: &str, place: [f64; 2], angle: f64, motion: &str| {
        format!(
            r#"
            [[elements]]
            type = "rigid_body"
            name = "{name}"
            position = [{}, {}, 0]
            angles = [0, 0, {angle}]
            {motion}
            mass = 1
            inertia = [1e-4, 0.08333333333, 0.08333333333]
            centre = [0.5, 0, 0]
            points = {{ end = [1, 0, 0] }}
            "#,
            place[0], place[1]
        )
    };
    let joint = |kind: &str, name: &str, marker: &str, more: &str| {
        format!("[[constraints]]\ntype = \"{kind}\"\nname = \"{name}\"\nmarker = \"{marker}\"\n{more}\n")
    };
    let gravity = "[[forces]]\ntype = \"gravity\"\n";
    let hinge = "to = [0, 0, 0]\naxis = [0, 0, 1]";
    let half = f64::sqrt(0.5);
    let pendulum = rod("rod", [0.0; 2], 0.0, "") + &joint("revolute", "hinge", "rod", hinge) + gravity;
    // arms of equal length, which fold onto each other and pass through
    let crank = rod("crank", [0.0; 2], std::f64::consts::FRAC_PI_4, "angular_velocity = [0, 0, 4]")
        + &rod(
            "rod",
            [half, half],
            -std::f64::consts::FRAC_PI_4,
            &format!("angular_velocity = [0, 0, -4]\nvelocity = [{}, {}, 0]", -4.0 * half, 4.0 * half),
        )
        + &joint("revolute", "hinge", "crank", hinge)
        + &joint("revolute", "pin", "rod", "to = \"crank.end\"\naxis = [0, 0, 1]")
        + &joint("point_on_line", "line", "rod.end", "axis = [1, 0, 0]")
        + gravity;
    let top = r#"
        [[elements]]
        type = "rigid_body"
        name = "rod"
        position = [0, 0, 0]
        angular_velocity = [0, 150, -4.61538]
        mass = 15
        inertia = [0.234375, 0.46875, 0.234375]
        centre = [0, 1, 0]
        points = { end = [0, 1, 0] }
        [[constraints]]
        type = "spherical"
        name = "foot"
        marker = "rod"
        to = [0, 0, 0]
        [[forces]]
        type = "gravity"
        "#;
    let (across, down) = ("gravity = [0, -9.81, 0]", "");
    for (what, gravity, scene, duration) in [
        ("pendulum", across, pendulum.as_str(), 2.0),
        ("slider crank", across, crank.as_str(), 2.0),
        ("top", down, top, 1.0),
    ] {
        let with = |solver: &str| {
            run(&format!(
                "{gravity}\n[run]\nduration = \"{duration} s\"\noutput = \"0.05 s\"\n[solver]\n{solver}\n{scene}\n\
                 [[records]]\ntype = \"position\"\nof = \"rod.end\"\n"
            ))
        };
        let exact = with(TIGHT);
        for scheme in ["", "scheme = \"radau-iia-5\""] {
            for tolerance in [1e-3, 1e-4] {
                let asked =
                    with(&format!("{scheme}\nstepping = {{ controlled = {{ tolerance = {tolerance} }} }}"));
                let ratio = apart(&asked, &exact, &SWING) / tolerance;
                println!("{what} `{scheme}` {tolerance:e}: {ratio:.3} of the tolerance");
                assert!((0.01..=3.0).contains(&ratio), "{what} `{scheme}` {tolerance:e}: {ratio}");
            }
        }
    }
}
