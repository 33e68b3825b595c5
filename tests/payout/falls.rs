//! Tackles of many falls, one element each: what friction and the number of sheaves cost.

use crate::hoist::Hoist;
use ropewalk::scene::Format;
use ropewalk::{History, SceneFile, simulate};
use ropewalk_scene::Scene;

/// Sheaves as tables of cranes have them.
const RUBS: &str = "efficiency = 0.98";

/// A hook block of 2 t on so many falls, hoisted by a drum after a second.
fn tackle(falls: usize, wheel: &str) -> Scene {
    read(&Hoist { falls, wheel, ..Hoist::default() }.text())
}

fn read(text: &str) -> Scene {
    SceneFile::parse(text, "tackle", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}")).into_scene()
}

fn run(scene: &Scene) -> History {
    simulate(scene).unwrap_or_else(|e| panic!("{e}"))
}

fn per_step(history: &History) -> f64 {
    let counts = &history.counts;
    counts.newton_iterations as f64 / counts.steps as f64
}

#[test]
fn friction_on_twelve_sheaves_costs_an_iteration_per_step_at_most() {
    let free = run(&tackle(12, ""));
    let rubs = run(&tackle(12, RUBS));
    let [a, b] = [&free, &rubs].map(per_step);
    println!("{a} and {b} iterations per step; {:?}, {:?}", free.counts, rubs.counts);
    assert!(b <= a + 1.0, "{b} iterations per step for {a}");
    // both hoist: 0.3 m/s for 5 s
    for history in [&free, &rubs] {
        let rise = history.last("block.z").unwrap() - 4.0;
        assert!((rise - 1.5).abs() < 0.02, "{rise} m");
    }
    // by what each sheave takes, the drum pulls more: falls are T, T e, T e², … with e for half a turn, and the first
    // sheave turns the rope by less
    let mean = |history: &History, column: &str| {
        let x = &history.column(column).unwrap()[20..];
        x.iter().sum::<f64>() / x.len() as f64
    };
    let e = 1.0_f64 / 0.98;
    let share = (0..12).map(|k| e.powi(-k)).sum::<f64>() / 12.0;
    let exact = e.powf(mean(&rubs, "head.1.wrap") / std::f64::consts::PI) / share;
    let more = mean(&rubs, "drum.torque") / mean(&free, "drum.torque");
    println!("the drum pulls {more} times as much, for {exact}");
    assert!((more / exact - 1.0).abs() < 0.01, "{more} for {exact}");
}

#[test]
fn cost_grows_with_the_number_of_sheaves_and_no_faster() {
    let mut rows = Vec::new();
    for falls in [2, 4, 8, 12, 24] {
        let hoist = Hoist { falls, wheel: RUBS, speed: 0.1, ramp: 3.0, guided: true, ..Hoist::default() };
        let scene = read(&hoist.text());
        let model = scene.build().expect("model");
        let structure = model.structure();
        let (unknowns, entries) = (structure.n, structure.entries());
        let history = run(&scene);
        // that a rope comes to its grooves from the side makes nothing flutter
        let unstable = history.warnings.iter().find(|w| w.contains("not stable"));
        assert!(unstable.is_none(), "{falls} falls: {unstable:?}");
        println!(
            "{falls} falls: {unknowns} unknowns, {entries} entries, {} per step, {:?}",
            per_step(&history),
            history.counts
        );
        rows.push((falls as f64, entries as f64, per_step(&history)));
    }
    // stored entries of the matrix by fall: each more sheave adds the same
    let by_fall: Vec<f64> = rows.windows(2).map(|w| (w[1].1 - w[0].1) / (w[1].0 - w[0].0)).collect();
    let (least, most) = by_fall.iter().fold((f64::INFINITY, 0.0_f64), |(l, m), x| (l.min(*x), m.max(*x)));
    assert!(most <= 1.15 * least, "{by_fall:?} entries by fall");
    // and an iteration doesn't become one of more work by being one of many
    assert!(rows.iter().all(|row| row.2 <= rows[0].2 + 1.0), "{rows:?}");
}

#[test]
fn friction_of_sheaves_cuts_no_steps_in_steady_hoisting() {
    for falls in [4, 12] {
        let hoist = |wheel| {
            let all = Hoist { falls, wheel, speed: 0.1, ramp: 3.0, duration: 20.0, ..Hoist::default() };
            Hoist { guided: true, ..all }
        };
        let [free, rubs] = ["", RUBS].map(|wheel| run(&read(&hoist(wheel).text())));
        println!("{falls} falls: {:?}, {:?}", free.counts, rubs.counts);
        assert!(per_step(&rubs) <= per_step(&free) + 1.0);
        // what begins to slip sets the falls trembling, which smooth ramps without friction don't: steps that follow it are tried
        // twice now and then, by the error of positions
        let (tries, steps) = (rubs.counts.rejected as f64, rubs.counts.steps as f64);
        assert!(
            tries <= (1.1 * free.counts.rejected as f64).max(0.25 * steps),
            "{tries} rejected in {steps} steps"
        );
    }
}

