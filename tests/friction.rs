//! Dry friction: what sticks stays, what slips loses what it should.

mod common;

use ropewalk_constraints::CoordinateSpec;
use ropewalk_constraints::motion::HarmonicSpec;
use ropewalk_core::integrator::{Options, Scheme, Stepping};
use ropewalk_core::{End, Scene, Simulation};
use ropewalk_elements::{PointMassSpec, RigidBodySpec};
use ropewalk_forces::GravitySpec;
use ropewalk_forces::contact::{ContactSpec, Friction, ShapeSpec};

const G: f64 = 9.81;
const R: f64 = 0.05;

fn schemes() -> [(Scheme, Stepping); 4] {
    let controlled = Stepping::Controlled { tolerance: 1e-5 };
    let alpha = Options::default().scheme;
    [
        (alpha.clone(), controlled),
        (Scheme::RadauIia5, controlled),
        (alpha, Stepping::Fixed { h: 1e-3 }),
        (Scheme::RadauIia5, Stepping::Fixed { h: 1e-3 }),
    ]
}

fn run(scene: &Scene, (scheme, stepping): &(Scheme, Stepping), duration: f64) -> Simulation {
    let options = Options { scheme: scheme.clone(), stepping: *stepping, ..Options::default() };
    let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
    let mut s = Simulation::new(model, &options, duration).unwrap_or_else(|e| panic!("{e}"));
    let end = s
        .advance(duration, f64::INFINITY, &mut ())
        .unwrap_or_else(|e| panic!("{scheme:?} {stepping:?}: {e}"));
    assert_eq!(end, End::Done);
    println!("{scheme:?} {stepping:?}: {:?}", s.work.counts);
    s
}

#[track_caller]
fn near(got: f64, wanted: f64, relative: f64) {
    println!("{got} instead of {wanted}: {:.1e}", got / wanted - 1.0);
    assert!((got / wanted - 1.0).abs() < relative, "{got} instead of {wanted}");
}

fn floor(k: f64, friction: Friction) -> ContactSpec {
    ContactSpec {
        radius: Some(R),
        stiffness: k,
        friction: Some(friction),
        ..ContactSpec::new("floor", ShapeSpec::Plane { normal: [0.0, 0.0, 1.0] })
    }
}

/// A weight that sticks on a slope of 25°.
fn slope() -> Scene {
    let (angle, k) = (25_f64.to_radians(), 1e5);
    let normal = [-angle.sin(), 0.0, angle.cos()];
    let height = R - G * angle.cos() / k;
    let mut scene = Scene::new();
    scene
        .element(PointMassSpec::new("weight", normal.map(|n| height * n), 1.0))
        .force(GravitySpec::default())
        .force(ContactSpec { shape: ShapeSpec::Plane { normal }, ..floor(k, Friction::new(0.6)) });
    scene
}

#[test]
fn a_weight_on_a_slope_stays_for_ever() {
    let along = |s: &Simulation| {
        let angle = 25_f64.to_radians();
        -s.state.q[0] * angle.cos() - s.state.q[2] * angle.sin()
    };
    let shift = G * 25_f64.to_radians().sin() / 1e5;
    for how in &schemes() {
        near(along(&run(&slope(), how, 2.0)), shift, 1e-6);
    }
    // more than a day
    let mut how = schemes()[0].clone();
    let s = run(&slope(), &how, 1e5);
    near(along(&s), shift, 1e-8);
    assert!(s.work.counts.steps < 2000, "{:?}", s.work.counts);
    how.1 = Stepping::Fixed { h: 1.0 };
    near(along(&run(&slope(), &how, 1e3)), shift, 1e-8);
}

