//! Motion of pendulums against references; orders, errors and energies.

use crate::common::{data, models, number, pendulum, place, size};
use ropewalk::scene::Format;
use ropewalk::{History, SceneFile, simulate};
use ropewalk_constraints::DistanceSpec;
use ropewalk_core::integrator::{Options, Scheme, Stepping};
use ropewalk_core::{End, Simulation};
use ropewalk_elements::{CableSpec, PointMassSpec, Section};
use ropewalk_forces::{GravitySpec, PointForceSpec, TimeFunction};
use ropewalk_scene::Scene;

fn fixed(h: f64) -> Options {
    Options { stepping: Stepping::Fixed { h }, ..Options::default() }
}

fn controlled(tolerance: f64) -> Options {
    Options { stepping: Stepping::Controlled { tolerance }, ..Options::default() }
}

fn start(scene: &Scene, options: &Options, duration: f64) -> Simulation {
    let model = scene.build().expect("model");
    Simulation::new(model, options, duration).unwrap_or_else(|e| panic!("{e}"))
}

fn go(s: &mut Simulation, t: f64) {
    assert_eq!(s.advance(t, f64::INFINITY, &mut ()).unwrap_or_else(|e| panic!("{e}")), End::Done);
}

/// A mass on a rod, pulled down along -y.
fn rod_pendulum(at: [f64; 3], v: [f64; 3]) -> Scene {
    let mut mass = PointMassSpec::new("mass", at, 1.0);
    mass.velocity = v;
    let mut scene = Scene::new();
    scene
        .element(mass)
        .constraint(DistanceSpec {
            name: "rod".into(),
            marker: "mass".into(),
            to: [0.0; 3].into(),
            length: Some(1.0),
        })
        .set_gravity([0.0, -9.81, 0.0])
        .force(GravitySpec::default());
    scene
}

#[test]
fn inconsistent_start_is_refused() {
    // projected, it is a case of the verification suite
    let scene = rod_pendulum([0.6, -0.81, 0.0], [1.0, 0.3, 0.0]);
    let refused = Simulation::new(scene.build().expect("model"), &fixed(1e-3), 1.0).err().expect("refused");
    assert!(
        refused.to_string().contains("project = true") && refused.to_string().contains("rod"),
        "{refused}"
    );
}

fn stiff_section() -> Section {
    Section::new(5540.0 * 1.8e-3, 7e7 * 1.8e-3, 7e7 * 1.215e-8)
}

#[test]
fn stiff_pendulum_falls_as_the_reference() {
    let reference = &data("pendulum_ref.json")["stiff"];
    let times: Vec<f64> = reference["t"].as_array().expect("t").iter().map(number).collect();
    for (name, v) in reference["variants"].as_object().expect("variants") {
        let Some(m) = models(name) else { continue };
        let n = v["n"].as_u64().expect("n") as usize;
        let scene = pendulum(n, 1.2, stiff_section(), m, 9.81);
        let mut s = start(&scene, &fixed(1e-4), 1.0);
        let tip = v["tip"].as_array().expect("tip");
        let mut worst = 0.0f64;
        for (t, p) in times.iter().zip(tip).filter(|(t, _)| **t > 0.0 && **t < 1.0 + 1e-9) {
            go(&mut s, *t);
            let x = place(&s.model, &s.state, "cable", 1.2);
            let off = ((x[0] - number(&p[0])).powi(2) + (x[1] - number(&p[1])).powi(2)).sqrt();
            worst = if off.is_nan() { f64::INFINITY } else { worst.max(off) };
        }
        println!("{name} {n}: {worst:.1e} m, {:?}", s.work.counts);
        assert!(worst < 2e-5, "{name}: {worst:e}");
    }
}

/// The stiff cable, softened so that steps resolve its highest frequency, let go from its hanging equilibrium with
/// a swing that starts without a shock.
fn soft_pendulum(n: usize) -> Scene {
    let section = Section { axial_retardation_time: 0.0, ..Section::new(1.0, 400.0, 0.02) };
    let mut scene = Scene::new();
    let cable = CableSpec::straight("cable", [0.0; 3], [0.6, -0.8, 0.0], n, section);
    scene
        .element(cable)
        .constraint(ropewalk_constraints::SphericalSpec::pin("pin", "cable.start"))
        // the weight comes on smoothly: nothing jumps at the start
        .force(PointForceSpec::new(
            "cable.end",
            [0.0, -3.0, 0.5],
            TimeFunction::Ramp { from: 0.0, to: 1.0, t0: 0.0, t1: 0.25 },
        ));
    scene
}