#[test]
fn steady_hoisting_cuts_no_steps() {
    let scene = tackle(12, RUBS);
    let history = run(&scene);
    let counts = &history.counts;
    assert!(counts.rejected as f64 <= 0.05 * counts.steps as f64, "{counts:?}");
}

#[test]
fn loose_tolerances_leave_the_tension_of_falls_right_to_a_per_cent() {
    let hoist = Hoist { wheel: RUBS, speed: 0.1, ramp: 3.0, duration: 8.0, ..Hoist::default() };
    let of = |tolerance: f64| {
        let controlled =
            format!("solver = {{ stepping = {{ controlled = {{ tolerance = {tolerance} }} }} }}\n");
        run(&read(&(controlled + &hoist.text())))
    };
    let tension = |history: &History| history.column("head.1.in.tension").expect("tension").to_vec();
    let [exact, strict, loose] = [1e-5, 1e-3, 1e-2].map(of);
    assert!(3 * loose.counts.steps < 2 * strict.counts.steps, "{:?} {:?}", loose.counts, strict.counts);
    let (right, got) = (tension(&exact), tension(&loose));
    let largest = right.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let most = right.iter().zip(&got).map(|(a, b)| (a - b).abs() / largest).fold(0.0, f64::max);
    println!("{most} of the tension, {:?}", loose.counts);
    assert!(most < 0.01 && got.iter().all(|x| x.is_finite()), "{most} of the tension");
}

/// The same tackle up and down by 5.7 m of rope every minute.
pub(super) fn up_and_down(text: &str) -> String {
    let drive = r#"
        solver = { stepping = { controlled = { tolerance = 1e-3 } }, horizon = "20 s" }
        [[inputs]]
        name = "hoist"
        unit = "m/s"
        min = -1
        max = 1
        join = "smooth"
        [[controllers]]
        type = "expression"
        input = "hoist"
        value = "0.6 m/s * sin(t * 6.283185307179586 / 60 s)"
        every = "1 s"
        [[elements]]"#;
    let text = text.replacen("[[elements]]", drive, 1).replace("start = 0.5\n", "").replace("ramp = 1\n", "");
    let (before, rest) = text.split_once("speed = -").expect("the speed of the drum");
    let (_, after) = rest.split_once('\n').expect("a line");
    format!("{before}speed = {{ input = \"hoist\" }}\n{after}")
}

/// Sixty times.
#[test]
#[ignore = "an hour of hoisting takes two minutes"]
fn an_hour_of_hoisting_keeps_its_energy() {
    let hoist = Hoist { falls: 4, wheel: RUBS, duration: 3600.0, output: 60.0, ..Hoist::default() };
    let text = up_and_down(&hoist.text());
    let history = run(&read(&text));
    let most = |name: &str| history.column(name).expect(name).iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let (imbalance, lost) = (most("energy.imbalance"), most("energy.dissipated"));
    println!("{imbalance} J of {lost} J, {} iterations per step, {:?}", per_step(&history), history.counts);
    assert!(imbalance < 1e-4 * lost, "{imbalance} J of {lost} J");
    // that friction is not in the equilibrium, and how many steps it takes
    assert!(history.warnings.len() <= 2, "{:?}", history.warnings);
    let rise = history.last("block.z").expect("block") - history.column("block.z").expect("block")[0];
    assert!(rise.abs() < 0.1, "{rise} m");
}

#[test]
fn looking_at_a_tackle_changes_no_step_of_it() {
    // its mass matrix changes as rope comes and goes, and its error is estimated with that
    let hoist = |output: f64| Hoist { falls: 4, wheel: RUBS, output, duration: 4.0, ..Hoist::default() };
    let [often, never] = [0.05, 4.0].map(|output| run(&read(&hoist(output).text())));
    println!("{:?}, {:?}", often.counts, never.counts);
    assert_eq!(often.counts.steps, never.counts.steps);
    assert_eq!(often.counts.rejected, never.counts.rejected);
    for column in ["block.z", "block.x", "drum.torque"] {
        assert_eq!(often.last(column), never.last(column), "{column}");
    }
}
