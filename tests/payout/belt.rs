//! Closed belts: routes without ends. Tensions by the length of the belt, slip by Euler and Eytelwein, creep by Grashof.

use crate::common::{data, number};
use ropewalk::scene::Format;
use ropewalk::{History, SceneFile, simulate};
use ropewalk_core::V3;
use ropewalk_elements::testing::{Side, Stop, lay_closed};
use std::f64::consts::PI;

const RADIUS: f64 = 0.1;
const APART: f64 = 0.6;
const EA: f64 = 1e4;
const MASS: f64 = 0.1;
const MU: f64 = 0.5;
/// Tension at rest, and the damping of what is driven.
const REST: f64 = 225.0;
const LOAD: f64 = 0.15;

fn text(moment: f64, more: &str) -> String {
    format!(
        r#"
        run = {{ duration = 3, output = 0.01 }}
        [[elements]]
        type = "cable"
        name = "belt"
        section = {{ mass = {MASS}, ea = {EA}, axial_retardation_time = "1 ms" }}
        elements = 1
        tension = {REST}
        route = [{{ round = "driver" }}, {{ round = "driven" }}]
        [[constraints]]
        type = "sheave"
        name = "driver"
        marker = [0, 0, 0]
        axis = [0, 1, 0]
        radius = {RADIUS}
        inertia = 0.01
        friction = {MU}
        torque = {moment}
        [[constraints]]
        type = "sheave"
        name = "driven"
        marker = [{APART}, 0, 0]
        axis = [0, 1, 0]
        radius = {RADIUS}
        inertia = 0.01
        friction = {MU}
        bearing = {{ damping = {LOAD} }}
        [[records]]
        type = "sheave"
        of = "driver"
        [[records]]
        type = "sheave"
        of = "driven"
        [[records]]
        type = "energy"
        {more}
        "#
    )
}

fn run(text: &str) -> History {
    let file = SceneFile::parse(text, "belt", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
    simulate(&file.into_scene()).unwrap_or_else(|e| panic!("{e}"))
}

fn refused(text: &str) -> String {
    SceneFile::parse(text, "belt", Format::Toml, &[])
        .map_err(|e| e.to_string())
        .and_then(|file| file.into_scene().build().map(drop).map_err(|e| e.to_string()))
        .expect_err("it builds")
}

/// Tight and slack side, and the ratio of the speeds of driven wheel and driver, of a belt that transmits this moment.
///
/// The belt sticks where it arrives at a pulley and slides before it leaves it, where `d(T - q) = μ (T - q) dφ`, `q = m λ V²`.
/// Its unstretched length is that which it has at rest.
fn exact(moment: f64) -> [f64; 3] {
    let rim = moment / LOAD * RADIUS;
    let whole = (2.0 * APART + 2.0 * PI * RADIUS) / (1.0 + REST / EA);
    let stretch = |t: f64| 1.0 + t / EA;
    let length = |tight: f64| {
        let slack = tight - moment / RADIUS;
        let v = rim / stretch(slack);
        let (n, mut angle, mut slides) = (2000, 0.0, 0.0);
        for k in 0..n {
            let t = slack + (tight - slack) * (k as f64 + 0.5) / n as f64;
            let lambda = stretch(t);
            let step = (tight - slack) / n as f64 * (1.0 - MASS * v * v / EA);
            let turn = step / (MU * (t - MASS * lambda * v * v));
            angle += turn;
            slides += RADIUS * turn / lambda;
        }
        let sticks = RADIUS * (PI - angle);
        (APART + sticks) * (1.0 / stretch(tight) + 1.0 / stretch(slack)) + 2.0 * slides
    };
    let (mut low, mut high) = (moment / RADIUS + 20.0, 10.0 * REST);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        // more tension, less of the belt fits
        if length(middle) > whole { low = middle } else { high = middle }
    }
    let slack = low - moment / RADIUS;
    [low, slack, stretch(slack) / stretch(low)]
}

