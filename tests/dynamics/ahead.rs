//! What changes with time is not stepped over: pulses, kinks of tables, jumps, motions; fixed steps say what they miss.

use ropewalk::scene::Format;
use ropewalk::{SceneFile, simulate};
use ropewalk_constraints::CoordinateSpec;
use ropewalk_core::integrator::{Options, Scheme, StepReport, Stepping};
use ropewalk_core::{
    Assembly, At, BuildError, End, Model, Motion, Moving, Observer, Pattern, Power, Simulation, State, Term,
    Timed,
};
use ropewalk_elements::PointMassSpec;
use ropewalk_forces::{PointForceSpec, TimeFunction};
use ropewalk_scene::{Builder, ForceSpec, MarkerRef, MotionSpec, Scene};
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;
use std::sync::Arc;

fn schemes() -> [Options; 2] {
    [Options::default(), Options { scheme: Scheme::RadauIia5, ..Options::default() }]
}

/// A mass of 1 kg that nothing holds, under what the scene adds.
fn mass() -> Scene {
    let mut scene = Scene::new();
    scene.element(PointMassSpec::new("ball", [0.0; 3], 1.0));
    scene
}

/// When steps ended.
#[derive(Default)]
struct Ends(Vec<f64>);

impl Observer for Ends {
    fn step(&mut self, _: &Model, state: &State, _: &StepReport) -> ControlFlow<()> {
        self.0.push(state.t);
        ControlFlow::Continue(())
    }
}

#[track_caller]
fn run(scene: &Scene, options: &Options, duration: f64) -> (Simulation, Vec<f64>) {
    let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
    let mut s = Simulation::new(model, options, duration).unwrap_or_else(|e| panic!("{e}"));
    let mut ends = Ends::default();
    assert_eq!(s.advance(duration, f64::INFINITY, &mut ends).unwrap_or_else(|e| panic!("{e}")), End::Done);
    (s, ends.0)
}

/// 1000 N for a millisecond, after an hour: half a newton second. The ball then flies at 0.5 m/s.
#[test]
fn a_pulse_of_a_millisecond_after_an_hour_at_rest_is_seen() {
    let mut scene = mass();
    let pulse = TimeFunction::Triangle { t0: 3600.0, peak: 3600.0005, t1: 3600.001 };
    scene.force(PointForceSpec::new("ball", [1000.0, 0.0, 0.0], pulse));
    for options in schemes() {
        let (s, ends) = run(&scene, &options, 3601.0);
        println!("{} steps, at {} m with {} m/s", ends.len(), s.state.q[0], s.state.v[0]);
        assert!((s.state.v[0] - 0.5).abs() < 1e-3, "{:?}: {} m/s", options.scheme, s.state.v[0]);
        assert!((s.state.q[0] - 0.5 * 0.9995).abs() < 1e-3, "{:?}: {} m", options.scheme, s.state.q[0]);
        assert!(ends.len() < 10_000, "{} steps", ends.len());
    }
}

