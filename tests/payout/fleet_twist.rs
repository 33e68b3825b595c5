//! Ropes that are twisted as they come to a sheave by a fleet angle: `fleet_twist`.

use super::reeving::{at, refused, run};
use super::torsion::{BLOCK, build, last, random, term};
use ropewalk_core::rotation::{cross, matrix, transposed_times};
use ropewalk_core::testing::{check_tangent, dense};
use ropewalk_core::{At, Model, NodeKind, Weights, Width, dot, retract};

const FLEET: f64 = 0.05;
const LENGTH: f64 = 40.0;
const HOISTED: f64 = 2.0;
const WEIGHT: f64 = 1e4;
const DIAMETER: f64 = 0.02;

/// A load on a swivel hangs over a wheel on a long rope, whose other end comes to the wheel along its own line: by these shares of the
/// way every ten seconds, and then it rests.
fn hoisting(side: f64, gj: f64, way: &[f64], wheel: &str) -> String {
    let (sin, cos) = (side * FLEET.sin(), FLEET.cos());
    let end = 10 * (way.len() - 1) + 5;
    let times: Vec<f64> = (0..=2 * end).map(|k| 0.5 * k as f64).collect();
    let smooth = |t: f64| {
        let (k, u) = ((t / 10.0) as usize, (t / 10.0).fract());
        let [from, to] = [k, k + 1].map(|k| way[k.min(way.len() - 1)]);
        from + (to - from) * u.powi(3) * (10.0 - 15.0 * u + 6.0 * u * u)
    };
    let of = |by: f64| times.iter().map(|&t| by * smooth(t)).collect::<Vec<_>>();
    let [x, y] = [of(HOISTED * cos), of(-HOISTED * sin)];
    format!(
        r#"
        run = {{ duration = {end}, output = 0.5 }}
        [[motions]]
        type = "table"
        name = "way"
        t = {times:?}
        x = {x:?}
        y = {y:?}
        ends = "at-rest"
        [[elements]]
        type = "rigid_body"
        name = "load"
        position = [0.3, 0, -5]
        mass = {}
        inertia = [10, 10, 10]
        [[elements]]
        type = "cable"
        name = "rope"
        section = {{ mass = 0.1, ea = 1e7, gj = {gj}, diameter = {DIAMETER}, rotary_inertia = 1e-5, torsional_retardation_time = 0.2, axial_retardation_time = 0.01 }}
        tension = {WEIGHT}
        normal = [0, 0, 1]
        elements = 4
        route = [{{ end = [{}, {}, 0.3] }}, {{ over = "wheel" }}, {{ end = "load" }}]
        [[constraints]]
        type = "driving"
        name = "led"
        marker = "rope.start"
        motion = "way"
        [[constraints]]
        type = "perpendicular"
        name = "held"
        marker = "rope.start"
        axis = [0, 1, 0]
        axis_to = [0, 0, 1]
        [[constraints]]
        type = "sheave"
        name = "wheel"
        marker = [0, 0, 0]
        axis = [0, 1, 0]
        radius = 0.3
        {wheel}
        [[forces]]
        type = "gravity"
        [[records]]
        type = "sheave"
        of = "wheel"
        [[records]]
        type = "position"
        of = "load"
        [[records]]
        type = "along"
        of = "rope.1"
        what = "twist"
        at = "end"
        [[records]]
        type = "along"
        of = "rope.2"
        what = "twist"
        at = "start"
        [[records]]
        type = "energy"
        "#,
        WEIGHT / 9.80665,
        -LENGTH * cos,
        LENGTH * sin,
    )
}

#[test]
fn a_rope_that_comes_by_a_fleet_angle_is_twisted_by_rolling() {
    // what is rolled into the span before and not carried on: K' = c/(L - x)
    let laid = 2.0 * FLEET.sin() / DIAMETER;
    let exact = |hoisted: f64| laid * (LENGTH / (LENGTH - hoisted)).ln();
    for (side, share, back) in [(1.0, 1.0, true), (-1.0, 1.0, false), (1.0, 0.4, false)] {
        let wheel = format!("fleet_twist = {share}\nflank_friction = 1\nslip_speed = 1e-4");
        let way: &[f64] = if back { &[0.0, 1.0, 0.0] } else { &[0.0, 1.0] };
        let history = run(&hoisting(side, 1.0, way, &wheel));
        for t in if back { vec![3.0, 5.0, 8.0] } else { vec![3.0, 5.0, 8.0, 15.0] } {
            let laid = side * share * exact(-5.0 - at(&history, "load.z", t));
            let [found, behind] = ["rope.1.end.twist", "rope.2.start.twist"].map(|c| at(&history, c, t));
            println!("{side} {share} {t}: {found} {laid}, behind {behind}");
            let most = if t > 10.0 { 2e-2 } else { 1e-2 };
            assert!((found / laid - 1.0).abs() < most, "{side}, {share}, {t}: {found} {laid}");
            // the load on its swivel turns with the rope behind
            assert!(behind.abs() < 1e-2 * laid.abs(), "{side}, {share}, {t}: {behind}");
        }
        if back {
            // what leaves isn't rolled but held: the turns of the span stay there
            for (t, length) in [(13.0, None), (25.0, Some(LENGTH))] {
                let out = -5.0 - at(&history, "load.z", t);
                let turns = exact(HOISTED) * (LENGTH - HOISTED);
                let kept = turns / length.unwrap_or(LENGTH - out);
                let found = at(&history, "rope.1.end.twist", t);
                println!("back {t}: {found} {kept}");
                // as it trembles at rest, a little more rolls in
                assert!((found / kept - 1.0).abs() < 2e-2, "{t}: {found} {kept}");
            }
        }
    }
}

