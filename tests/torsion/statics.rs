//! Equilibria and their stability.

use super::{apart, case, last, number, place, run, scene, three};
use ropewalk::{ModesOptions, modes};
use ropewalk_core::modes as core;
use ropewalk_core::statics::StaticsOptions;

/// A rod with a couple at its end that is fixed in space becomes a helix: a stretch of one turn.
#[test]
fn a_dead_couple_makes_a_helix() {
    let exact = case("helix_end_couple_0");
    let mut errors = Vec::new();
    for n in [16, 32] {
        let h = run(include_str!("helix.toml"), &[format!("n={n}")]);
        errors.push(apart(place(&h, "rod.end"), three(&exact["results"]["tip"])));
        let twist = last(&h, "rod.end.angle") / number(&exact["results"]["total_twist"]) - 1.0;
        let moment = last(&h, "rod.start.torque") / number(&exact["results"]["twist_moment"]) - 1.0;
        println!("{n}: tip {:.1e}, twist {twist:.1e}, moment {moment:.1e}", errors[errors.len() - 1]);
        assert!(twist.abs() < 1e-6 && moment.abs() < 1e-6);
    }
    assert!(errors[0] < 5e-5 && (errors[0] / errors[1]).log2() > 3.7, "{errors:?}");
}

/// Five turns in each of four elements, and back again.
#[test]
fn an_end_is_driven_through_twenty_turns_and_back() {
    let h = run(include_str!("turns.toml"), &[]);
    let (angle, torque) =
        (h.column("rod.end.angle").expect("angle"), h.column("rod.start.torque").expect("torque"));
    let most = angle.iter().fold(0.0_f64, |m, a| m.max(*a));
    assert!((most / (40.0 * std::f64::consts::PI) - 1.0).abs() < 1e-10, "{most}");
    let exact = number(&case("turns")["results"]["M_at_20_turns"]);
    for (a, m) in angle.iter().zip(torque) {
        assert!((m - 0.8 * a).abs() < 1e-10 * exact, "{a} {m}");
    }
    assert!(last(&h, "rod.end.angle").abs() < 1e-9 && last(&h, "rod.start.torque").abs() < 1e-9);
    let middle = place(&h, "rod@50%");
    assert!(middle[1].abs() < 1e-9 && middle[2].abs() < 1e-9, "{middle:?}");
}

/// However few equilibria are asked for, a driven angle goes all its way between them: twist keeps its turns, and a body doesn't
/// end half a turn off, where its joint is closed too.
#[test]
fn turns_are_kept_however_few_steps_there_are() {
    for steps in [2, 5, 40, 160] {
        let text = include_str!("turns.toml").replace("steps = 640", &format!("steps = {steps}"));
        let h = run(&text, &[]);
        let angle = h.column("rod.end.angle").expect("angle");
        assert_eq!(angle.len(), steps + 1);
        for (k, angle) in angle.iter().enumerate() {
            // the motion's table is joined by a parabola
            let t = 2.0 * k as f64 / steps as f64;
            let exact = 40.0 * std::f64::consts::PI * t * (2.0 - t);
            assert!((angle - exact).abs() < 1e-9, "{steps} steps: {angle} for {exact}");
        }
    }
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("yaw.csv");
    std::fs::write(&file, "t [s],yaw [rad]\n0,0\n1,10\n").expect("a table");
    let hinge = r#"
        [[motions]]
        type = "table"
        name = "turn"
        t = [0, 1]
        angle = [0, 10]
        [[constraints]]
        type = "revolute"
        name = "hinge"
        marker = "b"
        axis = [0, 0, 1]
        [[constraints]]
        type = "rotation"
        name = "drive"
        marker = "b"
        axis = [0, 0, 1]
        motion = "turn"
        "#;
    let vessel = format!(
        "[[constraints]]\ntype = \"vessel\"\nname = \"steered\"\nmarker = \"b\"\nfile = {:?}\n",
        file.display().to_string()
    );
    let body = r#"
        run = { analysis = "statics", duration = 1 }
        statics = { steps = 2 }
        [[elements]]
        type = "rigid_body"
        name = "b"
        position = [0, 0, 0]
        mass = 1
        inertia = [1, 1, 1]
        [[records]]
        type = "orientation"
        of = "b"
        "#;
    // a vessel starts at rest: the cubic t² (3 - t)/2
    for (driven, half) in [(hinge, 5.0), (&vessel, 10.0 * 0.3125)] {
        let h = run(&format!("{body}{driven}"), &[]);
        let yaw = h.table.columns.iter().find(|c| c.name.ends_with("phi3")).expect("an angle");
        for (yaw, turned) in yaw.values.iter().zip([0.0, half, 10.0]) {
            assert!((yaw - turned).sin().abs() < 1e-9 && (yaw - turned).cos() > 0.0, "{yaw} for {turned}");
        }
    }
}

