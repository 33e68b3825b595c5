//! Motion against references: pendulums, oscillators, free flight, sinking; orders, errors and energies.

mod common;

use common::{case, data, models, number, pendulum, place, size};
use ropewalk_constraints::DistanceSpec;
use ropewalk_core::integrator::{Options, Scheme, Stepping};
use ropewalk_core::{End, Scene, Simulation, Water};
use ropewalk_elements::{CableSpec, PointMassSpec, Section};
use ropewalk_forces::{
    AddedMassSpec, BuoyancySpec, DragSpec, GravitySpec, PointForceSpec, PointMomentSpec, SpringSpec,
    TimeFunction,
};

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
        .force(GravitySpec { g: [0.0, -9.81, 0.0], on: vec![] });
    scene
}

#[test]
fn simple_pendulum_of_the_benchmark_library() {
    let mut s = start(&rod_pendulum([-1.0, 0.0, 0.0], [0.0; 3]), &fixed(5e-4), 10.0);
    let e0 = s.model.energy(&s.state.at());
    for r in case("a01_simple_pendulum") {
        let Some((_, t)) = r.quantity.split_once("t=") else { continue };
        let t: f64 = t.trim_end_matches(" s").parse().expect("time");
        go(&mut s, t);
        let got = match &r.quantity[..1] {
            "x" => s.state.q[0],
            "y" => s.state.q[1],
            // the relation is the distance itself or its square; the force tells
            _ => {
                let f =
                    s.model.reaction(0, s.model.constraints()[0].nodes()[0], &s.state.at(), &s.state.lambda);
                size([f[0], f[1], f[2]])
            }
        };
        assert!((got - r.number()).abs() <= r.tolerance, "{}: {got} instead of {}", r.quantity, r.number());
        let e = s.model.energy(&s.state.at());
        let drift = e.kinetic + e.potential - e0.kinetic - e0.potential;
        assert!(drift.abs() < 5e-5, "energy drifts by {drift:e} J at {t} s");
    }
}

#[test]
fn inconsistent_start_is_refused_or_projected() {
    let scene = rod_pendulum([0.6, -0.81, 0.0], [1.0, 0.3, 0.0]);
    let refused = Simulation::new(scene.build().expect("model"), &fixed(1e-3), 1.0).err().expect("refused");
    assert!(
        refused.to_string().contains("project = true") && refused.to_string().contains("rod"),
        "{refused}"
    );
    let options = Options { project: true, filter_start: false, ..fixed(1e-6) };
    let s = start(&scene, &options, 1.0);
    let near = |a: f64, b: f64, eps: f64| assert!((a - b).abs() < eps, "{a} instead of {b}");
    near(s.state.q[0], 0.595_227_550_625_737_5, 1e-10);
    near(s.state.q[1], -0.803_557_193_344_745_7, 1e-10);
    near(s.state.v[0], 0.789_193_976_970_770_5, 1e-10);
    near(s.state.v[1], 0.584_588_131_089_459_7, 1e-10);
    near(s.state.a[0], -5.266_255_803_925_091, 1e-8);
    near(s.state.a[1], -2.700_554_664_701_126_5, 1e-8);
    let node = s.model.constraints()[0].nodes()[0];
    let f = s.model.reaction(0, node, &s.state.at(), &s.state.lambda);
    near(size([f[0], f[1], f[2]]), 8.847_466_483_009_564, 1e-8);
}

