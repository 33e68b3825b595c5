//! Cables with torsion that feed at a winch: twist travels with the material.

use super::{case, number, run};
use std::f64::consts::TAU;

const FED: &str = include_str!("fed.toml");

/// A body turns on a cable that is fed from an end that is held: its frequency falls as the cable grows (Bessel functions).
#[test]
fn a_torsional_pendulum_on_a_cable_that_grows() {
    let case = case("feeding_torsional_pendulum");
    let exact: Vec<[f64; 2]> = case["results"]["t_theta"]
        .as_array()
        .expect("rows")
        .iter()
        .map(|row| [number(&row[0]), number(&row[1])])
        .collect();
    for elements in [1, 4] {
        let h = run(FED, &[format!("n={elements}")]);
        let angle = h.column("wire.end.angle").expect("an angle");
        for [t, theta] in &exact {
            let row = h.times().iter().position(|x| (x - t).abs() < 1e-9).expect("a time");
            println!("{elements} elements, {t} s: {} {theta}, {:.1e}", angle[row], angle[row] - theta);
            assert!((angle[row] - theta).abs() < 1e-5, "{elements} elements, {t} s: {} {theta}", angle[row]);
        }
    }
    // the balance of energy has the power at the steps alone
    let imbalance = ["1e-6", "1e-9"].map(|tol| run(FED, &[format!("tol={tol}")]).summary().energy.imbalance.abs());
    println!("{imbalance:?}");
    assert!(imbalance[0] < 1e-4 && imbalance[1] < 1e-6, "{imbalance:?}");
}

/// Cable that is pulled over the end of a coil brings a turn per wrap: against a disc that doesn't turn, all of them stay in it.
#[test]
fn a_coil_brings_a_turn_per_wrap() {
    for (wrap, elements) in [(2.0, 1), (-1.5, 4)] {
        let set = [format!("wrap={wrap} m"), "disc=1e9".into(), format!("n={elements}")];
        let h = run(FED, &set);
        let (angle, torque) = (h.column("wire.end.angle").expect("angle"), h.column("wire.start.torque").expect("torque"));
        for (k, t) in h.times().iter().enumerate() {
            let exact = 2.0 + TAU * 0.5 * t / wrap;
            let moment = 0.05 * exact / (1.0 + 0.5 * t);
            assert!((angle[k] - exact).abs() < 1e-6, "{wrap} {t}: {} {exact}", angle[k]);
            assert!((torque[k] - moment).abs() < 1e-6, "{wrap} {t}: {} {moment}", torque[k]);
        }
        let energy = h.summary().energy;
        println!("{wrap}: {energy:?}");
        assert!(energy.imbalance.abs() < 1e-5, "{energy:?}");
    }
}

/// From a coil at one end to a drum at the other that takes cable with the twist that it has: the twist of the cable between them
/// goes towards a turn per wrap, as a first-order lag; the grip of the drum tells how much of it slips.
#[test]
fn twist_goes_along_with_what_is_reeled_in() {
    for grip in [0.5, 1e3] {
        let h = run(include_str!("through.toml"), &[format!("grip={grip} N m s")]);
        let torque = h.column("wire.50%.torque").expect("torque");
        let (gj, v, l, inflow) = (0.05, 0.5, 1.0, TAU / 2.0);
        let rate = (v + gj / grip) / l;
        let last = v * inflow / (l * rate);
        let mut worst = 0.0_f64;
        for (k, t) in h.times().iter().enumerate() {
            let off = torque[k] / gj - (last + (2.0 - last) * (-rate * t).exp());
            worst = if off.abs() <= worst { worst } else { off.abs() };
        }
        let energy = h.summary().energy;
        println!("{grip}: {worst:.1e}, {energy:?}");
        assert!(worst < 1e-5, "{grip}: {worst}");
        assert!(energy.imbalance.abs() < 1e-5 && (grip > 1.0 || energy.dissipated > 1e-3), "{energy:?}");
    }
}

/// A torque of 1 N m on EI = 1 N m² forms loops below 0.25 N, of which bending takes π² EI/L² in a cable of 20 m.
#[test]
fn a_cable_too_slack_for_its_torque_is_told() {
    let limit = 0.25 - std::f64::consts::PI.powi(2) / 400.0;
    for (share, loops) in [(1.02, false), (0.98, true)] {
        let h = run(include_str!("slack.toml"), &[format!("tension={} N", share * limit)]);
        let events = &h.summary().events;
        println!("{share}: {events:?}");
        let told: Vec<_> = events.iter().filter(|e| e.name.contains("may form a loop")).collect();
        assert_eq!(told.len(), usize::from(loops), "{events:?}");
        assert!(told.iter().all(|e| e.name.contains("`rope`") && e.name.contains("M^2/4EI = 0.250 N")), "{told:?}");
    }
    // let out while it runs: the instant at which tension has fallen to the limit
    let h = run(include_str!("slack.toml"), &["tension=1 N".into(), "out=2 mm".into()]);
    let when = h.summary().events.iter().find(|e| e.name.contains("may form a loop")).map(|e| e.t);
    // 20 m of 1 kN: 1 N is a strain of 1e-3, 20 mm; what is let out in 10 s is 2 mm per second
    let exact = 20.0 * (1.0 - limit) / 1e3 / 2e-3;
    println!("{when:?} {exact}");
    assert!(when.is_some_and(|t| (t - exact).abs() < 0.02), "{when:?} {exact}");
}