/// Greenhill: the twist at which a clamped rod gives way sideways, under end forces of both signs.
#[test]
fn a_twisted_rod_gives_way_at_the_critical_moment() {
    for (name, force) in
        [("greenhill_clamped_P0", 0.0), ("greenhill_clamped_P5", -5.0), ("greenhill_clamped_P-50", 50.0)]
    {
        let exact = number(&case(name)["results"]["M_cr"]);
        let grows = |moment: f64| {
            let set = [format!("twist={moment}"), format!("force={force}")];
            let model = scene(include_str!("green.toml"), &set).build().unwrap_or_else(|e| panic!("{e}"));
            let (mut state, options) = (model.state(), StaticsOptions::default());
            assert!(core::in_balance(&model, &mut state, &options, None).expect("a balance"), "{name}");
            let found = core::modes(&model, &state, &options, None, 4, &mut |_, _, _| {
                std::ops::ControlFlow::Continue(())
            });
            found.expect("modes").modes.iter().any(|m| m.is_unstable())
        };
        let (mut low, mut high) = (0.99 * exact, 1.01 * exact);
        assert!(!grows(low) && grows(high), "{name}");
        while high - low > 1e-5 * exact {
            let middle = 0.5 * (low + high);
            if grows(middle) { high = middle } else { low = middle }
        }
        println!("{name}: {:.1e}", low / exact - 1.0);
        assert!((low / exact - 1.0).abs() < 5e-4, "{name}: {low} {exact}");
    }
}

/// A curved cantilever that is loaded out of its plane.
#[test]
fn a_bend_of_45_degrees_is_bent_out_of_its_plane() {
    let text = include_str!("../../studies/verification/bend45_cantilever.toml");
    let tip = |gj: f64, force: f64, n: usize| {
        let text = text.replace("elements = 16", &format!("elements = {n}"));
        place(&run(&text, &[format!("gj={gj}"), format!("force={force}")]), "bend.end")
    };
    for (name, gj, force) in [
        ("bend45_GJ833333_P300", 833_333.333_333_333_4, 300.0),
        ("bend45_GJ833333_P600", 833_333.333_333_333_4, 600.0),
        ("bend45_GJ704000_P450", 704_000.0, 450.0),
    ] {
        let exact = three(&case(name)["results"]["tip"]);
        let errors = [8, 16].map(|n| apart(tip(gj, force, n), exact));
        println!("{name}: {errors:?}");
        assert!(errors[1] < 5e-4 && (errors[0] / errors[1]).log2() > 3.5, "{name}: {errors:?}");
    }
}

