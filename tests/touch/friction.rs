//! Dry friction: what sticks stays, what slips loses what it should; and walls that hold what is thrown at them.

use ropewalk::scene::Format;
use ropewalk::{History, SceneFile, simulate};
use ropewalk_constraints::CoordinateSpec;
use ropewalk_constraints::motion::HarmonicSpec;
use ropewalk_core::integrator::{Options, Scheme, Stepping};
use ropewalk_core::{End, Quantity, Simulation};
use ropewalk_elements::rigid_body::HullSpec;
use ropewalk_elements::{CableSpec, PointMassSpec, RigidBodySpec, Section};
use ropewalk_forces::contact::{ContactSpec, Damping, Friction, Leaving, ShapeSpec};
use ropewalk_forces::{GravitySpec, PointForceSpec, TimeFunction};
use ropewalk_scene::Scene;
use std::f64::consts::{PI, TAU};

const G: f64 = 9.81;
const R: f64 = 0.05;

fn schemes() -> [(Scheme, Stepping); 4] {
    let controlled = Stepping::Controlled { tolerance: 1e-5 };
    let alpha = Options::default().scheme;
    [
        (alpha, controlled),
        (Scheme::RadauIia5, controlled),
        (alpha, Stepping::Fixed { h: 1e-3 }),
        (Scheme::RadauIia5, Stepping::Fixed { h: 1e-3 }),
    ]
}

fn run(scene: &Scene, (scheme, stepping): &(Scheme, Stepping), duration: f64) -> Simulation {
    let options = Options { scheme: *scheme, stepping: *stepping, ..Options::default() };
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
        near(along(&run(&slope(), how, 2.0)), shift, 2e-5);
    }
    // more than a day
    let mut how = schemes()[0];
    let s = run(&slope(), &how, 1e5);
    near(along(&s), shift, 1e-8);
    assert!(s.work.counts.steps < 2000, "{:?}", s.work.counts);
    how.1 = Stepping::Fixed { h: 1.0 };
    near(along(&run(&slope(), &how, 1e3)), shift, 1e-8);
}

#[test]
fn elastic_slip_goes_by_the_gravity_of_the_scene() {
    // a bristle that gives way by `slip` under μ m g has μ m g/slip: m g sin φ moves it by slip sin φ/μ
    let (angle, mu, slip, k) = (25_f64.to_radians(), 0.6, 1e-4, 1e5);
    let normal = [-angle.sin(), 0.0, angle.cos()];
    for g in [1.62, G] {
        let height = R - g * angle.cos() / k;
        let mut scene = Scene::new();
        let friction = Friction { elastic_slip: Some(slip), ..Friction::new(mu) };
        scene
            .set_gravity([0.0, 0.0, -g])
            .element(PointMassSpec::new("weight", normal.map(|n| height * n), 1.0))
            .force(GravitySpec::default())
            .force(ContactSpec { shape: ShapeSpec::Plane { normal }, ..floor(k, friction) });
        let s = run(&scene, &schemes()[2], 2.0);
        near(-s.state.q[0] * angle.cos() - s.state.q[2] * angle.sin(), slip * angle.sin() / mu, 1e-6);
    }
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
        let mut block = PointMassSpec::new("block", [0.0, 0.0, R - 10.0 / k], mass);
        block.velocity = [amplitude * TAU / period, 0.0, 0.0];
        scene
            .motion(HarmonicSpec {
                name: "sway".into(),
                amplitude: [amplitude, 0.0, 0.0].map(Into::into),
                frequency: (1.0 / period).into(),
                phase: 0.0,
                start: 0.0,
                ramp: 0.0,
            })
            .element(block)
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
        // it stops after 0.68 s; then its bristle swings out
        let s = run(&scene, how, 1.2);
        near(s.state.q[0], v * v / (2.0 * mu * G), 2e-3);
        assert!(s.state.v[0].abs() < 1e-6, "{}", s.state.v[0]);
        near(s.audit.dissipated, 0.5 * v * v, 5e-3);
    }
}

/// A block of 6 kg that slides up a slope of 20° at first.
fn uphill(v: f64, friction: Friction) -> Scene {
    let (sin, cos) = 20_f64.to_radians().sin_cos();
    let normal = [-sin, 0.0, cos];
    let height = R - 6.0 * G * cos / 1e6;
    let mut block = PointMassSpec::new("block", normal.map(|n| height * n), 6.0);
    block.velocity = [v * cos, 0.0, v * sin];
    let slope = ContactSpec { shape: ShapeSpec::Plane { normal }, ..floor(1e6, friction) };
    let mut scene = Scene::new();
    scene.element(block).force(GravitySpec::default()).force(slope);
    scene
}

