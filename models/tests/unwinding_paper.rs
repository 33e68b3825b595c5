//! Unwinding by finite differences, against steady balloons from a collocation solver (`data/`), and against itself.

use ropewalk_constraints::motion::{Rest, Straight};
use ropewalk_constraints::{Package, PackageSpec};
use ropewalk_core::{Motion, Moving, V3};
use ropewalk_forces::{Drag, NormalLaw, TangentialLaw, TimeFunction};
use ropewalk_models::unwinding::{
    Cable, Eyelet, History, Kind, LiftOff, Plan, Pull, Ring, Row, Rule, SteadyError, Stepping, Stopped,
    Unwinding,
};
use serde_json::Value;
use std::f64::consts::TAU;
use std::sync::Arc;

const KNOT: f64 = 1852.0 / 3600.0;

/// A speed that was there before the start.
#[derive(Debug)]
struct Running(f64);
impl Motion for Running {
    fn at(&self, t: f64) -> Moving {
        Moving { x: [self.0 * t, 0.0, 0.0], v: [self.0, 0.0, 0.0], a: [0.0; 3] }
    }
}

fn cases(text: &str) -> Vec<Value> {
    let all: Value = serde_json::from_str(text).unwrap();
    all["cases"].as_array().unwrap().clone()
}
fn flexible() -> Vec<Value> {
    cases(include_str!("../../tests/data/flow/balloon.json"))
}
fn stiff() -> Vec<Value> {
    cases(include_str!("../../tests/data/flow/balloon_bend.json"))
}
fn named(all: Vec<Value>, name: &str) -> Value {
    all.into_iter().find(|c| c["name"] == name).unwrap()
}
fn number(case: &Value, key: &str) -> f64 {
    case[key].as_f64().or(case["params"][key].as_f64()).unwrap_or(0.0)
}

/// The problem of a reference case.
fn problem(case: &Value, segments: usize) -> Unwinding {
    let f = |key: &str| number(case, key);
    let cable = Cable { mass: f("m"), diameter: f("d"), ei: f("EI"), curvature_limit: 1e4 };
    let climb = case["params"]["tL"][2].as_f64().unwrap_or(0.0).asin();
    let ring = Ring { radius: f("R"), height: f("h"), climb, inner: true };
    let rule = Rule::Tension(Pull::constant(f("T0")));
    let mut p = Unwinding::new(cable, Arc::new(ring), Arc::new(Running(f("V"))), rule, segments);
    if f("rho") > 0.0 {
        let (normal, tangential) = if case["params"]["model"] == "choo" {
            (NormalLaw::ChooCasarella, TangentialLaw::ChooCasarella)
        } else {
            (NormalLaw::Constant(f("Cn")), TangentialLaw::Quadratic(f("Ct")))
        };
        p.drag = Some(Drag::new(f("rho"), 1.08e-3, normal, tangential).unwrap());
    }
    if f("EI") > 0.0 {
        p.lift_off = LiftOff::Tangent;
    }
    p
}

/// The reference shape, from the eyelet to the lift-off point.
fn points(case: &Value) -> Vec<V3<f64>> {
    let rows = case["rows"].as_array().unwrap();
    rows.iter().map(|r| [1, 2, 3].map(|i| r[i].as_f64().unwrap())).collect()
}

fn distance(a: &V3<f64>, b: &V3<f64>) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}

/// Starts from the reference shape and turns with it: largest deviation from the turning shape over R, and the history.
fn turned(case: &Value, p: &Unwinding, turns: f64, per_turn: usize, damping: f64) -> (f64, History) {
    let spin = number(case, "Om");
    let turn = TAU / spin;
    let start = p.start(&points(case), spin, 0.0).unwrap();
    let begin = start.x.clone();
    let shapes = (1..=8).map(|k| k as f64 * turns * turn / 8.0).collect();
    let plan = Plan { t_end: turns * turn, every: turn / 20.0, shapes };
    let stepping = Stepping { numerical_damping: damping, ..Stepping::new(turn / per_turn as f64) };
    let history = p.run(start, stepping, &plan).unwrap();
    let mut off = 0.0_f64;
    for shape in &history.shapes {
        let (sin, cos) = (spin * shape.t).sin_cos();
        for (x, b) in shape.x.iter().zip(&begin) {
            let there = [cos * b[0] - sin * b[1], sin * b[0] + cos * b[1], b[2]];
            off = off.max(distance(x, &there));
        }
    }
    (off / number(case, "R"), history)
}