/// A strip loaded at an angle to its principal axes bends about both and twists.
#[test]
fn the_princeton_beam_bends_about_both_axes_and_twists() {
    let text = include_str!("../../studies/verification/princeton_beam.toml");
    for (load, angles, most) in
        [(8.896, &[0, 15, 30, 45, 60, 75, 90][..], 2e-6), (13.345, &[0, 45, 90][..], 6e-6)]
    {
        for angle in angles {
            let exact = &case(&format!("princeton_P{load}_angle{angle}"))["results"]["tip_displacement"];
            let (sin, cos) = f64::from(*angle).to_radians().sin_cos();
            let h = run(text, &[format!("force=[0, {}, {}]", load * cos, load * sin)]);
            let tip = place(&h, "beam.end");
            let off = apart([tip[0] - 0.508, tip[1], tip[2]], three(exact));
            println!("{load} N at {angle}: {off:.1e}");
            assert!(off < most, "{load} {angle}: {off}");
        }
    }
}

/// A close-coiled spring is as stiff as its wire twists and bends; drawn it turns, and turned it is drawn.
#[test]
fn a_helical_spring_is_as_stiff_as_its_wire() {
    let exact = &case("helical_spring_5deg")["results"]["C"];
    let (force, couple, mut errors) = (1e-4, 1e-4, Vec::new());
    for n in [32, 64] {
        // where the axis of the spring goes, and by how much the arm turns about it
        let with = |f: f64, m: f64| {
            let set = ["n", "f", "m"].iter().zip([n.to_string(), f.to_string(), m.to_string()]);
            let h = run(
                include_str!("spring.toml"),
                &set.map(|(name, value)| format!("{name}={value}")).collect::<Vec<_>>(),
            );
            [place(&h, "arm.axis")[2], last(&h, "arm.phi3")]
        };
        // small strains, both ways
        let [drawn, pressed, turned, back] =
            [with(force, 0.0), with(-force, 0.0), with(0.0, couple), with(0.0, -couple)];
        let off = |a: f64, b: f64, by: f64, exact: &serde_json::Value| {
            ((a - b) / (2.0 * by * number(exact)) - 1.0).abs()
        };
        errors.push([
            off(drawn[0], pressed[0], force, &exact[0][0]),
            off(drawn[1], pressed[1], force, &exact[0][1]),
            off(turned[0], back[0], couple, &exact[1][0]),
            off(turned[1], back[1], couple, &exact[1][1]),
        ]);
    }
    println!("{errors:?}");
    for (k, most) in [5e-4, 5e-3, 5e-3, 5e-4].into_iter().enumerate() {
        assert!(errors[1][k] < most && (errors[0][k] / errors[1][k]).log2() > 3.4, "{k}: {errors:?}");
    }
}

/// The centre line of a rod of length `l` that holds a loop in its middle, as a table of `n` steps: both ends lie along x.
/// Of the tangent's angles `cos θ = 1 - 2 (1 - m²) sech²(√(1 - m²) s)`, `ψ' = M/(1 + cos θ)`; lengths by `√(B/T)`.
fn writhed(m: f64, l: f64, n: usize) -> Vec<[f64; 3]> {
    let k = (1.0 - m * m).sqrt();
    let rate = |s: f64, x: &[f64; 4]| {
        let c = 1.0 - 2.0 * (k / (k * s).cosh()).powi(2);
        let sine = (1.0 - c * c).max(0.0).sqrt();
        [c, sine * x[3].cos(), sine * x[3].sin(), 2.0 * m / (1.0 + c)]
    };
    let (fine, h) = (20, l / (20 * n) as f64);
    // from the middle to one end, by the classical Runge-Kutta method; the other half is its mirror image
    let (mut x, mut half) = ([0.0; 4], vec![[0.0; 3]]);
    let ahead = |x: &[f64; 4], k: &[f64; 4], h: f64| -> [f64; 4] { std::array::from_fn(|i| x[i] + h * k[i]) };
    for step in 0..fine * n / 2 {
        let s = h * step as f64;
        let one = rate(s, &x);
        let two = rate(s + 0.5 * h, &ahead(&x, &one, 0.5 * h));
        let three = rate(s + 0.5 * h, &ahead(&x, &two, 0.5 * h));
        let four = rate(s + h, &ahead(&x, &three, h));
        x = std::array::from_fn(|i| x[i] + h / 6.0 * (one[i] + 2.0 * (two[i] + three[i]) + four[i]));
        if (step + 1) % fine == 0 {
            half.push([x[0], x[1], x[2]]);
        }
    }
    let mirrored = half.iter().skip(1).rev().map(|[x, y, z]| [-x, -y, *z]);
    mirrored.chain(half.iter().copied()).collect()
}

