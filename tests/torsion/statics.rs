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

/// A close-coiled spring: as stiff as its wire twists and bends, and turning as it is drawn.
#[test]
fn a_helical_spring_is_as_stiff_as_its_wire() {
    let exact = &case("helical_spring_5deg")["results"]["C"];
    let (force, mut errors) = (1e-4, Vec::new());
    for n in [32, 64] {
        let with = |f: f64| {
            place(&run(include_str!("spring.toml"), &[format!("n={n}"), format!("f={f}")]), "arm.axis")
        };
        // small strains, both ways
        let compliance = (with(force)[2] - with(-force)[2]) / (2.0 * force);
        errors.push((compliance / number(&exact[0][0]) - 1.0).abs());
    }
    println!("{errors:?}");
    assert!(errors[1] < 5e-4 && (errors[0] / errors[1]).log2() > 3.4, "{errors:?}");
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
