//! What a run does beside stepping: events, restarts, other meshes, failures, energies, memory.

use crate::common::{everything, models, pendulum, place, size};
use ropewalk_constraints::SphericalSpec;
use ropewalk_core::integrator::{Limit, Options, Scheme, StepError, StepReport, Stepping};
use ropewalk_core::{Action, End, Event, Model, Observer, Plan, Simulation, State};
use ropewalk_elements::{CableSpec, PointMassSpec, Section};
use ropewalk_forces::{DragSpec, GravitySpec, SpringSpec};
use ropewalk_scene::{Scene, Water};
use std::ops::ControlFlow;

fn fixed(h: f64) -> Options {
    Options { stepping: Stepping::Fixed { h }, ..Options::default() }
}

#[test]
fn states_of_other_models_are_refused() {
    let ball = |count: usize| {
        let mut scene = Scene::new();
        for k in 0..count {
            scene.element(PointMassSpec::new(&format!("ball{k}"), [k as f64, 0.0, 0.0], 1.0));
        }
        scene.build().expect("model")
    };
    let mut s = Simulation::new(ball(1), &Options::default(), 1.0).expect("start");
    let other = ball(2).state();
    let e = Simulation::from(ball(1), other.clone(), &Options::default(), 1.0).err().expect("refused");
    assert_eq!(e, StepError::Foreign("it has 6 coordinates, the model 3".into()));
    s.state = other;
    assert!(matches!(s.advance(1.0, 0.1, &mut ()), Err(StepError::Foreign(_))));
}

/// The floor that a mass falls on.
struct Bounce {
    restitution: f64,
    times: std::sync::Arc<std::sync::Mutex<Vec<f64>>>,
}

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
        self.times.lock().expect("times").push(state.t);
        state.v[2] *= -self.restitution;
        Action::Restart
    }
}

#[test]
fn bounces_happen_when_and_where_they_should() {
    let mut scene = Scene::new();
    scene.element(PointMassSpec::new("ball", [0.0, 0.0, 1.0], 1.0)).force(GravitySpec::default());
    for options in [fixed(0.037), Options::default()] {
        let times = std::sync::Arc::default();
        let mut s = Simulation::new(scene.build().expect("model"), &options, 2.0).expect("start");
        s.add_event(Bounce { restitution: 0.8, times: std::sync::Arc::clone(&times) });
        assert_eq!(s.advance(2.0, f64::INFINITY, &mut ()), Ok(End::Done));
        let (mut t, mut v) = ((2.0f64 / 9.81).sqrt(), (2.0f64 * 9.81).sqrt());
        let times = times.lock().expect("times");
        assert!(times.len() >= 3, "{times:?}");
        for got in times.iter() {
            assert!((got - t).abs() < 1e-9, "{got} instead of {t}");
            v *= 0.8;
            t += 2.0 * v / 9.81;
        }
        let since = 2.0 - times[times.len() - 1];
        assert!((s.state.q[2] - (v * since - 0.5 * 9.81 * since * since)).abs() < 1e-8);
    }
}

/// Changes the mesh once, at a time.
struct Refine {
    at: f64,
    scene: Scene,
    mesh: Vec<f64>,
    stop: bool,
}

impl Event for Refine {
    fn name(&self) -> String {
        "refine".into()
    }
    fn value(&self, _: &Model, state: &State) -> f64 {
        state.t - self.at
    }
    fn direction(&self) -> i8 {
        1
    }
    fn act(&self, _: &Model, _: &mut State) -> Action {
        if self.stop {
            return Action::Stop;
        }
        let plan: Plan = [("cable".to_string(), self.mesh.clone().into())].into_iter().collect();
        Action::Remesh(Box::new(self.scene.build_on(&plan).expect("model")))
    }
}

fn swinging() -> Scene {
    pendulum(24, 1.2, Section::new(10.0, 1e5, 0.85), models("L4(lob3)+T3(2)").expect("legal"), 9.81)
}

