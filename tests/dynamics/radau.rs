//! Radau IIA: orders, errors against tolerances, work for precision, and what a run does beside stepping.

use crate::common::{everything, models, pendulum, place, size, tow_start};
use ropewalk_constraints::{DistanceSpec, SphericalSpec};
use ropewalk_core::integrator::{Counts, Options, Scheme, StepError, StepReport, Stepping, consistent};
use ropewalk_core::statics::{Statics, StaticsOptions};
use ropewalk_core::{Action, End, Event, Model, Observer, Plan, Sample, Simulation, State};
use ropewalk_elements::{CableSpec, PointMassSpec, Section};
use ropewalk_forces::{DragSpec, GravitySpec, PointForceSpec, TimeFunction};
use ropewalk_scene::{Scene, Water};
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex};

fn radau(stepping: Stepping) -> Options {
    Options { scheme: Scheme::RadauIia5, stepping, ..Options::default() }
}

fn fixed(h: f64) -> Options {
    radau(Stepping::Fixed { h })
}

fn controlled(tolerance: f64) -> Options {
    radau(Stepping::Controlled { tolerance })
}

fn start(scene: &Scene, options: &Options, duration: f64) -> Simulation {
    let model = scene.build().expect("model");
    let mut s = Simulation::new(model, options, duration).unwrap_or_else(|e| panic!("{e}"));
    s.keep_audit(false);
    s
}

fn go(s: &mut Simulation, t: f64) {
    assert_eq!(s.advance(t, f64::INFINITY, &mut ()).unwrap_or_else(|e| panic!("{e}")), End::Done);
}

fn largest(errors: impl IntoIterator<Item = f64>) -> f64 {
    errors.into_iter().fold(0.0, |m, e| if e.is_nan() { f64::INFINITY } else { m.max(e) })
}

/// Two soft elements, pinned, with a load that comes on smoothly, and their tip on a rod: a constraint whose force
/// depends on the motion.
fn rod() -> Scene {
    let mut scene = Scene::new();
    let ramp = TimeFunction::Ramp { from: 0.0, to: 1.0, t0: 0.0, t1: 0.5 };
    scene
        .element(CableSpec::straight("cable", [0.0; 3], [0.6, -0.8, 0.0], 2, Section::new(1.0, 20.0, 0.02)))
        .constraint(SphericalSpec::pin("pin", "cable.start"))
        .constraint(DistanceSpec {
            name: "rod".into(),
            marker: "cable.end".into(),
            to: [1.2, -0.4, 0.0].into(),
            length: None,
        })
        .force(PointForceSpec::new("cable@0.5", [0.0, -3.0, 0.5], ramp));
    scene
}

#[test]
fn orders_in_positions_velocities_and_multipliers() {
    let duration = 0.4;
    let run = |h: f64| {
        let options = Options { newton_tolerance: 1e-5, ..fixed(h) };
        let mut s = start(&rod(), &options, duration);
        go(&mut s, duration);
        assert_eq!(s.work.counts.rejected, 0);
        [s.state.q, s.state.v, s.state.lambda]
    };
    let runs: Vec<[Vec<f64>; 3]> = (0..4).map(|k| run(1e-2 / 2f64.powi(k))).collect();
    let change = |a: &[f64], b: &[f64]| largest(a.iter().zip(b).map(|(a, b)| (a - b).abs()));
    for (k, name) in ["q", "v", "λ"].iter().enumerate() {
        let changes: Vec<f64> = runs.windows(2).map(|w| change(&w[0][k], &w[1][k])).collect();
        let orders: Vec<f64> = changes.windows(2).map(|w| (w[0] / w[1]).log2()).collect();
        println!("{name}: changes {changes:?}, orders {orders:.2?}");
        assert!(orders.iter().all(|o| *o >= 4.0), "{name}: {orders:?}");
    }
}

/// The soft pendulum of the work-precision comparison: n = 16, full quadrature.
fn soft() -> Scene {
    pendulum(16, 1.0, Section::new(0.5, 5000.0, 0.1), models("L4+T3").expect("legal"), 9.81)
}