/// The pulse on a hanging cable: 100 N rise and fall within half a second; the largest swing is that of steps of 1 ms.
#[test]
fn a_pulse_on_a_hanging_cable_is_seen() {
    let scene = include_str!("../data/pulse.toml");
    let largest = |solver: &str| {
        let text = format!("{solver}{scene}");
        let file = SceneFile::parse(&text, "pulse", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
        let history = simulate(file.scene()).unwrap_or_else(|e| panic!("{e}"));
        let x = history.column("c.end.x").expect("column");
        x.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
    };
    let fixed = largest("[solver]\nstepping = { fixed = { h = 1e-3 } }\n");
    let controlled = largest("");
    println!("{controlled} m, {fixed} m with fixed steps");
    assert!((controlled - fixed).abs() < 1e-2 * fixed && fixed > 1.0, "{controlled} {fixed}");
}

#[test]
fn steps_end_at_the_kinks_of_a_table_that_is_coarser_than_they_are() {
    let t = vec![0.37, 1.11, 1.93, 2.9];
    let mut scene = mass();
    let table = TimeFunction::table(t.clone(), vec![0.0, 2.0, -1.0, 0.0]);
    scene.force(PointForceSpec::new("ball", [1.0, 0.0, 0.0], table));
    for options in schemes() {
        let (s, ends) = run(&scene, &options, 4.0);
        for t in &t {
            assert!(ends.iter().any(|e| (e - t).abs() < 1e-12), "{:?}: no step ends at {t}", options.scheme);
        }
        // the shortest step isn't what was left over by accident
        let shortest = ends.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
        assert!(shortest > 1e-5, "{shortest}");
        // momentum is the area under the table
        let area = 0.5 * 2.0 * 0.74 + 0.5 * (2.0 - 1.0) * 0.82 - 0.5 * 0.97;
        assert!((s.state.v[0] - area).abs() < 1e-4, "{} instead of {area}", s.state.v[0]);
    }
}

/// The same load as a formula and as a table of 20,000 rows.
#[test]
fn a_fine_table_does_not_hold_up_the_steps() {
    let swing = |t: f64| (0.9 * t).sin();
    let t: Vec<f64> = (0..=20_000).map(|k| 1e-3 * f64::from(k)).collect();
    let value = t.iter().map(|t| swing(*t)).collect();
    let formula = TimeFunction::Harmonic {
        mean: 0.0,
        amplitude: 1.0,
        frequency: 0.9 / std::f64::consts::TAU,
        phase: 0.0,
    };
    let mut counts = Vec::new();
    for time in [formula, TimeFunction::table(t, value)] {
        let mut scene = mass();
        scene.force(PointForceSpec::new("ball", [1.0, 0.0, 0.0], time));
        let (s, ends) = run(&scene, &Options::default(), 20.0);
        let exact = 20.0 / 0.9 - (0.9f64 * 20.0).sin() / 0.81;
        assert!((s.state.q[0] - exact).abs() < 5e-4, "{} instead of {exact}", s.state.q[0]);
        counts.push(ends.len());
    }
    println!("steps {counts:?}");
    assert!(counts[1] < 2 * counts[0], "{counts:?}");
}

/// Half a newton for as long as `from..to`, from a term that tells more or less of it.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Thrust {
    from: f64,
    to: f64,
    tells: bool,
}

struct ThrustTerm(Thrust, usize);

impl Term for ThrustTerm {
    fn label(&self) -> String {
        "thrust".into()
    }
    fn pattern(&self, _: &mut Pattern) {}
    fn add(&self, at: &At<'_>, out: &mut Assembly<'_>) {
        if at.t >= self.0.from && at.t < self.0.to {
            out.add(self.1, -0.5);
        }
    }
    fn power(&self, at: &At<'_>) -> Power {
        let on = at.t >= self.0.from && at.t < self.0.to;
        Power { supplied: if on { 0.5 * at.v[self.1] } else { 0.0 }, ..Power::default() }
    }
    fn timed(&self) -> Option<&dyn Timed> {
        Some(self)
    }
}

impl Timed for ThrustTerm {
    fn jump(&self, t: f64) -> f64 {
        let all = [self.0.from, self.0.to].into_iter();
        if self.0.tells { all.filter(|x| *x > t).fold(f64::INFINITY, f64::min) } else { f64::INFINITY }
    }
    fn reach(&self, _: f64, h: f64) -> Option<f64> {
        self.0.tells.then_some(h)
    }
}

#[typetag::serde(name = "thrust")]
impl ForceSpec for Thrust {
    fn markers(&self) -> Vec<&MarkerRef> {
        Vec::new()
    }
    fn build(&self, b: &mut Builder) -> Result<(), BuildError> {
        let first = b.nodes()[0].v;
        b.term(Box::new(ThrustTerm(self.clone(), first)));
        Ok(())
    }
}

#[test]
fn a_force_that_jumps_starts_the_run_anew_there() {
    let mut scene = mass();
    scene.force(Thrust { from: 100.123, to: 100.456, tells: true });
    for options in schemes() {
        let (s, _) = run(&scene, &options, 110.0);
        let (v, x) = (0.5 * 0.333, 0.25 * 0.333 * 0.333 + 0.5 * 0.333 * (110.0 - 100.456));
        assert!((s.state.v[0] - v).abs() < 1e-9 && (s.state.q[0] - x).abs() < 1e-8, "{:?}", s.state);
    }
}