#[test]
fn friction_on_the_flank_bounds_the_torque() {
    let history =
        run(&hoisting(1.0, 50.0, &[0.0, 1.0], "fleet_twist = 1\nflank_friction = 0.1\nslip_speed = 1e-4"));
    for t in [4.0, 6.0, 8.0] {
        let tension = at(&history, "wheel.in.tension", t);
        let exact = 0.1 * tension * FLEET.sin() * 0.5 * DIAMETER;
        let found = 50.0 * at(&history, "rope.1.end.twist", t);
        let [roll, behind] = ["wheel.in.roll", "wheel.torque"].map(|c| at(&history, c, t));
        println!("{t}: {found} {exact}, {roll}, {behind}");
        assert!((found / exact - 1.0).abs() < 1e-2 && (roll / exact - 1.0).abs() < 1e-2, "{found} {exact}");
        assert!(behind.abs() < 1e-2 * exact, "{behind}");
    }
}

#[test]
fn what_rolls_a_rope_keeps_account_of_its_work() {
    for (gj, friction) in [(1.0, 1.0), (50.0, 0.1)] {
        let wheel = format!("fleet_twist = 1\nflank_friction = {friction}\nslip_speed = 1e-4");
        let [history, smooth] = [&*wheel, ""].map(|wheel| run(&hoisting(1.0, gj, &[0.0, 1.0, 0.0], wheel)));
        let off = |history: &ropewalk::History| {
            history.column("energy.imbalance").expect("energy").iter().fold(0.0_f64, |m, x| m.max(x.abs()))
        };
        let lost = ["energy.dissipated", "energy.supplied"]
            .map(|column| last(&history, column) - last(&smooth, column));
        println!("{gj}: {} {} J, {lost:?}", off(&history), off(&smooth));
        assert!(lost[0] > 0.0 && lost[1] > lost[0], "it takes work: {lost:?} J");
        assert!(off(&history) < 1e-2, "{}", off(&history));
    }
}

#[test]
fn a_block_that_swings_on_a_rope_that_rolls_keeps_account_too() {
    let off = |wheel: &str| {
        let text = BLOCK
            .replace("mass = 1.5,", "mass = 0.5, diameter = 0.03, axial_retardation_time = 0.01,")
            .replace(", torque_tension = 200", "")
            .replace("laid_twist = 1.5", "")
            .replace("length = 8", "tension = 1000")
            + wheel
            + r#"
            [[forces]]
            type = "gravity"
            [[records]]
            type = "energy"
            [[records]]
            type = "sheave"
            of = "wheel"
            [solver]
            stepping = { controlled = { tolerance = 1e-4 } }
            "#;
        let history = run(&text);
        if !wheel.is_empty() {
            let most =
                |c: &str| history.column(c).expect("a torque").iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            println!("{} {}", most("wheel.in.roll"), most("wheel.out.roll"));
            assert!(most("wheel.in.roll") > 0.05 && most("wheel.out.roll") > 0.05, "it rolls");
        }
        history.column("energy.imbalance").expect("energy").iter().fold(0.0_f64, |m, x| m.max(x.abs()))
    };
    let [smooth, rolls] = ["", "fleet_twist = 1\nflank_friction = 0.3\n"].map(off);
    println!("{rolls} {smooth}");
    assert!(rolls < 2.0 * smooth + 1e-3, "{rolls} J, {smooth} J without");
}

/// A state of a model, moved and in motion.
fn moved(model: &Model, seed: f64) -> [Vec<f64>; 3] {
    let state = model.state();
    let mut next = random(seed);
    let mut some = |by: f64| -> Vec<f64> { state.v.iter().map(|_| by * next()).collect() };
    let (d, v, a) = (some(0.05), some(1.0), some(5.0));
    let mut q = state.q.clone();
    retract(model.nodes(), &state.q, &d, &mut q);
    [q, v, a]
}

/// What makes it a rope with torsion.
const TWISTS: &str =
    ", gj = 30, rotary_inertia = 0.02, torsional_retardation_time = 0.1, torque_tension = 50";