/// Tip of the soft pendulum at 1 s: an explicit Runge-Kutta method of order 6 with steps of 1e-5 s, in another code.
const TIP: [f64; 2] = [-0.831_109_48, 0.170_593_05];

#[test]
fn soft_pendulum_meets_the_tip_of_another_code_at_the_price_that_theory_knows() {
    // cost in microseconds per element as a study of the method modelled it
    let cost =
        |c: &Counts| 0.82 * c.newton_iterations as f64 + 1.6 * c.jacobians as f64 + 0.46 * c.steps as f64;
    for (tolerance, known) in [(1e-3, 415.0), (1e-4, 463.0), (1e-5, 887.0), (1e-6, 2700.0), (1e-7, 8479.0)] {
        let mut s = start(&soft(), &controlled(tolerance), 1.0);
        go(&mut s, 1.0);
        let (x, counts) = (place(&s.model, &s.state, "cable", 1.0), s.work.counts);
        let error = size([x[0] - TIP[0], x[1] - TIP[1], x[2]]);
        println!("tolerance {tolerance:e}: error {error:.1e}, cost {:.0}, {counts:?}", cost(&counts));
        // the reference has eight digits
        assert!(error < tolerance + 1e-8, "tolerance {tolerance:e}: {error:e}");
        assert!(cost(&counts) < 1.5 * known, "tolerance {tolerance:e}: {:.0} {counts:?}", cost(&counts));
        assert_eq!(counts.fallbacks, 0);
    }
}

/// Places along the part at ten instants, and the counts.
fn history(mut s: Simulation, part: &str, length: f64, duration: f64) -> (Vec<[f64; 3]>, Counts) {
    let mut all = Vec::new();
    for k in 1..=10 {
        go(&mut s, duration * f64::from(k) / 10.0);
        all.extend((1..=10).map(|j| place(&s.model, &s.state, part, length * f64::from(j) / 10.0)));
    }
    (all, s.work.counts)
}