#[test]
fn a_run_goes_on_with_another_mesh() {
    let run = |remesh: bool| {
        let mut s = Simulation::new(swinging().build().expect("model"), &fixed(5e-4), 0.6).expect("start");
        if remesh {
            // finer towards the end, and not nested in the old mesh
            let mesh: Vec<f64> =
                (0..=40).map(|k| 1.2 * (1.0 - (1.0 - f64::from(k) / 40.0).powf(1.2))).collect();
            s.add_event(Refine { at: 0.3, scene: swinging(), mesh, stop: false });
        }
        assert_eq!(s.advance(0.6, f64::INFINITY, &mut ()), Ok(End::Done));
        (place(&s.model, &s.state, "cable", 1.2), s.model.nodes().len())
    };
    let (whole, remeshed) = (run(false), run(true));
    assert_eq!((whole.1, remeshed.1), (25, 41));
    let off: [f64; 3] = std::array::from_fn(|i| whole.0[i] - remeshed.0[i]);
    println!("after remeshing the tip is {:.1e} m away", size(off));
    assert!(size(off) < 2e-3, "{off:?}");
}

#[test]
fn an_event_ends_a_run() {
    let mut s = Simulation::new(swinging().build().expect("model"), &fixed(1e-3), 1.0).expect("start");
    s.add_event(Refine { at: 0.2503, scene: Scene::new(), mesh: vec![], stop: true });
    assert_eq!(s.advance(1.0, f64::INFINITY, &mut ()), Ok(End::Stopped { by: "refine".into() }));
    assert!((s.state.t - 0.2503).abs() < 1e-12);
}

#[test]
fn a_failed_step_leaves_the_state_as_it_was() {
    // one iteration too few for a step so large, and no smaller one allowed
    let options = Options { max_iterations: 2, h_min: Some(0.4), newton_tolerance: 1e-9, ..fixed(0.5) };
    let mut s = Simulation::new(swinging().build().expect("model"), &options, 1.0).expect("start");
    let before = s.state.clone();
    let error = s.advance(1.0, f64::INFINITY, &mut ()).expect_err("must fail");
    assert!(matches!(error, StepError::NoConvergence { .. }), "{error}");
    assert!(error.to_string().contains("`cable`") && error.to_string().contains("t = 0.0"), "{error}");
    assert_eq!((s.state.q, s.state.v, s.state.t), (before.q, before.v, before.t));
}

#[test]
fn a_run_without_an_end_is_refused() {
    for duration in [f64::INFINITY, f64::NAN] {
        let options = Options::default();
        let error = Simulation::new(swinging().build().expect("model"), &options, duration).err();
        let error = error.expect("must be refused").to_string();
        assert!(error.contains("the length of the run is a finite time"), "{error}");
    }
}

#[test]
fn energy_is_accounted_for() {
    let balance = |h: f64| {
        let mut s = Simulation::new(everything().build().expect("model"), &fixed(h), 1.0).expect("start");
        s.advance(1.0, f64::INFINITY, &mut ()).expect("run");
        (s.audit.imbalance(), s.audit.dissipated)
    };
    let (coarse, fine) = (balance(4e-4), balance(1e-4));
    println!("imbalance {:.1e} and {:.1e} J of {:.1} J dissipated", coarse.0, fine.0, fine.1);
    assert!(fine.1 > 1.0 && fine.0.abs() < 1e-3 * fine.1, "{fine:?}");
    assert!(fine.0.abs() < 0.3 * coarse.0.abs(), "{coarse:?} {fine:?}");
}

/// The scene turned about a slanted axis and seen from elsewhere.
fn turned(x: [f64; 3], shift: bool) -> [f64; 3] {
    // columns: an orthonormal frame
    let r = [
        [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0],
        [2.0 / 3.0, 2.0 / 3.0, -1.0 / 3.0],
        [-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0],
    ];
    let d = if shift { [100.0, -50.0, 20.0] } else { [0.0; 3] };
    std::array::from_fn(|i| (0..3).map(|j| r[i][j] * x[j]).sum::<f64>() + d[i])
}