fn order(coarse: f64, fine: f64) -> f64 {
    (coarse / fine).abs().log2()
}

#[test]
fn steady_balloons_are_those_of_the_reference() {
    for case in flexible() {
        let name = case["name"].as_str().unwrap();
        let found =
            [20, 40].map(|n| problem(&case, n).steady(number(&case, "V"), number(&case, "T0"), 0.0).unwrap());
        let by_length = found.each_ref().map(|b| b.shape.length / number(&case, "L") - 1.0);
        assert!(by_length[1].abs() < 3e-4, "{name}: {by_length:?}");
        assert!((1.8..2.2).contains(&order(by_length[0], by_length[1])), "{name}: {by_length:?}");
        let lift = found[1].lift_tension / number(&case, "T_lift") - 1.0;
        assert!(lift.abs() < 6e-4, "{name}: {lift}");
        // halfway, in shape
        let rows = points(&case);
        let off = distance(&found[1].shape.x[20], &rows[20]) / number(&case, "R");
        assert!(off < 2e-3, "{name}: {off}");
    }
}

#[test]
fn stiff_balloons_are_those_of_the_reference() {
    for case in stiff() {
        let name = case["name"].as_str().unwrap();
        let found = [60, 120]
            .map(|n| problem(&case, n).steady(number(&case, "V"), number(&case, "T0"), 0.0).unwrap());
        let by_length = found.each_ref().map(|b| b.shape.length / number(&case, "L") - 1.0);
        assert!(by_length[1].abs() < 4e-4, "{name}: {by_length:?}");
        assert!((1.7..2.2).contains(&order(by_length[0], by_length[1])), "{name}: {by_length:?}");
        let bend = found[1].shape.curvature[120] / number(&case, "kappa_lift") - 1.0;
        assert!(bend.abs() < 5e-3, "{name}: lift-off curvature off by {bend}");
        let lift = found.each_ref().map(|b| b.lift_tension - number(&case, "T_lift"));
        assert!(lift[1].abs() < 0.02 * number(&case, "T0"), "{name}: {lift:?}");
        assert!((1.6..2.2).contains(&order(lift[0], lift[1])), "{name}: {lift:?}");
        // tangent to the wound layer: the last segment turns off it by half of its curvature
        let x = &found[1].shape.x;
        let ell = found[1].shape.length / 120.0;
        let tangent = [0, 1, 2].map(|i| case["params"]["tL"][i].as_f64().unwrap());
        let along: f64 = (0..3).map(|i| (x[120][i] - x[119][i]) / ell * tangent[i]).sum();
        let angle = 0.5 * ell * number(&case, "kappa_lift");
        assert!((along.acos() - angle).abs() < 0.05 * angle, "{name}");
    }
}

#[test]
fn below_the_fold_there_is_no_steady_balloon() {
    let all: Value = serde_json::from_str(include_str!("../../tests/data/flow/balloon.json")).unwrap();
    let exact = all["fold_no_drag_15kn"]["T0_min"].as_f64().unwrap();
    let case = named(flexible(), "flex_nodrag_15kn_T0.5");
    let least = [40, 80].map(|n| match problem(&case, n).steady(15.0 * KNOT, 0.9 * exact, 0.0) {
        Err(SteadyError::Nothing { least, .. }) => least,
        other => panic!("{other:?}"),
    });
    let error = least.map(|t| (t / exact - 1.0).abs());
    assert!(error[1] < 1e-4 && (1.8..2.2).contains(&order(error[0], error[1])), "{error:?}");
    let says = problem(&case, 40).steady(15.0 * KNOT, 0.3, 0.0).unwrap_err().to_string();
    assert!(says.contains("there is no steady balloon") && says.contains("0.312"), "{says}");
    // just above it there is one
    assert!(problem(&case, 40).steady(15.0 * KNOT, 1.001 * exact, 0.0).is_ok());
}

