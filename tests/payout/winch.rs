//! Cables that feed: hanging, swinging, moving strings, free payout, against closed forms and independent solutions.

use crate::common::{data, number};
use ropewalk_constraints::motion::{HarmonicSpec, StraightSpec};
use ropewalk_constraints::winch::Feeding;
use ropewalk_constraints::{DrivingSpec, EyeletSpec, SphericalSpec, WinchSpec};
use ropewalk_core::integrator::{Options, Stepping};
use ropewalk_core::{End, Simulation, State};
use ropewalk_elements::{CableSpec, PointMassSpec, Section};
use ropewalk_forces::GravitySpec;
use ropewalk_scene::Scene;

fn fixed(h: f64) -> Options {
    Options { stepping: Stepping::Fixed { h }, ..Options::default() }
}

fn go(s: &mut Simulation, t: f64) {
    let end = s.advance(t, f64::INFINITY, &mut ()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(end, End::Done);
}

/// A cable that hangs down from a winch at the origin.
fn hanging(length: f64, elements: usize, section: Section, winch: WinchSpec, g: f64) -> Scene {
    hung(CableSpec::straight("rope", [0.0; 3], [0.0, 0.0, -length], elements, section), winch, g)
}

fn hung(rope: CableSpec, winch: WinchSpec, g: f64) -> Scene {
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
fn steady(speed: f64) -> WinchSpec {
    WinchSpec::motion("winch", "rope.start", if speed > 0.0 { "out" } else { "in" })
}

/// The multiplier of the winch, what it pulls with.
fn pull(s: &Simulation) -> f64 {
    let all = s.model.constraints();
    let c = all.iter().position(|c| c.name() == "winch").expect("the winch");
    s.state.lambda[s.model.rows_of(c).start]
}

/// Vertical force of the eyelet on the cable.
fn reaction(s: &Simulation) -> f64 {
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
fn steadily(name: &str, speed: f64) -> ropewalk_constraints::motion::SpeedTableSpec {
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
fn hang(scene: &Scene, options: &Options, ea: f64, w: f64, l0: f64) -> Simulation {
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

/// Watches the mesh change.
#[derive(Default)]
struct Meshes(Vec<ropewalk_core::Remeshed>, f64);
impl ropewalk_core::Observer for Meshes {
    fn remeshed(&mut self, report: &ropewalk_core::Remeshed) {
        self.0.push(report.clone());
    }
    fn needs_forces(&self) -> bool {
        true
    }
    fn sample(&mut self, s: &ropewalk_core::Sample<'_>) -> std::ops::ControlFlow<()> {
        let all = s.model.constraints();
        let c = all.iter().position(|c| c.name() == "eyelet").expect("the eyelet");
        self.1 = s.model.reaction(c, all[c].nodes()[0], &s.at, s.lambda)[2];
        std::ops::ControlFlow::Continue(())
    }
}

/// Feeds out by `way` at 1 m/s and back again: a table of lengths with smooth ramps of 2 s.
fn haul(way: f64) -> ropewalk_constraints::motion::SpeedTableSpec {
    let turn = way + 2.0;
    ropewalk_constraints::motion::SpeedTableSpec {
        name: "haul".into(),
        direction: [1.0, 0.0, 0.0],
        file: None,
        t: vec![0.0, 2.0, way, turn, turn + 2.0, turn + 4.0, turn + 2.0 + way, 2.0 * way + 6.0],
        v: vec![0.0, 1.0, 1.0, 0.0, 0.0, -1.0, -1.0, 0.0],
        join: ropewalk_core::Join::Monotone,
    }
}

/// What a hanging cable was found to do on its way out and back.
#[derive(Debug)]
struct Hauled {
    /// Largest error of the tension at the top, relative.
    tension: f64,
    /// Largest error of the end's height [m].
    tip: f64,
    /// Largest jump of the tension at a change of the mesh, relative, and of momentum [kg m/s].
    jump: f64,
    impulse: f64,
    changes: usize,
    /// Steps in all, those on earlier meshes included.
    steps: u64,
    /// Imbalance of energy over the largest term.
    imbalance: f64,
}

/// Hangs in air, or in water which slows the ends of ramps a little.
fn out_and_back(way: f64, element: Option<f64>, eta: f64, elements: usize, water: bool) -> Hauled {
    hauled(way, element, eta, Divided::Evenly(elements), water)
}

/// How a cable is divided.
enum Divided {
    Evenly(usize),
    Into(Vec<f64>),
}

fn hauled(way: f64, element: Option<f64>, eta: f64, divided: Divided, water: bool) -> Hauled {
    let (l0, ea, m) = (1.0, 1e6, 1.0);
    let mut section = Section::new(m, ea, 0.0);
    (section.axial_retardation_time, section.diameter) = (eta, 0.02);
    let winch = WinchSpec { element_length: element, ..WinchSpec::motion("winch", "rope.start", "haul") };
    let mut scene = match divided {
        Divided::Evenly(elements) => hanging(l0, elements, section, winch, 9.81),
        Divided::Into(lengths) => {
            let mesh = Some(ropewalk_elements::cable::MeshSpec::Lengths(lengths));
            let rope = CableSpec::straight("rope", [0.0; 3], [0.0, 0.0, -l0], 0, section);
            hung(CableSpec { mesh, ..rope }, winch, 9.81)
        }
    };
    scene.motion(haul(way));
    let mut w = m * 9.81;
    let (rho, ct) = (1025.0, 0.01);
    if water {
        scene.water = Some(ropewalk_scene::Water { density: rho, ..Default::default() });
        scene
            .force(ropewalk_forces::BuoyancySpec::default())
            .force(ropewalk_forces::DragSpec { cn: 1.2, ct, ..Default::default() })
            .force(ropewalk_forces::AddedMassSpec::default());
        w -= rho * std::f64::consts::FRAC_PI_4 * 0.02 * 0.02 * 9.81;
    }
    let scheme = ropewalk_core::integrator::Scheme::GeneralizedAlpha { rho_inf: 0.5 };
    let options = Options { scheme, ..fixed(0.01) };
    let mut s = hang(&scene, &options, ea, w, l0);
    let motion = ropewalk_scene::MotionSpec::build(&haul(way), &[]).expect("motion");
    let mut seen = Meshes::default();
    let mut out =
        Hauled { tension: 0.0, tip: 0.0, jump: 0.0, impulse: 0.0, changes: 0, steps: 0, imbalance: 0.0 };
    let end = 2.0 * way + 6.0;
    for k in 1..=(10.0 * end) as usize {
        let t = 0.1 * k as f64;
        let ended = s.advance(t, f64::INFINITY, &mut seen).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(ended, End::Done, "at {} s", s.state.t);
        let now = motion.at(t);
        let l = l0 + now.x[0];
        // drag along the cable, which moves down at the speed of feeding
        let drag = if water {
            0.5 * rho * std::f64::consts::PI * 0.02 * ct * now.v[0] * now.v[0].abs()
        } else {
            0.0
        };
        let top = (w - drag - m * now.a[0]) * l;
        out.tension = out.tension.max(((seen.1 - top) / top).abs());
        let part = s.model.part("rope").expect("rope");
        let at = s.state.at();
        let length = part.length_now(&at);
        assert!((length - l).abs() < 1e-12 * l, "length at {t} s: {length} for {l}");
        let (x, _) = part.point(length, &at).expect("the end");
        out.tip = out.tip.max((x[2] + l + w * l * l / (2.0 * ea)).abs());
        // a NaN is no small error
        assert!(seen.1.is_finite() && x[2].is_finite());
    }
    for m in &seen.0 {
        out.jump = out.jump.max((m.jump() / m.tension[0]).abs());
        out.impulse = out.impulse.max(m.impulse());
    }
    out.changes = seen.0.len();
    out.steps = s.work.counts.steps;
    out.imbalance = s.audit.imbalance() / s.audit.scale;
    out
}

/// Short elements at the end that feeds stay there, with their lengths, while others are born and swallowed behind them.
#[test]
fn a_graded_end_stays_graded_while_it_feeds() {
    let lengths = vec![0.02, 0.03, 0.05, 0.5, 0.4];
    let hauled = hauled(6.0, Some(0.4), 0.01, Divided::Into(lengths.clone()), false);
    eprintln!("{hauled:?}");
    assert!(hauled.changes > 10 && hauled.tension < 5e-3 && hauled.tip < 1e-2, "{hauled:?}");
    assert!(hauled.jump < 5e-3 && hauled.impulse < 1e-4 && hauled.imbalance.abs() < 1e-5, "{hauled:?}");

    let section = Section { axial_retardation_time: 0.01, ..Section::new(1.0, 1e6, 0.0) };
    let rope = CableSpec {
        mesh: Some(ropewalk_elements::cable::MeshSpec::Lengths(lengths)),
        ..CableSpec::straight("rope", [0.0; 3], [0.0, 0.0, -1.0], 0, section)
    };
    let winch = WinchSpec { element_length: Some(0.4), ..WinchSpec::speed("winch", "rope.start", 1.0) };
    let scene = hung(rope.clone(), winch.clone(), 9.81);
    let mut s = Simulation::new(scene.build().expect("model"), &fixed(0.01), 4.0).expect("start");
    go(&mut s, 4.0);
    let mesh = s.model.part("rope").expect("rope").line().expect("a line").mesh_now(&s.state.at());
    assert!(mesh.len() > 9);
    for (k, l) in [0.02, 0.03, 0.05].into_iter().enumerate() {
        assert!((mesh[k + 1] - mesh[k] - l).abs() < 1e-9, "{mesh:?}");
    }
    let too_fine = WinchSpec { element_length: Some(0.49), ..winch };
    let rope = CableSpec { mesh: Some(ropewalk_elements::cable::MeshSpec::Lengths(vec![0.2; 5])), ..rope };
    let refused = hung(rope, too_fine, 9.81).build().err().expect("all elements are short").error;
    assert!(refused.message.contains("grade it less"), "{}", refused.message);
}

#[test]
fn cable_is_paid_out_and_reeled_in_with_the_right_tension() {
    for (element, elements, water) in [(None, 10, false), (Some(0.4), 3, false), (Some(0.4), 3, true)] {
        let hauled = out_and_back(6.0, element, 0.01, elements, water);
        eprintln!("{element:?} {water}: {hauled:?}");
        assert!(hauled.tension < 5e-3 && hauled.tip < 1e-2, "{element:?}, water {water}: {hauled:?}");
        assert!(hauled.jump < 5e-3 && hauled.impulse < 1e-4, "{element:?}, water {water}: {hauled:?}");
        assert!(hauled.imbalance.abs() < 1e-5, "{element:?}, water {water}: {hauled:?}");
        assert_eq!(hauled.changes > 10, element.is_some());
        assert!(hauled.steps >= 1800, "{hauled:?}");
    }
}

#[test]
#[ignore = "the whole way from 1 m to 50 m and back, eight times: half a minute"]
fn cable_is_paid_out_to_fifty_metres_and_back() {
    for water in [false, true] {
        for (element, elements, eta) in
            [(None, 20, 0.01), (Some(0.45), 2, 0.01), (Some(0.45), 2, 0.001), (Some(0.45), 2, 0.1)]
        {
            let begin = std::time::Instant::now();
            let hauled = out_and_back(49.0, element, eta, elements, water);
            let ms = 1e3 * begin.elapsed().as_secs_f64() / 104.0;
            eprintln!("{element:?}, eta {eta} s, water {water}: {hauled:?}, {ms:.1} ms per second");
            assert!(hauled.tension < 5e-3 && hauled.tip < 1e-2, "{hauled:?}");
            assert!(hauled.jump < 5e-3 && hauled.imbalance.abs() < 1e-5, "{hauled:?}");
        }
    }
}

/// Frequencies and shapes of a string or beam that runs along its axis between two eyelets: the lowest eigenvalues of its
/// own matrices by inverse iteration in complex arithmetic.
mod running {
    use super::*;
    use faer::Mat;
    use faer::c64;
    use faer::prelude::Solve;
    use ropewalk_core::{System, Weights};

    pub struct Line {
        pub m: f64,
        pub tension: f64,
        pub length: f64,
        pub ei: f64,
        pub v: f64,
        pub elements: usize,
    }

    /// Mass, gyroscopic and stiffness matrix of the transverse motion.
    fn matrices(line: &Line) -> [Mat<f64>; 3] {
        let n = line.elements;
        let ea = 1e6 * line.tension;
        let stretch = 1.0 + line.tension / ea;
        let mut scene = Scene::new();
        scene
            .element(
                CableSpec::straight(
                    "rope",
                    [0.0; 3],
                    [line.length, 0.0, 0.0],
                    n,
                    Section::new(line.m * stretch, ea, line.ei / stretch),
                )
                .unstretched(line.length / stretch),
            )
            .constraint(SphericalSpec::new("a", "rope.start", [0.0; 3]))
            .constraint(SphericalSpec::new("b", "rope.end", [line.length, 0.0, 0.0]))
            .constraint(WinchSpec::motion("in", "rope.start", "in"))
            .constraint(WinchSpec::motion("out", "rope.end", "out"))
            .motion(steadily("in", -line.v / stretch))
            .motion(steadily("out", line.v / stretch));
        let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
        let mut state = model.state();
        // fixed in space while the material runs through
        let boundaries = 6 * (n + 1);
        state.v.fill(0.0);
        (state.v[boundaries], state.v[boundaries + 1]) = (line.v / stretch, line.v / stretch);
        // unknowns: y and y' of every node, without y at both ends
        let dofs: Vec<usize> =
            (0..=n).flat_map(|k| [6 * k + 1, 6 * k + 4]).filter(|&d| d != 1 && d != 6 * n + 1).collect();
        let lambda = vec![0.0; model.multipliers()];
        [(0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0)].map(|(q, v, a)| {
            let mut system = System::default();
            model.assemble(&state.at(), &lambda, Some(Weights { q, v, a }), &mut system);
            let structure = model.structure();
            let mut all = Mat::<f64>::zeros(structure.n, structure.n);
            for (row, columns, at) in structure.rows() {
                for (k, value) in system.values[at].iter().enumerate() {
                    all[(row, columns.get(k))] = *value;
                }
            }
            let p = &structure.position;
            Mat::from_fn(dofs.len(), dofs.len(), |i, j| all[(p[dofs[i]], p[dofs[j]])])
        })
    }

    /// The eigenvalue next to a guess, and its vector: `(λ² M + λ C + K) x = 0` as `A z = λ B z` with `z = (x, λ x)`.
    pub fn mode(line: &Line, guess: f64) -> (c64, Vec<c64>) {
        let [m, c, k] = matrices(line);
        let n = m.nrows();
        let mut shift = c64::new(0.0, guess * (1.0 + 1e-3));
        let (mut x, mut y) = (vec![c64::new(1.0, 0.3); n], vec![c64::new(0.2, 1.0); n]);
        for round in 0..12 {
            let s = shift;
            let p = Mat::from_fn(n, n, |i, j| {
                s * s * c64::new(m[(i, j)], 0.0) + s * c64::new(c[(i, j)], 0.0) + c64::new(k[(i, j)], 0.0)
            });
            let lu = p.full_piv_lu();
            // (A - s B) z' = B z for companion form: y' = s x' + x, P x' = -(M (y + s x) + C x)
            let rhs = Mat::from_fn(n, 1, |i, _| {
                let mut sum = c64::new(0.0, 0.0);
                for j in 0..n {
                    sum =
                        sum - c64::new(m[(i, j)], 0.0) * (y[j] + s * x[j]) - c64::new(c[(i, j)], 0.0) * x[j];
                }
                sum
            });
            let solved = lu.solve(&rhs);
            let new_x: Vec<c64> = (0..n).map(|i| solved[(i, 0)]).collect();
            let new_y: Vec<c64> = (0..n).map(|i| s * new_x[i] + x[i]).collect();
            let biggest =
                (0..n).max_by(|&a, &b| new_x[a].norm().total_cmp(&new_x[b].norm())).unwrap_or_default();
            // 1/(λ - s) is how much the vector grew
            let gain = new_x[biggest] / x[biggest];
            let eigenvalue = s + c64::new(1.0, 0.0) / gain;
            let size = new_x[biggest];
            x = new_x.iter().map(|z| *z / size).collect();
            y = new_y.iter().map(|z| *z / size).collect();
            if round > 3 {
                shift = eigenvalue;
            }
            if (eigenvalue - s).norm() < 1e-11 * guess && round > 5 {
                return (eigenvalue, x);
            }
        }
        (shift, x)
    }
}

#[test]
fn strings_that_run_along_themselves_have_the_right_modes() {
    let data = data("flow/moving_string.json");
    for row in data["f1"].as_array().expect("rows") {
        let [m, tension, length, v] = ["m", "T", "L", "V"].map(|k| number(&row[k]));
        let omega: Vec<f64> = serde_json::from_value(row["omega"].clone()).expect("frequencies");
        let mut errors = Vec::new();
        for elements in [8, 16] {
            let line = running::Line { m, tension, length, ei: 0.0, v, elements };
            let (lambda, x) = running::mode(&line, omega[0]);
            let frequency = (lambda.im / omega[0] - 1.0).abs();
            assert!((lambda.re / omega[0]).abs() < 1e-9, "V = {v}: {lambda}");
            // material runs towards the start, so the phase falls along the string: the frequencies can't tell
            let kappa = number(&row["kappa1"]);
            let mut shape = 0.0_f64;
            let at = |k: usize| {
                let s = k as f64 / elements as f64;
                let angle = -kappa * s * length;
                faer::c64::new(angle.cos(), angle.sin()) * (std::f64::consts::PI * s).sin()
            };
            // unknowns: y' of the first node, then y and y' of each
            let value = |k: usize| x[2 * k - 1];
            let middle = value(elements / 2) / at(elements / 2);
            for k in 1..elements {
                shape = shape.max((value(k) / middle - at(k)).norm());
            }
            errors.push((frequency, shape));
        }
        eprintln!("V = {v}: {errors:?}");
        let order = (errors[0].0 / errors[1].0).log2();
        assert!(errors[1].0 < 1.2e-5 && order > 3.0, "V = {v}: {errors:?}, order {order}");
        assert!(errors[1].1 < 1e-3, "V = {v}: {errors:?}");
    }
}

/// A cable in water that hangs from a moving point, with bending stiffness, damping and drag.
fn wet() -> Scene {
    let section = Section {
        diameter: 0.02,
        axial_retardation_time: 0.01,
        bending_retardation_time: 0.01,
        ..Section::new(0.8, 1e4, 2.0)
    };
    let mut scene = Scene::new();
    scene.water = Some(ropewalk_scene::Water::default());
    scene
        .element(CableSpec::straight("rope", [0.0; 3], [0.0, 0.0, -6.0], 8, section))
        .element(PointMassSpec::new("bob", "rope.end", 3.0))
        .motion(StraightSpec {
            name: "course".into(),
            speed: 1.0,
            direction: [1.0, 0.0, 0.0],
            start: 0.0,
            ramp: 0.5,
        })
        .force(GravitySpec::default())
        .force(ropewalk_forces::BuoyancySpec::default())
        .force(ropewalk_forces::DragSpec::default());
    scene
}

/// What changes of a scene.
type Add<'a> = &'a dyn Fn(&mut Scene);

#[test]
fn an_eyelet_is_a_point_and_a_winch_in_one() {
    let feed = |w: WinchSpec| WinchSpec { name: "eyelet.feed".into(), ..w };
    let cases: [(Add<'_>, Add<'_>); 4] = [
        (&|s| _ = s.constraint(EyeletSpec::speed("eyelet", "rope.start", -0.8)), &|s| {
            s.constraint(SphericalSpec::pin("eyelet", "rope.start")).constraint(feed(WinchSpec::speed(
                "",
                "rope.start",
                -0.8,
            )));
        }),
        (
            &|s| {
                s.constraint(EyeletSpec {
                    path: Some("course".into()),
                    per_speed2: 0.5.into(),
                    damping: 2.0.into(),
                    ..EyeletSpec::tension("eyelet", "rope.start", 20.0)
                });
            },
            &|s| {
                let winch = WinchSpec::tension("", "rope.start", 20.0);
                s.constraint(DrivingSpec::new("eyelet", "rope.start", "course"))
                    .constraint(feed(WinchSpec { per_speed2: 0.5.into(), damping: 2.0.into(), ..winch }));
            },
        ),
        (
            &|s| {
                s.motion(steadily("in", 1.5)).constraint(EyeletSpec {
                    element_length: Some(0.5),
                    ..EyeletSpec::motion("eyelet", "rope.start", "in")
                });
            },
            &|s| {
                let winch = WinchSpec::motion("", "rope.start", "in");
                s.motion(steadily("in", 1.5))
                    .constraint(SphericalSpec::pin("eyelet", "rope.start"))
                    .constraint(feed(WinchSpec { element_length: Some(0.5), ..winch }));
            },
        ),
        // on a cart that runs by itself
        (
            &|s| {
                cart(s);
                s.constraint(EyeletSpec {
                    to: Some("cart".into()),
                    ..EyeletSpec::speed("eyelet", "rope.start", 0.8)
                });
            },
            &|s| {
                cart(s);
                s.constraint(SphericalSpec::new("eyelet", "rope.start", "cart"))
                    .constraint(feed(WinchSpec::speed("", "rope.start", 0.8)));
            },
        ),
    ];
    for (k, (one, two)) in cases.into_iter().enumerate() {
        let [one, two] = [one, two].map(|add| {
            let mut scene = wet();
            add(&mut scene);
            let model = scene.build().unwrap_or_else(|e| panic!("{k}: {e}"));
            let mut s = Simulation::new(model, &fixed(2e-3), 1.0).unwrap_or_else(|e| panic!("{k}: {e}"));
            go(&mut s, 1.0);
            let length = s.model.part("rope").expect("rope").length_now(&s.state.at());
            (s.state, s.audit, length)
        });
        assert!((one.2 - 6.0).abs() > 0.1, "{k}: nothing was fed, {} m", one.2);
        assert_eq!(one, two, "{k}");
    }
}

/// Something that an eyelet can be on.
fn cart(scene: &mut Scene) {
    scene
        .element(ropewalk_elements::RigidBodySpec::new("cart", [0.0; 3], 50.0, [1.0, 1.0, 1.0]))
        .constraint(DrivingSpec::new("wheels", "cart", "course"));
}

#[test]
fn what_no_eyelet_can_do_is_refused() {
    let speed = || EyeletSpec::speed("eyelet", "rope.start", -0.8);
    let tension = || EyeletSpec::tension("eyelet", "rope.start", 5.0);
    let cases: [(EyeletSpec, &str, &str); 14] = [
        (EyeletSpec { speed: None, ..speed() }, "name", "needs one of"),
        (EyeletSpec { motion: Some("course".into()), ..speed() }, "motion", "not both"),
        (
            EyeletSpec { tension: Some(5.0.into()), ..speed() },
            "tension",
            "the tension at this eyelet is a result",
        ),
        (EyeletSpec { damping: 5.0.into(), ..speed() }, "damping", "goes with `tension`"),
        (EyeletSpec { per_speed2: 5.0.into(), ..speed() }, "per_speed2", "goes with `tension`"),
        (
            EyeletSpec { to: Some([0.0; 3].into()), path: Some("course".into()), ..speed() },
            "path",
            "not both",
        ),
        (EyeletSpec { path: Some("corse".into()), ..speed() }, "path", "there is no motion `corse`"),
        (EyeletSpec { ramp: 0.0, ..speed() }, "ramp", "jump of velocity"),
        (EyeletSpec { stop: Some(0.5), ..speed() }, "stop", "before its speed has risen"),
        (EyeletSpec { element_length: Some(4.0), ..speed() }, "element_length", "less than half of that"),
        (EyeletSpec { shortest: Some(7.0), ..speed() }, "shortest", "must be less"),
        (EyeletSpec { marker: "rope@2m".into(), ..speed() }, "marker", "end of a cable"),
        (
            EyeletSpec { reference_speed: Some("corse".into()), ..tension() },
            "reference_speed",
            "there is no motion `corse`",
        ),
        (
            EyeletSpec { reference_speed: Some("in".into()), ..tension() },
            "reference_speed",
            "not defined for ever",
        ),
    ];
    for (spec, field, message) in cases {
        let mut scene = wet();
        scene.motion(steadily("in", 1.0)).constraint(spec);
        let e = scene.build().err().unwrap_or_else(|| panic!("{message}: it builds")).error;
        assert!(
            e.field.as_deref() == Some(field) && e.message.contains(message),
            "{:?} {}: not {field}, {message}",
            e.field,
            e.message
        );
    }
}

/// Energy of a cable with everything that takes or brings some, while elements are born or swallowed at an eyelet that
/// moves: the imbalance over the largest term, and how many changes of the mesh there were.
fn balance(speed: f64, h: f64) -> (f64, usize) {
    #[derive(Default)]
    struct Changes(usize);
    impl ropewalk_core::Observer for Changes {
        fn remeshed(&mut self, _: &ropewalk_core::Remeshed) {
            self.0 += 1;
        }
    }
    let mut scene = wet();
    scene
        .motion(HarmonicSpec {
            name: "heave".into(),
            amplitude: [0.3, 0.2, 0.4].map(Into::into),
            frequency: 0.5.into(),
            phase: 0.0,
            start: 0.0,
            ramp: 0.5,
        })
        .constraint(EyeletSpec {
            path: Some("heave".into()),
            element_length: Some(0.7),
            start: 0.1,
            ramp: 0.5,
            stop: Some(2.6),
            ..EyeletSpec::speed("eyelet", "rope.start", speed)
        });
    let model = scene.build().unwrap_or_else(|e| panic!("{e}"));
    let mut s = Simulation::new(model, &fixed(h), 3.5).unwrap_or_else(|e| panic!("{e}"));
    let mut changes = Changes::default();
    let end = s.advance(3.5, f64::INFINITY, &mut changes).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(end, End::Done);
    let a = &s.audit;
    let largest = [a.kinetic, a.potential, a.supplied, a.carried, a.dissipated];
    let largest = largest.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    println!("{speed} m/s, h = {h}: {:e} J of {largest} J, {} changes, {a:?}", a.imbalance(), changes.0);
    (a.imbalance().abs() / largest, changes.0)
}

#[test]
fn energy_closes_over_events_at_a_moving_eyelet() {
    for speed in [1.2, -1.2] {
        let all = [2e-3, 1e-3, 5e-4].map(|h| balance(speed, h));
        let ratios: Vec<f64> = all.windows(2).map(|w| w[0].0 / w[1].0).collect();
        assert!(all.iter().all(|(_, changes)| *changes >= 3), "{all:?}");
        assert!(all[2].0 < 1e-5, "{speed}: {all:?}");
        assert!(ratios.iter().all(|r| *r > 3.0), "{speed}: {ratios:?}");
    }
}

#[test]
fn an_eyelet_that_moves_stays_on_its_path_over_changes_of_the_mesh() {
    for speed in [1.2, -1.2] {
        let mut scene = wet();
        scene.constraint(EyeletSpec {
            path: Some("course".into()),
            element_length: Some(0.5),
            ..EyeletSpec::speed("eyelet", "rope.start", speed)
        });
        let mut s = Simulation::new(scene.build().unwrap_or_else(|e| panic!("{e}")), &fixed(2e-3), 2.0)
            .unwrap_or_else(|e| panic!("{e}"));
        go(&mut s, 2.0);
        // a ramp of 0.5 s and 1.5 s at 1 m/s
        let x = crate::common::place(&s.model, &s.state, "rope", 0.0);
        assert!((x[0] - 1.75).abs() < 1e-9 && x[2].abs() < 1e-9, "{speed}: {x:?}");
    }
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