#[test]
fn motion_does_not_depend_on_the_frame() {
    let run = |turn: bool, base: [f64; 3], end: [f64; 3], g: [f64; 3], to: [f64; 3]| {
        let section =
            Section { diameter: 0.03, bending_retardation_time: 1e-2, ..Section::new(2.0, 1e4, 1.0) };
        let mut scene = Scene::new();
        scene.water = Some(Water::default());
        scene
            .element(CableSpec::straight("cable", base, end, 8, section))
            .constraint(SphericalSpec::pin("pin", "cable.start"))
            .set_gravity(g)
            .force(GravitySpec::default())
            .force(DragSpec::default())
            .force(SpringSpec {
                name: "spring".into(),
                marker: "cable.end".into(),
                to: to.into(),
                stiffness: 5.0.into(),
                damping: 1.0.into(),
                length: Some(0.3.into()),
                tension_only: false,
            });
        let mut s = Simulation::new(scene.build().expect("model"), &fixed(1e-3), 0.5).expect("start");
        s.advance(0.5, f64::INFINITY, &mut ()).expect("run");
        let p = place(&s.model, &s.state, "cable", 1.7);
        if turn { p } else { turned(p, true) }
    };
    let (a, b, g, to) = ([0.0; 3], [2.0, 0.0, 0.0], [0.0, 0.0, -9.81], [1.0, 1.0, 0.5]);
    let plain = run(false, a, b, g, to);
    let seen = run(true, turned(a, true), turned(b, true), turned(g, false), turned(to, true));
    let off: [f64; 3] = std::array::from_fn(|i| plain[i] - seen[i]);
    assert!(size(off) < 1e-8, "{off:?}");
}

/// The same cable in other units of length, mass and time: the same steps, the same iterations, the same motion. Units
/// differ by powers of two, as metres from millimetres nearly do, so that they round alike: what still differs comes of a
/// number in the code that has a unit.
#[test]
fn motion_does_not_depend_on_units() {
    let run = |[l, m, t]: [f64; 3], options: &Options| {
        let force = m * l / (t * t);
        let section = Section::new(2.0 * m / l, 1e4 * force, force * l * l);
        let models = models("L4(lob3)+T3(2)").expect("legal");
        let scene = pendulum(8, 2.0 * l, section, models, 9.81 * l / (t * t));
        let mut s = Simulation::new(scene.build().expect("model"), options, 0.5 * t).expect("start");
        s.advance(0.5 * t, f64::INFINITY, &mut ()).expect("run");
        (place(&s.model, &s.state, "cable", 2.0 * l).map(|x| x / l), s.work.counts)
    };
    for scheme in [Scheme::default(), Scheme::RadauIia5] {
        let options = Options { scheme, ..Options::default() };
        let si = run([1.0; 3], &options);
        let k = 1024.0;
        for units in [[k, 1.0 / k, 1.0], [1.0 / k, 1.0, k], [0.5, 4.0, 0.125]] {
            let seen = run(units, &options);
            let off: [f64; 3] = std::array::from_fn(|i| si.0[i] - seen.0[i]);
            println!("{scheme:?} {units:?}: {:.1e}, {:?}", size(off), seen.1);
            assert!(size(off) < 1e-12, "{off:?}, {:?} and {:?}", si.1, seen.1);
            let work = |c: ropewalk_core::integrator::Counts| [c.steps, c.rejected, c.newton_iterations];
            assert_eq!(work(si.1), work(seen.1), "{scheme:?}, {units:?}");
        }
    }
}

#[test]
fn schemes_that_ring_are_refused_or_say_how_much() {
    let scheme = Scheme::AverageAcceleration;
    let refused =
        Simulation::new(swinging().build().expect("model"), &Options { scheme, ..fixed(1e-3) }, 1.0);
    assert!(refused.err().expect("refused").to_string().contains("allow_unstable"));
    let mut ringing = Vec::new();
    for scheme in [scheme, Scheme::Newmark { beta: 0.24, gamma: 0.5 }] {
        let options = Options { scheme, allow_unstable: true, ..fixed(1e-3) };
        let mut s = Simulation::new(swinging().build().expect("model"), &options, 1.0).expect("start");
        assert!(s.integrator.warning().is_some());
        // the second one blows up, which may end the run
        let _ = s.advance(0.05, f64::INFINITY, &mut ());
        ringing.push(s.ringing);
    }
    println!("ringing {ringing:?}");
    // from a consistent start the first has nothing to ring with; the second makes it out of rounding errors
    assert!(ringing[0] < 1e-3 && ringing[1] > 0.1, "{ringing:?}");
}

/// Counts allocations of every step but the first ones.
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
    for options in [fixed(1e-3), Options::default()] {
        let mut s = Simulation::new(everything().build().expect("model"), &options, 1.0).expect("start");
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
        let short = count(&mut s, &mut steps, 0.21);
        let few = steps.0 - warm;
        let long = count(&mut s, &mut steps, 0.5);
        let many = steps.0 - warm - few;
        println!("{short} allocations in {few} steps, {long} in {many}");
        assert!(many > 10 * few.max(1) || many > 100);
        assert!(long <= short + 4, "{short} allocations in {few} steps, {long} in {many}");
    }
}