#[test]
fn balloons_are_similar_in_the_square_of_the_speed() {
    let slow = named(flexible(), "low_const_5kn_a");
    let fast = named(flexible(), "low_const_15kn_a");
    let of = |case: &Value| problem(case, 40).steady(number(case, "V"), number(case, "T0"), 0.0).unwrap();
    let (a, b) = (of(&slow), of(&fast));
    let off = a.shape.x.iter().zip(&b.shape.x).fold(0.0_f64, |m, (a, b)| m.max(distance(a, b)));
    assert!(off < 1e-10, "{off}");
    assert!((b.lift_tension / a.lift_tension / 9.0 - 1.0).abs() < 1e-9);
    // in time as well: the same steps per turn
    let run = |case: &Value| turned(case, &problem(case, 20), 0.5, 100, 0.0).1;
    let (a, b) = (run(&slow), run(&fast));
    for (a, b) in a.rows.iter().zip(&b.rows) {
        assert!((b.lift_tension / a.lift_tension / 9.0 - 1.0).abs() < 1e-7);
        assert!((b.length / a.length - 1.0).abs() < 1e-9);
    }
}

#[test]
fn a_balloon_that_turns_keeps_its_shape() {
    for name in ["flex_nodrag_15kn_T0.5", "low_const_5kn_a", "low_choo_15kn_b"] {
        let case = named(flexible(), name);
        for free_length in [false, true] {
            let run = |n: usize| {
                let mut p = problem(&case, n);
                if !free_length {
                    p.rule = Rule::Length;
                }
                turned(&case, &p, 2.0, 300, 0.0)
            };
            let ((coarse, _), (fine, history)) = (run(12), run(24));
            assert!(history.stopped.is_none());
            assert!(fine < 3e-3, "{name}: {fine}");
            assert!((1.5..2.6).contains(&order(coarse, fine)), "{name}: {coarse} {fine}");
            // the segments keep their lengths: the constraint doesn't drift
            let x = &history.state.x;
            let ell = history.state.length[0] / 24.0;
            let drift = x.windows(2).fold(0.0_f64, |m, w| m.max((distance(&w[0], &w[1]) / ell - 1.0).abs()));
            assert!(drift < 3e-5, "{name}: {drift}");
            if name != "low_choo_15kn_b" {
                let tension = history.rows[history.rows.len() - 1].tension / number(&case, "T0") - 1.0;
                assert!(tension.abs() < 1e-3, "{name}: {tension}");
            }
            // the marched tension equation agrees
            let marching = history.rows.iter().fold(0.0_f64, |m, r| m.max(r.marching));
            assert!(marching < 5e-4 * number(&case, "T0"), "{name}: {marching}");
        }
    }
}

#[test]
fn the_wrong_coriolis_sign_shows() {
    let case = named(flexible(), "low_const_5kn_a");
    let mut p = problem(&case, 20);
    p.rule = Rule::Length;
    let (right, _) = turned(&case, &p, 1.0, 200, 0.0);
    p.coriolis = 2.0;
    let (wrong, history) = turned(&case, &p, 1.0, 200, 0.0);
    // the reference's own check: 0.17944 N instead of 0.15 N, 1.1 % of the radius
    let tension = history.rows[history.rows.len() - 1].tension;
    assert!((tension - 0.17944).abs() < 5e-4, "{tension}");
    assert!(wrong > 1e-2 && wrong > 50.0 * right, "{wrong} {right}");
}