fn rolling() -> String {
    BLOCK
        .replace("mass = 1.5,", "mass = 1.5, diameter = 0.03,")
        .replace("ea = 1e5", "ea = 1e3")
        .replace("torque_tension = 200", "torque_tension = 50")
        + "fleet_twist = 0.7\nflank_friction = 0.3\nslip_speed = 0.05\n"
}

#[test]
fn torques_of_a_flank_have_exact_tangents_and_turn_with_the_scene() {
    let model = build(&rolling());
    let (roll, nodes, internal) = (term(&model, "wheel: roll"), model.nodes(), model.state().internal);
    let mut acting = 0;
    for seed in 1..9 {
        let [q, v, a] = moved(&model, f64::from(seed));
        let now = At { t: 0.0, q: &q, v: &v, a: &a, internal: &internal, relaxed: None };
        let off = check_tangent(roll, nodes, &now, Width::One);
        assert!(off < 1e-6, "{seed}: {off}");
        let force = |v: &[f64]| dense(roll, nodes, &At { v, ..now }, Weights::default(), Width::One).0;
        let own = force(&v);
        acting += usize::from(own.iter().any(|f| f.abs() > 1e-6));

        // where only material and sections move, nothing comes of friction
        let mut runs = vec![0.0; v.len()];
        for n in nodes {
            match n.kind {
                NodeKind::Twist => runs[n.v + 6] = v[n.v + 6],
                NodeKind::Scalars(1) => runs[n.v] = v[n.v],
                _ => {}
            }
        }
        let lost = roll.power(&At { v: &runs, ..now }).dissipated;
        assert!(lost >= 0.0, "{seed}: {lost} W");

        // as all of it moves like a rigid body
        let (place, spin) = ([0.3, -0.4, 0.5], [0.7, 0.2, -1.1]);
        let mut rigid = vec![0.0; v.len()];
        for n in nodes {
            let three = |i: usize| [q[n.q + i], q[n.q + i + 1], q[n.q + i + 2]];
            let put = |rigid: &mut [f64], first: usize, x: [f64; 3]| {
                rigid[n.v + first..n.v + first + 3].copy_from_slice(&x);
            };
            if !matches!(n.kind, NodeKind::Frame | NodeKind::Twist) {
                continue;
            }
            let swing = cross(&spin, &three(0));
            put(&mut rigid, 0, std::array::from_fn(|i| place[i] + swing[i]));
            if n.kind == NodeKind::Frame {
                let turn = matrix(&[q[n.q + 3], q[n.q + 4], q[n.q + 5], q[n.q + 6]]);
                put(&mut rigid, 3, transposed_times(&turn, &spin));
            } else {
                let slope = three(3);
                put(&mut rigid, 3, cross(&spin, &slope));
                rigid[n.v + 6] = dot(&spin, &slope) / dot(&slope, &slope).sqrt();
            }
        }
        let size = own.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        let work: f64 = own.iter().zip(&rigid).map(|(f, v)| f * v).sum();
        assert!(work.abs() <= 1e-12 * size, "{seed}: {work}");
        let both: Vec<f64> = v.iter().zip(&rigid).map(|(a, b)| a + b).collect();
        for (a, b) in own.iter().zip(force(&both)) {
            assert!((a - b).abs() <= 1e-11 * size, "{seed}: {a} {b}");
        }
    }
    assert!(acting > 4, "{acting}");
}

#[test]
fn a_rope_in_the_plane_of_its_groove_is_not_rolled() {
    let model = build(&hoisting(0.0, 1.0, &[0.0, 1.0], "fleet_twist = 1\nflank_friction = 1"));
    let roll = term(&model, "wheel: roll");
    let state = model.state();
    let [_, v, a] = moved(&model, 3.0);
    let now = At { t: 0.0, q: &state.q, v: &v, a: &a, internal: &state.internal, relaxed: None };
    assert!(dense(roll, model.nodes(), &now, Weights::default(), Width::One).0.iter().all(|f| *f == 0.0));
}

#[test]
fn what_cannot_roll_is_refused_with_its_reason() {
    let without = |model: &Model| model.terms().iter().all(|t| t.label() != "wheel: roll");
    assert!(without(&build(BLOCK)));
    let with = |more: &str| format!("{BLOCK}{more}");
    let cases = [
        (with("fleet_twist = 1\nflank_friction = 0.1"), "a `diameter`"),
        (rolling().replace("flank_friction = 0.3", ""), "give `flank_friction`"),
        (rolling().replace("fleet_twist = 0.7", "fleet_twist = 1.5"), "a share of pure rolling"),
        (rolling().replace("fleet_twist = 0.7", ""), "give `fleet_twist`"),
        (
            rolling().replace(TWISTS, "").replace("twist = 0.3", "").replace("laid_twist = 1.5", ""),
            "`rope` has no torsion",
        ),
    ];
    for (text, reason) in cases {
        let message = refused(&text);
        assert!(message.contains(reason), "{message}\nbut not: {reason}");
    }
}