#[test]
fn belt_creeps_as_its_stretch_says() {
    for moment in [5.0, 15.0, 20.0] {
        let [tight, slack, ratio] = exact(moment);
        for sign in [1.0, -1.0] {
            let history = run(&text(sign * moment, ""));
            let last = |name: &str| history.last(name).unwrap_or_else(|| panic!("no {name}"));
            let sides = ["in", "out"].map(|side| last(&format!("driver.{side}.tension")));
            // turning the other way, the tight side is the other
            let [in_, out] = if sign > 0.0 { sides } else { [sides[1], sides[0]] };
            println!("{moment}: {in_} for {tight}, {out} for {slack}");
            // on the pulleys the tension is that of one side, where the exact one goes over in the other's
            assert!((in_ - tight).abs() < 0.01 * REST, "{in_} N for {tight} N");
            assert!((out - slack).abs() < 0.01 * REST, "{out} N for {slack} N");
            let [driver, driven] = ["driver", "driven"].map(|wheel| last(&format!("{wheel}.spin")));
            assert!((driven / (sign * moment / LOAD) - 1.0).abs() < 1e-4, "{driven} rad/s");
            let (creep, known) = (1.0 - driven / driver, 1.0 - ratio);
            println!("{moment}: creep {creep} for {known}");
            assert!((creep / known - 1.0).abs() < 0.02, "creep {creep} for {known}");
            // what is lost is the creep: no more, and nothing is made
            let all = ["supplied", "dissipated", "imbalance"].map(|what| last(&format!("energy.{what}")));
            assert!(all[2].abs() < 1e-4 * all[0] && all[1] > 0.0, "{all:?}");
        }
    }
}

#[test]
fn belt_creeps_as_the_reference_says() {
    let of = data("reeving/belt_creep.json");
    let given = |name: &str| number(&of["parameters"][name]);
    assert_eq!([given("EA"), given("m"), given("mu")], [EA, MASS, MU]);
    // the driver at 10 m/s; its moment is what the tensions differ by
    let moment = (given("T1") - given("T2")) * RADIUS;
    let history = run(&text(moment, ""));
    let last = |name: &str| history.last(name).unwrap_or_else(|| panic!("no {name}"));
    let [driver, driven] = ["driver", "driven"].map(|wheel| last(&format!("{wheel}.spin")));
    let creep = 1.0 - driven / driver;
    println!("creep {creep}, rim {}", driver * RADIUS);
    let off = (creep / number(&of["reference"]["creep"]) - 1.0).abs();
    assert!(off <= number(&of["tolerance_suggested"]["creep"]), "creep {creep}: off by {off}");
    // the rest is as long as the reference's tensions make it, to the second order in their difference
    let tight = last("driver.in.tension").max(last("driver.out.tension"));
    assert!((tight / given("T1") - 1.0).abs() <= 0.02, "{tight} N");
}

#[test]
fn belt_slips_where_euler_and_eytelwein_say() {
    // more than it can transmit: the driver runs away under it
    let history = run(&text(40.0, "").replace("duration = 3", "duration = 0.5"));
    let column = |name: &str| history.column(name).unwrap_or_else(|| panic!("no {name}"));
    let [tight, slack] = ["in", "out"].map(|side| column(&format!("driver.{side}.tension")));
    let (speed, wrap) = (column("driver.speed"), column("driver.wrap"));
    let n = history.times().len();
    assert!(history.last("driver.slip").is_some_and(|slip| slip < -1.0));
    for k in n / 2..n {
        // the speed of the material, and the momentum that turns with it
        let q = MASS * speed[k] * speed[k] / (1.0 + 0.5 * (tight[k] + slack[k]) / EA);
        let ratio = (tight[k] - q) / (slack[k] - q);
        let exact = (MU * wrap[k]).exp();
        assert!((ratio / exact - 1.0).abs() < 5e-3, "{ratio} for {exact}");
    }
}