#[test]
fn a_stiff_balloon_that_turns_keeps_its_shape() {
    let case = named(stiff(), "low_bend_const_5kn_a");
    let run = |n: usize| {
        let mut p = problem(&case, n);
        p.rule = Rule::Length;
        turned(&case, &p, 2.0, 100, 0.05)
    };
    let ((coarse, a), (fine, b)) = (run(30), run(60));
    assert!(fine < 6e-4 && (1.5..2.4).contains(&order(coarse, fine)), "{coarse} {fine}");
    let last = |h: &History| h.rows[h.rows.len() - 1];
    let error = [last(&a), last(&b)].map(|r| r.tension / 0.15 - 1.0);
    assert!((1.6..2.4).contains(&order(error[0], error[1])), "{error:?}");
    // the limit of fine meshes, by the order
    let limit = (4.0 * error[1] - error[0]) / 3.0;
    assert!(limit.abs() < 1e-3, "{error:?}");
    let bend = last(&b).lift_curvature / number(&case, "kappa_lift") - 1.0;
    assert!(bend.abs() < 0.02, "{bend}");
}

#[test]
fn a_stiff_balloon_keeps_its_tension_on_a_fine_mesh() {
    // the rows of the third case are too far apart for its boundary layer to be started from
    for (name, n) in [("low_bend_const_5kn_a", 120), ("bend_nodrag_15kn", 120)] {
        let case = named(stiff(), name);
        let mut p = problem(&case, n);
        p.rule = Rule::Length;
        let (off, history) = turned(&case, &p, 2.0, 200, 0.05);
        assert!(off < 1e-3, "{name}: {off}");
        let last = history.rows[history.rows.len() - 1];
        let error = last.tension / number(&case, "T0") - 1.0;
        assert!(error.abs() < 2e-3, "{name}: {error}");
        assert!((last.lift_curvature / number(&case, "kappa_lift") - 1.0).abs() < 0.02, "{name}");
    }
}

/// A cable that is drawn from an inner package, from rest.
fn launch(speed: f64, height: f64, segments: usize) -> Unwinding {
    let cable = Cable { mass: 1e-3, diameter: 0.9e-3, ei: 0.0, curvature_limit: 200.0 };
    let spec = PackageSpec { origin: [0.0, 0.0, height], ..PackageSpec::new(0.06, 0.2, 0.9e-3) };
    let package = Arc::new(Package::new(&spec).unwrap());
    let draw = Arc::new(Straight::new([1.0, 0.0, 0.0], speed, 0.0, 0.1).unwrap());
    let pull = Pull { rest: 0.05, time: TimeFunction::Constant, per_speed2: 0.0227 };
    let mut p = Unwinding::new(cable, package, draw, Rule::Tension(pull), segments);
    p.drag =
        Some(Drag::new(1025.0, 1.08e-3, NormalLaw::Constant(1.2), TangentialLaw::Quadratic(0.01)).unwrap());
    p
}

#[test]
fn a_launch_ends_in_the_steady_balloon() {
    for speed in [5.0 * KNOT, 15.0 * KNOT] {
        let p = launch(speed, 0.1, 20);
        let start = p.start(&[[0.0; 3], [0.06, 0.0, 0.1]], 0.0, 0.0).unwrap();
        let plan = Plan { t_end: 0.2, every: 0.01, shapes: vec![] };
        let h = p.run(start, Stepping::new(4e-4), &plan).unwrap();
        assert!(h.stopped.is_none() && h.conditions.is_empty(), "{:?}", h.conditions);
        let last = h.rows[h.rows.len() - 1];
        let steady = p.steady(speed, last.tension, last.peeled).unwrap();
        // the lift-off point climbs slowly meanwhile
        assert!((last.length / steady.shape.length - 1.0).abs() < 2e-4, "{}", last.length);
        assert!((last.lift_tension / steady.lift_tension - 1.0).abs() < 1e-3);
        // what has been drawn came from the package or from the free length
        let drawn = speed * (0.2 - 0.05);
        assert!((last.peeled - drawn - (last.length - h.rows[0].length)).abs() < 1e-12);
    }
}