/// A localised loop in a long rod: tension and torque follow from how far its ends have come and turned. Held like that it
/// is unstable for m < 1/√2, where less tension would do for a longer way, and in a long rod it may be anywhere: two
/// coordinates of its middle are held.
#[test]
fn a_loop_in_a_long_rod_has_its_tension_and_torque() {
    for (name, tension, torque) in [("writhe_m0.6", 2e-4, 1e-5), ("writhe_m0.3", 2e-4, 1e-5)] {
        let reference = case(name);
        let number = |group: &str, name: &str| number(&reference[group][name]);
        let (m, l) = (number("parameters", "m"), number("parameters", "L"));
        let curve = writhed(m, l, 512);
        let way = l - (curve[512][0] - curve[0][0]);
        assert!((way - number("results", "D")).abs() < 1e-8, "{way}");
        let exact = number("results", "M");
        let mut errors = Vec::new();
        for n in [128, 256] {
            let text = include_str!("writhe.toml").replace("curve = []", &format!("curve = {curve:?}"));
            let h = run(&text, &[format!("n={n}"), format!("twist={} rad/m", exact / 0.8)]);
            errors.push([last(&h, "end.fx") - 1.0, last(&h, "rod.start.torque") / exact - 1.0]);
            assert!(last(&h, "x.fx").abs() < 1e-9 && last(&h, "y.fy").abs() < 1e-9, "held for nothing");
        }
        println!("{name}: {errors:?}");
        assert!(errors[1][0].abs() < tension && errors[1][1].abs() < torque, "{name}: {errors:?}");
    }
}

#[test]
fn torsional_modes_are_those_of_a_bar() {
    let exact = &case("torsion_bar_modes")["results"]["omega"];
    let options = ModesOptions { count: 60, ..ModesOptions::default() };
    let found = modes(&scene(include_str!("bar.toml"), &[]), &options).unwrap_or_else(|e| panic!("{e}"));
    let turns: Vec<f64> = found.modes.iter().filter(|m| m.directions[3] > 0.99).map(|m| m.omega).collect();
    for (k, most) in [2e-7, 2e-5, 2e-4].into_iter().enumerate() {
        let off = turns[k] / number(&exact[k]) - 1.0;
        println!("mode {}: {off:.1e}", k + 1);
        assert!(off.abs() < most, "{k}: {off}");
    }
}

/// The inertia of the wire is that of its elements, halfway between consistent and lumped: of what turns with a linear
/// twist it is too large by 1/12 n² of its own.
#[test]
fn a_body_on_a_wire_turns_to_and_fro() {
    let period = number(&case("torsional_pendulum_0")["results"]["period"]);
    for (n, most) in [(4, 2.7e-6), (32, 5e-8)] {
        let options = ModesOptions { count: 12, ..ModesOptions::default() };
        let found = modes(&scene(include_str!("pendulum.toml"), &[format!("n={n}")]), &options)
            .unwrap_or_else(|e| panic!("{e}"));
        let omega = std::f64::consts::TAU / period;
        let off = found
            .modes
            .iter()
            .filter(|m| m.directions[3] > 0.999)
            .map(|m| (m.omega / omega - 1.0).abs())
            .fold(f64::INFINITY, f64::min);
        println!("{n}: {off:.1e}");
        assert!(off < most, "{n}: {off}");
    }
}