#[test]
fn belt_that_nothing_drives_stays_as_it_is_laid() {
    let history = run(&text(0.0, ""));
    for wheel in ["driver", "driven"] {
        for side in ["in", "out"] {
            let tension = history.last(&format!("{wheel}.{side}.tension")).unwrap();
            assert!((tension / REST - 1.0).abs() < 1e-9, "{tension}");
        }
        assert!(history.last(&format!("{wheel}.spin")).unwrap().abs() < 1e-9);
    }
}

#[test]
fn belt_of_two_sizes_and_a_crossed_one_are_laid_as_by_hand() {
    let wheel = |x: f64, radius: f64, way: f64| Stop::Wheel {
        centre: [x, 0.0, 0.0],
        axis: [0.0, way, 0.0],
        radius,
        side: Side::About,
    };
    let (large, small, apart) = (0.3, 0.1, 1.0);
    let off = |a: V3<f64>, b: V3<f64>| (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
    for (way, lean) in [(1.0, f64::asin((large - small) / apart)), (-1.0, f64::asin((large + small) / apart))]
    {
        let turns = lay_closed(&[wheel(0.0, large, 1.0), wheel(apart, small, way)]).unwrap();
        let second = if way > 0.0 { PI - 2.0 * lean } else { PI + 2.0 * lean };
        approx::assert_abs_diff_eq!(turns[0].wrap, PI + 2.0 * lean, epsilon = 1e-12);
        approx::assert_abs_diff_eq!(turns[1].wrap, second, epsilon = 1e-12);
        for k in 0..2 {
            let free = off(turns[k].at[1], turns[1 - k].at[0]);
            approx::assert_abs_diff_eq!(free, apart * lean.cos(), epsilon = 1e-12);
        }
    }
    // three wheels, over and under: the middle one presses on the lower side from below
    let side = |up: f64| Side::Towards([0.0, 0.0, up]);
    let about = |x: f64, z: f64, side: Side| Stop::Wheel {
        centre: [x, 0.0, z],
        axis: [0.0, 1.0, 0.0],
        radius: 0.1,
        side,
    };
    let stops = [about(0.0, 0.0, Side::About), about(1.0, 0.0, Side::About), about(0.5, -0.15, side(1.0))];
    let turns = lay_closed(&stops).unwrap();
    assert_eq!(turns.len(), 3);
    assert!(turns[2].axis[1] < 0.0 && turns[0].wrap > PI, "{turns:?}");
    // the sum of all turns is one
    let sum: f64 = turns.iter().map(|turn| turn.wrap * turn.axis[1]).sum();
    approx::assert_abs_diff_eq!(sum, 2.0 * PI, epsilon = 1e-12);
}

#[test]
fn what_is_no_belt_is_refused() {
    let with = |route: &str| {
        let scene = text(1.0, "");
        let (before, rest) = scene.split_once("route = [").unwrap();
        let (_, after) = rest.split_once("}]").unwrap();
        refused(&format!("{before}route = [{route}]{after}"))
    };
    let one = with("{ round = \"driver\" }");
    assert!(one.contains("a closed belt has none"), "{one}");
    let half = with("{ round = \"driver\" }, { round = \"driven\" }, { end = [0, 0, 1] }");
    assert!(half.contains("begins and ends with"), "{half}");
    let winch = "[[constraints]]\ntype = \"winch\"\nname = \"winch\"\nmarker = \"belt.start\"\nspeed = 1\n";
    let fed = refused(&text(1.0, winch));
    assert!(fed.contains("closed belt"), "{fed}");
    let mark = "[[records]]\ntype = \"position\"\nof = \"belt.start\"\n";
    let marked = SceneFile::parse(&text(1.0, mark), "belt", Format::Toml, &[])
        .map_err(|e| e.to_string())
        .and_then(|file| simulate(&file.into_scene()).map(drop).map_err(|e| e.to_string()))
        .expect_err("it has no start");
    assert!(marked.contains("no ends"), "{marked}");
}