#[test]
fn newmark_is_of_second_order() {
    let p = launch(5.0 * KNOT, 0.3, 16);
    let end = |steps: f64| {
        let start = p.start(&[[0.0; 3], [0.06, 0.0, 0.3]], 0.0, 0.0).unwrap();
        let plan = Plan { t_end: 0.08, every: 0.08, shapes: vec![] };
        p.run(start, Stepping::new(0.08 / steps), &plan).unwrap().rows[1]
    };
    let [a, b, c] = [400.0, 800.0, 1600.0].map(end);
    for of in [|r: &Row| r.length, |r: &Row| r.lift_tension, |r: &Row| r.centre[0][1]] {
        let o = order(of(&a) - of(&b), of(&b) - of(&c));
        // the tension's error falls still faster
        assert!(o > 1.8, "{o}: {} {} {}", of(&a), of(&b), of(&c));
    }
}

#[test]
fn the_mesh_converges_from_rest() {
    let run = |n: usize| {
        let p = launch(10.0 * KNOT, 0.1, n);
        let start = p.start(&[[0.0; 3], [0.06, 0.0, 0.1]], 0.0, 0.0).unwrap();
        let plan = Plan { t_end: 0.07, every: 0.01, shapes: vec![] };
        p.run(start, Stepping::new(5e-4), &plan).unwrap().rows
    };
    let [a, b, c] = [12, 24, 48].map(run);
    for k in [3, 5, 7] {
        let o = order(a[k].length - b[k].length, b[k].length - c[k].length);
        assert!((1.7..2.4).contains(&o), "{o}");
        assert!(b[k].marching < 1e-4 * b[k].tension, "{}", b[k].marching);
    }
}

#[test]
fn a_cable_that_is_held_tangent_starts_from_rest() {
    let mut p = launch(5.0 * KNOT, 0.1, 40);
    p.cable.ei = 5e-5;
    p.lift_off = LiftOff::Tangent;
    let rest = p.steady(0.0, 0.05, 0.0).unwrap();
    let start = p.start_steady(&rest).unwrap();
    let plan = Plan { t_end: 0.2, every: 0.01, shapes: vec![0.1, 0.2] };
    let h = p.run(start, Stepping { numerical_damping: 0.05, ..Stepping::new(2e-4) }, &plan).unwrap();
    assert!(h.stopped.is_none() && h.shapes.len() == 2, "{:?}", h.stopped);
    let last = h.rows[h.rows.len() - 1];
    let steady = p.steady(5.0 * KNOT, last.tension, last.peeled).unwrap();
    assert!((last.length / steady.shape.length - 1.0).abs() < 1e-3);
    assert!((last.lift_curvature / steady.shape.curvature[40] - 1.0).abs() < 1e-2);
}

/// Without drag, `T + EI κ²/2 + m Ω² ρ²/2` is the same all along the cable.
#[test]
fn a_guided_balloon_keeps_its_first_integral() {
    let case = named(stiff(), "bend_nodrag_15kn");
    let spread = |n: usize| {
        let mut p = problem(&case, n);
        p.through = Eyelet::Guided([0.0, 0.0, 1.0]);
        let b = p.steady(15.0 * KNOT, 0.5, 0.0).unwrap();
        let (shape, bending) = (&b.shape, p.cable.ei);
        // along the axis in the eyelet: the first segment turns off it by half of its curvature
        let angle = 0.5 * shape.length / n as f64 * shape.curvature[0];
        assert!(shape.curvature[0] > 5.0);
        assert!((shape.x[1][2] / (shape.length / n as f64) - angle.cos()).abs() < 1e-3);
        let energy = |j: usize, tension: f64| {
            let r2 = shape.x[j][0].powi(2) + shape.x[j][1].powi(2);
            tension + 0.5 * bending * shape.curvature[j].powi(2) + 0.5 * p.cable.mass * (b.spin * b.spin) * r2
        };
        let whole = energy(0, b.tension);
        // between the segments on both sides
        let inner = (1..n).map(|j| energy(j, 0.5 * (shape.tension[j - 1] + shape.tension[j])));
        let ends = energy(n, b.lift_tension);
        inner.chain([ends]).fold(0.0_f64, |m, e| m.max((e / whole - 1.0).abs()))
    };
    let (coarse, fine) = (spread(40), spread(80));
    assert!(fine < 5e-3 && (1.6..2.4).contains(&order(coarse, fine)), "{coarse} {fine}");
}