/// Where steps mustn't be so short as to see what slides turn round, the run ends with the instant and what to do; and that does.
#[test]
fn what_turns_round_within_the_shortest_step_is_told_of_with_the_remedy() {
    let end = |h_min: f64, elastic_slip: Option<f64>| {
        let scene = uphill(5.0, Friction { elastic_slip, ..Friction::new(0.2) });
        let stepping = Stepping::Controlled { tolerance: 1e-2 };
        let options = Options { stepping, h_min: Some(h_min), ..Options::default() };
        let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
        let mut s = Simulation::new(model, &options, 3.0).unwrap_or_else(|e| panic!("{e}"));
        s.advance(3.0, f64::INFINITY, &mut ())
    };
    let error = end(0.1, None).expect_err("no step is short enough").to_string();
    println!("{error}");
    for part in
        ["t = 1.0", "floor", "turned round within a step", "A smaller `h_min`", "a larger `elastic_slip`"]
    {
        assert!(error.contains(part), "no {part} in: {error}");
    }
    assert_eq!(end(3e-3, None), Ok(End::Done));
    assert!(end(0.01, None).is_err());
    assert_eq!(end(0.01, Some(0.02)), Ok(End::Done));
}

/// Steps of error control that grow while something slides don't leap over the instant at which it stops or turns round.
#[test]
fn what_slides_for_long_stops_where_it_should() {
    let tolerance = Stepping::Controlled { tolerance: 1e-4 };
    for scheme in [Options::default().scheme, Scheme::RadauIia5] {
        for (mu, v, duration) in
            [(0.15, 3.0, 20.0), (0.15, 2.0, 20.0), (0.15, 1.0, 30.0), (0.05, 3.0, 20.0), (0.3, 3.0, 100.0)]
        {
            let mut scene = Scene::new();
            let mut block = PointMassSpec::new("block", [0.0, 0.0, R - 6.0 * G / 1e6], 6.0);
            block.velocity = [v, 0.0, 0.0];
            scene.element(block).force(GravitySpec::default()).force(floor(1e6, Friction::new(mu)));
            let s = run(&scene, &(scheme, tolerance), duration);
            near(s.state.q[0], v * v / (2.0 * mu * G), 1e-3);
            assert!(s.work.counts.steps < 300, "{:?}", s.work.counts);
        }
        // up a slope of 20° and down again
        for mu in [0.1, 0.2, 0.3_f64] {
            let ((sin, cos), v) = (20_f64.to_radians().sin_cos(), 5.0);
            let scene = uphill(v, Friction::new(mu));
            let s = run(&scene, &(scheme, tolerance), 3.0);
            let [up, down] = [G * (sin + mu * cos), G * (sin - mu * cos)];
            let (peak, back) = (v * v / (2.0 * up), 0.5 * down * (3.0 - v / up).powi(2));
            let place = s.state.q[0] * cos + s.state.q[2] * sin;
            let off = (place - (peak - back)).abs() / (peak + back);
            assert!(off < 1e-2, "{scheme:?}, {mu}: {place} instead of {}", peak - back);
        }
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
            points: vec!["ball.com".into()],
            radius: Some(r),
            ..floor(k, Friction::new(mu))
        });
        let s = run(&scene, how, 0.5);
        // where rolling begins and how fast: reference data
        near(s.state.v[0], 0.714_285_714_285_714_3, 1e-6);
        near(s.state.v[4] * r, 0.714_285_714_285_714_3, 1e-6);
        let (t, x) = (0.145_623_998_835_006_98, 0.124_820_570_430_006_84);
        near(s.state.q[0], x + 0.714_285_714_285_714_3 * (0.5 - t), 1e-3);
    }
}

#[test]
fn a_checkpoint_keeps_what_friction_remembers() {
    let how = &schemes()[0];
    let options = Options { stepping: how.1, ..Options::default() };
    let mut one = Simulation::new(slope().build().unwrap(), &options, 1.0).unwrap();
    one.advance(0.1, f64::INFINITY, &mut ()).unwrap();
    let kept = one.checkpoint().unwrap();
    assert!(kept.state.internal.iter().any(|m| *m != 0.0));
    let mut two = Simulation::restore(slope().build().unwrap(), &options, 1.0, kept).unwrap();
    for s in [&mut one, &mut two] {
        s.advance(1.0, f64::INFINITY, &mut ()).unwrap();
    }
    assert_eq!(one.state, two.state);
}

