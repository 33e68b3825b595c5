//! How long a motion remembers its errors, and what that makes of long runs.

use ropewalk::{Options, Simulation, simulate};
use ropewalk_core::integrator::Scheme;
use ropewalk_core::integrator::Stepping;
use ropewalk_scene::{Format, Scene, SceneFile};

fn read(text: &str) -> Scene {
    SceneFile::parse(text, "scene", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}")).into_scene()
}

/// An umbilical of 2 km that is heaved, in water that flows.
fn umbilical(duration: f64) -> Scene {
    heaved(2000.0, duration)
}

/// The same of another length [m].
fn heaved(length: f64, duration: f64) -> Scene {
    let text = format!(
        r#"
water = {{ profile = [{{ z = -2400, velocity = [0, 0, 0] }}, {{ z = -200, velocity = [0.2, 0, 0] }}, {{ z = 0, velocity = [1, 0, 0] }}] }}
run = {{ duration = {duration}, output = "0.5 s" }}
elements = [
  {{ type = "cable", name = "u", points = [[0, 0, 0], [0, 0, -{length}]], elements = 24, section = {{ mass = 3, ea = 2e7, ei = 100, diameter = 0.04, axial_retardation_time = 0.01 }} }},
]
constraints = [{{ type = "driving", name = "top", marker = "u.start", motion = "heave" }}]
forces = [{{ type = "gravity" }}, {{ type = "buoyancy" }}, {{ type = "drag" }}, {{ type = "added_mass" }}]
motions = [{{ type = "harmonic", name = "heave", amplitude = [0, 0, 2], frequency = 0.1 }}]
records = [{{ type = "along", of = "u", what = "tension", at = "start" }}]
"#
    );
    read(&text)
}

fn steps(scene: &Scene) -> u64 {
    simulate(scene).unwrap_or_else(|e| panic!("{e}")).summary().counts.steps
}

#[test]
fn steps_of_what_forgets_grow_with_time() {
    let [short, long] = [1280.0, 5120.0].map(|t| steps(&umbilical(t)) as f64);
    println!("{short} and {long} steps");
    assert!(long <= 4.8 * short, "{short} and {long} steps");
    // the whole run as the horizon takes time to the power of 3/2
    let mut whole = umbilical(1280.0);
    whole.solver.horizon = 1280.0;
    let whole = steps(&whole) as f64;
    assert!(short <= 0.7 * whole, "{short} steps, {whole} without");
}

/// Here violent moments lie in the way of the looks ahead.
#[test]
fn steps_of_a_short_line_grow_with_time_as_well() {
    let [short, long] = [320.0, 1280.0].map(|t| steps(&heaved(500.0, t)) as f64);
    println!("{short} and {long} steps");
    assert!(long <= 4.8 * short, "{short} and {long} steps");
}

#[test]
fn the_tension_of_what_forgets_is_within_its_tolerance() {
    let fine = |scene: &mut Scene| {
        scene.solver.stepping = Stepping::Controlled { tolerance: 1e-6 };
        (scene.solver.force_tolerance, scene.solver.horizon) = (3e-4, 60.0);
    };
    let mut reference = umbilical(640.0);
    fine(&mut reference);
    let [got, want] = [umbilical(640.0), reference].map(|s| simulate(&s).unwrap_or_else(|e| panic!("{e}")));
    let name = "u.start.tension";
    let (got, want) = (got.column(name).expect(name), want.column(name).expect(name));
    let largest = want.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    assert_eq!(got.len(), want.len());
    for (a, b) in got.iter().zip(want) {
        assert!((a - b).abs() <= 0.01 * largest, "{a} instead of {b} N, of {largest} N");
    }
}

/// A slack hose that glides down forgets how it swings soon, and how far it has glided hardly at all: the errors of a few
/// steps are of the first kind, what adds up over many of the other.
#[test]
fn a_hose_that_glides_is_within_its_tolerance() {
    let ends = |change: &dyn Fn(&mut Scene)| {
        let mut scene = ropewalk::read("hose-straight").expect("a bundled scene");
        change(&mut scene);
        let history = simulate(&scene).unwrap_or_else(|e| panic!("{e}"));
        let column = |axis: &str| history.column(&format!("hose.end.{axis}")).expect("the end").to_vec();
        ["x", "z"].map(column)
    };
    let [x, z] = ends(&|scene| {
        scene.solver.scheme = Scheme::RadauIia5;
        scene.solver.stepping = Stepping::Controlled { tolerance: 1e-7 };
    });
    for tolerance in [3e-5, 1e-5] {
        let [a, b] = ends(&|scene| scene.solver.stepping = Stepping::Controlled { tolerance });
        let off = (0..x.len()).map(|i| (a[i] - x[i]).hypot(b[i] - z[i]) / 30.0 / tolerance);
        let most = off.fold(0.0, |m: f64, e| if e <= m { m } else { e });
        println!("{tolerance:e}: off by {most:.2} times that");
        assert!(most <= 3.0, "{most} times {tolerance}");
    }
}

#[test]
fn what_forgets_nothing_has_the_whole_run_as_its_horizon() {
    let swing = |horizon: f64| {
        let text = r#"
run = { duration = 20, output = 1 }
elements = [
  { type = "rigid_body", name = "rod", position = [0.5, 0, 0], mass = 1, shape = { cuboid = { edges = [1, 0.1, 0.1] } }, points = { hook = [-0.5, 0, 0] } },
]
constraints = [{ type = "spherical", name = "hook", marker = "rod.hook" }]
forces = [{ type = "gravity" }]
"#;
        let mut scene = read(text);
        scene.solver.horizon = horizon;
        let count = steps(&scene);
        assert!(count > 2000, "{count} steps are too few for a measurement");
        count
    };
    // but for the moments in which a step errs by nothing
    let [auto, whole] = [swing(0.0), swing(20.0)];
    assert!(auto as f64 >= 0.99 * whole as f64, "{auto} steps, {whole} with the whole run as the horizon");
}

/// A checkpoint keeps what was measured, and what will be measured later is measured alike.
#[test]
fn a_run_that_forgets_goes_on_to_the_last_bit() {
    let scene = umbilical(640.0);
    let options: Options = scene.solver.clone();
    let build = || scene.build().unwrap_or_else(|e| panic!("{e}"));
    for at in [5.0, 200.0] {
        let mut one = Simulation::new(build(), &options, 640.0).unwrap();
        one.advance(at, f64::INFINITY, &mut ()).unwrap();
        let kept = one.checkpoint().unwrap();
        let mut two = Simulation::restore(build(), &options, 640.0, kept).unwrap();
        for s in [&mut one, &mut two] {
            s.advance(640.0, f64::INFINITY, &mut ()).unwrap();
        }
        assert_eq!(one.state, two.state);
    }
}

/// The first look finds a hose that sinks and forgets nothing; once the ship tows it, it does. With that look alone it took 15 910
/// steps.
#[test]
fn a_motion_that_becomes_another_is_looked_at_again() {
    let steps = steps(&ropewalk::read("hose-turn").expect("a bundled scene"));
    println!("{steps} steps");
    assert!(steps < 3000, "{steps} steps");
}