#[test]
fn a_cable_that_sticks_peels_at_its_energy() {
    let case = named(stiff(), "low_bend_const_5kn_a");
    let mut p = problem(&case, 40);
    let balloon = p.steady(number(&case, "V"), 0.15, 0.0).unwrap();
    // the energy that the balloon of this tension peels at
    let x = &balloon.shape.x;
    let ell = balloon.shape.length / 40.0;
    let clamp = [0, 1, 2].map(|i| case["params"]["tL"][i].as_f64().unwrap());
    let jump: f64 = (0..3)
        .map(|i| {
            let wound = if i == 0 { -1.0 / 0.06 } else { 0.0 };
            (2.0 * (x[39][i] - x[40][i] + ell * clamp[i]) / (ell * ell) - wound).powi(2)
        })
        .sum();
    let energy = 0.5 * p.cable.ei * jump;
    p.rule = Rule::Peel(energy);
    let turn = TAU / number(&case, "Om");
    let plan = Plan { t_end: turn, every: 0.05 * turn, shapes: vec![] };
    let start = p.start_steady(&balloon).unwrap();
    let h = p.run(start, Stepping { numerical_damping: 0.05, ..Stepping::new(turn / 200.0) }, &plan).unwrap();
    assert!(h.stopped.is_none(), "{:?}", h.stopped);
    let last = h.rows[h.rows.len() - 1];
    assert!((last.length / balloon.shape.length - 1.0).abs() < 1e-3, "{}", last.length);
    // the balance of peeling is unstable, so that the speed of peeling trembles, and the tension with it
    assert!((last.tension / 0.15 - 1.0).abs() < 3e-2, "{}", last.tension);
    for row in &h.rows {
        assert!(
            (row.lift_curvature / balloon.shape.curvature[40] - 1.0).abs() < 2e-3,
            "{}",
            row.lift_curvature
        );
    }
}

#[test]
fn an_outer_package_unwinds_too() {
    let mut p = launch(5.0 * KNOT, 0.3, 24);
    let side = ropewalk_constraints::package::Side::Outer;
    let spec = PackageSpec { side, origin: [0.0, 0.0, 0.3], ..PackageSpec::new(0.06, 0.2, 0.9e-3) };
    p.path = Arc::new(Package::new(&spec).unwrap());
    p.drag = None;
    p.rule = Rule::Tension(Pull::constant(0.05));
    let start = p.start(&[[0.0; 3], [0.06, 0.0, 0.3]], 0.0, 0.0).unwrap();
    let plan = Plan { t_end: 0.15, every: 0.01, shapes: vec![] };
    let h = p.run(start, Stepping::new(4e-4), &plan).unwrap();
    assert!(h.stopped.is_none());
    assert!(h.rows.iter().all(|r| (r.tension - 0.05).abs() < 1e-9));
}

#[test]
fn troubles_are_reported_and_the_run_goes_on() {
    // the reference balloon lifts off with a negative tension, below m V², and bulges beyond the wall
    let case = named(stiff(), "bend_nodrag_15kn");
    let mut p = problem(&case, 30);
    p.rule = Rule::Length;
    p.cable.curvature_limit = 30.0;
    let (_, history) = turned(&case, &p, 0.3, 100, 0.05);
    assert!(history.stopped.is_none());
    for kind in [Kind::Subcritical, Kind::Contact, Kind::Bent, Kind::Slack] {
        let c = history.conditions.iter().find(|c| c.kind == kind).unwrap();
        assert!(c.worst.is_finite() && c.s > 0.1, "{c}");
    }
    let slack = history.conditions.iter().find(|c| c.kind == Kind::Slack).unwrap().to_string();
    assert!(slack.contains("negative"), "{slack}");
}

