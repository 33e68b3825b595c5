//! Twist that rings let through and drums take in.

use super::{BLOCK, build, last, observed, random, ringed, wrung};
use crate::reeving::{at, run};
use ropewalk_core::testing::check_constraint;
use ropewalk_core::{At, retract};

/// Its torque turns a rope that is bent in a ring out of the plane, as far as its bending stiffness lets it: by `β = M tan(φ/2)/√(EI T)` on
/// each side for a deflection `φ`. That takes `2 β tan(φ/2)` of the twist.
#[test]
fn a_ring_lets_twist_through() {
    let (records, columns) = observed(2, &[]);
    let scene = format!(
        r#"
            run = {{ analysis = "statics", duration = 1 }}
            statics = {{ steps = 10 }}
            [[elements]]
            type = "cable"
            name = "rope"
            section = {{ mass = 1, ea = 1e6, ei = 2, gj = 5, rotary_inertia = 1e-3 }}
            tension = 1000
            elements = 60
            route = [{{ end = [-2, 0, 0] }}, {{ through = "ring" }}, {{ end = [0, 0, -2] }}]
            [[constraints]]
            type = "ring"
            name = "ring"
            marker = [0, 0, 0]
            {}
            {records}
            "#,
        wrung([0.0, 0.0, -1.0], 1.0)
    );
    let history = run(&scene);
    let length = 4.0 / 1.001;
    let exact = 1.0 / (1.0 + 2.0 * 5.0 / (length * (2.0 * 1000.0_f64).sqrt()));
    for column in &columns {
        let found = last(&history, column) * length;
        println!("{column} {found} {exact}");
        assert!((found - exact).abs() < 2e-3, "{column}: {found} {exact}");
    }
}

#[test]
fn a_drum_takes_twist_in_and_gives_it_back() {
    let (records, columns) = observed(2, &["wheel"]);
    let history = run(&format!("{DRUM}{records}"));
    assert!((at(&history, "load.z", 4.0) + 3.0).abs() > 1.0);
    for column in &columns {
        let off =
            history.column(column).expect("a column").iter().fold(0.0_f64, |m, x| m.max((x - 2.0).abs()));
        println!("{column}: {off:e}");
        assert!(off < 1e-5, "{column}: {off}");
    }
    let imbalance =
        history.column("energy.imbalance").expect("energy").iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    println!("{imbalance}");
    assert!(imbalance < 0.1, "{imbalance}");
}

/// A load on a twisted rope from a drum, hoisted and lowered.
pub(super) const DRUM: &str = r#"
        run = { duration = 8, output = 0.5 }
        [[motions]]
        type = "table"
        name = "wind"
        t = [0, 4, 8]
        angle = [0, -4, 0]
        ends = "at-rest"
        [[elements]]
        type = "cable"
        name = "rope"
        section = { mass = 0.1, ea = 1e6, gj = 5, rotary_inertia = 1e-3, axial_retardation_time = 0.01 }
        tension = 1000
        laid_twist = 2
        elements = 2
        route = [{ wound = "drum" }, { over = "wheel" }, { end = [3.3, 0, -3] }]
        [[elements]]
        type = "rigid_body"
        name = "load"
        position = [3.3, 0, -3]
        mass = 101.9
        inertia = [1e9, 1e9, 1e9]
        [[constraints]]
        type = "weld"
        name = "tie"
        marker = "rope.end"
        to = "load"
        [[constraints]]
        type = "drum"
        name = "drum"
        marker = [0, 0, 0]
        axis = [0, 1, 0]
        radius = 0.3
        turn = "wind"
        [[constraints]]
        type = "sheave"
        name = "wheel"
        marker = [3, 0, 0]
        axis = [0, 1, 0]
        radius = 0.3
        [[forces]]
        type = "gravity"
        [[records]]
        type = "position"
        of = "load"
        [[records]]
        type = "energy"
    "#;

#[test]
fn equations_of_ends_with_torsion_are_differentiated() {
    let ring = ringed(BLOCK, "[2, 1, 0.2]");
    for (text, names) in [(&*ring, vec!["wheel", "ring: torsion"]), (DRUM, vec!["drum.rope"])] {
        let model = build(text);
        let (state, nodes) = (model.state(), model.nodes());
        let mut next = random(7.0);
        let d: Vec<f64> = state.v.iter().map(|_| 0.02 * next()).collect();
        let v: Vec<f64> = state.v.iter().map(|_| next()).collect();
        let mut q = state.q.clone();
        retract(nodes, &state.q, &d, &mut q);
        for name in names {
            let mine = model.constraints().iter().filter(|c| c.name() == name);
            assert!(
                mine.clone().count() > 0,
                "no {name}: {:?}",
                model.constraints().iter().map(|c| c.name()).collect::<Vec<_>>()
            );
            for constraint in mine {
                for mode in [0.0, 1.0, 2.0] {
                    let mut internal = state.internal.clone();
                    if name == "wheel" {
                        internal[0] = mode;
                    }
                    let now = At {
                        t: 0.3,
                        q: &q,
                        v: &v,
                        a: &vec![0.0; v.len()],
                        internal: &internal,
                        relaxed: None,
                    };
                    let off = check_constraint(constraint.as_ref(), nodes, &now);
                    assert!(off < 1e-5, "{name}, {mode}: {off}");
                }
            }
        }
    }
}

#[test]
fn a_ring_shows_the_tension_of_a_laid_rope() {
    let scene = format!(
        r#"
        run = {{ analysis = "statics", duration = 1 }}
        statics = {{ steps = 4 }}
        [[elements]]
        type = "cable"
        name = "rope"
        section = {{ mass = 1, ea = 1e6, ei = 2, gj = 50, rotary_inertia = 1e-3, torque_tension = 200 }}
        tension = 2000
        laid_twist = 3
        elements = 10
        route = [{{ end = [-2, 0, 0] }}, {{ through = "ring" }}, {{ end = [0, 0, -2] }}]
        [[constraints]]
        type = "ring"
        name = "ring"
        marker = [0, 0, 0]
        {}
        [[records]]
        type = "along"
        of = "rope.1"
        what = "tension"
        at = "end"
        [[records]]
        type = "force"
        of = "ring"
        "#,
        wrung([0.0, 0.0, -1.0], 0.5)
    );
    let history = run(&scene);
    let tension = last(&history, "rope.1.end.tension");
    for column in ["ring.in.tension", "ring.out.tension"] {
        let shown = last(&history, column);
        assert!((shown / tension - 1.0).abs() < 5e-3, "{column}: {shown} {tension}");
    }
}

#[test]
fn what_turned_on_its_drum_leaves_it_with_its_energy_accounted_for() {
    // wound and paid out with another twist all the time, as its load swings
    let text =
        format!("{DRUM}{}", observed(2, &["wheel"]).0).replace("[1e9, 1e9, 1e9]", "[0.05, 0.05, 0.05]");
    let imbalance = |tolerance: f64| {
        let history =
            run(&format!("{text}[solver]\nstepping = {{ controlled = {{ tolerance = {tolerance} }} }}\n"));
        let twist = history.column("rope.1.start.twist").expect("a twist");
        assert!(twist.iter().any(|k| *k < 0.0), "it swings: {twist:?}");
        // 9 J are lost as twist leaves the drum
        history.column("energy.imbalance").expect("energy").iter().fold(0.0_f64, |m, x| m.max(x.abs()))
    };
    let off = [1e-3, 1e-4].map(imbalance);
    println!("{off:?}");
    assert!(off[1] < 0.01, "{off:?}");
}
