//! Damping of bending where sections turn: shafts and strips.

use super::scene;
use ropewalk::{Modal, ModesOptions, modes};
use std::f64::consts::PI;

/// A bar of 1 m, clamped at one end, seen from a frame that turns with it at `turn` about its axis.
fn bar(section: &str, turn: f64) -> Modal {
    let text = format!(
        r#"
        gravity = [0, 0, 0]
        run = {{ analysis = "statics", frame = {{ omega = [{turn}, 0, 0] }} }}
        [[elements]]
        type = "cable"
        name = "bar"
        points = [[0, 0, 0], [1, 0, 0]]
        elements = 12
        normal = [0, 1, 0]
        section = {{ mass = 1, ea = 1e6, gj = 1, {section} }}
        [[constraints]]
        type = "clamp"
        name = "hub"
        marker = "bar.start"
        "#
    );
    modes(&scene(&text, &[]), &ModesOptions { count: 4, ..ModesOptions::default() })
        .unwrap_or_else(|e| panic!("{e}"))
}

/// Square of the first wave number of a cantilever of 1 m.
const FIRST: f64 = 3.516_015_268_5;

/// Seen from a shaft that turns at `Ω` its whirls swing with `ω ∓ Ω`, and damping inside of it lets them grow by
/// `-η ω (ω ∓ Ω)/2`: beyond the critical speed the one that goes ahead is driven on.
#[test]
fn damping_inside_a_shaft_drives_it_on_beyond_its_critical_speed() {
    let eta = 1e-3;
    for turn in [0.0, 2.0, 3.0, 4.0, 5.0] {
        let found = bar(&format!("ei = [1, 1], bending_retardation_time = {eta}"), turn);
        assert_eq!(found.unstable, turn > FIRST, "{turn}: {:?}", found.warnings);
        for mode in found.modes.iter().filter(|m| m.omega < FIRST + turn + 0.1) {
            let ahead = (mode.omega - (FIRST - turn).abs()).abs() < 1e-3;
            let seen = if ahead { FIRST - turn } else { FIRST + turn };
            assert!((mode.omega - seen.abs()).abs() < 1e-3, "{turn}: {} {seen}", mode.omega);
            let exact = -0.5 * eta * FIRST * seen;
            assert!((mode.growth / exact - 1.0).abs() < 1e-3, "{turn}: {} {exact}", mode.growth);
        }
        assert!(!found.modes.is_empty());
    }
}

/// A shaft of which both ends turn freely spins as it likes, which is no instability though hardly anything has that inertia.
#[test]
fn what_spins_freely_in_a_frame_that_turns_is_not_unstable() {
    for (turn, elements) in [(9.8, 32), (9.0, 8), (3.0, 16), (1.0, 16)] {
        let text = format!(
            r#"
            gravity = [0, 0, 0]
            run = {{ analysis = "statics", frame = {{ omega = [{turn}, 0, 0] }} }}
            [[elements]]
            type = "cable"
            name = "shaft"
            points = [[0, 0, 0], [1, 0, 0]]
            elements = {elements}
            normal = [0, 1, 0]
            section = {{ mass = 1, ea = 1e6, ei = [1, 1], gj = 100, bending_retardation_time = 1e-3 }}
            [[constraints]]
            type = "spherical"
            name = "a"
            marker = "shaft.start"
            [[constraints]]
            type = "point_on_line"
            name = "b"
            marker = "shaft.end"
            axis = [1, 0, 0]
            "#
        );
        let options = ModesOptions { count: 20, ..ModesOptions::default() };
        let found = modes(&scene(&text, &[]), &options).unwrap_or_else(|e| panic!("{e}"));
        assert!(!found.unstable, "{turn}: {:?}", found.warnings);
        let first = found.modes.iter().find(|m| !m.rigid).expect("it swings");
        let exact = PI * PI - turn;
        assert!((first.omega - exact).abs() < 2e-3, "{turn}: {} {exact}", first.omega);
    }
}

/// A strip is damped by its stiffness about either axis: ratios of `η ω/2` edgewise as well as flat.
#[test]
fn a_strip_is_damped_about_both_axes() {
    let eta = 1e-3;
    let found = bar(&format!("ei = [4, 1], bending_retardation_time = {eta}"), 0.0);
    for (mode, omega) in found.modes.iter().zip([FIRST, 2.0 * FIRST]) {
        assert!((mode.omega / omega - 1.0).abs() < 1e-3, "{} {omega}", mode.omega);
        let exact = 0.5 * eta * omega;
        assert!((mode.damping_ratio() / exact - 1.0).abs() < 2e-3, "{} {exact}", mode.damping_ratio());
    }
}
