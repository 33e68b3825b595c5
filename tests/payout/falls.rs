//! Tackles of many falls, one element each: what friction and the number of sheaves cost.

use ropewalk::scene::Format;
use ropewalk::{History, SceneFile, simulate};
use ropewalk_scene::Scene;
use std::fmt::Write as _;

/// A hook block of 2 t on so many falls, hoisted by a drum after a second.
fn tackle(falls: usize, wheel: &str) -> Scene {
    read(&text(falls, wheel))
}

fn read(text: &str) -> Scene {
    SceneFile::parse(text, "tackle", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}")).into_scene()
}

fn text(falls: usize, wheel: &str) -> String {
    let wheels = falls / 2;
    let mut route = String::from("{ wound = \"drum\" }");
    for k in 1..=wheels {
        let _ = write!(route, ", {{ over = \"head.{k}\" }}, {{ under = \"blocks.{k}\" }}");
    }
    let spacing = 0.06;
    let side = 0.5 * spacing * (wheels as f64 - 1.0);
    format!(
        r#"
        run = {{ duration = 6, output = 0.1, from_equilibrium = true }}
        [[elements]]
        type = "rigid_body"
        name = "block"
        position = [0, 0, 4]
        mass = 2000
        inertia = [200, 200, 100]
        centre = [0, 0, -0.6]
        [[elements]]
        type = "cable"
        name = "hoist"
        section = {{ mass = 1.5, ea = "15 MN", axial_retardation_time = "2 ms" }}
        elements = 1
        tension = {}
        route = [{route}, {{ end = [-0.25, {side}, 12] }}]
        [[constraints]]
        type = "drum"
        name = "drum"
        marker = [-6, {}, 2]
        axis = [0, 1, 0]
        radius = 0.3
        speed = {}
        start = 0.5
        ramp = 1
        wound_tension = {}
        [[constraints]]
        type = "spherical"
        name = "dead_end"
        marker = "hoist.end"
        [[constraints]]
        type = "sheave"
        name = "head"
        marker = [0, 0, 12]
        axis = [0, 1, 0]
        radius = 0.25
        count = {wheels}
        spacing = {spacing}
        {wheel}
        [[constraints]]
        type = "sheave"
        name = "blocks"
        marker = "block"
        axis = [0, 1, 0]
        radius = 0.25
        count = {wheels}
        spacing = {spacing}
        {wheel}
        [[forces]]
        type = "gravity"
        [[records]]
        type = "position"
        of = "block"
        [[records]]
        type = "drum"
        of = "drum"
        [[records]]
        type = "sheave"
        of = "head.1"
        [[records]]
        type = "energy"
        "#,
        2300.0 * 9.81 / falls as f64,
        -side,
        -0.3 * falls as f64,
        2300.0 * 9.81 / falls as f64,
    )
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
    let rubs = run(&tackle(12, "efficiency = 0.98"));
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
    for falls in [4, 8, 12] {
        let scene = tackle(falls, "efficiency = 0.98");
        let model = scene.build().expect("model");
        let entries = model.structure().entries();
        let history = run(&scene);
        println!("{falls} falls: {entries} entries, {} per step, {:?}", per_step(&history), history.counts);
        rows.push((entries as f64, per_step(&history)));
    }
    // stored entries of the matrix: each more sheave adds the same
    let [first, second] = [rows[1].0 - rows[0].0, rows[2].0 - rows[1].0];
    assert!(second <= 1.15 * first, "{first} and then {second} entries");
    assert!(rows[2].1 <= rows[0].1 + 1.0, "{rows:?}");
}

#[test]
fn steady_hoisting_cuts_no_steps() {
    let scene = tackle(12, "efficiency = 0.98");
    let history = run(&scene);
    let counts = &history.counts;
    assert!(counts.rejected as f64 <= 0.05 * counts.steps as f64, "{counts:?}");
}

/// Up and down by 5.7 m of rope, sixty times.
#[test]
#[ignore = "an hour of hoisting takes two minutes"]
fn an_hour_of_hoisting_keeps_its_energy() {
    let text = text(4, "efficiency = 0.98");
    let drive = r#"
        solver = { stepping = { controlled = { tolerance = 2e-3 } }, horizon = "20 s" }
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
    let text = text.replace("duration = 6, output = 0.1", "duration = 3600, output = 60");
    let text = text.replacen("[[elements]]", drive, 1).replace("start = 0.5\n", "").replace("ramp = 1\n", "");
    let text = text.replace("speed = -1.2", "speed = { input = \"hoist\" }");
    let history = run(&read(&text));
    let most = |name: &str| history.column(name).expect(name).iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let (imbalance, lost) = (most("energy.imbalance"), most("energy.dissipated"));
    println!("{imbalance} J of {lost} J, {} iterations per step, {:?}", per_step(&history), history.counts);
    assert!(imbalance < 1e-4 * lost, "{imbalance} J of {lost} J");
    assert!(history.warnings.is_empty(), "{:?}", history.warnings);
    let rise = history.last("block.z").expect("block") - history.column("block.z").expect("block")[0];
    assert!(rise.abs() < 0.1, "{rise} m");
}