/// Points of a rope over the upper half of a drum about y, with a straight piece on either side.
fn over(radius: f64, side: f64) -> Vec<[f64; 3]> {
    let mut points: Vec<[f64; 3]> =
        (0..20).map(|k| side * f64::from(k) / 20.0).map(|s| [-radius, 0.0, s - side]).collect();
    points.extend(
        (0..=60).map(|k| PI * f64::from(k) / 60.0).map(|a| [-radius * a.cos(), 0.0, radius * a.sin()]),
    );
    points.extend((1..=20).map(|k| side * f64::from(k) / 20.0).map(|s| [radius, 0.0, -s]));
    points
}

#[test]
fn a_rope_on_a_drum_slips_where_it_must_and_holds_where_it_can() {
    // 100 N at both ends, then 150, 110 and 150 N at one: what has slipped keeps its tension until it slips back
    let (radius, d, mu) = (0.5, 0.01, 0.3);
    let section = Section { diameter: d, axial_retardation_time: 5e-3, ..Section::new(0.05, 1e5, 0.0) };
    let mut rope = CableSpec::straight("rope", [0.0; 3], [1.0, 0.0, 0.0], 60, section);
    // as deep in the drum as it will be
    let k = 3e7;
    (rope.points, rope.curve) = (Vec::new(), over(radius - 100.0 / (k * radius), 0.3));
    rope.tension = Some(100.0);
    let times = (0..7).map(f64::from).collect();
    let pull = TimeFunction::table(times, vec![100.0, 150.0, 150.0, 110.0, 110.0, 150.0, 150.0]);
    let shape = ShapeSpec::Cylinder { axis: [0.0, 1.0, 0.0], radius: radius - d / 2.0, length: None };
    let mut scene = Scene::new();
    scene
        .element(rope)
        .force(PointForceSpec::new("rope.start", [0.0, 0.0, -100.0], TimeFunction::default()))
        .force(PointForceSpec::new("rope.end", [0.0, 0.0, -1.0], pull))
        .force(ContactSpec {
            stiffness_per_length: k,
            friction: Some(Friction::new(mu)),
            damping: Damping::KelvinVoigt { retardation_time: 1e-3, until: Leaving::Force },
            ..ContactSpec::new("drum", shape)
        });
    let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
    let mut s = Simulation::new(model, &Options::default(), 6.0).unwrap_or_else(|e| panic!("{e}"));
    // angles from where the rope meets the drum on the loaded side
    let right = |t: f64, a: f64| {
        let pulled = (150.0 * (-mu * a).exp()).max(100.0);
        if t == 4.0 { (110.0 * (mu * a).exp()).min(pulled) } else { pulled }
    };
    for t in [2.0, 4.0, 6.0] {
        s.advance(t, f64::INFINITY, &mut ()).unwrap_or_else(|e| panic!("{e}"));
        let part = s.model.part("rope").unwrap();
        let (mut worst, mut sum, mut count) = (0.0_f64, 0.0, 0.0);
        for w in part.mesh().windows(2) {
            let mid = 0.5 * (w[0] + w[1]);
            let x = crate::common::place(&s.model, &s.state, "rope", mid);
            let angle = x[2].atan2(x[0]);
            if x[2] > 0.0 && angle < PI - 0.1 {
                let tension = part.observe(Quantity::Tension, mid, &s.state.at()).unwrap();
                let off = (tension / right(t, angle) - 1.0).abs();
                (worst, sum, count) = (worst.max(off), sum + off, count + 1.0);
            }
        }
        println!("{t}: {worst:.1e}, mean {:.1e}, {:?}", sum / count, s.work.counts);
        // elastic slip rounds the corners off
        assert!(worst < 3e-2 && sum / count < 5e-3, "{t}: {worst}");
    }
}

