//! Cables that feed at a winch: hanging, swinging, free payout, against closed forms and independent solutions.

use crate::common::{data, number};
use ropewalk_constraints::winch::Feeding;
use ropewalk_constraints::{SphericalSpec, WinchSpec};
use ropewalk_core::integrator::{Options, Stepping};
use ropewalk_core::{End, Simulation, State};
use ropewalk_elements::{CableSpec, PointMassSpec, Section};
use ropewalk_forces::GravitySpec;
use ropewalk_scene::Scene;

pub fn fixed(h: f64) -> Options {
    Options { stepping: Stepping::Fixed { h }, ..Options::default() }
}

pub fn go(s: &mut Simulation, t: f64) {
    let end = s.advance(t, f64::INFINITY, &mut ()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(end, End::Done);
}

/// A cable that hangs down from a winch at the origin.
pub fn hanging(length: f64, elements: usize, section: Section, winch: WinchSpec, g: f64) -> Scene {
    hung(CableSpec::straight("rope", [0.0; 3], [0.0, 0.0, -length], elements, section), winch, g)
}

pub fn hung(rope: CableSpec, winch: WinchSpec, g: f64) -> Scene {
    let mut scene = Scene::new();
    scene
        .element(rope)
        .constraint(SphericalSpec::new("eyelet", "rope.start", [0.0; 3]))
        .constraint(winch)
        .set_gravity([0.0, 0.0, -g])
        .force(GravitySpec::default());
    scene
}

/// A winch that feeds at a constant speed from the first moment on.
pub fn steady(speed: f64) -> WinchSpec {
    WinchSpec::motion("winch", "rope.start", if speed > 0.0 { "out" } else { "in" })
}

/// The multiplier of the winch, what it pulls with.
pub fn pull(s: &Simulation) -> f64 {
    let all = s.model.constraints();
    let c = all.iter().position(|c| c.name() == "winch").expect("the winch");
    s.state.lambda[s.model.rows_of(c).start]
}

/// Vertical force of the eyelet on the cable.
pub fn reaction(s: &Simulation) -> f64 {
    let all = s.model.constraints();
    let c = all.iter().position(|c| c.name() == "eyelet").expect("the eyelet");
    s.model.reaction(c, all[c].nodes()[0], &s.state.at(), &s.state.lambda)[2]
}

#[test]
fn hanging_elastic_cable_is_exact_with_any_mesh() {
    let (ea, m, g, l0) = (1e4, 1.0, 8.0, 5.0);
    for (v, elements) in [(1.0, 1), (-1.0, 1), (4.0, 2), (-4.0, 2), (1.0, 8), (-4.0, 8)] {
        let mut scene = hanging(l0, elements, Section::new(m, ea, 0.0), steady(v), g);
        scene.motion(steadily("out", v.abs())).motion(steadily("in", -v.abs()));
        let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
        // with s from the free end the cable hangs by x = L - s + w*(L² - s²)/2EA
        let soft = m * g / (1.0 + v * v * m / ea) / ea;
        let place = |s: f64, l: f64| [-(l - s) - soft * (l * l - s * s) / 2.0, -(1.0 + soft * s)];
        let mut state = model.state();
        let fall = -v * (1.0 + soft * l0);
        for k in 0..=elements {
            let share = k as f64 / elements as f64;
            let [x, slope] = place(l0 * (1.0 - share), l0);
            state.q[6 * k + 2] = x;
            state.q[6 * k + 5] = slope;
            let rate = -v * (1.0 - share);
            // material moves at `fall`, the node along it at `rate`, past a slope that changes by w* per metre
            state.v[6 * k + 2] = fall + rate * slope;
            state.v[6 * k + 5] = rate * soft;
        }
        state.v[6 * (elements + 1)] = -v;
        let options = Options { newton_tolerance: 1e-8, filter_start: false, ..fixed(0.01) };
        let mut s = Simulation::from(model, state, &options, 1.0).unwrap_or_else(|e| panic!("{e}"));
        go(&mut s, 1.0);
        let l = l0 + v;
        let top = m * g * l / (1.0 + v * v * m / ea);
        let [tip, _] = place(0.0, l);
        let error = [
            (reaction(&s) - top) / top,
            (pull(&s) / (top * (1.0 + soft * l)) - 1.0),
            (s.state.q[6 * elements + 2] - tip) / l,
        ];
        for (what, e) in ["tension", "pull", "tip"].iter().zip(error) {
            assert!(e.abs() < 1e-10, "V = {v}, {elements} elements, {what}: {e:e}");
        }
    }
}

/// A length that grows at a constant speed.
pub fn steadily(name: &str, speed: f64) -> ropewalk_constraints::motion::SpeedTableSpec {
    ropewalk_constraints::motion::SpeedTableSpec {
        name: name.into(),
        direction: [1.0, 0.0, 0.0],
        file: None,
        t: vec![0.0, 1e6],
        v: vec![speed; 2],
        join: ropewalk_core::Join::Linear,
    }
}

#[test]
fn top_tension_of_a_ramp_holds_the_acceleration() {
    // T_top = (w - m dV/dt) L up to terms of order 1/EA; without the acceleration of the boundary it is 15 % off
    let (m, g, l0) = (1.0, 8.0, 5.0);
    let mut last = f64::INFINITY;
    for ea in [1e4, 1e5, 1e6] {
        let mut section = Section::new(m, ea, 0.0);
        section.axial_retardation_time = 0.01;
        let winch = WinchSpec { ramp: 2.0, ..WinchSpec::speed("winch", "rope.start", 2.0) };
        let scene = hanging(l0, 4, section, winch, g);
        let mut s = hang(&scene, &fixed(2e-3), ea, m * g, l0);
        let motion =
            ropewalk_constraints::motion::Straight::new([1.0, 0.0, 0.0], 2.0, 0.0, 2.0).expect("ramp");
        let mut worst = 0.0_f64;
        for k in 1..=100 {
            go(&mut s, 0.03 * k as f64);
            let now = ropewalk_core::Motion::at(&motion, s.state.t);
            let expected = (m * g - m * now.a[0]) * (l0 + now.x[0]);
            worst = worst.max(((reaction(&s) - expected) / (m * g * l0)).abs());
        }
        assert!(worst < 2e-2 * 1e4 / ea, "EA = {ea}: {worst:e}");
        assert!(worst < 0.2 * last);
        last = worst;
    }
}

/// A cable at rest that starts in its stretched state.
pub fn hang(scene: &Scene, options: &Options, ea: f64, w: f64, l0: f64) -> Simulation {
    let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
    let mut state: State = model.state();
    let mesh = model.part("rope").expect("rope").mesh().to_vec();
    for (k, p) in mesh.iter().enumerate() {
        let s = l0 - p;
        state.q[6 * k + 2] = -p - w * (l0 * l0 - s * s) / (2.0 * ea);
        state.q[6 * k + 5] = -1.0 - w * s / ea;
    }
    Simulation::from(model, state, options, 1.0).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn free_payout_follows_its_tension() {
    // m L dV/dt = w L - T0, and with -m V² where cable is picked up from rest; elastic terms are of order 1/EA
    let (m, g, l0) = (1.0, 8.0, 10.0);
    for (t0, pile) in [(40.0, false), (100.0, false), (40.0, true)] {
        let (mut l, mut v) = (l0, 0.0);
        let h = 1e-4;
        let rate = |l: f64, v: f64| g - (t0 + if pile && v > 0.0 { m * v * v } else { 0.0 }) / (m * l);
        let time = 1.5;
        for _ in 0..(time / h) as usize {
            let (a1, v1) = (rate(l, v), v);
            let (a2, v2) = (rate(l + 0.5 * h * v1, v + 0.5 * h * a1), v + 0.5 * h * a1);
            (l, v) = (l + h * v2, v + h * a2);
            let _ = v1;
        }
        let mut errors = Vec::new();
        for ea in [1e4, 1e5, 1e6] {
            let mut section = Section::new(m, ea, 0.0);
            section.axial_retardation_time = 0.005;
            let mut winch = WinchSpec::tension("winch", "rope.start", t0);
            winch.pile = pile;
            let scene = hanging(l0, 6, section, winch, g);
            let mut s = hang(&scene, &fixed(2e-3), ea, m * g, l0);
            go(&mut s, time);
            let length = s.model.part("rope").expect("rope").length_now(&s.state.at());
            errors.push(((length - l) / l).abs());
        }
        assert!(errors[2] < 1e-4 && errors[2] < 0.3 * errors[0], "T0 = {t0}, pile {pile}: {errors:?}");
    }
}

#[test]
fn heavy_swinging_cable_meets_a_chain_whose_masses_are_born() {
    let heavy = &data("flow/ale.json")["heavy"][0];
    let (mass, theta, ea) = (number(&heavy["M"]), number(&heavy["theta0"]), number(&heavy["EA"]));
    let table: Vec<[f64; 3]> = serde_json::from_value(heavy["tip_t_x_z"].clone()).expect("table");
    let mut errors = Vec::new();
    for (n, limit) in [(4, 4e-4), (8, 9e-5), (16, 2e-5)] {
        let mut scene = Scene::new();
        let end = [theta.sin(), 0.0, -theta.cos()];
        scene
            .element(CableSpec::straight("rope", [0.0; 3], end, n, Section::new(1.0, ea, 0.0)))
            .element(PointMassSpec::new("bob", "rope.end", mass))
            .constraint(SphericalSpec::new("eyelet", "rope.start", [0.0; 3]))
            .constraint(steady(1.0))
            .motion(steadily("out", 1.0))
            .set_gravity([0.0, 0.0, -9.81])
            .force(GravitySpec::default());
        let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
        // it starts straight, stretched as far as its weight along the line does it, and runs out along the line
        let mut state = model.state();
        let c = 9.81 * theta.cos() / ea;
        for k in 0..=n {
            let p = k as f64 / n as f64;
            let (along, slope) = (p + c * (mass * p + p - 0.5 * p * p), 1.0 + c * (mass + 1.0 - p));
            let (rate, bend) = (p - 1.0, -c);
            let v = 1.0 + c * (mass + 1.0) + rate * slope;
            for i in 0..3 {
                state.q[6 * k + i] = along * end[i];
                state.q[6 * k + 3 + i] = slope * end[i];
                state.v[6 * k + i] = v * end[i];
                state.v[6 * k + 3 + i] = rate * bend * end[i];
            }
        }
        let mut s = Simulation::from(model, state, &fixed(1e-3), 1.0).unwrap_or_else(|e| panic!("{e}"));
        let mut worst = 0.0_f64;
        for &[t, x, z] in &table[1..] {
            go(&mut s, t);
            let q = &s.state.q[6 * n..];
            worst = worst.max((q[0] - x).hypot(q[2] - z));
        }
        assert!(worst < limit, "{n} elements: {worst:e}");
        errors.push(worst);
    }
    eprintln!("{errors:?}");
}

#[test]
fn pendulum_of_changing_length() {
    let data = data("flow/moving_string.json");
    for row in data["f3"].as_array().expect("rows") {
        let [v, l0, theta, g] = ["v", "l0", "theta0", "g"].map(|k| number(&row[k]));
        let (t, angle): (Vec<f64>, Vec<f64>) = (
            serde_json::from_value(row["t"].clone()).expect("times"),
            serde_json::from_value(row["theta"].clone()).expect("angles"),
        );
        let end = [l0 * theta.sin(), 0.0, -l0 * theta.cos()];
        let velocity = [v * theta.sin(), 0.0, -v * theta.cos()];
        let mut scene = Scene::new();
        let mut section = Section::new(1e-4, 1e6, 0.0);
        section.axial_retardation_time = 1e-3;
        scene
            .element(CableSpec { velocity, ..CableSpec::straight("rope", [0.0; 3], end, 2, section) })
            .element(PointMassSpec::new("bob", "rope.end", 1.0))
            .constraint(SphericalSpec::new("eyelet", "rope.start", [0.0; 3]))
            .constraint(steady(v))
            .motion(steadily("out", v.abs()))
            .motion(steadily("in", -v.abs()))
            .set_gravity([0.0, 0.0, -g])
            .force(GravitySpec::default());
        let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
        let mut s = Simulation::new(model, &fixed(1e-3), 2.0).unwrap_or_else(|e| panic!("{e}"));
        let mut worst = 0.0_f64;
        // a line can't push: the reference on reel-in has negative tension from 1.7 s on
        for (&t, &angle) in t.iter().zip(&angle).filter(|(t, _)| **t > 0.0 && (v > 0.0 || **t <= 1.6)) {
            go(&mut s, t);
            let l = l0 + v * t;
            let q = &s.state.q[12..];
            worst = worst.max((q[0] - l * angle.sin()).hypot(q[2] + l * angle.cos()));
        }
        assert!(worst < 3e-4, "v = {v}: {worst:e}");
    }
}

#[test]
fn feeding_is_prescribed_by_a_constraint() {
    let scene =
        hanging(2.0, 3, Section::new(1.0, 1e5, 0.0), WinchSpec::speed("winch", "rope.start", 1.0), 9.81);
    let model = scene.build().expect("model");
    let part = model.part("rope").expect("rope");
    let boundary = part.boundary(0).expect("a boundary");
    let motion = ropewalk_constraints::motion::Straight::new([1.0, 0.0, 0.0], 1.0, 0.0, 1.0).expect("ramp");
    let feeding = Feeding::new("winch", boundary, std::sync::Arc::new(motion));
    let state = model.state();
    let at = ropewalk_core::At { t: 0.4, ..state.at() };
    assert!(ropewalk_core::testing::check_constraint(&feeding, model.nodes(), &at) < 1e-8);
}

#[test]
fn a_cable_is_laid_under_tension() {
    let lay = |change: &dyn Fn(&mut CableSpec)| {
        let mut cable =
            CableSpec::straight("rope", [0.0; 3], [5.0, 0.0, 0.0], 3, Section::new(1.0, 1e4, 0.0));
        change(&mut cable);
        let mut scene = Scene::new();
        scene.element(cable).constraint(SphericalSpec::pin("a", "rope.start"));
        scene.build().map_err(|e| e.error)
    };
    let model = lay(&|c| c.tension = Some(20.0)).unwrap_or_else(|e| panic!("{e}"));
    let rope = model.part("rope").expect("rope");
    assert!((rope.length() * (1.0 + 2e-3) - 5.0).abs() < 1e-12);
    let tension = rope.observe(ropewalk_core::Quantity::Tension, 2.0, &model.state().at()).expect("tension");
    assert!((tension - 20.0).abs() < 1e-9, "{tension}");
    for (tension, length, says) in
        [(20.0, Some(5.0), "not both"), (-2e4, None, "to nothing"), (f64::NAN, None, "tension")]
    {
        let e = lay(&|c| (c.tension, c.length) = (Some(tension), length)).err().expect("refused");
        assert!(e.field.as_deref() == Some("tension") && e.message.contains(says), "{e}");
    }
}