/// The largest over the instants of the root mean square over the length.
fn distance(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let square = |(a, b): (&[f64; 3], &[f64; 3])| (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>();
    let mean = |(a, b): (&[[f64; 3]], &[[f64; 3]])| (a.iter().zip(b).map(square).sum::<f64>() / 10.0).sqrt();
    largest(a.chunks(10).zip(b.chunks(10)).map(mean))
}

#[test]
fn error_control_keeps_its_promise_on_a_pendulum() {
    let run = |tolerance: f64| history(start(&soft(), &controlled(tolerance), 1.0), "cable", 1.0, 1.0);
    let exact = run(1e-8).0;
    for tolerance in [1e-3, 1e-4, 1e-5, 1e-6] {
        let (got, counts) = run(tolerance);
        let ratio = distance(&got, &exact) / tolerance;
        println!("tolerance {tolerance:e}: true error {ratio:.3} of it, {counts:?}");
        assert!((0.02..6.0).contains(&ratio), "tolerance {tolerance:e}: {ratio}");
    }
}

#[test]
fn error_control_keeps_its_promise_when_a_tow_starts() {
    let run = |options: &Options| {
        let scene = tow_start();
        let model = scene.build().expect("model");
        let mut state = model.state();
        let mut statics = Statics::new(&model, &StaticsOptions::default()).expect("statics");
        statics.find(&mut state, true).unwrap_or_else(|e| panic!("{e}"));
        drop(statics);
        let mut s = Simulation::from(model, state, options, 8.0).expect("start");
        s.keep_audit(false);
        history(s, "hose", 30.0, 8.0)
    };
    let exact = run(&controlled(1e-8)).0;
    for tolerance in [1e-3, 1e-4, 1e-5, 1e-6] {
        // the largest step that a short run has by default would keep loose tolerances far from their bound
        let (got, counts) = run(&Options { h_max: Some(1.0), ..controlled(tolerance) });
        let ratio = distance(&got, &exact) / 30.0 / tolerance;
        println!("tolerance {tolerance:e}: true error {ratio:.3} of it, {counts:?}");
        // convergence of Newton's method asks for smaller steps than loose tolerances do, and leaves a tenth of what it did
        // when this bound was 1e-3
        assert!((1e-4..6.0).contains(&ratio), "tolerance {tolerance:e}: {ratio}");
    }
    // another method comes to the same
    let alpha = Options { scheme: Scheme::default(), ..controlled(1e-6) };
    let off = distance(&run(&alpha).0, &exact);
    assert!(off < 1e-4, "generalized-alpha is {off:e} m away");
}

#[test]
fn energy_is_accounted_for() {
    let mut s = start(&everything(), &fixed(2e-4), 1.0);
    s.keep_audit(true);
    go(&mut s, 1.0);
    let (imbalance, dissipated) = (s.audit.imbalance(), s.audit.dissipated);
    println!("imbalance {imbalance:.1e} J of {dissipated:.1} J dissipated");
    // the audit itself is the trapezoidal rule over the steps
    assert!(dissipated > 1.0 && imbalance.abs() < 1e-3 * dissipated, "{imbalance} of {dissipated}");
    // nothing is taken or brought to a pendulum
    let mut s = start(&soft(), &controlled(1e-6), 0.8);
    let before = s.model.energy(&s.state.at());
    go(&mut s, 0.8);
    let after = s.model.energy(&s.state.at());
    let drift = after.kinetic + after.potential - before.kinetic - before.potential;
    assert!(drift.abs() < 1e-4 * after.kinetic, "{drift} J of {}", after.kinetic);
}

#[test]
fn constraints_hold_in_positions_and_velocities() {
    let mut s = start(&rod(), &fixed(1e-2), 0.4);
    go(&mut s, 0.4);
    let before = s.state.clone();
    consistent(&s.model, &mut s.state, &mut s.work).expect("forces");
    let change = |a: &[f64], b: &[f64]| largest(a.iter().zip(b).map(|(a, b)| (a - b).abs()));
    assert!(change(&before.v, &s.state.v) < 1e-12);
    assert!(change(&before.lambda, &s.state.lambda) < 1e-9 * largest(before.lambda.iter().copied()));
    let mut g = vec![0.0; s.model.multipliers()];
    s.model.violations(&before.at(), &mut s.work.system, &mut g);
    assert!(largest(g.iter().map(|g| g.abs())) < 1e-10, "{g:?}");
}

/// The floor that a mass falls on.
struct Bounce(Arc<Mutex<Vec<f64>>>);

impl Event for Bounce {
    fn name(&self) -> String {
        "bounce".into()
    }
    fn value(&self, _: &Model, state: &State) -> f64 {
        state.q[2]
    }
    fn direction(&self) -> i8 {
        -1
    }
    fn act(&self, _: &Model, state: &mut State) -> Action {
        self.0.lock().expect("times").push(state.t);
        state.v[2] *= -0.8;
        Action::Restart
    }
}

#[test]
fn bounces_happen_when_and_where_they_should() {
    let mut scene = Scene::new();
    scene.element(PointMassSpec::new("ball", [0.0, 0.0, 1.0], 1.0)).force(GravitySpec::default());
    for options in [fixed(0.037), controlled(1e-4)] {
        let times = Arc::default();
        let mut s = start(&scene, &options, 2.0);
        s.add_event(Bounce(Arc::clone(&times)));
        go(&mut s, 2.0);
        let (mut t, mut v) = ((2.0f64 / 9.81).sqrt(), (2.0f64 * 9.81).sqrt());
        let times = times.lock().expect("times");
        assert!(times.len() >= 3, "{times:?}");
        for got in times.iter() {
            assert!((got - t).abs() < 1e-9, "{got} instead of {t}");
            v *= 0.8;
            t += 2.0 * v / 9.81;
        }
    }
}

/// Changes the mesh once, at a time.
struct Refine(f64);

impl Event for Refine {
    fn name(&self) -> String {
        "refine".into()
    }
    fn value(&self, _: &Model, state: &State) -> f64 {
        state.t - self.0
    }
    fn direction(&self) -> i8 {
        1
    }
    fn act(&self, _: &Model, _: &mut State) -> Action {
        let mesh: Vec<f64> = (0..=24).map(|k| f64::from(k) / 24.0).collect();
        let plan: Plan = [("cable".to_string(), mesh.into())].into_iter().collect();
        Action::Remesh(Box::new(soft().build_on(&plan).expect("model")))
    }
}

#[test]
fn a_run_goes_on_with_another_mesh() {
    let run = |remesh: bool| {
        let mut s = start(&soft(), &controlled(1e-5), 0.5);
        if remesh {
            s.add_event(Refine(0.25));
        }
        go(&mut s, 0.5);
        (place(&s.model, &s.state, "cable", 1.0), s.model.nodes().len())
    };
    let (whole, remeshed) = (run(false), run(true));
    assert_eq!((whole.1, remeshed.1), (17, 25));
    let off = size(std::array::from_fn(|i| whole.0[i] - remeshed.0[i]));
    println!("after remeshing the tip is {off:.1e} m away");
    assert!(off < 5e-3, "{off:e}");
}

#[test]
fn motion_does_not_depend_on_the_frame() {
    // a rotation about a slanted axis, and another place
    let r = [[2.0, -1.0, 2.0], [2.0, 2.0, -1.0], [-1.0, 2.0, 2.0]];
    let turned = |x: [f64; 3], shift: f64| -> [f64; 3] {
        std::array::from_fn(|i| (0..3).map(|j| r[i][j] / 3.0 * x[j]).sum::<f64>() + shift * (i as f64 - 2.0))
    };
    let run = |map: &dyn Fn([f64; 3], f64) -> [f64; 3]| {
        let section =
            Section { diameter: 0.03, bending_retardation_time: 1e-2, ..Section::new(2.0, 1e4, 1.0) };
        let mut scene = Scene::new();
        scene.water = Some(Water::default());
        scene
            .element(CableSpec::straight(
                "cable",
                map([0.0; 3], 50.0),
                map([2.0, 0.0, 0.0], 50.0),
                8,
                section,
            ))
            .constraint(SphericalSpec::pin("pin", "cable.start"))
            .set_gravity(map([0.0, 0.0, -9.81], 0.0))
            .force(GravitySpec::default())
            .force(DragSpec::default());
        let mut s = start(&scene, &fixed(1e-3), 0.4);
        go(&mut s, 0.4);
        place(&s.model, &s.state, "cable", 1.7)
    };
    let plain = turned(run(&|x, _| x), 50.0);
    let seen = run(&turned);
    let off = size(std::array::from_fn(|i| plain[i] - seen[i]));
    assert!(off < 1e-8, "{off:e}");
}

#[test]
fn a_failed_step_leaves_the_state_as_it_was() {
    for stepping in [Stepping::Fixed { h: 0.5 }, Stepping::Controlled { tolerance: 1e-4 }] {
        let options = Options { h_min: Some(0.4), h_start: Some(0.5), ..radau(stepping) };
        let mut s = start(&soft(), &options, 1.0);
        let before = s.state.clone();
        let error = s.advance(1.0, f64::INFINITY, &mut ()).expect_err("must fail");
        assert!(matches!(error, StepError::NoConvergence { .. }), "{error}");
        let text = error.to_string();
        assert!(text.contains("`cable`") && text.contains("t = 0.0") && text.contains("h_min"), "{text}");
        assert_eq!((s.state.q, s.state.v, s.state.t), (before.q, before.v, before.t));
    }
}

#[test]
fn bad_options_are_refused_and_all_good_ones_run() {
    for (bad, word) in [
        (fixed(0.0), "`h`"),
        (fixed(f64::NAN), "`h`"),
        (controlled(-1.0), "`tolerance`"),
        (Options { max_iterations: 1, ..fixed(1e-3) }, "max_iterations"),
        (Options { h_min: Some(0.0), ..fixed(1e-3) }, "h_min"),
    ] {
        let refused = Simulation::new(soft().build().expect("model"), &bad, 1.0).err().expect("refused");
        assert!(refused.to_string().contains(word), "{refused}");
    }
    let full = Options { newton: ropewalk_core::integrator::NewtonPolicy::Full, ..fixed(2e-3) };
    let raw = Options { filter_start: false, ..fixed(2e-3) };
    let ends = [full, raw, fixed(2e-3)].map(|options| {
        let mut s = start(&soft(), &options, 0.2);
        go(&mut s, 0.2);
        (place(&s.model, &s.state, "cable", 1.0), s.work.counts)
    });
    for (x, counts) in &ends {
        let off = size(std::array::from_fn(|i| x[i] - ends[2].0[i]));
        assert!(off < 1e-7, "{off:e}: {counts:?}");
    }
    assert!(ends[0].1.newton_iterations < ends[2].1.newton_iterations);
    assert!(ends[0].1.jacobians >= ends[0].1.newton_iterations);
}

/// Energies at samples, most of which lie inside of steps.
#[derive(Default)]
struct Energies(Vec<f64>);

impl Observer for Energies {
    fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()> {
        let e = sample.model.energy(&sample.at);
        self.0.push(e.kinetic + e.potential);
        ControlFlow::Continue(())
    }
}

#[test]
fn many_elements_run_with_the_same_defaults() {
    let step = fixed(1e-3);
    let all = [(8, 0.5, &step), (512, 0.05, &step), (8192, 0.005, &step), (2048, 0.01, &controlled(1e-4))];
    for (n, duration, options) in all {
        let scene = pendulum(n, 1.0, Section::new(0.5, 5000.0, 0.1), models("L4+T3").expect("legal"), 9.81);
        let mut s = start(&scene, options, duration);
        let mut energies = Energies::default();
        s.advance(duration, 0.4e-3, &mut energies).unwrap_or_else(|e| panic!("{e}"));
        let counts = s.work.counts;
        let drift = largest(energies.0.iter().map(|e| (e - energies.0[0]).abs()));
        println!("{n}: energy drifts by {drift:.1e} J, {counts:?}");
        assert!(s.state.is_finite() && place(&s.model, &s.state, "cable", 1.0)[1] < 0.0);
        assert!(counts.rejected == 0 && counts.fallbacks == 0, "{n}: {counts:?}");
        assert!(drift < 1e-4, "{n}: {drift:e} J");
    }
}

#[test]
fn scenes_name_it() {
    let options: Options = serde_json::from_str(r#"{ "scheme": "radau-iia-5" }"#).expect("options");
    assert_eq!(options.scheme, Scheme::RadauIia5);
    assert_eq!(serde_json::to_value(&options).expect("options")["scheme"], "radau-iia-5");
}

/// Counts steps.
#[derive(Default)]
struct Steps(u64);

impl Observer for Steps {
    fn step(&mut self, _: &Model, _: &State, _: &StepReport) -> ControlFlow<()> {
        self.0 += 1;
        ControlFlow::Continue(())
    }
}

#[test]
fn stepping_does_not_allocate() {
    for options in [fixed(1e-3), controlled(1e-5)] {
        let mut s = start(&everything(), &options, 1.0);
        s.keep_audit(true);
        let mut steps = Steps::default();
        s.advance(0.2, f64::INFINITY, &mut steps).expect("run");
        let warm = steps.0;
        let count = |s: &mut Simulation, steps: &mut Steps, t: f64| {
            allocation_counter::measure(|| {
                s.advance(t, f64::INFINITY, steps).expect("run");
            })
            .count_total
        };
        // what an interval costs for itself, whatever its length
        let short = count(&mut s, &mut steps, 0.205);
        let few = steps.0 - warm;
        let rejected = s.work.counts.rejected;
        let long = count(&mut s, &mut steps, 0.5);
        let rejected = s.work.counts.rejected - rejected;
        let many = steps.0 - warm - few;
        println!("{short} allocations in {few} steps, {long} in {many}");
        assert!(many > 5 * few);
        // a step that is rejected says why
        assert!(long <= short + 4 + 12 * rejected, "{short} allocations in {few} steps, {long} in {many}");
    }
}