#[test]
fn orders_in_positions_velocities_and_multipliers() {
    let duration = 0.25;
    for scheme in [Scheme::GeneralizedAlpha { rho_inf: 0.8 }, Scheme::Hht { alpha: -0.1 }] {
        let run = |h: f64| {
            let options = Options { scheme, newton_tolerance: 1e-4, ..fixed(h) };
            let mut s = start(&soft_pendulum(2), &options, duration);
            go(&mut s, duration);
            ropewalk_core::integrator::consistent(&s.model, &mut s.state, &mut s.work).expect("multipliers");
            [s.state.q, s.state.v, s.state.lambda]
        };
        let runs: Vec<[Vec<f64>; 3]> = (0..5).map(|k| run(1e-3 / 4f64.powi(k))).collect();
        let worst = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        for (k, name) in ["q", "v", "λ"].iter().enumerate() {
            let changes: Vec<f64> = runs.windows(2).map(|w| worst(&w[0][k], &w[1][k])).collect();
            let orders: Vec<f64> = changes.windows(2).map(|w| (w[0] / w[1]).log2() / 2.0).collect();
            println!("{scheme:?} {name}: changes {changes:?}, orders {orders:.2?}");
            assert!(orders.iter().all(|o| *o >= 1.9), "{scheme:?} {name}: {orders:?}");
        }
    }
}

#[test]
fn error_control_keeps_its_promise_on_a_pendulum() {
    let scene = |n| {
        pendulum(n, 1.2, Section::new(9.972, 25_200.0, 1.701), models("L4(lob3)+T3(2)").expect("legal"), 9.81)
    };
    let tips = |options: &Options| {
        let mut s = start(&scene(8), options, 1.0);
        let mut all = Vec::new();
        for k in 1..=10 {
            go(&mut s, 0.1 * f64::from(k));
            all.push(place(&s.model, &s.state, "cable", 1.2));
        }
        (all, s.work.counts)
    };
    let exact = tips(&fixed(2e-5)).0;
    for tolerance in [1e-3, 1e-4, 1e-5, 1e-6] {
        let (got, counts) = tips(&controlled(tolerance));
        let error = got
            .iter()
            .zip(&exact)
            .map(|(a, b)| size([a[0] - b[0], a[1] - b[1], a[2] - b[2]]))
            .fold(0.0f64, |m, e| if e.is_nan() { f64::INFINITY } else { m.max(e) });
        let ratio = error / 1.2 / tolerance;
        println!("tolerance {tolerance:e}: true error {ratio:.3} of it, {counts:?}");
        assert!((0.05..5.0).contains(&ratio), "tolerance {tolerance:e}: {ratio}");
    }
}

#[test]
fn eight_to_eight_thousand_elements_run_with_the_same_defaults() {
    for (n, duration) in [(8, 1.0), (512, 0.2), (8192, 0.02)] {
        let scene = pendulum(n, 1.2, stiff_section(), models("L4(lob3)+T3(2)").expect("legal"), 9.81);
        let mut s = start(&scene, &Options::default(), duration);
        go(&mut s, duration);
        println!("{n}: {:?}", s.work.counts);
        let tip = place(&s.model, &s.state, "cable", 1.2);
        assert!(s.state.is_finite() && tip[1] < 0.0);
        let counts = s.work.counts;
        assert!(5 * counts.rejected <= counts.steps && counts.fallbacks == 0, "{n}: {counts:?}");
    }
}

/// The height of the end of a rod of 1 m that spins about a hinge, from horizontal at 7 rad/s, by the classical Runge-Kutta
/// method: `θ'' = -3/2 g cos θ`.
fn spinning(times: &[f64]) -> Vec<f64> {
    let rate = |[angle, omega]: [f64; 2]| [omega, -1.5 * 9.81 * angle.cos()];
    let step = |y: [f64; 2], h: f64| {
        let by = |k: [f64; 2], h: f64| [y[0] + h * k[0], y[1] + h * k[1]];
        let a = rate(y);
        let b = rate(by(a, 0.5 * h));
        let c = rate(by(b, 0.5 * h));
        let d = rate(by(c, h));
        [0, 1].map(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]))
    };
    let (mut y, mut t) = ([0.0, 7.0], 0.0);
    let height = |&time: &f64| {
        let count = ((time - t) / 2e-4_f64).ceil();
        for _ in 0..count as usize {
            y = step(y, (time - t) / count);
        }
        t = time;
        y[0].sin()
    };
    times.iter().map(height).collect()
}