#[test]
fn signatures_of_the_schemes_on_an_oscillator() {
    for r in case("integrator_signature_linear_oscillator") {
        let Some((scheme, rest)) = r.quantity.split_once(": omega*h=") else { continue };
        let scheme = match &scheme[..3] {
            "New" => Scheme::AverageAcceleration,
            "HHT" => Scheme::Hht { alpha: -0.1 },
            _ => Scheme::GeneralizedAlpha { rho_inf: 0.8 },
        };
        let (omega_h, rest) = rest.split_once(", x and v*h after ").expect("format");
        let (omega_h, steps): (f64, f64) =
            (omega_h.parse().expect("number"), rest.trim_end_matches(" step(s)").parse().expect("number"));
        let h = 0.1;
        let mut scene = Scene::new();
        let stiffness = (omega_h / h).powi(2);
        scene.element(PointMassSpec::new("mass", [1.0, 0.0, 0.0], 1.0)).force(SpringSpec {
            name: "spring".into(),
            marker: "mass".into(),
            to: [0.0; 3].into(),
            stiffness,
            damping: 0.0,
            length: Some(0.0),
            tension_only: false,
        });
        // the bare scheme: a₀ = -ω² x₀, no remedy for the start, iterated to the end
        let options = Options { scheme, filter_start: false, newton_tolerance: 1e-9, ..fixed(h) };
        let mut s = start(&scene, &options, 10.0);
        go(&mut s, steps * h);
        let want = r.value.as_array().expect("pair");
        for (got, want) in [(s.state.q[0], number(&want[0])), (s.state.v[0] * h, number(&want[1]))] {
            let eps = 1e-9 * want.abs().max(1.0);
            assert!((got - want).abs() < eps, "{}: {got} instead of {want}", r.quantity);
        }
    }
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

#[test]
fn flexible_pendulum_released_horizontally() {
    for r in case("flexible_pendulum_released_horizontally") {
        let (ea, ei) = if r.quantity.contains("EA=1260 ") { (1260.0, 0.8505) } else { (25_200.0, 1.701) };
        // "gs" is Green's strain with the curvature of geometry
        let variant = if r.quantity.contains("law gs") { "L3+T2" } else { "L4(lob3)+T3(2)" };
        let (_, t) = r.quantity.split_once("at t=").expect("time");
        let t: f64 = t.trim_end_matches(" s").parse().expect("time");
        let scene = pendulum(60, 1.2, Section::new(9.972, ea, ei), models(variant).expect("legal"), 9.81);
        let mut s = start(&scene, &fixed(5e-4), t);
        go(&mut s, t);
        let (tip, mid) = (place(&s.model, &s.state, "cable", 1.2), place(&s.model, &s.state, "cable", 0.6));
        for (got, want) in [tip[0], tip[1], mid[0], mid[1]].into_iter().zip(r.numbers()) {
            assert!((got - want).abs() < r.tolerance, "{}: {got} instead of {want}", r.quantity);
        }
    }
}

#[test]
fn spaghetti_flies_as_the_reference() {
    let triangle = || TimeFunction::Triangle { t0: 0.0, peak: 2.5, t1: 5.0 };
    let all = case("flying_spaghetti_2d");
    for (ei, law, variant) in
        [(500.0, "eng", "L4(lob3)+T3(2)"), (100.0, "eng", "L4(lob3)+T3(2)"), (100.0, "gs", "L3+T2")]
    {
        let mut scene = Scene::new();
        let rod =
            CableSpec::straight("rod", [6.0, 0.0, 0.0], [0.0, 8.0, 0.0], 32, Section::new(1.0, 1e4, ei));
        let (l, t, i) = models(variant).expect("legal");
        scene
            .element(rod.models(l, t, i))
            .force(PointForceSpec::new("rod.start", [8.0, 0.0, 0.0], triangle()))
            .force(PointMomentSpec {
                marker: "rod.start".into(),
                local: false,
                moment: [0.0, 0.0, -80.0],
                time: triangle(),
            });
        let mut s = start(&scene, &fixed(2e-3), 10.0);
        let prefix = format!("EI={ei}, law {law}: ");
        let mut energy = 0.0;
        for r in all.iter().filter(|r| r.quantity.starts_with(&prefix)) {
            let Some((_, t)) = r.quantity.split_once("at t=") else {
                let off = energy / r.number() - 1.0;
                assert!(off.abs() < r.tolerance, "{}: {energy}", r.quantity);
                continue;
            };
            go(&mut s, t.trim_end_matches(" s").parse().expect("time"));
            let (a, b) = (place(&s.model, &s.state, "rod", 0.0), place(&s.model, &s.state, "rod", 10.0));
            for (got, want) in [a[0], a[1], b[0], b[1]].into_iter().zip(r.numbers()) {
                assert!(
                    (got - want).abs() < r.tolerance,
                    "{} {}: {got} instead of {want}",
                    s.state.t,
                    r.quantity
                );
            }
            let e = s.model.energy(&s.state.at());
            energy = e.kinetic + e.potential;
        }
    }
}

/// A cable of 1 m on its own in the water, its axis down from the horizontal by an angle.
fn sinking(angle: f64, added: f64) -> Scene {
    let (c, s) = (angle.cos(), angle.sin());
    let section = Section { diameter: 0.02, ..Section::new(0.6, 1e6, 10.0) };
    let mut scene = Scene::new();
    scene.water = Some(Water { density: 1000.0, ..Water::default() });
    scene
        .element(CableSpec::straight("rod", [0.0; 3], [c, 0.0, -s], 4, section))
        .force(GravitySpec::default())
        .force(BuoyancySpec::default())
        .force(DragSpec { cn: 1.2, ct: 0.02, ..DragSpec::default() })
        .force(AddedMassSpec { ca: added, ..AddedMassSpec::default() });
    scene
}

#[test]
fn cylinders_sink_as_the_closed_form() {
    for r in case("sinking_cylinder_drag") {
        if let Some(rest) = r.quantity.strip_prefix("axis ") {
            let angle: f64 = rest.split(' ').next().and_then(|a| a.parse().ok()).expect("angle");
            let mut s = start(&sinking(angle.to_radians(), 1.0), &fixed(1e-2), 30.0);
            go(&mut s, 30.0);
            let (sink, drift) = (-s.state.v[2], s.state.v[0]);
            let want = r.numbers();
            assert!(
                (sink - want[0]).abs() < 1e-4 && (drift - want[1]).abs() < 1e-4,
                "{}: {sink} {drift}",
                r.quantity
            );
            continue;
        }
        let added = if r.quantity.contains("Ca=1") { 1.0 } else { 0.0 };
        let (_, t) = r.quantity.split_once("t=").expect("time");
        let t: f64 = t.trim_end_matches(" s").parse().expect("time");
        let mut s = start(&sinking(0.0, added), &fixed(1e-3), t);
        go(&mut s, t);
        let got = if r.quantity.contains("depth") { -s.state.q[2] } else { -s.state.v[2] };
        assert!((got / r.number() - 1.0).abs() < r.tolerance, "{}: {got}", r.quantity);
    }
}

/// The stiff cable, softened so that steps resolve its highest frequency, let go from its hanging equilibrium with
/// a swing that starts without a shock.
fn soft_pendulum(n: usize) -> Scene {
    let section = Section { axial_damping: 0.0, ..Section::new(1.0, 400.0, 0.02) };
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