#[test]
fn a_term_that_tells_nothing_but_that_it_depends_on_time_is_looked_at_within_steps() {
    let mut scene = mass();
    scene.force(Thrust { from: 10.1, to: 10.5, tells: false });
    for options in schemes() {
        let (s, _) = run(&scene, &options, 20.0);
        assert!((s.state.v[0] - 0.2).abs() < 2e-3, "{:?}: {} m/s", options.scheme, s.state.v[0]);
    }
}

/// A bump of 1 m within 0.4 s, smooth, of which the motion tells nothing.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Bump {
    t0: f64,
}

impl Motion for Bump {
    fn at(&self, t: f64) -> Moving {
        let (w, u) = (std::f64::consts::PI / 0.4, t - self.t0);
        if !(0.0..0.4).contains(&u) {
            return Moving::default();
        }
        // sin⁴
        let (s, c) = (w * u).sin_cos();
        let x = s.powi(4);
        let (v, a) = (4.0 * w * s.powi(3) * c, 4.0 * w * w * (3.0 * s * s * c * c - s.powi(4)));
        Moving { x: [x, 0.0, 0.0], v: [v, 0.0, 0.0], a: [a, 0.0, 0.0] }
    }
}

#[typetag::serde(name = "bump")]
impl MotionSpec for Bump {
    fn name(&self) -> &str {
        "bump"
    }
    fn build(&self, _: &[Arc<dyn Motion>]) -> Result<Arc<dyn Motion>, BuildError> {
        Ok(Arc::new(self.clone()))
    }
}

#[test]
fn a_motion_that_tells_nothing_is_looked_at_within_steps() {
    let mut scene = mass();
    scene.motion(Bump { t0: 10.2 }).constraint(CoordinateSpec {
        name: "driven".into(),
        marker: "ball".into(),
        direction: [1.0, 0.0, 0.0],
        motion: Some("bump".into()),
    });
    for options in schemes() {
        let (_, ends) = run(&scene, &options, 20.0);
        let within = ends.iter().filter(|t| (10.2..10.6).contains(*t)).count();
        assert!(within >= 4, "{:?}: {within} steps", options.scheme);
    }
}

#[test]
fn fixed_steps_say_what_they_do_not_follow() {
    let fixed = Options { stepping: Stepping::Fixed { h: 5e-3 }, ..Options::default() };
    let faster = |time: TimeFunction| {
        let mut scene = mass();
        scene.force(PointForceSpec::new("ball", [1.0, 0.0, 0.0], time));
        let s = Simulation::new(scene.build().expect("model"), &fixed, 20.0).expect("start");
        s.faster_than(5e-3, 20.0)
    };
    let pulse = |width: f64| TimeFunction::Triangle { t0: 10.0, peak: 10.0 + 0.5 * width, t1: 10.0 + width };
    let hum = |frequency: f64| TimeFunction::Harmonic { mean: 0.0, amplitude: 1.0, frequency, phase: 0.0 };
    // a table may jump within a step, but not go to and fro
    let table = |t: Vec<f64>| TimeFunction::table(t, vec![0.0, 1.0, 0.0, 0.0]);
    for (time, expected) in [
        (pulse(1e-3), Some(10.0)),
        (pulse(0.5), None),
        (hum(100.0), Some(0.0)),
        (hum(10.0), None),
        (table(vec![7.0, 7.001, 7.002, 7.5]), Some(7.0)),
        (table(vec![7.0, 7.001, 9.0, 9.001]), None),
    ] {
        let said = faster(time.clone());
        match expected {
            Some(t) => assert!(
                matches!(said.as_slice(), [(who, when)] if who == "force at `ball`" && (when - t).abs() < 5e-3),
                "{time:?}: {said:?}"
            ),
            None => assert!(said.is_empty(), "{time:?}: {said:?}"),
        }
    }
}