#[test]
fn a_mooring_does_not_depend_on_how_its_friction_is_made() {
    let text = include_str!("../data/mooring_friction.toml");
    let run = |friction: &str| {
        let text = text.replace("friction = 0.5", friction);
        let file = SceneFile::parse(&text, "mooring", Format::Toml, &[]).unwrap_or_else(|e| panic!("{e}"));
        simulate(file.scene()).unwrap_or_else(|e| panic!("{e}"))
    };
    let [smooth, rough, rigid] =
        ["", "friction = 0.5", "friction = { mu = 0.5, elastic_slip = \"10 um\" }"].map(run);
    // what the anchor feels: least, most and last
    let force = |h: &History| {
        let fx = h.column("anchor.fx").unwrap();
        let [least, most] = [f64::min, f64::max].map(|of| fx.iter().copied().fold(fx[0], of));
        [least, most, fx[fx.len() - 1]]
    };
    println!("{:?} {:?} {:?}", force(&smooth), force(&rough), force(&rigid));
    println!("{:?}\n{:?}\n{:?}", smooth.counts, rough.counts, rigid.counts);
    for (one, other) in force(&rough).into_iter().zip(force(&rigid)) {
        near(one, other, 5e-3);
    }
    assert!(2 * rough.counts.steps <= 3 * smooth.counts.steps);
    assert!(
        rough.warnings.iter().any(|w| w.contains("without the friction of `seabed`")),
        "{:?}",
        rough.warnings
    );
}

#[test]
fn friction_along_and_across_a_hull_differ() {
    // as far as its energy lasts: v²/(2 μ g)
    let (v, along, across, k) = (1.0, 0.3, 0.1, 1e6);
    for (direction, mu) in [([1.0, 0.0], along), ([0.0, 1.0], across)] {
        let mass = 3.0;
        let mut body = RigidBodySpec::new("rod", [0.0, 0.0, R - mass * G / k], mass, [1e3; 3]);
        body.hull = Some(HullSpec { from: [-0.5, 0.0, 0.0], to: [0.5, 0.0, 0.0], diameter: 2.0 * R });
        body.velocity = [v * direction[0], v * direction[1], 0.0];
        let mut scene = Scene::new();
        let friction = Friction { across: Some(across), ..Friction::new(along) };
        scene
            .element(body)
            .constraint(CoordinateSpec {
                name: "upright".into(),
                marker: "rod".into(),
                direction: [0.0, 0.0, 1.0],
                motion: None,
            })
            .force(GravitySpec::default())
            .force(ContactSpec { radius: None, stiffness_per_length: k, ..floor(1.0, friction) });
        let s = run(&scene, &schemes()[2], 1.2);
        let gone = direction[0] * s.state.q[0] + direction[1] * s.state.q[1];
        near(gone, v * v / (2.0 * mu * G), 2e-2);
    }
}

/// A ball of 2 mm and 10 g that flies at a wall of 2 mm.
fn thrown(speed: f64, stiffness: f64) -> Scene {
    let mut ball = PointMassSpec::new("ball", [0.0, 0.0, 0.5], 0.01);
    ball.velocity = [0.0, 0.0, -speed];
    let shape = ShapeSpec::Cuboid { edges: [1.0, 1.0, 0.002], angles: [0.0; 3] };
    let mut scene = Scene::new();
    scene.element(ball).force(ContactSpec {
        radius: Some(0.002),
        stiffness,
        ..ContactSpec::new("wall", shape)
    });
    scene
}

#[test]
fn nothing_passes_through_a_thin_wall() {
    let alpha = Options::default().scheme;
    let schemes = [
        (alpha, Stepping::Controlled { tolerance: 1e-4 }),
        (alpha, Stepping::Fixed { h: 0.01 }),
        (Scheme::RadauIia5, Stepping::Fixed { h: 0.01 }),
    ];
    for how in &schemes {
        for (speed, k) in [(1.0, 1e6), (10.0, 1e6), (1.0, 1e8), (10.0, 1e8), (100.0, 1e8)] {
            let s = run(&thrown(speed, k), how, 1.0 / speed);
            // a fixed step as long as this doesn't see the hit as it is, but sees that it is one
            let least = if matches!(how.1, Stepping::Fixed { .. }) { 0.0 } else { 0.99 * speed };
            assert!(s.state.v[2] > least && s.state.q[2] > 0.0, "{how:?} {speed} {k}: {:?}", s.state.v);
        }
        // √(m/k) v is more than the wall and the ball have: no step helps
        let options = Options { scheme: how.0, stepping: how.1, ..Options::default() };
        let mut s = Simulation::new(thrown(100.0, 1e6).build().unwrap(), &options, 0.01).unwrap();
        let error = s.advance(0.01, f64::INFINITY, &mut ()).expect_err("goes through").to_string();
        assert!(error.contains("`wall`") && error.contains("`stiffness` of 1e6"), "{error}");
    }
}