/// What limited each step, and its size.
#[derive(Default)]
struct Limited(Vec<(Limit, f64)>);

impl Observer for Limited {
    fn step(&mut self, _: &Model, _: &State, report: &StepReport) -> ControlFlow<()> {
        self.0.push((report.limit, report.h));
        ControlFlow::Continue(())
    }
}

#[test]
fn every_step_says_what_kept_it_from_being_longer() {
    let limits = |options: &Options, advances: &[f64], event: bool| {
        let mut s = Simulation::new(swinging().build().expect("model"), options, 0.3).expect("start");
        if event {
            let mesh = (0..=30).map(|k| 1.2 * f64::from(k) / 30.0).collect();
            s.add_event(Refine { at: 0.2, scene: swinging(), mesh, stop: false });
        }
        let mut seen = Limited::default();
        for t in advances {
            s.advance(*t, f64::INFINITY, &mut seen).expect("run");
        }
        let counts = s.work.counts;
        assert_eq!(counts.limits.iter().sum::<u64>(), counts.steps);
        assert!(Limit::ALL.iter().all(|limit| {
            let count = seen.0.iter().filter(|(own, _)| own == limit).count() as u64;
            counts.limits[*limit as usize] == count
        }));
        seen.0
    };
    assert!(limits(&fixed(1e-3), &[0.1], false).iter().all(|(limit, _)| *limit == Limit::Fixed));
    for scheme in [Scheme::default(), Scheme::RadauIia5] {
        // strict enough that errors limit steps, not their bound
        let stepping = Stepping::Controlled { tolerance: 1e-6 };
        let adaptive = Options { scheme, stepping, ..Options::default() };
        let free = limits(&adaptive, &[0.3], false);
        println!("{scheme:?}: {:?}", free.iter().map(|(l, _)| l.word()).collect::<Vec<_>>());
        assert_eq!((free[0].0, free[free.len() - 1].0), (Limit::Start, Limit::Instant));
        let by_error = |seen: &[(Limit, f64)]| {
            seen.iter().filter(|(l, _)| matches!(l, Limit::Position | Limit::Force)).count()
        };
        assert!(by_error(&free) > free.len() / 2);
        // a bound that is below what the error allows limits all but the first
        let least = free.iter().skip(free.len() / 2).map(|(_, h)| *h).fold(f64::INFINITY, f64::min);
        let bounded = Options { h_max: Some(0.3 * least), ..adaptive.clone() };
        let bounded = limits(&bounded, &[0.1], false);
        let longest = bounded.iter().filter(|(limit, _)| *limit == Limit::Longest).count();
        assert!(
            longest > bounded.len() / 2 && by_error(&bounded) < longest,
            "{longest} of {}",
            bounded.len()
        );
        // where it has to stand, and where something happens
        let stands = limits(&adaptive, &[0.1, 0.2, 0.3], false);
        assert!(stands.iter().filter(|(limit, _)| *limit == Limit::Instant).count() >= 3);
        let events = limits(&adaptive, &[0.3], true);
        let at = events.iter().position(|(limit, _)| *limit == Limit::Event).expect("an event");
        // it is in the midst of the run, and what follows begins anew with a short step
        assert!(at > 0 && at + 1 < events.len() && events[at + 1].1 < 0.5 * events[at].1, "{at}");
    }
}

#[test]
fn very_many_steps_are_told_of_with_what_limits_them() {
    struct Told(Vec<String>);
    impl Observer for Told {
        fn warn(&mut self, message: &str) {
            self.0.push(message.to_string());
        }
    }
    let mut scene = Scene::new();
    scene.element(PointMassSpec::new("ball", [0.0, 0.0, 1.0], 1.0)).force(GravitySpec::default());
    let options = Options { h_max: Some(1e-5), ..Options::default() };
    let model = scene.build().expect("model");
    let (mut told, mut s) = (Told(Vec::new()), Simulation::new(model, &options, 1.2).expect("start"));
    s.keep_audit(false);
    s.advance(1.2, f64::INFINITY, &mut told).expect("run");
    let [warning] = &told.0[..] else { panic!("{:?}", told.0) };
    assert!(warning.contains("% limited by h_max: a longer `h_max` or"), "{warning}");
}