/// What iterations leave, and steps that grow and shrink with every turn, added up with the square of time: at 50 s it was 5 to
/// 50 times the tolerance.
#[test]
fn a_pendulum_spins_for_long_within_its_tolerance() {
    let damping = "scheme = { generalized-alpha = { rho_inf = 0.5 } }";
    let radau = "scheme = \"radau-iia-5\"";
    for (scheme, tolerance, duration) in
        [("", 1e-3, 50.0), ("", 1e-4, 20.0), (damping, 1e-4, 10.0), (radau, 1e-3, 50.0), (radau, 1e-4, 50.0)]
    {
        let text = format!(
            r#"
            gravity = [0, -9.81, 0]
            [run]
            duration = {duration}
            output = 0.05
            [solver]
            {scheme}
            stepping = {{ controlled = {{ tolerance = {tolerance} }} }}
            [[elements]]
            type = "rigid_body"
            name = "rod"
            position = [0, 0, 0]
            angular_velocity = [0, 0, 7]
            mass = 1
            inertia = [1e-4, {inertia}, {inertia}]
            centre = [0.5, 0, 0]
            points = {{ end = [1, 0, 0] }}
            [[constraints]]
            type = "revolute"
            name = "hinge"
            marker = "rod"
            to = [0, 0, 0]
            axis = [0, 0, 1]
            [[forces]]
            type = "gravity"
            [[records]]
            type = "position"
            of = "rod.end"
            "#,
            inertia = 1.0 / 12.0
        );
        let file = SceneFile::parse(&text, "spins", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
        let run = simulate(&file.into_scene()).unwrap_or_else(|e| panic!("{e}"));
        let [times, y] = ["t", "rod.end.y"].map(|name| run.column(name).expect("recorded"));
        let off = spinning(times).into_iter().zip(y).map(|(exact, y)| (exact - y).abs());
        let off = off.fold(0.0, |m: f64, d| if d > m || d.is_nan() { d } else { m }) / tolerance;
        println!("{scheme} {tolerance:e} {duration} s: {off:.3}, {:?}", run.counts);
        assert!((0.01..=3.0).contains(&off), "{scheme} {tolerance:e} {duration} s: {off}");
    }
}

/// A rod of 1 m that falls about a hinge so far from the origin [m].
fn far_away(x: f64, tolerance: f64) -> History {
    let text = format!(
        r#"
        gravity = [0, -9.81, 0]
        [run]
        duration = "2 s"
        output = "0.05 s"
        [solver]
        stepping = {{ controlled = {{ tolerance = {tolerance} }} }}
        [[elements]]
        type = "rigid_body"
        name = "rod"
        position = [{x}, 0, 0]
        mass = 1
        inertia = [1e-4, 0.0833, 0.0833]
        centre = [0.5, 0, 0]
        points = {{ end = [1, 0, 0] }}
        [[constraints]]
        type = "revolute"
        name = "hinge"
        marker = "rod"
        to = [{x}, 0, 0]
        axis = [0, 0, 1]
        [[forces]]
        type = "gravity"
        [[records]]
        type = "position"
        of = "rod.end"
        "#
    );
    let file = SceneFile::parse(&text, "far", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
    simulate(&file.into_scene()).unwrap_or_else(|e| panic!("{e}"))
}

/// Far from the origin rounding moves what takes many steps by more than the tolerance: then the run says so.
#[test]
fn rounding_beyond_the_tolerance_is_told() {
    let told = |h: &History| h.warnings.iter().any(|w| w.contains("rounding moves positions by"));
    let heights = |h: &History| h.table.column("rod.end.y").expect("recorded").values.clone();
    for (x, tolerance, beyond) in [(0.0, 1e-6, false), (1e4, 1e-4, false), (1e4, 1e-7, true)] {
        let (run, exact) = (far_away(x, tolerance), far_away(0.0, 1e-7));
        let off = heights(&run).into_iter().zip(heights(&exact)).map(|(a, b)| (a - b).abs());
        let off = off.fold(0.0, |m: f64, d| if d > m || d.is_nan() { d } else { m }) / tolerance;
        println!("{x} m, {tolerance:e}: {off:.2} tolerances, {:?}", run.warnings);
        assert_eq!(told(&run), beyond, "{:?}", run.warnings);
        assert!(if beyond { off > 1.0 } else { off <= 3.0 }, "{off}");
    }
}