#[test]
fn a_block_moved_to_and_fro_loses_what_its_bristle_does_not_give_back() {
    // 4 μ N (A - μ N/k) per cycle after the first: reference data
    let (mass, mu, amplitude, period) = (10.0 / G, 0.3, 0.01, 4000.0);
    let k = 1e5;
    for (scheme, h) in
        [(Options::default().scheme, 20.0), (Options::default().scheme, 50.0), (Scheme::RadauIia5, 50.0)]
    {
        let mut scene = Scene::new();
        scene
            .motion(HarmonicSpec {
                name: "sway".into(),
                amplitude: [amplitude, 0.0, 0.0],
                frequency: 1.0 / period,
                phase: 0.0,
                start: 0.0,
                ramp: 0.0,
            })
            .element(PointMassSpec::new("block", [0.0, 0.0, R - 10.0 / k], mass))
            .constraint(CoordinateSpec {
                name: "drive".into(),
                marker: "block".into(),
                direction: [1.0, 0.0, 0.0],
                motion: Some("sway".into()),
            })
            .force(GravitySpec::default())
            .force(floor(k, Friction { elastic_slip: Some(3e-4), ..Friction::new(mu) }));
        let how = (scheme, Stepping::Fixed { h });
        let lost = |cycles: f64| run(&scene, &how, cycles * period).audit.dissipated;
        near(lost(3.0) - lost(2.0), 4.0 * 3.0 * (amplitude - 3.0 / 1e4), 5e-3);
    }
}

#[test]
fn a_block_slides_as_far_as_its_energy_lasts() {
    let (v, mu, k) = (2.0, 0.3, 1e6);
    for how in &schemes() {
        let mut scene = Scene::new();
        let mut block = PointMassSpec::new("block", [0.0, 0.0, R - G / k], 1.0);
        block.velocity = [v, 0.0, 0.0];
        scene.element(block).force(GravitySpec::default()).force(floor(k, Friction::new(mu)));
        let s = run(&scene, how, 1.0);
        near(s.state.q[0], v * v / (2.0 * mu * G), 2e-3);
        assert!(s.state.v[0].abs() < 1e-6, "{}", s.state.v[0]);
        near(s.audit.dissipated, 0.5 * v * v, 5e-3);
    }
}

#[test]
fn a_sphere_that_slides_begins_to_roll() {
    let (v, mu, k, mass, r) = (1.0, 0.2, 1e6, 1.0, 0.1);
    for how in &schemes() {
        let mut body =
            RigidBodySpec::new("ball", [0.0, 0.0, r - mass * G / k], mass, [0.4 * mass * r * r; 3]);
        body.velocity = [v, 0.0, 0.0];
        let mut scene = Scene::new();
        scene.element(body).force(GravitySpec::default()).force(ContactSpec {
            at: vec!["ball.com".into()],
            radius: Some(r),
            ..floor(k, Friction::new(mu))
        });
        let s = run(&scene, how, 0.5);
        // where rolling begins and how fast: reference data
        near(s.state.v[0], 0.714_285_714_285_714_3, 1e-4);
        near(s.state.v[4] * r, 0.714_285_714_285_714_3, 1e-4);
        let (t, x) = (0.145_623_998_835_006_98, 0.124_820_570_430_006_84);
        near(s.state.q[0], x + 0.714_285_714_285_714_3 * (0.5 - t), 3e-4);
    }
}

#[test]
fn a_checkpoint_keeps_what_friction_remembers() {
    let how = &schemes()[0];
    let options = Options { stepping: how.1, ..Options::default() };
    let mut one = Simulation::new(slope().build().unwrap(), &options, 1.0).unwrap();
    one.advance(0.1, f64::INFINITY, &mut ()).unwrap();
    let kept = one.checkpoint().unwrap();
    assert!(kept.state.modes.iter().any(|m| *m != 0.0));
    let mut two = Simulation::restore(slope().build().unwrap(), &options, 1.0, kept).unwrap();
    for s in [&mut one, &mut two] {
        s.advance(1.0, f64::INFINITY, &mut ()).unwrap();
    }
    assert_eq!(one.state, two.state);
}