#[test]
fn an_empty_package_ends_the_run() {
    let mut p = launch(5.0 * KNOT, 0.1, 16);
    // two turns and no more
    let spec = PackageSpec { origin: [0.0, 0.0, 0.1], ..PackageSpec::new(0.06, 1.8e-3, 0.9e-3) };
    p.path = Arc::new(Package::new(&spec).unwrap());
    let start = p.start(&[[0.0; 3], [0.06, 0.0, 0.1]], 0.0, 0.0).unwrap();
    let plan = Plan { t_end: 10.0, every: 0.01, shapes: vec![] };
    let h = p.run(start, Stepping::new(1e-3), &plan).unwrap();
    let Some(Stopped::Empty { t, wound }) = h.stopped else { panic!("{:?}", h.stopped) };
    assert!((wound - 2.0 * TAU * 0.06).abs() < 1e-3 && (wound - h.state.peeled[0]) < 1e-3);
    assert!(t > 0.3 && t < 0.4 && h.rows.len() > 30);
    // the short steps towards the end don't shake the tension
    assert!(h.conditions.is_empty(), "{:?}", h.conditions);
}

#[test]
fn bad_data_are_refused_with_a_remedy() {
    let good = launch(5.0 * KNOT, 0.1, 16);
    let line = [[0.0; 3], [0.06, 0.0, 0.1]];
    let refused = |p: &Unwinding, points: &[V3<f64>], says: &str| {
        let e = p.start(points, 0.0, 0.0).unwrap_err();
        assert!(e.message.contains(says), "{e}");
    };
    refused(&Unwinding { elements: 3, ..good.clone() }, &line, "give 6 at least");
    refused(&Unwinding { lift_off: LiftOff::Tangent, ..good.clone() }, &line, "bending stiffness");
    refused(&Unwinding { rule: Rule::Peel(0.1), ..good.clone() }, &line, "peeling needs");
    refused(&Unwinding { rule: Rule::Length, ..good.clone() }, &line, "slack or curved");
    refused(&good, &[[0.0; 3], [0.06, 0.0, 0.2]], "lift-off point");
    refused(&good, &[[0.0; 3]], "two points");
    refused(&good, &[[0.0; 3], [0.0; 3], [0.06, 0.0, 0.1]], "coincide");
    refused(&good, &[[f64::NAN; 3], [0.06, 0.0, 0.1]], "not a finite");
    let jump = Unwinding { feed: Arc::new(Running(2.0)), ..good.clone() };
    refused(&jump, &line, "rise from 0");
    let start = good.start(&line, 0.0, 0.0).unwrap();
    let plan = Plan { t_end: 1.0, every: 0.1, shapes: vec![] };
    assert!(good.run(start.clone(), Stepping::new(0.0), &plan).is_err());
    // nothing happens to a cable that nobody draws
    let still = Unwinding { feed: Arc::new(Rest), ..good };
    let h = still.run(start, Stepping::new(0.01), &plan).unwrap();
    assert!(h.rows.iter().all(|r| (r.length - h.rows[0].length).abs() < 1e-12));
}

#[test]
fn a_run_that_fails_says_when_and_where() {
    // a step as long as the ramp, not to be halved
    let p = launch(25.0 * KNOT, 0.3, 16);
    let start = p.start(&[[0.0; 3], [0.06, 0.0, 0.3]], 0.0, 0.0).unwrap();
    let plan = Plan { t_end: 0.2, every: 0.1, shapes: vec![] };
    let h = p.run(start, Stepping { least: 1.0, ..Stepping::new(0.1) }, &plan).unwrap();
    let says = h.stopped.expect("such a step can't converge").to_string();
    assert!(says.contains("at t = ") && says.contains("Try"), "{says}");
    assert!(!h.rows.is_empty());
}
